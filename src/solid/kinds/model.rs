//! `model`: a plate in the place of a model that cannot be read.

use glam::DVec2;

use super::{Kind, taper};
use crate::solid::Options;
use crate::solid::layers::Layer;

/// A plate like that of `default`. Its faces move nothing, because a model's surface does not.
#[derive(Debug, Clone, PartialEq)]
pub struct Model(taper::Default);

impl Kind for Model {
    fn new(_: &[f64], plate: f64) -> Option<Self> {
        Kind::new(&[], plate).map(Self)
    }

    fn numbers(&self) -> Vec<f64> {
        self.0.numbers()
    }

    fn is_soft(&self) -> bool {
        false
    }

    fn layers(&self, half: DVec2, options: &Options) -> Vec<Layer> {
        self.0.layers(half, options)
    }
}
