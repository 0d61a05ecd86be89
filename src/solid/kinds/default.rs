//! `default`: a plate with straight walls.

use glam::DVec2;

use super::taper::{Both, Taper};
use super::{Faces, Kind};
use crate::solid::Options;
use crate::solid::layers::Layer;

/// A plate between two depths.
#[derive(Debug, Clone, PartialEq)]
pub struct Default(Taper<Both>);

impl Kind for Default {
    fn new(numbers: &[f64], plate: f64) -> Option<Self> {
        match *numbers {
            [] => Some(Self(Taper::plate([-plate, plate]))),
            [z0, z1] => Some(Self(Taper::plate([z0, z1]))),
            _ => None,
        }
    }

    fn numbers(&self) -> Vec<f64> {
        self.0.numbers()
    }

    fn layers(&self, half: DVec2, options: &Options) -> Vec<Layer> {
        self.0.layers(half, options)
    }

    fn faces(&self) -> Option<Faces> {
        self.0.faces()
    }

    fn raise(&mut self, by: [f64; 2]) {
        self.0.raise(by);
    }
}
