//! What a figure does on the spot: keys as an animator sets them, with eases between. All of them begin and end in the same pose.

use std::f64::consts::TAU;

use glam::{DQuat, DVec3};

use super::BuiltIn;
use super::body::{Arm, Body, Leg, sign};
use super::curves::{bump, hermite, keyed};
use super::gaits::lower;
use super::pose::{Foot, Pose, lean, tip, turn};
use crate::labels::Side;
use crate::math;
use crate::mocap::JointId;
use crate::smoothing::ease;

/// The height of the hips above the ankles for which lengths in this file are meant: an adult's, centimetres.
const LEG: f64 = 83.0;

/// How far the leg that stretches most may do so, as a share of its length: whoever stands on two or four legs has almost straight
/// ones, an insect has bent ones.
const REACH: [f64; 2] = [0.997, 0.8];

/// How far an arm that hangs is spread, and its elbow bent, degrees.
const HANGING: [f64; 2] = [7.0, 14.0];

/// The poses of an action; `None` for gaits.
pub(super) fn poses(clip: BuiltIn, body: &Body) -> Option<Vec<Pose>> {
    let (frames, pose): (usize, fn(&Body, f64) -> Pose) = match clip {
        BuiltIn::Idle => (72, idle),
        BuiltIn::Wave => (60, wave),
        BuiltIn::Dance => (48, dance),
        BuiltIn::Punch => (48, punch),
        BuiltIn::Jump => (40, jump),
        _ => return None,
    };
    let mut poses: Vec<Pose> = (0..=frames).map(|frame| pose(body, frame as f64)).collect();
    lower(body, &mut poses, REACH[usize::from(body.legs.len() > 4)]);
    Some(poses)
}

/// Lengths of this file in centimetres of a body.
fn scale(body: &Body) -> f64 {
    let rest = body.skeleton.offset_pose();
    let leg = body.legs.first();
    leg.map_or(1.0, |leg| {
        (rest[leg.joints[0]].position.y - leg.ankle.y) / LEG
    })
}

/// How the trunk is turned: hips, chest and head in the world.
#[derive(Debug, Clone, Copy)]
struct Trunk {
    hips: DQuat,
    chest: DQuat,
    head: DQuat,
}

/// The body with its trunk turned, arms hanging.
fn standing(body: &Body, trunk: Trunk) -> Pose {
    let mut pose = Pose::rest(body);
    pose.turn_world(JointId::default(), trunk.hips);
    if let [spine, chest] = body.anatomy.spine[..] {
        pose.turn_world(spine, math::slerp(trunk.hips, trunk.chest, 0.5));
        pose.turn_world(chest, trunk.chest);
    }
    if let (Some(&neck), Some(head)) = (body.anatomy.neck.first(), body.anatomy.head) {
        pose.turn_world(neck, math::slerp(trunk.chest, trunk.head, 0.5));
        pose.turn_world(head, trunk.head);
    }
    for arm in &body.arms {
        hang(&mut pose, arm, 0.0, 0.0);
    }
    pose
}

/// An arm that hangs, `forward` degrees before the body, with `more` degrees more of a bend in the elbow.
fn hang(pose: &mut Pose, arm: &Arm, forward: f64, more: f64) {
    let [_, upper, lower, _] = arm.joints;
    let [spread, elbow] = HANGING;
    pose.turn_inner(upper, tip(-forward) * lean(sign(arm.side) * spread));
    pose.turn_inner(lower, tip(-elbow - more));
}

/// A foot that stands on its ball, its heel so many degrees up.
fn on_ball(leg: &Leg, heel_up: f64) -> Foot {
    let ball = leg.sole[1];
    let rotation = tip(heel_up);
    Foot {
        ankle: leg.ankle + ball - rotation * ball,
        rotation,
        toes: DQuat::IDENTITY,
    }
}

