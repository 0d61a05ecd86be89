//! Finds where a point lies in a triangulation, and what lies between two of its points.

use glam::DVec2;

use super::{Delaunay, NONE, next, orientation, previous};

/// Where a point lies.
pub(super) enum PointLocation {
    /// In the triangle of a half-edge.
    In(u32),
    /// On a half-edge.
    On(u32),
    At(u32),
}

impl Delaunay {
    /// Walks from triangle to triangle towards a point.
    pub(super) fn find(&self, point: DVec2, start: u32) -> PointLocation {
        let mut edge = start;
        let side = self.side(edge, point);
        // Whether the point is on the edge that the walk has come over.
        let mut is_on_edge = side == 0.0;
        if side < 0.0 {
            edge = self.edge(edge).twin;
        }
        for step in 0..self.is_inside.len() {
            let (mut one, mut other) = (next(edge), previous(edge));
            // In turn, because a walk that always turns the same way may go round in circles.
            if step % 2 == 1 {
                (one, other) = (other, one);
            }
            let sides = [self.side(one, point), self.side(other, point)];
            if sides[0] < 0.0 {
                edge = self.edge(one).twin;
            } else if sides[1] < 0.0 {
                edge = self.edge(other).twin;
            } else if is_on_edge || sides[0] == 0.0 || sides[1] == 0.0 {
                return self.location_in(point, edge);
            } else {
                return PointLocation::In(edge);
            }
            is_on_edge = false;
        }
        let contains = |edge: &u32| {
            [*edge, edge + 1, edge + 2]
                .iter()
                .all(|side| self.side(*side, point) >= 0.0)
        };
        let mut triangles = (0..self.is_inside.len() as u32).map(|i| 4 * i);
        self.location_in(point, triangles.find(contains).unwrap_or(edge))
    }

    /// Where in a triangle a point lies.
    fn location_in(&self, point: DVec2, edge: u32) -> PointLocation {
        let edges = [edge, next(edge), previous(edge)];
        let Some(zero) = edges
            .into_iter()
            .find(|edge| self.side(*edge, point) == 0.0)
        else {
            return PointLocation::In(edge);
        };
        let corners = edges.map(|edge| self.edge(edge).from);
        let corner = corners.into_iter().find(|corner| self.at(*corner) == point);
        corner.map_or(PointLocation::On(zero), PointLocation::At)
    }

    /// The half-edges that start at a point, counter-clockwise; of a corner of the square only some.
    fn around_vertex(&self, vertex: u32) -> impl Iterator<Item = u32> + '_ {
        let first = self.vertices[vertex as usize].edge;
        let turned = move |edge: &u32| {
            let next = self.edge(previous(*edge)).twin;
            (next != NONE && next != first).then_some(next)
        };
        std::iter::successors(Some(first), turned)
    }

    /// The half-edge from one point to another.
    pub(super) fn between(&self, from: u32, to: u32) -> Option<u32> {
        self.around_vertex(from)
            .find(|edge| self.edge(next(*edge)).from == to)
    }

    /// What is between two points: an edge, the first edge in the way if it is in `PointLocation::In`, or an edge to a point in the way.
    pub(super) fn towards(&self, from: u32, to: u32) -> PointLocation {
        if let Some(edge) = self.between(from, to) {
            return PointLocation::At(edge);
        }
        let (start, end) = (self.at(from), self.at(to));
        for edge in self.around_vertex(from) {
            let opposite = next(edge);
            let right = self.at(self.edge(opposite).from);
            let left = self.at(self.edge(next(opposite)).from);
            let side = orientation(start, end, right);
            if side == 0.0 && (right - start).dot(end - start) > 0.0 {
                return PointLocation::On(edge);
            }
            if side < 0.0 && orientation(start, end, left) > 0.0 {
                return PointLocation::In(opposite);
            }
        }
        // Not reached: the triangles around a point leave no gap.
        PointLocation::At(self.vertices[from as usize].edge)
    }
}
