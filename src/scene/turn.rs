//! Characters that turn with the viewer.

use glam::{DVec2, DVec3};
use typed_index_collections::{TiSlice, TiVec};

use crate::index::index_type;
use crate::math;

index_type!(
    /// Counts the views of a character.
    pub ViewId
);

impl ViewId {
    /// The view that a character is modelled in: morph targets are differences from it.
    pub const FIRST: Self = Self(0);
    /// The view after the first.
    #[cfg(test)]
    pub(crate) const SECOND: Self = Self(1);
}

/// The views of a character that turns, and what lies between them.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Turn {
    /// The directions of the views, degrees: around the upright axis towards the character's left (+x), and up. At the first the
    /// weights of all morph targets are 0; target i belongs to view i + 1.
    pub views: TiVec<ViewId, [f64; 2]>,
    /// Sets of one to three views; between the views of a set their weights are linear. A viewer outside of all sees the nearest
    /// position in one of them.
    pub between: Vec<Vec<ViewId>>,
}

/// The axes of a viewer in a direction, degrees: the screen's right and up, and towards the viewer, as unit vectors of the
/// character's space (x its left, y up, z its front).
pub fn view_axes([theta, phi]: [f64; 2]) -> [DVec3; 3] {
    let (st, ct) = math::sin_cos(theta.to_radians());
    let (sp, cp) = math::sin_cos(phi.to_radians());
    [
        DVec3::new(ct, 0.0, -st),
        DVec3::new(-st * sp, cp, -ct * sp),
        DVec3::new(st * cp, sp, ct * cp),
    ]
}

/// The direction of a unit vector towards the viewer, degrees.
pub fn direction(towards: DVec3) -> [f64; 2] {
    let theta = math::atan2(towards.x, towards.z);
    [theta, math::asin(towards.y.clamp(-1.0, 1.0))].map(f64::to_degrees)
}

impl Turn {
    /// What depths towards the viewer are multiplied by. Depths only decide what is in front: as they are, perspective would move
    /// the regions of a drawing apart.
    pub const FLATNESS: f64 = 0.25;
    /// Programs have to read so many views.
    pub const MOST_VIEWS: usize = 256;

    /// The weight of each view from a direction, degrees; they add up to 1.
    pub fn weights(&self, [theta, phi]: [f64; 2]) -> TiVec<ViewId, f64> {
        let none = || TiVec::from(vec![0.0; self.views.len()]);
        let mut best = (f64::INFINITY, none());
        for set in &self.between {
            let Some(corners) = self.corners(set) else {
                continue;
            };
            for turns in [-360.0, 0.0, 360.0] {
                let point = DVec2::new(theta + turns, phi);
                let shares = nearest(&corners, point);
                let position: DVec2 = corners.iter().zip(&shares).map(|(c, s)| *c * *s).sum();
                let distance = position.distance_squared(point);
                if distance < best.0 {
                    let mut weights = none();
                    for (view, share) in set.iter().zip(shares) {
                        weights[*view] += share;
                    }
                    best = (distance, weights);
                }
            }
        }
        best.1
    }

    /// Where a region is for a viewer, in the frame of a screen that faces the viewer: right, up and towards the viewer.
    /// `positions` are its positions in the views, in the character's space.
    pub fn position(
        &self,
        weights: &TiSlice<ViewId, f64>,
        positions: &TiSlice<ViewId, DVec3>,
    ) -> DVec3 {
        let (mut direction, mut point, mut depth) = ([0.0; 2], DVec3::ZERO, 0.0);
        let greatest = weights
            .iter()
            .zip(&self.views)
            .max_by(|a, b| a.0.total_cmp(b.0));
        let near = greatest.map_or(0.0, |(_, view)| view[0]);
        for ((view, weight), position) in self.views.iter().zip(weights).zip(positions) {
            let [_, _, towards] = view_axes(*view);
            direction[0] += weight * (near + short_way(view[0] - near));
            direction[1] += weight * view[1];
            point += *weight * *position;
            depth += weight * position.dot(towards);
        }
        let [right, up, _] = view_axes(direction);
        DVec3::new(point.dot(right), point.dot(up), Self::FLATNESS * depth)
    }

    /// The views of a set in the plane of angles, the short way around from the first; `None` if one is missing.
    pub(crate) fn corners(&self, set: &[ViewId]) -> Option<Vec<DVec2>> {
        let first = short_way(self.views.get(*set.first()?)?[0]);
        let corner = |view: &ViewId| {
            let [theta, phi] = *self.views.get(*view)?;
            Some(DVec2::new(first + short_way(theta - first), phi))
        };
        set.iter().map(corner).collect()
    }
}

