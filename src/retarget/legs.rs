//! Legs whose feet are lifted: by the knee, or as a whole where there is none.

use crate::math;
use glam::{DQuat, DVec3};

use super::kinematics::ForwardKinematics;
use super::rotations::{Rotations, arc};
use super::splayed::keeps_pose;
use super::{Follow, Rig, RigPart};
use crate::labels::FigurePartId;
use crate::smoothing::ease;

/// How far outward a leg of one piece turns, in leg lengths by which its foot is before or behind the hip.
const OUTWARD: f64 = 0.25;
/// The most by which a leg of one piece turns, degrees.
const MOST: f64 = 20.0;
/// The most by which a knee bends further, degrees.
const MOST_BENT: f64 = 60.0;
/// The sine of the angle between thigh and shin from which on they say in which plane the knee bends, and not the thigh alone.
const CLEAR: f64 = 0.1;
/// A foot keeps its tilt up to the first of these heights, in leg lengths, and may be levelled from the second on.
const LEVELLED: [f64; 2] = [0.025, 0.075];
/// Halvings of the range of an angle, to far less than a tenth of a degree.
const HALVINGS: usize = 12;

/// A leg whose foot is lifted.
pub(super) struct Leg {
    /// The foot of the clip that it follows.
    pub(super) foot: usize,
    /// Its pieces that turn about the hip.
    upper: Vec<FigurePartId>,
    /// The piece below the knee; `None` if nothing bends there.
    lower: Option<Shin>,
    /// The part that stands.
    end: FigurePartId,
    /// Whether that is a foot which turns by itself.
    is_foot: bool,
    /// Whether that keeps its direction if the leg bends.
    is_apart: bool,
    /// Per frame by how much it is to be lifted.
    lifts: Vec<f64>,
}

/// What is below the knee of a leg.
struct Shin {
    part: FigurePartId,
    /// The parts between whose joints the knee is: of those that share its turn, the two in the middle, which are one if their number is odd.
    knee: [FigurePartId; 2],
}

/// How a knee bends in a frame.
struct Knee {
    /// From the hip to the knee and from the knee to the end of the shin.
    ways: [DVec3; 2],
    /// The axis about which the shin turns backward.
    axis: DVec3,
}

impl Leg {
    /// The leg that a part stands on, whose foot is to be lifted; `None` if nothing of it turns by itself.
    pub(super) fn of(
        rig: &Rig,
        rotations: &Rotations,
        foot: usize,
        end: FigurePartId,
        lifts: Vec<f64>,
    ) -> Option<Self> {
        let is_foot = rig.parts[end]
            .drive
            .is_some_and(|drive| drive.follow == Follow::Sole);
        let above = |part: &FigurePartId| {
            rig.parts[*part]
                .parent
                .filter(|part| rig.parts[*part].is_leg)
        };
        let all = std::iter::successors(Some(end), above).take(rig.parts.len());
        let mut all: Vec<FigurePartId> = all.skip(usize::from(is_foot)).collect();
        all.reverse();
        // Those that share the turn of a joint follow the pieces beside it.
        let turns =
            |part: &&FigurePartId| rotations.is_own(**part) && rig.parts[**part].shared.is_none();
        let pieces: Vec<FigurePartId> = all.iter().filter(turns).copied().collect();
        let (&first, rest) = pieces.split_first()?;
        // A leg that keeps its drawn pose is lifted as a whole.
        let is_kept = rig.parts[first].drive.as_ref().is_some_and(keeps_pose);
        let lower = rest.first().filter(|_| !is_kept).map(|part| Shin {
            part: *part,
            knee: knee(rig, &all, [first, *part]),
        });
        Some(Self {
            foot,
            // Of three pieces, the last one is a foot that points as the actor's does.
            is_apart: is_foot || rest.len() > 1 && !is_kept,
            upper: match &lower {
                Some(_) => vec![first],
                None => pieces,
            },
            lower,
            end,
            is_foot,
            lifts,
        })
    }

