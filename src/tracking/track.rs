//! Marks followed from frame to frame.

use glam::DVec2;

use super::color::Hsv;
use super::components::{Component, Run, components as connected, push_pixel};
use super::frame::Frame;
use super::learn::Learned;
use super::traces::Thing;

/// Larger pictures are looked at in steps: a mark has many pixels there.
const MAX_PIXELS: usize = 1 << 20;
/// How far a mark may be from where it is expected, as a part of the picture's diagonal: more makes it doubtful.
const REACH: f64 = 0.06;
/// The least score of what is taken for a mark, of at most 1.
const LEAST_SCORE: f64 = 0.12;
/// How similar in size to the mark it must be, from 0 to 1.
const LEAST_SIMILARITY: f64 = 0.25;
/// The same for a mark that was lost.
const LEAST_SIMILARITY_LOST: f64 = 0.35;
/// Below this part of its size, a mark is covered: its middle is not the middle of what is seen.
const COVERED: f64 = 0.75;
/// Below this part of its size, a covered mark is lost.
const LEAST_PART: f64 = 0.35;
/// The same for a mark that was lost: nobody knows where its middle is.
const LEAST_PART_LOST: f64 = 0.6;
/// What is so many times as large as the mark has something else in it.
const MERGED: f64 = 2.5;
/// The most pixels of noise.
const NOISE: f64 = 3.0;
/// The part that a new velocity or area has in the expected one.
const NEW_VELOCITY: f64 = 0.7;
const NEW_AREA: f64 = 0.05;

/// A mark in a frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sighting {
    /// Its middle, pixels.
    pub at: DVec2,
    /// The radius of a disc of its size, pixels.
    pub radius: f64,
}

/// Follows marks through the frames of a clip.
#[derive(Debug, Clone)]
pub struct Tracker {
    pub(super) learned: Learned,
    followed: Vec<Followed>,
    /// Every so many pixels one is looked at.
    step: usize,
    runs: Vec<Vec<Run>>,
    /// Per mark what is connected of them.
    components: Vec<Vec<Component>>,
}

/// What is known about a mark from the frames so far.
#[derive(Debug, Clone)]
struct Followed {
    /// Where it was seen last.
    last: Option<DVec2>,
    /// How far it moves in a frame, pixels.
    velocity: DVec2,
    /// Its usual area, pixels.
    area: f64,
    /// The area when it was seen last, pixels.
    last_area: f64,
    /// In how many frames it was lost since.
    lost: usize,
    /// Where it may have been found again, far from where it was lost, in the frame before.
    doubtful: Option<DVec2>,
}

impl Tracker {
    /// A tracker of these marks.
    pub fn new(learned: Learned) -> Self {
        let pixels = learned.size[0] as usize * learned.size[1] as usize;
        let followed = learned.marks.iter().map(|mark| Followed {
            last: None,
            velocity: DVec2::ZERO,
            area: mark.area,
            last_area: mark.area,
            lost: 0,
            doubtful: None,
        });
        Self {
            step: (pixels as f64 / MAX_PIXELS as f64).sqrt().ceil().max(1.0) as usize,
            followed: followed.collect(),
            runs: vec![Vec::new(); learned.marks.len()],
            components: vec![Vec::new(); learned.marks.len()],
            learned,
        }
    }

    /// Says where a mark is, as a person does who points at it: it is looked for there in the next frame.
    pub fn start(&mut self, mark: usize, at: DVec2) {
        if let Some(followed) = self.followed.get_mut(mark) {
            followed.last = Some(at);
            followed.velocity = DVec2::ZERO;
            followed.lost = 0;
        }
    }

    /// The marks in the next frame; `None` for those that are lost, and for all in a frame of another size.
    pub fn push(&mut self, frame: Frame<'_>) -> Vec<Option<Sighting>> {
        if frame.size != self.learned.size {
            self.components.iter_mut().for_each(Vec::clear);
            return vec![None; self.followed.len()];
        }
        self.find_components(frame);
        let expected: Vec<Option<DVec2>> = self.followed.iter().map(Followed::expected).collect();
        (0..self.followed.len())
            .map(|mark| self.follow(mark, &expected))
            .collect()
    }

