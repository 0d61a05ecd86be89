//! How far solids come towards the viewer, looked up in their surfaces.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

use glam::{DAffine2, DVec2, DVec3, Vec3};
use rstar::{AABB, PointDistance, RTree, RTreeObject};
use rustc_hash::{FxHashMap, FxHashSet};

use super::Solid;
use crate::scene::{Surface, SurfaceSource};

/// Triangles that are steeper than this, as the cosine of their slope, are walls, which nothing lies on.
const WALL: f64 = 1e-6;
/// The distance, relative to the largest coordinate, at which a point counts as lying in a triangle.
const SLACK: f64 = 1e-7;
/// Cells a triangle.
const CELLS: f64 = 3.0;
/// Limit of the cells along each side of the grid.
const MAX_CELLS: f64 = 512.0;
/// Limit of the triangles that are kept.
const MAX_FACETS: usize = 1 << 20;

/// The side of a surface that faces the viewer.
#[derive(Debug)]
pub(super) struct Heights {
    facets: Vec<Facet>,
    grid: Grid,
    /// The edges at which nothing on the other side faces the viewer.
    border: RTree<Edge>,
    /// The height of all of the border, if it is the same everywhere, as at the border of soft kinds.
    level: Option<f64>,
    slack: f64,
}

impl Heights {
    pub(super) fn of(surface: &Surface) -> Self {
        let position = |corner: u32| surface.positions[corner as usize];
        // The sum maps -0.0 to 0.0.
        let at = |corner: u32| Vec3::from(position(corner).map(|x| x + 0.0)).as_dvec3();
        let triangles = surface.triangles.iter();
        Self::over(triangles.map(|triangle| triangle.map(at)))
    }

    /// The heights of those triangles that face the viewer. Their corners have the same coordinates where they share edges.
    pub(super) fn over(triangles: impl Iterator<Item = [DVec3; 3]>) -> Self {
        let mut largest = 0.0_f64;
        let mut facets = Vec::new();
        let place = |corner: DVec3| corner.to_array().map(f64::to_bits);
        let mut edges: FxHashSet<[[u64; 3]; 2]> = FxHashSet::default();
        for corners in triangles {
            largest = corners
                .iter()
                .fold(largest, |most, corner| most.max(corner.abs().max_element()));
            let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
            if normal.z > WALL * normal.length() {
                facets.push(Facet { corners, normal });
                let [a, b, c] = corners.map(place);
                edges.extend([[a, b], [b, c], [c, a]]);
            }
        }
        let point = |place: [u64; 3]| DVec3::from(place.map(f64::from_bits));
        let alone = edges.iter().filter(|[a, b]| !edges.contains(&[*b, *a]));
        let mut border: Vec<Edge> = alone.map(|ends| Edge(ends.map(point))).collect();
        // The tree, and so the nearest of several at the same distance, depends on the order.
        border.sort_unstable_by(|a, b| a.order(b));
        let ends = || border.iter().flat_map(|edge| edge.0.map(|end| end.z));
        let first = ends().next();
        let level = first.filter(|first| ends().all(|z| (z - first).abs() <= SLACK * largest));
        Self {
            grid: Grid::of(&facets),
            facets,
            level,
            border: RTree::bulk_load(border),
            slack: SLACK * largest,
        }
    }

    /// The height over a point of the drawing plane, if the surface is there.
    pub(super) fn at(&self, point: DVec2) -> Option<f64> {
        let near = self.grid.at(point).iter();
        let heights =
            near.filter_map(|facet| self.facets[*facet as usize].height(point, self.slack));
        heights.reduce(f64::max)
    }

    /// The greatest height; 0 for nothing.
    fn highest(&self) -> f64 {
        let corners = self.facets.iter().flat_map(|facet| facet.corners);
        corners
            .map(|corner| corner.z)
            .reduce(f64::max)
            .unwrap_or(0.0)
    }

    /// The height at the point of the surface's border that is nearest to a point of the drawing plane.
    pub(super) fn nearest(&self, point: DVec2) -> Option<f64> {
        self.level.or_else(|| {
            let edge = self.border.nearest_neighbor(point.to_array())?;
            Some(edge.nearest(point).z)
        })
    }

