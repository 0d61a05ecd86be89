//! Which place of one contour belongs to which of another.

use crate::math;
use glam::{DMat2, DVec2};

use super::contour::{Contour, Ends};

/// Samples along a contour.
const SAMPLES: usize = 48;
/// The fewest samples between two places that belong together.
const LEAST_SAMPLES: usize = 6;
/// The cost of different directions: this times one minus the cosine between them.
const DIRECTION: f64 = 0.1;
/// The cost of different turns, likewise: corners belong to corners.
const TURN: f64 = 0.1;
/// The cost of unequal lengths between two cuts: this times the square of the difference between two samples' shares.
const DRIFT: f64 = 3.0;
/// The cost of a sample that has no partner of its own.
const STEP: f64 = 0.02;
/// The smaller side of a contour's box counts at least this, relative to the larger.
const LEAST_SIDE: f64 = 0.05;
/// An affine map with a smaller determinant says nothing of directions.
const LEAST_DETERMINANT: f64 = 0.05;

/// A map between the places of two contours that keeps their order. Places are shares of the length.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Map {
    /// Ascending in both. Of a ring the last is the first, once around.
    knots: Vec<[f64; 2]>,
    ends: Ends,
}

impl Map {
    /// The place on the second contour of one on the first.
    pub(super) fn forth(&self, place: f64) -> f64 {
        self.map(place, 0, 1)
    }

    /// The place on the first contour of one on the second.
    pub(super) fn back(&self, place: f64) -> f64 {
        self.map(place, 1, 0)
    }

    fn map(&self, place: f64, from: usize, to: usize) -> f64 {
        let [Some(first), Some(_)] = [self.knots.first(), self.knots.get(1)] else {
            return place;
        };
        let place = match self.ends {
            Ends::Joined => first[from] + (place - first[from]).rem_euclid(1.0),
            Ends::Free => place,
        };
        let after = self.knots.partition_point(|knot| knot[from] <= place);
        let after = after.clamp(1, self.knots.len() - 1);
        let (a, b) = (self.knots[after - 1], self.knots[after]);
        let length = b[from] - a[from];
        let along = if length > 0.0 {
            ((place - a[from]) / length).clamp(0.0, 1.0)
        } else {
            0.0
        };
        let mapped = a[to] + along * (b[to] - a[to]);
        match self.ends {
            Ends::Joined => mapped.rem_euclid(1.0),
            Ends::Free => mapped,
        }
    }
}

/// The map between two rings or two lines. `cuts` are places on both that belong together, in the order of both.
pub(super) fn correspond(a: &Contour, b: &Contour, cuts: &[[f64; 2]]) -> Map {
    let to_unit = [unit(a), unit(b)];
    let first = knots([a, b], to_unit, cuts);
    let mut best = first;
    // Samples of parts that turn are compared after the turn that the first map finds.
    if let Some(turned) = affine([a, b], to_unit, &best.1) {
        let second = knots([a, b], [turned, to_unit[1]], cuts);
        if second.0 < best.0 {
            best = second;
        }
    }
    Map {
        knots: best.1,
        ends: a.ends,
    }
}

/// A map of the plane.
#[derive(Debug, Clone, Copy)]
struct Affine {
    linear: DMat2,
    offset: DVec2,
}

impl Affine {
    fn at(&self, point: DVec2) -> DVec2 {
        self.linear * point + self.offset
    }
}

/// The map of a contour's box to the unit square.
fn unit(contour: &Contour) -> Affine {
    let points = &contour.points;
    let first = points.first().copied().unwrap_or_default();
    let (low, high) =
        (points.iter()).fold((first, first), |(low, high), p| (low.min(*p), high.max(*p)));
    let size = high - low;
    let size = size.max(DVec2::splat(size.max_element() * LEAST_SIDE));
    let size = size.max(DVec2::splat(f64::MIN_POSITIVE));
    Affine {
        linear: DMat2::from_diagonal(1.0 / size),
        offset: -low.midpoint(high) / size,
    }
}

