//! Room for arms: forearms and hands stay out of the trunk.
//!
//! A drawn trunk is wider than an actor's, and deeper, so that arms which hang beside the actor's, or are held before its chest, would
//! go through it. The upper arm opens then, with all that hangs on it, on the shortest way out, by the least angle that changes smoothly.

use glam::{DQuat, DVec3};
use typed_index_collections::TiVec;

use super::kinematics::ForwardKinematics;
use super::rotations::Rotations;
use super::turns::Length;
use super::{Rig, RigPart};
use crate::labels::FigurePartId;
use crate::math;
use crate::mocap::Transform;
use crate::smoothing::envelope;

/// How long an arm takes to open, seconds.
const EASE: f64 = 0.15;
/// How often arms are opened further: where one leaves one part of the trunk, it may enter another.
const ROUNDS: usize = 8;
/// The most by which an arm opens in one round and altogether, degrees.
const STEP: f64 = 12.0;
const MOST: f64 = 60.0;
/// Arms may be in the trunk by this share of the figure's longest arm.
const ALLOWED: f64 = 0.01;
/// The stations along a piece of an arm at which it is looked at.
const STATIONS: usize = 5;
/// The directions in which trunks are measured: around the viewer's axis, and their angles with the drawing plane, degrees.
const AROUND: usize = 16;
const TILTS: [f64; 3] = [-45.0, 0.0, 45.0];

/// Opens the arms of a rig where they would be in its trunk.
pub(super) fn open(rig: &Rig, order: &[FigurePartId], rotations: &mut Rotations, length: &Length) {
    let trunk: Vec<Volume> = rig
        .parts
        .keys()
        .filter_map(|part| Volume::of(rig, part))
        .collect();
    let arms: Vec<Arm> = order
        .iter()
        .filter_map(|part| Arm::of(rig, order, *part, &trunk))
        .collect();
    if trunk.is_empty() || arms.is_empty() {
        return;
    }
    let (frames, reach) = (length.frames, length.frames_in(EASE));
    let mut openings = vec![vec![DVec3::ZERO; frames]; arms.len()];
    // Per arm the frames in which it was outside, and has not been opened further since.
    let mut is_settled = vec![vec![false; frames]; arms.len()];
    let mut separating = vec![vec![0; trunk.len()]; arms.len()];
    let mut kinematics = ForwardKinematics::new(rig);
    for _ in 0..ROUNDS {
        let mut further = vec![vec![DVec3::ZERO; frames]; arms.len()];
        for frame in 0..frames {
            if is_settled.iter().all(|is_settled| is_settled[frame]) {
                continue;
            }
            kinematics.pose(rig, rotations, order, frame);
            for (index, arm) in arms.iter().enumerate() {
                if !is_settled[index][frame] {
                    let (placed, opening) = (&kinematics.transforms, openings[index][frame]);
                    let separating = &mut separating[index];
                    further[index][frame] = arm.way_out(rig, placed, &trunk, opening, separating);
                }
            }
        }
        if further.iter().flatten().all(|way| *way == DVec3::ZERO) {
            break;
        }
        for (index, further) in further.into_iter().enumerate() {
            let eased = eased(&further, reach, length.is_cycle);
            let frames = openings[index].iter_mut().zip(&mut is_settled[index]);
            for ((opening, is_settled), (way, further)) in frames.zip(further.iter().zip(eased)) {
                let before = *opening;
                *opening = (before + further).clamp_length_max(MOST.to_radians());
                *is_settled = *way == DVec3::ZERO && *opening == before;
            }
        }
    }
    for (arm, openings) in arms.iter().zip(openings) {
        if openings.iter().any(|opening| *opening != DVec3::ZERO) {
            arm.apply(rig, rotations, &openings);
        }
    }
}

/// Smooth rotation vectors that are as large as these in each direction, or larger.
fn eased(ways: &[DVec3], reach: usize, is_cycle: bool) -> Vec<DVec3> {
    let along = |axis: DVec3| {
        let values: Vec<f64> = ways.iter().map(|way| way.dot(axis).max(0.0)).collect();
        envelope(&values, reach, is_cycle)
    };
    let mut eased = vec![DVec3::ZERO; ways.len()];
    for axis in DVec3::AXES.into_iter().flat_map(|axis| [axis, -axis]) {
        for (eased, value) in eased.iter_mut().zip(along(axis)) {
            *eased += axis * value;
        }
    }
    eased
}

