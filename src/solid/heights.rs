//! How far solids come towards the viewer, looked up in their surfaces.

use std::sync::{Arc, LazyLock, OnceLock};

use glam::{DVec2, DVec3, Vec2, Vec3};
use rstar::{AABB, PointDistance, RTree, RTreeObject};
use rustc_hash::FxHashSet;

use super::Solid;
use super::cells::{Cells, Lists};
use super::inflate::{Field, Mesh};
use crate::budget::{self, Step};
use crate::scene::{Surface, SurfaceSource};

/// Triangles that are steeper than this, as the cosine of their slope, are walls, which nothing lies on.
const WALL: f64 = 1e-6;
/// The distance, relative to the largest coordinate, at which a point counts as lying in a triangle.
const SLACK: f64 = 1e-7;
/// Cells a triangle: few, so that most triangles reach into four at most.
const CELLS: f64 = 1.0;
/// The most cells that a triangle reaches into on average; with more, the cells are larger. It is about four unless the triangles are needles.
const MOST_REACHED: usize = 16;

/// The side of a surface that faces the viewer.
#[derive(Debug)]
pub(super) struct Heights {
    facets: Vec<Facet>,
    grid: Grid,
    /// Whether no point lies in several triangles.
    is_field: bool,
    slack: f64,
    highest: f64,
    border: OnceLock<Border>,
    corners: OnceLock<Vec<Vec2>>,
}

/// The edges at which nothing on the other side faces the viewer.
#[derive(Debug)]
enum Border {
    /// All of it is at this height, as around soft kinds.
    Level(f64),
    Uneven(RTree<Edge>),
}

impl Heights {
    /// The heights of a surface.
    #[cfg(test)]
    pub(super) fn of(surface: &Surface) -> Self {
        Self::over(Facet::of(surface), false)
    }

    /// The heights over a mesh whose points have these.
    pub(super) fn over_mesh(mesh: &Mesh, height: impl Fn(usize) -> f64) -> Self {
        let place = |i: u32| {
            let [x, y] = mesh.points[i as usize];
            Vec3::new(x, y, height(i as usize) as f32)
        };
        let mut facets = Vec::with_capacity(mesh.triangles.len());
        let mut corners = Vec::with_capacity(mesh.points.len());
        let mut is_new = vec![true; mesh.points.len()];
        for triangle in &mesh.triangles {
            let Some(facet) = Facet::new(triangle.map(place)) else {
                continue;
            };
            for (i, corner) in triangle.iter().zip(facet.corners) {
                if std::mem::take(&mut is_new[*i as usize]) {
                    corners.push(corner.truncate());
                }
            }
            facets.push(facet);
        }
        Self {
            corners: corners.into(),
            ..Self::over(facets, true)
        }
    }

    fn over(facets: Vec<Facet>, is_field: bool) -> Self {
        let corners = || facets.iter().flat_map(|facet| facet.corners);
        let largest = corners().fold(0.0_f32, |most, corner| most.max(corner.abs().max_element()));
        let highest = corners().map(|corner| corner.z).reduce(f32::max);
        Self {
            highest: highest.unwrap_or(0.0).into(),
            grid: Grid::of(&facets),
            facets,
            is_field,
            slack: SLACK * f64::from(largest),
            border: OnceLock::new(),
            corners: OnceLock::new(),
        }
    }

    /// The height over a point of the drawing plane, if the surface is there.
    pub(super) fn at(&self, point: DVec2) -> Option<f64> {
        self.find(point).map(|(height, _)| height)
    }

    /// The height over a point of the drawing plane, if the surface is there, and the number of the triangle.
    pub(super) fn find(&self, point: DVec2) -> Option<(f64, u32)> {
        let near = self.grid.at(point).iter();
        let mut found = near.filter_map(|index| {
            let height = self.facets[*index as usize].height(point, self.slack);
            Some((height?, *index))
        });
        if self.is_field {
            found.next()
        } else {
            found.reduce(|one, other| if other.0 > one.0 { other } else { one })
        }
    }

    /// The greatest height; 0 for nothing.
    pub(super) fn highest(&self) -> f64 {
        self.highest
    }

    /// The height at the point of the surface's border that is nearest to a point of the drawing plane; `None` for a surface of walls
    /// only.
    pub(super) fn nearest(&self, point: DVec2) -> Option<f64> {
        if self.facets.is_empty() {
            return None;
        }
        match self.border.get_or_init(|| self.find_border()) {
            Border::Level(level) => Some(*level),
            Border::Uneven(edges) => {
                let edge = edges.nearest_neighbor(point.to_array())?;
                Some(edge.nearest(point).z)
            }
        }
    }

