//! Feet that move stay above the ground.
//!
//! A drawn leg has other proportions than the actor's, and may have no knee: where the actor's foot passes closely over the ground, the
//! drawn one would go through it, or hold the figure up in place of the foot that stands. Such a foot is levelled, as far as that helps;
//! for the rest, the leg turns about its hip, outward and on in its direction, by the least angle that is enough.

use glam::{DQuat, DVec3};

use super::contacts::Walk;
use super::kinematics::ForwardKinematics;
use super::root_motion::Feet;
use super::rotations::{Rotations, arc};
use super::stance::Stance;
use super::turns::Length;
use super::{Follow, Rig, RigPart};
use crate::labels::FigurePartId;
use crate::smoothing::envelope;

/// How far above the ground feet that move are kept, in leg lengths.
const MARGIN: f64 = 0.006;
/// How long a leg takes to make room, seconds.
const EASE: f64 = 0.08;
/// How long before and after a contact it is in its place, seconds.
const BACK: f64 = 0.06;
/// How far outward a leg turns, in leg lengths by which its foot is before or behind the hip.
const OUTWARD: f64 = 0.25;
/// The most by which a leg turns, degrees.
const MOST: f64 = 12.0;
/// Halvings of the range of an angle, to far less than a tenth of a degree.
const HALVINGS: usize = 12;

/// Lifts the feet of a rig that would be in the ground. `leg` is the length of its legs.
pub(super) fn clear(
    rig: &Rig,
    order: &[FigurePartId],
    rotations: &mut Rotations,
    walk: &Walk,
    leg: f64,
    length: &Length,
) {
    let frames = length.frames;
    let standing = walk.feet.iter().enumerate();
    let standing = standing.flat_map(|(foot, own)| own.parts.iter().map(move |part| (foot, *part)));
    // What keeps its drawn pose, such as a spider's leg, is not turned any further.
    let keeps_pose = |part: FigurePartId| {
        let drive = rig.parts[part].drive;
        drive.is_some_and(|drive| drive.follow == Follow::Change)
    };
    let standing = standing.filter(|(_, part)| !keeps_pose(*part));
    let standing: Vec<(usize, FigurePartId)> = standing.collect();
    let mut lacking = vec![vec![0.0; frames]; standing.len()];
    let mut kinematics = ForwardKinematics::new(rig);
    for frame in 0..frames {
        kinematics.pose(rig, rotations, order, frame);
        let feet = Feet::of(rig, &kinematics, walk);
        let height = Stance::of(walk, frame, &feet.lowest()).height();
        for (lacking, (_, part)) in lacking.iter_mut().zip(&standing) {
            let low = kinematics.lowest(rig, *part) + height;
            lacking[frame] = (MARGIN * leg - low).max(0.0);
        }
    }
    let reach = length.frames_in(EASE);
    let mut legs: Vec<Leg> = Vec::new();
    for ((foot, part), lacking) in standing.into_iter().zip(lacking) {
        let mut lifts = envelope(&lacking, reach, length.is_cycle);
        // The leg is back in its place when its foot begins to hold the figure.
        let firm = &walk.feet[foot].firm;
        let holds = (0..frames).map(|frame| {
            let near = &firm[frame.saturating_sub(1)..(frame + 2).min(frames)];
            if near.iter().any(|firm| *firm > 0.0) {
                1.0
            } else {
                0.0
            }
        });
        let holds: Vec<f64> = holds.collect();
        let holds = envelope(&holds, length.frames_in(BACK), length.is_cycle);
        for (lift, holds) in lifts.iter_mut().zip(holds) {
            *lift *= 1.0 - holds;
        }
        if lifts.iter().any(|lift| *lift > 0.0) {
            legs.push(Leg::of(rig, part, lifts));
        }
    }
    let mut turns: Vec<Vec<[DQuat; 2]>> = vec![Vec::with_capacity(frames); legs.len()];
    for frame in 0..frames {
        kinematics.pose(rig, rotations, order, frame);
        for (own, turns) in legs.iter().zip(&mut turns) {
            turns.push(own.turns(rig, order, &kinematics, frame, leg));
        }
    }
    for (leg, turns) in legs.iter().zip(turns) {
        leg.apply(rotations, &turns);
    }
}

/// A leg whose foot is lifted.
struct Leg {
    /// Its pieces, from the hip on, without a foot that turns by itself.
    pieces: Vec<FigurePartId>,
    /// The part that stands.
    end: FigurePartId,
    /// Whether that is a foot which turns by itself.
    is_foot: bool,
    /// Per frame by how much it is to be lifted.
    lifts: Vec<f64>,
}

