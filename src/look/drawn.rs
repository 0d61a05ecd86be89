//! The drawing as pixels: colours, and what was drawn last.

use resvg::tiny_skia::{FillRule, Mask, PathBuilder, Transform};
use rustc_hash::FxHashMap;
use typed_index_collections::{TiSlice, TiVec};

use super::LookError;
use crate::assemble::Owner;
use crate::bind::{Bindings, Part, PartId, PartKind};
use crate::compile::Compiled;
use crate::geometry::Outline;
use crate::resolver::Resolver;
use crate::svg::{self, Drawing, LeftOut, ShapeId};
use crate::terrain::LandscapeId;

/// Shapes with less opacity are not seen.
const CLEAR: f64 = 1.0 / 255.0;

/// Strokes that a drawing shows and its model does not.
pub(super) struct Lines {
    /// Per pixel the colour, as in [`Drawn::colors`], of what is built together with these strokes.
    pub(super) colors: Vec<[u8; 4]>,
    /// The argument of `Strokes` that builds them.
    pub(super) built_by: &'static str,
}

/// A picture of a drawing, of what is built.
pub(super) struct Drawn {
    /// Width and height, pixels.
    pub(super) size: [u32; 2],
    /// Per pixel the sRGB colour multiplied by alpha, and alpha.
    pub(super) colors: Vec<[u8; 4]>,
    /// The strokes that are drawn and not built, if there are any.
    pub(super) lines: Option<Lines>,
    /// Per pixel what was drawn last there.
    pub(super) owners: Vec<Option<Owner>>,
    /// Per part whether a linked model is in its place.
    pub(super) models: TiVec<PartId, bool>,
    /// The parts that are regions of characters, each with the part of the same region in the first view.
    pub(super) regions: FxHashMap<PartId, PartId>,
}

impl Drawn {
    /// Draws what a drawing shows of its parts and tiles, at `scale` pixels a drawing unit.
    pub(super) fn new(
        compiled: &Compiled,
        text: &str,
        resolver: &dyn Resolver,
        size: [u32; 2],
        scale: f64,
    ) -> Result<Self, LookError> {
        let Compiled {
            bindings, drawing, ..
        } = compiled;
        let regions = regions(compiled);
        let owners = owners_of_parts(compiled, &regions);
        let NotBuilt { guides, lines } = not_built(drawing, bindings, &owners);
        let colors = |left_out: &FxHashMap<usize, LeftOut>| {
            let raster = svg::raster(text, resolver, left_out, size, scale);
            raster.map(|raster| raster.pixels).ok_or(LookError::Drawing)
        };
        let with_lines = match lines.is_empty() {
            true => None,
            false => Some(Lines {
                colors: colors(&guides)?,
                built_by: match lines.values().any(|what| *what == LeftOut::Stroke) {
                    true => "all",
                    false => "lines",
                },
            }),
        };
        let mut left_out = guides;
        left_out.extend(lines);
        let models = bindings.parts.keys();
        let is_model = |part: PartId| bindings.attributes(part).shape().kind == "model";
        Ok(Self {
            size,
            colors: colors(&left_out)?,
            lines: with_lines,
            owners: last_drawn(drawing, bindings, &owners, size, scale)?,
            models: models.map(is_model).collect(),
            regions,
        })
    }

    /// What a model shows in the place of what was drawn.
    pub(super) fn built(&self, owner: Owner) -> Owner {
        match owner {
            Owner::Part(part) => Owner::Part(self.regions.get(&part).copied().unwrap_or(part)),
            Owner::Landscape(_) => owner,
        }
    }

    /// Whether a linked model is built in the place of what was drawn.
    pub(super) fn is_model(&self, owner: Option<Owner>) -> bool {
        matches!(owner, Some(Owner::Part(part)) if self.models[part])
    }
}