    fn find_border(&self) -> Border {
        let place = |corner: Vec3| corner.to_array().map(f32::to_bits);
        let mut edges: FxHashSet<[[u32; 3]; 2]> = FxHashSet::default();
        for facet in &self.facets {
            let [a, b, c] = facet.corners.map(place);
            edges.extend([[a, b], [b, c], [c, a]]);
        }
        let point = |place: [u32; 3]| Vec3::from(place.map(f32::from_bits)).as_dvec3();
        let alone = edges.iter().filter(|[a, b]| !edges.contains(&[*b, *a]));
        let mut border: Vec<Edge> = alone.map(|ends| Edge(ends.map(point))).collect();
        let ends = || border.iter().flat_map(|edge| edge.0.map(|end| end.z));
        let (low, high) = ends().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), z| {
            (low.min(z), high.max(z))
        });
        if high - low <= self.slack {
            return Border::Level(low);
        }
        // The tree, and so the nearest of several at the same distance, depends on the order.
        border.sort_unstable_by(|a, b| a.order(b));
        Border::Uneven(RTree::bulk_load(border))
    }

    /// The corners of the triangles, each of them once.
    pub(super) fn corners(&self) -> impl Iterator<Item = DVec2> + '_ {
        let corners = self.corners.get_or_init(|| {
            let mut known: FxHashSet<[u32; 2]> = FxHashSet::default();
            let all = self.facets.iter().flat_map(|facet| facet.corners);
            all.map(Vec3::truncate)
                .filter(|corner| known.insert(corner.to_array().map(f32::to_bits)))
                .collect()
        });
        corners.iter().map(|corner| corner.as_dvec2())
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
#[derive(Debug, PartialEq)]
struct Facet {
    corners: [Vec3; 3],
    /// How much higher it is per unit, across and up.
    slope: Vec2,
}

impl Facet {
    /// The triangles of a surface that face the viewer.
    fn of(surface: &Surface) -> Vec<Self> {
        let position = |corner: u32| surface.positions[corner as usize];
        // The sum maps -0.0 to 0.0.
        let at = |corner: u32| Vec3::from(position(corner).map(|x| x + 0.0));
        let triangles = surface.triangles.iter();
        let facets = triangles.map(|triangle| Self::new(triangle.map(at)));
        facets.flatten().collect()
    }

    /// A triangle, if it faces the viewer.
    fn new(corners: [Vec3; 3]) -> Option<Self> {
        let [a, b, c] = corners.map(|corner| corner.as_dvec3());
        let normal = (b - a).cross(c - a);
        (normal.z > WALL * normal.length()).then(|| Self {
            corners,
            slope: (normal.truncate() / -normal.z).as_vec2(),
        })
    }

    /// Its corners in the drawing plane.
    #[inline]
    fn flat(&self) -> [DVec2; 3] {
        // Spelled out, because this is where piles spend their time.
        let [a, b, c] = &self.corners;
        [
            DVec2::new(a.x.into(), a.y.into()),
            DVec2::new(b.x.into(), b.y.into()),
            DVec2::new(c.x.into(), c.y.into()),
        ]
    }

    #[inline]
    fn edges(&self) -> [[DVec2; 2]; 3] {
        let [a, b, c] = self.flat();
        [[a, b], [b, c], [c, a]]
    }

