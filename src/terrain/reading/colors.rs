//! Finds the kind of tile that a colour means, as a person names it: by hue, lightness and chroma.

use crate::math;
use crate::svg::oklab;
use crate::terrain::Tile;

/// What a person calls a colour.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Named {
    /// The colour of a kind of tiles.
    Tile(Tile),
    /// A light yellow-brown: ground, or a wall below a roof.
    Sand,
}

impl Named {
    /// All that are drawn.
    pub(super) const ALL: [Self; 6] = [
        Self::Tile(Tile::Green),
        Self::Tile(Tile::Brown),
        Self::Tile(Tile::Blue),
        Self::Tile(Tile::Red),
        Self::Tile(Tile::Beige),
        Self::Sand,
    ];

    /// The kind of tile, of sand without a roof.
    pub(super) fn tile(self) -> Tile {
        match self {
            Self::Tile(tile) => tile,
            Self::Sand => Tile::Green,
        }
    }
}

impl Default for Named {
    fn default() -> Self {
        Self::Tile(Tile::None)
    }
}

/// Colours of one name: ranges of hue in degrees, of lightness and of chroma in OkLCh.
struct Colors {
    named: Named,
    hue: [f64; 2],
    lightness: [f64; 2],
    chroma: [f64; 2],
}

const fn colors(named: Named, hue: [f64; 2], lightness: [f64; 2], chroma: [f64; 2]) -> Colors {
    Colors {
        named,
        hue,
        lightness,
        chroma,
    }
}

/// No limit of chroma.
const ANY: f64 = 1.0;

/// The names. Between them lie the colours that could be either, or something else: olive, turquoise, violet, pink, orange, yellow,
/// rust, and everything greyish, dark or pale. Fitted on half of the colours of common palettes.
#[rustfmt::skip]
const NAMES: &[Colors] = &[
    colors(Named::Tile(Tile::Green), [118.0, 168.0], [0.3, 0.93], [0.055, ANY]),
    // Olive green, as far as it is not lime.
    colors(Named::Tile(Tile::Green), [110.0, 118.0], [0.3, 0.7], [0.07, ANY]),
    colors(Named::Tile(Tile::Blue), [212.0, 276.0], [0.27, 0.84], [0.07, ANY]),
    // Towards violet only dull blues.
    colors(Named::Tile(Tile::Blue), [276.0, 285.0], [0.27, 0.84], [0.08, 0.12]),
    // Pale sky blue.
    colors(Named::Tile(Tile::Blue), [215.0, 235.0], [0.84, 0.9], [0.045, 0.1]),
    // Brown is dark orange; towards red only what is dull.
    colors(Named::Tile(Tile::Brown), [20.0, 30.0], [0.34, 0.66], [0.03, 0.1]),
    colors(Named::Tile(Tile::Brown), [30.0, 40.0], [0.34, 0.66], [0.03, 0.125]),
    colors(Named::Tile(Tile::Brown), [40.0, 90.0], [0.34, 0.71], [0.03, 0.12]),
    colors(Named::Tile(Tile::Red), [12.0, 30.0], [0.38, 0.66], [0.165, ANY]),
    // Away from brown also duller, or darker.
    colors(Named::Tile(Tile::Red), [12.0, 24.0], [0.38, 0.66], [0.14, 0.165]),
    colors(Named::Tile(Tile::Red), [26.0, 30.0], [0.385, 0.46], [0.15, 0.165]),
    colors(Named::Tile(Tile::Beige), [50.0, 100.0], [0.82, 0.985], [0.03, 0.085]),
    colors(Named::Sand, [50.0, 90.0], [0.72, 0.82], [0.04, 0.13]),
];

/// The name of an sRGB colour, if it is clear. The default colours of the tiles are.
pub(super) fn named(color: [u8; 3]) -> Option<Named> {
    if let Some(tile) = Tile::DRAWN.iter().find(|tile| tile.color() == color) {
        return Some(Named::Tile(*tile));
    }
    let [lightness, a, b] = oklab(color);
    let (hue, chroma) = (
        math::atan2(b, a).to_degrees().rem_euclid(360.0),
        math::hypot(a, b),
    );
    let holds = |range: &[f64; 2], value: f64| range[0] <= value && value < range[1];
    let found = NAMES.iter().find(|colors| {
        holds(&colors.hue, hue)
            && holds(&colors.lightness, lightness)
            && holds(&colors.chroma, chroma)
    });
    found.map(|colors| colors.named)
}

#[cfg(test)]
mod tests {
    use super::super::palettes::PALETTES;
    use super::*;

    fn of_hex(hex: &str) -> Option<Named> {
        let channel = |at: usize| u8::from_str_radix(&hex[at..at + 2], 16).unwrap();
        named([channel(0), channel(2), channel(4)])
    }

    #[test]
    fn colors_that_maps_are_drawn_with_are_clear() {
        let five = Tile::DRAWN.map(|tile| Some(Named::Tile(tile)));
        for map in [
            ["4caf50", "8d6e63", "42a5f5", "e53935", "f5deb3"],
            ["00a040", "8b5a2b", "285adc", "d22828", "ebd7aa"],
            ["00a000", "805020", "2060e0", "d02020", "e8d8a8"],
            ["228b22", "795548", "1e90ff", "ff0000", "fff8dc"],
            ["00ff00", "8b4513", "0000ff", "b71c1c", "ffe4c4"],
            ["006400", "a0522d", "000080", "8b0000", "ffebcd"],
        ] {
            assert_eq!(map.map(of_hex), five, "{map:?}");
        }
    }

    #[test]
    fn colors_that_could_be_anything_are_not() {
        for hex in [
            "000000", "404040", "808080", "c0c0c0", "ffffff", "ff00ff", "800080", "ffff00",
            "ffa500", "00ffff", "008080", "a52a2a",
        ] {
            assert_eq!(of_hex(hex), None, "{hex}");
        }
    }

    /// Of the colours of common palettes, those that a person calls by the name of a tile are taken for it, and no others.
    #[test]
    fn colors_of_common_palettes_are_read_as_a_person_names_them() {
        let (mut tiles, mut taken, mut wrong) = (0, 0, vec![]);
        for (hex, name) in PALETTES {
            let found = match of_hex(hex) {
                None => "none",
                Some(Named::Sand) => "sand",
                Some(Named::Tile(tile)) => tile.name(),
            };
            // Beige and sand are one colour to many: they differ only where there is no roof.
            let light = |name: &str| ["sand", "beige"].contains(&name);
            let is_right = found == *name || (light(found) && light(name));
            tiles += usize::from(*name != "none");
            taken += usize::from(*name != "none" && is_right);
            if found != "none" && !is_right {
                wrong.push((hex, name, found));
            }
        }
        assert_eq!(wrong, []);
        assert!(tiles >= 104, "{tiles}");
        assert!(taken * 104 > tiles * 95, "{taken} of {tiles}");
    }
}
