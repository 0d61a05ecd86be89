//! The cells of a grid over a drawing that a shape covers: what lies on what is a matter of counting them.

use glam::DVec2;

/// Cells on the longer side of the grid: an eye of a figure covers a few.
pub(crate) const SIDE: usize = 256;
const WORDS: usize = SIDE / 64;

/// A rectangle of cells: first and last column and row, rows counted downwards.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Box2 {
    pub(super) low: DVec2,
    pub(super) high: DVec2,
}

impl Box2 {
    pub(super) fn size(self) -> DVec2 {
        self.high - self.low
    }

    pub(super) fn middle(self) -> DVec2 {
        self.low.midpoint(self.high)
    }

    pub(super) fn around(self, other: Self) -> Self {
        Self {
            low: self.low.min(other.low),
            high: self.high.max(other.high),
        }
    }
}

/// Covered cells.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Mask {
    bits: Vec<u64>,
}

/// A connected piece of a mask.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Island {
    pub(super) cells: usize,
    pub(super) bounds: Box2,
}

impl Mask {
    /// The cells whose centres lie in an outline: closed rings, filled by the even-odd rule, in units of cells.
    pub(crate) fn of_rings<'a>(rings: impl Iterator<Item = &'a [DVec2]>) -> Self {
        let mut crossings: Vec<Vec<f64>> = vec![Vec::new(); SIDE];
        for ring in rings {
            let Some(mut a) = ring.last().copied() else {
                continue;
            };
            for &b in ring {
                let (top, bottom) = if a.y < b.y { (a, b) } else { (b, a) };
                let first = (top.y - 0.5).ceil().max(0.0) as usize;
                let end = (bottom.y - 0.5).ceil().clamp(0.0, SIDE as f64) as usize;
                for (row, at) in crossings.iter_mut().enumerate().take(end).skip(first) {
                    let share = (row as f64 + 0.5 - top.y) / (bottom.y - top.y);
                    at.push(top.x + share * (bottom.x - top.x));
                }
                a = b;
            }
        }
        let mut mask = Self::empty();
        for (row, at) in crossings.iter_mut().enumerate() {
            at.sort_by(f64::total_cmp);
            for pair in at.chunks_exact(2) {
                let first = (pair[0] - 0.5).ceil().max(0.0) as usize;
                let end = (pair[1] - 0.5).ceil().clamp(0.0, SIDE as f64) as usize;
                for column in first..end {
                    mask.set(row, column);
                }
            }
        }
        mask
    }

    pub(crate) fn empty() -> Self {
        Self {
            bits: vec![0; SIDE * WORDS],
        }
    }

    fn set(&mut self, row: usize, column: usize) {
        self.bits[row * WORDS + column / 64] |= 1 << (column % 64);
    }

    fn has(&self, row: usize, column: usize) -> bool {
        self.bits[row * WORDS + column / 64] >> (column % 64) & 1 == 1
    }

    /// Whether a place, in cells, is covered.
    pub(super) fn covers(&self, at: DVec2) -> bool {
        let inside = at.cmpge(DVec2::ZERO).all() && at.cmplt(DVec2::splat(SIDE as f64)).all();
        inside && self.has(at.y as usize, at.x as usize)
    }

    /// The number of covered cells.
    pub(crate) fn count(&self) -> usize {
        self.bits
            .iter()
            .map(|word| word.count_ones() as usize)
            .sum()
    }

    /// The number of cells that both cover.
    pub(super) fn shared(&self, other: &Self) -> usize {
        let both = self.bits.iter().zip(&other.bits);
        both.map(|(a, b)| (a & b).count_ones() as usize).sum()
    }

    /// Adds the cells of another mask.
    pub(crate) fn add(&mut self, other: &Self) {
        self.bits
            .iter_mut()
            .zip(&other.bits)
            .for_each(|(a, b)| *a |= b);
    }

    /// Takes the cells of another mask away.
    pub(super) fn remove(&mut self, other: &Self) {
        self.bits
            .iter_mut()
            .zip(&other.bits)
            .for_each(|(a, b)| *a &= !b);
    }

    /// Whether both cover neighbouring cells, or the same.
    pub(super) fn touches(&self, other: &Self) -> bool {
        let row_of = |mask: &Self, row: usize| -> [u64; WORDS] {
            std::array::from_fn(|word| mask.bits[row * WORDS + word])
        };
        let wide = |bits: [u64; WORDS]| -> [u64; WORDS] {
            std::array::from_fn(|word| {
                let before = if word > 0 { bits[word - 1] >> 63 } else { 0 };
                let after = bits.get(word + 1).map_or(0, |next| next << 63);
                bits[word] | bits[word] << 1 | bits[word] >> 1 | before | after
            })
        };
        (0..SIDE).any(|row| {
            let own = wide(row_of(self, row));
            (row.saturating_sub(1)..=(row + 1).min(SIDE - 1)).any(|near| {
                let theirs = row_of(other, near);
                own.iter().zip(theirs).any(|(a, b)| a & b != 0)
            })
        })
    }

    /// The lowest covered row, counted downwards.
    pub(crate) fn lowest(&self) -> Option<usize> {
        (0..SIDE).rev().find(|row| self.span(*row).is_some())
    }

    /// The left and the right end of what it covers just above its lowest row.
    pub(super) fn standing(&self) -> [f64; 2] {
        let row = self.lowest().unwrap_or(0).saturating_sub(2);
        let (first, last) = self.span(row).unwrap_or((0, 0));
        [first as f64, (last + 1) as f64]
    }

    /// How wide it is just above its lowest row, as a share of its whole width.
    pub(crate) fn foot(&self) -> f64 {
        let width = |row: usize| self.span(row).map_or(0, |(first, last)| last + 1 - first);
        let lowest = self.lowest().unwrap_or(0);
        let widest = (0..SIDE).map(width).max().unwrap_or(0).max(1);
        width(lowest.saturating_sub(2)) as f64 / widest as f64
    }

    /// The box around all covered cells.
    pub(super) fn bounds(&self) -> Option<Box2> {
        let rows = 0..SIDE;
        let mut found: Option<Box2> = None;
        for row in rows {
            let Some(span) = self.span(row) else { continue };
            let own = Box2 {
                low: DVec2::new(span.0 as f64, row as f64),
                high: DVec2::new(span.1 as f64 + 1.0, row as f64 + 1.0),
            };
            found = Some(found.map_or(own, |found| found.around(own)));
        }
        found
    }

    /// The first and the last covered column of a row.
    fn span(&self, row: usize) -> Option<(usize, usize)> {
        let mut columns = (0..SIDE).filter(|column| self.has(row, *column));
        let first = columns.next()?;
        Some((first, columns.next_back().unwrap_or(first)))
    }

    /// The share of a box that lies between the first and the last covered cell of each of its rows: holes count as filled.
    pub(super) fn fullness(&self, bounds: Box2) -> f64 {
        let rows = bounds.low.y as usize..(bounds.high.y as usize).min(SIDE);
        let within = |row: usize| {
            let columns = bounds.low.x as usize..(bounds.high.x as usize).min(SIDE);
            let mut covered = columns.filter(|column| self.has(row, *column));
            let first = covered.next()?;
            Some(covered.next_back().unwrap_or(first) - first + 1)
        };
        let filled: usize = rows.filter_map(within).sum();
        let all = bounds.size().element_product();
        if all > 0.0 { filled as f64 / all } else { 0.0 }
    }

    /// What it covers from a row on downwards.
    pub(super) fn below(&self, row: usize) -> Self {
        let mut below = self.clone();
        below.bits[..row.min(SIDE) * WORDS].fill(0);
        below
    }

    /// The connected pieces, the largest first.
    pub(super) fn islands(&self) -> Vec<Island> {
        let mut left = self.clone();
        let mut found = Vec::new();
        for row in 0..SIDE {
            for column in 0..SIDE {
                if left.has(row, column) {
                    found.push(left.take_island(row, column));
                }
            }
        }
        found.sort_by_key(|island: &Island| std::cmp::Reverse(island.cells));
        found
    }

    fn take_island(&mut self, row: usize, column: usize) -> Island {
        let mut cells = 0;
        let at = DVec2::new(column as f64, row as f64);
        let mut bounds = Box2 {
            low: at,
            high: at + DVec2::ONE,
        };
        let mut waiting = vec![(row, column)];
        while let Some((row, column)) = waiting.pop() {
            if !self.has(row, column) {
                continue;
            }
            self.bits[row * WORDS + column / 64] &= !(1 << (column % 64));
            cells += 1;
            let at = DVec2::new(column as f64, row as f64);
            bounds.low = bounds.low.min(at);
            bounds.high = bounds.high.max(at + DVec2::ONE);
            for row in row.saturating_sub(1)..=(row + 1).min(SIDE - 1) {
                for column in column.saturating_sub(1)..=(column + 1).min(SIDE - 1) {
                    if self.has(row, column) {
                        waiting.push((row, column));
                    }
                }
            }
        }
        Island { cells, bounds }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square(low: f64, high: f64) -> Vec<DVec2> {
        vec![
            DVec2::new(low, low),
            DVec2::new(high, low),
            DVec2::new(high, high),
            DVec2::new(low, high),
        ]
    }

    #[test]
    fn cells_are_counted_and_pieces_told_apart() {
        let rings = [square(10.0, 20.0), square(30.0, 34.0), square(12.0, 14.0)];
        let mask = Mask::of_rings(rings.iter().map(Vec::as_slice));
        // The third ring is a hole in the first.
        assert_eq!(mask.count(), 100 - 4 + 16);
        let islands = mask.islands();
        let cells: Vec<usize> = islands.iter().map(|island| island.cells).collect();
        assert_eq!(cells, [96, 16]);
        assert_eq!(mask.fullness(islands[0].bounds), 1.0);
        let other = Mask::of_rings([square(15.0, 40.0)].iter().map(Vec::as_slice));
        assert_eq!(mask.shared(&other), 25 + 16);
        let beside = |low: f64| Mask::of_rings([square(low, low + 1.0)].iter().map(Vec::as_slice));
        assert!(beside(63.0).touches(&beside(64.0)) && !beside(62.0).touches(&beside(64.0)));
    }

    #[test]
    fn what_lies_outside_of_the_grid_is_left_out() {
        let rings = [square(-50.0, 1000.0)];
        let mask = Mask::of_rings(rings.iter().map(Vec::as_slice));
        assert_eq!(mask.count(), SIDE * SIDE);
        assert!(!mask.covers(DVec2::splat(-1.0)));
    }
}
