//! `lathe`: turned about the axis like a vase.

use glam::DVec2;

use super::Kind;
use crate::geometry::Outline;
use crate::math;
use crate::scene::Surface;
use crate::solid::Options;
use crate::solid::lathe::{lathe, sweep_angle};
use crate::solid::layers::steps_per_half_turn;

/// Half the outline turned about the axis.
#[derive(Debug, Clone, PartialEq)]
pub struct Lathe {
    degrees: f64,
}

impl Kind for Lathe {
    fn new(numbers: &[f64], _: f64) -> Option<Self> {
        let &[degrees] = numbers else { return None };
        Some(Self { degrees })
    }

    fn numbers(&self) -> Vec<f64> {
        vec![self.degrees]
    }

    fn surface(&self, outline: &Outline, _: DVec2, options: &Options) -> Surface {
        lathe(outline, self.degrees, options)
    }

    fn depths(&self, half: DVec2, _: &Options) -> Option<[f64; 2]> {
        let side = (sweep_angle(self.degrees) / 2.0).to_radians();
        Some([half.x * math::cos(side).min(0.0), half.x])
    }

    fn triangles(&self, outline: &Outline, _: DVec2, options: &Options) -> u64 {
        (outline.point_count() * 4 * steps_per_half_turn(options) as usize) as u64
    }

    fn depends_on_axis(&self) -> bool {
        true
    }
}