/// A part of the trunk: what is between planes in many directions.
struct Volume {
    part: FigurePartId,
    /// Per direction of the drawing's axes how far the part reaches in it, as drawn.
    planes: Vec<(DVec3, f64)>,
}

impl Volume {
    fn of(rig: &Rig, part: FigurePartId) -> Option<Self> {
        let own = &rig.parts[part];
        if own.is_arm || own.outline.is_empty() {
            return None;
        }
        let plane = |direction: DVec3| {
            let reaches = own.outline.iter().map(|point| point.dot(direction));
            (direction, reaches.fold(f64::NEG_INFINITY, f64::max))
        };
        Some(Self {
            part,
            planes: directions().map(plane).collect(),
        })
    }

    /// How far a point of the drawing is inside, and the nearest way out, if it is deeper than `least`. `separating` is a plane behind
    /// which the point before was not so deep; most often this one is not, either.
    fn deeper_than(
        &self,
        least: f64,
        point: DVec3,
        separating: &mut usize,
    ) -> Option<(f64, DVec3)> {
        let is_shallow = |(way, reach): &(DVec3, f64)| reach - point.dot(*way) <= least;
        if is_shallow(&self.planes[*separating]) {
            return None;
        }
        match self.planes.iter().position(is_shallow) {
            Some(plane) => {
                *separating = plane;
                None
            }
            None => Some(self.depth(point)),
        }
    }

    /// How far a point of the drawing is inside, negative outside, and the nearest way out.
    fn depth(&self, point: DVec3) -> (f64, DVec3) {
        let depths = self
            .planes
            .iter()
            .map(|(way, reach)| (reach - point.dot(*way), *way));
        let nearest = depths.min_by(|a, b| a.0.total_cmp(&b.0));
        nearest.unwrap_or((f64::NEG_INFINITY, DVec3::Z))
    }
}

fn directions() -> impl Iterator<Item = DVec3> {
    let around = (0..AROUND).flat_map(|step| {
        let angle = std::f64::consts::TAU * step as f64 / AROUND as f64;
        TILTS.map(|tilt| {
            let (out, level) = math::sin_cos(tilt.to_radians());
            DVec3::new(math::cos(angle) * level, math::sin(angle) * level, out)
        })
    });
    around.chain([DVec3::Z, DVec3::NEG_Z])
}

/// An arm that may open.
struct Arm {
    /// Its first piece, which turns about the shoulder.
    top: FigurePartId,
    /// What the arm is attached to.
    chest: FigurePartId,
    /// What turns with it.
    carried: Vec<FigurePartId>,
    /// Points of forearm and hand as drawn, with the part that each belongs to, and per volume of the trunk how deep it may be in it.
    points: Vec<(FigurePartId, DVec3, Vec<f64>)>,
}

impl Arm {
    fn of(rig: &Rig, order: &[FigurePartId], top: FigurePartId, trunk: &[Volume]) -> Option<Self> {
        let own = &rig.parts[top];
        let chest = own
            .parent
            .filter(|parent| own.is_arm && !rig.parts[*parent].is_arm)?;
        let carried = order.iter().copied();
        let carried: Vec<FigurePartId> = carried.filter(|part| rig.is_below(*part, top)).collect();
        let pieces: Vec<FigurePartId> = carried
            .iter()
            .copied()
            .filter(|part| rig.parts[*part].is_arm)
            .collect();
        let allowed = ALLOWED * (rig.parts[*pieces.last()?].tip - own.joint).length();
        let mut points = Vec::new();
        for piece in &pieces {
            // Of an arm of one piece, the outer half is the forearm.
            let is_whole = *piece == top;
            if is_whole && pieces.len() > 2 {
                continue;
            }
            let from = match (is_whole, pieces.len()) {
                (true, 1) => 0.5,
                (true, _) if is_whole_arm(rig, &pieces) => 0.5,
                (true, _) => continue,
                (false, _) => 0.0,
            };
            for point in stations(&rig.parts[*piece], from) {
                let depths = trunk
                    .iter()
                    .map(|volume| volume.depth(point).0.max(allowed));
                points.push((*piece, point, depths.collect()));
            }
        }
        Some(Self {
            top,
            chest,
            carried,
            points,
        })
    }

