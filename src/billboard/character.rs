//! Characters: views that belong together, their regions matched, placed and given one mesh each.

use std::sync::Arc;

use glam::{DVec2, DVec3};
use rayon::prelude::*;
use rustc_hash::FxHashSet;
use typed_index_collections::{TiSlice, TiVec};

use super::backing::backings;
use super::diagnostics;
use super::drawn::{self, DrawnView};
use super::features::{self, OfRegion};
use super::keys;
use super::matching::{Matching, Method, RegionInView, Track, TrackId};
use super::paints::{Paints, Said};
use super::place::{Frame, TrackPosition, frames, place};
use super::region::{Direction, RegionId, View};
use super::shape::{Ends, Morph, line_mesh};
use super::shapes::{RegionShape, shapes};
use super::sides::{self, Drawings, Side, Views};
use super::turn::between;
use crate::bind::{Bindings, LayerId, PartId, StringId};
use crate::diagnostic::Diagnostic;
use crate::geometry::Outline;
use crate::lang::keyword::Keyword;
use crate::lang::value::Value;
use crate::memo::Memo;
use crate::scene::{Turn, ViewId, view_axes};
use crate::svg::{Drawing, ShapeId};

/// How far the line along a border lies in front of its region, heights. Less than regions are apart.
const LINE_STEP: f64 = 0.0004;
/// How far backings lie behind the back-most region, heights.
const BEHIND: f64 = 0.002;

/// A character that turns.
#[derive(Debug)]
pub struct Character {
    /// Its name.
    pub name: String,
    /// Per drawn view the index of its layer.
    pub layers: TiVec<ViewId, LayerId>,
    /// Its views, the drawn ones first, and what lies between them.
    pub turn: Turn,
    /// What the views are that follow the drawn ones.
    pub sides: Vec<Side>,
    /// Per view its centre and scale.
    pub frames: TiVec<ViewId, Frame>,
    /// Its regions, in the order of the first view that shows each.
    pub regions: TiVec<TrackId, RegionModel>,
    /// The regions of each drawn view.
    pub views: TiVec<ViewId, View>,
    /// Which regions of the drawn views are the same; its tracks are in the order of `regions`.
    pub matching: Matching,
}

/// A region of a character, over all its views.
#[derive(Debug)]
pub struct RegionModel {
    /// Its name; unique in the character.
    pub name: String,
    /// Its place in each view, in the character's space, heights.
    pub positions: TiVec<ViewId, DVec3>,
    /// The area, the line along its border in front of it, and its backing behind the whole character; at least the area.
    pub meshes: Vec<RegionMesh>,
    /// The shape that it is in the first view that shows it, or of the picture that it is in.
    pub shape: Option<ShapeId>,
    /// Its part there, if it has one: regions of pictures have none.
    pub part: Option<PartId>,
    /// Per view whether it is seen there.
    pub is_shown: TiVec<ViewId, bool>,
    /// Per drawn view whether it is hidden there (`Hidden`).
    pub is_hidden: TiVec<ViewId, bool>,
    /// Per drawn view the shape or picture, where the view shows it.
    pub shapes: TiVec<ViewId, Option<ShapeId>>,
    /// Per drawn view the string that names it in a picture.
    pub strings: TiVec<ViewId, Option<StringId>>,
}

/// A mesh with a paint for each view.
#[derive(Debug)]
pub struct RegionMesh {
    /// Its shape in each view, drawing units.
    pub morph: Morph,
    /// What it is painted with.
    pub paints: Paints,
    /// How far in front of the region's place it is, heights.
    pub lift: f64,
}

impl RegionModel {
    /// What its area is painted with.
    pub(crate) fn paints(&self) -> &Paints {
        &self.meshes[0].paints
    }

