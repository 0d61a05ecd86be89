//! A constrained Delaunay triangulation that grows point by point (Lawson, "Software for C¹ surface interpolation", 1977; edges
//! of the border by flipping as in Sloan, "A fast algorithm for generating constrained Delaunay triangulations", 1993).
//!
//! It covers a square around all points. Orientations are exact, so all triangles have area. Edges are flipped only if the
//! circle test is clear of rounding, so that flipping ends.

mod search;

use std::collections::VecDeque;

use glam::DVec2;
use robust::{Coord, orient2d};

use search::PointLocation;

/// In place of a half-edge or a triangle that does not exist.
const NONE: u32 = u32::MAX;
/// Points of the square around all others; they come first.
const CORNERS: u32 = 4;
/// Relative rounding errors of the line and the circle test (Shewchuk, "Adaptive precision floating-point arithmetic", 1997).
const LINE_ERROR: f64 = 4e-16;
const CIRCLE_ERROR: f64 = 1.2e-15;
/// How often an edge of the border may at least flip those in its way.
const MIN_FLIPS: usize = 64;

/// An edge as one of its triangles has it, counter-clockwise.
#[derive(Debug, Clone, Copy)]
struct HalfEdge {
    /// The point it starts at.
    from: u32,
    /// The same edge in the triangle across.
    twin: u32,
    /// Whether it is part of the border.
    is_wall: bool,
}

/// In the place of a fourth half-edge, so that the triangle of an edge is found without a division.
const UNUSED: HalfEdge = HalfEdge {
    from: NONE,
    twin: NONE,
    is_wall: false,
};

/// A point of a triangulation.
#[derive(Debug, Clone, Copy)]
struct Vertex {
    at: DVec2,
    /// One of the half-edges that start here.
    edge: u32,
    is_on_border: bool,
}

/// A triangulation; half-edges 4i to 4i + 2 belong to triangle i.
pub(super) struct Delaunay {
    vertices: Vec<Vertex>,
    edges: Vec<HalfEdge>,
    /// Per triangle, whether it lies in the outline; all of them until that is found out.
    is_inside: Vec<bool>,
    /// Whether separate parts of the border meet in a point.
    pub(super) has_pinches: bool,
    /// Half-edges whose neighbours may have to be flipped.
    open: Vec<u32>,
}

impl Delaunay {
    /// Two triangles that leave room around a box.
    pub(super) fn around(low: DVec2, high: DVec2, points: usize) -> Self {
        // So far off that no triangle with a corner of the square has its middle in the box.
        let room = 3.0 * (high - low).max_element().max(f64::MIN_POSITIVE.sqrt());
        let (low, high) = (low - room, high + room);
        let corners = [
            low,
            DVec2::new(high.x, low.y),
            high,
            DVec2::new(low.x, high.y),
        ];
        let mut vertices = Vec::with_capacity(points + CORNERS as usize);
        for (at, edge) in corners.into_iter().zip([0, 1, 2, 6]) {
            vertices.push(Vertex {
                at,
                edge,
                is_on_border: false,
            });
        }
        let mut edges = Vec::with_capacity(8 * (points + CORNERS as usize));
        for triangle in [
            [(0, NONE), (1, NONE), (2, 4)],
            [(0, 2), (2, NONE), (3, NONE)],
        ] {
            edges.extend(triangle.map(|(from, twin)| new(from, twin)));
            edges.push(UNUSED);
        }
        let mut is_inside = Vec::with_capacity(2 * (points + CORNERS as usize));
        is_inside.extend([true; 2]);
        Self {
            vertices,
            edges,
            is_inside,
            has_pinches: false,
            open: Vec::new(),
        }
    }

    /// A point from which every other can be found.
    pub(super) fn any(&self) -> u32 {
        self.vertices.len() as u32 - 1
    }

    pub(super) fn len(&self) -> usize {
        self.vertices.len()
    }

    pub(super) fn at(&self, vertex: u32) -> DVec2 {
        self.vertices[vertex as usize].at
    }

