//! Things that stand still and look like a mark now and then, while the mark moves.

use crate::math;
use glam::{DVec2, DVec3};

use super::traces::Trace;

/// What is at most so far from something that stands still is the same, pixels.
const SAME: f64 = 8.0;
/// A mark that moves does so for so many frames, and looks like it by this part.
const MOVES: usize = 10;
const LIKE: f64 = 0.3;
/// In so many frames both are seen.
const BOTH: usize = 3;
/// How much a mark's look differs from the usual one: its hue in degrees, and the logarithms of its chroma and of its area.
const UNUSUAL: DVec3 = DVec3::new(9.0, 0.6, 0.9);

/// A place where something stands still.
struct Place {
    /// Pixels.
    at: DVec2,
    traces: Vec<usize>,
    /// In how many frames it is seen.
    frames: usize,
}

/// How much a look is like the usual one of a mark, from 0 to 1.
pub(super) fn similarity(look: DVec3, usual: DVec3) -> f64 {
    math::exp(-((look - usual) / UNUSUAL).length_squared() / 2.0)
}

/// For each trace whether it is something that stands still, is seen now and then while the mark moves elsewhere, and is seen in fewer
/// frames than the mark moves. The traces are in the order of their first frames.
pub(super) fn still_things(traces: &[Trace], look: DVec3) -> Vec<bool> {
    let mut is_thing = vec![false; traces.len()];
    let (mut places, mut moving): (Vec<Place>, Vec<&Trace>) = (Vec::new(), Vec::new());
    for (index, trace) in traces.iter().enumerate() {
        if !trace.is_still() {
            if trace.things.len() >= MOVES && similarity(trace.look(), look) > LIKE {
                moving.push(trace);
            }
            continue;
        }
        let at = trace.middle();
        let frames = trace.things.len();
        match places.iter_mut().find(|place| place.at.distance(at) < SAME) {
            Some(place) => {
                place.traces.push(index);
                place.frames += frames;
            }
            None => places.push(Place {
                at,
                traces: vec![index],
                frames,
            }),
        }
    }
    let moved: usize = moving.iter().map(|trace| trace.things.len()).sum();
    for place in &places {
        let is_beside = |index: &usize| {
            let Trace { first, .. } = traces[*index];
            let end = traces[*index].end();
            let meanwhile =
                |moving: &&Trace| end.min(moving.end()) >= first.max(moving.first) + BOTH;
            moving.iter().any(meanwhile)
        };
        if place.frames < moved && place.traces.iter().any(is_beside) {
            for index in &place.traces {
                is_thing[*index] = true;
            }
        }
    }
    is_thing
}
