//! The path of a camera that follows what a clip moves from place to place.

use glam::DVec3;

use super::model::Model;
use crate::import::{Clip, Travellers};
use crate::smoothing::smoothed;

/// How many points of the path there are in a second.
const RATE: f64 = 24.0;
/// The most points of a path.
const MAX_POINTS: u32 = 10_000;
/// The standard deviation of the filter that smooths the path, in seconds: steps and swaying vanish, a run-up stays.
const SMOOTHING: f64 = 0.4;

/// Where a camera is, relative to its place at the beginning of a clip. It never rises or sinks.
#[derive(Debug)]
pub(super) struct CameraPath {
    /// The first and the last time, in seconds of the clip.
    span: [f64; 2],
    /// Evenly spaced from the first time to the last, in the world; y is 0. Never empty.
    points: Vec<DVec3>,
}

impl CameraPath {
    /// Follows the mean of the roots, smoothly. Without any the camera stands still.
    pub(super) fn new(
        model: &Model,
        clip: &Clip,
        travellers: &Travellers,
        [from, to]: [f64; 2],
    ) -> Self {
        let roots = &travellers.roots;
        let intervals = ((to - from) * RATE)
            .ceil()
            .clamp(1.0, f64::from(MAX_POINTS - 1)) as u32;
        let step = (to - from) / f64::from(intervals);
        let place = |index: u32| {
            let pose = model.pose_at(clip, from + step * f64::from(index));
            let places = model.places(&pose, roots);
            let mean = places.iter().sum::<DVec3>() / roots.len().max(1) as f64;
            DVec3::new(mean.x, 0.0, mean.z)
        };
        let places: Vec<DVec3> = (0..=intervals).map(place).collect();
        Self {
            span: [from, to],
            points: smoothed(&places, SMOOTHING / step.max(f64::MIN_POSITIVE)),
        }
    }

    /// The length of the way, in metres.
    pub(super) fn length(&self) -> f64 {
        let steps = self.points.windows(2);
        steps.map(|pair| pair[0].distance(pair[1])).sum()
    }

    /// Its place at a time of the clip.
    pub(super) fn at(&self, time: f64) -> DVec3 {
        let [from, to] = self.span;
        let last = self.points.len() - 1;
        let share = ((time - from) / (to - from)).clamp(0.0, 1.0);
        // A span without length has equal points.
        let place = if share.is_nan() { 0.0 } else { share } * last as f64;
        let index = (place as usize).min(last);
        let next = self.points[(index + 1).min(last)];
        self.points[index].lerp(next, place.fract())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn path(place: impl Fn(f64) -> f64) -> Vec<DVec3> {
        (0..=96)
            .map(|index| DVec3::X * place(f64::from(index) / RATE))
            .collect()
    }

    fn largest_difference(one: &[DVec3], other: &[DVec3]) -> f64 {
        let pairs = one.iter().zip(other);
        pairs.map(|(a, b)| a.distance(*b)).fold(0.0, f64::max)
    }

    #[test]
    fn a_run_up_is_followed_closely() {
        // Stands for a second, then runs.
        let run = path(|time| 3.0 * (time - 1.0).max(0.0));
        let followed = smoothed(&run, 9.6);
        assert!(largest_difference(&followed, &run) < 0.5);
        // The camera never moves backwards, and never jumps.
        for pair in followed.windows(2) {
            let step = pair[1].x - pair[0].x;
            assert!((-1e-9..3.01 / RATE).contains(&step), "{step}");
        }
    }
}
