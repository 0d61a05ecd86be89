//! Tile maps read from drawings.
//!
//! Invariant: the kind of a cell is that of the front-most paint at its middle, and of a picture's commonest paint within it; two cells
//! have an edge between them if a stroke runs along their common side. What is drawn and is neither is reported.

mod classify;
mod colors;
mod content;
mod diagnostics;
mod edges;
mod fit;
mod grid;
mod heights;
mod materials;
#[cfg(test)]
mod palettes;
mod raster;
mod sand;
#[cfg(test)]
mod tests;
mod tiled;

use std::ops::Range;
use std::sync::Arc;

use glam::DVec2;
use typed_index_collections::{TiSlice, TiVec};

pub(crate) use materials::{TileMaterial, TileTexture};

use super::landscape::{DEFAULT_ROOF, Landscape};
use super::map::{MAX_CELLS, Map};
use crate::bind::{Attribute, Bindings, LayerId, PartId, StringId};
use crate::diagnostic::{Code, Diagnostic};
use crate::geometry::Outline;
use crate::index::index_type;
use crate::memo::Memo;
use crate::resolver::Resolver;
use crate::svg::{Drawing, GroupId, PaintKey, ShapeId};
use classify::{Classification, classify};
use content::{Content, contents};
use grid::Grid;
use materials::Paints;
use raster::Canvas;
use tiled::Files;

index_type!(
    /// A landscape of a drawing: one of the tile layers that have tiles.
    pub LandscapeId
);

/// A tile layer and its landscape.
#[derive(Debug)]
pub struct Layer {
    /// Its index among all layers of the drawing.
    pub index: LayerId,
    /// Its name.
    pub name: String,
    /// Index of its string.
    pub string: StringId,
    /// Its group in the drawing.
    pub group: GroupId,
    /// The cells. Their indices of materials are those of [`materials`](Self::materials).
    pub map: Map,
    /// The heights.
    pub landscape: Landscape,
    /// The materials of the tiles; the first is that of empty cells.
    pub materials: Vec<TileMaterial>,
    /// The grid's top left corner, drawing units.
    pub origin: DVec2,
    /// The side of a tile, drawing units.
    pub size: f64,
    /// The ratio of a roof's height to its depth.
    pub roof: f64,
    /// The radius of the ground's bevel, tiles.
    pub bevel: f64,
    /// The main part that it hangs on; `None` hangs on the root.
    pub parent: Option<PartId>,
    /// The shapes that tiles are made from, back-most first.
    pub sources: Vec<TileSource>,
    /// What stands on a map of Tiled.
    pub(crate) objects: Vec<LayerObject>,
}

/// A picture that stands on a map of Tiled.
#[derive(Debug, Clone)]
pub(crate) struct LayerObject {
    /// Its name; empty if it has none.
    pub(crate) name: String,
    /// The middle of its lower edge, drawing units.
    pub(crate) foot: DVec2,
    /// Width and height, drawing units.
    pub(crate) size: DVec2,
    /// What of the picture is seen, in the unit square, y down.
    pub(crate) outline: Arc<Outline>,
    /// Its material among those of the layer.
    pub(crate) material: u8,
}

/// The cells that a shape may be visible in: those whose middles are in its bounding box.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct TileSource {
    /// The shape.
    pub shape: ShapeId,
    /// Columns.
    pub columns: Range<usize>,
    /// Rows.
    pub rows: Range<usize>,
}

impl TileSource {
    /// Adds the cells of another piece of the shape.
    fn extend(&mut self, columns: Range<usize>, rows: Range<usize>) {
        let wider = |one: &Range<usize>, other: Range<usize>| match one.is_empty() {
            true => other,
            false if other.is_empty() => one.clone(),
            false => one.start.min(other.start)..one.end.max(other.end),
        };
        self.columns = wider(&self.columns, columns);
        self.rows = wider(&self.rows, rows);
    }
}

