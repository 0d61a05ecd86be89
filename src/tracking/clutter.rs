//! What looks like a mark and never moves.

use std::fmt;

use glam::DVec2;

use super::appearance::Appearance;
use super::components::{Component, components, push_pixel};
use super::lookup::Lookup;
use super::samples::Samples;
use crate::regions::{Span, connected_runs};

/// What looks like a mark in more than this part of the samples stands still.
const STILL: f64 = 0.8;
/// What moves is at a place in at most this part of them: noise makes pixels look like a mark now and then.
const MOVING: f64 = 0.4;
/// With fewer samples nothing is known to stand still.
const LEAST_SAMPLES: usize = 5;
/// The fewest pixels of a sample that may be a mark.
const LEAST_AREA: f64 = 3.0;
/// What covers more than this part of a square with the picture's smaller side is seldom a mark: a disc as wide as a sixth of it.
pub(super) const LARGEST: f64 = 0.022;
/// Anything that has this part of the picture may be a mark.
const MARK: f64 = 2e-4;

/// For each pixel of a sample, the marks of which it looks in most frames; pixels beside such ones included.
#[derive(Clone)]
pub(super) struct Clutter {
    /// The sets of marks, a bit for each, row by row.
    pub(super) marks: Vec<u64>,
    size: [usize; 2],
    /// Per mark in how many of the samples each pixel looks like it, from 0 to 255; empty with few samples.
    often: Vec<Vec<u8>>,
}

impl fmt::Debug for Clutter {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Clutter")
            .field("size", &self.size)
            .finish_non_exhaustive()
    }
}

impl Clutter {
    /// Nothing.
    pub(super) fn none(size: [usize; 2]) -> Self {
        Self {
            marks: vec![0; size[0] * size[1]],
            size,
            often: Vec::new(),
        }
    }

    /// What is taken for one of the marks and is none.
    pub(super) fn find(samples: &Samples, appearances: &[Appearance]) -> Self {
        let mut clutter = Self::none(samples.size);
        if samples.frames.len() < LEAST_SAMPLES {
            return clutter;
        }
        let lookup = Lookup::new(appearances);
        // With noise, what is nearly like a mark looks like it now and then.
        let widened: Vec<Appearance> = appearances.iter().map(Appearance::widened).collect();
        let widened = Lookup::new(&widened);
        for mark in 0..appearances.len() {
            let counts = counts(samples, &widened, mark);
            let all = samples.frames.len() as f64;
            let often = counts.iter().map(|count| (255.0 * count / all) as u8);
            clutter.often.push(often.collect());
            // The marks themselves may rest for most of a clip.
            for group in still_groups(samples, &lookup, mark, &counts) {
                clutter.add(mark, &group);
            }
        }
        clutter
    }

    /// How much of the picture it is for a mark, from 0 to 1.
    pub(super) fn part(&self, mark: usize) -> f64 {
        let found = self
            .marks
            .iter()
            .filter(|marks| *marks >> mark & 1 == 1)
            .count();
        found as f64 / self.marks.len() as f64
    }

    /// In which part of the frames a pixel of the sample looks like a mark, from 0 to 1.
    pub(super) fn often(&self, mark: usize, [x, y]: [usize; 2]) -> f64 {
        let pixel = y.min(self.size[1] - 1) * self.size[0] + x.min(self.size[0] - 1);
        let often = self.often.get(mark).and_then(|often| often.get(pixel));
        often.map_or(0.0, |often| f64::from(*often) / 255.0)
    }

    /// Whether it is in a rectangle of pixels of the sample, ends included, or beside it.
    pub(super) fn touches(&self, mark: usize, least: [usize; 2], most: [usize; 2]) -> bool {
        let [width, height] = self.size;
        let rows = least[1].saturating_sub(1)..=(most[1] + 1).min(height - 1);
        let (from, to) = (least[0].saturating_sub(1), (most[0] + 1).min(width - 1));
        rows.into_iter().any(|y| {
            let row = &self.marks[y * width + from..=y * width + to];
            row.iter().any(|marks| marks >> mark & 1 == 1)
        })
    }

    /// Adds pixels, and those beside them.
    fn add(&mut self, mark: usize, pixels: &[usize]) {
        let [width, height] = self.size;
        for pixel in pixels {
            let (x, y) = (pixel % width, pixel / width);
            for y in y.saturating_sub(1)..=(y + 1).min(height - 1) {
                for x in x.saturating_sub(1)..=(x + 1).min(width - 1) {
                    self.marks[y * width + x] |= 1 << mark;
                }
            }
        }
    }
}

