//! What a map leaves open, and how it was decided (terrain.md: one warning a group, with its cells).

use rayon::prelude::*;

use super::grid::Grid;
use super::groups::{Groups, Role};
use super::houses::House;
use super::levels::Levels;
use super::map::Tile;
use super::solids::{Known, Seen, Solids};
use super::ties::{STRIPE, Ties};

/// Something that a map leaves open.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Note {
    /// What it is.
    pub what: Open,
    /// Column and row of a cell that shows it.
    pub cell: [usize; 2],
    /// How many cells it is about.
    pub cells: usize,
}

/// The kinds of what a map leaves open.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Open {
    /// Nothing says how high a group lies: its lowest part is put on the ground.
    Loose,
    /// A group hangs in the air: its front has fewer rows than it is high.
    Hangs {
        /// Rows that are drawn.
        drawn: i32,
        /// Rows that its height asks for.
        needed: i32,
    },
    /// A wall's colour without a roof, or a roof's without a wall: read as a top.
    Plain(Tile),
    /// A house hides tiles that are drawn: its roof or its wall is no rectangle, and nothing nearer covers the rest.
    House,
    /// There are pits and no edges: what was meant as a block on a plate is a hole in it.
    Pits,
}

/// Finds out what is open.
pub(super) fn notes(known: &Known<'_>, ties: &Ties) -> Vec<Note> {
    let Known {
        grid,
        groups,
        levels,
        ..
    } = *known;
    let mut notes = vec![];
    loose(grid, groups, levels, &mut notes);
    hanging(grid, groups, levels, &mut notes);
    for (first, cells) in &groups.plain {
        notes.push(Note {
            what: Open::Plain(grid.tile(*first)),
            cell: grid.place(*first),
            cells: *cells,
        });
    }
    hiding(known, &mut notes);
    if let Some(pit) = ties.pit
        && grid.edges.iter().all(|edges| *edges == 0)
    {
        notes.push(Note {
            what: Open::Pits,
            cell: [pit[1], pit[0]],
            cells: 1,
        });
    }
    notes
}

fn loose(grid: &Grid, groups: &Groups, levels: &Levels, notes: &mut Vec<Note>) {
    notes.extend(levels.loose.iter().map(|surface| {
        let surface = &groups.surfaces[*surface as usize];
        Note {
            what: Open::Loose,
            cell: grid.place(surface.first),
            cells: surface.area,
        }
    }));
}

/// Groups that hang above another one than that whose tie decided their height; one note a group.
fn hanging(grid: &Grid, groups: &Groups, levels: &Levels, notes: &mut Vec<Note>) {
    let mut told = vec![false; groups.surfaces.len()];
    for tie in &levels.hanging {
        let (upper, lower) = (tie.upper as usize, tie.lower as usize);
        if std::mem::replace(&mut told[upper], true) {
            continue;
        }
        let surface = &groups.surfaces[upper];
        notes.push(Note {
            what: Open::Hangs {
                drawn: tie.rise,
                needed: levels.level[upper] - levels.level[lower],
            },
            cell: grid.place(surface.first),
            cells: surface.area,
        });
    }
}

/// Houses that hide tiles that are drawn; one note a house.
fn hiding(known: &Known<'_>, notes: &mut Vec<Note>) {
    let stripes = known.houses_of.par_iter().enumerate();
    let found = stripes.map(|(stripe, houses)| {
        let mut found = vec![];
        let mut solids = Solids::default();
        let columns = stripe * STRIPE..((stripe + 1) * STRIPE).min(known.grid.columns);
        for number in columns.filter(|_| !houses.is_empty()) {
            let here = |house: &&u32| {
                let columns = known.houses[**house as usize].columns();
                columns.contains(&(number as i32))
            };
            let mut houses = houses.iter().filter(here).peekable();
            if houses.peek().is_some() {
                solids.look_at(known, number);
            }
            for index in houses {
                let house = &known.houses[*index as usize];
                let hidden = hidden_by(known, house, &solids, number);
                found.extend(hidden.map(|(cells, row)| (*index, cells, [number, row])));
            }
        }
        found
    });
    let mut found: Vec<(u32, usize, [usize; 2])> = found.flatten().collect();
    found.sort_unstable();
    for hidden in found.chunk_by(|one, other| one.0 == other.0) {
        notes.push(Note {
            what: Open::House,
            cell: hidden[0].2,
            cells: hidden.iter().map(|(_, cells, _)| cells).sum(),
        });
    }
}

/// How many drawn cells of a column a house hides, and the first one's row.
fn hidden_by(
    known: &Known<'_>,
    house: &House,
    solids: &Solids,
    number: usize,
) -> Option<(usize, usize)> {
    let [top, eaves, foot] = [
        house.back() - house.eaves(),
        house.front - house.eaves(),
        house.front - house.base,
    ];
    let column = number as i32;
    let from = if house.roof.contains(&column) {
        top
    } else {
        eaves
    };
    let to = if house.walls.contains(&column) {
        foot
    } else {
        eaves
    };
    let (mut cells, mut first) = (0, None);
    let start = solids.views.partition_point(|view| view.end <= from);
    for view in solids.views[start..]
        .iter()
        .take_while(|view| view.start < to)
    {
        for row in view.start.max(from)..view.end.min(to) {
            let cell = number * known.grid.rows + row as usize;
            // How high the house is where it is seen in this row, with a roof that looks as it is drawn.
            let own = if row < eaves {
                house.eaves() + (eaves - row).div_euclid(2)
            } else {
                house.front - row - 1
            };
            let nearer = match (known.groups.role(cell), view.seen) {
                (Role::Roof(_) | Role::Wall(_), Seen::Roof(level)) => {
                    level == house.eaves() || level > own
                }
                (_, Seen::Front(plane)) => plane >= house.front,
                (_, Seen::Top(level) | Seen::Roof(level)) => level > own,
                (_, Seen::Nothing) => true,
            };
            if !nearer {
                cells += 1;
                first.get_or_insert(row as usize);
            }
        }
    }
    first.map(|row| (cells, row))
}
