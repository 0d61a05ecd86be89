//! Which areas touch each other.

use glam::DVec2;

use super::{BoxTree, Outline, area_around, distance_squared, indexed_box};

/// How many distances between points and edges are computed to find areas that touch. After that, bounding boxes decide.
const MAX_DISTANCES: usize = 1 << 28;

/// With how many others an area is found to touch at most; a heap of shapes is not a figure.
const MAX_TOUCHED: usize = 256;

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
    let mut left = MAX_DISTANCES;
    let mut near = |index: usize| -> Vec<usize> {
        let own = &bodies[index];
        let reach = area_around(own.bounds, own.slack);
        let found = boxes.locate_in_envelope_intersecting(reach);
        let others = found.map(|found| found.data);
        let others = others.filter(|other| {
            *other != index && are_near(own, &bodies[*other], own.slack, &mut left)
        });
        let mut others: Vec<usize> = others.take(MAX_TOUCHED).collect();
        others.sort_unstable();
        others
    };
    let mut all: Vec<Vec<usize>> = (0..bodies.len()).map(&mut near).collect();
    // The larger slack counts for both.
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

/// Whether the distance between two bodies is at most `gap`; `true` if too few computations of distances are left to tell.
fn are_near(a: &Body<'_>, b: &Body<'_>, gap: f64, left: &mut usize) -> bool {
    let count = |body: &Body<'_>| -> usize { rings(body).map(<[DVec2]>::len).sum() };
    let work = count(a).saturating_mul(count(b)).saturating_mul(2);
    let Some(rest) = left.checked_sub(work) else {
        return true;
    };
    *left = rest;
    let reaches = |from: &Body<'_>, to: &Body<'_>| {
        let (low, high) = (to.bounds.0 - gap, to.bounds.1 + gap);
        let points = rings(from).flatten();
        // Most points are nowhere near.
        let mut points = points.filter(|point| point.cmpge(low).all() && point.cmple(high).all());
        points.any(|point| {
            let mut outlines = to.outlines.iter();
            outlines.any(|outline| distance_squared(outline, *point) <= gap * gap)
        })
    };
    reaches(a, b) || reaches(b, a) || borders_cross(a, b)
}

/// Whether edges of two bodies cross: two bars in the form of a plus have no corner near each other.
fn borders_cross(a: &Body<'_>, b: &Body<'_>) -> bool {
    let apart = a.bounds.0.cmpgt(b.bounds.1).any() || b.bounds.0.cmpgt(a.bounds.1).any();
    let (low, high) = b.bounds;
    !apart
        && edges(a).any(|[from, to]| {
            if from.max(to).cmplt(low).any() || from.min(to).cmpgt(high).any() {
                return false;
            }
            let along = to - from;
            edges(b).any(|[start, end]| {
                let side = |point: DVec2| along.perp_dot(point - from);
                let other = |point: DVec2| (end - start).perp_dot(point - start);
                side(start) * side(end) < 0.0 && other(from) * other(to) < 0.0
            })
        })
}

fn rings<'a>(body: &'a Body<'_>) -> impl Iterator<Item = &'a [DVec2]> {
    let polygons = body.outlines.iter().flat_map(|outline| &outline.polygons);
    polygons
        .flat_map(|polygon| &polygon.rings)
        .map(Vec::as_slice)
}

fn edges<'a>(body: &'a Body<'_>) -> impl Iterator<Item = [DVec2; 2]> + 'a {
    rings(body).flat_map(|ring| {
        let next = ring.iter().cycle().skip(1);
        ring.iter().zip(next).map(|(a, b)| [*a, *b])
    })
}

#[cfg(test)]
mod tests {
    use super::super::{FillRule, resolve_overlaps};
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
}
