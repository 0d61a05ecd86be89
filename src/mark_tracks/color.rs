//! The colours of marks: as text, and by their hues.

use std::str::FromStr;

/// A colour as `#rrggbb`.
pub(crate) fn hex([r, g, b]: [u8; 3]) -> String {
    format!("#{r:02x}{g:02x}{b:02x}")
}

/// The colour that `#rrggbb` or `#rgb` is.
pub(crate) fn parse_hex(text: &str) -> Option<[u8; 3]> {
    let digits: Vec<u8> = text
        .strip_prefix('#')?
        .chars()
        .map(|c| c.to_digit(16).and_then(|digit| u8::try_from(digit).ok()))
        .collect::<Option<_>>()?;
    match digits[..] {
        [r, g, b] => Some([r, g, b].map(|digit| 17 * digit)),
        [r0, r1, g0, g1, b0, b1] => Some([16 * r0 + r1, 16 * g0 + g1, 16 * b0 + b1]),
        _ => None,
    }
}

/// The colour with this CSS name, in small or capital letters.
pub(crate) fn named_color(name: &str) -> Option<[u8; 3]> {
    let is_word = name.bytes().all(|byte| byte.is_ascii_alphabetic());
    let color = svgtypes::Color::from_str(&name.to_ascii_lowercase()).ok()?;
    (is_word && color.alpha == 255).then_some([color.red, color.green, color.blue])
}

/// A colour by its hue.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Hsv {
    /// Degrees: red 0, green 120, blue 240; 0 for greys.
    pub hue: f64,
    /// 0 for greys, 1 for pure colours. Does not depend on the light.
    pub saturation: f64,
    /// Saturation times brightness.
    pub chroma: f64,
}

impl Hsv {
    /// The hue, saturation and chroma of an sRGB colour.
    pub(crate) fn of(rgb: [u8; 3]) -> Self {
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
pub(crate) fn hue_difference(hue: f64, other: f64) -> f64 {
    (hue - other + 180.0).rem_euclid(360.0) - 180.0
}
