//! Improves an assignment where neighbours changed order.
//!
//! Left and right eyes that look alike differ in their order only. Order concerns two pairs at once, which an assignment cannot
//! count; so single moves and swaps come after it.

use glam::DVec2;

use super::gains::Gains;
use crate::scene::ViewId;

/// What two pairs cost whose order differs.
const DISORDER: f64 = 0.5;
/// Distances from which a difference counts fully, and below which it does not count, heights.
const FULL: f64 = 0.05;
const NONE: f64 = 0.01;
/// The largest number of moves.
const MOVES: usize = 6;
/// An improvement below this is none.
const LEAST: f64 = 1e-9;

/// The regions that are being matched: rows of one or more views, columns of another view.
pub(super) struct Sides<'a> {
    pub(super) gains: &'a Gains,
    /// The view of each row's region, and where the region should come to lie in the columns' view.
    pub(super) rows: &'a [(ViewId, DVec2)],
    /// Where each column's region is drawn.
    pub(super) columns: &'a [DVec2],
}

/// A change of up to two rows' partners.
type Change = [Option<(usize, Option<usize>)>; 2];

/// Applies the best moves and swaps of partners until none improves the sum of gains less disorder, at most 6.
pub(super) fn exchange(sides: &Sides, partners: &mut [Option<usize>]) {
    let mut state = State::new(sides, partners);
    for _ in 0..MOVES {
        let Some(change) = state.best_change() else {
            return;
        };
        state.apply(change);
    }
}

struct State<'a> {
    sides: &'a Sides<'a>,
    partners: &'a mut [Option<usize>],
    /// The disorder that each possible pair would have with the partners of all other rows, row by row.
    disorder: Vec<f64>,
}

impl<'a> State<'a> {
    fn new(sides: &'a Sides, partners: &'a mut [Option<usize>]) -> Self {
        let mut state = Self {
            sides,
            disorder: vec![0.0; partners.len() * sides.columns.len()],
            partners,
        };
        for row in 0..state.partners.len() {
            state.count(row, 1.0);
        }
        state
    }

    /// Adds what all pairs have to do with a row's present one.
    fn count(&mut self, row: usize, times: f64) {
        let Some(column) = self.partners[row] else {
            return;
        };
        let columns = self.sides.columns.len();
        for (other, sums) in self.disorder.chunks_exact_mut(columns).enumerate() {
            // The two could not exchange their partners.
            if other == row || !self.sides.fits(other, column) {
                continue;
            }
            for (new, sum) in sums.iter_mut().enumerate() {
                *sum += times * self.sides.between((row, column), (other, new));
            }
        }
    }

    fn apply(&mut self, change: Change) {
        for (row, _) in change.into_iter().flatten() {
            self.count(row, -1.0);
        }
        for (row, partner) in change.into_iter().flatten() {
            self.partners[row] = partner;
        }
        for (row, _) in change.into_iter().flatten() {
            self.count(row, 1.0);
        }
    }

    fn best_change(&self) -> Option<Change> {
        let mut owner = vec![None; self.sides.columns.len()];
        for (row, column) in self.partners.iter().enumerate() {
            if let Some(column) = column {
                owner[*column] = Some(row);
            }
        }
        let (mut best, mut best_gain) = (None, LEAST);
        for (row, &own) in self.partners.iter().enumerate() {
            let others = (0..owner.len()).map(Some).chain([None]);
            for column in others.filter(|c| *c != own) {
                let other = column.and_then(|c| owner[c]);
                let change = [Some((row, column)), other.map(|other| (other, own))];
                if let Some(gain) = self.gain(change)
                    && gain > best_gain
                {
                    (best, best_gain) = (Some(change), gain);
                }
            }
        }
        best
    }

    /// What a change gains; `None` if it makes a pair that cannot be.
    fn gain(&self, change: Change) -> Option<f64> {
        let mut gain = 0.0;
        for (row, partner) in change.into_iter().flatten() {
            gain += self.worth(row, partner)? - self.worth(row, self.partners[row])?;
        }
        if let [Some((a, new_a)), Some((b, new_b))] = change {
            // The disorder of the two with each other was counted twice before, and not at all after.
            let both = |a: (usize, Option<usize>), b: (usize, Option<usize>)| {
                let (Some(partner_a), Some(partner_b)) = (a.1, b.1) else {
                    return 0.0;
                };
                self.sides.between((a.0, partner_a), (b.0, partner_b))
            };
            gain -= both((a, self.partners[a]), (b, self.partners[b]));
            gain -= both((a, new_a), (b, new_b));
        }
        Some(gain)
    }

    /// The gain of a pair less its disorder with the present others.
    fn worth(&self, row: usize, column: Option<usize>) -> Option<f64> {
        let Some(column) = column else {
            return Some(0.0);
        };
        let gain = self.sides.gains.get(row, column)?;
        Some(gain - self.disorder[row * self.sides.columns.len() + column])
    }
}

impl Sides<'_> {
    /// Whether two regions are alike enough to be a pair.
    fn fits(&self, row: usize, column: usize) -> bool {
        self.gains.get(row, column).is_some_and(|gain| gain > 0.0)
    }

    /// The disorder of two pairs that could exchange their partners, both rows being of one view.
    pub(super) fn between(&self, a: (usize, usize), b: (usize, usize)) -> f64 {
        let ((view_a, at_a), (view_b, at_b)) = (self.rows[a.0], self.rows[b.0]);
        if view_a != view_b || !self.fits(a.0, b.1) || !self.fits(b.0, a.1) {
            return 0.0;
        }
        let (from, to) = (at_a - at_b, self.columns[a.1] - self.columns[b.1]);
        let axis = |from: f64, to: f64| {
            let least = from.abs().min(to.abs());
            if from * to < 0.0 && least > NONE {
                DISORDER * (least / FULL).min(1.0)
            } else {
                0.0
            }
        };
        axis(from.x, to.x) + axis(from.y, to.y)
    }
}
