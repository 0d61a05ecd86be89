//! Triangles between the points of an inflated outline.
//!
//! Points are rounded to their final `f32` positions first and triangulated there, so that rounding cannot make a triangle
//! degenerate.

use glam::DVec2;
use rustc_hash::FxHashSet;

use super::delaunay::Delaunay;
use super::points::Points;
use crate::geometry::{Bands, bounds_of};
use crate::solid::stack::PlacementTransform;

/// The number of rounds in which triangles without an inner point are given one.
const MAX_ROUNDS: usize = 3;
/// With more points than this, some are spread when they are inserted.
const MANY: usize = 1 << 12;
/// How many points of a level are spread at most.
const MOST_SPREAD: usize = 1 << 10;
/// Smaller coordinates are 0: their products would underflow in the triangulation.
const NOTHING: f64 = 1e-40;

/// Triangles in the plane, at their final positions.
#[derive(Debug, Default)]
pub struct Mesh {
    /// Their final positions, as seen from the front.
    pub(in crate::solid) points: Vec<[f32; 2]>,
    /// Counter-clockwise, all with area; each has a point off the border.
    pub(in crate::solid) triangles: Vec<[u32; 3]>,
    pub(in crate::solid) on_border: Vec<bool>,
    /// Whether separate parts of the border meet in a point.
    pub(in crate::solid) has_pinches: bool,
}

impl Mesh {
    /// The edges of the border, the filled side on the left.
    pub(in crate::solid) fn border(&self) -> Vec<[u32; 2]> {
        let is_on_border =
            |[a, b]: &[u32; 2]| self.on_border[*a as usize] && self.on_border[*b as usize];
        let along = self.triangles.iter().flat_map(sides).filter(is_on_border);
        let edges: FxHashSet<[u32; 2]> = along.clone().collect();
        along.filter(|[a, b]| !edges.contains(&[*b, *a])).collect()
    }
}

fn sides([a, b, c]: &[u32; 3]) -> [[u32; 2]; 3] {
    [[*a, *b], [*b, *c], [*c, *a]]
}

/// Joins points by a Delaunay triangulation that keeps the border's edges.
pub(in crate::solid) fn mesh(points: &Points, transform: &PlacementTransform) -> Mesh {
    let places = points.points.iter();
    let places: Vec<DVec2> = places
        .map(|point| clear(transform.in_plane(*point)))
        .collect();
    let bounds = bounds_of(places.iter().copied());
    let Some((low, high)) = bounds.filter(|_| places.iter().all(|place| place.is_finite())) else {
        return Mesh::default();
    };

    let mut delaunay = Delaunay::around(low, high, places.len());
    let mut vertices = Vec::with_capacity(places.len());
    let borders = points.edges.iter().flatten().max();
    let (border, inner) = places.split_at(borders.map_or(0, |last| last + 1));
    insert(&mut delaunay, border, &mut vertices);
    let mut is_crossed = false;
    for edge in &points.edges {
        if let [Some(from), Some(to)] = edge.map(|i| vertices[i]) {
            is_crossed |= !delaunay.toggle_wall(from, to);
        }
    }
    if is_crossed {
        // Triangles that cross the border should be small when they are told apart.
        insert(&mut delaunay, inner, &mut vertices);
        let walls = points.edges.iter().map(|edge| edge.map(|i| places[i]));
        let walls = Bands::new(walls.collect());
        delaunay.find_inside(Some(|point| walls.contains(point)));
    } else {
        delaunay.find_inside(None::<fn(DVec2) -> bool>);
        insert(&mut delaunay, inner, &mut vertices);
    }

    let mut wanted = Vec::new();
    for _ in 0..MAX_ROUNDS {
        delaunay.wanted(&mut wanted);
        if wanted.is_empty() {
            return numbered(&delaunay, &vertices);
        }
        for (place, near) in &wanted {
            let written = clear(place.as_vec2().to_array());
            vertices.push(delaunay.insert(written, *near));
        }
    }
    // Triangles too small for another `f32` point are left out.
    while delaunay.drop_flat() {}
    numbered(&delaunay, &vertices)
}

