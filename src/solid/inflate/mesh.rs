//! Triangles between the points of an inflated outline.
//!
//! Points are rounded to their final `f32` positions first and triangulated there, so that rounding cannot make a triangle
//! degenerate.

use glam::DVec2;
use rustc_hash::FxHashMap;
use spade::{ConstrainedDelaunayTriangulation, HasPosition, Point2, Triangulation};

use super::points::Points;
use crate::geometry::crosses;
use crate::solid::stack::PlacementTransform;

/// The number of rounds in which triangles without an inner point are given one.
const MAX_ROUNDS: usize = 3;
/// Smaller coordinates are 0: their products would underflow in the triangulation.
const NOTHING: f64 = 1e-40;

/// Triangles in the plane, at their final positions.
pub(in crate::solid) struct Mesh {
    pub(in crate::solid) points: Vec<[f32; 2]>,
    /// Counter-clockwise, all with area; each has a point off the border.
    pub(in crate::solid) triangles: Vec<[u32; 3]>,
    pub(in crate::solid) on_border: Vec<bool>,
}

type Delaunay = ConstrainedDelaunayTriangulation<Vertex>;

#[derive(Clone, Copy)]
struct Vertex([f32; 2]);

impl HasPosition for Vertex {
    type Scalar = f64;

    fn position(&self) -> Point2<f64> {
        let [x, y] = self.0.map(f64::from);
        Point2::new(x, y)
    }
}

/// Joins points by a Delaunay triangulation that keeps the border's edges.
pub(in crate::solid) fn mesh(points: &Points, transform: &PlacementTransform) -> Mesh {
    let mut known: FxHashMap<[u32; 2], usize> = FxHashMap::default();
    let mut vertices: Vec<Vertex> = Vec::with_capacity(points.points.len());
    let ids: Vec<usize> = points
        .points
        .iter()
        .map(|point| {
            let place = clear(transform.in_plane(*point));
            *known.entry(place.map(f32::to_bits)).or_insert_with(|| {
                vertices.push(Vertex(place));
                vertices.len() - 1
            })
        })
        .collect();
    // Coinciding parts of the border cancel each other out.
    let mut border: Vec<[usize; 2]> = points
        .edges
        .iter()
        .map(|edge| edge.map(|i| ids[i]))
        .filter(|[a, b]| a != b)
        .collect();
    border.sort_unstable_by_key(|[a, b]| [*a.min(b), *a.max(b)]);
    let same = |a: &[usize; 2], b: &[usize; 2]| a == b || *a == [b[1], b[0]];
    let border: Vec<[usize; 2]> = border
        .chunk_by(same)
        .filter(|edges| edges.len() % 2 == 1)
        .map(|edges| edges[0])
        .collect();

    let walls: Vec<[DVec2; 2]> = border
        .iter()
        .map(|edge| edge.map(|i| flat(vertices[i].0)))
        .collect();
    let mut crossed = false;
    let Ok(mut delaunay) = Delaunay::try_bulk_load_cdt(vertices, border, |_| crossed = true) else {
        return Faces::default().mesh(&Delaunay::new());
    };
    let walls = crossed.then_some(&walls[..]);
    let mut faces = Faces::of(&delaunay, walls);
    for _ in 0..MAX_ROUNDS {
        let wanted = faces.wanted(&delaunay);
        if wanted.is_empty() {
            break;
        }
        for place in wanted {
            if delaunay.insert(Vertex(place)).is_err() {
                break;
            }
        }
        faces = Faces::of(&delaunay, walls);
    }
    // Triangles too small for another `f32` point are left out.
    while faces.drop_flat() {}
    faces.mesh(&delaunay)
}

fn clear(place: [f32; 2]) -> [f32; 2] {
    // The sum maps -0.0 to 0.0.
    place.map(|x| {
        if f64::from(x).abs() < NOTHING {
            0.0
        } else {
            x + 0.0
        }
    })
}

fn flat(place: [f32; 2]) -> DVec2 {
    let [x, y] = place.map(f64::from);
    DVec2::new(x, y)
}

/// The triangles of a triangulation that lie in the outline.
#[derive(Default)]
struct Faces {
    corners: Vec<[usize; 3]>,
    /// The triangle across the edge from each corner to the next, if that lies in the outline.
    across: Vec<[Option<u32>; 3]>,
    on_border: Vec<bool>,
}

