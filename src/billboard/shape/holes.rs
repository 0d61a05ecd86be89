//! Bridges between a polygon's border and its holes, the same ones in all views.

use glam::DVec2;

/// Bridges that are tried for one hole.
const MAX_TRIED: usize = 4000;

/// The views, and every two of them blended half and half.
pub(super) fn samples(views: &[Vec<DVec2>]) -> Vec<Vec<DVec2>> {
    let mut samples = views.to_vec();
    for second in 1..views.len() {
        for first in 0..second {
            let each = views[first].iter().zip(&views[second]);
            samples.push(each.map(|(a, b)| a.midpoint(*b)).collect());
        }
    }
    samples
}

/// Rings against which chords are tested.
pub(super) struct Crossings<'a> {
    samples: &'a [Vec<DVec2>],
    ring: &'a [u32],
    edges: Vec<[u32; 2]>,
}

impl<'a> Crossings<'a> {
    pub(super) fn new(samples: &'a [Vec<DVec2>], ring: &'a [u32]) -> Self {
        Self {
            samples,
            ring,
            edges: edges(ring).collect(),
        }
    }

    /// How many edges the chord between two places of the ring crosses in all samples. Ends that do not point into the ring
    /// count too.
    pub(super) fn of(&self, [from, to]: [usize; 2]) -> usize {
        let ends = [self.ring[from], self.ring[to]];
        let each = self.samples.iter().map(|points| {
            let is_open =
                opens(points, self.ring, from, ends[1]) && opens(points, self.ring, to, ends[0]);
            usize::from(!is_open) + count(points, &self.edges, ends)
        });
        each.sum()
    }
}

/// A ring through a border and its holes, connected by bridges that run both ways. The bridges are the shortest that cross
/// nothing in any view or between two; if there are none, they cross as little as possible.
pub(super) fn join(views: &[Vec<DVec2>], border: &[u32], holes: &[Vec<u32>]) -> Vec<u32> {
    let samples = samples(views);
    let mut joined = border.to_vec();
    let mut holes: Vec<&Vec<u32>> = holes.iter().filter(|hole| !hole.is_empty()).collect();
    while !holes.is_empty() && !joined.is_empty() {
        let walls: Vec<[u32; 2]> = (edges(&joined))
            .chain(holes.iter().flat_map(|hole| edges(hole)))
            .collect();
        let mut bridges = Vec::new();
        for (index, hole) in holes.iter().enumerate() {
            for (from, &a) in joined.iter().enumerate() {
                for (to, &b) in hole.iter().enumerate() {
                    let length = views.iter().map(|view| {
                        let [a, b] = [a, b].map(|i| view[i as usize]);
                        a.distance_squared(b)
                    });
                    bridges.push((length.sum::<f64>(), [index, from, to]));
                }
            }
        }
        bridges.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut best = (usize::MAX, [0; 3]);
        for (tried, (_, [index, from, to])) in bridges.iter().enumerate() {
            let ends = [joined[*from], holes[*index][*to]];
            let obstacles = samples.iter().map(|points| {
                let is_open = opens(points, &joined, *from, ends[1])
                    && opens(points, holes[*index], *to, ends[0]);
                count(points, &walls, ends) + usize::from(!is_open)
            });
            let obstacles = obstacles.sum();
            if obstacles < best.0 {
                best = (obstacles, [*index, *from, *to]);
            }
            if obstacles == 0 || tried > MAX_TRIED {
                break;
            }
        }
        let [index, from, to] = best.1;
        let hole = holes.remove(index);
        let way = hole[to..].iter().chain(&hole[..=to]).copied();
        let way: Vec<u32> = way.chain([joined[from]]).collect();
        joined.splice(from + 1..from + 1, way);
    }
    joined
}

fn edges(ring: &[u32]) -> impl Iterator<Item = [u32; 2]> {
    let next = ring.iter().cycle().skip(1);
    ring.iter().zip(next).map(|(a, b)| [*a, *b])
}

/// Whether the way from a place of a ring to a point starts on the ring's left.
fn opens(points: &[DVec2], ring: &[u32], from: usize, to: u32) -> bool {
    let at = |i: usize| points[ring[i % ring.len()] as usize];
    let here = at(from);
    let (before, after) = (at(from + ring.len() - 1) - here, at(from + 1) - here);
    let way = points[to as usize] - here;
    if before == DVec2::ZERO || after == DVec2::ZERO {
        return true;
    }
    if after.perp_dot(before) >= 0.0 {
        after.perp_dot(way) >= 0.0 && way.perp_dot(before) >= 0.0
    } else {
        after.perp_dot(way) >= 0.0 || way.perp_dot(before) >= 0.0
    }
}

/// How many of the edges a chord crosses. Those that share a point with it do not count.
fn count(points: &[DVec2], edges: &[[u32; 2]], ends: [u32; 2]) -> usize {
    let [a, b] = ends.map(|i| points[i as usize]);
    let side = |from: DVec2, to: DVec2, point: DVec2| (to - from).perp_dot(point - from);
    let crosses = |edge: &&[u32; 2]| {
        if edge.iter().any(|i| ends.contains(i)) {
            return false;
        }
        let [c, d] = edge.map(|i| points[i as usize]);
        // Edges that have shrunk to a point are no obstacle.
        c != d && side(a, b, c) * side(a, b, d) <= 0.0 && side(c, d, a) * side(c, d, b) <= 0.0
    };
    edges.iter().filter(crosses).count()
}
