//! Four boxes, and four triangles, that a ray is tested with at once (Dammertz, Hanika and Keller 2008).

use glam::{Vec3, Vec3A, Vec4};
use obvhs::aabb::Aabb;
use obvhs::ray::Ray as Inverted;

use super::surface::Surface;

/// The number of children of a node, and of triangles in a pack.
pub(super) const WIDTH: usize = 4;
/// How far triangles extend beyond their edges, relative to their size, so that no ray slips through between two.
pub(super) const EDGE: f32 = 1e-5;
/// How much further away the end of a box is taken to be, for rounding (Ize 2013).
const ROUNDING: f32 = 1.0 + 4.0 * f32::EPSILON;

/// Up to four boxes.
#[derive(Clone)]
pub(super) struct Node {
    /// The lower corners: x of all boxes, then y, then z; and the upper corners.
    corners: [[Vec4; 3]; 2],
    pub(super) children: [Child; WIDTH],
    /// The number of boxes.
    pub(super) count: u32,
}

/// What is in a box.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Child {
    /// The index of a node, or of the first pack.
    pub(super) first: u32,
    /// The number of packs; 0 for a node.
    pub(super) packs: u32,
}

/// Up to four triangles, each in the form of `obvhs::rt_triangle`.
#[derive(Clone)]
pub(super) struct Pack {
    corner: [Vec4; 3],
    /// From the second corner to the first.
    back: [Vec4; 3],
    /// From the first corner to the third.
    forth: [Vec4; 3],
    /// At a right angle to both, inward. Zero where there is no triangle: no ray meets that.
    inward: [Vec4; 3],
    triangles: [u32; WIDTH],
    /// The number of triangles.
    count: u32,
}

/// The intersection of a ray with a triangle.
#[derive(Debug, Clone, Copy)]
pub(super) struct Hit {
    /// The index of the triangle in its surface.
    pub(super) triangle: usize,
    pub(super) distance: f32,
    /// Barycentric coordinates.
    pub(super) shares: Vec3,
    /// Whether the ray comes from behind.
    pub(super) behind: bool,
}

/// A ray, each coordinate four times.
pub(super) struct Ray {
    origin: [Vec4; 3],
    direction: [Vec4; 3],
    inverse: [Vec4; 3],
    /// For each axis which corner of a box the ray passes first.
    first: [usize; 3],
    nearest: Vec4,
}

impl Ray {
    pub(super) fn new(origin: Vec3, direction: Vec3, nearest: f32) -> Self {
        let ray = Inverted::new(origin.into(), direction.into(), nearest, f32::INFINITY);
        Self {
            origin: splat(ray.origin),
            direction: splat(ray.direction),
            inverse: splat(ray.inv_direction),
            first: ray
                .inv_direction
                .to_array()
                .map(|inverse| usize::from(inverse < 0.0)),
            nearest: Vec4::splat(nearest),
        }
    }
}

/// Each coordinate four times.
fn splat(v: Vec3A) -> [Vec4; 3] {
    [Vec4::splat(v.x), Vec4::splat(v.y), Vec4::splat(v.z)]
}

impl Node {
    pub(super) const EMPTY: Self = Self {
        corners: [[Vec4::INFINITY; 3], [Vec4::NEG_INFINITY; 3]],
        children: [Child { first: 0, packs: 0 }; WIDTH],
        count: 0,
    };

    pub(super) fn set_box(&mut self, lane: usize, of: &Aabb) {
        for axis in 0..3 {
            self.corners[0][axis][lane] = of.min[axis];
            self.corners[1][axis][lane] = of.max[axis];
        }
    }

    /// The box around all boxes.
    pub(super) fn bounds(&self) -> Aabb {
        let low = self.corners[0].map(Vec4::min_element);
        let high = self.corners[1].map(Vec4::max_element);
        Aabb::new(low.into(), high.into())
    }

    /// Where the ray enters each box, and which of them it meets before `furthest`.
    #[inline]
    pub(super) fn meet(&self, ray: &Ray, furthest: f32) -> (Vec4, u32) {
        let mut enter = ray.nearest;
        let mut leave = Vec4::splat(furthest);
        for axis in 0..3 {
            let first = ray.first[axis];
            let near = self.corners[first][axis];
            let far = self.corners[1 - first][axis];
            enter = enter.max((near - ray.origin[axis]) * ray.inverse[axis]);
            leave = leave.min((far - ray.origin[axis]) * ray.inverse[axis]);
        }
        let used = (1 << self.count) - 1;
        (enter, enter.cmple(leave * ROUNDING).bitmask() & used)
    }
}

