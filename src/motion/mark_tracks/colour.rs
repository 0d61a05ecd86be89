//! The colours of marks as text.

use std::str::FromStr;

/// A colour as `#rrggbb`.
pub fn hex([r, g, b]: [u8; 3]) -> String {
    format!("#{r:02x}{g:02x}{b:02x}")
}

/// The colour that `#rrggbb` or `#rgb` is.
pub fn parse_hex(text: &str) -> Option<[u8; 3]> {
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
pub fn named_colour(name: &str) -> Option<[u8; 3]> {
    let is_word = name.bytes().all(|byte| byte.is_ascii_alphabetic());
    let colour = svgtypes::Color::from_str(&name.to_ascii_lowercase()).ok()?;
    (is_word && colour.alpha == 255).then_some([colour.red, colour.green, colour.blue])
}
