//! Sand, the colour of beaches and of walls: it is ground, except where a roof lies over it.

use super::super::map::{EDGE_BELOW, EDGE_RIGHT, Tile};
use super::TileSource;
use super::materials::TileMaterial;
use crate::regions::connected;

/// The largest number of materials, which have an index of a byte.
pub(super) const MAX_MATERIALS: usize = 256;

/// The largest number of cells that the shapes of a map may cover for each cell, so that it is found out which shape is in front.
const MAX_DEPTH: usize = 64;

/// Makes walls of sand that lies below a roof: of a whole patch if at least half of its columns do, of those columns otherwise, for
/// example where the house stands on a beach. Patches end where shapes do, such as a road at a house. `cells` and `edges` are row by
/// row; walls get materials of their own.
pub(super) fn walls(
    cells: &mut [u8],
    edges: &[u8],
    sources: &[TileSource],
    columns: usize,
    materials: &mut Vec<TileMaterial>,
) {
    let of = |tile: Tile| materials.iter().any(|material| material.tile == tile);
    if !of(Tile::Red) || !materials.iter().any(|material| material.is_sand) {
        return;
    }
    let is_sand: Vec<bool> = materials.iter().map(|material| material.is_sand).collect();
    let is_roof: Vec<bool> = materials
        .iter()
        .map(|material| material.tile == Tile::Red)
        .collect();
    let sand = |cell: usize| is_sand[usize::from(cells[cell])];
    let fronts = fronts(cells.len(), columns, sources);
    // Walls may be drawn tile by tile, or row by row.
    let joined = |one: usize, other: usize| {
        let [one, other] =
            [one, other].map(|cell| fronts.get(cell).and_then(|at| sources.get(*at as usize)));
        let is_tile = |of: &TileSource| of.columns.len() <= 1 && of.rows.len() <= 1;
        match (one, other) {
            (Some(one), Some(other)) => {
                one.shape == other.shape
                    || one.columns == other.columns
                    || (is_tile(one) && is_tile(other))
            }
            _ => true,
        }
    };
    let below = |cell: usize| {
        let above = cell - columns;
        cells[cell] == cells[above] && edges[above] & EDGE_BELOW == 0 && joined(cell, above)
    };
    let right = |cell: usize| {
        let left = cell - 1;
        cells[cell] == cells[left] && edges[left] & EDGE_RIGHT == 0 && joined(cell, left)
    };
    let patches = connected(cells.len(), columns, 1, sand, right, below);
    let roofed = |cell: usize| cell >= columns && is_roof[usize::from(cells[cell - columns])];
    // Per patch its columns, and those that begin below a roof; each with the column that was counted last.
    let mut counts = vec![[(0_usize, usize::MAX); 2]; patches.firsts.len() + 1];
    let rows = cells.len() / columns;
    for column in 0..columns {
        for cell in (0..rows).map(|row| row * columns + column) {
            let patch = patches.of[cell] as usize;
            if patch == 0 {
                continue;
            }
            for (count, last) in counts[patch].iter_mut().take(1 + usize::from(roofed(cell))) {
                if *last != column {
                    (*count, *last) = (*count + 1, column);
                }
            }
        }
    }
    let mut wall = vec![false; cells.len()];
    for cell in 0..cells.len() {
        let patch = patches.of[cell] as usize;
        let [(all, _), (under, _)] = counts[patch];
        let continues = cell >= columns && wall[cell - columns] && below(cell);
        wall[cell] = patch != 0 && under > 0 && (under * 2 >= all || roofed(cell) || continues);
    }
    let mut is_ground = [false; MAX_MATERIALS];
    for (cell, _) in cells.iter().zip(&wall).filter(|(_, wall)| !**wall) {
        is_ground[usize::from(*cell)] = true;
    }
    let mut walls: Vec<Option<u8>> = vec![None; materials.len()];
    for (cell, _) in cells.iter_mut().zip(wall).filter(|(_, wall)| *wall) {
        let sand = usize::from(*cell);
        if walls[sand].is_none() && !is_ground[sand] {
            walls[sand] = Some(*cell);
        } else if walls[sand].is_none() && materials.len() < MAX_MATERIALS {
            walls[sand] = Some(materials.len() as u8);
            materials.push(materials[sand].clone());
        }
        *cell = walls[sand].unwrap_or(*cell);
    }
    for wall in walls.into_iter().flatten() {
        let material = &mut materials[usize::from(wall)];
        (material.tile, material.is_sand) = (Tile::Beige, false);
    }
}

/// Per cell the index of the front-most shape whose bounding box it is in; nothing if there are too many shapes on each other.
fn fronts(count: usize, columns: usize, sources: &[TileSource]) -> Vec<u32> {
    let covered = sources
        .iter()
        .map(|source| source.columns.len() * source.rows.len());
    if covered.sum::<usize>() > count.saturating_mul(MAX_DEPTH) {
        return vec![];
    }
    let mut fronts = vec![u32::MAX; count];
    for (index, source) in (0..).zip(sources) {
        for row in source.rows.clone() {
            fronts[row * columns..][source.columns.clone()].fill(index);
        }
    }
    fronts
}
