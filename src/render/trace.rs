//! Traces rays: what they hit, and how much light passes.

use std::time::Duration;

use glam::{Vec2, Vec3, Vec3A, Vec4};
use obvhs::BvhBuildParams;
use obvhs::aabb::Aabb;
use obvhs::bvh2::Bvh2;
use obvhs::bvh2::builder::build_bvh2;
use obvhs::ray::{Ray, RayHit};
use obvhs::rt_triangle::RtTriangle;

use super::surface::{Alpha, Material, Surface};
use super::texture::Texture;

/// How far triangles extend beyond their edges, relative to their size, so that no ray slips through between two.
const EDGE: f32 = 1e-5;

/// A surface in a bounding volume hierarchy.
pub(super) struct Tracer<'a> {
    pub(super) surface: Surface,
    pub(super) materials: &'a [Material],
    textures: &'a [Option<Texture>],
    tree: Bvh2,
    /// In the order of the tree, like the surface's.
    triangles: Vec<RtTriangle>,
    /// Whether any material is transparent.
    clear: bool,
}

/// The intersection of a ray with a triangle.
#[derive(Debug, Clone, Copy)]
pub(super) struct Hit {
    pub(super) triangle: usize,
    pub(super) distance: f32,
    /// Barycentric coordinates.
    pub(super) shares: Vec3,
}

/// How many rays will be traced: a better tree pays off only for many.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Rays {
    /// One for each pixel of a small picture.
    Few,
    /// Those of a lit picture.
    Many,
}

/// The bounding volume hierarchy of one pose, which others of the same model use too: its boxes are fitted to them
/// (Lauterbach and others 2006). That takes a fraction of the time of building one.
pub(super) struct Hierarchy {
    tree: Bvh2,
    /// The triangles of the pose, in the order of the file.
    triangles: Vec<[u32; 3]>,
}

impl Hierarchy {
    pub(super) fn new(surface: &Surface, rays: Rays) -> Self {
        let mut tree = build(&triangles_of(surface), rays);
        // Boxes are fitted in one sweep over nodes in order.
        tree.reorder_in_stack_traversal_order();
        Self {
            tree,
            triangles: surface.triangles.clone(),
        }
    }

    /// The tree for another pose; `None` if other triangles are visible in it.
    fn fitted(&self, surface: &Surface, triangles: &[RtTriangle]) -> Option<Bvh2> {
        if self.triangles != surface.triangles {
            return None;
        }
        let mut tree = self.tree.clone();
        for node in tree.nodes.iter_mut().filter(|node| node.is_leaf()) {
            let first = node.first_index as usize;
            let within = &tree.primitive_indices[first..][..node.prim_count as usize];
            let boxes = within.iter().map(|index| triangles[*index as usize].aabb());
            node.set_aabb(boxes.fold(Aabb::empty(), |all, one| all.union(&one)));
        }
        tree.refit_all();
        Some(tree)
    }
}

fn triangles_of(surface: &Surface) -> Vec<RtTriangle> {
    let of = |[a, b, c]: [u32; 3]| {
        let at = |corner: u32| Vec3A::from(surface.positions[corner as usize]);
        RtTriangle::new(at(a), at(b), at(c))
    };
    surface
        .triangles
        .iter()
        .map(|corners| of(*corners))
        .collect()
}

fn build(triangles: &[RtTriangle], rays: Rays) -> Bvh2 {
    let effort = match rays {
        Rays::Few => BvhBuildParams::fastest_build(),
        // Reinsertion would improve the tree a little, but may make it deeper than the stack that `obvhs` traverses it with.
        Rays::Many => BvhBuildParams {
            reinsertion_batch_ratio: 0.0,
            ..BvhBuildParams::medium_build()
        },
    };
    build_bvh2(triangles, effort, &mut Duration::default())
}

impl<'a> Tracer<'a> {
    pub(super) fn new(
        surface: Surface,
        materials: &'a [Material],
        textures: &'a [Option<Texture>],
        rays: Rays,
    ) -> Self {
        let triangles = triangles_of(&surface);
        let tree = build(&triangles, rays);
        Self::with_tree(surface, materials, textures, (tree, triangles))
    }

    /// With the hierarchy of another pose, if that has the same triangles.
    pub(super) fn fitted(
        surface: Surface,
        materials: &'a [Material],
        textures: &'a [Option<Texture>],
        hierarchy: &Hierarchy,
    ) -> Self {
        let triangles = triangles_of(&surface);
        let tree = hierarchy.fitted(&surface, &triangles);
        let tree = tree.unwrap_or_else(|| build(&triangles, Rays::Many));
        Self::with_tree(surface, materials, textures, (tree, triangles))
    }

    /// Puts triangles in the order of their tree.
    fn with_tree(
        mut surface: Surface,
        materials: &'a [Material],
        textures: &'a [Option<Texture>],
        (tree, triangles): (Bvh2, Vec<RtTriangle>),
    ) -> Self {
        let order = || tree.primitive_indices.iter().map(|index| *index as usize);
        let triangles = order().map(|index| triangles[index]).collect();
        surface.triangles = order().map(|index| surface.triangles[index]).collect();
        surface.materials = order().map(|index| surface.materials[index]).collect();
        let clear = materials
            .iter()
            .any(|material| material.alpha != Alpha::Opaque);
        Self {
            surface,
            materials,
            textures,
            tree,
            triangles,
            clear,
        }
    }

    pub(super) fn material(&self, triangle: usize) -> usize {
        self.surface.materials[triangle] as usize
    }

