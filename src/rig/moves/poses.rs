//! How the parts of a figure turn in the clips that move them, and how its root goes. Times are shares of a cycle, angles degrees,
//! lengths drawing units in the drawing's axes: x to the right, y up, z towards the viewer.

use std::f64::consts::TAU;

use glam::{DMat3, DQuat, DVec2, DVec3};

use super::roles::{Role, Roles};
use crate::clips::BuiltIn;
use crate::labels::FigurePartId;
use crate::math;
use crate::smoothing::ease;

/// A wheel takes so many frames to turn once.
const FRAMES_A_TURN: usize = 20;
/// A cycle has at most so many turns of the largest wheel.
const MAX_TURNS: usize = 6;
/// A wheel whose turns in a cycle are off a whole number by less than this shows no seam.
const WHOLE: f64 = 0.02;
/// The share of a hop for which the body is on the ground.
const STANDING: f64 = 0.3;

/// How many frames a cycle takes, and how far the figure goes in it.
pub(super) fn cycle(which: BuiltIn, roles: &Roles) -> (usize, f64) {
    match which {
        BuiltIn::Drive => {
            let (turns, radius) = turns(roles);
            (turns * FRAMES_A_TURN, turns as f64 * TAU * radius)
        }
        BuiltIn::Fly => (32, 1.5 * roles.length()),
        BuiltIn::Swim => (24, 0.6 * roles.length()),
        BuiltIn::Hop => (20, 0.5 * roles.height()),
        BuiltIn::Float => (48, 0.0),
        _ => (72, 0.0),
    }
}

/// How often the largest wheel turns in a cycle, and its radius: as seldom as possible, but so that the others end as they begin.
fn turns(roles: &Roles) -> (usize, f64) {
    let radii = roles.radii();
    let Some(&largest) = radii.first() else {
        return (2, 0.25 * roles.height());
    };
    let seam = |turns: usize| {
        let off = radii.iter().map(|radius| {
            let own = turns as f64 * largest / radius;
            (own - own.round()).abs()
        });
        off.fold(0.0, f64::max)
    };
    let good = (1..=MAX_TURNS).find(|turns| seam(*turns) < WHOLE);
    let best = (1..=MAX_TURNS).min_by(|a, b| seam(*a).total_cmp(&seam(*b)));
    (good.or(best).unwrap_or(1), largest)
}

/// Whether a part of this role has a motion of its own in a clip.
pub(super) fn moves(which: BuiltIn, role: Role) -> bool {
    match which {
        BuiltIn::Drive => role == Role::Wheel,
        BuiltIn::Fly => matches!(role, Role::Wing | Role::Tail | Role::Leg),
        BuiltIn::Swim => matches!(role, Role::Fin | Role::Tail | Role::Wing),
        BuiltIn::Float => matches!(role, Role::Tentacle | Role::Tail | Role::Fin),
        BuiltIn::Sway => role != Role::Wheel && role != Role::Leg,
        _ => false,
    }
}

/// Whether the figure is on the ground.
pub(super) fn is_grounded(which: BuiltIn, time: f64) -> bool {
    match which {
        BuiltIn::Drive | BuiltIn::Sway => true,
        BuiltIn::Hop => time <= STANDING,
        _ => false,
    }
}

/// Where the root is, from where it would be if it went evenly and as far as `travel` in a cycle.
pub(super) fn offset(which: BuiltIn, roles: &Roles, travel: f64, time: f64) -> DVec3 {
    let height = roles.height();
    let (up, ahead) = match which {
        BuiltIn::Drive => {
            let bounces = 2.0 * turns(roles).0 as f64;
            (
                0.003 * height * (1.0 - math::cos(bounces * time * TAU)),
                0.0,
            )
        }
        // The body rises while the wings go down.
        BuiltIn::Fly => (-0.04 * height * beat(time), 0.0),
        BuiltIn::Swim => (0.02 * height * math::sin(time * TAU), 0.0),
        BuiltIn::Hop => {
            let air = ((time - STANDING) / (1.0 - STANDING)).clamp(0.0, 1.0);
            (
                0.35 * height * 4.0 * air * (1.0 - air),
                travel * (air - time),
            )
        }
        BuiltIn::Float => (0.05 * height * math::sin(time * TAU), 0.0),
        _ => (0.0, 0.0),
    };
    DVec3::Y * up + roles.forward * ahead
}

