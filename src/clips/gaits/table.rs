//! The gaits in numbers.
//!
//! The order of the feet is that of real animals. On two and four legs a walker always has a foot on the ground, so its duty factor is
//! above one half; runs, trots and gallops have a time in the air. Insects always stand on three legs or more.

use super::{Arms, Gait, Trunk};
use crate::clips::pose::MAX_REACH;
use crate::clips::steps::Steps;
use crate::clips::{BuiltIn, Legs};

impl Gait {
    /// The gait of a clip; `None` for clips that stay on the spot.
    pub(in crate::clips) fn of(clip: BuiltIn, legs: Legs) -> Option<Self> {
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
}

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
        ahead: -6.0,
    },
    touches: ALTERNATING,
    // A straighter leg than elsewhere: who walks does not crouch.
    reach: 0.998,
    trunk: Trunk {
        bob: 1.2,
        lowest: 0.0,
        sway: 2.5,
        hip_turn: 7.0,
        hip_drop: 3.0,
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
        duty: 0.38,
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
