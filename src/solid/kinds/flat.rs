//! `flat`: the outline alone, like paper.

use glam::DVec2;

use super::{Faces, Kind};
use crate::solid::Options;
use crate::solid::layers::{Layer, finite};

/// The outline at one depth.
#[derive(Debug, Clone, PartialEq)]
pub struct Flat {
    z: f64,
}

impl Kind for Flat {
    fn new(numbers: &[f64], _: f64) -> Option<Self> {
        let &[z] = numbers else { return None };
        Some(Self { z })
    }

    fn numbers(&self) -> Vec<f64> {
        vec![self.z]
    }

    fn layers(&self, _: DVec2, _: &Options) -> Vec<Layer> {
        vec![Layer::whole(finite(self.z))]
    }

    fn faces(&self) -> Option<Faces> {
        let (depths, thickness) = ([None, Some(self.z)], None);
        Some(Faces { depths, thickness })
    }

    fn raise(&mut self, [_, front]: [f64; 2]) {
        self.z += front;
    }

    fn is_soft(&self) -> bool {
        false
    }

    fn is_open(&self) -> bool {
        true
    }
}
