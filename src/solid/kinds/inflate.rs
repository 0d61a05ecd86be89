//! `inflate`: blown up like a balloon.

use std::f64::consts::FRAC_PI_2;

use glam::DVec2;

use super::{HeightField, Kind};
use crate::geometry::Outline;
use crate::scene::Surface;
use crate::solid::Options;
use crate::solid::inflate::{Field, Mesh, field, height, heights, surface};
use crate::solid::layers::DEFAULT_SEGMENTS;

/// Layers per half turn of the smallest outlines: seen from near by they are still round.
const LEAST_SEGMENTS: u32 = 8;
/// In what steps there are more.
const STEP: f64 = 4.0;

/// A height field to both sides.
#[derive(Debug, Clone, PartialEq)]
pub struct Inflate {
    /// The height of the highest point; see [`field`] for what it is if not given.
    height: Option<f64>,
}

impl Kind for Inflate {
    fn new(numbers: &[f64], _: f64) -> Option<Self> {
        let height = numbers.first().copied();
        (numbers.len() <= 1).then_some(Self { height })
    }

    fn numbers(&self) -> Vec<f64> {
        self.height.into_iter().collect()
    }

    fn surface(&self, outline: &Outline, half: DVec2, options: &Options) -> Surface {
        surface(&self.field(outline, half, options), options)
    }

    fn height_field(&self) -> Option<&dyn HeightField> {
        Some(self)
    }

    fn depths(&self, half: DVec2, _: &Options) -> Option<[f64; 2]> {
        let height = height(self.height, half);
        Some([-height, height])
    }

    fn segments(&self, half: DVec2, crease: f64, invisible: f64) -> u32 {
        // Chords of a circle of radius r with n steps per half turn are off by r(π / 2n)² / 2.
        let radius = height(self.height, half).max(half.min_element());
        let enough = FRAC_PI_2 * (radius / (2.0 * invisible)).sqrt();
        // In coarse steps: when the drawing grows, most solids stay as they are.
        let enough = (STEP * (enough / STEP).round()) as u32;
        // With more degrees between the layers than the crease has, their edges would show.
        let smooth = ((180.0 / crease) as u32).saturating_add(1);
        enough.max(smooth).clamp(LEAST_SEGMENTS, DEFAULT_SEGMENTS)
    }
}

impl HeightField for Inflate {
    fn field(&self, outline: &Outline, half: DVec2, options: &Options) -> Field {
        field(outline, self.height, half, options)
    }

    fn surface_of(&self, field: &Field, options: &Options) -> Surface {
        surface(field, options)
    }

    fn heights(&self, mesh: &Mesh, half: DVec2, options: &Options) -> Vec<f64> {
        heights(mesh, self.height, half, options.placement.scale)
    }
}
