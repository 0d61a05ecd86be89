//! What an arm holds: a broom, a pan, a banner. It is no piece of the arm, and turns with the hand only.

use crate::math;
use typed_index_collections::{TiSlice, TiVec};

use super::figure::Drafts;
use super::part_tree::PartTree;
use super::{Class, FigurePartId};
use crate::anatomy::Term;

/// What is longer than this share of the arm is held.
const LONG: f64 = 0.5;
/// What points elsewhere than the arm, by more than this many degrees, is held.
const ASIDE: f64 = 40.0;
/// What is not this much longer than wide points nowhere, as a fist.
const SLENDER: f64 = 1.5;
/// What is held reaches beyond the hand at both sides by at least this share of its own length.
const BEYOND: f64 = 0.1;
/// A forearm is at least and at most this much as wide as the arm above it, and at most as long.
const FOREARM: [f64; 2] = [0.5, 1.5];
/// The most pieces of an arm that are measured.
const MAX_PIECES: usize = 8;

/// Per part whether one of those that hang on it is a hand by its name.
pub(super) fn with_hands(tree: &PartTree<'_>, drafts: &Drafts) -> TiVec<FigurePartId, bool> {
    let is_hand = |part: &FigurePartId| drafts[*part].says(&[Term::Hand]);
    let children = tree.children.iter();
    children
        .map(|children| children.iter().any(is_hand))
        .collect()
}

/// Why an arm holds a part, for people to read: it hangs on a hand, or on an arm without one, and is no piece of it. `None` if it is
/// a piece of the arm, or hangs on something else. What is above the part must have its class.
pub(super) fn by_arm(
    tree: &PartTree<'_>,
    drafts: &Drafts,
    with_hands: &TiSlice<FigurePartId, bool>,
    part: FigurePartId,
) -> Option<String> {
    let above = tree.parents[part].filter(|above| drafts[*above].class == Some(Class::Arm))?;
    let is_hand = |part: FigurePartId| drafts[part].says(&[Term::Hand]);
    if drafts[part].says(&[Term::Upper, Term::Lower, Term::Fore]) {
        return None;
    }
    // An arm without a name may have any number of pieces, and an upper arm has another one.
    let is_end = is_hand(above)
        || drafts[above].named
            && !drafts[above].says(&[Term::UpperArm, Term::Upper, Term::Shoulder, Term::Collar])
            && !with_hands[above];
    let [near, far] = tree.ends(part);
    let way = far - near;
    let length = way.length();
    let along = way.try_normalize()?;
    let arm = pieces(tree, drafts, above);
    let whole: f64 = arm
        .iter()
        .map(|piece| tree.joint(*piece).distance(tree.tip(*piece)))
        .sum();
    // The hand itself, or the end of the arm.
    let (hand, half) = if is_hand(above) {
        (tree.middle(above), tree.size(above).max_element() / 2.0)
    } else {
        (tree.tip(above), tree.parts[above].width / 2.0)
    };
    let past = half + BEYOND * length;
    let crosses = (hand - near).dot(along) > past && (far - hand).dot(along) > past;
    let name = tree.name(part);
    let holder = tree.name(above);
    let held = |why: &str| Some(format!("held by `{holder}`: `{name}` {why}"));
    // What goes on where the arm ends, and is about as wide and as long as that, is its forearm, whatever it is called.
    let alike =
        |own: f64, arms: f64, range: [f64; 2]| (range[0]..=range[1]).contains(&(own / arms));
    let goes_on = !is_hand(above)
        && near.distance(hand).min(far.distance(hand)) <= tree.parts[above].width
        && alike(tree.parts[part].width, tree.parts[above].width, FOREARM)
        && length <= FOREARM[1] * whole;
    if goes_on {
        return None;
    }
    if crosses && (is_end || !drafts[above].named) {
        return held("reaches beyond the hand at both sides");
    }
    if !is_end {
        return None;
    }
    if length > LONG * whole {
        return held("is longer than half the arm");
    }
    // A hand may be bent; the arm is what it hangs on.
    let bone = if is_hand(above) && arm.len() > 1 {
        arm[1]
    } else {
        above
    };
    let axis = tree.tip(bone) - tree.joint(bone);
    let angle = math::angle_to(axis, way).abs().to_degrees();
    let angle = angle.min(180.0 - angle);
    let is_slender = length > SLENDER * tree.parts[part].width;
    // A thumb that is called one points aside too.
    if angle > ASIDE && is_slender && !drafts[part].detail {
        return held(&format!("points {angle:.0}° away from the arm"));
    }
    None
}

/// A piece of an arm, and the pieces between it and the trunk.
fn pieces(tree: &PartTree<'_>, drafts: &Drafts, last: FigurePartId) -> Vec<FigurePartId> {
    let above = |part: &FigurePartId| {
        let above = tree.parents[*part]?;
        (drafts[above].class == Some(Class::Arm)).then_some(above)
    };
    std::iter::successors(Some(last), above)
        .take(MAX_PIECES)
        .collect()
}
