//! Materials, textures, samplers and images of the JSON.

use serde::{Serialize, Serializer};

use super::document::Number;
use super::packing::Packed;
use super::room::text;
use crate::scene::{self, AlphaMode, Filter, MediaType, Scene, TextureUse, Wrap};

/// More bytes than what is written here takes, reckoned before anything is packed.
pub(super) fn room(scene: &Scene) -> usize {
    const MATERIAL: usize = 768;
    const TEXTURE: usize = 64;
    const SAMPLER: usize = 96;
    /// With the view that holds its bytes.
    const IMAGE: usize = 224;

    let materials = scene.materials.iter();
    let materials: usize = materials.map(|m| MATERIAL + text(&m.name)).sum();
    let images = scene.images.iter();
    let images: usize = images.map(|image| IMAGE + text(&image.name)).sum();
    materials + images + scene.textures.len() * (TEXTURE + SAMPLER)
}

pub(super) struct Materials<'a>(pub(super) &'a Scene);

impl Serialize for Materials<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_seq(self.0.materials.iter().map(Material::new))
    }
}

#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
struct Material<'a> {
    #[serde(skip_serializing_if = "str::is_empty")]
    name: &'a str,
    pbr_metallic_roughness: MetallicRoughness,
    #[serde(skip_serializing_if = "Option::is_none")]
    normal_texture: Option<TextureInfo>,
    #[serde(skip_serializing_if = "Option::is_none")]
    occlusion_texture: Option<TextureInfo>,
    #[serde(skip_serializing_if = "Option::is_none")]
    emissive_texture: Option<TextureInfo>,
    #[serde(skip_serializing_if = "Option::is_none")]
    emissive_factor: Option<[Number; 3]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    alpha_mode: Option<&'static str>,
    #[serde(skip_serializing_if = "Option::is_none")]
    alpha_cutoff: Option<Number>,
    #[serde(skip_serializing_if = "Option::is_none")]
    double_sided: Option<bool>,
}

#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
struct MetallicRoughness {
    base_color_factor: [Number; 4],
    #[serde(skip_serializing_if = "Option::is_none")]
    base_color_texture: Option<TextureInfo>,
    metallic_factor: Number,
    roughness_factor: Number,
    #[serde(skip_serializing_if = "Option::is_none")]
    metallic_roughness_texture: Option<TextureInfo>,
}

/// A texture as a material names it; its coordinates are always the first set.
#[derive(Serialize, Default)]
struct TextureInfo {
    index: usize,
    #[serde(skip_serializing_if = "Option::is_none")]
    scale: Option<Number>,
    #[serde(skip_serializing_if = "Option::is_none")]
    strength: Option<Number>,
}

impl TextureInfo {
    fn plain(texture: &TextureUse) -> Self {
        Self {
            index: texture.texture,
            ..Self::default()
        }
    }

    /// The amount, unless it is the format's own default.
    fn amount(texture: &TextureUse) -> Option<Number> {
        (texture.amount != 1.0).then_some(Number(texture.amount))
    }

    fn normal(texture: &TextureUse) -> Self {
        Self {
            scale: Self::amount(texture),
            ..Self::plain(texture)
        }
    }

    fn occlusion(texture: &TextureUse) -> Self {
        Self {
            strength: Self::amount(texture),
            ..Self::plain(texture)
        }
    }
}

impl<'a> Material<'a> {
    fn new(material: &'a scene::Material) -> Self {
        let plain = |texture: &Option<TextureUse>| texture.as_ref().map(TextureInfo::plain);
        let (alpha_mode, cutoff) = match material.alpha_mode {
            AlphaMode::Opaque => (None, None),
            AlphaMode::Mask { cutoff } => (Some("MASK"), Some(cutoff)),
            AlphaMode::Blend => (Some("BLEND"), None),
        };
        Self {
            name: &material.name,
            pbr_metallic_roughness: MetallicRoughness {
                base_color_factor: material.base_color.map(Number),
                base_color_texture: plain(&material.base_color_texture),
                metallic_factor: Number(material.metallic),
                roughness_factor: Number(material.roughness),
                metallic_roughness_texture: plain(&material.metallic_roughness_texture),
            },
            normal_texture: material.normal_texture.as_ref().map(TextureInfo::normal),
            occlusion_texture: material
                .occlusion_texture
                .as_ref()
                .map(TextureInfo::occlusion),
            emissive_texture: plain(&material.emissive_texture),
            emissive_factor: (material.emissive != [0.0; 3]).then(|| material.emissive.map(Number)),
            alpha_mode,
            // One half is the format's own default.
            alpha_cutoff: cutoff.filter(|cutoff| *cutoff != 0.5).map(Number),
            double_sided: material.double_sided.then_some(true),
        }
    }
}

