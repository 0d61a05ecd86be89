//! Walking and running: cycles of steps, with the body's own motion about them.
//!
//! What the trunk does follows from the legs, as animators describe it: it is lowest just after a foot has touched the ground (walks)
//! or while one carries it (runs, trots) and highest in between; the hips turn with the leg that swings forward and drop on its side;
//! the chest and the arms turn against the hips; the head stays level and looks ahead.

mod table;

use crate::math;
use glam::DVec3;

use super::body::{Body, Leg, sign};
use super::curves::wave;
use super::pose::{Pose, lean, tip, turn};
use super::steps::Steps;
use crate::mocap::JointId;

/// A gait. Times are turns of its cycle, lengths centimetres, angles degrees.
#[derive(Debug, Clone, Copy)]
pub(super) struct Gait {
    /// Frames of a cycle.
    frames: usize,
    pub(super) steps: Steps,
    /// When the feet touch the ground: per pair the left and the right one.
    touches: [[f64; 2]; 3],
    /// How far the leg that stretches most may do so, as a share of its length.
    reach: f64,
    trunk: Trunk,
    arms: Arms,
}

/// How the trunk moves.
#[derive(Debug, Clone, Copy)]
struct Trunk {
    /// How far it rises and falls, how often in a cycle, and when it is lowest.
    bob: f64,
    bobs: f64,
    lowest: f64,
    /// How far the hips shift over the leg that stands.
    sway: f64,
    /// How far the hips turn towards the leg that swings forward, and drop on its side.
    hip_turn: f64,
    hip_drop: f64,
    /// How far the chest turns the other way.
    chest_turn: f64,
    /// How far the trunk leans forward.
    lean: f64,
    /// How far it pitches, front down, and when; how far the back is arched, and when.
    pitch: [f64; 2],
    arch: [f64; 2],
    /// How far the head is lowered, and how far it nods at every bob.
    head: f64,
    nod: f64,
}

/// How arms swing. Angles are forward of hanging down.
#[derive(Debug, Clone, Copy)]
struct Arms {
    swing: f64,
    mean: f64,
    spread: f64,
    elbow: f64,
    elbow_swing: f64,
}

/// The time of the first frame. Hips and shoulders are square to the way then, so that a figure, whose front is found by them in the
/// first frame, goes straight ahead.
pub(super) const START: f64 = 0.25;

/// How far behind the upper arm the forearm is.
const ELBOW_LAG: f64 = 0.06;

impl Gait {
    /// When a leg touches the ground, and for how much of the cycle it stays there.
    pub(super) fn contact(&self, leg: &Leg) -> (f64, f64) {
        let side = if leg.sign() > 0.0 { 0 } else { 1 };
        (self.touches[leg.pair][side], self.steps.duty)
    }

    /// The poses of a cycle; the last one is the first one again, one stride ahead.
    pub(super) fn poses(&self, body: &Body) -> Vec<Pose> {
        let times = (0..=self.frames).map(|frame| START + frame as f64 / self.frames as f64);
        let mut poses: Vec<Pose> = times.map(|time| self.pose(body, time)).collect();
        lower(body, &mut poses, self.reach);
        poses
    }

    fn pose(&self, body: &Body, time: f64) -> Pose {
        let trunk = &self.trunk;
        let mut pose = Pose::rest(body);
        let left = self.touches[0][0] + self.steps.duty / 2.0;
        let up = -trunk.bob * wave(trunk.bobs * time, trunk.bobs * trunk.lowest);
        let sway = trunk.sway * wave(time, left);
        pose.hips += DVec3::new(sway, up, self.steps.stride * time);
        // A body on more legs has hips and chest above legs of their own, and each turns with its own pair.
        let chest_pair = body.legs.iter().map(|leg| leg.pair).max().unwrap_or(0);
        let chest_left = match chest_pair {
            0 => None,
            pair => Some(self.touches[pair][0] + self.steps.duty / 2.0),
        };
        let forward = wave(time, self.touches[0][0]);
        let drop = trunk.hip_drop * wave(time, left);
        let chest_drop = match chest_left {
            None => -0.6 * drop,
            Some(left) => trunk.hip_drop * wave(time, left),
        };
        let pitch = trunk.lean + trunk.pitch[0] * wave(time, trunk.pitch[1]);
        let arch = trunk.arch[0] * wave(time, trunk.arch[1]);
        let hips = turn(-trunk.hip_turn * forward) * lean(drop) * tip(pitch * 0.5 - arch);
        let chest = turn(trunk.chest_turn * forward) * lean(chest_drop) * tip(pitch + arch);
        pose.turn_world(JointId::default(), hips);
        let joints = &body.anatomy;
        if let [spine, chest_joint] = joints.spine[..] {
            pose.turn_world(spine, math::slerp(hips, chest, 0.5));
            pose.turn_world(chest_joint, chest);
        }
        let nod = trunk.nod * wave(trunk.bobs * time, trunk.bobs * (trunk.lowest + 0.08));
        let head = tip(trunk.head + nod);
        if let (Some(&neck), Some(head_joint)) = (joints.neck.first(), joints.head) {
            pose.turn_world(neck, math::slerp(chest, head, 0.6));
            pose.turn_world(head_joint, head);
        }
        for (index, joint) in joints.tail.iter().enumerate() {
            let late = 0.1 + 0.12 * index as f64;
            let wag = turn(9.0 * wave(time, late)) * tip(-3.0 * wave(trunk.bobs * time, late));
            pose.turn_inner(*joint, wag);
        }
        for arm in &body.arms {
            let x = sign(arm.side);
            // The right arm swings forward with the left leg.
            let ahead = if x > 0.0 { 0.5 } else { 0.0 };
            let [_, upper, lower, hand] = arm.joints;
            let swing = self.arms.mean + self.arms.swing * wave(time, ahead);
            let elbow = self.arms.elbow + self.arms.elbow_swing * wave(time, ahead + ELBOW_LAG);
            pose.turn_inner(upper, tip(-swing) * lean(x * self.arms.spread));
            pose.turn_inner(lower, tip(-elbow));
            pose.turn_inner(hand, tip(-8.0 - 6.0 * wave(time, ahead + 2.0 * ELBOW_LAG)));
        }
        for (leg, foot) in body.legs.iter().zip(&mut pose.feet) {
            *foot = Some(self.steps.foot(leg, self.contact(leg).0, time));
        }
        pose
    }
}

/// Lowers or raises the body, by the same in all poses, until the leg that stretches most does so by `reach` of its length.
pub(super) fn lower(body: &Body, poses: &mut [Pose], reach: f64) {
    /// Halvings of the range of heights, to far less than a millimetre.
    const HALVINGS: usize = 24;

    let shifted = |pose: &Pose, by: f64| {
        let mut pose = pose.clone();
        pose.hips.y += by;
        pose
    };
    let (mut low, mut high) = (-60.0, 20.0);
    for _ in 0..HALVINGS {
        let middle = (low + high) / 2.0;
        let fits = |pose: &Pose| shifted(pose, middle).reach(body) <= reach;
        if poses.iter().all(fits) {
            low = middle
        } else {
            high = middle
        }
    }
    for pose in poses {
        pose.hips.y += low;
    }
}
