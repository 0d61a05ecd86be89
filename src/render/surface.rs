//! The triangles of a posed model and their materials.

use glam::{DVec3, Vec2, Vec3, Vec4};

use super::texture::Sampler;
use crate::import::TriangleSoup;

/// The meaning of a material's alpha.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Alpha {
    Opaque,
    /// Opaque if alpha is at least this.
    Mask(f32),
    /// Alpha is coverage.
    Blend,
}

/// A material. Colours are linear.
#[derive(Debug, Clone)]
pub(super) struct Material {
    /// Colour and alpha.
    pub(super) base: Vec4,
    pub(super) sampler: Option<Sampler>,
    pub(super) alpha: Alpha,
    pub(super) double_sided: bool,
    pub(super) metallic: f32,
    pub(super) roughness: f32,
    pub(super) emissive: Vec3,
    /// Shown in its base colour, without light.
    pub(super) unlit: bool,
}

/// From the world into normalised space: `(point - middle) * scale`.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Normalization {
    pub(super) middle: DVec3,
    pub(super) scale: f64,
}

impl Normalization {
    /// A point of the world in normalised space.
    pub(super) fn apply(&self, point: DVec3) -> DVec3 {
        (point - self.middle) * self.scale
    }
}

/// Triangles in normalised space: their bounding box is centred at the origin and its longest side is 1, unless the
/// normalization of another pose is used.
#[derive(Debug, Default)]
pub(super) struct Surface {
    pub(super) positions: Vec<Vec3>,
    /// Unit vectors; zero if the file has none.
    pub(super) normals: Vec<Vec3>,
    pub(super) uvs: Vec<Vec2>,
    /// One per corner, or empty.
    pub(super) colors: Vec<Vec4>,
    pub(super) triangles: Vec<[u32; 3]>,
    /// The material of each triangle.
    pub(super) materials: Vec<u32>,
    /// The lower corner of the bounding box.
    pub(super) low: Vec3,
    pub(super) high: Vec3,
    pub(super) normalization: Normalization,
}

impl Surface {
    /// The triangles that are finite and have an area. Those without a material get the one at index `materials`.
    pub(super) fn new(
        soup: TriangleSoup,
        materials: usize,
        normalization: Option<Normalization>,
    ) -> Self {
        let mut surface = Self {
            normals: soup.normals,
            uvs: soup.uvs,
            colors: soup.colors,
            triangles: soup.triangles,
            materials: soup
                .materials
                .iter()
                .map(|material| material.unwrap_or(materials as u32))
                .collect(),
            ..Self::default()
        };
        surface.place(&soup.positions, normalization);
        surface
    }

    /// Sets the positions, and drops triangles that are not finite or have no area.
    fn place(&mut self, world: &[DVec3], normalization: Option<Normalization>) {
        let mut low = DVec3::INFINITY;
        let mut high = DVec3::NEG_INFINITY;
        let mut kept = self
            .triangles
            .iter()
            .map(|triangle| {
                let [a, b, c] = *triangle;
                let corners = [world[a as usize], world[b as usize], world[c as usize]];
                let [a, b, c] = corners;
                let sound = corners
                    .iter()
                    .all(|corner| corner.is_finite() && corner.abs().max_element() < 1e30)
                    && (b - a).cross(c - a) != DVec3::ZERO;
                if sound {
                    low = corners.iter().fold(low, |low, corner| low.min(*corner));
                    high = corners.iter().fold(high, |high, corner| high.max(*corner));
                }
                sound
            })
            .collect::<Vec<bool>>()
            .into_iter();
        let mut also = kept.clone();
        self.triangles.retain(|_| kept.next().unwrap_or(false));
        self.materials.retain(|_| also.next().unwrap_or(false));
        let middle = (low + high) / 2.0;
        let size = (high - low).max_element();
        let scale = if size > 0.0 { 1.0 / size } else { 1.0 };
        let normalization = normalization.unwrap_or(Normalization { middle, scale });
        self.positions = world
            .iter()
            .map(|point| normalization.apply(*point).as_vec3())
            .collect();
        let half = ((high - low) / 2.0 * normalization.scale).as_vec3();
        let middle = normalization.apply(middle).as_vec3();
        (self.low, self.high) = (middle - half, middle + half);
        self.normalization = normalization;
    }

    /// A distance from the origin, in any direction, beyond which there is nothing.
    pub(super) fn reach(&self) -> f64 {
        f64::from(1.0 + self.low.abs().max(self.high.abs()).length())
    }

    /// The positions that triangles use.
    pub(super) fn used_positions(&self) -> Vec<Vec3> {
        let mut used = vec![false; self.positions.len()];
        self.triangles
            .iter()
            .flatten()
            .for_each(|corner| used[*corner as usize] = true);
        let pairs = self.positions.iter().zip(used);
        pairs
            .filter(|(_, used)| *used)
            .map(|(position, _)| *position)
            .collect()
    }
}
