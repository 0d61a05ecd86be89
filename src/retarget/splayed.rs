//! Limbs that keep their drawn pose: wings, tentacles, and legs that are splayed.
//!
//! They turn by as much as the clip's limbs turn from where these are on average. A leg that points to the side is lifted about another
//! axis than one that points ahead, and one on the left about the opposite axis of one on the right. Therefore, what a leg of the clip
//! does is seen from that leg, and the drawn one does the same.

use glam::{DQuat, DVec3};
use typed_index_collections::{TiVec, ti_vec};

use super::rotations::{Reference, arc};
use super::{Drive, Follow, Rig, RigPart, Source};
use crate::labels::{FigurePartId, Limb};
use crate::mocap::JointId;

/// The length of the mean of the directions below which a limb has no main direction.
const MAIN: f64 = 0.2;
/// A leg is splayed if it is level by this share of its length.
const LEVEL: f64 = 0.35;
/// It is on one side of the body if it points there by this share of what it is level.
const ASIDE: f64 = 0.2;

/// Whether a part keeps its drawn pose and follows a limb.
pub(super) fn keeps_pose(drive: &Drive) -> bool {
    drive.follow == Follow::Change && drive.tip.is_some()
}

/// From where a limb that keeps its drawn pose turns.
#[derive(Debug, Clone, Copy)]
pub(super) struct Kept {
    /// Where the joint is on average.
    pub(super) reference: Reference,
    /// How a leg that is splayed is seen.
    pub(super) splay: Option<Splay>,
}

/// How what a leg of the clip does is seen from that leg.
#[derive(Debug, Clone, Copy)]
pub(super) struct Splay {
    /// The joint that carries the clip's leg.
    carrier: JointId,
    /// From the drawing's axes to those of the carrier, on average.
    reference: DQuat,
    /// About the vertical, from where the clip's leg points to where the drawn one does.
    yaw: DQuat,
    /// The body's left in the drawing's axes, if the drawn leg is on the other side of its body.
    mirrored: Option<DVec3>,
}

impl Splay {
    /// The change of a drawn leg, given that of the clip's leg and the rotation of its carrier.
    pub(super) fn apply(&self, change: DQuat, to_drawing: DQuat, carrier: DQuat) -> DQuat {
        let carried = to_drawing * carrier * self.reference;
        let own = carried.inverse() * change;
        let own = self.mirrored.map_or(own, |left| {
            let axis = own.xyz();
            let axis = 2.0 * axis.dot(left) * left - axis;
            DQuat::from_xyzw(axis.x, axis.y, axis.z, own.w)
        });
        carried * self.yaw * own * self.yaw.inverse()
    }

    /// The joint that carries the clip's leg.
    pub(super) fn carrier(&self) -> JointId {
        self.carrier
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
    limb: Limb,
    carrier: JointId,
    turn: MeanTurn,
    /// From hip to ankle, in the drawing's axes.
    way: DVec3,
}

impl LegSums {
    fn of(source: &Source<'_>, drive: &Drive) -> Option<Self> {
        let mut legs = source.landmarks.legs.iter();
        let limb = legs.find(|leg| {
            let joints = [Some(leg.upper), leg.lower, leg.end, leg.toe];
            joints.contains(&Some(drive.joint))
        })?;
        limb.end.or(limb.lower)?;
        Some(Self {
            limb: *limb,
            carrier: source.clip.skeleton.joints[limb.upper].parent?,
            turn: MeanTurn::new(),
            way: DVec3::ZERO,
        })
    }
}

/// Per part where it turns from, for limbs that keep their drawn pose: wings are drawn as they are on average, not as the arms of a
/// T-pose. `None` for all others, and for limbs that point everywhere.
pub(super) fn kept(source: &mut Source<'_>) -> TiVec<FigurePartId, Option<Kept>> {
    let sums = |part: &RigPart| {
        let drive = part.drive.filter(keeps_pose)?;
        Some(Sums {
            drive,
            turn: MeanTurn::new(),
            direction: DVec3::ZERO,
            leg: part.is_leg.then(|| LegSums::of(source, &drive)).flatten(),
        })
    };
    let mut sums: Vec<Option<Sums>> = source.rig.parts.iter().map(sums).collect();
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
                leg.turn.add(pose[leg.carrier].rotation.inverse() * body);
                let end = leg.limb.end.or(leg.limb.lower).unwrap_or(leg.limb.upper);
                leg.way += body.inverse() * (pose[end].position - pose[leg.limb.upper].position);
            }
        }
    }
    let frames = source.clip.frames as f64;
    let mean = |(part, sums): (FigurePartId, Option<Sums>)| {
        let sums = sums?;
        let is_clear =
            sums.turn.0.length() > MAIN * frames && sums.direction.length() > MAIN * frames;
        is_clear.then(|| Kept {
            reference: Reference {
                turn: sums.turn.0.normalize(),
                direction: sums.direction.try_normalize(),
            },
            splay: sums.leg.and_then(|leg| splay(source.rig, part, &leg)),
        })
    };
    let sums: TiVec<FigurePartId, Option<Sums>> = sums.into();
    sums.into_iter_enumerated().map(mean).collect()
}

fn splay(rig: &Rig, part: FigurePartId, leg: &LegSums) -> Option<Splay> {
    let level = |way: DVec3| {
        let flat = way.with_y(0.0);
        let is_splayed = flat.length() > LEVEL * way.length();
        is_splayed.then(|| flat.try_normalize()).flatten()
    };
    let mut way = level(leg.way)?;
    let drawn = level(drawn_way(rig, part))?;
    let left = rig.facing.turn() * DVec3::X;
    let [clip_aside, drawn_aside] = [way, drawn].map(|way| way.dot(left));
    let is_mirrored =
        clip_aside * drawn_aside < 0.0 && clip_aside.abs().min(drawn_aside.abs()) > ASIDE;
    if is_mirrored {
        way -= 2.0 * clip_aside * left;
    }
    Some(Splay {
        carrier: leg.carrier,
        reference: leg.turn.0.normalize(),
        yaw: arc(way, drawn, DVec3::Y),
        mirrored: is_mirrored.then_some(left),
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
