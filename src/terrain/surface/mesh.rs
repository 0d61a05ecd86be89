//! Triangulates polygons that have additional points on their sides.

use glam::{DVec3, Vec3};
use rustc_hash::FxHashMap;

use super::super::grid::Grid;
use super::super::map::CellPictures;
use super::greedy::Facing;
use super::steps;
use crate::scene::Surface;

/// The surfaces under construction, one for each material.
#[derive(Debug)]
pub(super) struct Mesh<'a> {
    /// The pictures of tops, column by column, and the number of rows.
    pictures: Option<(&'a CellPictures, usize)>,
    /// x and z of the map's middle, which is the model's origin.
    middle: [f64; 2],
    materials: Vec<MaterialSurface>,
}

#[derive(Debug, Default)]
struct MaterialSurface {
    surface: Surface,
    /// The index of each corner by its position and facing.
    known: FxHashMap<([i32; 3], Facing), u32>,
}

impl<'a> Mesh<'a> {
    pub(super) fn new(grid: &'a Grid, materials: usize) -> Self {
        let Grid { columns, rows, .. } = *grid;
        Self {
            pictures: grid.pictures.as_ref().map(|pictures| (pictures, rows)),
            middle: [columns as f64 / 2.0, rows as f64 / 2.0],
            materials: (0..materials.max(1))
                .map(|_| MaterialSurface::default())
                .collect(),
        }
    }

    /// Whether the tops of a material show a picture each, and so are single squares.
    pub(super) fn is_pictured(&self, material: u8) -> bool {
        let pictures = self.pictures.map(|(pictures, _)| pictures.material);
        pictures == Some(material)
    }

    /// Texture coordinates of a point. `cell` is the column and the row of the top that the point belongs to, or is beside.
    fn uv(&self, material: u8, facing: Facing, place: [f64; 3], cell: [i32; 2]) -> [f64; 2] {
        let [column, row] = cell;
        let pictured = self.pictures.filter(|_| self.is_pictured(material));
        let found = pictured.and_then(|(pictures, rows)| {
            let cell = usize::try_from(column).ok()? * rows + usize::try_from(row).ok()?;
            Some((pictures.grid, *pictures.places.get(cell)?))
        });
        match found {
            None => uv(facing, place),
            Some((grid, picture)) => {
                let [x, _, z] = place;
                grid.uv(picture, [x - f64::from(column), z - f64::from(row)])
            }
        }
    }

    /// The surfaces that something was added to.
    pub(super) fn finish(self) -> Vec<(u8, Surface)> {
        let all = self.materials.into_iter().enumerate();
        let made = all.filter(|(_, material)| !material.surface.triangles.is_empty());
        made.map(|(index, material)| (index as u8, material.surface))
            .collect()
    }

    /// Adds a corner, shared by all polygons that look in the same direction.
    fn corner(&mut self, material: u8, facing: Facing, point: [i32; 3]) -> u32 {
        let place = steps::place(point);
        let MaterialSurface { surface, known } = &mut self.materials[usize::from(material)];
        *known.entry((point, facing)).or_insert_with(|| {
            push_corner(
                surface,
                self.middle,
                facing.normal(),
                uv(facing, place),
                place,
            )
        })
    }

    /// Adds a corner that no other polygon shares.
    fn push(&mut self, material: u8, facing: Facing, place: [f64; 3], cell: [i32; 2]) -> u32 {
        let uv = self.uv(material, facing, place, cell);
        let surface = &mut self.materials[usize::from(material)].surface;
        push_corner(surface, self.middle, facing.normal(), uv, place)
    }

    /// Adds an axis-aligned rectangle with points on its sides. `sides` are the four sides, each without its end, counter-clockwise
    /// seen from outside.
    pub(super) fn rectangle(&mut self, material: u8, facing: Facing, sides: &[Vec<[i32; 3]>; 4]) {
        // Corners of pictures have texture coordinates of their own.
        let [x, _, z] = sides[0][0];
        let cell = [x, z];
        let pictured = self.is_pictured(material);
        let ids = sides.each_ref().map(|side| -> Vec<u32> {
            side.iter()
                .map(|point| match pictured {
                    true => self.push(material, facing, steps::place(*point), cell),
                    false => self.corner(material, facing, *point),
                })
                .collect()
        });
        let plain = |side: usize| ids[side].len() == 1;
        if plain(1) && plain(3) {
            self.zip(material, &ids, 0);
        } else if plain(0) && plain(2) {
            self.zip(material, &ids, 1);
        } else {
            // A fan about the middle has no degenerate triangle.
            let [a, b] = [sides[0][0], sides[2][0]].map(steps::place);
            let middle = [0, 1, 2].map(|axis| (a[axis] + b[axis]) / 2.0);
            let center = self.push(material, facing, middle, cell);
            let surface = &mut self.materials[usize::from(material)].surface;
            let ring: Vec<u32> = ids.concat();
            let next = ring.iter().cycle().skip(1);
            let fan = ring
                .iter()
                .zip(next)
                .map(|(one, other)| [center, *one, *other]);
            surface.triangles.extend(fan);
        }
    }

    /// Joins the points of two opposite sides if the other two sides have no points.
    fn zip(&mut self, material: u8, ids: &[Vec<u32>; 4], first: usize) {
        let line = |side: usize| {
            let end = ids[(side + 1) % 4][0];
            ids[side].iter().copied().chain([end]).collect::<Vec<_>>()
        };
        let below = line(first);
        let mut above = line(first + 2);
        above.reverse();
        let triangles = &mut self.materials[usize::from(material)].surface.triangles;
        let [mut i, mut j] = [0, 0];
        while i + 1 < below.len() || j + 1 < above.len() {
            // Advance on the side that lags behind.
            let lags = j + 1 == above.len()
                || (i + 1 < below.len() && i * (above.len() - 1) <= j * (below.len() - 1));
            if lags {
                triangles.push([below[i], below[i + 1], above[j]]);
                i += 1;
            } else {
                triangles.push([below[i], above[j + 1], above[j]]);
                j += 1;
            }
        }
    }

