//! Follow-through: parts that hang lag behind what they hang on, and overshoot (docs/motion.md, "Hair, tails and capes").
//!
//! The far end of such a part is a weight on a rod. A damped spring pulls it to where it would be without swinging, and gravity
//! pulls it down, less what it pulls in the drawing: as drawn, a figure at rest is in balance.

use glam::DVec3;

use super::Rig;
use super::carried::{self, Carriage, Carried, Tracks};
use super::rotations::{Rotations, arc};
use crate::labels::FigurePartId;
use crate::math;
use crate::mocap::{Transform, height};

/// Steps of the integration per second, at least; every frame has a whole number of them.
const STEPS: f64 = 240.0;
/// The natural frequency of a part of stiffness 1, hertz.
const FREQUENCY: f64 = 1.5;
/// Stiffer parts hardly swing, and would need shorter steps.
const MAX_STIFFNESS: f64 = 400.0;
/// The damping ratio: below 1, so the part overshoots.
const DAMPING: f64 = 0.3;
/// Gravity, m/s².
const GRAVITY: f64 = 9.81;
/// The height of a figure, metres: drawings have no scale.
const HEIGHT: f64 = 1.7;
/// How a part is carried is smoothed by a Gaussian of this deviation, seconds: frames miss what happens between them, and feet that
/// are locked to the ground push the body in jerks. With less, motions at 24 and at 60 frames a second differ by more than 2°.
const SMOOTHING: f64 = 0.07;
/// The largest deviation from the drawn pose, degrees.
const MAX_ANGLE: f64 = 60.0;
/// The same of each bone of a part that bends: they add up.
const MAX_ANGLE_OF_BONE: f64 = 25.0;
/// How often the weight is pushed out of what the part hangs on and back onto its rod.
const PUSHES: usize = 3;
/// A clip whose first and last frame differ by less than this, degrees, is a cycle.
const CYCLE: f64 = 5.0;

/// Lets the parts of a rig that swing do so, parents before children. `path` is where the root part's node is.
pub(super) fn swing(
    rig: &Rig,
    order: &[FigurePartId],
    path: &[DVec3],
    frame_time: f64,
    rotations: &mut Rotations,
) {
    let meter = meter(rig);
    let is_timed = frame_time > 0.0 && frame_time.is_finite();
    if !(meter > 0.0 && meter.is_finite() && is_timed && path.len() > 1) {
        return;
    }
    let deviation = SMOOTHING / frame_time;
    let warm_up = is_cycle(rotations, path.len());
    let mut tracks = Tracks::new(rig);
    for part in order {
        let own = &rig.parts[*part];
        let Some(stiffness) = own.swing else { continue };
        let way = own.tip - own.joint;
        let length = way.length();
        if !(length > 0.0 && length.is_finite() && stiffness > 0.0) {
            continue;
        }
        let carried = Carried::of(rig, *part, path, rotations, &mut tracks, deviation);
        // A bone turns where the one before ends, and stays out of what the whole part hangs on.
        let obstacle =
            carried::held_by(rig, *part).and_then(|holder| Obstacle::of(rig, holder, own.tip));
        let bones = bones(rig, *part);
        let pendulum = Pendulum {
            length,
            frame_time,
            // The deviations of short bones add up: they are as much stiffer as the part has more of them.
            stiffness: (stiffness * bones as f64).min(MAX_STIFFNESS)
                * (std::f64::consts::TAU * FREQUENCY).powi(2),
            gravity: GRAVITY * meter,
            most: match bones {
                1 => MAX_ANGLE.to_radians(),
                _ => MAX_ANGLE_OF_BONE.to_radians(),
            },
            obstacle,
        };
        let directions = pendulum.swing(&carried, warm_up);
        let turns = directions.into_iter().enumerate();
        let turns = turns.map(|(frame, direction)| {
            let drawn = carried.at(frame).aim / length;
            (arc(drawn, direction, DVec3::Z) * carried.rotations[frame]).normalize()
        });
        let turns = turns.collect();
        rotations.set(rig, order, *part, turns);
        tracks.forget(*part);
    }
}

/// How many bones swing in the part that a bone belongs to.
fn bones(rig: &Rig, part: FigurePartId) -> usize {
    let whole = rig.parts[part].inside.unwrap_or(part);
    let inside = rig.parts.iter();
    1 + inside
        .filter(|bone| bone.inside == Some(whole) && bone.swing.is_some())
        .count()
}

/// Drawing units per metre.
fn meter(rig: &Rig) -> f64 {
    let ends = rig.parts.iter().flat_map(|part| [part.joint, part.tip]);
    height(ends) / HEIGHT
}

/// Whether a clip ends as it begins, so that it may be repeated.
pub(super) fn is_cycle(rotations: &Rotations, frames: usize) -> bool {
    let mut turns = rotations.all();
    turns.all(|turns| math::angle_between_turns(turns[0], turns[frames - 1]) < CYCLE.to_radians())
}

/// The part that another hangs on, as an ellipsoid in the axes of its node.
struct Obstacle {
    center: DVec3,
    half: DVec3,
    /// How deep the hanging part is inside in the drawing: 1 at the surface, 0 at the centre.
    level: f64,
}

