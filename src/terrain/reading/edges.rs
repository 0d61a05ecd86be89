//! Edges: strokes that run along grid lines.

use glam::DVec2;

use super::grid::Grid;
use crate::svg::StrokeSource;
use crate::terrain::{EDGE_BELOW, EDGE_RIGHT};

/// The largest distance of a stroke from its grid line, cells: a quarter, so that what is drawn by hand counts.
pub(super) const NEAR: f64 = 0.25;
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

/// A stroke that is no edge for a part of its way.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Stray {
    /// Its index among the strokes.
    pub(super) stroke: usize,
    /// The first cell that it crosses.
    pub(super) cell: usize,
}

/// The distance of the places of a stroke that are looked at, cells.
const STRIDE: f64 = 1.0 / 8.0;
/// How much of a stroke must be stray, cells.
const STRAY: f64 = 0.5;
/// How many places are looked at for each cell of the map, and for each stroke.
const PLACES_LOOKED_AT: usize = 64;

/// The strokes that run across cells, too far from the lines between them, for half a cell or more. Where the cells on both sides are
/// of different materials, such as along the border of a shape, nothing is lost, and where there are none.
pub(super) fn strays(grid: &Grid, strokes: &[&StrokeSource], cells: &[u8]) -> Vec<Stray> {
    let mut left = (cells.len() + strokes.len()).saturating_mul(PLACES_LOOKED_AT);
    let mut strays = vec![];
    for (index, stroke) in strokes.iter().enumerate() {
        let (mut lost, mut first) = (0.0, None);
        stroke.middle_line(grid.size * NEAR / 4.0, |from, to| {
            let Some([from, to]) = clipped(grid, grid.cells(from), grid.cells(to)) else {
                return;
            };
            let way = to - from;
            let places = (way.length() / STRIDE).ceil().max(1.0) as usize;
            if places > left {
                left = 0;
                return;
            }
            left -= places;
            for place in 0..places {
                let at = from + way * ((place as f64 + 0.5) / places as f64);
                let off = (at - at.round()).abs();
                // Upright lines must be near upright ones, level lines near level ones, and slanted ones near any.
                let slanted = way.x.abs().min(way.y.abs()) * 2.0 > way.x.abs().max(way.y.abs());
                let off = match way.x.abs() > way.y.abs() {
                    _ if slanted => off.min_element(),
                    true => off.y,
                    false => off.x,
                };
                if off > NEAR
                    && let Some(cell) = alike(grid, cells, at)
                {
                    lost += way.length() / places as f64;
                    first.get_or_insert(cell);
                }
            }
        });
        if lost >= STRAY
            && let Some(cell) = first
        {
            strays.push(Stray {
                stroke: index,
                cell,
            });
        }
    }
    strays
}

/// The part of a line on the map, if there is one.
fn clipped(grid: &Grid, from: DVec2, to: DVec2) -> Option<[DVec2; 2]> {
    let (way, extent) = (to - from, grid.extent());
    let (mut start, mut end) = (0.0_f64, 1.0_f64);
    for axis in 0..2 {
        let ends = [
            -from[axis] / way[axis],
            (extent[axis] - from[axis]) / way[axis],
        ];
        if way[axis] == 0.0 {
            if !(0.0..=extent[axis]).contains(&from[axis]) {
                return None;
            }
            continue;
        }
        start = start.max(ends[0].min(ends[1]));
        end = end.min(ends[0].max(ends[1]));
    }
    // Written so that NaN is no line.
    (start < end).then(|| [from + way * start, from + way * end])
}

/// The cell at a place, if it is painted, and its four neighbours have the same material.
fn alike(grid: &Grid, cells: &[u8], at: DVec2) -> Option<usize> {
    let extent = [grid.columns, grid.rows];
    let [column, row] = [0, 1].map(|axis| (at[axis].max(0.0) as usize).min(extent[axis] - 1));
    let cell = row * grid.columns + column;
    let material = cells[cell];
    let around = [
        (column > 0).then(|| cell - 1),
        (column + 1 < grid.columns).then_some(cell + 1),
        (row > 0).then(|| cell - grid.columns),
        (row + 1 < grid.rows).then(|| cell + grid.columns),
    ];
    let same = around
        .into_iter()
        .flatten()
        .all(|other| cells[other] == material);
    (material != 0 && same).then_some(cell)
}
