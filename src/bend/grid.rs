//! The inside of an outline on a grid: how far its cells are from the border, and ways through them.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use glam::DVec2;

use crate::geometry::{Outline, area, bounds, perimeter, squared_distances};

/// About as many cells lie side by side across a slender outline …
const ACROSS: f64 = 14.0;
/// … unless more than this would cover its bounding box.
const MAX_CELLS: f64 = 9000.0;
/// The most cells along one side.
const MAX_SIDE: f64 = 600.0;
/// How strongly the way prefers the middle: the cost of a step is divided by this power of the distance from the border.
const MIDDLE: i32 = 3;

/// Squares in rows.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Cells {
    low: DVec2,
    side: f64,
    columns: usize,
    rows: usize,
}

impl Cells {
    /// The middle of a cell.
    fn middle(&self, cell: usize) -> DVec2 {
        let at = DVec2::new(
            (cell % self.columns) as f64 + 0.5,
            (cell / self.columns) as f64 + 0.5,
        );
        self.low + at * self.side
    }

    /// The cell at a point, or the nearest one.
    pub(super) fn cell_at(&self, point: DVec2) -> usize {
        let [column, row] = ((point - self.low) / self.side).to_array();
        let within = |at: f64, count: usize| (at.max(0.0) as usize).min(count - 1);
        within(row, self.rows) * self.columns + within(column, self.columns)
    }
}

/// The cells inside an outline.
pub(super) struct Grid {
    pub(super) cells: Cells,
    /// Per cell how far its middle is from the nearest cell outside, in cells; 0 outside.
    depths: Vec<f64>,
}

impl Grid {
    /// The largest piece of an outline; `None` if it has no area.
    pub(super) fn new(outline: &Outline) -> Option<Self> {
        let (low, high) = bounds(outline)?;
        let size = high - low;
        // Of a strip, whose ends count for little.
        let width = 2.0 * area(outline) / perimeter(outline);
        let cell = (width / ACROSS)
            .max((size.x * size.y / MAX_CELLS).sqrt())
            .max(size.max_element() / MAX_SIDE);
        if !(cell > 0.0 && cell.is_finite()) {
            return None;
        }
        // A border of cells outside.
        let [columns, rows] = (size / cell).to_array().map(|cells| cells as usize + 3);
        // What is symmetric has symmetric cells.
        let half = DVec2::new(columns as f64, rows as f64) / 2.0;
        let mut grid = Self {
            cells: Cells {
                low: low.midpoint(high) - half * cell,
                side: cell,
                columns,
                rows,
            },
            depths: Vec::new(),
        };
        let mut inside = grid.filled(outline);
        grid.keep_largest(&mut inside);
        if !inside.contains(&true) {
            return None;
        }
        grid.depths = grid.distances(&inside);
        Some(grid)
    }

    /// The middle of a cell.
    pub(super) fn place(&self, cell: usize) -> DVec2 {
        self.cells.middle(cell)
    }

    /// All cells.
    pub(super) fn all_cells(&self) -> std::ops::Range<usize> {
        0..self.depths.len()
    }

    /// Whether a cell is inside.
    pub(super) fn is_inside(&self, cell: usize) -> bool {
        self.depths[cell] > 0.0
    }

