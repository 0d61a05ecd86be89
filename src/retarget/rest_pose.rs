//! The rest pose: the pose from which a clip's rotations are measured.

use glam::{DQuat, DVec3};
use typed_index_collections::TiSlice;

use super::axes::Landmarks;
use super::{Source, ground};
use crate::mocap::{JointId, Pose, Transform};
use crate::retarget::Follow;

/// In a standing pose the legs deviate from straight down by at most this, degrees.
const LEGS: f64 = 35.0;
/// In a standing pose the lines through hips and shoulders deviate from level by at most this, degrees.
const LEVEL: f64 = 25.0;

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
        };
    }
    let frame = nearest(source);
    let pose = source.poses.at(frame).to_vec();
    RestPose {
        source: RestSource::Frame(frame),
        axes: source.axes.at(source.landmarks, &pose),
        pose,
    }
}

/// Whether a body stands upright in a pose: legs down, hips and shoulders level.
fn stands(pose: &TiSlice<JointId, Transform>, landmarks: &Landmarks, up: DVec3) -> bool {
    let way = |from: JointId, to: JointId| pose[to].position - pose[from].position;
    let down = |leg: DVec3| {
        leg.try_normalize()
            .is_some_and(|leg| leg.dot(-up) >= LEGS.to_radians().cos())
    };
    let level = |line: DVec3| {
        line.try_normalize()
            .is_some_and(|line| line.dot(up).abs() <= LEVEL.to_radians().sin())
    };
    let legs = match (landmarks.thighs, landmarks.feet) {
        (Some(thighs), Some(feet)) => (0..2).all(|side| down(way(thighs[side], feet[side]))),
        _ => true,
    };
    let lines = [landmarks.thighs, landmarks.shoulders];
    let known = lines.iter().flatten().count() > 0;
    known
        && legs
        && lines
            .into_iter()
            .flatten()
            .all(|[left, right]| level(way(right, left)))
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
                (to_drawing * bone).angle_between(drawn)
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
