//! What the marks of a clip look like, learned from some of its frames.

use crate::math;
use glam::DVec3;
use thiserror::Error;

use super::appearance::Appearance;
use super::clutter::{Clutter, LARGEST, likenesses};
use super::color::{HUES, Hsv, hue_difference, hue_name};
use super::frame::Frame;
use super::lookup::Lookup;
use super::mark::Mark;
use super::samples::Samples;

/// How far the hue of a mark may be from the one that is named, degrees.
const NAMED_REACH: f64 = 35.0;
/// What is paler is no mark.
const LEAST_SATURATION: f64 = 0.25;
/// What is darker or paler is no mark.
const LEAST_CHROMA: f64 = 0.12;
/// The range of hues that a mark can have to either side, degrees.
const REACHES: [f64; 2] = [10.0, 20.0];
/// The least chroma and saturation of a mark, as parts of what is usual for it: half of the light, and blurred borders.
const PALEST: [f64; 2] = [0.35, 0.6];
/// The fewest pixels of all samples that a mark is learned from.
const LEAST_PIXELS: f64 = 8.0;
/// The fewest pixels of a sample that a mark usually has.
const LEAST_AREA: f64 = 5.0;
/// A mark is in at least one of so many samples.
const RAREST: usize = 8;
/// A hue is in the clip if it has this part of the pixels.
const LEAST_PART: f64 = 5e-4;

/// Learns marks from the frames of a clip, one after the other. It keeps some of them, reduced.
#[derive(Debug, Clone)]
pub struct Learner {
    size: [u32; 2],
    marks: Vec<Mark>,
    samples: Samples,
}

/// Marks that can be tracked.
#[derive(Debug, Clone)]
pub struct Learned {
    pub(super) size: [u32; 2],
    pub(super) marks: Vec<LearnedMark>,
    pub(super) lookup: Lookup,
    pub(super) clutter: Clutter,
    /// Pixels beside each other in a sample are so many pixels apart.
    pub(super) step: usize,
}

/// A mark, and what was learned about it.
#[derive(Debug, Clone)]
pub(super) struct LearnedMark {
    pub(super) mark: Mark,
    /// How many pixels of the picture it has.
    pub(super) area: f64,
    pub(super) appearance: Appearance,
}

/// Why a mark cannot be tracked.
#[derive(Debug, Clone, PartialEq, Error)]
#[error("has no pixels of the hue {}", hue_name(*.hue))]
pub struct LearnError {
    /// The index of the mark.
    pub mark: usize,
    /// Its hue, degrees.
    pub hue: f64,
    /// The names of the hues that the clip has, the largest areas first.
    pub hues: Vec<&'static str>,
}

impl Learner {
    /// A learner of at most 64 marks in pictures of this size.
    pub fn new(size: [u32; 2], mut marks: Vec<Mark>) -> Self {
        marks.truncate(u64::BITS as usize);
        Self {
            size,
            marks,
            samples: Samples::new(size),
        }
    }

    /// Looks at the next frame of the clip; frames of another size are passed over.
    pub fn push(&mut self, frame: Frame<'_>) {
        if frame.size == self.size {
            self.samples.push(frame);
        }
    }

    /// What was learned from the frames so far.
    ///
    /// # Errors
    /// If a mark is in none of them.
    pub fn learned(&self) -> Result<Learned, LearnError> {
        let named: Vec<Appearance> = (0..self.marks.len()).map(|mark| self.named(mark)).collect();
        let lookup = Lookup::new(&named);
        let clutter = Clutter::find(&self.samples, &named);
        let mut appearances = Vec::new();
        for mark in 0..self.marks.len() {
            let appearance = self.appearance(mark, &lookup, Some(&clutter));
            let appearance = appearance.or_else(|| self.appearance(mark, &lookup, None));
            appearances.push(appearance.ok_or_else(|| self.not_found(mark))?);
        }
        self.separate(&mut appearances);
        let clutter = Clutter::find(&self.samples, &appearances);
        let lookup = Lookup::new(&appearances);
        let mut marks = Vec::new();
        for (index, mark) in self.marks.iter().enumerate() {
            let area = self.area(index, &lookup, &clutter);
            // A few pixels are noise, or the blurred border between other colours.
            if area < LEAST_AREA {
                return Err(self.not_found(index));
            }
            marks.push(LearnedMark {
                mark: mark.clone(),
                area: area * (self.samples.step * self.samples.step) as f64,
                appearance: appearances[index],
            });
        }
        Ok(Learned {
            size: self.size,
            marks,
            lookup,
            clutter,
            step: self.samples.step,
        })
    }

