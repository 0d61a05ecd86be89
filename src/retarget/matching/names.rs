//! Joints that a part's string names with `Bone`.

use rustc_hash::FxHashMap;
use typed_index_collections::TiVec;

use super::{Drive, Follow, Problem, bone};
use crate::labels::{Anatomy, Class, FigurePartId, JointTree, LimbSegment, Tip, plain_names};
use crate::mocap::{JointId, Skeleton};

/// How many names are suggested for an unknown one.
const MAX_OFFERED: usize = 3;
/// For how many unknown names suggestions are searched; a figure with more has another problem.
const MAX_UNKNOWN: usize = 32;
/// Up to this many letters a name is compared with others, because that takes the product of both lengths.
const MAX_LETTERS: usize = 64;

/// An index of joints by name.
pub(super) struct Names<'a> {
    skeleton: &'a Skeleton,
    tree: JointTree,
    /// The names without the prefixes that most of them share.
    plain: TiVec<JointId, &'a str>,
    /// The joints of a name: as written, in lower case, and without prefixes in lower case.
    joints: [FxHashMap<String, Vec<JointId>>; 3],
}

impl<'a> Names<'a> {
    pub(super) fn new(skeleton: &'a Skeleton) -> Self {
        let plain = plain_names(skeleton);
        let mut joints: [FxHashMap<String, Vec<JointId>>; 3] = Default::default();
        for (joint, plain) in plain.iter_enumerated() {
            let own = &skeleton.joints[joint].name;
            let ways = [own.clone(), own.to_lowercase(), plain.to_lowercase()];
            for (joints, name) in joints.iter_mut().zip(ways) {
                joints.entry(name).or_default().push(joint);
            }
        }
        Self {
            skeleton,
            tree: JointTree::new(skeleton),
            plain,
            joints,
        }
    }

    /// The joints of a name: an exact match, else one that ignores case, else one that also ignores prefixes.
    pub(super) fn joints(&self, name: &str) -> &[JointId] {
        let [exact, lower, plain] = &self.joints;
        let in_lower = name.to_lowercase();
        exact
            .get(name)
            .or_else(|| lower.get(&in_lower))
            .or_else(|| plain.get(&in_lower))
            .map_or(&[], Vec::as_slice)
    }

    /// The drive that a part's string names; `None` if it names none that is usable.
    pub(super) fn bones(
        &self,
        part: FigurePartId,
        bones: &[String],
        class: Option<Class>,
        anatomy: &Anatomy,
        problems: &mut Vec<Problem>,
    ) -> Option<(Drive, String)> {
        if bones.len() > 2 {
            problems.push(Problem::TooManyBones { part });
        }
        let mut joints = Vec::new();
        for name in bones.iter().take(2) {
            let found = self.joints(name);
            if found.len() > 1 {
                problems.push(Problem::AmbiguousBone {
                    part,
                    name: name.clone(),
                    joints: found.to_vec(),
                });
            }
            match found.first() {
                Some(joint) => joints.push(*joint),
                None => problems.push(self.unknown(part, name, problems.len())),
            }
        }
        if joints.len() < bones.len().min(2) {
            return None;
        }
        let joint = *joints.first()?;
        let tip = match joints.get(1) {
            Some(to) if *to != joint => {
                if !self.tree.is_below(*to, joint) {
                    problems.push(Problem::NotAChain {
                        part,
                        from: joint,
                        to: *to,
                    });
                    return None;
                }
                Some(Tip::Joint(*to))
            }
            _ if class.is_some_and(Class::is_limb) => self.own_bone(joint, anatomy),
            _ => None,
        };
        let follow = if tip.is_some() {
            Follow::Direction
        } else {
            Follow::Change
        };
        let why = "its string names the joint with `Bone`".to_owned();
        Some((Drive { joint, tip, follow }, why))
    }

    /// The end of a joint's bone: as its limb has it, else where its longest chain continues.
    fn own_bone(&self, joint: JointId, anatomy: &Anatomy) -> Option<Tip> {
        let segments = [
            LimbSegment::Collar,
            LimbSegment::Upper,
            LimbSegment::Lower,
            LimbSegment::End,
        ];
        let of_limbs = anatomy
            .limbs
            .iter()
            .flat_map(|limb| segments.map(|segment| bone(limb, segment)));
        of_limbs
            .flatten()
            .find(|(from, _)| *from == joint)
            .map_or_else(|| self.tree.bone_end(joint), |(_, tip)| tip)
    }

    fn unknown(&self, part: FigurePartId, name: &str, before: usize) -> Problem {
        let lower: String = name.to_lowercase();
        let letters = lower.chars().count();
        let allowed = (letters / 3).max(1);
        let mut near: Vec<(usize, JointId)> = Vec::new();
        if before < MAX_UNKNOWN && letters <= MAX_LETTERS {
            for (joint, plain) in self.plain.iter_enumerated() {
                if plain.chars().count().abs_diff(letters) <= allowed {
                    let distance = strsim::damerau_levenshtein(&lower, &plain.to_lowercase());
                    if distance <= allowed && distance < letters {
                        near.push((distance, joint));
                    }
                }
            }
        }
        near.sort_unstable();
        let mut nearest: Vec<String> = Vec::new();
        for (_, joint) in near {
            let name = &self.skeleton.joints[joint].name;
            if nearest.len() < MAX_OFFERED && !nearest.contains(name) {
                nearest.push(name.clone());
            }
        }
        Problem::UnknownBone {
            part,
            name: name.to_owned(),
            nearest,
        }
    }
}
