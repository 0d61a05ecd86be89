//! The axis of a clip's world that points up.

use std::fmt;
use std::str::FromStr;

use glam::DVec3;

use crate::mocap::Axis;

/// The axis of a clip's world that points up, where a person names it: `+z`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct UpAxis {
    /// The axis.
    pub axis: Axis,
    /// Whether it points in the negative direction.
    pub is_negative: bool,
}

impl UpAxis {
    /// The unit vector in its direction.
    pub fn direction(self) -> DVec3 {
        let axis = match self.axis {
            Axis::X => DVec3::X,
            Axis::Y => DVec3::Y,
            Axis::Z => DVec3::Z,
        };
        if self.is_negative { -axis } else { axis }
    }
}

/// The error for a text that names no axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("expected one of +x, -x, +y, -y, +z, -z")]
pub struct NoAxis;

impl FromStr for UpAxis {
    type Err = NoAxis;

    /// Reads `+z` and the like; a sign may be missing.
    fn from_str(text: &str) -> Result<Self, NoAxis> {
        let (is_negative, name) = match text.strip_prefix('-') {
            Some(name) => (true, name),
            None => (false, text.strip_prefix('+').unwrap_or(text)),
        };
        let axis = match name {
            "x" | "X" => Axis::X,
            "y" | "Y" => Axis::Y,
            "z" | "Z" => Axis::Z,
            _ => return Err(NoAxis),
        };
        Ok(Self { axis, is_negative })
    }
}

impl fmt::Display for UpAxis {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let sign = if self.is_negative { '-' } else { '+' };
        write!(f, "{sign}{}", ['x', 'y', 'z'][self.axis.index()])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn axes_are_read_and_printed() {
        for (text, direction) in [
            ("+x", DVec3::X),
            ("-y", DVec3::NEG_Y),
            ("Z", DVec3::Z),
            ("-z", DVec3::NEG_Z),
        ] {
            let axis: UpAxis = text.parse().unwrap();
            assert_eq!(axis.direction(), direction, "{text}");
            assert_eq!(axis.to_string().parse(), Ok(axis));
        }
        for text in ["", "+", "w", "+-z", "zz", "++z"] {
            assert_eq!(text.parse::<UpAxis>(), Err(NoAxis), "{text}");
        }
    }
}
