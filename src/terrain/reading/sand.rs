//! Sand, the colour of beaches and of walls: it is ground, except where a roof lies over it.

use super::super::map::{EDGE_BELOW, EDGE_RIGHT, Tile};
use super::materials::TileMaterial;
use crate::regions::connected;

/// The largest number of materials, which have an index of a byte.
const MAX_MATERIALS: usize = 256;

/// Makes walls of sand that lies below a roof: of a whole patch if at least half of its columns do, of those columns otherwise, for
/// example where the house stands on a beach. `cells` and `edges` are row by row; walls get materials of their own.
pub(super) fn walls(
    cells: &mut [u8],
    edges: &[u8],
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
    let below = |cell: usize| {
        cells[cell] == cells[cell - columns] && edges[cell - columns] & EDGE_BELOW == 0
    };
    let right = |cell: usize| cells[cell] == cells[cell - 1] && edges[cell - 1] & EDGE_RIGHT == 0;
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
