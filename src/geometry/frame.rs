//! Local frames of parts (paper, section 3.5; figure.md, Hierarchy and local frames).

use glam::{DAffine2, DVec2};

use super::Measure;

/// A part's frame in the drawing plane, y up.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Frame {
    /// The joint.
    pub origin: DVec2,
    /// The part's centre.
    pub center: DVec2,
    /// By how much +Y is turned from the drawing's up, counter-clockwise, radians.
    pub angle: f64,
}

/// A point of the drawing in a plane with y up.
pub fn y_up(point: DVec2) -> DVec2 {
    DVec2::new(point.x, -point.y)
}

impl Frame {
    /// The frame of a part whose joint is at `origin`. +Y leads along the axis from the joint to the far end; where the joint is
    /// the centre, up, or right when the axis is level.
    pub fn new(measure: &Measure, origin: DVec2) -> Self {
        let origin = y_up(origin);
        let center = y_up(measure.center);
        let axis = y_up(measure.axis);
        let lead = axis.dot(center - origin);
        let level = axis.y.abs() < 1e-9;
        let upward = if level { axis.x < 0.0 } else { axis.y < 0.0 };
        let backward = if lead.abs() > 1e-9 * measure.half_along {
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
    pub fn to_local(&self, point: DVec2) -> DVec2 {
        DVec2::from_angle(-self.angle).rotate(point - self.origin)
    }

    /// From the drawing, y down, to axes turned like this frame's with the part's centre at the origin.
    pub fn from_drawing_about_center(&self) -> DAffine2 {
        let flip = DAffine2::from_scale(DVec2::new(1.0, -1.0));
        DAffine2::from_angle(-self.angle) * DAffine2::from_translation(-self.center) * flip
    }
}
