//! A skeleton as a tree, with lengths and depths for the search for limbs.

use glam::DVec3;
use typed_index_collections::{TiVec, ti_vec};

use super::Tip;
use crate::mocap::{JointId, Skeleton};

/// A skeleton as a tree. A parent that does not precede its child is ignored, so that no walk is endless.
#[derive(Debug)]
pub(crate) struct JointTree {
    pub(crate) parents: TiVec<JointId, Option<JointId>>,
    pub(crate) children: TiVec<JointId, Vec<JointId>>,
    /// Number of ancestors.
    pub(crate) depths: TiVec<JointId, usize>,
    /// Size of the subtree that begins at a joint.
    pub(crate) sizes: TiVec<JointId, usize>,
    /// Length of the longest chain that begins at a joint, including its end site.
    pub(crate) reaches: TiVec<JointId, f64>,
    /// Per joint the child that continues its longest chain.
    pub(crate) next: TiVec<JointId, Option<JointId>>,
    /// Length of the bone that leads to a joint.
    pub(crate) bones: TiVec<JointId, f64>,
    /// Per joint its longest end site: index and length.
    ends: TiVec<JointId, Option<(usize, f64)>>,
}

impl JointTree {
    pub(crate) fn new(skeleton: &Skeleton) -> Self {
        let joints = &skeleton.joints;
        let count = joints.len();
        let parents: TiVec<JointId, Option<JointId>> = joints
            .iter_enumerated()
            .map(|(id, joint)| joint.parent.filter(|parent| *parent < id))
            .collect();
        let mut children: TiVec<JointId, _> = ti_vec![Vec::new(); count];
        let mut depths: TiVec<JointId, usize> = ti_vec![0; count];
        for (id, parent) in parents.iter_enumerated() {
            if let Some(parent) = parent {
                children[*parent].push(id);
                depths[id] = depths[*parent] + 1;
            }
        }
        let bones: TiVec<JointId, f64> = joints.iter().map(|joint| length(joint.offset)).collect();
        let ends = joints.iter().map(|joint| {
            let lengths = joint.ends.iter().map(|end| length(*end)).enumerate();
            lengths
                .filter(|(_, length)| *length > 0.0)
                .reduce(|best, end| if end.1 > best.1 { end } else { best })
        });
        let ends: TiVec<JointId, Option<(usize, f64)>> = ends.collect();
        let mut sizes: TiVec<JointId, usize> = ti_vec![1; count];
        let mut reaches: TiVec<JointId, f64> = ends
            .iter()
            .map(|end| end.map_or(0.0, |end| end.1))
            .collect();
        let mut next: TiVec<JointId, Option<JointId>> = ti_vec![None; count];
        for id in parents.keys().rev() {
            let Some(parent) = parents[id] else {
                continue;
            };
            sizes[parent] += sizes[id];
            let reach = bones[id] + reaches[id];
            // Visited from last to first, so `>=` picks the first of equal ones.
            if reach >= reaches[parent] {
                reaches[parent] = reach;
                next[parent] = Some(id);
            }
        }
        Self {
            parents,
            children,
            depths,
            sizes,
            reaches,
            next,
            bones,
            ends,
        }
    }

    pub(crate) fn len(&self) -> usize {
        self.parents.len()
    }

    /// All joints.
    pub(crate) fn joints(&self) -> impl DoubleEndedIterator<Item = JointId> + use<> {
        self.parents.keys()
    }

    /// The joints from one up to its root, starting with itself.
    pub(crate) fn upward(&self, joint: JointId) -> impl Iterator<Item = JointId> {
        std::iter::successors(Some(joint), |joint| self.parents[*joint])
    }

    /// The joints of the longest chain that begins at a joint, starting with itself.
    pub(crate) fn chain(&self, joint: JointId) -> impl Iterator<Item = JointId> {
        std::iter::successors(Some(joint), |joint| self.next[*joint])
    }

    /// Whether a joint is `above` or a descendant of it.
    pub(crate) fn is_below(&self, joint: JointId, above: JointId) -> bool {
        self.upward(joint)
            .take_while(|joint| *joint >= above)
            .any(|joint| joint == above)
    }

    /// Per joint whether it is `above` or a descendant of it.
    pub(crate) fn branch(&self, above: JointId) -> TiVec<JointId, bool> {
        let mut inside: TiVec<JointId, bool> = ti_vec![false; self.len()];
        for joint in self.joints().filter(|joint| *joint >= above) {
            inside[joint] =
                joint == above || self.parents[joint].is_some_and(|parent| inside[parent]);
        }
        inside
    }

    /// The lowest common ancestor.
    pub(crate) fn common(&self, joints: impl IntoIterator<Item = JointId>) -> Option<JointId> {
        joints.into_iter().map(Some).reduce(|a, b| {
            let (mut a, mut b) = (a?, b?);
            // A parent precedes its child, so the later of two cannot be an ancestor of the other.
            while a != b {
                if a > b {
                    a = self.parents[a]?;
                } else {
                    b = self.parents[b]?;
                }
            }
            Some(a)
        })?
    }

    /// Where the bone of a joint ends: at the first joint of its longest chain that is not almost in the same place, or at the
    /// chain's end.
    pub(crate) fn bone_end(&self, joint: JointId) -> Option<Tip> {
        /// Joints nearer than this share of the chain count as the same place: the bones within a palm.
        const NEAR: f64 = 0.1;
        let mut last = joint;
        let mut away = 0.0;
        while let Some(next) = self.next[last] {
            away += self.bones[next];
            if away > self.reaches[joint] * NEAR {
                return Some(Tip::Joint(next));
            }
            last = next;
        }
        self.own_end(last)
    }

    /// Whether the file has any end sites.
    pub(crate) fn has_ends(&self) -> bool {
        self.ends.iter().any(Option::is_some)
    }

    /// The longest end site of a joint.
    pub(crate) fn own_end(&self, joint: JointId) -> Option<Tip> {
        self.ends[joint].map(|(end, _)| Tip::End { joint, end })
    }
}

/// The length of an offset; 0 if it is not a number or too large.
fn length(offset: DVec3) -> f64 {
    /// Longer bones would make sums infinite.
    const MAX_LENGTH: f64 = 1e100;
    let length = offset.length();
    if length < MAX_LENGTH { length } else { 0.0 }
}
