//! Retargets a clip to a figure: which joint drives which part, how parts turn, and where the figure goes.
//!
//! All results are in the drawing's axes: x to the drawing's right, y up, z towards the viewer, in the figure's unit. The body
//! axes of the clip's first frame are mapped to them, so the figure starts in the direction in which it is drawn.

mod axes;
mod carried;
mod contacts;
mod ground;
mod joined;
mod kinematics;
mod legs;
mod matching;
mod planting;
mod rest_pose;
mod room;
mod root_motion;
mod rotations;
mod soles;
mod splayed;
mod spline;
mod stance;
mod stepping;
mod swing;
mod turns;

use std::sync::Arc;

use glam::{DQuat, DVec3};
use typed_index_collections::{TiSlice, TiVec, ti_vec};

use crate::labels::{Facing, FigurePartId};
use crate::mocap::{Clip, JointId, Pose, Transform};

pub use axes::Landmarks;
pub(crate) use joined::{Turn, joined};
pub use matching::{Drive, Follow};
pub(crate) use matching::{MatchedPart, Matching, Problem, bent_arms, joints_named, match_figure};
pub use rest_pose::RestSource;
pub use turns::Turns;

/// A figure as motion sees it: its nodes at rest, and the joints that drive them.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Rig {
    /// The parts, in any order.
    pub parts: TiVec<FigurePartId, RigPart>,
    /// The direction that it faces.
    pub facing: Facing,
}

impl Rig {
    /// The parts, parents before children; those in cycles are missing.
    pub(crate) fn order(&self) -> Vec<FigurePartId> {
        let count = self.parts.len();
        let mut children = ti_vec![Vec::new(); count];
        let mut order: Vec<FigurePartId> = Vec::with_capacity(count);
        for (index, part) in self.parts.iter_enumerated() {
            match part.parent {
                Some(parent) => children[parent].push(index),
                None => order.push(index),
            }
        }
        let mut next = 0;
        while let Some(part) = order.get(next) {
            order.extend_from_slice(&children[*part]);
            next += 1;
        }
        order
    }

    /// Whether a part is another one, or hangs on it.
    pub(crate) fn is_below(&self, part: FigurePartId, top: FigurePartId) -> bool {
        let above = |part: &FigurePartId| self.parts[*part].parent;
        let mut ways = std::iter::successors(Some(part), above).take(self.parts.len());
        ways.any(|part| part == top)
    }
}

/// A part of a rig.
#[derive(Debug, Clone, PartialEq)]
pub struct RigPart {
    /// Its parent. One part has none: the root, whose travel is the figure's.
    pub parent: Option<FigurePartId>,
    /// Whether its node is a child of the model's root and not of its parent's node: parts that are connected only because they
    /// touch.
    pub is_rooted: bool,
    /// Its node at rest.
    pub node: Transform,
    /// Where it turns. The node of a rooted part is elsewhere, in the middle of the part.
    pub joint: DVec3,
    /// Its far end.
    pub tip: DVec3,
    /// Points around its surface and around what moves with it, which the ground holds up.
    pub surface: Vec<DVec3>,
    /// Points around its own solid, if it is a piece of an arm that makes room, or a part of the trunk, of which that stays out.
    pub outline: Vec<DVec3>,
    /// Whether it is a piece of such an arm.
    pub is_arm: bool,
    /// Whether it is the end of a leg, on which the figure stands.
    pub stands: bool,
    /// The joint that drives it.
    pub drive: Option<Drive>,
    /// Whether it belongs to a leg and follows a bone or chain.
    pub is_leg: bool,
    /// Whether it swings, and how stiff it is: 1 is like hair, 4 returns twice as fast.
    pub swing: Option<f64>,
    /// For a bone inside another part, that part, which comes before it.
    pub inside: Option<FigurePartId>,
    /// For a bone that makes a share of the turn of a joint, whose it is.
    pub shared: Option<SharedTurn>,
}

/// The turn of a joint that several bones share.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SharedTurn {
    /// The bones before the joint and after it.
    pub between: [FigurePartId; 2],
    /// The share that is made up to here, 0 to 1.
    pub share: f64,
}

