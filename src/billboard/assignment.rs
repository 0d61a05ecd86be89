//! One-to-one assignment of rows to columns.

use pathfinding::prelude::{Matrix, kuhn_munkres};

/// Steps per unit of gain; `kuhn_munkres` wants integers.
const STEPS: f64 = 1e6;

/// The column of each row, one to one, with the largest sum of gains (Hungarian algorithm). Rows and columns can stay alone, and two
/// without a gain, or with one that is not positive, do so.
pub(super) fn assign(
    rows: usize,
    columns: usize,
    gain: impl Fn(usize, usize) -> Option<f64>,
) -> Vec<Option<usize>> {
    if rows == 0 {
        return Vec::new();
    }
    let gain = |row: usize, column: usize| match column < columns {
        true => gain(row, column).filter(|gain| *gain > 0.0),
        false => None,
    };
    // A pair that gains nothing is none, so that no further columns are needed for rows that stay alone.
    let weights = Matrix::from_fn(rows, columns.max(rows), |(row, column)| {
        gain(row, column).map_or(0, |gain| (gain * STEPS) as i64)
    });
    let (_, partners) = kuhn_munkres(&weights);
    let partner = |(row, column)| gain(row, column).map(|_| column);
    partners.into_iter().enumerate().map(partner).collect()
}