    /// The colours that a mark's name stands for: those nearer to it than to the others' names.
    fn named(&self, mark: usize) -> Appearance {
        let hue = self.marks[mark].hue;
        let others = self
            .marks
            .iter()
            .enumerate()
            .filter(|(other, _)| *other != mark);
        let nearest = others
            .map(|(_, other)| hue_difference(other.hue, hue).abs() / 2.0)
            .filter(|half| *half > 0.0)
            .fold(NAMED_REACH, f64::min);
        Appearance {
            hue,
            reach: nearest,
            saturation: LEAST_SATURATION,
            chroma: LEAST_CHROMA,
            usual: 1.0,
        }
    }

    /// What a mark looks like, by the pixels of its named hue that are no clutter. The most coloured ones weigh most: skin and wood have
    /// the hues of marks, but are pale.
    fn appearance(
        &self,
        mark: usize,
        lookup: &Lookup,
        clutter: Option<&Clutter>,
    ) -> Option<Appearance> {
        let named = self.named(mark);
        /// Hues are counted in steps of so many degrees.
        const STEP: f64 = 2.0;
        let mut bins = [0.0; 360 / STEP as usize];
        let mut pixels = Vec::new();
        for sample in &self.samples.frames {
            for (index, pixel) in sample.iter().enumerate() {
                let is_clutter =
                    clutter.is_some_and(|clutter| clutter.marks[index] >> mark & 1 == 1);
                if is_clutter || lookup.marks(*pixel) >> mark & 1 == 0 {
                    continue;
                }
                let color = Hsv::of(*pixel);
                let away = hue_difference(color.hue, named.hue) / named.reach.max(1.0);
                let weight =
                    (color.chroma * color.saturation).powi(4) * (1.2 - away * away).clamp(0.2, 1.0);
                bins[(color.hue / STEP) as usize % bins.len()] += weight;
                pixels.push((color, weight));
            }
        }
        if (pixels.len() as f64) < LEAST_PIXELS {
            return None;
        }
        let around = |bin: usize| -> f64 {
            let bins = [
                bin + bins.len() - 2,
                bin + bins.len() - 1,
                bin,
                bin + 1,
                bin + 2,
            ]
            .map(|bin| bins[bin % bins.len()]);
            bins.iter().sum()
        };
        let peak = (0..bins.len()).max_by(|a, b| around(*a).total_cmp(&around(*b)))?;
        let peak = (peak as f64 + 0.5) * STEP;
        let near = || {
            let pixels = pixels.iter();
            pixels.filter(|(color, _)| hue_difference(color.hue, peak).abs() < REACHES[1])
        };
        let total: f64 = near().map(|(_, weight)| weight).sum();
        let mean = |value: &dyn Fn(&Hsv) -> f64| {
            near()
                .map(|(color, weight)| value(color) * weight)
                .sum::<f64>()
                / total
        };
        let offset = mean(&|color| hue_difference(color.hue, peak));
        let spread = mean(&|color| (hue_difference(color.hue, peak) - offset).powi(2)).sqrt();
        let usual = mean(&|color| color.chroma);
        Some(Appearance {
            usual,
            hue: (peak + offset).rem_euclid(360.0),
            reach: (2.2 * spread).clamp(REACHES[0], REACHES[1]),
            saturation: LEAST_SATURATION.max(PALEST[1] * mean(&|color| color.saturation)),
            chroma: LEAST_CHROMA.max(PALEST[0] * usual),
        })
    }