    /// The corners of the triangles in a box, some of them several times.
    pub(super) fn corners(&self, low: DVec2, high: DVec2) -> impl Iterator<Item = DVec2> + '_ {
        let facets = self.grid.in_box(low, high);
        let corners = facets.flat_map(|facet| self.facets[facet as usize].corners);
        let corners = corners.map(DVec3::truncate);
        corners.filter(move |point| point.clamp(low, high) == *point)
    }

    /// Where a line from one point to another crosses the edges of triangles, as shares of its length: in no order, some of them
    /// several times.
    pub(super) fn crossings(&self, from: DVec2, to: DVec2, found: &mut Vec<f64>) {
        let line = to - from;
        for facet in self.grid.in_box(from.min(to), from.max(to)) {
            for [a, b] in self.facets[facet as usize].edges() {
                let edge = b - a;
                let across = line.perp_dot(edge);
                let share = (a - from).perp_dot(edge) / across;
                let along = (a - from).perp_dot(line) / across;
                if share > 0.0 && share < 1.0 && (0.0..=1.0).contains(&along) {
                    found.push(share);
                }
            }
        }
    }
}

/// A triangle that faces the viewer.
#[derive(Debug)]
struct Facet {
    corners: [DVec3; 3],
    normal: DVec3,
}

impl Facet {
    fn edges(&self) -> [[DVec2; 2]; 3] {
        let [a, b, c] = self.corners.map(DVec3::truncate);
        [[a, b], [b, c], [c, a]]
    }

    /// The height over a point that is in the triangle, or outside by at most `slack`.
    fn height(&self, point: DVec2, slack: f64) -> Option<f64> {
        let is_left = |[from, to]: [DVec2; 2]| {
            let edge = to - from;
            let distance = edge.perp_dot(point - from);
            distance >= 0.0 || distance * distance <= slack * slack * edge.length_squared()
        };
        let [a, b, c] = self.corners;
        // At a sharp corner, a point may be near both edges and still be far away.
        let (low, high) = (a.min(b).min(c), a.max(b).max(c));
        let close = point.clamp(low.truncate() - slack, high.truncate() + slack);
        if close != point {
            return None;
        }
        self.edges().into_iter().all(is_left).then(|| {
            let slope = self.normal.truncate().dot(point - a.truncate()) / self.normal.z;
            // In steep triangles the plane is known less precisely than the corners.
            (a.z - slope).clamp(low.z, high.z)
        })
    }
}

/// A part of the border.
#[derive(Debug)]
struct Edge([DVec3; 2]);

impl Edge {
    fn nearest(&self, point: DVec2) -> DVec3 {
        let [from, to] = self.0;
        let edge = (to - from).truncate();
        let along = (point - from.truncate()).dot(edge) / edge.length_squared();
        from.lerp(to, along.clamp(0.0, 1.0))
    }

    fn order(&self, other: &Self) -> std::cmp::Ordering {
        let numbers = |edge: &Self| edge.0.map(|end| end.to_array());
        let pairs = numbers(self).into_iter().flatten();
        let mut pairs = pairs.zip(numbers(other).into_iter().flatten());
        let order = pairs.find_map(|(a, b)| Some(a.total_cmp(&b)).filter(|order| order.is_ne()));
        order.unwrap_or(std::cmp::Ordering::Equal)
    }
}

impl RTreeObject for Edge {
    type Envelope = AABB<[f64; 2]>;

    fn envelope(&self) -> Self::Envelope {
        let [from, to] = self.0.map(|end| end.truncate().to_array());
        AABB::from_corners(from, to)
    }
}

impl PointDistance for Edge {
    fn distance_2(&self, point: &[f64; 2]) -> f64 {
        let point = DVec2::from(*point);
        self.nearest(point).truncate().distance_squared(point)
    }
}

/// The triangles over each cell of a grid.
#[derive(Debug)]
struct Grid {
    low: DVec2,
    high: DVec2,
    /// Cells a unit, across and up.
    scale: DVec2,
    /// Cells along each side.
    size: [usize; 2],
    /// Per cell where its triangles begin in the list.
    starts: Vec<u32>,
    list: Vec<u32>,
}