    /// The things in the last frame that could be a mark.
    pub(super) fn things(&self, mark: usize) -> Vec<Thing> {
        let scale = self.step as f64;
        let usual = self.learned.marks[mark].area;
        let thing = |component: &Component| Thing {
            at: component.middle * scale,
            area: component.area * scale * scale,
            tint: component.tint,
            is_beside_clutter: self.touches_clutter(mark, component),
            often: {
                let place = component.middle * scale / self.learned.step as f64;
                let place = place.to_array().map(|side| side as usize);
                self.learned.clutter.often(mark, place)
            },
        };
        let things = self.components[mark].iter().map(thing);
        let is_possible =
            |thing: &Thing| (LEAST_SIMILARITY..MERGED).contains(&(thing.area / usual));
        things.filter(is_possible).collect()
    }

    /// Finds what looks like the marks.
    fn find_components(&mut self, frame: Frame<'_>) {
        for runs in &mut self.runs {
            runs.clear();
        }
        let Learned {
            lookup, clutter, ..
        } = &self.learned;
        let columns = (self.learned.size[0] as usize).div_ceil(self.learned.step);
        for (y, row) in frame.rows(self.step).enumerate() {
            let still = y * self.step / self.learned.step * columns;
            for (x, pixel) in row.enumerate() {
                let mut marks = lookup.marks(pixel);
                if marks == 0 {
                    continue;
                }
                marks &= !clutter.marks[still + x * self.step / self.learned.step];
                let color = Hsv::of(pixel);
                while marks != 0 {
                    let mark = marks.trailing_zeros() as usize;
                    marks &= marks - 1;
                    let appearance = &self.learned.marks[mark].appearance;
                    let (weight, tint) = (appearance.likeness(color), appearance.tint(color));
                    push_pixel(&mut self.runs[mark], x as u32, y as u32, weight, tint);
                }
            }
        }
        for (components, runs) in self.components.iter_mut().zip(&self.runs) {
            *components = connected(runs);
            components.retain(|component| component.area > NOISE);
        }
    }

    /// Finds a mark near where it is expected.
    fn follow(&mut self, mark: usize, expected: &[Option<DVec2>]) -> Option<Sighting> {
        let scale = self.step as f64;
        let diagonal = DVec2::from_array(self.learned.size.map(f64::from)).length();
        let followed = &self.followed[mark];
        let radius = followed.radius();
        let reach = (REACH * diagonal + radius / 2.0) * (1 + followed.lost) as f64;
        let place = |component: &Component| component.middle * scale;
        let score = |component: &Component| {
            let area = component.area * scale * scale;
            let similarity = followed.similarity(area);
            let likeness = component.weight / component.area;
            let distance =
                expected[mark].map_or(0.0, |expected| place(component).distance(expected));
            (
                similarity,
                similarity * likeness / (1.0 + (distance / reach).powi(2)),
            )
        };
        let least = match followed.lost {
            0 => LEAST_SIMILARITY,
            _ => LEAST_SIMILARITY_LOST,
        };
        let found = self.components[mark]
            .iter()
            .map(|component| (score(component), *component))
            .filter(|((similarity, score), _)| *similarity >= least && *score >= LEAST_SCORE)
            .max_by(|a, b| a.0.1.total_cmp(&b.0.1))
            .map(|(_, component)| component);
        let seen = found.and_then(|component| self.middle(mark, &component, expected));
        let followed = &mut self.followed[mark];
        let Some((at, area)) = seen else {
            followed.lose(None);
            return None;
        };
        // What is found again far away may be something else: then it is elsewhere in the next frame, or gone.
        let is_far = |from: DVec2| from.distance(at) > 1.5 * (REACH * diagonal + radius / 2.0);
        if expected[mark].is_some_and(is_far) && followed.doubtful.is_none_or(is_far) {
            followed.lose(Some(at));
            return None;
        }
        followed.see(at, area);
        Some(Sighting {
            at,
            radius: followed.radius(),
        })
    }

