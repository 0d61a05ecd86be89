//! A posed model: one list of triangles, and what they are made of.

use glam::{DVec3, Vec2, Vec3, Vec4};

use super::texture::Sampler;
use crate::import::Soup;

/// How a material's alpha is meant.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Alpha {
    Opaque,
    /// There, where alpha is at least this.
    Mask(f32),
    /// As far as alpha says.
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
    /// Shown as it is, without light.
    pub(super) unlit: bool,
}

/// How the world is put on the stage: to `(point - middle) * scale`.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Frame {
    pub(super) middle: DVec3,
    pub(super) scale: f64,
}

impl Frame {
    /// Where a point of the world goes.
    pub(super) fn place(&self, point: DVec3) -> DVec3 {
        (point - self.middle) * self.scale
    }
}

/// Triangles on the stage: unless they keep to a frame from before, their box is centred at the origin and its longest
/// side is 1.
#[derive(Debug, Default)]
pub(super) struct Surface {
    pub(super) positions: Vec<Vec3>,
    /// Unit vectors; zero where the file has none.
    pub(super) normals: Vec<Vec3>,
    pub(super) uvs: Vec<Vec2>,
    /// One a corner, or empty.
    pub(super) colours: Vec<Vec4>,
    pub(super) triangles: Vec<[u32; 3]>,
    /// The material of each triangle.
    pub(super) materials: Vec<u32>,
    /// The least and the greatest corner of the box.
    pub(super) low: Vec3,
    pub(super) high: Vec3,
    pub(super) frame: Frame,
}

impl Surface {
    /// The triangles that stand somewhere and have an area. What has no material has the one behind the `materials`.
    pub(super) fn new(soup: Soup, materials: usize, frame: Option<Frame>) -> Self {
        let mut surface = Self {
            normals: soup.normals,
            uvs: soup.uvs,
            colours: soup.colours,
            triangles: soup.triangles,
            materials: soup
                .materials
                .iter()
                .map(|material| material.unwrap_or(materials as u32))
                .collect(),
            ..Self::default()
        };
        surface.place(&soup.positions, frame);
        surface
    }

    /// Takes over the positions; drops triangles that stand nowhere or have no area.
    fn place(&mut self, world: &[DVec3], frame: Option<Frame>) {
        let mut low = DVec3::INFINITY;
        let mut high = DVec3::NEG_INFINITY;
        let mut kept = self
            .triangles
            .iter()
            .map(|triangle| {
                let corners = triangle.map(|corner| world[corner as usize]);
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
        let frame = frame.unwrap_or(Frame { middle, scale });
        self.positions = world
            .iter()
            .map(|point| frame.place(*point).as_vec3())
            .collect();
        let half = ((high - low) / 2.0 * frame.scale).as_vec3();
        let middle = frame.place(middle).as_vec3();
        (self.low, self.high) = (middle - half, middle + half);
        self.frame = frame;
    }

    /// The corners that triangles have.
    pub(super) fn used(&self) -> Vec<Vec3> {
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
