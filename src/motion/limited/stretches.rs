//! Stretches of frames that one drawing could stand for, and ways through a motion that are made of them.

use rayon::prelude::*;

use super::ssd::Frames;

/// Frames that a thread takes at once.
const GRAIN: usize = 256;
/// What is further apart than this counts as this far apart, so that sums stay finite.
const FAR: f64 = 1e280;

/// All stretches that one drawing may stand for, with what it costs: Σ ‖p(t) − p(drawing)‖² over its frames, for the best drawing
/// of the stretch.
pub(super) struct Stretches {
    frames: usize,
    longest: usize,
    /// `frames × longest`: the cost of each stretch by its first frame and its length less 1.
    costs: Vec<f64>,
    /// Still runs that are longer than `longest`, as first frame and end.
    still: Vec<[usize; 2]>,
    /// Per frame the still run that a stretch of more than `longest` frames may begin or end in with it, or [`Self::NONE`].
    begins: Vec<u32>,
    ends: Vec<u32>,
    /// How many poses there are: neighbours that are equal are one.
    pub(super) poses: usize,
}

/// A way through a motion: where its stretches end, with how many and what they cost.
#[derive(Debug, Clone)]
pub(super) struct Way {
    pub(super) ends: Vec<usize>,
    pub(super) cost: f64,
}

impl Way {
    pub(super) fn count(&self) -> usize {
        self.ends.len()
    }
}

/// What the rest of a motion costs at least, from some frame on.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Rest {
    pub(super) cost: f64,
    pub(super) count: usize,
}

impl Stretches {
    const NONE: u32 = u32::MAX;

    pub(super) fn new(frames: Frames<'_>, longest: usize) -> Self {
        let count = frames.count();
        let mut costs = vec![0.0; count * longest];
        costs
            .par_chunks_mut(GRAIN * longest)
            .enumerate()
            .for_each(|(chunk, costs)| {
                let start = chunk * GRAIN;
                let rows = costs.len() / longest;
                let near = near(frames, start, (start + rows + longest).min(count), longest);
                let mut sums = vec![0.0; longest];
                for (row, costs) in costs.chunks_mut(longest).enumerate() {
                    let most = longest.min(count - start - row);
                    from(&near[row * longest..], longest, most, &mut sums, costs);
                }
            });
        let mut stretches = Self {
            frames: count,
            longest,
            costs,
            still: Vec::new(),
            begins: vec![Self::NONE; count + 1],
            ends: vec![Self::NONE; count + 1],
            poses: 0,
        };
        stretches.find_still(&frames.speeds());
        stretches
    }

    /// A stretch of equal frames costs nothing however long it is. One of more than `longest` frames needs to begin in the first
    /// two and to end behind the last two frames of a still run alone: a neighbour that shares more of the run could leave all
    /// of it but one frame, without costing more.
    fn find_still(&mut self, speeds: &[f64]) {
        let mut start = 0;
        // Behind the last frame there is none that is equal.
        let moved = speeds.iter().skip(1).map(|speed| *speed != 0.0);
        let moved = moved.chain((self.frames > 0).then_some(true));
        for end in moved
            .zip(1..)
            .filter_map(|(moved, end)| moved.then_some(end))
        {
            self.poses += 1;
            if end - start > self.longest {
                let run = self.still.len() as u32;
                self.still.push([start, end]);
                self.begins[start..start + 2].fill(run);
                self.ends[end - 1..=end].fill(run);
            }
            start = end;
        }
    }

    pub(super) fn frames(&self) -> usize {
        self.frames
    }