    /// The middle of a mark of which a component is seen, and its area if it is seen as a whole; `None` if too little is seen.
    fn middle(
        &self,
        mark: usize,
        component: &Component,
        expected: &[Option<DVec2>],
    ) -> Option<(DVec2, Option<f64>)> {
        let scale = self.step as f64;
        let followed = &self.followed[mark];
        let area = component.area * scale * scale;
        let middle = component.middle * scale;
        let part = area / followed.area;
        if part > MERGED
            && let Some(expected) = expected[mark]
        {
            let reach = 1.3 * followed.radius() / scale;
            let within = windowed(&self.runs[mark], expected / scale, reach)?;
            return Some((within * scale, None));
        }
        if part >= COVERED || !self.may_be_covered(mark, component, expected) {
            return Some((middle, Some(area)));
        }
        match expected[mark].filter(|_| followed.lost == 0) {
            Some(expected) => (part >= LEAST_PART).then(|| (expected.lerp(middle, part), None)),
            None => (part >= LEAST_PART_LOST).then_some((middle, None)),
        }
    }

    /// Whether the edge of the picture, clutter or another mark may hide some of a mark.
    fn may_be_covered(
        &self,
        mark: usize,
        component: &Component,
        expected: &[Option<DVec2>],
    ) -> bool {
        let [least, most] = [component.least, component.most]
            .map(|corner| corner.map(|place| place as usize * self.step));
        let size = self.learned.size.map(|side| side as usize);
        let is_at_edge =
            (0..2).any(|axis| least[axis] <= 1 || most[axis] + self.step + 1 >= size[axis]);
        let is_beside_another = |other: usize| {
            let reach = self.followed[mark].radius() + self.followed[other].radius() + 4.0;
            let middle = component.middle * self.step as f64;
            other != mark
                && expected[other].is_some_and(|other| other.distance(middle) < 1.5 * reach)
        };
        is_at_edge
            || self.touches_clutter(mark, component)
            || (0..expected.len()).any(is_beside_another)
    }

    /// Whether a component is beside what looks like the mark and stands still.
    fn touches_clutter(&self, mark: usize, component: &Component) -> bool {
        let [least, most] = [component.least, component.most]
            .map(|corner| corner.map(|place| place as usize * self.step / self.learned.step));
        self.learned.clutter.touches(mark, least, most)
    }
}

impl Followed {
    /// Where the mark should be in the next frame.
    fn expected(&self) -> Option<DVec2> {
        // A mark that is lost may have stopped.
        let velocity = match self.lost {
            0 => self.velocity,
            _ => DVec2::ZERO,
        };
        self.last.map(|last| last + velocity)
    }

    /// How similar an area is to the usual one, or to that in the frame before, from 0 to 1.
    fn similarity(&self, area: f64) -> f64 {
        let to = |other: f64| (area / other).min(other / area);
        match self.lost {
            0 => to(self.area).max(to(self.last_area)),
            _ => to(self.area),
        }
    }

    /// The radius of a disc of its area, pixels.
    fn radius(&self) -> f64 {
        (self.area / std::f64::consts::PI).sqrt()
    }

    fn lose(&mut self, doubtful: Option<DVec2>) {
        self.lost += 1;
        self.doubtful = doubtful;
    }

    fn see(&mut self, at: DVec2, area: Option<f64>) {
        self.velocity = match self.last {
            Some(last) if self.lost == 0 => self.velocity.lerp(at - last, NEW_VELOCITY),
            _ => DVec2::ZERO,
        };
        self.last = Some(at);
        self.lost = 0;
        self.doubtful = None;
        if let Some(area) = area {
            self.area += NEW_AREA * (area - self.area);
            self.last_area = area;
        }
    }
}

/// The middle of the pixels within a circle, which follows them in a few steps.
fn windowed(runs: &[Run], start: DVec2, radius: f64) -> Option<DVec2> {
    let mut middle = start;
    for _ in 0..4 {
        let (mut sum, mut count) = (DVec2::ZERO, 0.0);
        for Run { span, .. } in runs {
            let y = f64::from(span.y);
            let half = (radius * radius - (y - middle.y).powi(2)).max(0.0).sqrt();
            let from = f64::from(span.from).max((middle.x - half).ceil());
            let to = f64::from(span.to - 1).min((middle.x + half).floor());
            if half > 0.0 && to >= from {
                let pixels = to - from + 1.0;
                sum += pixels * DVec2::new((from + to) / 2.0, y);
                count += pixels;
            }
        }
        if count == 0.0 {
            return None;
        }
        middle = sum / count;
    }
    Some(middle)
}