impl Grid {
    fn of(facets: &[Facet]) -> Self {
        let points = || {
            facets
                .iter()
                .flat_map(|facet| facet.corners.map(DVec3::truncate))
        };
        let (low, high) = (
            points().reduce(DVec2::min).unwrap_or_default(),
            points().reduce(DVec2::max).unwrap_or_default(),
        );
        let extent = (high - low).max(DVec2::splat(f64::MIN_POSITIVE));
        // Cells are about as long as wide.
        let side = (extent.x * extent.y / (CELLS * facets.len().max(1) as f64)).sqrt();
        let size = (extent / side.max(f64::MIN_POSITIVE)).ceil();
        let size = size.clamp(DVec2::ONE, DVec2::splat(MAX_CELLS));
        let mut grid = Self {
            low,
            high,
            scale: size / extent,
            size: size.to_array().map(|count| count as usize),
            starts: Vec::new(),
            list: Vec::new(),
        };
        let mut cells: Vec<(u32, u32)> = Vec::new();
        for (index, facet) in facets.iter().enumerate() {
            grid.cells_of(facet, |cell| cells.push((cell as u32, index as u32)));
        }
        cells.sort_unstable();
        grid.starts = vec![0; grid.size[0] * grid.size[1] + 1];
        for (cell, _) in &cells {
            grid.starts[*cell as usize + 1] += 1;
        }
        for cell in 1..grid.starts.len() {
            grid.starts[cell] += grid.starts[cell - 1];
        }
        grid.list = cells.into_iter().map(|(_, facet)| facet).collect();
        grid
    }

    /// The column and the row of a point, or of the nearest cell.
    fn cell(&self, point: DVec2) -> [usize; 2] {
        let place = (point - self.low) * self.scale;
        let [column, row] = place.max(DVec2::ZERO).to_array().map(|x| x as usize);
        [column.min(self.size[0] - 1), row.min(self.size[1] - 1)]
    }

    /// Calls `each` with the cells that a triangle reaches into, row by row.
    fn cells_of(&self, facet: &Facet, mut each: impl FnMut(usize)) {
        let edges = facet.edges();
        let ys = edges.map(|[from, _]| from.y);
        let [bottom, top] = [
            ys.into_iter().fold(f64::INFINITY, f64::min),
            ys.into_iter().fold(f64::NEG_INFINITY, f64::max),
        ];
        let row = |y: f64| self.cell(DVec2::new(self.low.x, y))[1];
        for row in row(bottom)..=row(top) {
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
            if left <= right {
                let more = 1e-9 / self.scale.x;
                let column = |x: f64| self.cell(DVec2::new(x, self.low.y))[0];
                for column in column(left - more)..=column(right + more) {
                    each(row * self.size[0] + column);
                }
            }
        }
    }

    /// The triangles over the cell of a point.
    fn at(&self, point: DVec2) -> &[u32] {
        let slack = (self.high - self.low) * 1e-6;
        if point.clamp(self.low - slack, self.high + slack) != point {
            return &[];
        }
        let [column, row] = self.cell(point);
        self.of_cell(row * self.size[0] + column)
    }

    fn of_cell(&self, cell: usize) -> &[u32] {
        &self.list[self.starts[cell] as usize..self.starts[cell + 1] as usize]
    }

    /// The triangles over the cells that a box reaches into, some of them several times.
    fn in_box(&self, low: DVec2, high: DVec2) -> impl Iterator<Item = u32> + '_ {
        let is_apart = high.cmplt(self.low).any() || low.cmpgt(self.high).any();
        let [[left, bottom], [right, top]] = [low, high].map(|corner| self.cell(corner));
        let rows = if is_apart { 0..0 } else { bottom..top + 1 };
        rows.flat_map(move |row| (left..=right).map(move |column| row * self.size[0] + column))
            .flat_map(|cell| self.of_cell(cell).iter().copied())
    }
}

/// Heights of the front and of the back of a solid.
#[derive(Debug, Clone)]
pub(super) struct BothHeights {
    pub(super) front: Arc<Heights>,
    /// Of the solid mirrored in its plane.
    pub(super) back: Arc<Heights>,
}

