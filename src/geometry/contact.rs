//! Which areas touch each other.

use std::cell::OnceCell;

use glam::DVec2;

use super::query::edge_distance_squared;
use super::{BoxTree, Outline, area_around, contains, edges, indexed_box};

/// How many edges are looked at to find areas that touch, once for each other edge near them. After that, bounding boxes decide.
const MAX_STEPS: usize = 1 << 26;

/// How many others are looked for that an area touches. It has more where others with fewer touch it; a heap of shapes is not a figure.
const MAX_TOUCHED: usize = 64;

/// An area of one or more outlines.
pub(crate) struct Body<'a> {
    /// The outlines.
    pub(crate) outlines: Vec<&'a Outline>,
    /// The lower and the upper corner of their bounding box.
    pub(crate) bounds: (DVec2, DVec2),
    /// How far from others it may be and still touches them; of two the larger one counts.
    pub(crate) slack: f64,
}

/// Per body the others that it touches, in ascending order.
pub(crate) fn touching(bodies: &[Body<'_>]) -> Vec<Vec<usize>> {
    let boxes = bodies.iter().enumerate();
    let boxes = boxes.map(|(index, body)| indexed_box(body.bounds, index));
    let boxes = BoxTree::bulk_load(boxes.collect());
    let sorted: Vec<Sorted<'_>> = bodies.iter().map(Sorted::new).collect();
    let mut left = MAX_STEPS;
    let mut near = |index: usize| -> Vec<usize> {
        let own = &bodies[index];
        let reach = area_around(own.bounds, own.slack);
        let found = boxes.locate_in_envelope_intersecting(reach);
        let others = found.map(|found| found.data);
        // The larger slack counts for both, so that each pair is compared from that side only.
        let is_other_side = |other: usize| {
            let slack = bodies[other].slack;
            slack > own.slack || (slack == own.slack && other <= index)
        };
        let others = others.filter(|other| {
            !is_other_side(*other)
                && are_near(&sorted[index], &sorted[*other], own.slack, &mut left)
        });
        let mut others: Vec<usize> = others.take(MAX_TOUCHED).collect();
        others.sort_unstable();
        others
    };
    let mut all: Vec<Vec<usize>> = (0..bodies.len()).map(&mut near).collect();
    for index in 0..bodies.len() {
        for other in all[index].clone() {
            if let Err(place) = all[other].binary_search(&index) {
                all[other].insert(place, index);
            }
        }
    }
    all
}

/// The connected groups among what has these neighbours, in the order of their first members; the members are in ascending order.
pub(crate) fn connected(neighbors: &[Vec<usize>]) -> Vec<Vec<usize>> {
    let mut taken = vec![false; neighbors.len()];
    let mut groups = Vec::new();
    for first in 0..neighbors.len() {
        if std::mem::replace(&mut taken[first], true) {
            continue;
        }
        let mut members = vec![first];
        let mut next = 0;
        while let Some(&at) = members.get(next) {
            next += 1;
            for &other in &neighbors[at] {
                if !std::mem::replace(&mut taken[other], true) {
                    members.push(other);
                }
            }
        }
        members.sort_unstable();
        groups.push(members);
    }
    groups
}

/// A body whose edges are sorted when they are first needed.
struct Sorted<'a> {
    body: &'a Body<'a>,
    edges: OnceCell<Vec<Edge>>,
}

/// An edge with its bounding box.
#[derive(Clone, Copy)]
struct Edge {
    ends: [DVec2; 2],
    low: DVec2,
    high: DVec2,
}

impl<'a> Sorted<'a> {
    fn new(body: &'a Body<'a>) -> Self {
        Self {
            body,
            edges: OnceCell::new(),
        }
    }

    /// The edges by the left sides of their boxes.
    fn edges(&self) -> &[Edge] {
        self.edges.get_or_init(|| {
            let edges = self.body.outlines.iter().flat_map(|outline| edges(outline));
            let edges = edges.map(|[from, to]| Edge {
                ends: [from, to],
                low: from.min(to),
                high: from.max(to),
            });
            let mut edges: Vec<Edge> = edges.collect();
            edges.sort_unstable_by(|a, b| a.low.x.total_cmp(&b.low.x));
            edges
        })
    }

