//! How large a model is.

use std::fmt;

use glam::DVec3;
use serde::Serialize;

/// The size of a model in its rest pose, along the axes of the scene, metres.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Size {
    /// Along x.
    pub width: f64,
    /// Along y, which points up.
    pub height: f64,
    /// Along z.
    pub depth: f64,
}

impl Size {
    /// The size of what reaches so far along each axis. It is rounded: positions have single precision.
    pub(crate) fn of(reach: DVec3) -> Self {
        let [width, height, depth] = reach.to_array().map(|length| rounded(length, 6));
        Self {
            width,
            height,
            depth,
        }
    }
}

/// `1.7 m high, 0.62 m wide, 0.31 m deep`, each with up to three significant digits.
impl fmt::Display for Size {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let all = [self.height, self.width, self.depth];
        let [height, width, depth] = all.map(|length| rounded(length, 3));
        write!(f, "{height} m high, {width} m wide, {depth} m deep")
    }
}

/// A number with so many significant digits.
fn rounded(number: f64, digits: usize) -> f64 {
    format!("{number:.*e}", digits - 1)
        .parse()
        .unwrap_or(number)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_are_rounded() {
        let size = Size::of(DVec3::new(0.6249, f64::from(1.7_f32), 0.0));
        assert_eq!([size.width, size.height, size.depth], [0.6249, 1.7, 0.0]);
        assert_eq!(size.to_string(), "1.7 m high, 0.625 m wide, 0 m deep");
        let size = Size::of(DVec3::new(12_345.6, 10.54, 0.000_123_4));
        assert_eq!(
            size.to_string(),
            "10.5 m high, 12300 m wide, 0.000123 m deep"
        );
    }
}