/// The wings: 1 up, −1 down, two beats a cycle.
fn beat(time: f64) -> f64 {
    math::cos(2.0 * time * TAU)
}

/// The point about which the root turns.
pub(super) fn pivot(which: BuiltIn, roles: &Roles) -> DVec2 {
    match which {
        BuiltIn::Hop | BuiltIn::Sway | BuiltIn::Drive => DVec2::new(roles.middle().x, roles.low.y),
        _ => roles.middle(),
    }
}

/// How the root turns.
pub(super) fn body(which: BuiltIn, roles: &Roles, time: f64) -> DQuat {
    let wave = math::sin(time * TAU);
    match which {
        BuiltIn::Fly => pitch(roles, 3.0 * math::sin(2.0 * time * TAU)),
        BuiltIn::Swim => yaw(-swing_of_body(roles) * wave),
        // It leans back before it leaves the ground, forward as it lands.
        BuiltIn::Hop => {
            let air = ((time - STANDING) / (1.0 - STANDING)).clamp(0.0, 1.0);
            let ground = (time / STANDING).clamp(0.0, 1.0);
            let lean = if time < STANDING {
                10.0 - 20.0 * ease(ground)
            } else {
                -10.0 + 20.0 * ease(air)
            };
            pitch(roles, lean)
        }
        BuiltIn::Float => roll(2.5 * math::cos(time * TAU)),
        BuiltIn::Sway if roles.is_potted => DQuat::IDENTITY,
        BuiltIn::Sway => {
            roll(2.5 * wave) * math::rotation_x((1.0 * math::cos(time * TAU)).to_radians())
        }
        _ => DQuat::IDENTITY,
    }
}

/// A fish without a tail swings as a whole.
fn swing_of_body(roles: &Roles) -> f64 {
    let mut parts = roles.parts.iter();
    if parts.any(|part| part.role == Some(Role::Tail)) {
        5.0
    } else {
        12.0
    }
}

/// Which piece of a part turns: a part that bends moves as a wave that runs from its joint to its far end.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Piece {
    /// The share of the part's turn that it makes.
    pub(super) size: f64,
    /// How far along the part it begins, as a share of the part's length.
    pub(super) along: f64,
}

impl Piece {
    /// The share of the turn of a part that bends which is made at its joint: the rest is made along it …
    const AT_JOINT: f64 = 0.5;
    /// … and more, as pieces that turn one after the other never turn to one side together.
    const ALONG: f64 = 1.2;

    /// A part without pieces.
    pub(super) const WHOLE: Self = Self {
        size: 1.0,
        along: 0.0,
    };
    /// The first piece of a part that bends.
    pub(super) const FIRST: Self = Self {
        size: Self::AT_JOINT,
        along: 0.0,
    };

    /// A further piece, which makes a share of the turn of one of several joints.
    pub(super) fn inside(share: f64, joint: usize, joints: usize) -> Self {
        Self {
            size: Self::ALONG * share / joints as f64,
            along: (joint + 1) as f64 / (joints + 1) as f64,
        }
    }

    /// How much later it moves than the part's joint, if parts that hang on each other are late by one.
    fn late(self) -> f64 {
        const LATE: f64 = 2.5;
        LATE * self.along
    }
}

