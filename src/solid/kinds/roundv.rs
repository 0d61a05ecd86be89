//! `roundv`: rounded about the axis, a cylinder over a bar.

use glam::DVec2;

use super::Kind;
use crate::solid::Options;
use crate::solid::layers::{Layer, rounding};

/// Rounded about the axis between two angles.
#[derive(Debug, Clone, PartialEq)]
pub struct RoundV {
    angles: [f64; 2],
}

impl Kind for RoundV {
    fn new(numbers: &[f64], _: f64) -> Option<Self> {
        let angles = numbers.try_into().ok()?;
        Some(Self { angles })
    }

    fn numbers(&self) -> Vec<f64> {
        self.angles.to_vec()
    }

    fn layers(&self, half: DVec2, options: &Options) -> Vec<Layer> {
        rounding(self.angles, half.x, options, |scale| [scale, 1.0])
    }

    fn depends_on_axis(&self) -> bool {
        true
    }
}
