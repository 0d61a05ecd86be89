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
const FLOORS: [f64; 4] = [0.01, 0.05, 0.25, 1.0];
/// Empty triangles in copies smaller than this are taken to come of the scale.
const NARROW: f64 = 0.05;
/// How often a surface is tried.
const ATTEMPTS: usize = 12;
/// How far a point is moved off an edge that it cannot be told from in `f32`, relative to the
/// largest coordinate.
const NUDGE: f64 = 1e-6;
/// The most of it, relative to the extent.
const MOST: f64 = 1e-4;
/// Gaps in a copy wider than this, relative to its largest coordinate, survive in `f32`.
const GAP: f64 = 1e-6;
/// Copies further away than this, relative to their extent, are checked even if not scaled.
const FAR: f64 = 1.0;
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

/// An outline as its stack is built from it.
enum Base {
    /// Scaled both ways; copies of scale 0 are points.
    Even(Rings),
    /// Scaled one way, towards a line on which both sides of the outline match.
    Ridge(Matched),
    /// Scaled one way, towards a line that would be met several times; a narrow copy takes the
    /// place of copies of scale 0.
    Narrow(Rings),
}

impl Base {
    fn new(outline: &Outline, layers: &[Layer]) -> Base {
        let collapse = if layers.iter().any(|l| l.across != l.along && l.along == 1.0) {
            Collapse::Across
        } else if layers.iter().any(|l| l.across != l.along) {
            Collapse::Along
        } else {
            return Base::Even(Rings::of(outline));
        };
        match matched(outline, collapse) {
            Some(matched) => Base::Ridge(matched),
            None => Base::Narrow(Rings::of(outline)),
        }
    }

    fn rings(&self) -> &Rings {
        match self {
            Base::Even(rings) | Base::Narrow(rings) => rings,
            Base::Ridge(matched) => &matched.rings,
        }
    }

    fn stations(&self) -> Option<&[u32]> {
        match self {
            Base::Ridge(matched) => Some(&matched.stations),
            Base::Even(_) | Base::Narrow(_) => None,
        }
    }

    fn caps(&self) -> Vec<[u32; 3]> {
        match self {
            Base::Even(rings) | Base::Narrow(rings) => cap::triangles(rings),
            Base::Ridge(matched) => matched.triangles(),
        }
    }
}

impl Base {
    /// Whether walls are so warped, for how thin the outline is, that two triangles are too coarse
    /// for each: the volumes that they would add or lose come near to the whole.
    fn is_warped(&self) -> bool {
        let Base::Narrow(rings) = self else {
            return false;
        };
        let (mut warp, mut area) = (0.0, 0.0);
        for (p, next) in rings.points.iter().zip(&rings.next) {
            let q = rings.points[*next as usize];
            warp += (q.x - p.x) * (q.y - p.y).abs();
            area += p.perp_dot(q) / 2.0;
        }
        warp.abs() > area / 2.0
    }
}

/// Whether an edge leads up.
fn rises(from: DVec2, to: DVec2) -> bool {
    (from.y, from.x) <= (to.y, to.x)
}

