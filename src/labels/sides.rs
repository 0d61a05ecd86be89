//! Tells left from right in a skeleton whose names do not.

use glam::DVec3;
use typed_index_collections::TiSlice;

use super::Tip;
use super::joint_names::LimbJoints;
use super::joint_tree::JointTree;
use crate::mocap::{JointId, Pose, Skeleton, Transform};

/// A front vector shorter than this share of a leg says nothing: a trunk that leans a little gives as much.
const UNDECIDED: f64 = 0.03;

/// What tells the front of a body from its back.
#[derive(Debug)]
pub(super) struct Sides<'a> {
    pub(super) skeleton: &'a Skeleton,
    pub(super) tree: &'a JointTree,
    pub(super) arms: &'a [LimbJoints],
    pub(super) legs: &'a [LimbJoints],
    /// The joints at the lower and upper end of the trunk.
    pub(super) trunk: [JointId; 2],
}

impl Sides<'_> {
    /// Whether the first of two mirrored limbs, each given by one of its joints, is the left one.
    ///
    /// Up points from the feet to the trunk. Front is where the feet point and the knees bend to, and, with half the weight,
    /// opposite to where the elbows bend. Left is up × front. Each pose votes with the length of its front vector. Without any
    /// vote left is +x, as in most BVH files.
    pub(super) fn first_is_left(&self, pair: [JointId; 2], poses: &[Pose]) -> bool {
        let across =
            |pose: &TiSlice<JointId, Transform>| pose[pair[0]].position - pose[pair[1]].position;
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

    fn up(&self, pose: &TiSlice<JointId, Transform>) -> DVec3 {
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

    fn front(&self, pose: &TiSlice<JointId, Transform>, up: DVec3) -> DVec3 {
        let mut front = DVec3::ZERO;
        for leg in self.legs {
            front += self.foot(leg, pose).unwrap_or_default() + bend(leg, pose);
        }
        for arm in self.arms {
            front -= bend(arm, pose) / 2.0;
        }
        front - up * front.dot(up)
    }

    /// The vector from the ankle to the end of the toes, in leg lengths.
    fn foot(&self, leg: &LimbJoints, pose: &TiSlice<JointId, Transform>) -> Option<DVec3> {
        let [hip, ankle] = [leg.upper?, leg.end?];
        let last = self.tree.chain(ankle).last()?;
        let toes = self.tree.own_end(last).unwrap_or(Tip::Joint(last));
        let toes = toes.place(self.skeleton, pose);
        let length = pose[ankle].position.distance(pose[hip].position);
        let foot = (toes - pose[ankle].position) / length;
        foot.is_finite().then(|| foot.clamp_length_max(1.0))
    }
}

/// The offset of a limb's middle joint from the line between its ends, in lengths of that line.
fn bend(limb: &LimbJoints, pose: &TiSlice<JointId, Transform>) -> DVec3 {
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
