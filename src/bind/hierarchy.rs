//! Names, parents and joints (figure.md, Hierarchy and local frames).

use std::sync::Arc;

use glam::DVec2;
use rayon::prelude::*;
use rstar::primitives::GeomWithData;
use rstar::{PointDistance, RTree};
use rustc_hash::{FxHashMap, FxHashSet};

use super::bindings::{Bindings, DrawingString, NamedBy, PartKind};
use super::{contact, joints, many, names, parents};
use crate::diagnostic::{Code, Diagnostic, few_or_one, listed};
use crate::geometry::{Measure, measure_along};
use crate::lang::ast::{self, Annotation, Name};
use crate::memo::{Bits, Long, Memo};
use crate::source::Span;
use crate::svg::Drawing;
use crate::threads::GRAIN;

/// The name of the virtual node that is the parent of parts without one.
pub(super) const ROOT: &str = "Root";

/// Names every main part, and finds its parent, axis and joint.
pub(super) fn build(
    drawing: &Drawing,
    bindings: &mut Bindings,
    memo: &Memo,
    diagnostics: &mut Vec<Diagnostic>,
) {
    let mut names = names_of_strings(drawing, bindings, diagnostics);
    names::give(drawing, bindings, &mut names);
    automatic(drawing, bindings, &mut names, memo, diagnostics);
    if bindings.hierarchy_by_contact {
        contact::build(bindings);
    }
    parents::other_signs(bindings, &names, diagnostics);
    parents::parents(drawing, bindings, &names, diagnostics);
    parents::of_layers(drawing, bindings, &names, diagnostics);
    parents::break_cycles(drawing, bindings, diagnostics);
    axes(drawing, bindings, diagnostics);
    let parts = 0..bindings.parts.len();
    let is_main = |part: &usize| bindings.parts[*part].kind == PartKind::Main;
    let joints: Vec<(usize, DVec2, Option<Diagnostic>)> = parts
        .into_par_iter()
        .with_min_len(GRAIN)
        .filter(is_main)
        .map(|part| {
            let origin = joints::origin(bindings, part);
            let finding = joints::turns_about_middle(drawing, bindings, part, origin);
            (part, origin, finding)
        })
        .collect();
    for (part, origin, finding) in joints {
        bindings.parts[part].origin = origin;
        diagnostics.extend(finding);
    }
}

fn part_name(bindings: &Bindings, part: usize) -> Option<&Name> {
    match &bindings.strings[bindings.parts[part].string?].annotation {
        Annotation::Part(part) => part.name.as_ref(),
        _ => None,
    }
}

/// The main parts that strings name by name; of several with the same name, the first.
fn names_of_strings(
    drawing: &Drawing,
    bindings: &Bindings,
    diagnostics: &mut Vec<Diagnostic>,
) -> FxHashMap<String, usize> {
    let mut names: FxHashMap<String, usize> = FxHashMap::default();
    names.reserve(bindings.parts.len());
    let span = |part: usize| match (part_name(bindings, part), bindings.parts[part].string) {
        (Some(name), Some(string)) => bindings.strings[string].text.span(name.range.clone()),
        (None, Some(string)) => bindings.strings[string].text.whole(),
        _ => drawing.shapes[bindings.parts[part].shape].element.span,
    };
    for (index, part) in bindings.parts.iter().enumerate() {
        if part.kind != PartKind::Main || part.name.is_empty() {
            continue;
        }
        if let Some(first) = names.get(&part.name) {
            let message = format!("two parts are named `{}`", part.name);
            diagnostics.push(
                Diagnostic::new(Code::DuplicateName, span(index), message)
                    .label("the second one")
                    .related(span(*first), "the first one")
                    .help("rename one of them"),
            );
        } else {
            names.insert(part.name.clone(), index);
        }
    }
    let mut layers: FxHashMap<&str, Span> = FxHashMap::default();
    for (_, layer) in bindings.tile_layers() {
        let own = name_span(&bindings.strings[layer.string]);
        let part = names.get(&layer.name).map(|part| span(*part));
        let Some(first) = part.or_else(|| layers.get(layer.name.as_str()).copied()) else {
            layers.insert(&layer.name, own);
            continue;
        };
        let what = if part.is_some() {
            "a part"
        } else {
            "another tile layer"
        };
        let message = format!("this tile layer and {what} are both named `{}`", layer.name);
        diagnostics.push(
            Diagnostic::new(Code::DuplicateName, own, message)
                .related(first, "the first one")
                .help("rename one of them"),
        );
    }
    names
}

/// The place of the name in a string; the whole string if it has none.
fn name_span(string: &DrawingString) -> Span {
    match &string.annotation {
        Annotation::Part(ast::Part {
            name: Some(name), ..
        }) => string.text.span(name.range.clone()),
        _ => string.text.whole(),
    }
}

