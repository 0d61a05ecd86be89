//! The textures of parts and tiles: `Texture`, gradients, patterns, pictures.

use std::sync::Arc;

use glam::{DAffine2, DVec2};
use rustc_hash::{FxHashMap, FxHashSet};
use typed_index_collections::{TiSlice, TiVec};

use crate::bind::{Bindings, PartId, StringId};
use crate::diagnostic::{Code, Diagnostic};
use crate::figure::LinkedModels;
use crate::memo::Memo;
use crate::resolver::{LinkError, Resolver};
use crate::scene::{self, Image, ImageId, Texture, TextureId, Wrap};
use crate::source::Span;
use crate::svg::{Drawing, PaintKey, broken_link};
use crate::terrain::{LandscapeId, Layer, TileTexture};
use crate::texture::{
    self, Alpha, Baked, Holes, PaintServer, Picture, PictureError, Plan, PlanKey, Source,
};

/// Pixels of a tile along as much of the drawing as the page's diagonal is long.
const DETAIL: f64 = 2048.0;

/// The textures of a drawing, and the texture of each part and tile.
pub(super) struct Textures {
    textures: TiVec<TextureId, Texture>,
    images: TiVec<ImageId, Image>,
    alphas: TiVec<ImageId, Alpha>,
    of_part: FxHashMap<PartId, Textured>,
    /// By tile layer and look.
    of_look: FxHashMap<(LandscapeId, usize), TextureId>,
}

#[derive(Clone, Copy)]
pub(super) struct Textured {
    pub(super) texture: TextureId,
    /// From the drawing to texture coordinates.
    pub(super) map: DAffine2,
    /// Whether it is the file of `Texture`.
    pub(super) is_file: bool,
}

/// A part whose texture is planned.
struct TexturedPart {
    part: PartId,
    server: Arc<PaintServer>,
    plan: usize,
    is_file: bool,
}

impl Textures {
    /// `regions` are the parts that are regions of characters, and decide what these look like.
    #[expect(
        clippy::too_many_arguments,
        reason = "it is called once, with all that is known"
    )]
    pub(super) fn collect<'a>(
        drawing: &'a Drawing,
        bindings: &'a Bindings,
        models: &LinkedModels,
        layers: &'a TiSlice<LandscapeId, Layer>,
        regions: &[PartId],
        resolver: &dyn Resolver,
        memo: &Memo,
        diagnostics: &mut Vec<Diagnostic>,
    ) -> Self {
        let mut collector = Collector {
            drawing,
            bindings,
            files: Files {
                resolver,
                memo,
                read: FxHashMap::default(),
                reported: FxHashSet::default(),
            },
            plans: Vec::new(),
            names: Vec::new(),
            known: FxHashMap::default(),
            parts: Vec::new(),
            looks: Vec::new(),
            reported: FxHashSet::default(),
        };
        for (index, part) in bindings.parts.iter_enumerated() {
            let built = part.kind.is_solid();
            if built && !models.has(index) && bindings.profile(drawing, index).is_some() {
                collector.part(index, diagnostics);
            }
        }
        for region in regions {
            collector.part(*region, diagnostics);
        }
        for (index, layer) in layers.iter_enumerated() {
            collector.layer(index, layer, diagnostics);
        }
        texture::fit(&mut collector.plans);
        let baked = memo.get_each(collector.plans.clone(), Plan::bake);
        collector.finish(baked, diagnostics)
    }

    pub(super) fn of(&self, part: PartId) -> Option<Textured> {
        self.of_part.get(&part).copied()
    }

    /// The texture of a tile layer's look.
    pub(super) fn of_look(&self, layer: LandscapeId, look: usize) -> Option<TextureId> {
        self.of_look.get(&(layer, look)).copied()
    }

    /// The name of a texture, and whether it is transparent.
    pub(super) fn about(&self, texture: TextureId) -> (&str, Alpha) {
        let image = self.textures[texture].image;
        (&self.images[image].name, self.alphas[image])
    }

    pub(super) fn into_lists(self) -> (TiVec<TextureId, Texture>, TiVec<ImageId, Image>) {
        (self.textures, self.images)
    }
}

