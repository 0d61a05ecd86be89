//! Outlines drawn around a soft solid: a hoop around its border.
//!
//! A line whose one half lies on a soft border and whose other half is beside that would follow every triangle of the steep
//! surface there, ragged as seen from the side. It becomes a hoop with a flat front instead, as high as the surface at the line's
//! inner edge, smoothed along the line.

use glam::DVec2;

use super::ground::Ground;
use crate::geometry::{Outline, area, edges, perimeter};
use crate::solid::cells::Scattered;

/// Samples per width of the line.
const SAMPLES: f64 = 3.0;
/// The distance over which fronts are smoothed, in widths of the line.
const SMOOTH: f64 = 1.5;
/// Limit of the samples; on longer lines they are farther apart.
const MAX_SAMPLES: f64 = 8192.0;

/// The front of a hoop, where a line is one.
#[derive(Debug)]
pub(super) struct Rim {
    /// Depths in the drawing.
    samples: Scattered<f64>,
}

impl Rim {
    /// The rim of a line with this outline; `None` if all of it lies on one volume, or beside all.
    pub(super) fn new(outline: &Outline, ground: &Ground, step: f64) -> Option<Self> {
        let length = perimeter(outline);
        // A line of width w and length l has the area w·l and a border of about 2·l.
        let width = 2.0 * area(outline).abs() / length;
        let apart = (width / SAMPLES).max(length / MAX_SAMPLES);
        let width = width.max(SAMPLES * apart);
        let reach = SMOOTH * width;
        if !(apart > 0.0 && reach.is_finite()) {
            return None;
        }
        let mut on: Vec<(DVec2, f64)> = Vec::new();
        // Points of the border with the indices of the volumes that they lie on.
        let mut places: Vec<(DVec2, Option<usize>)> = Vec::new();
        for [from, to] in edges(outline) {
            let count = (from.distance(to) / apart).ceil().max(1.0);
            for index in 0..count as usize {
                let point = from.lerp(to, index as f64 / count);
                places.push((point, ground.top(point)));
                if let Some(front) = ground.front(point) {
                    on.push((point, front + step));
                }
            }
        }
        let (_, first) = *places.first()?;
        if places.iter().all(|(_, volume)| *volume == first) {
            return None;
        }
        let on = Scattered::new(&on, reach);
        let volumes = Scattered::new(&places, width);
        let sample = |(point, volume): &(DVec2, Option<usize>)| {
            if volumes.near(*point).all(|(_, other)| other == *volume) {
                return None;
            }
            let highest = on.near(*point).map(|(_, front)| front).reduce(f64::max)?;
            Some((*point, highest))
        };
        let samples: Vec<(DVec2, f64)> = places.iter().filter_map(sample).collect();
        (!samples.is_empty()).then(|| Self {
            samples: Scattered::new(&samples, reach),
        })
    }

    /// The front of the hoop at a point of the line; `None` where it is none.
    pub(super) fn front(&self, point: DVec2) -> Option<f64> {
        let (mut sum, mut weights) = (0.0, 0.0);
        for (apart, front) in self.samples.near(point) {
            let weight = (1.0 - apart).powi(2);
            sum += weight * front;
            weights += weight;
        }
        (weights > 0.0).then(|| sum / weights)
    }
}
