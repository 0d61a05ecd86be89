//! The heights of plain maps, which legends, groups and the layer's own string give with `Height`.

use super::colors::Named;
use super::materials::{Paints, TileMaterial};
use super::raster::Canvas;
use super::sand::MAX_MATERIALS;
use crate::regions::connected;
use crate::terrain::{Tile, UNSET};

/// Per cell, row by row, its height, or [`UNSET`]; empty if nothing gives one, so that the map has the drawn look. A legend counts before
/// a group, and that before the layer.
pub(super) fn read(
    canvas: &Canvas<'_>,
    paints: &Paints<'_>,
    cells: &[u8],
    materials: &[TileMaterial],
) -> Vec<i8> {
    let of_layer = paints.height_of_layer();
    let legends = materials.iter();
    let legends: Vec<Option<i8>> = legends
        .map(|material| paints.height_of_legend(material.legend))
        .collect();
    let grouped = canvas.has_heights();
    if of_layer.is_none() && !grouped && legends.iter().all(Option::is_none) {
        return vec![];
    }
    let mut heights = if grouped {
        canvas.heights(cells.len())
    } else {
        vec![UNSET; cells.len()]
    };
    for (height, material) in heights.iter_mut().zip(cells) {
        let material = usize::from(*material);
        *height = match legends[material] {
            _ if material == 0 => UNSET,
            Some(of_legend) => of_legend,
            None if *height == UNSET => of_layer.unwrap_or(UNSET),
            None => *height,
        };
    }
    let is_loose = |cell: usize| {
        let material = usize::from(cells[cell]);
        materials[material].tile == Tile::Blue && legends[material].is_none()
    };
    let is_ground = |cell: usize| {
        !matches!(
            materials[usize::from(cells[cell])].tile,
            Tile::None | Tile::Blue
        )
    };
    sink(&mut heights, canvas.columns(), is_loose, is_ground);
    heights
}

/// Lowers water by a tile that no legend gives its height, and that would lie level with ground beside it: a pond in a group of ground.
pub(super) fn sink(
    heights: &mut [i8],
    columns: usize,
    is_loose: impl Fn(usize) -> bool + Sync,
    is_ground: impl Fn(usize) -> bool,
) {
    let is_given = |cell: usize| is_loose(cell) && heights[cell] != UNSET;
    if !(0..heights.len()).any(is_given) {
        return;
    }
    let same = |one: usize, other: usize| {
        is_loose(one) == is_loose(other) && heights[one] == heights[other]
    };
    let bodies = connected(
        heights.len(),
        columns,
        1,
        is_given,
        |cell| same(cell - 1, cell),
        |cell| same(cell - columns, cell),
    );
    let mut is_flush = vec![false; bodies.firsts.len() + 1];
    let height = |cell: usize| match heights[cell] {
        UNSET => 0,
        height => height,
    };
    let mut meet = |one: usize, other: usize| {
        for [water, ground] in [[one, other], [other, one]] {
            let body = bodies.of[water] as usize;
            is_flush[body] |= body != 0 && is_ground(ground) && height(ground) == height(water);
        }
    };
    for cell in 0..heights.len() {
        if (cell + 1) % columns != 0 {
            meet(cell, cell + 1);
        }
        if cell + columns < heights.len() {
            meet(cell, cell + columns);
        }
    }
    for (height, body) in heights.iter_mut().zip(&bodies.of) {
        *height -= i8::from(is_flush[*body as usize]);
    }
}

/// Adds the material of earth for the walls below ground, if the map has ground and nothing brown.
pub(super) fn add_earth(paints: &Paints<'_>, materials: &mut Vec<TileMaterial>) {
    let has = |tile: Tile| materials.iter().any(|material| material.tile == tile);
    if has(Tile::Green) && !has(Tile::Brown) && materials.len() < MAX_MATERIALS {
        let color = Tile::Brown.color();
        let earth = Named::Tile(Tile::Brown);
        materials.push(paints.material(earth, None, color.map(f64::from), 1.0));
    }
}
