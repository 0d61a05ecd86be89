//! Finds vehicles by their wheels.

use super::mask::{Box2, Island};
use super::shapes::{Shape, Shapes};
use super::{Certainty, Guesses};
use crate::anatomy::Noun;

/// A wheel is at least and at most this share of the vehicle's height high.
const SMALLEST: f64 = 0.1;
const LARGEST: f64 = 0.65;
/// Wheels stand at most this share of the height above the ground.
const LOW: f64 = 0.1;
/// Wheels of one vehicle differ by at most this factor.
const ALIKE: f64 = 0.55;
/// What lies on a wheel, or below it, covers it by this share.
const ON: f64 = 0.8;
/// A hub is at most this share of its wheel wide.
const HUB: f64 = 0.8;

/// A disc that stands on the ground.
struct Disc {
    shape: usize,
    bounds: Box2,
}

/// Names wheels, what lies in their middle, and the body. Says whether it is a vehicle: two wheels or more.
pub(super) fn find(shapes: &Shapes, guesses: &mut Guesses) -> bool {
    let ground = shapes.bounds.high.y;
    let height = shapes.height();
    let stands = |island: &Island| {
        let size = island.bounds.size().y;
        (SMALLEST * height..=LARGEST * height).contains(&size)
            && island.bounds.high.y >= ground - LOW * height
    };
    let mut discs: Vec<Disc> = Vec::new();
    for (index, shape) in shapes.iter() {
        for island in &shape.islands {
            if stands(island) && shape.is_disc(island) {
                discs.push(Disc {
                    shape: index,
                    bounds: island.bounds,
                });
            }
        }
    }
    let largest = discs.iter().map(|disc| disc.bounds.size().y);
    let largest = largest.fold(0.0, f64::max);
    // What lies within a larger disc is its hub.
    let holds = |outer: &Disc, inner: &Disc| {
        let off = outer.bounds.middle().distance(inner.bounds.middle());
        outer.shape != inner.shape
            && outer.bounds.size().x > inner.bounds.size().x
            && off <= 0.3 * outer.bounds.size().x
    };
    let wheels: Vec<&Disc> = discs
        .iter()
        .filter(|disc| disc.bounds.size().y >= ALIKE * largest)
        .filter(|disc| !discs.iter().any(|outer| holds(outer, disc)))
        .collect();
    let apart = |a: &&Disc| {
        wheels.iter().any(|b| {
            let distance = (a.bounds.middle().x - b.bounds.middle().x).abs();
            distance >= 0.9 * a.bounds.size().x.max(b.bounds.size().x)
        })
    };
    let wheels: Vec<&Disc> = wheels.iter().copied().filter(apart).collect();
    if wheels.len() < 2 {
        return false;
    }
    let body = shapes
        .iter()
        .filter(|(index, _)| !discs.iter().any(|disc| disc.shape == *index))
        .max_by(|a, b| a.1.seen.total_cmp(&b.1.seen));
    let Some((body, _)) = body else {
        return false;
    };
    guesses.add(
        body,
        Noun::Body,
        Certainty::Likely,
        "it is the largest shape above wheels",
    );
    for wheel in &wheels {
        let of_shape = wheels.iter().filter(|other| other.shape == wheel.shape);
        let noun = if of_shape.count() > 1 {
            Noun::Wheels
        } else {
            Noun::Wheel
        };
        guesses.add(
            wheel.shape,
            noun,
            Certainty::Certain,
            "it is round, and stands on the ground beside another one",
        );
    }
    name_hubs(shapes, &wheels, guesses);
    true
}

/// What lies in the middle of wheels and is round, too.
fn name_hubs(shapes: &Shapes, wheels: &[&Disc], guesses: &mut Guesses) {
    for (index, shape) in shapes.iter() {
        let lies_in = |island: &Island| {
            wheels.iter().any(|wheel| {
                let off = wheel.bounds.middle().distance(island.bounds.middle());
                off <= 0.1 * wheel.bounds.size().x
                    && island.bounds.size().x <= HUB * wheel.bounds.size().x
                    && index > wheel.shape
            })
        };
        let is_hub = |shape: &Shape| {
            shape
                .islands
                .iter()
                .all(|island| lies_in(island) && shape.is_disc(island))
        };
        let lies_on = |shape: &Shape| {
            let below = wheels.iter().filter_map(|wheel| shapes.get(wheel.shape));
            below.map(|wheel| shape.on(wheel)).fold(0.0, f64::max) >= ON
        };
        // Hubs in one shape, on wheels of their own, move with none of those without a name.
        if shape.islands.len() > 1 && is_hub(shape) && lies_on(shape) {
            guesses.add(
                index,
                Noun::Hubs,
                Certainty::Likely,
                "they lie in the middle of wheels",
            );
        }
    }
}
