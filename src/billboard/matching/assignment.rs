//! The best one-to-one assignment, before order is looked at.

use pathfinding::prelude::{Matrix, kuhn_munkres};

/// What an unmatched region costs.
pub(super) const UNMATCHED: f64 = 1.75;
/// What a pair gains over two unmatched regions if both regions have the same name: more than all other pairs together.
const NAMED: f64 = 1e7;
/// Steps per unit of gain; `kuhn_munkres` wants integers.
const STEPS: f64 = 1e6;

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

    /// The gain of a pair of this cost.
    pub(super) fn of(cost: f64) -> f64 {
        2.0 * UNMATCHED - cost
    }

    /// The gain of a pair that a name makes.
    pub(super) fn of_named(cost: f64) -> f64 {
        NAMED - cost
    }
}

/// The partner of each row with the largest sum of gains (Hungarian algorithm). Each row can do without.
pub(super) fn assign(gains: &Gains) -> Vec<Option<usize>> {
    let rows = gains.rows;
    // A pair that gains nothing is none, so that no further columns are needed for rows that stay alone.
    let columns = gains.columns.max(rows);
    let weight = |(row, column): (usize, usize)| {
        let gain = if column < gains.columns {
            gains.get(row, column)
        } else {
            None
        };
        gain.map_or(0, |gain| ((gain * STEPS) as i64).max(0))
    };
    if rows == 0 {
        return Vec::new();
    }
    let weights = Matrix::from_fn(rows, columns, weight);
    let (_, partners) = kuhn_munkres(&weights);
    let partner = |(row, column): (usize, usize)| {
        let gain = (column < gains.columns).then(|| gains.get(row, column));
        gain.flatten().filter(|g| *g > 0.0).map(|_| column)
    };
    partners.into_iter().enumerate().map(partner).collect()
}
