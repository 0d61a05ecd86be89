//! What a mark looks like.

use glam::DVec2;

use super::color::{Hsv, hue_difference};

/// The colours that are a mark's.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Appearance {
    /// The middle of its hues, degrees.
    pub(super) hue: f64,
    /// How far hues may be from it, degrees.
    pub(super) reach: f64,
    /// The least saturation.
    pub(super) saturation: f64,
    /// The least chroma.
    pub(super) chroma: f64,
    /// The chroma that it usually has.
    pub(super) usual: f64,
}

impl Appearance {
    /// Whether a colour may be the mark's.
    pub(super) fn has(&self, color: Hsv) -> bool {
        color.chroma >= self.chroma
            && color.saturation >= self.saturation
            && hue_difference(color.hue, self.hue).abs() <= self.reach
    }

    /// How far the hue of a colour is from the mark's, degrees, and its chroma.
    pub(super) fn tint(&self, color: Hsv) -> DVec2 {
        DVec2::new(hue_difference(color.hue, self.hue), color.chroma)
    }

    /// How much a colour that may be the mark's is like it, from just above 0 to 1.
    pub(super) fn likeness(&self, color: Hsv) -> f64 {
        let away = (hue_difference(color.hue, self.hue) / self.reach).clamp(-1.0, 1.0);
        (color.chroma / self.usual).clamp(0.05, 1.0) * (1.0 - 0.7 * away * away)
    }

    /// The colours that could be taken for the mark's in another light, or with noise.
    pub(super) fn widened(&self) -> Self {
        Self {
            hue: self.hue,
            reach: 1.2 * self.reach,
            saturation: 0.85 * self.saturation,
            chroma: 0.7 * self.chroma,
            usual: self.usual,
        }
    }
}
