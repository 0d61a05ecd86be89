//! Feature points: names beside places of outlines that belong together in all views.

use glam::DVec2;
use typed_index_collections::{TiSlice, TiVec};

use super::drawn::DrawnView;
use super::matching::{Track, TrackId};
use super::place::Frame;
use crate::bind::{Bindings, LayerId, StringId};
use crate::diagnostic::{Code, Diagnostic};
use crate::geometry::border_distance_squared;
use crate::lang::ast::Annotation;
use crate::scene::ViewId;
use crate::svg::Drawing;

/// A feature point of a view.
#[derive(Debug, Clone)]
pub(super) struct FeaturePoint {
    name: String,
    string: StringId,
    /// Points on the page, drawing units, of which the one nearest to the outline is meant.
    points: [DVec2; 3],
}

/// The feature points of one region: per view their names and places, drawing units.
pub(super) type OfRegion = TiVec<ViewId, Vec<(String, DVec2)>>;

/// The feature points in the view that a layer is. Of points with the same name the first counts.
pub(super) fn of_view(
    drawing: &Drawing,
    bindings: &Bindings,
    layer: LayerId,
    diagnostics: &mut Vec<Diagnostic>,
) -> Vec<FeaturePoint> {
    let mut found: Vec<FeaturePoint> = Vec::new();
    for (name, string) in strings(bindings) {
        if bindings.view_of_string(drawing, string) != Some(layer) {
            continue;
        }
        let text = &bindings.strings[string].text;
        // Only texts are read as feature points: a description has no place.
        let Some(points) = bindings.points_of_string(drawing, string) else {
            continue;
        };
        if let Some(first) = found.iter().find(|other| other.name == name) {
            let message = format!("`^{name}` is in this view twice, and the first one counts");
            let first = bindings.strings[first.string].text.whole();
            diagnostics.push(
                Diagnostic::new(Code::UnusedFeature, text.whole(), message)
                    .related(first, "the first one")
                    .help("give each point of a view a name of its own"),
            );
            continue;
        }
        found.push(FeaturePoint {
            name: name.to_owned(),
            string,
            points,
        });
    }
    found
}

/// Reports the feature points outside of views.
pub(super) fn report_others(
    drawing: &Drawing,
    bindings: &Bindings,
    diagnostics: &mut Vec<Diagnostic>,
) {
    let outside =
        strings(bindings).filter(|(_, string)| bindings.view_of_string(drawing, *string).is_none());
    diagnostics.extend(outside.map(|(name, string)| {
        let message = format!("`^{name}` is in no view of a character, so it has no effect");
        let place = bindings.strings[string].text.whole();
        Diagnostic::new(Code::UnusedFeature, place, message).help(
            "move it into a layer with a string like `Boy$View 0 0`, beside the outline of a region",
        )
    }));
}

/// The strings that name feature points.
fn strings(bindings: &Bindings) -> impl Iterator<Item = (&str, StringId)> {
    let strings = bindings.strings.iter_enumerated();
    strings.filter_map(|(index, string)| match &string.annotation {
        Annotation::Feature(name) => Some((name.text.as_str(), index)),
        _ => None,
    })
}

/// Gives each feature point to the region of all views whose outlines are nearest to it. Returns those of each track.
pub(super) fn assign(
    bindings: &Bindings,
    views: &TiSlice<ViewId, DrawnView>,
    frames: &TiSlice<ViewId, Frame>,
    tracks: &TiSlice<TrackId, Track>,
    diagnostics: &mut Vec<Diagnostic>,
) -> TiVec<TrackId, OfRegion> {
    let mut assigned: TiVec<TrackId, OfRegion> =
        vec![vec![Vec::new(); views.len()].into(); tracks.len()].into();
    for (view, drawn) in views.iter_enumerated() {
        for feature in &drawn.features {
            let namesakes = views.iter().map(|view| {
                let mut features = view.features.iter();
                features.find(|other| other.name == feature.name)
            });
            let each: TiVec<ViewId, Option<&FeaturePoint>> = namesakes.collect();
            if each[..view].iter().any(Option::is_some) {
                continue;
            }
            let problem = match nearest(&each, views, frames, tracks) {
                None if each.iter().flatten().count() < 2 => "no other view has it",
                None => "in the views that have it, it is beside regions that are no partners",
                Some((track, points)) => {
                    let shown = tracks[track].regions.iter().zip(&points);
                    if shown
                        .clone()
                        .any(|(r, point)| r.is_some() && point.is_none())
                    {
                        "another view that shows its region does not have it"
                    } else {
                        let known = points.iter().flatten().copied().next().unwrap_or_default();
                        for (all, point) in assigned[track].iter_mut().zip(points) {
                            all.push((feature.name.clone(), point.unwrap_or(known)));
                        }
                        continue;
                    }
                }
            };
            let message = format!("`^{}` has no effect: {problem}", feature.name);
            let place = bindings.strings[feature.string].text.whole();
            diagnostics.push(
                Diagnostic::new(Code::UnusedFeature, place, message).help(format!(
                    "write `^{}` beside the same point of the region's outline in every view that shows it",
                    feature.name
                )),
            );
        }
    }
    assigned
}

/// The track whose outlines are nearest to a point that several views name, and that point in each of its views.
fn nearest(
    feature: &TiSlice<ViewId, Option<&FeaturePoint>>,
    views: &TiSlice<ViewId, DrawnView>,
    frames: &TiSlice<ViewId, Frame>,
    tracks: &TiSlice<TrackId, Track>,
) -> Option<(TrackId, TiVec<ViewId, Option<DVec2>>)> {
    let mut best: Option<(f64, TrackId, TiVec<ViewId, Option<DVec2>>)> = None;
    for (index, track) in tracks.iter_enumerated() {
        let mut points = TiVec::from(vec![None; views.len()]);
        let mut distances = Vec::new();
        for (view, feature) in feature.iter_enumerated() {
            let (Some(feature), Some(region)) = (feature, track.regions[view]) else {
                continue;
            };
            let outline = &views[view].view.regions[region].outline;
            let distances_squared = feature
                .points
                .map(|point| (border_distance_squared(outline, point), point));
            let found = distances_squared
                .into_iter()
                .min_by(|a, b| a.0.total_cmp(&b.0));
            if let Some((squared, point)) = found.filter(|(squared, _)| squared.is_finite()) {
                points[view] = Some(point);
                distances.push(squared.sqrt() / frames[view].height);
            }
        }
        if distances.len() < 2 {
            continue;
        }
        let mean = distances.iter().sum::<f64>() / distances.len() as f64;
        if best.as_ref().is_none_or(|(least, ..)| mean < *least) {
            best = Some((mean, index, points));
        }
    }
    best.map(|(_, track, points)| (track, points))
}
