//! How firmly the feet of a clip are planted on the ground, in continuous time.
//!
//! Everything is computed from smooth curves through the frames, and changes gradually with heights and speeds: the same
//! motion at another frame rate plants the same feet at the same times.

use std::ops::Sub;

use glam::DVec3;

use crate::math;
use crate::smoothing::{ease, smoothed};

/// A point of a foot is in contact if it is lower than this above its lowest height, in leg lengths …
pub(super) const CONTACT_HEIGHT: f64 = 0.08;
/// … and slower than this, in leg lengths per second.
const CONTACT_SPEED: f64 = 0.6;
/// The lowest height of a point is this quantile of its heights.
const LOWEST: f64 = 0.02;
/// What it is lower than if it is known to be on the sole.
pub(super) const SOLE_HEIGHT: f64 = 0.03;
/// At this many times the height or the speed of a contact, nothing is left of it.
const RELEASE: f64 = 1.5;
/// Of two feet that could take over, one that is slower by this, in leg lengths per second, gets e times as much.
const PREFERENCE: f64 = 0.1;
/// The foot that holds the figure lets go where it pulls less than this share of what another one does …
const WEAKER: f64 = 0.3;
/// … and holds nothing where it pulls less than this.
const WEAKEST: f64 = 0.05;
/// Paths are smoothed by a Gaussian of this deviation, seconds: single frames may be wrong.
const SMOOTHING: f64 = 0.03;
/// A contact lasts: what a foot's velocity changes by in this time, seconds, counts as speed.
const TURN: f64 = 0.02;
/// Samples per second, at least; every frame has a whole number of them.
const SAMPLES: f64 = 240.0;
/// The most samples of a frame.
const MAX_SAMPLES: f64 = 100.0;

/// How firmly the feet hold the figure in place, as functions of time.
#[derive(Debug, Clone, Default)]
pub(super) struct Planting {
    /// How many samples a frame has.
    rate: usize,
    /// Per foot its share: 0 in the air, 1 if it alone holds the figure. Linear from one sample to the next; the sum of all shares is
    /// at most 1.
    shares: Vec<Vec<f64>>,
    /// Per foot how firmly it is in contact, from 0 to 1.
    firmness: Vec<Vec<f64>>,
    /// Per foot the lowest heights of its points.
    pub(super) lowest: Vec<Vec<f64>>,
}

/// The share of a foot on the way from one frame to the next.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct Hold {
    /// Its mean.
    pub(super) mean: f64,
    /// The mean of its product with time, which runs from −½ to ½.
    pub(super) lean: f64,
}

impl Hold {
    /// How far something goes while it is held. Its way in the whole time is `way`, and its ways before and after say how its velocity
    /// changes.
    pub(super) fn part_of(self, [before, way, after]: [DVec3; 3]) -> DVec3 {
        way * self.mean + (after - before) / 2.0 * self.lean
    }
}

impl Sub for Hold {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        Self {
            mean: self.mean - other.mean,
            lean: self.lean - other.lean,
        }
    }
}

/// A point or a foot at a moment.
#[derive(Debug, Clone, Copy, Default)]
struct Contact {
    /// How firmly it is in contact: from 0, not at all, to 1.
    firmness: f64,
    /// The same, less for fast ones.
    pull: f64,
}

impl Planting {
    /// The planting of feet, each of which touches the ground at points with these paths, frame by frame, below a height in leg
    /// lengths. `leg` is the length of a leg.
    pub(super) fn of(feet: &[(Vec<Vec<DVec3>>, f64)], frame_time: f64, leg: f64) -> Self {
        let is_timed = frame_time > 0.0 && frame_time.is_finite();
        let rate = if is_timed {
            (frame_time * SAMPLES).ceil().clamp(1.0, MAX_SAMPLES) as usize
        } else {
            1
        };
        let time = if is_timed {
            frame_time / rate as f64
        } else {
            1.0 / SAMPLES
        };
        let mut lowest_heights = Vec::with_capacity(feet.len());
        let mut contacts = Vec::with_capacity(feet.len());
        for (foot, height) in feet {
            let paths: Vec<Vec<DVec3>> = foot.iter().map(|path| sampled(path, rate)).collect();
            let paths: Vec<Vec<DVec3>> = paths
                .iter()
                .map(|path| smoothed(path, SMOOTHING / time))
                .collect();
            let lowest: Vec<f64> = paths
                .iter()
                .map(|path| lowest(path.iter().map(|point| point.y)))
                .collect();
            let points = paths.iter().zip(&lowest);
            let points =
                points.map(|(path, lowest)| point_contacts(path, [*lowest, *height], time, leg));
            contacts.push(points.reduce(firmer).unwrap_or_default());
            lowest_heights.push(lowest);
        }
        Self {
            rate,
            shares: if is_timed && leg > 0.0 {
                shares(&contacts)
            } else {
                vec![Vec::new(); feet.len()]
            },
            firmness: if is_timed && leg > 0.0 {
                let firmness = |own: &Vec<Contact>| own.iter().map(|own| own.firmness).collect();
                contacts.iter().map(firmness).collect()
            } else {
                vec![Vec::new(); feet.len()]
            },
            lowest: lowest_heights,
        }
    }