/// An angle between −180 and 180.
fn short_way(degrees: f64) -> f64 {
    (degrees + 180.0).rem_euclid(360.0) - 180.0
}

/// The shares of one to three corners at the point of the line or triangle between them that is nearest to a point.
fn nearest(corners: &[DVec2], point: DVec2) -> Vec<f64> {
    match corners {
        [a, b] => {
            let along = *b - *a;
            let share = (point - *a).dot(along) / along.length_squared();
            let share = if share.is_finite() {
                share.clamp(0.0, 1.0)
            } else {
                0.0
            };
            vec![1.0 - share, share]
        }
        [a, b, c] => {
            let whole = (*b - *a).perp_dot(*c - *a);
            let shares = [[b, c], [c, a], [a, b]].map(|[from, to]| {
                let part = (*to - *from).perp_dot(point - *from) / whole;
                if part.is_finite() { part } else { -1.0 }
            });
            if shares.iter().all(|share| *share >= 0.0) {
                return shares.to_vec();
            }
            let sides = [[0, 1], [1, 2], [2, 0]].map(|[i, j]| {
                let side = nearest(&[corners[i], corners[j]], point);
                let position = corners[i] * side[0] + corners[j] * side[1];
                let mut shares = vec![0.0; 3];
                (shares[i], shares[j]) = (side[0], side[1]);
                (position.distance_squared(point), shares)
            });
            let best = sides.into_iter().min_by(|a, b| a.0.total_cmp(&b.0));
            best.map_or_else(Vec::new, |(_, shares)| shares)
        }
        corners => (0..corners.len())
            .map(|i| f64::from(u8::from(i == 0)))
            .collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn turn(views: &[[f64; 2]], between: &[&[usize]]) -> Turn {
        Turn {
            views: views.to_vec().into(),
            between: between
                .iter()
                .map(|set| set.iter().copied().map(ViewId::from).collect())
                .collect(),
        }
    }

    fn close(found: &TiSlice<ViewId, f64>, expected: &[f64]) {
        let mut pairs = found.iter().zip(expected);
        let near = pairs.all(|(a, b)| (a - b).abs() < 1e-12);
        assert!(
            near && found.len() == expected.len(),
            "{found:?} for {expected:?}"
        );
    }

    #[test]
    fn weights_are_linear_between_views_and_clamped_outside() {
        let pair = turn(&[[0.0, 0.0], [45.0, 0.0]], &[&[0, 1]]);
        close(&pair.weights([22.5, 0.0]), &[0.5, 0.5]);
        close(&pair.weights([-30.0, 10.0]), &[1.0, 0.0]);
        close(&pair.weights([90.0, -80.0]), &[0.0, 1.0]);
        // From the other side, the nearer end.
        close(&pair.weights([-170.0, 0.0]), &[0.0, 1.0]);
        let round = turn(
            &[[0.0, 0.0], [90.0, 0.0], [180.0, 0.0], [270.0, 0.0]],
            &[&[0, 1], &[1, 2], &[2, 3], &[3, 0]],
        );
        close(&round.weights([-45.0, 0.0]), &[0.5, 0.0, 0.0, 0.5]);
        close(&round.weights([-135.0, 5.0]), &[0.0, 0.0, 0.5, 0.5]);
        let three = turn(&[[0.0, 0.0], [45.0, 0.0], [0.0, 30.0]], &[&[0, 1, 2]]);
        close(&three.weights([0.0, 0.0]), &[1.0, 0.0, 0.0]);
        close(&three.weights([15.0, 10.0]), &[1.0 / 3.0; 3]);
        close(&three.weights([-20.0, 15.0]), &[0.5, 0.0, 0.5]);
        assert!(turn(&[], &[]).weights([0.0, 0.0]).is_empty());
    }

    #[test]
    fn a_region_is_where_it_was_drawn() {
        let pair = turn(&[[0.0, 0.0], [45.0, 10.0]], &[&[0, 1]]);
        for (index, view) in pair.views.iter_enumerated() {
            let [right, up, towards] = view_axes(*view);
            let positions = [DVec3::new(3.0, 2.0, 1.0), DVec3::new(2.5, 2.0, 0.5)];
            let positions = TiVec::from(positions.to_vec());
            let found = pair.position(&pair.weights(*view), &positions);
            let position = positions[index];
            let seen = DVec3::new(
                position.dot(right),
                position.dot(up),
                Turn::FLATNESS * position.dot(towards),
            );
            assert!(found.distance(seen) < 1e-12, "{found} {seen}");
            let back = direction(towards);
            assert!((back[0] - view[0]).abs() + (back[1] - view[1]).abs() < 1e-9);
        }
    }
}
