//! Height constraints: by how much one surface is higher than another, as read from the columns.

use std::cmp::{Ordering, Reverse};

use rayon::prelude::*;
use rustc_hash::{FxHashMap, FxHashSet};

use super::column::{Below, Column};
use super::grid::Grid;
use super::groups::{GROUND, GroupKind, Groups};

/// The number of columns that a thread takes at a time.
pub(super) const STRIPE: usize = 64;

/// One surface is higher than another by a number of tiles.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct HeightConstraint {
    pub(super) upper: u32,
    pub(super) lower: u32,
    /// By how much the upper one is higher.
    pub(super) rise: i32,
    /// The number of columns that show it.
    pub(super) columns: usize,
    /// Row and column of the first cell that shows it.
    pub(super) first: [usize; 2],
}

/// A few columns of a pair show more rows of front than its constraint says.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Uneven {
    /// The constraint, with the number of all columns of the pair.
    pub(super) taken: HeightConstraint,
    /// The columns that show more, with the most rows that one of them shows.
    pub(super) more: HeightConstraint,
}

/// A pair of surfaces has the largest rise that one in so many of its columns shows.
const SHARE: usize = 4;

#[derive(Debug, Default)]
pub(super) struct Constraints {
    /// Those between a surface and what is visible right below it or below its front; one a pair. Strongest first.
    pub(super) strong: Vec<HeightConstraint>,
    /// Those that are only likely. Strongest first.
    pub(super) weak: Vec<HeightConstraint>,
    /// Pairs of which a few columns show more than the constraint, in the order of their first cells.
    pub(super) uneven: Vec<Uneven>,
    /// Per surface with pits the rows of front of its deepest one. A pit is a front between parts of one surface.
    pub(super) pits: FxHashMap<u32, i32>,
    /// Row and column of the first pit.
    pub(super) pit: Option<[usize; 2]>,
}

#[derive(Debug, Default)]
struct Collected {
    strong: FxHashMap<(u32, u32, i32), HeightConstraint>,
    weak: FxHashMap<(u32, u32, i32), HeightConstraint>,
    pits: FxHashMap<u32, i32>,
    pit: Option<[usize; 2]>,
}

impl Constraints {
    /// Reads the constraints from all columns.
    pub(super) fn read(grid: &Grid, groups: &Groups) -> Self {
        let stripes = grid.columns.div_ceil(STRIPE);
        let found = (0..stripes)
            .into_par_iter()
            .map(|stripe| {
                let mut found = Collected::default();
                let mut column = Column::default();
                let end = ((stripe + 1) * STRIPE).min(grid.columns);
                for index in stripe * STRIPE..end {
                    column.read(grid, groups, index);
                    found.column(groups, &column, index);
                }
                found
            })
            .reduce(Collected::default, Collected::with);
        found.border(grid, groups).sorted(groups)
    }
}

impl Collected {
    fn strong(&mut self, constraint: HeightConstraint) {
        add(&mut self.strong, constraint);
    }

    fn weak(&mut self, constraint: HeightConstraint) {
        if constraint.upper != constraint.lower {
            add(&mut self.weak, constraint);
        }
    }

    fn pit_in(&mut self, surface: u32, depth: i32) {
        let deepest = self.pits.entry(surface).or_default();
        *deepest = depth.max(*deepest);
    }

