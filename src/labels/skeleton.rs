//! Labels the joints of a skeleton: by name, and where names fail by the skeleton's shape.

use typed_index_collections::{TiSlice, TiVec, ti_vec};

use super::joint_names::{self, JointName, LimbJoints};
use super::joint_tree::JointTree;
use super::sides::Sides;
use super::topology;
use super::trunk;
use super::{Class, Label, LimbSegment, Side, Tip};
use crate::anatomy::{self, Term, name_words};
use crate::mocap::{Clip, JointId, Pose, Skeleton};

/// How many frames of a clip are used where its shape has to tell left from right.
const FRAMES: usize = 32;

/// What the joints of a skeleton are.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Anatomy {
    /// Per joint its label; `None` for helpers, fingers and faces.
    pub labels: TiVec<JointId, Option<Label>>,
    /// The limbs that were found: left arm, right arm, left leg, right leg.
    pub limbs: Vec<Limb>,
    /// The joint that carries the legs.
    pub hips: Option<JointId>,
    /// The joints of the trunk, from above the hips up to the chest, which carries the arms. Empty if arms and legs are
    /// attached to the same joint.
    pub spine: Vec<JointId>,
    /// The joints of the neck, bottom up.
    pub neck: Vec<JointId>,
    /// The head's joint.
    pub head: Option<JointId>,
    /// The joints of the tail, starting at the trunk.
    pub tail: Vec<JointId>,
}

impl Anatomy {
    /// The joint that carries the arms: the last one of the spine, else the hips.
    pub fn chest(&self) -> Option<JointId> {
        self.spine.last().copied().or(self.hips)
    }

    /// The joints that have a label: all but helpers, fingers and faces.
    pub fn labeled(&self) -> impl Iterator<Item = JointId> + '_ {
        let labels = self.labels.iter_enumerated();
        labels.filter_map(|(joint, label)| label.as_ref().map(|_| joint))
    }

    /// The limb of a class and a side; of several the rearmost one.
    pub fn limb(&self, class: Class, side: Side) -> Option<&Limb> {
        self.limb_of_pair(class, side, 0)
    }

    /// The limb of a class, a side and a pair.
    pub fn limb_of_pair(&self, class: Class, side: Side, pair: usize) -> Option<&Limb> {
        let mut limbs = self.limbs.iter();
        limbs.find(|limb| (limb.class, limb.side, limb.pair) == (class, side, pair))
    }

    /// How many pairs of legs it has.
    pub fn leg_pairs(&self) -> usize {
        let legs = self.limbs.iter().filter(|limb| limb.class == Class::Leg);
        legs.map(|leg| leg.pair + 1).max().unwrap_or(0)
    }
}

/// An arm or a leg of a skeleton.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Limb {
    /// Arm or leg.
    pub class: Class,
    /// Its side.
    pub side: Side,
    /// Which limb of its class and side: 0 is the rearmost. A skeleton from a file has one of each.
    pub pair: usize,
    /// Where the collar bone begins, or the bone that carries the thigh.
    pub collar: Option<JointId>,
    /// The shoulder or hip: where upper arm or thigh begins.
    pub upper: JointId,
    /// The elbow or knee.
    pub lower: Option<JointId>,
    /// The wrist or ankle.
    pub end: Option<JointId>,
    /// The joint of the toes.
    pub toe: Option<JointId>,
    /// The far end of its last bone: the hand or foot, or the last segment that exists.
    pub tip: Option<Tip>,
}

/// Labels the joints of a skeleton. If names do not tell left from right, its offset pose does.
#[cfg(test)]
pub(crate) fn label_skeleton(skeleton: &Skeleton) -> Anatomy {
    anatomy(skeleton, || vec![skeleton.offset_pose()])
}

/// Labels the joints of a clip's skeleton. If names do not tell left from right, its offset pose and up to 32 evenly spaced
/// frames do.
pub fn label_clip(clip: &Clip) -> Anatomy {
    let skeleton = &*clip.skeleton;
    anatomy(skeleton, || {
        let mut poses = vec![skeleton.offset_pose()];
        let count = clip.frames.min(FRAMES);
        poses.extend((0..count).map(|index| clip.pose(index * clip.frames / count)));
        poses
    })
}

/// The joint names without the prefixes that most of them share.
pub(crate) fn plain_names(skeleton: &Skeleton) -> TiVec<JointId, &str> {
    let names: Vec<&str> = skeleton
        .joints
        .iter()
        .map(|joint| joint.name.as_str())
        .collect();
    name_words::without_prefixes(&names, |prefix| !anatomy::terms(prefix).is_empty()).into()
}

