//! Which regions strokes belong to: a stroke pairs with one of its region's partner only, so that the mirror of a car does not get the
//! outline of the car.

use glam::DVec2;
use typed_index_collections::{TiSlice, TiVec};

use super::RegionId;
use crate::billboard::region::{Region, View};
use crate::geometry::{area, border_distance_squared, bounds, distance_squared};

/// A stroke follows a border if at least this share of it does.
const FOLLOWS: f64 = 0.7;
/// So many points of a stroke are compared with the borders of regions.
const POINTS: usize = 24;

/// Per region, for a stroke the region whose outline it follows, or else in which it lies, or else that is nearest; `None` for what is
/// no stroke, and if there is nothing but strokes.
pub(super) fn owners(view: &View) -> TiVec<RegionId, Option<RegionId>> {
    let regions = &view.regions;
    let boxes: TiVec<RegionId, _> = regions.iter().map(|one| bounds(&one.outline)).collect();
    let fills = || regions.keys().filter(|region| !regions[*region].is_line);
    let owner = |stroke: &Region| {
        let points = points(stroke);
        let width = width(stroke);
        let (low, high) = bounds(&stroke.outline)?;
        let followed = fills().filter_map(|fill| {
            let (least, greatest) = boxes[fill]?;
            let is_around = least.cmple(low + width).all() && greatest.cmpge(high - width).all();
            let share = is_around.then(|| {
                let outline = &regions[fill].outline;
                let is_near =
                    |point: &&DVec2| border_distance_squared(outline, **point) <= width * width;
                points.iter().filter(is_near).count() as f64 / points.len() as f64
            })?;
            (share >= FOLLOWS).then_some((share, fill))
        });
        // Of equals the last: it is painted over the others.
        let followed = followed.max_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        let around = || surrounding(regions, stroke);
        let nearest = || {
            let far = |fill: RegionId| {
                let outline = &regions[fill].outline;
                let each = points.iter();
                each.map(|point| distance_squared(outline, *point).sqrt())
                    .sum::<f64>()
            };
            let all = fills().map(|fill| (far(fill), fill));
            all.min_by(|a, b| a.0.total_cmp(&b.0).then(b.1.cmp(&a.1)))
                .map(|(_, fill)| fill)
        };
        followed
            .map(|(_, fill)| fill)
            .or_else(around)
            .or_else(nearest)
    };
    let each = regions.iter();
    each.map(|one| one.is_line.then(|| owner(one)).flatten())
        .collect()
}

/// The innermost region around a stroke that is none itself.
fn surrounding(regions: &TiSlice<RegionId, Region>, stroke: &Region) -> Option<RegionId> {
    let mut outer = stroke.container?;
    // Containers that contain each other would be climbed for ever.
    for _ in 0..regions.len() {
        let region = regions.get(outer)?;
        if !region.is_line {
            return Some(outer);
        }
        outer = region.container?;
    }
    None
}

/// Some points along the borders of a stroke's area.
fn points(stroke: &Region) -> Vec<DVec2> {
    let all: Vec<DVec2> = stroke.outline.rings().flatten().copied().collect();
    let step = all.len().div_ceil(POINTS).max(1);
    all.into_iter().step_by(step).collect()
}

/// The width of a stroke, from its area and the length of its border.
fn width(stroke: &Region) -> f64 {
    let ring = |ring: &Vec<DVec2>| -> f64 {
        let next = ring.iter().cycle().skip(1);
        ring.iter().zip(next).map(|(a, b)| a.distance(*b)).sum()
    };
    let length: f64 = stroke.outline.rings().map(ring).sum();
    if length > 0.0 {
        2.0 * area(&stroke.outline) / length
    } else {
        0.0
    }
}