struct Collector<'a> {
    drawing: &'a Drawing,
    bindings: &'a Bindings,
    files: Files<'a>,
    plans: Vec<Plan>,
    /// The names of the plans.
    names: Vec<String>,
    known: FxHashMap<PlanKey, usize>,
    parts: Vec<TexturedPart>,
    /// Tile layers' looks, each with the plan that is laid over each tile.
    looks: Vec<((LandscapeId, usize), usize)>,
    /// Paints that cannot be drawn and were reported.
    reported: FxHashSet<&'a PaintKey>,
}

impl<'a> Collector<'a> {
    fn part(&mut self, index: PartId, diagnostics: &mut Vec<Diagnostic>) {
        let (drawing, bindings) = (self.drawing, self.bindings);
        let part = &bindings.parts[index];
        let attributes = bindings.attributes(index);
        let file = attributes.texture().and_then(|texture| {
            let span = bindings.span_of(&texture.source);
            let string = texture.source.string;
            self.files.picture(texture.value, string, span, diagnostics)
        });
        let paint = part.paint(drawing);
        if file.is_none() && paint.server.is_none() {
            return;
        }
        let extent = part.measure.bounds;
        let (server, name) = match (file, &paint.server) {
            (Some((link, picture)), _) => {
                let (low, high) = extent;
                let place = DAffine2::from_translation(low) * DAffine2::from_scale(high - low);
                let source = Source::Picture(picture, scene::Filter::Linear);
                (
                    Arc::new(PaintServer { source, place }),
                    Some(file_name(link).to_owned()),
                )
            }
            (None, Some(server)) => {
                let picture = matches!(paint.key, PaintKey::Picture(_));
                if !picture && attributes.color().is_some() {
                    return;
                }
                (Arc::clone(server), None)
            }
            (None, None) => return,
        };
        let is_file = name.is_some();
        let density = DETAIL / drawing.page.1.length().max(f64::MIN_POSITIVE);
        let plan = match server.plan([extent.0, extent.1], density) {
            Ok(plan) => plan,
            Err(why) => return diagnostics.extend(self.plain(index, why)),
        };
        let number = self.number(plan, || {
            name.unwrap_or_else(|| match &paint.key {
                PaintKey::Server(id) => format!("#{id}"),
                _ => drawing.shapes[part.shape].element.own_name().to_owned(),
            })
        });
        self.parts.push(TexturedPart {
            part: index,
            server,
            plan: number,
            is_file,
        });
    }

    /// The looks of a tile layer.
    fn layer(&mut self, index: LandscapeId, layer: &'a Layer, diagnostics: &mut Vec<Diagnostic>) {
        for (number, look) in layer.materials.iter().enumerate() {
            let (source, name) = match &look.texture {
                None => continue,
                Some(TileTexture::File { link, string, span }) => {
                    let file = self.files.picture(link, *string, *span, diagnostics);
                    let Some((link, picture)) = file else {
                        continue;
                    };
                    let source = Source::Picture(picture, scene::Filter::Linear);
                    (source, file_name(link))
                }
                // Most tile sets are drawn pixel by pixel.
                Some(TileTexture::Pictures(picture)) => {
                    let source = Source::Picture(picture.clone(), scene::Filter::Nearest);
                    (source, layer.name.as_str())
                }
            };
            let server = PaintServer {
                source,
                place: DAffine2::IDENTITY,
            };
            if let Ok(plan) = server.plan([DVec2::ZERO, DVec2::ONE], 1.0) {
                let plan = self.number(plan, || name.to_owned());
                self.looks.push(((index, number), plan));
            }
        }
    }

    /// The index of a plan; equal plans share one.
    fn number(&mut self, plan: Plan, name: impl FnOnce() -> String) -> usize {
        let next = self.plans.len();
        let number = *self.known.entry(plan.key()).or_insert(next);
        if number == next {
            self.plans.push(plan);
            self.names.push(name());
        }
        number
    }

    /// Reports, once for each paint, that it appears in one colour.
    fn plain(&mut self, part: PartId, why: &str) -> Option<Diagnostic> {
        let (drawing, bindings) = (self.drawing, self.bindings);
        let part = &bindings.parts[part];
        let key = &part.paint(drawing).key;
        let what = match key {
            PaintKey::Server(id) => format!("the gradient or pattern `#{id}`"),
            PaintKey::Picture(_) | PaintKey::Solid(_) => "the picture".to_owned(),
        };
        self.reported.insert(key).then(|| {
            let span = drawing.shapes[part.shape].element.span;
            let message = format!("{what} appears in the model as its mean colour: {why}");
            Diagnostic::new(Code::PlainPaint, span, message)
                .help("make it simpler, or set the part's colour with `Color`")
        })
    }