    /// The height over a point that is in the triangle, or outside by at most `slack`.
    #[inline]
    fn height(&self, point: DVec2, slack: f64) -> Option<f64> {
        let [a, b, c] = self.flat();
        let mut is_inside = true;
        for [from, to] in [[a, b], [b, c], [c, a]] {
            let edge = to - from;
            let distance = edge.perp_dot(point - from);
            if distance < 0.0 {
                is_inside = false;
                if distance * distance > slack * slack * edge.length_squared() {
                    return None;
                }
            }
        }
        let (low, high) = (a.min(b).min(c) - slack, a.max(b).max(c) + slack);
        // At a sharp corner, a point may be near both edges and still be far away.
        (is_inside || point.clamp(low, high) == point).then(|| {
            let [low, middle, high] = &self.corners;
            let (low, high) = (
                low.z.min(middle.z).min(high.z),
                low.z.max(middle.z).max(high.z),
            );
            let height = f64::from(self.corners[0].z) + self.slope.as_dvec2().dot(point - a);
            // In steep triangles the plane is known less precisely than the corners.
            height.clamp(low.into(), high.into())
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
    cells: Cells,
    lists: Lists<u32>,
}

impl Grid {
    fn of(facets: &[Facet]) -> Self {
        let points = || facets.iter().flat_map(|facet| facet.corners);
        let [low, high] = [
            points().reduce(Vec3::min).unwrap_or_default(),
            points().reduce(Vec3::max).unwrap_or_default(),
        ];
        let bounds = [low, high].map(|corner| corner.truncate().as_dvec2());
        let mut count = CELLS * facets.len() as f64;
        let square = Cells::over(bounds, count);
        let (cells, entries) = match Self::entries(facets, &square) {
            Some(entries) => (square, entries),
            // Needles that lie side by side are alike in shape.
            None => {
                let extents = facets.iter().map(|facet| {
                    let [a, b, c] = facet.flat();
                    a.max(b).max(c) - a.min(b).min(c)
                });
                let proportions = extents.sum::<DVec2>();
                loop {
                    let cells = Cells::alike(bounds, count, proportions);
                    if let Some(entries) = Self::entries(facets, &cells) {
                        break (cells, entries);
                    }
                    count /= 4.0;
                }
            }
        };
        Self {
            lists: Lists::new(cells.count(), &entries),
            cells,
        }
    }

    /// Cells with the triangles over them; `None` if these are too many, and there is more than one cell.
    fn entries(facets: &[Facet], cells: &Cells) -> Option<Vec<(u32, u32)>> {
        let most = MOST_REACHED * facets.len();
        let mut entries: Vec<(u32, u32)> = Vec::with_capacity(4 * facets.len());
        for (index, facet) in facets.iter().enumerate() {
            cells.of_triangle(facet.flat(), |cell| {
                entries.push((cell as u32, index as u32))
            });
            if entries.len() > most && cells.count() > 1 {
                return None;
            }
        }
        budget::count(Step::Cell, entries.len());
        Some(entries)
    }

    /// The triangles over the cell of a point.
    fn at(&self, point: DVec2) -> &[u32] {
        let cell = self.cells.at(point);
        cell.map_or(&[], |cell| self.lists.of_cell(cell))
    }

    /// The triangles over the cells that a box reaches into, some of them several times.
    fn in_box(&self, low: DVec2, high: DVec2) -> impl Iterator<Item = u32> + '_ {
        let cells = self.cells.in_box(low, high);
        cells.flat_map(|cell| self.lists.of_cell(cell).iter().copied())
    }
}

/// Heights of the front and of the back of a solid.
#[derive(Debug, Clone)]
pub(super) struct BothHeights {
    pub(super) front: Arc<Heights>,
    /// `None` where it equals the front.
    back: Option<Arc<LazyHeights>>,
}

/// Heights that are made when they are first needed.
type LazyHeights = LazyLock<Heights, Box<dyn FnOnce() -> Heights + Send + Sync>>;

impl BothHeights {
    /// The heights of a front, and of a back, which few need: those of the solid mirrored in its plane.
    pub(super) fn new(
        front: Heights,
        back: impl FnOnce() -> Heights + Send + Sync + 'static,
    ) -> Self {
        Self {
            front: Arc::new(front),
            back: Some(Arc::new(LazyLock::new(Box::new(back)))),
        }
    }

    /// The heights of a solid in its own frame, whose field this is if it has one.
    pub(super) fn of_solid(solid: &Solid, field: Option<&Field>) -> Self {
        match field {
            Some(field) if solid.options.placement.translation.z == 0.0 => Self {
                front: Arc::new(Heights::over_mesh(&field.mesh, |i| field.heights[i])),
                back: None,
            },
            _ => Self::of(&solid.surface()),
        }
    }

    /// The heights of both sides of a surface.
    fn of(surface: &Surface) -> Self {
        let [front, back] = [Facet::of(surface), Facet::of(&surface.mirrored())];
        // Most solids are their own mirror images.
        let is_symmetric = front == back;
        let back = || -> Arc<LazyHeights> {
            Arc::new(LazyLock::new(Box::new(|| Heights::over(back, false))))
        };
        Self {
            front: Arc::new(Heights::over(front, false)),
            back: (!is_symmetric).then(back),
        }
    }

    /// The heights of the solid mirrored in its plane.
    pub(super) fn back(&self) -> &Heights {
        self.back.as_deref().map_or(&self.front, |back| back)
    }

    /// Whether both sides are the same.
    pub(super) fn is_symmetric(&self) -> bool {
        self.back.is_none()
    }

    /// The number of triangles of its front.
    pub(super) fn facet_count(&self) -> usize {
        self.front.facets.len()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Separate triangles, most of them in clusters that are each a hundredth of the one around it.
    fn clustered(random: &mut fastrand::Rng, count: usize) -> Vec<Facet> {
        let facets = (0..count).filter_map(|_| {
            let size = [1.0, 1e-2, 1e-4][random.usize(0..3)];
            let mut place = || Vec3::new(random.f32(), random.f32(), random.f32()) * size;
            let [a, b, c] = [place(), place() * 0.1, place() * 0.1];
            Facet::new([a, a + b, a + c]).or_else(|| Facet::new([a, a + c, a + b]))
        });
        facets.collect()
    }

    #[test]
    fn triangles_are_found_in_clusters() {
        let mut random = fastrand::Rng::with_seed(7);
        let mut found = 0;
        for _ in 0..20 {
            let heights = Heights::over(clustered(&mut random, 600), false);
            for facet in &heights.facets {
                let [a, b, c] = facet.flat();
                let place = a.lerp(b, random.f64()).lerp(c, random.f64());
                let over = heights.facets.iter();
                let over = over.filter_map(|facet| facet.height(place, heights.slack));
                assert_eq!(heights.at(place), over.reduce(f64::max), "{place}");
                found += 1;
            }
        }
        assert!(found > 10_000, "{found}");
    }
}
