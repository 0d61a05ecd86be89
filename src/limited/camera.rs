//! Motion as a camera sees it (Kitamura 5.4).

use crate::math;
use glam::{DMat3, DVec3};
use rayon::prelude::*;

/// Points that a thread processes at once.
const GRAIN: usize = 4096;
/// The least depth of a point, as a share of the camera's distance; points nearer to the camera, or behind it, are moved to
/// this depth.
const NEAREST: f64 = 0.01;

/// A camera that looks at the centre of a motion.
///
/// Axes: x to the right, y up, z towards a camera of yaw 0 and pitch 0, which looks along −z.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Camera {
    /// Its angle around the motion about y, degrees: at 90 it stands on the side of +x and looks along −x.
    pub yaw: f64,
    /// Its elevation, degrees: at 90 it looks straight down.
    pub pitch: f64,
    /// Its distance from the centre of the motion, in the positions' unit; `None` for an orthographic picture.
    pub distance: Option<f64>,
}

impl Camera {
    /// The positions in the camera's picture: x to the right, y up, z = 0, relative to the centre of the motion (of the
    /// bounding box of all finite positions). Lengths at the depth of the centre keep their size; in perspective, an object
    /// twice as far away appears half as large. A distance that is not a positive number counts as `None`, an angle that is not
    /// finite as 0.
    pub fn project(&self, positions: &[DVec3]) -> Vec<DVec3> {
        let [yaw, pitch] = [self.yaw, self.pitch].map(|angle| {
            if angle.is_finite() {
                (angle % 360.0).to_radians()
            } else {
                0.0
            }
        });
        // The camera's rotation undone: about y first, then about the picture's x.
        let turn =
            DMat3::from_quat(math::rotation_x(pitch)) * DMat3::from_quat(math::rotation_y(-yaw));
        let middle = middle(positions);
        let distance = self
            .distance
            .filter(|distance| *distance > 0.0 && distance.is_finite());
        let project = |position: &DVec3| {
            let point = turn * (*position - middle);
            let scale = distance.map_or(1.0, |distance| {
                distance / (distance - point.z).max(distance * NEAREST)
            });
            DVec3::new(point.x * scale, point.y * scale, 0.0)
        };
        positions
            .par_iter()
            .with_min_len(GRAIN)
            .map(project)
            .collect()
    }
}

fn middle(positions: &[DVec3]) -> DVec3 {
    let finite = positions.iter().filter(|position| position.is_finite());
    let corners = finite.fold(None, |corners, position| {
        let [low, high] = corners.unwrap_or([*position; 2]);
        Some([low.min(*position), high.max(*position)])
    });
    // Halved first, because the sum might be infinite.
    corners.map_or(DVec3::ZERO, |[low, high]: [DVec3; 2]| {
        low * 0.5 + high * 0.5
    })
}
