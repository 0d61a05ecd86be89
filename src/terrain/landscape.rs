//! The landscape of a map: heights and houses, from which its surface is built.

use rustc_hash::FxHashSet;

use super::ambiguities::{self, Ambiguity};
use super::backs;
use super::constraints::Constraints;
use super::flush;
use super::grid::Grid;
use super::groups::{GroupKind, Groups};
use super::hidden_houses;
use super::houses;
use super::levels::Levels;
use super::map::{Map, Tile};
use super::occlusion::Visible;
use super::plain;
use super::solids::{MapContext, Solids};
use super::surface;
use crate::scene::Surface;

/// The default ratio of a roof's height to its depth (equation 3.1).
pub const DEFAULT_ROOF: f64 = std::f64::consts::FRAC_1_SQRT_2;

/// A landscape, in tiles.
#[derive(Debug)]
pub struct Landscape {
    context: MapContext,
    constraints: Constraints,
}

/// A group of ground or a body of water.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Group {
    /// Whether it is water.
    pub water: bool,
    /// Its height.
    pub height: i32,
    /// The number of its cells.
    pub cells: usize,
    /// Column and row of its first cell.
    pub first: [usize; 2],
}

/// A house.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HouseInfo {
    /// Height of its floor.
    pub base: i32,
    /// The number of columns of its walls.
    pub width: i32,
    /// Its extent from front to back.
    pub depth: i32,
    /// Height of its walls.
    pub height: i32,
}

impl HouseInfo {
    /// Height of its ridge; `roof` is the ratio of a roof's height to its depth.
    pub fn ridge(&self, roof: f64) -> f64 {
        f64::from(self.base + self.height) + roof * f64::from(self.depth)
    }
}

impl Landscape {
    /// Computes the height of everything on a map, in time linear in its cells. Never fails: ambiguities are decided by the
    /// rules (see [`ambiguities`](Self::ambiguities)). Of a plain map the heights are given; only those of water may follow from
    /// its banks.
    pub fn new(map: &Map) -> Self {
        if map.is_plain() {
            let (context, constraints) = plain::measured(map);
            return Self {
                context,
                constraints,
            };
        }
        let mut refused: FxHashSet<usize> = FxHashSet::default();
        let beige = commonest(map, Tile::Beige);
        let mut tries = 0;
        let (mut context, constraints) = loop {
            let is_plain = |first: usize| tries == 2 || refused.contains(&first);
            let (mut context, constraints) = measured(map, is_plain);
            // A roof that cannot be a hidden house is ground of its colour, which may change the heights of others.
            let found = hidden_houses::measure(&mut context, beige);
            if found.is_empty() {
                break (context, constraints);
            }
            refused.extend(found);
            tries += 1;
        };
        context.backs = backs::backs(&context);
        Self {
            context,
            constraints,
        }
    }

    /// The landscape without the hidden ground of rule 10, to compare them.
    #[must_use]
    pub fn without_backs(mut self) -> Self {
        self.context.backs.clear();
        self
    }

    /// The height of the top that is drawn in a cell: ground or water; `None` where there is none.
    pub fn top(&self, column: usize, row: usize) -> Option<i32> {
        match self.kind_at(column, row) {
            GroupKind::Surface(surface) => Some(self.context.levels.level[surface as usize]),
            _ => None,
        }
    }

    /// The height of the visible point at the lower edge of each cell of a column: of the top or the eaves, or of the place on
    /// a front. `None` where nothing is drawn.
    pub fn visible_heights(&self, column: usize) -> Vec<Option<i32>> {
        if self.is_plain() {
            let rows = 0..self.context.grid.rows;
            return rows.map(|row| self.top(column, row)).collect();
        }
        let mut solids = Solids::default();
        solids.read_views(&self.context, column);
        let heights = solids.views.iter().flat_map(|view| {
            let rows = view.start..view.end;
            rows.map(|row| match view.visible {
                Visible::Nothing => None,
                Visible::Top(level) | Visible::Roof(level) => Some(level),
                Visible::Front(plane) => Some(plane - row - 1),
            })
        });
        heights.collect()
    }

    /// Whether it is that of a plain map, which shows no fronts.
    pub fn is_plain(&self) -> bool {
        self.context.plain.is_some()
    }

