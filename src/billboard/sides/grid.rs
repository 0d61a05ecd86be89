//! A view on a grid: which region is seen at each place, and how much of a drawing is its own mirror image.

use glam::DVec2;
use typed_index_collections::TiVec;

use crate::billboard::region::{RegionId, View};
use crate::geometry::Outline;

/// Rows of the grid.
const ROWS: usize = 256;
/// Columns at most: drawings may be much wider than high.
const MOST_COLUMNS: usize = 1024;
/// Regions with a smaller alpha hide nothing.
pub(super) const OPAQUE: f64 = 0.98;
/// Colours that differ by at most this in each channel are alike: a fringe and the hair behind a head.
const ALIKE: f64 = 0.06;

/// Whether two colours are alike, sRGB from 0 to 1.
pub(super) fn is_alike(a: [f64; 4], b: [f64; 4]) -> bool {
    (0..3).all(|channel| (a[channel] - b[channel]).abs() <= ALIKE)
}

/// Which opaque region is seen at each cell of a grid over the box around a view; lines are left out. Rows run down, columns to the
/// right, and cells are squares.
pub(super) struct Grid {
    columns: usize,
    seen: Vec<Option<RegionId>>,
    /// The upper left corner, drawing units.
    low: DVec2,
    /// The side of a cell, drawing units.
    step: f64,
}

impl Grid {
    /// The grid of a view; `None` if it shows nothing that has a height or a width.
    pub(super) fn new(view: &View) -> Option<Self> {
        let (low, high) = view.bounds()?;
        let size = high - low;
        let step = (size.y / ROWS as f64).max(size.x / MOST_COLUMNS as f64);
        if !(step > 0.0 && step.is_finite()) {
            return None;
        }
        let count = |length: f64| ((length / step).ceil() as usize).clamp(1, MOST_COLUMNS);
        let (columns, rows) = (count(size.x), count(size.y));
        let mut grid = Self {
            columns,
            seen: vec![None; columns * rows],
            low,
            step,
        };
        let regions = view.regions.iter_enumerated();
        for (id, region) in regions.filter(|(_, r)| !r.is_line && r.color[3] >= OPAQUE) {
            grid.fill(&region.outline, |p| (p - low) / step - 0.5, id);
        }
        Some(grid)
    }

    /// Fills an outline; `place` takes its points to cells, whose middles are whole numbers.
    fn fill(&mut self, outline: &Outline, place: impl Fn(DVec2) -> DVec2, id: RegionId) {
        let rows = self.seen.len() / self.columns;
        let mut crossings: Vec<Vec<f64>> = vec![Vec::new(); rows];
        for ring in outline.rings() {
            let next = ring.iter().cycle().skip(1);
            for (a, b) in ring.iter().zip(next) {
                let (a, b) = (place(*a), place(*b));
                let (upper, lower) = if a.y < b.y { (a, b) } else { (b, a) };
                let first = upper.y.ceil().max(0.0) as usize;
                let end = (lower.y.ceil().max(0.0) as usize).min(rows);
                for (row, crossings) in crossings.iter_mut().enumerate().take(end).skip(first) {
                    let share = (row as f64 - upper.y) / (lower.y - upper.y);
                    crossings.push(upper.x + share * (lower.x - upper.x));
                }
            }
        }
        for (row, mut crossings) in crossings.into_iter().enumerate() {
            crossings.sort_by(f64::total_cmp);
            for pair in crossings.chunks_exact(2) {
                let [first, end] = [pair[0], pair[1]].map(|x| x.ceil().max(0.0) as usize);
                let cells = row * self.columns + first.min(self.columns)
                    ..row * self.columns + end.min(self.columns);
                self.seen[cells].fill(Some(id));
            }
        }
    }

    pub(super) fn columns(&self) -> usize {
        self.columns
    }

    pub(super) fn rows(&self) -> usize {
        self.seen.len() / self.columns
    }

    /// In how many cells a region is seen.
    pub(super) fn cells(&self) -> usize {
        self.seen.iter().flatten().count()
    }

    /// What is seen at a cell; nothing outside of the grid.
    pub(super) fn at(&self, column: isize, row: isize) -> Option<RegionId> {
        let column = usize::try_from(column).ok().filter(|c| *c < self.columns)?;
        let row = usize::try_from(row).ok().filter(|r| *r < self.rows())?;
        self.seen[row * self.columns + column]
    }
}

/// The same grid by colours, for how much of it is its own mirror image.
pub(super) struct Colors<'a> {
    grid: &'a Grid,
    /// Per region the first one of its colour.
    color_of: TiVec<RegionId, RegionId>,
}

impl<'a> Colors<'a> {
    pub(super) fn new(grid: &'a Grid, view: &View) -> Self {
        let regions = &view.regions;
        let is_same = |a: RegionId, b: RegionId| is_alike(regions[a].color, regions[b].color);
        let mut firsts: Vec<RegionId> = Vec::new();
        let color = |id: RegionId| {
            let known = firsts.iter().copied().find(|first| is_same(*first, id));
            known.unwrap_or_else(|| {
                firsts.push(id);
                id
            })
        };
        Self {
            color_of: regions.keys().map(color).collect(),
            grid,
        }
    }

    /// In how many cells the same colour is seen as in their images about an upright line at `axis`, drawing units.
    pub(super) fn mirrored(&self, axis: f64) -> usize {
        let Grid {
            columns, low, step, ..
        } = *self.grid;
        // The middle of a column's image lies in a column: x + image = 2 · axis.
        let sum = (2.0 * (axis - low.x) / step).round() - 1.0;
        let image = |column: usize| {
            let image = sum - column as f64;
            (image >= 0.0 && image < columns as f64).then_some(image as usize)
        };
        let images: Vec<Option<usize>> = (0..columns).map(image).collect();
        let of_row = |row: &[Option<RegionId>]| {
            let pairs = row.iter().zip(&images);
            let is_same = |(own, image): &(&Option<RegionId>, &Option<usize>)| {
                let other = image.and_then(|image| row[image]);
                let pair = own.zip(other);
                pair.is_some_and(|(own, other)| self.color_of[own] == self.color_of[other])
            };
            pairs.filter(is_same).count()
        };
        self.grid.seen.chunks_exact(columns).map(of_row).sum()
    }
}