    /// The turns of its pieces above the knee, of that below, and of the foot, in a frame of a pose. `leg` is the length of the rig's
    /// legs, and the actor's foot is this high above the ground.
    pub(super) fn turns(
        &self,
        rig: &Rig,
        order: &[FigurePartId],
        kinematics: &ForwardKinematics,
        frame: usize,
        [leg, height]: [f64; 2],
    ) -> [DQuat; 3] {
        let mut turns = [DQuat::IDENTITY; 3];
        let mut lift = self.lifts[frame];
        if lift <= 0.0 {
            return turns;
        }
        let at = |part: FigurePartId, place: DVec3| {
            kinematics.transforms[part].apply(rig.parts[part].node.to_local(place))
        };
        let joint = |part: FigurePartId| at(part, rig.parts[part].joint);
        let sole: Vec<DVec3> = kinematics.surface(rig, self.end).collect();
        let last = match &self.lower {
            Some(shin) => shin.part,
            None => self.upper[self.upper.len() - 1],
        };
        let ankle = match self.is_apart {
            true => joint(self.end),
            false => at(last, rig.parts[last].tip),
        };
        if self.is_foot {
            let placed = kinematics.transforms[self.end].rotation;
            let up = placed * rig.parts[self.end].node.rotation.inverse() * DVec3::Y;
            let level = arc(up, DVec3::Y, DVec3::Z);
            let part = |share: f64| math::slerp(DQuat::IDENTITY, level, share);
            let raised = |share: f64| {
                let points = sole.iter().map(|point| part(share) * (*point - ankle));
                lowest(points) - lowest(sole.iter().map(|point| *point - ankle))
            };
            // The sole of a foot that stands is as flat as the actor's.
            let [from, to] = LEVELLED.map(|height| height * leg);
            let most = ease((height - from) / (to - from));
            let share = least(most, |share| raised(share) >= lift);
            let gained = raised(share);
            if gained > 0.0 {
                turns[2] = part(share);
                lift -= gained;
            }
        }
        if lift <= 1e-6 * leg {
            return turns;
        }
        let hip = joint(self.upper[0]);
        let from_hip: Vec<DVec3> = match self.is_apart {
            true => vec![ankle - hip],
            false => sole.iter().map(|point| *point - hip).collect(),
        };
        let before = lowest(from_hip.iter().copied());
        let Some(shin) = &self.lower else {
            let way = (ankle - hip).with_y(0.0)
                + outward(rig, order, kinematics, self.upper[0]) * OUTWARD * leg;
            if let Some(way) = way.try_normalize() {
                let axis = way.cross(DVec3::Y);
                let raised = |angle: f64| {
                    let turn = math::rotation_around(axis, angle);
                    lowest(from_hip.iter().map(|point| turn * *point)) - before
                };
                let angle = least(MOST.to_radians(), |angle| raised(angle) >= lift);
                // The edge of a wide sole goes down before its middle goes up.
                if raised(angle) > 0.0 {
                    turns[0] = math::rotation_around(axis, angle);
                }
            }
            return turns;
        };
        let [above, below] = shin.knee.map(joint);
        let middle = above.midpoint(below);
        let top = self.upper[0];
        let thigh = kinematics.transforms[top].rotation * rig.parts[top].node.rotation.inverse();
        let left = thigh * (rig.facing.turn() * DVec3::X);
        let knee = Knee::new([middle - hip, ankle - middle], left);
        let raised = |height: f64| {
            let [upper, lower] = knee.lifted(height);
            let moved = |point: &DVec3| upper * knee.ways[0] + lower * (*point - knee.ways[0]);
            lowest(from_hip.iter().map(moved)) - before
        };
        let height = match self.is_apart {
            true => lift,
            false => least(2.0 * lift, |height| raised(height) >= lift),
        };
        let [upper, lower] = knee.lifted(height);
        turns[0] = upper;
        turns[1] = lower;
        turns
    }

    /// Applies turns, per frame those of the pieces above the knee, below it, and of the foot.
    pub(super) fn apply(&self, rotations: &mut Rotations, turns: &[[DQuat; 3]]) {
        for piece in &self.upper {
            rotations.turn(*piece, turns.iter().map(|turns| turns[0]));
        }
        if let Some(shin) = &self.lower {
            rotations.turn(shin.part, turns.iter().map(|turns| turns[1]));
        }
        if self.is_foot {
            rotations.turn(self.end, turns.iter().map(|turns| turns[2]));
        }
    }
}

/// The parts between whose joints the knee is that lies between two pieces of a leg, given all parts of the leg from the hip on.
fn knee(rig: &Rig, all: &[FigurePartId], [upper, lower]: [FigurePartId; 2]) -> [FigurePartId; 2] {
    let shares = |part: &FigurePartId| {
        let shared = rig.parts[*part].shared;
        shared.is_some_and(|shared| shared.between == [upper, lower])
    };
    let sharing = all.iter().copied().filter(shares);
    let sharing: Vec<FigurePartId> = sharing.chain([lower]).collect();
    let last = sharing.len() - 1;
    [sharing[last / 2], sharing[last.div_ceil(2)]]
}

impl Knee {
    /// A knee, given the ways from the hip to it and on, and the direction of the thigh's left.
    fn new(ways: [DVec3; 2], left: DVec3) -> Self {
        let [thigh, shin] = ways.map(|way| way.normalize_or(DVec3::NEG_Y));
        let bent = thigh.cross(shin);
        // Legs of birds and hind legs of animals may be bent the other way, and bend further so.
        let side = if bent.dot(left) < -CLEAR { -left } else { left };
        let axis = bent + side.reject_from_normalized(thigh) * CLEAR;
        Self {
            ways,
            axis: axis.normalize_or(left),
        }
    }

    /// The turns of thigh and shin that lift the end of the shin by this height, as far as the knee bends.
    fn lifted(&self, height: f64) -> [DQuat; 2] {
        let [thigh, shin] = self.ways;
        let target = thigh + shin + DVec3::Y * height;
        let bent = |angle: f64| math::rotation_around(self.axis, angle);
        let reaches = |angle: f64| (thigh + bent(angle) * shin).length() <= target.length();
        let angle = least(MOST_BENT.to_radians(), reaches);
        let end = thigh + bent(angle) * shin;
        let swing = match (end.try_normalize(), target.try_normalize()) {
            (Some(from), Some(to)) => arc(from, to, self.axis),
            _ => DQuat::IDENTITY,
        };
        [swing, swing * bent(angle)]
    }
}

/// The least value up to a limit that is enough, or the limit.
fn least(limit: f64, is_enough: impl Fn(f64) -> bool) -> f64 {
    if is_enough(0.0) {
        return 0.0;
    }
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
