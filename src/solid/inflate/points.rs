//! Samples the points of an inflated outline.
//!
//! From points along the border, columns lead inward to the middle of the largest disc that touches
//! the border there and lies in the outline (shrinking ball: Ma, Bae & Choi, "3D medial axis point
//! approximation using nearest neighbors and the normal field", 2012). Their points are spaced as on a quarter
//! circle seen from the side, so they are dense where the surface is steep. Points too close to
//! others in space, for instance towards the middle of a disc, are left out.

use glam::{DVec2, DVec3};
use rstar::RTree;
use rstar::primitives::Line;
use rustc_hash::FxHashMap;

use crate::geometry::{Outline, bounds};

/// The largest number of points added along borders, and of columns.
const MAX_COLUMNS: usize = 1 << 13;
/// The largest number of inner points.
const MAX_INSIDE: usize = 1 << 16;
/// A disc counts as inside the outline if the border comes no closer to its centre than this, relative
/// to its radius: flattened curves cut off that little.
const SLACK: f64 = 0.9;
/// The largest number of iterations for a disc; a handful is usual.
const MAX_ITERATIONS: usize = 24;
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
/// The lower limit of that distance, relative to the usual one.
const LEAST_ALONG: f64 = 0.25;

/// Points in the part's frame: those of the border, then those inside.
pub(in crate::solid) struct Points {
    pub(in crate::solid) points: Vec<DVec2>,
    /// Edges of the border, as drawn or parts of these; the filled side is on the left.
    pub(in crate::solid) edges: Vec<[usize; 2]>,
}

/// A line of points from the border inward.
struct Column {
    foot: DVec2,
    /// A unit vector.
    inward: DVec2,
    /// The radius of the disc.
    radius: f64,
}

/// A point on the border between two drawn points or at one of them, with the radius there.
#[derive(Clone, Copy)]
struct Foot {
    at: DVec2,
    radius: f64,
}

struct Discs {
    border: RTree<Line<[f64; 2]>>,
    /// The radius to begin with.
    reach: f64,
}

impl Discs {
    fn of(outline: &Outline, reach: f64) -> Self {
        let rings = outline.polygons.iter().flat_map(|polygon| &polygon.rings);
        let edges = rings.flat_map(|ring| {
            let n = ring.len();
            (0..n).map(move |i| Line::new(ring[i].to_array(), ring[(i + 1) % n].to_array()))
        });
        Self {
            border: RTree::bulk_load(edges.collect()),
            reach,
        }
    }

    /// The radius of the largest disc that touches the border at `foot`; 0 where there is none.
    fn radius(&self, foot: DVec2, inward: DVec2) -> f64 {
        let mut radius = self.reach;
        for _ in 0..MAX_ITERATIONS {
            let middle = foot + radius * inward;
            let Some(edge) = self.border.nearest_neighbor(middle.to_array()) else {
                return 0.0;
            };
            let nearest = DVec2::from_array(edge.nearest_point(&middle.to_array()));
            let distance = nearest.distance(middle);
            if distance >= SLACK * radius {
                return distance.min(radius);
            }
            let to = nearest - foot;
            let smaller = to.length_squared() / (2.0 * inward.dot(to));
            if !(smaller > 0.0 && smaller < radius) {
                return 0.0;
            }
            radius = smaller;
        }
        0.0
    }
}

/// Points for an outline, y up, at about the density of a rounding of so many layers per 180°.
pub(super) fn points(outline: &Outline, segments: u32) -> Points {
    let mut all = Points {
        points: Vec::new(),
        edges: Vec::new(),
    };
    let Some((low, high)) = bounds(outline) else {
        return all;
    };
    let size = high - low;
    let discs = Discs::of(outline, size.length());
    let rings = || outline.polygons.iter().flat_map(|polygon| &polygon.rings);
    let edges =
        rings().flat_map(|ring| (0..ring.len()).map(move |i| ring[(i + 1) % ring.len()] - ring[i]));
    let around: f64 = edges.map(DVec2::length).sum();
    let usual = std::f64::consts::PI * size.min_element() / 2.0 / f64::from(segments);
    let apart = usual.max(4.0 * around / MAX_COLUMNS as f64);

    let mut columns = Vec::new();
    for ring in rings() {
        border(ring, apart, &discs, &mut all, &mut columns);
    }
    let most = columns
        .iter()
        .map(|column| column.radius)
        .fold(0.0, f64::max);
    columns.retain(|column| column.radius > NOTHING * most);
    if columns.len() > MAX_COLUMNS {
        let step = columns.len().div_ceil(MAX_COLUMNS);
        let mut place = 0;
        columns.retain(|_| {
            place += 1;
            place % step == 0
        });
    }
    let layers =
        (segments.div_ceil(2) as usize).clamp(1, (MAX_INSIDE / columns.len().max(1)).max(1));
    inside(&columns, layers, most, &mut all.points);
    all
}

