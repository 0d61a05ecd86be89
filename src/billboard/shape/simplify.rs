//! Which points of corresponding contours are needed, in all views at once.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use glam::DVec2;

use super::contour::Ends;

/// How many points to keep. Errors are distances from a contour relative to its region's extent.
#[derive(Debug, Clone, Copy)]
pub(super) struct Limits {
    /// Errors that nobody sees.
    pub(super) fine: f64,
    /// From this count on, only errors above `coarse` are reason for another point.
    pub(super) few: usize,
    pub(super) coarse: f64,
    /// Never more.
    pub(super) many: usize,
}

/// A part of a contour that is drawn as one edge.
struct Part {
    error: f64,
    contour: usize,
    from: usize,
    worst: usize,
    to: usize,
}

impl Ord for Part {
    fn cmp(&self, other: &Self) -> Ordering {
        (self.error.total_cmp(&other.error))
            .then(other.contour.cmp(&self.contour))
            .then(other.from.cmp(&self.from))
    }
}

impl PartialOrd for Part {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Part {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Part {}

/// The indices to keep of each ring, ascending, so that every ring stays within the smallest distance that the limits allow in
/// every view. A ring is given by its points in each view; `extents` are those of the region in each view.
///
/// This is the method of Douglas and Peucker with the largest error of all views, worst part first: points that two round
/// contours both need are not needed twice.
pub(super) fn simplify(
    rings: &[Vec<Vec<DVec2>>],
    extents: &[f64],
    limits: Limits,
    ends: Ends,
) -> Vec<Vec<usize>> {
    let mut kept: Vec<Vec<usize>> = Vec::new();
    let mut parts = BinaryHeap::new();
    let scales: Vec<f64> = extents
        .iter()
        .map(|e| if *e > 0.0 { 1.0 / e } else { 0.0 })
        .collect();
    for (contour, views) in rings.iter().enumerate() {
        let count = views.first().map_or(0, Vec::len);
        if count <= 3 {
            kept.push((0..count).collect());
            continue;
        }
        if ends == Ends::Free {
            kept.push(vec![0, count - 1]);
            parts.extend(part(rings, &scales, contour, [0, count - 1]));
            continue;
        }
        // A triangle that is as large as possible, roughly.
        let first = farthest(views, &scales, |view| mean(&views[view]));
        let second = farthest(views, &scales, |view| views[view][first]);
        let [low, high] = [first.min(second), first.max(second)];
        if low == high {
            kept.push(vec![0, 1, 2]);
            continue;
        }
        kept.push(vec![low, high]);
        for [from, to] in [[low, high], [high, low + count]] {
            parts.extend(part(rings, &scales, contour, [from, to]));
        }
    }

    let least = if ends == Ends::Joined { 3 } else { 2 };
    let mut total: usize = kept.iter().map(Vec::len).sum();
    while let Some(next) = parts.pop() {
        let is_needed = kept[next.contour].len() < least;
        let is_wanted = next.error > limits.fine
            && total < limits.many
            && (total < limits.few || next.error > limits.coarse);
        if !is_needed && !is_wanted {
            // Another ring may still be without area.
            if kept.iter().all(|ring| ring.len() >= least) {
                break;
            }
            continue;
        }
        let count = rings[next.contour].first().map_or(0, Vec::len);
        kept[next.contour].push(next.worst % count);
        total += 1;
        for ends in [[next.from, next.worst], [next.worst, next.to]] {
            parts.extend(part(rings, &scales, next.contour, ends));
        }
    }
    for ring in &mut kept {
        ring.sort_unstable();
    }
    kept
}

/// The part between two points, unless it is an edge already. Indices may exceed the ring's length by up to its length.
fn part(
    rings: &[Vec<Vec<DVec2>>],
    scales: &[f64],
    contour: usize,
    [from, to]: [usize; 2],
) -> Option<Part> {
    if to <= from + 1 {
        return None;
    }
    let (mut error, mut worst) = (-1.0, from + 1);
    for (view, scale) in rings[contour].iter().zip(scales) {
        let at = |i: usize| view[if i < view.len() { i } else { i - view.len() }];
        let (a, edge) = (at(from), at(to) - at(from));
        let length = edge.length_squared();
        for i in from + 1..to {
            let offset = at(i) - a;
            let along = if length > 0.0 {
                (offset.dot(edge) / length).clamp(0.0, 1.0)
            } else {
                0.0
            };
            let distance = (offset - edge * along).length() * scale;
            if distance > error {
                (error, worst) = (distance, i);
            }
        }
    }
    Some(Part {
        error,
        contour,
        from,
        worst,
        to,
    })
}

fn mean(points: &[DVec2]) -> DVec2 {
    points.iter().sum::<DVec2>() / points.len().max(1) as f64
}

/// The index of the point farthest from others, over all views.
fn farthest(views: &[Vec<DVec2>], scales: &[f64], from: impl Fn(usize) -> DVec2) -> usize {
    let count = views.first().map_or(0, Vec::len);
    let mut farthest = (0, -1.0);
    let froms: Vec<DVec2> = (0..views.len()).map(from).collect();
    for i in 0..count {
        let each = views.iter().zip(scales).zip(&froms);
        let distance = each.fold(0.0, |sum: f64, ((view, scale), from)| {
            sum + view[i].distance(*from) * scale
        });
        if distance > farthest.1 {
            farthest = (i, distance);
        }
    }
    farthest.0
}
