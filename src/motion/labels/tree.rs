//! A skeleton as a tree, with what the search for limbs asks of it.

use glam::DVec3;

use super::Tip;
use crate::motion::skeleton::Skeleton;

/// A skeleton as a tree. A parent that does not stand before its child counts as none, so that no walk is endless.
#[derive(Debug)]
pub(crate) struct Tree {
    pub(crate) parents: Vec<Option<usize>>,
    pub(crate) children: Vec<Vec<usize>>,
    /// Steps from the root.
    pub(crate) depths: Vec<usize>,
    /// Joints of the branch that begins at a joint.
    pub(crate) sizes: Vec<usize>,
    /// Length of the longest chain that begins at a joint, its end bone included.
    pub(crate) reaches: Vec<f64>,
    /// Per joint the child that its longest chain goes on with.
    pub(crate) next: Vec<Option<usize>>,
    /// Length of the bone that leads to a joint.
    pub(crate) bones: Vec<f64>,
    /// Per joint its longest end bone: index and length.
    ends: Vec<Option<(usize, f64)>>,
}

impl Tree {
    pub(crate) fn new(skeleton: &Skeleton) -> Self {
        let joints = &skeleton.joints;
        let count = joints.len();
        let parents: Vec<Option<usize>> = joints
            .iter()
            .enumerate()
            .map(|(index, joint)| joint.parent.filter(|parent| *parent < index))
            .collect();
        let mut children = vec![Vec::new(); count];
        let mut depths = vec![0; count];
        for (index, parent) in parents.iter().enumerate() {
            if let Some(parent) = parent {
                children[*parent].push(index);
                depths[index] = depths[*parent] + 1;
            }
        }
        let bones: Vec<f64> = joints.iter().map(|joint| length(joint.offset)).collect();
        let ends = joints.iter().map(|joint| {
            let lengths = joint.ends.iter().map(|end| length(*end)).enumerate();
            lengths
                .filter(|(_, length)| *length > 0.0)
                .reduce(|best, end| if end.1 > best.1 { end } else { best })
        });
        let ends: Vec<Option<(usize, f64)>> = ends.collect();
        let mut sizes = vec![1; count];
        let mut reaches: Vec<f64> = ends
            .iter()
            .map(|end| end.map_or(0.0, |end| end.1))
            .collect();
        let mut next: Vec<Option<usize>> = vec![None; count];
        for index in (0..count).rev() {
            let Some(parent) = parents[index] else {
                continue;
            };
            sizes[parent] += sizes[index];
            let reach = bones[index] + reaches[index];
            // Of equal ones the first: they come from the last.
            if reach >= reaches[parent] {
                reaches[parent] = reach;
                next[parent] = Some(index);
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

    /// The joints from one up to its root, itself first.
    pub(crate) fn upward(&self, joint: usize) -> impl Iterator<Item = usize> {
        std::iter::successors(Some(joint), |joint| self.parents[*joint])
    }

    /// The joints of the longest chain that begins at a joint, itself first.
    pub(crate) fn chain(&self, joint: usize) -> impl Iterator<Item = usize> {
        std::iter::successors(Some(joint), |joint| self.next[*joint])
    }

    /// Whether a joint is another or hangs on it, however far.
    pub(crate) fn is_below(&self, joint: usize, above: usize) -> bool {
        self.upward(joint)
            .take_while(|joint| *joint >= above)
            .any(|joint| joint == above)
    }

    /// Per joint whether it is another or hangs on it.
    pub(crate) fn branch(&self, above: usize) -> Vec<bool> {
        let mut inside = vec![false; self.len()];
        for joint in above..self.len() {
            inside[joint] =
                joint == above || self.parents[joint].is_some_and(|parent| inside[parent]);
        }
        inside
    }

    /// The last joint that all of these are or hang on.
    pub(crate) fn common(&self, joints: impl IntoIterator<Item = usize>) -> Option<usize> {
        joints.into_iter().map(Some).reduce(|a, b| {
            let (mut a, mut b) = (a?, b?);
            // A parent stands before its child, so the later of two cannot be what the other hangs on.
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

    /// Where the bone of a joint ends: on its longest chain, at the first joint that is not almost in the same place, or at the
    /// chain's end.
    pub(crate) fn bone_end(&self, joint: usize) -> Option<Tip> {
        /// A joint nearer than this share of the chain is almost in the same place: the bones within a palm.
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

    /// Whether any bone ends without a joint, as the ends of all are written in most files.
    pub(crate) fn has_ends(&self) -> bool {
        self.ends.iter().any(Option::is_some)
    }

    /// The longest end of a joint.
    pub(crate) fn own_end(&self, joint: usize) -> Option<Tip> {
        self.ends[joint].map(|(end, _)| Tip::End { joint, end })
    }
}

/// The length of an offset; 0 where it is no number or beyond all measure.
fn length(offset: DVec3) -> f64 {
    /// Longer bones would make sums infinite.
    const LONGEST: f64 = 1e100;
    let length = offset.length();
    if length < LONGEST { length } else { 0.0 }
}
