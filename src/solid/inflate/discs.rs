//! The largest discs that touch the border of a polygon from inside (shrinking ball: Ma, Bae & Choi, "3D medial axis point
//! approximation using nearest neighbors and the normal field", 2012).

use glam::DVec2;

use crate::budget::{self, Step};
use crate::geometry::{Ring, bounds_of, edges_of};

/// A disc counts as inside the polygon if the border comes no closer to its centre than this, relative
/// to its radius: flattened curves cut off that little.
const SLACK: f64 = 0.9;
/// The largest number of iterations for a disc; a handful is usual.
const MAX_ITERATIONS: usize = 24;
/// How many consecutive edges are in a box of the lowest level.
const RUN: usize = 16;
/// How many consecutive boxes of a level are in one of the next.
const FAN: usize = 4;
/// Slanted boxes are used where they have at most this share of the area of upright ones.
const SLANTED: f64 = 0.3;
/// How far coordinates in a slanted frame may be off, relative to the largest.
const ROUNDING: f64 = 1e-12;
/// More edges than this are a crowd: discs are grown before they are shrunk.
const CROWD: usize = 1 << 13;
/// The factor by which they are grown.
const GROWTH: f64 = 4.0;
/// Fewer edges stay in the order of their rings.
const MANY: usize = 4 * RUN * FAN;

/// A disc in a polygon.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Disc {
    /// 0 where there is none.
    pub(super) radius: f64,
    /// Where else it touches the border, if anywhere.
    opposite: Option<DVec2>,
}

/// The edges of a polygon, and boxes around runs of them. Edges that follow each other are near each other, so that the boxes are small:
/// if there are few, neighbours on a ring, and otherwise along a curve through all of the polygon's box, because rings in rings, and
/// turns of a spiral, are near to each other over all of their length.
pub(super) struct Discs {
    edges: Vec<Edge>,
    /// From the boxes around [`RUN`] edges to the one around all.
    levels: Vec<Vec<Bounds>>,
    /// The radius to begin with.
    reach: f64,
    /// The radius from which larger ones are tried, in a crowd of edges: the middle of a disc that is far too large is about as far from
    /// very many of them.
    least: Option<f64>,
}

#[derive(Clone, Copy)]
struct Edge {
    from: DVec2,
    along: DVec2,
    /// The inverse of the squared length.
    inverse: f64,
    /// Its place among those of the polygon.
    number: u32,
}

/// What is around some edges.
#[derive(Clone, Copy)]
struct Bounds {
    upright: Rectangle,
    /// Along the edges, if that is much smaller: slanted needles beside each other have the same upright box.
    slanted: Option<Slanted>,
}

#[derive(Clone, Copy)]
struct Rectangle {
    low: DVec2,
    high: DVec2,
}

/// A rectangle in a frame of its own.
#[derive(Clone, Copy)]
struct Slanted {
    /// The direction of its x, a unit vector.
    along: DVec2,
    rectangle: Rectangle,
}

impl Rectangle {
    fn around(points: impl Iterator<Item = DVec2>) -> Self {
        let (low, high) = bounds_of(points).unwrap_or((DVec2::INFINITY, DVec2::NEG_INFINITY));
        Self { low, high }
    }

    fn distance_squared(&self, point: DVec2) -> f64 {
        let outside = (self.low - point).max(point - self.high);
        outside.max(DVec2::ZERO).length_squared()
    }

    fn area(&self) -> f64 {
        (self.high - self.low).element_product()
    }
}

impl Bounds {
    /// The bounds of edges, upright ones only if there are few.
    fn around(edges: &[Edge], are_many: bool) -> Self {
        let ends = || {
            let ends = edges.iter().map(|edge| [edge.from, edge.from + edge.along]);
            ends.flatten()
        };
        let upright = Rectangle::around(ends());
        let slanted = || {
            let length = |edge: &&Edge| edge.along.length_squared();
            let longest = edges
                .iter()
                .max_by(|a, b| length(a).total_cmp(&length(b)))?
                .along;
            let ways = edges
                .iter()
                .map(|edge| edge.along * edge.along.dot(longest).signum());
            let along = ways.sum::<DVec2>().try_normalize()?;
            let frame = conjugate(along);
            let turned = Rectangle::around(ends().map(|end| frame.rotate(end)));
            // Rounding must not let the box seem farther away than what is in it.
            let room = ROUNDING * turned.low.abs().max(turned.high.abs()).max_element();
            let rectangle = Rectangle {
                low: turned.low - room,
                high: turned.high + room,
            };
            (rectangle.area() < SLANTED * upright.area()).then_some(Slanted { along, rectangle })
        };
        Self {
            upright,
            slanted: if are_many { slanted() } else { None },
        }
    }

