//! The rest pose: the pose from which a clip's rotations are measured.

use glam::{DQuat, DVec3};
use typed_index_collections::TiSlice;

use super::axes::Landmarks;
use super::rotations::arc;
use super::{Source, ground};
use crate::math;
use crate::mocap::{JointId, Pose, Skeleton, Transform};
use crate::retarget::{Drive, Follow};

/// In a standing pose the legs deviate from straight down by at most this, degrees.
const LEGS: f64 = 35.0;
/// In a standing pose the lines through hips and shoulders deviate from level by at most this, degrees.
const LEVEL: f64 = 25.0;
/// A trunk that deviates from upright by more than this, degrees, belongs to an animal or to somebody who lies: how far such a body leans
/// from the drawn one is unknown.
const UPRIGHT: f64 = 45.0;

/// Sums of squared angles that differ by a smaller share are equal.
const SAME: f64 = 1e-9;

/// Where the rest pose comes from.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum RestSource {
    /// The skeleton's offsets, because they form a standing pose.
    #[default]
    Offsets,
    /// The frame that is nearest to the drawing.
    Frame(usize),
}

pub(super) struct RestPose {
    pub(super) source: RestSource,
    pub(super) pose: Pose,
    /// From the drawing's axes to the clip's world, by the body's axes in the rest pose: Cᵣ.
    pub(super) axes: DQuat,
    /// How the trunk leans from upright in the rest pose, in the clip's world. The figure's trunk is drawn upright, whatever the actor
    /// does in the frame that is nearest to the drawing, and so leans by as much as the actor. None for offsets, which stand.
    lean: Option<DQuat>,
}

impl RestPose {
    /// From the drawing's axes to those of the body in the rest pose as far as a part is concerned: a trunk leans, a head and limbs do not.
    pub(super) fn axes_for(
        &self,
        drive: &Drive,
        skeleton: &Skeleton,
        landmarks: &Landmarks,
    ) -> DQuat {
        let is_trunk = match drive.follow {
            Follow::Trunk { .. } => true,
            Follow::Change => {
                drive.tip.is_none() && carries_shoulders(drive.joint, skeleton, landmarks)
            }
            Follow::Direction | Follow::Sole => false,
        };
        match self.lean {
            Some(lean) if is_trunk => lean * self.axes,
            _ => self.axes,
        }
    }
}

/// Whether both shoulders hang on a joint.
fn carries_shoulders(joint: JointId, skeleton: &Skeleton, landmarks: &Landmarks) -> bool {
    let hangs = |shoulder: JointId| {
        let above = |below: &JointId| skeleton.joints[*below].parent;
        std::iter::successors(Some(shoulder), above).any(|above| above == joint)
    };
    landmarks
        .shoulders
        .is_some_and(|shoulders| shoulders.into_iter().all(hangs))
}

pub(super) fn choose(source: &mut Source<'_>) -> RestPose {
    let offsets = source.clip.skeleton.offset_pose();
    // The skeleton may have been made in other axes than the motion.
    let up = ground::upright(&offsets, source.landmarks);
    if source.clip.frames == 0 || stands(&offsets, source.landmarks, up) {
        return RestPose {
            source: RestSource::Offsets,
            axes: source.axes.at_upright(source.landmarks, &offsets, up),
            pose: offsets,
            lean: None,
        };
    }
    let frame = nearest(source);
    let pose = source.poses.at(frame).to_vec();
    RestPose {
        source: RestSource::Frame(frame),
        axes: source.axes.at(source.landmarks, &pose),
        lean: lean(&pose, source.landmarks, source.axes.up),
        pose,
    }
}

/// The shortest rotation from up to the line from the hips to the middle of the shoulders; `None` if there is no such line, or it is far
/// from upright.
fn lean(pose: &TiSlice<JointId, Transform>, landmarks: &Landmarks, up: DVec3) -> Option<DQuat> {
    let [left, right] = landmarks.shoulders?.map(|joint| pose[joint].position);
    let line = ((left + right) / 2.0 - pose[landmarks.hips].position).try_normalize()?;
    (line.dot(up) >= math::cos(UPRIGHT.to_radians())).then(|| arc(up, line, up))
}

/// Whether a body stands upright in a pose: the head above the hips, legs down, hips and shoulders level and turned to the same side.
///
/// Offsets of skeletons whose joints all have one axis along their bone have legs that point up beside the trunk: seen from the other
/// side of up they would stand, but for the head.
fn stands(pose: &TiSlice<JointId, Transform>, landmarks: &Landmarks, up: DVec3) -> bool {
    let way = |from: JointId, to: JointId| pose[to].position - pose[from].position;
    let down = |leg: DVec3| {
        leg.try_normalize()
            .is_some_and(|leg| leg.dot(-up) >= math::cos(LEGS.to_radians()))
    };
    let level = |line: DVec3| {
        line.try_normalize()
            .is_some_and(|line| line.dot(up).abs() <= math::sin(LEVEL.to_radians()))
    };
    let legs = match (landmarks.thighs, landmarks.feet) {
        (Some(thighs), Some(feet)) => (0..2).all(|side| down(way(thighs[side], feet[side]))),
        _ => true,
    };
    let rises = landmarks
        .head
        .is_none_or(|head| way(landmarks.hips, head).dot(up) > 0.0);
    let pairs = [landmarks.thighs, landmarks.shoulders];
    let lines: Vec<DVec3> = pairs
        .into_iter()
        .flatten()
        .map(|[left, right]| way(right, left))
        .collect();
    let agree = lines.windows(2).all(|pair| pair[0].dot(pair[1]) > 0.0);
    !lines.is_empty() && rises && legs && agree && lines.into_iter().all(level)
}

/// The frame in which the limbs' directions are nearest to the drawn ones: least sum of squared angles, the first of equal
/// ones.
fn nearest(source: &mut Source<'_>) -> usize {
    let mut best = (0, f64::INFINITY);
    for frame in 0..source.clip.frames {
        let pose = source.poses.at(frame);
        let to_drawing = source.axes.at(source.landmarks, pose).inverse();
        let mut sum = 0.0;
        for part in &source.rig.parts {
            let Some(drive) = part.drive.filter(|drive| drive.follow == Follow::Direction) else {
                continue;
            };
            let Some(tip) = drive.tip else { continue };
            let bone = tip.place(&source.clip.skeleton, pose) - pose[drive.joint].position;
            let drawn = part.tip - part.joint;
            let angle = if bone.length_squared() > 0.0 && drawn.length_squared() > 0.0 {
                math::angle_between(to_drawing * bone, drawn)
            } else {
                0.0
            };
            sum += angle * angle;
        }
        // Frames that differ only by rounding are equal, so that the same motion written in another way has the same rest pose.
        if sum < best.1 * (1.0 - SAME) {
            best = (frame, sum);
        }
    }
    best.0
}
