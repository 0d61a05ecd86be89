//! What others hide of a solid that is translucent together with them.
//!
//! A group of shapes that is translucent as a whole is painted as if it were opaque: nothing of it shows through other shapes of
//! it. So of such a solid only that is left which could be seen if all of them were opaque: its front beside what is drawn on it,
//! and of its back and its walls what is not inside others. What is left of all of them together is closed.

use std::cell::OnceCell;

use glam::{DVec2, DVec3, Vec3};
use rstar::primitives::{GeomWithData, Rectangle};
use rstar::{AABB, RTree};
use rustc_hash::FxHashMap;

use super::Pile;
use super::ground::BodyInFrame;
use super::region::{Division, Region};
use crate::geometry::Outline;
use crate::scene::Surface;

/// Triangles that are steeper than this, as the cosine of their slope, are walls.
const WALL: f64 = 1e-6;
/// What is closer together, as a share of a solid's extent, is in the same place.
const SAME: f64 = 1e-4;
/// How often a triangle is halved along each side, at most, where the heights of what hides it are not linear over it.
const MAX_DEPTH: u32 = 4;
/// Heights that are this close to linear ones over a triangle, as a share of a solid's extent, count as linear, and those over
/// triangles with sides that are as short.
const LINEAR: f64 = 1e-3;
const SMALL: f64 = 0.06;
/// A front that more later solids than this lie over is cut by all of them at once.
const MANY: usize = 16;

/// The solids that hide parts of another one.
pub(super) struct Hiders {
    all: Vec<Hider>,
    /// The boxes around them in the plane, with their indices.
    boxes: RTree<GeomWithData<Rectangle<[f64; 2]>, usize>>,
}

/// A solid that hides parts of another one.
struct Hider {
    body: BodyInFrame,
    region: Region,
    /// The depth of its back at the farthest, and of its front at the nearest.
    depths: OnceCell<[f64; 2]>,
    /// Whether it is drawn later.
    is_later: bool,
    /// Its larger extent.
    extent: f64,
}

/// A corner of a triangle.
#[derive(Clone, Copy)]
struct Corner {
    /// Its depth is one in the drawing.
    at: DVec3,
    normal: Vec3,
}

type Triangle = [Corner; 3];

/// A corner with how far it is in front of the back of what hides it, and behind the front of that.
#[derive(Clone, Copy)]
struct Level {
    corner: Corner,
    inside: [f64; 2],
}

impl Corner {
    fn lerp(self, to: Self, share: f64) -> Self {
        Self {
            at: self.at.lerp(to.at, share),
            normal: self.normal.lerp(to.normal, share as f32),
        }
    }

    /// The corner of a part of a triangle over a point of it.
    fn of([a, b, c]: Triangle, point: DVec2) -> Self {
        let flat = |corner: Self| corner.at.truncate();
        let (ab, ac, to) = (flat(b) - flat(a), flat(c) - flat(a), point - flat(a));
        let twice = ab.perp_dot(ac);
        let share_b = (to.perp_dot(ac) / twice).clamp(0.0, 1.0);
        let share_c = (ab.perp_dot(to) / twice).clamp(0.0, 1.0 - share_b);
        let share_a = 1.0 - share_b - share_c;
        let depth = a.at.z * share_a + b.at.z * share_b + c.at.z * share_c;
        let normals = [(a, share_a), (b, share_b), (c, share_c)];
        let normals = normals.map(|(corner, share)| corner.normal * share as f32);
        Self {
            at: point.extend(depth),
            normal: normals.into_iter().sum(),
        }
    }
}

impl Level {
    fn lerp(self, to: Self, share: f64) -> Self {
        let inside = [0, 1].map(|i| self.inside[i] + (to.inside[i] - self.inside[i]) * share);
        Self {
            corner: self.corner.lerp(to.corner, share),
            inside,
        }
    }
}

impl Pile {
    /// The bodies that hide parts of another one.
    pub(super) fn hiders(&self, index: usize) -> Hiders {
        let body = &self.bodies[index];
        let mut known = FxHashMap::default();
        let hider = |other: &usize| {
            self.place(*other, &mut known);
            let heights = known[other].clone();
            let hider = self.in_frame(*other, heights, body);
            let back = hider.to.inverse();
            let outline = self.outline(&self.bodies[*other]);
            let is_mirrored = back.matrix2.determinant() < 0.0;
            let outline = outline.map_rings(|ring| {
                let ring = ring.iter().map(|p| back.transform_point2(*p));
                // All of them go around their borders the same way.
                if is_mirrored {
                    ring.rev().collect()
                } else {
                    ring.collect()
                }
            });
            Hider::new(hider, outline, *other > index)
        };
        Hiders::new(body.hidden_by.iter().filter_map(hider).collect())
    }
}