    /// What each view that shows it paints it with, for people: its area, and the line along its border if that has several paints.
    /// `None` if it looks the same in all of them.
    pub(crate) fn paints_in_views(&self) -> Option<TiVec<ViewId, Option<String>>> {
        let line = self.meshes.iter().find(|mesh| mesh.lift > 0.0);
        let line = line.map(|line| &line.paints).filter(|line| line.differ());
        let area = self.paints();
        if !area.differ() && line.is_none() {
            return None;
        }
        let of_view = |(view, shape): (ViewId, &Option<ShapeId>)| {
            (*shape)?;
            let area = area.list[area.of_view[view]].describe();
            Some(match line {
                Some(line) => format!(
                    "{area}, border {}",
                    line.list[line.of_view[view]].describe()
                ),
                None => area,
            })
        };
        let all: TiVec<ViewId, Option<String>> =
            self.shapes.iter_enumerated().map(of_view).collect();
        // They may only differ in views that nobody drew.
        let mut shown = all.iter().flatten();
        let first = shown.next();
        shown.any(|paint| Some(paint) != first).then_some(all)
    }
}

/// Reads the characters of a drawing.
pub(crate) fn read(
    drawing: &Drawing,
    bindings: &Bindings,
    memo: &Memo,
    diagnostics: &mut Vec<Diagnostic>,
) -> Vec<Character> {
    features::report_others(drawing, bindings, diagnostics);
    let mut names: Vec<(&str, Vec<LayerId>)> = Vec::new();
    for (index, layer) in bindings.views() {
        match names.iter_mut().find(|(name, _)| *name == layer.name) {
            Some((_, layers)) => layers.push(index),
            None => names.push((&layer.name, vec![index])),
        }
    }
    let characters = names.into_iter().filter_map(|(name, layers)| {
        let views = views(drawing, bindings, (name, &layers), memo, diagnostics)?;
        let drawn = (name, views);
        Some(character(drawing, bindings, drawn, memo, diagnostics))
    });
    characters.collect()
}

/// The views of a character; `None` if there are too few to turn between.
fn views(
    drawing: &Drawing,
    bindings: &Bindings,
    (name, layers): (&str, &[LayerId]),
    memo: &Memo,
    diagnostics: &mut Vec<Diagnostic>,
) -> Option<TiVec<ViewId, DrawnView>> {
    let mut views: TiVec<ViewId, DrawnView> = TiVec::new();
    // What is wrong with a view was reported; then it is not missing.
    let mut has_broken = false;
    for layer in layers {
        let Some(view) = drawn::read(drawing, bindings, *layer, memo, diagnostics) else {
            has_broken = true;
            continue;
        };
        if view.view.regions.is_empty() {
            diagnostics.push(diagnostics::empty(drawing, bindings, *layer));
            continue;
        }
        let same = views
            .iter()
            .find(|other| other.view.direction == view.view.direction);
        if let Some(same) = same {
            diagnostics.push(diagnostics::same_direction(bindings, *layer, same.layer));
            continue;
        }
        views.push(view);
    }
    if let [only] = &views.raw[..]
        && !has_broken
    {
        diagnostics.push(diagnostics::alone(bindings, name, only));
    }
    drawn::name_by_labels(&mut views);
    (views.len() > 1).then_some(views)
}