impl Leg {
    fn of(rig: &Rig, end: FigurePartId, lifts: Vec<f64>) -> Self {
        let is_foot = rig.parts[end]
            .drive
            .is_some_and(|drive| drive.follow == Follow::Sole);
        let above = |part: &FigurePartId| {
            rig.parts[*part]
                .parent
                .filter(|part| rig.parts[*part].is_leg)
        };
        let pieces = std::iter::successors(Some(end), above).take(rig.parts.len());
        let mut pieces: Vec<FigurePartId> = pieces.skip(usize::from(is_foot)).collect();
        pieces.reverse();
        Self {
            pieces,
            end,
            is_foot,
            lifts,
        }
    }

    /// The turns of the pieces and of the foot in a frame.
    fn turns(
        &self,
        rig: &Rig,
        order: &[FigurePartId],
        kinematics: &ForwardKinematics,
        frame: usize,
        leg: f64,
    ) -> [DQuat; 2] {
        let mut turns = [DQuat::IDENTITY; 2];
        let mut lift = self.lifts[frame];
        if lift <= 0.0 {
            return turns;
        }
        let placed = kinematics.transforms[self.end];
        let own = &rig.parts[self.end];
        let ankle = placed.apply(own.node.to_local(own.joint));
        let sole: Vec<DVec3> = kinematics.surface(rig, self.end).collect();
        if self.is_foot {
            let up = placed.rotation * own.node.rotation.inverse() * DVec3::Y;
            let level = arc(up, DVec3::Y, DVec3::Z);
            let part = |share: f64| DQuat::IDENTITY.slerp(level, share);
            let raised = |share: f64| {
                let points = sole.iter().map(|point| part(share) * (*point - ankle));
                lowest(points) - lowest(sole.iter().map(|point| *point - ankle))
            };
            let share = least(1.0, |share| raised(share) >= lift);
            let gained = raised(share);
            if gained > 0.0 {
                turns[1] = part(share);
                lift -= gained;
            }
        }
        let (Some(top), true) = (self.pieces.first(), lift > 1e-6 * leg) else {
            return turns;
        };
        let above = &rig.parts[*top];
        let hip = kinematics.transforms[*top].apply(above.node.to_local(above.joint));
        let way = (ankle - hip).with_y(0.0) + outward(rig, order, kinematics, *top) * OUTWARD * leg;
        let Some(way) = way.try_normalize() else {
            return turns;
        };
        let axis = way.cross(DVec3::Y);
        let points: Vec<DVec3> = match self.is_foot {
            true => vec![ankle - hip],
            false => sole.iter().map(|point| *point - hip).collect(),
        };
        let before = lowest(points.iter().copied());
        let raised = |angle: f64| {
            let turn = DQuat::from_axis_angle(axis, angle);
            lowest(points.iter().map(|point| turn * *point)) - before
        };
        turns[0] = DQuat::from_axis_angle(
            axis,
            least(MOST.to_radians(), |angle| raised(angle) >= lift),
        );
        turns
    }

    fn apply(&self, rotations: &mut Rotations, turns: &[[DQuat; 2]]) {
        for piece in &self.pieces {
            rotations.turn(*piece, turns.iter().map(|turns| turns[0]));
        }
        if self.is_foot {
            rotations.turn(self.end, turns.iter().map(|turns| turns[1]));
        }
    }
}

/// The least value up to a limit that is enough, or the limit.
fn least(limit: f64, is_enough: impl Fn(f64) -> bool) -> f64 {
    let (mut low, mut high) = (0.0, limit);
    for _ in 0..HALVINGS {
        let middle = f64::midpoint(low, high);
        if is_enough(middle) {
            high = middle;
        } else {
            low = middle;
        }
    }
    high
}

fn lowest(points: impl Iterator<Item = DVec3>) -> f64 {
    points.map(|point| point.y).fold(f64::INFINITY, f64::min)
}

/// The level direction from the middle between the legs to the side on which one of them is; zero for one in the middle.
fn outward(
    rig: &Rig,
    order: &[FigurePartId],
    kinematics: &ForwardKinematics,
    top: FigurePartId,
) -> DVec3 {
    let Some(&root) = order.first() else {
        return DVec3::ZERO;
    };
    let is_top =
        |part: &&RigPart| part.is_leg && part.parent.is_none_or(|parent| !rig.parts[parent].is_leg);
    let hips = rig.parts.iter().filter(is_top).map(|part| part.joint);
    let (sum, count) = hips.fold((DVec3::ZERO, 0.0), |(sum, count), hip| {
        (sum + hip, count + 1.0)
    });
    let left = rig.facing.turn() * DVec3::X;
    let aside = (rig.parts[top].joint * count - sum).dot(left);
    if aside == 0.0 {
        return DVec3::ZERO;
    }
    let turned = kinematics.transforms[root].rotation * rig.parts[root].node.rotation.inverse();
    (turned * left * aside.signum()).with_y(0.0)
}