/// A surface in the frame of a node at this depth without what others hide of it.
pub(super) fn cut(surface: &Surface, node_depth: f64, hiders: &Hiders) -> Surface {
    let corner = |index: u32| {
        let [at, normal] = [&surface.positions, &surface.normals].map(|list| list[index as usize]);
        let at = Vec3::from(at).as_dvec3() + DVec3::Z * node_depth;
        Corner {
            at,
            normal: normal.into(),
        }
    };
    let mut out = Surface::default();
    let mut places: Vec<Option<u32>> = vec![None; surface.positions.len()];
    for indices in &surface.triangles {
        let whole = indices.map(corner);
        match hiders.seen(whole) {
            None => {
                let triangle = indices.map(|index| {
                    *places[index as usize].get_or_insert_with(|| {
                        let index = index as usize;
                        out.positions.push(surface.positions[index]);
                        out.normals.push(surface.normals[index]);
                        out.positions.len() as u32 - 1
                    })
                });
                out.triangles.push(triangle);
            }
            Some(parts) => parts
                .into_iter()
                .for_each(|part| push(&mut out, part, node_depth)),
        }
    }
    out
}

fn push(out: &mut Surface, triangle: Triangle, node_depth: f64) {
    let positions = triangle.map(|corner| (corner.at - DVec3::Z * node_depth).as_vec3());
    let [a, b, c] = positions;
    if (b - a).cross(c - a) == Vec3::ZERO {
        return;
    }
    let first = out.positions.len() as u32;
    out.positions.extend(positions.map(|at| at.to_array()));
    let normals = triangle.map(|corner| corner.normal.normalize_or(Vec3::Z).to_array());
    out.normals.extend(normals);
    out.triangles.push([first, first + 1, first + 2]);
}

impl Hiders {
    fn new(all: Vec<Hider>) -> Self {
        let boxes = all.iter().enumerate().map(|(index, hider)| {
            let [low, high] = hider.region.bounds.map(|corner| corner.to_array());
            GeomWithData::new(Rectangle::from_corners(low, high), index)
        });
        Self {
            boxes: RTree::bulk_load(boxes.collect()),
            all,
        }
    }

    /// Those that a triangle may reach into, in their order.
    fn near(&self, triangle: Triangle) -> Vec<&Hider> {
        let [a, b, c] = triangle.map(|corner| corner.at.truncate());
        let corners = [a.min(b).min(c), a.max(b).max(c)].map(|corner| corner.to_array());
        let near = AABB::from_corners(corners[0], corners[1]);
        let near = self.boxes.locate_in_envelope_intersecting(near);
        let mut near: Vec<usize> = near.map(|hider| hider.data).collect();
        near.sort_unstable();
        near.into_iter().map(|index| &self.all[index]).collect()
    }

    /// The parts of a triangle that none of them hides; `None` for all of it.
    fn seen(&self, whole: Triangle) -> Option<Vec<Triangle>> {
        let near = self.near(whole);
        if near.len() > MANY && slope(whole) > WALL {
            let later = near.iter().filter(|hider| hider.is_later);
            let regions: Vec<&Region> = later.map(|hider| &hider.region).collect();
            if regions.len() > MANY {
                let flat = whole.map(|corner| corner.at.truncate());
                let parts = Region::outside_all(&regions, flat)?.into_iter();
                let parts = parts.map(|part| part.map(|point| Corner::of(whole, point)));
                return Some(parts.collect());
            }
        }
        let mut parts: Option<Vec<Triangle>> = None;
        for hider in near {
            let before = parts.as_deref().unwrap_or(std::slice::from_ref(&whole));
            let mut after = Vec::with_capacity(before.len());
            let mut is_cut = false;
            for part in before {
                match hider.seen(*part) {
                    None => after.push(*part),
                    Some(seen) => {
                        is_cut = true;
                        after.extend(seen);
                    }
                }
            }
            if is_cut {
                parts = Some(after);
            }
        }
        parts
    }
}

