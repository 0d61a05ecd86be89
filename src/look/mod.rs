//! Whether a model, seen from the front, looks like its drawing.
//!
//! [`compare`] draws both and says which pixels show the right colour, per part and in all; [`hints()`] says it in words.
//! [`DrawnView`] is where a camera has to be so that the model lies on the page as drawn:
//!
//! ```text
//!  Compiled ─► DrawnView ─► render: per pixel the colour and the part that the model shows ─┐
//!  text ─► svg::raster: per pixel the colour that the drawing shows ────────────────────────┼─► Look ─► hints
//!  Bindings ─► Owners: per pixel the part that was drawn last ──────────────────────────────┘
//! ```
//!
//! Conventions: pixels are in rows from the top; the parts are those of the bindings, back-most first. Pixels near a border in
//! the drawing are not counted: there the two pictures are antialiased in different ways.

mod borders;
mod characters;
mod drawn;
mod hints;
mod view;

use rustc_hash::FxHashMap;
use typed_index_collections::{TiSlice, TiVec};

use crate::assemble::{Owner, assemble_apart};
use crate::bind::PartId;
use crate::compile::Compiled;
use crate::crash::Crash;
use crate::export::{self, GLB};
use crate::lang::keyword::Keyword;
use crate::render::{self, Options, PosedModel, RenderError};
use crate::resolver::Resolver;
use crate::scene::MaterialId;
use crate::terrain::{LandscapeId, Layer};
use crate::threads;
use borders::Borders;
use drawn::Drawn;

pub use hints::hints;
pub use view::DrawnView;

/// How far a channel may be off, of 255, over white.
const TOLERANCE: u8 = 24;

/// How a model looks, compared with its drawing.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Look {
    /// The share of the counted pixels that show the right colour, 0 to 1; 1 if none is counted.
    pub right: f64,
    /// The number of counted pixels: those where the drawing or the model shows something, away from borders, and those of lines
    /// that are not built.
    pub pixels: usize,
    /// The same share of the drawing without the lines that are not built.
    pub right_without_lines: f64,
    /// The lines that are not built, if the model does not look as they do.
    pub lines: Option<LinesLeftOut>,
    /// The parts that have counted pixels in the drawing, back-most first.
    pub parts: Vec<PartLook>,
}

/// Lines and outlines that a drawing shows and its model does not. Guides, leaders and hairlines beside all shapes are none.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LinesLeftOut {
    /// The share of the counted pixels that do not show the right colour because of these lines, above 0 and at most 1.
    pub share: f64,
    /// What `Strokes` would have to be for them to be built: `lines` or `all`.
    pub built_by: &'static str,
}

/// How a part looks.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct PartLook {
    /// The part.
    pub part: PartId,
    /// The number of counted pixels that show it in the drawing.
    pub pixels: usize,
    /// How many of them show the right colour in the model.
    pub right: usize,
    /// What most of the others show, and how many do.
    pub instead: Option<(Instead, usize)>,
}

impl PartLook {
    /// The share of its pixels that show the right colour, 0 to 1.
    pub fn share(&self) -> f64 {
        self.right as f64 / self.pixels.max(1) as f64
    }
}

/// What a model shows in the place of a part.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Instead {
    /// The part itself, in another colour.
    OtherColor,
    /// Nothing.
    Nothing,
    /// Another part.
    Part(PartId),
    /// The landscape of a tile layer.
    Landscape(LandscapeId),
}