impl Obstacle {
    fn of(rig: &Rig, parent: FigurePartId, tip: DVec3) -> Option<Self> {
        let node = &rig.parts[parent].node;
        let mut points = rig.parts[parent].surface.iter().map(|p| node.to_local(*p));
        let first = points.next()?;
        let (low, high) = points.fold((first, first), |(low, high), point| {
            (low.min(point), high.max(point))
        });
        let mut obstacle = Self {
            center: (low + high) / 2.0,
            half: (high - low) / 2.0,
            level: 1.0,
        };
        if obstacle.half.min_element() <= 0.0 {
            return None;
        }
        obstacle.level = obstacle.level_at(node.to_local(tip)).min(1.0);
        Some(obstacle)
    }

    fn level_at(&self, point: DVec3) -> f64 {
        ((point - self.center) / self.half).length()
    }

    /// A point outside, as near as in the drawing at most; the point itself if it is.
    fn outside(&self, node: &Transform, point: DVec3) -> DVec3 {
        let local = node.to_local(point);
        let level = self.level_at(local);
        if level > 0.0 && level < self.level {
            node.apply(self.center + (local - self.center) * (self.level / level))
        } else {
            point
        }
    }
}

struct Pendulum {
    length: f64,
    frame_time: f64,
    /// The spring's force per length, 1/s².
    stiffness: f64,
    gravity: f64,
    /// The largest deviation from the drawn pose, radians.
    most: f64,
    obstacle: Option<Obstacle>,
}

/// The weight: where it is and how it moves, relative to the joint.
#[derive(Clone, Copy)]
struct Weight {
    offset: DVec3,
    velocity: DVec3,
}

impl Pendulum {
    /// The directions of the part in all frames. It begins at rest, and with a `warm_up` as it is after having played the clip once.
    fn swing(&self, carried: &Carried, warm_up: bool) -> Vec<DVec3> {
        let rest = Weight {
            offset: carried.at(0).aim,
            velocity: DVec3::ZERO,
        };
        let (first, last) = self.play(carried, rest);
        if !warm_up {
            return first;
        }
        // The clip ends almost as it begins.
        let [begin, end] = [0, carried.rotations.len() - 1].map(|frame| carried.rotations[frame]);
        let back = begin * end.inverse();
        let again = Weight {
            offset: back * last.offset,
            velocity: back * last.velocity,
        };
        self.play(carried, again).0
    }

    fn play(&self, carried: &Carried, mut weight: Weight) -> (Vec<DVec3>, Weight) {
        let steps = (self.frame_time * STEPS).ceil().max(1.0);
        let time = self.frame_time / steps;
        // What is shown obeys the limits in the very pose of the frame, what swings on those of the smooth paths.
        let shown = |weight: &Weight, frame: usize| {
            self.constrained(weight.offset, &carried.at(frame)) / self.length
        };
        let mut directions = vec![shown(&weight, 0)];
        for frame in 1..carried.rotations.len() {
            let between = carried.between(frame);
            let mut before = between(0.0);
            for step in 1..=steps as usize {
                let now = between(step as f64 / steps);
                weight = self.step(weight, &before, &now, time);
                before = now;
            }
            directions.push(shown(&weight, frame));
        }
        (directions, weight)
    }

    fn step(&self, weight: Weight, before: &Carriage, now: &Carriage, time: f64) -> Weight {
        let target = self.on_rod(now.aim, DVec3::Y);
        let carried = (target - self.on_rod(before.aim, target)) / time;
        let damping = 2.0 * DAMPING * self.stiffness.sqrt();
        // The joint's acceleration acts on the weight like a force in the opposite direction.
        let inertia = -(now.velocity - before.velocity) / (self.frame_time * time);
        let gravity = (DVec3::NEG_Y - now.down) * self.gravity;
        let spring = (target - weight.offset) * self.stiffness;
        let force = spring + inertia + gravity - (weight.velocity - carried) * damping;
        let velocity = weight.velocity + force * time;
        let offset = self.constrained(weight.offset + velocity * time, now);
        Weight {
            offset,
            velocity: (offset - weight.offset) / time,
        }
    }

    /// The end of the rod in a direction, or in another one if that has no length.
    fn on_rod(&self, way: DVec3, other: DVec3) -> DVec3 {
        way.try_normalize()
            .unwrap_or_else(|| other.normalize_or(DVec3::Y))
            * self.length
    }

    /// The weight on its rod, outside of what the part hangs on, and not too far from the drawn pose.
    fn constrained(&self, mut offset: DVec3, now: &Carriage) -> DVec3 {
        let drawn = self.on_rod(now.aim, DVec3::Y);
        for _ in 0..PUSHES {
            if let Some(obstacle) = &self.obstacle {
                offset = obstacle.outside(&now.above, offset);
            }
            offset = self.on_rod(offset, drawn);
        }
        let most = self.most;
        let cross = drawn.cross(offset);
        let angle = math::atan2(cross.length(), drawn.dot(offset));
        if angle <= most || angle.is_nan() {
            return offset;
        }
        let axis = cross.try_normalize();
        let axis = axis.unwrap_or_else(|| (drawn / self.length).any_orthonormal_vector());
        math::rotation_around(axis, most) * drawn
    }
}
