//! The landscape that a map shows.

use super::grid::Grid;
use super::groups::{Groups, Role};
use super::houses::{self, House};
use super::levels::Levels;
use super::map::{Map, Tile};
use super::notes::{self, Note};
use super::solids::{self, Known, Seen, Solids};
use super::surface;
use super::ties::Ties;
use crate::scene::Surface;

/// The height of a roof over its depth, if nothing else is said (equation 3.1).
pub const ROOF: f64 = std::f64::consts::FRAC_1_SQRT_2;

/// A landscape, in tiles.
#[derive(Debug)]
pub struct Land {
    grid: Grid,
    groups: Groups,
    levels: Levels,
    houses: Vec<House>,
    houses_of: Vec<Vec<u32>>,
    flush: Vec<Option<i32>>,
    earth: Option<u8>,
    ties: Ties,
}

/// A group of ground or a body of water.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Group {
    /// Whether it is water.
    pub water: bool,
    /// Its height.
    pub height: i32,
    /// How many cells it has.
    pub cells: usize,
    /// Column and row of its first cell.
    pub first: [usize; 2],
}

/// A house.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Built {
    /// Height of its floor.
    pub base: i32,
    /// Columns of its walls.
    pub width: i32,
    /// From front to back.
    pub depth: i32,
    /// Height of its walls.
    pub height: i32,
}

impl Built {
    /// Height of its ridge; `roof` is the height of roofs over their depth.
    pub fn ridge(&self, roof: f64) -> f64 {
        f64::from(self.base + self.height) + roof * f64::from(self.depth)
    }
}

impl Land {
    /// Works out how high everything on a map lies. Never fails: what is ambiguous is decided by the rules. Takes about as
    /// long as reading the map a few times.
    pub fn new(map: &Map) -> Self {
        let grid = Grid::new(map);
        let groups = Groups::new(&grid);
        let ties = Ties::read(&grid, &groups);
        let levels = Levels::new(&groups, &ties);
        let houses = houses::measure(&grid, &groups, &levels);
        let flush = solids::flush(&grid, &groups, &levels);
        let earth = commonest(map, Tile::Brown);
        Self {
            grid,
            groups,
            levels,
            houses_of: houses::by_stripe(&houses, map.columns),
            houses,
            flush,
            earth,
            ties,
        }
    }

    /// The height of the top that is drawn in a cell: ground or water; `None` where there is none.
    pub fn top(&self, column: usize, row: usize) -> Option<i32> {
        match self.groups.role(column * self.grid.rows + row) {
            Role::Surface(surface) => Some(self.levels.level[surface as usize]),
            _ => None,
        }
    }

    /// The height of what is seen in each cell of a column, at the cell's lower edge: of the top or the eaves, or of that place
    /// on a front. `None` where nothing is drawn.
    pub fn seen(&self, column: usize) -> Vec<Option<i32>> {
        let mut solids = Solids::default();
        solids.look_at(&self.known(), column);
        let heights = solids.views.iter().flat_map(|view| {
            let rows = view.start..view.end;
            rows.map(|row| match view.seen {
                Seen::Nothing => None,
                Seen::Top(level) | Seen::Roof(level) => Some(level),
                Seen::Front(plane) => Some(plane - row - 1),
            })
        });
        heights.collect()
    }

    /// How many columns the map has.
    pub fn columns(&self) -> usize {
        self.grid.columns
    }

    /// The blocks of a column that are solid, in no order: from back to front and from below to above. They may overlap, and
    /// sheets have no height; roofs are not among them.
    pub fn blocks(&self, column: usize) -> Vec<[[i32; 2]; 2]> {
        let mut solids = Solids::default();
        solids.build(&self.known(), column);
        solids
            .blocks
            .iter()
            .map(|block| [block.z, block.y])
            .collect()
    }

    /// What the map leaves open.
    pub fn notes(&self) -> Vec<Note> {
        notes::notes(&self.known(), &self.ties)
    }

    /// The group that a cell's top belongs to: its index among [`groups`](Self::groups).
    pub fn group_at(&self, column: usize, row: usize) -> Option<usize> {
        match self.groups.role(column * self.grid.rows + row) {
            Role::Surface(surface) => Some(surface as usize - 1),
            _ => None,
        }
    }

    /// The groups of ground and the bodies of water, in the order of their first cells, column by column.
    pub fn groups(&self) -> impl Iterator<Item = Group> + '_ {
        // The first surface is the ground that is not drawn.
        let surfaces = self.groups.surfaces.iter().zip(&self.levels.level).skip(1);
        surfaces.map(|(surface, level)| Group {
            water: surface.water,
            height: *level,
            cells: surface.area,
            first: self.grid.place(surface.first),
        })
    }

    /// The house that a cell's roof or wall belongs to: its index among [`houses`](Self::houses).
    pub fn house_at(&self, column: usize, row: usize) -> Option<usize> {
        let role = self.groups.role(column * self.grid.rows + row);
        role.house().map(|house| house as usize)
    }

    /// The houses.
    pub fn houses(&self) -> impl Iterator<Item = Built> + '_ {
        self.houses.iter().map(|house| Built {
            base: house.base,
            width: house.walls.len() as i32,
            depth: house.depth,
            height: house.height,
        })
    }

    /// The triangles: per look the pieces of its surface, in tiles, about the map's middle at height 0. `roof` is the height of
    /// roofs over their depth, `bevel` the radius of bevels in tiles, at most a half.
    pub fn surface(&self, roof: f64, bevel: f64) -> Vec<(u8, Vec<Surface>)> {
        surface::surface(&self.known(), roof, bevel)
    }

    fn known(&self) -> Known<'_> {
        Known {
            grid: &self.grid,
            groups: &self.groups,
            levels: &self.levels,
            houses: &self.houses,
            houses_of: &self.houses_of,
            flush: &self.flush,
            earth: self.earth,
        }
    }
}

/// The look of a kind that most cells have.
fn commonest(map: &Map, tile: Tile) -> Option<u8> {
    let mut counts = [0_usize; 256];
    for look in &map.cells {
        counts[usize::from(*look)] += 1;
    }
    let looks = map.looks.iter().enumerate();
    let of_kind = looks.filter(|(look, kind)| **kind == tile && counts[*look] > 0);
    let best = of_kind.max_by_key(|(look, _)| (counts[*look], std::cmp::Reverse(*look)));
    best.map(|(look, _)| look as u8)
}
