//! Which pixels a surface may cover, so that no rays are traced in the others.

use glam::{Vec2, Vec3};

use super::camera::Camera;
use super::surface::Surface;

/// The side of the blocks that are marked together, in pixels.
const BLOCK: f32 = 2.0;
/// How far a triangle may reach beyond its corners by rounding, in pixels.
const TOLERANCE: f32 = 1.0;
/// How many blocks are marked, relative to the number of triangles and blocks, before it is not worth while.
const MAX_MARKS: usize = 8;

/// The places of a surface's positions in a picture. Those beside or behind the eye are not a number; so are those that no
/// triangle uses, perhaps.
pub(super) fn places(surface: &Surface, camera: &Camera) -> Vec<Vec2> {
    let place = |position: &Vec3| camera.project(*position).unwrap_or(Vec2::NAN);
    surface.positions.iter().map(place).collect()
}

/// The blocks of a picture that the bounding boxes of triangles reach.
pub(super) struct Coverage {
    columns: usize,
    /// Rows from the top; empty if any pixel may be covered.
    blocks: Vec<bool>,
}

impl Coverage {
    /// The pixels that `surface` may cover in a picture of `size` pixels, or as far beyond it as `margin`.
    /// `places` are the corners of its triangles in the picture.
    pub(super) fn new(surface: &Surface, places: &[Vec2], size: [u32; 2], margin: u32) -> Self {
        let sides = size.map(|side| (side + margin) as f32);
        let [columns, rows] = sides.map(|side| (side / BLOCK).ceil() as usize);
        let everywhere = Self {
            columns,
            blocks: Vec::new(),
        };
        let mut blocks = vec![false; columns * rows];
        let mut left = MAX_MARKS * (blocks.len() + surface.triangles.len());
        for triangle in &surface.triangles {
            let [a, b, c] = *triangle;
            let [a, b, c] = [places[a as usize], places[b as usize], places[c as usize]];
            if (a + b + c).is_nan() {
                return everywhere;
            }
            let low = ((a.min(b).min(c) - TOLERANCE) / BLOCK).floor();
            let high = ((a.max(b).max(c) + TOLERANCE) / BLOCK).floor();
            let (low, high) = (low.max(Vec2::ZERO), high + 1.0);
            // Negative numbers become 0.
            let [left_end, right_end] = [low.x, high.x].map(|x| (x as usize).min(columns));
            let [top, bottom] = [low.y, high.y].map(|y| (y as usize).min(rows));
            let width = right_end.saturating_sub(left_end);
            let Some(rest) = left.checked_sub(1 + width * bottom.saturating_sub(top)) else {
                return everywhere;
            };
            left = rest;
            if width > 0 {
                for row in top..bottom {
                    blocks[row * columns + left_end..][..width].fill(true);
                }
            }
        }
        Self { columns, blocks }
    }

    /// Whether a pixel may be covered.
    #[inline]
    pub(super) fn contains(&self, x: u32, y: u32) -> bool {
        let block = |place: u32| place as usize / BLOCK as usize;
        let index = block(y) * self.columns + block(x);
        self.blocks.get(index).copied().unwrap_or(true)
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::render::camera::{Framing, Projection, View};
    use crate::render::hierarchy::Rays;
    use crate::render::hierarchy::tests::ring;
    use crate::render::light::even;
    use crate::render::surface::Material;
    use crate::render::trace::Tracer;

    /// An opaque white material without light.
    pub(in crate::render) fn plain(double_sided: bool) -> Material {
        Material {
            base: glam::Vec4::ONE,
            sampler: None,
            alpha: crate::render::surface::Alpha::Opaque,
            double_sided,
            metallic: 0.0,
            roughness: 1.0,
            emissive: Vec3::ZERO,
            unlit: true,
        }
    }

    #[test]
    fn rays_hit_covered_pixels_only() {
        let materials = [plain(true)];
        for (seed, projection) in [(1, Projection::Perspective), (2, Projection::Orthographic)] {
            let view = View::default();
            let size = [90, 70];
            let surface = ring(seed);
            let points = surface.used_positions();
            let shots = [(view, ())];
            let framing = Framing::new(&shots, projection, size, |_, ()| {
                Ok::<_, ()>(std::borrow::Cow::Borrowed(&*points))
            });
            let camera = framing.unwrap().camera(view);
            let tracer = Tracer::new(surface, &materials, &[], Rays::Many);
            let coverage =
                Coverage::new(&tracer.surface, &places(&tracer.surface, &camera), size, 2);
            let (mut hits, mut empty) = (0, 0);
            for (x, y) in (0..size[1]).flat_map(|y| (0..size[0]).map(move |x| (x, y))) {
                let corner = Vec2::new(x as f32, y as f32);
                let hit = (0..16).any(|index| {
                    let (origin, direction) = camera.ray(corner + even(index));
                    tracer.closest(origin, direction, 0.0).is_some()
                });
                hits += usize::from(hit);
                empty += usize::from(!coverage.contains(x, y));
                assert!(!hit || coverage.contains(x, y), "{x} {y}");
            }
            assert!(hits > 500 && empty > 1000, "{hits} {empty}");
            // With the eye in their midst, triangles are all around.
            let within = camera.moved(tracer.surface.positions[0] - camera.ray(Vec2::ZERO).0);
            if projection == Projection::Perspective {
                let coverage =
                    Coverage::new(&tracer.surface, &places(&tracer.surface, &within), size, 2);
                assert!(coverage.contains(0, 0) && coverage.contains(89, 69));
            }
        }
    }
}
