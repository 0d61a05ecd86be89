//! How a body is oriented in its clip.

use glam::{DMat3, DQuat, DVec3};
use typed_index_collections::TiSlice;

use super::{PoseBuffer, ground};
use crate::labels::{Anatomy, Class, Facing, Limb, Side, Tip};
use crate::mocap::{Clip, JointId, Transform, UpAxis};

/// The joints that define how a body is oriented. Pairs are left and right from the body's own point of view.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Landmarks {
    /// The joint whose travel is the body's travel.
    pub hips: JointId,
    /// The head, or the joint nearest to it.
    pub head: Option<JointId>,
    /// Where the arms begin: the shoulders.
    pub shoulders: Option<[JointId; 2]>,
    /// Where the legs begin: the hip joints.
    pub thighs: Option<[JointId; 2]>,
    /// The knees.
    pub knees: Option<[JointId; 2]>,
    /// Where the feet begin, or the legs end: the ankles.
    pub feet: Option<[JointId; 2]>,
    /// Where the toes begin.
    pub toes: Option<[JointId; 2]>,
    /// The far ends of the feet.
    pub foot_tips: Option<[Tip; 2]>,
    /// Where the hands begin, or the arms end: the wrists.
    pub hands: Option<[JointId; 2]>,
    /// All legs.
    pub legs: Vec<Limb>,
    /// The axis of the clip's world that points up; `None` to find it.
    pub up: Option<UpAxis>,
}

impl Landmarks {
    /// The leg that a joint belongs to.
    pub(super) fn leg_of(&self, joint: JointId) -> Option<&Limb> {
        self.legs.iter().find(|leg| {
            let joints = [Some(leg.upper), leg.lower, leg.end, leg.toe];
            joints.contains(&Some(joint))
        })
    }

    /// The landmarks of a labelled skeleton; if it has no hips, its first joint is used.
    pub fn of(anatomy: &Anatomy) -> Self {
        fn both<T>(limbs: [Option<&Limb>; 2], of: fn(&Limb) -> Option<T>) -> Option<[T; 2]> {
            let [left, right] = limbs.map(|limb| limb.and_then(of));
            Some([left?, right?])
        }
        let limbs = |class: Class| {
            let limbs = anatomy.limbs.iter();
            limbs.filter(|limb| limb.class == class).copied().collect()
        };
        let [arms, legs] =
            [Class::Arm, Class::Leg].map(|class| Side::BOTH.map(|side| anatomy.limb(class, side)));
        Self {
            hips: anatomy.hips.unwrap_or_default(),
            head: anatomy
                .head
                .or(anatomy.neck.last().copied())
                .or(anatomy.chest()),
            shoulders: both(arms, |arm| Some(arm.upper)),
            thighs: both(legs, |leg| Some(leg.upper)),
            knees: both(legs, |leg| leg.end.and(leg.lower)),
            feet: both(legs, |leg| leg.end.or(leg.lower)),
            toes: both(legs, |leg| leg.toe),
            foot_tips: both(legs, |leg| leg.end.and(leg.tip)),
            hands: both(arms, |arm| arm.end.or(arm.lower)),
            legs: limbs(Class::Leg),
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
            up: landmarks
                .up
                .map_or_else(|| ground::up(clip, landmarks), UpAxis::direction),
            first: DQuat::IDENTITY,
            facing: facing.turn(),
        };
        axes.first = match clip.frames {
            0 => axes.at(landmarks, &clip.skeleton.offset_pose()),
            _ => axes.at(landmarks, PoseBuffer::new(clip).at(0)),
        };
        axes
    }

    /// From the drawing's axes to the clip's world, by the body's axes in a pose.
    pub(super) fn at(&self, landmarks: &Landmarks, pose: &TiSlice<JointId, Transform>) -> DQuat {
        self.at_upright(landmarks, pose, self.up)
    }

    /// From the drawing's axes to the axes of a pose in which another axis points up.
    ///
    /// A body's left is the mean of the lines through hips and shoulders, projected to the ground; its front is left × up.
    pub(super) fn at_upright(
        &self,
        landmarks: &Landmarks,
        pose: &TiSlice<JointId, Transform>,
        up: DVec3,
    ) -> DQuat {
        let line = |pair: Option<[JointId; 2]>| {
            let [left, right] = pair?;
            (pose[left].position - pose[right].position).try_normalize()
        };
        let lines = [line(landmarks.thighs), line(landmarks.shoulders)];
        let sum: DVec3 = lines.into_iter().flatten().sum();
        let level = |line: DVec3| line.reject_from(up).try_normalize();
        // Hips and shoulders can be missing, vertical, or opposite to each other.
        let left = level(sum)
            .or_else(|| lines.into_iter().flatten().find_map(level))
            .unwrap_or_else(|| any_left(up));
        let body = DMat3::from_cols(left, up, left.cross(up));
        (DQuat::from_mat3(&body) * self.facing.inverse()).normalize()
    }
}

/// A left for bodies without sides: x, or z if x is up.
fn any_left(up: DVec3) -> DVec3 {
    if up.x == 0.0 { DVec3::X } else { DVec3::Z }
}
