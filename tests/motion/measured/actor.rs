//! What the feet of a motion do, computed from its joints alone.

use glam::{DQuat, DVec3};
use okoshi::internals::labels::{Class, Limb, Tip};
use okoshi::internals::mocap::{Clip, Pose};
use okoshi::internals::prepare::PreparedClip;
use okoshi::internals::retarget::Landmarks;

/// A point is as low as it gets at this quantile of its heights: single frames may be wrong.
const LOWEST: f64 = 0.02;
/// A foot stands if its lowest point is at most this high, in leg lengths …
const STANDS: f64 = 0.025;
/// … and moves at most so fast, in leg lengths per second.
const RESTS: f64 = 0.25;
/// How far a heel is behind its ankle, in distances from ankle to toes.
const HEEL: f64 = 0.35;

/// A foot of the actor, frame by frame; lengths are in leg lengths.
pub(super) struct ActorFoot {
    /// The height of its lowest point over the ground.
    pub(super) clearance: Vec<f64>,
    /// How fast that point moves on the way from the frame before, per second.
    pub(super) speed: Vec<f64>,
    /// How far its sole is from flat, degrees.
    pub(super) tilt: Vec<f64>,
    /// Whether it stands.
    pub(super) stands: Vec<bool>,
}

/// An actor.
pub(super) struct Actor {
    /// Per limb that is a leg.
    pub(super) feet: Vec<(Limb, ActorFoot)>,
    /// Its joints, frame by frame.
    pub(super) poses: Vec<Pose>,
}

impl Actor {
    pub(super) fn of(prepared: &PreparedClip) -> Self {
        let clip = &prepared.clip;
        let poses: Vec<Pose> = (0..clip.frames).map(|frame| clip.pose(frame)).collect();
        let up = up(prepared, &poses);
        let legs = prepared.anatomy.limbs.iter();
        let legs =
            legs.filter(|limb| limb.class == Class::Leg && limb.end.or(limb.lower).is_some());
        let legs: Vec<Limb> = legs.copied().collect();
        let soles: Vec<Sole> = legs
            .iter()
            .map(|leg| Sole::of(clip, &poses, leg, up))
            .collect();
        let lengths = legs.iter().zip(&soles).map(|(leg, sole)| {
            let joints =
                [Some(leg.upper), leg.lower, leg.end].map(|joint| Some(poses[0][joint?].position));
            let joints: Vec<DVec3> = joints.into_iter().flatten().collect();
            let bones = joints.windows(2).map(|pair| pair[0].distance(pair[1]));
            bones.sum::<f64>() + sole.drop
        });
        let leg = lengths.sum::<f64>() / legs.len().max(1) as f64;
        let feet = soles
            .iter()
            .map(|sole| sole.measured(clip, &poses, up, leg));
        Self {
            feet: legs.iter().copied().zip(feet).collect(),
            poses,
        }
    }

    /// The height of the lowest foot in a frame, in leg lengths.
    pub(super) fn clearance(&self, frame: usize) -> f64 {
        let feet = self.feet.iter().map(|(_, foot)| foot.clearance[frame]);
        feet.fold(f64::INFINITY, f64::min)
    }
}

/// The axis that is nearest to the direction from feet to head.
fn up(prepared: &PreparedClip, poses: &[Pose]) -> DVec3 {
    let landmarks = Landmarks::of(&prepared.anatomy);
    let Some(feet) = landmarks.feet else {
        return DVec3::Y;
    };
    // A body on four legs lies along the ground: the hips are over the feet.
    let rise = poses.iter().map(|pose| {
        pose[landmarks.hips].position - (pose[feet[0]].position + pose[feet[1]].position) / 2.0
    });
    let rise: DVec3 = rise.sum();
    let axis = rise.abs().max_position();
    DVec3::AXES[axis] * rise[axis].signum()
}

/// The sole of a foot: points that are on the ground while it stands flat.
struct Sole {
    ankle: okoshi::internals::mocap::JointId,
    tip: Option<Tip>,
    /// How far the ground is below the ankle.
    drop: f64,
    /// Points in the ankle's frame.
    points: Vec<DVec3>,
    /// The ankle's rotation while the foot is flat.
    flat: DQuat,
}

