//! One triangle list for a polygon's whole range.

use glam::DVec2;

use super::holes::{Crossings, samples};

/// Polygons with more points are split along a chord first.
const MAX_DIRECT: usize = 256;
/// Even those without a chord that lies inside are split if they have more points.
const MAX_UNSPLIT: usize = 512;
/// Of more views than this, only every two that follow each other are looked at between.
const MAX_PAIRED: usize = 6;
/// The cost of inverted area relative to the polygon's.
const INVERTED: f64 = 1000.0;
/// The cost of a diagonal's squared length relative to the polygon's squared extent.
const LENGTH: f64 = 1e-3;
/// How many points a polygon is looked at when it is split.
const CHORD_ENDS: usize = 96;

/// The triangles of a polygon that is given by indices into the points of each view, y up, counter-clockwise. A polygon may
/// visit a point twice (bridges to holes).
///
/// Minimum-weight triangulation by interval dynamic programming (Klincsek, *Minimal triangulations of polygonal domains*,
/// 1980). The weight of a triangle is the inverted part of its area in every view, and for every pair of views in the middle
/// and where it is smallest between them: the area is quadratic in the blend.
pub(super) fn triangulate(views: &[Vec<DVec2>], polygon: &[u32]) -> Vec<[u32; 3]> {
    let mut triangles = Vec::new();
    let mut waiting = vec![polygon.to_vec()];
    while let Some(polygon) = waiting.pop() {
        let chord = if polygon.len() > MAX_DIRECT {
            chord(views, &polygon)
        } else {
            None
        };
        if let Some([from, to]) = chord {
            waiting.push(polygon[from..=to].to_vec());
            waiting.push([&polygon[to..], &polygon[..=from]].concat());
        } else {
            direct(views, &polygon, &mut triangles);
        }
    }
    triangles
}

/// Doubled areas of the triangles between the origin and two points of the polygon, by pairs of points.
struct Areas {
    count: usize,
    of: Vec<f64>,
}

impl Areas {
    /// Those of the products of one view's points with another's. They are antisymmetric.
    fn new(a: &[DVec2], b: &[DVec2], scale: f64) -> Self {
        let mut of = Vec::with_capacity(a.len() * a.len());
        for (a0, b0) in a.iter().zip(b) {
            let each = a.iter().zip(b);
            of.extend(each.map(|(a1, b1)| scale * (a0.perp_dot(*b1) + b0.perp_dot(*a1))));
        }
        let count = a.len();
        Self { count, of }
    }

    fn row(&self, i: usize) -> &[f64] {
        &self.of[i * self.count..(i + 1) * self.count]
    }
}

/// The areas in two views, and the mixed ones between them: area(t) = (1−t)² first + t² second + t(1−t) mixed.
struct Pair {
    first: usize,
    second: usize,
    mixed: Areas,
}

fn direct(views: &[Vec<DVec2>], polygon: &[u32], triangles: &mut Vec<[u32; 3]>) {
    let count = polygon.len();
    if count < 3 || views.is_empty() {
        return;
    }
    let views: Vec<Vec<DVec2>> = (views.iter())
        .map(|view| around_origin(polygon.iter().map(|i| view[*i as usize])))
        .collect();
    let area = views.iter().map(|view| doubled_area(view).abs());
    let area = area.sum::<f64>() / views.len() as f64;
    let extent = views.iter().flatten().map(|p| p.length_squared());
    let extent = extent.fold(f64::MIN_POSITIVE, f64::max);
    let scale = 1.0 / area.max(1e-9 * extent);

    let own: Vec<Areas> = (views.iter())
        .map(|view| Areas::new(view, view, scale / 2.0))
        .collect();
    let mut pairs = Vec::new();
    for second in 1..views.len() {
        let from = if views.len() > MAX_PAIRED {
            second - 1
        } else {
            0
        };
        for first in from..second {
            let mixed = Areas::new(&views[first], &views[second], scale);
            pairs.push(Pair {
                first,
                second,
                mixed,
            });
        }
    }
    let weights = Weights { own, pairs };
    let length = |i: usize, j: usize| {
        let squared = views.iter().map(|view| view[i].distance_squared(view[j]));
        squared.sum::<f64>() * LENGTH / (extent * views.len() as f64)
    };

    // Symmetric, so that both parts of an interval are read along rows.
    let mut best = vec![0.0; count * count];
    let mut costs = vec![0.0; count];
    for i in (0..count).rev() {
        for j in i + 2..count {
            weights.costs(&best, [i, j], &mut costs);
            let least = costs[i + 1..j]
                .iter()
                .copied()
                .fold(f64::INFINITY, f64::min);
            let cost = least + length(i, j);
            best[i * count + j] = cost;
            best[j * count + i] = cost;
        }
    }

    let mut waiting = vec![[0, count - 1]];
    while let Some([i, j]) = waiting.pop() {
        if j < i + 2 {
            continue;
        }
        weights.costs(&best, [i, j], &mut costs);
        let mut middle = i + 1;
        for k in i + 1..j {
            if costs[k] < costs[middle] {
                middle = k;
            }
        }
        let corners = [polygon[i], polygon[middle], polygon[j]];
        if corners[0] != corners[1] && corners[1] != corners[2] && corners[2] != corners[0] {
            triangles.push(corners);
        }
        waiting.push([i, middle]);
        waiting.push([middle, j]);
    }
}