/// The closed surface over two or more layers.
pub(super) fn stack(outline: &Outline, layers: &[Layer], options: &Options) -> Surface {
    let put = Put::new(options);
    let crease = Crease::new(options.crease);
    let mut base = Base::new(outline, layers);
    if base.rings().len() < 3 {
        return Surface::default();
    }
    let extent = base.rings().extent();
    let largest = layers
        .iter()
        .map(|l| l.across.min(l.along))
        .fold(0.0, f64::max);
    let mut floors = FLOORS.iter().map(|floor| floor.min(largest));
    let mut floor = LEAST.min(largest);
    let mut nudge = NUDGE * (extent + put.translation.truncate().abs().max_element());
    for _ in 0..ATTEMPTS {
        let levels = levels(layers, &base, floor, &put);
        let ends = [levels[0].form, levels[levels.len() - 1].form];
        let mut caps = [Vec::new(), Vec::new()];
        if ends.contains(&Form::Rings) {
            // Each end may need other edges turned.
            let cap = base.caps();
            caps = [cap.clone(), cap];
        }
        match fault(base.rings(), &levels, &mut caps, &put) {
            None => return skin(&base, &levels, &caps, crease, &put),
            Some(Fault::Small) => floor = floors.next().unwrap_or(floor),
            Some(Fault::Empty(empty)) => {
                if let Base::Even(rings) | Base::Narrow(rings) = &mut base {
                    rings.widen(&empty, nudge);
                    nudge = (2.0 * nudge).min(MOST * extent);
                } else {
                    base = Base::Narrow(Rings::of(outline));
                }
            }
        }
    }
    // Some points fall together as they are written; that is all that is wrong with it.
    let levels = levels(layers, &base, floor, &put);
    let caps = base.caps();
    skin(&base, &levels, &[caps.clone(), caps], crease, &put)
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
fn levels(layers: &[Layer], base: &Base, floor: f64, put: &Put) -> Vec<Level> {
    let end = layers.len() - 1;
    let depth = layers[end].z - layers[0].z;
    let mut levels: Vec<Level> = Vec::with_capacity(layers.len());
    for (i, layer) in layers.iter().enumerate() {
        let mut scale = DVec2::new(layer.across, layer.along);
        let mut form = Form::Rings;
        if let Base::Narrow(_) = base {
            scale = scale.max(DVec2::splat(floor));
        } else if scale.min_element() < floor {
            if i != 0 && i != end {
                continue;
            }
            let tip = scale.x < floor && scale.y < floor;
            form = if tip { Form::Tip } else { Form::Ridge };
            // A narrow copy that turned out too narrow, though the kind does not collapse.
            if form == Form::Ridge && !matches!(base, Base::Ridge(_)) {
                form = Form::Rings;
                scale = scale.max(DVec2::splat(floor));
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

/// What is wrong with a stack as it would be written.
enum Fault {
    /// A copy is so small that points fall together.
    Small,
    /// Triangles of a cap are empty.
    Empty(Vec<[u32; 3]>),
}

/// The first fault of a stack, after edges within the caps were turned to avoid empty triangles.
fn fault(
    rings: &Rings,
    levels: &[Level],
    caps: &mut [Vec<[u32; 3]>; 2],
    put: &Put,
) -> Option<Fault> {
    let extent = rings.extent();
    let away = put.translation.truncate().abs().max_element();
    let gap = cap::least_gap(rings);
    let ends = [0, levels.len() - 1];
    for (k, level) in levels
        .iter()
        .enumerate()
        .filter(|(_, l)| l.form == Form::Rings)
    {
        let scale = level.scale.min_element();
        let small = (scale < 1.0 || away > FAR * extent) && scale * gap < GAP * (extent + away);
        let capped = ends.contains(&k);
        if !(small || capped) {
            continue;
        }
        let place = |p: &DVec2| {
            let [x, y, _] = put.position((*p * level.scale).extend(level.z));
            DVec2::new(x.into(), y.into())
        };
        let points: Vec<DVec2> = rings.points.iter().map(place).collect();
        if small {
            let bits = |p: &DVec2| {
                let [x, y] = [p.x, p.y].map(|x| u64::from((x as f32 + 0.0).to_bits()));
                x << 32 | y
            };
            let mut places: Vec<u64> = points.iter().map(bits).collect();
            places.sort_unstable();
            if places.windows(2).any(|w| w[0] == w[1]) {
                return Some(Fault::Small);
            }
        }
        if capped {
            let empty = cap::turn_empty(&points, &mut caps[usize::from(k > 0)]);
            if !empty.is_empty() {
                return Some(if scale < NARROW {
                    Fault::Small
                } else {
                    Fault::Empty(empty)
                });
            }
        }
    }
    None
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
    /// The last station.
    last: u32,
    /// Walls are cut about their middles.
    warped: bool,
    levels: &'a [Level],
    /// Unit normals of the walls, band by band; a wall bears the number of the point it starts at.
    walls: Vec<DVec3>,
    crease: Crease,
    put: &'a Put,
    surface: Surface,
}

fn skin(
    base: &Base,
    levels: &[Level],
    caps: &[Vec<[u32; 3]>; 2],
    crease: Crease,
    put: &Put,
) -> Surface {
    let (rings, stations) = (base.rings(), base.stations());
    let n = rings.len();
    let end = levels.len() - 1;
    let mut skin = Skin {
        rings,
        stations,
        warped: base.is_warped(),
        last: stations.and_then(|s| s.iter().copied().max()).unwrap_or(0),
        levels,
        walls: Vec::with_capacity(n * end),
        crease,
        put,
        surface: Surface::default(),
    };
    let corners = n * (2 * end + 4);
    skin.surface.positions.reserve(corners);
    skin.surface.normals.reserve(corners);
    skin.surface
        .triangles
        .reserve(2 * (n * end + caps[0].len()));
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
            let turned = caps[0].iter().map(|[a, b, c]| [*a, *c, *b]);
            let turned = turned.map(|t| t.map(|i| upper.cap[i as usize]));
            skin.surface.triangles.extend(turned);
        }
        if k > 0 {
            skin.band(k - 1, &lower, &upper);
        }
        if k == end && levels[k].form == Form::Rings {
            let caps = caps[1].iter().map(|t| t.map(|i| upper.cap[i as usize]));
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

    /// Whether the wall on an edge is cut from the edge's start to the copy of its end, or the
    /// other way. Both sides of a narrow part are cut alike, or their warped walls would cross.
    fn rises(&self, k: usize, i: usize, j: usize) -> bool {
        let Some(stations) = self.stations else {
            return rises(self.rings.points[i], self.rings.points[j]);
        };
        let (low, high) = (stations[i].min(stations[j]), stations[i].max(stations[j]));
        // Where both sides meet in a point they would be cut by the same edge.
        let meets = match (self.levels[k].form, self.levels[k + 1].form) {
            (Form::Ridge, _) => high == self.last,
            (_, Form::Ridge) => low == 0,
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
                let (position, normal) = (self.put.position(middle), self.put.normal(normal));
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

fn add(surface: &mut Surface, position: [f32; 3], normal: [f32; 3]) -> u32 {
    let id = surface.positions.len() as u32;
    surface.positions.push(position);
    surface.normals.push(normal);
    id
}
