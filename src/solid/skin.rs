//! The surface that joins the layers of a stack.
//!
//! A band of walls joins each layer to the next; the first and the last layer are closed by a cap,
//! unless they are a line or a point.

use glam::{DMat2, DVec2, DVec3};

use super::groups::{Crease, share, share_tip};
use super::layers::{LEAST, Layer};
use super::ridge::{Collapse, Matched, matched};
use super::rings::Rings;
use super::{Options, cap};
use crate::geometry::Outline;
use crate::scene::Surface;

/// Scales below which copies are given up, tried in turn until all points keep apart in `f32`.
const FLOORS: [f64; 5] = [LEAST, 0.01, 0.05, 0.25, 1.0];
/// Copies smaller than this are checked for points that fall together.
const SMALL: f64 = 0.05;
/// So are copies further away than this, relative to their extent.
const FAR: f64 = 4.0;
/// Layers closer than this, relative to the whole depth, are one.
const NEAR: f64 = 1e-6;

/// The outline alone, seen from the front.
pub(super) fn flat(outline: &Outline, z: f64, options: &Options) -> Surface {
    let rings = Rings::of(outline);
    let put = Put::new(options);
    let put = |p: &DVec2| put.position(p.extend(z));
    Surface {
        positions: rings.points.iter().map(put).collect(),
        normals: vec![[0.0, 0.0, 1.0]; rings.len()],
        uvs: Vec::new(),
        triangles: cap::triangles(&rings),
    }
}

/// What the copies of scale 0 are.
enum Fold {
    /// Points.
    Tip,
    /// Lines, on which both sides of the outline match.
    Ridge(Matched),
    /// Lines that would be met several times; a narrow copy takes their place.
    Narrow(Rings),
}

/// The closed surface over two or more layers.
pub(super) fn stack(outline: &Outline, layers: &[Layer], options: &Options) -> Surface {
    let across = layers.iter().any(|l| l.across == 0.0);
    let along = layers.iter().any(|l| l.along == 0.0);
    let fold = match (across, along) {
        (true, false) => line(outline, Collapse::Across),
        (false, true) => line(outline, Collapse::Along),
        _ => Fold::Tip,
    };
    let plain;
    let (rings, stations) = match &fold {
        Fold::Tip => {
            plain = Rings::of(outline);
            (&plain, None)
        }
        Fold::Ridge(matched) => (&matched.rings, Some(&matched.stations[..])),
        Fold::Narrow(rings) => (rings, None),
    };
    if rings.len() < 3 {
        return Surface::default();
    }
    let put = Put::new(options);
    let crease = Crease::new(options.crease);
    let mut caps = None;
    for (i, floor) in FLOORS.into_iter().enumerate() {
        let levels = levels(layers, &fold, floor, &put);
        if levels.len() < 2 || levels.iter().all(|l| l.form != Form::Rings) {
            continue;
        }
        let capped = levels[0].form == Form::Rings || levels[levels.len() - 1].form == Form::Rings;
        if capped && caps.is_none() {
            caps = Some(match &fold {
                Fold::Ridge(matched) => matched.triangles(),
                Fold::Tip | Fold::Narrow(_) => cap::triangles(rings),
            });
        }
        let caps = caps.as_deref_mut().unwrap_or_default();
        let last = i + 1 == FLOORS.len();
        if keeps_apart(rings, &levels, caps, &put) || last {
            return skin(rings, stations, &levels, caps, crease, &put);
        }
    }
    Surface::default()
}

fn line(outline: &Outline, collapse: Collapse) -> Fold {
    match matched(outline, collapse) {
        Some(matched) => Fold::Ridge(matched),
        None => Fold::Narrow(Rings::of(outline)),
    }
}

/// What a copy consists of.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Form {
    Rings,
    Ridge,
    Tip,
}

#[derive(Clone, Copy)]
struct Level {
    scale: DVec2,
    z: f64,
    form: Form,
}

