//! Straight walls between two depths: plates and cones.

use std::fmt::Debug;
use std::marker::PhantomData;

use glam::DVec2;

use super::{Faces, Kind};
use crate::solid::Options;
use crate::solid::layers::{Layer, finite, snap};

/// The outline in full size at one depth, scaled at another one.
#[derive(Debug, Clone, PartialEq)]
pub struct Taper<S> {
    /// The depth of the full size, and that of the scaled one.
    depths: [f64; 2],
    /// The size at the second depth over that at the first.
    top: f64,
    direction: PhantomData<S>,
}

/// The direction in which a taper scales the outline.
pub trait Direction: Debug {
    /// The scales across and along the axis for the size at the top.
    fn scales(top: f64) -> [f64; 2];
}

/// Both ways.
#[derive(Debug, Clone, PartialEq)]
pub struct Both;

impl Direction for Both {
    fn scales(top: f64) -> [f64; 2] {
        [top, top]
    }
}

impl<S> Taper<S> {
    /// A plate between two depths.
    pub(super) fn plate(depths: [f64; 2]) -> Self {
        Self {
            depths,
            top: 1.0,
            direction: PhantomData,
        }
    }
}

impl<S: Direction> Kind for Taper<S> {
    fn new(numbers: &[f64], _: f64) -> Option<Self> {
        match *numbers {
            [z0, z1, top] => Some(Self {
                top,
                ..Self::plate([z0, z1])
            }),
            _ => None,
        }
    }

    fn numbers(&self) -> Vec<f64> {
        vec![self.depths[0], self.depths[1], self.top]
    }

    fn layers(&self, _: DVec2, _: &Options) -> Vec<Layer> {
        let [z0, z] = self.depths.map(finite);
        let [across, along] = S::scales(snap(finite(self.top)));
        vec![Layer::whole(z0), Layer { across, along, z }]
    }

    /// A face at each depth, unless the solid ends there in a line or a point.
    fn faces(&self) -> Option<Faces> {
        let [z0, z1] = self.depths;
        let top = self.top > 0.0;
        let (back, front) = if z0 <= z1 { (true, top) } else { (top, true) };
        Some(Faces {
            depths: [back.then_some(z0.min(z1)), front.then_some(z0.max(z1))],
            thickness: Some((z1 - z0).abs()),
        })
    }

    fn raise(&mut self, [back, front]: [f64; 2]) {
        let [z0, z1] = self.depths;
        self.depths = if z0 <= z1 {
            [z0 - back, z1 + front]
        } else {
            [z0 + front, z1 - back]
        };
    }

    fn depends_on_axis(&self) -> bool {
        let [across, along] = S::scales(0.0);
        across != along
    }
}
