//! Walking and running: cycles of steps, with the body's own motion about them.
//!
//! What the trunk does follows from the legs, as animators describe it: it is lowest just after a foot has touched the ground (walks)
//! or while one carries it (runs, trots) and highest in between; the hips turn with the leg that swings forward and drop on its side;
//! the chest and the arms turn against the hips; the head stays level and looks ahead.

use glam::DVec3;

use super::BuiltIn;
use super::Legs;
use super::body::{Body, Leg, sign};
use super::curves::wave;
use super::pose::{MAX_REACH, Pose, lean, tip, turn};
use super::steps::Steps;

/// A gait. Times are turns of its cycle, lengths centimetres, angles degrees.
#[derive(Debug, Clone, Copy)]
pub(super) struct Gait {
    /// Frames of a cycle.
    pub(super) frames: usize,
    pub(super) steps: Steps,
    /// When the feet touch the ground: per pair the left and the right one.
    touches: [[f64; 2]; 3],
    /// How far the leg that stretches most may do so, as a share of its length.
    reach: f64,
    trunk: Trunk,
    arms: Arms,
}

/// How the trunk moves.
#[derive(Debug, Clone, Copy)]
struct Trunk {
    /// How far it rises and falls, how often in a cycle, and when it is lowest.
    bob: f64,
    bobs: f64,
    lowest: f64,
    /// How far the hips shift over the leg that stands.
    sway: f64,
    /// How far the hips turn towards the leg that swings forward, and drop on its side.
    hip_turn: f64,
    hip_drop: f64,
    /// How far the chest turns the other way.
    chest_turn: f64,
    /// How far the trunk leans forward.
    lean: f64,
    /// How far it pitches, front down, and when; how far the back is arched, and when.
    pitch: [f64; 2],
    arch: [f64; 2],
    /// How far the head is lowered, and how far it nods at every bob.
    head: f64,
    nod: f64,
}

/// How arms swing. Angles are forward of hanging down.
#[derive(Debug, Clone, Copy)]
struct Arms {
    swing: f64,
    mean: f64,
    spread: f64,
    elbow: f64,
    elbow_swing: f64,
}

/// The time of the first frame. Hips and shoulders are square to the way then, so that a figure, whose front is found by them in the
/// first frame, goes straight ahead.
pub(super) const START: f64 = 0.25;

/// How far behind the upper arm the forearm is.
const ELBOW_LAG: f64 = 0.06;

const NO_TRUNK: Trunk = Trunk {
    bob: 0.0,
    bobs: 2.0,
    lowest: 0.0,
    sway: 0.0,
    hip_turn: 0.0,
    hip_drop: 0.0,
    chest_turn: 0.0,
    lean: 0.0,
    pitch: [0.0, 0.0],
    arch: [0.0, 0.0],
    head: 0.0,
    nod: 0.0,
};

const NO_ARMS: Arms = Arms {
    swing: 0.0,
    mean: 0.0,
    spread: 0.0,
    elbow: 0.0,
    elbow_swing: 0.0,
};

const ALTERNATING: [[f64; 2]; 3] = [[0.0, 0.5]; 3];
/// Each hind foot is followed by the fore foot of its side, a quarter of a cycle later.
const LATERAL_SEQUENCE: [[f64; 2]; 3] = [[0.0, 0.5], [0.25, 0.75], [0.5, 0.0]];
/// A hind foot and the fore foot of the other side.
const DIAGONALS: [[f64; 2]; 3] = [[0.0, 0.5], [0.5, 0.0], [0.0, 0.5]];
/// The hind feet one soon after the other, then the fore feet, then none.
const GALLOP: [[f64; 2]; 3] = [[0.0, 0.1], [0.44, 0.55], [0.0, 0.0]];
/// One foot after the other, from the hind end on.
const METACHRONAL: [[f64; 2]; 3] = [[0.0, 0.5], [1.0 / 3.0, 5.0 / 6.0], [2.0 / 3.0, 1.0 / 6.0]];

