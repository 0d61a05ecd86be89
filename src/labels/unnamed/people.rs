//! Names what is around a head that is drawn from the front: hair, ears, neck, trunk, and what hangs from its shoulders.

use super::faces::Face;
use super::mask::Box2;
use super::shapes::{Shape, Shapes};
use super::{Certainty, Guesses};
use crate::anatomy::Noun;
use crate::labels::Side;

/// What lies on the head by this share is a feature of it.
const ON: f64 = 0.75;
/// Skin of one figure differs by at most this distance of colours.
const SKIN: f64 = 110.0;
/// Hair and hats differ from the skin by at least this.
const OTHER: f64 = 45.0;

/// The eyes of what is head and body in one are at most this share of its height from its top.
const HIGH_EYES: f64 = 0.3;
/// Ears in one shape behind the head are this many times as wide as that.
const BAND: std::ops::RangeInclusive<f64> = 1.05..=1.5;

/// A bust is at least this share of its width wide where it ends.
pub(crate) const BUST: f64 = 0.6;
/// What stands ends at most this share of the figure's height above the ground.
const STANDS: f64 = 0.06;

/// A cape is behind the body, which covers at most this share of it and on which at least that share of the body lies; it is at least this
/// share of the body's height high.
const COVERED: f64 = 0.85;
const BEHIND: f64 = 0.35;
const CAPE: f64 = 0.6;
/// What is farther from below the head's middle than this share of its width is but one half of a jacket. The shirt between both halves is
/// nearer than that share of its own width, and at least this share of the half.
const HALF: f64 = 0.25;
const MIDDLE: f64 = 0.2;
const SHIRT: f64 = 0.4;
/// Legs lie by this share before a cape.
const BEFORE: f64 = 0.4;

/// A head with what is around it.
pub(super) struct Around<'a> {
    pub(super) shapes: &'a Shapes,
    pub(super) head: &'a Shape,
    index: usize,
    face: &'a Face,
}

/// Names a head, its eyes, and what belongs to them.
pub(super) fn around(shapes: &Shapes, face: &Face, guesses: &mut Guesses) {
    let Some(head) = shapes.get(face.head) else {
        return;
    };
    let around = Around {
        shapes,
        head,
        index: face.head,
        face,
    };
    if around.is_whole() {
        let why = "it has eyes, and stands on the ground: head and body are one";
        guesses.has_head = true;
        guesses.add(face.head, Noun::Body, Certainty::Certain, why);
        around.eyes(guesses);
        around.limbs(guesses);
        return;
    }
    guesses.add(face.head, Noun::Head, Certainty::Certain, face.why);
    around.eyes(guesses);
    around.ears(guesses);
    around.neck(guesses);
    around.cover(guesses);
    if around.body(guesses) {
        around.cape(guesses);
        around.limbs(guesses);
        around.hands(guesses);
    }
}

impl<'a> Around<'a> {
    /// Whether a head is that of a snowman or a ghost, with the body below the eyes in the same shape.
    pub(super) fn is_whole(&self) -> bool {
        let eyes = self.face.eyes.iter();
        let eyes = eyes.filter_map(|eye| self.shapes.get(*eye));
        let eyes = eyes.map(|eye| eye.middle().y).fold(0.0, f64::max);
        let size = self.head.size();
        let is_high =
            !self.face.eyes.is_empty() && eyes <= self.head.bounds.low.y + HIGH_EYES * size.y;
        is_high && size.y >= size.x && self.stands(self.head.bounds)
    }

    fn eyes(&self, guesses: &mut Guesses) {
        let why = "they are two of one size at one height";
        let apart = self
            .face
            .eyes
            .iter()
            .copied()
            .filter(|eye| *eye != self.index);
        let apart: Vec<usize> = apart.collect();
        match apart.as_slice() {
            [both] => guesses.add(*both, Noun::Eyes, Certainty::Likely, why),
            [left, right] if left != right => {
                // The figure's right is on the drawing's left.
                let mut pair = [*left, *right];
                let x = |eye: usize| self.shapes.get(eye).map_or(0.0, |shape| shape.middle().x);
                pair.sort_by(|a, b| x(*a).total_cmp(&x(*b)));
                for (eye, side) in pair.into_iter().zip([Side::Right, Side::Left]) {
                    guesses.add_sided(eye, Noun::Eye, Some(side), Certainty::Likely, why);
                }
            }
            _ => (),
        }
    }

