//! Samples the points of an inflated outline.
//!
//! From points along the border, columns lead inward to the middle of the largest disc that touches
//! the border there and lies in the outline. Their points are spaced as on a quarter
//! circle seen from the side, so they are dense where the surface is steep. Points too close to
//! others in space, for instance towards the middle of a disc, are left out.

use glam::{DVec2, DVec3};

use super::discs::{Disc, Discs};
use crate::geometry::{Outline, bounds, bounds_of, perimeter};
use crate::math;

/// The largest number of points added along borders, and of columns.
pub(super) const MAX_COLUMNS: usize = 1 << 13;
/// The largest number of inner points.
const MAX_INSIDE: usize = 1 << 16;
/// The fewest layers per 180° of a polygon that is small beside the outline, if that has more.
const LEAST_SEGMENTS: u32 = 8;
/// Corners that turn left by more have no column, because discs in them have no size; radians.
const CONVEX: f64 = 0.9;
/// Corners that turn right have columns this far apart, radians.
const FAN: f64 = 0.4;
/// Discs smaller than this, relative to the largest, have fewer points to the middle.
const SMALL: f64 = 0.1;
/// Discs smaller than this, relative to the largest, have no columns.
const NOTHING: f64 = 0.01;
/// The smallest distance between points, relative to the steps of their columns.
const NEAR: f64 = 0.62;
/// The largest distance between points on the border, relative to the radius of the disc there.
const ALONG: f64 = 0.8;
/// Limit of the cells along each side of the grid in which points keep their distance.
const MAX_CELLS: f64 = 512.0;
/// The lower limit of that distance, relative to the usual one.
const LEAST_ALONG: f64 = 0.25;

/// Points in the part's frame: those of the border, then those inside.
#[derive(Debug)]
pub struct Points {
    pub(in crate::solid) points: Vec<DVec2>,
    /// Edges of the border, as drawn or parts of these; the filled side is on the left.
    pub(in crate::solid) edges: Vec<[usize; 2]>,
}

/// A line of points from the border inward.
pub(super) struct Column {
    pub(super) foot: DVec2,
    /// A unit vector.
    pub(super) inward: DVec2,
    /// The radius of the disc.
    pub(super) radius: f64,
}

/// A point on the border between two drawn points or at one of them, with the disc there.
#[derive(Clone, Copy)]
struct Foot {
    at: DVec2,
    disc: Disc,
}

/// Points for an outline, y up, at about the density of a rounding of so many layers per 180°.
pub(in crate::solid) fn points(outline: &Outline, segments: u32) -> Points {
    let mut all = Points {
        points: Vec::new(),
        edges: Vec::new(),
    };
    let Some(whole) = bounds(outline).map(smaller_side) else {
        return all;
    };
    let usual = spacing(whole, segments);
    let least = 4.0 * perimeter(outline) / MAX_COLUMNS as f64;
    // Of more columns, most would be left out again.
    let fan = if outline.point_count() > MAX_COLUMNS {
        f64::INFINITY
    } else {
        FAN
    };
    // Polygon by polygon, so that an eye that is drawn in one path with the other one is as round as by itself.
    let mut groups = Vec::with_capacity(outline.polygons.len());
    for polygon in &outline.polygons {
        let points = polygon.rings.iter().flatten().copied();
        let size = bounds_of(points).map_or(0.0, smaller_side);
        // What is smaller is as precise with fewer layers.
        let fewer = f64::from(segments) * (size / whole).sqrt();
        let segments = (fewer.ceil() as u32).clamp(segments.min(LEAST_SEGMENTS), segments);
        // Between the distance that it would have by itself and that of the whole, which splinters need not be finer than.
        let apart = (spacing(size, segments) * usual).sqrt().max(least);
        let discs = Discs::of(&polygon.rings);
        let mut columns = Vec::new();
        for ring in &polygon.rings {
            border(ring, [apart, fan], &discs, &mut all, &mut columns);
        }
        let radii = columns.iter().map(|column| column.radius);
        let most = radii.fold(0.0, f64::max);
        columns.retain(|column| column.radius > NOTHING * most);
        groups.push((columns, segments, most));
    }
    let count = groups.iter().map(|(columns, ..)| columns.len()).sum();
    for (mut columns, segments, most) in groups {
        let layers = thin(&mut columns, count, segments);
        inside(&columns, layers, most, &mut all.points);
    }
    all
}

