//! What pairs of regions gain, before order is looked at.

use crate::assignment::most_gainful;

/// What an unmatched region costs.
pub(super) const UNMATCHED: f64 = 1.75;
/// What a pair gains over two unmatched regions if both regions have the same name: more than all other pairs together.
const NAMED: f64 = 1e7;

/// What pairing two regions gains over leaving both unmatched.
#[derive(Debug, Clone)]
pub(super) struct Gains {
    pub(super) rows: usize,
    pub(super) columns: usize,
    /// Row by row; `None` if the two cannot be a pair.
    pub(super) values: Vec<Option<f64>>,
}

impl Gains {
    pub(super) fn get(&self, row: usize, column: usize) -> Option<f64> {
        self.values[row * self.columns + column]
    }

    /// These gains without the rows that have partners already, and those.
    pub(super) fn without(&self, partners: &[Option<usize>]) -> Self {
        let mut rest = self.clone();
        for (row, partner) in partners.iter().enumerate() {
            let Some(taken) = partner else { continue };
            for column in 0..self.columns {
                rest.values[row * self.columns + column] = None;
            }
            for other in 0..self.rows {
                rest.values[other * self.columns + taken] = None;
            }
        }
        rest
    }

    /// The gain of a pair of this cost.
    pub(super) fn of(cost: f64) -> f64 {
        2.0 * UNMATCHED - cost
    }

    /// The gain of a pair that a name makes.
    pub(super) fn of_named(cost: f64) -> f64 {
        NAMED - cost
    }

    /// The partner of each row with the largest sum of gains. Each row can do without.
    pub(super) fn assign(&self) -> Vec<Option<usize>> {
        most_gainful(self.rows, self.columns, |row, column| self.get(row, column))
    }
}