    pub(super) fn context(&self) -> &MapContext {
        &self.context
    }

    fn kind_at(&self, column: usize, row: usize) -> GroupKind {
        let context = &self.context;
        context.groups.kind(column * context.grid.rows + row)
    }

    /// The number of columns of the map.
    pub fn columns(&self) -> usize {
        self.context.grid.columns
    }

    /// The solid blocks of a column in no order, each as `[back, front]` and `[bottom, top]`. They may overlap, plates have no
    /// height here, and roofs are not among them.
    pub fn blocks(&self, column: usize) -> Vec<[[i32; 2]; 2]> {
        let mut solids = Solids::default();
        solids.build(&self.context, column);
        let blocks = solids.blocks.iter();
        blocks.map(|block| [block.z, block.y]).collect()
    }

    /// The places of the map that can be read in more than one way.
    pub fn ambiguities(&self) -> Vec<Ambiguity> {
        if self.is_plain() {
            return vec![];
        }
        ambiguities::ambiguities(&self.context, &self.constraints)
    }

    /// The group that a cell's top belongs to: its index among [`groups`](Self::groups).
    pub fn group_at(&self, column: usize, row: usize) -> Option<usize> {
        match self.kind_at(column, row) {
            GroupKind::Surface(surface) => Some(surface as usize - 1),
            _ => None,
        }
    }

    /// The groups of ground and the bodies of water, in the order of their first cells, column by column.
    pub fn groups(&self) -> impl Iterator<Item = Group> + '_ {
        // The first surface is the ground, which is not drawn.
        let surfaces = self.context.groups.surfaces.iter();
        let surfaces = surfaces.zip(&self.context.levels.level).skip(1);
        surfaces.map(|(surface, level)| Group {
            water: surface.water,
            height: *level,
            cells: surface.area,
            first: self.context.grid.place(surface.first),
        })
    }

    /// The house that a cell's roof or wall belongs to: its index among [`houses`](Self::houses).
    pub fn house_at(&self, column: usize, row: usize) -> Option<usize> {
        let house = self.kind_at(column, row).house();
        house.map(|house| house as usize)
    }

    /// The houses.
    pub fn houses(&self) -> impl Iterator<Item = HouseInfo> + '_ {
        self.context.houses.iter().map(|house| HouseInfo {
            base: house.base,
            width: house.walls.len() as i32,
            depth: house.depth,
            height: house.height,
        })
    }

    /// The triangles: per material the pieces of its surface, in tiles, about the map's middle at height 0. `roof` is the ratio
    /// of a roof's height to its depth, `bevel` the radius of bevels in tiles, at most a half.
    pub fn surface(&self, roof: f64, bevel: f64) -> Vec<(u8, Vec<Surface>)> {
        surface::surface(&self.context, roof, bevel)
    }
}

/// The heights of a map, without hidden ground and without the size of hidden houses. Roofs without walls whose first cell passes
/// the test `is_plain` are ground.
fn measured(map: &Map, is_plain: impl Fn(usize) -> bool) -> (MapContext, Constraints) {
    let grid = Grid::new(map);
    let groups = Groups::new(&grid, is_plain);
    let constraints = Constraints::read(&grid, &groups);
    let levels = Levels::new(&groups, &constraints);
    let houses = houses::measure(&grid, &groups, &levels);
    let context = MapContext {
        flush: flush::flush(&grid, &groups, &levels),
        earth: commonest(map, Tile::Brown),
        houses_of: houses::by_stripe(&houses, map.columns),
        grid,
        groups,
        levels,
        houses,
        plain: None,
        backs: vec![],
    };
    (context, constraints)
}

/// The commonest material of a kind of tile.
pub(super) fn commonest(map: &Map, tile: Tile) -> Option<u8> {
    let mut counts = [0_usize; 256];
    for material in &map.cells {
        counts[usize::from(*material)] += 1;
    }
    let materials = map.tiles.iter().enumerate();
    let of_kind = materials.filter(|(material, kind)| **kind == tile && counts[*material] > 0);
    let best =
        of_kind.max_by_key(|(material, _)| (counts[*material], std::cmp::Reverse(*material)));
    best.map(|(material, _)| material as u8)
}
