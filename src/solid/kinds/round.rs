//! Roundings between two angles: cylinders over bars (`roundv`, `roundh`), an ellipsoid over an ellipse (`round`).

use glam::DVec2;

use super::Kind;
use crate::geometry::Outline;
use crate::solid::Options;
use crate::solid::layers::{Layer, finite, least_thickness, overflows, rounding, scales};

/// `roundv`: rounded about the axis.
pub(super) type RoundV = Rounding<true, false>;
/// `roundh`: rounded across the axis.
pub(super) type RoundH = Rounding<false, true>;
/// `round`: rounded both ways.
pub(super) type Round = Rounding<true, true>;

/// Rounded between two angles, with the outline scaled across the axis, along it or both.
#[derive(Debug, Clone, PartialEq)]
pub struct Rounding<const ACROSS: bool, const ALONG: bool> {
    angles: [f64; 2],
    /// How far it comes out of the drawing; if not given, as far as the smaller of the half extents that are scaled. Only
    /// `round` takes one.
    radius: Option<f64>,
}

impl<const ACROSS: bool, const ALONG: bool> Kind for Rounding<ACROSS, ALONG> {
    fn new(numbers: &[f64], _: f64) -> Option<Self> {
        let (angles, radius) = match *numbers {
            [a0, a1] => ([a0, a1], None),
            [a0, a1, radius] if ACROSS && ALONG => ([a0, a1], Some(radius)),
            _ => return None,
        };
        Some(Self { angles, radius })
    }

    fn numbers(&self) -> Vec<f64> {
        self.angles.into_iter().chain(self.radius).collect()
    }

    fn layers(&self, half: DVec2, options: &Options) -> Vec<Layer> {
        let radius = match (ACROSS, ALONG) {
            (true, false) => half.x,
            (false, true) => half.y,
            _ => {
                let radius = self.radius.map(|radius| finite(radius).abs());
                let radius = radius.unwrap_or(half.min_element());
                radius.max(least_thickness(half))
            }
        };
        rounding(self.angles, radius, options, scales::<ACROSS, ALONG>)
    }

    fn overflows(&self, outline: &Outline) -> bool {
        overflows::<ACROSS, ALONG>(outline)
    }

    fn depends_on_axis(&self) -> bool {
        ACROSS != ALONG
    }
}