    /// Per foot how it holds the figure on the way to each of these places from the one before. Places are given in frames, ascend, and
    /// may lie between frames.
    pub(super) fn holds(&self, places: &[f64]) -> Vec<Vec<Hold>> {
        let ways = || places.iter().take(1).chain(places).zip(places);
        let holds = |shares: &Vec<f64>| {
            let scaled = |place: f64| place * self.rate as f64;
            ways()
                .map(|(from, to)| hold(shares, scaled(*from), scaled(*to)))
                .collect()
        };
        self.shares.iter().map(holds).collect()
    }

    /// Per foot how firmly it is in contact at these places, likewise.
    pub(super) fn firmness(&self, places: &[f64]) -> Vec<Vec<f64>> {
        let at = |firmness: &Vec<f64>| {
            let places = places.iter();
            places
                .map(|place| value(firmness, place * self.rate as f64))
                .collect()
        };
        self.firmness.iter().map(at).collect()
    }
}

/// A path with this many points per frame, straight from frame to frame.
fn sampled(path: &[DVec3], rate: usize) -> Vec<DVec3> {
    let steps = path.windows(2).flat_map(|pair| {
        let step = move |step: usize| pair[0].lerp(pair[1], step as f64 / rate as f64);
        (0..rate).map(step)
    });
    steps.chain(path.last().copied()).collect()
}

/// The lowest of some heights: a low quantile, because single frames may be wrong.
pub(super) fn lowest(heights: impl Iterator<Item = f64>) -> f64 {
    let mut heights: Vec<f64> = heights.collect();
    heights.sort_by(f64::total_cmp);
    match heights.len() {
        0 => 0.0,
        count => heights[((count - 1) as f64 * LOWEST) as usize],
    }
}

/// How firmly a point is in contact, sample by sample, given its lowest height, and up to which height above it, in leg lengths, it is so.
/// `time` is the time between samples.
fn point_contacts(
    path: &[DVec3],
    [lowest, contact_height]: [f64; 2],
    time: f64,
    leg: f64,
) -> Vec<Contact> {
    let contact = |sample: usize| {
        let [before, after] = [sample.saturating_sub(1), (sample + 1).min(path.len() - 1)];
        let passed = (after - before).max(1) as f64 * time;
        let speed = path[before].distance(path[after]) / passed / leg;
        // A foot that turns back in the air is slow for a moment only.
        let change = (path[before] + path[after] - 2.0 * path[sample]).length();
        let speed = math::hypot(speed, change / (time * time * leg) * TURN);
        let height = (path[sample].y - lowest) / leg;
        let firmness = within(height / contact_height) * within(speed / CONTACT_SPEED);
        Contact {
            firmness,
            pull: firmness * math::exp(-speed / PREFERENCE),
        }
    };
    (0..path.len()).map(contact).collect()
}

/// 1 up to a limit of 1, then less and less down to 0 at [`RELEASE`].
fn within(value: f64) -> f64 {
    1.0 - ease((value - 1.0) / (RELEASE - 1.0))
}

/// A foot is as firmly in contact as the firmest of its points.
fn firmer(mut all: Vec<Contact>, other: Vec<Contact>) -> Vec<Contact> {
    for (own, other) in all.iter_mut().zip(other) {
        own.firmness = own.firmness.max(other.firmness);
        own.pull = own.pull.max(other.pull);
    }
    all
}

/// The shares of feet, sample by sample. The foot that holds the figure goes on to do so until it is released; as it loosens, those that
/// pull most take over.
fn shares(feet: &[Vec<Contact>]) -> Vec<Vec<f64>> {
    let samples = feet.iter().map(Vec::len).min().unwrap_or(0);
    let mut shares = vec![Vec::with_capacity(samples); feet.len()];
    let mut holder: Option<usize> = None;
    for sample in 0..samples {
        let contact = |foot: usize| feet[foot][sample];
        let strongest = (0..feet.len())
            .map(|foot| contact(foot).pull)
            .fold(0.0, f64::max);
        let pulling = |foot: &usize| contact(*foot).pull > WEAKEST * strongest;
        holder = holder.filter(pulling).or_else(|| {
            let pulling = (0..feet.len()).filter(pulling);
            pulling.max_by(|a, b| contact(*a).pull.total_cmp(&contact(*b).pull))
        });
        let all = (0..feet.len()).map(contact);
        let firmest = all.clone().map(|own| own.firmness).fold(0.0, f64::max);
        let held = holder.map_or(0.0, |foot| {
            let share = contact(foot).pull / strongest;
            contact(foot).firmness * ease((share - WEAKEST) / (WEAKER - WEAKEST))
        });
        let pull: f64 = all.map(|own| own.pull).sum();
        let others = pull - holder.map_or(0.0, |foot| contact(foot).pull);
        for (foot, shares) in shares.iter_mut().enumerate() {
            shares.push(if holder == Some(foot) {
                held
            } else if others > 0.0 {
                (firmest - held) * contact(foot).pull / others
            } else {
                0.0
            });
        }
    }
    shares
}

