//! A fast path for prisms, the most common solids; [`super::shell`] is the general case.

use glam::DVec2;

use super::crease::Crease;
use super::rings::Rings;
use super::stack::{Form, Level, PlacementTransform};
use crate::scene::Surface;

/// The prism between two equal copies of an outline; `None` for other levels, or if its walls may share corners with its
/// caps.
pub(super) fn prism(
    rings: &Rings,
    levels: &[Level],
    caps: &[Vec<[u32; 3]>; 2],
    crease: Crease,
    transform: &PlacementTransform,
) -> Option<Surface> {
    let [low, high] = levels else { return None };
    let whole = |level: &Level| level.form == Form::Rings && level.scale == DVec2::ONE;
    if !whole(low) || !whole(high) || crease.spans_right_angles() {
        return None;
    }
    let n = rings.len();
    let depths = [transform.depth(low.z), transform.depth(high.z)];
    let plane: Vec<[f32; 2]> = rings
        .points
        .iter()
        .map(|p| transform.in_plane(*p))
        .collect();
    let mut surface = Surface::default();
    let Surface {
        positions,
        normals,
        triangles,
        ..
    } = &mut surface;
    positions.reserve(6 * n);
    normals.reserve(6 * n);
    triangles.reserve(2 * n + caps[0].len() + caps[1].len());

    for (depth, normal) in [(depths[0], -1.0), (depths[1], 1.0)] {
        positions.extend(plane.iter().map(|[x, y]| [*x, *y, depth]));
        normals.resize(positions.len(), [0.0, 0.0, normal]);
    }
    let top = n as u32;
    triangles.extend(caps[0].iter().map(|[a, b, c]| [*a, *c, *b]));
    triangles.extend(caps[1].iter().map(|t| t.map(|corner| corner + top)));

    let walls: Vec<DVec2> = (0..n)
        .map(|i| {
            let along = rings.points[rings.next[i] as usize] - rings.points[i];
            DVec2::new(along.y, -along.x).normalize_or(DVec2::X)
        })
        .collect();
    // The index of the lower corner at each point, of the wall before it and of the wall after it; the upper corner has the next
    // index.
    let mut corners: Vec<[u32; 2]> = Vec::with_capacity(n);
    let mut edge = |normal: DVec2, [x, y]: [f32; 2]| {
        let corner = positions.len() as u32;
        positions.extend(depths.map(|depth| [x, y, depth]));
        let normal = transform.normal(normal.extend(0.0));
        normals.extend([normal; 2]);
        corner
    };
    for i in 0..n {
        let (before, after) = (walls[rings.before[i] as usize], walls[i]);
        corners.push(if crease.is_smooth(before.dot(after)) {
            [edge((before + after).normalize_or(after), plane[i]); 2]
        } else {
            [edge(before, plane[i]), edge(after, plane[i])]
        });
    }
    for i in 0..n {
        let (a, b) = (corners[i][1], corners[rings.next[i] as usize][0]);
        triangles.extend([[a, b, b + 1], [a, b + 1, a + 1]]);
    }
    Some(surface)
}