    /// Those of the edges that reach into a box.
    fn edges_in(&self, (low, high): (DVec2, DVec2)) -> Vec<Edge> {
        let is_in = |edge: &&Edge| edge.high.cmpge(low).all() && edge.low.cmple(high).all();
        self.edges().iter().filter(is_in).copied().collect()
    }

    /// Whether it holds a ring of another body whose borders are apart from its own; also if no steps are left before that is clear.
    fn holds(&self, other: &Self, left: &mut usize) -> bool {
        let (low, high) = self.body.bounds;
        let outlines = &other.body.outlines;
        let rings = outlines.iter().flat_map(|outline| outline.rings());
        let points = rings.filter_map(|ring| ring.first());
        let mut points = points.filter(|point| point.clamp(low, high) == **point);
        let edges = self.edges().len();
        points.any(|point| {
            let mut outlines = self.body.outlines.iter();
            !spend(left, edges) || outlines.any(|outline| contains(outline, *point))
        })
    }
}

/// Takes steps, and tells whether any are left.
fn spend(left: &mut usize, steps: usize) -> bool {
    *left = left.saturating_sub(steps);
    *left > 0
}

/// Whether the distance between two bodies is at most `gap`; `true` if no steps are left before that is clear.
fn are_near(a: &Sorted<'_>, b: &Sorted<'_>, gap: f64, left: &mut usize) -> bool {
    if a.holds(b, left) || b.holds(a, left) {
        return true;
    }
    let around = |body: &Body<'_>| (body.bounds.0 - gap, body.bounds.1 + gap);
    let (near_a, near_b) = (a.edges_in(around(b.body)), b.edges_in(around(a.body)));
    let mut is_near = !spend(left, a.edges().len() + b.edges().len());
    // Sweep and prune: each pair is met at the edge that begins farther left.
    let mut sweep = |these: &[Edge], those: &[Edge]| {
        let mut first = 0;
        for edge in these {
            let begun = those[first..].iter();
            first += begun.take_while(|other| other.low.x < edge.low.x).count();
            let mut others = those[first..].iter();
            while !is_near
                && let Some(other) = others.next()
                && other.low.x <= edge.high.x + gap
            {
                is_near = edge.is_near(other, gap) || !spend(left, 1);
            }
        }
    };
    sweep(&near_a, &near_b);
    sweep(&near_b, &near_a);
    is_near
}

