//! How high above the ground a figure is: on its feet, and in flight.

use super::contacts::Walk;

/// A figure in a frame. Heights are those of its root above the ground.
#[derive(Debug, Clone, Copy)]
pub(super) struct Stance {
    /// The height at which the feet that are in contact stand on the ground, each as firmly as it is in contact.
    on_ground: f64,
    /// How firmly the firmest of them is in contact, from 0 to 1.
    firm: f64,
    /// The height at which the lowest foot touches the ground.
    touching: f64,
    /// How far the lowest foot of the actor is above the ground, in the figure's unit.
    pub(super) lift: f64,
}

impl Stance {
    /// The stance in a frame of a walk, given the heights of the feet relative to the root.
    pub(super) fn of(walk: &Walk, frame: usize, lowest: &[f64]) -> Self {
        let heights = || lowest.iter().map(|low| -low);
        let touching = heights().fold(f64::NEG_INFINITY, f64::max);
        let firmness = walk.feet.iter().map(|foot| foot.firm[frame]);
        let firm = firmness.clone().fold(0.0, f64::max);
        let lifts = walk.feet.iter().map(|foot| foot.lift[frame]);
        let mut stance = Self {
            on_ground: touching,
            firm,
            touching,
            lift: lifts.fold(f64::INFINITY, f64::min),
        };
        if firm > 0.0 {
            let weighed = || heights().zip(firmness.clone().map(|own| own / firm));
            let sum: f64 = weighed().map(|(height, weight)| height * weight).sum();
            let mean = sum / weighed().map(|(_, weight)| weight).sum::<f64>();
            let on_ground = weighed().map(|(height, weight)| mean + weight * (height - mean));
            stance.on_ground = on_ground.fold(f64::NEG_INFINITY, f64::max);
        }
        stance
    }

    /// The height of the root: feet in contact stand on the ground, as firmly as they are in contact; without any, the lowest foot is as
    /// high as the actor's.
    pub(super) fn height(&self) -> f64 {
        let in_air = self.touching + self.lift;
        in_air + (self.on_ground - in_air) * self.firm
    }
}