    /// Narrows the hues of marks so that none has those of another.
    fn separate(&self, appearances: &mut [Appearance]) {
        let hues: Vec<f64> = appearances
            .iter()
            .map(|appearance| appearance.hue)
            .collect();
        for (mark, appearance) in appearances.iter_mut().enumerate() {
            for (other, hue) in hues.iter().enumerate() {
                let half = hue_difference(*hue, appearance.hue).abs() / 2.0;
                if other != mark && half > 1.0 {
                    appearance.reach = appearance.reach.min(half);
                }
            }
        }
    }

    /// How many pixels of a sample a mark usually has; 0 if it never has enough to be one.
    fn area(&self, mark: usize, lookup: &Lookup, clutter: &Clutter) -> f64 {
        let areas = |sample: &Vec<[u8; 3]>| -> Vec<f64> {
            let is_mark = |marks: u64| marks >> mark & 1 == 1;
            let found = likenesses(sample, self.samples.size, |index, pixel| {
                let is_it = !is_mark(clutter.marks[index]) && is_mark(lookup.marks(pixel));
                is_it.then_some(1.0)
            });
            let areas = found.iter().map(|found| found.area);
            areas.filter(|area| *area >= LEAST_AREA).collect()
        };
        // Where the mark is out of the picture there may still be specks of its colour.
        let mut areas: Vec<Vec<f64>> = self.samples.frames.iter().map(areas).collect();
        areas.retain(|areas| !areas.is_empty());
        // Specks that are as large as a mark are rare.
        if areas.len() * RAREST < self.samples.frames.len() {
            return 0.0;
        }
        let sides = self.samples.size.map(|side| side as f64);
        usual_area(&areas, LARGEST * sides[0].min(sides[1]).powi(2))
    }

    /// That a mark is not in the clip.
    fn not_found(&self, mark: usize) -> LearnError {
        LearnError {
            mark,
            hue: self.marks[mark].hue,
            hues: self.hues(),
        }
    }

    /// The names of the hues that the samples have, the largest areas first.
    fn hues(&self) -> Vec<&'static str> {
        let mut counts = HUES.map(|(name, _)| (name, 0_usize));
        let mut all = 0;
        for pixel in self.samples.frames.iter().flatten() {
            let color = Hsv::of(*pixel);
            all += 1;
            if color.saturation >= LEAST_SATURATION && color.chroma >= LEAST_CHROMA {
                let name = hue_name(color.hue);
                if let Some(count) = counts.iter_mut().find(|(other, _)| *other == name) {
                    count.1 += 1;
                }
            }
        }
        counts.sort_by_key(|(_, count)| std::cmp::Reverse(*count));
        let found = counts
            .iter()
            .filter(|(_, count)| *count as f64 > LEAST_PART * f64::from(all));
        found.map(|(name, _)| *name).collect()
    }
}

/// The area of a mark, of the areas of all things of its hue in each sample: that of the largest thing in most of them. If that is
/// larger than marks are, and something smaller is in half as many samples, a surface of the mark's hue passes, and the mark is smaller.
fn usual_area(samples: &[Vec<f64>], largest: f64) -> f64 {
    let usual = |most: f64| {
        let own = samples.iter().filter_map(|areas| {
            let areas = areas.iter().copied();
            areas.filter(|area| *area <= most).reduce(f64::max)
        });
        let mut own: Vec<f64> = own.collect();
        own.sort_by(f64::total_cmp);
        (own.get(own.len() / 2).copied().unwrap_or(0.0), own.len())
    };
    let (any, _) = usual(f64::INFINITY);
    if any <= largest {
        return any;
    }
    match usual(largest) {
        (small, count) if 2 * count >= samples.len() => small,
        _ => any,
    }
}

impl LearnedMark {
    /// How it looks usually: how far its hue is from what was learned, degrees, and the logarithms of its chroma and of its area.
    pub(super) fn look(&self) -> DVec3 {
        DVec3::new(0.0, math::ln(self.appearance.usual), math::ln(self.area))
    }
}

impl Learned {
    /// How much of the picture looks like a mark without being it, from 0 to 1.
    pub fn clutter(&self, mark: usize) -> f64 {
        self.clutter.part(mark)
    }
}
