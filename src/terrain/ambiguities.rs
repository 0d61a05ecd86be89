//! The ambiguities of a map, and how each was decided.

use rayon::prelude::*;

use super::constraints::{Constraints, STRIPE, Uneven};
use super::grid::Grid;
use super::groups::{GroupKind, Groups};
use super::houses::House;
use super::levels::Levels;
use super::map::Tile;
use super::occlusion::Visible;
use super::solids::{MapContext, Solids};

/// A place in a map that can be read in more than one way.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Ambiguity {
    /// The kind of ambiguity.
    pub kind: AmbiguityKind,
    /// Column and row of a cell that shows it.
    pub cell: [usize; 2],
    /// The number of cells concerned.
    pub cells: usize,
}

/// The kinds of ambiguities, each with the decision that was made.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum AmbiguityKind {
    /// No constraint leads to the height of a group: its lowest part is put on the ground.
    Unconstrained,
    /// A group hangs in the air: its front has fewer rows than it is high.
    Hangs {
        /// Rows that are drawn.
        drawn: i32,
        /// Rows that its height requires.
        needed: i32,
    },
    /// A few columns of a group's front have more rows than the others: they go on below what the group stands on.
    Uneven {
        /// The most rows that are drawn.
        most: i32,
        /// The height that was taken.
        taken: i32,
        /// All columns of this front.
        columns: usize,
    },
    /// A wall's colour without a roof, or a roof's without a wall: read as a top.
    Plain(Tile),
    /// A house hides tiles that are drawn: its roof or its wall is no rectangle, and nothing nearer covers the rest.
    House,
    /// There are pits and no edges: what was meant as a block on a plate is a hole in it.
    Pits,
}

pub(super) fn ambiguities(context: &MapContext, constraints: &Constraints) -> Vec<Ambiguity> {
    let MapContext {
        grid,
        groups,
        levels,
        ..
    } = context;
    let mut ambiguities = vec![];
    unconstrained(grid, groups, levels, &mut ambiguities);
    hanging(grid, groups, levels, &mut ambiguities);
    let rise = |uneven: &&Uneven| {
        let [upper, lower] = [uneven.taken.upper, uneven.taken.lower];
        levels.level[upper as usize] - levels.level[lower as usize]
    };
    // Another constraint may have given the height that they show.
    let uneven = constraints.uneven.iter();
    let uneven = uneven.filter(|uneven| rise(uneven) < uneven.more.rise);
    ambiguities.extend(uneven.map(|uneven| Ambiguity {
        kind: AmbiguityKind::Uneven {
            most: uneven.more.rise,
            taken: uneven.taken.rise,
            columns: uneven.taken.columns,
        },
        cell: [uneven.more.first[1], uneven.more.first[0]],
        cells: uneven.more.columns,
    }));
    for (first, cells) in &groups.plain {
        ambiguities.push(Ambiguity {
            kind: AmbiguityKind::Plain(grid.tile(*first)),
            cell: grid.place(*first),
            cells: *cells,
        });
    }
    hiding(context, &mut ambiguities);
    if let Some(pit) = constraints.pit
        && grid.edges.iter().all(|edges| *edges == 0)
    {
        ambiguities.push(Ambiguity {
            kind: AmbiguityKind::Pits,
            cell: [pit[1], pit[0]],
            cells: 1,
        });
    }
    ambiguities
}

fn unconstrained(grid: &Grid, groups: &Groups, levels: &Levels, ambiguities: &mut Vec<Ambiguity>) {
    ambiguities.extend(levels.unconstrained.iter().map(|surface| {
        let surface = &groups.surfaces[*surface as usize];
        Ambiguity {
            kind: AmbiguityKind::Unconstrained,
            cell: grid.place(surface.first),
            cells: surface.area,
        }
    }));
}

/// Groups whose height was decided by one constraint and that hang in the air by another; one ambiguity a group.
fn hanging(grid: &Grid, groups: &Groups, levels: &Levels, ambiguities: &mut Vec<Ambiguity>) {
    let mut is_reported = vec![false; groups.surfaces.len()];
    for constraint in &levels.hanging {
        let (upper, lower) = (constraint.upper as usize, constraint.lower as usize);
        if std::mem::replace(&mut is_reported[upper], true) {
            continue;
        }
        let surface = &groups.surfaces[upper];
        ambiguities.push(Ambiguity {
            kind: AmbiguityKind::Hangs {
                drawn: constraint.rise,
                needed: levels.level[upper] - levels.level[lower],
            },
            cell: grid.place(surface.first),
            cells: surface.area,
        });
    }
}

/// Houses that hide tiles that are drawn; one ambiguity a house.
fn hiding(context: &MapContext, ambiguities: &mut Vec<Ambiguity>) {
    let stripes = context.houses_of.par_iter().enumerate();
    let found = stripes.map(|(stripe, houses)| {
        let mut found = vec![];
        let mut solids = Solids::default();
        let columns = stripe * STRIPE..((stripe + 1) * STRIPE).min(context.grid.columns);
        for number in columns.filter(|_| !houses.is_empty()) {
            let here = |house: &&u32| {
                let columns = context.houses[**house as usize].columns();
                columns.contains(&(number as i32))
            };
            let mut houses = houses.iter().filter(here).peekable();
            if houses.peek().is_some() {
                solids.read_views(context, number);
            }
            for index in houses {
                let house = &context.houses[*index as usize];
                let hidden = hidden_by(context, house, &solids, number);
                found.extend(hidden.map(|(cells, row)| (*index, cells, [number, row])));
            }
        }
        found
    });
    let mut found: Vec<(u32, usize, [usize; 2])> = found.flatten().collect();
    found.sort_unstable();
    for hidden in found.chunk_by(|one, other| one.0 == other.0) {
        ambiguities.push(Ambiguity {
            kind: AmbiguityKind::House,
            cell: hidden[0].2,
            cells: hidden.iter().map(|(_, cells, _)| cells).sum(),
        });
    }
}

/// How many drawn cells of a column a house hides, and the first one's row.
fn hidden_by(
    context: &MapContext,
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
            let cell = number * context.grid.rows + row as usize;
            // The height of the house that is visible in this row, if its roof is as steep as drawn.
            let own = if row < eaves {
                house.eaves() + (eaves - row).div_euclid(2)
            } else {
                house.front - row - 1
            };
            let nearer = match (context.groups.kind(cell), view.visible) {
                (GroupKind::Roof(_) | GroupKind::Wall(_), Visible::Roof(level)) => {
                    level == house.eaves() || level > own
                }
                (_, Visible::Front(plane)) => plane >= house.front,
                (_, Visible::Top(level) | Visible::Roof(level)) => level > own,
                (_, Visible::Nothing) => true,
            };
            if !nearer {
                cells += 1;
                first.get_or_insert(row as usize);
            }
        }
    }
    first.map(|row| (cells, row))
}