/// The parts that views of characters show, each with the part of the same region in the first view.
fn regions(compiled: &Compiled) -> FxHashMap<PartId, PartId> {
    let mut first_of_shape = FxHashMap::default();
    for region in compiled.characters.iter().flat_map(|c| &c.regions) {
        let Some(first) = region.part else { continue };
        let shown = region.shapes.iter().zip(&region.is_hidden);
        let shapes = shown.filter_map(|(shape, is_hidden)| shape.filter(|_| !is_hidden));
        first_of_shape.extend(shapes.map(|shape| (shape, first)));
    }
    let parts = compiled.bindings.parts.iter_enumerated();
    let regions = parts.filter(|(_, part)| part.kind == PartKind::Region);
    regions
        .filter_map(|(index, part)| Some((index, *first_of_shape.get(&part.shape)?)))
        .collect()
}

/// Per part what it is in the model; `None` for what is not built.
fn owners_of_parts(
    compiled: &Compiled,
    regions: &FxHashMap<PartId, PartId>,
) -> TiVec<PartId, Option<Owner>> {
    let Compiled {
        bindings, drawing, ..
    } = compiled;
    let owner = |(index, part): (PartId, &Part)| match part.kind {
        PartKind::Prop if !is_seen(compiled, index) => None,
        PartKind::Main | PartKind::Sub | PartKind::Prop => {
            let is_built = bindings.profile(drawing, index).is_some();
            is_built.then_some(Owner::Part(index))
        }
        PartKind::Tile => landscape_of(compiled, part.shape).map(Owner::Landscape),
        PartKind::Region => regions.contains_key(&index).then_some(Owner::Part(index)),
        PartKind::Legend | PartKind::Unused => None,
    };
    bindings.parts.iter_enumerated().map(owner).collect()
}

/// Whether a prop is seen as it is drawn: plain maps are compared from straight above, from where what stands on them shows its upper
/// edge alone.
fn is_seen(compiled: &Compiled, part: PartId) -> bool {
    let standing = compiled
        .bindings
        .prop_of(part)
        .and_then(|prop| compiled.props.get(prop));
    standing.is_some_and(|standing| !compiled.layers[standing.landscape].map.is_plain())
}

/// The landscape that a shape belongs to.
fn landscape_of(compiled: &Compiled, shape: ShapeId) -> Option<LandscapeId> {
    let group = compiled.drawing.shapes[shape].group;
    let layer = compiled.bindings.tile_layer_of_group(group)?;
    compiled
        .layers
        .position(|landscape| landscape.index == layer)
}

/// What of a file is not built. Keys are the first bytes of elements.
struct NotBuilt {
    /// What is not meant to be: guides, samples of paints in legends, and what strings leave out.
    guides: FxHashMap<usize, LeftOut>,
    /// Strokes that another `Strokes` would build.
    lines: FxHashMap<usize, LeftOut>,
}