/// Inserts points, and notes for each its vertex. Coarse first, then between: so that no order of the points is a bad one, and
/// each is near a known one.
fn insert(delaunay: &mut Delaunay, places: &[DVec2], vertices: &mut Vec<Option<u32>>) {
    let start = vertices.len();
    let count = places.len();
    vertices.resize(start + count, None);
    // The vertex from which to search; that of a point nearby if the point has none.
    let mut near = vec![delaunay.any(); count];
    let mut add = |i: usize, parent: usize| {
        let vertex = delaunay.insert(places[i], near[parent]);
        vertices[start + i] = vertex;
        near[i] = vertex.unwrap_or(near[parent]);
    };
    if count > 0 {
        add(0, 0);
    }
    let mut step = count.next_power_of_two() / 2;
    while step > 0 {
        let between = (count - step).div_ceil(2 * step);
        for k in spread(between, count > MANY) {
            let i = (2 * k + 1) * step;
            add(i, i - step);
        }
        step /= 2;
    }
}

/// The numbers below a count, once each. If they are to be spread, those that begin a block come first, in the order of their reversed
/// bits, so that each lies far from those before it; the others ascend. Of long rows beside each other, each point in ascending order
/// would flip the edges that the one before it has led past all rows to come; but spreading all of them would miss the cache.
fn spread(count: usize, is_spread: bool) -> impl Iterator<Item = usize> {
    let block = if is_spread {
        count.div_ceil(MOST_SPREAD).next_power_of_two()
    } else {
        count.max(1)
    };
    let blocks = count.div_ceil(block).next_power_of_two();
    // The bits above those of a block's number; all of them if there is one block.
    let above = usize::BITS - blocks.trailing_zeros();
    let reversed = move |k: usize| k.reverse_bits().checked_shr(above).unwrap_or(0);
    let first = (0..blocks).map(move |k| reversed(k) * block);
    let others = (0..count).filter(move |k| k % block != 0);
    first.filter(move |k| *k < count).chain(others)
}

/// A final position.
fn clear(place: [f32; 2]) -> DVec2 {
    // The sum maps -0.0 to 0.0.
    let [x, y] = place
        .map(f64::from)
        .map(|x| if x.abs() < NOTHING { 0.0 } else { x + 0.0 });
    DVec2::new(x, y)
}

/// The triangles in the outline with the points they use, in the order of these.
fn numbered(delaunay: &Delaunay, vertices: &[Option<u32>]) -> Mesh {
    const UNUSED: u32 = u32::MAX;
    let mut number = vec![UNUSED; delaunay.len()];
    let mut mesh = Mesh {
        triangles: delaunay.inner().collect(),
        has_pinches: delaunay.has_pinches,
        ..Mesh::default()
    };
    for vertex in mesh.triangles.iter().flatten() {
        number[*vertex as usize] = 0;
    }
    let mut is_new = vec![true; delaunay.len()];
    for vertex in vertices.iter().flatten() {
        let i = *vertex as usize;
        if number[i] != UNUSED && std::mem::take(&mut is_new[i]) {
            number[i] = mesh.points.len() as u32;
            mesh.points.push(delaunay.at(*vertex).as_vec2().to_array());
            mesh.on_border.push(delaunay.is_on_border(*vertex));
        }
    }
    for corner in mesh.triangles.iter_mut().flatten() {
        *corner = number[*corner as usize];
    }
    mesh
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spread_numbers_are_there_once() {
        for count in [0, 1, 2, 3, 7, 1000, 1024, 1025, 5000] {
            let ascending: Vec<usize> = (0..count).collect();
            assert!(spread(count, false).eq(0..count));
            let mut spread: Vec<usize> = spread(count, true).collect();
            assert!(count < 3 || spread[1] > count / 3, "{spread:?}");
            spread.sort_unstable();
            assert_eq!(spread, ascending);
        }
    }
}
