//! The content of a tile layer: filled shapes, pictures and strokes.

use glam::DVec2;
use rustc_hash::FxHashSet;
use typed_index_collections::{TiVec, ti_vec};

use super::grid::Grid;
use super::materials::{Painted, Paints};
use super::raster::{Item, MAX_PAINTS, Picture, paint_code};
use crate::bind::{Bindings, LayerId, PartKind, StringHolder};
use crate::diagnostic::{Code, Diagnostic};
use crate::geometry::bounds;
use crate::lang::ast::Annotation;
use crate::svg::{Drawing, LARGE, PictureSource, ShapeId, StrokeSource};

/// The largest number of pixels of all pictures of a layer.
const MAX_PIXELS: usize = 1 << 28;
/// The largest number of cells that the bounding boxes of a layer's shapes may cover, summed.
const MAX_COVERED: u64 = 1 << 34;
/// For pictures that are SVG: the smallest and the largest number of pixels along the longer side, and the preferred number a
/// tile, which is odd so that one pixel is in the middle.
const SVG_SIDE: [u32; 3] = [1024, 8192, 3];

/// The content of a tile layer, back-most first.
#[derive(Debug, Default, Clone)]
pub(super) struct Content {
    /// Filled shapes and pictures, each with its bounding box, drawing units.
    pub(super) fills: Vec<(ShapeId, [DVec2; 2])>,
    pub(super) strokes: Vec<ShapeId>,
}

/// The content of each tile layer.
pub(super) fn contents(drawing: &Drawing, bindings: &Bindings) -> TiVec<LayerId, Content> {
    let mut contents = ti_vec![Content::default(); bindings.layers.len()];
    // A shape with its own string is not a tile. Lines usually have no part at all.
    let mut is_tile: TiVec<ShapeId, bool> = ti_vec![true; drawing.shapes.len()];
    for part in bindings
        .parts
        .iter()
        .filter(|part| !matches!(part.kind, PartKind::Tile | PartKind::Region))
    {
        is_tile[part.shape] = false;
    }
    let unused = bindings.strings.iter();
    let unused = unused.filter(|string| string.annotation == Annotation::Unused);
    let left_out: FxHashSet<ShapeId> = unused
        .filter_map(|string| match string.holder {
            StringHolder::Shape(shape) => Some(shape),
            _ => None,
        })
        .collect();
    for (index, shape) in drawing.shapes.iter_enumerated() {
        let Some(layer) = bindings.tile_layer_of_group(shape.group) else {
            continue;
        };
        if !is_tile[index] || left_out.contains(&index) {
            continue;
        }
        if let Some((low, high)) = bounds(&shape.outline) {
            contents[layer].fills.push((index, [low, high]));
        }
        if shape.stroke.is_some() {
            contents[layer].strokes.push(index);
        }
    }
    contents
}

impl Content {
    /// The bounding box of all fills.
    pub(super) fn bounds(&self) -> Option<[DVec2; 2]> {
        let boxes = self.fills.iter().map(|(_, bounds)| *bounds);
        boxes.reduce(|one, other| [one[0].min(other[0]), one[1].max(other[1])])
    }

    pub(super) fn strokes<'a>(&self, drawing: &'a Drawing) -> Vec<&'a StrokeSource> {
        let strokes = self.strokes.iter();
        strokes
            .filter_map(|shape| drawing.shapes[*shape].stroke.as_deref())
            .collect()
    }

    /// The items to be drawn, each with its shape. Pictures that cannot be read are reported and left out.
    ///
    /// # Errors
    /// The layer exceeds a limit.
    pub(super) fn items<'a>(
        &self,
        drawing: &'a Drawing,
        grid: &Grid,
        paints: &mut Paints<'a>,
        diagnostics: &mut Vec<Diagnostic>,
    ) -> Result<Vec<(ShapeId, Item<'a>)>, Box<Diagnostic>> {
        let mut items = Vec::with_capacity(self.fills.len());
        let (mut pixels, mut painted) = (0_usize, 0_u64);
        for (index, bounds) in &self.fills {
            let shape = &drawing.shapes[*index];
            let too_much = |what: String| {
                let help = "remove what is hidden, or use one picture with one pixel per tile";
                Box::new(Diagnostic::new(Code::LimitPassed, shape.element.span, what).help(help))
            };
            let item = match &shape.picture {
                None => {
                    let paint = paints.index(Painted {
                        key: &shape.paint.key,
                        color: shape.paint.color,
                        opacity: shape.opacity,
                        shape: *index,
                    });
                    if paint >= MAX_PAINTS {
                        return Err(too_much(format!(
                            "a tile layer has more than {MAX_PAINTS} paints"
                        )));
                    }
                    Item::area(grid, &shape.outline, *bounds, paint_code(paint))
                }
                Some(source) => match picture(grid, source) {
                    Ok(mut picture) => {
                        pixels +=
                            picture.pixels.width() as usize * picture.pixels.height() as usize;
                        if pixels > MAX_PIXELS {
                            let what = format!(
                                "the pictures of a tile layer have more than {MAX_PIXELS} pixels"
                            );
                            return Err(too_much(what));
                        }
                        picture.opacity = shape.opacity;
                        picture.within = source.is_clipped().then_some(&*shape.outline);
                        Item::picture(grid, *bounds, picture)
                    }
                    Err((code, message)) => {
                        diagnostics
                            .push(Diagnostic::new(code, shape.element.span, message).help(LARGE));
                        continue;
                    }
                },
            };
            let [columns, rows] = item.reach(grid).map(|[from, to]| to - from);
            painted = painted.saturating_add(columns as u64 * rows as u64);
            if painted > MAX_COVERED {
                let what = format!(
                    "the shapes of a tile layer cover more than {MAX_COVERED} cells in total"
                );
                return Err(too_much(what));
            }
            items.push((*index, item));
        }
        Ok(items)
    }
}

fn picture<'a>(grid: &Grid, source: &PictureSource) -> Result<Picture<'a>, (Code, String)> {
    let [least, most, a_tile] = SVG_SIDE;
    let longer = grid.columns.max(grid.rows) as u32;
    let side = longer.saturating_mul(a_tile).clamp(least, most);
    let pixels = source.pixels(side)?;
    let (width, height) = (f64::from(pixels.width()), f64::from(pixels.height()));
    let to_unit = source.place().inverse();
    let to_drawing = glam::DAffine2::from_translation(grid.origin)
        * glam::DAffine2::from_scale(DVec2::splat(grid.size));
    Ok(Picture {
        pixels,
        to_pixels: glam::DAffine2::from_scale(DVec2::new(width, height)) * to_unit * to_drawing,
        opacity: 1.0,
        within: None,
    })
}
