//! A grid over the ring that holes are joined to, which grows with each of them. It finds the edges beside a point and the corners in
//! a triangle without looking at the whole ring.

use glam::DVec2;

use super::cells::Cells;

/// Rings with fewer corners have one cell: a grid would take longer to fill than it saves.
const FEW: usize = 256;

/// Edges and corners by their cells. Corners are numbered in the order in which they are added, and each starts one edge.
pub(super) struct Border {
    cells: Cells,
    /// Per cell, the edges that reach into it.
    edges: Vec<Vec<u32>>,
    /// Per cell, the corners in it.
    corners: Vec<Vec<u32>>,
    /// Per edge, the corner at which it starts.
    starts: Vec<u32>,
    /// Per corner, the edge that starts there.
    edge_of: Vec<u32>,
}

impl Border {
    /// A ring without corners, which will have so many in this box.
    pub(super) fn new(bounds: [DVec2; 2], corners: usize) -> Self {
        let count = if corners <= FEW { 1.0 } else { corners as f64 };
        let cells = Cells::over(bounds, count);
        let lists = vec![Vec::new(); cells.count()];
        Self {
            cells,
            edges: lists.clone(),
            corners: lists,
            starts: Vec::new(),
            edge_of: Vec::new(),
        }
    }

    /// Adds the next corner, which starts this edge.
    pub(super) fn add(&mut self, edge: [DVec2; 2]) {
        let corner = self.edge_of.len() as u32;
        self.corners[self.cells.nearest(edge[0])].push(corner);
        self.edge_of.push(0);
        self.add_edge(corner, edge);
    }

    /// Adds the next corner where `other` is. It takes over the edge that starts there, and `other` starts this new one.
    pub(super) fn split(&mut self, other: u32, edge: [DVec2; 2]) {
        let corner = self.edge_of.len() as u32;
        self.corners[self.cells.nearest(edge[0])].push(corner);
        let taken = self.edge_of[other as usize];
        self.starts[taken as usize] = corner;
        self.edge_of.push(taken);
        self.add_edge(other, edge);
    }

    fn add_edge(&mut self, corner: u32, [from, to]: [DVec2; 2]) {
        let edge = self.starts.len() as u32;
        self.starts.push(corner);
        self.edge_of[corner as usize] = edge;
        let Self { cells, edges, .. } = self;
        cells.of_triangle([from, to, to], |cell| edges[cell].push(edge));
    }

    /// Calls `crossing` with the starts of edges near the horizontal line from a point to the left, until all that cross it nearer
    /// than the greatest x that it returned have been seen. An edge may be seen more than once.
    pub(super) fn leftward(&self, point: DVec2, mut crossing: impl FnMut(u32) -> Option<f64>) {
        let mut nearest = f64::NEG_INFINITY;
        for (cell, left) in self.cells.leftward(point) {
            for edge in &self.edges[cell] {
                let x = crossing(self.starts[*edge as usize]);
                nearest = x.map_or(nearest, |x| nearest.max(x));
            }
            if nearest > left {
                break;
            }
        }
    }

    /// The corners in a triangle and perhaps others near it, in the order in which they were added.
    pub(super) fn corners_near(&self, triangle: [DVec2; 3]) -> Vec<u32> {
        let mut found = Vec::new();
        self.cells
            .of_triangle(triangle, |cell| found.extend(&self.corners[cell]));
        found.sort_unstable();
        found
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    /// The greatest x up to that of a point at which an edge meets its height, with the earliest edge that has it.
    fn nearest(edges: &[[DVec2; 2]], point: DVec2, corner: u32) -> Option<(f64, u32)> {
        let [p, q] = edges[corner as usize];
        let x = p.x + (q.x - p.x) * ((point.y - p.y) / (q.y - p.y));
        ((p.y > point.y) != (q.y > point.y) && x <= point.x).then_some((x, corner))
    }

    proptest! {
        #[test]
        fn a_grid_finds_what_a_search_finds(
            places in prop::collection::vec((0..20_u32, 0..20_u32), 3..60),
            looks in prop::collection::vec([0..40_u32, 0..40], 1..20),
            corners in prop_oneof![Just(1), Just(300), Just(5000)],
            holes in prop::collection::vec(0..3_usize, 0..20),
        ) {
            let place = |(x, y): (u32, u32)| DVec2::new(f64::from(x), f64::from(y) / 3.0);
            let points: Vec<DVec2> = places.iter().copied().map(place).collect();
            let mut edges: Vec<[DVec2; 2]> = (0..points.len())
                .map(|i| [points[i], points[(i + 1) % points.len()]])
                .collect();
            let bounds = [DVec2::ZERO, DVec2::new(19.0, 19.0 / 3.0)];
            let mut border = Border::new(bounds, corners);
            edges.iter().for_each(|edge| border.add(*edge));
            for hole in holes {
                // A bridge from this corner to another and back.
                let [from, to] = [points[hole], points[2 - hole]];
                let taken = std::mem::replace(&mut edges[hole], [from, to]);
                border.add([to, from]);
                border.split(hole as u32, [from, to]);
                edges.extend([[to, from], taken]);
            }
            let best = |a: Option<(f64, u32)>, b: Option<(f64, u32)>| match (a, b) {
                (Some(a), Some(b)) if b.0 > a.0 || (b.0 == a.0 && b.1 < a.1) => Some(b),
                _ => a.or(b),
            };
            let all = 0..edges.len() as u32;
            for look in looks {
                let point = DVec2::new(f64::from(look[0]) / 2.0, f64::from(look[1]) / 6.0);
                let mut found = None;
                border.leftward(point, |corner| {
                    let crossing = nearest(&edges, point, corner);
                    found = best(found, crossing);
                    crossing.map(|(x, _)| x)
                });
                let expected = all.clone().map(|corner| nearest(&edges, point, corner));
                prop_assert_eq!(found, expected.fold(None, best));

                let triangle = [point, points[0], points[1]];
                let near = border.corners_near(triangle);
                let [low, high] = [
                    triangle.into_iter().fold(point, DVec2::min),
                    triangle.into_iter().fold(point, DVec2::max),
                ];
                let [a, b, c] = triangle;
                for corner in all.clone() {
                    let p = edges[corner as usize][0];
                    let sides = [(b - a).perp_dot(p - a), (c - b).perp_dot(p - b), (a - c).perp_dot(p - c)];
                    let is_in = p.clamp(low, high) == p
                        && (sides.iter().all(|side| *side >= 0.0) || sides.iter().all(|side| *side <= 0.0));
                    prop_assert!(!is_in || near.contains(&corner));
                }
                prop_assert!(near.is_sorted());
            }
        }
    }
}