/// Breathes twice, shifts its weight, and looks aside.
fn idle(body: &Body, frame: f64) -> Pose {
    let breath = (1.0 - math::cos(frame / 36.0 * TAU)) / 2.0;
    let shift = math::sin(frame / 72.0 * TAU);
    let look = keyed(
        &[
            (10.0, 0.0),
            (20.0, 14.0),
            (34.0, 14.0),
            (46.0, -6.0),
            (60.0, 0.0),
        ],
        frame,
    );
    let k = scale(body);
    let mut pose = standing(
        body,
        Trunk {
            hips: lean(1.2 * shift),
            chest: lean(-0.8 * shift) * tip(-1.6 * breath),
            head: turn(look) * tip(1.5 - 1.5 * breath),
        },
    );
    pose.hips += DVec3::new(2.2 * shift, 0.7 * breath, 0.0) * k;
    for arm in &body.arms {
        hang(&mut pose, arm, -1.5 * breath, 3.0 * breath);
    }
    for (index, joint) in body.anatomy.tail.iter().enumerate() {
        let late = 0.5 * index as f64;
        pose.turn_inner(*joint, turn(8.0 * math::sin(frame / 36.0 * TAU - late)));
    }
    pose
}

/// Raises the right hand, or the right fore leg, and waves it three times.
fn wave(body: &Body, frame: f64) -> Pose {
    let raised = keyed(&[(3.0, 0.0), (15.0, 1.0), (44.0, 1.0), (57.0, 0.0)], frame);
    let waving = ease((frame - 11.0) / 5.0) * ease((47.0 - frame) / 5.0);
    let to_and_fro = waving * math::sin((frame - 13.0) / 10.0 * TAU);
    let k = scale(body);
    let mut pose = standing(
        body,
        Trunk {
            hips: lean(1.5 * raised),
            chest: lean(-3.0 * raised - 0.8 * to_and_fro) * turn(-5.0 * raised),
            head: lean(-6.0 * raised) * tip(-3.0 * raised),
        },
    );
    pose.hips.x += 3.0 * raised * k;
    if let Some(arm) = body.arms.iter().find(|arm| arm.side == Side::Right) {
        let [_, upper, lower, hand] = arm.joints;
        let [spread, elbow] = HANGING;
        let out = spread + raised * (98.0 - spread) + 5.0 * to_and_fro;
        pose.turn_inner(upper, tip(-12.0 * raised) * lean(-out));
        let up = lean(-raised * 72.0 - 26.0 * to_and_fro);
        pose.turn_inner(lower, up * tip(-elbow * (1.0 - raised)));
        pose.turn_inner(hand, lean(-16.0 * to_and_fro));
        return pose;
    }
    let legs = body.legs.iter().zip(&mut pose.feet);
    let fore = legs.filter(|(leg, _)| leg.side == Side::Right);
    if let Some((leg, foot)) = fore.max_by_key(|(leg, _)| leg.pair) {
        let length = leg.length();
        let up = DVec3::new(-0.04, 0.62, 0.5) * length * raised;
        let aside = DVec3::new(-0.16, 0.05, 0.0) * length * to_and_fro;
        *foot = Some(Foot {
            ankle: leg.ankle + up + aside,
            rotation: tip(-40.0 * raised),
            toes: DQuat::IDENTITY,
        });
    }
    pose
}

/// Four beats of half a second: a bounce on each, the weight from side to side, the arms up for the second half.
fn dance(body: &Body, frame: f64) -> Pose {
    let beat = math::cos(frame / 12.0 * TAU);
    let side = math::sin(frame / 24.0 * TAU);
    let late = math::sin((frame - 2.0) / 24.0 * TAU);
    let high = keyed(&[(20.0, 0.0), (27.0, 1.0), (43.0, 1.0), (48.0, 0.0)], frame);
    let k = scale(body);
    let mut pose = standing(
        body,
        Trunk {
            hips: turn(-10.0 * side) * lean(-7.0 * side),
            chest: turn(12.0 * late) * lean(5.0 * late) * tip(3.0 + 2.0 * beat),
            head: lean(-7.0 * late) * tip(4.0 * beat),
        },
    );
    pose.hips += DVec3::new(8.0 * side, -2.6 * (1.0 + beat) - 2.0, 0.0) * k;
    for arm in &body.arms {
        let x = sign(arm.side);
        let [_, upper, lower, hand] = arm.joints;
        let pump = x * late;
        let forward = 22.0 + 26.0 * pump + high * (14.0 - 10.0 * pump);
        let out = 16.0 + high * (104.0 + 14.0 * beat);
        pose.turn_inner(upper, tip(-forward) * lean(x * out));
        let elbow = 85.0 - 18.0 * pump - 30.0 * high;
        pose.turn_inner(lower, tip(-elbow * (1.0 - high)) * lean(x * 50.0 * high));
        pose.turn_inner(hand, lean(x * 10.0 * high * beat));
    }
    // The heel of the leg without weight comes up.
    let is_biped = body.legs.len() == 2;
    for (leg, foot) in body.legs.iter().zip(&mut pose.feet) {
        let free = (-leg.sign() * side).max(0.0);
        *foot = Some(if is_biped {
            on_ball(leg, 34.0 * ease(free))
        } else {
            // On more legs every second one marches on the spot.
            let turn = leg.sign() * if leg.pair % 2 == 0 { 1.0 } else { -1.0 };
            let free = (-turn * side).max(0.0);
            Foot::flat(leg.ankle + DVec3::Y * 0.2 * leg.length() * ease(free))
        });
    }
    for joint in &body.anatomy.tail {
        pose.turn_inner(*joint, turn(14.0 * late));
    }
    pose
}

