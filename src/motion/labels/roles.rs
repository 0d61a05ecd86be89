//! Limbs of a skeleton by the names of its joints.

use super::names;
use super::skeleton::plain_names;
use super::tree::Tree;
use super::words::{self, Term};
use super::{Class, Side};
use crate::motion::skeleton::Skeleton;

/// Limbs of one name that are looked at; names that say something do not repeat so often.
const MAX_STARTS: usize = 16;

/// What a name says of a joint, before its neighbours are looked at.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Named {
    /// Twist, share, finger and face joints, ends: no joint to drive a part with.
    Helper,
    Hips,
    Spine,
    Neck,
    Head,
    Tail,
    Limb(Word, Side),
}

/// What the name of a sided joint says.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Word {
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

/// Which bone of a limb begins at a joint.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Role {
    Collar,
    Upper,
    Lower,
    End,
    Toe,
}

/// The joints of a limb as their names tell them; the rest is left to the shape.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Found {
    pub(super) collar: Option<usize>,
    pub(super) upper: Option<usize>,
    pub(super) lower: Option<usize>,
    pub(super) end: Option<usize>,
    pub(super) toe: Option<usize>,
}

/// What the names of all joints say.
pub(super) fn named(skeleton: &Skeleton) -> Vec<Option<Named>> {
    plain_names(skeleton).into_iter().map(name).collect()
}

fn name(name: &str) -> Option<Named> {
    use Term as T;
    // MakeHuman writes helpers that only carry a joint elsewhere as `__UpLeg_L`.
    if name.starts_with("__") {
        return Some(Named::Helper);
    }
    let terms = words::terms(name);
    let has = |term: Term| terms.contains(&term);
    let any = |wanted: &[Term]| terms.iter().any(|term| wanted.contains(term));
    let finger = has(T::Middle) && !any(&[T::Body, T::Chest, T::Belly, T::Back, T::Neck]);
    if any(&[T::Helper, T::Detail, T::Face, T::Skirt]) || finger {
        return Some(Named::Helper);
    }
    let side = match (has(T::Left), has(T::Right)) {
        (true, false) => Some(Side::Left),
        (false, true) => Some(Side::Right),
        _ => None,
    };
    if let Some(side) = side {
        return limb_word(&terms).map(|word| Named::Limb(word, side));
    }
    if any(&[T::Hips, T::Hip]) || has(T::Lower) && has(T::Body) {
        Some(Named::Hips)
    } else if has(T::Head) {
        Some(Named::Head)
    } else if has(T::Neck) {
        Some(Named::Neck)
    } else if has(T::Tail) {
        Some(Named::Tail)
    } else if any(&[T::Body, T::Chest, T::Belly, T::Back, T::Waist]) {
        Some(Named::Spine)
    } else {
        None
    }
}

fn limb_word(terms: &[Term]) -> Option<Word> {
    use Term as T;
    let has = |term: Term| terms.contains(&term);
    let low = has(T::Lower);
    Some(if has(T::Toe) || has(T::Fore) && has(T::Foot) {
        Word::Toe
    } else if has(T::Foot) {
        Word::Foot
    } else if has(T::Hand) {
        Word::Hand
    } else if has(T::LowerArm) || has(T::Arm) && (low || has(T::Fore)) {
        Word::LowerArm
    } else if has(T::UpperArm) || has(T::Arm) && has(T::Upper) {
        Word::UpperArm
    } else if has(T::Shin) || has(T::Leg) && low {
        Word::Shin
    } else if has(T::Thigh) || has(T::Leg) && has(T::Upper) {
        Word::Thigh
    } else if has(T::Arm) {
        Word::Arm
    } else if has(T::Leg) {
        Word::Leg
    } else if has(T::Collar) {
        Word::Collar
    } else if has(T::Shoulder) {
        Word::Shoulder
    } else if has(T::Hip) {
        Word::Hip
    } else {
        return None;
    })
}