    pub(super) fn is_on_border(&self, vertex: u32) -> bool {
        self.vertices[vertex as usize].is_on_border
    }

    /// The corners of the triangles in the outline.
    pub(super) fn inner(&self) -> impl Iterator<Item = [u32; 3]> + '_ {
        let triangles = self.edges.chunks_exact(4).zip(&self.is_inside);
        triangles
            .filter(|(_, is_inside)| **is_inside)
            .map(|(edges, _)| [edges[0].from, edges[1].from, edges[2].from])
    }

    /// Adds a point and returns its number, or that of a point in the same place; `None` outside the outline. The search for its
    /// place begins at the point `near`.
    pub(super) fn insert(&mut self, at: DVec2, near: u32) -> Option<u32> {
        let location = self.find(at, self.vertices[near as usize].edge);
        let is_inside = |edge: u32| self.is_inside[triangle(edge)];
        let vertex = self.vertices.len() as u32;
        match location {
            PointLocation::At(known) => return Some(known),
            PointLocation::In(edge) if is_inside(edge) => {
                self.vertices.push(Vertex {
                    at,
                    edge,
                    is_on_border: false,
                });
                self.split_triangle(edge & !3, vertex);
            }
            PointLocation::On(edge) if is_inside(edge) || is_inside(self.edge(edge).twin) => {
                self.vertices.push(Vertex {
                    at,
                    edge,
                    is_on_border: self.edge(edge).is_wall,
                });
                self.split_edge(edge, vertex);
            }
            PointLocation::In(_) | PointLocation::On(_) => return None,
        }
        self.restore::<false>();
        Some(vertex)
    }

    /// Makes the line between two points part of the border, or, where it already is, no part of it; `false` if another part of
    /// the border is in the way.
    pub(super) fn toggle_wall(&mut self, mut from: u32, to: u32) -> bool {
        let mut crossed = Vec::new();
        while from != to {
            let edge = match self.towards(from, to) {
                PointLocation::On(edge) | PointLocation::At(edge) => edge,
                PointLocation::In(first) => {
                    let Some(end) = self.crossed(from, to, first, &mut crossed) else {
                        return false;
                    };
                    if !self.clear(from, end, &crossed) {
                        return false;
                    }
                    let Some(edge) = self.between(from, end) else {
                        return false;
                    };
                    edge
                }
            };
            let twin = self.edge(edge).twin;
            for side in [edge, twin] {
                let side = &mut self.edges[side as usize];
                side.is_wall = !side.is_wall;
            }
            from = self.edge(twin).from;
            self.restore::<true>();
        }
        true
    }

    /// Finds out which triangles lie in the outline by walking inward from the square; or, where parts of the border cross each
    /// other, by a test of a point of each triangle.
    pub(super) fn find_inside(&mut self, test: Option<impl Fn(DVec2) -> bool>) {
        if let Some(test) = test {
            for i in 0..self.is_inside.len() {
                let corners = self.edges[4 * i..4 * i + 3].iter();
                let sum: DVec2 = corners.map(|edge| self.at(edge.from)).sum();
                self.is_inside[i] = test(sum / 3.0);
            }
        } else {
            let mut is_known = vec![false; self.is_inside.len()];
            let outer = triangle(self.vertices[0].edge);
            self.is_inside[outer] = false;
            is_known[outer] = true;
            let mut open = vec![outer];
            while let Some(i) = open.pop() {
                for edge in &self.edges[4 * i..4 * i + 3] {
                    if edge.twin != NONE && !is_known[triangle(edge.twin)] {
                        let other = triangle(edge.twin);
                        is_known[other] = true;
                        self.is_inside[other] = self.is_inside[i] != edge.is_wall;
                        open.push(other);
                    }
                }
            }
        }
        self.find_border();
    }

    /// The border is what separates inside and outside.
    fn find_border(&mut self) {
        for vertex in &mut self.vertices {
            vertex.is_on_border = false;
        }
        self.has_pinches = false;
        for (i, edge) in self.edges.iter_mut().enumerate() {
            let is_inside = self.is_inside[i / 4];
            edge.is_wall = edge.twin != NONE && self.is_inside[triangle(edge.twin)] != is_inside;
            if edge.is_wall && is_inside {
                let start = &mut self.vertices[edge.from as usize].is_on_border;
                self.has_pinches |= std::mem::replace(start, true);
            }
        }
    }

    /// Places of additional points, each with a point near it, so that every triangle in the outline has one off the border.
    pub(super) fn wanted(&self, wanted: &mut Vec<(DVec2, u32)>) {
        wanted.clear();
        for (i, _) in (0..).zip(&self.is_inside).filter(|(_, inside)| **inside) {
            let edges = [4 * i, 4 * i + 1, 4 * i + 2];
            let [a, b, c] = edges.map(|edge| self.edge(edge).from);
            if edges.iter().all(|edge| self.edge(*edge).is_wall) {
                wanted.push(((self.at(a) + self.at(b) + self.at(c)) / 3.0, a));
            }
            for (edge, [from, to]) in edges.into_iter().zip([[a, b], [b, c], [c, a]]) {
                if from < to && self.is_chord(edge) {
                    wanted.push((self.at(from).midpoint(self.at(to)), from));
                }
            }
        }
    }

    /// Whether an edge in the outline leads from border to border, where front and back would meet.
    fn is_chord(&self, edge: u32) -> bool {
        let HalfEdge { from, is_wall, .. } = self.edge(edge);
        !is_wall && self.is_on_border(from) && self.is_on_border(self.edge(next(edge)).from)
    }

    /// Takes triangles out of the outline that front and back would share; `false` if there are none.
    pub(super) fn drop_flat(&mut self) -> bool {
        let is_flat = |i: &u32| {
            let edges = [4 * i, 4 * i + 1, 4 * i + 2];
            self.is_inside[*i as usize]
                && (edges.iter().all(|edge| self.edge(*edge).is_wall)
                    || edges.iter().any(|edge| self.is_chord(*edge)))
        };
        let flat: Vec<u32> = (0..self.is_inside.len() as u32).filter(is_flat).collect();
        for i in &flat {
            self.is_inside[*i as usize] = false;
        }
        if !flat.is_empty() {
            self.find_border();
        }
        !flat.is_empty()
    }

    /// Collects the ends of the edges between two points, beginning with a given one, up to the next point in the way, which is
    /// returned; `None` if one of them is part of the border.
    fn crossed(&self, from: u32, to: u32, first: u32, ends: &mut Vec<[u32; 2]>) -> Option<u32> {
        let (start, end) = (self.at(from), self.at(to));
        ends.clear();
        let mut edge = first;
        loop {
            let HalfEdge {
                from: right,
                twin,
                is_wall,
            } = self.edge(edge);
            if is_wall {
                return None;
            }
            ends.push([right, self.edge(twin).from]);
            let opposite = previous(twin);
            let point = self.edge(opposite).from;
            let side = orientation(start, end, self.at(point));
            if point == to || side == 0.0 {
                return Some(point);
            }
            edge = if side > 0.0 { next(twin) } else { opposite };
        }
    }

    /// Flips the edges with these ends until none is between two points; `false` if that does not end.
    fn clear(&mut self, from: u32, to: u32, ends: &[[u32; 2]]) -> bool {
        let (start, end) = (self.at(from), self.at(to));
        let mut left: VecDeque<[u32; 2]> = ends.iter().copied().collect();
        // Every edge can be flipped once enough of the others are.
        for _ in 0..MIN_FLIPS + ends.len() * ends.len() {
            let Some([one, other]) = left.pop_front() else {
                return true;
            };
            let reverse = || Some(self.edge(self.between(other, one)?).twin);
            let Some(edge) = self.between(one, other).or_else(reverse) else {
                return false;
            };
            let twin = self.edge(edge).twin;
            let corners = [edge, twin, previous(edge), previous(twin)];
            let vertices = corners.map(|edge| self.edge(edge).from);
            let [a, b, p, d] = vertices.map(|vertex| self.at(vertex));
            if orientation(a, d, p) <= 0.0 || orientation(d, b, p) <= 0.0 {
                left.push_back([one, other]);
                continue;
            }
            self.flip(edge);
            let around = [edge, twin, previous(edge), next(twin)];
            self.open.extend(around);
            self.open.push(next(edge));
            let sides = [p, d].map(|point| orientation(start, end, point).signum());
            let is_end = |vertex: u32| vertex == from || vertex == to;
            if !is_end(vertices[2]) && !is_end(vertices[3]) && sides[0] * sides[1] < 0.0 {
                left.push_back([vertices[2], vertices[3]]);
            }
        }
        left.is_empty()
    }

    fn edge(&self, edge: u32) -> HalfEdge {
        self.edges[edge as usize]
    }

    /// Positive for a point left of a half-edge, negative right of it.
    fn side(&self, edge: u32, point: DVec2) -> f64 {
        let to = self.edge(next(edge)).from;
        orientation(self.at(self.edge(edge).from), self.at(to), point)
    }

    fn push_triangle(&mut self, [a, b, c]: [HalfEdge; 3], is_inside: bool) {
        let first = self.edges.len() as u32;
        self.edges.extend([a, b, c, UNUSED]);
        self.is_inside.push(is_inside);
        self.join(first, a.twin);
        self.join(first + 1, b.twin);
        self.join(first + 2, c.twin);
    }

    /// Tells two half-edges that they are the two sides of an edge.
    fn join(&mut self, a: u32, b: u32) {
        self.edges[a as usize].twin = b;
        if b != NONE {
            self.edges[b as usize].twin = a;
        }
    }

    /// Makes three triangles of one by a point in it.
    fn split_triangle(&mut self, ab: u32, vertex: u32) {
        let (bc, ca) = (ab + 1, ab + 2);
        let (old_bc, old_ca) = (self.edge(bc), self.edge(ca));
        let is_inside = self.is_inside[triangle(ab)];
        let one = self.edges.len() as u32;
        let other = one + 4;
        self.edges[bc as usize] = new(old_bc.from, NONE);
        self.edges[ca as usize] = new(vertex, NONE);
        self.push_triangle([old_bc, new(old_ca.from, NONE), new(vertex, bc)], is_inside);
        let a = self.edge(ab).from;
        self.push_triangle([old_ca, new(a, ca), new(vertex, one + 1)], is_inside);
        self.vertices[old_ca.from as usize].edge = other;
        self.vertices[vertex as usize].edge = ca;
        self.open.extend([ab, one, other]);
    }

    /// Makes four triangles of two by a point on their common edge.
    fn split_edge(&mut self, ab: u32, vertex: u32) {
        let HalfEdge {
            from: a,
            twin: ba,
            is_wall,
        } = self.edge(ab);
        let (bc, ca) = (next(ab), previous(ab));
        let (ad, db) = (next(ba), previous(ba));
        let (old_bc, old_ad) = (self.edge(bc), self.edge(ad));
        let (b, c, d) = (old_bc.from, self.edge(ca).from, self.edge(db).from);
        let half = |twin| HalfEdge {
            from: vertex,
            twin,
            is_wall,
        };
        let one = self.edges.len() as u32;
        let other = one + 4;
        self.edges[bc as usize] = new(vertex, NONE);
        self.edges[ad as usize] = new(vertex, NONE);
        let [left, right] = [ab, ba].map(|edge| self.is_inside[triangle(edge)]);
        self.push_triangle([half(ba), old_bc, new(c, bc)], left);
        self.push_triangle([half(ab), old_ad, new(d, ad)], right);
        self.vertices[a as usize].edge = ab;
        self.vertices[b as usize].edge = ba;
        self.vertices[vertex as usize].edge = one;
        self.open.extend([ca, one + 1, db, other + 1]);
    }

    /// Flips edges that are not Delaunay, beginning with the open ones: those opposite a new point, or `ALL` around each flip.
    fn restore<const ALL: bool>(&mut self) {
        while let Some(edge) = self.open.pop() {
            let HalfEdge { twin, is_wall, .. } = self.edge(edge);
            if is_wall || twin == NONE {
                continue;
            }
            let corner = |edge: u32| self.at(self.edge(edge).from);
            let circle = [corner(edge), corner(twin), corner(previous(edge))];
            if is_in_circle(circle, corner(previous(twin))) {
                self.flip(edge);
                self.open.extend([edge, twin]);
                if ALL {
                    self.open.extend([previous(edge), next(twin)]);
                }
            }
        }
    }

    /// Replaces the edge from a to b between triangles abp and bad by the one from d to p. Afterwards the half-edge goes from a to
    /// d and its former twin from d to b.
    fn flip(&mut self, ab: u32) {
        let ba = self.edge(ab).twin;
        let (bp, ad) = (next(ab), next(ba));
        let (pa, db) = (next(bp), next(ad));
        let (old_bp, old_ad, old_db) = (self.edge(bp), self.edge(ad), self.edge(db));
        let HalfEdge { from: p, .. } = self.edge(pa);
        self.edges[ab as usize] = old_ad;
        self.edges[bp as usize] = HalfEdge {
            from: old_db.from,
            twin: db,
            is_wall: false,
        };
        self.edges[ba as usize] = old_db;
        self.edges[ad as usize] = old_bp;
        self.edges[db as usize] = HalfEdge {
            from: p,
            twin: bp,
            is_wall: false,
        };
        self.join(ab, old_ad.twin);
        self.join(ba, old_db.twin);
        self.join(ad, old_bp.twin);
        self.vertices[old_ad.from as usize].edge = ab;
        self.vertices[old_bp.from as usize].edge = ad;
        self.vertices[old_db.from as usize].edge = ba;
    }
}