    fn with(mut self, other: Self) -> Self {
        if self.strong.len() + self.weak.len() < other.strong.len() + other.weak.len() {
            return other.with(self);
        }
        self.pit = self.pit.into_iter().chain(other.pit).min();
        #[expect(
            clippy::iter_over_hash_type,
            reason = "the deepest pit does not depend on the order"
        )]
        for (surface, depth) in other.pits {
            self.pit_in(surface, depth);
        }
        // The result of merging does not depend on the order.
        for constraint in other.strong.into_values() {
            self.strong(constraint);
        }
        for constraint in other.weak.into_values() {
            self.weak(constraint);
        }
        self
    }

    fn column(&mut self, groups: &Groups, column: &Column, number: usize) {
        let water = |surface: u32| groups.surfaces[surface as usize].water;
        for (index, segment) in column.segments.iter().enumerate() {
            let GroupKind::Surface(upper) = segment.kind else {
                continue;
            };
            let first = [segment.start as usize, number];
            let constraint = |lower: u32, rise: i32| HeightConstraint {
                upper,
                lower,
                rise,
                columns: 1,
                first,
            };
            let (fronts, below, next) = column.below(index);
            match below {
                Below::Surface(lower) if lower == upper => {
                    self.pit = self.pit.into_iter().chain([first]).min();
                    self.pit_in(upper, fronts);
                }
                Below::Surface(GROUND) => self.strong(constraint(GROUND, fronts)),
                Below::Surface(lower) if fronts > 0 || (!water(upper) && water(lower)) => {
                    self.strong(constraint(lower, fronts));
                }
                // Water's near bank hides how deep the water lies.
                Below::Surface(_) if water(upper) => {}
                // (a) A surface whose foot is hidden by something stands on what that stands on.
                Below::Surface(_) => {
                    if let Some((lower, _)) = column.stands_on(groups, next) {
                        self.weak(constraint(lower, 0));
                    }
                }
                // (a) and (c): behind a house, and on its roof.
                Below::House(_) => {
                    if let Some((lower, more)) = column.foot(next) {
                        let rise = if fronts > 0 { fronts + more } else { 0 };
                        self.weak(constraint(lower, rise));
                    }
                }
            }
            // (b) Both banks of water have the same height.
            if let Below::Surface(between) = below
                && !water(upper)
                && water(between)
                && let (0, Below::Surface(bank), _) = column.below(next)
                && bank != GROUND
                && !water(bank)
            {
                self.weak(constraint(bank, 0));
            }
        }
    }

    /// Water at the map's border is open water at ground level (rule 7), unless the map shows it falling there.
    fn border(mut self, grid: &Grid, groups: &Groups) -> Self {
        let falling: FxHashSet<u32> = self
            .strong
            .keys()
            .filter(|key| key.1 == GROUND)
            .map(|key| key.0)
            .collect();
        let surfaces = groups.surfaces.iter().enumerate().skip(1);
        for (index, surface) in surfaces.filter(|(_, surface)| surface.water && surface.at_border) {
            let [column, row] = grid.place(surface.first);
            let upper = index as u32;
            if !falling.contains(&upper) {
                self.strong(HeightConstraint {
                    upper,
                    lower: GROUND,
                    rise: 0,
                    columns: 1,
                    first: [row, column],
                });
            }
        }
        self
    }

    fn sorted(self, groups: &Groups) -> Constraints {
        let mut shown: Vec<HeightConstraint> = self.strong.into_values().collect();
        shown.par_sort_unstable_by_key(|c| (c.upper, c.lower, Reverse(c.rise)));
        let pairs =
            shown.chunk_by(|one, other| (one.upper, one.lower) == (other.upper, other.lower));
        let pairs = pairs.map(HeightConstraint::of_pair);
        let (mut strong, uneven): (Vec<HeightConstraint>, Vec<Option<Uneven>>) = pairs.unzip();
        let mut uneven: Vec<Uneven> = uneven.into_iter().flatten().collect();
        uneven.sort_unstable_by_key(|uneven| (uneven.more.first, uneven.more.lower));
        let mut weak: Vec<HeightConstraint> = self.weak.into_values().collect();
        let mut all = vec![0_usize; groups.surfaces.len()];
        for constraint in &strong {
            all[constraint.upper as usize] += constraint.columns;
        }
        let share = |one: &HeightConstraint, other: &HeightConstraint| -> Ordering {
            let [one_all, other_all] = [one, other].map(|c| all[c.upper as usize] as u128);
            (other.columns as u128 * one_all).cmp(&(one.columns as u128 * other_all))
        };
        let stands_free = |c: &HeightConstraint| c.lower == GROUND && c.rise > 0;
        strong.par_sort_unstable_by(|one, other| {
            let area = |c: &HeightConstraint| groups.surfaces[c.lower as usize].area;
            (stands_free(other).cmp(&stands_free(one)))
                .then_with(|| share(one, other))
                .then_with(|| area(other).cmp(&area(one)))
                .then_with(|| other.columns.cmp(&one.columns))
                .then_with(|| other.rise.cmp(&one.rise))
                .then_with(|| (one.first, one.lower).cmp(&(other.first, other.lower)))
        });
        weak.par_sort_unstable_by_key(|c| (Reverse(c.columns), c.first, c.lower, c.rise));
        Constraints {
            strong,
            weak,
            uneven,
            pits: self.pits,
            pit: self.pit,
        }
    }
}

/// Adds a constraint to others, by pair and rise.
fn add(
    constraints: &mut FxHashMap<(u32, u32, i32), HeightConstraint>,
    constraint: HeightConstraint,
) {
    let known = constraints.entry((constraint.upper, constraint.lower, constraint.rise));
    known
        .and_modify(|known| known.join(&constraint))
        .or_insert(constraint);
}

impl HeightConstraint {
    /// Counts the columns of another constraint of the pair.
    fn join(&mut self, other: &Self) {
        self.columns += other.columns;
        self.first = self.first.min(other.first);
    }

    /// The constraint of a pair from what its columns show, largest rise first: the largest that at least a quarter of the columns
    /// show or exceed. Where the map shows less, the upper surface hangs; where it shows more, the front goes on below.
    fn of_pair(shown: &[Self]) -> (Self, Option<Uneven>) {
        let mut taken = shown[0];
        let all: usize = shown.iter().map(|one| one.columns).sum();
        let mut more: Option<Self> = None;
        let mut columns = 0;
        for one in shown {
            columns += one.columns;
            if columns * SHARE >= all {
                taken.rise = one.rise;
                break;
            }
            more = Some(match more {
                Some(mut more) => {
                    more.join(one);
                    more
                }
                None => *one,
            });
        }
        shown[1..].iter().for_each(|one| taken.join(one));
        (taken, more.map(|more| Uneven { taken, more }))
    }
}
