//! Finds the limbs of a skeleton by its shape: the two longest mirrored pairs of chains.

use crate::math;
use typed_index_collections::TiSlice;

use super::joint_names::LimbJoints;
use super::joint_tree::JointTree;
use crate::mocap::{JointId, Pose, Transform};

/// Two chains are mirrored if the lengths of their bones differ by at most this share of the chain, summed up.
const MIRRORED: f64 = 0.1;
/// How many bones of a chain are compared, from the trunk outward: those beyond are fingers and toes, where the longest may
/// differ by chance.
const COMPARED: usize = 4;
/// How many chains of similar length a chain is compared with; bounds the work at joints with very many branches.
const NEIGHBORS: usize = 8;
/// The most joints of a chain. No limb has so many; a longer thread is not one.
const MAX_CHAIN: usize = 64;
/// Bones shorter than this share of their chain are only offsets.
const SHORT: f64 = 0.02;
/// Two bones whose angle is never greater than this many degrees are one.
const STRAIGHT: f64 = 1.0;
/// So many poses tell where a chain bends: the offset pose alone may be stretched.
const FEWEST_POSES: usize = 3;
/// Upper bone, lower bone, and hand or foot.
const FEWEST_BONES: usize = 3;
/// A single pair that branches off at most this many joints below the root is the legs.
const LEGS_DEPTH: usize = 1;

/// Two mirrored chains.
#[derive(Debug, Clone, Copy)]
pub(super) struct Pair {
    /// The joint where they branch.
    branch: JointId,
    /// The first joint of each.
    starts: [JointId; 2],
    /// The length of the shorter one.
    length: f64,
}

/// The pairs of arms and legs.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Limbs {
    pub(super) arms: Option<[JointId; 2]>,
    pub(super) legs: Option<[JointId; 2]>,
}

/// The two longest mirrored pairs of chains. The pair that branches off nearer to the root is the legs; of two at the same
/// depth, the longer one.
pub(super) fn limbs(tree: &JointTree) -> Limbs {
    let mut pairs: Vec<Pair> = tree
        .joints()
        .flat_map(|joint| pairs_at(tree, joint))
        .collect();
    pairs.sort_by(|a, b| b.length.total_cmp(&a.length).then(a.starts.cmp(&b.starts)));
    let Some(first) = pairs.first().copied() else {
        return Limbs::default();
    };
    let second = pairs[1..]
        .iter()
        .copied()
        .find(|pair| are_separate(tree, &first, pair));
    match second {
        Some(second) => {
            let [a, b] = [first, second].map(|pair| tree.depths[pair.branch]);
            let (legs, arms) = if b < a {
                (second, first)
            } else {
                (first, second)
            };
            Limbs {
                arms: Some(arms.starts),
                legs: Some(legs.starts),
            }
        }
        None if tree.depths[first.branch] <= LEGS_DEPTH => Limbs {
            arms: None,
            legs: Some(first.starts),
        },
        None => Limbs {
            arms: Some(first.starts),
            legs: None,
        },
    }
}

/// The mirrored pairs that branch off at a joint, each child in at most one; only the two longest, since there are no more
/// limbs.
fn pairs_at(tree: &JointTree, branch: JointId) -> Vec<Pair> {
    let mut children = tree.children[branch].clone();
    children.retain(|child| tree.reaches[*child] > 0.0);
    children.sort_by(|a, b| tree.reaches[*b].total_cmp(&tree.reaches[*a]).then(a.cmp(b)));
    let mut taken = vec![false; children.len()];
    let mut pairs = Vec::new();
    for first in 0..children.len() {
        let near = first + 1..children.len().min(first + 1 + NEIGHBORS);
        let second = near
            .filter(|second| !taken[*second])
            .find(|second| mirrored(tree, children[first], children[*second]));
        if let Some(second) = second.filter(|_| !taken[first]) {
            taken[second] = true;
            let [a, b] = [children[first], children[second]];
            pairs.push(Pair {
                branch,
                starts: [a.min(b), a.max(b)],
                length: tree.reaches[a].min(tree.reaches[b]),
            });
            if pairs.len() == 2 {
                break;
            }
        }
    }
    pairs
}

fn mirrored(tree: &JointTree, a: JointId, b: JointId) -> bool {
    let longer = tree.reaches[a].max(tree.reaches[b]);
    let allowed = MIRRORED * longer;
    let [small, large] = {
        let (a, b) = (tree.sizes[a], tree.sizes[b]);
        [a.min(b), a.max(b)]
    };
    if (tree.reaches[a] - tree.reaches[b]).abs() > allowed || small * 2 < large {
        return false;
    }
    let [a, b] = [a, b].map(|start| bones(tree, start));
    let (Some(a), Some(b)) = (a, b) else {
        return false;
    };
    let differences = a
        .iter()
        .zip(&b)
        .take(COMPARED)
        .map(|(a, b)| (a.length - b.length).abs());
    a.len().min(COMPARED) == b.len().min(COMPARED) && differences.sum::<f64>() <= allowed
}

