//! Computes corners and normals for an indexed list of triangles.

use glam::{DVec3, Vec3};

use super::crease::{Crease, share, share_tip};
use crate::scene::Surface;

/// The surface of triangles over shared points, counter-clockwise seen from outside. `is_tip` names the points
/// at which a cone may end.
pub(super) fn shade(
    points: &[[f32; 3]],
    triangles: &[[u32; 3]],
    crease: Crease,
    is_tip: impl Fn(u32) -> bool,
) -> Surface {
    let at = |i: u32| Vec3::from(points[i as usize]).as_dvec3();
    let mut faces = Vec::with_capacity(triangles.len());
    let mut angles = Vec::with_capacity(triangles.len());
    for triangle in triangles {
        let [a, b, c] = triangle.map(at);
        let sides = [b - a, c - b, a - c].map(DVec3::normalize_or_zero);
        // Sides are normalised first, or their product could underflow.
        let best = (0..3).map(|i| sides[i].cross(sides[(i + 1) % 3]));
        let best = best.max_by(|a, b| a.length_squared().total_cmp(&b.length_squared()));
        faces.push(best.unwrap_or_default().normalize_or(DVec3::Z));
        let angle = |i: usize| {
            let (into, out) = (-sides[(i + 2) % 3], sides[i]);
            into.cross(out).length().atan2(into.dot(out)).max(1e-9)
        };
        angles.push([angle(0), angle(1), angle(2)]);
    }

    // The corners at each point: where they start in the list, and each as three times the triangle's index plus the
    // corner's.
    let mut starts = vec![0u32; points.len() + 1];
    for i in triangles.iter().flatten() {
        starts[*i as usize + 1] += 1;
    }
    for i in 0..points.len() {
        starts[i + 1] += starts[i];
    }
    let mut places = starts.clone();
    let mut corners = vec![0u32; 3 * triangles.len()];
    for (corner, i) in triangles.iter().flatten().enumerate() {
        let place = &mut places[*i as usize];
        corners[*place as usize] = corner as u32;
        *place += 1;
    }

    let mut surface = Surface {
        triangles: vec![[0; 3]; triangles.len()],
        ..Surface::default()
    };
    surface.positions.reserve(points.len());
    surface.normals.reserve(points.len());
    let split = |corner: u32| ((corner / 3) as usize, (corner % 3) as usize);
    let other = |corner: u32, step: usize| {
        let (triangle, i) = split(corner);
        triangles[triangle][(i + step) % 3]
    };
    let mut done = Vec::new();
    let (mut fan, mut normals, mut weights, mut ids) = (vec![], vec![], vec![], vec![]);
    for (point, position) in points.iter().enumerate() {
        let around = &mut corners[starts[point] as usize..starts[point + 1] as usize];
        around.sort_unstable_by_key(|corner| other(*corner, 1));
        done.clear();
        done.resize(around.len(), false);
        // More than one fan if parts of the surface meet in a point.
        for first in 0..around.len() {
            fan.clear();
            let mut next = Some(first);
            while let Some(place) = next.filter(|place| !done[*place]) {
                done[place] = true;
                fan.push(around[place]);
                let edge = other(around[place], 2);
                next = around.binary_search_by_key(&edge, |c| other(*c, 1)).ok();
            }
            if fan.is_empty() {
                continue;
            }
            normals.clear();
            normals.extend(fan.iter().map(|corner| faces[split(*corner).0]));
            weights.clear();
            weights.extend(fan.iter().map(|corner| {
                let (triangle, i) = split(*corner);
                angles[triangle][i]
            }));
            ids.clear();
            ids.resize(fan.len(), 0);
            let corner = |normal: DVec3| {
                surface.positions.push(*position);
                surface.normals.push(normal.as_vec3().to_array());
                surface.positions.len() as u32 - 1
            };
            if is_tip(point as u32) {
                share_tip(&normals, &weights, crease, corner, &mut ids);
            } else {
                share(&normals, &weights, crease, corner, &mut ids);
            }
            for ((corner, id), face) in fan.iter().zip(&ids).zip(&normals) {
                let (triangle, i) = split(*corner);
                let mut id = *id;
                // Where faces fold sharply, one may face away from their mean; at least one does not.
                let shared = Vec3::from(surface.normals[id as usize]).as_dvec3();
                if shared.dot(*face) <= 0.0 {
                    id = surface.positions.len() as u32;
                    surface.positions.push(*position);
                    surface.normals.push(face.as_vec3().to_array());
                }
                surface.triangles[triangle][i] = id;
            }
        }
    }
    surface
}
