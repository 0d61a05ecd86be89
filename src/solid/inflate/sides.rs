//! Front and back of an inflated outline as one surface.

use glam::{DVec3, Vec3};

use super::{Field, MIN_HEIGHT};
use crate::scene::Surface;
use crate::solid::crease::Crease;
use crate::solid::shade::{Face, shade};

/// Both sides of a height field: points and triangles of the front, then those of the back. Both sides share the border.
pub(super) struct Sides {
    points: Vec<[f32; 3]>,
    triangles: Vec<[u32; 3]>,
    /// Per point of the front, that behind it.
    back: Vec<u32>,
}

impl Sides {
    /// The sides of a field about a depth, model units.
    pub(super) fn of(field: &Field, middle: f64) -> Self {
        let mesh = &field.mesh;
        let count = mesh.points.len();
        let least = MIN_HEIGHT * middle.abs();
        let height = |i: usize| {
            if mesh.on_border[i] {
                0.0
            } else {
                field.heights[i].max(least)
            }
        };
        let mut points = Vec::with_capacity(2 * count);
        let front = mesh.points.iter().enumerate();
        points.extend(front.map(|(i, [x, y])| [*x, *y, (middle + height(i)) as f32]));
        let mut back = Vec::with_capacity(count);
        for (i, [x, y]) in mesh.points.iter().enumerate() {
            if mesh.on_border[i] {
                back.push(i as u32);
            } else {
                back.push(points.len() as u32);
                points.push([*x, *y, (middle - height(i)) as f32]);
            }
        }
        let mut triangles = Vec::with_capacity(2 * mesh.triangles.len());
        triangles.extend_from_slice(&mesh.triangles);
        triangles.extend(mesh.triangles.iter().map(|triangle| {
            let [a, b, c] = triangle.map(|i| back[i as usize]);
            [a, c, b]
        }));
        Self {
            points,
            triangles,
            back,
        }
    }

    /// The surface with edges below a crease angle smooth.
    pub(super) fn shaded(self, crease: Crease) -> Surface {
        shade(&self.points, &self.triangles, crease, |_| false)
    }

    /// The surface with all edges smooth, where the triangles around each point make one fan. Normals are computed for the front:
    /// those of the back mirror them, and those of the border have no depth, because both sides add to them.
    pub(super) fn smooth(self) -> Surface {
        let Self {
            points,
            triangles,
            back,
        } = self;
        let half = triangles.len() / 2;
        let at = |i: u32| Vec3::from(points[i as usize]).as_dvec3();
        let front = triangles[..half].iter();
        let faces: Vec<Face> = front
            .map(|[a, b, c]| Face::of([at(*a), at(*b), at(*c)]))
            .collect();
        let mut sums = vec![DVec3::ZERO; back.len()];
        for (face, triangle) in faces.iter().zip(&triangles) {
            for (i, angle) in triangle.iter().zip(face.angles) {
                sums[*i as usize] += face.normal * angle;
            }
        }
        let mut normals = Vec::with_capacity(points.len());
        for (i, sum) in (0..).zip(&mut sums) {
            if back[i as usize] == i {
                sum.z = 0.0;
            }
            let any = || {
                let with = triangles.iter().zip(&faces);
                let mut with = with.filter(|(triangle, _)| triangle.contains(&i));
                with.next().map_or(DVec3::Z, |(_, face)| face.normal)
            };
            let normal = sum.try_normalize().unwrap_or_else(any);
            normals.push(normal.as_vec3().to_array());
        }
        normals.resize(points.len(), [0.0; 3]);
        for (i, behind) in back.iter().enumerate() {
            if *behind != i as u32 {
                normals[*behind as usize] = mirrored(normals[i]);
            }
        }
        let mut surface = Surface {
            positions: points,
            normals,
            triangles,
            ..Surface::default()
        };
        turn_outward(&mut surface, &faces);
        surface
    }
}

/// Where faces fold sharply, one may face away from their mean: it gets corners of its own, and so does that behind it.
fn turn_outward(surface: &mut Surface, faces: &[Face]) {
    for (front, face) in faces.iter().enumerate() {
        let normal = face.normal.as_vec3();
        for corner in 0..3 {
            let id = surface.triangles[front][corner] as usize;
            if Vec3::from(surface.normals[id]).dot(normal) > 0.0 {
                continue;
            }
            // The order of a triangle's corners is the other way round behind.
            let behind = (front + faces.len(), (3 - corner) % 3);
            let normal = normal.to_array();
            for ((triangle, corner), normal) in
                [((front, corner), normal), (behind, mirrored(normal))]
            {
                let id = &mut surface.triangles[triangle][corner];
                let position = surface.positions[*id as usize];
                *id = surface.positions.len() as u32;
                surface.positions.push(position);
                surface.normals.push(normal);
            }
        }
    }
}

fn mirrored([x, y, z]: [f32; 3]) -> [f32; 3] {
    [x, y, -z]
}
