//! Feet on the ground: those that stand are on it, and those that move are above it.
//!
//! A drawn leg has other proportions than the actor's, and may have no knee: where the actor's foot passes closely over the ground, the
//! drawn one would go through it, and where both feet stand, one would float. The figure is as low as the foot that reaches down least
//! of those that stand needs; the others bend their knees for it (`legs.rs`), and so does a leg whose foot moves too low. A foot that
//! moves is levelled first, as far as that helps.

use glam::DQuat;

use super::Rig;
use super::contacts::Walk;
use super::kinematics::ForwardKinematics;
use super::legs::Leg;
use super::root_motion::Feet;
use super::rotations::Rotations;
use super::stance::Stance;
use super::turns::Length;
use crate::labels::FigurePartId;
use crate::smoothing::envelope;

/// How far above the ground feet that move are kept, in leg lengths.
const MARGIN: f64 = 0.006;
/// How long a leg takes to make room, seconds.
const EASE: f64 = 0.08;
/// How long before and after it stands on the ground a foot is considered, seconds …
const NEAR: f64 = 0.1;
/// … and how much lower it would have to reach at the ends of that time, in leg lengths.
const FAR: f64 = 0.15;
/// Of feet that stand, some may float by this, in leg lengths: nobody sees it, and their legs need not bend.
const UNEVEN: f64 = 0.02;
/// A foot that reaches down less than others by more than this, in leg lengths, is drawn in the air: legs bend less for it, and at
/// twice as much not at all.
const RAISED: f64 = 0.06;

/// Places the feet of a rig on the ground or above it. `leg` is the length of its legs.
pub(super) fn place(
    rig: &Rig,
    order: &[FigurePartId],
    rotations: &mut Rotations,
    walk: &Walk,
    leg: f64,
    length: &Length,
) {
    let standing = walk.feet.iter().enumerate();
    let standing = standing.flat_map(|(foot, own)| own.parts.iter().map(move |part| (foot, *part)));
    let standing: Vec<(usize, FigurePartId)> = standing.collect();
    let is_sized = leg > 0.0 && leg.is_finite();
    if standing.is_empty() || length.frames == 0 || !is_sized {
        return;
    }
    let lacking = lacking(rig, order, rotations, walk, &standing, leg, length);
    let reach = length.frames_in(EASE);
    let mut legs: Vec<Leg> = Vec::new();
    for ((foot, part), lacking) in standing.into_iter().zip(lacking) {
        let lifts = envelope(&lacking, reach, length.is_cycle);
        if lifts.iter().any(|lift| *lift > 0.0) {
            legs.extend(Leg::of(rig, rotations, foot, part, lifts));
        }
    }
    let mut kinematics = ForwardKinematics::new(rig);
    let mut turns: Vec<Vec<[DQuat; 3]>> = vec![Vec::with_capacity(length.frames); legs.len()];
    for frame in 0..length.frames {
        kinematics.pose(rig, rotations, order, frame);
        for (own, turns) in legs.iter().zip(&mut turns) {
            let lift = walk.feet[own.foot].lift[frame];
            turns.push(own.turns(rig, order, &kinematics, frame, [leg, lift]));
        }
    }
    for (leg, turns) in legs.iter().zip(turns) {
        leg.apply(rotations, &turns);
    }
    rotations.share(rig, order);
}

/// Per part that stands, and per frame, by how much it has to be lifted.
fn lacking(
    rig: &Rig,
    order: &[FigurePartId],
    rotations: &Rotations,
    walk: &Walk,
    standing: &[(usize, FigurePartId)],
    leg: f64,
    length: &Length,
) -> Vec<Vec<f64>> {
    let near = walk.feet.iter().map(|foot| {
        let stands = |lift: &f64| if *lift > 0.0 { 0.0 } else { 1.0 };
        let stands: Vec<f64> = foot.lift.iter().map(stands).collect();
        envelope(&stands, length.frames_in(NEAR), length.is_cycle)
    });
    let near: Vec<Vec<f64>> = near.collect();
    let nearness = |foot: usize, frame: usize| near[foot][frame];
    let mut kinematics = ForwardKinematics::new(rig);
    let mut lacking = vec![Vec::with_capacity(length.frames); standing.len()];
    for frame in 0..length.frames {
        kinematics.pose(rig, rotations, order, frame);
        let feet = Feet::of(rig, &kinematics, walk);
        let highest = Stance::of(walk, frame, &feet.lowest()).height();
        let lows = standing
            .iter()
            .map(|(_, part)| kinematics.lowest(rig, *part));
        let lows: Vec<f64> = lows.collect();
        // By how much the root is too high for a foot that stands, or soon will.
        let too_high = standing.iter().zip(&lows).map(|((foot, _), low)| {
            let lift = walk.feet[*foot].lift[frame];
            let height = lift - low + (1.0 - nearness(*foot, frame)) * FAR * leg;
            let too_high = highest - height;
            too_high.min(2.0 * RAISED * leg - too_high)
        });
        let too_high = too_high.fold(0.0, f64::max);
        let height = highest - (too_high - UNEVEN * leg).max(0.0);
        for ((lacking, (foot, _)), low) in lacking.iter_mut().zip(standing).zip(lows) {
            let least = walk.feet[*foot].lift[frame].min(MARGIN * leg);
            lacking.push((least - low - height).max(0.0));
        }
    }
    lacking
}
