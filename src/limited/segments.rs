//! Segments of frames that one drawing could be held for, and segmentations of a motion into them.

use rayon::prelude::*;

use super::poses::Poses;

/// Frames that a thread processes at once.
const GRAIN: usize = 256;
/// Larger distances count as this much, so that sums stay finite.
const FAR: f64 = 1e280;

/// All segments that one drawing may be held for, with their cost: Σ ‖p(t) − p(drawing)‖² over the frames of the segment, for
/// its best drawing.
pub(super) struct Segments {
    pub(super) frames: usize,
    max_hold: usize,
    /// `frames × max_hold`: the cost of each segment, by its first frame and its length − 1.
    costs: Vec<f64>,
    /// Still runs that are longer than `max_hold`, as first frame and end.
    still: Vec<[usize; 2]>,
    /// Per frame the still run that a segment of more than `max_hold` frames may begin or end in at this frame, or
    /// [`Self::NONE`].
    begins: Vec<u32>,
    ends: Vec<u32>,
    /// The number of poses: equal neighbours count as one.
    pub(super) poses: usize,
}

/// A segmentation of a motion: the ends of its segments, and their total cost.
#[derive(Debug, Clone)]
pub(super) struct Segmentation {
    pub(super) ends: Vec<usize>,
    pub(super) cost: f64,
}

impl Segmentation {
    pub(super) fn count(&self) -> usize {
        self.ends.len()
    }
}

/// The cost and number of segments of the best segmentation from some frame to the end.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Remainder {
    pub(super) cost: f64,
    pub(super) count: usize,
}

impl Segments {
    const NONE: u32 = u32::MAX;

    pub(super) fn new(frames: Poses<'_>, max_hold: usize) -> Self {
        let count = frames.count();
        let mut costs = vec![0.0; count * max_hold];
        costs
            .par_chunks_mut(GRAIN * max_hold)
            .enumerate()
            .for_each(|(chunk, costs)| {
                let start = chunk * GRAIN;
                let rows = costs.len() / max_hold;
                let end = (start + rows + max_hold).min(count);
                let near = nearby_ssds(frames, start, end, max_hold);
                let mut sums = vec![0.0; max_hold];
                for (row, costs) in costs.chunks_mut(max_hold).enumerate() {
                    let most = max_hold.min(count - start - row);
                    accumulate_costs(&near[row * max_hold..], max_hold, most, &mut sums, costs);
                }
            });
        let mut segments = Self {
            frames: count,
            max_hold,
            costs,
            still: Vec::new(),
            begins: vec![Self::NONE; count + 1],
            ends: vec![Self::NONE; count + 1],
            poses: 0,
        };
        if let Some(key) = frames.key().filter(|key| *key < count) {
            segments.require(frames, key);
        }
        segments.find_still(frames);
        segments
    }

    /// Makes a frame the drawing of all segments that contain it.
    fn require(&mut self, frames: Poses<'_>, key: usize) {
        for start in (key + 1).saturating_sub(self.max_hold)..=key {
            let longest = self.frames.min(start + self.max_hold);
            for end in key + 1..=longest {
                let cost = start..end;
                let cost = cost.map(|frame| frames.ssd(frame, key).min(FAR)).sum();
                self.costs[start * self.max_hold + end - start - 1] = cost;
            }
        }
    }

    /// A segment of equal frames costs nothing, however long it is. A segment of more than `max_hold` frames only needs to
    /// begin at one of the first two frames of a still run and to end at one of its last two boundaries: a neighbouring segment
    /// that shares more of the run could give up all of it but one frame at no extra cost.
    fn find_still(&mut self, frames: Poses<'_>) {
        let mut start = 0;
        // The last frame has no equal successor.
        let moved = (1..self.frames).map(|frame| !frames.is_repeat(frame));
        let moved = moved.chain((self.frames > 0).then_some(true));
        for end in moved
            .zip(1..)
            .filter_map(|(moved, end)| moved.then_some(end))
        {
            self.poses += 1;
            if end - start > self.max_hold {
                let run = self.still.len() as u32;
                self.still.push([start, end]);
                self.begins[start..start + 2].fill(run);
                self.ends[end - 1..=end].fill(run);
            }
            start = end;
        }
    }

    /// The segments that begin at a frame, as end and cost.
    pub(super) fn starting(&self, start: usize) -> impl Iterator<Item = (usize, f64)> + '_ {
        let most = self.max_hold.min(self.frames - start);
        let costs = &self.costs[start * self.max_hold..][..most];
        let short = costs.iter().enumerate();
        let short = short.map(move |(index, cost)| (start + index + 1, *cost));
        let run = self.still.get(self.begins[start] as usize);
        let still = run.into_iter().flat_map(move |[_, end]| [end - 1, *end]);
        let still = still.filter(move |end| end - start > self.max_hold);
        short.chain(still.map(|end| (end, 0.0)))
    }

    /// The segments that end before a frame, as first frame and cost.
    pub(super) fn ending(&self, end: usize) -> impl Iterator<Item = (usize, f64)> + '_ {
        let short = 1..=self.max_hold.min(end);
        let short = short.map(move |length| (end - length, self.cost(end - length, end)));
        let run = self.still.get(self.ends[end] as usize);
        let still = run.into_iter().flat_map(|[start, _]| [*start, start + 1]);
        let still = still.filter(move |start| end - start > self.max_hold);
        short.chain(still.map(|start| (start, 0.0)))
    }

    pub(super) fn cost(&self, start: usize, end: usize) -> f64 {
        // Longer segments are still.
        if end - start > self.max_hold {
            return 0.0;
        }
        self.costs[start * self.max_hold + end - start - 1]
    }

    /// The segmentation whose key, computed from cost and count, is smallest; ties go to shorter segments first. Also returns,
    /// per frame, the best rest of the motion from there on. Backward dynamic programming.
    pub(super) fn best<K: PartialOrd>(
        &self,
        key: impl Fn(Remainder) -> K,
    ) -> (Segmentation, Vec<Remainder>) {
        let mut rest = vec![Remainder::default(); self.frames + 1];
        let mut next = vec![0; self.frames];
        for start in (0..self.frames).rev() {
            let mut best: Option<(K, Remainder, usize)> = None;
            for (end, cost) in self.starting(start) {
                let whole = Remainder {
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
        (Segmentation { ends, cost }, rest)
    }
}

/// The SSDs between frames that can share a segment: for each of `start..end` to the frames before it, by distance.
fn nearby_ssds(frames: Poses<'_>, start: usize, end: usize, max_hold: usize) -> Vec<f64> {
    let mut near = vec![0.0; (end - start) * max_hold];
    for (row, near) in near.chunks_mut(max_hold).enumerate() {
        for (back, near) in near.iter_mut().enumerate().take(row + 1) {
            *near = frames.ssd(start + row - back, start + row).min(FAR);
        }
    }
    near
}

/// The costs of the segments of up to `most` frames that begin where `near` begins.
fn accumulate_costs(
    near: &[f64],
    max_hold: usize,
    most: usize,
    sums: &mut [f64],
    costs: &mut [f64],
) {
    for last in 0..most {
        let row = &near[last * max_hold..][..=last];
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

/// The frame of a segment that is its drawing: the one that must stay, else the best one; of equal ones the first.
pub(super) fn drawing(frames: Poses<'_>, start: usize, end: usize, max_hold: usize) -> usize {
    if let Some(key) = frames.key().filter(|key| (start..end).contains(key)) {
        return key;
    }
    // Longer segments are still.
    let end = end.min(start + max_hold);
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
