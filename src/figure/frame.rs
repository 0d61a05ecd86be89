//! Local frames (paper, section 3.5; figure.md, Hierarchy and local frames).

use glam::{DAffine2, DVec2};

use crate::bind::Part;

/// A part's frame in the drawing plane, y up.
#[derive(Debug, Clone, Copy)]
pub(super) struct Frame {
    /// The joint.
    pub(super) origin: DVec2,
    /// The part's centre.
    pub(super) center: DVec2,
    /// By how much +Y is turned from the drawing's up, counter-clockwise, radians.
    pub(super) angle: f64,
}

/// A point of the drawing in a plane with y up.
pub(super) fn up(p: DVec2) -> DVec2 {
    DVec2::new(p.x, -p.y)
}

impl Frame {
    /// +Y leads along the axis from the joint to the far end; where the joint is the centre, up, or right when
    /// the axis is level.
    pub(super) fn of(part: &Part) -> Self {
        let origin = up(part.origin);
        let center = up(part.measure.center);
        let axis = up(part.measure.axis);
        let lead = axis.dot(center - origin);
        let level = axis.y.abs() < 1e-9;
        let upward = if level { axis.x < 0.0 } else { axis.y < 0.0 };
        let backward = if lead.abs() > 1e-9 * part.measure.half_along {
            lead < 0.0
        } else {
            upward
        };
        let y = if backward { -axis } else { axis };
        Self {
            origin,
            center,
            angle: (-y.x).atan2(y.y),
        }
    }

    /// A point of the plane in this frame.
    pub(super) fn to_local(self, p: DVec2) -> DVec2 {
        DVec2::from_angle(-self.angle).rotate(p - self.origin)
    }

    /// From the drawing, y down, to a frame turned like this one with the part's centre at its origin.
    pub(super) fn placing(self) -> DAffine2 {
        let flip = DAffine2::from_scale(DVec2::new(1.0, -1.0));
        DAffine2::from_angle(-self.angle) * DAffine2::from_translation(-self.center) * flip
    }
}
