//! The map in column-major order, because heights are read from columns.

use rayon::prelude::*;

use super::map::{CellPictures, EDGE_BELOW, EDGE_RIGHT, Map, Tile};

/// Side of the blocks in which a map is transposed, cells: a block and its transpose fit into the L1 cache.
const SQUARE: usize = 64;

/// A map in column-major order, so that a column is one slice.
#[derive(Debug)]
pub(super) struct Grid {
    pub(super) columns: usize,
    pub(super) rows: usize,
    /// Per cell the index of its material.
    pub(super) cells: Vec<u8>,
    /// Per cell [`EDGE_RIGHT`] and [`EDGE_BELOW`].
    pub(super) edges: Vec<u8>,
    /// Per material the kind of tile.
    tiles: [Tile; 256],
    /// The pictures of tops, column by column.
    pub(super) pictures: Option<CellPictures>,
}

impl Grid {
    pub(super) fn new(map: &Map) -> Self {
        let mut tiles = [Tile::None; 256];
        for (slot, tile) in tiles.iter_mut().zip(&map.tiles) {
            *slot = *tile;
        }
        Self {
            columns: map.columns,
            rows: map.rows,
            cells: transposed(&map.cells, map.columns, map.rows),
            edges: transposed(&map.edges, map.columns, map.rows),
            tiles,
            pictures: map.pictures.as_ref().map(|pictures| CellPictures {
                places: transposed(&pictures.places, map.columns, map.rows),
                ..*pictures
            }),
        }
    }

    /// The kind of tile of a material.
    pub(super) fn tile_of(&self, material: u8) -> Tile {
        self.tiles[usize::from(material)]
    }

    /// The kind of tile in a cell.
    pub(super) fn tile(&self, cell: usize) -> Tile {
        self.tile_of(self.cells[cell])
    }

    /// The material of the top of a plain map's cell.
    pub(super) fn top(&self, cell: usize) -> u8 {
        match &self.pictures {
            Some(pictures) if pictures.places[cell] != 0 => pictures.material,
            _ => self.cells[cell],
        }
    }

    /// Whether there is an edge between a cell and the one below it.
    pub(super) fn edge_below(&self, cell: usize) -> bool {
        self.edges[cell] & EDGE_BELOW != 0
    }

    /// Whether there is an edge between a cell and the one to its right.
    pub(super) fn edge_right(&self, cell: usize) -> bool {
        self.edges[cell] & EDGE_RIGHT != 0
    }

    /// Column and row of a cell.
    pub(super) fn place(&self, cell: usize) -> [usize; 2] {
        [cell / self.rows, cell % self.rows]
    }
}

/// Transposes a table from row-major to column-major order.
pub(super) fn transposed<T: Copy + Default + Send + Sync>(
    table: &[T],
    columns: usize,
    rows: usize,
) -> Vec<T> {
    let mut out = vec![T::default(); table.len()];
    if table.is_empty() {
        return out;
    }
    out.par_chunks_mut(rows * SQUARE)
        .enumerate()
        .for_each(|(band, out)| {
            let left = band * SQUARE;
            for top in (0..rows).step_by(SQUARE) {
                for row in top..(top + SQUARE).min(rows) {
                    let line =
                        &table[row * columns + left..row * columns + columns.min(left + SQUARE)];
                    for (column, material) in line.iter().enumerate() {
                        out[column * rows + row] = *material;
                    }
                }
            }
        });
    out
}
