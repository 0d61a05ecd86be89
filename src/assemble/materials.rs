//! Materials, shared by all parts and tiles with the same factors and texture.

use rustc_hash::FxHashMap;
use typed_index_collections::{TiSlice, TiVec};

use super::Owner;
use super::textures::{Textured, Textures};
use crate::bind::{Bindings, MaterialFactors, PartId};
use crate::diagnostic::Diagnostic;
use crate::figure::LinkedModels;
use crate::memo::Memo;
use crate::resolver::Resolver;
use crate::scene::{
    AlphaMode, Image, ImageId, Material, MaterialId, PartMaterial, Scene, Texture, TextureId,
    TextureUse, linear,
};
use crate::svg::Drawing;
use crate::terrain::{LandscapeId, Layer, Tile, TileMaterial};
use crate::texture::Alpha;

/// The alpha below which a texture with only opaque and transparent pixels has a hole.
const CUTOFF: f32 = 0.5;

/// Which parts and tiles have a material in common.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Sharing {
    /// All with the same factors and texture.
    Alike,
    /// Only tiles of one layer.
    Apart,
}

/// The materials of a drawing, and the material of each part and tile.
pub(super) struct Materials {
    list: TiVec<MaterialId, Material>,
    textures: TiVec<TextureId, Texture>,
    images: TiVec<ImageId, Image>,
    of_part: TiVec<PartId, PartMaterial>,
    /// Per tile layer and look its material.
    of_looks: TiVec<LandscapeId, Vec<Option<MaterialId>>>,
}

/// Collects materials; equal ones of one owner are one.
#[derive(Default)]
struct Shared {
    list: TiVec<MaterialId, Material>,
    known: FxHashMap<Key, MaterialId>,
}

impl Shared {
    /// A material of this owner; `None` is everybody.
    fn slot(
        &mut self,
        owner: Option<Owner>,
        factors: &MaterialFactors,
        double_sided: bool,
        texture: Option<TextureId>,
        textures: &Textures,
    ) -> MaterialId {
        let list = &mut self.list;
        let key = key(factors, double_sided, texture, owner);
        let known = self.known.entry(key);
        *known.or_insert_with(|| {
            list.push_and_get_key(textured(factors, double_sided, texture, textures))
        })
    }
}

/// Two parts with equal keys share a material.
#[derive(PartialEq, Eq, Hash)]
struct Key {
    factors: [u64; 9],
    double_sided: bool,
    texture: Option<TextureId>,
    owner: Option<Owner>,
}

impl Materials {
    #[expect(
        clippy::too_many_arguments,
        reason = "it is called once, with all that is known"
    )]
    pub(super) fn collect(
        drawing: &Drawing,
        bindings: &Bindings,
        models: &LinkedModels,
        layers: &TiSlice<LandscapeId, Layer>,
        regions: &[PartId],
        sharing: Sharing,
        resolver: &dyn Resolver,
        memo: &Memo,
        diagnostics: &mut Vec<Diagnostic>,
    ) -> Self {
        let textures = Textures::collect(
            drawing,
            bindings,
            models,
            layers,
            regions,
            resolver,
            memo,
            diagnostics,
        );
        let mut shared = Shared::default();
        let owned_by = |owner: Owner| (sharing == Sharing::Apart).then_some(owner);
        let look = |part: PartId| {
            let mut factors = bindings.material_factors(drawing, part);
            let textured = textures.of(part);
            if let Some(textured) = textured {
                // What a file shows is tinted by `Color`, but by nothing else.
                let tinted = textured.is_file && bindings.attributes(part).color().is_some();
                if !tinted {
                    factors.color[..3].fill(1.0);
                }
            }
            (factors, textured)
        };
        let mut of_part: TiVec<PartId, PartMaterial> = TiVec::with_capacity(bindings.parts.len());
        for (index, part) in bindings.parts.iter_enumerated() {
            let built = part.kind.is_solid();
            // Models bring their own materials.
            let own = built && !models.has(index);
            let Some(profile) = bindings.profile(drawing, index).filter(|_| own) else {
                of_part.push(None);
                continue;
            };
            let (factors, textured) = look(index);
            let double_sided = profile.is_open();
            let texture = textured.map(|textured| textured.texture);
            let owner = owned_by(Owner::Part(index));
            let slot = shared.slot(owner, &factors, double_sided, texture, &textures);
            of_part.push(Some((slot, textured.map(|textured| textured.map))));
        }
        for region in regions {
            let (factors, Some(Textured { texture, map, .. })) = look(*region) else {
                continue;
            };
            let mut material = textured(&factors, true, Some(texture), &textures);
            material.unlit = true;
            of_part[*region] = Some((shared.list.push_and_get_key(material), Some(map)));
        }
        let mut of_look = |layer: LandscapeId, number: usize, found: &TileMaterial| {
            let mut factors = found.factors.clone();
            let texture = textures.of_look(layer, number);
            if texture.is_some() && !found.is_tinted {
                factors.color[..3].fill(1.0);
            }
            let owner = owned_by(Owner::Landscape(layer));
            let drawn = found.tile != Tile::None;
            drawn.then(|| shared.slot(owner, &factors, false, texture, &textures))
        };
        let of_layer = |(index, layer): (LandscapeId, &Layer)| {
            let looks = layer.materials.iter().enumerate();
            looks
                .map(|(number, look)| of_look(index, number, look))
                .collect()
        };
        let of_looks = layers.iter_enumerated().map(of_layer).collect();
        let (textures, images) = textures.into_lists();
        Self {
            list: shared.list,
            textures,
            images,
            of_part,
            of_looks,
        }
    }

    /// A scene that has them, and nothing else yet; and which part and which look of a tile layer has which.
    pub(super) fn into_scene(self) -> (Scene, TiVec<PartId, PartMaterial>, LookMaterials) {
        let scene = Scene {
            materials: self.list,
            textures: self.textures,
            images: self.images,
            ..Scene::default()
        };
        (scene, self.of_part, LookMaterials(self.of_looks))
    }
}