/// The ways of sampling that textures ask for, each once, in the order of the textures.
fn samplers(scene: &Scene) -> Vec<([Wrap; 2], Filter)> {
    let mut samplers = Vec::new();
    for texture in &scene.textures {
        let sampler = (texture.wrap, texture.filter);
        // There are no more than eighteen.
        if !samplers.contains(&sampler) {
            samplers.push(sampler);
        }
    }
    samplers
}

pub(super) struct Textures<'a> {
    scene: &'a Scene,
    packed: &'a Packed,
    samplers: Vec<([Wrap; 2], Filter)>,
}

impl<'a> Textures<'a> {
    pub(super) fn new(scene: &'a Scene, packed: &'a Packed) -> Self {
        Self {
            scene,
            packed,
            samplers: samplers(scene),
        }
    }
}

impl Serialize for Textures<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        #[derive(Serialize)]
        struct Texture {
            #[serde(skip_serializing_if = "Option::is_none")]
            sampler: Option<usize>,
            source: usize,
        }
        serializer.collect_seq(self.scene.textures.iter().map(|texture| {
            let sampler = (texture.wrap, texture.filter);
            Texture {
                sampler: self.samplers.iter().position(|known| *known == sampler),
                source: self.packed.image_numbers[texture.image],
            }
        }))
    }
}

pub(super) struct Samplers(Vec<([Wrap; 2], Filter)>);

impl Samplers {
    pub(super) fn new(scene: &Scene) -> Self {
        Self(samplers(scene))
    }
}

impl Serialize for Samplers {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        #[derive(Serialize)]
        #[serde(rename_all = "camelCase")]
        struct Sampler {
            mag_filter: u16,
            min_filter: u16,
            wrap_s: u16,
            wrap_t: u16,
        }
        const NEAREST: u16 = 9728;
        const LINEAR: u16 = 9729;
        const NEAREST_MIPMAP_LINEAR: u16 = 9986;
        const LINEAR_MIPMAP_LINEAR: u16 = 9987;
        let wrap = |wrap: Wrap| match wrap {
            Wrap::Repeat => 10497,
            Wrap::MirroredRepeat => 33648,
            Wrap::ClampToEdge => 33071,
        };
        serializer.collect_seq(self.0.iter().map(|([s, t], filter)| {
            let (mag_filter, min_filter) = match filter {
                Filter::Linear => (LINEAR, LINEAR_MIPMAP_LINEAR),
                Filter::Nearest => (NEAREST, NEAREST_MIPMAP_LINEAR),
            };
            Sampler {
                mag_filter,
                min_filter,
                wrap_s: wrap(*s),
                wrap_t: wrap(*t),
            }
        }))
    }
}

/// The images, equal ones once.
pub(super) struct Images<'a>(pub(super) &'a Scene, pub(super) &'a Packed);

impl Serialize for Images<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        #[derive(Serialize)]
        #[serde(rename_all = "camelCase")]
        struct Image<'a> {
            #[serde(skip_serializing_if = "str::is_empty")]
            name: &'a str,
            buffer_view: usize,
            mime_type: &'static str,
        }
        let Self(scene, packed) = self;
        serializer.collect_seq(packed.images.iter().map(|stored| {
            let image = &scene.images[stored.image];
            Image {
                name: &image.name,
                buffer_view: stored.view,
                mime_type: match image.media_type {
                    MediaType::Png => "image/png",
                    MediaType::Jpeg => "image/jpeg",
                },
            }
        }))
    }
}
