//! Edges: strokes that run along grid lines.

use glam::DVec2;

use super::grid::Grid;
use crate::svg::StrokeSource;
use crate::terrain::{EDGE_BELOW, EDGE_RIGHT};

/// The largest distance of a stroke from its grid line, cells.
const NEAR: f64 = 0.1;
/// How much of a cell's side must be covered, in sixteenths: half of it.
const COVERED: u32 = 8;
/// The number of places on a side that are tested.
const PLACES: f64 = 16.0;

/// Sets [`EDGE_RIGHT`] and [`EDGE_BELOW`] of the cells along whose sides strokes run for at least half of the side.
pub(super) fn read(grid: &Grid, strokes: &[&StrokeSource], edges: &mut [u8]) {
    if strokes.is_empty() || edges.is_empty() {
        return;
    }
    // One direction at a time, to halve the memory.
    for (swapped, edge) in [(false, EDGE_RIGHT), (true, EDGE_BELOW)] {
        let mut sides = Sides {
            covered: vec![0; edges.len()],
            count: if swapped {
                [grid.rows, grid.columns]
            } else {
                [grid.columns, grid.rows]
            },
            swapped,
        };
        let turned = |p: DVec2| if swapped { DVec2::new(p.y, p.x) } else { p };
        for stroke in strokes {
            stroke.middle_line(grid.size * NEAR / 4.0, |from, to| {
                sides.add(turned(grid.cells(from)), turned(grid.cells(to)));
            });
        }
        for (edges, covered) in edges.iter_mut().zip(sides.covered) {
            if covered.count_ones() >= COVERED {
                *edges |= edge;
            }
        }
    }
}

/// The sides between cells and their right neighbours, or their lower neighbours if columns and rows are swapped.
struct Sides {
    /// Per cell of the map a bit for each place along the side, set if a stroke covers it.
    covered: Vec<u16>,
    /// Columns and rows; rows and columns if they are swapped.
    count: [usize; 2],
    swapped: bool,
}

impl Sides {
    /// Adds a straight piece of a stroke.
    fn add(&mut self, from: DVec2, to: DVec2) {
        let (from, to) = if from.y <= to.y {
            (from, to)
        } else {
            (to, from)
        };
        let way = to - from;
        // A piece that runs more across than along covers less than half of any side.
        if !(way.y > 0.0 && way.y >= way.x.abs()) {
            return;
        }
        let [columns, rows] = self.count.map(|count| count as f64);
        let slope = way.x / way.y;
        let x_at = |y: f64| from.x + slope * (y - from.y);
        let (low, high) = (from.y.max(0.0), to.y.min(rows));
        if low >= high {
            return;
        }
        let (left, right) = (x_at(low).min(x_at(high)), x_at(low).max(x_at(high)));
        // The outermost lines have no cells on both sides.
        let first = (left - NEAR).ceil().max(1.0);
        let last = (right + NEAR).floor().min(columns - 1.0);
        let mut line = first;
        while line <= last {
            let span = if slope == 0.0 {
                [low, high]
            } else {
                let ends = [line - NEAR, line + NEAR].map(|x| from.y + (x - from.x) / slope);
                [
                    ends[0].min(ends[1]).max(low),
                    ends[0].max(ends[1]).min(high),
                ]
            };
            self.cover(line as usize - 1, span);
            line += 1.0;
        }
    }

    /// Covers a range of the line to the right of a column.
    fn cover(&mut self, column: usize, [from, to]: [f64; 2]) {
        // The sixteenths whose middles lie in the range.
        let first = (from * PLACES - 0.5).ceil().max(0.0) as usize;
        let past = (to * PLACES - 0.5).ceil().max(0.0) as usize;
        let [columns, rows] = self.count;
        let mut at = first;
        while at < past.min(rows * PLACES as usize) {
            let row = at / PLACES as usize;
            let end = past.min((row + 1) * PLACES as usize);
            let (low, high) = (at % PLACES as usize, end - row * PLACES as usize);
            let bits = (((1_u32 << high) - 1) & !((1_u32 << low) - 1)) as u16;
            let cell = if self.swapped {
                column * rows + row
            } else {
                row * columns + column
            };
            self.covered[cell] |= bits;
            at = end;
        }
    }
}