fn anatomy(skeleton: &Skeleton, poses: impl FnOnce() -> Vec<Pose>) -> Anatomy {
    let tree = JointTree::new(skeleton);
    if tree.len() == 0 {
        return Anatomy::default();
    }
    let named = joint_names::named(skeleton);
    let limbs = limbs(skeleton, &tree, &named, poses);
    let mut anatomy = Anatomy {
        labels: ti_vec![None; tree.len()],
        limbs: limbs.iter().map(|(limb, _)| *limb).collect(),
        ..Anatomy::default()
    };
    trunk::fill(&tree, &named, &mut anatomy);
    anatomy.tail = tree
        .joints()
        .filter(|joint| named[*joint] == Some(JointName::Tail))
        .collect();
    write_labels(skeleton, &named, &limbs, &mut anatomy);
    anatomy
}

/// How a limb was found.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Source {
    Name,
    Shape,
}

/// The limbs, by name; if no name tells any of a class, by shape.
fn limbs(
    skeleton: &Skeleton,
    tree: &JointTree,
    named: &TiSlice<JointId, Option<JointName>>,
    poses: impl FnOnce() -> Vec<Pose>,
) -> Vec<(Limb, Source)> {
    let names: TiVec<JointId, &str> = skeleton
        .joints
        .iter()
        .map(|joint| joint.name.as_str())
        .collect();
    let by_name =
        |class: Class| Side::BOTH.map(|side| joint_names::limb(tree, &names, named, class, side));
    let [arms, legs] = [Class::Arm, Class::Leg].map(by_name);
    let has = |pair: &[Option<LimbJoints>; 2]| pair.iter().any(Option::is_some);
    let mut found = vec![
        (Class::Arm, arms, Source::Name),
        (Class::Leg, legs, Source::Name),
    ];
    if !has(&arms) || !has(&legs) {
        let shape = topology::limbs(tree);
        let known: Vec<JointId> = [arms, legs]
            .into_iter()
            .flatten()
            .flatten()
            .filter_map(|limb| limb.upper)
            .collect();
        // A pair that names have already assigned is not the other class as well.
        let free = |pair: &[JointId; 2]| {
            !pair.iter().any(|start| {
                known
                    .iter()
                    .any(|known| tree.is_below(*known, *start) || tree.is_below(*start, *known))
            })
        };
        let [arm_pair, leg_pair] = match (has(&arms), has(&legs)) {
            (false, false) => [shape.arms, shape.legs],
            (false, true) => [shape.arms.filter(free).or(shape.legs.filter(free)), None],
            _ => [None, shape.legs.filter(free).or(shape.arms.filter(free))],
        };
        let pairs = sides_of_pairs(skeleton, tree, [arm_pair, leg_pair], &poses());
        for (slot, pair) in found.iter_mut().zip(pairs) {
            if let Some(pair) = pair {
                (slot.1, slot.2) = (pair.map(Some), Source::Shape);
            }
        }
    }
    let mut limbs = Vec::new();
    for (class, pair, source) in found {
        for (side, found) in Side::BOTH.into_iter().zip(pair) {
            if let Some(limb) =
                found.and_then(|found| completed(skeleton, tree, named, class, side, found))
            {
                limbs.push((limb, source));
            }
        }
    }
    limbs
}

/// Pairs of chains as limbs, the left one first.
fn sides_of_pairs(
    skeleton: &Skeleton,
    tree: &JointTree,
    pairs: [Option<[JointId; 2]>; 2],
    poses: &[Pose],
) -> [Option<[LimbJoints; 2]>; 2] {
    let found =
        pairs.map(|pair| pair.map(|pair| pair.map(|start| topology::segments(tree, start, poses))));
    let [arms, legs] = found.map(|pair| pair.map_or(Vec::new(), Vec::from));
    let branch = |limbs: Option<[JointId; 2]>| limbs.and_then(|[start, _]| tree.parents[start]);
    let low = branch(pairs[1]).unwrap_or_default();
    let high = branch(pairs[0])
        .unwrap_or_else(|| tree.chain(JointId::default()).last().unwrap_or_default());
    let sides = Sides {
        skeleton,
        tree,
        arms: &arms,
        legs: &legs,
        trunk: [low, high],
    };
    let mut sorted = found;
    for pair in sorted.iter_mut().flatten() {
        let [Some(a), Some(b)] = [pair[0].upper, pair[1].upper] else {
            continue;
        };
        if !sides.first_is_left([a, b], poses) {
            pair.reverse();
        }
    }
    sorted
}

