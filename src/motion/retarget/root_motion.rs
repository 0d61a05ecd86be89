//! Root motion and foot locking: travel is scaled by leg length, and feet in contact with the ground do not slide.

use glam::{DQuat, DVec3};

use super::axes::{Axes, Landmarks};
use super::rotations::Rotations;
use super::{PoseBuffer, Rig};
use crate::motion::matching::Drive;
use crate::motion::skeleton::{Clip, Transform};

/// A foot is in contact if it is lower than this above its lowest height, in leg lengths …
const CONTACT_HEIGHT: f64 = 0.08;
/// … and slower than this, in leg lengths per second.
const CONTACT_SPEED: f64 = 0.6;
/// The lowest height of a foot is this quantile of its heights, because single frames may be wrong.
const LOWEST: f64 = 0.02;

/// The motion of nodes that have no parent node.
pub(super) struct RootMotion {
    /// Per part the positions of its node; `None` if it keeps its place.
    pub(super) positions: Vec<Option<Vec<DVec3>>>,
    /// Per frame whether a foot is in contact with the ground.
    pub(super) grounded: Vec<bool>,
}

pub(super) fn root_motion(
    clip: &Clip,
    rig: &Rig,
    landmarks: &Landmarks,
    axes: &Axes,
    rotations: &Rotations,
    order: &[usize],
    poses: &mut PoseBuffer<'_>,
) -> RootMotion {
    let mut motion = RootMotion {
        positions: vec![None; rig.parts.len()],
        grounded: vec![false; clip.frames()],
    };
    let Some(&main) = order.first() else {
        return motion;
    };
    let legs = leg_lengths(clip, rig, landmarks, poses);
    let walk = Walk::of(clip, rig, landmarks, axes, legs[0], poses);
    let scale = match legs[0] > 0.0 {
        true => legs[1] / legs[0],
        false => 0.0,
    };
    let start = rig.parts[main].node.position;
    let floor = walk.feet.iter().flat_map(|foot| &foot.soles);
    let floor = floor.flat_map(|part| &rig.parts[*part].sole);
    let floor = floor.map(|point| point.y).reduce(f64::min);
    let is_moving = |part: &usize| *part == main || rig.parts[*part].is_rooted;
    let moving: Vec<usize> = order.iter().copied().filter(is_moving).collect();
    for part in &moving {
        motion.positions[*part] = Some(Vec::with_capacity(clip.frames()));
    }
    let mut kinematics = ForwardKinematics::new(rig);
    let mut position = start;
    let mut planted: Option<usize> = None;
    let mut before: Vec<DVec3> = Vec::new();
    for frame in 0..clip.frames() {
        kinematics.pose(rig, rotations, order, frame);
        let feet: Vec<DVec3> = walk
            .feet
            .iter()
            .map(|foot| foot.reference(rig, &kinematics))
            .collect();
        planted = walk.planted(frame, planted);
        motion.grounded[frame] = planted.is_some();
        if frame > 0 {
            let step = match planted {
                // Foot locking: the foot stays in place, so the root moves by the opposite of its step.
                Some(foot) => before[foot] - feet[foot],
                None => (walk.hips[frame] - walk.hips[frame - 1]) * scale,
            };
            position += DVec3::new(step.x, 0.0, step.z);
        }
        position.y = match floor {
            Some(floor) => {
                let clearance = walk.feet.iter().map(|foot| foot.clearance[frame].max(0.0));
                let clearance = clearance.fold(f64::INFINITY, f64::min);
                let soles = walk.feet.iter().map(|foot| foot.lowest(rig, &kinematics));
                floor + lifted(clearance, legs[0]) * scale - soles.fold(f64::INFINITY, f64::min)
            }
            None => start.y + (walk.hips[frame].y - walk.hips[0].y) * scale,
        };
        before = feet;
        for part in &moving {
            if let Some(places) = &mut motion.positions[*part] {
                places.push(position + kinematics.transforms[*part].position);
            }
        }
    }
    motion
}

/// The height at which a foot is shown that has this clearance in the clip. Up to the contact height it is on the ground,
/// because a heel that rises lifts the end of a leg; from twice that height on it keeps its clearance.
fn lifted(clearance: f64, leg: f64) -> f64 {
    let low = CONTACT_HEIGHT * leg;
    (2.0 * (clearance - low)).max(0.0).min(clearance)
}

/// Forward kinematics: the parts' positions, with the root part's node at the origin.
struct ForwardKinematics {
    transforms: Vec<Transform>,
    /// Per part the position of its joint, in its parent's frame and in its own.
    joints: Vec<[DVec3; 2]>,
}

