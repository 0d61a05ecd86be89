//! The poses of a motion, and the distance between two of them.

use glam::DVec3;
use rayon::prelude::*;

/// Pairs that a thread processes at once.
const GRAIN: usize = 512;

/// The sum of squared distances (SSD) between the points of two poses (Kitamura 5.2.1, equation 5.1), in the square of the
/// points' unit.
///
/// Points are added in order, each as x² + y² + z², so the same pair gives the same bits everywhere, whichever pose comes
/// first. A sum that is NaN, as of infinite points, counts as infinite. Points that only one pose has are ignored.
pub fn ssd(a: &[DVec3], b: &[DVec3]) -> f64 {
    let mut sum = 0.0;
    for (a, b) in a.iter().zip(b) {
        sum += (*a - *b).length_squared();
    }
    if sum.is_nan() { f64::INFINITY } else { sum }
}

/// The poses of a motion: points in space, frame by frame.
#[derive(Debug, Clone, Copy)]
pub struct Poses<'a> {
    points: &'a [DVec3],
    per_frame: usize,
    repeats: Option<&'a [bool]>,
    key: Option<usize>,
    is_loop: bool,
}

impl<'a> Poses<'a> {
    /// Poses of so many points per frame: `frames × per_frame`, frame by frame, in any unit. Frames are equal if all their points
    /// are. Without points there are no frames; an incomplete last frame is ignored, and so are frames beyond 2³² − 2.
    pub fn new(points: &'a [DVec3], per_frame: usize) -> Self {
        Self {
            points,
            per_frame,
            repeats: None,
            key: None,
            is_loop: false,
        }
    }

    /// The same poses, of which those frames equal the one before that `repeats` says: something may move that has no point.
    #[must_use]
    pub fn repeating(self, repeats: &'a [bool]) -> Self {
        Self {
            repeats: Some(repeats),
            ..self
        }
    }

    /// The same poses, of which the pose of this frame is never removed, nor moved to another frame: the key pose of a performance.
    #[must_use]
    pub fn keeping(self, key: Option<usize>) -> Self {
        Self { key, ..self }
    }

    /// The same poses, without the last one if they are a loop: it is the first one again, and no frame is left for it to be held in.
    #[must_use]
    pub fn looping(self, is_loop: bool) -> Self {
        Self { is_loop, ..self }
    }

    pub(super) fn key(self) -> Option<usize> {
        self.key
    }

    /// The number of frames.
    pub fn count(self) -> usize {
        let whole = self.points.len().checked_div(self.per_frame).unwrap_or(0);
        // `u32::MAX` marks the absence of a pose.
        let whole = whole.min(u32::MAX as usize - 1);
        if self.is_loop && whole > 1 {
            whole - 1
        } else {
            whole
        }
    }

    pub(super) fn per_frame(self) -> usize {
        self.per_frame
    }

    pub(super) fn pose(self, frame: usize) -> &'a [DVec3] {
        &self.points[frame * self.per_frame..][..self.per_frame]
    }

    /// Whether a frame equals the one before.
    pub(super) fn is_repeat(self, frame: usize) -> bool {
        frame > 0
            && match self.repeats {
                Some(repeats) => repeats.get(frame) == Some(&true),
                None => self.pose(frame) == self.pose(frame - 1),
            }
    }

    pub(super) fn ssd(self, a: usize, b: usize) -> f64 {
        ssd(self.pose(a), self.pose(b))
    }

    /// The speed of every frame: its [`ssd`] to the frame before; 0 for the first.
    pub fn speeds(self) -> Vec<f64> {
        self.speeds_of(self.count(), |index| index)
    }

    /// The speeds within a selection of frames: `frame` maps 0…count to frame numbers.
    pub(super) fn speeds_of(self, count: usize, frame: impl Fn(usize) -> usize + Sync) -> Vec<f64> {
        let mut speeds = vec![0.0; count];
        speeds
            .par_chunks_mut(GRAIN)
            .enumerate()
            .for_each(|(chunk, speeds)| {
                for (offset, speed) in speeds.iter_mut().enumerate() {
                    let index = chunk * GRAIN + offset;
                    if index > 0 {
                        *speed = self.ssd(frame(index - 1), frame(index));
                    }
                }
            });
        speeds
    }
}
