//! How far the cells of a grid are from others.

/// Per cell of a grid, row by row, the square of its distance from the nearest cell that is not inside; 0 for these. Without any, all are
/// farther than the grid is large.
///
/// Source: Felzenszwalb & Huttenlocher, *Distance transforms of sampled functions* (2012).
pub(crate) fn squared_distances(inside: &[bool], columns: usize) -> Vec<f64> {
    let rows = inside.len() / columns.max(1);
    let far = (columns + rows).pow(2) as f64;
    let square = inside.iter().map(|inside| if *inside { far } else { 0.0 });
    let mut squares: Vec<f64> = square.collect();
    let mut transform = Transform::default();
    for column in 0..columns {
        transform.apply(&mut squares[column..], columns, rows);
    }
    for row in squares.chunks_exact_mut(columns) {
        transform.apply(row, 1, columns);
    }
    squares
}

/// The distance transform of a row, with its memory.
#[derive(Default)]
struct Transform {
    values: Vec<f64>,
    /// The parabolas of the lower envelope: their places, and where each begins to be the lowest.
    envelope: Vec<(usize, f64)>,
}

impl Transform {
    /// Replaces f(p) by the least (p − q)² + f(q), for `count` values that are `stride` apart.
    fn apply(&mut self, row: &mut [f64], stride: usize, count: usize) {
        let Self { values, envelope } = self;
        values.clear();
        values.extend(row.iter().step_by(stride).take(count));
        envelope.clear();
        let height = |at: usize| values[at] + (at * at) as f64;
        for at in 0..count {
            let mut from = f64::NEG_INFINITY;
            while let Some(&(last, begin)) = envelope.last() {
                from = (height(at) - height(last)) / (2 * (at - last)) as f64;
                if from > begin {
                    break;
                }
                envelope.pop();
                from = f64::NEG_INFINITY;
            }
            envelope.push((at, from));
        }
        let mut lowest = 0;
        for (at, value) in row.iter_mut().step_by(stride).take(count).enumerate() {
            while envelope
                .get(lowest + 1)
                .is_some_and(|(_, from)| *from < at as f64)
            {
                lowest += 1;
            }
            let (place, _) = envelope[lowest];
            *value = (at as f64 - place as f64).powi(2) + values[place];
        }
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn the_nearest_cell_is_found(
            columns in 1..9_usize,
            cells in prop::collection::vec(prop::bool::weighted(0.8), 1..70),
        ) {
            let rows = cells.len().div_ceil(columns);
            let mut inside = cells;
            inside.resize(rows * columns, false);
            inside[0] = false;
            let found = squared_distances(&inside, columns);
            for (at, square) in found.iter().enumerate() {
                let outside = (0..inside.len()).filter(|other| !inside[*other]);
                let squares = outside.map(|other| {
                    let apart = |of: fn(usize, usize) -> usize| of(at, columns).abs_diff(of(other, columns)).pow(2);
                    apart(|at, columns| at / columns) + apart(|at, columns| at % columns)
                });
                prop_assert_eq!(*square, squares.min().unwrap() as f64);
            }
        }
    }
}
