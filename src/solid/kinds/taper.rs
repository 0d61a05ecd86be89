//! Straight walls between two depths: plates (`default`) and cones (`cone`, `conev`, `coneh`).

use glam::DVec2;

use super::{Faces, Kind};
use crate::geometry::Outline;
use crate::solid::Options;
use crate::solid::layers::{Layer, finite, overflows, scales, snap};

/// `default`: a plate with straight walls.
pub(super) type Default = Taper<false, false>;
/// `cone`: the outline scaled evenly from one depth to another.
pub(super) type Cone = Taper<true, true>;
/// `conev`: scaled across the axis.
pub(super) type ConeV = Taper<true, false>;
/// `coneh`: scaled along the axis.
pub(super) type ConeH = Taper<false, true>;

/// The outline in full size at one depth, scaled at another one, across the axis, along it or both; a plate if neither.
#[derive(Debug, Clone, PartialEq)]
pub struct Taper<const ACROSS: bool, const ALONG: bool> {
    /// The depth of the full size, and that of the scaled one.
    depths: [f64; 2],
    /// The size at the second depth over that at the first; 1 for a plate.
    top: f64,
}

impl Default {
    /// A plate that reaches as far to both sides, drawing units.
    pub(super) fn plate(reach: f64) -> Self {
        Self {
            depths: [-reach, reach],
            top: 1.0,
        }
    }
}

impl<const ACROSS: bool, const ALONG: bool> Kind for Taper<ACROSS, ALONG> {
    fn new(numbers: &[f64], plate: f64) -> Option<Self> {
        let (depths, top) = match (ACROSS || ALONG, numbers) {
            (false, []) => ([-plate, plate], 1.0),
            (false, &[z0, z1]) => ([z0, z1], 1.0),
            (true, &[z0, z1, top]) => ([z0, z1], top),
            _ => return None,
        };
        Some(Self { depths, top })
    }

    fn numbers(&self) -> Vec<f64> {
        vec![self.depths[0], self.depths[1], self.top]
    }

    fn layers(&self, _: DVec2, _: &Options) -> Vec<Layer> {
        let [z0, z] = self.depths.map(finite);
        let [across, along] = scales::<ACROSS, ALONG>(snap(finite(self.top)));
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

    fn is_soft(&self) -> bool {
        ACROSS || ALONG
    }

    fn overflows(&self, outline: &Outline) -> bool {
        overflows::<ACROSS, ALONG>(outline)
    }

    fn depends_on_axis(&self) -> bool {
        ACROSS != ALONG
    }
}
