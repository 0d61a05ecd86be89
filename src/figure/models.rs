//! Parts that are linked models: the files of `Shape model`, fitted to their parts.

use crate::math;
use std::sync::Arc;

use glam::{DMat3, DVec2, DVec3};
use rustc_hash::{FxHashMap, FxHashSet};
use typed_index_collections::TiVec;

use crate::bind::{Bindings, PartId};
use crate::diagnostic::{Code, Diagnostic};
use crate::geometry::{Frame, Outline};
use crate::import::{ImportError, StaticModel, read_static_model};
use crate::memo::Memo;
use crate::resolver::{LinkError, Resolver};
use crate::scene::{ImageId, Material, MaterialId, Scene, Surface, Texture, TextureId};
use crate::svg::broken_link;

/// Limit of the triangles of all parts that are models.
const MAX_TRIANGLES: usize = 16 << 20;

/// The linked models of a drawing, and the model of each part.
pub(super) struct Models {
    assets: Vec<Loaded>,
    of_part: FxHashMap<PartId, usize>,
}

struct Loaded {
    asset: Arc<StaticModel>,
    /// Per material of its own that in the scene.
    in_scene: TiVec<MaterialId, MaterialId>,
}

/// The key of a model file, by its link.
#[derive(PartialEq, Eq, Hash)]
struct ModelFile(String);

/// Why a model cannot be used.
#[derive(Clone)]
enum ModelError {
    Link(LinkError),
    Import(ImportError),
}

impl Models {
    pub(super) fn collect(
        bindings: &Bindings,
        resolver: &dyn Resolver,
        memo: &Memo,
        diagnostics: &mut Vec<Diagnostic>,
    ) -> Self {
        let mut models = Self {
            assets: Vec::new(),
            of_part: FxHashMap::default(),
        };
        let mut known: FxHashMap<&str, Result<usize, ModelError>> = FxHashMap::default();
        let mut reported = FxHashSet::default();
        let mut triangles = 0_usize;
        for (index, part) in bindings.parts.iter_enumerated() {
            let Some(shape) = bindings.attributes(index).shape_if_set() else {
                continue;
            };
            let Some(link) = shape.value.file() else {
                continue;
            };
            if !part.kind.is_solid() {
                continue;
            }
            let found = known.entry(link).or_insert_with(|| {
                let file = ModelFile(link.to_owned());
                let asset = memo.get_reading(file, resolver, |file, resolver| {
                    load(&file.0, resolver).map(Arc::new)
                })?;
                models.assets.push(Loaded {
                    asset,
                    in_scene: TiVec::new(),
                });
                Ok(models.assets.len() - 1)
            });
            let span = bindings.span_of(&shape.source);
            match found {
                Ok(asset) => {
                    triangles = triangles.saturating_add(models.assets[*asset].asset.triangles());
                    if triangles <= MAX_TRIANGLES {
                        models.of_part.insert(index, *asset);
                    } else if reported.insert(None) {
                        let message =
                            format!("the models have more than {MAX_TRIANGLES} triangles together");
                        let help = "use simpler models, or fewer of them";
                        diagnostics
                            .push(Diagnostic::new(Code::LimitPassed, span, message).help(help));
                    }
                }
                // A legend sets the model of many parts, but is reported once.
                Err(error) if reported.insert(Some(shape.source.string)) => {
                    diagnostics.push(match error {
                        ModelError::Link(error) => broken_link(link, error, span),
                        ModelError::Import(error) => {
                            let message = format!("the model `{link}` {error}");
                            Diagnostic::new(Code::MissingFile, span, message)
                                .help("until this is fixed, the part is built as a plate")
                        }
                    })
                }
                Err(_) => {}
            }
        }
        models
    }

    /// Whether a part is a model.
    pub(super) fn has(&self, part: PartId) -> bool {
        self.of_part.contains_key(&part)
    }

    pub(super) fn add_materials(&mut self, scene: &mut Scene) {
        for Loaded { asset, in_scene } in &mut self.assets {
            let images = asset.images.iter();
            let images: TiVec<ImageId, ImageId> = images
                .map(|image| scene.images.push_and_get_key(image.clone()))
                .collect();
            let texture = |texture: &Texture| {
                let image = images[texture.image];
                scene
                    .textures
                    .push_and_get_key(Texture { image, ..*texture })
            };
            let textures: TiVec<TextureId, TextureId> =
                asset.textures.iter().map(texture).collect();
            let material = |material: &Material| {
                let mut material = material.clone();
                for used in material.textures_mut() {
                    used.texture = textures[used.texture];
                }
                scene.materials.push_and_get_key(material)
            };
            *in_scene = asset.materials.iter().map(material).collect();
        }
    }

    /// The surfaces of a part that is a model, each with its material, in the frame of the node.
    ///
    /// The model is as large as its box fits into the part's, seen from the front, and both boxes have one middle;
    /// its up leads along the part's axis, and its front to the viewer.
    pub(super) fn surfaces(
        &self,
        part: PartId,
        outline: &Outline,
        [own, node]: [&Frame; 2],
        depth: f64,
        both: bool,
        scale: f64,
    ) -> Vec<(MaterialId, Surface)> {
        let asset = self.of_part.get(&part).map(|asset| &self.assets[*asset]);
        let Some(Loaded { asset, in_scene }) = asset else {
            return Vec::new();
        };
        let to_frame = own.drawing_about_center();
        let points = outline
            .polygons
            .iter()
            .flat_map(|polygon| polygon.rings.first())
            .flatten();
        let none = [DVec2::INFINITY, DVec2::NEG_INFINITY];
        let [low, high] = points.fold(none, |[low, high], point| {
            let point = to_frame.transform_point2(*point);
            [low.min(point), high.max(point)]
        });
        let [least, greatest] = asset.bounds;
        let room = (high - low) / (greatest - least).truncate();
        // What has no extent on one side fits there anyway.
        let size = [room.x, room.y].into_iter().filter(|room| room.is_finite());
        let size = size.fold(f64::INFINITY, f64::min);
        let size = if size.is_finite() { size } else { 1.0 };
        let spin = DMat3::from_quat(math::rotation_z(own.angle - node.angle));
        let turn = spin * (size * scale);
        let middle =
            spin * low.midpoint(high).extend(0.0) + node.to_local(own.center).extend(depth);
        let translation: DVec3 = middle * scale - turn * least.midpoint(greatest);
        asset
            .placed(turn, translation)
            .map(|(material, mut surface)| {
                if both {
                    let back = surface.mirrored();
                    surface.append(&back);
                }
                (in_scene[material], surface)
            })
            .collect()
    }
}

fn load(link: &str, resolver: &dyn Resolver) -> Result<StaticModel, ModelError> {
    let folder = link.rfind(['/', '\\']).map_or("", |end| &link[..=end]);
    let bytes = resolver.read(link).map_err(ModelError::Link)?;
    read_static_model(&bytes, &Beside { resolver, folder }).map_err(ModelError::Import)
}

/// Resolves the links of a linked file, which start from its own folder.
struct Beside<'a> {
    resolver: &'a dyn Resolver,
    folder: &'a str,
}

impl Resolver for Beside<'_> {
    fn read(&self, link: &str) -> Result<Arc<[u8]>, LinkError> {
        let absolute = link.starts_with(['/', '\\']) || link.contains(':');
        if absolute {
            self.resolver.read(link)
        } else {
            self.resolver.read(&format!("{}{link}", self.folder))
        }
    }
}
