//! Finds what the rays of a picture meet by going through its triangles, each of which meets few rays, instead of going through its
//! rays. In most pictures triangles are not much larger than a pixel, so this is several times faster.
//!
//! The formulas are those of [`super::lanes`], for rays whose direction is not normalised: its length along the camera's axis is 1. Their
//! numerators are then linear in the place in the picture.

use glam::{Vec2, Vec3, Vec4};

use super::camera::{Camera, RayField};
use super::lanes::{EDGE, WIDTH, corners};
use super::light::even;
use super::trace::Tracer;

/// In the place of a triangle where there is none.
const NOTHING: u32 = u32::MAX;
/// How far a triangle may reach beyond its corners by rounding, in pixels.
const TOLERANCE: f32 = 0.01;
/// How many pixels are in the bounding boxes of triangles, relative to the number of triangles and pixels, before tracing rays is
/// faster.
const MAX_PIXELS: usize = 8;

/// The triangles of a picture that rays may meet.
pub(super) struct Raster<'a> {
    tracer: &'a Tracer<'a>,
    rays: RayField,
    depths: [Vec4; 2],
    /// In the order of the surface.
    candidates: Vec<Candidate>,
}

/// A triangle that does not show its invisible back.
struct Candidate {
    triangle: u32,
    /// Its bounding box in the picture, in pixels.
    low: Vec2,
    high: Vec2,
}

/// A rectangle of pixels, which may begin left of the picture or above it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Area {
    pub(super) left: i64,
    pub(super) top: i64,
    pub(super) width: u32,
    pub(super) height: u32,
}

impl Area {
    /// The pixels from the one that contains `low` to the one that contains `high`, as far as they are in the area and not left of
    /// the picture or above it: columns and rows, from the area's corner.
    fn within(&self, low: Vec2, high: Vec2) -> [std::ops::Range<usize>; 2] {
        let range = |low: f32, high: f32, start: i64, length: u32| {
            let first = (low.max(0.0) as i64 - start).max(0);
            let end = (high as i64 + 1 - start).min(i64::from(length));
            first as usize..if high < 0.0 { 0 } else { end.max(0) as usize }
        };
        [
            range(low.x, high.x, self.left, self.width),
            range(low.y, high.y, self.top, self.height),
        ]
    }
}

/// What the middles of pixels show, row by row.
pub(super) struct Middles {
    area: Area,
    triangles: Vec<u32>,
}

impl Middles {
    /// The triangle in the middle of a pixel of the area.
    pub(super) fn at(&self, x: u32, y: u32) -> Option<usize> {
        let column = i64::from(x) - self.area.left;
        let row = i64::from(y) - self.area.top;
        let triangle = self.triangles[row as usize * row_length(self.area) + column as usize];
        (triangle != NOTHING).then_some(triangle as usize)
    }
}

/// What the samples of some pixels show.
pub(super) struct Samples {
    count: usize,
    triangles: Vec<u32>,
}

impl Samples {
    /// The triangle at a sample of the pixel with this number.
    pub(super) fn at(&self, pixel: usize, sample: usize) -> Option<usize> {
        let triangle = self.triangles[pixel * self.count + sample];
        (triangle != NOTHING).then_some(triangle as usize)
    }
}

/// The length of the rows of an area in memory: four pixels are read at once.
fn row_length(area: Area) -> usize {
    area.width as usize + WIDTH
}

/// The numerators of barycentric coordinates and depth for four rays, and their denominator.
#[derive(Clone, Copy)]
struct Fractions {
    u: Vec4,
    v: Vec4,
    depth: Vec4,
    below: Vec4,
}

impl Fractions {
    fn splat([u, v, depth, below]: [f32; 4]) -> Self {
        Self {
            u: Vec4::splat(u),
            v: Vec4::splat(v),
            depth: Vec4::splat(depth),
            below: Vec4::splat(below),
        }
    }