fn tip_place(clip: &Clip, pose: &Pose, tip: Tip) -> DVec3 {
    match tip {
        Tip::Joint(joint) => pose[joint].position,
        Tip::End { joint, end } => {
            pose[joint].position + pose[joint].rotation * clip.skeleton.joints[joint].ends[end]
        }
    }
}

fn lowest(heights: impl Iterator<Item = f64>) -> f64 {
    let mut heights: Vec<f64> = heights.collect();
    heights.sort_by(f64::total_cmp);
    heights[((heights.len() - 1) as f64 * LOWEST) as usize]
}

impl Sole {
    fn of(clip: &Clip, poses: &[Pose], leg: &Limb, up: DVec3) -> Self {
        let ankle = leg.end.or(leg.lower).expect("an ankle");
        let tip = leg.end.and(leg.tip).filter(|tip| *tip != Tip::Joint(ankle));
        let height = |pose: &Pose| pose[ankle].position.dot(up);
        let floor = lowest(poses.iter().map(height));
        let toes = |pose: &Pose| tip.map_or(0.0, |tip| tip_place(clip, pose, tip).dot(up));
        let toes_floor = lowest(poses.iter().map(toes));
        // It is flat where ankle and toes are low and slow together.
        let cost = |frame: usize| {
            let before = frame.saturating_sub(1);
            let moved = poses[frame][ankle].position - poses[before][ankle].position;
            height(&poses[frame]) - floor + toes(&poses[frame]) - toes_floor + moved.length()
        };
        let frames = (0..poses.len()).min_by(|a, b| cost(*a).total_cmp(&cost(*b)));
        let pose = &poses[frames.expect("a frame")];
        let placed = pose[ankle];
        let mut points = vec![placed.position];
        let mut drop = 0.0;
        if let Some(tip) = tip {
            let toe = tip_place(clip, pose, tip);
            drop = (placed.position - toe).dot(up).max(0.0);
            let way = (toe - placed.position).reject_from(up);
            points = vec![
                placed.position - way * HEEL - up * drop,
                placed.position + way * 0.7 - up * drop,
            ];
        }
        let back = placed.rotation.inverse();
        Self {
            ankle,
            tip,
            drop,
            points: points
                .iter()
                .map(|point| back * (*point - placed.position))
                .collect(),
            flat: placed.rotation,
        }
    }

    /// The points of the sole in a pose.
    fn points(&self, clip: &Clip, pose: &Pose) -> Vec<DVec3> {
        let placed = pose[self.ankle];
        let mut points: Vec<DVec3> = self
            .points
            .iter()
            .map(|point| placed.position + placed.rotation * *point)
            .collect();
        points.extend(self.tip.map(|tip| tip_place(clip, pose, tip)));
        points
    }

    fn measured(&self, clip: &Clip, poses: &[Pose], up: DVec3, leg: f64) -> ActorFoot {
        let paths: Vec<Vec<DVec3>> = poses.iter().map(|pose| self.points(clip, pose)).collect();
        let floors: Vec<f64> = (0..paths[0].len())
            .map(|point| lowest(paths.iter().map(|path| path[point].dot(up))))
            .collect();
        let heights = |frame: usize| {
            let points = paths[frame].iter().zip(&floors);
            points
                .map(|(point, floor)| (point.dot(up) - floor) / leg)
                .collect::<Vec<f64>>()
        };
        let clearance: Vec<f64> = (0..poses.len())
            .map(|frame| heights(frame).into_iter().fold(f64::INFINITY, f64::min))
            .collect();
        let speed: Vec<f64> = (0..poses.len())
            .map(|frame| {
                let before = frame.saturating_sub(1);
                let pairs = heights(frame)
                    .into_iter()
                    .zip(heights(before))
                    .map(|(a, b)| a + b);
                let low = pairs.enumerate().min_by(|a, b| a.1.total_cmp(&b.1));
                let point = low.expect("a point").0;
                let way = (paths[frame][point] - paths[before][point]).reject_from(up);
                way.length() / leg / clip.frame_time
            })
            .collect();
        let tilt = poses.iter().map(|pose| {
            let turn = pose[self.ankle].rotation * self.flat.inverse();
            (turn * up).angle_between(up).to_degrees()
        });
        ActorFoot {
            stands: clearance
                .iter()
                .zip(&speed)
                .map(|(height, speed)| *height < STANDS && *speed < RESTS)
                .collect(),
            tilt: tilt.collect(),
            clearance,
            speed,
        }
    }
}