/// The affine map of the first contour that brings it nearest to the second's in its box (least squares).
fn affine([a, b]: [&Contour; 2], to_unit: [Affine; 2], knots: &[[f64; 2]]) -> Option<Affine> {
    let map = Map {
        knots: knots.to_vec(),
        ends: a.ends,
    };
    let each = (0..SAMPLES).map(|i| {
        let place = i as f64 / SAMPLES as f64;
        (
            to_unit[0].at(a.point(place)),
            to_unit[1].at(b.point(map.forth(place))),
        )
    });
    let pairs: Vec<(DVec2, DVec2)> = each.collect();
    let count = pairs.len() as f64;
    let sum = |(a, b): (DVec2, DVec2), pair: &(DVec2, DVec2)| (a + pair.0, b + pair.1);
    let means = pairs.iter().fold((DVec2::ZERO, DVec2::ZERO), sum);
    let means = (means.0 / count, means.1 / count);
    let (mut own, mut mixed) = (DMat2::ZERO, DMat2::ZERO);
    for (p, q) in &pairs {
        let (p, q) = (*p - means.0, *q - means.1);
        own += DMat2::from_cols(p * p.x, p * p.y);
        mixed += DMat2::from_cols(q * p.x, q * p.y);
    }
    if own.determinant() < 1e-6 {
        return None;
    }
    let linear = mixed * own.inverse();
    let is_usable = linear.determinant() > LEAST_DETERMINANT;
    is_usable.then(|| Affine {
        linear: linear * to_unit[0].linear,
        offset: linear * (to_unit[0].offset - means.0) + means.1,
    })
}

/// Points along a contour, with the directions in which it runs there.
struct Samples {
    places: Vec<f64>,
    points: Vec<DVec2>,
    directions: Vec<DVec2>,
    /// The turn at each, as a unit vector.
    turns: Vec<DVec2>,
}

impl Samples {
    /// Samples at equal distances from a place on, over a share of the contour's length. The nearest samples move to corners.
    fn new(
        contour: &Contour,
        to_unit: Affine,
        [from, length]: [f64; 2],
        count: usize,
        ends: Ends,
    ) -> Self {
        let last = if ends == Ends::Joined {
            count
        } else {
            count + 1
        };
        let step = length / count as f64;
        let mut places: Vec<f64> = (0..last).map(|i| from + i as f64 * step).collect();
        let mut sharpest = vec![0.0; last];
        for (corner, turn) in contour.corners() {
            let from_start = match contour.ends {
                Ends::Joined => (corner - from).rem_euclid(1.0),
                Ends::Free => corner - from,
            };
            let nearest = (from_start / step).round();
            if !(0.0..=count as f64).contains(&nearest) || step <= 0.0 {
                continue;
            }
            let index = nearest as usize;
            if ends == Ends::Free && (index == 0 || index == count) {
                continue;
            }
            let (index, place) = if index == count {
                (0, from + from_start - length)
            } else {
                (index, from + from_start)
            };
            if f64::abs(turn) > sharpest[index] {
                sharpest[index] = f64::abs(turn);
                places[index] = place;
            }
        }
        let window = step / 2.0;
        let at = |place: f64| to_unit.at(contour.point(place));
        Self {
            points: places.iter().map(|place| at(*place)).collect(),
            directions: (places.iter())
                .map(|place| (at(place + window) - at(place - window)).normalize_or_zero())
                .collect(),
            turns: (places.iter())
                .map(|place| math::direction(contour.turn(*place)))
                .collect(),
            places,
        }
    }
}

/// The cost of the best map and its knots.
fn knots(contours: [&Contour; 2], to_unit: [Affine; 2], cuts: &[[f64; 2]]) -> (f64, Vec<[f64; 2]>) {
    let ends = contours[0].ends;
    let (Some(first), Ends::Joined) = (cuts.first(), ends) else {
        if ends == Ends::Free {
            let cuts = [&[[0.0; 2]], cuts, &[[1.0; 2]]].concat();
            return pieces(contours, to_unit, &cuts);
        }
        return around(contours, to_unit);
    };
    let mut all = vec![*first];
    for cut in &cuts[1..] {
        let after = [0, 1].map(|i| first[i] + (cut[i] - first[i]).rem_euclid(1.0));
        all.push(after);
    }
    all.push(first.map(|place| place + 1.0));
    pieces(contours, to_unit, &all)
}

