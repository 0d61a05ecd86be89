//! The surface that joins the layers of a stack.
//!
//! A band of walls joins each layer to the next; the first and the last layer are closed by a cap,
//! unless they are a line or a point.

use glam::DVec3;

use super::crease::{Crease, share, share_tip};
use super::rings::Rings;
use super::stack::{Base, Form, Level, PlacementTransform, rises};
use crate::math;
use crate::scene::Surface;

/// Per point of a level, the corners that its adjacent walls use: the wall before the point and
/// the one after it, below the level and above.
#[derive(Default)]
struct Corners {
    below: Vec<[u32; 2]>,
    above: Vec<[u32; 2]>,
    cap: Vec<u32>,
}

struct Shell<'a> {
    rings: &'a Rings,
    stations: Option<&'a [u32]>,
    /// The first and the last station, if both sides meet there in one point.
    tips: [Option<u32>; 2],
    /// Walls are split into four triangles about their middles.
    warped: bool,
    levels: &'a [Level],
    /// Unit normals of the walls, band by band; a wall has the index of the point it starts at.
    walls: Vec<DVec3>,
    crease: Crease,
    transform: &'a PlacementTransform,
    surface: Surface,
}

/// Joins levels of a base; `caps` close the first and the last.
pub(super) fn shell(
    base: &Base,
    levels: &[Level],
    caps: &[Vec<[u32; 3]>; 2],
    crease: Crease,
    transform: &PlacementTransform,
) -> Surface {
    let (rings, stations) = (base.rings(), base.stations());
    let n = rings.len();
    let end = levels.len() - 1;
    let mut shell = Shell {
        rings,
        stations,
        warped: base.is_warped(),
        tips: stations.map_or([None; 2], tips),
        levels,
        walls: Vec::with_capacity(n * end),
        crease,
        transform,
        surface: Surface::default(),
    };
    let corners = n * (2 * end + 4);
    shell.surface.positions.reserve(corners);
    shell.surface.normals.reserve(corners);
    shell
        .surface
        .triangles
        .reserve(2 * (n * end + caps[0].len()));
    for k in 0..end {
        for i in 0..n {
            let wall = shell.wall(k, i);
            shell.walls.push(wall);
        }
    }
    let mut lower = Corners::default();
    let mut upper = Corners::default();
    for (k, level) in levels.iter().enumerate() {
        shell.corners(k, &mut upper);
        if k == 0 && level.form == Form::Rings {
            let turned = caps[0].iter().map(|[a, b, c]| [*a, *c, *b]);
            let turned = turned.map(|t| t.map(|i| upper.cap[i as usize]));
            shell.surface.triangles.extend(turned);
        }
        if k > 0 {
            shell.band(k - 1, &lower, &upper);
        }
        if k == end && level.form == Form::Rings {
            let caps = caps[1].iter().map(|t| t.map(|i| upper.cap[i as usize]));
            shell.surface.triangles.extend(caps);
        }
        std::mem::swap(&mut lower, &mut upper);
    }
    shell.surface
}

