//! Houses: a block under a roof.

use std::ops::Range;

use rayon::prelude::*;
use rustc_hash::FxHashMap;

use super::column::{Below, Column};
use super::constraints::STRIPE;
use super::grid::Grid;
use super::groups::{GroupKind, Groups};
use super::levels::Levels;
use super::solids::Block;

/// A house, in tiles.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct House {
    pub(super) walls: Range<i32>,
    pub(super) roof: Range<i32>,
    /// Height of its floor.
    pub(super) base: i32,
    /// Height of its walls.
    pub(super) height: i32,
    /// Its extent from front to back.
    pub(super) depth: i32,
    /// The z of its front.
    pub(super) front: i32,
    /// The material of its roof, and that of its walls.
    pub(super) materials: [u8; 2],
    /// The ground under it where its foot is hidden everywhere.
    pub(super) under: Option<Block>,
    /// Whether its foot is visible somewhere: no other house hides it.
    stands: bool,
}

impl House {
    pub(super) fn eaves(&self) -> i32 {
        self.base + self.height
    }

    /// The columns of its walls and its roof.
    pub(super) fn columns(&self) -> Range<i32> {
        let mut columns = self.walls.clone();
        widen(&mut columns, &self.roof);
        columns
    }

    /// The z of its back.
    pub(super) fn back(&self) -> i32 {
        self.front - self.depth
    }

    fn join(&mut self, other: &Self) {
        // Where most of the wall is visible, nothing hides its foot; of such columns the highest counts.
        let foot = |house: &Self| {
            let walled = !house.walls.is_empty();
            (walled, house.stands, house.height, house.base, house.front)
        };
        if foot(self) < foot(other) {
            (self.base, self.front) = (other.base, other.front);
            self.stands = other.stands;
            self.materials[1] = other.materials[1];
        }
        if self.roof.is_empty() {
            self.materials[0] = other.materials[0];
        }
        widen(&mut self.walls, &other.walls);
        widen(&mut self.roof, &other.roof);
        self.height = self.height.max(other.height);
        self.depth = self.depth.max(other.depth);
    }
}

/// Extends a range to cover another one, which may be empty.
fn widen(range: &mut Range<i32>, other: &Range<i32>) {
    if range.start >= range.end {
        *range = other.clone();
    } else if !other.is_empty() {
        *range = range.start.min(other.start)..range.end.max(other.end);
    }
}

pub(super) fn measure(grid: &Grid, groups: &Groups, levels: &Levels) -> Vec<House> {
    if groups.houses == 0 {
        return vec![];
    }
    let found = (0..grid.columns.div_ceil(STRIPE))
        .into_par_iter()
        .map(|stripe| {
            let mut found = Vec::new();
            let mut column = Column::default();
            for index in stripe * STRIPE..((stripe + 1) * STRIPE).min(grid.columns) {
                column.read(grid, groups, index);
                in_column(grid, levels, &column, index, &mut found);
            }
            found
        })
        .collect::<Vec<_>>();
    let mut houses: FxHashMap<u32, House> = FxHashMap::default();
    for (number, part) in found.into_iter().flatten() {
        let known = houses.entry(number);
        known.and_modify(|known| known.join(&part)).or_insert(part);
    }
    let all = 0..groups.houses as u32;
    // Each house has at least one column, that of a roof over a wall.
    all.filter_map(|number| houses.remove(&number)).collect()
}

/// Per stripe of columns the houses that extend into it.
pub(super) fn by_stripe(houses: &[House], columns: usize) -> Vec<Vec<u32>> {
    let mut stripes = vec![vec![]; columns.div_ceil(STRIPE)];
    for (index, house) in houses.iter().enumerate() {
        let columns = house.columns();
        let reached = columns.start as usize / STRIPE..(columns.end as usize).div_ceil(STRIPE);
        stripes[reached]
            .iter_mut()
            .for_each(|houses| houses.push(index as u32));
    }
    stripes
}

/// Adds the parts of houses that a column shows.
fn in_column(
    grid: &Grid,
    levels: &Levels,
    column: &Column,
    number: usize,
    found: &mut Vec<(u32, House)>,
) {
    let here = number as i32..number as i32 + 1;
    for (index, segment) in column.segments.iter().enumerate() {
        let Some(house) = segment.kind.house() else {
            continue;
        };
        let is_roof = matches!(segment.kind, GroupKind::Roof(_));
        let foot = if is_roof { None } else { column.foot(index) };
        let base = foot.map_or(0, |(surface, fronts)| {
            levels.level[surface as usize] + fronts
        });
        let material = grid.cells[number * grid.rows + segment.start as usize];
        let ([walls, roof], [height, depth]) = if is_roof {
            ([0..0, here.clone()], [0, segment.rows()])
        } else {
            ([here.clone(), 0..0], [segment.rows(), 0])
        };
        let part = House {
            walls,
            roof,
            base,
            height,
            depth,
            front: segment.end + base,
            materials: [material; 2],
            under: None,
            stands: !is_roof && !matches!(column.below(index).1, Below::House(_)),
        };
        found.push((house, part));
    }
}
