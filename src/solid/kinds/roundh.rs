//! `roundh`: rounded across the axis, a cylinder over a bar.

use glam::DVec2;

use super::Kind;
use crate::solid::Options;
use crate::solid::layers::{Layer, rounding};

/// Rounded across the axis between two angles.
#[derive(Debug, Clone, PartialEq)]
pub struct RoundH {
    angles: [f64; 2],
}

impl Kind for RoundH {
    fn new(numbers: &[f64], _: f64) -> Option<Self> {
        let angles = numbers.try_into().ok()?;
        Some(Self { angles })
    }

    fn numbers(&self) -> Vec<f64> {
        self.angles.to_vec()
    }

    fn layers(&self, half: DVec2, options: &Options) -> Vec<Layer> {
        rounding(self.angles, half.y, options, |scale| [1.0, scale])
    }

    fn depends_on_axis(&self) -> bool {
        true
    }
}
