//! Limbs that keep their drawn pose: wings, tentacles, and legs that are splayed.
//!
//! They turn by as much as the clip's limbs turn from where these are on average. A leg that points to the side has to turn about other
//! axes than one that points ahead or down, if its foot is to step ahead and to be lifted like that one's. Therefore, a splayed leg turns
//! as a whole, by what its foot moves from its hip.

use glam::{DQuat, DVec2, DVec3};
use typed_index_collections::{TiSlice, TiVec, ti_vec};

use super::rotations::{Reference, arc};
use super::{Drive, Follow, Rig, RigPart, Source};
use crate::labels::FigurePartId;
use crate::mocap::{JointId, Transform};

/// The length of the mean of the directions below which a limb has no main direction.
const MAIN: f64 = 0.2;
/// A drawn leg is on the other side than the clip's if both point aside by this share of their lengths.
const ASIDE: f64 = 0.1;
/// A foot moves by at most this share of the leg's length from where it is on average: a leg that is pulled in keeps its direction.
const FARTHEST: f64 = 0.8;

/// Whether a part keeps its drawn pose and follows a limb.
pub(super) fn keeps_pose(drive: &Drive) -> bool {
    drive.follow == Follow::Change && drive.tip.is_some()
}

/// From where a limb that keeps its drawn pose turns.
#[derive(Debug, Clone, Copy)]
pub(super) struct Kept {
    /// Where the joint is on average.
    pub(super) reference: Reference,
    /// How a leg steps.
    pub(super) step: Option<Step>,
}

/// How a leg that keeps its drawn pose does what the clip's leg does: its foot moves likewise.
#[derive(Debug, Clone, Copy)]
pub(super) struct Step {
    /// The joint that carries the clip's leg, the hip, and the ankle.
    joints: [JointId; 3],
    /// From the drawing's axes to those of the carrier, on average.
    reference: DQuat,
    /// From hip to ankle on average, in the drawing's axes.
    mean: DVec3,
    /// How far the drawn leg's far end moves, in its distances from the hip, by what the ankle moves in the clip's unit.
    gain: f64,
    /// The body's left in the drawing's axes, if the drawn leg is on the other side of its body.
    mirrored: Option<DVec3>,
    /// Where the drawn leg points, from its hip to its far end.
    drawn: DVec3,
}

impl Step {
    /// The change of a drawn leg in a pose; `to_drawing` is the rotation from the clip's world to the drawing's axes.
    pub(super) fn change(&self, to_drawing: DQuat, pose: &TiSlice<JointId, Transform>) -> DQuat {
        let [carrier, hip, ankle] = self.joints;
        let carried = pose[carrier].rotation * self.reference;
        let way = carried.inverse() * (pose[ankle].position - pose[hip].position);
        let mut moved = (way - self.mean) * self.gain;
        if let Some(left) = self.mirrored {
            moved -= 2.0 * moved.dot(left) * left;
        }
        let points = (self.drawn + moved.clamp_length_max(FARTHEST)).normalize();
        to_drawing * carried * arc(self.drawn, points, DVec3::Y)
    }
}

/// A mean of rotations.
struct MeanTurn(DQuat);

impl MeanTurn {
    fn new() -> Self {
        Self(DQuat::from_xyzw(0.0, 0.0, 0.0, 0.0))
    }

    fn add(&mut self, turn: DQuat) {
        let is_opposite = self.0.dot(turn) < 0.0;
        self.0 += if is_opposite { -turn } else { turn };
    }
}

/// What is summed up over the frames for a part.
struct Sums {
    drive: Drive,
    turn: MeanTurn,
    direction: DVec3,
    leg: Option<LegSums>,
}

/// The same for the leg of the clip that a part follows.
struct LegSums {
    /// What carries the leg, its hip and its ankle.
    joints: [JointId; 3],
    turn: MeanTurn,
    /// From hip to ankle, in the drawing's axes.
    way: DVec3,
    /// From the hip of the drawn leg to its far end.
    drawn: DVec3,
}

impl LegSums {
    fn of(source: &Source<'_>, part: FigurePartId, drive: &Drive) -> Option<Self> {
        let limb = source.landmarks.leg_of(drive.joint)?;
        let carrier = source.clip.skeleton.joints[limb.upper].parent?;
        Some(Self {
            joints: [carrier, limb.upper, limb.end.or(limb.lower)?],
            turn: MeanTurn::new(),
            way: DVec3::ZERO,
            drawn: drawn_way(source.rig, part),
        })
    }
}