impl Edge {
    /// Whether an edge is no farther than `gap` from another one, or crosses it: of two bars in the form of a plus, no corners are near
    /// each other.
    fn is_near(&self, other: &Self, gap: f64) -> bool {
        if other.low.y > self.high.y + gap || self.low.y > other.high.y + gap {
            return false;
        }
        let reaches = |edge: &Self, points: [DVec2; 2]| {
            let square = |point| edge_distance_squared(edge.ends, point);
            points.into_iter().any(|point| square(point) <= gap * gap)
        };
        let parts = |[from, to]: [DVec2; 2], [start, end]: [DVec2; 2]| {
            let side = |point: DVec2| (to - from).perp_dot(point - from);
            side(start) * side(end) < 0.0
        };
        reaches(self, other.ends)
            || reaches(other, self.ends)
            || (parts(self.ends, other.ends) && parts(other.ends, self.ends))
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::super::{FillRule, distance_squared, resolve_overlaps};
    use super::*;

    fn rectangle(low: [f64; 2], high: [f64; 2]) -> Outline {
        let ring = vec![
            DVec2::from(low),
            DVec2::new(high[0], low[1]),
            DVec2::from(high),
            DVec2::new(low[0], high[1]),
        ];
        resolve_overlaps(vec![ring], FillRule::NonZero)
    }

    #[test]
    fn bodies_touch_within_the_larger_slack() {
        let outlines = [
            rectangle([0.0, 0.0], [10.0, 10.0]),
            rectangle([11.0, 0.0], [20.0, 10.0]),
            rectangle([23.0, 0.0], [30.0, 10.0]),
            // A bar through the first two, with no corner near them.
            rectangle([-50.0, 4.0], [21.0, 6.0]),
            // In the first one.
            rectangle([2.0, 7.0], [3.0, 8.0]),
        ];
        let slack = [1.5, 0.0, 0.0, 0.0, 0.0];
        let bodies: Vec<Body<'_>> = outlines
            .iter()
            .zip(slack)
            .map(|(outline, slack)| Body {
                outlines: vec![outline],
                bounds: super::super::bounds(outline).unwrap(),
                slack,
            })
            .collect();
        assert_eq!(
            touching(&bodies),
            [vec![1, 3, 4], vec![0, 3], vec![], vec![0, 1], vec![0]]
        );
        assert_eq!(connected(&touching(&bodies)), [vec![0, 1, 3, 4], vec![2]]);
    }

    /// Whether bodies are near, by all their points and edges.
    fn are_near_by_all(a: &Body<'_>, b: &Body<'_>, gap: f64) -> bool {
        let reaches = |from: &Body<'_>, to: &Body<'_>| {
            let mut points = from
                .outlines
                .iter()
                .flat_map(|outline| outline.rings())
                .flatten();
            points.any(|point| {
                let mut outlines = to.outlines.iter();
                outlines.any(|outline| distance_squared(outline, *point) <= gap * gap)
            })
        };
        let cross = || {
            let of = |body: &Body<'_>| -> Vec<[DVec2; 2]> {
                body.outlines
                    .iter()
                    .flat_map(|outline| edges(outline))
                    .collect()
            };
            let (of_a, of_b) = (of(a), of(b));
            of_a.iter().any(|[from, to]| {
                of_b.iter().any(|[start, end]| {
                    let side = |point: DVec2| (*to - *from).perp_dot(point - *from);
                    let other = |point: DVec2| (*end - *start).perp_dot(point - *start);
                    side(*start) * side(*end) < 0.0 && other(*from) * other(*to) < 0.0
                })
            })
        };
        reaches(a, b) || reaches(b, a) || cross()
    }

    proptest! {
        #[test]
        fn bodies_touch_if_any_points_or_edges_do(
            drawn in prop::collection::vec(
                (prop::collection::vec(prop::collection::vec((0..30_u32, 0..30_u32), 3..8), 1..3), 0..4_u32),
                2..7,
            ),
        ) {
            let ring = |points: &Vec<(u32, u32)>| -> Vec<DVec2> {
                points.iter().map(|(x, y)| DVec2::new(f64::from(*x), f64::from(*y))).collect()
            };
            let outlines: Vec<(Vec<Outline>, f64)> = drawn
                .iter()
                .map(|(rings, slack)| {
                    let outlines = rings.iter().map(|points| resolve_overlaps(vec![ring(points)], FillRule::EvenOdd));
                    let outlines = outlines.filter(|outline| super::super::bounds(outline).is_some());
                    // No distance between points and lines of whole numbers is near these.
                    (outlines.collect(), f64::from(*slack) * 0.613)
                })
                .filter(|(outlines, _): &(Vec<Outline>, f64)| !outlines.is_empty())
                .collect();
            let bodies: Vec<Body<'_>> = outlines
                .iter()
                .map(|(outlines, slack)| {
                    let boxes = outlines.iter().filter_map(super::super::bounds);
                    let bounds = boxes.reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)));
                    Body { outlines: outlines.iter().collect(), bounds: bounds.unwrap(), slack: *slack }
                })
                .collect();
            for (index, near) in touching(&bodies).into_iter().enumerate() {
                let expected = (0..bodies.len()).filter(|other| {
                    let gap = bodies[index].slack.max(bodies[*other].slack);
                    *other != index && are_near_by_all(&bodies[index], &bodies[*other], gap)
                });
                prop_assert_eq!(near, expected.collect::<Vec<_>>());
            }
        }
    }
}