impl Hit {
    /// Where a ray meets the plane of a triangle.
    pub(super) fn of_plane(
        surface: &Surface,
        triangle: usize,
        origin: Vec3,
        direction: Vec3,
    ) -> Option<Self> {
        let [a, b, c] = corners(surface, triangle as u32);
        let (back, forth, to) = (a - b, c - a, a - origin);
        let inward = back.cross(forth);
        let across = direction.cross(to);
        let slope = inward.dot(direction);
        let distance = inward.dot(to) / slope;
        let (u, v) = (across.dot(forth) / slope, across.dot(back) / slope);
        distance.is_finite().then(|| Self {
            triangle,
            distance,
            shares: Vec3::new(1.0 - u - v, u, v),
            behind: slope < 0.0,
        })
    }
}

impl Pack {
    pub(super) fn new(surface: &Surface, triangles: &[u32]) -> Self {
        let mut pack = Self {
            corner: [Vec4::ZERO; 3],
            back: [Vec4::ZERO; 3],
            forth: [Vec4::ZERO; 3],
            inward: [Vec4::ZERO; 3],
            triangles: [0; WIDTH],
            count: triangles.len() as u32,
        };
        for (lane, triangle) in triangles.iter().enumerate() {
            pack.triangles[lane] = *triangle;
            let [a, b, c] = corners(surface, *triangle);
            let (back, forth) = (a - b, c - a);
            let inward = back.cross(forth);
            for axis in 0..3 {
                pack.corner[axis][lane] = a[axis];
                pack.back[axis][lane] = back[axis];
                pack.forth[axis][lane] = forth[axis];
                pack.inward[axis][lane] = inward[axis];
            }
        }
        pack
    }

    /// Moves the triangles to where they are in `surface`, and returns the box around them.
    pub(super) fn fit(&mut self, surface: &Surface) -> Aabb {
        let triangles = &self.triangles[..self.count as usize];
        let boxes = triangles
            .iter()
            .map(|triangle| bounds(&corners(surface, *triangle)));
        let bounds = boxes.fold(Aabb::empty(), |all, one| all.union(&one));
        *self = Self::new(surface, triangles);
        bounds
    }

    /// Where the ray meets each triangle (Möller and Trumbore 1997), and calls `each` for those that it meets before
    /// `furthest`.
    #[inline]
    pub(super) fn meet(&self, ray: &Ray, furthest: f32, mut each: impl FnMut(Hit)) {
        let to = sub(self.corner, ray.origin);
        let across = cross(ray.direction, to);
        let slope = dot(self.inward, ray.direction);
        let inverse = Vec4::ONE / slope;
        let u = dot(across, self.forth) * inverse;
        let v = dot(across, self.back) * inverse;
        let distance = dot(self.inward, to) * inverse;
        let edge = Vec4::splat(-EDGE);
        let within = u.cmpge(edge) & v.cmpge(edge) & (u + v).cmple(Vec4::splat(1.0 + EDGE));
        let ahead = distance.cmpge(ray.nearest) & distance.cmple(Vec4::splat(furthest));
        let mut met = (within & ahead).bitmask();
        while met != 0 {
            let lane = met.trailing_zeros() as usize;
            met &= met - 1;
            if distance[lane].is_finite() {
                each(Hit {
                    triangle: self.triangles[lane] as usize,
                    distance: distance[lane],
                    shares: Vec3::new(1.0 - u[lane] - v[lane], u[lane], v[lane]),
                    behind: slope[lane] < 0.0,
                });
            }
        }
    }
}

pub(super) fn corners(surface: &Surface, triangle: u32) -> [Vec3; 3] {
    let [a, b, c] = surface.triangles[triangle as usize];
    let at = |corner: u32| surface.positions[corner as usize];
    [at(a), at(b), at(c)]
}

pub(super) fn bounds(corners: &[Vec3; 3]) -> Aabb {
    let [a, b, c] = corners.map(Vec3A::from);
    Aabb::new(a.min(b).min(c), a.max(b).max(c))
}

fn sub(a: [Vec4; 3], b: [Vec4; 3]) -> [Vec4; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn dot(a: [Vec4; 3], b: [Vec4; 3]) -> Vec4 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: [Vec4; 3], b: [Vec4; 3]) -> [Vec4; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}