/// Guard, a jab with the left hand, a punch with the right one and all of the body behind it, and back.
fn punch(body: &Body, frame: f64) -> Pose {
    let guard = keyed(&[(0.0, 0.0), (8.0, 1.0), (38.0, 1.0), (48.0, 0.0)], frame);
    let jab = keyed(&[(10.0, 0.0), (13.0, 1.0), (15.0, 1.0), (20.0, 0.0)], frame);
    let wind = keyed(&[(17.0, 0.0), (23.0, 1.0), (26.0, 0.0)], frame);
    let cross = keyed(&[(23.0, 0.0), (26.0, 1.0), (29.0, 1.0), (37.0, 0.0)], frame);
    // The right shoulder is back in the guard, and comes forward with the punch.
    let yaw = -18.0 * guard - 10.0 * jab - 12.0 * wind + 58.0 * cross;
    // A trunk that lies on its legs turns less.
    let yaw = if body.arms.is_empty() {
        0.25 * yaw
    } else {
        yaw
    };
    let k = scale(body);
    let mut pose = standing(
        body,
        Trunk {
            hips: turn(yaw * 0.55),
            chest: turn(yaw) * tip(8.0 * guard + 6.0 * cross),
            head: tip(4.0 * guard),
        },
    );
    let forward = 3.0 * guard + 4.0 * jab - 3.0 * wind + 9.0 * cross;
    pose.hips += DVec3::new(0.0, -5.0 * guard - 2.0 * wind - 2.0 * cross, forward) * k;
    for arm in &body.arms {
        let x = sign(arm.side);
        let out = if x > 0.0 { jab } else { cross };
        let [_, upper, lower, _] = arm.joints;
        let [spread, bend] = HANGING;
        let raise = guard * (42.0 + 60.0 * out);
        let elbow = bend + guard * (112.0 - (112.0 + bend - 4.0) * out);
        // The fist flies straight ahead, wherever the chest has turned.
        let ahead = turn(-yaw * out);
        pose.turn_inner(upper, ahead * tip(-raise) * lean(x * spread));
        pose.turn_inner(lower, tip(-elbow));
    }
    if body.arms.is_empty() {
        strike(body, &mut pose, [jab, cross]);
        return pose;
    }
    for (leg, foot) in body.legs.iter().zip(&mut pose.feet) {
        let is_left = leg.side == Side::Left;
        let stagger = DVec3::new(3.0 * leg.sign(), 0.0, if is_left { 16.0 } else { -16.0 });
        let heel = if is_left {
            0.0
        } else {
            8.0 * guard + 26.0 * cross
        };
        let mut planted = on_ball(leg, heel);
        planted.ankle += stagger * k;
        *foot = Some(planted);
    }
    pose
}

/// Without arms the fore legs punch, the left one first.
fn strike(body: &Body, pose: &mut Pose, punches: [f64; 2]) {
    let front = body.legs.iter().map(|leg| leg.pair).max();
    for (leg, foot) in body.legs.iter().zip(&mut pose.feet) {
        if Some(leg.pair) != front {
            continue;
        }
        let out = punches[if leg.side == Side::Left { 0 } else { 1 }];
        let reach = DVec3::new(-0.05 * leg.sign(), 0.55, 0.75) * leg.length();
        *foot = Some(Foot {
            ankle: leg.ankle + reach * out,
            rotation: tip(-50.0 * out),
            toes: DQuat::IDENTITY,
        });
    }
}

