//! Finds a head by its two eyes.

use glam::DVec2;

use super::mask::{Box2, Island};
use super::shapes::{Shape, Shapes};

/// An eye is at most this share of the head that it lies on, and at least this many cells.
const LARGEST_EYE: f64 = 0.13;
const SMALLEST_EYE: usize = 2;
/// The share of an eye that lies on its head.
const ON: f64 = 0.5;
/// What is at most this much wider than both eyes together is no head but a mask, or glasses.
const MASK: f64 = 1.3;
/// Eyes differ by at least this distance of colours from what they lie on.
const CONTRAST: f64 = 60.0;
/// How far the middle between the eyes is from that of the head, as a share of the head's width.
const OFF: f64 = 0.3;
/// A head is at least this share of the figure's box, and at most this much longer than wide or the other way round.
const SMALLEST_HEAD: f64 = 0.004;
const LONGEST_HEAD: f64 = 2.2;
/// Hair behind a face holds this share of it, and brows on it are at most this share of the face's height from the eyes.
const ON_HAIR: f64 = 0.6;
const SAME_PLACE: f64 = 0.15;
/// A helmet is at most this share of the trunk wide, and the slit in it between these shares of the helmet.
const HELMET: f64 = 0.75;
const SLIT_WIDTH: std::ops::RangeInclusive<f64> = 0.5..=0.9;
/// The least score of a face: dark eyes in the middle of something high up.
const LEAST: f64 = 1.7;

/// A head that is drawn from the front.
#[derive(Debug)]
pub(super) struct Face {
    pub(super) head: usize,
    /// The shapes of its eyes: one with two pieces, or two; none for a helmet.
    pub(super) eyes: Vec<usize>,
    /// Why it is a head, a clause.
    pub(super) why: &'static str,
}

/// A pair of spots that may be eyes.
struct Pair {
    shapes: Vec<usize>,
    spots: [Island; 2],
}

/// The best face of a drawing.
pub(super) fn find(shapes: &Shapes) -> Option<Face> {
    let pairs = pairs(shapes);
    let scored = pairs.iter().filter_map(|pair| {
        let head = host(shapes, pair)?;
        Some((score(shapes, pair, head)?, pair, head))
    });
    let faces: Vec<(f64, &Pair, usize)> = scored.filter(|(score, ..)| *score >= LEAST).collect();
    let mut best = *faces.iter().max_by(|a, b| a.0.total_cmp(&b.0))?;
    // Brows may lie on hair that is behind the face.
    let inner = faces.iter().filter(|face| is_before(shapes, face, &best));
    if let Some(inner) = inner.max_by(|a, b| a.0.total_cmp(&b.0)) {
        best = *inner;
    }
    let (_, pair, head) = best;
    if let Some(head) = helmet(shapes, head) {
        return Some(Face {
            head,
            eyes: Vec::new(),
            why: "it is above the body, with a slit like that of a helmet",
        });
    }
    Some(Face {
        head,
        eyes: pair.shapes.clone(),
        why: "two dark spots of one size lie on it like eyes",
    })
}

/// Whether a face lies on the head of another one, with its eyes at the same place.
fn is_before(
    shapes: &Shapes,
    (_, pair, head): &(f64, &Pair, usize),
    (_, behind, other): &(f64, &Pair, usize),
) -> bool {
    let (Some(own), Some(other_head)) = (shapes.get(*head), shapes.get(*other)) else {
        return false;
    };
    let apart = between(pair).distance(between(behind));
    head > other && own.on(other_head) >= ON_HAIR && apart <= SAME_PLACE * own.size().y
}

/// The helmet above a trunk on which two spots lie: narrower than the trunk and about as high as wide, with a dark slit across it.
fn helmet(shapes: &Shapes, trunk: usize) -> Option<usize> {
    let trunk = shapes.get(trunk)?;
    let size = trunk.size();
    let is_above = |shape: &Shape| {
        let own = shape.size();
        shape.bounds.high.y <= trunk.bounds.low.y + 0.2 * size.y
            && (shape.middle().x - trunk.middle().x).abs() <= 0.15 * size.x
            && own.x <= HELMET * size.x
            && own.max_element() <= 1.7 * own.min_element()
    };
    let is_slit = |slit: &Shape, helmet: &Shape| {
        let (own, all) = (slit.size(), helmet.size());
        slit.on(helmet) >= 0.9
            && SLIT_WIDTH.contains(&(own.x / all.x))
            && own.y <= 0.25 * all.y
            && (slit.middle().x - helmet.middle().x).abs() <= 0.15 * all.x
            && slit.distance_of_colors(helmet) >= CONTRAST
            && slit.brightness() < helmet.brightness()
    };
    let has_slit = |index: usize, helmet: &Shape| {
        let mut later = shapes.iter().filter(|(other, _)| *other > index);
        later.any(|(_, slit)| is_slit(slit, helmet))
    };
    let mut helmets = shapes.iter().filter(|(_, shape)| is_above(shape));
    let found = helmets.find(|(index, helmet)| has_slit(*index, helmet));
    found.map(|(index, _)| index)
}

