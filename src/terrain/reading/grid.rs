//! The grid of a tile layer, and shapes that lie on it.

use glam::DVec2;

use crate::geometry::Outline;

/// The position and the extent of a tile layer's cells.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Grid {
    /// The top left corner, drawing units.
    pub(super) origin: DVec2,
    /// The side of a cell, drawing units.
    pub(super) size: f64,
    pub(super) columns: usize,
    pub(super) rows: usize,
}

impl Grid {
    /// The grid over a box of the drawing: both corners are rounded to the nearest crossings, ties to the upper left.
    ///
    /// # Errors
    /// The numbers of columns and rows, if that makes more than `most` cells.
    pub(super) fn over([low, high]: [DVec2; 2], size: f64, most: usize) -> Result<Self, [f64; 2]> {
        let nearest = |p: DVec2| (p / size - 0.5).ceil();
        let (first, last) = (nearest(low), nearest(high));
        let count = last - first;
        // Written so that NaN does not fit.
        let fits = count.x * count.y <= most as f64 && count.max_element() <= most as f64;
        if !fits {
            return Err(count.to_array());
        }
        Ok(Self {
            origin: first * size,
            size,
            columns: count.x as usize,
            rows: count.y as usize,
        })
    }

    /// A point of the drawing in cells from the top left corner.
    pub(super) fn cells(&self, p: DVec2) -> DVec2 {
        (p - self.origin) / self.size
    }

    /// The numbers of columns and rows.
    pub(super) fn extent(&self) -> DVec2 {
        DVec2::new(self.columns as f64, self.rows as f64)
    }
}

/// The bounds of an outline that is an axis-aligned rectangle.
pub(super) fn rectangle(outline: &Outline) -> Option<[DVec2; 2]> {
    let [polygon] = outline.polygons.as_slice() else {
        return None;
    };
    let [ring] = polygon.rings.as_slice() else {
        return None;
    };
    let [a, b, c, d] = ring.as_slice() else {
        return None;
    };
    let (low, high) = (a.min(*c), a.max(*c));
    let slack = 1e-9 * (high - low).max_element();
    let same = |p: DVec2, x: f64, y: f64| (p.x - x).abs() <= slack && (p.y - y).abs() <= slack;
    let one_way = same(*b, a.x, c.y) && same(*d, c.x, a.y);
    let other_way = same(*b, c.x, a.y) && same(*d, a.x, c.y);
    (one_way || other_way).then_some([low, high])
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn a_grid_begins_at_the_nearest_crossing() {
        let grid = |low: [f64; 2], high: [f64; 2]| {
            let grid = Grid::over([low.into(), high.into()], 16.0, 100).unwrap();
            (grid.origin.to_array(), grid.columns, grid.rows)
        };
        assert_eq!(grid([16.0, -32.0], [48.0, 0.0]), ([16.0, -32.0], 2, 2));
        assert_eq!(grid([17.5, 30.5], [47.0, 49.0]), ([16.0, 32.0], 2, 1));
        // Half a cell: no pixel of a picture is lost.
        assert_eq!(grid([8.0, -8.0], [40.0, 24.0]), ([0.0, -16.0], 2, 2));
        assert_eq!(grid([1.0, 1.0], [2.0, 2.0]), ([0.0, 0.0], 0, 0));
    }

    #[test]
    fn a_grid_of_too_many_cells_is_refused() {
        let over = |side: f64, size: f64| Grid::over([DVec2::ZERO, DVec2::splat(side)], size, 100);
        assert!(over(160.0, 16.0).is_ok());
        assert_eq!(over(176.0, 16.0), Err([11.0, 11.0]));
        assert!(over(1.0, 1e-300).is_err());
        assert!(over(1e300, 1e-300).is_err());
        assert!(over(f64::NAN, 1.0).is_err());
        let flat = [DVec2::ZERO, DVec2::new(1e20, 0.1)];
        assert!(Grid::over(flat, 1.0, 100).is_err());
    }

    proptest! {
        #[test]
        fn what_reaches_a_middle_lies_in_the_grid(
            low in (-50.0..50.0, -50.0..50.0_f64),
            extent in (0.0..50.0, 0.0..50.0_f64),
            size in 0.5..20.0_f64,
        ) {
            let low = DVec2::from(low);
            let high = low + DVec2::from(extent);
            let grid = Grid::over([low, high], size, 1 << 20).unwrap();
            let first = (low / size - 0.5).ceil();
            let past = (high / size - 0.5).ceil();
            for axis in 0..2 {
                let count = [grid.columns, grid.rows][axis];
                let middles = (-200..200).map(|k| (f64::from(k) + 0.5) * size);
                let covered = middles.filter(|m| *m >= low[axis] && *m < high[axis]).count();
                prop_assert_eq!(count, covered, "{} {}", first, past);
            }
        }
    }
}