    /// The square of a distance that they are from a point at least, unless it is greater than that.
    fn distance_squared(&self, point: DVec2, most: f64) -> Option<f64> {
        let distance_squared = self.upright.distance_squared(point);
        if distance_squared > most {
            return None;
        }
        let Some(Slanted { along, rectangle }) = &self.slanted else {
            return Some(distance_squared);
        };
        let slanted = rectangle.distance_squared(conjugate(*along).rotate(point));
        (slanted <= most).then_some(distance_squared.max(slanted))
    }
}

impl Edge {
    fn nearest(&self, point: DVec2) -> DVec2 {
        let share = (point - self.from).dot(self.along) * self.inverse;
        self.from + self.along * share.clamp(0.0, 1.0)
    }
}

/// The nearest point found so far.
struct Nearest {
    at: DVec2,
    distance_squared: f64,
    /// The edge that it is on. Of several at the same distance, the first one counts, in whatever order they are found.
    edge: u32,
}

impl Discs {
    /// Those of one polygon, whose rings these are.
    pub(super) fn of(rings: &[Ring]) -> Self {
        let (low, high) = bounds_of(rings.iter().flatten().copied()).unwrap_or_default();
        let reach = low.distance(high);
        let edges = edges_of(rings).zip(0..).map(|([from, to], number)| Edge {
            from,
            along: to - from,
            inverse: from.distance_squared(to).max(f64::MIN_POSITIVE).recip(),
            number,
        });
        let mut edges: Vec<Edge> = edges.collect();
        if edges.len() > MANY {
            let all = (low, high);
            edges.sort_by_cached_key(|edge| place_on_curve(edge.from + 0.5 * edge.along, all));
        }
        let are_many = edges.len() > MANY;
        let mut levels: Vec<Vec<Bounds>> = Vec::new();
        let mut size = RUN;
        while levels.last().is_none_or(|level| level.len() > 1) {
            let runs = edges.chunks(size);
            let around = runs.map(|run| Bounds::around(run, are_many));
            levels.push(around.collect());
            size *= FAN;
        }
        Self {
            least: (edges.len() > CROWD).then(|| reach / edges.len() as f64),
            edges,
            levels,
            reach,
        }
    }

    /// The largest disc that touches the border at `foot`. That of a neighbour shows about how large it can be.
    pub(super) fn disc(&self, foot: DVec2, inward: DVec2, neighbor: Disc) -> Disc {
        // The disc through a point of the border is an upper limit.
        let through = |point: DVec2| {
            let to = point - foot;
            to.length_squared() / (2.0 * inward.dot(to))
        };
        let mut disc = Disc {
            radius: self.first_radius(foot, inward, neighbor),
            opposite: None,
        };
        if let Some(opposite) = neighbor.opposite {
            let radius = through(opposite);
            // Near the foot, flattening shrinks the disc.
            let is_far = opposite.distance(foot) > neighbor.radius;
            if is_far && radius > 0.0 && radius < disc.radius {
                disc = Disc {
                    radius,
                    opposite: Some(opposite),
                };
            }
        }
        for _ in 0..MAX_ITERATIONS {
            let nearest = self.nearest(foot, inward, disc.radius);
            let distance = nearest.distance_squared.sqrt();
            if distance >= SLACK * disc.radius {
                if self.least.is_none() {
                    disc.radius = disc.radius.min(distance);
                }
                return disc;
            }
            let smaller = through(nearest.at);
            if !(smaller > 0.0 && smaller < disc.radius) {
                break;
            }
            disc = Disc {
                radius: smaller,
                opposite: Some(nearest.at),
            };
        }
        Disc::default()
    }

    /// How far from the middle of a disc points of the border matter: in a crowd only those that the disc must not have in it, because
    /// very many may lie about as far away as its border.
    fn limit(&self, radius: f64) -> f64 {
        if self.least.is_some() {
            SLACK * radius
        } else {
            radius
        }
    }