/// Per tile layer and look its material.
pub(super) struct LookMaterials(pub(super) TiVec<LandscapeId, Vec<Option<MaterialId>>>);

impl LookMaterials {
    /// The material of a layer's look, if anything looks so.
    pub(super) fn of(&self, layer: LandscapeId, look: u8) -> Option<MaterialId> {
        self.0[layer].get(usize::from(look)).copied().flatten()
    }
}

fn key(
    factors: &MaterialFactors,
    double_sided: bool,
    texture: Option<TextureId>,
    owner: Option<Owner>,
) -> Key {
    let [r, g, b, alpha] = factors.color;
    let [er, eg, eb] = factors.emissive;
    let all = [
        r,
        g,
        b,
        alpha,
        factors.metallic,
        factors.roughness,
        er,
        eg,
        eb,
    ];
    Key {
        factors: all.map(f64::to_bits),
        double_sided,
        texture,
        owner,
    }
}

/// A material, with a texture if it has one.
fn textured(
    factors: &MaterialFactors,
    double_sided: bool,
    texture: Option<TextureId>,
    textures: &Textures,
) -> Material {
    let mut material = material(factors, double_sided);
    if let Some(texture) = texture {
        let (name, alpha) = textures.about(texture);
        name.clone_into(&mut material.name);
        material.base_color_texture = Some(TextureUse::new(texture));
        material.alpha_mode = match (material.alpha_mode, alpha) {
            (AlphaMode::Opaque, Alpha::Opaque) => AlphaMode::Opaque,
            (AlphaMode::Opaque, Alpha::Holes) => AlphaMode::Mask { cutoff: CUTOFF },
            _ => AlphaMode::Blend,
        };
    }
    material
}

fn material(factors: &MaterialFactors, double_sided: bool) -> Material {
    let [r, g, b, alpha] = factors.color;
    let byte = |channel: f64| (channel.clamp(0.0, 1.0) * 255.0).round() as u8;
    Material {
        name: format!("#{:02x}{:02x}{:02x}", byte(r), byte(g), byte(b)),
        base_color: [
            linear(r),
            linear(g),
            linear(b),
            alpha.clamp(0.0, 1.0) as f32,
        ],
        metallic: factors.metallic as f32,
        roughness: factors.roughness as f32,
        emissive: factors.emissive.map(linear),
        alpha_mode: if alpha < 1.0 {
            AlphaMode::Blend
        } else {
            AlphaMode::Opaque
        },
        double_sided,
        ..Material::default()
    }
}