impl Gait {
    /// The gait of a clip; `None` for clips that stay on the spot.
    pub(super) fn of(clip: BuiltIn, legs: Legs) -> Option<Self> {
        Some(match (clip, legs) {
            (BuiltIn::Walk, Legs::Two) => WALK,
            (BuiltIn::Run, Legs::Two) => RUN,
            (BuiltIn::Trot, Legs::Two) => JOG,
            (BuiltIn::Sneak, Legs::Two) => SNEAK,
            (BuiltIn::Walk, Legs::Four) => WALK_ON_FOUR,
            (BuiltIn::Trot, Legs::Four) => TROT_ON_FOUR,
            (BuiltIn::Run, Legs::Four) => GALLOP_ON_FOUR,
            (BuiltIn::Sneak, Legs::Four) => SNEAK_ON_FOUR,
            (BuiltIn::Walk, Legs::Six) => WALK_ON_SIX,
            (BuiltIn::Trot, Legs::Six) => TROT_ON_SIX,
            (BuiltIn::Run, Legs::Six) => RUN_ON_SIX,
            (BuiltIn::Sneak, Legs::Six) => SNEAK_ON_SIX,
            _ => return None,
        })
    }

    /// When a leg touches the ground, and for how much of the cycle it stays there.
    pub(super) fn contact(&self, leg: &Leg) -> (f64, f64) {
        let side = if leg.sign() > 0.0 { 0 } else { 1 };
        (self.touches[leg.pair][side], self.steps.duty)
    }

    /// The poses of a cycle; the last one is the first one again, one stride ahead.
    pub(super) fn poses(&self, body: &Body) -> Vec<Pose> {
        let times = (0..=self.frames).map(|frame| START + frame as f64 / self.frames as f64);
        let mut poses: Vec<Pose> = times.map(|time| self.pose(body, time)).collect();
        lower(body, &mut poses, self.reach);
        poses
    }

    fn pose(&self, body: &Body, time: f64) -> Pose {
        let trunk = &self.trunk;
        let mut pose = Pose::rest(body);
        let left = self.touches[0][0] + self.steps.duty / 2.0;
        let up = -trunk.bob * wave(trunk.bobs * time, trunk.bobs * trunk.lowest);
        let sway = trunk.sway * wave(time, left);
        pose.hips += DVec3::new(sway, up, self.steps.stride * time);
        // A body on more legs has hips and chest above legs of their own, and each turns with its own pair.
        let chest_pair = body.legs.iter().map(|leg| leg.pair).max().unwrap_or(0);
        let chest_left = match chest_pair {
            0 => None,
            pair => Some(self.touches[pair][0] + self.steps.duty / 2.0),
        };
        let forward = wave(time, self.touches[0][0]);
        let drop = trunk.hip_drop * wave(time, left);
        let chest_drop = match chest_left {
            None => -0.6 * drop,
            Some(left) => trunk.hip_drop * wave(time, left),
        };
        let pitch = trunk.lean + trunk.pitch[0] * wave(time, trunk.pitch[1]);
        let arch = trunk.arch[0] * wave(time, trunk.arch[1]);
        let hips = turn(-trunk.hip_turn * forward) * lean(drop) * tip(pitch * 0.5 - arch);
        let chest = turn(trunk.chest_turn * forward) * lean(chest_drop) * tip(pitch + arch);
        pose.turn_world(0, hips);
        let joints = &body.anatomy;
        if let [spine, chest_joint] = joints.spine[..] {
            pose.turn_world(spine, hips.slerp(chest, 0.5));
            pose.turn_world(chest_joint, chest);
        }
        let nod = trunk.nod * wave(trunk.bobs * time, trunk.bobs * (trunk.lowest + 0.08));
        let head = tip(trunk.head + nod);
        if let (Some(&neck), Some(head_joint)) = (joints.neck.first(), joints.head) {
            pose.turn_world(neck, chest.slerp(head, 0.6));
            pose.turn_world(head_joint, head);
        }
        for (index, joint) in joints.tail.iter().enumerate() {
            let late = 0.1 + 0.12 * index as f64;
            let wag = turn(9.0 * wave(time, late)) * tip(-3.0 * wave(trunk.bobs * time, late));
            pose.turn_inner(*joint, wag);
        }
        for arm in &body.arms {
            let x = sign(arm.side);
            // The right arm swings forward with the left leg.
            let ahead = if x > 0.0 { 0.5 } else { 0.0 };
            let [_, upper, lower, hand] = arm.joints;
            let swing = self.arms.mean + self.arms.swing * wave(time, ahead);
            let elbow = self.arms.elbow + self.arms.elbow_swing * wave(time, ahead + ELBOW_LAG);
            pose.turn_inner(upper, tip(-swing) * lean(x * self.arms.spread));
            pose.turn_inner(lower, tip(-elbow));
            pose.turn_inner(hand, tip(-8.0 - 6.0 * wave(time, ahead + 2.0 * ELBOW_LAG)));
        }
        for (leg, foot) in body.legs.iter().zip(&mut pose.feet) {
            *foot = Some(self.steps.foot(leg, self.contact(leg).0, time));
        }
        pose
    }
}

