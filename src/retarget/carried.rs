//! How a part that swings is carried by what it hangs on.

use std::collections::VecDeque;
use std::rc::Rc;

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
        part: FigurePartId,
        path: &[DVec3],
        rotations: &Rotations,
        tracks: &mut Tracks,
        deviation: f64,
    ) -> Self {
        let own = &rig.parts[part];
        let joint = own.node.to_local(own.joint);
        let holder = held_by(rig, part).unwrap_or(part);
        let back = own.node.rotation.inverse();
        let [axis, down] = [own.tip - own.joint, DVec3::NEG_Y].map(|way| back * way);
        let above = tracks.of(rig, rotations, holder, path.len());
        let nodes = tracks.of(rig, rotations, part, path.len());
        let mut turns = Vec::with_capacity(path.len());
        let mut paths: [Vec<DVec3>; 6] = Default::default();
        for ((root, node), above) in path.iter().zip(&*nodes).zip(&*above) {
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

/// How many places of nodes are kept: a part that swings needs those of what it hangs on, which hangs on others that swing.
const MOST_KEPT: usize = 1 << 18;

/// The nodes of parts in all frames, with the root part's node at the origin. Of those that were needed last some are kept, so that
/// in a long chain none is found again for each part below it.
pub(super) struct Tracks {
    kinematics: ForwardKinematics,
    /// The oldest first.
    kept: VecDeque<(FigurePartId, Rc<[Transform]>)>,
}

impl Tracks {
    pub(super) fn new(rig: &Rig) -> Self {
        Self {
            kinematics: ForwardKinematics::new(rig),
            kept: VecDeque::new(),
        }
    }

    /// Forgets a part, which turns otherwise now.
    pub(super) fn forget(&mut self, part: FigurePartId) {
        self.kept.retain(|(kept, _)| *kept != part);
    }

    /// The nodes of a part.
    fn of(
        &mut self,
        rig: &Rig,
        rotations: &Rotations,
        part: FigurePartId,
        frames: usize,
    ) -> Rc<[Transform]> {
        let find = |part: FigurePartId| self.kept.iter().rev().find(|(kept, _)| *kept == part);
        let mut missing = vec![];
        let mut above = None;
        let mut next = Some(part);
        while let Some(part) = next {
            if let Some((_, track)) = find(part) {
                above = Some(Rc::clone(track));
                break;
            }
            missing.push(part);
            next = rig.parts[part].parent;
        }
        for missing in missing.into_iter().rev() {
            let node = |frame: usize| {
                let parent = above.as_ref().map(|above| above[frame]);
                (self.kinematics).placed(missing, rotations.at(missing, frame), parent)
            };
            let track: Rc<[Transform]> = (0..frames).map(node).collect();
            self.kept.push_back((missing, Rc::clone(&track)));
            while self.kept.len() > 2 && self.kept.len() * frames > MOST_KEPT {
                self.kept.pop_front();
            }
            above = Some(track);
        }
        above.unwrap_or_default()
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
