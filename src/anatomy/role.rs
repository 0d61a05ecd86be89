//! What part of a figure a name means, and what carries it.

use super::Term;

/// What a part of a figure is by its name, as far as it tells what carries it. The pieces of limbs are in order from the trunk outward.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(crate) enum Role {
    Body,
    Chest,
    Belly,
    Hips,
    Neck,
    Head,
    Shoulder,
    /// Also a whole arm, a wing.
    UpperArm,
    LowerArm,
    Hand,
    /// Also a whole leg.
    Thigh,
    Shin,
    Foot,
    Toe,
    Tail,
    /// What belongs to a head: eyes, hair, a hat.
    OfHead,
}

impl Role {
    /// The role that the words of a name give; `None` if they give none.
    pub(crate) fn of(terms: &[Term]) -> Option<Self> {
        use Term as T;
        let says = |wanted: &[Term]| terms.iter().any(|term| wanted.contains(term));
        if says(&[T::Detail]) {
            return says(&[T::OfHead, T::HeadWear]).then_some(Self::OfHead);
        }
        let lower = says(&[T::Lower, T::Fore]);
        Some(match () {
            () if says(&[T::Hand]) => Self::Hand,
            () if says(&[T::LowerArm]) || says(&[T::Arm]) && lower => Self::LowerArm,
            () if says(&[T::Arm, T::UpperArm]) => Self::UpperArm,
            () if says(&[T::Toe]) => Self::Toe,
            () if says(&[T::Foot]) => Self::Foot,
            () if says(&[T::Shin]) || says(&[T::Leg]) && says(&[T::Lower]) => Self::Shin,
            () if says(&[T::Leg, T::Thigh]) => Self::Thigh,
            () if says(&[T::Shoulder, T::Collar]) => Self::Shoulder,
            () if says(&[T::Head, T::Face]) => Self::Head,
            () if says(&[T::Neck]) => Self::Neck,
            () if says(&[T::Tail]) => Self::Tail,
            () if says(&[T::Hips, T::Hip, T::Waist]) => Self::Hips,
            () if says(&[T::Body]) && says(&[T::Lower]) => Self::Hips,
            () if says(&[T::Body]) => Self::Body,
            () if says(&[T::Chest]) => Self::Chest,
            () if says(&[T::Belly]) => Self::Belly,
            () if says(&[T::HeadWear]) => Self::OfHead,
            () => return None,
        })
    }

    /// How good a root a piece of the trunk is, the best first.
    pub(crate) fn trunk(self) -> Option<u8> {
        match self {
            Self::Body => Some(0),
            Self::Chest => Some(1),
            Self::Belly => Some(2),
            Self::Hips => Some(3),
            _ => None,
        }
    }

    /// Whether it is an arm or a leg, or a piece of one.
    pub(crate) fn is_piece_of_limb(self) -> bool {
        matches!(
            self,
            Self::Shoulder
                | Self::UpperArm
                | Self::LowerArm
                | Self::Hand
                | Self::Thigh
                | Self::Shin
                | Self::Foot
                | Self::Toe
        )
    }

    /// What carries it, the best first. No chain of carriers returns to its beginning.
    pub(crate) fn carriers(self) -> &'static [Self] {
        match self {
            Self::Body => &[],
            Self::Chest => &[Self::Body],
            Self::Belly => &[Self::Body, Self::Chest],
            Self::Hips => &[Self::Belly, Self::Body, Self::Chest],
            Self::Neck | Self::Shoulder => &[Self::Chest, Self::Body],
            Self::Head => &[Self::Neck, Self::Chest, Self::Body],
            Self::UpperArm => &[
                Self::Shoulder,
                Self::Chest,
                Self::Body,
                Self::Belly,
                Self::Hips,
            ],
            Self::LowerArm => &[Self::UpperArm],
            Self::Hand => &[Self::LowerArm, Self::UpperArm],
            Self::Thigh | Self::Tail => &[Self::Hips, Self::Belly, Self::Body, Self::Chest],
            Self::Shin => &[Self::Thigh],
            Self::Foot => &[Self::Shin, Self::Thigh],
            Self::Toe => &[Self::Foot],
            Self::OfHead => &[Self::Head],
        }
    }
}

/// Whether a name says left, and whether it says right; from the figure's own point of view.
pub(crate) fn sides(terms: &[Term]) -> [bool; 2] {
    [Term::Left, Term::Right].map(|side| terms.contains(&side))
}