/// Crouches, flies for eleven frames on the parabola of a thrown body, lands and recovers.
fn jump(body: &Body, frame: f64) -> Pose {
    /// Frames: deepest crouch, off the ground, back on it, deepest again, standing.
    const KEYS: [f64; 5] = [10.0, 14.0, 25.0, 30.0, 40.0];
    /// Heights of the hips, centimetres: crouched, off the ground, absorbing.
    const HEIGHTS: [f64; 3] = [-28.0, 5.0, -20.0];
    /// Gravity, centimetres per frame and frame.
    const GRAVITY: f64 = 981.0 / (24.0 * 24.0);

    let [crouch, off, on, deep, stand] = KEYS;
    let [low, stretched, absorbed] = HEIGHTS;
    let is_biped = body.legs.len() == 2;
    // Without heels to stand up on, legs are straight when the body is as high as at rest.
    let high = if is_biped { stretched } else { 0.0 };
    let speed = GRAVITY * (on - off) / 2.0;
    let since = frame - off;
    let flight = if (off..on).contains(&frame) {
        speed * since - GRAVITY * since * since / 2.0
    } else {
        0.0
    };
    let height = match frame {
        at if at < crouch => low * ease(at / crouch),
        at if at < off => hermite(
            low,
            high,
            [0.0, speed * (off - crouch)],
            (at - crouch) / (off - crouch),
        ),
        at if at < on => high + flight,
        at if at < deep => hermite(
            high,
            absorbed,
            [-speed * (deep - on), 0.0],
            (at - on) / (deep - on),
        ),
        at => absorbed * (1.0 - ease((at - deep) / (stand - deep))),
    };
    let k = scale(body);
    let bow = keyed(
        &[
            (0.0, 0.0),
            (crouch, 32.0),
            (off, -4.0),
            (on, 4.0),
            (deep, 24.0),
            (stand, 0.0),
        ],
        frame,
    );
    // On more legs the front goes up first, and comes down first.
    let nose = keyed(
        &[
            (0.0, 0.0),
            (crouch, 4.0),
            (off, 0.0),
            (off + 4.0, -12.0),
            (on, 3.0),
            (deep, 2.0),
            (stand, 0.0),
        ],
        frame,
    );
    let pitch = if is_biped { bow } else { nose };
    let mut pose = standing(
        body,
        Trunk {
            hips: tip(pitch * if is_biped { 0.6 } else { 1.0 }),
            chest: tip(pitch),
            head: tip(pitch * 0.3),
        },
    );
    let back = if is_biped { -0.25 * bow } else { 0.0 };
    pose.hips += DVec3::new(0.0, height, back) * k;
    let arms = keyed(
        &[
            (0.0, 0.0),
            (crouch - 1.0, -48.0),
            (off, 150.0),
            (on - 3.0, 110.0),
            (deep, 20.0),
            (stand, 0.0),
        ],
        frame,
    );
    for arm in &body.arms {
        hang(&mut pose, arm, arms, 10.0 - arms.abs() * 0.05);
    }
    let heel = keyed(
        &[
            (crouch + 1.0, 0.0),
            (off, 42.0),
            (on - 4.0, 34.0),
            (on, 34.0),
            (on + 2.0, 0.0),
        ],
        frame,
    );
    let tuck = 9.0 * bump(since / (on - off), 0.45);
    for (leg, foot) in body.legs.iter().zip(&mut pose.feet) {
        let mut placed = on_ball(leg, heel);
        placed.ankle.y += (flight + tuck) * k;
        if !is_biped {
            // In the air the feet keep their place below the trunk.
            let aloft = ease(since / 3.0) * ease((on - frame) / 3.0);
            let ahead = leg.ankle.z - pose.hips.z;
            placed.ankle.y -= aloft * ahead * math::sin(pitch.to_radians());
        }
        if flight > 0.0 {
            placed.toes = tip(heel * 0.6 * ease(since / 2.0) * ease((on - frame) / 2.0));
        }
        *foot = Some(placed);
    }
    pose
}