    fn finish(
        mut self,
        baked: Vec<Result<Baked, &'static str>>,
        diagnostics: &mut Vec<Diagnostic>,
    ) -> Textures {
        let mut textures = Textures {
            textures: TiVec::new(),
            images: TiVec::new(),
            alphas: TiVec::new(),
            of_part: FxHashMap::default(),
            of_look: FxHashMap::default(),
        };
        let mut numbers = Vec::with_capacity(baked.len());
        for (baked, name) in baked.into_iter().zip(std::mem::take(&mut self.names)) {
            numbers.push(baked.map(|baked| {
                textures.alphas.push(baked.picture.alpha);
                let image = textures.images.push_and_get_key(Image {
                    name,
                    media_type: baked.picture.media_type,
                    bytes: baked.picture.bytes,
                });
                textures.textures.push_and_get_key(Texture {
                    image,
                    wrap: baked.wrap,
                    filter: baked.filter,
                })
            }));
        }
        for part in std::mem::take(&mut self.parts) {
            match numbers[part.plan] {
                Ok(texture) => {
                    let map = self.plans[part.plan].map(&part.server);
                    let is_file = part.is_file;
                    let textured = Textured {
                        texture,
                        map,
                        is_file,
                    };
                    textures.of_part.insert(part.part, textured);
                }
                Err(why) => diagnostics.extend(self.plain(part.part, why)),
            }
        }
        // On tiles a picture repeats, which is another texture of the same image.
        let mut repeated: FxHashMap<TextureId, TextureId> = FxHashMap::default();
        for (look, plan) in std::mem::take(&mut self.looks) {
            let Ok(once) = numbers[plan] else { continue };
            let list = &mut textures.textures;
            let texture = *repeated.entry(once).or_insert_with(|| {
                list.push_and_get_key(Texture {
                    wrap: [Wrap::Repeat; 2],
                    ..list[once]
                })
            });
            textures.of_look.insert(look, texture);
        }
        textures
    }
}

/// The last part of a link.
fn file_name(link: &str) -> &str {
    link.rsplit(['/', '\\']).next().unwrap_or(link)
}

/// The files that `Texture` names.
struct Files<'a> {
    resolver: &'a dyn Resolver,
    memo: &'a Memo,
    /// The pictures that were read, by link.
    read: FxHashMap<&'a str, ReadPicture>,
    /// Strings whose file was reported.
    reported: FxHashSet<StringId>,
}

/// The key of a picture file, by its link.
#[derive(PartialEq, Eq, Hash)]
struct PictureFile(String);

/// The picture in a file, or what is wrong with it.
type ReadPicture = Result<Result<Picture, (Code, String)>, LinkError>;

impl<'a> Files<'a> {
    /// A file's name and picture; if there is none, it is reported once for each string.
    fn picture(
        &mut self,
        link: &'a str,
        string: StringId,
        span: Span,
        diagnostics: &mut Vec<Diagnostic>,
    ) -> Option<(&'a str, Picture)> {
        let found = self.read.entry(link).or_insert_with(|| {
            let file = PictureFile(link.to_owned());
            let read = |file: &PictureFile, resolver: &dyn Resolver| read(&file.0, resolver);
            self.memo.get_reading(file, self.resolver, read)
        });
        if let Ok(Ok(picture)) = found {
            return Some((link, picture.clone()));
        }
        if self.reported.insert(string) {
            diagnostics.extend(match found {
                Err(error) => Some(broken_link(link, error, span)),
                Ok(Err((code, message))) => Some(
                    Diagnostic::new(*code, span, format!("the picture `{link}` {message}"))
                        .help("use a smaller picture, or save it again as PNG or JPEG"),
                ),
                Ok(Ok(_)) => None,
            });
        }
        None
    }
}

fn read(link: &str, resolver: &dyn Resolver) -> ReadPicture {
    let bytes = resolver.read(link)?;
    Ok(match texture::decode(&bytes) {
        Ok(decoded) => texture::picture(decoded, &bytes, Holes::Alpha).ok_or_else(|| {
            let message = "cannot be written as PNG".to_owned();
            (Code::LimitPassed, message)
        }),
        Err(error) => Err(match error {
            PictureError::TooLarge => (Code::LimitPassed, error.to_string()),
            PictureError::Unreadable(_) => (Code::MissingFile, error.to_string()),
        }),
    })
}
