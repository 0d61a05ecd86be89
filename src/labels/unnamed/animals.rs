//! Finds animals that are drawn from the side, by their one eye.

use super::mask::{Box2, Island, Mask};
use super::shapes::{Shape, Shapes};
use super::{Certainty, Guesses, bodies};
use crate::anatomy::Noun;

/// An eye is at most this share of what it lies on, and at least this many cells.
const LARGEST_EYE: f64 = 0.05;
const SMALLEST_EYE: f64 = 3.0;
/// Eyes are darker than this.
const DARK: f64 = 0.45;
/// What lies on something larger by this share belongs to it.
const ON: f64 = 0.85;
/// An eye is within this share of the drawing's width from one of its ends, and this share of its height from the top.
const END: f64 = 0.42;
const HIGH: f64 = 0.6;
/// What is drawn from the side and at least this share of its width high stands on two legs.
const UPRIGHT: f64 = 1.2;
/// Legs stand at most this share of the height above the ground, and reach up to at most this share of it.
const LOW: f64 = 0.08;
const REACH: f64 = 0.62;

/// What hangs between the legs ends at least this share of the height above the ground.
const HANGS: f64 = 0.1;
/// Of a shape of legs, at least this share stands on the ground. The rest may be the shadow of a neck, or a tail.
const STANDS: f64 = 0.4;
/// What is in front of the eye and at most this share of the drawing's width and height from it is of the face, and what rises above it
/// within that share of the width are horns or ears.
const FACE: f64 = 0.28;
/// What lies on a muzzle or in a mouth by this share belongs to it.
const IN_MOUTH: f64 = 0.5;
/// Horns and ears begin at most this share of the height below the eye.
const CROWN: f64 = 0.06;

/// An animal in profile that is not upright, as far as it matters for what may be a limb of it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Profile {
    /// The height of its eye, in cells downwards.
    eye: f64,
    /// Where its feet are: the left and the right end of what stands on the ground, and the ground.
    feet: [f64; 2],
    ground: f64,
    height: f64,
}

impl Profile {
    fn read(shapes: &Shapes, eye: f64) -> Self {
        let mut all = Mask::empty();
        shapes.iter().for_each(|(_, shape)| all.add(&shape.mask));
        Self {
            eye,
            feet: all.standing(),
            ground: shapes.bounds.high.y,
            height: shapes.height(),
        }
    }

    /// Whether what points outward may be an arm: a mane, which does so too, is higher than the eye.
    pub(crate) fn may_be_arm(&self, mask: &Mask) -> bool {
        mask.bounds()
            .is_some_and(|bounds| bounds.middle().y >= self.eye)
    }

    /// Whether something hangs between the legs without reaching the ground, like an udder.
    pub(crate) fn is_between_legs(&self, mask: &Mask) -> bool {
        let [left, right] = self.feet;
        let is_between = |bounds: Box2| {
            bounds.low.x > left
                && bounds.high.x < right
                && bounds.high.y < self.ground - HANGS * self.height
        };
        mask.bounds().is_some_and(is_between)
    }
}

/// Names eye, head, body and legs of an animal in profile, whose eye lies on `host`.
pub(super) fn around(shapes: &Shapes, [eye, host]: [usize; 2], guesses: &mut Guesses) {
    let named = guesses.find(Noun::Body);
    let may_be = |index: usize| match named {
        Some(body) => index == body,
        None => index != eye || eye == host,
    };
    let body = shapes
        .iter()
        .filter(|(index, _)| may_be(*index))
        .max_by(|a, b| a.1.seen.total_cmp(&b.1.seen));
    let Some((mut body, mut trunk)) = body else {
        return;
    };
    // Wool or a saddle may be what is seen most of a body.
    let below = shapes.iter().filter(|(index, other)| {
        named.is_none() && *index < body && other.cells > trunk.cells && trunk.on(other) >= ON
    });
    if let Some((index, other)) = below.max_by(|a, b| a.1.cells.total_cmp(&b.1.cells)) {
        (body, trunk) = (index, other);
    }
    let is_single = shapes.get(eye).is_some_and(|eye| eye.islands.len() == 1);
    if eye != host && is_single {
        let why = "it is dark and round, and lies near one end";
        guesses.add(eye, Noun::Eye, Certainty::Likely, why);
    }
    if host != body && is_above(shapes, host, trunk) {
        guesses.add(host, Noun::Head, Certainty::Certain, "an eye lies on it");
        bodies::find(shapes, Some(host), guesses);
        return;
    }
    if let Some(spot) = shapes.get(eye)
        && eye != host
        && !is_upright(shapes)
    {
        name_face(shapes, [eye, body, host], spot, guesses);
        guesses.profile = Some(Profile::read(shapes, spot.middle().y));
    }
    if host == body {
        guesses.has_head = true;
        let why = "it is the largest shape, and an eye lies on it";
        guesses.add(body, Noun::Body, Certainty::Likely, why);
    } else {
        guesses.add(host, Noun::Head, Certainty::Certain, "an eye lies on it");
        let why = "it is the largest shape beside a head";
        guesses.add(body, Noun::Body, Certainty::Certain, why);
    }
    name_legs(shapes, trunk, guesses);
}

fn is_upright(shapes: &Shapes) -> bool {
    let size = shapes.bounds.size();
    size.y >= UPRIGHT * size.x
}