impl ForwardKinematics {
    fn new(rig: &Rig) -> Self {
        let joints = rig.parts.iter().map(|part| {
            let above = part
                .parent
                .map(|parent| to_local(&rig.parts[parent].node, part.joint));
            [above.unwrap_or_default(), to_local(&part.node, part.joint)]
        });
        let identity = Transform {
            rotation: DQuat::IDENTITY,
            position: DVec3::ZERO,
        };
        Self {
            transforms: vec![identity; rig.parts.len()],
            joints: joints.collect(),
        }
    }

    fn pose(&mut self, rig: &Rig, rotations: &Rotations, order: &[usize], frame: usize) {
        for part in order.iter().copied() {
            let rotation = rotations.at(part, frame);
            let [above, own] = self.joints[part];
            let position = match rig.parts[part].parent {
                Some(parent) => {
                    let parent = self.transforms[parent];
                    parent.rotation * above + parent.position - rotation * own
                }
                None => DVec3::ZERO,
            };
            self.transforms[part] = Transform { rotation, position };
        }
    }
}

/// A point in the frame of a node at rest.
fn to_local(node: &Transform, point: DVec3) -> DVec3 {
    node.rotation.inverse() * (point - node.position)
}

/// The walk of a clip, in the drawing's axes and the clip's unit.
struct Walk {
    hips: Vec<DVec3>,
    feet: Vec<Foot>,
}

/// A foot of the clip, and the parts of the figure that follow it.
struct Foot {
    drive: Drive,
    soles: Vec<usize>,
    /// Per frame its height above its lowest height.
    clearance: Vec<f64>,
    /// Per frame whether it was in contact since the frame before.
    contact: Vec<bool>,
    /// Per frame the length of its step from the frame before, in the clip's unit.
    speed: Vec<f64>,
}

impl Walk {
    fn of(
        clip: &Clip,
        rig: &Rig,
        landmarks: &Landmarks,
        axes: &Axes,
        leg: f64,
        poses: &mut PoseBuffer<'_>,
    ) -> Self {
        let mut feet: Vec<Foot> = Vec::new();
        for (index, part) in rig.parts.iter().enumerate() {
            let Some(drive) = part.drive.filter(|_| part.is_leg) else {
                continue;
            };
            if part.sole.is_empty() {
                continue;
            }
            match feet
                .iter_mut()
                .find(|foot| (foot.drive.joint, foot.drive.tip) == (drive.joint, drive.tip))
            {
                Some(foot) => foot.soles.push(index),
                None => feet.push(Foot {
                    drive,
                    soles: vec![index],
                    clearance: Vec::new(),
                    contact: Vec::new(),
                    speed: Vec::new(),
                }),
            }
        }
        let to_drawing = axes.first.inverse();
        let mut hips = Vec::with_capacity(clip.frames());
        let mut paths: Vec<Vec<DVec3>> = vec![Vec::with_capacity(clip.frames()); feet.len()];
        for frame in 0..clip.frames() {
            let pose = poses.at(frame);
            hips.push(to_drawing * pose[landmarks.hips].position);
            for (foot, path) in feet.iter().zip(&mut paths) {
                path.push(to_drawing * foot_point(clip, pose, landmarks, &foot.drive));
            }
        }
        for (foot, path) in feet.iter_mut().zip(&paths) {
            foot.measure(path, clip.frame_time, leg);
        }
        Self { hips, feet }
    }

    /// The foot that is locked on the way to a frame: the same as before while it is in contact, else the slowest one in
    /// contact.
    fn planted(&self, frame: usize, before: Option<usize>) -> Option<usize> {
        let stays = before.filter(|foot| self.feet[*foot].contact[frame]);
        let standing = self
            .feet
            .iter()
            .enumerate()
            .filter(|(_, foot)| foot.contact[frame]);
        let slowest = standing.min_by(|(_, a), (_, b)| a.speed[frame].total_cmp(&b.speed[frame]));
        stays.or(slowest.map(|(index, _)| index))
    }
}

/// The point of a clip's foot that touches the ground: the middle of a foot, the end of a leg without one.
fn foot_point(clip: &Clip, pose: &[Transform], landmarks: &Landmarks, drive: &Drive) -> DVec3 {
    let joint = pose[drive.joint].position;
    let tip = drive
        .tip
        .map_or(joint, |tip| tip.place(&clip.skeleton, pose));
    match is_foot(landmarks, drive) {
        true => (joint + tip) / 2.0,
        false => tip,
    }
}

/// Whether a drive is that of a foot, rather than that of a whole leg or its lower half.
fn is_foot(landmarks: &Landmarks, drive: &Drive) -> bool {
    landmarks
        .feet
        .is_some_and(|feet| feet.contains(&drive.joint))
}

