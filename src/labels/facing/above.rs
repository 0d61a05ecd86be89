//! Animals that are drawn from above: beetles, spiders and others whose legs spread to both sides.

use super::{Bounds, Observed, middle, width};
use crate::anatomy;
use crate::labels::segments::Limb;
use crate::labels::{Class, Facing, FigurePartId};

/// So many legs are on each side, at least.
const FEWEST: usize = 3;
/// A leg points ahead or back if its tip is so far before or behind its joint, as a share of its length.
const POINTS: f64 = 0.15;
/// Feet are spread if they are apart by at least this share of the trunk's length.
const SPREAD: f64 = 0.5;
/// A head leads if its middle is so far ahead of the trunk's, as a share of the trunk's length.
const LEADS: f64 = 0.35;
/// A head that is narrower than this share of the trunk's width shows no face, whatever is drawn on it.
const SMALL: f64 = 0.5;

/// A leg: where its joint and its tip are, along the way from the hind end to the head.
struct Leg {
    joint: f64,
    tip: f64,
    length: f64,
}

impl Observed<'_> {
    /// How a figure faces that is drawn from above, and why it seems to be. Its legs, three or more on each side, point ahead in front
    /// and back behind, so they do not stand on a ground that is at the drawing's bottom; and no face is turned to us, unless it is on a
    /// head at the end of a body along which the feet are spread, or a name says that it is a beetle or the like.
    pub(super) fn seen_from_above(&self) -> Option<(Facing, String)> {
        let trunk = self.trunk?;
        let facing = self.up();
        let up = if facing == Facing::UpHeadDown {
            -1.0
        } else {
            1.0
        };
        let mut sides = [Vec::new(), Vec::new()];
        for limb in self.limbs.iter().filter(|limb| limb.class == Class::Leg) {
            let (root, end) = (limb.root(), self.end_of(limb));
            let (joint, tip) = (self.tree.joint(root), self.tree.tip(end));
            let is_right = joint.midpoint(tip).x > middle(trunk).x;
            sides[usize::from(is_right)].push(Leg {
                joint: joint.y * up,
                tip: tip.y * up,
                length: joint.distance(tip),
            });
        }
        let [left, right] = &sides;
        if left.len() < FEWEST || left.len() != right.len() {
            return None;
        }
        let mut names = self.tree.order.iter().map(|part| self.tree.name(*part));
        let name = names.find(|name| anatomy::is_crawler(name));
        let points = |legs: &[Leg], way: f64| {
            let mut legs = legs.iter();
            legs.any(|leg| (leg.tip - leg.joint) * way > POINTS * leg.length)
        };
        let point_both_ways = sides
            .iter()
            .all(|legs| points(legs, 1.0) && points(legs, -1.0));
        let spread = sides.iter().all(|legs| is_spread(legs, trunk, up));
        let leads = self.head.is_some_and(|head| {
            let ahead = (middle(head).y - middle(trunk).y) * up;
            ahead > LEADS * (trunk[1].y - trunk[0].y)
        });
        let count = 2 * left.len();
        let why = match name {
            Some(name) if point_both_ways || spread => {
                format!("`{name}` is drawn from above: its {count} legs spread to both sides")
            }
            None if point_both_ways && (spread && leads || !self.shows_face(trunk)) => {
                format!("its {count} legs point ahead and back at both sides, as seen from above")
            }
            _ => return None,
        };
        Some((facing, why))
    }

    /// How a figure faces that is known to be drawn from above: by where its head or its face is.
    pub(super) fn up(&self) -> Facing {
        let face = self.head.map(middle).or(self.middle_of_face());
        let is_below = face
            .zip(self.trunk)
            .is_some_and(|(face, trunk)| face.y < middle(trunk).y);
        if is_below {
            Facing::UpHeadDown
        } else {
            Facing::Up
        }
    }

    /// Whether a face with two eyes is turned to us, and not only a small head at the end of a body drawn with both.
    fn shows_face(&self, trunk: Bounds) -> bool {
        let is_small = |head: Bounds| width(head) < SMALL * width(trunk);
        self.two_eyes().is_some() && !self.head.is_some_and(is_small)
    }

    /// The last part of a limb.
    fn end_of(&self, limb: &Limb) -> FigurePartId {
        let deepest = limb.parts.iter().max_by_key(|(_, depth)| *depth);
        deepest.map_or(limb.root(), |(part, _)| *part)
    }
}

/// Whether feet are spread over the length of a trunk, and not all at its hind end.
fn is_spread(legs: &[Leg], [low, high]: Bounds, up: f64) -> bool {
    let tips = legs.iter().map(|leg| leg.tip);
    let [last, first] = tips.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], tip| {
        [low.min(tip), high.max(tip)]
    });
    first - last > SPREAD * (high.y - low.y) && first > low.midpoint(high).y * up
}
