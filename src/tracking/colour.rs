//! Hue, saturation and chroma.

/// The names of hues, and where they are on the circle, in degrees.
pub const HUES: [(&str, f64); 8] = [
    ("red", 0.0),
    ("orange", 30.0),
    ("yellow", 57.0),
    ("green", 130.0),
    ("cyan", 190.0),
    ("blue", 225.0),
    ("purple", 280.0),
    ("pink", 325.0),
];

/// A colour by its hue.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hsv {
    /// Degrees: red 0, green 120, blue 240; 0 for greys.
    pub hue: f64,
    /// 0 for greys, 1 for pure colours. Does not depend on the light.
    pub saturation: f64,
    /// Saturation times brightness.
    pub chroma: f64,
}

impl Hsv {
    /// The hue, saturation and chroma of an sRGB colour.
    pub fn of(rgb: [u8; 3]) -> Self {
        let [r, g, b] = rgb.map(f64::from);
        let (most, least) = (r.max(g).max(b), r.min(g).min(b));
        let range = most - least;
        if range == 0.0 {
            return Self {
                hue: 0.0,
                saturation: 0.0,
                chroma: 0.0,
            };
        }
        let sixth = if most == r {
            (g - b) / range
        } else if most == g {
            (b - r) / range + 2.0
        } else {
            (r - g) / range + 4.0
        };
        Self {
            hue: (60.0 * sixth).rem_euclid(360.0),
            saturation: range / most,
            chroma: range / 255.0,
        }
    }
}

/// How far a hue is from another, from -180 to 180 degrees.
pub(super) fn hue_difference(hue: f64, other: f64) -> f64 {
    (hue - other + 180.0).rem_euclid(360.0) - 180.0
}

/// The name of the nearest hue.
pub fn hue_name(hue: f64) -> &'static str {
    let mut nearest = HUES[0];
    for named in HUES {
        if hue_difference(hue, named.1).abs() < hue_difference(hue, nearest.1).abs() {
            nearest = named;
        }
    }
    nearest.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hues_are_where_they_are_named() {
        for (rgb, name) in [
            ([220, 30, 40], "red"),
            ([250, 140, 20], "orange"),
            ([240, 230, 40], "yellow"),
            ([40, 160, 70], "green"),
            ([30, 200, 210], "cyan"),
            ([30, 60, 200], "blue"),
            ([130, 40, 180], "purple"),
            ([240, 60, 170], "pink"),
        ] {
            assert_eq!(hue_name(Hsv::of(rgb).hue), name);
        }
    }

    #[test]
    fn darker_light_changes_chroma_only() {
        let (bright, dark) = (Hsv::of([200, 40, 80]), Hsv::of([100, 20, 40]));
        assert_eq!((bright.hue, bright.saturation), (dark.hue, dark.saturation));
        assert_eq!(bright.chroma, 2.0 * dark.chroma);
        assert_eq!(hue_difference(350.0, 10.0), -20.0);
        assert_eq!(hue_difference(10.0, 350.0), 20.0);
    }
}
