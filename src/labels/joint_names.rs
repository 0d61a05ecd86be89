//! Finds the limbs of a skeleton by the names of its joints.

use typed_index_collections::{TiSlice, TiVec, ti_vec};

use super::joint_tree::JointTree;
use super::skeleton::plain_names;
use super::{Class, LimbSegment, Side};
use crate::anatomy::{self, Term, name_words};
use crate::mocap::{JointId, Skeleton};

/// How many limbs of one name are tried; meaningful names do not repeat so often.
const MAX_STARTS: usize = 16;

/// What a joint's name says, before its neighbours are considered.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum JointName {
    /// Twist, share, finger, face and end joints: not used to drive parts.
    Helper,
    Hips,
    Spine,
    Neck,
    Head,
    Tail,
    Limb(LimbWord, Side),
}

/// The word for a limb's segment in the name of a joint that has a side.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum LimbWord {
    Collar,
    Shoulder,
    Arm,
    UpperArm,
    LowerArm,
    Hand,
    Hip,
    Leg,
    Thigh,
    Shin,
    Foot,
    Toe,
}

/// The joints of a limb as far as they are known.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct LimbJoints {
    pub(super) collar: Option<JointId>,
    pub(super) upper: Option<JointId>,
    pub(super) lower: Option<JointId>,
    pub(super) end: Option<JointId>,
    pub(super) toe: Option<JointId>,
}

/// What the names of all joints say.
pub(super) fn named(skeleton: &Skeleton) -> TiVec<JointId, Option<JointName>> {
    plain_names(skeleton).into_iter().map(name).collect()
}

fn name(name: &str) -> Option<JointName> {
    use Term as T;
    // MakeHuman names helper joints, which only offset their child, like `__UpLeg_L`.
    if name.starts_with("__") {
        return Some(JointName::Helper);
    }
    let terms = anatomy::terms(name);
    let has = |term: Term| terms.contains(&term);
    let any = |wanted: &[Term]| terms.iter().any(|term| wanted.contains(term));
    let finger = has(T::Middle) && !any(&[T::Body, T::Chest, T::Belly, T::Back, T::Neck]);
    let worn = any(&[T::BodyWear, T::HeadWear, T::HipWear]);
    let helper = has(T::Helper) && !(has(T::Neck) && twists(name));
    if helper || any(&[T::Detail, T::Face]) || worn || finger {
        return Some(JointName::Helper);
    }
    let side = match (has(T::Left), has(T::Right)) {
        (true, false) => Some(Side::Left),
        (false, true) => Some(Side::Right),
        _ => None,
    };
    if let Some(side) = side {
        return limb_word(&terms).map(|word| JointName::Limb(word, side));
    }
    if any(&[T::Hips, T::Hip]) || has(T::Lower) && has(T::Body) {
        Some(JointName::Hips)
    } else if has(T::Head) {
        Some(JointName::Head)
    } else if has(T::Neck) {
        Some(JointName::Neck)
    } else if has(T::Tail) {
        Some(JointName::Tail)
    } else if any(&[T::Body, T::Chest, T::Belly, T::Back, T::Waist]) {
        Some(JointName::Spine)
    } else {
        None
    }
}

/// Whether a joint is named after a turn about its bone. iClone's joints of the neck are, and the head hangs on them.
fn twists(name: &str) -> bool {
    let words = name_words::split(name);
    words
        .iter()
        .any(|word| ["twist", "roll"].contains(&word.as_str()))
}

fn limb_word(terms: &[Term]) -> Option<LimbWord> {
    use Term as T;
    let has = |term: Term| terms.contains(&term);
    let low = has(T::Lower);
    Some(if has(T::Toe) || has(T::Fore) && has(T::Foot) {
        LimbWord::Toe
    } else if has(T::Foot) {
        LimbWord::Foot
    } else if has(T::Hand) {
        LimbWord::Hand
    } else if has(T::LowerArm) || has(T::Arm) && (low || has(T::Fore)) {
        LimbWord::LowerArm
    } else if has(T::UpperArm) || has(T::Arm) && has(T::Upper) {
        LimbWord::UpperArm
    } else if has(T::Shin) || has(T::Leg) && low {
        LimbWord::Shin
    } else if has(T::Thigh) || has(T::Leg) && has(T::Upper) {
        LimbWord::Thigh
    } else if has(T::Arm) {
        LimbWord::Arm
    } else if has(T::Leg) {
        LimbWord::Leg
    } else if has(T::Collar) {
        LimbWord::Collar
    } else if has(T::Shoulder) {
        LimbWord::Shoulder
    } else if has(T::Hip) {
        LimbWord::Hip
    } else {
        return None;
    })
}