fn between(pair: &Pair) -> DVec2 {
    let [left, right] = pair.spots.map(|spot| spot.bounds.middle());
    left.midpoint(right)
}

fn around(pair: &Pair) -> Box2 {
    let [left, right] = pair.spots.map(|spot| spot.bounds);
    left.around(right)
}

/// Two spots of one size at one height, beside each other: in one shape, or in two of one colour.
fn pairs(shapes: &Shapes) -> Vec<Pair> {
    let mut found = Vec::new();
    let largest = LARGEST_EYE * shapes.area();
    let small: Vec<(usize, &Shape)> = shapes
        .iter()
        .filter(|(_, shape)| shape.cells <= largest)
        .collect();
    for (index, shape) in &small {
        if let Some(spots) = shape.twins() {
            found.push(Pair {
                shapes: vec![*index],
                spots,
            });
        }
        let [own] = shape.islands.as_slice() else {
            continue;
        };
        for (later, other) in small.iter().filter(|(later, _)| later > index) {
            let [spot] = other.islands.as_slice() else {
                continue;
            };
            if shape.distance_of_colors(other) > 40.0 {
                continue;
            }
            let mut both = [(*index, *own), (*later, *spot)];
            both.sort_by(|a, b| a.1.bounds.middle().x.total_cmp(&b.1.bounds.middle().x));
            found.push(Pair {
                shapes: vec![*index, *later],
                spots: both.map(|(_, spot)| spot),
            });
        }
    }
    found.retain(|pair| {
        let [left, right] = &pair.spots;
        let (a, b) = (left.bounds.size(), right.bounds.size());
        let (least, most) = (left.cells.min(right.cells), left.cells.max(right.cells));
        let level = (left.bounds.middle().y - right.bounds.middle().y).abs();
        let apart = right.bounds.low.x - left.bounds.high.x;
        least >= SMALLEST_EYE
            && least as f64 >= 0.55 * most as f64
            && level <= 0.5 * a.y.max(b.y) + 1.0
            && apart >= 0.25 * a.x.max(b.x)
            && a.max(b).x <= 2.5 * a.max(b).y
    });
    found
}

/// The shape on which both spots and what is between them lie.
fn host(shapes: &Shapes, pair: &Pair) -> Option<usize> {
    let eyes = around(pair);
    let cells: usize = pair.spots.iter().map(|spot| spot.cells).sum();
    let first = pair.shapes[0];
    let holds = |(index, shape): &(usize, &Shape)| {
        *index < first
            && shapes
                .get(first)
                .is_some_and(|eye| eye.distance_of_colors(shape) >= CONTRAST)
            && shape.mask.covers(between(pair))
            && pair
                .shapes
                .iter()
                .filter_map(|eye| shapes.get(*eye))
                .all(|eye| eye.on(shape) >= ON)
            && shape.cells * LARGEST_EYE >= cells as f64
            && shape.size().x > MASK * eyes.size().x
            && shape.size().max_element() <= LONGEST_HEAD * shape.size().min_element()
    };
    let hosts = shapes.iter().filter(holds);
    hosts.last().map(|(index, _)| index)
}

/// How much two spots look like the eyes of a head; `None` if they cannot be.
fn score(shapes: &Shapes, pair: &Pair, head: usize) -> Option<f64> {
    let head = shapes.get(head)?;
    let size = head.size();
    let off = (between(pair).x - head.middle().x).abs() / size.x;
    let down = (between(pair).y - head.bounds.low.y) / size.y;
    let is_head =
        off <= OFF && (0.12..=0.75).contains(&down) && head.cells >= SMALLEST_HEAD * shapes.area();
    if !is_head {
        return None;
    }
    let dark = pair.shapes.iter().filter_map(|eye| shapes.get(*eye));
    let dark = 1.0 - dark.map(Shape::brightness).fold(0.0, f64::max);
    let high = 1.0 - (head.middle().y - shapes.bounds.low.y) / shapes.height();
    let round = pair.spots.iter().map(|spot| {
        let size = spot.bounds.size();
        size.min_element() / size.max_element()
    });
    let round = round.fold(1.0, f64::min);
    Some(dark + high + 0.7 * (1.0 - off / OFF) + 0.4 * round)
}
