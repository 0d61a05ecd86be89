//! Names the limbs of a figure that is drawn from the front, of which two are one shape, and the hands of a bust.

use super::mask::Box2;
use super::people::{Around, BUST};
use super::shapes::Shape;
use super::{Certainty, Guesses};
use crate::anatomy::Noun;
use crate::labels::Side;

/// What begins at most this share of the body's height above its end is below it.
const BELOW: f64 = 0.15;
/// Shoes are at most this share of the figure high.
const SHOE: f64 = 0.16;
/// The middles of arms are at least this share of the body's width apart, and those of a pair mirror each other within that share.
const APART: f64 = 0.5;
const MIRRORED: f64 = 0.25;
/// Both arms are at least this share of the body, and at most.
const ARMS: std::ops::RangeInclusive<f64> = 0.08..=1.0;
/// Thighs begin below this share of the body's height.
const SQUAT: f64 = 0.6;
/// Raised arms lie on the body by at least this share, and on the head by at most this share.
const BRUSHES: f64 = 0.1;
/// A hand is at least this share of the head, and at most.
const HANDS: std::ops::RangeInclusive<f64> = 0.05..=0.5;
/// Hands have the colour of the head, within this distance.
const ALIKE: f64 = 40.0;
/// A hand by itself is at most this much longer than wide, or the other way round; what is longer is a bare arm.
const COMPACT: f64 = 1.9;

/// A shape of two pieces, the left one first.
struct Pair<'a> {
    index: usize,
    shape: &'a Shape,
    pieces: [Box2; 2],
    /// Whether they are legs that hang together.
    is_one: bool,
}

impl Pair<'_> {
    fn top(&self) -> f64 {
        self.pieces[0].low.y.min(self.pieces[1].low.y)
    }

    fn is_long(&self) -> bool {
        let mut sizes = self.pieces.iter().map(|piece| piece.size());
        sizes.all(|size| size.y >= 0.9 * size.x)
    }
}

/// The pairs beside a body.
struct Pairs<'a> {
    around: &'a Around<'a>,
    body: &'a Shape,
    all: Vec<Pair<'a>>,
    /// The shapes of the pairs that are low and stand on the ground.
    shoes: Vec<&'a Shape>,
}

impl<'a> Pairs<'a> {
    fn find(around: &'a Around<'a>, body: &'a Shape, guesses: &Guesses) -> Self {
        let all = around.free(guesses).filter_map(|(index, shape)| {
            let twins = shape.twins().map(|twins| twins.map(|twin| twin.bounds));
            Some(Pair {
                index,
                shape,
                pieces: twins.or_else(|| shape.legs())?,
                is_one: twins.is_none(),
            })
        });
        let mut pairs = Self {
            around,
            body,
            all: all.collect(),
            shoes: Vec::new(),
        };
        let shoes = pairs.all.iter().filter(|pair| {
            pairs.is_on_ground(pair) && pairs.is_low(pair) && pairs.is_below_body(pair)
        });
        pairs.shoes = shoes.map(|pair| pair.shape).collect();
        pairs
    }

    fn is_on_ground(&self, pair: &Pair<'_>) -> bool {
        pair.pieces.iter().any(|piece| self.around.stands(*piece))
    }

    fn is_low(&self, pair: &Pair<'_>) -> bool {
        pair.shape.size().y <= SHOE * self.around.shapes.height()
    }

    /// Whether a pair is below the body, or trousers into which that is tucked, or over which it hangs.
    fn is_below_body(&self, pair: &Pair<'_>) -> bool {
        let top = if pair.is_one {
            pair.shape.middle().y
        } else {
            pair.top()
        };
        top >= self.body.bounds.high.y - BELOW * self.body.size().y
    }

    /// Whether a pair stands on the ground, or in shoes.
    fn stands(&self, pair: &Pair<'_>) -> bool {
        let mut shoes = self.shoes.iter();
        self.is_on_ground(pair) || shoes.any(|shoes| pair.shape.mask.touches(&shoes.mask))
    }

    /// Whether one piece is on either side of the head's middle, as far from it as the other.
    fn is_mirrored(&self, pair: &Pair<'_>) -> bool {
        let axis = self.around.head.middle().x;
        let [left, right] = pair.pieces.map(|piece| piece.middle().x);
        let off = (left + right - 2.0 * axis).abs();
        off <= MIRRORED * self.body.size().x && left < axis && right > axis
    }

    /// Whether a pair is where limbs are: below the head's middle, or arms that are raised beside it.
    fn is_at_limbs(&self, pair: &Pair<'_>) -> bool {
        let head = self.around.head;
        let [left, right] = pair.pieces.map(|piece| piece.high.y);
        let is_beside_head = || {
            pair.shape.on(head) <= BRUSHES
                && pair.shape.on(self.body) >= BRUSHES
                && left.min(right) > head.middle().y
        };
        pair.top() >= head.middle().y || is_beside_head() || self.around.is_whole()
    }

