//! A bounding volume hierarchy: finds the triangles that a ray meets.
//!
//! `obvhs` builds a binary tree; two levels of it become one here, so that a ray tests four boxes at once, and four triangles
//! (Dammertz, Hanika and Keller 2008). What a ray meets does not depend on the shape of the tree.

use std::time::Duration;

use glam::{Vec3, Vec3A, Vec4};
use obvhs::BvhBuildParams;
use obvhs::aabb::Aabb;
use obvhs::bvh2::builder::build_bvh2;
use obvhs::bvh2::node::Bvh2Node;
use obvhs::ploc::PlocSearchDistance;
use obvhs::ray::Ray as Inverted;
use smallvec::SmallVec;

use super::surface::Surface;

/// The number of children of a node, and of triangles in a pack.
const WIDTH: usize = 4;
/// How far triangles extend beyond their edges, relative to their size, so that no ray slips through between two.
const EDGE: f32 = 1e-5;
/// How much further away the end of a box is taken to be, for rounding (Ize 2013).
const ROUNDING: f32 = 1.0 + 4.0 * f32::EPSILON;
/// How many entries of a stack need no memory of their own.
const STACK: usize = 64;

/// How many rays will be traced: a better tree pays off only for many.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Rays {
    /// One for each pixel of a small picture.
    Few,
    /// Those of a lit picture.
    Many,
    /// Those of many lit pictures.
    Film,
}

/// Triangles in a tree of boxes.
#[derive(Clone)]
pub(super) struct Hierarchy {
    /// The root comes first, and children after their parents.
    nodes: Vec<Node>,
    packs: Vec<Pack>,
}

/// Up to four boxes.
#[derive(Clone)]
struct Node {
    /// The lower corners: x of all boxes, then y, then z.
    low: [Vec4; 3],
    high: [Vec4; 3],
    children: [Child; WIDTH],
    /// The number of boxes.
    count: u32,
}

/// What is in a box.
#[derive(Debug, Clone, Copy, Default)]
struct Child {
    /// The index of a node, or of the first pack.
    first: u32,
    /// The number of packs; 0 for a node.
    packs: u32,
}

/// Up to four triangles, each in the form of `obvhs::rt_triangle`.
#[derive(Clone)]
struct Pack {
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
struct Ray {
    origin: [Vec4; 3],
    direction: [Vec4; 3],
    inverse: [Vec4; 3],
    nearest: Vec4,
}

impl Ray {
    fn new(origin: Vec3, direction: Vec3, nearest: f32) -> Self {
        let ray = Inverted::new(origin.into(), direction.into(), nearest, f32::INFINITY);
        Self {
            origin: splat(ray.origin),
            direction: splat(ray.direction),
            inverse: splat(ray.inv_direction),
            nearest: Vec4::splat(nearest),
        }
    }
}

/// Each coordinate four times.
fn splat(v: Vec3A) -> [Vec4; 3] {
    [Vec4::splat(v.x), Vec4::splat(v.y), Vec4::splat(v.z)]
}

impl Node {
    const EMPTY: Self = Self {
        low: [Vec4::INFINITY; 3],
        high: [Vec4::NEG_INFINITY; 3],
        children: [Child { first: 0, packs: 0 }; WIDTH],
        count: 0,
    };

    fn set_box(&mut self, lane: usize, of: &Aabb) {
        for axis in 0..3 {
            self.low[axis][lane] = of.min[axis];
            self.high[axis][lane] = of.max[axis];
        }
    }

    /// The box around all boxes.
    fn bounds(&self) -> Aabb {
        let low = self.low.map(Vec4::min_element);
        let high = self.high.map(Vec4::max_element);
        Aabb::new(low.into(), high.into())
    }