impl Shell<'_> {
    fn point(&self, k: usize, i: usize) -> DVec3 {
        let level = &self.levels[k];
        (self.rings.points[i] * level.scale).extend(level.z)
    }

    fn wall(&self, k: usize, i: usize) -> DVec3 {
        let j = self.rings.next[i] as usize;
        let diagonal = self.point(k + 1, j) - self.point(k, i);
        let other = self.point(k + 1, i) - self.point(k, j);
        // Diagonals are normalised first, or their product could underflow.
        let normal = diagonal
            .normalize_or_zero()
            .cross(other.normalize_or_zero());
        normal.normalize_or(DVec3::Z)
    }

    /// Whether two points of a level coincide there.
    fn merged(&self, k: usize, i: usize, j: usize) -> bool {
        match (self.levels[k].form, self.stations) {
            (Form::Rings, _) => false,
            (Form::Ridge, Some(stations)) => stations[i] == stations[j],
            (Form::Ridge, None) | (Form::Tip, _) => true,
        }
    }

    fn corners(&mut self, k: usize, corners: &mut Corners) {
        let n = self.rings.len();
        let end = self.levels.len() - 1;
        for list in [&mut corners.below, &mut corners.above] {
            list.clear();
            list.resize(n, [0; 2]);
        }
        match self.levels[k].form {
            Form::Rings if k > 0 && k < end => self.middle(k, corners),
            Form::Rings => self.end(k, corners),
            Form::Ridge | Form::Tip => self.collapsed(k, corners),
        }
    }

    fn middle(&mut self, k: usize, corners: &mut Corners) {
        let n = self.rings.len();
        let (below, above) = ((k - 1) * n, k * n);
        for i in 0..n {
            let before = self.rings.before[i] as usize;
            let faces = [
                self.walls[below + before],
                self.walls[below + i],
                self.walls[above + i],
                self.walls[above + before],
            ];
            let position = self.transform.position(self.point(k, i));
            let mut ids = [0; 4];
            let (surface, transform) = (&mut self.surface, self.transform);
            let corner = |normal| add(surface, position, transform.normal(normal));
            share(&faces, &[1.0; 4], self.crease, corner, &mut ids);
            corners.below[i] = [ids[0], ids[1]];
            corners.above[i] = [ids[3], ids[2]];
        }
    }

    fn end(&mut self, k: usize, corners: &mut Corners) {
        let n = self.rings.len();
        let (walls, cap) = if k == 0 {
            (0, DVec3::NEG_Z)
        } else {
            ((k - 1) * n, DVec3::Z)
        };
        corners.cap.clear();
        for i in 0..n {
            let before = self.rings.before[i] as usize;
            let faces = [self.walls[walls + before], self.walls[walls + i], cap];
            let position = self.transform.position(self.point(k, i));
            let mut ids = [0; 3];
            let (surface, transform) = (&mut self.surface, self.transform);
            let corner = |normal| add(surface, position, transform.normal(normal));
            share(&faces, &[1.0; 3], self.crease, corner, &mut ids);
            corners.below[i] = [ids[0], ids[1]];
            corners.above[i] = [ids[0], ids[1]];
            corners.cap.push(ids[2]);
        }
    }

    /// Corners of a level where points coincide: the faces around each of its points are
    /// found in the order of the ring.
    fn collapsed(&mut self, k: usize, corners: &mut Corners) {
        let (walls, other) = if k == 0 {
            (0, 1)
        } else {
            ((k - 1) * self.rings.len(), k - 1)
        };
        let list = if k == 0 {
            &mut corners.above
        } else {
            &mut corners.below
        };
        let rings = self.rings;
        for ring in &rings.rings {
            // Each face: the station where it meets the level, its index, and the point whose corner it is, if only one.
            let mut faces: Vec<(u32, usize, Option<usize>)> = Vec::with_capacity(2 * ring.len());
            for i in ring.clone() {
                let j = rings.next[i] as usize;
                let station = |i: usize| match (self.levels[k].form, self.stations) {
                    (Form::Ridge, Some(stations)) => stations[i],
                    _ => 0,
                };
                if self.merged(k, i, j) {
                    faces.push((station(i), i, None));
                } else {
                    faces.push((station(i), i, Some(i)));
                    faces.push((station(j), i, Some(j)));
                }
            }
            // Stable, so that the order of the ring is kept.
            faces.sort_by_key(|(station, _, _)| *station);
            for around in faces.chunk_by(|a, b| a.0 == b.0) {
                let normals: Vec<DVec3> = around.iter().map(|f| self.walls[walls + f.1]).collect();
                let angle = |face: &(u32, usize, Option<usize>)| {
                    let (i, j) = (face.1, rings.next[face.1] as usize);
                    let here = self.point(k, face.2.unwrap_or(i));
                    let sides = match face.2 {
                        None => [self.point(other, i), self.point(other, j)],
                        Some(own) if own == i => [self.point(other, i), self.point(k, j)],
                        Some(_) => [self.point(other, j), self.point(k, i)],
                    };
                    let [a, b] = sides.map(|p| (p - here).normalize_or_zero());
                    math::atan2(a.cross(b).length(), a.dot(b)).max(1e-9)
                };
                let weights: Vec<f64> = around.iter().map(angle).collect();
                let position = self.transform.position(self.point(k, around[0].1));
                let position = match around[0].2 {
                    Some(own) => self.transform.position(self.point(k, own)),
                    None => position,
                };
                let mut ids = vec![0; around.len()];
                let (surface, transform) = (&mut self.surface, self.transform);
                let corner = |normal| add(surface, position, transform.normal(normal));
                if self.levels[k].form == Form::Tip {
                    share_tip(&normals, &weights, self.crease, corner, &mut ids);
                } else {
                    share(&normals, &weights, self.crease, corner, &mut ids);
                }
                for ((_, i, own), id) in around.iter().zip(ids) {
                    let j = rings.next[*i] as usize;
                    if own.is_none_or(|own| own == *i) {
                        list[*i][1] = id;
                    }
                    if own.is_none_or(|own| own == j) {
                        list[j][0] = id;
                    }
                }
            }
        }
    }

    /// Whether the wall on an edge is split along the diagonal from the edge's start, or along the
    /// other. Both sides of a narrow part are split alike, or their warped walls would intersect.
    fn rises(&self, k: usize, i: usize, j: usize) -> bool {
        let Some(stations) = self.stations else {
            return rises(self.rings.points[i], self.rings.points[j]);
        };
        let (low, high) = (stations[i].min(stations[j]), stations[i].max(stations[j]));
        // If both sides meet in a point, they would be split by the same edge.
        let meets = match (self.levels[k].form, self.levels[k + 1].form) {
            (Form::Ridge, _) => Some(high) == self.tips[1],
            (_, Form::Ridge) => Some(low) == self.tips[0],
            _ => false,
        };
        (stations[i] <= stations[j]) != meets
    }

    fn band(&mut self, k: usize, lower: &Corners, upper: &Corners) {
        for i in 0..self.rings.len() {
            let j = self.rings.next[i] as usize;
            let [a, b] = [lower.above[i][1], lower.above[j][0]];
            let [c, d] = [upper.below[j][0], upper.below[i][1]];
            if self.merged(k, i, j) {
                self.surface.triangles.push([a, c, d]);
            } else if self.merged(k + 1, i, j) {
                self.surface.triangles.push([a, b, c]);
            } else if self.warped && self.levels[k].scale != self.levels[k + 1].scale {
                let middle = self.point(k, i) + self.point(k, j);
                let middle = (middle + self.point(k + 1, i) + self.point(k + 1, j)) / 4.0;
                let normal = self.walls[k * self.rings.len() + i];
                let (position, normal) = (
                    self.transform.position(middle),
                    self.transform.normal(normal),
                );
                let m = add(&mut self.surface, position, normal);
                let around = [[a, b, m], [b, c, m], [c, d, m], [d, a, m]];
                self.surface.triangles.extend(around);
            } else if self.rises(k, i, j) {
                self.surface.triangles.extend([[a, b, c], [a, c, d]]);
            } else {
                self.surface.triangles.extend([[a, b, d], [b, c, d]]);
            }
        }
    }
}

/// The first and the last station, each if it has only one point.
fn tips(stations: &[u32]) -> [Option<u32>; 2] {
    let ends = [stations.iter().min(), stations.iter().max()];
    ends.map(|end| {
        let end = *end?;
        let points = stations.iter().filter(|station| **station == end);
        (points.count() == 1).then_some(end)
    })
}

fn add(surface: &mut Surface, position: [f32; 3], normal: [f32; 3]) -> u32 {
    let id = surface.positions.len() as u32;
    surface.positions.push(position);
    surface.normals.push(normal);
    id
}