    /// Adds a polygon whose corners have these normals. Points at the same position are merged. `cell` is the column and
    /// the row of the top that it has its material from.
    pub(super) fn smooth_polygon(
        &mut self,
        material: u8,
        facing: Facing,
        cell: [i32; 2],
        points: &[([f64; 3], [f32; 3])],
    ) {
        let mut ring: Vec<([f64; 3], [f32; 3])> = points.to_vec();
        ring.dedup_by(|next, last| next.0 == last.0);
        if ring.len() > 1 && ring[0].0 == ring[ring.len() - 1].0 {
            ring.pop();
        }
        if ring.len() < 3 {
            return;
        }
        let mut add = |place: [f64; 3], normal: [f32; 3]| {
            let uv = self.uv(material, facing, place, cell);
            let surface = &mut self.materials[usize::from(material)].surface;
            push_corner(surface, self.middle, normal, uv, place)
        };
        let ids: Vec<u32> = ring
            .iter()
            .map(|(place, normal)| add(*place, *normal))
            .collect();
        if let [a, b, c, rest @ ..] = ids.as_slice()
            && rest.len() < 2
        {
            let surface = &mut self.materials[usize::from(material)].surface;
            let triangles = match rest {
                [d] => halves(surface, [*a, *b, *c, *d]).to_vec(),
                _ => vec![[*a, *b, *c]],
            };
            for triangle in triangles {
                push_triangle(surface, triangle);
            }
            return;
        }
        let sum = |of: &dyn Fn(usize) -> [f64; 3]| {
            (0..ring.len()).map(of).fold([0.0; 3], |sum, add| {
                [0, 1, 2].map(|axis| sum[axis] + add[axis])
            })
        };
        let middle = sum(&|at| ring[at].0).map(|value| value / ring.len() as f64);
        let normal = sum(&|at| ring[at].1.map(f64::from));
        let length = normal.iter().map(|value| value * value).sum::<f64>().sqrt();
        let normal = if length > 1e-6 {
            normal.map(|value| (value / length) as f32)
        } else {
            facing.normal()
        };
        let center = add(middle, normal);
        let surface = &mut self.materials[usize::from(material)].surface;
        let next = ids.iter().cycle().skip(1);
        for (one, other) in ids.iter().zip(next) {
            push_triangle(surface, [center, *one, *other]);
        }
    }

    /// Adds a flat convex polygon as a triangle fan about its first point, which must not be collinear with any two neighbours.
    pub(super) fn fan(&mut self, material: u8, normal: [f32; 3], points: &[([f64; 3], [f64; 2])]) {
        let surface = &mut self.materials[usize::from(material)].surface;
        let ids: Vec<u32> = points
            .iter()
            .map(|(place, uv)| push_corner(surface, self.middle, normal, *uv, *place))
            .collect();
        let pairs = ids[1..].windows(2);
        surface
            .triangles
            .extend(pairs.map(|pair| [ids[0], pair[0], pair[1]]));
    }
}

/// Cuts a quadrilateral along the diagonal that leaves both triangles facing as its corners' normals do. Where a wide bevel bends
/// a corner inward, only one diagonal does.
fn halves(surface: &Surface, [a, b, c, d]: [u32; 4]) -> [[u32; 3]; 2] {
    let place = |corner: u32| DVec3::from(Vec3::from(surface.positions[corner as usize]));
    let normals = [a, b, c, d].map(|corner| Vec3::from(surface.normals[corner as usize]));
    let facing = DVec3::from(normals.into_iter().sum::<Vec3>());
    let least = |halves: &[[u32; 3]; 2]| {
        let areas = halves.map(|[a, b, c]| {
            let [a, b, c] = [a, b, c].map(place);
            (b - a).cross(c - a).dot(facing)
        });
        areas[0].min(areas[1])
    };
    let [usual, other] = [[[a, b, c], [a, c, d]], [[a, b, d], [b, c, d]]];
    if least(&usual) < 0.0 && least(&other) > least(&usual) {
        other
    } else {
        usual
    }
}

/// Adds a triangle, unless two of its corners coincide.
fn push_triangle(surface: &mut Surface, triangle: [u32; 3]) {
    let [a, b, c] = triangle.map(|corner| surface.positions[corner as usize]);
    if a != b && b != c && c != a {
        surface.triangles.push(triangle);
    }
}

/// Adds a corner; its index.
fn push_corner(
    surface: &mut Surface,
    middle: [f64; 2],
    normal: [f32; 3],
    uv: [f64; 2],
    [x, y, z]: [f64; 3],
) -> u32 {
    let index = surface.positions.len() as u32;
    let place = [x - middle[0], y, z - middle[1]];
    surface.positions.push(place.map(|value| value as f32));
    surface.normals.push(normal);
    surface.uvs.push(uv.map(|value| value as f32));
    index
}

/// Texture coordinates in tiles: aligned with the map on tops, upright on fronts.
fn uv(facing: Facing, [x, y, z]: [f64; 3]) -> [f64; 2] {
    match facing {
        Facing::Up | Facing::Down => [x, z],
        Facing::Front | Facing::Back => [x, -y],
        Facing::Right | Facing::Left => [z, -y],
    }
}