/// Adds the points of a ring, and the columns that stand on them.
fn border(ring: &[DVec2], apart: f64, discs: &Discs, all: &mut Points, columns: &mut Vec<Column>) {
    let n = ring.len();
    let direction = |i: usize| (ring[(i + 1) % n] - ring[i]).normalize_or_zero();
    // Radii at corners, and columns there.
    let mut radii = vec![0.0f64; n];
    let mut last = DVec2::INFINITY;
    for i in 0..n {
        let (before, after) = (direction((i + n - 1) % n), direction(i));
        let turn = before.perp_dot(after).atan2(before.dot(after));
        if turn > CONVEX {
            continue;
        }
        let crowded = ring[i].distance(last) < LEAST_ALONG * apart;
        let count = if turn < -FAN {
            (-turn / FAN).ceil() as usize
        } else {
            0
        };
        if crowded && count == 0 {
            radii[i] = radii[(i + n - 1) % n];
            continue;
        }
        for k in 0..=count {
            let part = if count == 0 {
                0.5
            } else {
                k as f64 / count as f64
            };
            let inward = DVec2::from_angle(turn * part).rotate(before).perp();
            let radius = discs.radius(ring[i], inward);
            radii[i] = radii[i].max(radius);
            columns.push(Column {
                foot: ring[i],
                inward,
                radius,
            });
        }
        last = ring[i];
    }
    let start = all.points.len();
    for i in 0..n {
        let (from, to) = (ring[i], ring[(i + 1) % n]);
        let inward = direction(i).perp();
        let ends = [
            Foot {
                at: from,
                radius: radii[i],
            },
            Foot {
                at: to,
                radius: radii[(i + 1) % n],
            },
        ];
        all.points.push(from);
        // At the usual distance first, then closer where discs are small.
        let coarse = between(ends, apart, inward, discs);
        for pair in coarse.windows(2) {
            let mean = pair[0].radius.midpoint(pair[1].radius);
            let closer = (ALONG * mean).clamp(LEAST_ALONG * apart, apart);
            let fine = between([pair[0], pair[1]], closer, inward, discs);
            for foot in &fine[1..] {
                if foot.at != to {
                    all.points.push(foot.at);
                    columns.push(Column {
                        foot: foot.at,
                        inward,
                        radius: foot.radius,
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
fn between(ends: [Foot; 2], apart: f64, inward: DVec2, discs: &Discs) -> Vec<Foot> {
    let [from, to] = ends;
    let count = (from.at.distance(to.at) / apart * 0.8).ceil().max(1.0) as usize;
    let middle = (1..count).map(|k| {
        let at = from.at.lerp(to.at, k as f64 / count as f64);
        Foot {
            at,
            radius: discs.radius(at, inward),
        }
    });
    std::iter::once(from).chain(middle).chain([to]).collect()
}

/// Adds the columns' points, layer by layer.
fn inside(columns: &[Column], layers: usize, most: f64, points: &mut Vec<DVec2>) {
    let quarter = std::f64::consts::FRAC_PI_2;
    let count = |column: &Column| {
        let share = (column.radius / (SMALL * most)).min(1.0);
        ((layers as f64 * share).ceil() as usize).clamp(1, layers)
    };
    let cell = NEAR * most * quarter / layers as f64;
    let mut taken: FxHashMap<[i32; 3], Vec<DVec3>> = FxHashMap::default();
    for layer in 1..=layers {
        for column in columns {
            let own = count(column);
            if layer > own {
                continue;
            }
            let angle = quarter * layer as f64 / own as f64;
            let depth = column.radius * (1.0 - angle.cos());
            let at = column.foot + depth * column.inward;
            let place = at.extend(column.radius * angle.sin());
            let near = (NEAR * column.radius * quarter / own as f64).min(cell);
            let cells = |place: DVec3| (place / cell).floor().as_ivec3().to_array();
            let (low, high) = (cells(place - near), cells(place + near));
            let mut around = (low[0]..=high[0]).flat_map(|x| {
                (low[1]..=high[1]).flat_map(move |y| (low[2]..=high[2]).map(move |z| [x, y, z]))
            });
            let crowded = around.any(|cell| {
                taken.get(&cell).is_some_and(|others| {
                    others.iter().any(|other| {
                        let apart = *other - place;
                        apart.length_squared() < near * near
                            // Estimates of height may differ between columns.
                            || apart.truncate().length_squared() < (0.1 * near).powi(2)
                    })
                })
            });
            if !crowded {
                taken.entry(cells(place)).or_default().push(place);
                points.push(at);
            }
        }
    }
}