/// Lowers or raises the body, by the same in all poses, until the leg that stretches most does so by `reach` of its length.
pub(super) fn lower(body: &Body, poses: &mut [Pose], reach: f64) {
    /// Halvings of the range of heights, to far less than a millimetre.
    const HALVINGS: usize = 24;

    let shifted = |pose: &Pose, by: f64| {
        let mut pose = pose.clone();
        pose.hips.y += by;
        pose
    };
    let (mut low, mut high) = (-60.0, 20.0);
    for _ in 0..HALVINGS {
        let middle = (low + high) / 2.0;
        let fits = |pose: &Pose| shifted(pose, middle).reach(body) <= reach;
        match poses.iter().all(fits) {
            true => low = middle,
            false => high = middle,
        }
    }
    for pose in poses {
        pose.hips.y += low;
    }
}

const WALK: Gait = Gait {
    frames: 24,
    steps: Steps {
        stride: 122.0,
        duty: 0.6,
        toes_up: 22.0,
        heel_up: 38.0,
        heel_off: 0.5,
        lift: 9.0,
        highest: 0.3,
        track: 0.6,
        ahead: -7.0,
    },
    touches: ALTERNATING,
    reach: MAX_REACH,
    trunk: Trunk {
        bob: 2.4,
        lowest: 0.05,
        sway: 2.5,
        hip_turn: 7.0,
        hip_drop: 4.0,
        chest_turn: 9.0,
        lean: 4.0,
        nod: 1.5,
        ..NO_TRUNK
    },
    arms: Arms {
        swing: 24.0,
        mean: 2.0,
        spread: 7.0,
        elbow: 17.0,
        elbow_swing: 9.0,
    },
};

const RUN: Gait = Gait {
    frames: 16,
    steps: Steps {
        stride: 210.0,
        duty: 0.33,
        toes_up: 8.0,
        heel_up: 48.0,
        heel_off: 0.35,
        lift: 31.0,
        highest: 0.4,
        track: 0.4,
        ahead: -9.0,
    },
    touches: ALTERNATING,
    reach: MAX_REACH,
    trunk: Trunk {
        bob: 4.5,
        lowest: 0.15,
        sway: 1.0,
        hip_turn: 9.0,
        hip_drop: 5.0,
        chest_turn: 14.0,
        lean: 13.0,
        head: 2.0,
        nod: 2.0,
        ..NO_TRUNK
    },
    arms: Arms {
        swing: 42.0,
        mean: 0.0,
        spread: 10.0,
        elbow: 82.0,
        elbow_swing: 14.0,
    },
};

const JOG: Gait = Gait {
    frames: 18,
    steps: Steps {
        stride: 150.0,
        duty: 0.42,
        toes_up: 10.0,
        heel_up: 42.0,
        heel_off: 0.4,
        lift: 22.0,
        highest: 0.38,
        ..RUN.steps
    },
    trunk: Trunk {
        bob: 4.0,
        lowest: 0.18,
        hip_turn: 7.0,
        chest_turn: 10.0,
        lean: 8.0,
        ..RUN.trunk
    },
    arms: Arms {
        swing: 28.0,
        elbow: 75.0,
        ..RUN.arms
    },
    ..RUN
};

const SNEAK: Gait = Gait {
    frames: 48,
    steps: Steps {
        stride: 96.0,
        duty: 0.6,
        toes_up: -14.0,
        heel_up: 34.0,
        heel_off: 0.55,
        lift: 24.0,
        highest: 0.45,
        track: 0.8,
        ahead: 4.0,
    },
    touches: ALTERNATING,
    reach: 0.9,
    trunk: Trunk {
        bob: 3.0,
        lowest: 0.05,
        sway: 4.0,
        hip_turn: 8.0,
        hip_drop: 3.0,
        chest_turn: 9.0,
        lean: 24.0,
        head: 6.0,
        nod: 3.0,
        ..NO_TRUNK
    },
    arms: Arms {
        swing: 20.0,
        mean: 34.0,
        spread: 10.0,
        elbow: 80.0,
        elbow_swing: 14.0,
    },
};

