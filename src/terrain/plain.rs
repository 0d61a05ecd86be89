//! Plain maps, which are seen from straight above and have no fronts: their heights are given (ours).
//!
//! A cell is a column of solid from the map's floor up to the height of its top, so walls stand where heights differ, and there is
//! nothing below the floor but its plate.

use super::constraints::Constraints;
use super::grid::{Grid, transposed};
use super::groups::{GROUND, GroupKind, Groups, Surface};
use super::landscape::commonest;
use super::levels::Levels;
use super::map::{Map, Tile, UNSET};
use super::solids::{Block, MapContext};
use crate::regions::connected;

/// How far water lies below its lowest bank.
const SUNK: i32 = 1;

/// What plain maps need beside their groups and levels.
#[derive(Debug)]
pub(super) struct Plain {
    /// The height down to which everything is solid.
    floor: i32,
    /// Per material that of the walls below its tops.
    walls: [u8; 256],
}

/// The heights of a plain map.
pub(super) fn measured(map: &Map) -> (MapContext, Constraints) {
    let grid = Grid::new(map);
    let given = transposed(&map.heights, map.columns, map.rows);
    let groups = groups(&grid, &given);
    let banks = banks(&grid, &groups, &given);
    let level_of = |(index, surface): (usize, &Surface)| match surface {
        _ if index == GROUND as usize => 0,
        surface if given[surface.first] != UNSET => i32::from(given[surface.first]),
        // Water that runs to the border is the sea, which lies at 0 or below.
        surface if surface.water => match banks[index] {
            None => 0,
            Some(bank) if surface.at_border => (bank - SUNK).min(0),
            Some(bank) => bank - SUNK,
        },
        _ => 0,
    };
    let level: Vec<i32> = groups.surfaces.iter().enumerate().map(level_of).collect();
    let floor = level.iter().copied().min().unwrap_or(0);
    let context = MapContext {
        plain: Some(Plain {
            floor,
            walls: walls(map),
        }),
        levels: Levels {
            base: vec![floor; level.len()],
            plates: [floor].into_iter().collect(),
            support: vec![None; level.len()],
            unconstrained: vec![],
            hanging: vec![],
            level,
        },
        earth: commonest(map, Tile::Brown),
        flush: vec![None; groups.kinds.len()],
        houses_of: vec![],
        houses: vec![],
        backs: vec![],
        grid,
        groups,
    };
    (context, Constraints::default())
}

/// Groups of connected cells of one height, each a surface.
fn groups(grid: &Grid, given: &[i8]) -> Groups {
    let rows = grid.rows;
    let water = |cell: usize| grid.tile(cell) == Tile::Blue;
    let is_drawn = |cell: usize| grid.tile(cell) != Tile::None;
    // Ground without a height is at 0.
    let height = |cell: usize| match given[cell] {
        UNSET if !water(cell) => 0,
        height => height,
    };
    let same = |one: usize, other: usize| {
        is_drawn(one) == is_drawn(other)
            && water(one) == water(other)
            && height(one) == height(other)
    };
    let labels = connected(
        grid.cells.len(),
        rows,
        1,
        is_drawn,
        |cell| same(cell - 1, cell),
        |cell| same(cell - rows, cell),
    );
    let ground = Surface {
        water: false,
        area: usize::MAX,
        first: usize::MAX,
        at_border: true,
    };
    let of_label = labels.firsts.iter().map(|first| Surface {
        water: water(*first),
        area: 0,
        first: *first,
        at_border: false,
    });
    let mut surfaces: Vec<Surface> = std::iter::once(ground).chain(of_label).collect();
    for (cell, label) in labels.of.iter().enumerate() {
        if *label != GROUND {
            let surface = &mut surfaces[*label as usize];
            surface.area += 1;
            let [column, row] = grid.place(cell);
            surface.at_border |=
                column == 0 || column + 1 == grid.columns || row == 0 || row + 1 == rows;
        }
    }
    let kinds = (0..surfaces.len() as u32).map(|surface| match surface {
        GROUND => GroupKind::Nothing,
        surface => GroupKind::Surface(surface),
    });
    Groups {
        kinds: kinds.collect(),
        labels: labels.of,
        surfaces,
        houses: 0,
        plain: vec![],
        hidden: vec![],
    }
}

/// Per surface of water the height of the lowest ground beside it.
fn banks(grid: &Grid, groups: &Groups, given: &[i8]) -> Vec<Option<i32>> {
    let mut banks = vec![None; groups.surfaces.len()];
    let mut meet = |one: usize, other: usize| {
        let [one, other] = [one, other].map(|cell| groups.labels[cell]);
        for [water, ground] in [[one, other], [other, one]] {
            let [of_water, of_ground] =
                [water, ground].map(|label| &groups.surfaces[label as usize]);
            if water == GROUND || ground == GROUND || !of_water.water || of_ground.water {
                continue;
            }
            let height = match given[of_ground.first] {
                UNSET => 0,
                height => i32::from(height),
            };
            let bank = banks[water as usize].get_or_insert(height);
            *bank = height.min(*bank);
        }
    };
    for cell in 0..grid.cells.len() {
        if (cell + 1) % grid.rows != 0 {
            meet(cell, cell + 1);
        }
        if cell + grid.rows < grid.cells.len() {
            meet(cell, cell + grid.rows);
        }
    }
    banks
}

/// Per material that of the walls below its tops: earth below ground, walls below roofs, where the map has them, and itself below
/// all else.
fn walls(map: &Map) -> [u8; 256] {
    let [earth, beige] = [Tile::Brown, Tile::Beige].map(|tile| commonest(map, tile));
    // Earth that nothing is painted with has a material all the same, for these walls.
    let earth = earth.or_else(|| {
        let brown = map.tiles.iter().position(|tile| *tile == Tile::Brown);
        brown.map(|material| material as u8)
    });
    let mut walls = [0; 256];
    for ((own, tile), wall) in map.tiles.iter().enumerate().zip(&mut walls) {
        let found = match tile {
            Tile::Green => earth,
            Tile::Red => beige,
            _ => None,
        };
        *wall = found.unwrap_or(own as u8);
    }
    walls
}

impl Plain {
    /// Adds the blocks of a column: one for each run of cells of one material and height.
    pub(super) fn blocks(&self, context: &MapContext, number: usize, blocks: &mut Vec<Block>) {
        let MapContext {
            grid,
            groups,
            levels,
            ..
        } = context;
        let column = number * grid.rows;
        let mut row = 0;
        while row < grid.rows {
            let of = |row: usize| {
                let top = grid.top(column + row);
                (groups.labels[column + row], grid.cells[column + row], top)
            };
            let (label, material, top) = of(row);
            let same = |next: &usize| of(*next) == (label, material, top);
            let end = row + (row..grid.rows).take_while(same).count();
            if label != GROUND {
                blocks.push(Block {
                    z: [row as i32, end as i32],
                    y: [self.floor, levels.level[label as usize]],
                    top: Some(top),
                    side: self.walls[usize::from(material)],
                });
            }
            row = end;
        }
    }
}
