//! Which marks a colour may belong to, looked up in a table: hue and saturation are computed once for all marks and frames.

use std::fmt;

use super::appearance::Appearance;
use super::color::Hsv;

/// Bits of each channel that the table tells apart.
const BITS: usize = 6;

/// For each colour a set of marks, a bit for each.
#[derive(Clone)]
pub(super) struct Lookup(Vec<u64>);

impl fmt::Debug for Lookup {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Lookup").finish_non_exhaustive()
    }
}

impl Lookup {
    /// A table for at most 64 marks.
    pub(super) fn new(appearances: &[Appearance]) -> Self {
        let side = 1 << BITS;
        let middle = |level: usize| (level << (8 - BITS) | 1 << (7 - BITS)) as u8;
        let set = |cell: usize| {
            let levels = [
                cell >> (2 * BITS),
                cell >> BITS & (side - 1),
                cell & (side - 1),
            ];
            let color = Hsv::of(levels.map(middle));
            let marks = appearances.iter().enumerate();
            marks.fold(0, |set, (mark, appearance)| {
                set | u64::from(appearance.has(color)) << mark
            })
        };
        Self((0..side * side * side).map(set).collect())
    }

    /// The marks that a colour may belong to.
    pub(super) fn marks(&self, rgb: [u8; 3]) -> u64 {
        let [r, g, b] = rgb.map(|value| usize::from(value >> (8 - BITS)));
        self.0[r << (2 * BITS) | g << BITS | b]
    }
}
