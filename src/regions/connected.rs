//! Labels for all cells of a table.

use rayon::prelude::*;

use super::sets::{join, number};

/// The least number of cells that a thread labels at once: with fewer, waking it takes longer.
const LEAST_BAND: usize = 1 << 16;

/// Which region each cell belongs to.
#[derive(Debug)]
pub(crate) struct Labels {
    /// Per cell its region, counted from the first label; 0 for cells that are no members.
    pub(crate) of: Vec<u32>,
    /// Per region its first cell.
    pub(crate) firsts: Vec<usize>,
}

/// The regions of a table of `count` cells in lines of `length`, connected over edges. `along` tells whether a cell, which is not the first
/// of its line, is joined to the one before it, and `across` whether one, which is not in the first line, is joined to that in the
/// line before. Labels count from `first`.
pub(crate) fn connected(
    count: usize,
    length: usize,
    first: u32,
    is_member: impl Fn(usize) -> bool,
    along: impl Fn(usize) -> bool + Sync,
    across: impl Fn(usize) -> bool + Sync,
) -> Labels {
    let length = length.max(1);
    let least = LEAST_BAND.div_ceil(length) * length;
    let band = if count > least {
        let lines = (count / length).div_ceil(rayon::current_num_threads() * 4);
        least.max(lines * length)
    } else {
        least
    };
    let mut of = joined(count, length, band, along, across);
    let firsts = number(&mut of, first, is_member);
    Labels { of, firsts }
}

/// Per cell of a table the first cell of its region, or one that comes before it and leads there. Bands of so many cells, whole lines, are
/// joined by themselves, in parallel, and then with each other.
fn joined(
    count: usize,
    length: usize,
    band: usize,
    along: impl Fn(usize) -> bool + Sync,
    across: impl Fn(usize) -> bool + Sync,
) -> Vec<u32> {
    let mut parents = vec![0_u32; count];
    if band < count {
        let bands = parents.par_chunks_mut(band).enumerate();
        bands.for_each(|(index, band_parents)| {
            join_band(band_parents, index * band, length, &along, &across);
        });
    } else {
        join_band(&mut parents, 0, length, &along, &across);
    }
    for start in (band..count).step_by(band) {
        for cell in (start..start + length).filter(|cell| across(*cell)) {
            join(&mut parents, cell as u32, (cell - length) as u32);
        }
    }
    parents
}

/// Joins the cells of some lines, of which the first cell is `base`. Each cell's parent becomes an index of the table.
fn join_band(
    parents: &mut [u32],
    base: usize,
    length: usize,
    along: &impl Fn(usize) -> bool,
    across: &impl Fn(usize) -> bool,
) {
    for start in (0..parents.len()).step_by(length) {
        let mut was_above = false;
        for at in start..start + length {
            let cell = base + at;
            let before = at > start && along(cell);
            parents[at] = if before { parents[at - 1] } else { at as u32 };
            let above = start > 0 && across(cell);
            // Usually the pair of cells before has joined the two lines already.
            if above && !(before && was_above && along(cell - length)) {
                join(parents, at as u32, (at - length) as u32);
            }
            was_above = above;
        }
    }
    if base > 0 {
        parents.iter_mut().for_each(|parent| *parent += base as u32);
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    /// The same by filling, one region after the other.
    fn filled(classes: &[u8], length: usize) -> Vec<u32> {
        let mut labels = vec![0; classes.len()];
        let mut count = 0;
        for start in 0..classes.len() {
            if classes[start] == 0 || labels[start] != 0 {
                continue;
            }
            count += 1;
            let mut todo = vec![start];
            while let Some(at) = todo.pop() {
                if classes[at] != classes[start] || labels[at] != 0 {
                    continue;
                }
                labels[at] = count;
                let x = at % length;
                todo.extend((x > 0).then(|| at - 1));
                todo.extend((x + 1 < length).then_some(at + 1));
                todo.extend(at.checked_sub(length));
                todo.extend(Some(at + length).filter(|below| *below < classes.len()));
            }
        }
        labels
    }

    proptest! {
        #[test]
        fn regions_equal_those_of_filling(
            (length, classes) in (1..9_usize, 0..150_usize).prop_flat_map(|(length, lines)| {
                (Just(length), prop::collection::vec(0..3_u8, length * lines))
            })
        ) {
            let is_member = |cell: usize| classes[cell] > 0;
            let along = |cell: usize| classes[cell - 1] == classes[cell];
            let across = |cell: usize| classes[cell - length] == classes[cell];
            let found = connected(classes.len(), length, 1, is_member, along, across);
            prop_assert_eq!(&found.of, &filled(&classes, length));
            for (index, first) in found.firsts.iter().enumerate() {
                let label = index as u32 + 1;
                prop_assert_eq!(found.of.iter().position(|other| *other == label), Some(*first));
            }
            let last = found.of.iter().copied().max().unwrap_or(0);
            prop_assert_eq!(found.firsts.len(), last as usize);
            for lines in [1, 2, 7] {
                let mut of = joined(classes.len(), length, lines * length, along, across);
                prop_assert_eq!(&number(&mut of, 1, is_member), &found.firsts);
                prop_assert_eq!(&of, &found.of);
            }
        }
    }
}
