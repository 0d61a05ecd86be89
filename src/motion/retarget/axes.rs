//! ExposureMethod a body is oriented in its clip.

use glam::{DMat3, DQuat, DVec3};

use super::PoseBuffer;
use crate::motion::labels::{Anatomy, Class, Facing, Limb, Side};
use crate::motion::skeleton::{Clip, Transform};
use crate::motion::up::UpAxis;

/// The joints that define how a body is oriented. Pairs are left and right from the body's own point of view.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Landmarks {
    /// The joint whose travel is the body's travel.
    pub hips: usize,
    /// The head, or the joint nearest to it.
    pub head: Option<usize>,
    /// Where the arms begin: the shoulders.
    pub shoulders: Option<[usize; 2]>,
    /// Where the legs begin: the hip joints.
    pub thighs: Option<[usize; 2]>,
    /// The knees.
    pub knees: Option<[usize; 2]>,
    /// Where the feet begin, or the legs end: the ankles.
    pub feet: Option<[usize; 2]>,
    /// The axis of the clip's world that points up; `None` to find it.
    pub up: Option<UpAxis>,
}

impl Landmarks {
    /// The landmarks of a labelled skeleton; if it has no hips, its first joint is used.
    pub fn of(anatomy: &Anatomy) -> Self {
        let limb = |class, side| anatomy.limb(class, side);
        let both = |class, of: fn(&Limb) -> Option<usize>| {
            let [left, right] = Side::BOTH.map(|side| limb(class, side).and_then(of));
            Some([left?, right?])
        };
        Self {
            hips: anatomy.hips.unwrap_or(0),
            head: anatomy
                .head
                .or(anatomy.neck.last().copied())
                .or(anatomy.chest()),
            shoulders: both(Class::Arm, |arm| Some(arm.upper)),
            thighs: both(Class::Leg, |leg| Some(leg.upper)),
            knees: both(Class::Leg, |leg| leg.end.and(leg.lower)),
            feet: both(Class::Leg, |leg| leg.end.or(leg.lower)),
            up: None,
        }
    }
}

/// The orientation of a clip's world in the drawing's axes.
#[derive(Debug, Clone)]
pub(super) struct Axes {
    /// The axis of the clip's world that points up.
    pub(super) up: DVec3,
    /// From the drawing's axes to the clip's world, by the body's axes in the first frame: C₀.
    pub(super) first: DQuat,
    facing: DQuat,
}

impl Axes {
    pub(super) fn of(clip: &Clip, landmarks: &Landmarks, facing: Facing) -> Self {
        let mut axes = Self {
            up: up(clip, landmarks),
            first: DQuat::IDENTITY,
            facing: facing.turn(),
        };
        axes.first = match clip.frames() {
            0 => axes.at(landmarks, &clip.skeleton.offset_pose()),
            _ => axes.at(landmarks, PoseBuffer::new(clip).at(0)),
        };
        axes
    }

    /// From the drawing's axes to the clip's world, by the body's axes in a pose.
    ///
    /// A body's left is the mean of the lines through hips and shoulders, projected to the ground; its front is left × up.
    pub(super) fn at(&self, landmarks: &Landmarks, pose: &[Transform]) -> DQuat {
        let line = |pair: Option<[usize; 2]>| {
            let [left, right] = pair?;
            (pose[left].position - pose[right].position).try_normalize()
        };
        let lines = [line(landmarks.thighs), line(landmarks.shoulders)];
        let sum: DVec3 = lines.into_iter().flatten().sum();
        let level = |line: DVec3| line.reject_from(self.up).try_normalize();
        // Hips and shoulders can be missing, vertical, or opposite to each other.
        let left = level(sum)
            .or_else(|| lines.into_iter().flatten().find_map(level))
            .unwrap_or_else(|| self.any_left());
        let body = DMat3::from_cols(left, self.up, left.cross(self.up));
        (DQuat::from_mat3(&body) * self.facing.inverse()).normalize()
    }

    /// A left for bodies without sides: x, or z if x is up.
    fn any_left(&self) -> DVec3 {
        match self.up.x == 0.0 {
            true => DVec3::X,
            false => DVec3::Z,
        }
    }
}

/// The axis of the clip's world that is nearest to the mean direction from feet to head.
fn up(clip: &Clip, landmarks: &Landmarks) -> DVec3 {
    /// A sample of the poses is enough.
    const MAX_POSES: usize = 1000;

    if let Some(up) = landmarks.up {
        return up.direction();
    }
    let mut poses = PoseBuffer::new(clip);
    let rise = |pose: &[Transform]| {
        let low = match landmarks.feet {
            Some([left, right]) => (pose[left].position + pose[right].position) / 2.0,
            None => pose[landmarks.hips].position,
        };
        landmarks
            .head
            .map_or(DVec3::ZERO, |head| pose[head].position - low)
    };
    let step = clip.frames().div_ceil(MAX_POSES).max(1);
    let frames = (0..clip.frames()).step_by(step);
    let sum: DVec3 = frames.map(|frame| rise(poses.at(frame))).sum();
    let sum = match sum == DVec3::ZERO {
        true => rise(&clip.skeleton.offset_pose()),
        false => sum,
    };
    // Up is +Y in most files, so +Y wins ties.
    let mut best = DVec3::Y;
    for axis in [DVec3::Z, DVec3::X, DVec3::NEG_Y, DVec3::NEG_Z, DVec3::NEG_X] {
        if axis.dot(sum) > best.dot(sum) {
            best = axis;
        }
    }
    best
}