struct Weights {
    own: Vec<Areas>,
    pairs: Vec<Pair>,
}

impl Weights {
    /// For every corner k between i and j, what the triangle i, k, j and the parts beside it cost.
    fn costs(&self, best: &[f64], [i, j]: [usize; 2], costs: &mut [f64]) {
        let count = costs.len();
        let range = i + 1..j;
        let row = |of: usize| &best[of * count..][range.clone()];
        let costs = &mut costs[range.clone()];
        for ((cost, a), b) in costs.iter_mut().zip(row(i)).zip(row(j)) {
            *cost = a + b;
        }
        if self.pairs.is_empty() {
            for areas in &self.own {
                let (a, b, base) = rows(areas, [i, j]);
                let (a, b) = (&a[range.clone()], &b[range.clone()]);
                for ((cost, a), b) in costs.iter_mut().zip(a).zip(b) {
                    *cost += INVERTED * inverted(a - b - base);
                }
            }
        }
        for pair in &self.pairs {
            let (a0, b0, base0) = rows(&self.own[pair.first], [i, j]);
            let (a1, b1, base1) = rows(&self.own[pair.second], [i, j]);
            let (am, bm, base_m) = rows(&pair.mixed, [i, j]);
            let [a0, b0, a1, b1, am, bm] = [a0, b0, a1, b1, am, bm].map(|row| &row[range.clone()]);
            let count = costs.len();
            let (a0, b0, a1, b1) = (&a0[..count], &b0[..count], &a1[..count], &b1[..count]);
            let (am, bm) = (&am[..count], &bm[..count]);
            for k in 0..count {
                let first = a0[k] - b0[k] - base0;
                let second = a1[k] - b1[k] - base1;
                let mixed = am[k] - bm[k] - base_m;
                let middle = (first + second + mixed) / 4.0;
                let curvature = first + second - mixed;
                let slope = 2.0 * first - mixed;
                let lowest = first - slope * slope / (4.0 * curvature);
                let is_between = (slope > 0.0) & (slope < 2.0 * curvature);
                let lowest = if is_between { lowest } else { 0.0 };
                let sum = inverted(first) + inverted(second) + inverted(middle) + inverted(lowest);
                costs[k] += INVERTED * sum;
            }
        }
    }
}

/// The rows of two points, and the entry of both.
fn rows(areas: &Areas, [i, j]: [usize; 2]) -> (&[f64], &[f64], f64) {
    let row = areas.row(i);
    (row, areas.row(j), row[j])
}

fn inverted(area: f64) -> f64 {
    if area < 0.0 { -area } else { 0.0 }
}

fn around_origin(points: impl Iterator<Item = DVec2>) -> Vec<DVec2> {
    let mut points: Vec<DVec2> = points.collect();
    let mean = points.iter().sum::<DVec2>() / points.len().max(1) as f64;
    for point in &mut points {
        *point -= mean;
    }
    points
}

fn doubled_area(points: &[DVec2]) -> f64 {
    let next = points.iter().cycle().skip(1);
    points.iter().zip(next).map(|(a, b)| a.perp_dot(*b)).sum()
}

/// The shortest chord that splits a polygon into two of similar size and lies inside in all views and between them. A very
/// large polygon is split even if there is none.
fn chord(views: &[Vec<DVec2>], polygon: &[u32]) -> Option<[usize; 2]> {
    let samples = samples(views);
    let crossings = Crossings::new(&samples, polygon);
    let count = polygon.len();
    let step = count.div_ceil(CHORD_ENDS);
    let mut chords = Vec::new();
    for from in (0..count).step_by(step) {
        for to in (from + count / 4..count.min(from + count - count / 4)).step_by(step) {
            if polygon[from] != polygon[to] {
                let [a, b] = [from, to].map(|i| polygon[i] as usize);
                let length = views.iter().map(|view| view[a].distance_squared(view[b]));
                chords.push((length.sum::<f64>(), [from, to]));
            }
        }
    }
    chords.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut best = None;
    for (_, chord) in chords {
        let count = crossings.of(chord);
        if count == 0 {
            return Some(chord);
        }
        if best.is_none_or(|(least, _)| count < least) {
            best = Some((count, chord));
        }
    }
    best.map(|(_, chord)| chord).filter(|_| count > MAX_UNSPLIT)
}
