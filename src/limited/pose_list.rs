//! The poses of a motion in order, each shown for some frames, while some are being removed.

use super::exposure::Exposure;
use super::poses::Poses;

/// The absence of a pose.
const NONE: u32 = u32::MAX;

/// A linked list of poses from which some are removed. Poses are numbered in the order of the source.
pub(super) struct PoseList<'a> {
    frames: Poses<'a>,
    /// Per pose its first source frame.
    source: Vec<u32>,
    /// Per pose for how many frames it is shown; 0 for a removed one.
    pub(super) shown: Vec<u32>,
    /// Per pose its SSD to the pose before it; 0 for the first.
    pub(super) speed: Vec<f64>,
    before: Vec<u32>,
    after: Vec<u32>,
    /// The pose that is not to be removed.
    key: Option<usize>,
}

impl<'a> PoseList<'a> {
    pub(super) fn new(frames: Poses<'a>) -> Self {
        let mut source: Vec<u32> = Vec::with_capacity(frames.count());
        let mut shown: Vec<u32> = Vec::with_capacity(frames.count());
        for frame in 0..frames.count() {
            match shown.last_mut() {
                Some(shown) if frames.is_repeat(frame) => *shown += 1,
                _ => {
                    source.push(frame as u32);
                    shown.push(1);
                }
            }
        }
        let speed = frames.speeds_of(source.len(), |pose| source[pose] as usize);
        let key = frames.key().filter(|key| *key < frames.count());
        // The pose of a frame is the last one that begins before it.
        let key = key.map(|key| source.partition_point(|first| *first as usize <= key) - 1);
        let count = source.len() as u32;
        Self {
            key,
            frames,
            source,
            shown,
            speed,
            before: (0..count).map(|pose| pose.wrapping_sub(1)).collect(),
            after: (1..=count)
                .map(|pose| if pose == count { NONE } else { pose })
                .collect(),
        }
    }

    /// The number of poses before any was removed.
    pub(super) fn len(&self) -> usize {
        self.source.len()
    }

    /// The pose that is not to be removed.
    pub(super) fn key(&self) -> Option<usize> {
        self.key
    }

    pub(super) fn source(&self, pose: usize) -> u32 {
        self.source[pose]
    }

    pub(super) fn previous(&self, pose: usize) -> Option<usize> {
        let before = self.before[pose];
        (before != NONE).then_some(before as usize)
    }

    pub(super) fn next(&self, pose: usize) -> Option<usize> {
        let after = self.after[pose];
        (after != NONE).then_some(after as usize)
    }

    /// Whether a pose may be removed, as far as it is not shown by copying.
    pub(super) fn is_removable(&self, pose: usize) -> bool {
        self.shown[pose] == 1 && self.key != Some(pose) && self.previous(pose).is_some()
    }

    /// Removes a pose that is shown for one frame and is not the first.
    pub(super) fn remove(&mut self, pose: usize) {
        self.shown[pose] = 0;
        let [before, after] = [self.before[pose], self.after[pose]];
        if before != NONE {
            self.after[before as usize] = after;
        }
        if after != NONE {
            self.before[after as usize] = before;
            self.measure(after as usize);
        }
    }

    /// Puts back the pose that was removed last.
    pub(super) fn restore(&mut self, pose: usize) {
        self.shown[pose] = 1;
        let [before, after] = [self.before[pose], self.after[pose]];
        if before != NONE {
            self.after[before as usize] = pose as u32;
        }
        if after != NONE {
            self.before[after as usize] = pose as u32;
            self.measure(after as usize);
        }
    }

    fn measure(&mut self, pose: usize) {
        self.speed[pose] = self.previous(pose).map_or(0.0, |before| {
            let [a, b] = [before, pose].map(|pose| self.source[pose] as usize);
            self.frames.ssd(a, b)
        });
    }

    /// The remaining poses, in order.
    pub(super) fn remaining(&self) -> impl Iterator<Item = usize> + '_ {
        let first = (self.len() > 0).then_some(0);
        std::iter::successors(first, |pose| self.next(*pose))
    }

    pub(super) fn exposure(&self) -> Exposure {
        let sources = self
            .remaining()
            .flat_map(|pose| std::iter::repeat_n(self.source[pose], self.shown[pose] as usize));
        Exposure::new(sources.collect())
    }
}
