//! The point nearest to several rays.

use glam::{DMat3, DVec2, DVec3};

use crate::billboard::region::Direction;
use crate::math;

/// Directions closer than this tell no depth, degrees.
const LEAST_ANGLE: f64 = 0.5;

/// The angle between two directions, degrees.
pub(crate) fn angle(a: Direction, b: Direction) -> f64 {
    let (a, b) = (a.axes()[2], b.axes()[2]);
    math::atan2(a.cross(b).length(), a.dot(b)).to_degrees()
}

/// The point of a view's screen, at a depth towards the viewer, in the character's space.
pub(crate) fn on_ray(direction: Direction, at: DVec2, depth: f64) -> DVec3 {
    let [right, up, toward] = direction.axes();
    right * at.x + up * at.y + toward * depth
}

/// The point with the least sum of squared distances to the rays through `at` along each direction:
/// [Σ(I − d dᵀ)]⁻¹ Σ(x·r + y·u). This is the fixed point of the thesis' Algorithm 1. `None` if all rays are parallel to within
/// half a degree.
pub(crate) fn nearest_to_rays(rays: &[(Direction, DVec2)]) -> Option<DVec3> {
    let (first, _) = rays.first()?;
    // Opposite directions are parallel, too.
    let spread = |(d, _): &(Direction, DVec2)| {
        let between = angle(*first, *d);
        between.min(180.0 - between)
    };
    if !rays.iter().any(|ray| spread(ray) > LEAST_ANGLE) {
        return None;
    }
    let (mut matrix, mut sum) = (DMat3::ZERO, DVec3::ZERO);
    for (direction, at) in rays {
        let toward = direction.axes()[2];
        matrix += DMat3::IDENTITY
            - DMat3::from_cols(toward * toward.x, toward * toward.y, toward * toward.z);
        sum += on_ray(*direction, *at, 0.0);
    }
    let point = matrix.inverse() * sum;
    point.is_finite().then_some(point)
}