    /// The first triangle beyond `nearest` that is visible to the ray; single-sided ones are invisible from behind.
    pub(super) fn closest(&self, origin: Vec3, direction: Vec3, nearest: f32) -> Option<Hit> {
        let ray = Ray::new(origin.into(), direction.into(), nearest, f32::INFINITY);
        let mut found = RayHit::none();
        let hit = self.tree.ray_traverse(ray, &mut found, |ray, index| {
            let triangle = &self.triangles[index];
            let distance = meet(triangle, ray);
            // `ng` points inward.
            let behind = || triangle.ng.dot(ray.direction) < 0.0;
            if distance.is_finite()
                && behind()
                && !self.materials[self.material(index)].double_sided
            {
                return f32::INFINITY;
            }
            distance
        });
        hit.then(|| self.hit(&ray, found.primitive_id as usize, found.t))
    }

    fn hit(&self, ray: &Ray, triangle: usize, distance: f32) -> Hit {
        let Vec2 { x, y } = self.triangles[triangle].compute_barycentric(ray);
        Hit {
            triangle,
            distance,
            shares: Vec3::new(1.0 - x - y, x, y),
        }
    }

    /// The share of light that arrives from a direction, 0 to 1.
    pub(super) fn light_through(&self, origin: Vec3, direction: Vec3) -> f32 {
        let ray = Ray::new(origin.into(), direction.into(), 0.0, f32::INFINITY);
        let mut light = 1.0;
        let missed = self.tree.ray_traverse_miss(ray, |ray, index| {
            let distance = meet(&self.triangles[index], ray);
            if !self.clear || !distance.is_finite() {
                return distance;
            }
            light *= 1.0
                - self.cover(
                    &self.hit(ray, index, distance),
                    self.base(&self.hit(ray, index, distance), 0.0).w,
                );
            if light > 0.01 {
                f32::INFINITY
            } else {
                distance
            }
        });
        if missed { light } else { 0.0 }
    }

    /// The opacity of a surface whose material has this alpha at the hit.
    pub(super) fn cover(&self, hit: &Hit, alpha: f32) -> f32 {
        match self.materials[self.material(hit.triangle)].alpha {
            Alpha::Opaque => 1.0,
            Alpha::Mask(cutoff) => f32::from(u8::from(alpha >= cutoff)),
            Alpha::Blend => alpha.clamp(0.0, 1.0),
        }
    }

    /// Base colour and alpha at a hit, for a sample of this width.
    pub(super) fn base(&self, hit: &Hit, width: f32) -> Vec4 {
        let material = &self.materials[self.material(hit.triangle)];
        let corners = self.surface.triangles[hit.triangle];
        let mut base = material.base;
        let colours = &self.surface.colours;
        if !colours.is_empty() {
            base *= blend(corners, hit.shares, |corner| colours[corner]);
        }
        let Some(sampler) = &material.sampler else {
            return base;
        };
        let Some(texture) = &self.textures[sampler.image] else {
            return base;
        };
        let uvs = &self.surface.uvs;
        let uv = blend(corners, hit.shares, |corner| uvs[corner]);
        if !uv.is_finite() || uv.abs().max_element() > 1e6 {
            return base;
        }
        // The density of texels on this triangle.
        let [a, b, c] = corners.map(|corner| uvs[corner as usize] * texture.size());
        let texels = (b - a).perp_dot(c - a).abs();
        let area = self.triangles[hit.triangle].ng.length();
        base * texture.at(
            uv,
            width * (texels / area.max(f32::MIN_POSITIVE)).sqrt(),
            sampler,
        )
    }

    /// The unit normal of a triangle.
    pub(super) fn facet(&self, triangle: usize) -> Vec3 {
        self.triangles[triangle].compute_normal().into()
    }

    /// The interpolated normal of the file, if it has any.
    pub(super) fn normal(&self, hit: &Hit) -> Option<Vec3> {
        let normals = &self.surface.normals;
        let corners = self.surface.triangles[hit.triangle];
        blend(corners, hit.shares, |corner| normals[corner]).try_normalize()
    }

    /// The origin of shadow rays on a smooth surface: lifted off the triangle to the curved surface that it approximates, so
    /// that smooth objects cast no jagged shadows on themselves (Hanika 2021).
    pub(super) fn lifted(&self, hit: &Hit, place: Vec3, side: f32) -> Vec3 {
        let (positions, normals) = (&self.surface.positions, &self.surface.normals);
        let corners = self.surface.triangles[hit.triangle];
        place
            + blend(corners, hit.shares, |corner| {
                let normal = normals[corner] * side;
                let below = (place - positions[corner]).dot(normal).min(0.0);
                normal * -below
            })
    }
}

/// The distance at which a ray hits a triangle, infinite if it does not (Möller and Trumbore 1997).
///
/// `obvhs` has this test too, but lets rays slip through between two triangles.
#[inline]
fn meet(triangle: &RtTriangle, ray: &Ray) -> f32 {
    let to = triangle.v0 - ray.origin;
    let across = ray.direction.cross(to);
    let inverse = 1.0 / triangle.ng.dot(ray.direction);
    let u = across.dot(triangle.e2) * inverse;
    let v = across.dot(triangle.e1) * inverse;
    if u >= -EDGE && v >= -EDGE && u + v <= 1.0 + EDGE {
        let distance = triangle.ng.dot(to) * inverse;
        if distance >= ray.tmin && distance <= ray.tmax {
            return distance;
        }
    }
    f32::INFINITY
}

fn blend<T>(corners: [u32; 3], shares: Vec3, at: impl Fn(usize) -> T) -> T
where
    T: std::ops::Mul<f32, Output = T> + std::ops::Add<Output = T>,
{
    let [a, b, c] = corners.map(|corner| at(corner as usize));
    a * shares.x + b * shares.y + c * shares.z
}