/// How a piece of a part of this role turns about its joint, in the drawing's axes as what it hangs on carries it.
pub(super) fn turn(
    which: BuiltIn,
    role: Role,
    roles: &Roles,
    part: FigurePartId,
    time: f64,
    piece: Piece,
) -> DQuat {
    let actor = &roles.parts[part];
    let depth = actor.depth as f64 + piece.late();
    let size = piece.size;
    match (which, role) {
        (BuiltIn::Drive, _) => {
            let (turns, largest) = turns(roles);
            // The distance over the radius, radians.
            let angle = turns as f64 * TAU * largest * time / actor.radius.max(f64::MIN_POSITIVE);
            math::rotation_around(left(roles), angle)
        }
        (BuiltIn::Fly, Role::Wing) => flap(roles, part, time, piece),
        (BuiltIn::Fly, Role::Leg) if actor.depth == 0 => pitch(roles, 35.0 * size),
        (BuiltIn::Fly, Role::Tail) => {
            let late = 0.06 * piece.late();
            pitch(roles, 6.0 * size * math::sin(2.0 * (time - late) * TAU))
        }
        (BuiltIn::Swim, Role::Tail) => {
            let angle = 24.0 / (1.0 + 0.5 * actor.depth as f64);
            yaw(size * angle * math::sin((time - 0.15 - 0.12 * depth) * TAU))
        }
        (BuiltIn::Swim, Role::Fin | Role::Wing) => {
            let angle = 14.0 * size * actor.side * math::sin((time - 0.1 * depth) * TAU);
            math::rotation_around(roles.forward, angle.to_radians())
        }
        (BuiltIn::Float, _) => {
            let outward = 1.0_f64.copysign(actor.span.x);
            let late = 0.14 * depth;
            // All of them spread and close together, and each waves a little for itself.
            let pulse = 9.0 * math::sin((time + 0.25 - late) * TAU) * outward;
            let wave = 8.0 * math::sin((time - late - actor.lag) * TAU);
            let out = 7.0 * math::cos((time - late - 2.0 * actor.lag) * TAU);
            roll(size * (pulse + wave)) * math::rotation_x((size * out).to_radians())
        }
        (BuiltIn::Sway, _) => {
            let late = 0.08 * (depth + 1.0) + 0.25 * actor.lag;
            let angle =
                5.0 * math::sin((time - late) * TAU) + 1.5 * math::sin((2.0 * time - late) * TAU);
            let out = 4.0 * math::cos((time - late) * TAU);
            roll(size * angle) * math::rotation_x((size * out).to_radians())
        }
        _ => DQuat::IDENTITY,
    }
}

/// The role in which the bones of the root move: what it carries moves on its own.
pub(super) fn role_of_root(which: BuiltIn) -> Role {
    match which {
        BuiltIn::Swim | BuiltIn::Fly => Role::Tail,
        BuiltIn::Float => Role::Tentacle,
        BuiltIn::Sway => Role::Twig,
        _ => Role::Body,
    }
}

/// A wing in a beat. In profile it is first spread sideways, however it is drawn: folded, hanging or raised.
fn flap(roles: &Roles, part: FigurePartId, time: f64, piece: Piece) -> DQuat {
    let actor = &roles.parts[part];
    let is_first = actor.depth == 0 && piece.along == 0.0;
    let late = 0.08 * actor.depth as f64 + 0.04 * piece.late();
    let angle = match is_first {
        // The whole wing beats, whether it bends or not.
        true => 6.0 + 34.0 * beat(time),
        false => 16.0 * piece.size * beat(time - late),
    };
    // forward × left = up, so what points to the left rises.
    let raise = math::rotation_around(roles.forward, (angle * actor.side).to_radians());
    if !is_first || !roles.facing.facing.is_profile() {
        return raise;
    }
    raise * spread(roles, actor.span, actor.side)
}

/// The rotation that lays a wing, drawn from the side, out to its side with its front edge ahead.
fn spread(roles: &Roles, span: DVec2, side: f64) -> DQuat {
    let along = span.extend(0.0).normalize_or(DVec3::Y);
    let out = left(roles) * side;
    let front = roles.forward;
    let across = DVec3::Z.cross(along);
    // The edge that is drawn in front or above leads.
    let leads = across * 1.0_f64.copysign(across.dot(front + DVec3::Y));
    let drawn = DMat3::from_cols(along, leads, along.cross(leads));
    let laid = DMat3::from_cols(out, front, out.cross(front));
    DQuat::from_mat3(&(laid * drawn.transpose())).normalize()
}

/// The direction to the figure's left.
fn left(roles: &Roles) -> DVec3 {
    DVec3::Y.cross(roles.forward)
}

/// Tips what points up to the front.
fn pitch(roles: &Roles, degrees: f64) -> DQuat {
    math::rotation_around(left(roles), degrees.to_radians())
}

/// Turns about the vertical.
fn yaw(degrees: f64) -> DQuat {
    math::rotation_y(degrees.to_radians())
}

/// Turns in the drawing plane.
fn roll(degrees: f64) -> DQuat {
    math::rotation_z(degrees.to_radians())
}
