//! Traces rays: what they hit, and how much light passes.

use glam::{Vec3, Vec4};

use super::hierarchy::{Hierarchy, Rays};
use super::lanes::Hit;
use super::surface::{Alpha, Material, Surface};
use super::texture::Texture;

/// A surface in a bounding volume hierarchy.
pub(super) struct Tracer<'a> {
    pub(super) surface: Surface,
    pub(super) materials: &'a [Material],
    textures: &'a [Option<Texture>],
    hierarchy: Hierarchy,
    /// Whether any material is transparent.
    clear: bool,
}

impl<'a> Tracer<'a> {
    pub(super) fn new(
        surface: Surface,
        materials: &'a [Material],
        textures: &'a [Option<Texture>],
        rays: Rays,
    ) -> Self {
        let hierarchy = Hierarchy::new(&surface, rays);
        Self::with_hierarchy(surface, materials, textures, hierarchy)
    }

    /// With a hierarchy of this surface.
    pub(super) fn with_hierarchy(
        surface: Surface,
        materials: &'a [Material],
        textures: &'a [Option<Texture>],
        hierarchy: Hierarchy,
    ) -> Self {
        let clear = materials
            .iter()
            .any(|material| material.alpha != Alpha::Opaque);
        Self {
            surface,
            materials,
            textures,
            hierarchy,
            clear,
        }
    }

    /// Its hierarchy, for other pictures.
    pub(super) fn into_hierarchy(self) -> Hierarchy {
        self.hierarchy
    }

    #[inline]
    pub(super) fn material(&self, triangle: usize) -> usize {
        self.surface.materials[triangle] as usize
    }

    /// The first triangle beyond `nearest` that is visible to the ray; single-sided ones are invisible from behind.
    pub(super) fn closest(&self, origin: Vec3, direction: Vec3, nearest: f32) -> Option<Hit> {
        let visible =
            |hit: &Hit| !hit.behind || self.materials[self.material(hit.triangle)].double_sided;
        self.hierarchy.closest(origin, direction, nearest, visible)
    }

    /// The share of light that arrives from a direction, 0 to 1.
    pub(super) fn light_through(&self, origin: Vec3, direction: Vec3) -> f32 {
        let mut light = 1.0;
        let blocked = self.hierarchy.is_blocked(origin, direction, |hit| {
            if self.clear {
                light *= 1.0 - self.cover(hit, self.base(hit, 0.0).w);
            } else {
                light = 0.0;
            }
            light <= 0.01
        });
        if blocked { 0.0 } else { light }
    }

    /// The opacity of a surface whose material has this alpha at the hit.
    #[inline]
    pub(super) fn cover(&self, hit: &Hit, alpha: f32) -> f32 {
        match self.materials[self.material(hit.triangle)].alpha {
            Alpha::Opaque => 1.0,
            Alpha::Mask(cutoff) => f32::from(u8::from(alpha >= cutoff)),
            Alpha::Blend => alpha.clamp(0.0, 1.0),
        }
    }

    /// Base colour and alpha at a hit, for a sample of this width.
    #[inline]
    pub(super) fn base(&self, hit: &Hit, width: f32) -> Vec4 {
        let material = &self.materials[self.material(hit.triangle)];
        let corners = self.surface.triangles[hit.triangle];
        let mut base = material.base;
        let colors = &self.surface.colors;
        if !colors.is_empty() {
            base *= blend(corners, hit.shares, |corner| colors[corner]);
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
        let area = self.inward(hit.triangle).length();
        base * texture.at(
            uv,
            width * (texels / area.max(f32::MIN_POSITIVE)).sqrt(),
            sampler,
        )
    }

    /// The unit normal of a triangle.
    #[inline]
    pub(super) fn facet(&self, triangle: usize) -> Vec3 {
        -self.inward(triangle).normalize_or_zero()
    }

    /// A vector at a right angle to a triangle, twice as long as its area.
    #[inline]
    pub(super) fn inward(&self, triangle: usize) -> Vec3 {
        let [a, b, c] = self.surface.triangles[triangle];
        let at = |corner: u32| self.surface.positions[corner as usize];
        (at(a) - at(b)).cross(at(c) - at(a))
    }

    /// The interpolated normal of the file, if it has any.
    #[inline]
    pub(super) fn normal(&self, hit: &Hit) -> Option<Vec3> {
        let normals = &self.surface.normals;
        let corners = self.surface.triangles[hit.triangle];
        blend(corners, hit.shares, |corner| normals[corner]).try_normalize()
    }

    /// The origin of shadow rays on a smooth surface: lifted off the triangle to the curved surface that it approximates, so
    /// that smooth objects cast no jagged shadows on themselves (Hanika 2021).
    #[inline]
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

fn blend<T>(corners: [u32; 3], shares: Vec3, at: impl Fn(usize) -> T) -> T
where
    T: std::ops::Mul<f32, Output = T> + std::ops::Add<Output = T>,
{
    // Not `map`, which is not inlined.
    let [a, b, c] = corners;
    at(a as usize) * shares.x + at(b as usize) * shares.y + at(c as usize) * shares.z
}
