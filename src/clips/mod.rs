//! Built-in clips: walks, runs and a few actions, made by rules, for two, four and six legs. Those that move the parts of a figure, such
//! as wheels, are in `rig`, because they need one.
//!
//! A gait is made as an animator blocks it: the feet first, planted on the ground and carried to the next step, then the hips over
//! them, then what follows from these: chest, arms and head. Legs reach their feet by inverse kinematics, and the body is as high as
//! the leg that stretches most allows. Every clip ends in the pose in which it begins, so all of them can be repeated.

mod actions;
mod body;
mod curves;
mod gaits;
mod parts;
mod pose;
mod steps;
#[cfg(test)]
mod tests;

use std::sync::Arc;

use crate::labels::Figure;
use crate::labels::{Anatomy, Class, label_figure};
use crate::mocap::Clip;
use crate::mocap::resample::FPS;
use body::Body;
use gaits::Gait;
pub(crate) use parts::still;

/// A built-in clip.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum BuiltIn {
    /// A walk.
    Walk,
    /// A run; a gallop on four legs.
    Run,
    /// A trot; a jog on two legs.
    Trot,
    /// A slow walk on bent legs.
    Sneak,
    /// One jump on the spot.
    Jump,
    /// Standing and breathing.
    Idle,
    /// A wave with the right hand, or with a fore leg.
    Wave,
    /// A dance on the spot.
    Dance,
    /// A jab and a punch.
    Punch,
    /// Rolling on wheels.
    Drive,
    /// Flying with wings.
    Fly,
    /// Swimming with fins and a tail.
    Swim,
    /// Hopping as one body.
    Hop,
    /// Floating with tentacles.
    Float,
    /// Swaying in the wind.
    Sway,
}

impl BuiltIn {
    /// All of them.
    pub const ALL: [Self; 15] = [
        Self::Walk,
        Self::Run,
        Self::Trot,
        Self::Sneak,
        Self::Jump,
        Self::Idle,
        Self::Wave,
        Self::Dance,
        Self::Punch,
        Self::Drive,
        Self::Fly,
        Self::Swim,
        Self::Hop,
        Self::Float,
        Self::Sway,
    ];

    /// The word for it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Walk => "walk",
            Self::Run => "run",
            Self::Trot => "trot",
            Self::Sneak => "sneak",
            Self::Jump => "jump",
            Self::Idle => "idle",
            Self::Wave => "wave",
            Self::Dance => "dance",
            Self::Punch => "punch",
            Self::Drive => "drive",
            Self::Fly => "fly",
            Self::Swim => "swim",
            Self::Hop => "hop",
            Self::Float => "float",
            Self::Sway => "sway",
        }
    }

    /// Whether it is a way to walk.
    pub(crate) fn is_gait(self) -> bool {
        matches!(self, Self::Walk | Self::Run | Self::Trot | Self::Sneak)
    }

    /// Whether it moves the parts of a figure by what they are, and not by the joints of a body: it exists on a figure only.
    pub fn moves_parts(self) -> bool {
        matches!(
            self,
            Self::Drive | Self::Fly | Self::Swim | Self::Hop | Self::Float | Self::Sway
        )
    }

    /// The clip of a word.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|clip| clip.name() == name)
    }
}

/// How many legs a clip is made for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Legs {
    /// Two, and two arms.
    Two,
    /// Four.
    Four,
    /// Six.
    Six,
}

impl Legs {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Two, Self::Four, Self::Six];

    /// The legs of the clips that a figure plays. Figures with more pairs of legs than three play those for six, figures without legs
    /// those for two.
    pub fn of(figure: &Figure) -> Self {
        let labels = label_figure(figure);
        let legs = labels
            .iter()
            .flatten()
            .filter(|label| label.class == Class::Leg);
        match legs.map(|leg| leg.pair).max() {
            None | Some(0) => Self::Two,
            Some(1) => Self::Four,
            Some(_) => Self::Six,
        }
    }

    /// The number.
    pub fn count(self) -> usize {
        match self {
            Self::Two => 2,
            Self::Four => 4,
            Self::Six => 6,
        }
    }
}

/// A clip of a body, without frames for what moves the parts of a figure. Centimetres, 24 frames a second; +y is up, and the body travels to +z. Its last frame is the first one again, as far
/// ahead as it has travelled.
pub(crate) fn clip(which: BuiltIn, legs: Legs) -> (Clip, Anatomy) {
    let body = Body::on(legs);
    let poses = match Gait::of(which, legs) {
        Some(gait) => gait.poses(&body),
        None => actions::poses(which, &body).unwrap_or_default(),
    };
    let values = pose::channel_values(&body, &poses);
    let clip = Clip::new(Arc::new(body.skeleton), 1.0 / FPS, values);
    (clip, body.anatomy)
}
