//! Labels for the joints of a skeleton and the parts of a figure: head, arm or leg, which side, which segment of it.
//!
//! Both are labelled by name first, and by shape where names say nothing: [`label_clip`] and [`label_figure`]. A label
//! keeps the reason for it. All tables of words are in `anatomy`.

mod beside;
mod by_shape;
mod drawn_figure;
mod facing;
mod figure;
mod held;
mod joint_names;
mod joint_tree;
mod part_tree;
mod placement;
mod segments;
mod sides;
mod skeleton;
mod topology;
mod trunk;
mod unnamed;
mod vehicle;

#[cfg(test)]
pub(crate) mod tests;

use crate::math;
use glam::DVec3;
use typed_index_collections::TiSlice;

use crate::mocap::{JointId, Skeleton, Transform};

pub use drawn_figure::FigurePartId;
pub(crate) use drawn_figure::{Carry, Detail, Figure, FigurePart};
pub(crate) use facing::FoundFacing;
pub(crate) use figure::label_figure;
pub(crate) use figure::{LabeledFigure, label_drawn};
pub use skeleton::{Anatomy, Limb, label_clip};
pub(crate) use unnamed::{
    BUST, Certainty, Drawn, Guess, Guesses, Mask, Profile, SIDE as GRID_SIDE, guess,
};

pub(crate) use joint_tree::JointTree;
pub(crate) use skeleton::plain_names;

/// What a joint or a part belongs to.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Class {
    /// The head.
    Head,
    /// The neck.
    Neck,
    /// The trunk above the hips, or all of it.
    Body,
    /// The hips: the trunk's lower end.
    Hips,
    /// An arm, a wing.
    Arm,
    /// A leg.
    Leg,
    /// A tail.
    Tail,
}

impl Class {
    /// Its name in messages.
    pub fn name(self) -> &'static str {
        match self {
            Self::Head => "head",
            Self::Neck => "neck",
            Self::Body => "body",
            Self::Hips => "hips",
            Self::Arm => "arm",
            Self::Leg => "leg",
            Self::Tail => "tail",
        }
    }

    /// Whether it is an arm or a leg.
    pub fn is_limb(self) -> bool {
        matches!(self, Self::Arm | Self::Leg)
    }
}

/// A side from the figure's or the actor's own point of view, not the viewer's.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Side {
    /// Left.
    Left,
    /// Right.
    Right,
}

impl Side {
    /// Both.
    pub const BOTH: [Self; 2] = [Self::Left, Self::Right];

    /// The opposite side.
    #[must_use]
    pub fn other(self) -> Self {
        match self {
            Self::Left => Self::Right,
            Self::Right => Self::Left,
        }
    }

    /// Its name in messages.
    pub fn name(self) -> &'static str {
        match self {
            Self::Left => "left",
            Self::Right => "right",
        }
    }
}

/// The direction that a figure faces.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Hash)]
pub enum Facing {
    /// Towards the viewer.
    #[default]
    Viewer,
    /// To the drawing's left.
    Left,
    /// To the drawing's right.
    Right,
    /// Away from the viewer, who sees its back.
    Away,
    /// It is seen from above, its head in the drawing's upper half: lying on the ground, it looks away from the viewer.
    Up,
    /// It is seen from above, its head in the drawing's lower half: lying on the ground, it looks to the viewer.
    UpHeadDown,
}

