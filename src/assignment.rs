//! One-to-one assignment of rows to columns at the least total cost, or with the largest total gain.
//!
//! Successive shortest augmenting paths with potentials (Jonker & Volgenant 1987), over the columns that each row can have: a few, or
//! all of them. Rows are assigned in their order. Among paths of equal length the one to the first column wins, so that ties give
//! the same result everywhere.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// Steps per unit of gain: sums of whole numbers are exact, so that equal totals are ties.
const STEPS: f64 = 1e6;

/// Which row has which column.
#[derive(Debug, Clone)]
pub(crate) struct Assignment {
    /// Per row its column.
    pub(crate) column_of: Vec<Option<usize>>,
    /// Per column its row.
    pub(crate) row_of: Vec<Option<usize>>,
}

/// Assigns columns to rows, one to one, at the least total cost. `candidates` are the columns that a row can have, each with its cost,
/// which is not negative; a row that stays alone costs `alone`.
pub(crate) fn cheapest<C: Iterator<Item = (usize, f64)>>(
    rows: usize,
    columns: usize,
    alone: f64,
    candidates: impl Fn(usize) -> C,
) -> Assignment {
    let mut search = Search {
        candidates,
        alone,
        row_potential: vec![0.0; rows],
        column_potential: vec![0.0; columns],
        found: Assignment {
            column_of: vec![None; rows],
            row_of: vec![None; columns],
        },
        reached: vec![f64::INFINITY; columns],
        from: vec![usize::MAX; columns],
        settled: vec![false; columns],
    };
    (0..rows).for_each(|row| search.augment(row));
    search.found
}

/// The column of each row, one to one, with the largest sum of gains. Rows and columns can stay alone, and two without a gain, or
/// with one that is not positive, do so.
pub(crate) fn most_gainful(
    rows: usize,
    columns: usize,
    gain: impl Fn(usize, usize) -> Option<f64>,
) -> Vec<Option<usize>> {
    let gain = |row: usize, column: usize| gain(row, column).filter(|gain| *gain > 0.0);
    // A pair that gains nothing is none, so that no further columns are needed for rows that stay alone.
    let width = columns.max(rows);
    let mut costs = vec![0.0; rows * width];
    for row in 0..rows {
        for column in 0..columns {
            costs[row * width + column] = -(gain(row, column).unwrap_or(0.0) * STEPS).trunc();
        }
    }
    // Costs are not negative.
    let most = costs.iter().copied().fold(0.0, f64::min);
    costs.iter_mut().for_each(|cost| *cost -= most);
    let found = cheapest(rows, width, f64::INFINITY, |row| {
        let costs = &costs[row * width..(row + 1) * width];
        costs.iter().copied().enumerate()
    });
    let is_pair = |row: usize, column: &usize| *column < columns && gain(row, *column).is_some();
    let column_of = found.column_of.into_iter().enumerate();
    column_of
        .map(|(row, column)| column.filter(|column| is_pair(row, column)))
        .collect()
}

/// A length in a heap, smallest first; ties go to the earlier column.
struct Step(f64, usize);

