//! A grid over points of the plane, in which what is near a place is found.

use glam::DVec2;

/// Limit of the cells along each side, if they are about as long as wide.
const MAX_CELLS: f64 = 512.0;
/// Cells along the radius within which points are looked for, and the most cells a point.
const CELLS_PER_RADIUS: f64 = 2.0;
const CELLS_PER_POINT: f64 = 4.0;

/// Values that are in the cells of a grid.
#[derive(Debug)]
pub(super) struct Lists<T> {
    /// Per cell where its values begin in the list.
    starts: Vec<u32>,
    list: Vec<T>,
}

impl<T: Copy> Lists<T> {
    /// The values of so many cells, each with its cell. Those of a cell keep their order.
    pub(super) fn new(cells: usize, entries: &[(u32, T)]) -> Self {
        let mut ends = vec![0_u32; cells + 1];
        for (cell, _) in entries {
            ends[*cell as usize + 1] += 1;
        }
        for cell in 1..ends.len() {
            ends[cell] += ends[cell - 1];
        }
        let starts = ends.clone();
        let mut list: Vec<T> = entries.iter().map(|(_, value)| *value).collect();
        for (cell, value) in entries {
            let place = &mut ends[*cell as usize];
            list[*place as usize] = *value;
            *place += 1;
        }
        Self { starts, list }
    }

    pub(super) fn of_cell(&self, cell: usize) -> &[T] {
        &self.list[self.starts[cell] as usize..self.starts[cell + 1] as usize]
    }
}

/// Points of the plane with values, of which those near a place are found.
#[derive(Debug)]
pub(super) struct Scattered<T> {
    cells: Cells,
    lists: Lists<(DVec2, T)>,
    radius: f64,
}

impl<T: Copy> Scattered<T> {
    /// Points of which those within a radius will be looked for.
    pub(super) fn new(points: &[(DVec2, T)], radius: f64) -> Self {
        let places = || points.iter().map(|(point, _)| *point);
        let bounds = [
            places().reduce(DVec2::min).unwrap_or_default(),
            places().reduce(DVec2::max).unwrap_or_default(),
        ];
        let extent = (bounds[1] - bounds[0]) / (radius / CELLS_PER_RADIUS) + 1.0;
        // Not many more cells than points.
        let count = (extent.x * extent.y).min(CELLS_PER_POINT * points.len() as f64);
        let cells = Cells::over(bounds, count);
        let entries = points
            .iter()
            .map(|entry| (cells.nearest(entry.0) as u32, *entry));
        let entries: Vec<_> = entries.collect();
        Self {
            lists: Lists::new(cells.count(), &entries),
            cells,
            radius,
        }
    }

    /// The points that are no farther from a place than the radius, each with the square of its distance in radii, in an order that
    /// depends on all points.
    pub(super) fn near(&self, place: DVec2) -> impl Iterator<Item = (f64, T)> + '_ {
        let within = self.radius * self.radius;
        let cells = self.cells.in_box(place - self.radius, place + self.radius);
        let points = cells.flat_map(|cell| self.lists.of_cell(cell));
        points.filter_map(move |(point, value)| {
            let apart = point.distance_squared(place);
            (apart <= within).then_some((apart / within, *value))
        })
    }
}

/// The cells of a grid, numbered row by row.
#[derive(Debug)]
pub(super) struct Cells {
    low: DVec2,
    high: DVec2,
    /// Cells a unit, across and up.
    scale: DVec2,
    /// Cells along each side.
    size: [usize; 2],
}

impl Cells {
    /// About so many cells over a box, about as long as wide.
    pub(super) fn over(bounds: [DVec2; 2], count: f64) -> Self {
        Self::shaped(bounds, count, DVec2::ONE, MAX_CELLS)
    }

    /// About so many cells over a box, which are about as long and wide as these proportions.
    pub(super) fn alike(bounds: [DVec2; 2], count: f64, proportions: DVec2) -> Self {
        let most = count.clamp(1.0, MAX_CELLS * MAX_CELLS);
        let proportions = proportions / proportions.max_element();
        let proportions = proportions.max(DVec2::splat(1e-6));
        Self::shaped(bounds, most, proportions, most)
    }

    fn shaped([low, high]: [DVec2; 2], count: f64, proportions: DVec2, most: f64) -> Self {
        let extent = (high - low).max(DVec2::splat(f64::MIN_POSITIVE));
        let relative = extent / proportions;
        let side = (relative.x * relative.y / count.max(1.0)).sqrt();
        let size = (relative / side.max(f64::MIN_POSITIVE)).ceil();
        let size = size.clamp(DVec2::ONE, DVec2::splat(most));
        Self {
            low,
            high,
            scale: size / extent,
            size: size.to_array().map(|count| count as usize),
        }
    }

    /// How many there are.
    pub(super) fn count(&self) -> usize {
        self.size[0] * self.size[1]
    }

    /// The column and the row of a point, or of the nearest cell.
    fn place(&self, point: DVec2) -> [usize; 2] {
        let place = (point - self.low) * self.scale;
        let [column, row] = place.max(DVec2::ZERO).to_array().map(|x| x as usize);
        [column.min(self.size[0] - 1), row.min(self.size[1] - 1)]
    }