/// The layers as they are built: without those that are too small or too close.
fn levels(layers: &[Layer], fold: &Fold, floor: f64, put: &Put) -> Vec<Level> {
    let end = layers.len() - 1;
    let depth = layers[end].z - layers[0].z;
    let mut levels: Vec<Level> = Vec::with_capacity(layers.len());
    for (i, layer) in layers.iter().enumerate() {
        let mut scale = DVec2::new(layer.across, layer.along);
        let mut form = Form::Rings;
        if let Fold::Narrow(_) = fold {
            scale = scale.max(DVec2::splat(floor));
        } else if scale.min_element() < floor {
            if i != 0 && i != end {
                continue;
            }
            let tip = scale.x < floor && scale.y < floor;
            form = if tip { Form::Tip } else { Form::Ridge };
            // Without a fold this is a copy that turned out too small.
            if form == Form::Ridge && !matches!(fold, Fold::Ridge(_)) {
                form = Form::Rings;
            } else {
                scale = DVec2::select(scale.cmplt(DVec2::splat(floor)), DVec2::ZERO, scale);
            }
        }
        if let Some(before) = levels.last()
            && (layer.z - before.z <= NEAR * depth || put.depth(layer.z) == put.depth(before.z))
        {
            if i != end {
                continue;
            }
            if levels.len() > 1 {
                levels.pop();
            }
        }
        levels.push(Level {
            scale,
            z: layer.z,
            form,
        });
    }
    levels
}

/// Whether the points of all copies differ as they are written, and no triangle of a cap is empty.
fn keeps_apart(rings: &Rings, levels: &[Level], caps: &mut [[u32; 3]], put: &Put) -> bool {
    let extent = rings
        .points
        .iter()
        .fold(0.0, |most: f64, p| most.max(p.abs().max_element()));
    let far = put.translation.truncate().abs().max_element() > FAR * extent;
    let ends = [0, levels.len() - 1];
    for (k, level) in levels
        .iter()
        .enumerate()
        .filter(|(_, l)| l.form == Form::Rings)
    {
        let risky = far || level.scale.min_element() < SMALL;
        let capped = ends.contains(&k);
        if !(risky || capped) {
            continue;
        }
        let points: Vec<[f32; 3]> = rings
            .points
            .iter()
            .map(|p| put.position((*p * level.scale).extend(level.z)))
            .collect();
        if risky {
            let mut places: Vec<[u32; 2]> = points
                .iter()
                .map(|[x, y, _]| [(x + 0.0).to_bits(), (y + 0.0).to_bits()])
                .collect();
            places.sort_unstable();
            if places.windows(2).any(|w| w[0] == w[1]) {
                return false;
            }
        }
        if capped {
            let points: Vec<DVec2> = points
                .iter()
                .map(|[x, y, _]| DVec2::new((*x).into(), (*y).into()))
                .collect();
            if !cap::turn_empty(&points, caps) {
                return false;
            }
        }
    }
    true
}

/// Carries points to their final places.
struct Put {
    turn: DMat2,
    translation: DVec3,
    scale: f64,
}

impl Put {
    fn new(options: &Options) -> Put {
        Put {
            turn: options.placement.turn(),
            translation: options.placement.translation,
            scale: options.placement.scale,
        }
    }

    fn position(&self, p: DVec3) -> [f32; 3] {
        let turned = (self.turn * p.truncate()).extend(p.z);
        (self.scale * (turned + self.translation))
            .as_vec3()
            .to_array()
    }

    fn depth(&self, z: f64) -> f32 {
        (self.scale * (z + self.translation.z)) as f32
    }

    fn normal(&self, n: DVec3) -> [f32; 3] {
        (self.turn * n.truncate()).extend(n.z).as_vec3().to_array()
    }
}

/// The corners that the faces beside every point of a level use: on the wall before the point and
/// on the one after it, below the level and above.
#[derive(Default)]
struct Corners {
    below: Vec<[u32; 2]>,
    above: Vec<[u32; 2]>,
    cap: Vec<u32>,
}

struct Skin<'a> {
    rings: &'a Rings,
    stations: Option<&'a [u32]>,
    levels: &'a [Level],
    /// Unit normals of the walls, band by band; a wall bears the number of the point it starts at.
    walls: Vec<DVec3>,
    crease: Crease,
    put: &'a Put,
    surface: Surface,
}

