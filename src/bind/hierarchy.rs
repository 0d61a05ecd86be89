//! Names, parents and joints (figure.md, Hierarchy and local frames).

use std::sync::Arc;

use glam::DVec2;
use rayon::prelude::*;
use rstar::primitives::GeomWithData;
use rstar::{PointDistance, RTree};
use rustc_hash::{FxHashMap, FxHashSet};

use super::bindings::{Bindings, DrawingString, Part, PartKind};

use super::parents;
use crate::diagnostic::{Code, Diagnostic};
use crate::geometry::{Measure, measure_along};
use crate::lang::ast::{self, Annotation, Name};
use crate::lang::value::Origin;
use crate::memo::{Bits, Long, Memo};
use crate::source::Span;
use crate::svg::Drawing;
use crate::threads::GRAIN;

/// The name of the virtual node that is the parent of parts without one.
pub(super) const ROOT: &str = "Root";
/// The least ratio of length to width for the hint that a part turns about its middle.
const LONG: f64 = 2.0;
/// Limit of automatic names that are reported one by one.
const MAX_REPORTED: usize = 200;

/// Names every main part, and finds its parent, axis and joint.
pub(super) fn build(
    drawing: &Drawing,
    bindings: &mut Bindings,
    memo: &Memo,
    diagnostics: &mut Vec<Diagnostic>,
) {
    let mut names = names(drawing, bindings, diagnostics);
    automatic(drawing, bindings, &mut names, memo, diagnostics);
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
            let origin = origin(bindings, part);
            let finding = turns_about_middle(drawing, bindings, part, origin);
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

/// The main parts by name; of several with the same name, the first.
fn names(
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

/// Names the parts without a string, and makes them children of the nearest named main part (rule 5).
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
    let center = |part: usize| bindings.parts[part].measure.center.to_array();
    let question = NearestNamed {
        named: named
            .into_iter()
            .map(|part| (Bits(center(part)), part))
            .collect(),
        centers: waiting.iter().map(|part| Bits(center(*part))).collect(),
    };
    let of_layers: FxHashSet<String> = bindings
        .tile_layers()
        .map(|(_, layer)| layer.name.clone())
        .collect();
    let parents = memo.get(question, NearestNamed::answer);
    let mut counter = 0;
    let pairs = waiting.iter().copied().zip(parents.iter().copied());
    for (place, (index, parent)) in pairs.enumerate() {
        let name = loop {
            counter += 1;
            let name = format!("U-{counter}");
            if !names.contains_key(&name) && !of_layers.contains(name.as_str()) {
                break name;
            }
        };
        if bindings.annotated && place < MAX_REPORTED {
            diagnostics.push(automatic_name(drawing, bindings, index, &name, parent));
        }
        names.insert(name.clone(), index);
        let part = &mut bindings.parts[index];
        part.name = name;
        part.automatic = true;
        part.parent = parent;
    }
    if let (true, [first, .., last]) = (
        bindings.annotated,
        waiting.get(MAX_REPORTED..).unwrap_or_default(),
    ) {
        let [from, to] = [first, last].map(|part| &bindings.parts[*part].name);
        let count = waiting.len() - MAX_REPORTED;
        let message =
            format!("{count} more parts have no string: they are named `{from}` to `{to}`");
        let span = drawing.shapes[bindings.parts[*first].shape].element.span;
        let help = "`okoshi inspect` lists them all, each with its parent";
        diagnostics.push(Diagnostic::new(Code::AutomaticName, span, message).help(help));
    }
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

/// Reports the name of a part without a string.
fn automatic_name(
    drawing: &Drawing,
    bindings: &Bindings,
    part: usize,
    name: &str,
    parent: Option<usize>,
) -> Diagnostic {
    let on = parent.map_or(String::new(), |parent| {
        format!(" and is attached to `{}`", bindings.parts[parent].name)
    });
    let element = &drawing.shapes[bindings.parts[part].shape].element;
    let message = format!(
        "{} has no string: it is named `{name}`{on}",
        element.describe()
    );
    Diagnostic::new(Code::AutomaticName, element.span, message)
        .help("write a name beside it, or `*` to leave it out")
}

/// Turns the axes of parts with `Axis`.
fn axes(drawing: &Drawing, bindings: &mut Bindings, diagnostics: &mut Vec<Diagnostic>) {
    let found: Vec<(usize, Axis)> = (0..bindings.parts.len())
        .into_par_iter()
        .with_min_len(GRAIN)
        .filter_map(|part| Some((part, axis(drawing, bindings, part)?)))
        .collect();
    for (part, axis) in found {
        match axis {
            Axis::Turned(measure) => bindings.parts[part].measure = measure,
            Axis::Guessed(finding) => diagnostics.push(finding),
        }
    }
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
    if !matches!(part.kind, PartKind::Main | PartKind::Sub) {
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

/// The joint of a main part (paper, section 3.5).
fn origin(bindings: &Bindings, index: usize) -> DVec2 {
    let part = &bindings.parts[index];
    let center = |parent: usize| bindings.parts[parent].measure.center;
    let parent = part.parent.map(center);
    let [start, end] = sorted_ends(part, parent);
    match bindings.attributes(index).origin() {
        Some(Origin::Center) => part.measure.center,
        Some(Origin::Start) => start,
        Some(Origin::End) => end,
        Some(Origin::Point([x, y])) => DVec2::new(x, y),
        None => match parent {
            None => part.measure.center,
            Some(parent) => {
                let candidates = [start, end, part.measure.center];
                // `min_by` takes the first of equals: an end rather than the centre, unless the part is centred on its parent.
                let near = |p: &DVec2| p.distance_squared(parent);
                candidates
                    .into_iter()
                    .min_by(|a, b| near(a).total_cmp(&near(b)))
                    .unwrap_or(part.measure.center)
            }
        },
    }
}

/// The ends of the axis: the one nearer to the parent's centre first; without a parent, the upper one first.
fn sorted_ends(part: &Part, parent: Option<DVec2>) -> [DVec2; 2] {
    let [a, b] = part.measure.ends;
    let swapped = match parent {
        Some(parent) => b.distance_squared(parent) < a.distance_squared(parent),
        None => b.y < a.y,
    };
    if swapped { [b, a] } else { [a, b] }
}

/// Reports a long part beside its parent that turns about its middle, which is seldom meant.
fn turns_about_middle(
    drawing: &Drawing,
    bindings: &Bindings,
    index: usize,
    origin: DVec2,
) -> Option<Diagnostic> {
    let part = &bindings.parts[index];
    let long = part.measure.half_along > LONG * part.measure.half_across;
    let (parent, string) = (part.parent?, part.string?);
    let chosen = || bindings.attributes(index).origin().is_some();
    let beside = &bindings.parts[parent].measure;
    // A hat or a foot lies across the end of its parent, and is meant to turn about its middle.
    let alike = !beside.certain
        || beside.axis.dot(part.measure.axis).abs() > std::f64::consts::FRAC_1_SQRT_2;
    if !long || !alike || origin != part.measure.center || chosen() {
        return None;
    }
    let string = &bindings.strings[string];
    let text = &string.text;
    let has_attributes = match &string.annotation {
        Annotation::Part(annotation) => {
            !annotation.attributes.is_empty() || text.as_str().trim_end().ends_with(['$', '＄'])
        }
        _ => return None,
    };
    let end = text.as_str().trim_end().len();
    let place = text.span(end..end);
    let [start, far] = sorted_ends(part, Some(bindings.parts[parent].measure.center));
    let way = far - start;
    let side = match (way.y.abs() >= way.x.abs(), way.x >= 0.0, way.y >= 0.0) {
        (true, _, true) => "upper",
        (true, _, false) => "lower",
        (false, true, _) => "left",
        (false, false, _) => "right",
    };
    let lead = if has_attributes { " " } else { "$" };
    let message = format!(
        "both ends of `{}` are about equally far from `{}`, so it turns about its middle",
        part.name, bindings.parts[parent].name
    );
    let mut diagnostic = Diagnostic::new(Code::TurnsAboutMiddle, text.whole(), message)
    .related(drawing.shapes[part.shape].element.span, "the part")
    .help(format!(
        "for an arm or a leg write `Origin start` (the end nearer to the centre of `{}`, here the {side} one) or `Origin end`",
        bindings.parts[parent].name
    ));
    for word in ["start", "end"] {
        diagnostic = diagnostic.fix(
            format!("Turn about its {word}"),
            place,
            format!("{lead}Origin {word}"),
        );
    }
    Some(diagnostic)
}
