//! How feet step: planted while the body passes over them, then carried to the next place.

use glam::{DQuat, DVec3};

use super::body::Leg;
use super::curves::{bump, hermite};
use super::pose::{Foot, tip};
use crate::smoothing::ease;

/// The steps of a gait. Times are turns of its cycle, lengths centimetres, angles degrees.
#[derive(Debug, Clone, Copy)]
pub(super) struct Steps {
    /// How far the body travels in a cycle; every foot takes one step in it.
    pub(super) stride: f64,
    /// For how much of the cycle a foot is on the ground.
    pub(super) duty: f64,
    /// How far the toes are up when the heel touches the ground; negative where the toes touch it first.
    pub(super) toes_up: f64,
    /// How far the heel is up when the toes leave the ground.
    pub(super) heel_up: f64,
    /// At which share of the time on the ground the heel begins to rise.
    pub(super) heel_off: f64,
    /// How high the ankle is carried.
    pub(super) lift: f64,
    /// At which share of the time in the air it is highest.
    pub(super) highest: f64,
    /// How far from the middle the feet are set, as a share of where they stand at rest.
    pub(super) track: f64,
    /// How far in front of its place at rest a foot is when the body is over it.
    pub(super) ahead: f64,
}

/// At which share of the time on the ground a foot is flat after its heel has touched the ground.
const FLAT: f64 = 0.18;

impl Steps {
    /// The foot of a leg at a time of the cycle. `touches` is the time at which it touches the ground; the body, whose hips are at
    /// z = stride × time, may be in any cycle.
    pub(super) fn foot(&self, leg: &Leg, touches: f64, time: f64) -> Foot {
        let cycle = (time - touches).floor();
        let since = time - touches - cycle;
        let place = self.place(leg, touches + cycle);
        if since < self.duty {
            return self.standing(leg, place, since / self.duty);
        }
        let next = self.place(leg, touches + cycle + 1.0);
        let air = 1.0 - self.duty;
        let s = (since - self.duty) / air;
        let from = self.standing(leg, place, 1.0);
        let to = self.standing(leg, next, 0.0);
        // The ankle leaves and reaches the ground with the velocity that it has there.
        let step = 1e-4;
        let leaving = (from.ankle - self.standing(leg, place, 1.0 - step).ankle) / step;
        let reaching = (self.standing(leg, next, step).ankle - to.ankle) / step;
        let velocities = [leaving, reaching].map(|velocity| velocity * (air / self.duty));
        let along = |axis: usize| {
            let ends = [velocities[0][axis], velocities[1][axis]];
            hermite(from.ankle[axis], to.ankle[axis], ends, s)
        };
        let ankle = DVec3::new(
            along(0),
            along(1) + self.lift * bump(s, self.highest),
            along(2),
        );
        // The foot goes on turning as it did when it left the ground, then it is brought up for the next step.
        let turning = -2.0 * self.heel_up / (1.0 - self.heel_off) * (air / self.duty);
        let pitch = hermite(-self.heel_up, self.toes_up, [turning, 0.0], s);
        let toes = pitch.min(0.0) * ease(s * 3.0) + pitch.max(0.0);
        Foot {
            ankle,
            rotation: pitched(pitch),
            toes: pitched(toes),
        }
    }

    /// The ankle's place with the foot flat, for the step that begins at a time.
    fn place(&self, leg: &Leg, begins: f64) -> DVec3 {
        let body = self.stride * (begins + self.duty / 2.0);
        let rest = leg.ankle;
        DVec3::new(rest.x * self.track, rest.y, rest.z + body + self.ahead)
    }

    /// A foot on the ground, at a share of its time there.
    fn standing(&self, leg: &Leg, place: DVec3, share: f64) -> Foot {
        let landing = self.toes_up * (1.0 - ease(share / FLAT));
        let rising = self.heel_up * rise((share - self.heel_off) / (1.0 - self.heel_off));
        let pitch = landing - rising;
        let [heel, ball] = leg.sole;
        let pivot = if pitch > 0.0 { heel } else { ball };
        let rotation = pitched(pitch);
        Foot {
            ankle: place + pivot - rotation * pivot,
            rotation,
            toes: pitched(landing),
        }
    }
}

/// From 0 to 1, slowly at first and with speed at the end: a heel that rises goes on rising in the air.
fn rise(t: f64) -> f64 {
    t.clamp(0.0, 1.0).powi(2)
}

/// A foot whose toes are so many degrees up.
fn pitched(toes_up: f64) -> DQuat {
    tip(-toes_up)
}