/// Between places that belong together.
fn pieces(
    contours: [&Contour; 2],
    to_unit: [Affine; 2],
    cuts: &[[f64; 2]],
) -> (f64, Vec<[f64; 2]>) {
    let mut total = 0.0;
    let mut all = Vec::new();
    for cut in cuts.windows(2) {
        let lengths = [0, 1].map(|i| cut[1][i] - cut[0][i]);
        let share = lengths[0].max(lengths[1]).clamp(0.0, 1.0);
        let count = ((share * SAMPLES as f64).ceil() as usize).max(LEAST_SAMPLES);
        let samples = [0, 1].map(|i| {
            let part = [cut[0][i], lengths[i]];
            Samples::new(contours[i], to_unit[i], part, count, Ends::Free)
        });
        let costs = Costs::new(&samples);
        let paths = Paths {
            steps: count,
            band: count.div_ceil(2).max(LEAST_SAMPLES),
            drift: DRIFT,
        };
        let (cost, path) = paths.best(&costs, 0);
        total += cost;
        all.push(cut[0]);
        let inner = path.iter().filter(|cell| {
            let is_inner = |i: &usize| *i > 0 && *i < count;
            cell.iter().all(is_inner)
        });
        all.extend(places(inner, &samples, &costs));
    }
    all.extend(cuts.last());
    (total, all)
}

/// Between two rings, wherever they start.
fn around(contours: [&Contour; 2], to_unit: [Affine; 2]) -> (f64, Vec<[f64; 2]>) {
    let samples = [0, 1].map(|i| {
        let whole = [0.0, 1.0];
        Samples::new(contours[i], to_unit[i], whole, SAMPLES, Ends::Joined)
    });
    let costs = Costs::new(&samples);
    let paths = Paths {
        steps: SAMPLES,
        band: SAMPLES / 4,
        // Where a ring starts is a guess, so shares of the length say little.
        drift: 0.0,
    };
    // Some sample of the second contour belongs to the first of the first: all are tried.
    let mut best = (f64::INFINITY, 0);
    for start in 0..SAMPLES {
        let cost = paths.cost(&costs, start, best.0);
        if cost < best.0 {
            best = (cost, start);
        }
    }
    let (cost, path) = paths.best(&costs, best.1);
    let is_inner = |cell: &&[usize; 2]| cell[0] < SAMPLES && cell[1] < best.1 + SAMPLES;
    let inner = path.iter().filter(is_inner);
    let mut knots = places(inner, &samples, &costs);
    if let Some(first) = knots.first().copied() {
        knots.push(first.map(|place| place + 1.0));
    }
    (cost, knots)
}

/// The places of a path's cells. Where a sample has several partners only the most similar is kept, so that the places ascend
/// in both contours.
fn places<'a>(
    path: impl Iterator<Item = &'a [usize; 2]>,
    samples: &[Samples; 2],
    costs: &Costs,
) -> Vec<[f64; 2]> {
    let path: Vec<[usize; 2]> = path.copied().collect();
    let mut order: Vec<usize> = (0..path.len()).collect();
    let cost = |cell: &[usize; 2]| costs.at(cell[0], cell[1]);
    order.sort_by(|a, b| cost(&path[*a]).total_cmp(&cost(&path[*b])));
    let mut kept = vec![false; path.len()];
    // A path's cells that share a sample are neighbours on it.
    for index in order {
        let shares = |other: &[usize; 2]| other[0] == path[index][0] || other[1] == path[index][1];
        let before = path[..index].iter().zip(&kept[..index]).rev();
        let after = path[index + 1..].iter().zip(&kept[index + 1..]);
        let mut beside = (before.take_while(|(cell, _)| shares(cell)))
            .chain(after.take_while(|(cell, _)| shares(cell)));
        kept[index] = !beside.any(|(_, is_kept)| *is_kept);
    }
    let place = |sample: &Samples, i: usize| {
        let count = sample.places.len();
        let turns = (i / count) as f64;
        sample.places[i % count] + turns
    };
    let kept = path.iter().zip(&kept).filter(|(_, is_kept)| **is_kept);
    kept.map(|(cell, _)| [place(&samples[0], cell[0]), place(&samples[1], cell[1])])
        .collect()
}

