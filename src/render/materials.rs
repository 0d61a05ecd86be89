//! Materials and their images.

use std::io::Cursor;

use ::gltf::texture::{MagFilter, WrappingMode};
use ::gltf::{Document, image, material};
use ::image::{ImageReader, Limits, RgbaImage};
use glam::{Vec3, Vec4};

use super::surface::{Alpha, Material};
use super::texture::{Sampler, Texture, Wrap};
use crate::import::{Buffers, ImportError, fetch, malformed};
use crate::resolver::Resolver;

/// The longest side of an image, texels.
const SIDE_LIMIT: u32 = 16_384;
/// The memory that one image may take, bytes.
const IMAGE_LIMIT: u64 = 512 << 20;

/// The file's materials, and behind them the one of what has none.
pub(super) fn read(document: &Document) -> Vec<Material> {
    let mut materials: Vec<Material> = document
        .materials()
        .map(|source| self::material(&source))
        .collect();
    materials.push(Material {
        base: Vec4::ONE,
        sampler: None,
        alpha: Alpha::Opaque,
        double_sided: false,
        metallic: 0.0,
        roughness: 1.0,
        emissive: Vec3::ZERO,
        unlit: false,
    });
    materials
}

fn material(source: &::gltf::Material<'_>) -> Material {
    let base = source.pbr_metallic_roughness();
    let sampler = base.base_color_texture().map(|info| {
        let texture = info.texture();
        let sampler = texture.sampler();
        let wrap = |mode| match mode {
            WrappingMode::ClampToEdge => Wrap::Clamp,
            WrappingMode::MirroredRepeat => Wrap::Mirror,
            WrappingMode::Repeat => Wrap::Repeat,
        };
        Sampler {
            image: texture.source().index(),
            wrap: [wrap(sampler.wrap_s()), wrap(sampler.wrap_t())],
            nearest: sampler.mag_filter() == Some(MagFilter::Nearest),
        }
    });
    let strength = source.emissive_strength().unwrap_or(1.0);
    Material {
        base: Vec4::from(base.base_color_factor()),
        sampler,
        alpha: match source.alpha_mode() {
            material::AlphaMode::Opaque => Alpha::Opaque,
            material::AlphaMode::Mask => Alpha::Mask(source.alpha_cutoff().unwrap_or(0.5)),
            material::AlphaMode::Blend => Alpha::Blend,
        },
        double_sided: source.double_sided(),
        metallic: base.metallic_factor(),
        roughness: base.roughness_factor(),
        emissive: Vec3::from(source.emissive_factor()) * strength,
        unlit: source.unlit(),
    }
}

/// The images that base colours use, each at its index; none for the others, which are not even decoded.
pub(super) fn textures(
    document: &Document,
    buffers: &Buffers,
    resolver: &dyn Resolver,
) -> Result<Vec<Option<Texture>>, ImportError> {
    let mut used = vec![false; document.images().len()];
    for material in document.materials() {
        if let Some(info) = material.pbr_metallic_roughness().base_color_texture() {
            used[info.texture().source().index()] = true;
        }
    }
    let sources = &document.as_json().images;
    document
        .images()
        .zip(used)
        .map(|(image, used)| {
            if !used {
                return Ok(None);
            }
            let source = &sources[image.index()];
            if source.buffer_view.is_some() && source.mime_type.is_none()
                || source.buffer_view.is_none() && source.uri.is_none()
            {
                return Err(malformed(format!(
                    "image {} does not say where or what it is",
                    image.index()
                )));
            }
            let pixels = match image.source() {
                image::Source::View { view, .. } => decode(buffers.view(&view)?)?,
                image::Source::Uri { uri, .. } => decode(&fetch(uri, resolver)?)?,
            };
            Ok(Some(Texture::new(pixels)))
        })
        .collect()
}

fn decode(bytes: &[u8]) -> Result<RgbaImage, ImportError> {
    let failed = |error: String| ImportError::Image(error);
    let mut reader = ImageReader::new(Cursor::new(bytes))
        .with_guessed_format()
        .map_err(|error| failed(error.to_string()))?;
    let mut limits = Limits::default();
    limits.max_image_width = Some(SIDE_LIMIT);
    limits.max_image_height = Some(SIDE_LIMIT);
    limits.max_alloc = Some(IMAGE_LIMIT);
    reader.limits(limits);
    let image = reader.decode().map_err(|error| failed(error.to_string()))?;
    Ok(image.into_rgba8())
}
