//! Follow-through: parts that hang lag behind what they hang on, and overshoot (motion.md, Follow-through).
//!
//! The far end of such a part is a weight on a rod. A damped spring pulls it to where it would be without swinging, and gravity
//! pulls it down, less what it pulls in the drawing: as drawn, a figure at rest is in balance.

use glam::{DQuat, DVec3};

use super::Rig;
use super::kinematics::ForwardKinematics;
use super::rotations::{Rotations, arc};
use crate::motion::skeleton::{Transform, height};

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
/// What pulls the weight is smoothed by a Gaussian of this deviation, seconds: frames miss what happens between them, and feet that
/// are locked to the ground push the body in jerks.
const SMOOTHING: f64 = 0.05;
/// The largest deviation from the drawn pose, degrees.
const MAX_ANGLE: f64 = 60.0;
/// How often the weight is pushed out of what the part hangs on and back onto its rod.
const PUSHES: usize = 3;
/// A clip whose first and last frame differ by less than this, degrees, is a cycle.
const CYCLE: f64 = 5.0;

/// Lets the parts of a rig that swing do so, parents before children. `path` is where the root part's node is.
pub(super) fn swing(
    rig: &Rig,
    order: &[usize],
    path: &[DVec3],
    frame_time: f64,
    rotations: &mut Rotations,
) {
    let metre = metre(rig);
    let is_timed = frame_time > 0.0 && frame_time.is_finite();
    if !(metre > 0.0 && metre.is_finite() && is_timed && path.len() > 1) {
        return;
    }
    let warm_up = is_cycle(rotations, path.len());
    for part in order {
        let own = &rig.parts[*part];
        let Some(stiffness) = own.swing else { continue };
        let axis = own.node.rotation.inverse() * (own.tip - own.joint);
        let length = axis.length();
        if !(length > 0.0 && length.is_finite() && stiffness > 0.0) {
            continue;
        }
        let carried = Carried::of(rig, order, *part, path, rotations, SMOOTHING / frame_time);
        let obstacle = own
            .parent
            .and_then(|parent| Obstacle::of(rig, parent, own.tip));
        let pendulum = Pendulum {
            length,
            frame_time,
            stiffness: stiffness.min(MAX_STIFFNESS) * (std::f64::consts::TAU * FREQUENCY).powi(2),
            gravity: GRAVITY * metre,
            down: own.node.rotation.inverse() * DVec3::NEG_Y,
            axis: axis / length,
            obstacle,
        };
        let directions = pendulum.swing(&carried, warm_up);
        let turns = carried.frames.iter().zip(directions);
        let turns = turns.map(|(frame, direction)| {
            let drawn = frame.rotation * pendulum.axis;
            (arc(drawn, direction, DVec3::Z) * frame.rotation).normalize()
        });
        let turns = turns.collect();
        rotations.set(rig, order, *part, turns);
    }
}

/// Drawing units per metre.
fn metre(rig: &Rig) -> f64 {
    let ends = rig.parts.iter().flat_map(|part| [part.joint, part.tip]);
    height(ends) / HEIGHT
}

/// Whether a clip ends as it begins, so that it may be repeated.
fn is_cycle(rotations: &Rotations, frames: usize) -> bool {
    let mut turns = rotations.all();
    turns.all(|turns| turns[0].angle_between(turns[frames - 1]) < CYCLE.to_radians())
}

/// How a part moves without swinging.
struct Carried {
    /// Per frame the rotation of its node, and the position of its joint.
    frames: Vec<Transform>,
    /// Per frame the node of what it hangs on.
    above: Vec<Transform>,
    /// Per frame the position of its joint, smoothed.
    way: Vec<DVec3>,
    /// Per frame where its far end is, relative to the joint, smoothed.
    aim: Vec<DVec3>,
}