fn not_built(
    drawing: &Drawing,
    bindings: &Bindings,
    owners: &TiSlice<PartId, Option<Owner>>,
) -> NotBuilt {
    /// What is built of an element, and how many shapes it has.
    #[derive(Default)]
    struct Built {
        fill: bool,
        stroke: bool,
        has_stroke: bool,
        is_clone: bool,
        is_filled: bool,
        is_guide: bool,
    }
    let mut is_part: TiVec<ShapeId, bool> = vec![false; drawing.shapes.len()].into();
    for part in &bindings.parts {
        is_part[part.shape] = true;
    }
    let mut elements: FxHashMap<usize, Built> = FxHashMap::default();
    for (index, shape) in drawing.shapes.iter_enumerated() {
        let built = elements.entry(shape.element.span.start).or_default();
        // A picture that is a map is no part.
        built.fill |= bindings.is_picture_of_layer(drawing, index);
        built.has_stroke |= shape.stroke.is_some();
        built.is_clone |= shape.element.tag == "use";
        // Strokes of maps and of views have a meaning of their own there.
        built.is_guide |= bindings.is_in_layer(shape.group);
        built.is_filled |= !shape.outline.polygons.is_empty();
        if shape.outline.polygons.is_empty() {
            built.is_guide |= is_part[index]
                || bindings.is_leader(index)
                || shape
                    .stroke
                    .as_deref()
                    .is_none_or(|stroke| drawing.is_hairline(stroke));
        }
    }
    for (part, _) in bindings
        .parts
        .iter()
        .zip(owners)
        .filter(|(_, o)| o.is_some())
    {
        let start = drawing.shapes[part.shape].element.span.start;
        if let Some(built) = elements.get_mut(&start) {
            if part.is_stroke {
                built.stroke = true
            } else {
                built.fill = true
            }
        }
    }
    let found = elements.into_iter().filter_map(|(start, built)| {
        let (what, may_be_line) = match built {
            Built {
                fill: false,
                stroke: false,
                ..
            // A filled shape that is not built is left out with its outline.
            } => (LeftOut::Element, !built.is_filled),
            // What a clone shows has paints of its own.
            Built { is_clone: true, .. } => return None,
            Built { fill: false, .. } => (LeftOut::Fill, false),
            Built {
                stroke: false,
                has_stroke: true,
                ..
            } => (LeftOut::Stroke, true),
            _ => return None,
        };
        let is_line = may_be_line && built.has_stroke && !built.is_guide;
        Some((is_line, start, what))
    });
    let (lines, guides): (Vec<_>, Vec<_>) = found.partition(|(is_line, ..)| *is_line);
    let by_element = |found: Vec<(bool, usize, LeftOut)>| {
        let found = found.into_iter();
        found.map(|(_, start, what)| (start, what)).collect()
    };
    let mut guides: FxHashMap<usize, LeftOut> = by_element(guides);
    let poses = drawing.poses.layers.iter();
    let poses = poses.map(|layer| drawing.groups[*layer].element.span.start);
    guides.extend(poses.map(|start| (start, LeftOut::Element)));
    NotBuilt {
        guides,
        lines: by_element(lines),
    }
}

/// Per pixel what was drawn last over its middle.
fn last_drawn(
    drawing: &Drawing,
    bindings: &Bindings,
    owners: &TiSlice<PartId, Option<Owner>>,
    [width, height]: [u32; 2],
    scale: f64,
) -> Result<Vec<Option<Owner>>, LookError> {
    let mut drawn = vec![None; width as usize * height as usize];
    let mut mask = Mask::new(width, height).ok_or(LookError::Drawing)?;
    for (part, owner) in bindings.parts.iter().zip(owners) {
        if owner.is_none() || drawing.shapes[part.shape].opacity < CLEAR {
            continue;
        }
        let Some(path) = path(&part.outline) else {
            continue;
        };
        let corner = drawing.page.0;
        let transform = Transform::from_scale(scale as f32, scale as f32)
            .pre_translate(-corner.x as f32, -corner.y as f32);
        mask.fill_path(&path, FillRule::EvenOdd, false, transform);
        // Only the rows and columns that the part reaches are looked at.
        let (low, high) = part.measure.bounds;
        let within = |at: f64, side: u32| at.clamp(0.0, f64::from(side)) as usize;
        let low = (low - corner) * scale - 1.0;
        let high = (high - corner) * scale + 2.0;
        let columns = within(low.x, width)..within(high.x, width);
        for row in within(low.y, height)..within(high.y, height) {
            let at = row * width as usize;
            let covered = &mut mask.data_mut()[at + columns.start..at + columns.end];
            let drawn = &mut drawn[at + columns.start..at + columns.end];
            for (covered, drawn) in covered.iter_mut().zip(drawn) {
                if std::mem::take(covered) > 0 {
                    *drawn = *owner;
                }
            }
        }
    }
    Ok(drawn)
}

/// An outline as a path; `None` if it is empty.
fn path(outline: &Outline) -> Option<resvg::tiny_skia::Path> {
    let mut path = PathBuilder::new();
    for ring in outline.rings() {
        for (index, point) in ring.iter().enumerate() {
            let (x, y) = (point.x as f32, point.y as f32);
            match index {
                0 => path.move_to(x, y),
                _ => path.line_to(x, y),
            }
        }
        path.close();
    }
    path.finish()
}
