//! Round shapes whose radius is beyond any use.
//!
//! usvg turns arcs into curves with an absolute tolerance, so that their number grows with the radius: a circle with the largest
//! radius that fits into a number would become millions of curves. The largest coordinate that can be built is much smaller,
//! so such radii are replaced before usvg sees them, and the shape is left out as all shapes are that are too large.

use svgtypes::{Length, PathParser, PathSegment};

/// The largest radius that usvg sees; larger than the largest coordinate that can be built.
const MAX_RADIUS: f64 = 1e13;

/// What takes the place of a larger radius.
const RADIUS: &str = "1e13";

/// What takes the place of the data of a path with a larger radius.
const PATH: &str = "M0 0H1e13V1e13z";

/// A number with fewer digits in a row, and without an exponent, is no larger than [`MAX_RADIUS`].
const DIGITS: usize = 13;

/// The attributes that [`bounded`] looks at.
pub(super) const ATTRIBUTES: [&str; 4] = ["r", "rx", "ry", "d"];

/// What takes the place of the value of an attribute; `None` if it is kept.
pub(super) fn bounded(attribute: &str, value: &str) -> Option<&'static str> {
    match attribute {
        // A negative radius is none.
        "r" | "rx" | "ry" if may_be_large(value) => {
            let length: Length = value.trim().parse().ok()?;
            (length.number > MAX_RADIUS).then_some(RADIUS)
        }
        "d" if may_be_large(value) => {
            let is_large = |segment: PathSegment| match segment {
                PathSegment::EllipticalArc { rx, ry, .. } => rx.abs().max(ry.abs()) > MAX_RADIUS,
                _ => false,
            };
            // What follows a mistake is not drawn.
            let mut segments = PathParser::from(value).map_while(Result::ok);
            segments.any(is_large).then_some(PATH)
        }
        _ => None,
    }
}

/// Whether a text may have a number that is too large. Takes less time than parsing.
fn may_be_large(text: &str) -> bool {
    let mut digits = 0;
    text.bytes().any(|byte| {
        digits = if byte.is_ascii_digit() { digits + 1 } else { 0 };
        matches!(byte, b'e' | b'E') || digits > DIGITS
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_radii_beyond_use_are_replaced() {
        for (attribute, value, expected) in [
            ("r", "5", None),
            ("r", "1e13", None),
            ("r", "1e14", Some(RADIUS)),
            ("rx", " 1e38mm", Some(RADIUS)),
            ("rx", "-1e38", None),
            ("ry", "100000000000000", Some(RADIUS)),
            ("cx", "1e38", None),
            ("r", "large", None),
            ("d", "M0 0A1e38 1 0 0 0 5 5", Some(PATH)),
            ("d", "M1e38 0A5 5 0 0 0 5 5", None),
            (
                "d",
                "M0 0a9 9 0 0 0 5 5 10000000000000000 9 0 0 0 5 5",
                Some(PATH),
            ),
            ("d", "M0 0 e A1e38 1 0 0 0 5 5", None),
        ] {
            assert_eq!(bounded(attribute, value), expected, "{attribute}={value}");
        }
    }
}