    /// The radius to begin with, which is no smaller than that of the disc.
    fn first_radius(&self, foot: DVec2, inward: DVec2, neighbor: Disc) -> f64 {
        let Some(least) = self.least else {
            return self.reach;
        };
        let mut radius = least.max(neighbor.radius);
        while radius < self.reach {
            let nearest = self.nearest(foot, inward, radius);
            if nearest.distance_squared.sqrt() < SLACK * radius {
                return radius;
            }
            radius *= GROWTH;
        }
        self.reach
    }

    /// The point of the border that is nearest to the middle of the disc of a radius at a foot: the foot itself if none is nearer.
    fn nearest(&self, foot: DVec2, inward: DVec2, radius: f64) -> Nearest {
        let mut nearest = Nearest {
            at: foot,
            distance_squared: self.limit(radius).powi(2),
            // No edge at this distance is nearer.
            edge: 0,
        };
        let middle = foot + radius * inward;
        self.search(self.levels.len() - 1, 0, middle, &mut nearest);
        nearest
    }

    /// Looks for a nearer point of the border in the box of a level.
    fn search(&self, level: usize, index: usize, point: DVec2, nearest: &mut Nearest) {
        if level == 0 {
            let start = index * RUN;
            let end = self.edges.len().min(start + RUN);
            budget::count(Step::DiscEdge, end - start);
            for edge in &self.edges[start..end] {
                let at = edge.nearest(point);
                let distance_squared = at.distance_squared(point);
                if distance_squared < nearest.distance_squared
                    || (distance_squared == nearest.distance_squared && edge.number < nearest.edge)
                {
                    *nearest = Nearest {
                        at,
                        distance_squared,
                        edge: edge.number,
                    };
                }
            }
            return;
        }
        let start = index * FAN;
        let below = &self.levels[level - 1][start..];
        let mut fan = [(f64::INFINITY, 0); FAN];
        let mut count = 0;
        for (child, bounds) in below.iter().take(FAN).enumerate() {
            if let Some(far) = bounds.distance_squared(point, nearest.distance_squared) {
                fan[count] = (far, start + child);
                count += 1;
            }
        }
        // The nearest first: of the others, most are then too far away.
        fan[..count].sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
        for (distance_squared, child) in &fan[..count] {
            if *distance_squared <= nearest.distance_squared {
                self.search(level - 1, *child, point, nearest);
            }
        }
    }
}

/// Where a point is on a curve through all of a box that seldom leaves a neighbourhood (Z-order).
fn place_on_curve(point: DVec2, (low, high): (DVec2, DVec2)) -> u32 {
    let share = (point - low) / (high - low).max(DVec2::splat(f64::MIN_POSITIVE));
    let spread = |share: f64| {
        let place = (share * f64::from(u16::MAX)) as u32;
        (0..16).fold(0, |all, bit| all | (place >> bit & 1) << (2 * bit))
    };
    spread(share.x) | spread(share.y) << 1
}

/// The way back from a direction, as complex numbers have it.
fn conjugate(along: DVec2) -> DVec2 {
    DVec2::new(along.x, -along.y)
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;

    /// A star with so many tips.
    fn star(tips: usize) -> Vec<Ring> {
        let place = |i: usize| {
            let angle = TAU * i as f64 / (2 * tips) as f64;
            DVec2::from_angle(angle) * if i.is_multiple_of(2) { 10.0 } else { 6.0 }
        };
        vec![(0..2 * tips).map(place).collect()]
    }

    #[test]
    fn discs_are_free_and_large() {
        for tips in [40, 400, CROWD] {
            let rings = star(tips);
            let discs = Discs::of(&rings);
            assert_eq!(discs.least.is_some(), tips == CROWD);
            let all: Vec<[DVec2; 2]> = edges_of(&rings).collect();
            let mut disc = Disc::default();
            for [from, to] in all.iter().step_by(all.len() / 40 - 1) {
                let foot = from.lerp(*to, 0.5);
                let inward = (*to - *from).normalize().perp();
                disc = discs.disc(foot, inward, disc);
                let gap = |radius: f64| {
                    let middle = foot + radius * inward;
                    let nearest = discs.edges.iter().map(|edge| edge.nearest(middle));
                    let gaps = nearest.map(|at| at.distance(middle));
                    gaps.fold(f64::INFINITY, f64::min) / radius
                };
                assert!(
                    disc.radius > 0.0 && gap(disc.radius) >= 0.999 * SLACK,
                    "{tips}"
                );
                assert!(gap(1.3 * disc.radius) < SLACK, "{tips}: {}", disc.radius);
            }
        }
    }
}