/// The components of a sample's pixels, by what weighs the ones that look like a mark.
pub(super) fn likenesses(
    sample: &[[u8; 3]],
    size: [usize; 2],
    weight: impl Fn(usize, [u8; 3]) -> Option<f64>,
) -> Vec<Component> {
    let mut runs = Vec::new();
    for (index, pixel) in sample.iter().enumerate() {
        if let Some(weight) = weight(index, *pixel) {
            let (x, y) = (index % size[0], index / size[0]);
            push_pixel(&mut runs, x as u32, y as u32, weight, DVec2::ZERO);
        }
    }
    components(&runs)
}

/// In how many samples each pixel looks like a mark.
fn counts(samples: &Samples, lookup: &Lookup, mark: usize) -> Vec<f64> {
    let mut counts = vec![0.0; samples.size[0] * samples.size[1]];
    for sample in &samples.frames {
        for (count, pixel) in counts.iter_mut().zip(sample) {
            *count += (lookup.marks(*pixel) >> mark & 1) as f64;
        }
    }
    counts
}

/// The groups of pixels that stand still also where the mark is seen elsewhere: a mark that only rests for long leaves its place then.
fn still_groups(
    samples: &Samples,
    lookup: &Lookup,
    mark: usize,
    counts: &[f64],
) -> Vec<Vec<usize>> {
    let all = samples.frames.len() as f64;
    let is_still = |index: usize| counts[index] > STILL * all;
    let is_like = |pixel: [u8; 3]| lookup.marks(pixel) >> mark & 1 == 1;
    let groups = groups(samples.size, is_still);
    if groups.is_empty() {
        return groups;
    }
    // Pixels beside those that stand still look like the mark now and then.
    let mut around = Clutter::none(samples.size);
    for group in &groups {
        around.add(mark, group);
    }
    // A mark that moves a little covers its middle in most samples: what is connected with that is not elsewhere.
    let is_moving = |index: usize| around.marks[index] == 0 && counts[index] <= MOVING * all;
    let weight = |index: usize, pixel: [u8; 3]| {
        is_like(pixel).then_some(if is_moving(index) { 1.0 } else { 0.5 })
    };
    let elsewhere = |sample: &Vec<[u8; 3]>| {
        let found = likenesses(sample, samples.size, weight).into_iter();
        let apart = found.filter(|found| found.weight == found.area);
        apart.map(|found| found.area).fold(0.0, f64::max)
    };
    let areas: Vec<f64> = samples.frames.iter().map(elsewhere).collect();
    let mut sorted: Vec<f64> = areas
        .iter()
        .copied()
        .filter(|area| *area >= LEAST_AREA)
        .collect();
    sorted.sort_by(f64::total_cmp);
    let least = sorted
        .get(sorted.len() / 2)
        .map_or(LEAST_AREA, |area| LEAST_AREA.max(0.3 * area));
    let largest = MARK * (samples.size[0] * samples.size[1]) as f64;
    let too_large = LARGEST * samples.size[0].min(samples.size[1]).pow(2) as f64;
    let stays = |group: &Vec<usize>| {
        // What is too large for a mark cannot be one at rest.
        if group.len() as f64 > too_large {
            return true;
        }
        let frames = samples.frames.iter().zip(&areas);
        let (mut there, mut all) = (0, 0);
        // What is much smaller than a mark at rest is noise.
        let least = least.max(largest.min(0.25 * group.len() as f64));
        for (sample, _) in frames.filter(|(_, area)| **area >= least) {
            let like = group
                .iter()
                .filter(|index| is_like(sample[**index]))
                .count();
            all += 1;
            there += usize::from(2 * like > group.len());
        }
        2 * there > all
    };
    groups.into_iter().filter(stays).collect()
}

/// The groups of connected pixels.
fn groups(size: [usize; 2], has: impl Fn(usize) -> bool) -> Vec<Vec<usize>> {
    let [width, height] = size;
    let mut runs: Vec<Span> = Vec::new();
    for index in (0..width * height).filter(|index| has(*index)) {
        let (x, y) = ((index % width) as u32, (index / width) as u32);
        if !runs.last_mut().is_some_and(|run| run.extend(x, y)) {
            runs.push(Span::pixel(x, y));
        }
    }
    let (labels, count) = connected_runs(&runs, |run| *run);
    let mut groups = vec![Vec::new(); count];
    for (run, label) in runs.iter().zip(labels) {
        let row = run.y as usize * width;
        groups[label as usize].extend(row + run.from as usize..row + run.to as usize);
    }
    groups
}