impl Layer {
    /// The bounds of the grid, drawing units.
    pub fn bounds(&self) -> [DVec2; 2] {
        let extent = DVec2::new(self.map.columns as f64, self.map.rows as f64);
        [self.origin, self.origin + extent * self.size]
    }

    /// The front-most shape that may be visible in a cell.
    pub fn source_at(&self, column: usize, row: usize) -> Option<ShapeId> {
        let holds =
            |tiles: &&TileSource| tiles.columns.contains(&column) && tiles.rows.contains(&row);
        self.sources
            .iter()
            .rev()
            .find(holds)
            .map(|tiles| tiles.shape)
    }

    /// The index of the cell at a point of the drawing.
    pub fn cell_at(&self, point: DVec2) -> Option<usize> {
        let at = ((point - self.origin) / self.size).floor();
        let extent = DVec2::new(self.map.columns as f64, self.map.rows as f64);
        let inside = at.cmpge(DVec2::ZERO).all() && at.cmplt(extent).all();
        inside.then(|| self.map.index(at.x as usize, at.y as usize))
    }
}

/// Reads the tile layers of a drawing. Those without tiles are reported and left out.
pub(crate) fn read(
    drawing: &Drawing,
    bindings: &Bindings,
    resolver: &dyn Resolver,
    memo: &Memo,
    diagnostics: &mut Vec<Diagnostic>,
) -> TiVec<LandscapeId, Layer> {
    if bindings.tile_layers().next().is_none() {
        return TiVec::new();
    }
    let mut used: Vec<bool> = bindings
        .legends
        .iter()
        .map(|legend| legend.is_used)
        .collect();
    let mut layers = TiVec::new();
    let mut all_read = true;
    let contents = contents(drawing, bindings);
    let levels = &bindings.levels_of_groups(drawing);
    for (index, _) in bindings.tile_layers() {
        let reading = Reading {
            drawing,
            bindings,
            index,
            levels,
            files: Files { resolver, memo },
        };
        match reading.layer(&contents[index], &mut used, diagnostics) {
            Ok(layer) => layers.push(layer),
            Err(finding) => {
                diagnostics.extend(finding.map(|finding| *finding));
                all_read = false;
            }
        }
    }
    // Only the pixels of tile layers can use the legends that `bind` left.
    let mut shapes = drawing.shapes.keys();
    if all_read && shapes.any(|shape| bindings.is_picture_of_layer(drawing, shape)) {
        for (legend, _) in bindings.legends.iter().zip(used).filter(|(_, used)| !used) {
            if matches!(legend.paint, PaintKey::Solid(_)) {
                diagnostics.push(legend.unused(drawing, &bindings.strings));
            }
        }
    }
    layers
}

/// A layer that is being read.
struct Reading<'a> {
    drawing: &'a Drawing,
    bindings: &'a Bindings,
    index: LayerId,
    /// Per group the height that it gives its tiles; empty if none does.
    levels: &'a TiSlice<GroupId, Option<i8>>,
    files: Files<'a>,
}

