//! Frames of a clip of any length, evenly spaced and reduced, to learn from.

use super::frame::Frame;

/// The most frames that are kept.
const MAX_SAMPLES: usize = 48;
/// Samples are at most this many pixels wide and high.
const MAX_SIDE: u32 = 320;

/// Some frames of a clip, in the order of time.
#[derive(Debug, Clone)]
pub(super) struct Samples {
    /// Every so many pixels and rows one is kept.
    pub(super) step: usize,
    /// Columns and rows of a sample.
    pub(super) size: [usize; 2],
    /// The samples, pixel by pixel.
    pub(super) frames: Vec<Vec<[u8; 3]>>,
    /// Every so many frames one is kept.
    stride: usize,
    /// The frames so far.
    seen: usize,
}

impl Samples {
    /// No samples of pictures of this size.
    pub(super) fn new(size: [u32; 2]) -> Self {
        let step = size[0].max(size[1]).div_ceil(MAX_SIDE).max(1) as usize;
        Self {
            step,
            size: size.map(|side| (side as usize).div_ceil(step)),
            frames: Vec::new(),
            stride: 1,
            seen: 0,
        }
    }

    /// Looks at the next frame of the clip.
    pub(super) fn push(&mut self, frame: Frame<'_>) {
        if self.seen.is_multiple_of(self.stride) {
            if self.frames.len() == MAX_SAMPLES {
                self.stride *= 2;
                let mut is_kept = false;
                self.frames.retain(|_| {
                    is_kept = !is_kept;
                    is_kept
                });
            }
            if self.seen.is_multiple_of(self.stride) {
                self.frames.push(frame.rows(self.step).flatten().collect());
            }
        }
        self.seen += 1;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn samples_are_evenly_spaced() {
        for count in [1, MAX_SAMPLES, MAX_SAMPLES + 1, 200, 1000] {
            let mut samples = Samples::new([1, 1]);
            for number in 0..count {
                let pixel = [(number >> 8) as u8, number as u8, 0];
                samples.push(Frame::new([1, 1], &pixel).unwrap());
            }
            let numbers: Vec<usize> = samples
                .frames
                .iter()
                .map(|frame| usize::from(frame[0][0]) << 8 | usize::from(frame[0][1]))
                .collect();
            let expected: Vec<usize> = (0..count).step_by(samples.stride).collect();
            assert_eq!(numbers, expected);
            assert!(numbers.len() <= MAX_SAMPLES && numbers.len() >= count.min(MAX_SAMPLES / 2));
        }
    }

    #[test]
    fn samples_of_large_pictures_are_small() {
        let samples = Samples::new([4096, 100]);
        assert_eq!((samples.step, samples.size), (13, [316, 8]));
    }
}
