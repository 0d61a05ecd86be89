//! The ways of everything that could be a mark, from frame to frame.

use crate::math;
use glam::{DVec2, DVec3};

/// How far something is from where it is expected at most, as a part of the picture's diagonal.
const REACH: f64 = 0.06;
/// In how many frames something may be missing.
const MOST_MISSING: usize = 2;
/// What stands still moves at most so far, in pixels, and by its radius.
const STILL: f64 = 4.0;
/// Where something looks like the mark in more than this part of the clip, something stands.
const OFTEN: f64 = 0.4;
/// Of a surface that stands, now one part looks like the mark and now another, within so many times the radius of the largest.
const WIDEST: f64 = 5.0;
/// The part that a new velocity has in the expected one.
const NEW_VELOCITY: f64 = 0.5;

/// Something in a frame that could be a mark.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Thing {
    /// Its middle, pixels.
    pub(super) at: DVec2,
    /// Its area, pixels.
    pub(super) area: f64,
    /// How far its hue is from the mark's, degrees, and its chroma.
    pub(super) tint: DVec2,
    /// Whether it touches what looks like the mark and stands still.
    pub(super) is_beside_clutter: bool,
    /// In which part of the clip its place looks like the mark, from 0 to 1.
    pub(super) often: f64,
}

/// A thing in some frames that follow each other.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Trace {
    /// The first frame.
    pub(super) first: usize,
    /// The thing in each frame from there on; where it was missing for a moment, as it was before.
    pub(super) things: Vec<Thing>,
}

/// Joins things to traces.
#[derive(Debug, Clone)]
pub(super) struct Tracer {
    /// Pixels.
    reach: f64,
    frame: usize,
    ended: Vec<Trace>,
    open: Vec<Open>,
}

/// A trace that may go on.
#[derive(Debug, Clone)]
struct Open {
    trace: Trace,
    /// Pixels a frame.
    velocity: DVec2,
    /// In how many frames it has been missing.
    missing: usize,
}

impl Thing {
    /// The radius of a disc of its area, pixels.
    pub(super) fn radius(&self) -> f64 {
        (self.area / std::f64::consts::PI).sqrt()
    }

    /// How far its border is from that of another thing, pixels, if both are discs.
    pub(super) fn distance(&self, other: &Self) -> f64 {
        self.at.distance(other.at) - self.radius() - other.radius()
    }

    /// How it looks: its hue in degrees, and the logarithms of its chroma and of its area.
    pub(super) fn look(&self) -> DVec3 {
        DVec3::new(
            self.tint.x,
            math::ln(self.tint.y.max(1e-3)),
            math::ln(self.area),
        )
    }
}

impl Trace {
    /// The frame after the last one.
    pub(super) fn end(&self) -> usize {
        self.first + self.things.len()
    }

    /// How it looks: the mean of its things.
    pub(super) fn look(&self) -> DVec3 {
        let looks = self.things.iter().map(Thing::look);
        looks.sum::<DVec3>() / self.things.len() as f64
    }

    /// The mean of its places, pixels.
    pub(super) fn middle(&self) -> DVec2 {
        let places = self.things.iter().map(|thing| thing.at);
        places.sum::<DVec2>() / self.things.len() as f64
    }

    /// Whether it stands still.
    pub(super) fn is_still(&self) -> bool {
        let (mut least, mut most) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
        for thing in &self.things {
            least = least.min(thing.at);
            most = most.max(thing.at);
        }
        let radius = self.things.iter().map(Thing::radius).fold(0.0, f64::max);
        let often = self.things.iter().map(|thing| thing.often).sum::<f64>();
        let range = (most - least).max_element();
        let is_often = often > OFTEN * self.things.len() as f64;
        range < radius + STILL || is_often && range < WIDEST * radius
    }

    /// Whether it is clutter that a camera does not always show as such: it stands still beside clutter.
    pub(super) fn is_clutter(&self) -> bool {
        let beside = self.things.iter().filter(|thing| thing.is_beside_clutter);
        2 * beside.count() > self.things.len() && self.is_still()
    }

    /// The thing in a frame.
    pub(super) fn at(&self, frame: usize) -> Option<&Thing> {
        self.things.get(frame.checked_sub(self.first)?)
    }
}

impl Tracer {
    pub(super) fn new(size: [u32; 2]) -> Self {
        let diagonal = DVec2::from_array(size.map(f64::from)).length();
        Self {
            reach: REACH * diagonal,
            frame: 0,
            ended: Vec::new(),
            open: Vec::new(),
        }
    }

    /// Adds the things in the next frame.
    pub(super) fn push(&mut self, things: &[Thing]) {
        let mut pairs = Vec::new();
        for (index, open) in self.open.iter().enumerate() {
            for (number, thing) in things.iter().enumerate() {
                if let Some(cost) = open.cost(thing, self.reach) {
                    pairs.push((cost, index, number));
                }
            }
        }
        pairs.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut followed = vec![false; self.open.len()];
        let mut taken = vec![false; things.len()];
        for (_, index, number) in pairs {
            if !followed[index] && !taken[number] {
                followed[index] = true;
                taken[number] = true;
                self.open[index].see(things[number]);
            }
        }
        for (open, followed) in self.open.iter_mut().zip(&followed) {
            open.missing += usize::from(!followed);
        }
        let ended = self.open.extract_if(.., |open| open.missing > MOST_MISSING);
        self.ended.extend(ended.map(|open| open.trace));
        let new = things.iter().zip(taken).filter(|(_, taken)| !taken);
        self.open.extend(new.map(|(thing, _)| Open {
            trace: Trace {
                first: self.frame,
                things: vec![*thing],
            },
            velocity: DVec2::ZERO,
            missing: 0,
        }));
        self.frame += 1;
    }

    /// All traces, by their first frames.
    pub(super) fn finish(self) -> Vec<Trace> {
        let mut traces = self.ended;
        traces.extend(self.open.into_iter().map(|open| open.trace));
        traces.sort_by_key(|trace| trace.first);
        traces
    }
}

impl Open {
    fn last(&self) -> &Thing {
        self.trace.things.last().expect("it has one")
    }

    /// How badly a thing in the next frame would follow; `None` if it cannot.
    fn cost(&self, thing: &Thing, reach: f64) -> Option<f64> {
        let last = self.last();
        let steps = (1 + self.missing) as f64;
        let expected = last.at + steps * self.velocity;
        let reach = (reach + last.radius() / 2.0) * (1.0 + 0.5 * self.missing as f64);
        let part = expected.distance(thing.at) / reach;
        (part < 1.0).then(|| part + 0.5 * math::ln(thing.area / last.area).abs())
    }

    fn see(&mut self, thing: Thing) {
        let last = *self.last();
        let steps = (1 + self.missing) as f64;
        for step in 1..=self.missing {
            let part = step as f64 / steps;
            let at = last.at.lerp(thing.at, part);
            self.trace.things.push(Thing { at, ..last });
        }
        let part = if self.trace.things.len() == 1 {
            1.0
        } else {
            NEW_VELOCITY
        };
        self.velocity = self.velocity.lerp((thing.at - last.at) / steps, part);
        self.missing = 0;
        self.trace.things.push(thing);
    }
}