impl Facing {
    /// The word of `Facing` for it.
    pub fn word(self) -> &'static str {
        match self {
            Self::Viewer => "front",
            Self::Left => "left",
            Self::Right => "right",
            Self::Away => "back",
            Self::Up | Self::UpHeadDown => "up",
        }
    }

    /// What a word of `Facing` means.
    pub(crate) fn from_word(word: &str) -> Option<Self> {
        let all = [Self::Viewer, Self::Left, Self::Right, Self::Away, Self::Up];
        all.into_iter().find(|facing| facing.word() == word)
    }

    /// Whether the figure is seen from one of its sides.
    pub fn is_profile(self) -> bool {
        matches!(self, Self::Left | Self::Right)
    }

    /// Whether the figure is seen from above, and lies on the ground when it moves.
    pub fn is_from_above(self) -> bool {
        matches!(self, Self::Up | Self::UpHeadDown)
    }

    /// The rotation from a body's own axes (x its left, y up, z its front) to the drawing's; for a figure that is seen from above, to
    /// those of the drawing laid on the ground.
    pub fn turn(self) -> glam::DQuat {
        match self {
            Self::Viewer | Self::UpHeadDown => glam::DQuat::IDENTITY,
            Self::Left => math::rotation_y(-std::f64::consts::FRAC_PI_2),
            Self::Right => math::rotation_y(std::f64::consts::FRAC_PI_2),
            Self::Away | Self::Up => math::rotation_y(std::f64::consts::PI),
        }
    }
}

/// A segment of a limb.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum LimbSegment {
    /// The whole limb, without a hand or foot that is a segment of its own.
    Whole,
    /// The collar bone; only in skeletons.
    Collar,
    /// Upper arm, thigh.
    Upper,
    /// Forearm, shin.
    Lower,
    /// Hand, foot.
    End,
    /// What follows the hand or foot: fingers, toes.
    Beyond,
}

impl LimbSegment {
    /// Its name in messages, for a limb of this class.
    pub fn name(self, class: Class) -> &'static str {
        match (self, class) {
            (Self::Collar, Class::Arm) => "collar bone",
            (Self::Upper, Class::Arm) => "upper arm",
            (Self::Lower, Class::Arm) => "forearm",
            (Self::End, Class::Arm) => "hand",
            (Self::Beyond, Class::Arm) => "fingers",
            (Self::Collar, Class::Leg) => "hip bone",
            (Self::Upper, Class::Leg) => "thigh",
            (Self::Lower, Class::Leg) => "shin",
            (Self::End, Class::Leg) => "foot",
            (Self::Beyond, Class::Leg) => "toes",
            (_, class) => class.name(),
        }
    }
}

/// What a joint or a part is.
#[derive(Debug, Clone, PartialEq)]
pub struct Label {
    /// What it belongs to.
    pub class: Class,
    /// The side of a limb.
    pub side: Option<Side>,
    /// Which segment of a limb; [`LimbSegment::Whole`] for everything else.
    pub segment: LimbSegment,
    /// Which limb of its class and side: 0 is the rearmost or lowest. In a figure also which segment of the trunk, counted from
    /// the hips, and of neck and tail, counted from the trunk.
    pub pair: usize,
    /// The reason, for people to read: "`Rarm` is a right arm by its name".
    pub why: String,
}

impl Label {
    /// A short description: `right arm, upper`.
    pub fn describe(&self) -> String {
        let side = self.side.map_or("", Side::name);
        let space = if side.is_empty() { "" } else { " " };
        let segment = match self.segment {
            LimbSegment::Whole => "",
            LimbSegment::Collar => ", collar",
            LimbSegment::Upper => ", upper",
            LimbSegment::Lower => ", lower",
            LimbSegment::End => ", end",
            LimbSegment::Beyond => ", beyond",
        };
        format!("{side}{space}{}{segment}", self.class.name())
    }
}

/// The far end of a chain of bones.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Tip {
    /// A joint.
    Joint(JointId),
    /// The end of a bone that leads to no joint.
    End {
        /// The joint that the bone begins at.
        joint: JointId,
        /// Its index in [`Joint::ends`](crate::mocap::Joint::ends).
        end: usize,
    },
}

impl Tip {
    /// Its position in a pose of the skeleton.
    pub(crate) fn place(self, skeleton: &Skeleton, pose: &TiSlice<JointId, Transform>) -> DVec3 {
        match self {
            Self::Joint(joint) => pose[joint].position,
            Self::End { joint, end } => {
                let placed = pose[joint];
                placed.rotation * skeleton.joints[joint].ends[end] + placed.position
            }
        }
    }
}
