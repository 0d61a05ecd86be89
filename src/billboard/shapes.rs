//! The shape and the paints of each region of a character, before it is known where in space the regions are.

use std::sync::Arc;

use rayon::prelude::*;
use typed_index_collections::{TiSlice, TiVec};

use super::drawn::{Drawn, DrawnLine, DrawnView};
use super::features::OfRegion;
use super::keys;
use super::matching::{RegionInView, Track, TrackId};
use super::paints::{Paint, Paints, Said, is_same_color};
use super::pieces::DEPTH;
use super::region::Region;
use super::shape::{Ends, Morph, line_mesh, match_lines};
use crate::geometry::Outline;
use crate::memo::Memo;
use crate::scene::{Turn, ViewId};

/// A region over all views.
#[derive(Debug)]
pub(super) struct RegionShape {
    /// The views that show it, with its numbers there.
    pub(super) shown: Vec<RegionInView>,
    /// Its area in each view, drawing units; in a view that does not show it, anywhere.
    pub(super) area: Morph,
    /// What its area is painted with.
    pub(super) paints: Paints,
    /// The views with a line along its border.
    pub(super) lines: Vec<(ViewId, DrawnLine)>,
    /// What that line is painted with; `None` without one.
    pub(super) line_paints: Option<Paints>,
}

impl RegionShape {
    /// How far in front of its area the line along its border has to be, heights, besides what all lines are.
    pub(super) fn thickness(&self) -> f64 {
        if self.paints.differ() { DEPTH } else { 0.0 }
    }

    /// How much farther away what is painted over it has to be, in heights towards the viewer.
    pub(super) fn room(&self) -> f64 {
        let line = self.line_paints.as_ref();
        let line = if line.is_some_and(Paints::differ) {
            DEPTH
        } else {
            0.0
        };
        (self.thickness() + line) / Turn::FLATNESS
    }
}

/// The shapes of all regions. `features` are the feature points of each.
pub(super) fn shapes(
    views: &TiSlice<ViewId, DrawnView>,
    tracks: &TiSlice<TrackId, Track>,
    features: &TiSlice<TrackId, OfRegion>,
    said: Said<'_>,
    memo: &Memo,
) -> TiVec<TrackId, RegionShape> {
    let shape = |index: usize| {
        let index = TrackId::from(index);
        shape(views, &tracks[index], &features[index], said, memo)
    };
    let all: Vec<RegionShape> = (0..tracks.len()).into_par_iter().map(shape).collect();
    all.into()
}

fn shape(
    views: &TiSlice<ViewId, DrawnView>,
    track: &Track,
    features: &OfRegion,
    said: Said<'_>,
    memo: &Memo,
) -> RegionShape {
    let shown = track.regions.iter_enumerated();
    let shown = shown.filter_map(|(view, id)| Some(RegionInView { view, id: (*id)? }));
    let shown: Vec<RegionInView> = shown.collect();
    let region = |at: &RegionInView| -> &Region { &views[at.view].view.regions[at.id] };
    let drawn = |at: &RegionInView| -> &Drawn { &views[at.view].drawn[at.id] };
    let area = open_line(views, &shown).unwrap_or_else(|| {
        let mut outlines: TiVec<ViewId, Arc<Outline>> = vec![Arc::default(); views.len()].into();
        for at in &shown {
            outlines[at.view] = Arc::clone(&region(at).outline);
        }
        keys::morphed(outlines.raw, features, memo)
    });
    let paints = shown.iter().map(|at| Paint {
        color: region(at).color,
        part: drawn(at).part,
        view: at.view,
        mirror: views[at.view].mirror,
    });
    let paints: Vec<Paint> = paints.collect();
    let paints = said.paints(views.len(), &paints, &area);
    let lines = shown
        .iter()
        .filter_map(|at| Some((at.view, drawn(at).line?)));
    let lines: Vec<(ViewId, DrawnLine)> = lines.collect();
    let plain = lines.iter();
    let plain = plain.map(|(view, line)| (*view, Paint::plain(line.color, *view)));
    let is_same = |a: &Paint, b: &Paint| is_same_color(a.color, b.color);
    RegionShape {
        area,
        paints,
        line_paints: (!lines.is_empty()).then(|| Paints::collect(views.len(), plain, is_same)),
        lines,
        shown,
    }
}

/// A line that is no border, as wide as it is drawn in each view; `None` if a view shows something else.
fn open_line(views: &TiSlice<ViewId, DrawnView>, shown: &[RegionInView]) -> Option<Morph> {
    let mut points: TiVec<ViewId, _> = vec![Vec::new(); views.len()].into();
    let mut widths: TiVec<ViewId, _> = vec![0.0; views.len()].into();
    for RegionInView { view, id } in shown {
        let line = views[*view].drawn[*id].open_line.as_ref()?;
        points[*view].clone_from(&line.points);
        widths[*view] = line.width;
    }
    let points = match_lines(&points.raw);
    Some(line_mesh(&points, &widths.raw, Ends::Free))
}
