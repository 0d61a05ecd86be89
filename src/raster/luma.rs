//! Colours as JPEG files store them, which have fewer pixels of hue than of brightness.

use glam::Vec2;

use super::canvas::Color;

/// How far a fringe's hue may be from a mixture of those beside it, and its brightness beyond theirs, in steps of 1/255.
const FRINGE: f32 = 20.0;

/// Brightness and hue, in steps of 1/255 (ITU-R BT.601).
#[derive(Debug, Clone, Copy)]
pub(super) struct LumaChroma {
    luma: f32,
    chroma: Vec2,
}

impl LumaChroma {
    pub(super) fn of([r, g, b, _]: Color) -> Self {
        let luma = 0.299 * r + 0.587 * g + 0.114 * b;
        Self {
            luma,
            chroma: Vec2::new(0.564 * (b - luma), 0.713 * (r - luma)),
        }
    }

    /// Whether it is what a JPEG file may make of the edge between two others: its brightness and its hue are between theirs, each on
    /// its own.
    pub(super) fn is_fringe(self, a: Self, b: Self) -> bool {
        let along = b.chroma - a.chroma;
        let share = (self.chroma - a.chroma).dot(along) / along.length_squared();
        let off = self.chroma.distance(a.chroma.lerp(b.chroma, share));
        let is_between =
            self.luma > a.luma.min(b.luma) - FRINGE && self.luma < a.luma.max(b.luma) + FRINGE;
        along.length() > FRINGE && (0.0..1.0).contains(&share) && off < FRINGE && is_between
    }
}