/// The distance of columns on a polygon whose box is so wide at its smaller side, for a rounding of so many layers per 180°.
fn spacing(size: f64, segments: u32) -> f64 {
    std::f64::consts::PI * size / 2.0 / f64::from(segments)
}

/// The smaller side of a box.
fn smaller_side((low, high): (DVec2, DVec2)) -> f64 {
    (high - low).min_element()
}

/// Leaves columns out where there are too many of a whole outline. Returns how many points each has, for a rounding of so many layers
/// per 180°.
pub(super) fn thin(columns: &mut Vec<Column>, count: usize, segments: u32) -> usize {
    let step = count.div_ceil(MAX_COLUMNS);
    if step > 1 {
        let mut place = 0;
        columns.retain(|_| {
            place += 1;
            place % step == 0
        });
    }
    let most = MAX_INSIDE / count.clamp(1, MAX_COLUMNS);
    (segments.div_ceil(2) as usize).clamp(1, most.max(1))
}

/// Adds the points of a ring, and the columns that stand on them: about so far apart along it, and by so many radians at a corner that
/// turns right.
fn border(
    ring: &[DVec2],
    [apart, fan]: [f64; 2],
    discs: &Discs,
    all: &mut Points,
    columns: &mut Vec<Column>,
) {
    let n = ring.len();
    let direction = |i: usize| (ring[(i + 1) % n] - ring[i]).normalize_or_zero();
    let directions: Vec<DVec2> = (0..n).map(direction).collect();
    // Discs at corners, and columns there.
    let mut corners = vec![Disc::default(); n];
    let mut last = DVec2::INFINITY;
    for i in 0..n {
        let (before, after) = (directions[(i + n - 1) % n], directions[i]);
        let turn = math::atan2(before.perp_dot(after), before.dot(after));
        if turn > CONVEX {
            continue;
        }
        let neighbor = corners[(i + n - 1) % n];
        let crowded = ring[i].distance(last) < LEAST_ALONG * apart;
        let is_sharp = turn < -FAN;
        let count = if is_sharp {
            (-turn / fan).ceil() as usize
        } else {
            0
        };
        if crowded && !is_sharp {
            corners[i] = neighbor;
            continue;
        }
        for k in 0..=count {
            let part = if count == 0 {
                0.5
            } else {
                k as f64 / count as f64
            };
            let inward = math::direction(turn * part).rotate(before).perp();
            let disc = discs.disc(ring[i], inward, neighbor);
            if disc.radius > corners[i].radius {
                corners[i] = disc;
            }
            columns.push(Column {
                foot: ring[i],
                inward,
                radius: disc.radius,
            });
        }
        last = ring[i];
    }
    let start = all.points.len();
    let (mut coarse, mut fine) = (Vec::new(), Vec::new());
    for i in 0..n {
        let next = (i + 1) % n;
        let ends = [i, next].map(|i| Foot {
            at: ring[i],
            disc: corners[i],
        });
        let inward = directions[i].perp();
        all.points.push(ring[i]);
        // At the usual distance first, then closer where discs are small.
        between(ends, apart, inward, discs, &mut coarse);
        for pair in coarse.windows(2) {
            let mean = pair[0].disc.radius.midpoint(pair[1].disc.radius);
            let closer = (ALONG * mean).clamp(LEAST_ALONG * apart, apart);
            between([pair[0], pair[1]], closer, inward, discs, &mut fine);
            for foot in &fine[1..] {
                if foot.at != ring[next] {
                    all.points.push(foot.at);
                    columns.push(Column {
                        foot: foot.at,
                        inward,
                        radius: foot.disc.radius,
                    });
                }
            }
        }
    }
    let end = all.points.len();
    let next = |i: usize| if i + 1 == end { start } else { i + 1 };
    all.edges.extend((start..end).map(|i| [i, next(i)]));
}

