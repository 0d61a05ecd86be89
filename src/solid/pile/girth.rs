//! Solids that are round about an upright line: hats about heads, skirts about hips.
//!
//! The section at a height is an ellipse as wide as the outline is there. A skirt ends in a level hem and a hat in a brim, where a
//! balloon would close.

use glam::DVec2;

/// The sections of a solid one above the other, in the drawing.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Girth {
    /// The drawing's y of the topmost section.
    pub first: f64,
    /// How far the sections are apart.
    pub step: f64,
    /// Per section its ellipses, from left to right.
    pub sections: Vec<Vec<Section>>,
    /// Between these y the solid changes from what it is by itself to the sections.
    pub from: Option<[f64; 2]>,
}

/// An ellipse seen from the edge.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Section {
    /// The middle of its width, and half of it.
    pub middle: f64,
    pub half: f64,
    /// How far it reaches to the front and to the back.
    pub depth: f64,
}

impl Section {
    fn at(&self, x: f64) -> f64 {
        let off = (x - self.middle) / self.half.max(f64::MIN_POSITIVE);
        self.depth * (1.0 - off * off).max(0.0).sqrt()
    }

    fn lerp(&self, other: &Self, share: f64) -> Self {
        let between = |a: f64, b: f64| a + (b - a) * share;
        Self {
            middle: between(self.middle, other.middle),
            half: between(self.half, other.half),
            depth: between(self.depth, other.depth),
        }
    }
}

impl Girth {
    /// How far the solid reaches to the front and to the back over a point, where by itself it reaches this far.
    pub(crate) fn reach(&self, point: DVec2, own: [f64; 2]) -> [f64; 2] {
        let around = self.around(point);
        let share = self.from.map_or(1.0, |[from, to]| {
            let share = ((point.y - from) / (to - from)).clamp(0.0, 1.0);
            share * share * (3.0 - 2.0 * share)
        });
        own.map(|own| own + (around - own) * share)
    }

    /// How far its sections reach over a point.
    pub(crate) fn around(&self, point: DVec2) -> f64 {
        let last = self.sections.len().saturating_sub(1);
        let place = ((point.y - self.first) / self.step).clamp(0.0, last as f64);
        let index = (place as usize).min(last.saturating_sub(1));
        let share = place - index as f64;
        let [Some(above), Some(below)] = [index, last.min(index + 1)].map(|i| self.sections.get(i))
        else {
            return 0.0;
        };
        if above.len() == below.len() {
            // Between sections that correspond to each other the border is straight.
            let pairs = above.iter().zip(below);
            let between = pairs.map(|(a, b)| a.lerp(b, share).at(point.x));
            return between.fold(0.0, f64::max);
        }
        let [above, below] = [above, below].map(|sections| {
            let heights = sections.iter().map(|section| section.at(point.x));
            heights.fold(0.0, f64::max)
        });
        above + (below - above) * share
    }

    /// The greatest depth of its sections.
    pub(crate) fn highest(&self) -> f64 {
        let sections = self.sections.iter().flatten();
        sections.map(|section| section.depth).fold(0.0, f64::max)
    }

    /// All its numbers, for hashes.
    pub(super) fn numbers(&self) -> impl Iterator<Item = f64> + '_ {
        let counts = self.sections.iter().map(|sections| sections.len() as f64);
        let sections = self.sections.iter().flatten();
        let sections = sections.flat_map(|section| [section.middle, section.half, section.depth]);
        let from = self.from.unwrap_or([f64::NAN; 2]);
        ([self.first, self.step].into_iter())
            .chain(from)
            .chain(counts)
            .chain(sections)
    }
}