    /// The cells inside.
    pub(super) fn inside_cells(&self) -> impl Iterator<Item = usize> + '_ {
        (0..self.depths.len()).filter(|cell| self.depths[*cell] > 0.0)
    }

    /// The area of all cells inside.
    pub(super) fn area(&self) -> f64 {
        self.inside_cells().count() as f64 * self.cells.side.powi(2)
    }

    /// The cell inside that is nearest to a point.
    pub(super) fn nearest(&self, point: DVec2) -> Option<usize> {
        let distance = |cell: &usize| self.place(*cell).distance_squared(point);
        self.inside_cells()
            .min_by(|a, b| distance(a).total_cmp(&distance(b)))
    }

    /// The cell that is farthest from another one on the way inside.
    ///
    /// Steps to the eight cells around have whole lengths of about the same proportions as their own, so that cells can wait in one list
    /// for each distance (Dial's algorithm).
    pub(super) fn farthest(&self, from: usize) -> usize {
        const BESIDE: usize = 5;
        const ACROSS: usize = 7;
        const LISTS: usize = ACROSS + 1;

        let mut distances = vec![usize::MAX; self.depths.len()];
        let mut lists: [Vec<usize>; LISTS] = Default::default();
        distances[from] = 0;
        lists[0].push(from);
        let (mut distance, mut waiting, mut farthest) = (0, 1, from);
        while waiting > 0 {
            while let Some(cell) = lists[distance % LISTS].pop() {
                waiting -= 1;
                if distances[cell] != distance {
                    continue;
                }
                farthest = cell;
                for (next, length) in self.around(cell) {
                    let step = if length > 1.0 { ACROSS } else { BESIDE };
                    if self.depths[next] > 0.0 && distance + step < distances[next] {
                        distances[next] = distance + step;
                        lists[(distance + step) % LISTS].push(next);
                        waiting += 1;
                    }
                }
            }
            distance += 1;
        }
        farthest
    }

    /// The way from one cell to another that keeps to the middle: a step costs its length times the mean of what its ends cost.
    pub(super) fn middle_way(&self, from: usize, to: usize) -> Vec<usize> {
        let cost = |depth: &f64| {
            if *depth > 0.0 {
                depth.powi(-MIDDLE)
            } else {
                0.0
            }
        };
        let costs: Vec<f64> = self.depths.iter().map(cost).collect();
        let mut spent = vec![f64::INFINITY; costs.len()];
        // Per cell the next one on the way to the end.
        let mut before = vec![None; costs.len()];
        let mut queue = BinaryHeap::from([Reverse((Cost(0.0), to))]);
        spent[to] = 0.0;
        while let Some(Reverse((Cost(own), cell))) = queue.pop() {
            // All further ones are more expensive.
            if cell == from {
                break;
            }
            if own > spent[cell] {
                continue;
            }
            for (next, length) in self.around(cell) {
                if self.depths[next] <= 0.0 {
                    continue;
                }
                let total = own + length * f64::midpoint(costs[cell], costs[next]);
                if total < spent[next] {
                    spent[next] = total;
                    before[next] = Some(cell);
                    queue.push(Reverse((Cost(total), next)));
                }
            }
        }
        std::iter::successors(Some(from), |cell| before[*cell]).collect()
    }

    /// Per cell the value of that of some places, each with its value, which is nearest on the way inside; for cells outside, what the
    /// nearest cell inside has.
    pub(super) fn labeled(&self, places: &[(DVec2, f64)]) -> Vec<f32> {
        /// A step outside costs more than any way inside.
        const OUTSIDE: f64 = 1e6;

        let mut found = vec![(f64::INFINITY, 0.0_f32); self.depths.len()];
        let mut queue = BinaryHeap::new();
        for (place, value) in places {
            let cell = self.cells.cell_at(*place);
            found[cell] = (0.0, *value as f32);
            queue.push(Reverse((Cost(0.0), cell)));
        }
        while let Some(Reverse((Cost(spent), cell))) = queue.pop() {
            if spent > found[cell].0 {
                continue;
            }
            for (next, length) in self.neighbors(cell) {
                let factor = if self.depths[next] > 0.0 {
                    1.0
                } else {
                    OUTSIDE
                };
                let total = spent + factor * length;
                if total < found[next].0 {
                    found[next] = (total, found[cell].1);
                    queue.push(Reverse((Cost(total), next)));
                }
            }
        }
        found.into_iter().map(|(_, value)| value).collect()
    }

    /// The eight cells around one inside, with their distances in cells. There is a border of cells outside, so that all of them exist.
    fn around(&self, cell: usize) -> [(usize, f64); 8] {
        const ACROSS: f64 = std::f64::consts::SQRT_2;

        let columns = self.cells.columns;
        let [above, below] = [cell - columns, cell + columns];
        [
            (above - 1, ACROSS),
            (above, 1.0),
            (above + 1, ACROSS),
            (cell - 1, 1.0),
            (cell + 1, 1.0),
            (below - 1, ACROSS),
            (below, 1.0),
            (below + 1, ACROSS),
        ]
    }

    /// The cells around any one, with their distances in cells.
    fn neighbors(&self, cell: usize) -> impl Iterator<Item = (usize, f64)> + use<> {
        let Cells { columns, rows, .. } = self.cells;
        let around = [-1_isize, 0, 1]
            .into_iter()
            .flat_map(|y| [-1_isize, 0, 1].map(|x| (x, y)));
        let around = around.filter(|at| *at != (0, 0));
        around.filter_map(move |(x, y)| {
            let next = cell.checked_add_signed(y * columns as isize + x)?;
            let is_beyond = next >= columns * rows || (next % columns).abs_diff(cell % columns) > 1;
            if is_beyond {
                return None;
            }
            let is_across = x != 0 && y != 0;
            let length = if is_across {
                std::f64::consts::SQRT_2
            } else {
                1.0
            };
            Some((next, length))
        })
    }

    /// The cells to the right of one and below it, where they are inside.
    pub(super) fn next(&self, cell: usize) -> [Option<usize>; 2] {
        // There is a border of cells outside.
        [cell + 1, cell + self.cells.columns].map(|next| {
            let is_inside = self.depths.get(next).is_some_and(|depth| *depth > 0.0);
            is_inside.then_some(next)
        })
    }

    /// The side of a cell.
    pub(super) fn side(&self) -> f64 {
        self.cells.side
    }

    /// Per cell whether its middle is inside.
    fn filled(&self, outline: &Outline) -> Vec<bool> {
        let Cells {
            low,
            side,
            columns,
            rows,
        } = self.cells;
        let mut inside = vec![false; columns * rows];
        let rings = || outline.rings();
        let mut crossings = Vec::new();
        for row in 0..rows {
            let y = low.y + (row as f64 + 0.5) * side;
            crossings.clear();
            for ring in rings() {
                let ends = ring.iter().zip(ring.iter().cycle().skip(1));
                let crossed = ends.filter(|(a, b)| (a.y <= y) != (b.y <= y));
                crossings.extend(crossed.map(|(a, b)| a.x + (y - a.y) / (b.y - a.y) * (b.x - a.x)));
            }
            crossings.sort_by(f64::total_cmp);
            let column = |x: f64| ((x - low.x) / side - 0.5).ceil().max(0.0) as usize;
            for span in crossings.chunks_exact(2) {
                let [from, to] = [span[0], span[1]].map(|x| column(x).min(columns));
                inside[row * columns..][from..to.max(from)].fill(true);
            }
        }
        inside
    }

    /// Leaves the largest connected piece.
    fn keep_largest(&self, inside: &mut [bool]) {
        let mut piece = vec![0_u32; inside.len()];
        let mut sizes = vec![0];
        for first in 0..inside.len() {
            if !inside[first] || piece[first] != 0 {
                continue;
            }
            let number = sizes.len() as u32;
            let mut open = vec![first];
            let mut size = 0;
            piece[first] = number;
            while let Some(cell) = open.pop() {
                size += 1;
                for (next, _) in self.around(cell) {
                    if inside[next] && piece[next] == 0 {
                        piece[next] = number;
                        open.push(next);
                    }
                }
            }
            sizes.push(size);
        }
        let largest = (1..sizes.len()).rev().max_by_key(|number| sizes[*number]);
        for (inside, piece) in inside.iter_mut().zip(piece) {
            *inside = *inside && Some(piece as usize) == largest;
        }
    }

    /// Per cell its distance from the nearest cell outside.
    fn distances(&self, inside: &[bool]) -> Vec<f64> {
        let squares = squared_distances(inside, self.cells.columns);
        squares.into_iter().map(f64::sqrt).collect()
    }
}

/// A cost, ordered.
#[derive(PartialEq)]
struct Cost(f64);
impl Eq for Cost {}
impl PartialOrd for Cost {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}
impl Ord for Cost {
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        self.0.total_cmp(&other.0)
    }
}
