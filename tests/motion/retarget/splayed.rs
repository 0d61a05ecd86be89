//! The law of legs that keep their drawn pose: their far ends move as the ankles of the clip do.

use glam::{DQuat, DVec3};
use okoshi::internals::labels::FigurePartId;
use okoshi::internals::mocap::{Clip, JointId, Pose};
use okoshi::internals::retarget::{Follow, Landmarks, Rig};

use super::Body;

/// A leg that keeps its drawn pose, and the ends of what it follows.
pub(crate) struct SplayedLeg {
    pub(crate) hip: JointId,
    pub(crate) ankle: JointId,
    /// From its hip to its far end, as it is drawn.
    pub(crate) points: DVec3,
}

impl SplayedLeg {
    /// The leg that a part of a rig belongs to, if it keeps its drawn pose.
    pub(crate) fn of(rig: &Rig, landmarks: &Landmarks, part: FigurePartId) -> Option<Self> {
        let own = &rig.parts[part];
        let drive = own.drive.as_ref().filter(|_| own.is_leg)?;
        if drive.follow != Follow::Change || drive.tip.is_none() {
            return None;
        }
        let limb = landmarks.legs.iter().find(|limb| {
            let joints = [Some(limb.upper), limb.lower, limb.end];
            joints.contains(&Some(drive.joint))
        })?;
        let top = |mut part: FigurePartId| {
            while let Some(above) = rig.parts[part]
                .parent
                .filter(|above| rig.parts[*above].is_leg)
            {
                part = above;
            }
            part
        };
        let hip = rig.parts[top(part)].joint;
        let pieces = rig.parts.iter_enumerated();
        let pieces = pieces.filter(|(other, piece)| piece.is_leg && top(*other) == top(part));
        let ways = pieces.map(|(_, piece)| piece.tip - hip);
        Some(Self {
            hip: limb.upper,
            ankle: limb.end.or(limb.lower)?,
            points: ways.max_by(|a, b| a.length().total_cmp(&b.length()))?,
        })
    }

    fn way(&self, pose: &Pose) -> DVec3 {
        pose[self.ankle].position - pose[self.hip].position
    }
}

/// How far the legs of a figure step.
pub(crate) struct Steps<'a> {
    clip: &'a Clip,
    body: &'a Body,
    poses: Vec<Pose>,
    /// The lengths of the drawn legs over those of the clip's.
    scale: f64,
}

impl<'a> Steps<'a> {
    pub(crate) fn of(clip: &'a Clip, body: &'a Body, legs: &[SplayedLeg]) -> Self {
        let poses = (0..clip.frames).map(|frame| clip.pose(frame));
        let mut steps = Self {
            clip,
            body,
            poses: poses.collect(),
            scale: 1.0,
        };
        let drawn: f64 = legs.iter().map(|leg| leg.points.length()).sum();
        let actor: f64 = legs.iter().map(|leg| steps.mean(leg).length()).sum();
        steps.scale = drawn / actor;
        steps
    }

    /// From hip to ankle on average, in the axes of a drawing of the body.
    fn mean(&self, leg: &SplayedLeg) -> DVec3 {
        let ways = self.poses.iter();
        let ways = ways.map(|pose| self.body.drawn(pose, leg.way(pose)));
        ways.sum::<DVec3>() / self.poses.len() as f64
    }

    /// Where a leg points in a pose, in the clip's world, as it is carried by what carries the clip's leg.
    pub(crate) fn due(&self, leg: &SplayedLeg, pose: &Pose) -> DVec3 {
        let carrier = self.clip.skeleton.joints[leg.hip].parent;
        let carrier = carrier.expect("something carries a leg");
        let turn = |pose: &Pose| pose[carrier].rotation.inverse() * self.body.turn(pose).inverse();
        let aligned =
            |sum: DQuat, turn: DQuat| sum + if sum.dot(turn) < 0.0 { -turn } else { turn };
        let turns = self.poses.iter().map(turn);
        let reference = turns.reduce(aligned).expect("a frame").normalize();
        let carried = pose[carrier].rotation * reference;
        let moved = self.scale * (carried.inverse() * leg.way(pose) - self.mean(leg));
        let most = 0.8 * leg.points.length();
        carried * (leg.points + moved.clamp_length_max(most))
    }
}
