//! The content of a tile layer: filled shapes, pictures and strokes.

use glam::DVec2;
use rustc_hash::FxHashSet;
use typed_index_collections::{TiVec, ti_vec};

use super::colors::Named;
use super::edges::NEAR;
use super::grid::Grid;
use super::materials::{Painted, Paints};
use super::raster::{Item, MAX_PAINTS, Picture, paint_code};
use crate::bind::{Bindings, LayerId, PartKind, StringHolder};
use crate::diagnostic::{Code, Diagnostic};
use crate::geometry::{Outline, Polygon, bounds};
use crate::lang::ast::Annotation;
use crate::svg::{Drawing, LARGE, Paint, PictureSource, ShapeId, StrokeSource};
use crate::terrain::Tile;

/// The largest number of pixels of all pictures of a layer.
const MAX_PIXELS: usize = 1 << 28;
/// The largest number of cells that the bounding boxes of a layer's shapes may cover, summed.
const MAX_COVERED: u64 = 1 << 34;
/// How wide a stroke in the colour of a tile is paint, and not an edge, tiles.
const ROAD: f64 = 0.5;
/// For pictures that are SVG: the smallest and the largest number of pixels along the longer side, and the preferred number a
/// tile, which is odd so that one pixel is in the middle.
const SVG_SIDE: [u32; 3] = [1024, 8192, 3];

/// The content of a tile layer, back-most first.
#[derive(Debug, Default, Clone)]
pub(super) struct Content {
    /// Filled shapes and pictures, each with its bounding box, drawing units.
    pub(super) fills: Vec<(ShapeId, [DVec2; 2])>,
    pub(super) strokes: Vec<ShapeId>,
    /// Strokes that are paint, each with its area and its bounding box.
    pub(super) roads: Vec<(ShapeId, Outline, [DVec2; 2])>,
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
    /// Makes paint of the strokes that are wider than half a tile and have the colour of one: roads and streams.
    pub(super) fn with_roads(mut self, drawing: &Drawing, size: f64, paints: &Paints<'_>) -> Self {
        let mut roads = vec![];
        self.strokes.retain(|index| {
            let Some(stroke) = &drawing.shapes[*index].stroke else {
                return false;
            };
            let Paint { key, color, .. } = &stroke.paint;
            let is_tile = !matches!(
                paints.named(key, *color).0,
                None | Some(Named::Tile(Tile::None))
            );
            if !(is_tile && stroke.width() > size * ROAD) {
                return true;
            }
            for outline in std::iter::once(stroke.outline()).chain(ends(stroke, size)) {
                if let Some((low, high)) = bounds(&outline) {
                    roads.push((*index, outline, [low, high]));
                }
            }
            false
        });
        self.roads = roads;
        self
    }

    /// How many items are painted.
    pub(super) fn painted(&self) -> usize {
        self.fills.len() + self.roads.len()
    }

    /// The bounding box of all that is painted.
    pub(super) fn bounds(&self) -> Option<[DVec2; 2]> {
        let fills = self.fills.iter().map(|(_, bounds)| *bounds);
        let boxes = fills.chain(self.roads.iter().map(|(_, _, bounds)| *bounds));
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
        &'a self,
        drawing: &'a Drawing,
        grid: &Grid,
        paints: &mut Paints<'a>,
        diagnostics: &mut Vec<Diagnostic>,
    ) -> Result<Vec<(ShapeId, Item<'a>)>, Box<Diagnostic>> {
        let mut items = Vec::with_capacity(self.painted());
        let (mut pixels, mut painted) = (0_usize, 0_u64);
        let fills = self
            .fills
            .iter()
            .map(|(index, bounds)| (*index, None, *bounds));
        let roads = self.roads.iter();
        let roads = roads.map(|(index, outline, bounds)| (*index, Some(outline), *bounds));
        let mut all: Vec<_> = fills.chain(roads).collect();
        // A stroke is painted over the fill of its shape.
        all.sort_by_key(|(index, road, _)| (*index, road.is_some()));
        for (index, road, bounds) in &all {
            let shape = &drawing.shapes[*index];
            let too_much = |what: String| {
                let help = "remove what is hidden, or use one picture with one pixel per tile";
                Box::new(Diagnostic::new(Code::LimitPassed, shape.element.span, what).help(help))
            };
            let stroke = road.and(shape.stroke.as_deref());
            let item = match shape.picture.as_ref().filter(|_| road.is_none()) {
                None => {
                    let paint = stroke.map_or(&shape.paint, |stroke| &stroke.paint);
                    let paint = paints.index(Painted {
                        key: &paint.key,
                        color: paint.color,
                        opacity: shape.opacity,
                        shape: *index,
                    });
                    if paint >= MAX_PAINTS {
                        return Err(too_much(format!(
                            "a tile layer has more than {MAX_PAINTS} paints"
                        )));
                    }
                    let outline = road.unwrap_or(&shape.outline);
                    Item::area(grid, outline, *bounds, paint_code(paint))
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

/// Continuations of a stroke beyond its open ends, by as much as an edge may be off: a road that is drawn from the middle of a tile to
/// the middle of another covers both.
fn ends(stroke: &StrokeSource, size: f64) -> Vec<Outline> {
    let mut lines: Vec<Vec<DVec2>> = vec![];
    stroke.middle_line(size * NEAR / 4.0, |from, to| {
        match lines.last_mut().filter(|line| line.last() == Some(&from)) {
            Some(line) => line.push(to),
            None => lines.push(vec![from, to]),
        }
    });
    let open = lines.iter().filter(|line| line.first() != line.last());
    let ends = open.flat_map(|line| {
        [
            [line[1], line[0]],
            [line[line.len() - 2], line[line.len() - 1]],
        ]
    });
    let ends = ends.filter_map(|[before, end]| {
        let way = (end - before).try_normalize()?;
        let [beyond, aside] = [way * size * NEAR, way.perp() * stroke.width() / 2.0];
        // It overlaps the stroke, so that there is no seam.
        let end = end - beyond;
        let beyond = beyond * 2.0;
        let ring = vec![
            end - aside,
            end + aside,
            end + aside + beyond,
            end - aside + beyond,
        ];
        let polygons = vec![Polygon { rings: vec![ring] }];
        Some(Outline { polygons })
    });
    ends.collect()
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