impl Carried {
    fn of(
        rig: &Rig,
        order: &[usize],
        part: usize,
        path: &[DVec3],
        rotations: &Rotations,
        deviation: f64,
    ) -> Self {
        let own = &rig.parts[part];
        let joint = own.node.to_local(own.joint);
        let mut kinematics = ForwardKinematics::new(rig);
        let mut frames = Vec::with_capacity(path.len());
        let mut above = Vec::with_capacity(path.len());
        for (frame, root) in path.iter().enumerate() {
            kinematics.pose(rig, rotations, order, frame);
            let placed = |part: usize| Transform {
                position: kinematics.transforms[part].position + *root,
                ..kinematics.transforms[part]
            };
            let node = placed(part);
            frames.push(Transform {
                rotation: node.rotation,
                position: node.apply(joint),
            });
            above.push(own.parent.map_or(node, placed));
        }
        let axis = own.node.rotation.inverse() * (own.tip - own.joint);
        let joints: Vec<DVec3> = frames.iter().map(|frame| frame.position).collect();
        let ends: Vec<DVec3> = frames.iter().map(|frame| frame.rotation * axis).collect();
        Self {
            way: smooth(&joints, deviation),
            aim: smooth(&ends, deviation),
            frames,
            above,
        }
    }
}

/// A path, a point per frame, smoothed by a Gaussian whose deviation is given in frames.
fn smooth(path: &[DVec3], deviation: f64) -> Vec<DVec3> {
    let reach = (3.0 * deviation).ceil() as isize;
    let last = path.len() as isize - 1;
    // Beyond the ends it goes on as it came, mirrored in the end point.
    let at = |index: isize| {
        let inside = index.clamp(0, last);
        let mirrored = (2 * inside - index).clamp(0, last);
        match inside == index {
            true => path[inside as usize],
            false => path[inside as usize] * 2.0 - path[mirrored as usize],
        }
    };
    let near = |frame: usize| {
        let (mut sum, mut weights) = (DVec3::ZERO, 0.0);
        for away in -reach..=reach {
            let weight = (-(away as f64 / deviation).powi(2) / 2.0).exp();
            sum += at(frame as isize + away) * weight;
            weights += weight;
        }
        sum / weights
    };
    (0..path.len()).map(near).collect()
}

/// The part that another hangs on, as an ellipsoid in the axes of its node.
struct Obstacle {
    center: DVec3,
    half: DVec3,
    /// How deep the hanging part is inside in the drawing: 1 at the surface, 0 at the centre.
    level: f64,
}

impl Obstacle {
    fn of(rig: &Rig, parent: usize, tip: DVec3) -> Option<Self> {
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
        match level > 0.0 && level < self.level {
            true => node.apply(self.center + (local - self.center) * (self.level / level)),
            false => point,
        }
    }
}

