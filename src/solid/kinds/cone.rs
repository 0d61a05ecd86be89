//! `cone`: narrows both ways.

use glam::DVec2;

use super::taper::Taper;
use super::{Faces, Kind};
use crate::solid::Options;
use crate::solid::layers::Layer;

/// The outline scaled evenly from one depth to another.
#[derive(Debug, Clone, PartialEq)]
pub struct Cone(Taper);

impl Kind for Cone {
    fn new(numbers: &[f64], _: f64) -> Option<Self> {
        Taper::cone(numbers).map(Self)
    }

    fn numbers(&self) -> Vec<f64> {
        self.0.numbers()
    }

    fn layers(&self, _: DVec2, _: &Options) -> Vec<Layer> {
        self.0.layers(|top| [top, top])
    }

    fn faces(&self) -> Option<Faces> {
        Some(self.0.faces())
    }

    fn raise(&mut self, by: [f64; 2]) {
        self.0.raise(by);
    }
}
