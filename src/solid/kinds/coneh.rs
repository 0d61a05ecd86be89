//! `coneh`: narrows along the axis.

use glam::DVec2;

use super::taper::Taper;
use super::{Faces, Kind};
use crate::solid::Options;
use crate::solid::layers::Layer;

/// The outline scaled along its axis from one depth to another.
#[derive(Debug, Clone, PartialEq)]
pub struct ConeH(Taper);

impl Kind for ConeH {
    fn new(numbers: &[f64], _: f64) -> Option<Self> {
        Taper::cone(numbers).map(Self)
    }

    fn numbers(&self) -> Vec<f64> {
        self.0.numbers()
    }

    fn layers(&self, _: DVec2, _: &Options) -> Vec<Layer> {
        self.0.layers(|top| [1.0, top])
    }

    fn faces(&self) -> Option<Faces> {
        Some(self.0.faces())
    }

    fn raise(&mut self, by: [f64; 2]) {
        self.0.raise(by);
    }

    fn depends_on_axis(&self) -> bool {
        true
    }
}