/// The limb of a class and side that names tell; the one with the most bones where there are several.
pub(super) fn limb(
    tree: &Tree,
    names: &[&str],
    named: &[Option<Named>],
    class: Class,
    side: Side,
) -> Option<Found> {
    let roles = roles(tree, named, class, side);
    let start = (0..tree.len())
        .filter(|joint| matches!(roles[*joint], Some(Role::Upper)))
        .filter(|joint| !continues(tree, names, *joint))
        .take(MAX_STARTS)
        .map(|joint| (joint, found(tree, &roles, joint)))
        // The first of the best, nearest to the root.
        .reduce(|best, other| {
            let bones = |found: &Found| {
                usize::from(found.lower.is_some()) + usize::from(found.end.is_some())
            };
            let better =
                (bones(&other.1), tree.depths[best.0]) > (bones(&best.1), tree.depths[other.0]);
            if better { other } else { best }
        })?;
    Some(start.1)
}

/// Whether a joint is the next of a run of one name whose number goes on: `UpArm2` on `UpArm1`.
fn continues(tree: &Tree, names: &[&str], joint: usize) -> bool {
    let plain = |joint: usize| {
        let mut words = names::split(names[joint]);
        words.retain(|word| !names::is_number(word));
        words
    };
    tree.parents[joint].is_some_and(|parent| {
        names[parent] != names[joint]
            && !names[parent].starts_with("__")
            && plain(parent) == plain(joint)
    })
}

/// Which bones of one limb begin at the joints.
fn roles(tree: &Tree, named: &[Option<Named>], class: Class, side: Side) -> Vec<Option<Role>> {
    let word = |joint: usize| match named[joint] {
        Some(Named::Limb(word, its)) if its == side => Some(word),
        _ => None,
    };
    let follows = |wanted: &[Word]| {
        let mut below = vec![false; tree.len()];
        for joint in (0..tree.len()).rev() {
            if let Some(parent) = tree.parents[joint] {
                below[parent] |=
                    below[joint] || word(joint).is_some_and(|word| wanted.contains(&word));
            }
        }
        below
    };
    let arm_follows = follows(&[Word::Arm, Word::UpperArm]);
    let thigh_follows = follows(&[Word::Thigh]);
    let upper_arm = (0..tree.len()).any(|joint| word(joint) == Some(Word::UpperArm));
    let hip_is_thigh = |joint: usize| !thigh_follows[joint];
    let thigh = (0..tree.len()).any(|joint| match word(joint) {
        Some(Word::Thigh) => true,
        Some(Word::Hip) => hip_is_thigh(joint),
        _ => false,
    });
    (0..tree.len())
        .map(|joint| {
            let word = word(joint)?;
            Some(match (class, word) {
                (Class::Arm, Word::Collar) => Role::Collar,
                (Class::Arm, Word::Shoulder) if arm_follows[joint] => Role::Collar,
                (Class::Arm, Word::Shoulder | Word::UpperArm) => Role::Upper,
                (Class::Arm, Word::Arm) if upper_arm => Role::Lower,
                (Class::Arm, Word::Arm) => Role::Upper,
                (Class::Arm, Word::LowerArm) => Role::Lower,
                (Class::Arm, Word::Hand) => Role::End,
                (Class::Leg, Word::Hip) if !hip_is_thigh(joint) => Role::Collar,
                (Class::Leg, Word::Hip | Word::Thigh) => Role::Upper,
                (Class::Leg, Word::Leg) if thigh => Role::Lower,
                (Class::Leg, Word::Leg) => Role::Upper,
                (Class::Leg, Word::Shin) => Role::Lower,
                (Class::Leg, Word::Foot) => Role::End,
                (Class::Leg, Word::Toe) => Role::Toe,
                _ => return None,
            })
        })
        .collect()
}

/// The joints of the limb that begins at a joint.
fn found(tree: &Tree, roles: &[Option<Role>], upper: usize) -> Found {
    let first_below = |above: usize, role: Role| {
        let inside = tree.branch(above);
        (above + 1..tree.len())
            .filter(|joint| inside[*joint] && roles[*joint] == Some(role))
            .min_by_key(|joint| (tree.depths[*joint], *joint))
    };
    let lower = first_below(upper, Role::Lower);
    let end = first_below(lower.unwrap_or(upper), Role::End);
    Found {
        collar: tree
            .upward(upper)
            .skip(1)
            .find(|joint| roles[*joint] == Some(Role::Collar)),
        upper: Some(upper),
        lower,
        end,
        toe: first_below(end.or(lower).unwrap_or(upper), Role::Toe),
    }
}
