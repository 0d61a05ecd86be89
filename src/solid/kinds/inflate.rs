//! `inflate`: blown up like a balloon.

use glam::DVec2;

use super::Kind;
use crate::geometry::Outline;
use crate::scene::Surface;
use crate::solid::Options;
use crate::solid::inflate::{height, inflate};

/// A height field to both sides.
#[derive(Debug, Clone, PartialEq)]
pub struct Inflate {
    /// The height of the highest point; see [`inflate`] for what it is if not given.
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
        inflate(outline, self.height, half, options)
    }

    fn depths(&self, half: DVec2, _: &Options) -> Option<[f64; 2]> {
        let height = height(self.height, half);
        Some([-height, height])
    }
}
