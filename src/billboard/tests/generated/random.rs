//! The numbers of which generated characters are made.

use super::Form;

/// A small generator of numbers (SplitMix64).
pub(in crate::billboard) struct Random(u64);

impl Random {
    pub(in crate::billboard) fn new(seed: u64) -> Self {
        Self(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15))
    }

    pub(in crate::billboard) fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }

    pub(in crate::billboard) fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.next()
    }

    pub(super) fn chance(&mut self, share: f64) -> bool {
        self.next() < share
    }

    pub(in crate::billboard) fn below(&mut self, count: usize) -> usize {
        (self.next() * count as f64) as usize
    }

    /// A color whose channels lie between two values.
    pub(in crate::billboard) fn color(&mut self, low: f64, high: f64) -> [f64; 4] {
        let mut channel = || self.between(low, high);
        [channel(), channel(), channel(), 1.0]
    }

    pub(super) fn form(&mut self, boxes: f64) -> Form {
        if self.chance(boxes) {
            Form::Box
        } else {
            Form::Ellipsoid
        }
    }
}
