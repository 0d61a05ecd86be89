//! Which axis of a clip's world points up.

use glam::DVec3;
use typed_index_collections::TiSlice;

use super::PoseBuffer;
use super::axes::Landmarks;
use crate::mocap::{Clip, JointId, Transform};

/// A sample of the poses is enough.
const MAX_POSES: usize = 1000;
/// Along the up axis the body's lowest point stays within this share of the body's height …
const SPREAD: f64 = 0.08;
/// … from its lowest place, which is this quantile of its heights because single frames may be wrong, to this one: jumps take less
/// than the rest of a clip.
const QUANTILES: [f64; 2] = [0.02, 0.6];
/// A limb reaches the ground if it comes within this share of the body's height of it …
const REACH: f64 = 0.1;
/// … in this share of the frames.
const OFTEN: f64 = 0.05;
/// By how much of the spread a body that stands along an axis makes up for it.
const UPRIGHT: f64 = 0.25;

/// The axes of a world. Up is +Y in most files and +Z in most others, so these win ties.
const AXES: [DVec3; 6] = [
    DVec3::Y,
    DVec3::Z,
    DVec3::X,
    DVec3::NEG_Y,
    DVec3::NEG_Z,
    DVec3::NEG_X,
];

/// The up axis of a clip's world: of the axes along which the body's lowest point stays at one height, on the left and on the right,
/// the one that is nearest to the mean direction from feet to head. If there is none (a body that climbs, swims or falls), the axis
/// with the least spread, for which that direction counts too.
pub(super) fn up(clip: &Clip, landmarks: &Landmarks) -> DVec3 {
    let mut poses = PoseBuffer::new(clip);
    let step = clip.frames.div_ceil(MAX_POSES).max(1);
    let frames: Vec<usize> = (0..clip.frames).step_by(step).collect();
    let mut rise = DVec3::ZERO;
    let mut height = 0.0_f64;
    let mut heights: [Heights; AXES.len()] = Default::default();
    for frame in &frames {
        let pose = poses.at(*frame);
        let own = feet_to_head(pose, landmarks);
        rise += own;
        height = height.max(own.length());
        for (axis, heights) in AXES.iter().zip(&mut heights) {
            heights.add(*axis, pose, landmarks);
        }
    }
    if rise == DVec3::ZERO {
        return upright(&clip.skeleton.offset_pose(), landmarks);
    }
    let direction = rise.normalize_or_zero();
    let spreads = heights.map(|heights| heights.spread(height));
    let best = |cost: &dyn Fn(usize) -> Option<f64>| {
        let costs = (0..AXES.len()).filter_map(|axis| Some((axis, cost(axis)?)));
        costs.reduce(|best, next| if next.1 < best.1 { next } else { best })
    };
    let standing = |axis: usize| AXES[axis].dot(direction);
    let grounded = best(&|axis| {
        let spread = spreads[axis].filter(|spread| *spread <= SPREAD);
        spread.map(|_| -standing(axis))
    });
    let steadiest = || best(&|axis| Some(spreads[axis]? - UPRIGHT * standing(axis)));
    match grounded.or_else(steadiest) {
        Some((axis, _)) => AXES[axis],
        None => nearest(rise),
    }
}

/// The up axis of a pose: the one nearest to the direction from feet to head.
pub(super) fn upright(pose: &TiSlice<JointId, Transform>, landmarks: &Landmarks) -> DVec3 {
    nearest(feet_to_head(pose, landmarks))
}

fn nearest(direction: DVec3) -> DVec3 {
    let mut best = AXES[0];
    for axis in AXES {
        if axis.dot(direction) > best.dot(direction) {
            best = axis;
        }
    }
    best
}

fn feet_to_head(pose: &TiSlice<JointId, Transform>, landmarks: &Landmarks) -> DVec3 {
    let low = match landmarks.feet {
        Some([left, right]) => (pose[left].position + pose[right].position) / 2.0,
        None => pose[landmarks.hips].position,
    };
    landmarks
        .head
        .map_or(DVec3::ZERO, |head| pose[head].position - low)
}

/// How low a body reaches along an axis, frame by frame.
#[derive(Default)]
struct Heights {
    lowest: Vec<f64>,
    /// The lowest points of the limbs on the left and on the right; empty if no limb is known on both sides.
    sides: [Vec<f64>; 2],
}

impl Heights {
    fn add(&mut self, axis: DVec3, pose: &TiSlice<JointId, Transform>, landmarks: &Landmarks) {
        let height = |joint: JointId| axis.dot(pose[joint].position);
        let trunk = std::iter::once(landmarks.hips).chain(landmarks.head);
        let mut lowest = trunk.map(height).fold(f64::INFINITY, f64::min);
        let limbs = [
            landmarks.feet,
            landmarks.toes,
            landmarks.hands,
            landmarks.knees,
        ];
        for (side, heights) in self.sides.iter_mut().enumerate() {
            let ends = limbs.iter().flatten().map(|pair| height(pair[side]));
            if let Some(low) = ends.reduce(f64::min) {
                heights.push(low);
                lowest = lowest.min(low);
            }
        }
        self.lowest.push(lowest);
    }

    /// The spread of the lowest point as a share of the body's height; `None` if only one side ever reaches down to it.
    fn spread(mut self, height: f64) -> Option<f64> {
        self.lowest.sort_by(f64::total_cmp);
        let last = self.lowest.len().checked_sub(1)? as f64;
        let [low, high] = QUANTILES.map(|share| self.lowest[(last * share) as usize]);
        let reaches = |heights: &Vec<f64>| {
            let reach = |at: &&f64| **at <= low + REACH * height;
            let count = heights.iter().filter(reach).count();
            heights.is_empty() || count as f64 >= OFTEN * heights.len() as f64
        };
        let spread = (high - low) / height;
        (self.sides.iter().all(reaches) && spread.is_finite()).then_some(spread)
    }
}
