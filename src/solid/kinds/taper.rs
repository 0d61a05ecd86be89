//! Straight walls between two depths, which plates and cones have in common.

use super::Faces;
use crate::solid::layers::{Layer, finite, snap};

/// The outline in full size at one depth and scaled at another one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Taper {
    /// The depth of the full size, and that of the scaled one.
    depths: [f64; 2],
    /// The size at the second depth over that at the first.
    top: f64,
}

impl Taper {
    /// A plate between two depths.
    pub(super) fn plate(depths: [f64; 2]) -> Self {
        Self { depths, top: 1.0 }
    }

    /// A cone from its numbers: two depths and the top.
    pub(super) fn cone(numbers: &[f64]) -> Option<Self> {
        match *numbers {
            [z0, z1, top] => Some(Self {
                depths: [z0, z1],
                top,
            }),
            _ => None,
        }
    }

    pub(super) fn numbers(&self) -> Vec<f64> {
        vec![self.depths[0], self.depths[1], self.top]
    }

    /// Two layers; `scale` gives the scales across and along the axis of the second.
    pub(super) fn layers(&self, scale: fn(f64) -> [f64; 2]) -> Vec<Layer> {
        let [z0, z1] = self.depths.map(finite);
        let [across, along] = scale(snap(finite(self.top)));
        vec![
            Layer::whole(z0),
            Layer {
                across,
                along,
                z: z1,
            },
        ]
    }

    /// A face at each depth, unless the solid ends there in a line or a point.
    pub(super) fn faces(&self) -> Faces {
        let [z0, z1] = self.depths;
        let top = self.top > 0.0;
        let (back, front) = if z0 <= z1 { (true, top) } else { (top, true) };
        Faces {
            depths: [back.then_some(z0.min(z1)), front.then_some(z0.max(z1))],
            thickness: Some((z1 - z0).abs()),
        }
    }

    pub(super) fn raise(&mut self, [back, front]: [f64; 2]) {
        let [z0, z1] = self.depths;
        self.depths = if z0 <= z1 {
            [z0 - back, z1 + front]
        } else {
            [z0 + front, z1 - back]
        };
    }
}