/// The cosine of a triangle's slope, negative for one that faces away from the viewer.
fn slope(triangle: Triangle) -> f64 {
    let [a, b, c] = triangle.map(|corner| corner.at);
    let normal = (b - a).cross(c - a);
    normal.z / normal.length()
}

impl Hider {
    /// A solid with this outline, in the frame of the one of which it hides parts.
    fn new(body: BodyInFrame, outline: Outline, is_later: bool) -> Option<Self> {
        let region = Region::new(outline)?;
        let [low, high] = region.bounds;
        Some(Self {
            body,
            extent: (high - low).max_element(),
            region,
            depths: OnceCell::new(),
            is_later,
        })
    }

    /// Whether all of a triangle is behind its back or in front of its front.
    fn is_apart(&self, triangle: Triangle) -> bool {
        let [back, front] = *self.depths.get_or_init(|| self.body.depths());
        let depths = triangle.map(|corner| corner.at.z);
        let nearest = depths.into_iter().fold(f64::NEG_INFINITY, f64::max);
        let farthest = depths.into_iter().fold(f64::INFINITY, f64::min);
        nearest < back - SAME * self.extent || farthest > front
    }

    /// The parts of a triangle that it does not hide; `None` for all of it.
    fn seen(&self, triangle: Triangle) -> Option<Vec<Triangle>> {
        let slope = slope(triangle);
        if slope.is_nan() {
            return None;
        }
        let is_front = slope > WALL;
        let is_hiding = if is_front {
            self.is_later
        } else {
            !self.is_apart(triangle)
        };
        if !is_hiding {
            return None;
        }
        if slope.abs() <= WALL {
            return self.seen_of_wall(triangle);
        }
        let flat = triangle.map(|corner| corner.at.truncate());
        let (mut seen, inside) = match self.region.divide(flat) {
            Division::Outside => return None,
            Division::Inside => (Vec::new(), vec![triangle]),
            Division::Both(parts) => {
                let [outside, inside] = parts.map(|parts| {
                    let part = |part: [DVec2; 3]| {
                        let [a, b, c] = part.map(|point| Corner::of(triangle, point));
                        if is_front { [a, b, c] } else { [a, c, b] }
                    };
                    parts.into_iter().map(part).collect::<Vec<Triangle>>()
                });
                (outside, inside)
            }
        };
        if !is_front {
            let parts = inside
                .iter()
                .map(|part| (part, self.beside(*part, MAX_DEPTH)));
            let parts: Vec<_> = parts.collect();
            if parts.iter().all(|(_, part)| part.is_none()) {
                return None;
            }
            for (whole, part) in parts {
                seen.extend(part.unwrap_or_else(|| vec![*whole]));
            }
        }
        Some(seen)
    }

    /// How far a place is in front of its back and behind its front, measured over a point near by.
    fn inside(&self, place: DVec3, near: DVec2) -> Option<[f64; 2]> {
        let back = self.body.back(near)?;
        let (front, _) = self.body.front(near)?;
        // Of two backs in the same place, that is seen which is drawn first.
        let same = SAME * self.extent;
        let same = if self.is_later { -same } else { same };
        Some([place.z - back + same, front - place.z])
    }

