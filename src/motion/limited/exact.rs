//! The best way through a motion in a given number of stretches.
//!
//! A table of frames × stretches would grow with the square of a motion's length. Instead a price is put on each stretch
//! (Lagrangian relaxation): the best way at a price is found in one pass, and it is the best of all ways with as many stretches.
//! The price is sought at which that number is the one asked for. Some numbers are best at no price, since costs are not convex in
//! the number; for these the best ways at the last price bound the cost from below, and only those parts of the table are filled
//! that the bound does not rule out.

use std::collections::BinaryHeap;

use super::stretches::{Rest, Stretches, Way};

/// The greatest number of entries of the table that are kept.
const MOST_ENTRIES: usize = 1 << 24;
/// Costs that differ by less than this share of what was added up for them are equal.
const ROUNDING: f64 = 1e-12;

/// A way, and what each way of as many stretches costs at least.
pub(super) struct Found {
    pub(super) way: Way,
    pub(super) bound: f64,
}

impl Found {
    fn proved(way: Way) -> Self {
        let bound = way.cost;
        Self { way, bound }
    }
}

/// The best way in `count` stretches, or as near to that number as can be; and the fewest stretches there can be.
pub(super) fn find(stretches: &Stretches, count: usize) -> (Found, usize) {
    let (mut low, _) = stretches.best(|rest| (rest.count, rest.cost));
    let fewest = low.count();
    if count <= fewest {
        return (Found::proved(low), fewest);
    }
    let (mut high, _) = stretches.best(|rest| (rest.cost, rest.count));
    if count >= high.count() {
        return (Found::proved(high), fewest);
    }
    loop {
        let price = (low.cost - high.cost) / (high.count() - low.count()) as f64;
        let (way, rest) = stretches.best(|rest| rest.cost + price * rest.count as f64);
        if way.count() == count {
            return (Found::proved(way), fewest);
        }
        let line = low.cost + price * low.count() as f64;
        let below = line - (way.cost + price * way.count() as f64);
        if below <= ROUNDING * line || !(low.count() + 1..high.count()).contains(&way.count()) {
            let edge = Edge {
                stretches,
                count,
                price,
                rest,
                bound: line - price * count as f64,
                slack: ROUNDING * line,
            };
            return (edge.between(&low, &high), fewest);
        }
        if way.count() < count {
            low = way;
        } else {
            high = way;
        }
    }
}

/// Two numbers of stretches with a price at which both are best, and a number between them that is not.
struct Edge<'a> {
    stretches: &'a Stretches,
    count: usize,
    price: f64,
    /// Per frame what is left of the best way at this price.
    rest: Vec<Rest>,
    /// What a way of so many stretches costs at least.
    bound: f64,
    slack: f64,
}

