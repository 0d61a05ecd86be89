//! Ties: what the columns say about how much higher one surface is than another (terrain.md, rule 3).

use std::cmp::{Ordering, Reverse};
use std::hash::Hash;

use rayon::prelude::*;
use rustc_hash::FxHashMap;

use super::column::{Below, Column};
use super::grid::Grid;
use super::groups::{GROUND, Groups, Role};

/// How many columns a thread reads before it looks for more.
pub(super) const STRIPE: usize = 64;

/// A is n above B, say some columns.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Tie {
    /// The upper surface.
    pub(super) upper: u32,
    /// The lower surface.
    pub(super) lower: u32,
    /// By how much the upper one is higher.
    pub(super) rise: i32,
    /// How many columns say so.
    pub(super) columns: usize,
    /// Where it is said first: the row, then the column.
    pub(super) first: [usize; 2],
}

/// All ties of a map.
#[derive(Debug, Default)]
pub(super) struct Ties {
    /// Those between a surface and what is seen right below it or its front; one a pair. Strongest first.
    pub(super) strong: Vec<Tie>,
    /// Those that only suggest themselves. Strongest first.
    pub(super) weak: Vec<Tie>,
    /// Row and column of the first pit: fronts between parts of one surface.
    pub(super) pit: Option<[usize; 2]>,
}

#[derive(Debug, Default)]
struct Found {
    strong: FxHashMap<(u32, u32), Tie>,
    weak: FxHashMap<(u32, u32, i32), Tie>,
    pit: Option<[usize; 2]>,
}

impl Ties {
    /// Reads the ties off all columns.
    pub(super) fn read(grid: &Grid, groups: &Groups) -> Self {
        let stripes = grid.columns.div_ceil(STRIPE);
        let found = (0..stripes)
            .into_par_iter()
            .map(|stripe| {
                let mut found = Found::default();
                let mut column = Column::default();
                let end = ((stripe + 1) * STRIPE).min(grid.columns);
                for index in stripe * STRIPE..end {
                    column.read(grid, groups, index);
                    found.column(groups, &column, index);
                }
                found
            })
            .reduce(Found::default, Found::with);
        found.border(grid, groups).sorted(groups)
    }
}

impl Found {
    fn strong(&mut self, tie: Tie) {
        add(&mut self.strong, (tie.upper, tie.lower), tie);
    }

    fn weak(&mut self, tie: Tie) {
        if tie.upper != tie.lower {
            add(&mut self.weak, (tie.upper, tie.lower, tie.rise), tie);
        }
    }

    fn with(mut self, other: Self) -> Self {
        if self.strong.len() + self.weak.len() < other.strong.len() + other.weak.len() {
            return other.with(self);
        }
        self.pit = self.pit.into_iter().chain(other.pit).min();
        // What is joined does not depend on the order in which it comes.
        for tie in other.strong.into_values() {
            self.strong(tie);
        }
        for tie in other.weak.into_values() {
            self.weak(tie);
        }
        self
    }

    fn column(&mut self, groups: &Groups, column: &Column, number: usize) {
        let water = |surface: u32| groups.surfaces[surface as usize].water;
        for (index, segment) in column.segments.iter().enumerate() {
            let Role::Surface(upper) = segment.role else {
                continue;
            };
            let first = [segment.start as usize, number];
            let tie = |lower: u32, rise: i32| Tie {
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
                }
                Below::Surface(GROUND) => self.strong(tie(GROUND, fronts)),
                Below::Surface(lower) if fronts > 0 || (!water(upper) && water(lower)) => {
                    self.strong(tie(lower, fronts));
                }
                // Water's near bank hides how deep the water lies.
                Below::Surface(_) if water(upper) => {}
                // (a) What is hidden behind something stands where that stands.
                Below::Surface(_) => {
                    if let Some((lower, _)) = column.stands_on(groups, next) {
                        self.weak(tie(lower, 0));
                    }
                }
                // (a) and (c): behind a house, and on its roof.
                Below::House(_) => {
                    if let Some((lower, more)) = column.foot(next) {
                        let rise = if fronts > 0 { fronts + more } else { 0 };
                        self.weak(tie(lower, rise));
                    }
                }
            }
            // (b) Both banks of water are of one height.
            if let Below::Surface(between) = below
                && !water(upper)
                && water(between)
                && let (0, Below::Surface(bank), _) = column.below(next)
                && bank != GROUND
                && !water(bank)
            {
                self.weak(tie(bank, 0));
            }
        }
    }

    /// Water that runs to the border is open water at the ground (rule 7), if it is not seen to fall down there.
    fn border(mut self, grid: &Grid, groups: &Groups) -> Self {
        let surfaces = groups.surfaces.iter().enumerate().skip(1);
        for (index, surface) in surfaces.filter(|(_, surface)| surface.water && surface.at_border) {
            let [column, row] = grid.place(surface.first);
            let upper = index as u32;
            self.strong.entry((upper, GROUND)).or_insert(Tie {
                upper,
                lower: GROUND,
                rise: 0,
                columns: 1,
                first: [row, column],
            });
        }
        self
    }

    fn sorted(self, groups: &Groups) -> Ties {
        let mut strong: Vec<Tie> = self.strong.into_values().collect();
        let mut weak: Vec<Tie> = self.weak.into_values().collect();
        let mut all = vec![0_usize; groups.surfaces.len()];
        for tie in &strong {
            all[tie.upper as usize] += tie.columns;
        }
        let share = |one: &Tie, other: &Tie| -> Ordering {
            let [one_all, other_all] = [one, other].map(|tie| all[tie.upper as usize] as u128);
            (other.columns as u128 * one_all).cmp(&(one.columns as u128 * other_all))
        };
        let stands_free = |tie: &Tie| tie.lower == GROUND && tie.rise > 0;
        strong.par_sort_unstable_by(|one, other| {
            let area = |tie: &Tie| groups.surfaces[tie.lower as usize].area;
            (stands_free(other).cmp(&stands_free(one)))
                .then_with(|| share(one, other))
                .then_with(|| area(other).cmp(&area(one)))
                .then_with(|| other.columns.cmp(&one.columns))
                .then_with(|| other.rise.cmp(&one.rise))
                .then_with(|| (one.first, one.lower).cmp(&(other.first, other.lower)))
        });
        weak.par_sort_unstable_by_key(|tie| (Reverse(tie.columns), tie.first, tie.lower, tie.rise));
        Ties {
            strong,
            weak,
            pit: self.pit,
        }
    }
}

/// Adds a tie to those that say the same.
fn add<Key: Eq + Hash>(ties: &mut FxHashMap<Key, Tie>, key: Key, tie: Tie) {
    let known = ties.entry(key);
    known.and_modify(|known| known.join(&tie)).or_insert(tie);
}

impl Tie {
    /// Ties of one pair are one, with the largest rise: the others hang.
    fn join(&mut self, other: &Self) {
        self.rise = self.rise.max(other.rise);
        self.columns += other.columns;
        self.first = self.first.min(other.first);
    }
}