    /// The parts of a triangle over its region that are not inside it; `None` for all of it.
    fn beside(&self, triangle: Triangle, depth: u32) -> Option<Vec<Triangle>> {
        let middle = triangle.iter().map(|corner| corner.at).sum::<DVec3>() / 3.0;
        let level = |corner: Corner| {
            // Not on the border, where there may be none.
            let near = corner.at.lerp(middle, SAME);
            let inside = self.inside(corner.at, near.truncate())?;
            Some(Level { corner, inside })
        };
        let [a, b, c] = triangle.map(level);
        let levels = [a?, b?, c?];
        let at_middle = self.inside(middle, middle.truncate())?;
        let is_linear = |side: usize| {
            let mean = levels.iter().map(|level| level.inside[side]).sum::<f64>() / 3.0;
            (mean - at_middle[side]).abs() <= LINEAR * self.extent
        };
        let sides = [0, 1, 2].map(|i| triangle[i].at.distance(triangle[(i + 1) % 3].at));
        let is_small = sides.iter().all(|side| *side <= SMALL * self.extent);
        if depth == 0 || is_small || (is_linear(0) && is_linear(1)) {
            return outside(&levels);
        }
        let [a, b, c] = triangle;
        let [ab, bc, ca] = [(a, b), (b, c), (c, a)].map(|(from, to)| from.lerp(to, 0.5));
        let quarters = [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]];
        let parts = quarters.map(|quarter| (quarter, self.beside(quarter, depth - 1)));
        if parts.iter().all(|(_, part)| part.is_none()) {
            return None;
        }
        let parts = parts.into_iter();
        let parts = parts.flat_map(|(whole, part)| part.unwrap_or_else(|| vec![whole]));
        Some(parts.collect())
    }

    /// The parts of a wall that are not inside it; `None` for all of it.
    fn seen_of_wall(&self, triangle: Triangle) -> Option<Vec<Triangle>> {
        let flat = |corner: Corner| corner.at.truncate();
        let [a, b, c] = triangle;
        let normal = (b.at - a.at).cross(c.at - a.at).truncate();
        let sides = [(a, b), (b, c), (c, a)].map(|(from, to)| (flat(from), flat(to)));
        let (from, to) = sides
            .into_iter()
            .max_by(|a, b| a.0.distance(a.1).total_cmp(&b.0.distance(b.1)))?;
        let along = (to - from) / (to - from).length_squared();
        let [low, high] = self.region.bounds;
        let is_apart = from.max(to).cmplt(low).any() || from.min(to).cmpgt(high).any();
        if !along.is_finite() || is_apart {
            return None;
        }
        // Of two walls in the same place, that is seen which is drawn first.
        let aside = SAME * self.extent;
        let aside = if self.is_later { aside } else { -aside };
        let aside = normal.normalize_or_zero() * aside;
        let mut shares = self.body.all_crossings(from + aside, to + aside);
        shares.extend([0.0, 1.0]);
        shares.sort_unstable_by(f64::total_cmp);
        shares.dedup_by(|next, last| *next - *last < SAME);
        let level = |corner| Level {
            corner,
            inside: [0.0; 2],
        };
        let mut rest: Vec<Level> = triangle.into_iter().map(level).collect();
        let mut seen = Vec::new();
        let mut is_cut = false;
        for (index, until) in shares[1..].iter().enumerate() {
            let middle = shares[index].midpoint(*until);
            let share = |level: &Level| (flat(level.corner) - from).dot(along);
            let [strip, next] = divide(&rest, |level| until - share(level));
            rest = next;
            let levels = strip.iter().map(|level| {
                // Not on an edge, on whose other side the heights may be others.
                let share = share(level) + (middle - share(level)) * SAME;
                let near = from + (to - from) * share + aside;
                let inside = self.inside(level.corner.at, near)?;
                Some(Level { inside, ..*level })
            });
            match levels
                .collect::<Option<Vec<Level>>>()
                .map(|levels| outside(&levels))
            {
                Some(Some(parts)) => {
                    is_cut = true;
                    seen.extend(parts);
                }
                _ => seen.extend(fan(&strip)),
            }
        }
        seen.extend(fan(&rest));
        is_cut.then_some(seen)
    }
}

/// The parts of a convex polygon that are not inside; `None` for all of it.
fn outside(polygon: &[Level]) -> Option<Vec<Triangle>> {
    let [in_front, behind] = divide(polygon, |level| level.inside[0]);
    let [hidden, before] = divide(&in_front, |level| level.inside[1]);
    (hidden.len() > 2).then(|| fan(&behind).chain(fan(&before)).collect())
}

/// The parts of a convex polygon where a linear function is positive, and where it is not.
fn divide(polygon: &[Level], value: impl Fn(&Level) -> f64) -> [Vec<Level>; 2] {
    let mut parts = [Vec::new(), Vec::new()];
    for (index, from) in polygon.iter().enumerate() {
        let to = &polygon[(index + 1) % polygon.len()];
        let (here, there) = (value(from), value(to));
        parts[usize::from(here <= 0.0)].push(*from);
        if (here <= 0.0) != (there <= 0.0) {
            let between = from.lerp(*to, here / (here - there));
            parts.iter_mut().for_each(|part| part.push(between));
        }
    }
    parts
}

/// The triangles of a convex polygon.
fn fan(polygon: &[Level]) -> impl Iterator<Item = Triangle> + '_ {
    let first = polygon.first();
    let pairs = polygon.windows(2).skip(1);
    pairs.filter_map(move |pair| Some([first?.corner, pair[0].corner, pair[1].corner]))
}
