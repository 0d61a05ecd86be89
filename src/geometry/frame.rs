//! Local frames of parts (Arai & Horry, section 3.5).

use crate::math;
use glam::{DAffine2, DVec2};

use super::Measure;

/// A part's frame in the drawing plane, y up.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Frame {
    /// The joint.
    pub origin: DVec2,
    /// The part's centre.
    pub center: DVec2,
    /// By how much +Y is turned from the drawing's up, counter-clockwise, radians.
    pub angle: f64,
}

/// A point of the drawing in a plane with y up.
pub(crate) fn y_up(point: DVec2) -> DVec2 {
    DVec2::new(point.x, -point.y)
}

impl Frame {
    /// The frame of a part whose joint is at `origin`. +Y leads along the axis from the joint to the far end; where the joint is
    /// the centre, up, or right when the axis is level.
    pub(crate) fn new(measure: &Measure, origin: DVec2) -> Self {
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
            angle: math::atan2(-y.x, y.y),
        }
    }

    /// The frame of what stands upright on a point of the drawing.
    pub(crate) fn upright(foot: DVec2) -> Self {
        let origin = y_up(foot);
        Self {
            origin,
            center: origin,
            angle: 0.0,
        }
    }

    /// A point of the plane in this frame.
    pub(crate) fn to_local(self, point: DVec2) -> DVec2 {
        math::direction(-self.angle).rotate(point - self.origin)
    }

    /// The map from the plane to this frame.
    pub(crate) fn plane_to_local(self) -> DAffine2 {
        DAffine2::from_mat2(math::rotation(-self.angle)) * DAffine2::from_translation(-self.origin)
    }

    /// The map from the drawing, y down, to axes turned like this frame's with the part's centre at the origin.
    pub(crate) fn drawing_about_center(self) -> DAffine2 {
        let flip = DAffine2::from_scale(DVec2::new(1.0, -1.0));
        DAffine2::from_mat2(math::rotation(-self.angle))
            * DAffine2::from_translation(-self.center)
            * flip
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A part of 20 by 10 along an axis, y down, with its centre at 50, 50.
    fn measure(axis: DVec2) -> Measure {
        let center = DVec2::new(50.0, 50.0);
        Measure {
            center,
            axis,
            ends: [center - axis * 10.0, center + axis * 10.0],
            half_along: 10.0,
            half_across: 5.0,
            bounds: (center - 10.0, center + 10.0),
            certain: true,
        }
    }

    #[test]
    fn y_leads_from_the_joint_to_the_far_end() {
        let right = measure(DVec2::X);
        for (joint, angle) in [(40.0, -90.0_f64), (60.0, 90.0)] {
            let frame = Frame::new(&right, DVec2::new(joint, 50.0));
            assert!((frame.angle.to_degrees() - angle).abs() < 1e-9, "{frame:?}");
            let far = frame.to_local(DVec2::new(100.0 - joint, -50.0));
            assert!(far.distance(DVec2::new(0.0, 20.0)) < 1e-9, "{far}");
        }
    }

    #[test]
    fn y_leads_up_or_right_where_the_joint_is_the_center() {
        let center = DVec2::new(50.0, 50.0);
        for axis in [DVec2::Y, -DVec2::Y] {
            assert!(Frame::new(&measure(axis), center).angle.abs() < 1e-9);
        }
        for axis in [DVec2::X, -DVec2::X] {
            let angle = Frame::new(&measure(axis), center).angle.to_degrees();
            assert!((angle + 90.0).abs() < 1e-9, "{angle}");
        }
    }

    #[test]
    fn the_drawing_is_turned_about_the_center() {
        let frame = Frame::new(&measure(DVec2::X), DVec2::new(40.0, 50.0));
        let to_frame = frame.drawing_about_center();
        let [center, far] = [50.0, 60.0].map(|x| to_frame.transform_point2(DVec2::new(x, 50.0)));
        assert!(center.length() < 1e-9 && far.distance(DVec2::new(0.0, 10.0)) < 1e-9);
    }
}
