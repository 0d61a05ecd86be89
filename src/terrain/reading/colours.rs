//! Finds the kind of tile that a colour means (terrain.md, Input).

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
const GREY: f64 = 0.02;

/// The kind of tile for an sRGB colour: the one with that default colour, or else the one whose default colour is clearly
/// nearest.
pub(super) fn kind(color: [u8; 3]) -> Option<Tile> {
    if let Some(tile) = Tile::DRAWN.iter().find(|tile| tile.color() == color) {
        return Some(*tile);
    }
    let lab = oklab(color);
    if lab[1].hypot(lab[2]) < GREY {
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

/// Oklab: lightness and two colour axes (Ottosson, *A perceptual color space for image processing*, 2020).
fn oklab(color: [u8; 3]) -> [f64; 3] {
    let [r, g, b] = color.map(|channel| {
        let channel = f64::from(channel) / 255.0;
        match channel <= 0.040_45 {
            true => channel / 12.92,
            false => ((channel + 0.055) / 1.055).powf(2.4),
        }
    });
    let l = (0.412_221_470_8 * r + 0.536_332_536_3 * g + 0.051_445_992_9 * b).cbrt();
    let m = (0.211_903_498_2 * r + 0.680_699_545_1 * g + 0.107_396_956_6 * b).cbrt();
    let s = (0.088_302_461_9 * r + 0.281_718_837_6 * g + 0.629_978_700_5 * b).cbrt();
    [
        0.210_454_255_3 * l + 0.793_617_785_0 * m - 0.004_072_046_8 * s,
        1.977_998_495_1 * l - 2.428_592_205_0 * m + 0.450_593_709_9 * s,
        0.025_904_037_1 * l + 0.782_771_766_2 * m - 0.808_675_766_0 * s,
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn named(hex: &str) -> Option<Tile> {
        let channel = |at: usize| u8::from_str_radix(&hex[at..at + 2], 16).unwrap();
        kind([channel(0), channel(2), channel(4)])
    }

    #[test]
    fn colours_that_maps_are_drawn_with_are_clear() {
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
    fn colours_that_could_be_anything_are_not() {
        for hex in [
            "000000", "404040", "808080", "c0c0c0", "ffffff", "ff00ff", "800080", "ffff00",
            "ffa500", "00ffff", "008080", "a52a2a", "000080", "556b2f",
        ] {
            assert_eq!(named(hex), None, "{hex}");
        }
    }

    #[test]
    fn oklab_is_that_of_its_paper() {
        let near = |a: [f64; 3], b: [f64; 3]| (0..3).all(|i| (a[i] - b[i]).abs() < 5e-4);
        assert!(near(oklab([255; 3]), [1.0, 0.0, 0.0]));
        assert!(near(oklab([255, 0, 0]), [0.628, 0.225, 0.126]));
        assert!(near(oklab([0, 0, 255]), [0.452, -0.032, -0.312]));
    }
}