    /// Shapes that have no name yet, and are not on the face.
    pub(super) fn free<'b>(
        &'b self,
        guesses: &'b Guesses,
    ) -> impl Iterator<Item = (usize, &'a Shape)> + use<'a, 'b> {
        self.shapes.iter().filter(|(index, shape)| {
            let is_on_face = *index > self.index && shape.on(self.head) >= ON;
            !guesses.has(*index) && !is_on_face && shape.name.is_empty()
        })
    }

    /// Where a place is, from the head's middle, in halves of its size.
    fn place(&self, bounds: Box2) -> glam::DVec2 {
        (bounds.middle() - self.head.middle()) / (self.head.size() / 2.0)
    }

    fn ears(&self, guesses: &mut Guesses) {
        let is_ear = |bounds: Box2| {
            let place = self.place(bounds);
            let size = bounds.size() / self.head.size();
            (0.7..=1.35).contains(&place.x.abs())
                && (-0.75..=0.75).contains(&place.y)
                && (0.05..=0.4).contains(&size.x)
                && (0.08..=0.6).contains(&size.y)
        };
        let why = "they are at both sides of the head, in its colour";
        let mut single: Vec<(usize, Side)> = Vec::new();
        let (mut both, mut band) = (None, None);
        for (index, shape) in self.free(guesses) {
            if shape.distance_of_colors(self.head) > SKIN {
                continue;
            }
            if let Some(twins) = shape.twins() {
                let opposite = self.place(twins[0].bounds).x * self.place(twins[1].bounds).x < 0.0;
                if opposite && twins.iter().all(|twin| is_ear(twin.bounds)) {
                    both.get_or_insert(index);
                }
            } else if index < self.index && self.is_band(shape) {
                band.get_or_insert(index);
            } else if shape.islands.len() == 1 && is_ear(shape.bounds) {
                let is_left = self.place(shape.bounds).x > 0.0;
                single.push((index, if is_left { Side::Left } else { Side::Right }));
            }
        }
        if let Some(both) = both {
            guesses.add(both, Noun::Ears, Certainty::Certain, why);
        } else if let Some(band) = band {
            let why = "it is behind the head, and seen at both of its sides, in its colour";
            guesses.add(band, Noun::Ears, Certainty::Likely, why);
        } else if single.iter().any(|one| one.1 != single[0].1) {
            for side in Side::BOTH {
                if let Some((ear, _)) = single.iter().find(|one| one.1 == side) {
                    guesses.add_sided(*ear, Noun::Ear, Some(side), Certainty::Likely, why);
                }
            }
        }
    }

    /// Whether a shape behind the head is a band from one ear to the other.
    fn is_band(&self, shape: &Shape) -> bool {
        let place = self.place(shape.bounds);
        let size = shape.size() / self.head.size();
        shape.islands.len() == 1
            && place.x.abs() <= 0.15
            && (-0.75..=0.75).contains(&place.y)
            && BAND.contains(&size.x)
            && (0.08..=0.6).contains(&size.y)
    }

    fn neck(&self, guesses: &mut Guesses) {
        let is_neck = |shape: &Shape| {
            let size = shape.size() / self.head.size();
            let off = (shape.middle().x - self.head.middle().x).abs() / self.head.size().x;
            let bottom = self.head.bounds.high.y;
            (0.12..=0.75).contains(&size.x)
                && size.y <= 0.8
                && off <= 0.2
                && shape.bounds.low.y < bottom + 1.0
                && shape.bounds.high.y > bottom + 1.0
                && shape.middle().y > self.head.middle().y + 0.25 * self.head.size().y
                && shape.distance_of_colors(self.head) <= SKIN
                && shape.islands.len() == 1
        };
        let found = self.free(guesses).filter(|(_, shape)| is_neck(shape));
        let found = found.max_by(|a, b| a.1.cells.total_cmp(&b.1.cells));
        if let Some((neck, _)) = found {
            let why = "it is below the head, narrower, and in its colour";
            guesses.add(neck, Noun::Neck, Certainty::Certain, why);
        }
    }

    /// Hair and hats.
    fn cover(&self, guesses: &mut Guesses) {
        let head = self.head;
        let size = head.size();
        let is_cover = |index: usize, shape: &Shape| {
            let own = shape.size();
            let off = (shape.middle().x - head.middle().x).abs();
            let top = head.bounds.low.y;
            let reaches_over = shape.bounds.low.y <= top + 0.12 * size.y;
            let touches = shape.bounds.high.y >= top - 1.0;
            let in_front = index > self.index;
            let lower = if in_front { 0.6 } else { 2.2 };
            reaches_over
                && touches
                && off <= 0.35 * size.x
                && own.x >= 0.55 * size.x
                && shape.bounds.high.y <= top + lower * size.y
                && shape.distance_of_colors(head) >= OTHER
                && shape.cells >= 0.03 * head.cells
                // A barbell above a head is neither hair nor hat.
                && shape.mask.touches(&head.mask)
        };
        let found: Vec<usize> = self
            .free(guesses)
            .filter(|(index, shape)| is_cover(*index, shape))
            .map(|(index, _)| index)
            .collect();
        let shape = |index: usize| self.shapes.get(index);
        // Of wings and hair behind a head, hair is what most of the head lies on.
        let below = found.iter().copied().filter(|index| *index < self.index);
        let under_head =
            |index: &usize| shape(*index).map_or(0, |shape| shape.mask.shared(&head.mask));
        let behind = below.rev().max_by_key(under_head);
        let front: Vec<usize> = found
            .iter()
            .copied()
            .filter(|index| *index > self.index)
            .collect();
        // What has another colour than the hair behind, or stands out far, is a hat.
        let is_hat = |index: &usize| {
            let Some(cover) = shape(*index) else {
                return false;
            };
            let rises = (head.bounds.low.y - cover.bounds.low.y) / size.y;
            let hair = behind.and_then(shape);
            let other = hair.is_some_and(|hair| cover.distance_of_colors(hair) > OTHER);
            other || cover.size().x >= 1.35 * size.x && rises >= 0.15 || rises >= 0.45
        };
        let largest = |indices: &[usize]| {
            let cells = |index: &usize| shape(*index).map_or(0.0, |shape| shape.cells);
            indices
                .iter()
                .copied()
                .max_by(|a, b| cells(a).total_cmp(&cells(b)))
        };
        let (hats, locks): (Vec<usize>, Vec<usize>) = front.iter().copied().partition(is_hat);
        if let Some(hat) = largest(&hats) {
            let why = "it is on top of the head, and no hair";
            guesses.add(hat, Noun::Hat, Certainty::Likely, why);
        }
        let why = "it is around the top of the head";
        if let Some(hair) = largest(&locks) {
            guesses.add(hair, Noun::Hair, Certainty::Likely, why);
        }
        if let Some(hair) = behind {
            guesses.add(hair, Noun::Hair, Certainty::Likely, why);
        }
    }

    /// Names the trunk; says whether there is one.
    fn body(&self, guesses: &mut Guesses) -> bool {
        if guesses.find(Noun::Body).is_some() {
            return true;
        }
        let head = self.head;
        let worth = |index: usize, shape: &Shape| {
            let off = (shape.middle().x - head.middle().x).abs();
            let below = shape.middle().y - head.middle().y;
            let gap = (shape.bounds.low.y - head.bounds.high.y).max(0.0);
            // What begins above the middle of the head is hair, or a cape.
            let begins = shape.bounds.low.y > head.bounds.low.y + 0.35 * head.size().y;
            let covers_middle = off <= 0.5 * shape.size().x;
            let is_one = shape.islands.len() == 1;
            let may_be = below > 0.3 * head.size().y && begins && covers_middle;
            (may_be && !self.is_behind_legs(index, shape)).then_some(
                shape.seen * if is_one { 1.0 } else { 0.4 }
                    / (1.0 + 20.0 * gap / self.shapes.height()),
            )
        };
        let found = self
            .free(guesses)
            .filter_map(|(index, shape)| Some((worth(index, shape)?, index)));
        let mut found: Vec<(f64, usize)> = found.collect();
        found.sort_by(|a, b| b.0.total_cmp(&a.0));
        let Some(&(_, mut body)) = found.first() else {
            return false;
        };
        // The half of a jacket with its sleeve is beside the shirt that it lies on, and larger than what is seen of that.
        let aside = |shape: &Shape| (shape.middle().x - head.middle().x).abs() / shape.size().x;
        if let Some(largest) = self.shapes.get(body).filter(|half| aside(half) > HALF) {
            let is_middle = |shape: &Shape| {
                aside(shape) <= MIDDLE
                    && shape.islands.len() == 1
                    && shape.cells >= SHIRT * largest.cells
                    && shape.mask.touches(&largest.mask)
            };
            let shape = |index: usize| self.shapes.get(index);
            let middle = found.iter().map(|(_, index)| *index);
            let mut middle = middle.filter(|index| shape(*index).is_some_and(is_middle));
            body = middle.next().unwrap_or(body);
        }
        let why = "it is the largest shape below the head";
        guesses.add(body, Noun::Body, Certainty::Certain, why);
        true
    }

    /// Whether something reaches down to the ground.
    pub(super) fn stands(&self, bounds: Box2) -> bool {
        bounds.high.y >= self.shapes.bounds.high.y - STANDS * self.shapes.height()
    }

    /// Whether legs that stand on the ground are before much of a shape, as they are before a cape.
    fn is_behind_legs(&self, index: usize, shape: &Shape) -> bool {
        let later = self.shapes.iter().filter(|(other, _)| *other > index);
        let legs = later.filter(|(_, leg)| {
            let size = leg.size();
            self.stands(leg.bounds)
                && leg.bounds.low.y > self.head.bounds.high.y
                && (size.y >= size.x || leg.twins().is_some())
                && leg.on(shape) >= BEFORE
        });
        let count: usize = legs.map(|(_, leg)| leg.islands.len()).sum();
        // A bust ends on the ground, with seams and pockets before it.
        count >= 2 && !self.stands(shape.bounds)
    }

    /// What hangs behind the body from its shoulders, and is seen at both of its sides.
    fn cape(&self, guesses: &mut Guesses) {
        let Some((body_index, body)) = self.trunk(guesses) else {
            return;
        };
        let is_cape = |index: usize, shape: &Shape| {
            let shoulders = body.bounds.low.y + 0.35 * body.size().y;
            index < body_index
                && shape.islands.len() == 1
                && shape.bounds.low.x < body.bounds.low.x
                && shape.bounds.high.x > body.bounds.high.x
                && shape.bounds.low.y <= shoulders
                && shape.bounds.low.y >= self.head.middle().y
                && shape.size().y >= CAPE * body.size().y
                && body.on(shape) >= BEHIND
                && shape.on(body) <= COVERED
        };
        let found = self.free(guesses).filter(|one| is_cape(one.0, one.1));
        let found = found.max_by(|a, b| a.1.cells.total_cmp(&b.1.cells));
        if let Some((cape, _)) = found {
            let why = "it is behind the body, and seen at both of its sides";
            guesses.add(cape, Noun::Cape, Certainty::Likely, why);
        }
    }

    /// The body, which has been found.
    pub(super) fn trunk(&self, guesses: &Guesses) -> Option<(usize, &'a Shape)> {
        let body = guesses.find(Noun::Body)?;
        Some((body, self.shapes.get(body)?))
    }
}
