//! Smooth and sharp edges: which faces around a point share a corner with a common normal.

use crate::math;
use glam::DVec3;

/// The crease angle, below which edges are smooth.
#[derive(Clone, Copy)]
pub(super) struct Crease {
    /// Edges are smooth if the cosine between the normals is greater.
    cosine: f64,
}

impl Crease {
    pub(super) fn new(degrees: f64) -> Crease {
        let degrees = if degrees.is_finite() {
            degrees.clamp(0.0, 180.0)
        } else {
            0.0
        };
        // A cosine above 1 makes nothing smooth, not even coplanar faces.
        let cosine = if degrees > 0.0 {
            math::cos(degrees.to_radians())
        } else {
            2.0
        };
        Crease { cosine }
    }

    /// Whether an edge is smooth whose faces' normals have this cosine.
    pub(super) fn is_smooth(self, cosine: f64) -> bool {
        cosine > self.cosine
    }

    /// Whether edges of right angles are smooth, or nearly.
    pub(super) fn spans_right_angles(self) -> bool {
        self.cosine < 1e-3
    }

    fn smooth(self, a: DVec3, b: DVec3) -> bool {
        self.is_smooth(a.dot(b))
    }
}

/// Assigns corners to the faces around a point. `faces` are unit normals in order around the
/// point, each sharing an edge with the next and the last with the first; `corner` makes a corner
/// from a unit normal; `out` receives the corner of every face.
pub(super) fn share(
    faces: &[DVec3],
    weights: &[f64],
    crease: Crease,
    mut corner: impl FnMut(DVec3) -> u32,
    out: &mut [u32],
) {
    let n = faces.len();
    let first = (0..n).find(|&i| !crease.smooth(faces[(i + n - 1) % n], faces[i]));
    let start = first.unwrap_or(0);
    let mut k = 0;
    while k < n {
        let mut sum = DVec3::ZERO;
        let mut end = k;
        loop {
            let i = (start + end) % n;
            sum += faces[i] * weights[i];
            end += 1;
            if end == n || !crease.smooth(faces[i], faces[(start + end) % n]) {
                break;
            }
        }
        let normal = sum.normalize_or(faces[(start + k) % n]);
        let id = corner(normal);
        for i in k..end {
            out[(start + i) % n] = id;
        }
        k = end;
    }
}

/// The same for the tip of a cone: if the faces differ too much for one normal, each gets its own
/// corner.
pub(super) fn share_tip(
    faces: &[DVec3],
    weights: &[f64],
    crease: Crease,
    mut corner: impl FnMut(DVec3) -> u32,
    out: &mut [u32],
) {
    let mut sum = DVec3::ZERO;
    for (face, weight) in faces.iter().zip(weights) {
        sum += *face * *weight;
    }
    let mean = sum.normalize_or_zero();
    if faces.iter().all(|face| crease.smooth(*face, mean)) {
        out.fill(corner(mean));
    } else {
        for (face, out) in faces.iter().zip(out) {
            *out = corner(*face);
        }
    }
}