impl PartialEq for Step {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for Step {}

impl PartialOrd for Step {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Step {
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        self.0.total_cmp(&other.0).then(self.1.cmp(&other.1))
    }
}

struct Search<F> {
    candidates: F,
    alone: f64,
    row_potential: Vec<f64>,
    column_potential: Vec<f64>,
    found: Assignment,
    /// Per column the length of the shortest path to it, the row before it on the path, and whether the length is final.
    reached: Vec<f64>,
    from: Vec<usize>,
    settled: Vec<bool>,
}

impl<C: Iterator<Item = (usize, f64)>, F: Fn(usize) -> C> Search<F> {
    /// Gives a row a column along a shortest path, on which other rows change theirs.
    fn augment(&mut self, first: usize) {
        let mut heap: BinaryHeap<Reverse<Step>> = BinaryHeap::new();
        let mut touched: Vec<usize> = Vec::new();
        // Rows on the paths, each with the length of the path to it.
        let mut rows: Vec<(usize, f64)> = vec![(first, 0.0)];
        // The path that ends by leaving a row alone.
        let (mut shortest, mut left_out) = (f64::INFINITY, first);
        let mut end = None;
        // No path that is longer than a complete one is followed.
        let mut bound = f64::INFINITY;
        let mut next = 0;
        loop {
            while next < rows.len() {
                let (row, length) = rows[next];
                next += 1;
                let alone = length + self.alone - self.row_potential[row];
                if alone < shortest {
                    (shortest, left_out) = (alone, row);
                    bound = bound.min(shortest);
                }
                for (column, cost) in (self.candidates)(row) {
                    let reduced = cost - self.row_potential[row] - self.column_potential[column];
                    let length = length + reduced.max(0.0);
                    let is_shorter = length < self.reached[column] && length <= bound;
                    if is_shorter && !self.settled[column] {
                        if self.found.row_of[column].is_none() {
                            bound = length;
                        }
                        if self.reached[column] == f64::INFINITY {
                            touched.push(column);
                        }
                        self.reached[column] = length;
                        self.from[column] = row;
                        heap.push(Reverse(Step(length, column)));
                    }
                }
            }
            let Some(Reverse(Step(length, column))) = heap.pop() else {
                break;
            };
            if self.settled[column] || length > self.reached[column] {
                continue;
            }
            if length >= shortest {
                break;
            }
            self.settled[column] = true;
            match self.found.row_of[column] {
                None => {
                    (shortest, end) = (length, Some(column));
                    break;
                }
                Some(row) => rows.push((row, length)),
            }
        }
        for &(row, length) in &rows {
            self.row_potential[row] += shortest - length;
        }
        for column in touched {
            if self.settled[column] && self.reached[column] < shortest {
                self.column_potential[column] -= shortest - self.reached[column];
            }
            self.settled[column] = false;
            self.reached[column] = f64::INFINITY;
        }
        let mut free = match end {
            Some(column) => Some(column),
            None if left_out == first => None,
            None => self.found.column_of[left_out].take(),
        };
        while let Some(column) = free {
            let row = self.from[column];
            self.found.row_of[column] = Some(row);
            free = self.found.column_of[row].replace(column);
            if row == first {
                break;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    const ALONE: f64 = 1e7;

    /// The least total over all ways to give each row a column of its own or none; `cost` is infinite for what cannot be a pair.
    fn least(costs: &[Vec<f64>], alone: f64, taken: &mut Vec<bool>) -> f64 {
        let Some((first, rest)) = costs.split_first() else {
            return 0.0;
        };
        let mut best = alone + least(rest, alone, taken);
        for column in 0..taken.len() {
            if !taken[column] {
                taken[column] = true;
                best = best.min(first[column] + least(rest, alone, taken));
                taken[column] = false;
            }
        }
        best
    }

    /// Rows of small whole numbers, which make ties common.
    fn tables(range: std::ops::Range<i32>) -> impl Strategy<Value = (usize, Vec<Vec<f64>>)> {
        (1..6_usize).prop_flat_map(move |columns| {
            let row = prop::collection::vec(range.clone().prop_map(f64::from), columns);
            (Just(columns), prop::collection::vec(row, 0..6))
        })
    }

    proptest! {
        #[test]
        fn the_total_is_the_least((columns, costs) in tables(0..9)) {
            let found = cheapest(costs.len(), columns, ALONE, |row| costs[row].iter().copied().enumerate());
            let cost = |(row, column): (usize, &Option<usize>)| column.map_or(ALONE, |column| costs[row][column]);
            let total: f64 = found.column_of.iter().enumerate().map(cost).sum();
            prop_assert_eq!(total, least(&costs, ALONE, &mut vec![false; columns]));
            for (row, column) in found.column_of.iter().enumerate() {
                if let Some(column) = column {
                    prop_assert_eq!(found.row_of[*column], Some(row));
                }
            }
            let pairs = found.column_of.iter().flatten().count();
            prop_assert_eq!(found.row_of.iter().flatten().count(), pairs);
            prop_assert_eq!(pairs, costs.len().min(columns));
        }

        #[test]
        fn the_gain_is_the_largest((columns, gains) in tables(-3..6)) {
            // The least number stands for what cannot be a pair.
            let gain = |row: usize, column: usize| Some(gains[row][column]).filter(|gain| *gain > -3.0);
            let found = most_gainful(gains.len(), columns, gain);
            let pairs: Vec<(usize, usize)> = found.iter().enumerate().filter_map(|(row, column)| Some((row, (*column)?))).collect();
            let total: f64 = pairs.iter().map(|(row, column)| gains[*row][*column]).sum();
            let costs: Vec<Vec<f64>> = gains.iter().map(|row| row.iter().map(|gain| -gain).collect()).collect();
            prop_assert_eq!(total, -least(&costs, 0.0, &mut vec![false; columns]));
            prop_assert!(pairs.iter().all(|(row, column)| gains[*row][*column] > 0.0));
            let mut columns: Vec<usize> = pairs.iter().map(|(_, column)| *column).collect();
            columns.sort_unstable();
            columns.dedup();
            prop_assert_eq!(columns.len(), pairs.len());
        }
    }

    fn assign<const ROWS: usize, const COLUMNS: usize>(
        gains: [[f64; COLUMNS]; ROWS],
    ) -> [Option<usize>; ROWS] {
        let found = most_gainful(ROWS, COLUMNS, |row, column| Some(gains[row][column]));
        found.try_into().unwrap()
    }

    #[test]
    fn ties_go_to_the_first_columns() {
        assert_eq!(assign([[1.0; 3]; 3]), [Some(0), Some(1), Some(2)]);
        assert_eq!(assign([[1.0; 2]; 3]), [Some(0), Some(1), None]);
        assert_eq!(assign([[1.0; 5]; 2]), [Some(0), Some(1)]);
        assert_eq!(assign([[1.0, 2.0]; 3]), [Some(1), Some(0), None]);
        assert_eq!(assign([[2.0, 2.0, 1.0]; 3]), [Some(0), Some(1), Some(2)]);
        let some_tied = [[0.0, 0.0, 3.0], [1.0, 1.0, 3.0], [0.0, 2.0, 3.0]];
        assert_eq!(assign(some_tied), [Some(2), Some(0), Some(1)]);
        assert_eq!(assign::<0, 0>([]), []);
    }
}
