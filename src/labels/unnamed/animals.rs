//! Finds animals that are drawn from the side, by their one eye.

use super::shapes::{Shape, Shapes};
use super::{Certainty, Guesses};
use crate::anatomy::Noun;

/// An eye is at most this share of what it lies on, and at least this many cells.
const LARGEST_EYE: f64 = 0.05;
const SMALLEST_EYE: f64 = 3.0;
/// Eyes are darker than this.
const DARK: f64 = 0.45;
/// The share of an eye that lies on what it belongs to.
const ON: f64 = 0.85;
/// An eye is within this share of the drawing's width from one of its ends, and this share of its height from the top.
const END: f64 = 0.42;
const HIGH: f64 = 0.6;
/// A head is at most this share of the body.
const SMALLER: f64 = 0.9;
/// Legs stand at most this share of the height above the ground, and reach up to at most this share of it.
const LOW: f64 = 0.08;
const REACH: f64 = 0.62;

/// Names eye, head, body and legs of an animal in profile.
pub(super) fn find(shapes: &Shapes, guesses: &mut Guesses) {
    let Some((eye, host)) = eye(shapes) else {
        return;
    };
    let is_free = |index: usize| index != eye;
    let body = shapes
        .iter()
        .filter(|(index, _)| is_free(*index))
        .max_by(|a, b| a.1.seen.total_cmp(&b.1.seen));
    let Some((body, trunk)) = body else {
        return;
    };
    let has_head = host != body
        && shapes
            .get(host)
            .is_some_and(|head| head.cells <= SMALLER * trunk.cells);
    let why = "it is dark and round, and lies near one end";
    guesses.add(eye, Noun::Eye, Certainty::Likely, why);
    if has_head {
        guesses.add(host, Noun::Head, Certainty::Certain, "an eye lies on it");
        let why = "it is the largest shape beside a head";
        guesses.add(body, Noun::Body, Certainty::Certain, why);
    } else {
        let why = "it is the largest shape, and an eye lies on it";
        guesses.add(host, Noun::Body, Certainty::Likely, why);
        guesses.add(body, Noun::Body, Certainty::Likely, why);
    }
    name_legs(shapes, guesses);
}

/// The eye, and the shape on which it lies.
fn eye(shapes: &Shapes) -> Option<(usize, usize)> {
    let mut best: Option<(f64, usize, usize)> = None;
    for (index, shape) in shapes.iter() {
        let [only] = shape.islands.as_slice() else {
            continue;
        };
        let size = only.bounds.size();
        let round = size.min_element() / size.max_element();
        let place = (shape.middle() - shapes.bounds.low) / shapes.bounds.size();
        let is_eye = shape.cells >= SMALLEST_EYE
            && shape.brightness() <= DARK
            && round >= 0.5
            && (place.x <= END || place.x >= 1.0 - END)
            && place.y <= HIGH;
        if !is_eye {
            continue;
        }
        let holds = |(other, host): &(usize, &Shape)| {
            *other < index
                && shape.on(host) >= ON
                && shape.cells <= LARGEST_EYE * host.cells
                && shape.cells * 6.0 <= host.seen
        };
        let Some((host, _)) = shapes.iter().filter(holds).last() else {
            continue;
        };
        let fills = shape.mask.fullness(only.bounds).min(0.8);
        let score = round + fills - shape.brightness() - 0.5 * place.y;
        if best.is_none_or(|(most, ..)| score > most) {
            best = Some((score, index, host));
        }
    }
    best.map(|(_, eye, host)| (eye, host))
}

/// Shapes of several legs each: they stand on the ground and end below the body's back.
fn name_legs(shapes: &Shapes, guesses: &mut Guesses) {
    let ground = shapes.bounds.high.y;
    let height = shapes.height();
    let trunk = guesses.0.iter().filter(|guess| guess.noun == Noun::Body);
    let trunk = trunk.map(|guess| guess.shape).max();
    for (index, shape) in shapes.iter() {
        let stand = shape
            .islands
            .iter()
            .filter(|leg| leg.bounds.high.y >= ground - LOW * height);
        let count = stand.count();
        let reaches = shape.bounds.high.y - shape.bounds.low.y;
        if count < 2 || count < shape.islands.len() || reaches > REACH * height {
            continue;
        }
        let are_long = shape.islands.iter().all(|leg| {
            let size = leg.bounds.size();
            size.y >= 0.9 * size.x
        });
        if !are_long {
            continue;
        }
        let is_behind = trunk.is_some_and(|trunk| index < trunk);
        let noun = if is_behind { Noun::FarLegs } else { Noun::NearLegs };
        let why = "its pieces stand on the ground below the body";
        guesses.add(index, noun, Certainty::Likely, why);
    }
}
