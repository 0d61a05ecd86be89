//! Curves through the points of a path, between its frames.

use glam::DVec3;

/// A Catmull-Rom spline from the frame before to a frame, by the coefficients of its powers of the share of the way.
pub(super) struct Spline([DVec3; 4]);

impl Spline {
    /// The spline to a frame, which is not the first one.
    pub(super) fn of(path: &[DVec3], frame: usize) -> Self {
        let [b, c] = [path[frame - 1], path[frame]];
        // Beyond the ends it goes on as it came.
        let a = if frame > 1 {
            path[frame - 2]
        } else {
            b * 2.0 - c
        };
        let d = path.get(frame + 1).copied().unwrap_or(c * 2.0 - b);
        Self([
            b,
            (c - a) / 2.0,
            a - b * 2.5 + c * 2.0 - d / 2.0,
            (b - c) * 1.5 + (d - a) / 2.0,
        ])
    }

    /// The point at a share of the time between the frames.
    pub(super) fn position(&self, share: f64) -> DVec3 {
        let [still, linear, square, cubic] = self.0;
        still + (linear + (square + cubic * share) * share) * share
    }

    /// The velocity there, per frame.
    pub(super) fn velocity(&self, share: f64) -> DVec3 {
        let [_, linear, square, cubic] = self.0;
        linear + (square * 2.0 + cubic * (3.0 * share)) * share
    }
}
