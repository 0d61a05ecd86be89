//! Outlines drawn around a soft solid: a hoop around its border.
//!
//! A line whose one half lies on a soft border and whose other half is beside that would follow every triangle of the steep
//! surface there, ragged as seen from the side. It becomes a hoop with a flat front instead, as high as the surface at the line's
//! inner edge, smoothed along the line.

use glam::DVec2;
use rstar::RTree;
use rstar::primitives::GeomWithData;

use super::ground::Ground;
use crate::geometry::{Outline, area, edges, perimeter};

/// Samples per width of the line.
const SAMPLES: f64 = 3.0;
/// The distance over which fronts are smoothed, in widths of the line.
const SMOOTH: f64 = 1.5;
/// Limit of the samples; on longer lines they are farther apart.
const MAX_SAMPLES: f64 = 8192.0;

/// A front, depth in the drawing.
type Sample = GeomWithData<[f64; 2], f64>;
/// The index of the volume that a point lies on.
type VolumeSample = GeomWithData<[f64; 2], Option<usize>>;

/// The front of a hoop, where a line is one.
#[derive(Debug)]
pub(super) struct Rim {
    samples: RTree<Sample>,
    /// The distance over which they are smoothed.
    reach: f64,
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
        let mut on = Vec::new();
        let mut volume_samples = Vec::new();
        for [from, to] in edges(outline) {
            let count = (from.distance(to) / apart).ceil().max(1.0);
            for index in 0..count as usize {
                let point = from.lerp(to, index as f64 / count);
                volume_samples.push(VolumeSample::new(point.to_array(), ground.top(point)));
                if let Some(front) = ground.front(point) {
                    on.push(Sample::new(point.to_array(), front + step));
                }
            }
        }
        let first = volume_samples.first()?.data;
        if volume_samples
            .iter()
            .all(|volume_sample| volume_sample.data == first)
        {
            return None;
        }
        let on = RTree::bulk_load(on);
        let volume_samples = RTree::bulk_load(volume_samples);
        let within = reach * reach;
        let sample = |volume_sample: &VolumeSample| {
            let mut near =
                volume_samples.locate_within_distance(*volume_sample.geom(), width * width);
            if near.all(|other| other.data == volume_sample.data) {
                return None;
            }
            let near = on.locate_within_distance(*volume_sample.geom(), within);
            let highest = near.map(|sample| sample.data).reduce(f64::max)?;
            Some(Sample::new(*volume_sample.geom(), highest))
        };
        let samples: Vec<Sample> = volume_samples.iter().filter_map(sample).collect();
        (!samples.is_empty()).then(|| Self {
            samples: RTree::bulk_load(samples),
            reach,
        })
    }

    /// The front of the hoop at a point of the line; `None` where it is none.
    pub(super) fn front(&self, point: DVec2) -> Option<f64> {
        let within = self.reach * self.reach;
        let near = self
            .samples
            .locate_within_distance(point.to_array(), within);
        let (mut sum, mut weights) = (0.0, 0.0);
        for sample in near {
            let apart = point.distance_squared(DVec2::from(*sample.geom())) / within;
            let weight = (1.0 - apart).powi(2);
            sum += weight * sample.data;
            weights += weight;
        }
        (weights > 0.0).then(|| sum / weights)
    }
}
