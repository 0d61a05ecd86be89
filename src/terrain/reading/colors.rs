//! Finds the kind of tile that a colour means.

use crate::svg::oklab;
use crate::terrain::Tile;

/// The weight of a difference of lightness, less than 1 so that light and shade do not change the kind.
const LIGHTNESS: f64 = 0.5;
/// The largest distance of a colour from that of its kind: about three quarters of the distance between the two most similar
/// kinds, brown and red (0.17).
const FAR: f64 = 0.13;
/// The largest ratio of the distance from the nearest kind to that from the next: a crimson brown (0.64) could be a roof or
/// a cliff.
const CLEARLY: f64 = 0.6;
/// Colours of less chroma are grey, which is the colour of no kind.
const GRAY: f64 = 0.02;

/// The kind of tile for an sRGB colour: the one with that default colour, or else the one whose default colour is clearly
/// nearest.
pub(super) fn kind(color: [u8; 3]) -> Option<Tile> {
    if let Some(tile) = Tile::DRAWN.iter().find(|tile| tile.color() == color) {
        return Some(*tile);
    }
    let lab = oklab(color);
    if lab[1].hypot(lab[2]) < GRAY {
        return None;
    }
    let mut near = Tile::DRAWN.map(|tile| (distance(lab, oklab(tile.color())), tile));
    near.sort_by(|(one, _), (other, _)| one.total_cmp(other));
    let [(first, tile), (second, _), ..] = near;
    (first < FAR && first <= CLEARLY * second).then_some(tile)
}

fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    let [l, x, y] = [0, 1, 2].map(|i| a[i] - b[i]);
    ((LIGHTNESS * l).powi(2) + x * x + y * y).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn named(hex: &str) -> Option<Tile> {
        let channel = |at: usize| u8::from_str_radix(&hex[at..at + 2], 16).unwrap();
        kind([channel(0), channel(2), channel(4)])
    }

    #[test]
    fn colors_that_maps_are_drawn_with_are_clear() {
        let five = Tile::DRAWN.map(Some);
        for map in [
            ["4caf50", "8d6e63", "42a5f5", "e53935", "f5deb3"],
            ["00a040", "8b5a2b", "285adc", "d22828", "ebd7aa"],
            ["00a000", "805020", "2060e0", "d02020", "e8d8a8"],
            ["228b22", "795548", "1e90ff", "ff0000", "fff8dc"],
        ] {
            assert_eq!(map.map(named), five, "{map:?}");
        }
    }

    #[test]
    fn colors_that_could_be_anything_are_not() {
        for hex in [
            "000000", "404040", "808080", "c0c0c0", "ffffff", "ff00ff", "800080", "ffff00",
            "ffa500", "00ffff", "008080", "a52a2a", "000080", "556b2f",
        ] {
            assert_eq!(named(hex), None, "{hex}");
        }
    }
}
