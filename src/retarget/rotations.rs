//! The rotations of a rig's parts.

use crate::math;
use glam::{DQuat, DVec3};
use typed_index_collections::{TiSlice, TiVec, ti_vec};

use super::axes::Axes;
use super::rest_pose::RestPose;
use super::soles::{FootEnd, Sole, foot_axes};
use super::splayed::{self, Kept, Step};
use super::{Rig, RigPart, SharedTurn, Source};
use crate::labels::FigurePartId;
use crate::mocap::resample::TimeMap;
use crate::mocap::turns::{continuous, damp};
use crate::mocap::{Clip, JointId, Transform};
use crate::retarget::{Drive, Follow};

/// The rotations of parts in the drawing's axes, frame by frame.
pub(super) struct Rotations {
    /// Per part; `None` if it turns with its parent.
    own: TiVec<FigurePartId, Option<Vec<DQuat>>>,
    /// Per part the nearest ancestor (or itself) that turns on its own, and the part's rotation in that ancestor's frame.
    carrier: TiVec<FigurePartId, (Option<FigurePartId>, DQuat)>,
    /// Per part by how much it was turned further in each frame, radians; `None` if it was not.
    pub(super) turned: TiVec<FigurePartId, Option<Vec<f64>>>,
}

impl Rotations {
    /// Whether a part turns on its own, and not only with its parent.
    pub(super) fn is_own(&self, part: FigurePartId) -> bool {
        self.own[part].is_some()
    }

    /// The rotations of all parts that turn on their own.
    pub(super) fn all(&self) -> impl Iterator<Item = &[DQuat]> {
        self.own.iter().flatten().map(Vec::as_slice)
    }

    /// Lets a part turn on its own, and what hangs on it with it.
    pub(super) fn set(
        &mut self,
        rig: &Rig,
        order: &[FigurePartId],
        part: FigurePartId,
        turns: Vec<DQuat>,
    ) {
        self.own[part] = Some(turns);
        self.carry(rig, order);
    }

    /// Shares the turns of joints among the bones that bend a part there.
    pub(super) fn share(&mut self, rig: &Rig, order: &[FigurePartId]) {
        let mut is_shared = false;
        for part in order {
            let Some(SharedTurn { between, share }) = rig.parts[*part].shared else {
                continue;
            };
            let [before, after] = between;
            let Some(frames) = self.own[after].as_ref().map(Vec::len) else {
                continue;
            };
            let [from_rest, to_rest, rest] =
                [before, after, *part].map(|part| rig.parts[part].node.rotation);
            let turns = (0..frames).map(|frame| {
                let from = self.at(before, frame) * from_rest.inverse();
                let to = self.at(after, frame) * to_rest.inverse();
                (math::slerp(from, to, share) * rest).normalize()
            });
            let turns = turns.collect();
            self.own[*part] = Some(turns);
            is_shared = true;
        }
        if is_shared {
            self.carry(rig, order);
        }
    }

    /// Turns a part further, in every frame by a rotation in the drawing's axes.
    pub(super) fn turn(&mut self, part: FigurePartId, turns: impl Iterator<Item = DQuat>) {
        let Some(own) = &mut self.own[part] else {
            return;
        };
        let turned = self.turned[part].get_or_insert_with(|| vec![0.0; own.len()]);
        for ((own, turned), turn) in own.iter_mut().zip(turned).zip(turns) {
            *own = (turn * *own).normalize();
            *turned += math::angle_between_turns(turn, DQuat::IDENTITY);
        }
    }

    fn carry(&mut self, rig: &Rig, order: &[FigurePartId]) {
        for part in order {
            let drawn = rig.parts[*part].node.rotation;
            self.carrier[*part] = match (self.is_own(*part), rig.parts[*part].parent) {
                (true, _) => (Some(*part), DQuat::IDENTITY),
                (false, None) => (None, drawn),
                (false, Some(parent)) => {
                    let (carrier, inner) = self.carrier[parent];
                    let above = rig.parts[parent].node.rotation;
                    (carrier, inner * above.inverse() * drawn)
                }
            };
        }
    }

    /// The same rotations, played along a map of time.
    pub(super) fn timed(self, map: &TimeMap) -> Self {
        let timed = |turns: Vec<DQuat>| map.apply(&turns, math::slerp);
        Self {
            own: self.own.into_iter().map(|own| own.map(timed)).collect(),
            carrier: self.carrier,
            turned: {
                let between = |a: f64, b: f64, t: f64| a + (b - a) * t;
                let turned = self.turned.into_iter();
                turned
                    .map(|turned| Some(map.apply(&turned?, between)))
                    .collect()
            },
        }
    }

    /// The rotation of a part in the frame of its parent.
    pub(super) fn local(&self, part: FigurePartId, parent: FigurePartId, frame: usize) -> DQuat {
        (self.at(parent, frame).inverse() * self.at(part, frame)).normalize()
    }