fn character(
    drawing: &Drawing,
    bindings: &Bindings,
    (name, drawn): (&str, TiVec<ViewId, DrawnView>),
    memo: &Memo,
    diagnostics: &mut Vec<Diagnostic>,
) -> Character {
    let views: TiVec<ViewId, View> = drawn.iter().map(|drawn| drawn.view.clone()).collect();
    let frames = frames(&views);
    let method = said_method(bindings, &drawn);
    let matching = keys::matched(&views, method, memo);
    diagnostics::report(drawing, bindings, name, &drawn, &matching, diagnostics);
    let depths: TiVec<ViewId, TiVec<RegionId, Option<f64>>> = drawn
        .iter()
        .map(|view| view.drawn.iter().map(|drawn| drawn.depth).collect())
        .collect();
    let features = features::assign(bindings, &drawn, &frames, &matching.tracks, diagnostics);
    let all = sides::with_sides(
        bindings,
        name,
        Drawings {
            views: drawn,
            frames,
            tracks: matching.tracks.clone(),
            features,
        },
        memo,
        diagnostics,
    );
    let Views {
        drawings:
            Drawings {
                views: drawn,
                frames,
                tracks,
                features,
            },
        ..
    } = &all;
    let said = Said { drawing, bindings };
    let shapes = shapes(drawn, tracks, features, said, memo);
    let rooms: TiVec<TrackId, f64> = shapes.iter().map(RegionShape::room).collect();
    let count = views.next_key();
    let mut placed = place(&views, &frames[..count], &matching.tracks, &depths, &rooms);
    all.place(&mut placed, &rooms);
    let directions: TiVec<ViewId, Direction> =
        drawn.iter().map(|drawn| drawn.view.direction).collect();
    let turn = between(&directions);
    let backings = if all.has_backing {
        backings(drawn, frames, tracks, &placed)
    } else {
        vec![None; tracks.len()].into()
    };
    let behind = behind_all(&placed);
    let regions = shapes
        .raw
        .into_par_iter()
        .enumerate()
        .map(|(index, shape)| {
            let index = TrackId::from(index);
            let sources = Sources {
                drawn,
                frames,
                count: count.into(),
                track: &tracks[index],
                placed: &placed[index],
                memo,
                features: &features[index],
                backing: backings[index].as_deref(),
                behind,
            };
            sources.model(drawing, index, shape)
        });
    let mut regions: Vec<RegionModel> = regions.collect();
    unique_names(name, &mut regions);
    Character {
        name: name.to_owned(),
        layers: drawn[..count].iter().map(|view| view.layer).collect(),
        turn,
        sides: all.sides,
        frames: all.drawings.frames,
        regions: regions.into(),
        views,
        matching,
    }
}

/// By what the strings of the views say that their regions find their partners; the first one counts.
fn said_method(bindings: &Bindings, views: &TiSlice<ViewId, DrawnView>) -> Method {
    let mut said = views
        .iter()
        .filter_map(|view| drawn::setting(bindings, view.layer, Keyword::Match));
    match said.next() {
        Some(Value::Word(word)) if word == "thesis" => Method::Thesis,
        _ => Method::Whole,
    }
}

/// What the model of a region is made from.
struct Sources<'a> {
    drawn: &'a TiSlice<ViewId, DrawnView>,
    frames: &'a TiSlice<ViewId, Frame>,
    /// How many of the views are drawn.
    count: usize,
    track: &'a Track,
    placed: &'a TrackPosition,
    memo: &'a Memo,
    features: &'a OfRegion,
    /// The outlines of its backing.
    backing: Option<&'a TiSlice<ViewId, Arc<Outline>>>,
    /// How far back the backings of the character are, heights.
    behind: f64,
}

/// A distance, heights, by which something has to be moved back to lie behind all of a character at every view.
fn behind_all(placed: &TiSlice<TrackId, TrackPosition>) -> f64 {
    let depths = || {
        placed
            .iter()
            .flat_map(|placed| placed.depths.iter().copied())
    };
    let (least, greatest) = (
        depths().fold(f64::INFINITY, f64::min),
        depths().fold(f64::NEG_INFINITY, f64::max),
    );
    Turn::FLATNESS * (greatest - least).max(0.0) + BEHIND
}