struct Pendulum {
    length: f64,
    frame_time: f64,
    /// The spring's force per length, 1/s².
    stiffness: f64,
    gravity: f64,
    /// Down and the part's axis in the drawing, in the axes of its node.
    down: DVec3,
    axis: DVec3,
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
            offset: carried.frames[0].rotation * self.axis * self.length,
            velocity: DVec3::ZERO,
        };
        let (first, last) = self.play(carried, rest);
        if !warm_up {
            return first;
        }
        // The clip ends almost as it begins.
        let [begin, end] =
            [0, carried.frames.len() - 1].map(|frame| carried.frames[frame].rotation);
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
        let mut directions = vec![weight.offset / self.length];
        for frame in 1..carried.frames.len() {
            let at = |step: usize| Moment::between(carried, frame, step as f64 / steps);
            let mut before = at(0);
            for step in 1..=steps as usize {
                let now = at(step);
                weight = self.step(weight, &before, &now, time);
                before = now;
            }
            directions.push(weight.offset / self.length);
        }
        (directions, weight)
    }

    fn step(&self, weight: Weight, before: &Moment, now: &Moment, time: f64) -> Weight {
        let target = now.aim.normalize_or(self.axis) * self.length;
        let carried = (target - before.aim.normalize_or(self.axis) * self.length) / time;
        let damping = 2.0 * DAMPING * self.stiffness.sqrt();
        // The joint's acceleration acts on the weight like a force in the opposite direction.
        let inertia = -(now.velocity - before.velocity) / (self.frame_time * time);
        let gravity = (DVec3::NEG_Y - now.frame.rotation * self.down) * self.gravity;
        let spring = (target - weight.offset) * self.stiffness;
        let force = spring + inertia + gravity - (weight.velocity - carried) * damping;
        let velocity = weight.velocity + force * time;
        let drawn = now.frame.rotation * self.axis * self.length;
        let offset = self.constrained(weight.offset + velocity * time, now, drawn);
        Weight {
            offset,
            velocity: (offset - weight.offset) / time,
        }
    }

    /// The weight on its rod, outside of what the part hangs on, and not too far from the drawn pose.
    fn constrained(&self, mut offset: DVec3, now: &Moment, drawn: DVec3) -> DVec3 {
        for _ in 0..PUSHES {
            if let Some(obstacle) = &self.obstacle {
                let joint = now.frame.position;
                offset = obstacle.outside(&now.above, joint + offset) - joint;
            }
            offset = offset
                .try_normalize()
                .map_or(drawn, |way| way * self.length);
        }
        let most = MAX_ANGLE.to_radians();
        let cross = drawn.cross(offset);
        let angle = cross.length().atan2(drawn.dot(offset));
        if angle <= most || angle.is_nan() {
            return offset;
        }
        let axis = cross.try_normalize();
        let axis = axis.unwrap_or_else(|| (drawn / self.length).any_orthonormal_vector());
        DQuat::from_axis_angle(axis, most) * drawn
    }
}

/// How a part is carried at a time between two frames.
struct Moment {
    frame: Transform,
    /// The velocity of the joint, drawing units a frame.
    velocity: DVec3,
    above: Transform,
    /// Where the far end would be without swinging, relative to the joint, smoothed.
    aim: DVec3,
}

impl Moment {
    /// The moment at a share of the time from the frame before to a frame. Velocity and aim are those on a Catmull-Rom
    /// spline, so that they have no kinks, whatever the frame rate.
    fn between(carried: &Carried, frame: usize, share: f64) -> Self {
        let way = Spline::of(&carried.way, frame);
        let aim = Spline::of(&carried.aim, frame);
        let place = |track: &[Transform]| {
            let [before, now] = [&track[frame - 1], &track[frame]];
            Transform {
                rotation: before.rotation.slerp(now.rotation, share),
                position: before.position.lerp(now.position, share),
            }
        };
        Self {
            frame: place(&carried.frames),
            velocity: way.velocity(share),
            above: place(&carried.above),
            aim: aim.position(share),
        }
    }
}

/// A Catmull-Rom spline from the frame before to a frame, by the coefficients of its powers of the share of the way.
struct Spline([DVec3; 4]);

impl Spline {
    fn of(path: &[DVec3], frame: usize) -> Self {
        let [b, c] = [path[frame - 1], path[frame]];
        // Beyond the ends it goes on as it came.
        let a = if frame > 1 {
            path[frame - 2]
        } else {
            b * 2.0 - c
        };
        let d = path.get(frame + 1).copied().unwrap_or(c * 2.0 - b);
        Self([
            b,
            (c - a) / 2.0,
            a - b * 2.5 + c * 2.0 - d / 2.0,
            (b - c) * 1.5 + (d - a) / 2.0,
        ])
    }

    fn position(&self, share: f64) -> DVec3 {
        let [still, linear, square, cubic] = self.0;
        still + (linear + (square + cubic * share) * share) * share
    }

    /// Per frame.
    fn velocity(&self, share: f64) -> DVec3 {
        let [_, linear, square, cubic] = self.0;
        linear + (square * 2.0 + cubic * (3.0 * share)) * share
    }
}