    /// The sum with a multiple of another.
    #[inline]
    fn plus(&self, other: &Self, times: Vec4) -> Self {
        Self {
            u: self.u + other.u * times,
            v: self.v + other.v * times,
            depth: self.depth + other.depth * times,
            below: self.below + other.below * times,
        }
    }

    /// Puts the triangle in the places of the rays that meet it before what they met so far.
    #[inline]
    fn meet(&self, [near, far]: [Vec4; 2], triangle: u32, depths: &mut [f32], met: &mut [u32]) {
        let inverse = Vec4::ONE / self.below;
        let (u, v, depth) = (self.u * inverse, self.v * inverse, self.depth * inverse);
        let edge = Vec4::splat(-EDGE);
        let within = u.cmpge(edge) & v.cmpge(edge) & (u + v).cmple(Vec4::splat(1.0 + EDGE));
        let before = depth.cmplt(Vec4::from_slice(depths));
        let mut hits = (within & before & depth.cmpge(near) & depth.cmple(far)).bitmask();
        while hits != 0 {
            let lane = hits.trailing_zeros() as usize;
            hits &= hits - 1;
            depths[lane] = depth[lane];
            met[lane] = triangle;
        }
    }
}

/// The fractions of a triangle in a picture.
struct Projected {
    /// In the middle of a pixel.
    middle: Fractions,
    /// The change to the next pixel, to the right and down.
    right: Fractions,
    down: Fractions,
}

impl<'a> Raster<'a> {
    /// The triangles that rays of a picture may meet, where `places` are its corners in the picture. `None` if a corner is
    /// beside the eye or behind it, and if large triangles make this slow in a picture of `size` pixels.
    pub(super) fn new(
        tracer: &'a Tracer<'a>,
        camera: &Camera,
        places: &[Vec2],
        size: [u32; 2],
    ) -> Option<Self> {
        let surface = &tracer.surface;
        let rays = camera.ray_field();
        let extent = Vec2::new(size[0] as f32, size[1] as f32);
        let pixels = size[0] as usize * size[1] as usize;
        let mut left = MAX_PIXELS * (pixels + surface.triangles.len());
        let mut candidates = Vec::with_capacity(surface.triangles.len());
        for (index, triangle) in surface.triangles.iter().enumerate() {
            let [a, b, c] = *triangle;
            let [a, b, c] = [places[a as usize], places[b as usize], places[c as usize]];
            if (a + b + c).is_nan() {
                return None;
            }
            let [_, direction] = rays.at(a);
            let behind = tracer.inward(index).dot(direction) < 0.0;
            if behind && !tracer.materials[tracer.material(index)].double_sided {
                continue;
            }
            let low = a.min(b).min(c) - TOLERANCE;
            let high = a.max(b).max(c) + TOLERANCE;
            let seen = (high.min(extent) - low.max(Vec2::ZERO)).max(Vec2::ZERO) + 1.0;
            left = left.checked_sub((seen.x * seen.y) as usize)?;
            candidates.push(Candidate {
                triangle: index as u32,
                low,
                high,
            });
        }
        Some(Self {
            tracer,
            rays,
            depths: camera.depths.map(Vec4::splat),
            candidates,
        })
    }

    /// What is seen in the middle of each pixel of an area.
    pub(super) fn middles(&self, area: Area) -> Middles {
        let length = row_length(area);
        let mut depths = vec![f32::INFINITY; length * area.height as usize];
        let mut met = vec![NOTHING; length * area.height as usize];
        let lanes = Vec4::new(0.0, 1.0, 2.0, 3.0);
        for candidate in &self.candidates {
            let half = Vec2::splat(0.5);
            let [columns, rows] = area.within(candidate.low + half, candidate.high - half);
            if columns.is_empty() || rows.is_empty() {
                continue;
            }
            let projected = self.projected(candidate.triangle, area, columns.start, rows.start);
            let start = projected.middle.plus(&projected.right, lanes);
            for (below, row) in rows.enumerate() {
                let down = start.plus(&projected.down, Vec4::splat(below as f32));
                for (beside, column) in columns.clone().enumerate().step_by(WIDTH) {
                    let fractions = down.plus(&projected.right, Vec4::splat(beside as f32));
                    let place = row * length + column;
                    let place = place..place + WIDTH;
                    let (depths, met) = (&mut depths[place.clone()], &mut met[place]);
                    fractions.meet(self.depths, candidate.triangle, depths, met);
                }
            }
        }
        Middles {
            area,
            triangles: met,
        }
    }