/// What it costs to let a sample belong to another.
struct Costs {
    counts: [usize; 2],
    of: Vec<f64>,
}

impl Costs {
    fn new([a, b]: &[Samples; 2]) -> Self {
        let mut of = Vec::with_capacity(a.points.len() * b.points.len());
        for i in 0..a.points.len() {
            for j in 0..b.points.len() {
                let direction = 1.0 - a.directions[i].dot(b.directions[j]);
                let turn = 1.0 - a.turns[i].dot(b.turns[j]);
                let distance = a.points[i].distance_squared(b.points[j]);
                of.push(distance + DIRECTION * direction + TURN * turn);
            }
        }
        Self {
            counts: [a.points.len(), b.points.len()],
            of,
        }
    }

    /// Indices wrap around.
    fn at(&self, i: usize, j: usize) -> f64 {
        self.of[i % self.counts[0] * self.counts[1] + j % self.counts[1]]
    }
}

/// Monotone paths from (0, 0) to (steps, steps) that stay near the diagonal.
struct Paths {
    steps: usize,
    band: usize,
    drift: f64,
}

impl Paths {
    /// The cost of a cell apart from the similarity.
    fn drift(&self, i: usize, j: usize) -> f64 {
        let away = (i as f64 - j as f64) / self.steps as f64;
        self.drift * away * away
    }

    fn band(&self, i: usize) -> std::ops::RangeInclusive<usize> {
        i.saturating_sub(self.band)..=(i + self.band).min(self.steps)
    }

    /// The cost of the best path if the second contour starts at a sample; infinite once it exceeds a limit.
    fn cost(&self, costs: &Costs, start: usize, limit: f64) -> f64 {
        let mut row = vec![f64::INFINITY; self.steps + 1];
        let mut before = row.clone();
        for i in 0..=self.steps {
            std::mem::swap(&mut row, &mut before);
            row.fill(f64::INFINITY);
            let mut least = f64::INFINITY;
            for j in self.band(i) {
                let from = if i == 0 && j == 0 {
                    0.0
                } else {
                    let diagonal = if j > 0 { before[j - 1] } else { f64::INFINITY };
                    let left = if j > 0 { row[j - 1] } else { f64::INFINITY };
                    diagonal.min(left.min(before[j]) + STEP)
                };
                row[j] = from + costs.at(i, start + j) + self.drift(i, j);
                least = least.min(row[j]);
            }
            if least >= limit {
                return f64::INFINITY;
            }
        }
        row[self.steps]
    }

    /// The best path, by pairs of samples; those of the second contour count from the start of the contour.
    fn best(&self, costs: &Costs, start: usize) -> (f64, Vec<[usize; 2]>) {
        let width = self.steps + 1;
        let mut sums = vec![f64::INFINITY; width * width];
        let before = |sums: &[f64], i: usize, j: usize| {
            let at = |i: usize, j: usize| sums[i * width + j];
            let mut best = (f64::INFINITY, [i, j]);
            if i > 0 && j > 0 {
                best = (at(i - 1, j - 1), [i - 1, j - 1]);
            }
            if i > 0 && at(i - 1, j) + STEP < best.0 {
                best = (at(i - 1, j) + STEP, [i - 1, j]);
            }
            if j > 0 && at(i, j - 1) + STEP < best.0 {
                best = (at(i, j - 1) + STEP, [i, j - 1]);
            }
            best
        };
        for i in 0..=self.steps {
            for j in self.band(i) {
                let from = if i + j == 0 {
                    0.0
                } else {
                    before(&sums, i, j).0
                };
                sums[i * width + j] = from + costs.at(i, start + j) + self.drift(i, j);
            }
        }
        let mut cell = [self.steps; 2];
        let mut path = vec![];
        loop {
            path.push([cell[0], cell[1] + start]);
            let next = before(&sums, cell[0], cell[1]).1;
            if next == cell {
                break;
            }
            cell = next;
        }
        path.reverse();
        (sums[width * width - 1], path)
    }
}