    /// The shortest way out of the trunk for the deepest point of an arm that is opened: a rotation vector in the axes of what the arm is
    /// attached to. Zero if it is outside. `separating` has a plane of each volume, see
    /// [`Volume::deeper_than`].
    fn way_out(
        &self,
        rig: &Rig,
        placed: &TiVec<FigurePartId, Transform>,
        trunk: &[Volume],
        opening: DVec3,
        separating: &mut [usize],
    ) -> DVec3 {
        let drawn = |part: FigurePartId| rig.parts[part].node;
        let chest = placed[self.chest].rotation * drawn(self.chest).rotation.inverse();
        let shoulder = placed[self.top].apply(drawn(self.top).to_local(rig.parts[self.top].joint));
        let turn = math::rotation_along(chest * opening);
        let mut deepest = (0.0, DVec3::ZERO, DVec3::ZERO);
        for (part, point, allowed) in &self.points {
            let now = placed[*part].apply(drawn(*part).to_local(*point));
            let now = shoulder + turn * (now - shoulder);
            for ((volume, allowed), separating) in trunk.iter().zip(allowed).zip(&mut *separating) {
                let node = drawn(volume.part);
                let as_drawn = node.apply(placed[volume.part].to_local(now));
                let least = allowed + deepest.0;
                if let Some((depth, way)) = volume.deeper_than(least, as_drawn, separating) {
                    let way = placed[volume.part].rotation * node.rotation.inverse() * way;
                    deepest = (depth - allowed, now - shoulder, way);
                }
            }
        }
        let (depth, arm, way) = deepest;
        let lever = arm.cross(way);
        let Some(axis) = lever.try_normalize().filter(|_| depth > 0.0) else {
            return DVec3::ZERO;
        };
        let angle = (depth / lever.length()).min(STEP.to_radians());
        chest.inverse() * axis * angle
    }

    fn apply(&self, rig: &Rig, rotations: &mut Rotations, openings: &[DVec3]) {
        let drawn = rig.parts[self.chest].node.rotation.inverse();
        let turns = openings.iter().enumerate().map(|(frame, opening)| {
            let chest = rotations.at(self.chest, frame) * drawn;
            math::rotation_along(chest * *opening)
        });
        let turns: Vec<DQuat> = turns.collect();
        for part in &self.carried {
            rotations.turn(*part, turns.iter().copied());
        }
    }
}

/// Whether the first of these pieces of an arm is the whole arm, and the rest its hand: that is shorter than half of it.
fn is_whole_arm(rig: &Rig, pieces: &[FigurePartId]) -> bool {
    let length = |part: FigurePartId| rig.parts[part].joint.distance(rig.parts[part].tip);
    let rest: f64 = pieces.iter().skip(1).map(|part| length(*part)).sum();
    rest < length(pieces[0]) / 2.0
}

/// Points of a piece around its axis, from a share of its length on.
fn stations(part: &RigPart, from: f64) -> Vec<DVec3> {
    let axis = part.tip - part.joint;
    let Some(along) = axis.try_normalize() else {
        return Vec::new();
    };
    let across = along.cross(DVec3::Z).normalize_or(DVec3::X);
    let reach = |way: DVec3| {
        let reaches = part
            .outline
            .iter()
            .map(|point| (*point - part.joint).dot(way));
        reaches.fold(0.0, f64::max)
    };
    let sides = [across, -across, DVec3::Z, DVec3::NEG_Z].map(|way| way * reach(way));
    let length = reach(along).max(axis.length());
    let stations = (0..=STATIONS).map(|step| from + (1.0 - from) * step as f64 / STATIONS as f64);
    let points = stations.flat_map(|share| {
        let middle = part.joint + along * (length * share);
        // Pieces are rounded at their ends.
        let width = if share == 1.0 { 0.0 } else { 1.0 };
        sides.map(|side| middle + side * width)
    });
    points.collect()
}
