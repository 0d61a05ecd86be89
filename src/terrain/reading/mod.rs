//! Tile maps read from drawings (terrain.md, Input).
//!
//! Invariant: what a cell is, is what is painted last over its middle; an edge is where a stroke runs along the line
//! between two cells.

mod colours;
mod content;
mod edges;
mod findings;
mod grid;
mod looks;
mod raster;
mod survey;
#[cfg(test)]
mod tests;

use std::ops::Range;

use glam::DVec2;

pub use findings::cells_named;
pub use looks::{TileLook, TileTexture};

use super::land::{Land, ROOF};
use super::map::{MOST_CELLS, Map};
use crate::bind::{Attribute, Bindings};
use crate::diagnostic::{Code, Diagnostic};
use crate::svg::{Drawing, PaintKey};
use content::{Content, contents};
use grid::Grid;
use looks::Paints;
use raster::Canvas;
use survey::{Survey, survey};

/// A tile layer as it was read.
#[derive(Debug)]
pub struct Layer {
    /// Its name.
    pub name: String,
    /// Index of its string.
    pub string: usize,
    /// Index of its group in the drawing.
    pub group: usize,
    /// What is in each cell. Its looks are the kinds of [`looks`](Self::looks).
    pub map: Map,
    /// How high everything lies.
    pub land: Land,
    /// How each look of the map appears; the first is that of cells in which nothing is.
    pub looks: Vec<TileLook>,
    /// The grid's top left corner, drawing units.
    pub origin: DVec2,
    /// The side of a tile, drawing units.
    pub size: f64,
    /// The height of roofs' ridges over their depth.
    pub roof: f64,
    /// The radius of the ground's bevel, tiles.
    pub bevel: f64,
    /// Index of the main part that it hangs on; `None` hangs on the root.
    pub parent: Option<usize>,
    /// The shapes of which tiles are made, hindmost first.
    pub sources: Vec<Tiles>,
}

/// The cells in whose middles a shape may be seen: those in its box.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Tiles {
    /// Index of the shape.
    pub shape: usize,
    /// Columns.
    pub columns: Range<usize>,
    /// Rows.
    pub rows: Range<usize>,
}

impl Layer {
    /// Least and greatest corner of the grid, drawing units.
    pub fn bounds(&self) -> [DVec2; 2] {
        let extent = DVec2::new(self.map.columns as f64, self.map.rows as f64);
        [self.origin, self.origin + extent * self.size]
    }

    /// Index of the foremost shape that may be seen in a cell.
    pub fn source_at(&self, column: usize, row: usize) -> Option<usize> {
        let holds = |tiles: &&Tiles| tiles.columns.contains(&column) && tiles.rows.contains(&row);
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

/// Reads the tile layers of a drawing. Those in which nothing can be built are said and left out.
pub fn read(
    drawing: &Drawing,
    bindings: &Bindings,
    diagnostics: &mut Vec<Diagnostic>,
) -> Vec<Layer> {
    if bindings.tile_layers().next().is_none() {
        return Vec::new();
    }
    let mut used: Vec<bool> = bindings
        .legends
        .iter()
        .map(|legend| legend.is_used)
        .collect();
    let mut layers = Vec::new();
    let mut all_read = true;
    let contents = contents(drawing, bindings);
    for (index, _) in bindings.tile_layers() {
        let reading = Reading {
            drawing,
            bindings,
            index,
        };
        match reading.layer(&contents[index], &mut used, diagnostics) {
            Ok(layer) => layers.push(layer),
            Err(finding) => {
                diagnostics.extend(finding.map(|finding| *finding));
                all_read = false;
            }
        }
    }
    // Legends whose paint only pictures can have are left to this room.
    let mut shapes = 0..drawing.shapes.len();
    if all_read && shapes.any(|shape| bindings.is_picture_of_tiles(drawing, shape)) {
        for (legend, _) in bindings.legends.iter().zip(used).filter(|(_, used)| !used) {
            if matches!(legend.paint, PaintKey::Solid(_)) {
                diagnostics.push(legend.unused(drawing, bindings));
            }
        }
    }
    layers
}

/// A layer that is being read.
struct Reading<'a> {
    drawing: &'a Drawing,
    bindings: &'a Bindings,
    index: usize,
}

impl Reading<'_> {
    /// Reads the layer, and marks the legends that it uses.
    ///
    /// # Errors
    /// Why there is nothing to build; nothing, where that is said already.
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
        } = *self;
        let of_layer = &bindings.layers[index];
        let attributes = bindings.layer_attributes(index);
        let Some(Attribute { value: size, .. }) = attributes.tile_size() else {
            return Err(None);
        };
        let nothing = |holds| {
            Err(Some(Box::new(findings::empty(
                drawing, bindings, index, holds,
            ))))
        };
        let Some(bounds) = content.bounds() else {
            return nothing(false);
        };
        let grid = Grid::over(bounds, size, MOST_CELLS)
            .map_err(|count| Some(Box::new(findings::too_large(bindings, index, size, count))))?;
        if grid.columns == 0 || grid.rows == 0 {
            return nothing(true);
        }
        let mut paints = Paints::new(bindings, index);
        let items = content.items(drawing, &grid, &mut paints, diagnostics)?;
        let sources = items.iter().map(|(shape, item)| {
            let [columns, rows] = item.reach(&grid).map(|[from, to]| from..to);
            Tiles {
                shape: *shape,
                columns,
                rows,
            }
        });
        let sources: Vec<Tiles> = sources.collect();
        let items: Vec<_> = items.into_iter().map(|(_, item)| item).collect();
        let is_complete = items.len() == content.fills.len();
        let canvas = Canvas::new(grid, items);
        let Survey {
            cells,
            looks,
            unclear,
            legends,
            plain,
            too_many_legends,
        } = survey(&canvas, &paints, vec![0; grid.columns * grid.rows]);
        // Pictures take much memory, which edges may need.
        drop(canvas);
        let is_empty = looks.len() == 1 && unclear.is_empty();
        let mut edges = vec![0; cells.len()];
        edges::read(&grid, &content.strokes(drawing), &mut edges);
        legends.iter().for_each(|legend| used[*legend] = true);
        let map = Map {
            columns: grid.columns,
            rows: grid.rows,
            cells,
            looks: looks.iter().map(|look| look.tile).collect(),
            edges,
        };
        let layer = Layer {
            name: of_layer.name.clone(),
            string: of_layer.string,
            group: of_layer.group,
            land: Land::new(&map),
            map,
            looks,
            origin: grid.origin,
            size: grid.size,
            roof: attributes.roof().unwrap_or(ROOF),
            bevel: attributes.bevel(),
            parent: of_layer.parent,
            sources,
        };
        findings::unclear(drawing, &layer, &paints, &unclear, diagnostics);
        diagnostics.extend(findings::plain(drawing, &paints, &plain));
        diagnostics.extend(findings::off_grid(drawing, bindings, index, &grid, content));
        if too_many_legends {
            let message =
                "so many paints are used that not every legend's attributes can be heeded";
            let span = findings::size_span(bindings, index);
            let help = "use fewer paints, or fewer legends";
            diagnostics.push(Diagnostic::new(Code::LimitPassed, span, message).help(help));
        }
        if is_empty && is_complete {
            return nothing(true);
        }
        findings::open(drawing, &layer, diagnostics);
        Ok(layer)
    }
}