impl BothHeights {
    fn of(surface: &Surface) -> Self {
        Self {
            front: Arc::new(Heights::of(surface)),
            back: Arc::new(Heights::of(&surface.mirrored())),
        }
    }

    fn facet_count(&self) -> usize {
        self.front.facets.len() + self.back.facets.len()
    }
}

/// The heights that were asked for last, so that those of a solid with much on it are found once, and those of thousands of solids
/// do not fill the memory. They are known by hashes of all that they are made from.
#[derive(Debug, Default)]
pub struct RecentHeights(Mutex<Kept>);

#[derive(Debug, Default)]
struct Kept {
    slots: FxHashMap<u128, Slot>,
    /// The keys by when they were last asked for.
    order: BTreeMap<u64, u128>,
    next: u64,
    /// The triangles of all.
    facets: usize,
}

#[derive(Debug)]
struct Slot {
    cell: Arc<OnceLock<Option<BothHeights>>>,
    used: u64,
    /// Its triangles, once they are known.
    facets: usize,
}

impl RecentHeights {
    /// The heights of a solid by itself.
    pub(super) fn of_solid(&self, solid: &Solid) -> BothHeights {
        let make = || BothHeights::of(&solid.surface());
        let found = self.get(solid.long_key(), || Some(make()));
        found.unwrap_or_else(make)
    }

    /// What is kept for a key, if anything is.
    pub(super) fn find(&self, key: u128) -> Option<Option<BothHeights>> {
        let mut kept = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        kept.slots
            .contains_key(&key)
            .then(|| kept.slot(key))?
            .get()
            .cloned()
    }

    /// What is kept for a key, or made now.
    pub(super) fn get(
        &self,
        key: u128,
        make: impl FnOnce() -> Option<BothHeights>,
    ) -> Option<BothHeights> {
        let lock = || self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let cell = lock().slot(key);
        let mut is_new = false;
        let made = cell.get_or_init(|| {
            is_new = true;
            make()
        });
        if is_new {
            let facets = made.as_ref().map_or(0, BothHeights::facet_count);
            lock().grow(key, facets);
        }
        made.clone()
    }
}

impl Kept {
    /// The slot of a key, which becomes the one that was asked for last.
    fn slot(&mut self, key: u128) -> Arc<OnceLock<Option<BothHeights>>> {
        let used = self.next;
        self.next += 1;
        let slot = self.slots.entry(key).or_insert_with(|| Slot {
            cell: Arc::default(),
            used,
            facets: 0,
        });
        self.order.remove(&slot.used);
        slot.used = used;
        self.order.insert(used, key);
        Arc::clone(&slot.cell)
    }

    /// Notes how large a result is, and forgets the oldest ones if all together are too large.
    fn grow(&mut self, key: u128, facets: usize) {
        if let Some(slot) = self.slots.get_mut(&key) {
            self.facets += facets - slot.facets;
            slot.facets = facets;
        }
        while self.facets > MAX_FACETS
            && self.order.len() > 1
            && let Some((_, oldest)) = self.order.pop_first()
        {
            let forgotten = self.slots.remove(&oldest);
            self.facets -= forgotten.map_or(0, |slot| slot.facets);
        }
    }
}

/// How far a solid by itself reaches from its plane, over points of the drawing.
#[derive(Debug, Clone)]
pub struct SolidHeights {
    both: BothHeights,
    /// From the drawing, y down, to the solid's final positions.
    to_final: DAffine2,
    scale: f64,
}

impl SolidHeights {
    /// The heights of a solid, its plane at depth 0.
    pub fn of(solid: &Solid, recent: &RecentHeights) -> Self {
        Self {
            both: recent.of_solid(solid),
            to_final: solid.to_final(),
            scale: solid.options.placement.scale,
        }
    }

    /// How far it reaches to the front over a point, drawing units; 0 beside it.
    pub fn front(&self, point: DVec2) -> f64 {
        let height = self.both.front.at(self.to_final.transform_point2(point));
        height.unwrap_or(0.0) / self.scale
    }

    /// How far it reaches to the front and to the back at most, drawing units.
    pub fn highest(&self) -> [f64; 2] {
        [&self.both.front, &self.both.back].map(|side| side.highest() / self.scale)
    }
}