/// A half-edge that is no part of the border.
fn new(from: u32, twin: u32) -> HalfEdge {
    HalfEdge {
        from,
        twin,
        is_wall: false,
    }
}

fn triangle(edge: u32) -> usize {
    edge as usize / 4
}

/// The next half-edge of the triangle.
fn next(edge: u32) -> u32 {
    if edge % 4 == 2 { edge - 2 } else { edge + 1 }
}

/// The one before.
fn previous(edge: u32) -> u32 {
    if edge.is_multiple_of(4) {
        edge + 2
    } else {
        edge - 1
    }
}

/// Positive if the points are counter-clockwise, 0 if they are on a line.
fn orientation(a: DVec2, b: DVec2, c: DVec2) -> f64 {
    let (one, other) = ((a.x - c.x) * (b.y - c.y), (a.y - c.y) * (b.x - c.x));
    let difference = one - other;
    // Nearly always clear at once, without a call.
    if difference.abs() > LINE_ERROR * (one.abs() + other.abs()) {
        return difference;
    }
    let coord = |p: DVec2| Coord { x: p.x, y: p.y };
    orient2d(coord(a), coord(b), coord(c))
}

/// Whether a point is in the circle through three others, counter-clockwise, by more than rounding.
fn is_in_circle([a, b, c]: [DVec2; 3], point: DVec2) -> bool {
    let (a, b, c) = (a - point, b - point, c - point);
    let (bc, cb) = (b.x * c.y, b.y * c.x);
    let (ca, ac) = (c.x * a.y, c.y * a.x);
    let (ab, ba) = (a.x * b.y, a.y * b.x);
    let (a, b, c) = (a.length_squared(), b.length_squared(), c.length_squared());
    let determinant = a * (bc - cb) + b * (ca - ac) + c * (ab - ba);
    let size = a * (bc.abs() + cb.abs()) + b * (ca.abs() + ac.abs()) + c * (ab.abs() + ba.abs());
    determinant > CIRCLE_ERROR * size
}