fn skin(
    rings: &Rings,
    stations: Option<&[u32]>,
    levels: &[Level],
    caps: &[[u32; 3]],
    crease: Crease,
    put: &Put,
) -> Surface {
    let n = rings.len();
    let end = levels.len() - 1;
    let mut skin = Skin {
        rings,
        stations,
        levels,
        walls: Vec::with_capacity(n * end),
        crease,
        put,
        surface: Surface::default(),
    };
    let corners = n * (2 * end + 4);
    skin.surface.positions.reserve(corners);
    skin.surface.normals.reserve(corners);
    skin.surface.triangles.reserve(2 * (n * end + caps.len()));
    for k in 0..end {
        for i in 0..n {
            let wall = skin.wall(k, i);
            skin.walls.push(wall);
        }
    }
    let mut lower = Corners::default();
    let mut upper = Corners::default();
    for k in 0..=end {
        skin.corners(k, &mut upper);
        if k == 0 && levels[k].form == Form::Rings {
            let turned = caps.iter().map(|[a, b, c]| [*a, *c, *b]);
            let turned = turned.map(|t| t.map(|i| upper.cap[i as usize]));
            skin.surface.triangles.extend(turned);
        }
        if k > 0 {
            skin.band(k - 1, &lower, &upper);
        }
        if k == end && levels[k].form == Form::Rings {
            let caps = caps.iter().map(|t| t.map(|i| upper.cap[i as usize]));
            skin.surface.triangles.extend(caps);
        }
        std::mem::swap(&mut lower, &mut upper);
    }
    skin.surface
}

impl Skin<'_> {
    fn point(&self, k: usize, i: usize) -> DVec3 {
        let level = &self.levels[k];
        (self.rings.points[i] * level.scale).extend(level.z)
    }

    fn wall(&self, k: usize, i: usize) -> DVec3 {
        let j = self.rings.next[i] as usize;
        let diagonal = self.point(k + 1, j) - self.point(k, i);
        let other = self.point(k + 1, i) - self.point(k, j);
        // Lengths are made about 1 first, or their product could vanish.
        let normal = diagonal
            .normalize_or_zero()
            .cross(other.normalize_or_zero());
        normal.normalize_or(DVec3::Z)
    }

    /// Whether two points of a level are one there.
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
            let position = self.put.position(self.point(k, i));
            let mut ids = [0; 4];
            let (surface, put) = (&mut self.surface, self.put);
            let corner = |normal| add(surface, position, put.normal(normal));
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
            let position = self.put.position(self.point(k, i));
            let mut ids = [0; 3];
            let (surface, put) = (&mut self.surface, self.put);
            let corner = |normal| add(surface, position, put.normal(normal));
            share(&faces, &[1.0; 3], self.crease, corner, &mut ids);
            corners.below[i] = [ids[0], ids[1]];
            corners.above[i] = [ids[0], ids[1]];
            corners.cap.push(ids[2]);
        }
    }

    /// Corners of a level where points fall together: the faces round each of its points are
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
            // Each face with the point it meets the level at, and where its corner is to be noted.
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
                    a.cross(b).length().atan2(a.dot(b)).max(1e-9)
                };
                let weights: Vec<f64> = around.iter().map(angle).collect();
                let position = self.put.position(self.point(k, around[0].1));
                let position = match around[0].2 {
                    Some(own) => self.put.position(self.point(k, own)),
                    None => position,
                };
                let mut ids = vec![0; around.len()];
                let (surface, put) = (&mut self.surface, self.put);
                let corner = |normal| add(surface, position, put.normal(normal));
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

    fn band(&mut self, k: usize, lower: &Corners, upper: &Corners) {
        for i in 0..self.rings.len() {
            let j = self.rings.next[i] as usize;
            let [a, b] = [lower.above[i][1], lower.above[j][0]];
            let [c, d] = [upper.below[j][0], upper.below[i][1]];
            if self.merged(k, i, j) {
                self.surface.triangles.push([a, c, d]);
            } else if self.merged(k + 1, i, j) {
                self.surface.triangles.push([a, b, c]);
            } else {
                self.surface.triangles.extend([[a, b, c], [a, c, d]]);
            }
        }
    }
}

fn add(surface: &mut Surface, position: [f32; 3], normal: [f32; 3]) -> u32 {
    let id = surface.positions.len() as u32;
    surface.positions.push(position);
    surface.normals.push(normal);
    id
}