    /// The cell of a point, or the nearest one.
    pub(super) fn nearest(&self, point: DVec2) -> usize {
        let [column, row] = self.place(point);
        row * self.size[0] + column
    }

    /// The cell of a point, if it is in the box or hardly outside.
    pub(super) fn at(&self, point: DVec2) -> Option<usize> {
        let slack = (self.high - self.low) * 1e-6;
        let is_near = point.clamp(self.low - slack, self.high + slack) == point;
        is_near.then(|| self.nearest(point))
    }

    /// The cell of a point, or the nearest one, and those to the left of it, each with an x a little greater than that of its left
    /// side.
    pub(super) fn leftward(&self, point: DVec2) -> impl Iterator<Item = (usize, f64)> + '_ {
        let [column, row] = self.place(point);
        (0..=column).rev().map(move |column| {
            let left = self.low.x + (column as f64 + 1e-6) / self.scale.x;
            (row * self.size[0] + column, left)
        })
    }

    /// The cells that a box reaches into.
    pub(super) fn in_box(&self, low: DVec2, high: DVec2) -> impl Iterator<Item = usize> + '_ {
        let is_apart = high.cmplt(self.low).any() || low.cmpgt(self.high).any();
        let [[left, bottom], [right, top]] = [low, high].map(|corner| self.place(corner));
        let rows = if is_apart { 0..0 } else { bottom..top + 1 };
        rows.flat_map(move |row| (left..=right).map(move |column| row * self.size[0] + column))
    }

    /// Calls `each` with the cells that a triangle reaches into, row by row, and perhaps with a few beside it.
    pub(super) fn of_triangle(&self, triangle: [DVec2; 3], mut each: impl FnMut(usize)) {
        self.any_of_triangle(triangle, |cell| {
            each(cell);
            false
        });
    }

    /// Whether this is true of any cell that a triangle reaches into, or of one beside it.
    pub(super) fn any_of_triangle(
        &self,
        [a, b, c]: [DVec2; 3],
        mut is: impl FnMut(usize) -> bool,
    ) -> bool {
        let [[left, bottom], [right, top]] =
            [a.min(b).min(c), a.max(b).max(c)].map(|corner| self.place(corner));
        // Most triangles are about as large as a cell: which cells of their box they do not reach is not worth finding out.
        let is_small = top - bottom <= 1 && right - left <= 1;
        (bottom..=top).any(|row| {
            let [left, right] = if is_small {
                [left, right]
            } else {
                self.columns_of([[a, b], [b, c], [c, a]], row)
            };
            (left..=right).any(|column| is(row * self.size[0] + column))
        })
    }

    /// The first and the last column that a triangle with these edges reaches into in a row that it reaches into.
    fn columns_of(&self, edges: [[DVec2; 2]; 3], row: usize) -> [usize; 2] {
        let y = |row: usize| self.low.y + row as f64 / self.scale.y;
        // A little more, for rounding.
        let more = 1e-9 / self.scale.y;
        let (from_y, to_y) = (y(row) - more, y(row + 1) + more);
        let (mut left, mut right) = (f64::INFINITY, f64::NEG_INFINITY);
        for [a, b] in edges {
            let (a, b) = if a.y <= b.y { (a, b) } else { (b, a) };
            if b.y < from_y || a.y > to_y {
                continue;
            }
            for y in [from_y, to_y] {
                let share = ((y - a.y) / (b.y - a.y)).clamp(0.0, 1.0);
                let x = if share.is_nan() {
                    a.x
                } else {
                    a.x + (b.x - a.x) * share
                };
                left = left.min(x);
                right = right.max(x);
            }
            if a.y == b.y {
                left = left.min(b.x);
                right = right.max(b.x);
            }
        }
        let more = 1e-9 / self.scale.x;
        let column = |x: f64| self.place(DVec2::new(x, self.low.y))[0];
        [column(left - more), column(right + more)]
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        /// What is found near a place is what a look at all points finds, however they are spread.
        #[test]
        fn all_points_within_the_radius_are_found(
            points in prop::collection::vec((-10.0..10.0, -10.0..10.0), 0..80),
            flat in any::<bool>(),
            radius in 0.01..8.0_f64,
            place in (-14.0..14.0, -14.0..14.0),
        ) {
            let squeezed = |(x, y): (f64, f64)| DVec2::new(x, if flat { 1.0 } else { y });
            let points: Vec<(DVec2, usize)> =
                points.into_iter().map(squeezed).zip(0..).collect();
            let place = DVec2::from(place);
            let near = |(point, _): &&(DVec2, usize)| {
                point.distance_squared(place) <= radius * radius
            };
            let expected: Vec<usize> = points.iter().filter(near).map(|(_, index)| *index).collect();
            let scattered = Scattered::new(&points, radius);
            let mut found: Vec<usize> = scattered.near(place).map(|(_, index)| index).collect();
            found.sort_unstable();
            prop_assert_eq!(found, expected);
        }
    }
}
