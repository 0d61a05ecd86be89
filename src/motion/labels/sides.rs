//! Left and right of a skeleton whose names do not tell them.

use glam::DVec3;

use super::Tip;
use super::roles::Found;
use super::tree::Tree;
use crate::motion::skeleton::{Placed, Skeleton};

/// A front shorter than this share of a leg tells nothing: so much comes from a trunk that is not quite upright.
const UNDECIDED: f64 = 0.03;

/// What tells front from behind.
#[derive(Debug)]
pub(super) struct Sides<'a> {
    pub(super) skeleton: &'a Skeleton,
    pub(super) tree: &'a Tree,
    pub(super) arms: &'a [Found],
    pub(super) legs: &'a [Found],
    /// The joints at the lower and the upper end of the trunk.
    pub(super) trunk: [usize; 2],
}

impl Sides<'_> {
    /// Whether the first of two mirrored limbs, told by a joint of each, is the left one.
    ///
    /// Up runs from the feet to the trunk, front is where the feet point, where the knees bend to and, half as much, where the
    /// elbows bend from; left is up × front. Each pose has a vote of the strength of its front. Where nothing tells, left is +x,
    /// as most BVH files have it.
    pub(super) fn first_is_left(&self, pair: [usize; 2], poses: &[Vec<Placed>]) -> bool {
        let across = |pose: &[Placed]| pose[pair[0]].position - pose[pair[1]].position;
        let votes: f64 = poses
            .iter()
            .map(|pose| {
                let up = self.up(pose);
                let front = self.front(pose, up);
                let front = if front.length() < UNDECIDED {
                    DVec3::ZERO
                } else {
                    front
                };
                up.cross(front).dot(across(pose).normalize_or_zero())
            })
            .filter(|vote| vote.is_finite())
            .sum();
        if votes != 0.0 {
            return votes > 0.0;
        }
        let to_the_left = poses.iter().map(|pose| across(pose).x);
        to_the_left.filter(|x| x.is_finite()).sum::<f64>() >= 0.0
    }

    fn up(&self, pose: &[Placed]) -> DVec3 {
        let feet: Vec<DVec3> = self
            .legs
            .iter()
            .filter_map(|leg| Some(pose[leg.end.or(leg.lower)?].position))
            .collect();
        let low = if feet.is_empty() {
            pose[self.trunk[0]].position
        } else {
            feet.iter().sum::<DVec3>() / feet.len() as f64
        };
        (pose[self.trunk[1]].position - low).normalize_or_zero()
    }

    fn front(&self, pose: &[Placed], up: DVec3) -> DVec3 {
        let mut front = DVec3::ZERO;
        for leg in self.legs {
            front += self.foot(leg, pose).unwrap_or_default() + bend(leg, pose);
        }
        for arm in self.arms {
            front -= bend(arm, pose) / 2.0;
        }
        front - up * front.dot(up)
    }

    /// The foot up to the toes' end as a vector, in lengths of its leg.
    fn foot(&self, leg: &Found, pose: &[Placed]) -> Option<DVec3> {
        let [hip, ankle] = [leg.upper?, leg.end?];
        let last = self.tree.chain(ankle).last()?;
        let toes = self.tree.own_end(last).unwrap_or(Tip::Joint(last));
        let toes = toes.place(self.skeleton, pose);
        let length = pose[ankle].position.distance(pose[hip].position);
        let foot = (toes - pose[ankle].position) / length;
        foot.is_finite().then(|| foot.clamp_length_max(1.0))
    }
}

/// How far the middle joint of a limb stands off the line from its first to its last, in lengths of that line.
fn bend(limb: &Found, pose: &[Placed]) -> DVec3 {
    let (Some(upper), Some(lower), Some(end)) = (limb.upper, limb.lower, limb.end) else {
        return DVec3::ZERO;
    };
    let line = pose[end].position - pose[upper].position;
    let off = pose[lower].position - pose[upper].position;
    let bend = (off - line * (off.dot(line) / line.length_squared())) / line.length();
    if bend.is_finite() {
        bend.clamp_length_max(1.0)
    } else {
        DVec3::ZERO
    }
}