/// Names the parts without a name, and makes them and the other parts without a string children of the nearest named main part
/// (rule 5).
fn automatic(
    drawing: &Drawing,
    bindings: &mut Bindings,
    names: &mut FxHashMap<String, usize>,
    memo: &Memo,
    diagnostics: &mut Vec<Diagnostic>,
) {
    let main = |part: &usize| bindings.parts[*part].kind == PartKind::Main;
    let (named, waiting): (Vec<usize>, Vec<usize>) = (0..bindings.parts.len())
        .filter(main)
        .partition(|part| !bindings.parts[*part].name.is_empty());
    // What has a string carries what labels and ids name, and both carry what nothing names. Without strings two names are needed:
    // one says nothing about what hangs on what.
    let (by_string, mut by_element): (Vec<usize>, Vec<usize>) = named
        .iter()
        .partition(|part| bindings.parts[**part].string.is_some());
    let carriers = match by_string.is_empty() && by_element.len() < 2 {
        true => vec![],
        false => named,
    };
    if by_string.is_empty() {
        by_element.clear();
    }
    let parents = nearest(bindings, by_string, &by_element, memo);
    let carrying = parents::carrying(bindings, names);
    for (part, parent) in by_element.iter().copied().zip(parents.iter().copied()) {
        // A part that others are attached to must not hang on one of those.
        let parent = parent.filter(|parent| {
            !carrying.contains(&part) || !parents::hangs_on(bindings, names, *parent, part)
        });
        bindings.parts[part].parent = parent;
    }
    if bindings.annotated {
        many::names_without_strings(drawing, bindings, &by_element, diagnostics);
    }
    let of_layers: FxHashSet<String> = bindings
        .tile_layers()
        .map(|(_, layer)| layer.name.clone())
        .collect();
    let parents = nearest(bindings, carriers, &waiting, memo);
    let mut counter = 0;
    let pairs = waiting.iter().copied().zip(parents.iter().copied());
    for (index, parent) in pairs {
        let name = loop {
            counter += 1;
            let name = format!("U-{counter}");
            if !names.contains_key(&name) && !of_layers.contains(name.as_str()) {
                break name;
            }
        };
        names.insert(name.clone(), index);
        let part = &mut bindings.parts[index];
        part.name = name;
        part.named_by = NamedBy::Automatic;
        part.parent = parent;
    }
    if bindings.annotated {
        many::names_without_strings(drawing, bindings, &waiting, diagnostics);
    }
}

/// The nearest of some parts to each of others.
fn nearest(
    bindings: &Bindings,
    named: Vec<usize>,
    waiting: &[usize],
    memo: &Memo,
) -> Arc<[Option<usize>]> {
    let center = |part: usize| Bits(bindings.parts[part].measure.center.to_array());
    let question = NearestNamed {
        named: named.into_iter().map(|part| (center(part), part)).collect(),
        centers: waiting.iter().map(|part| center(*part)).collect(),
    };
    memo.get(question, NearestNamed::answer)
}

/// Which named part is nearest to each part without a string?
#[derive(PartialEq, Eq, Hash)]
struct NearestNamed {
    /// The centres of the named parts, with their indices.
    named: Long<(Bits<[f64; 2]>, usize)>,
    /// The centres of the parts without a string.
    centers: Long<Bits<[f64; 2]>>,
}

impl NearestNamed {
    /// The nearest named part of each; of several at the same distance, the back-most.
    fn answer(&self) -> Arc<[Option<usize>]> {
        let named = self.named.0.iter();
        let named = named.map(|(center, part)| GeomWithData::new(center.0, *part));
        let tree = RTree::bulk_load(named.collect());
        let nearest = |Bits(center): &Bits<[f64; 2]>| {
            let distance = tree.nearest_neighbor(*center)?.distance_2(center);
            let as_near = tree.locate_within_distance(*center, distance);
            as_near.map(|found| found.data).min()
        };
        let centers = self.centers.0.par_iter().with_min_len(GRAIN);
        centers.map(nearest).collect::<Vec<_>>().into()
    }
}

/// Turns the axes of parts with `Axis`.
fn axes(drawing: &Drawing, bindings: &mut Bindings, diagnostics: &mut Vec<Diagnostic>) {
    let found: Vec<(usize, Axis)> = (0..bindings.parts.len())
        .into_par_iter()
        .with_min_len(GRAIN)
        .filter_map(|part| Some((part, axis(drawing, bindings, part)?)))
        .collect();
    let mut guessed = Vec::new();
    for (part, axis) in found {
        match axis {
            Axis::Turned(measure) => bindings.parts[part].measure = measure,
            Axis::Guessed(finding) => guessed.push((part, finding)),
        }
    }
    let (parts, findings): (Vec<usize>, Vec<Diagnostic>) = guessed.into_iter().unzip();
    let names = || listed(parts.iter().map(|part| bindings.describe(drawing, *part)));
    few_or_one(
        findings,
        |count| {
            let names = names();
            format!(
                "{count} parts are as wide as they are long, so their axes are assumed to be upright: {names}"
            )
        },
        diagnostics,
    );
}

/// A change to a part's axis, or a doubt about it.
enum Axis {
    /// `Axis` turns it.
    Turned(Measure),
    /// The solid depends on the axis, which the outline does not determine.
    Guessed(Diagnostic),
}

fn axis(drawing: &Drawing, bindings: &Bindings, index: usize) -> Option<Axis> {
    let part = &bindings.parts[index];
    if !matches!(part.kind, PartKind::Main | PartKind::Sub) || bindings.form(index) != index {
        return None;
    }
    if let Some(degrees) = bindings.attributes(index).axis() {
        let (sin, cos) = degrees.to_radians().sin_cos();
        let measure = measure_along(&part.outline, DVec2::new(cos, -sin))?;
        return Some(Axis::Turned(Measure {
            certain: true,
            ..measure
        }));
    }
    let turns = !part.measure.certain
        && bindings
            .profile(drawing, index)
            .is_some_and(|profile| profile.depends_on_axis());
    turns.then(|| {
        let name = bindings.describe(drawing, index);
        let place = part
            .string
            .map_or(drawing.shapes[part.shape].element.span, |string| {
                bindings.strings[string].text.whole()
            });
        let message =
            format!("{name} is as wide as it is long, so its axis is assumed to be upright");
        Axis::Guessed(
            Diagnostic::new(Code::AxisGuess, place, message)
                .help("write `Axis 90` for an upright axis, `Axis 0` for a horizontal one"),
        )
    })
}