impl Reading<'_> {
    /// Reads the layer, and marks the legends that it uses.
    ///
    /// # Errors
    /// The diagnostic if there is nothing to build; `None` if one was made already.
    fn layer(
        &self,
        content: &Content,
        used: &mut [bool],
        diagnostics: &mut Vec<Diagnostic>,
    ) -> Result<Layer, Option<Box<Diagnostic>>> {
        let Self {
            drawing,
            bindings,
            index,
            ..
        } = *self;
        let of_layer = &bindings.layers[index];
        let attributes = bindings.layer_attributes(index);
        if let Some(file) = attributes.tile_file() {
            return self.tiled(&file, content, diagnostics);
        }
        let Some(Attribute { value: size, .. }) = attributes.tile_size() else {
            return Err(None);
        };
        let nothing = |holds| {
            Err(Some(Box::new(diagnostics::empty(
                drawing, bindings, index, holds,
            ))))
        };
        let mut paints = Paints::new(bindings, index);
        let content = &content.clone().with_roads(drawing, size, &paints);
        let Some(bounds) = content.bounds() else {
            return nothing(false);
        };
        let grid = Grid::over(bounds, size, MAX_CELLS).map_err(|count| {
            Some(Box::new(diagnostics::too_large(
                bindings, index, size, count,
            )))
        })?;
        if grid.columns == 0 || grid.rows == 0 {
            return nothing(true);
        }
        let mut items = content.items(drawing, &grid, &mut paints, diagnostics)?;
        for (shape, item) in &mut items {
            let level = self.levels.get(drawing.shapes[*shape].group);
            item.height = level.copied().flatten();
        }
        let mut sources: Vec<TileSource> = Vec::with_capacity(items.len());
        for (shape, item) in &items {
            let [columns, rows] = item.reach(&grid).map(|[from, to]| from..to);
            match sources.last_mut().filter(|last| last.shape == *shape) {
                Some(last) => last.extend(columns, rows),
                None => sources.push(TileSource {
                    shape: *shape,
                    columns,
                    rows,
                }),
            }
        }
        let items: Vec<_> = items.into_iter().map(|(_, item)| item).collect();
        let is_complete = items.len() == content.painted();
        let canvas = Canvas::new(grid, items, &paints);
        let Classification {
            mut cells,
            mut materials,
            unclear,
            legends,
            plain,
            too_many_legends,
        } = classify(&canvas, &paints, vec![0; grid.columns * grid.rows]);
        let heights = heights::read(&canvas, &paints, &cells, &materials);
        // Free the memory of pictures before edges are read.
        drop(canvas);
        let is_empty = materials.len() == 1 && unclear.is_empty();
        let mut edges = vec![0; cells.len()];
        let mut strays = vec![];
        if heights.is_empty() {
            let strokes = content.strokes(drawing);
            edges::read(&grid, &strokes, &mut edges);
            strays = edges::strays(&grid, &strokes, &cells);
            sand::walls(&mut cells, &edges, &sources, grid.columns, &mut materials);
        } else {
            heights::add_earth(&paints, &mut materials);
        }
        legends.iter().for_each(|legend| used[*legend] = true);
        let map = Map {
            columns: grid.columns,
            rows: grid.rows,
            cells,
            tiles: materials.iter().map(|material| material.tile).collect(),
            edges,
            heights,
            pictures: None,
        };
        let layer = Layer {
            index,
            name: of_layer.name.clone(),
            string: of_layer.string,
            group: of_layer.group,
            landscape: Landscape::new(&map),
            map,
            materials,
            origin: grid.origin,
            size: grid.size,
            roof: attributes.roof().unwrap_or(DEFAULT_ROOF),
            bevel: attributes.bevel(),
            parent: bindings.parent_of_layer(index),
            sources,
            objects: vec![],
        };
        diagnostics::unclear(drawing, &layer, &paints, &unclear, diagnostics);
        diagnostics.extend(diagnostics::plain(drawing, &paints, &plain));
        diagnostics.extend(diagnostics::off_grid(
            drawing, bindings, index, &grid, content,
        ));
        diagnostics.extend(diagnostics::stray(drawing, &layer, content, &strays));
        diagnostics.extend(diagnostics::idle(drawing, &layer, &grid, content));
        if too_many_legends {
            let message =
                "so many paints are used that not every legend's attributes can be heeded";
            let span = diagnostics::size_span(bindings, index);
            let help = "use fewer paints, or fewer legends";
            diagnostics.push(Diagnostic::new(Code::LimitPassed, span, message).help(help));
        }
        if is_empty && is_complete {
            return nothing(true);
        }
        diagnostics::open(drawing, &layer, diagnostics);
        Ok(layer)
    }
}
