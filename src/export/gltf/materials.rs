//! Materials, textures, samplers and images of the JSON.

use ::gltf::json::image::MimeType;
use ::gltf::json::material::{
    AlphaCutoff, AlphaMode as JsonAlphaMode, EmissiveFactor, Material as JsonMaterial,
    NormalTexture, OcclusionTexture, PbrBaseColorFactor, PbrMetallicRoughness, StrengthFactor,
};
use ::gltf::json::texture::{Info, MagFilter, MinFilter, Sampler, Texture, WrappingMode};
use ::gltf::json::validation::Checked::Valid;
use ::gltf::json::{Image, Index, Root, Value};
use serde_json::json;

use super::document::{index, name};
use super::primitives::Packed;
use crate::scene::{AlphaMode, Filter, Material, MediaType, Scene, TextureUse, Wrap};

/// The extension of materials that show their colour whatever the light.
pub(super) const UNLIT: &str = "KHR_materials_unlit";

/// A material as JSON. Members that have the value that the format assumes without them are left out.
pub(super) fn material(material: &Material) -> Value {
    let plain = |texture: &TextureUse| Info {
        index: index(texture.texture),
        tex_coord: 0,
        extensions: None,
        extras: None,
    };
    let (alpha_mode, cutoff) = match material.alpha_mode {
        AlphaMode::Opaque => (JsonAlphaMode::Opaque, None),
        AlphaMode::Mask { cutoff } => (JsonAlphaMode::Mask, Some(AlphaCutoff(cutoff))),
        AlphaMode::Blend => (JsonAlphaMode::Blend, None),
    };
    let json = JsonMaterial {
        name: name(&material.name),
        pbr_metallic_roughness: PbrMetallicRoughness {
            base_color_factor: PbrBaseColorFactor(material.base_color),
            base_color_texture: material.base_color_texture.as_ref().map(plain),
            metallic_factor: StrengthFactor(material.metallic),
            roughness_factor: StrengthFactor(material.roughness),
            metallic_roughness_texture: material.metallic_roughness_texture.as_ref().map(plain),
            ..PbrMetallicRoughness::default()
        },
        normal_texture: material.normal_texture.map(|texture| NormalTexture {
            index: index(texture.texture),
            scale: texture.amount,
            tex_coord: 0,
            extensions: None,
            extras: None,
        }),
        occlusion_texture: material.occlusion_texture.map(|texture| OcclusionTexture {
            index: index(texture.texture),
            strength: StrengthFactor(texture.amount),
            tex_coord: 0,
            extensions: None,
            extras: None,
        }),
        emissive_texture: material.emissive_texture.as_ref().map(plain),
        emissive_factor: EmissiveFactor(material.emissive),
        alpha_mode: Valid(alpha_mode),
        alpha_cutoff: cutoff,
        double_sided: material.double_sided,
        ..JsonMaterial::default()
    };
    let mut value = json!(json);
    remove_defaults(&mut value);
    if material.unlit {
        value["extensions"] = json!({ UNLIT: {} });
    }
    value
}

/// Removes the members that the JSON types always write, where they say nothing.
fn remove_defaults(value: &mut Value) {
    let Value::Object(members) = value else {
        return;
    };
    members.retain(|name, value| match name.as_str() {
        "alphaMode" => *value != "OPAQUE",
        "alphaCutoff" => *value != 0.5,
        "doubleSided" => *value != false,
        "emissiveFactor" => *value != json!([0.0, 0.0, 0.0]),
        "texCoord" => *value != 0,
        "scale" | "strength" => *value != 1.0,
        _ => true,
    });
    members.values_mut().for_each(remove_defaults);
}

/// Adds textures, their samplers, and images to the document.
pub(super) fn add_textures(scene: &Scene, packed: &Packed, root: &mut Root) {
    // The ways of sampling, each once in the order of the textures. There are no more than eighteen.
    let mut samplers: Vec<([Wrap; 2], Filter)> = Vec::new();
    for texture in &scene.textures {
        let sampling = (texture.wrap, texture.filter);
        let known = samplers.iter().position(|known| *known == sampling);
        root.textures.push(Texture {
            name: None,
            sampler: Some(index(known.unwrap_or(samplers.len()))),
            source: index(packed.image_numbers[texture.image]),
            extensions: None,
            extras: None,
        });
        if known.is_none() {
            samplers.push(sampling);
        }
    }
    root.samplers = samplers.into_iter().map(sampler).collect();
    root.images = packed
        .images
        .iter()
        .map(|stored| {
            let image = &scene.images[stored.image];
            Image {
                buffer_view: Some(Index::new(stored.view as u32)),
                mime_type: Some(MimeType(mime_type(image.media_type).to_owned())),
                name: name(&image.name),
                uri: None,
                extensions: None,
                extras: None,
            }
        })
        .collect();
}

fn sampler(([s, t], filter): ([Wrap; 2], Filter)) -> Sampler {
    let wrap = |wrap: Wrap| match wrap {
        Wrap::Repeat => WrappingMode::Repeat,
        Wrap::MirroredRepeat => WrappingMode::MirroredRepeat,
        Wrap::ClampToEdge => WrappingMode::ClampToEdge,
    };
    let (mag_filter, min_filter) = match filter {
        Filter::Linear => (MagFilter::Linear, MinFilter::LinearMipmapLinear),
        Filter::Nearest => (MagFilter::Nearest, MinFilter::NearestMipmapLinear),
    };
    Sampler {
        mag_filter: Some(Valid(mag_filter)),
        min_filter: Some(Valid(min_filter)),
        wrap_s: Valid(wrap(s)),
        wrap_t: Valid(wrap(t)),
        ..Sampler::default()
    }
}

fn mime_type(media_type: MediaType) -> &'static str {
    match media_type {
        MediaType::Png => "image/png",
        MediaType::Jpeg => "image/jpeg",
    }
}
