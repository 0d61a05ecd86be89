//! Labels for a few pixels of a large picture, from runs in rows.

use super::sets::{join, number};

/// Pixels of a row beside each other.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Span {
    /// The row.
    pub(crate) y: u32,
    /// The first column.
    pub(crate) from: u32,
    /// The column after the last one.
    pub(crate) to: u32,
}

impl Span {
    /// A single pixel.
    pub(crate) fn pixel(x: u32, y: u32) -> Self {
        Self {
            y,
            from: x,
            to: x + 1,
        }
    }

    /// Adds the given pixel if it follows the last one. Returns whether it does.
    pub(crate) fn extend(&mut self, x: u32, y: u32) -> bool {
        let is_next = self.y == y && self.to == x;
        self.to += u32::from(is_next);
        is_next
    }
}

/// Per run the number of its region, where regions are connected over edges and corners, and the number of regions. The runs, each with the
/// pixels that `span` tells, are sorted by row and column and do not overlap.
pub(crate) fn connected_runs<R>(runs: &[R], span: impl Fn(&R) -> Span) -> (Vec<u32>, usize) {
    let mut parents: Vec<u32> = (0..runs.len() as u32).collect();
    let mut above = 0;
    for (index, run) in runs.iter().enumerate() {
        let run = span(run);
        // Runs of the row above that touch this one. Runs further left cannot touch later ones.
        loop {
            let other = span(&runs[above]);
            let is_past = other.y + 1 < run.y || (other.y + 1 == run.y && other.to < run.from);
            if !is_past {
                break;
            }
            above += 1;
        }
        let touching = (above..index).take_while(|other| {
            let other = span(&runs[*other]);
            other.y < run.y && other.from <= run.to
        });
        for other in touching {
            join(&mut parents, index as u32, other as u32);
        }
    }
    let count = number(&mut parents, 0, |_| true).len();
    (parents, count)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    /// Per pixel the number of its region from 1, by filling.
    fn filled(rows: &[Vec<bool>]) -> Vec<Vec<u32>> {
        let mut labels: Vec<Vec<u32>> = rows.iter().map(|row| vec![0; row.len()]).collect();
        let mut count = 0;
        for y in 0..rows.len() {
            for x in 0..rows[y].len() {
                if !rows[y][x] || labels[y][x] != 0 {
                    continue;
                }
                count += 1;
                let mut todo = vec![(x, y)];
                while let Some((x, y)) = todo.pop() {
                    if !rows[y][x] || labels[y][x] != 0 {
                        continue;
                    }
                    labels[y][x] = count;
                    let columns = x.saturating_sub(1)..=(x + 1).min(rows[y].len() - 1);
                    let beside = y.saturating_sub(1)..=(y + 1).min(rows.len() - 1);
                    todo.extend(beside.flat_map(|y| columns.clone().map(move |x| (x, y))));
                }
            }
        }
        labels
    }

    proptest! {
        #[test]
        fn regions_equal_those_of_filling(rows in prop::collection::vec(prop::collection::vec(any::<bool>(), 12), 0..12)) {
            let mut runs: Vec<Span> = Vec::new();
            for (y, row) in rows.iter().enumerate() {
                for (x, _) in row.iter().enumerate().filter(|(_, set)| **set) {
                    let (x, y) = (x as u32, y as u32);
                    if !runs.last_mut().is_some_and(|run| run.extend(x, y)) {
                        runs.push(Span::pixel(x, y));
                    }
                }
            }
            let (labels, count) = connected_runs(&runs, |run| *run);
            let expected = filled(&rows);
            let most = expected.iter().flatten().copied().max().unwrap_or(0);
            prop_assert_eq!(count, most as usize);
            for (run, label) in runs.iter().zip(labels) {
                for x in run.from..run.to {
                    prop_assert_eq!(expected[run.y as usize][x as usize], label + 1);
                }
            }
        }
    }
}