/// Completes a limb: joints that no name tells are found by shape.
fn completed(
    skeleton: &Skeleton,
    tree: &JointTree,
    named: &TiSlice<JointId, Option<JointName>>,
    class: Class,
    side: Side,
    found: LimbJoints,
) -> Option<Limb> {
    let upper = found.upper?;
    let useful = |joint: &JointId| named[*joint] != Some(JointName::Helper);
    let (mut lower, mut end) = (found.lower, found.end);
    if lower.is_none() {
        match end {
            Some(end) => {
                lower = tree
                    .upward(end)
                    .skip(1)
                    .take_while(|joint| *joint != upper)
                    .filter(useful)
                    .last();
            }
            None => {
                let segments = topology::segments(tree, upper, &[]);
                if segments.upper == Some(upper) {
                    lower = segments.lower.filter(useful);
                    end = segments.end.filter(|end| useful(end) && lower.is_some());
                }
            }
        }
    } else if end.is_none() {
        end = lower.and_then(|lower| tree.chain(lower).skip(1).find(useful));
    }
    let toe = match (class, end.map(|end| tree.bone_end(end))) {
        (Class::Leg, Some(Some(Tip::Joint(joint)))) => found.toe.or(Some(joint).filter(useful)),
        _ => found.toe,
    };
    Some(Limb {
        class,
        side,
        pair: 0,
        collar: found.collar,
        upper,
        lower,
        end,
        toe,
        tip: toe
            .or_else(|| middle_finger(skeleton, tree, end?))
            .map(Tip::Joint)
            .or_else(|| tree.bone_end(end.or(lower).unwrap_or(upper))),
    })
}

/// The joint of the middle finger, which a hand points to.
fn middle_finger(skeleton: &Skeleton, tree: &JointTree, hand: JointId) -> Option<JointId> {
    let name = |joint: JointId| skeleton.joints[joint].name.as_str();
    tree.children[hand]
        .iter()
        .copied()
        .filter(|joint| tree.bones[*joint] > 0.0 && !name(*joint).starts_with("__"))
        .find(|joint| anatomy::terms(name(*joint)).contains(&Term::Middle))
}

fn write_labels(
    skeleton: &Skeleton,
    named: &TiSlice<JointId, Option<JointName>>,
    limbs: &[(Limb, Source)],
    anatomy: &mut Anatomy,
) {
    let mut labels: TiVec<JointId, Option<Label>> = ti_vec![None; skeleton.joints.len()];
    let mut put =
        |joint: JointId, class: Class, side: Option<Side>, segment: LimbSegment, why: &str| {
            let name = &skeleton.joints[joint].name;
            let side_name = side.map_or(String::new(), |side| format!("{} ", side.name()));
            labels[joint] = Some(Label {
                class,
                side,
                segment,
                pair: 0,
                why: format!("`{name}` is the {side_name}{} {why}", segment.name(class)),
            });
        };
    let by = |joint: JointId| match named[joint] {
        Some(JointName::Helper | JointName::Limb(..)) | None => "by its place in the skeleton",
        Some(_) => "by its name",
    };
    for joint in &anatomy.tail {
        put(*joint, Class::Tail, None, LimbSegment::Whole, by(*joint));
    }
    for joint in &anatomy.spine {
        put(*joint, Class::Body, None, LimbSegment::Whole, by(*joint));
    }
    for joint in &anatomy.neck {
        put(*joint, Class::Neck, None, LimbSegment::Whole, by(*joint));
    }
    for (joint, class) in [(anatomy.head, Class::Head), (anatomy.hips, Class::Hips)] {
        if let Some(joint) = joint {
            put(joint, class, None, LimbSegment::Whole, by(joint));
        }
    }
    for (limb, source) in limbs {
        let segments = [
            (limb.collar, LimbSegment::Collar),
            (Some(limb.upper), LimbSegment::Upper),
            (limb.lower, LimbSegment::Lower),
            (limb.end, LimbSegment::End),
            (limb.toe, LimbSegment::Beyond),
        ];
        for (joint, segment) in segments {
            if let Some(joint) = joint {
                let why = match (source, named[joint]) {
                    (Source::Name, Some(JointName::Limb(..))) => "by its name",
                    (Source::Name, _) => "by its place in the skeleton",
                    (Source::Shape, _) => "by the skeleton's shape: its names do not tell",
                };
                put(joint, limb.class, Some(limb.side), segment, why);
            }
        }
    }
    anatomy.labels = labels;
}
