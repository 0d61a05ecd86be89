//! Triangles: polygons whose sides are straight lines with points on them.

use rustc_hash::FxHashMap;

use super::sweep::Facing;
use crate::scene::Surface;

/// Surfaces on their way, one a look.
#[derive(Debug)]
pub(super) struct Mesh {
    /// Half the map's extent: x and z of the middle, which is where the model's origin is.
    middle: [f64; 2],
    looks: Vec<Look>,
}

#[derive(Debug, Default)]
struct Look {
    surface: Surface,
    /// Corners that are there already.
    known: FxHashMap<([i32; 3], Facing), u32>,
}

impl Mesh {
    pub(super) fn new(columns: usize, rows: usize, looks: usize) -> Self {
        Self {
            middle: [columns as f64 / 2.0, rows as f64 / 2.0],
            looks: (0..looks.max(1)).map(|_| Look::default()).collect(),
        }
    }

    /// The surfaces that something was added to.
    pub(super) fn finish(self) -> Vec<(u8, Surface)> {
        let all = self.looks.into_iter().enumerate();
        let made = all.filter(|(_, look)| !look.surface.triangles.is_empty());
        made.map(|(index, look)| (index as u8, look.surface))
            .collect()
    }

    /// Adds a corner, once for all polygons that look the same way.
    fn corner(&mut self, look: u8, facing: Facing, point: [i32; 3]) -> u32 {
        let place = point.map(f64::from);
        let Look { surface, known } = &mut self.looks[usize::from(look)];
        *known.entry((point, facing)).or_insert_with(|| {
            push(
                surface,
                self.middle,
                facing.normal(),
                uv(facing, place),
                place,
            )
        })
    }

    /// Adds a flat polygon that looks along an axis: a rectangle with points on its sides. `sides` are the four sides, each
    /// without its end, counter-clockwise seen from outside.
    pub(super) fn rectangle(&mut self, look: u8, facing: Facing, sides: &[Vec<[i32; 3]>; 4]) {
        let ids = sides.each_ref().map(|side| -> Vec<u32> {
            side.iter()
                .map(|point| self.corner(look, facing, *point))
                .collect()
        });
        let plain = |side: usize| ids[side].len() == 1;
        if plain(1) && plain(3) {
            self.zip(look, &ids, 0);
        } else if plain(0) && plain(2) {
            self.zip(look, &ids, 1);
        } else {
            // A point in the middle sees all sides, and no triangle is flat.
            let [a, b] = [sides[0][0], sides[2][0]];
            let middle = [0, 1, 2].map(|axis| f64::from(a[axis] + b[axis]) / 2.0);
            let surface = &mut self.looks[usize::from(look)].surface;
            let centre = push(
                surface,
                self.middle,
                facing.normal(),
                uv(facing, middle),
                middle,
            );
            let ring: Vec<u32> = ids.concat();
            let next = ring.iter().cycle().skip(1);
            let fan = ring
                .iter()
                .zip(next)
                .map(|(one, other)| [centre, *one, *other]);
            surface.triangles.extend(fan);
        }
    }

    /// Joins the points of a side with those of the opposite one, where the other two have none.
    fn zip(&mut self, look: u8, ids: &[Vec<u32>; 4], first: usize) {
        let line = |side: usize| {
            let end = ids[(side + 1) % 4][0];
            ids[side].iter().copied().chain([end]).collect::<Vec<_>>()
        };
        let below = line(first);
        let mut above = line(first + 2);
        above.reverse();
        let triangles = &mut self.looks[usize::from(look)].surface.triangles;
        let [mut i, mut j] = [0, 0];
        while i + 1 < below.len() || j + 1 < above.len() {
            // The side that lags behind goes on.
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

    /// Adds a fan of triangles around its first point: a flat convex polygon no other point of which lies on a line with
    /// the first and its neighbour.
    pub(super) fn fan(&mut self, look: u8, normal: [f32; 3], points: &[([f64; 3], [f64; 2])]) {
        let surface = &mut self.looks[usize::from(look)].surface;
        let ids: Vec<u32> = points
            .iter()
            .map(|(place, uv)| push(surface, self.middle, normal, *uv, *place))
            .collect();
        let pairs = ids[1..].windows(2);
        surface
            .triangles
            .extend(pairs.map(|pair| [ids[0], pair[0], pair[1]]));
    }
}

/// Adds a corner and says which it is.
fn push(
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

/// Texture coordinates in tiles: on tops as the map lies, on fronts upright.
fn uv(facing: Facing, [x, y, z]: [f64; 3]) -> [f64; 2] {
    match facing {
        Facing::Up | Facing::Down => [x, z],
        Facing::Front | Facing::Back => [x, -y],
        Facing::Right | Facing::Left => [z, -y],
    }
}
