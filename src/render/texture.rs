//! Images on surfaces, with mipmaps.

use crate::math;
use glam::{Vec2, Vec3, Vec4};
use image::RgbaImage;
use std::sync::LazyLock;

/// The linear light of each sRGB byte.
static LINEAR: LazyLock<[f32; 256]> = LazyLock::new(|| {
    std::array::from_fn(|byte| {
        let value = byte as f64 / 255.0;
        let linear = if value <= 0.04045 {
            value / 12.92
        } else {
            math::powf((value + 0.055) / 1.055, 2.4)
        };
        linear as f32
    })
});

/// The linear light of an sRGB byte.
pub(super) fn srgb_to_linear(byte: u8) -> f32 {
    LINEAR[usize::from(byte)]
}

/// The nearest sRGB byte of linear light.
#[inline]
pub(super) fn linear_to_srgb(light: f32) -> u8 {
    (srgb_value(light) * 255.0 + 0.5).clamp(0.0, 255.0) as u8
}

/// The sRGB value of linear light, both from 0 to 1.
fn srgb_value(light: f32) -> f32 {
    if light <= 0.003_130_8 {
        12.92 * light
    } else {
        1.055 * math::powf(light, 1.0 / 2.4) - 0.055
    }
}

/// The sRGB values of a linear colour, each cut to the range from 0 to 1.
pub(super) fn srgb_values(color: Vec3) -> Vec3 {
    color.map(|light| srgb_value(light.clamp(0.0, 1.0)))
}

/// How texture coordinates outside an image are mapped into it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Wrap {
    Clamp,
    Mirror,
    Repeat,
}

impl Wrap {
    fn apply(self, place: i64, length: u32) -> u32 {
        let length = i64::from(length);
        let place = match self {
            Self::Clamp => place.clamp(0, length - 1),
            Self::Repeat => place.rem_euclid(length),
            Self::Mirror => {
                let place = place.rem_euclid(2 * length);
                place.min(2 * length - 1 - place)
            }
        };
        place as u32
    }
}

/// How an image is sampled.
#[derive(Debug, Clone, Copy)]
pub(super) struct Sampler {
    /// Index of the image.
    pub(super) image: usize,
    pub(super) wrap: [Wrap; 2],
    /// Whether magnified texels have sharp edges.
    pub(super) nearest: bool,
}

/// An image and its mipmaps, down to one texel.
#[derive(Debug)]
pub(super) struct Texture {
    levels: Vec<RgbaImage>,
}

impl Texture {
    pub(super) fn new(image: RgbaImage) -> Self {
        let mut levels = vec![image];
        while let Some(half) = levels.last().and_then(half) {
            levels.push(half);
        }
        Self { levels }
    }

    /// Width and height in texels.
    pub(super) fn size(&self) -> Vec2 {
        let (width, height) = self.levels[0].dimensions();
        Vec2::new(width as f32, height as f32)
    }

    /// Linear colour and alpha at `uv` (origin at the image's top left), for a pixel that covers `texels` texels.
    pub(super) fn at(&self, uv: Vec2, texels: f32, sampler: &Sampler) -> Vec4 {
        let level = math::log2(texels.max(1.0)).round() as usize;
        let image = &self.levels[level.min(self.levels.len() - 1)];
        let size = Vec2::new(image.width() as f32, image.height() as f32);
        let place = uv * size;
        if sampler.nearest && level == 0 {
            return texel(
                image,
                place.x.floor() as i64,
                place.y.floor() as i64,
                sampler.wrap,
            );
        }
        let corner = (place - 0.5).floor();
        let share = place - 0.5 - corner;
        let (x, y) = (corner.x as i64, corner.y as i64);
        let at = |dx: i64, dy: i64| {
            texel(
                image,
                x.saturating_add(dx),
                y.saturating_add(dy),
                sampler.wrap,
            )
        };
        let top = at(0, 0).lerp(at(1, 0), share.x);
        let bottom = at(0, 1).lerp(at(1, 1), share.x);
        top.lerp(bottom, share.y)
    }
}

fn texel(image: &RgbaImage, x: i64, y: i64, wrap: [Wrap; 2]) -> Vec4 {
    let [r, g, b, a] = image
        .get_pixel(
            wrap[0].apply(x, image.width()),
            wrap[1].apply(y, image.height()),
        )
        .0;
    Vec4::new(
        srgb_to_linear(r),
        srgb_to_linear(g),
        srgb_to_linear(b),
        f32::from(a) / 255.0,
    )
}

/// The next mipmap: half the size, each side rounded up; `None` for a single texel.
fn half(image: &RgbaImage) -> Option<RgbaImage> {
    let (width, height) = image.dimensions();
    if width.max(height) <= 1 {
        return None;
    }
    Some(RgbaImage::from_fn(
        width.div_ceil(2),
        height.div_ceil(2),
        |x, y| {
            let mut color = Vec4::ZERO;
            for (dx, dy) in [(0, 0), (1, 0), (0, 1), (1, 1)] {
                let (x, y) = ((2 * x + dx).min(width - 1), (2 * y + dy).min(height - 1));
                let texel = texel(image, i64::from(x), i64::from(y), [Wrap::Clamp; 2]);
                // Weighted by alpha, so that transparent texels do not bleed.
                color += (texel.truncate() * texel.w).extend(texel.w);
            }
            let alpha = color.w / 4.0;
            let color = color.truncate() / color.w.max(1e-6);
            let [r, g, b] = color.to_array().map(linear_to_srgb);
            image::Rgba([r, g, b, (alpha * 255.0 + 0.5) as u8])
        },
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn srgb_bytes_survive_the_round_trip() {
        for byte in 0..=255 {
            assert_eq!(linear_to_srgb(srgb_to_linear(byte)), byte);
        }
        assert_eq!(linear_to_srgb(f32::INFINITY), 255);
    }

    #[test]
    fn wrap_modes_apply_at_edges() {
        let places = [-1, 0, 3, 4, 7, 8];
        assert_eq!(places.map(|x| Wrap::Clamp.apply(x, 4)), [0, 0, 3, 3, 3, 3]);
        assert_eq!(places.map(|x| Wrap::Repeat.apply(x, 4)), [3, 0, 3, 0, 3, 0]);
        assert_eq!(places.map(|x| Wrap::Mirror.apply(x, 4)), [0, 0, 3, 3, 0, 0]);
    }

    #[test]
    fn distant_textures_use_mipmaps() {
        let image = RgbaImage::from_fn(64, 64, |x, y| match (x + y) % 2 {
            0 => image::Rgba([255, 255, 255, 255]),
            _ => image::Rgba([0, 0, 0, 255]),
        });
        let texture = Texture::new(image);
        let sampler = Sampler {
            image: 0,
            wrap: [Wrap::Repeat; 2],
            nearest: true,
        };
        let near = texture.at(Vec2::new(0.5 / 64.0, 0.5 / 64.0), 0.5, &sampler);
        assert_eq!(near, Vec4::ONE);
        let far = texture.at(Vec2::splat(0.3), 64.0, &sampler);
        assert!((far.x - 0.5).abs() < 0.02, "{far}");
    }
}