    /// The stretches that begin with a frame, as end and cost.
    pub(super) fn starting(&self, start: usize) -> impl Iterator<Item = (usize, f64)> + '_ {
        let most = self.longest.min(self.frames - start);
        let costs = &self.costs[start * self.longest..][..most];
        let short = costs.iter().enumerate();
        let short = short.map(move |(index, cost)| (start + index + 1, *cost));
        let run = self.still.get(self.begins[start] as usize);
        let still = run.into_iter().flat_map(move |[_, end]| [end - 1, *end]);
        let still = still.filter(move |end| end - start > self.longest);
        short.chain(still.map(|end| (end, 0.0)))
    }

    /// The stretches that end before a frame, as first frame and cost.
    pub(super) fn ending(&self, end: usize) -> impl Iterator<Item = (usize, f64)> + '_ {
        let short = 1..=self.longest.min(end);
        let short = short.map(move |length| (end - length, self.cost(end - length, end)));
        let run = self.still.get(self.ends[end] as usize);
        let still = run.into_iter().flat_map(|[start, _]| [*start, start + 1]);
        let still = still.filter(move |start| end - start > self.longest);
        short.chain(still.map(|start| (start, 0.0)))
    }

    pub(super) fn cost(&self, start: usize, end: usize) -> f64 {
        // What is longer is still.
        if end - start > self.longest {
            return 0.0;
        }
        self.costs[start * self.longest + end - start - 1]
    }

    /// The way on which the key of its cost and count is least, of equal keys the one of shorter stretches first; and per frame
    /// what is left of such a way from there.
    pub(super) fn best<K: PartialOrd>(&self, key: impl Fn(Rest) -> K) -> (Way, Vec<Rest>) {
        let mut rest = vec![Rest::default(); self.frames + 1];
        let mut next = vec![0; self.frames];
        for start in (0..self.frames).rev() {
            let mut best: Option<(K, Rest, usize)> = None;
            for (end, cost) in self.starting(start) {
                let whole = Rest {
                    cost: cost + rest[end].cost,
                    count: 1 + rest[end].count,
                };
                let key = key(whole);
                if best.as_ref().is_none_or(|(best, ..)| key < *best) {
                    best = Some((key, whole, end));
                }
            }
            if let Some((_, whole, end)) = best {
                rest[start] = whole;
                next[start] = end;
            }
        }
        let (mut ends, mut frame) = (Vec::with_capacity(rest[0].count), 0);
        while frame < self.frames {
            frame = next[frame];
            ends.push(frame);
        }
        let cost = rest[0].cost;
        (Way { ends, cost }, rest)
    }
}

/// How far frames are apart that one stretch may hold: for each of `start..end` the SSD to those before it, by distance.
fn near(frames: Frames<'_>, start: usize, end: usize, longest: usize) -> Vec<f64> {
    let mut near = vec![0.0; (end - start) * longest];
    for (row, near) in near.chunks_mut(longest).enumerate() {
        for (back, near) in near.iter_mut().enumerate().take(row + 1) {
            *near = frames.ssd(start + row - back, start + row).min(FAR);
        }
    }
    near
}

/// The costs of the stretches of up to `most` frames from where `near` begins.
fn from(near: &[f64], longest: usize, most: usize, sums: &mut [f64], costs: &mut [f64]) {
    for last in 0..most {
        let row = &near[last * longest..][..=last];
        let mut own = 0.0;
        let mut least = f64::INFINITY;
        for drawing in 0..last {
            let apart = row[last - drawing];
            sums[drawing] += apart;
            own += apart;
            least = least.min(sums[drawing]);
        }
        sums[last] = own;
        costs[last] = least.min(own);
    }
}

/// The frame of a stretch that costs least as its drawing, of equal ones the first.
pub(super) fn drawing(frames: Frames<'_>, start: usize, end: usize, longest: usize) -> usize {
    // What is longer is still.
    let end = end.min(start + longest);
    let cost = |drawing: usize| -> f64 {
        let all = start..end;
        all.map(|frame| frames.ssd(frame, drawing).min(FAR)).sum()
    };
    let mut best = (f64::INFINITY, start);
    for frame in start..end {
        let cost = cost(frame);
        if cost < best.0 {
            best = (cost, frame);
        }
    }
    best.1
}