/// Points from one to another in equal steps, both included.
fn between(ends: [Foot; 2], apart: f64, inward: DVec2, discs: &Discs, feet: &mut Vec<Foot>) {
    let [from, to] = ends;
    let count = (from.at.distance(to.at) / apart * 0.8).ceil().max(1.0) as usize;
    feet.clear();
    feet.push(from);
    let mut disc = from.disc;
    for k in 1..count {
        let at = from.at.lerp(to.at, k as f64 / count as f64);
        disc = discs.disc(at, inward, disc);
        feet.push(Foot { at, disc });
    }
    feet.push(to);
}

/// Adds the columns' points, layer by layer.
pub(super) fn inside(columns: &[Column], layers: usize, most: f64, points: &mut Vec<DVec2>) {
    let quarter = std::f64::consts::FRAC_PI_2;
    let count = |column: &Column| {
        let share = (column.radius / (SMALL * most)).min(1.0);
        ((layers as f64 * share).ceil() as usize).clamp(1, layers)
    };
    let counts: Vec<usize> = columns.iter().map(count).collect();
    let cell = NEAR * most * quarter / layers as f64;
    let ends = columns.iter().map(|column| {
        let middle = column.foot + column.radius * column.inward;
        [column.foot.min(middle), column.foot.max(middle)]
    });
    let Some([low, high]) = ends.reduce(|a, b| [a[0].min(b[0]), a[1].max(b[1])]) else {
        return;
    };
    let mut taken = Taken::new(low, high, cell);
    for layer in 1..=layers {
        let angles = |own: usize| math::sin_cos(quarter * layer as f64 / own as f64);
        let usual = angles(layers);
        for (column, own) in columns.iter().zip(&counts) {
            if layer > *own {
                continue;
            }
            let (sine, cosine) = if *own == layers { usual } else { angles(*own) };
            let depth = column.radius * (1.0 - cosine);
            let at = column.foot + depth * column.inward;
            let near = (NEAR * column.radius * quarter / *own as f64).min(cell);
            if taken.take(at.extend(column.radius * sine), near) {
                points.push(at);
            }
        }
    }
}

/// Points in space that others keep a distance from, by cells of the plane.
struct Taken {
    low: DVec2,
    /// Cells a unit.
    scale: f64,
    /// The last cell across and up.
    last: DVec2,
    /// Per cell, row by row, the number of its last point.
    cells: Vec<u32>,
    /// Each with the number of the point before it in its cell.
    points: Vec<(DVec3, u32)>,
}

impl Taken {
    /// No point before another.
    const NONE: u32 = u32::MAX;

    /// An empty grid over a box. A cell is this wide, or wider where there would be too many.
    fn new(low: DVec2, high: DVec2, cell: f64) -> Self {
        let size = high - low;
        let least = size.max_element() / MAX_CELLS;
        let scale = cell.max(least).max(f64::MIN_POSITIVE).recip();
        let last = (size * scale).floor();
        let count = (last.x as usize + 1) * (last.y as usize + 1);
        Self {
            low,
            scale,
            last,
            cells: vec![Self::NONE; count],
            points: Vec::new(),
        }
    }

    /// Adds a point unless another is nearer to it than this.
    fn take(&mut self, place: DVec3, near: f64) -> bool {
        let cell = |at: DVec2| {
            let cell = ((at - self.low) * self.scale).clamp(DVec2::ZERO, self.last);
            [cell.x as usize, cell.y as usize]
        };
        let at = place.truncate();
        let ([left, bottom], [right, top]) = (cell(at - near), cell(at + near));
        let across = self.last.x as usize + 1;
        for y in bottom..=top {
            for x in left..=right {
                let mut next = self.cells[y * across + x];
                while let Some((other, before)) = self.points.get(next as usize) {
                    let apart = *other - place;
                    // Estimates of height may differ between columns.
                    if apart.length_squared() < near * near
                        || apart.truncate().length_squared() < (0.1 * near).powi(2)
                    {
                        return false;
                    }
                    next = *before;
                }
            }
        }
        let [x, y] = cell(at);
        let first = &mut self.cells[y * across + x];
        let before = std::mem::replace(first, self.points.len() as u32);
        self.points.push((place, before));
        true
    }
}