/// The value at a place of a list of samples, linear between them; 0 if it is empty.
fn value(samples: &[f64], place: f64) -> f64 {
    let Some(last) = samples.len().checked_sub(1) else {
        return 0.0;
    };
    let sample = (place as usize).min(last);
    let [start, end] = [sample, (sample + 1).min(last)].map(|sample| samples[sample]);
    start + (end - start) * (place - sample as f64).clamp(0.0, 1.0)
}

/// The share of a foot from one place to another, in samples.
fn hold(shares: &[f64], from: f64, to: f64) -> Hold {
    let at = |place: f64| value(shares, place);
    let way = to - from;
    if way.is_nan() || way <= 0.0 {
        return Hold {
            mean: at(to),
            lean: 0.0,
        };
    }
    let mut hold = Hold::default();
    let mut start = from;
    while start < to {
        let end = (start.floor() + 1.0).min(to);
        // Simpson's rule is exact here: the share is linear, and so is time.
        for (place, weight) in [(start, 1.0), ((start + end) / 2.0, 4.0), (end, 1.0)] {
            let share = at(place) * weight / 6.0 * (end - start) / way;
            hold.mean += share;
            hold.lean += share * ((place - from) / way - 0.5);
        }
        start = end;
    }
    hold
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Feet at these heights and places along x, 48 frames a second, for two seconds, on legs of length 1.
    fn planting(feet: &[&dyn Fn(f64) -> [f64; 2]]) -> Planting {
        let point = |place: [f64; 2]| DVec3::new(place[1], place[0], 0.0);
        let path = |foot: &&dyn Fn(f64) -> [f64; 2]| {
            let places = (0..=96).map(|frame| point(foot(f64::from(frame) / 48.0)));
            (vec![places.collect()], CONTACT_HEIGHT)
        };
        let paths: Vec<(Vec<Vec<DVec3>>, f64)> = feet.iter().map(path).collect();
        Planting::of(&paths, 1.0 / 48.0, 1.0)
    }

    fn at(planting: &Planting, time: f64) -> Vec<f64> {
        let frame = time * 48.0;
        let holds = planting.holds(&[frame]);
        holds.iter().map(|holds| holds[0].mean).collect()
    }

    #[test]
    fn the_foot_that_holds_goes_on_until_it_is_lifted() {
        // The second foot is put down after half a second, the first one lifted after a second and a half.
        let first = |time: f64| [(time - 1.5).max(0.0) * 3.0, 0.0];
        let second = |time: f64| [(0.5 - time).max(0.0) * 3.0, 1.0];
        let planting = planting(&[&first, &second]);
        for (time, due) in [
            (0.1, [1.0, 0.0]),
            (1.0, [1.0, 0.0]),
            (1.3, [1.0, 0.0]),
            (1.7, [0.0, 1.0]),
        ] {
            assert_eq!(at(&planting, time), due, "after {time} s");
        }
        // All the time something holds, and the shares change gradually.
        let mut before = [1.0, 0.0];
        for moment in 0..=480 {
            let shares = at(&planting, f64::from(moment) / 240.0);
            assert!((shares[0] + shares[1] - 1.0).abs() < 1e-9, "{shares:?}");
            assert!((shares[0] - before[0]).abs() < 0.5, "{shares:?}");
            before = [shares[0], shares[1]];
        }
    }

    #[test]
    fn feet_that_are_high_or_fast_or_turn_back_hold_nothing() {
        let high = |time: f64| [if time < 0.2 { 0.0 } else { 0.3 }, 0.0];
        let fast = |time: f64| [0.0, 2.0 * time];
        let turning = |time: f64| [0.0, 2.0 * (time - 1.0).abs()];
        let planting = planting(&[&high, &fast, &turning]);
        assert_eq!(at(&planting, 1.0), [0.0; 3]);
        assert_eq!(at(&planting, 0.1), [1.0, 0.0, 0.0]);
    }

    #[test]
    fn holds_are_means_and_leans() {
        // From 0 to 1 on the way from sample 1 to sample 2.
        let shares = [0.0, 0.0, 1.0, 1.0];
        let close = |hold: Hold, mean: f64, lean: f64| {
            assert!((hold.mean - mean).abs() < 1e-12, "{hold:?}");
            assert!((hold.lean - lean).abs() < 1e-12, "{hold:?}");
        };
        close(hold(&shares, 2.0, 3.0), 1.0, 0.0);
        close(hold(&shares, 1.0, 2.0), 0.5, 1.0 / 12.0);
        close(hold(&shares, 0.0, 3.0), 0.5, 13.0 / 108.0);
        close(hold(&shares, 1.5, 1.5), 0.5, 0.0);
        close(hold(&[], 0.0, 1.0), 0.0, 0.0);
        // A way with a steadily growing velocity, of which the second half is held: from 0.5 on, x = t².
        let half = Hold {
            mean: 0.5,
            lean: 0.125,
        };
        let ways = [-1.0, 1.0, 3.0].map(|way| DVec3::X * way);
        assert!((half.part_of(ways).x - 0.75).abs() < 1e-12);
    }
}
