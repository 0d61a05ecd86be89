//! How a part that swings is carried by what it hangs on.

use glam::{DQuat, DVec3};

use super::Rig;
use super::kinematics::ForwardKinematics;
use super::rotations::Rotations;
use super::spline::Spline;
use crate::labels::FigurePartId;
use crate::mocap::Transform;
use crate::smoothing::smoothed;

/// How a part would be without swinging, at a moment. All directions are those of the drawing's axes.
#[derive(Debug, Clone, Copy)]
pub(super) struct Carriage {
    /// The velocity of its joint, drawing units a frame.
    pub(super) velocity: DVec3,
    /// From its joint to its far end.
    pub(super) aim: DVec3,
    /// Where the direction points that is down in the drawing.
    pub(super) down: DVec3,
    /// The node of what it hangs on, relative to its joint; for a bone, of what the whole part hangs on.
    pub(super) above: Transform,
}

/// A part frame by frame.
pub(super) struct Carried {
    /// The rotations of its node.
    pub(super) rotations: Vec<DQuat>,
    exact: Paths,
    smooth: Paths,
}

/// The paths of joint, aim and down, of the node above, and of two of its axes.
struct Paths([Vec<DVec3>; 6]);

impl Carried {
    /// The part of a rig whose root part's node is at these places. Paths are smoothed by a Gaussian of this deviation, in frames.
    pub(super) fn of(
        rig: &Rig,
        order: &[FigurePartId],
        part: FigurePartId,
        path: &[DVec3],
        rotations: &Rotations,
        deviation: f64,
    ) -> Self {
        let own = &rig.parts[part];
        let joint = own.node.to_local(own.joint);
        let holder = held_by(rig, part).unwrap_or(part);
        let back = own.node.rotation.inverse();
        let [axis, down] = [own.tip - own.joint, DVec3::NEG_Y].map(|way| back * way);
        let mut kinematics = ForwardKinematics::new(rig);
        let mut turns = Vec::with_capacity(path.len());
        let mut paths: [Vec<DVec3>; 6] = Default::default();
        for (frame, root) in path.iter().enumerate() {
            kinematics.pose(rig, rotations, order, frame);
            let node = kinematics.transforms[part];
            let above = kinematics.transforms[holder];
            let place = node.apply(joint);
            let points = [
                place + *root,
                node.rotation * axis,
                node.rotation * down,
                above.position - place,
                above.rotation * DVec3::X,
                above.rotation * DVec3::Y,
            ];
            for (path, point) in paths.iter_mut().zip(points) {
                path.push(point);
            }
            turns.push(node.rotation);
        }
        Self {
            rotations: turns,
            smooth: Paths(paths.each_ref().map(|path| smoothed(path, deviation))),
            exact: Paths(paths),
        }
    }

    /// The part in a frame, without velocity.
    pub(super) fn at(&self, frame: usize) -> Carriage {
        carriage(self.exact.0.each_ref().map(|path| path[frame]), DVec3::ZERO)
    }

    /// The part at moments after the frame before a frame, by their shares of the time between the two. Its paths are smooth, and
    /// curved between frames: they have no kinks, whatever the frame rate.
    pub(super) fn between(&self, frame: usize) -> impl Fn(f64) -> Carriage {
        let splines = self.smooth.0.each_ref().map(|path| Spline::of(path, frame));
        move |share| {
            let points = splines.each_ref().map(|spline| spline.position(share));
            carriage(points, splines[0].velocity(share))
        }
    }
}

/// What a part hangs on; for a bone, what the whole part hangs on.
pub(super) fn held_by(rig: &Rig, part: FigurePartId) -> Option<FigurePartId> {
    rig.parts[rig.parts[part].inside.unwrap_or(part)].parent
}

/// What the points of [`Paths`] say.
fn carriage([_, aim, down, above, x, y]: [DVec3; 6], velocity: DVec3) -> Carriage {
    let x = x.normalize_or(DVec3::X);
    let y = y.reject_from_normalized(x);
    let y = y
        .try_normalize()
        .unwrap_or_else(|| x.any_orthonormal_vector());
    Carriage {
        velocity,
        aim,
        down,
        above: Transform {
            rotation: DQuat::from_mat3(&glam::DMat3::from_cols(x, y, x.cross(y))),
            position: above,
        },
    }
}
