//! Computes corners and normals for an indexed list of triangles.

use glam::{DVec3, Vec3};

use super::crease::{Crease, share, share_tip};
use crate::scene::Surface;

/// The least weight of a face in the normal of a corner.
const MIN_ANGLE: f64 = 1e-9;

/// The unit normal of a triangle and its angles, radians.
pub(super) struct Face {
    pub(super) normal: DVec3,
    pub(super) angles: [f64; 3],
}

impl Face {
    pub(super) fn of([a, b, c]: [DVec3; 3]) -> Self {
        // Products of three lengths of `f32` positions neither underflow nor overflow in `f64`.
        let (ab, bc, ca) = (b - a, c - b, a - c);
        let lengths = [ab, bc, ca].map(DVec3::length);
        let inverse = (lengths[0] * lengths[1] * lengths[2]).recip();
        let cosines = [
            -ca.dot(ab) * lengths[1] * inverse,
            -ab.dot(bc) * lengths[2] * inverse,
            -bc.dot(ca) * lengths[0] * inverse,
        ];
        // The shorter two sides give the normal of a needle most precisely.
        let [one, other] = match lengths {
            [x, y, z] if x >= y && x >= z => [bc, ca],
            [_, y, z] if y >= z => [ca, ab],
            _ => [ab, bc],
        };
        let long = one.cross(other);
        let length = long.length();
        Self {
            normal: if length > 0.0 {
                long / length
            } else {
                DVec3::Z
            },
            angles: cosines.map(angle),
        }
    }
}

/// The angle with a cosine, to 7e-5, but not 0: Abramowitz & Stegun 4.4.45. Much faster than the exact one, and as good for a
/// weight.
fn angle(cosine: f64) -> f64 {
    let x = cosine.abs().min(1.0);
    let polynomial = 1.570_728_8 + x * (-0.212_114_4 + x * (0.074_261_0 - x * 0.018_729_3));
    let angle = (1.0 - x).sqrt() * polynomial;
    if cosine < 0.0 {
        std::f64::consts::PI - angle
    } else {
        angle.max(MIN_ANGLE)
    }
}

/// The surface of triangles over shared points, counter-clockwise seen from outside. `is_tip` names the points
/// at which a cone may end.
pub(super) fn shade(
    points: &[[f32; 3]],
    triangles: &[[u32; 3]],
    crease: Crease,
    is_tip: impl Fn(u32) -> bool,
) -> Surface {
    let at = |i: u32| Vec3::from(points[i as usize]).as_dvec3();
    let faces = triangles.iter();
    let faces: Vec<Face> = faces.map(|triangle| Face::of(triangle.map(at))).collect();

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
    // Some points have several corners.
    let corners_expected = points.len() + points.len() / 4;
    surface.positions.reserve(corners_expected);
    surface.normals.reserve(corners_expected);
    let split = |corner: u32| ((corner / 3) as usize, (corner % 3) as usize);
    let other = |corner: u32, step: usize| {
        let (triangle, i) = split(corner);
        triangles[triangle][(i + step) % 3]
    };
    let (mut around, mut done) = (Vec::new(), Vec::new());
    let (mut fan, mut normals, mut weights, mut ids) = (vec![], vec![], vec![], vec![]);
    for (point, position) in points.iter().enumerate() {
        let here = &corners[starts[point] as usize..starts[point + 1] as usize];
        around.clear();
        around.extend(here.iter().map(|corner| (other(*corner, 1), *corner)));
        around.sort_unstable();
        done.clear();
        done.resize(around.len(), false);
        // More than one fan if parts of the surface meet in a point.
        for first in 0..around.len() {
            fan.clear();
            let mut next = Some(first);
            while let Some(place) = next.filter(|place| !done[*place]) {
                done[place] = true;
                let (_, corner) = around[place];
                fan.push(corner);
                let edge = other(corner, 2);
                next = around.binary_search_by_key(&edge, |(next, _)| *next).ok();
            }
            if fan.is_empty() {
                continue;
            }
            normals.clear();
            normals.extend(fan.iter().map(|corner| faces[split(*corner).0].normal));
            weights.clear();
            weights.extend(fan.iter().map(|corner| {
                let (triangle, i) = split(*corner);
                faces[triangle].angles[i]
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
