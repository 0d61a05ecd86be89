//! What closes the gaps between regions.

use std::sync::Arc;

use rayon::prelude::*;
use typed_index_collections::{TiSlice, TiVec};

use super::drawn::DrawnView;
use super::matching::{Track, TrackId};
use super::place::{Frame, TrackPosition};
use crate::geometry::{Outline, area, bounds, intersect, offset, union};
use crate::scene::ViewId;

/// How far a region goes on under those in front of it, heights.
const GROWTH: f64 = 0.03;
/// How far it stays away from the character's border, heights: at a drawn view nothing of it may show.
const MARGIN: f64 = 0.01;
/// Regions with a smaller alpha hide nothing, and have no backing.
const OPAQUE: f64 = 0.98;
/// What grows by a smaller share of its area has nothing to close.
const LEAST_GROWTH: f64 = 1e-3;

/// For each track its backing in each view, drawing units: the region and what it would be under its neighbours in front, without
/// anything that shows at that view. `None` where nothing lies in front, and for what is not opaque.
pub(super) fn backings(
    views: &TiSlice<ViewId, DrawnView>,
    frames: &TiSlice<ViewId, Frame>,
    tracks: &TiSlice<TrackId, Track>,
    placed: &TiSlice<TrackId, TrackPosition>,
) -> TiVec<TrackId, Option<TiVec<ViewId, Arc<Outline>>>> {
    let covers = |view: ViewId, track: TrackId| {
        let region = &views[view].view.regions[tracks[track].regions[view]?];
        (region.color[3] >= OPAQUE).then_some(&region.outline)
    };
    let backing = |track: TrackId| {
        let mut shown = views
            .keys()
            .filter(|view| tracks[track].regions[*view].is_some());
        if shown.any(|view| covers(view, track).is_none()) {
            // It would show through itself.
            return None;
        }
        let mut grows = false;
        let of_view = |view: ViewId| {
            let Some(region) = tracks[track].regions[view] else {
                return Arc::default();
            };
            let own = &views[view].view.regions[region].outline;
            let height = frames[view].height;
            let grown = offset(own, GROWTH * height);
            let depth = placed[track].depths[view];
            let in_front = tracks
                .keys()
                .filter(|other| placed[*other].depths[view] > depth);
            let neighbors = in_front
                .filter_map(|other| covers(view, other))
                .filter(|other| overlap(&grown, other));
            let all = [own].into_iter().chain(neighbors);
            let all: Vec<Outline> = all.map(|outline| Outline::clone(outline)).collect();
            let hidden = offset(&union(&all), -MARGIN * height);
            let backing = intersect(&grown, &hidden);
            // The margin makes it smaller where nothing is in front.
            let inner = intersect(&backing, own);
            grows |= area(&backing) - area(&inner) > LEAST_GROWTH * area(own);
            Arc::new(backing)
        };
        let outlines: TiVec<ViewId, Arc<Outline>> = views.keys().map(of_view).collect();
        grows.then_some(outlines)
    };
    let all = (0..tracks.len()).into_par_iter();
    let all: Vec<_> = all.map(|track| backing(track.into())).collect();
    all.into()
}

/// Whether the boxes around two outlines overlap.
fn overlap(a: &Outline, b: &Outline) -> bool {
    let boxes = bounds(a).zip(bounds(b));
    boxes.is_some_and(|((low, high), (from, to))| low.max(from).cmplt(high.min(to)).all())
}
