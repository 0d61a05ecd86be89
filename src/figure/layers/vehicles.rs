//! Vehicles that are drawn from the side, which are the same on their far side: the bodies reach as far to the back as to the front,
//! and the wheels stand at both sides of them.

use super::overlaps::Overlap;
use super::shapes::Shape;
use super::{Cover, Reason};
use crate::bind::VehiclePart;

/// From this share on, what is drawn later hides a wheel, which therefore does not stand out of the body.
const HIDDEN: f64 = 0.05;
/// How much of its thickness a wheel stands out of the body otherwise.
const STANDS_OUT: f64 = 0.5;
/// How far a wheel stays behind the side of a body that hides it, in thicknesses.
const BEHIND: f64 = 0.05;
/// A disc that lies on others for this share of its area is a hub, not a wheel.
const HUB: f64 = 0.9;

/// Moves wheels to the near side of their vehicles. `is_detail` says per shape whether it lies on others; wheels do not, even if
/// they are drawn within a body.
pub(super) fn place_wheels(
    shapes: &mut [Shape],
    overlaps: &[Vec<Overlap>],
    is_detail: &mut [bool],
) {
    if !shapes.iter().any(Shape::is_wheel) {
        return;
    }
    let mut hidden = vec![0.0; shapes.len()];
    for (above, below) in overlaps.iter().enumerate() {
        let hides = !is_detail[above] && !shapes[above].is_wheel();
        for overlap in below.iter().filter(|_| hides) {
            hidden[overlap.below] += overlap.area;
        }
        let on_wheels = below
            .iter()
            .filter(|overlap| shapes[overlap.below].is_wheel());
        let on_wheels: f64 = on_wheels.map(|overlap| overlap.area).sum();
        let shape = &shapes[above];
        if shape.is_wheel() && !shape.is_ink {
            is_detail[above] = on_wheels >= HUB * shape.area;
        }
    }
    for (shape, hidden) in shapes.iter_mut().zip(hidden) {
        if let Some(VehiclePart::Wheel { half, beside }) = shape.of_vehicle {
            let by = if hidden >= HIDDEN * shape.area {
                -BEHIND
            } else {
                STANDS_OUT
            };
            shape.offset += beside + (2.0 * by - 1.0) * half;
        }
    }
}

/// Per shape whether it is a detail that lies on a wheel.
pub(super) fn on_wheels(
    shapes: &[Shape],
    covers: &[Cover],
    overlaps: &[Vec<Overlap>],
) -> Vec<bool> {
    let is_on_wheel = |(cover, below): (&Cover, &Vec<Overlap>)| {
        let mut below = below.iter();
        cover.is_detail && below.any(|overlap| shapes[overlap.below].is_wheel())
    };
    covers.iter().zip(overlaps).map(is_on_wheel).collect()
}

/// Why a node of a vehicle lies in the plane of what it hangs on; `None` for other nodes.
pub(super) fn reason(shape: &Shape) -> Option<Reason> {
    Some(match shape.of_vehicle? {
        VehiclePart::Body { .. } => Reason::Vehicle,
        VehiclePart::Wheel { .. } if shape.is_near => Reason::Plane,
        VehiclePart::Wheel { .. } => Reason::Wheel,
        VehiclePart::MiddleWheel { .. } => Reason::MiddleWheel,
    })
}
