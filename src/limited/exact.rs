//! The best segmentation of a motion into a given number of segments.
//!
//! A full dynamic-programming table of frames × segments grows with the square of a motion's length. Instead each segment is
//! charged a penalty, the Lagrange multiplier of the constraint on their number (Lagrangian relaxation): one pass of dynamic
//! programming finds the best segmentation at a penalty, and that is the best of all with as many segments. The penalty is
//! searched for at which this number is the requested one. Costs are not convex in the number, so some numbers are optimal at
//! no penalty (a duality gap). For those the last penalty gives a lower bound of the cost, and only the entries of the table
//! are filled that this bound does not rule out (branch and bound).

use std::collections::BinaryHeap;

use super::segments::{Remainder, Segmentation, Segments};

/// The most entries of the table that are stored.
const MAX_ENTRIES: usize = 1 << 24;
/// Costs that differ by less than this share of their sum are equal.
const ROUNDING: f64 = 1e-12;

/// A segmentation, and a lower bound of the cost of every segmentation into as many segments.
pub(super) struct Solution {
    pub(super) segmentation: Segmentation,
    pub(super) bound: f64,
}

impl Solution {
    fn optimal(segmentation: Segmentation) -> Self {
        let bound = segmentation.cost;
        Self {
            segmentation,
            bound,
        }
    }
}

/// The best segmentation into `count` segments, or the nearest possible number of them; and the smallest possible number.
pub(super) fn find(segments: &Segments, count: usize) -> (Solution, usize) {
    let (mut low, _) = segments.best(|rest| (rest.count, rest.cost));
    let fewest = low.count();
    if count <= fewest {
        return (Solution::optimal(low), fewest);
    }
    let (mut high, _) = segments.best(|rest| (rest.cost, rest.count));
    if count >= high.count() {
        return (Solution::optimal(high), fewest);
    }
    loop {
        let penalty = (low.cost - high.cost) / (high.count() - low.count()) as f64;
        let (segmentation, rest) = segments.best(|rest| rest.cost + penalty * rest.count as f64);
        if segmentation.count() == count {
            return (Solution::optimal(segmentation), fewest);
        }
        let line = low.cost + penalty * low.count() as f64;
        let below = line - (segmentation.cost + penalty * segmentation.count() as f64);
        if below <= ROUNDING * line
            || !(low.count() + 1..high.count()).contains(&segmentation.count())
        {
            let gap = DualityGap {
                segments,
                count,
                penalty,
                rest,
                bound: line - penalty * count as f64,
                slack: ROUNDING * line,
            };
            return (gap.between(&low, &high), fewest);
        }
        if segmentation.count() < count {
            low = segmentation;
        } else {
            high = segmentation;
        }
    }
}

/// Two numbers of segments that are both optimal at one penalty, and a requested number between them that is optimal at none.
struct DualityGap<'a> {
    segments: &'a Segments,
    count: usize,
    penalty: f64,
    /// Per frame the best rest of the motion from there on, at this penalty.
    rest: Vec<Remainder>,
    /// Lower bound of the cost of a segmentation into `count` segments.
    bound: f64,
    slack: f64,
}