/// Per part where it turns from, for limbs that keep their drawn pose: wings are drawn as they are on average, not as the arms of a
/// T-pose. `None` for all others, and for limbs that point everywhere.
pub(super) fn kept(source: &mut Source<'_>) -> TiVec<FigurePartId, Option<Kept>> {
    let sums = |(index, part): (FigurePartId, &RigPart)| {
        let drive = part.drive.filter(keeps_pose)?;
        Some(Sums {
            drive,
            turn: MeanTurn::new(),
            direction: DVec3::ZERO,
            leg: part
                .is_leg
                .then(|| LegSums::of(source, index, &drive))
                .flatten(),
        })
    };
    let sums = source.rig.parts.iter_enumerated().map(sums);
    let mut sums: TiVec<FigurePartId, Option<Sums>> = sums.collect();
    if sums.iter().all(Option::is_none) {
        return ti_vec![None; source.rig.parts.len()];
    }
    for frame in 0..source.clip.frames {
        let pose = source.poses.at(frame);
        let body = source.axes.at(source.landmarks, pose);
        for sums in sums.iter_mut().flatten() {
            let own = Reference::of(source.clip, &sums.drive, body, pose);
            sums.turn.add(own.turn);
            sums.direction += own.direction.unwrap_or_default();
            if let Some(leg) = &mut sums.leg {
                let [carrier, hip, ankle] = leg.joints;
                leg.turn.add(pose[carrier].rotation.inverse() * body);
                leg.way += body.inverse() * (pose[ankle].position - pose[hip].position);
            }
        }
    }
    let frames = source.clip.frames as f64;
    // Legs of all lengths take equally long steps, or those that stand would slide.
    let legs = sums.iter().flatten().filter_map(|sums| sums.leg.as_ref());
    let lengths = legs.map(|leg| DVec2::new(leg.drawn.length(), leg.way.length() / frames));
    let lengths: DVec2 = lengths.sum();
    let scale = lengths.x / lengths.y;
    let mean = |sums: Option<Sums>| {
        let sums = sums?;
        let is_clear =
            sums.turn.0.length() > MAIN * frames && sums.direction.length() > MAIN * frames;
        is_clear.then(|| Kept {
            reference: Reference {
                turn: sums.turn.0.normalize(),
                direction: sums.direction.try_normalize(),
            },
            step: sums
                .leg
                .and_then(|leg| step(source.rig, &leg, frames, scale)),
        })
    };
    sums.into_iter().map(mean).collect()
}

/// `scale` is how far the far ends of drawn legs move by what ankles do.
fn step(rig: &Rig, leg: &LegSums, frames: f64, scale: f64) -> Option<Step> {
    let mean = leg.way / frames;
    let gain = scale / leg.drawn.length();
    let left = rig.facing.turn() * DVec3::X;
    let [clip_points, drawn] = [mean.try_normalize()?, leg.drawn.try_normalize()?];
    let [clip_aside, drawn_aside] = [clip_points, drawn].map(|way| way.dot(left));
    let is_mirrored =
        clip_aside * drawn_aside < 0.0 && clip_aside.abs().min(drawn_aside.abs()) > ASIDE;
    gain.is_finite().then(|| Step {
        joints: leg.joints,
        reference: leg.turn.0.normalize(),
        mean,
        gain,
        mirrored: is_mirrored.then_some(left),
        drawn,
    })
}

/// From the hip of the drawn leg that a part belongs to, to its far end.
fn drawn_way(rig: &Rig, part: FigurePartId) -> DVec3 {
    let above = |part: &FigurePartId| {
        let parent = rig.parts[*part].parent;
        parent.filter(|parent| rig.parts[*parent].is_leg)
    };
    // Parents that form a cycle have no top.
    let all = std::iter::successors(Some(part), above).take(rig.parts.len());
    let top = all.last().unwrap_or(part);
    let hip = rig.parts[top].joint;
    let own = rig.parts.iter_enumerated();
    let own = own.filter(|(other, own)| own.is_leg && rig.is_below(*other, top));
    let ways = own.map(|(_, own)| own.tip - hip);
    let far = |a: &DVec3, b: &DVec3| a.length_squared().total_cmp(&b.length_squared());
    ways.max_by(far).unwrap_or_default()
}