    /// What is seen at the first `count` samples of some pixels of an area.
    pub(super) fn samples(&self, area: Area, pixels: &[[u32; 2]], count: usize) -> Samples {
        let length = row_length(area);
        let mut numbers = vec![NOTHING; length * area.height as usize];
        for (number, [x, y]) in pixels.iter().enumerate() {
            let column = (i64::from(*x) - area.left) as usize;
            let row = (i64::from(*y) - area.top) as usize;
            numbers[row * length + column] = number as u32;
        }
        let groups = count.div_ceil(WIDTH);
        let count = groups * WIDTH;
        let places: Vec<[Vec4; 2]> = (0..groups)
            .map(|group| {
                let places: [Vec2; WIDTH] = std::array::from_fn(|lane| even(group * WIDTH + lane));
                let from_middle = |axis: usize| places.map(|place| place[axis] - 0.5).into();
                [from_middle(0), from_middle(1)]
            })
            .collect();
        let mut depths = vec![f32::INFINITY; pixels.len() * count];
        let mut met = vec![NOTHING; pixels.len() * count];
        for candidate in &self.candidates {
            let [columns, rows] = area.within(candidate.low, candidate.high);
            let mut projected = None;
            for row in rows.clone() {
                for column in columns.clone() {
                    let number = numbers[row * length + column];
                    if number == NOTHING {
                        continue;
                    }
                    let projected = projected.get_or_insert_with(|| {
                        self.projected(candidate.triangle, area, columns.start, rows.start)
                    });
                    let [right, down] = [column - columns.start, row - rows.start];
                    for (group, [x, y]) in places.iter().enumerate() {
                        let fractions = projected
                            .middle
                            .plus(&projected.right, Vec4::splat(right as f32) + *x)
                            .plus(&projected.down, Vec4::splat(down as f32) + *y);
                        let place = number as usize * count + group * WIDTH;
                        let place = place..place + WIDTH;
                        let (depths, met) = (&mut depths[place.clone()], &mut met[place]);
                        fractions.meet(self.depths, candidate.triangle, depths, met);
                    }
                }
            }
        }
        Samples {
            count,
            triangles: met,
        }
    }

    /// The fractions of a triangle in the middle of the pixel in a column and a row of an area, and around it.
    fn projected(&self, triangle: u32, area: Area, column: usize, row: usize) -> Projected {
        let [a, b, c] = corners(&self.tracer.surface, triangle);
        let (back, forth) = (a - b, c - a);
        let inward = back.cross(forth);
        let pixel = |first: i64, step: usize| (first + step as i64) as f32 + 0.5;
        let middle = Vec2::new(pixel(area.left, column), pixel(area.top, row));
        let [origin, direction] = self.rays.at(middle);
        let to = a - origin;
        let of = |across: Vec3, to: Vec3, direction: Vec3| {
            Fractions::splat([
                across.dot(forth),
                across.dot(back),
                inward.dot(to),
                inward.dot(direction),
            ])
        };
        let step = |axis: usize| {
            let [moved, turned] = self.rays.steps[axis];
            of(turned.cross(to) - direction.cross(moved), -moved, turned)
        };
        Projected {
            middle: of(direction.cross(to), to, direction),
            right: step(0),
            down: step(1),
        }
    }
}

#[cfg(test)]
mod tests {
    use std::borrow::Cow;