/// Why a model cannot be compared with its drawing. Messages follow the name of the drawing.
#[derive(Debug, thiserror::Error)]
pub enum LookError {
    /// The page has no width or no height.
    #[error("has a page without a size")]
    NoPage,
    /// The drawing cannot be drawn.
    #[error("cannot be drawn for the comparison")]
    Drawing,
    /// The model cannot be drawn.
    #[error(transparent)]
    Render(#[from] RenderError),
    /// The model cannot be written.
    #[error("cannot be drawn: {0}")]
    Export(#[from] std::io::Error),
    /// Comparing panicked.
    #[error("cannot be compared: {0}; {help}", help = crate::crash::HELP)]
    Crash(#[from] Crash),
}

/// What a pixel shows.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
enum Shown {
    #[default]
    Nothing,
    Owner(Owner),
    /// A linked model, or a region of a picture: what looks as its file says.
    File,
}

/// Compares the model of a drawing with the drawing, seen from the front as [`DrawnView`] describes it, in pictures whose
/// larger side has `side` pixels. `text` is the drawing that was compiled, and `resolver` reads the files that it links to.
///
/// A pixel is right if each channel, over white, is off by at most 24 of 255. Where strings give a part another colour than is
/// drawn, it is right if it shows that part. Linked models are not counted.
///
/// # Errors
/// See [`LookError`].
pub fn compare(
    compiled: &Compiled,
    text: &str,
    resolver: &dyn Resolver,
    side: u32,
) -> Result<Look, LookError> {
    let longest = compiled.drawing.page.1.max_element();
    if !(longest > 0.0 && longest.is_finite()) {
        return Err(LookError::NoPage);
    }
    threads::run(|| {
        let scale = f64::from(side) / longest;
        let apart = assemble_apart(
            &compiled.drawing,
            &compiled.bindings,
            &compiled.characters,
            resolver,
        );
        let view = DrawnView::new(compiled, apart.scene, scale)?;
        let drawn = Drawn::new(compiled, text, resolver, view.size, scale)?;
        let shown = shown(&view, &apart.owners, resolver)?;
        Ok(count(compiled, &drawn, &shown))
    })?
}

/// What the model shows in each pixel: the surface, and its sRGB colour multiplied by alpha, and alpha.
fn shown(
    view: &DrawnView,
    owners: &TiSlice<MaterialId, Option<Owner>>,
    resolver: &dyn Resolver,
) -> Result<Vec<(Shown, [u8; 4])>, LookError> {
    let [width, height] = view.size;
    if view.scene.meshes.is_empty() {
        return Ok(vec![Default::default(); width as usize * height as usize]);
    }
    let bytes = export::to_memory(&GLB, &view.scene, None)?.bytes;
    let model = render::read(&bytes, resolver)?;
    drop(bytes);
    let posed = PosedModel::new(&model, &model.rest())?;
    let options = Options {
        size: view.size,
        ..Options::default()
    };
    let seen = posed.visible_surfaces_of(&options, &view.sheet)?;
    let pixel = |surface: Option<render::VisibleSurface>| {
        let Some(surface) = surface else {
            return Default::default();
        };
        let owner = surface
            .material
            .and_then(|material| owners.get(MaterialId::from(material)).copied().flatten());
        let what = owner.map_or(Shown::File, Shown::Owner);
        let byte = |value: f32| (value * 255.0 + 0.5).clamp(0.0, 255.0) as u8;
        (what, surface.blended.map(byte))
    };
    Ok(seen.into_iter().map(pixel).collect())
}

/// Counts the pixels that show the right colour.
fn count(compiled: &Compiled, drawn: &Drawn, shown: &[(Shown, [u8; 4])]) -> Look {
    let borders = Borders::find(drawn);
    let recolored = Recolored::new(compiled);
    let (mut pixels, mut right) = (0, 0);
    // Of the pixels of lines: how many there are, how many of them show the line's colour, and of those that are counted without
    // the lines too, how many there are and how many are right.
    let mut of_lines = [0; 2];
    let mut under_lines = [0; 2];
    let mut parts: FxHashMap<PartId, PartLook> = FxHashMap::default();
    let mut instead: FxHashMap<(PartId, Instead), usize> = FxHashMap::default();
    for (at, (shown, color)) in shown.iter().enumerate() {
        let (owner, drawn_color) = (drawn.owners[at], drawn.colors[at]);
        let line = drawn.lines.as_ref().map(|lines| lines.colors[at]);
        let line = line.filter(|line| !is_alike(*line, drawn_color));
        if let Some(line) = line
            && *shown != Shown::File
            && !drawn.is_model(owner)
        {
            of_lines[0] += 1;
            of_lines[1] += usize::from(is_alike(line, *color));
        }
        let is_empty = drawn_color[3] == 0 && color[3] == 0;
        if is_empty || borders.is_near(at) || *shown == Shown::File || drawn.is_model(owner) {
            continue;
        }
        let built = owner.map(|owner| drawn.built(owner));
        let is_same = built.map_or(Shown::Nothing, Shown::Owner) == *shown;
        let is_excused = is_same && owner.is_some_and(|owner| recolored.contains(owner));
        let is_right = is_excused || is_alike(drawn_color, *color);
        pixels += 1;
        right += usize::from(is_right);
        if line.is_some() {
            under_lines[0] += 1;
            under_lines[1] += usize::from(is_right);
        }
        let Some(Owner::Part(part)) = owner else {
            continue;
        };
        let look = parts.entry(part).or_insert(PartLook {
            part,
            pixels: 0,
            right: 0,
            instead: None,
        });
        look.pixels += 1;
        look.right += usize::from(is_right);
        if !is_right {
            let what = match *shown {
                _ if is_same => Instead::OtherColor,
                Shown::Owner(Owner::Part(other)) => Instead::Part(other),
                Shown::Owner(Owner::Landscape(layer)) => Instead::Landscape(layer),
                Shown::Nothing | Shown::File => Instead::Nothing,
            };
            *instead.entry((part, what)).or_default() += 1;
        }
    }
    let mut instead: Vec<_> = instead.into_iter().collect();
    instead.sort_unstable();
    for ((part, what), count) in instead {
        if let Some(look) = parts.get_mut(&part)
            && look.instead.is_none_or(|(_, most)| count > most)
        {
            look.instead = Some((what, count));
        }
    }
    let mut parts: Vec<PartLook> = parts.into_values().collect();
    parts.sort_unstable_by_key(|look| look.part);
    let share = |right: usize, pixels: usize| match pixels {
        0 => 1.0,
        _ => right as f64 / pixels as f64,
    };
    let [line_pixels, right_lines] = of_lines;
    let counted = pixels - under_lines[0] + line_pixels;
    let shown_right = right - under_lines[1] + right_lines;
    let lines = drawn.lines.as_ref().filter(|_| right_lines < line_pixels);
    Look {
        right: share(shown_right, counted),
        pixels: counted,
        right_without_lines: share(right, pixels),
        lines: lines.map(|lines| LinesLeftOut {
            share: share(line_pixels - right_lines, counted),
            built_by: lines.built_by,
        }),
        parts,
    }
}

/// Whether two colours, multiplied by alpha, look the same over white.
fn is_alike(one: [u8; 4], other: [u8; 4]) -> bool {
    let over_white =
        |[r, g, b, alpha]: [u8; 4]| [r, g, b].map(|value| value.saturating_add(255 - alpha));
    let (one, other) = (over_white(one), over_white(other));
    (0..3).all(|channel| one[channel].abs_diff(other[channel]) <= TOLERANCE)
}

/// What shows other colours than were drawn.
struct Recolored {
    parts: TiVec<PartId, bool>,
    landscapes: TiVec<LandscapeId, bool>,
}

impl Recolored {
    /// Finds what strings give a colour, a texture or an opacity, and what such things show through.
    fn new(compiled: &Compiled) -> Self {
        const OF_COLOR: [Keyword; 3] = [Keyword::Color, Keyword::Texture, Keyword::Alpha];
        let Compiled {
            bindings, drawing, ..
        } = compiled;
        let by_strings = |part: PartId| {
            let set = |keyword: &Keyword| bindings.setting(part, *keyword).is_some();
            OF_COLOR.iter().any(set)
        };
        let mut parts: TiVec<PartId, bool> = bindings.parts.keys().map(by_strings).collect();
        if parts.contains(&true) {
            for (index, part) in bindings.parts.iter_enumerated() {
                let has_server = part.paint(drawing).server.is_some();
                parts[index] |= has_server || drawing.shapes[part.shape].opacity < 1.0;
            }
        }
        let by_legends = |layer: &Layer| {
            let legends = (0..bindings.legends.len()).map(Some);
            let mut all = std::iter::once(None).chain(legends);
            all.any(|legend| {
                let attributes = bindings.tile_attributes(layer.index, legend);
                let set = |keyword: &Keyword| attributes.source(*keyword).is_some();
                OF_COLOR.iter().any(set)
            })
        };
        Self {
            parts,
            landscapes: compiled.layers.iter().map(by_legends).collect(),
        }
    }

    fn contains(&self, owner: Owner) -> bool {
        match owner {
            Owner::Part(part) => self.parts[part],
            Owner::Landscape(landscape) => self.landscapes[landscape],
        }
    }
}
