//! Outlines along horizontal lines: how much of one lies in another, to the precision of a few lines.
//!
//! Exact intersections of polygons take long for what is only a question of "mostly". On a line an outline is a list of
//! intervals, whose unions and differences are exact and cheap.

use glam::DVec2;

use super::Outline;

/// How many lines cross an area.
pub(crate) const LINES: usize = 16;
/// Neighbouring edges that are skipped together if no line crosses any of them.
const CHUNK: usize = 64;

/// Evenly spaced horizontal lines.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Scanlines {
    first: f64,
    step: f64,
}

/// The intervals of an area on each line, ascending and disjoint.
#[derive(Debug, Default)]
pub(crate) struct Intervals {
    lines: [Vec<[f64; 2]>; LINES],
    /// Where edges cross each line, and a line that is being changed: kept to reuse their memory.
    crossings: [Vec<f64>; LINES],
    line: Vec<[f64; 2]>,
}

/// The vertical ranges of runs of edges, so that large outlines need not be read as a whole for a few lines.
#[derive(Debug, Default, Clone)]
pub(crate) struct EdgeRanges {
    /// Per ring, its chunks; empty for a small outline.
    chunks: Vec<[f64; 2]>,
}

impl EdgeRanges {
    /// The ranges of an outline's edges.
    pub(crate) fn new(outline: &Outline) -> Self {
        if outline.point_count() <= 2 * CHUNK {
            return Self::default();
        }
        let mut chunks = Vec::new();
        for ring in outline.rings() {
            for start in (0..ring.len()).step_by(CHUNK) {
                // A chunk's last edge ends at the first point of the next one.
                let points =
                    (start..=start + CHUNK).map(|i| ring[i.min(ring.len()) % ring.len()].y);
                let range = points.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], y| {
                    [low.min(y), high.max(y)]
                });
                chunks.push(range);
            }
        }
        Self { chunks }
    }
}

impl Scanlines {
    /// Lines across a box.
    pub(crate) fn across((low, high): (DVec2, DVec2)) -> Self {
        let step = (high.y - low.y) / LINES as f64;
        Self {
            first: low.y + step / 2.0,
            step,
        }
    }

    /// The vertical position of a line.
    pub(crate) fn place(&self, line: usize) -> f64 {
        self.first + self.step * line as f64
    }

    /// The area that an interval's unit of length stands for.
    pub(crate) fn weight(&self) -> f64 {
        self.step
    }

    /// The intervals of an outline on these lines.
    pub(crate) fn cut(&self, outline: &Outline, ranges: &EdgeRanges, out: &mut Intervals) {
        let Intervals {
            lines, crossings, ..
        } = out;
        let last = self.first + self.step * (LINES - 1) as f64;
        let per_unit = self.step.recip();
        let mut edge = |a: DVec2, b: DVec2| {
            let (low, high) = if a.y < b.y { (a, b) } else { (b, a) };
            if high.y <= self.first || low.y > last || low.y == high.y {
                return;
            }
            // The last line below the edge, or the first one.
            let from = ((low.y - self.first) * per_unit) as usize;
            let mut slope = None;
            for (line, crossings) in crossings.iter_mut().enumerate().skip(from) {
                let y = self.place(line);
                if y >= high.y {
                    break;
                }
                if y >= low.y {
                    // Most edges are short, and cross no line.
                    let slope = slope.get_or_insert_with(|| (high.x - low.x) / (high.y - low.y));
                    crossings.push(low.x + (y - low.y) * *slope);
                }
            }
        };
        let mut chunk = 0;
        for ring in outline.rings() {
            if ranges.chunks.is_empty() {
                if let Some(last) = ring.last() {
                    edge(*last, ring[0]);
                }
                ring.windows(2).for_each(|pair| edge(pair[0], pair[1]));
                continue;
            }
            for start in (0..ring.len()).step_by(CHUNK) {
                let [low, high] = ranges.chunks[chunk];
                chunk += 1;
                if high <= self.first || low > last {
                    continue;
                }
                for i in start..(start + CHUNK).min(ring.len()) {
                    edge(ring[i], ring[(i + 1) % ring.len()]);
                }
            }
        }
        for (crossings, intervals) in crossings.iter_mut().zip(lines) {
            intervals.clear();
            match crossings[..] {
                [] => continue,
                [a, b] => intervals.push([a.min(b), a.max(b)]),
                _ => {
                    crossings.sort_unstable_by(f64::total_cmp);
                    let pairs = crossings.chunks_exact(2);
                    intervals.extend(pairs.map(|pair| [pair[0], pair[1]]));
                }
            }
            crossings.clear();
        }
    }
}

impl Intervals {
    /// Takes over the intervals of another area.
    pub(crate) fn copy_from(&mut self, other: &Self) {
        for (line, other) in self.lines.iter_mut().zip(&other.lines) {
            line.clear();
            line.extend_from_slice(other);
        }
    }

    /// Whether nothing is left.
    pub(crate) fn is_empty(&self) -> bool {
        self.lines.iter().all(Vec::is_empty)
    }

    /// The total length.
    pub(crate) fn length(&self) -> f64 {
        let intervals = self.lines.iter().flatten();
        intervals.map(|[start, end]| end - start).sum()
    }