    use super::*;
    use crate::render::camera::{Framing, Projection, View};
    use crate::render::coverage::{places, tests::plain};
    use crate::render::hierarchy::Rays;
    use crate::render::hierarchy::tests::ring;

    const SIZE: [u32; 2] = [90, 70];
    /// The samples of a pixel.
    const COUNT: usize = 6;

    /// Calls `check` with a picture of triangles in perspective, and with one in parallel projection.
    fn pictures(double_sided: bool, check: impl Fn(&Tracer<'_>, &Camera)) {
        for (seed, projection) in [(1, Projection::Perspective), (2, Projection::Orthographic)] {
            let view = View::default();
            let materials = [plain(double_sided)];
            let surface = ring(seed);
            let points = surface.used_positions();
            let framing = Framing::new(&[(view, ())], projection, SIZE, |_, ()| {
                Ok::<_, ()>(Cow::Borrowed(&*points))
            });
            let camera = framing.unwrap().camera(view);
            check(&Tracer::new(surface, &materials, &[], Rays::Many), &camera);
        }
    }

    /// The triangle that the ray through a point of the picture meets.
    fn traced(tracer: &Tracer<'_>, camera: &Camera, place: Vec2) -> Option<usize> {
        let (origin, direction) = camera.ray(place);
        let hit = tracer.closest(origin, direction, 0.0);
        hit.map(|hit| hit.triangle)
    }

    /// Compares the raster with traced rays: at the edges of triangles, rounding may decide.
    fn compare(tracer: &Tracer<'_>, camera: &Camera) {
        let corners = places(&tracer.surface, camera);
        let raster = Raster::new(tracer, camera, &corners, SIZE).expect("triangles are small");
        // An area that begins left of the picture, and one in its middle.
        for (left, top) in [(-2, -2), (31, 17)] {
            let area = Area {
                left,
                top,
                width: 40,
                height: 40,
            };
            let pixel = |index: i64| [left + index % 40, top + index / 40];
            let pixels: Vec<[u32; 2]> = (0..1600)
                .map(pixel)
                .filter(|[x, y]| *x >= 0 && *y >= 0)
                .map(|[x, y]| [x as u32, y as u32])
                .collect();
            let middles = raster.middles(area);
            let samples = raster.samples(area, &pixels, COUNT);
            let (mut hits, mut other) = (0, 0);
            for (number, [x, y]) in pixels.into_iter().enumerate() {
                let corner = Vec2::new(x as f32, y as f32);
                let expected = traced(tracer, camera, corner + even(0));
                other += usize::from(middles.at(x, y) != expected);
                for sample in 0..COUNT {
                    let expected = traced(tracer, camera, corner + even(sample));
                    hits += usize::from(expected.is_some());
                    other += usize::from(samples.at(number, sample) != expected);
                }
            }
            assert!(hits > 150 && other <= 2, "{hits} hits, {other} others");
        }
    }

    #[test]
    fn rays_meet_what_they_meet_when_they_are_traced() {
        pictures(true, compare);
        pictures(false, compare);
    }

    #[test]
    fn with_the_eye_among_triangles_rays_are_traced() {
        pictures(true, |tracer, camera| {
            let [eye, _] = camera.ray_field().at(Vec2::ZERO);
            let within = camera.moved(tracer.surface.positions[0] - eye);
            let corners = places(&tracer.surface, &within);
            let beside = corners.iter().any(|place| place.is_nan());
            let raster = Raster::new(tracer, &within, &corners, SIZE);
            assert!(raster.is_none() == beside);
        });
    }

    #[test]
    fn for_many_large_triangles_rays_are_traced() {
        pictures(true, |tracer, camera| {
            let everywhere = [Vec2::ZERO, Vec2::new(90.0, 0.0), Vec2::new(0.0, 70.0)];
            let corners: Vec<Vec2> = (0..tracer.surface.positions.len())
                .map(|corner| everywhere[corner % 3])
                .collect();
            assert!(Raster::new(tracer, camera, &corners, SIZE).is_none());
        });
    }
}