impl Faces {
    /// Walks from triangle to triangle, changing between inside and outside wherever the border is crossed; or, if walls are
    /// given because parts of the border cross each other, tests each triangle by itself.
    fn of(delaunay: &Delaunay, walls: Option<&[[DVec2; 2]]>) -> Self {
        let mut inside: Vec<Option<bool>> = vec![None; delaunay.num_all_faces()];
        if let Some(walls) = walls {
            for face in delaunay.inner_faces() {
                let [a, b, c] = face.vertices().map(|vertex| flat(vertex.data().0));
                inside[face.fix().index()] = Some(encloses(walls, (a + b + c) / 3.0));
            }
        } else {
            let mut open = Vec::new();
            for hull in delaunay.convex_hull() {
                if let Some(face) = hull.rev().face().as_inner() {
                    open.push((face, hull.is_constraint_edge()));
                }
            }
            while let Some((face, is_inside)) = open.pop() {
                let known = &mut inside[face.fix().index()];
                if known.is_some() {
                    continue;
                }
                *known = Some(is_inside);
                for edge in face.adjacent_edges() {
                    if let Some(other) = edge.rev().face().as_inner()
                        && inside[other.fix().index()].is_none()
                    {
                        open.push((other, is_inside != edge.is_constraint_edge()));
                    }
                }
            }
        }

        let mut own = vec![None; inside.len()];
        let mut count = 0;
        for (own, inside) in own.iter_mut().zip(&inside) {
            if *inside == Some(true) {
                *own = Some(count);
                count += 1;
            }
        }
        let mut faces = Faces {
            on_border: vec![false; delaunay.num_vertices()],
            ..Faces::default()
        };
        for face in delaunay.inner_faces() {
            if own[face.fix().index()].is_none() {
                continue;
            }
            let edges = face.adjacent_edges();
            faces
                .corners
                .push(edges.map(|edge| edge.from().fix().index()));
            faces
                .across
                .push(edges.map(|edge| own[edge.rev().face().fix().index()]));
        }
        faces.find_border();
        faces
    }

    fn find_border(&mut self) {
        for (corners, across) in self.corners.iter().zip(&self.across) {
            for i in 0..3 {
                if across[i].is_none() {
                    self.on_border[corners[i]] = true;
                    self.on_border[corners[(i + 1) % 3]] = true;
                }
            }
        }
    }

    /// Whether an edge leads from border to border through the outline, where front and back would meet.
    fn is_chord(&self, face: usize, i: usize) -> bool {
        let corners = self.corners[face];
        self.across[face][i].is_some()
            && self.on_border[corners[i]]
            && self.on_border[corners[(i + 1) % 3]]
    }

    /// Whether a triangle has the border on all sides.
    fn is_alone(&self, face: usize) -> bool {
        self.across[face].iter().all(Option::is_none)
    }

    /// Positions of additional points, so that each triangle has one off the border.
    fn wanted(&self, delaunay: &Delaunay) -> Vec<[f32; 2]> {
        let at = |i: usize| {
            let handle = spade::handles::FixedVertexHandle::from_index(i);
            flat(delaunay.vertex(handle).data().0)
        };
        let mut places = Vec::new();
        for (face, corners) in self.corners.iter().enumerate() {
            if self.is_alone(face) {
                places.push(corners.iter().map(|i| at(*i)).sum::<DVec2>() / 3.0);
            }
            for i in 0..3 {
                let (a, b) = (corners[i], corners[(i + 1) % 3]);
                if a < b && self.is_chord(face, i) {
                    places.push(at(a).midpoint(at(b)));
                }
            }
        }
        let written = |place: DVec2| clear(place.as_vec2().to_array());
        places.into_iter().map(written).collect()
    }

    /// Removes triangles that front and back would share; `false` if there are none.
    fn drop_flat(&mut self) -> bool {
        let flat = |face: usize| self.is_alone(face) || (0..3).any(|i| self.is_chord(face, i));
        let keep: Vec<bool> = (0..self.corners.len()).map(|face| !flat(face)).collect();
        if keep.iter().all(|keep| *keep) {
            return false;
        }
        let mut number = vec![None; keep.len()];
        let mut count = 0;
        for (number, keep) in number.iter_mut().zip(&keep) {
            if *keep {
                *number = Some(count);
                count += 1;
            }
        }
        let mut kept = keep.iter();
        self.corners.retain(|_| kept.next() == Some(&true));
        let mut kept = keep.iter();
        self.across.retain(|_| kept.next() == Some(&true));
        for other in self.across.iter_mut().flatten() {
            *other = other.and_then(|face| number[face as usize]);
        }
        self.find_border();
        true
    }

    /// The triangles with the points they use.
    fn mesh(self, delaunay: &Delaunay) -> Mesh {
        let mut number = vec![u32::MAX; self.on_border.len()];
        let mut mesh = Mesh {
            points: Vec::with_capacity(number.len()),
            triangles: Vec::with_capacity(self.corners.len()),
            on_border: Vec::with_capacity(number.len()),
        };
        for corners in &self.corners {
            let triangle = corners.map(|i| {
                if number[i] == u32::MAX {
                    number[i] = mesh.points.len() as u32;
                    let handle = spade::handles::FixedVertexHandle::from_index(i);
                    mesh.points.push(delaunay.vertex(handle).data().0);
                    mesh.on_border.push(self.on_border[i]);
                }
                number[i]
            });
            mesh.triangles.push(triangle);
        }
        mesh
    }
}

fn encloses(walls: &[[DVec2; 2]], point: DVec2) -> bool {
    walls
        .iter()
        .fold(false, |inside, wall| inside != crosses(*wall, point))
}
