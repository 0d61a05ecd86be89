//! `round`: rounded both ways, an ellipsoid over an ellipse.

use glam::DVec2;

use super::Kind;
use crate::solid::Options;
use crate::solid::layers::{Layer, finite, least_thickness, rounding};

/// Rounded both ways between two angles.
#[derive(Debug, Clone, PartialEq)]
pub struct Round {
    angles: [f64; 2],
    /// How far it comes out of the drawing; if not given, as far as the outline's smaller half extent.
    radius: Option<f64>,
}

impl Kind for Round {
    fn new(numbers: &[f64], _: f64) -> Option<Self> {
        match *numbers {
            [a0, a1] => Some(Self {
                angles: [a0, a1],
                radius: None,
            }),
            [a0, a1, radius] => Some(Self {
                angles: [a0, a1],
                radius: Some(radius),
            }),
            _ => None,
        }
    }

    fn numbers(&self) -> Vec<f64> {
        self.angles.into_iter().chain(self.radius).collect()
    }

    fn layers(&self, half: DVec2, options: &Options) -> Vec<Layer> {
        let radius = self.radius.map(|radius| finite(radius).abs());
        let radius = radius.unwrap_or(half.min_element());
        let radius = radius.max(least_thickness(half));
        rounding(self.angles, radius, options, |scale| [scale, scale])
    }
}