    /// Damps the rotations of parts in their parents' frames, from those of the first frame on. What hangs on a damped part turns
    /// with it.
    pub(super) fn damp(
        &mut self,
        rig: &Rig,
        order: &[FigurePartId],
        ratios: &TiSlice<FigurePartId, Option<f64>>,
    ) {
        let ratio = |part: FigurePartId| {
            ratios
                .get(rig.parts[part].inside.unwrap_or(part))
                .copied()
                .flatten()
                .filter(|ratio| *ratio != 1.0)
        };
        let mut is_changed = ti_vec![false; rig.parts.len()];
        let mut changed: TiVec<FigurePartId, Option<Vec<DQuat>>> = ti_vec![None; rig.parts.len()];
        for part in order {
            let parent = rig.parts[*part].parent;
            let is_above = parent.is_some_and(|parent| is_changed[parent]);
            let own = self.own[*part].as_ref();
            is_changed[*part] = is_above || own.is_some() && ratio(*part).is_some();
            let Some(turns) = own.filter(|_| is_changed[*part]) else {
                continue;
            };
            let locals = (0..turns.len()).map(|frame| match parent {
                Some(parent) => self.local(*part, parent, frame),
                None => turns[frame],
            });
            let mut locals = continuous(locals.collect());
            if let Some(ratio) = ratio(*part) {
                damp(&mut locals, ratio);
            }
            let turns = locals.into_iter().enumerate().map(|(frame, local)| {
                let above = parent.map_or(DQuat::IDENTITY, |parent| {
                    let (carrier, inner) = self.carrier[parent];
                    let turns = carrier.and_then(|carrier| {
                        changed[carrier].as_ref().or(self.own[carrier].as_ref())
                    });
                    turns.map_or(inner, |turns| turns[frame] * inner)
                });
                (above * local).normalize()
            });
            changed[*part] = Some(turns.collect());
        }
        for (own, changed) in self.own.iter_mut().zip(changed) {
            if changed.is_some() {
                *own = changed;
            }
        }
    }

    /// The rotation of any part in a frame.
    pub(super) fn at(&self, part: FigurePartId, frame: usize) -> DQuat {
        let (carrier, inner) = self.carrier[part];
        let outer = carrier.and_then(|carrier| self.own[carrier].as_ref());
        outer.map_or(inner, |rotations| rotations[frame] * inner)
    }
}

pub(super) fn rotations(
    source: &mut Source<'_>,
    rest: &RestPose,
    order: &[FigurePartId],
    leg: f64,
) -> Rotations {
    let count = source.rig.parts.len();
    let mut known = splayed::kept(source);
    for part in order {
        let drive = source.rig.parts[*part].drive;
        if let Some(drive) = drive.filter(|drive| drive.follow == Follow::Sole) {
            known[*part] = Some(Kept {
                reference: Reference::on_sole(source, *part, &drive, leg),
                step: None,
            });
        }
    }
    let solver = |part: &FigurePartId| {
        let drive = source.rig.parts[*part].drive?;
        let kept = known[*part].unwrap_or_else(|| {
            let axes = rest.axes_for(&drive, &source.clip.skeleton, source.landmarks);
            Kept {
                reference: Reference::of(source.clip, &drive, axes, &rest.pose),
                step: None,
            }
        });
        let rotation = PartRotation::new(&source.rig.parts[*part], drive, &source.axes, kept);
        Some((*part, rotation))
    };
    let solvers: Vec<(FigurePartId, PartRotation)> = order.iter().filter_map(solver).collect();
    let mut own: TiVec<FigurePartId, Option<Vec<DQuat>>> = ti_vec![None; count];
    for (part, _) in &solvers {
        own[*part] = Some(Vec::with_capacity(source.clip.frames));
    }
    for frame in 0..source.clip.frames {
        let pose = source.poses.at(frame);
        for (part, solver) in &solvers {
            if let Some(rotations) = &mut own[*part] {
                rotations.push(solver.at(source.clip, pose));
            }
        }
    }
    let mut rotations = Rotations {
        own,
        carrier: ti_vec![(None, DQuat::IDENTITY); count],
        turned: ti_vec![None; count],
    };
    rotations.carry(source.rig, order);
    rotations.share(source.rig, order);
    rotations
}

/// What a joint's rotations are measured from.
#[derive(Debug, Clone, Copy)]
pub(super) struct Reference {
    /// From the drawing's axes to the joint's own: Rⱼ(r)ᵀ · Cᵣ.
    pub(super) turn: DQuat,
    /// The direction of the chain, if the part follows one, in the drawing's axes: Cᵣᵀ · d(r).
    pub(super) direction: Option<DVec3>,
}