/// A clip retargeted to a rig, frame by frame.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct RetargetedClip {
    /// Per part the rotation of its node in its parent's frame, of rooted nodes in the drawing's axes; `None` if it does not
    /// change. Animations share them where they need all of them.
    pub rotations: TiVec<FigurePartId, Option<Arc<Vec<DQuat>>>>,
    /// Per part the position of its node; for rooted nodes only.
    pub translations: TiVec<FigurePartId, Option<Vec<DVec3>>>,
    /// Per frame whether a foot is in contact with the ground, and none takes over from another.
    pub grounded: Vec<bool>,
    /// Per part by how much it is turned in each frame to keep an arm out of the trunk or a foot out of the ground, radians; `None`
    /// if it points where the motion says in all of them.
    pub turned: TiVec<FigurePartId, Option<Vec<f64>>>,
    /// The rest pose from which the clip's rotations were measured.
    pub rest: RestSource,
}

impl RetargetedClip {
    /// The node of a part in a frame, in the drawing's axes, given that of its parent in `placed`.
    pub(crate) fn node(
        &self,
        rig: &Rig,
        part: FigurePartId,
        frame: usize,
        placed: &TiSlice<FigurePartId, Transform>,
    ) -> Transform {
        let own = &rig.parts[part];
        let turn = self.rotations[part].as_ref().map(|turns| turns[frame]);
        match own.parent.filter(|_| !own.is_rooted) {
            Some(parent) => {
                let (above, rest) = (placed[parent], &rig.parts[parent].node);
                let drawn = || rest.rotation.inverse() * own.node.rotation;
                Transform {
                    rotation: above.rotation * turn.unwrap_or_else(drawn),
                    position: above.apply(rest.to_local(own.node.position)),
                }
            }
            None => {
                let place = self.translations[part].as_ref().map(|places| places[frame]);
                Transform {
                    rotation: turn.unwrap_or(own.node.rotation),
                    position: place.unwrap_or(own.node.position),
                }
            }
        }
    }
}

/// Retargets a clip to a rig. Every index in `rig` and `landmarks` must be valid. Nothing moves if no part is driven; parts
/// whose parents form a cycle stay in place.
pub fn retarget(clip: &Clip, rig: &Rig, landmarks: &Landmarks) -> RetargetedClip {
    Turns::new(clip, rig, landmarks).travel()
}

/// From a clip's world to the axes of a drawing whose figure faces in a direction: y up, z towards the viewer. The front of the body is
/// that of the first frame.
pub(crate) fn to_drawing(clip: &Clip, landmarks: &Landmarks, facing: Facing) -> DQuat {
    axes::Axes::of(clip, landmarks, facing).first.inverse()
}

/// By how much the body of a clip is turned about the vertical from its first frame to its last one, in the axes of a drawing whose figure
/// faces in a direction.
pub(crate) fn turn(clip: &Clip, landmarks: &Landmarks, facing: Facing) -> DQuat {
    let axes = axes::Axes::of(clip, landmarks, facing);
    match clip.frames.checked_sub(1) {
        Some(last) => {
            let at = axes.at(landmarks, PoseBuffer::new(clip).at(last));
            (axes.first.inverse() * at).normalize()
        }
        None => DQuat::IDENTITY,
    }
}

/// What turns are made from: a clip, and the rig that plays it.
struct Source<'a> {
    clip: &'a Clip,
    rig: &'a Rig,
    landmarks: &'a Landmarks,
    axes: axes::Axes,
    poses: PoseBuffer<'a>,
}

/// The poses of a clip, of which the one that was used last is stored.
struct PoseBuffer<'a> {
    clip: &'a Clip,
    frame: Option<usize>,
    pose: Pose,
}

impl<'a> PoseBuffer<'a> {
    fn new(clip: &'a Clip) -> Self {
        Self {
            clip,
            frame: None,
            pose: Pose::new(),
        }
    }

    fn at(&mut self, frame: usize) -> &TiSlice<JointId, Transform> {
        if self.frame != Some(frame) {
            self.clip.pose_into(frame, &mut self.pose);
            self.frame = Some(frame);
        }
        &self.pose
    }
}