    /// Whether a pair is the thighs of somebody who squats: they are at both sides of the body, as arms are, and lead on to legs.
    fn are_thighs(&self, pair: &Pair<'_>) -> bool {
        let squats = self.body.bounds.low.y + SQUAT * self.body.size().y;
        let leads_to = |legs: &Pair<'_>| {
            legs.index != pair.index
                && self.stands(legs)
                && legs.shape.bounds.low.y > pair.shape.middle().y
                && legs.shape.mask.touches(&pair.shape.mask)
        };
        pair.top() > squats && self.all.iter().any(leads_to)
    }

    fn may_be_arms(&self, pair: &Pair<'_>) -> bool {
        let [left, right] = pair.pieces.map(|piece| piece.middle().x);
        right - left >= APART * self.body.size().x
            && pair.is_long()
            && ARMS.contains(&(pair.shape.cells / self.body.cells))
            && !self.is_below_body(pair)
            && !self.are_thighs(pair)
    }

    /// Whether both pieces, left and right of the head's middle, are hands.
    fn are_hands(&self, pair: &Pair<'_>) -> bool {
        let head = self.around.head;
        let axis = head.middle().x;
        let is_compact =
            |one: &Box2| one.size().max_element() <= COMPACT * one.size().min_element();
        let [left, right] = pair.pieces.map(|piece| piece.middle().x);
        HANDS.contains(&(pair.shape.cells / 2.0 / head.cells))
            && pair.shape.distance_of_colors(head) <= ALIKE
            && pair.pieces.iter().all(is_compact)
            && left < axis
            && right > axis
    }
}

impl Around<'_> {
    /// Arms, legs and shoes of which two are one shape; what is single is found by the labels of motion.
    pub(super) fn limbs(&self, guesses: &mut Guesses) {
        let Some((_, body)) = self.trunk(guesses) else {
            return;
        };
        let pairs = Pairs::find(self, body, guesses);
        let (mut found, mut arms) = (Vec::new(), Vec::new());
        for pair in &pairs.all {
            let stands = pairs.stands(pair);
            if pair.is_one && !(stands && pairs.is_below_body(pair) && !pairs.is_low(pair)) {
                continue;
            }
            if !stands && pairs.are_hands(pair) {
                let why = "they are two in the colour of the head, and lie apart from it";
                found.push((pair.index, Noun::Hands, why));
                continue;
            }
            if !pairs.is_mirrored(pair) || !pairs.is_at_limbs(pair) {
                continue;
            }
            if stands && pairs.is_below_body(pair) {
                found.push(if !pairs.is_low(pair) && pair.is_long() {
                    let why = "they are two, and stand on the ground below the body";
                    (pair.index, Noun::Legs, why)
                } else {
                    (
                        pair.index,
                        Noun::Shoes,
                        "they are two, and lie on the ground",
                    )
                });
            } else if pairs.may_be_arms(pair) {
                // Lapels come nearer to each other than sleeves.
                let apart = (pair.pieces[1].low.x - pair.pieces[0].high.x).max(0.0);
                arms.push((apart * pair.shape.cells, pair.index));
            }
        }
        // Sleeves, cuffs and collars are pairs, too.
        if let Some((_, index)) = arms.into_iter().max_by(|a, b| a.0.total_cmp(&b.0)) {
            let why = "they are two of one size, at both sides of the body";
            found.push((index, Noun::Arms, why));
        }
        for (index, noun, why) in found {
            guesses.add(index, noun, Certainty::Likely, why);
        }
    }

    /// Of a bust, what has the colour of the head and lies apart from it.
    pub(super) fn hands(&self, guesses: &mut Guesses) {
        let body = self.trunk(guesses).map(|(_, body)| body);
        let ground = self.shapes.bounds.high.y - 0.05 * self.shapes.height();
        if body.is_none_or(|body| body.bounds.high.y < ground || body.mask.foot() < BUST) {
            return;
        }
        let middle = self.head.middle().x;
        let is_hand = |shape: &Shape| {
            shape.islands.len() == 1
                && HANDS.contains(&(shape.cells / self.head.cells))
                && shape.distance_of_colors(self.head) <= ALIKE
                && shape.bounds.low.y > self.head.bounds.high.y - 0.2 * self.head.size().y
                && (shape.middle().x - middle).abs() >= 0.4 * self.head.size().x
        };
        let hands = self.free(guesses).filter(|(_, shape)| is_hand(shape));
        let hands: Vec<(usize, Side)> = hands
            .map(|(index, shape)| {
                let is_left = shape.middle().x > middle;
                (index, if is_left { Side::Left } else { Side::Right })
            })
            .collect();
        let why = "it has the colour of the head, and lies apart from it";
        for (index, side) in hands {
            guesses.add_sided(index, Noun::Hand, Some(side), Certainty::Uncertain, why);
        }
    }
}
