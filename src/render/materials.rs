//! Reads materials and their images.

use ::gltf::texture::{MagFilter, WrappingMode};
use ::gltf::{Document, material};
use glam::{Vec3, Vec4};

use super::surface::{Alpha, Material};
use super::texture::{Sampler, Texture, Wrap};
use crate::import::{Buffers, ImportError, decode};
use crate::resolver::Resolver;

/// The file's materials, followed by the one for triangles without a material.
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

/// The images of base colour textures, by index; images with other uses are not decoded.
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
    document
        .images()
        .zip(used)
        .map(|(image, used)| {
            if used {
                let bytes = buffers.image(document, &image, resolver)?;
                Ok(Some(Texture::new(decode(&bytes)?)))
            } else {
                Ok(None)
            }
        })
        .collect()
}