impl DualityGap<'_> {
    fn between(&self, low: &Segmentation, high: &Segmentation) -> Solution {
        let crossovers =
            [&[low, high], &[high, low]].map(|[a, b]| self.split(&self.crossover(a, b)));
        let [split, other] = crossovers;
        let split = if other.cost < split.cost {
            other
        } else {
            split
        };
        if split.cost <= self.bound + self.slack {
            return Solution::optimal(split);
        }
        match self.search_table(split.cost) {
            TableResult::Cheaper(segmentation) => Solution::optimal(segmentation),
            TableResult::NoneCheaper => Solution::optimal(split),
            TableResult::TooLarge => Solution {
                segmentation: split,
                bound: self.bound,
            },
        }
    }

    /// Follows the first segmentation up to a frame where both have a boundary, and the second from there on; of all such
    /// frames the one that gives the most segments without exceeding `count`. The result is as good at the penalty as both are.
    fn crossover(&self, a: &Segmentation, b: &Segmentation) -> Vec<usize> {
        let [mut i, mut j] = [0, 0];
        let mut best: Option<[usize; 2]> = None;
        loop {
            let count = i + b.count() - j;
            let more = best.is_none_or(|[i, j]| count > i + b.count() - j);
            if count <= self.count && more {
                best = Some([i, j]);
            }
            // On to the next boundary that both have.
            loop {
                match (a.ends.get(i), b.ends.get(j)) {
                    (Some(end), Some(other)) if end == other => break,
                    (Some(end), Some(other)) if end < other => i += 1,
                    (Some(_), Some(_)) => j += 1,
                    _ => {
                        let [i, j] = best.unwrap_or([0, 0]);
                        return [&a.ends[..i], &b.ends[j..]].concat();
                    }
                }
            }
            (i, j) = (i + 1, j + 1);
        }
    }

    /// A good segmentation, from one with too few segments: repeatedly splits the segment whose split saves most.
    fn split(&self, low: &[usize]) -> Segmentation {
        let cut = |start: usize, end: usize| {
            let mut best = (0.0, start);
            for middle in start + 1..end {
                let [a, b] =
                    [(start, middle), (middle, end)].map(|(a, b)| self.segments.cost(a, b));
                let saved = self.segments.cost(start, end) - (a + b);
                if best.1 == start || saved > best.0 {
                    best = (saved, middle);
                }
            }
            best
        };
        let mut queue = BinaryHeap::new();
        let mut start = 0;
        let push = |queue: &mut BinaryHeap<Split>, start, end| {
            // A still segment has nothing to save, and may be long.
            if end - start > 1 && self.segments.cost(start, end) > 0.0 {
                let (saved, middle) = cut(start, end);
                queue.push(Split {
                    saved,
                    start,
                    middle,
                    end,
                });
            }
        };
        for end in low {
            push(&mut queue, start, *end);
            start = *end;
        }
        let mut ends = low.to_vec();
        while ends.len() < self.count {
            let Some(split) = queue.pop() else { break };
            ends.push(split.middle);
            push(&mut queue, split.start, split.middle);
            push(&mut queue, split.middle, split.end);
        }
        ends.sort_unstable();
        let mut start = 0;
        let costs = ends.iter().map(|end| {
            let cost = self.segments.cost(start, *end);
            start = *end;
            cost
        });
        let cost = if ends.len() == self.count {
            costs.sum()
        } else {
            f64::INFINITY
        };
        Segmentation { ends, cost }
    }

    /// Searches the table for the cheapest segmentation that costs less than `known`.
    fn search_table(&self, known: f64) -> TableResult {
        let frames = self.segments.frames;
        let mut rows: Vec<TableRow> = vec![TableRow {
            first: 0,
            at: 0,
            width: 1,
        }];
        let mut costs = vec![0.0];
        let mut row: Vec<f64> = Vec::new();
        let mut before: Vec<(TableRow, f64)> = Vec::new();
        for end in 1..=frames {
            let all = self.segments.ending(end);
            let all = all.map(|(start, cost)| (rows[start], cost));
            before.clear();
            before.extend(all.filter(|(row, _)| row.width > 0));
            let range = before
                .iter()
                .fold((usize::MAX, 0), |(low, high), (row, _)| {
                    (low.min(row.first + 1), high.max(row.first + 1 + row.width))
                });
            let (first, last) = (range.0, range.1.min(self.count + 1));
            row.clear();
            row.resize(last.saturating_sub(first), f64::INFINITY);
            for (before, cost) in &before {
                let values = &costs[before.at..][..before.width];
                let skipped = before.first + 1 - first;
                for (value, entry) in values.iter().zip(row.iter_mut().skip(skipped)) {
                    *entry = entry.min(value + cost);
                }
            }
            let rest = self.rest[end];
            let rest = rest.cost + self.penalty * rest.count as f64;
            for (index, entry) in row.iter_mut().enumerate() {
                let left = (self.count - (first + index)) as f64;
                if *entry + rest - self.penalty * left >= known - self.slack {
                    *entry = f64::INFINITY;
                }
            }
            let kept = |entry: &f64| entry.is_finite();
            let skipped = row.iter().position(kept).unwrap_or(row.len());
            let until = row.iter().rposition(kept).map_or(skipped, |last| last + 1);
            rows.push(TableRow {
                first: first.saturating_add(skipped),
                at: costs.len(),
                width: until - skipped,
            });
            costs.extend_from_slice(&row[skipped..until]);
            if costs.len() > MAX_ENTRIES {
                return TableResult::TooLarge;
            }
        }
        self.trace(&rows, &costs)
    }

    fn trace(&self, rows: &[TableRow], costs: &[f64]) -> TableResult {
        let entry = |frame: usize, count: usize| -> Option<f64> {
            let row = rows[frame];
            let index = count
                .checked_sub(row.first)
                .filter(|index| *index < row.width)?;
            Some(costs[row.at + index]).filter(|cost| cost.is_finite())
        };
        let (mut frame, mut count) = (self.segments.frames, self.count);
        let Some(cost) = entry(frame, count) else {
            return TableResult::NoneCheaper;
        };
        let mut ends = Vec::with_capacity(count);
        while frame > 0 {
            ends.push(frame);
            let here = entry(frame, count);
            let mut before = self.segments.ending(frame);
            let Some((start, _)) = before.find(|(start, cost)| {
                count > 0 && entry(*start, count - 1).map(|before| before + cost) == here
            }) else {
                return TableResult::NoneCheaper;
            };
            (frame, count) = (start, count - 1);
        }
        ends.reverse();
        TableResult::Cheaper(Segmentation { ends, cost })
    }
}

/// The result of searching the table.
enum TableResult {
    Cheaper(Segmentation),
    NoneCheaper,
    TooLarge,
}

/// The stored entries of a frame: the first number of segments, their offset in the list of costs, and how many there are.
#[derive(Debug, Clone, Copy)]
struct TableRow {
    first: usize,
    at: usize,
    width: usize,
}

/// A segment, where it would be split, and what that saves.
struct Split {
    saved: f64,
    start: usize,
    middle: usize,
    end: usize,
}

impl Ord for Split {
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        self.saved
            .total_cmp(&other.saved)
            .then(other.start.cmp(&self.start))
    }
}

impl PartialOrd for Split {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Split {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for Split {}