    /// Adds an area, the union of both.
    pub(crate) fn add(&mut self, other: &Self) {
        for (line, other) in self.lines.iter_mut().zip(&other.lines) {
            if other.is_empty() {
                continue;
            }
            line.extend_from_slice(other);
            line.sort_unstable_by(|a, b| a[0].total_cmp(&b[0]));
            let mut kept = 0;
            for i in 1..line.len() {
                if line[i][0] <= line[kept][1] {
                    line[kept][1] = line[kept][1].max(line[i][1]);
                } else {
                    kept += 1;
                    line[kept] = line[i];
                }
            }
            line.truncate(kept + 1);
        }
    }

    /// Removes an area, and returns the length of what was removed.
    pub(crate) fn remove(&mut self, other: &Self) -> f64 {
        let mut removed = 0.0;
        let rest = &mut self.line;
        for (line, other) in self.lines.iter_mut().zip(&other.lines) {
            if line.is_empty() || other.is_empty() {
                continue;
            }
            rest.clear();
            for &[mut start, end] in line.iter() {
                for [from, to] in other {
                    if *to <= start {
                        continue;
                    }
                    if *from >= end {
                        break;
                    }
                    if *from > start {
                        rest.push([start, *from]);
                    }
                    removed += to.min(end) - from.max(start);
                    start = start.max(*to);
                }
                if start < end {
                    rest.push([start, end]);
                }
            }
            line.clone_from(rest);
        }
        removed
    }

    /// Calls `each` with evenly spaced places in each interval, about this far apart and at least one: the index of the line, the
    /// place, and the length that it stands for.
    pub(crate) fn spread(&self, apart: f64, mut each: impl FnMut(usize, f64, f64)) {
        for (index, line) in self.lines.iter().enumerate() {
            for interval in line {
                spread(*interval, apart, |x, weight| each(index, x, weight));
            }
        }
    }

    /// Whether a place on a line is within the area.
    pub(crate) fn contains(&self, line: usize, place: f64) -> bool {
        let after = self.lines[line].partition_point(|[_, end]| *end < place);
        let interval = self.lines[line].get(after);
        interval.is_some_and(|[start, _]| *start <= place)
    }

    /// The same for the pieces of lines that are in both, without the lengths.
    pub(crate) fn spread_common(&self, other: &Self, apart: f64, mut each: impl FnMut(usize, f64)) {
        for (index, (line, other)) in self.lines.iter().zip(&other.lines).enumerate() {
            for [start, end] in line {
                for [from, to] in other {
                    let (from, to) = (from.max(*start), to.min(*end));
                    if from < to {
                        spread([from, to], apart, |x, _| each(index, x));
                    }
                }
            }
        }
    }

    /// The length of what is in both.
    pub(crate) fn common(&self, other: &Self) -> f64 {
        let mut common = 0.0;
        for (line, other) in self.lines.iter().zip(&other.lines) {
            for [start, end] in line {
                for [from, to] in other {
                    common += (to.min(*end) - from.max(*start)).max(0.0);
                }
            }
        }
        common
    }
}

/// Calls `each` with evenly spaced places in an interval, about this far apart and at least one, and the length that each stands for.
fn spread([from, to]: [f64; 2], apart: f64, mut each: impl FnMut(f64, f64)) {
    let count = ((to - from) / apart).round().max(1.0);
    let weight = (to - from) / count;
    (0..count as usize).for_each(|k| each(from + weight * (k as f64 + 0.5), weight));
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::geometry::{FillRule, area, intersect, resolve_overlaps, union};

    fn outline(points: &[(f64, f64)]) -> Outline {
        let ring = points.iter().copied().map(DVec2::from).collect();
        resolve_overlaps(vec![ring], FillRule::EvenOdd)
    }

    /// A polygon with so many points that its edges come in chunks.
    fn fine_star() -> Outline {
        let point = |i: i32| {
            let radius = if i % 2 == 0 { 10.0 } else { 9.0 };
            (DVec2::from_angle(f64::from(i) * std::f64::consts::TAU / 400.0) * radius).into()
        };
        outline(&(0..400).map(point).collect::<Vec<_>>())
    }

    proptest! {
        /// Lengths times the lines' distance are about the areas of exact intersections.
        #[test]
        fn intervals_measure_areas(
            a in prop::collection::vec((-10.0..10.0, -10.0..10.0), 3..8),
            b in prop::collection::vec((-10.0..10.0, -10.0..10.0), 3..8),
            large in any::<bool>(),
        ) {
            let (a, b) = (outline(&a), if large { fine_star() } else { outline(&b) });
            let lines = Scanlines::across((DVec2::splat(-10.0), DVec2::splat(10.0)));
            let cut = |outline: &Outline| {
                let mut intervals = Intervals::default();
                lines.cut(outline, &EdgeRanges::new(outline), &mut intervals);
                intervals
            };
            let (ca, cb) = (cut(&a), cut(&b));
            let whole = 400.0;
            let near = |length: f64, exact: f64| {
                prop_assert!((length * lines.weight() - exact).abs() < 0.06 * whole, "{length} {exact}");
                Ok(())
            };
            near(ca.length(), area(&a))?;
            near(ca.common(&cb), area(&intersect(&a, &b)))?;
            let copy = |of: &Intervals| {
                let mut copy = Intervals::default();
                copy.copy_from(of);
                copy
            };
            let mut both = copy(&ca);
            both.add(&cb);
            near(both.length(), area(&union(&[a.clone(), b.clone()])))?;
            let mut rest = copy(&ca);
            let removed = rest.remove(&cb);
            prop_assert!((removed - ca.common(&cb)).abs() < 1e-9);
            prop_assert!((rest.length() + removed - ca.length()).abs() < 1e-9);
            prop_assert!(rest.common(&cb) < 1e-9);
        }
    }
}