const WALK_ON_FOUR: Gait = Gait {
    frames: 24,
    steps: Steps {
        stride: 62.0,
        duty: 0.64,
        toes_up: 6.0,
        heel_up: 30.0,
        heel_off: 0.6,
        lift: 9.0,
        highest: 0.4,
        track: 0.8,
        ahead: 0.0,
    },
    touches: LATERAL_SEQUENCE,
    reach: MAX_REACH,
    trunk: Trunk {
        bob: 0.6,
        lowest: 0.05,
        sway: 1.2,
        hip_turn: 4.0,
        hip_drop: 3.0,
        chest_turn: 3.0,
        nod: 3.5,
        ..NO_TRUNK
    },
    arms: NO_ARMS,
};

const TROT_ON_FOUR: Gait = Gait {
    frames: 16,
    steps: Steps {
        stride: 92.0,
        duty: 0.46,
        heel_up: 35.0,
        lift: 13.0,
        ..WALK_ON_FOUR.steps
    },
    touches: DIAGONALS,
    trunk: Trunk {
        bob: 2.2,
        lowest: 0.22,
        hip_turn: 3.0,
        hip_drop: 2.0,
        nod: 2.0,
        ..NO_TRUNK
    },
    ..WALK_ON_FOUR
};

const GALLOP_ON_FOUR: Gait = Gait {
    frames: 12,
    steps: Steps {
        stride: 140.0,
        duty: 0.28,
        toes_up: 4.0,
        heel_up: 40.0,
        lift: 16.0,
        highest: 0.4,
        ..WALK_ON_FOUR.steps
    },
    touches: GALLOP,
    trunk: Trunk {
        bob: 2.5,
        bobs: 1.0,
        lowest: 0.42,
        pitch: [5.0, 0.62],
        arch: [5.0, 0.92],
        head: 4.0,
        nod: 5.0,
        ..NO_TRUNK
    },
    ..WALK_ON_FOUR
};

const SNEAK_ON_FOUR: Gait = Gait {
    frames: 40,
    steps: Steps {
        stride: 46.0,
        duty: 0.74,
        lift: 11.0,
        highest: 0.45,
        ..WALK_ON_FOUR.steps
    },
    reach: 0.84,
    trunk: Trunk {
        bob: 0.8,
        sway: 1.6,
        hip_turn: 5.0,
        hip_drop: 4.0,
        chest_turn: 5.0,
        head: 14.0,
        nod: 2.0,
        ..NO_TRUNK
    },
    ..WALK_ON_FOUR
};

const WALK_ON_SIX: Gait = Gait {
    frames: 16,
    steps: Steps {
        stride: 26.0,
        duty: 0.56,
        toes_up: 0.0,
        heel_up: 0.0,
        heel_off: 0.9,
        lift: 8.0,
        highest: 0.5,
        track: 1.0,
        ahead: 0.0,
    },
    touches: DIAGONALS,
    reach: 0.84,
    trunk: Trunk {
        bob: 0.5,
        lowest: 0.03,
        sway: 0.6,
        hip_turn: 2.5,
        hip_drop: 1.5,
        chest_turn: 2.5,
        nod: 2.0,
        ..NO_TRUNK
    },
    arms: NO_ARMS,
};

const TROT_ON_SIX: Gait = Gait {
    frames: 12,
    steps: Steps {
        stride: 29.0,
        duty: 0.52,
        ..WALK_ON_SIX.steps
    },
    ..WALK_ON_SIX
};

const RUN_ON_SIX: Gait = Gait {
    frames: 10,
    steps: Steps {
        stride: 34.0,
        duty: 0.5,
        lift: 9.0,
        ..WALK_ON_SIX.steps
    },
    trunk: Trunk {
        bob: 0.8,
        lowest: 0.25,
        hip_turn: 3.5,
        chest_turn: 3.5,
        head: -4.0,
        ..WALK_ON_SIX.trunk
    },
    ..WALK_ON_SIX
};

const SNEAK_ON_SIX: Gait = Gait {
    frames: 48,
    steps: Steps {
        stride: 20.0,
        duty: 0.78,
        lift: 9.0,
        ..WALK_ON_SIX.steps
    },
    touches: METACHRONAL,
    reach: 0.78,
    trunk: Trunk {
        bob: 0.4,
        sway: 0.8,
        head: 8.0,
        ..WALK_ON_SIX.trunk
    },
    ..WALK_ON_SIX
};