    /// Where the ray enters each box, and which of them it meets before `furthest`.
    #[inline]
    fn meet(&self, ray: &Ray, furthest: f32) -> (Vec4, u32) {
        let mut enter = ray.nearest;
        let mut leave = Vec4::splat(furthest);
        for axis in 0..3 {
            let one = (self.low[axis] - ray.origin[axis]) * ray.inverse[axis];
            let other = (self.high[axis] - ray.origin[axis]) * ray.inverse[axis];
            enter = enter.max(one.min(other));
            leave = leave.min(one.max(other) * ROUNDING);
        }
        let used = (1 << self.count) - 1;
        (enter, enter.cmple(leave).bitmask() & used)
    }
}

impl Pack {
    fn new(surface: &Surface, triangles: &[u32]) -> Self {
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
    fn fit(&mut self, surface: &Surface) -> Aabb {
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
    fn meet(&self, ray: &Ray, furthest: f32, mut each: impl FnMut(Hit)) {
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

fn corners(surface: &Surface, triangle: u32) -> [Vec3; 3] {
    let [a, b, c] = surface.triangles[triangle as usize];
    let at = |corner: u32| surface.positions[corner as usize];
    [at(a), at(b), at(c)]
}

fn bounds(corners: &[Vec3; 3]) -> Aabb {
    let [a, b, c] = corners.map(Vec3A::from);
    Aabb::new(a.min(b).min(c), a.max(b).max(c))
}

/// The nodes of a binary tree that become the children of one node: those that a ray hits most probably are replaced by their
/// own children.
fn opened<'t>(nodes: &'t [Bvh2Node], parent: &'t Bvh2Node) -> SmallVec<[&'t Bvh2Node; WIDTH]> {
    let mut opened: SmallVec<[&Bvh2Node; WIDTH]> = SmallVec::from_slice(&[parent]);
    while opened.len() < WIDTH {
        let inner = (0..opened.len()).filter(|index| !opened[*index].is_leaf());
        let area = |index: &usize| opened[*index].aabb().half_area();
        let Some(largest) = inner.max_by(|a, b| area(a).total_cmp(&area(b))) else {
            break;
        };
        let first = opened.swap_remove(largest).first_index as usize;
        opened.extend(&nodes[first..first + 2]);
    }
    opened
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

impl Hierarchy {
    pub(super) fn new(surface: &Surface, rays: Rays) -> Self {
        let boxes: Vec<Aabb> = (0..surface.triangles.len() as u32)
            .map(|triangle| bounds(&corners(surface, triangle)))
            .collect();
        let effort = BvhBuildParams {
            // Reinsertion would improve the tree a little.
            reinsertion_batch_ratio: 0.0,
            max_prims_per_leaf: WIDTH as u32,
            ..match rays {
                Rays::Few => BvhBuildParams::very_fast_build(),
                Rays::Many => BvhBuildParams::medium_build(),
                Rays::Film => BvhBuildParams {
                    ploc_search_distance: PlocSearchDistance::VeryHigh,
                    search_depth_threshold: 0,
                    ..BvhBuildParams::medium_build()
                },
            }
        };
        let tree = build_bvh2(&boxes, effort, &mut Duration::default());
        let mut hierarchy = Self {
            nodes: Vec::with_capacity(tree.nodes.len() / 3 + 1),
            packs: Vec::with_capacity(tree.nodes.len() / 2 + 1),
        };
        let Some(root) = tree.nodes.first() else {
            return hierarchy;
        };
        hierarchy.nodes.push(Node::EMPTY);
        // Nodes whose children are still missing, with the boxes of the binary tree that become these.
        let mut missing: Vec<(usize, SmallVec<[&Bvh2Node; WIDTH]>)> =
            vec![(0, opened(&tree.nodes, root))];
        while let Some((index, boxes)) = missing.pop() {
            hierarchy.nodes[index].count = boxes.len() as u32;
            for (lane, one) in boxes.into_iter().enumerate() {
                hierarchy.nodes[index].set_box(lane, one.aabb());
                hierarchy.nodes[index].children[lane] = match one.is_leaf() {
                    true => {
                        let of = &tree.primitive_indices[one.first_index as usize..];
                        hierarchy.add_packs(surface, &of[..one.prim_count as usize])
                    }
                    false => {
                        let first = hierarchy.nodes.len();
                        hierarchy.nodes.push(Node::EMPTY);
                        missing.push((first, opened(&tree.nodes, one)));
                        Child {
                            first: first as u32,
                            packs: 0,
                        }
                    }
                };
            }
        }
        hierarchy
    }

    fn add_packs(&mut self, surface: &Surface, triangles: &[u32]) -> Child {
        let first = self.packs.len();
        let packs = triangles.chunks(WIDTH);
        self.packs
            .extend(packs.map(|pack| Pack::new(surface, pack)));
        Child {
            first: first as u32,
            packs: (self.packs.len() - first) as u32,
        }
    }

    /// The first triangle beyond `nearest` that `accept` does not refuse; of several at the same distance the first one in
    /// the file.
    pub(super) fn closest(
        &self,
        origin: Vec3,
        direction: Vec3,
        nearest: f32,
        accept: impl Fn(&Hit) -> bool,
    ) -> Option<Hit> {
        let ray = Ray::new(origin, direction, nearest);
        let mut found: Option<Hit> = None;
        let mut furthest = f32::INFINITY;
        let mut stack: SmallVec<[(f32, Child); STACK]> = SmallVec::new();
        stack.push((0.0, Child::default()));
        while let Some((enter, child)) = stack.pop() {
            if enter > furthest {
                continue;
            }
            if child.packs > 0 {
                for pack in &self.packs[child.first as usize..][..child.packs as usize] {
                    pack.meet(&ray, furthest, |hit| {
                        let before = found.is_none_or(|found| {
                            hit.distance < found.distance
                                || hit.distance == found.distance && hit.triangle < found.triangle
                        });
                        if before && accept(&hit) {
                            furthest = hit.distance;
                            found = Some(hit);
                        }
                    });
                }
                continue;
            }
            let Some(node) = self.nodes.get(child.first as usize) else {
                continue;
            };
            let (enter, mut met) = node.meet(&ray, furthest);
            // The nearest one comes last, so that it is next.
            let first = stack.len();
            while met != 0 {
                let lane = met.trailing_zeros() as usize;
                met &= met - 1;
                stack.push((enter[lane], node.children[lane]));
                let mut place = stack.len() - 1;
                while place > first && stack[place - 1].0 < stack[place].0 {
                    stack.swap(place - 1, place);
                    place -= 1;
                }
            }
        }
        found
    }

    /// Whether the ray meets a triangle that `blocks`, which is called for triangles in any order.
    pub(super) fn is_blocked(
        &self,
        origin: Vec3,
        direction: Vec3,
        mut blocks: impl FnMut(&Hit) -> bool,
    ) -> bool {
        let ray = Ray::new(origin, direction, 0.0);
        let mut blocked = false;
        let mut stack: SmallVec<[Child; STACK]> = SmallVec::new();
        stack.push(Child::default());
        while let Some(child) = stack.pop() {
            if child.packs > 0 {
                for pack in &self.packs[child.first as usize..][..child.packs as usize] {
                    pack.meet(&ray, f32::INFINITY, |hit| blocked = blocked || blocks(&hit));
                }
                if blocked {
                    return true;
                }
                continue;
            }
            let Some(node) = self.nodes.get(child.first as usize) else {
                continue;
            };
            let (_, mut met) = node.meet(&ray, f32::INFINITY);
            while met != 0 {
                let lane = met.trailing_zeros() as usize;
                met &= met - 1;
                stack.push(node.children[lane]);
            }
        }
        false
    }

    /// The same tree for other positions of the same triangles: the boxes are fitted to them (Lauterbach and others 2006), which
    /// takes a fraction of the time of building one.
    pub(super) fn fitted(&self, surface: &Surface) -> Self {
        let mut fitted = self.clone();
        for index in (0..fitted.nodes.len()).rev() {
            for lane in 0..fitted.nodes[index].count as usize {
                let child = fitted.nodes[index].children[lane];
                let of = match child.packs {
                    0 => fitted.nodes[child.first as usize].bounds(),
                    packs => {
                        let packs = &mut fitted.packs[child.first as usize..][..packs as usize];
                        packs
                            .iter_mut()
                            .map(|pack| pack.fit(surface))
                            .fold(Aabb::empty(), |all, one| all.union(&one))
                    }
                };
                fitted.nodes[index].set_box(lane, &of);
            }
        }
        fitted
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use glam::{DVec3, Vec2};

    use super::*;
    use crate::import::TriangleSoup;

    /// Small triangles at random places of a ring, around an empty middle.
    pub(crate) fn ring(seed: u64) -> Surface {
        let mut random = fastrand::Rng::with_seed(seed);
        let mut soup = TriangleSoup::default();
        for _ in 0..200 {
            let (sin, cos) = (random.f64() * std::f64::consts::TAU).sin_cos();
            let first = soup.positions.len() as u32;
            for _ in 0..3 {
                let apart = DVec3::from_array([(); 3].map(|()| random.f64() - 0.5)) * 0.2;
                soup.positions.push(DVec3::new(sin, cos, 0.0) + apart);
                soup.normals.push(Vec3::ZERO);
                soup.uvs.push(Vec2::ZERO);
            }
            soup.triangles.push([first, first + 1, first + 2]);
            soup.materials.push(None);
        }
        Surface::new(soup, 0, None)
    }

    /// Rays from all around, each with an origin and a direction.
    fn rays() -> Vec<(Vec3, Vec3)> {
        let mut random = fastrand::Rng::with_seed(5);
        let mut point = || Vec3::from_array([(); 3].map(|()| random.f32() - 0.5));
        // Towards the ring.
        let mut rays: Vec<(Vec3, Vec3)> = (0..3000)
            .map(|_| {
                let origin = point() * 3.0;
                let aim = point().with_z(0.0).normalize_or(Vec3::X) * 0.45;
                (origin, (aim - origin).normalize_or(Vec3::X))
            })
            .collect();
        // Along axes too, where boxes are met at infinity.
        rays.extend((0..300).map(|_| (point().with_z(2.0), Vec3::NEG_Z)));
        rays
    }

    /// All triangles that a ray meets, without a tree.
    fn met(surface: &Surface, origin: Vec3, direction: Vec3) -> Vec<Hit> {
        let mut met = Vec::new();
        let ray = Ray::new(origin, direction, 0.0);
        for triangle in 0..surface.triangles.len() as u32 {
            Pack::new(surface, &[triangle]).meet(&ray, f32::INFINITY, |hit| met.push(hit));
        }
        met
    }

    fn check(hierarchy: &Hierarchy, surface: &Surface) {
        let mut hits = 0;
        for (origin, direction) in rays() {
            let met = met(surface, origin, direction);
            let first = met.iter().min_by(|a, b| a.distance.total_cmp(&b.distance));
            let found = hierarchy.closest(origin, direction, 0.0, |_| true);
            assert_eq!(found.map(|hit| hit.triangle), first.map(|hit| hit.triangle));
            let blocked = hierarchy.is_blocked(origin, direction, |_| true);
            assert_eq!(blocked, first.is_some());
            let mut count = 0;
            hierarchy.is_blocked(origin, direction, |_| {
                count += 1;
                false
            });
            assert_eq!(count, met.len());
            hits += count;
            // What is refused is not there, and what is before the start is not either.
            if let Some(first) = first {
                let behind = met.iter().filter(|hit| hit.distance > first.distance);
                let second = behind.min_by(|a, b| a.distance.total_cmp(&b.distance));
                let second = second.map(|hit| hit.triangle);
                let other = |hit: &Hit| hit.triangle != first.triangle;
                let found = hierarchy.closest(origin, direction, 0.0, other);
                assert_eq!(found.map(|hit| hit.triangle), second);
                let nearest = first.distance.next_up();
                let found = hierarchy.closest(origin, direction, nearest, |_| true);
                assert_eq!(found.map(|hit| hit.triangle), second);
            }
        }
        assert!(hits > 1000, "{hits}");
    }

    #[test]
    fn rays_meet_what_they_meet_without_a_tree() {
        for (seed, rays) in [(1, Rays::Many), (2, Rays::Few), (3, Rays::Film)] {
            let surface = ring(seed);
            check(&Hierarchy::new(&surface, rays), &surface);
        }
    }

    #[test]
    fn a_tree_is_fitted_to_other_positions() {
        let (before, after) = (ring(3), ring(4));
        assert_eq!(before.triangles, after.triangles);
        check(&Hierarchy::new(&before, Rays::Film).fitted(&after), &after);
    }

    #[test]
    fn of_coincident_triangles_the_first_one_is_met() {
        let mut surface = ring(6);
        let twice = surface.triangles.clone();
        surface.triangles.extend(twice);
        let hierarchy = Hierarchy::new(&surface, Rays::Many);
        for (origin, direction) in rays() {
            let found = hierarchy.closest(origin, direction, 0.0, |_| true);
            assert!(found.is_none_or(|hit| hit.triangle < 200));
        }
    }

    #[test]
    fn without_triangles_nothing_is_met() {
        let hierarchy = Hierarchy::new(&Surface::default(), Rays::Many);
        let found = hierarchy.closest(Vec3::ZERO, Vec3::X, 0.0, |_| true);
        assert!(found.is_none() && !hierarchy.is_blocked(Vec3::ZERO, Vec3::X, |_| true));
        let fitted = hierarchy.fitted(&Surface::default());
        assert!(!fitted.is_blocked(Vec3::ZERO, Vec3::X, |_| true));
    }
}