/// Whether neither pair is attached to a chain of the other, so that both can be limbs.
fn are_separate(tree: &JointTree, a: &Pair, b: &Pair) -> bool {
    let on = |inner: &Pair, outer: &Pair| {
        outer.starts.iter().any(|start| {
            tree.is_below(inner.branch, *start) || inner.starts.iter().any(|inner| inner == start)
        })
    };
    !on(a, b) && !on(b, a)
}

/// A bone of a chain: its first joint and its length.
#[derive(Debug, Clone, Copy)]
struct Bone {
    joint: JointId,
    length: f64,
}

/// The bones of the longest chain that begins at a joint. A short bone is merged with the long one that follows it: the result
/// begins where the short one does, except at the start of the chain, where it begins where the long one does. `None` for a
/// chain of too many joints.
fn bones(tree: &JointTree, start: JointId) -> Option<Vec<Bone>> {
    let short = SHORT * tree.reaches[start];
    let chain: Vec<JointId> = tree.chain(start).take(MAX_CHAIN + 1).collect();
    if chain.len() > MAX_CHAIN {
        return None;
    }
    let mut bones: Vec<Bone> = Vec::new();
    let mut first_short = None;
    for (index, joint) in chain.iter().enumerate() {
        let next = chain.get(index + 1).map(|next| tree.bones[*next]);
        let length = next.unwrap_or(tree.reaches[*joint]);
        if length > short {
            let begins = first_short.take().filter(|_| !bones.is_empty());
            bones.push(Bone {
                joint: begins.unwrap_or(*joint),
                length,
            });
        } else {
            first_short = first_short.or(Some(*joint));
        }
    }
    Some(bones)
}

/// Joins bones between which no pose bends, as long as an upper bone, a lower bone and an end are left. Few poses say nothing.
fn joined(tree: &JointTree, mut bones: Vec<Bone>, poses: &[Pose]) -> Vec<Bone> {
    if poses.len() < FEWEST_POSES {
        return bones;
    }
    let mut index = 1;
    while index < bones.len() && bones.len() > FEWEST_BONES {
        let [before, own] = [bones[index - 1].joint, bones[index].joint];
        let bends = match tree.chain(own).nth(1) {
            Some(next) => poses
                .iter()
                .any(|pose| bend(pose, [before, own, next]) > STRAIGHT),
            None => true,
        };
        if bends {
            index += 1;
        } else {
            bones[index - 1].length += bones[index].length;
            bones.remove(index);
        }
    }
    bones
}

/// The angle between the bones from one joint to the next and from there to the third, degrees; 0 without length.
fn bend(pose: &TiSlice<JointId, Transform>, joints: [JointId; 3]) -> f64 {
    let [a, b, c] = joints.map(|joint| pose[joint].position);
    let angle = math::angle_between(b - a, c - b).to_degrees();
    if angle.is_finite() { angle } else { 0.0 }
}

/// Assigns the bones of the chain that begins at a joint: upper and lower are the two neighbours with the greatest total
/// length. A bone before them is a collar bone. Bones between which no pose bends count as one, so elbows and knees are where
/// the motion bends, whatever joints for twists there are.
pub(super) fn segments(tree: &JointTree, start: JointId, poses: &[Pose]) -> LimbJoints {
    let Some(bones) = bones(tree, start) else {
        return LimbJoints::default();
    };
    let bones = joined(tree, bones, poses);
    let upper = (1..bones.len())
        .max_by(|a, b| {
            let sum = |index: usize| bones[index - 1].length + bones[index].length;
            // Of equal ones the first.
            sum(*a).total_cmp(&sum(*b)).then(b.cmp(a))
        })
        .map_or(0, |index| index - 1);
    let joint = |index: usize| bones.get(index).map(|bone| bone.joint);
    LimbJoints {
        collar: (upper > 0).then(|| bones[upper - 1].joint),
        upper: joint(upper),
        lower: joint(upper + 1),
        // A limb that ends in a joint without an end site has its hand there.
        end: joint(upper + 2).or_else(|| {
            let last = tree.chain(start).take(MAX_CHAIN).last()?;
            (joint(upper + 1)? != last).then_some(last)
        }),
        toe: None,
    }
}