impl Edge<'_> {
    fn between(&self, low: &Way, high: &Way) -> Found {
        let ways = [&[low, high], &[high, low]].map(|[a, b]| self.split(&self.crossed(a, b)));
        let [split, other] = ways;
        let split = if other.cost < split.cost {
            other
        } else {
            split
        };
        if split.cost <= self.bound + self.slack {
            return Found::proved(split);
        }
        match self.cheaper(split.cost) {
            Table::Cheaper(way) => Found::proved(way),
            Table::NoneCheaper => Found::proved(split),
            Table::TooLarge => Found {
                way: split,
                bound: self.bound,
            },
        }
    }

    /// Where each stretch of the first way ends up to some frame, and of the second from there on: with the most stretches that
    /// are not too many. Such a way is best at the price as both are.
    fn crossed(&self, a: &Way, b: &Way) -> Vec<usize> {
        let [mut i, mut j] = [0, 0];
        let mut best: Option<[usize; 2]> = None;
        loop {
            let count = i + b.count() - j;
            let more = best.is_none_or(|[i, j]| count > i + b.count() - j);
            if count <= self.count && more {
                best = Some([i, j]);
            }
            // On to the next frame in which a stretch ends on both.
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

    /// A good way, from the ends of one with too few stretches: always the stretch is split that becomes cheapest by it.
    fn split(&self, low: &[usize]) -> Way {
        let cut = |start: usize, end: usize| {
            let mut best = (0.0, start);
            for middle in start + 1..end {
                let [a, b] =
                    [(start, middle), (middle, end)].map(|(a, b)| self.stretches.cost(a, b));
                let saved = self.stretches.cost(start, end) - (a + b);
                if best.1 == start || saved > best.0 {
                    best = (saved, middle);
                }
            }
            best
        };
        let mut queue = BinaryHeap::new();
        let mut start = 0;
        let push = |queue: &mut BinaryHeap<Split>, start, end| {
            // A still stretch has nothing to save, and may be long.
            if end - start > 1 && self.stretches.cost(start, end) > 0.0 {
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
            let cost = self.stretches.cost(start, *end);
            start = *end;
            cost
        });
        let cost = match ends.len() == self.count {
            true => costs.sum(),
            false => f64::INFINITY,
        };
        Way { ends, cost }
    }

    /// A way that is cheaper than `known`, the cheapest there is.
    fn cheaper(&self, known: f64) -> Table {
        let frames = self.stretches.frames();
        let mut rows: Vec<Row> = vec![Row {
            first: 0,
            at: 0,
            width: 1,
        }];
        let mut costs = vec![0.0];
        let mut row: Vec<f64> = Vec::new();
        let mut before: Vec<(Row, f64)> = Vec::new();
        for end in 1..=frames {
            let all = self.stretches.ending(end);
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
            let rest = rest.cost + self.price * rest.count as f64;
            for (index, entry) in row.iter_mut().enumerate() {
                let left = (self.count - (first + index)) as f64;
                if *entry + rest - self.price * left >= known - self.slack {
                    *entry = f64::INFINITY;
                }
            }
            let kept = |entry: &f64| entry.is_finite();
            let skipped = row.iter().position(kept).unwrap_or(row.len());
            let until = row.iter().rposition(kept).map_or(skipped, |last| last + 1);
            rows.push(Row {
                first: first.saturating_add(skipped),
                at: costs.len(),
                width: until - skipped,
            });
            costs.extend_from_slice(&row[skipped..until]);
            if costs.len() > MOST_ENTRIES {
                return Table::TooLarge;
            }
        }
        self.trace(&rows, &costs)
    }

    fn trace(&self, rows: &[Row], costs: &[f64]) -> Table {
        let entry = |frame: usize, count: usize| -> Option<f64> {
            let row = rows[frame];
            let index = count
                .checked_sub(row.first)
                .filter(|index| *index < row.width)?;
            Some(costs[row.at + index]).filter(|cost| cost.is_finite())
        };
        let (mut frame, mut count) = (self.stretches.frames(), self.count);
        let Some(cost) = entry(frame, count) else {
            return Table::NoneCheaper;
        };
        let mut ends = Vec::with_capacity(count);
        while frame > 0 {
            ends.push(frame);
            let here = entry(frame, count);
            let mut before = self.stretches.ending(frame);
            let Some((start, _)) = before.find(|(start, cost)| {
                count > 0 && entry(*start, count - 1).map(|before| before + cost) == here
            }) else {
                return Table::NoneCheaper;
            };
            (frame, count) = (start, count - 1);
        }
        ends.reverse();
        Table::Cheaper(Way { ends, cost })
    }
}

/// What the table showed.
enum Table {
    Cheaper(Way),
    NoneCheaper,
    TooLarge,
}

/// The entries of a frame: from which number of stretches on, where they stand, and how many they are.
#[derive(Debug, Clone, Copy)]
struct Row {
    first: usize,
    at: usize,
    width: usize,
}

/// A stretch, where it would be split, and what that saves.
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