/// The limb of a class and side by name; of several the one with the most bones.
pub(super) fn limb(
    tree: &JointTree,
    names: &TiSlice<JointId, &str>,
    named: &TiSlice<JointId, Option<JointName>>,
    class: Class,
    side: Side,
) -> Option<LimbJoints> {
    let segments = segments(tree, named, class, side);
    let start = tree
        .joints()
        .filter(|joint| matches!(segments[*joint], Some(LimbSegment::Upper)))
        .filter(|joint| !continues(tree, names, *joint))
        .take(MAX_STARTS)
        .map(|joint| (joint, limb_joints(tree, &segments, joint)))
        // Of equal ones the first, nearest to the root.
        .reduce(|best, other| {
            let bones = |found: &LimbJoints| {
                usize::from(found.lower.is_some()) + usize::from(found.end.is_some())
            };
            let better =
                (bones(&other.1), tree.depths[best.0]) > (bones(&best.1), tree.depths[other.0]);
            if better { other } else { best }
        })?;
    Some(start.1)
}

/// Whether a joint continues a run of joints with one name and increasing numbers: `UpArm2` below `UpArm1`.
fn continues(tree: &JointTree, names: &TiSlice<JointId, &str>, joint: JointId) -> bool {
    let plain = |joint: JointId| {
        let mut words = name_words::split(names[joint]);
        words.retain(|word| !name_words::is_number(word));
        words
    };
    tree.parents[joint].is_some_and(|parent| {
        names[parent] != names[joint]
            && !names[parent].starts_with("__")
            && plain(parent) == plain(joint)
    })
}

/// Which bones of a limb begin at each joint.
fn segments(
    tree: &JointTree,
    named: &TiSlice<JointId, Option<JointName>>,
    class: Class,
    side: Side,
) -> TiVec<JointId, Option<LimbSegment>> {
    let word = |joint: JointId| match named[joint] {
        Some(JointName::Limb(word, its)) if its == side => Some(word),
        _ => None,
    };
    let follows = |wanted: &[LimbWord]| {
        let mut below: TiVec<JointId, bool> = ti_vec![false; tree.len()];
        for joint in tree.joints().rev() {
            if let Some(parent) = tree.parents[joint] {
                below[parent] |=
                    below[joint] || word(joint).is_some_and(|word| wanted.contains(&word));
            }
        }
        below
    };
    let arm_follows = follows(&[LimbWord::Arm, LimbWord::UpperArm]);
    let thigh_follows = follows(&[LimbWord::Thigh]);
    let upper_arm = tree
        .joints()
        .any(|joint| word(joint) == Some(LimbWord::UpperArm));
    let hip_is_thigh = |joint: JointId| !thigh_follows[joint];
    let thigh = tree.joints().any(|joint| match word(joint) {
        Some(LimbWord::Thigh) => true,
        Some(LimbWord::Hip) => hip_is_thigh(joint),
        _ => false,
    });
    tree.joints()
        .map(|joint| {
            let word = word(joint)?;
            Some(match (class, word) {
                (Class::Arm, LimbWord::Collar) => LimbSegment::Collar,
                (Class::Arm, LimbWord::Shoulder) if arm_follows[joint] => LimbSegment::Collar,
                (Class::Arm, LimbWord::Shoulder | LimbWord::UpperArm) => LimbSegment::Upper,
                (Class::Arm, LimbWord::Arm) if upper_arm => LimbSegment::Lower,
                (Class::Arm, LimbWord::Arm) => LimbSegment::Upper,
                (Class::Arm, LimbWord::LowerArm) => LimbSegment::Lower,
                (Class::Arm, LimbWord::Hand) => LimbSegment::End,
                (Class::Leg, LimbWord::Hip) if !hip_is_thigh(joint) => LimbSegment::Collar,
                (Class::Leg, LimbWord::Hip | LimbWord::Thigh) => LimbSegment::Upper,
                (Class::Leg, LimbWord::Leg) if thigh => LimbSegment::Lower,
                (Class::Leg, LimbWord::Leg) => LimbSegment::Upper,
                (Class::Leg, LimbWord::Shin) => LimbSegment::Lower,
                (Class::Leg, LimbWord::Foot) => LimbSegment::End,
                (Class::Leg, LimbWord::Toe) => LimbSegment::Beyond,
                _ => return None,
            })
        })
        .collect()
}

/// The joints of the limb whose upper bone begins at `upper`.
fn limb_joints(
    tree: &JointTree,
    segments: &TiSlice<JointId, Option<LimbSegment>>,
    upper: JointId,
) -> LimbJoints {
    let first_below = |above: JointId, segment: LimbSegment| {
        let inside = tree.branch(above);
        tree.joints()
            .filter(|joint| *joint > above && inside[*joint] && segments[*joint] == Some(segment))
            .min_by_key(|joint| (tree.depths[*joint], *joint))
    };
    let lower = first_below(upper, LimbSegment::Lower);
    let end = first_below(lower.unwrap_or(upper), LimbSegment::End);
    LimbJoints {
        collar: tree
            .upward(upper)
            .skip(1)
            .find(|joint| segments[*joint] == Some(LimbSegment::Collar)),
        upper: Some(upper),
        lower,
        end,
        toe: first_below(end.or(lower).unwrap_or(upper), LimbSegment::Beyond),
    }
}