impl Foot {
    fn measure(&mut self, path: &[DVec3], frame_time: f64, leg: f64) {
        let mut heights: Vec<f64> = path.iter().map(|point| point.y).collect();
        heights.sort_by(f64::total_cmp);
        let lowest = match heights.len() {
            0 => 0.0,
            count => heights[((count - 1) as f64 * LOWEST) as usize],
        };
        self.clearance = path.iter().map(|point| point.y - lowest).collect();
        let steps = path.windows(2).map(|step| (step[1] - step[0]).length());
        self.speed = std::iter::once(0.0).chain(steps).take(path.len()).collect();
        let low = |frame: usize| self.clearance[frame] < CONTACT_HEIGHT * leg;
        let contact = (0..path.len()).map(|frame| {
            let slow = self.speed[frame] < CONTACT_SPEED * leg * frame_time;
            low(frame) && low(frame.saturating_sub(1)) && slow
        });
        self.contact = contact.collect();
    }

    /// The mean of its soles' points.
    fn reference(&self, rig: &Rig, kinematics: &ForwardKinematics) -> DVec3 {
        let points: Vec<DVec3> = self.points(rig, kinematics).collect();
        points.iter().sum::<DVec3>() / points.len().max(1) as f64
    }

    /// The height of the lowest point of its soles.
    fn lowest(&self, rig: &Rig, kinematics: &ForwardKinematics) -> f64 {
        self.points(rig, kinematics)
            .map(|point| point.y)
            .fold(f64::INFINITY, f64::min)
    }

    fn points(&self, rig: &Rig, kinematics: &ForwardKinematics) -> impl Iterator<Item = DVec3> {
        self.soles.iter().flat_map(|part| {
            let placed = kinematics.transforms[*part];
            let own = &rig.parts[*part];
            let point = move |point: &DVec3| {
                placed.rotation * to_local(&own.node, *point) + placed.position
            };
            own.sole.iter().map(point)
        })
    }
}

/// The leg lengths of the clip and of the figure, feet excluded; if one of them has no legs, their sizes.
fn leg_lengths(
    clip: &Clip,
    rig: &Rig,
    landmarks: &Landmarks,
    poses: &mut PoseBuffer<'_>,
) -> [f64; 2] {
    let pose = match clip.frames() {
        0 => clip.skeleton.offset_pose(),
        _ => poses.at(0).to_vec(),
    };
    let mean = |lengths: Vec<f64>| match lengths.len() {
        0 => None,
        count => Some(lengths.iter().sum::<f64>() / count as f64).filter(|length| *length > 0.0),
    };
    let way = |from: usize, to: usize| (pose[to].position - pose[from].position).length();
    let clip_legs = match (landmarks.thighs, landmarks.feet) {
        (Some(thighs), Some(feet)) => [0, 1].map(|side| match landmarks.knees {
            Some(knees) => way(thighs[side], knees[side]) + way(knees[side], feet[side]),
            None => way(thighs[side], feet[side]),
        }),
        _ => [0.0; 2],
    };
    let stand_on = rig
        .parts
        .iter()
        .enumerate()
        .filter(|(_, part)| !part.sole.is_empty());
    let rig_legs = stand_on
        .map(|(index, _)| leg_length(rig, landmarks, index))
        .collect();
    match (mean(clip_legs.to_vec()), mean(rig_legs)) {
        (Some(clip), Some(rig)) => [clip, rig],
        _ => {
            let extent = |points: &mut dyn Iterator<Item = DVec3>| {
                let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
                for point in points {
                    low = low.min(point);
                    high = high.max(point);
                }
                (high - low).max_element().max(0.0)
            };
            let ends = |part: &super::RigPart| [part.joint, part.tip];
            [
                extent(&mut pose.iter().map(|placed| placed.position)),
                extent(&mut rig.parts.iter().flat_map(ends)),
            ]
        }
    }
}

/// The length of the leg that ends with a part.
fn leg_length(rig: &Rig, landmarks: &Landmarks, end: usize) -> f64 {
    let above = |part: &usize| {
        let parent = rig.parts[*part].parent?;
        let above = &rig.parts[parent];
        (above.is_leg && above.drive.is_some()).then_some(parent)
    };
    std::iter::successors(Some(end), above)
        // Parents that form a cycle have no top.
        .take(rig.parts.len())
        .map(|part| &rig.parts[part])
        .filter(|part| part.drive.is_none_or(|drive| !is_foot(landmarks, &drive)))
        .map(|part| (part.tip - part.joint).length())
        .sum()
}