impl Reference {
    /// Where a foot stands flat, as the drawn foot does, with its toes ahead.
    fn on_sole(source: &mut Source<'_>, part: FigurePartId, drive: &Drive, leg: f64) -> Self {
        let end = FootEnd::of(source.landmarks, drive);
        let flat = Sole::of(source, end, leg).flat;
        let drawn = foot_axes(DVec3::Y, drawn_toes(source.rig, part));
        Self {
            turn: (flat * drawn.inverse()).normalize(),
            direction: None,
        }
    }

    /// A pose as the reference, in which the body has these axes.
    pub(super) fn of(
        clip: &Clip,
        drive: &Drive,
        axes: DQuat,
        pose: &TiSlice<JointId, Transform>,
    ) -> Self {
        let direction = drive.direction(&clip.skeleton, pose);
        Self {
            turn: pose[drive.joint].rotation.inverse() * axes,
            direction: direction.map(|direction| axes.inverse() * direction),
        }
    }
}

/// The level direction in which a foot is drawn: where the figure faces, or to a side if the foot reaches more to that side of its leg
/// than ahead of it.
fn drawn_toes(rig: &Rig, part: FigurePartId) -> DVec3 {
    /// The share of a foot's width that is more on one side of the leg than on the other, from which on it points to that side.
    const ASIDE: f64 = 0.35;

    let ahead = rig.facing.turn() * DVec3::Z;
    let own = &rig.parts[part];
    let leg = own.parent.map(|parent| &rig.parts[parent]);
    let ankle = match leg.filter(|leg| leg.is_leg) {
        Some(leg) if !rig.facing.is_profile() => leg.tip,
        _ => return ahead,
    };
    let reach = |way: DVec3| {
        let reaches = own.surface.iter().map(|point| (*point - ankle).dot(way));
        reaches.fold(0.0, f64::max)
    };
    let [left, right] = [DVec3::NEG_X, DVec3::X].map(reach);
    let before = reach(ahead) - reach(-ahead);
    let aside = right - left;
    if aside.abs() > ASIDE * (left + right) && aside.abs() > before {
        DVec3::X * aside.signum()
    } else {
        ahead
    }
}

/// Computes the rotations of one part.
struct PartRotation {
    drive: Drive,
    reference: Reference,
    step: Option<Step>,
    /// From the clip's world to the drawing's axes: C₀ᵀ.
    to_drawing: DQuat,
    /// The rotation that the joint's change is applied to: A · D for limbs, D for bodies.
    drawn: DQuat,
    /// The viewer's axis in the clip's world.
    viewer: DVec3,
}

impl PartRotation {
    fn new(part: &RigPart, drive: Drive, axes: &Axes, kept: Kept) -> Self {
        let Kept { reference, step } = kept;
        let axis = (part.tip - part.joint).try_normalize();
        let align = match (drive.follow, axis, reference.direction) {
            (Follow::Direction, Some(axis), Some(direction)) => arc(axis, direction, DVec3::Z),
            _ => DQuat::IDENTITY,
        };
        Self {
            drive,
            reference,
            step,
            to_drawing: axes.first.inverse(),
            drawn: align * part.node.rotation,
            viewer: axes.first * DVec3::Z,
        }
    }

    /// G(k) · D with G(k) = C₀ᵀ · S(k) · Rⱼ(k) · Rⱼ(r)ᵀ · Cᵣ · A; A is the identity for parts that keep the drawn pose, S for those
    /// that follow no chain. A leg that keeps its drawn pose turns by what its foot moves.
    fn at(&self, clip: &Clip, pose: &TiSlice<JointId, Transform>) -> DQuat {
        if let Some(step) = self.step {
            return (step.change(self.to_drawing, pose) * self.drawn).normalize();
        }
        let turn = pose[self.drive.joint].rotation * self.reference.turn;
        let now = self.drive.direction(&clip.skeleton, pose);
        let straighten = match (self.reference.direction, now) {
            (Some(rest), Some(now)) => arc(turn * rest, now, self.viewer),
            _ => DQuat::IDENTITY,
        };
        let change = self.to_drawing * straighten * turn;
        (change * self.drawn).normalize()
    }
}

/// The shortest rotation from one direction to another, both unit vectors; a half turn goes about `about`.
pub(super) fn arc(from: DVec3, to: DVec3, about: DVec3) -> DQuat {
    /// Below this cosine the axis of the shortest rotation is undefined.
    const HALF_TURN: f64 = -1.0 + 1e-12;

    if from.dot(to) > HALF_TURN {
        // Not `from_rotation_arc`, which switches to a half turn some hundredths of a degree too early.
        let cross = from.cross(to);
        return DQuat::from_xyzw(cross.x, cross.y, cross.z, 1.0 + from.dot(to)).normalize();
    }
    let axis = about.reject_from(from).try_normalize();
    math::rotation_around(
        axis.unwrap_or_else(|| from.any_orthonormal_vector()),
        std::f64::consts::PI,
    )
}