impl Sources<'_> {
    fn model(&self, drawing: &Drawing, index: TrackId, shape: RegionShape) -> RegionModel {
        let region = |at: &RegionInView| &self.drawn[at.view].view.regions[at.id];
        let drawn = |at: &RegionInView| &self.drawn[at.view].drawn[at.id];
        let line = self.line(&shape);
        let RegionShape {
            shown,
            mut area,
            paints,
            ..
        } = shape;
        self.shrink(&mut area);
        let first = shown.first();
        let backing = self.backing.map(|outlines| {
            let mut morph = keys::morphed(outlines.raw.to_vec(), self.features, self.memo);
            self.shrink(&mut morph);
            RegionMesh {
                morph,
                paints: paints.clone(),
                lift: -self.behind,
            }
        });
        let area = RegionMesh {
            morph: area,
            paints,
            lift: 0.0,
        };
        let meshes = [Some(area), line, backing].into_iter().flatten().collect();
        let named = shown.iter().find_map(|at| region(at).name.clone());
        let mut shapes = TiVec::from(vec![None; self.count]);
        let mut strings = TiVec::from(vec![None; self.count]);
        let mut is_hidden = TiVec::from(vec![false; self.count]);
        let in_drawn = shown.iter().filter(|at| usize::from(at.view) < self.count);
        for at in in_drawn {
            shapes[at.view] = Some(drawn(at).shape);
            strings[at.view] = drawn(at).string;
            is_hidden[at.view] = drawn(at).is_hidden;
        }
        RegionModel {
            name: named.unwrap_or_else(|| {
                let shape = first.map(|first| &drawing.shapes[drawn(first).shape]);
                let shape = shape.filter(|shape| shape.picture.is_none());
                match shape.map(|shape| shape.element.own_name()) {
                    None | Some("") => format!("Region {}", usize::from(index) + 1),
                    Some(own) => own.to_owned(),
                }
            }),
            positions: self.positions(),
            meshes,
            shape: first.map(|first| drawn(first).shape),
            part: first.and_then(|first| drawn(first).part),
            is_shown: self.track.regions.iter().map(Option::is_some).collect(),
            is_hidden,
            shapes,
            strings,
        }
    }

    /// The places in the views, as deep as the order of painting needs.
    fn positions(&self) -> TiVec<ViewId, DVec3> {
        let views = self
            .drawn
            .iter()
            .zip(&self.placed.in_views)
            .zip(&self.placed.depths);
        let place = |((drawn, place), depth): ((&DrawnView, &DVec3), &f64)| {
            let towards = drawn.view.direction.axes()[2];
            *place + towards * (depth - place.dot(towards))
        };
        views.map(place).collect()
    }

    /// The line along the border, as wide as it is drawn in each view.
    fn line(&self, shape: &RegionShape) -> Option<RegionMesh> {
        let RegionShape { area, lines, .. } = shape;
        let paints = shape.line_paints.clone()?;
        // A view that does not show the region has the width of another one; where it is drawn without a line there is none.
        let width = |view: ViewId| {
            let own = lines.iter().find(|(v, _)| *v == view);
            if own.is_none() && self.track.regions[view].is_some() {
                return Some(0.0);
            }
            let (from, line) = own.or(lines.first())?;
            Some(line.width * self.frames[view].height / self.frames[*from].height)
        };
        let widths: Option<TiVec<ViewId, f64>> = self.drawn.keys().map(width).collect();
        let widths = widths?;
        let mut morph = Morph {
            points: vec![Vec::new(); self.drawn.len()].into(),
            ..Morph::default()
        };
        for ring in &area.rings {
            let along = area
                .points
                .iter()
                .map(|points| ring.iter().map(|index| points[*index as usize]).collect());
            let along: Vec<Vec<DVec2>> = along.collect();
            let part = line_mesh(&along, &widths.raw, Ends::Joined);
            let base = morph.points[ViewId::FIRST].len() as u32;
            for (all, points) in morph.points.iter_mut().zip(part.points) {
                all.extend(points);
            }
            let triangles = part.triangles.into_iter();
            morph
                .triangles
                .extend(triangles.map(|t| t.map(|corner| corner + base)));
        }
        self.shrink(&mut morph);
        Some(RegionMesh {
            morph,
            paints,
            lift: LINE_STEP + shape.thickness(),
        })
    }

    /// Where a view does not show the region, it is a point at its place.
    fn shrink(&self, morph: &mut Morph) {
        for (view, points) in morph.points.iter_mut_enumerated() {
            if self.track.regions[view].is_none() {
                let Direction { theta, phi } = self.drawn[view].view.direction;
                let [right, up, _] = view_axes([theta, phi]);
                let place = self.placed.in_views[view];
                let at = DVec2::new(place.dot(right), place.dot(up));
                points.fill(self.frames[view].in_drawing(at));
            }
        }
    }
}

/// Numbers regions whose names are taken, by the character or by one before.
fn unique_names(character: &str, regions: &mut [RegionModel]) {
    let mut taken = FxHashSet::from_iter([character.to_owned()]);
    for region in regions {
        let own = region.name.clone();
        let mut number = 1;
        while !taken.insert(region.name.clone()) {
            number += 1;
            region.name = format!("{own} {number}");
        }
    }
}