/// Whether a head is above the body of a figure that stands upright.
fn is_above(shapes: &Shapes, head: usize, trunk: &Shape) -> bool {
    let Some(head) = shapes.get(head) else {
        return false;
    };
    let off = (head.middle().x - trunk.middle().x).abs();
    is_upright(shapes) && off <= 0.5 * trunk.size().x
}

/// The eye, and the shape on which it lies.
pub(super) fn eye(shapes: &Shapes) -> Option<(usize, usize)> {
    let mut best: Option<(f64, usize, usize)> = None;
    for (index, shape) in shapes
        .iter()
        .filter(|(_, shape)| shape.brightness() <= DARK)
    {
        for spot in &shape.islands {
            let size = spot.bounds.size();
            let round = size.min_element() / size.max_element();
            let cells = spot.cells as f64;
            let place = (spot.bounds.middle() - shapes.bounds.low) / shapes.bounds.size();
            let is_eye = cells >= SMALLEST_EYE
                && round >= 0.5
                && (place.x <= END || place.x >= 1.0 - END)
                && place.y <= HIGH;
            let holds = |(other, host): &(usize, &Shape)| {
                *other < index
                    && host.mask.covers(spot.bounds.middle())
                    && cells <= LARGEST_EYE * host.cells
                    && cells * 6.0 <= host.seen
                    && host.distance_of_colors(shape) >= 40.0
            };
            let Some((host, _)) = shapes.iter().filter(holds).last().filter(|_| is_eye) else {
                continue;
            };
            let fills = shape.mask.fullness(spot.bounds).min(0.8);
            let score = round + fills - shape.brightness() - 0.5 * place.y;
            if best.is_none_or(|(most, ..)| score > most) {
                best = Some((score, index, host));
            }
        }
    }
    best.map(|(_, eye, host)| (eye, host))
}

/// What is before the eye, and what rises above it: both would look like arms.
fn name_face(shapes: &Shapes, [eye, body, host]: [usize; 3], spot: &Shape, guesses: &mut Guesses) {
    let (all, at) = (shapes.bounds, spot.middle());
    let size = all.size();
    let ahead = if at.x - all.low.x < all.high.x - at.x {
        -1.0
    } else {
        1.0
    };
    let (mut before, mut above): (Vec<(usize, &Shape)>, Vec<usize>) = (Vec::new(), Vec::new());
    for (index, shape) in shapes.iter() {
        if [eye, body, host].contains(&index) || !shape.name.is_empty() {
            continue;
        }
        let middle = shape.middle();
        let far = (middle - at).abs() / size;
        if ahead * (middle.x - at.x) > 0.0
            && far.max_element() <= FACE
            && shape.size().max_element() <= FACE * size.max_element()
            && shape.bounds.low.y >= at.y - CROWN * size.y
        {
            before.push((index, shape));
        } else if shape.bounds.high.y <= at.y + CROWN * size.y
            && middle.y < at.y
            && far.x <= FACE
            && shape.bounds.low.y < spot.bounds.low.y
        {
            above.push(index);
        }
    }
    // Nostrils lie on a muzzle, and teeth in a mouth: they go along with it without a name.
    before.sort_by(|a, b| b.1.cells.total_cmp(&a.1.cells));
    let mut mouths: Vec<&Shape> = Vec::new();
    for (index, shape) in before {
        if mouths.iter().all(|mouth| shape.on(mouth) < IN_MOUTH) {
            let why = "it is before the eye";
            guesses.add(index, Noun::Mouth, Certainty::Uncertain, why);
            mouths.push(shape);
        }
    }
    for index in above {
        let why = "it rises above the eye";
        guesses.add(index, Noun::Horns, Certainty::Uncertain, why);
    }
}

/// Shapes of several legs each: they stand on the ground and end below the body's back.
fn name_legs(shapes: &Shapes, trunk: &Shape, guesses: &mut Guesses) {
    let ground = shapes.bounds.high.y;
    let height = shapes.height();
    for (index, shape) in shapes.iter() {
        let stand = shape
            .islands
            .iter()
            .filter(|leg| leg.bounds.high.y >= ground - LOW * height);
        let legs: Vec<&Island> = stand.collect();
        let count = legs.len();
        let cells: usize = legs.iter().map(|leg| leg.cells).sum();
        let boxes = legs.iter().map(|leg| leg.bounds);
        let reaches = boxes.reduce(Box2::around).map_or(0.0, |all| all.size().y);
        if count < 2
            || (cells as f64) < STANDS * shape.cells
            || reaches > REACH * height
            || shape.cells >= trunk.cells
        {
            continue;
        }
        let are_long = legs.iter().all(|leg| {
            let size = leg.bounds.size();
            size.y >= 0.9 * size.x
        });
        if reaches <= LOW * height && count > 1 {
            let why = "its pieces lie on the ground";
            guesses.add(index, Noun::Feet, Certainty::Likely, why);
            continue;
        }
        if !are_long {
            continue;
        }
        let body = guesses.all.iter().find(|guess| guess.noun == Noun::Body);
        let is_behind = body.is_some_and(|body| index < body.shape);
        let noun = if is_behind {
            Noun::FarLegs
        } else {
            Noun::NearLegs
        };
        let why = "its pieces stand on the ground below the body";
        guesses.add(index, noun, Certainty::Likely, why);
    }
}
