//! The distance between two poses.

use glam::DVec3;
use rayon::prelude::*;

/// Pairs that a thread processes at once.
const GRAIN: usize = 512;

/// The sum of squared distances (SSD) between the joints of two poses (Kitamura 5.2.1, equation 5.1), in the square of the
/// positions' unit.
///
/// Joints are added in order, each as x² + y² + z², so the same pair gives the same bits everywhere, whichever pose comes
/// first. A sum that is NaN, as of infinite positions, counts as infinite. Joints that only one pose has are ignored.
pub fn ssd(a: &[DVec3], b: &[DVec3]) -> f64 {
    let mut sum = 0.0;
    for (a, b) in a.iter().zip(b) {
        sum += (*a - *b).length_squared();
    }
    if sum.is_nan() { f64::INFINITY } else { sum }
}

/// The speed of every frame: its [`ssd`] to the frame before; 0 for the first. `positions` are `frames × joints`, frame by
/// frame.
pub fn speeds(positions: &[DVec3], joints: usize) -> Vec<f64> {
    Frames::new(positions, joints).speeds()
}

/// Joint positions, frame by frame.
#[derive(Clone, Copy)]
pub(super) struct Frames<'a> {
    positions: &'a [DVec3],
    joints: usize,
}

impl<'a> Frames<'a> {
    /// Without joints there are no frames; an incomplete last frame is ignored.
    pub(super) fn new(positions: &'a [DVec3], joints: usize) -> Self {
        Self { positions, joints }
    }

    pub(super) fn count(self) -> usize {
        let whole = self.positions.len().checked_div(self.joints).unwrap_or(0);
        // `u32::MAX` marks the absence of a pose.
        whole.min(u32::MAX as usize - 1)
    }

    pub(super) fn joints(self) -> usize {
        self.joints
    }

    pub(super) fn pose(self, frame: usize) -> &'a [DVec3] {
        &self.positions[frame * self.joints..][..self.joints]
    }

    pub(super) fn ssd(self, a: usize, b: usize) -> f64 {
        ssd(self.pose(a), self.pose(b))
    }

    pub(super) fn speeds(self) -> Vec<f64> {
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
