//! The largest discs that touch the border of an outline from inside (shrinking ball: Ma, Bae & Choi, "3D medial axis point
//! approximation using nearest neighbors and the normal field", 2012).

use glam::DVec2;

use crate::budget::{self, Step};
use crate::geometry::{Outline, bounds, edges};

/// A disc counts as inside the outline if the border comes no closer to its centre than this, relative
/// to its radius: flattened curves cut off that little.
const SLACK: f64 = 0.9;
/// The largest number of iterations for a disc; a handful is usual.
const MAX_ITERATIONS: usize = 24;
/// How many consecutive edges are in a box of the lowest level.
const RUN: usize = 16;
/// How many consecutive boxes of a level are in one of the next.
const FAN: usize = 4;
/// Fewer edges stay in the order of their rings.
const MANY: usize = 4 * RUN * FAN;

/// A disc in an outline.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Disc {
    /// 0 where there is none.
    pub(super) radius: f64,
    /// Where else it touches the border, if anywhere.
    opposite: Option<DVec2>,
}

/// The edges of an outline, and boxes around runs of them. Edges that follow each other are near each other, so that the boxes are small:
/// if there are few, neighbours on a ring, and otherwise along a curve through all of the outline's box, because rings in rings, and
/// turns of a spiral, are near to each other over all of their length.
pub(super) struct Discs {
    edges: Vec<Edge>,
    /// From the boxes around [`RUN`] edges to the one around all.
    levels: Vec<Vec<Bounds>>,
    /// The radius to begin with.
    reach: f64,
}

#[derive(Clone, Copy)]
struct Edge {
    from: DVec2,
    along: DVec2,
    /// The inverse of the squared length.
    inverse: f64,
    /// Its place among those of the outline.
    number: u32,
}

#[derive(Clone, Copy)]
struct Bounds {
    low: DVec2,
    high: DVec2,
}

impl Bounds {
    fn around(bounds: impl Iterator<Item = Bounds>) -> Bounds {
        let nothing = Bounds {
            low: DVec2::INFINITY,
            high: DVec2::NEG_INFINITY,
        };
        bounds.fold(nothing, |all, one| Bounds {
            low: all.low.min(one.low),
            high: all.high.max(one.high),
        })
    }

    fn distance_squared(&self, point: DVec2) -> f64 {
        let outside = (self.low - point).max(point - self.high);
        outside.max(DVec2::ZERO).length_squared()
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
    pub(super) fn of(outline: &Outline, reach: f64) -> Self {
        let edges = edges(outline).zip(0..).map(|([from, to], number)| Edge {
            from,
            along: to - from,
            inverse: from.distance_squared(to).max(f64::MIN_POSITIVE).recip(),
            number,
        });
        let mut edges: Vec<Edge> = edges.collect();
        if edges.len() > MANY {
            let all = bounds(outline).unwrap_or_default();
            edges.sort_by_cached_key(|edge| place_on_curve(edge.from + 0.5 * edge.along, all));
        }
        let of_edge = |edge: &Edge| {
            let to = edge.from + edge.along;
            Bounds {
                low: edge.from.min(to),
                high: edge.from.max(to),
            }
        };
        let runs = edges.chunks(RUN);
        let mut level: Vec<Bounds> = runs
            .map(|run| Bounds::around(run.iter().map(of_edge)))
            .collect();
        let mut levels = Vec::new();
        while level.len() > 1 {
            let fans = level.chunks(FAN);
            let next = fans.map(|fan| Bounds::around(fan.iter().copied()));
            let next = next.collect();
            levels.push(std::mem::replace(&mut level, next));
        }
        levels.push(level);
        Self {
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
            radius: self.reach,
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
            let middle = foot + disc.radius * inward;
            let mut nearest = Nearest {
                at: foot,
                distance_squared: disc.radius * disc.radius,
                // No edge at this distance is nearer.
                edge: 0,
            };
            self.search(self.levels.len() - 1, 0, middle, &mut nearest);
            let distance = nearest.distance_squared.sqrt();
            if distance >= SLACK * disc.radius {
                disc.radius = disc.radius.min(distance);
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
            let distance_squared = bounds.distance_squared(point);
            if distance_squared <= nearest.distance_squared {
                fan[count] = (distance_squared, start + child);
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
