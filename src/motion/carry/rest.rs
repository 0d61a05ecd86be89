//! The pose that a clip's rotations are measured from.

use glam::{DQuat, DVec3};

use super::axes::{Axes, Landmarks};
use super::{Poses, Puppet};
use crate::motion::matching::Follow;
use crate::motion::skeleton::{Clip, Placed};

/// How far legs may be from down in a pose that stands, degrees.
const LEGS: f64 = 35.0;
/// How far hips and shoulders may be from level in a pose that stands, degrees.
const LEVEL: f64 = 25.0;

/// Sums of squared angles that differ by a smaller share are the same.
const SAME: f64 = 1e-9;

/// The pose that a clip's rotations are measured from.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Rest {
    /// The skeleton's offsets, for it stands in them.
    #[default]
    Offsets,
    /// The frame that is nearest to the drawing.
    Frame(usize),
}

/// A rest pose.
pub(super) struct RestPose {
    pub(super) rest: Rest,
    pub(super) pose: Vec<Placed>,
    /// From the drawing's axes to the clip's world, by the body's axes in the pose: Cᵣ.
    pub(super) axes: DQuat,
}

pub(super) fn choose(
    clip: &Clip,
    puppet: &Puppet,
    landmarks: &Landmarks,
    axes: &Axes,
    poses: &mut Poses<'_>,
) -> RestPose {
    let offsets = clip.skeleton.offset_pose();
    let rest = match clip.frames() == 0 || stands(&offsets, landmarks, axes.up) {
        true => Rest::Offsets,
        false => Rest::Frame(nearest(clip, puppet, landmarks, axes, poses)),
    };
    let pose = match rest {
        Rest::Offsets => offsets,
        Rest::Frame(frame) => poses.at(frame).to_vec(),
    };
    RestPose {
        rest,
        axes: axes.at(landmarks, &pose),
        pose,
    }
}

/// Whether a pose stands: legs down, hips and shoulders level.
fn stands(pose: &[Placed], landmarks: &Landmarks, up: DVec3) -> bool {
    let way = |from: usize, to: usize| pose[to].position - pose[from].position;
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

/// The frame in which limbs point most nearly as they are drawn: least sum of squared angles, the first of equals.
fn nearest(
    clip: &Clip,
    puppet: &Puppet,
    landmarks: &Landmarks,
    axes: &Axes,
    poses: &mut Poses<'_>,
) -> usize {
    let mut best = (0, f64::INFINITY);
    for frame in 0..clip.frames() {
        let pose = poses.at(frame);
        let to_drawing = axes.at(landmarks, pose).inverse();
        let mut sum = 0.0;
        for part in &puppet.parts {
            let Some(drive) = part.drive.filter(|drive| drive.follow == Follow::Direction) else {
                continue;
            };
            let Some(tip) = drive.tip else { continue };
            let bone = tip.place(&clip.skeleton, pose) - pose[drive.joint].position;
            let drawn = part.tip - part.joint;
            let angle = match bone.length_squared() > 0.0 && drawn.length_squared() > 0.0 {
                true => (to_drawing * bone).angle_between(drawn),
                false => 0.0,
            };
            sum += angle * angle;
        }
        // Of frames that differ by rounding alone the first, so that another way to write the same motion has the same rest.
        if sum < best.1 * (1.0 - SAME) {
            best = (frame, sum);
        }
    }
    best.0
}
