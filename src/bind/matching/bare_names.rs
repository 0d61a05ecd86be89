//! Texts that are names and nothing more: `Head`, without any sign of the language.

use std::sync::Arc;

use glam::DVec2;
use rayon::prelude::*;
use rustc_hash::FxHashSet;
use typed_index_collections::{TiVec, ti_vec};

use super::fills::Fills;
use super::wrappers::is_filled;
use crate::bind::bindings::StringHolder;
use crate::geometry::edge_distance_squared;
use crate::lang::is_name_char;
use crate::source::Text;
use crate::svg::{Drawing, GroupId, GroupKind, Label, StrokeSource};

/// The fewest names that make a drawing annotated: a single word is a title or a signature.
const FEWEST: usize = 2;
/// The most single letters that are taken for names: people who name parts `A`, `B`, `C` have few of them.
const LETTERS: usize = 3;
/// How far a name's points may be from its shape, in font sizes: one from its letters.
const REACH: f64 = 1.3;

/// Whether all words are single letters of the alphabet: lettering along a curve is often one text per letter.
fn is_lettering(words: &FxHashSet<&str>) -> bool {
    let is_letter =
        |word: &&str| word.len() == 1 && word.starts_with(|c: char| c.is_ascii_alphabetic());
    words.len() > LETTERS && words.iter().all(is_letter)
}

/// Whether a text is a single word that can name a part: it has letters, and no sign of the language.
pub(in crate::bind) fn is_bare_name(text: &str) -> bool {
    let text = text.trim();
    !text.starts_with(['#', '^', '%', '*'])
        && text.chars().all(is_name_char)
        && text.chars().any(char::is_alphabetic)
}

/// Whether the names in the descriptions of a drawing without any sign of the language are names of parts: distinct words, each of a
/// filled shape, or of a group that directly holds one.
pub(super) fn descriptions_name_parts(
    drawing: &Drawing,
    names: &[(StringHolder, Arc<Text>)],
) -> bool {
    let holding = drawing.shapes.iter().filter(|shape| is_filled(shape));
    let holding: FxHashSet<GroupId> = holding.map(|shape| shape.group).collect();
    let mut seen = FxHashSet::default();
    names.iter().all(|(holder, text)| {
        let has_part = match holder {
            StringHolder::Shape(shape) => is_filled(&drawing.shapes[*shape]),
            StringHolder::Group(group) => holding.contains(group),
            StringHolder::Label(_) => false,
        };
        has_part && seen.insert(text.as_str().trim())
    })
}

/// Whether one of the points is on a stroke, or at most `reach` away from it.
fn is_beside(stroke: &StrokeSource, points: [DVec2; 3], reach: f64) -> bool {
    let reach = reach + 0.5 * stroke.width();
    let mut is_beside = false;
    stroke.middle_line(reach, |from, to| {
        let distances = points.map(|point| edge_distance_squared([from, to], point));
        is_beside |= distances.iter().any(|distance| *distance <= reach * reach);
    });
    is_beside
}

/// Per group, whether it has a single text and holds filled shapes, but not all of them.
fn named_by_its_text(drawing: &Drawing) -> TiVec<GroupId, bool> {
    let mut shapes: TiVec<GroupId, usize> = ti_vec![0; drawing.groups.len()];
    for shape in drawing.shapes.iter().filter(|shape| is_filled(shape)) {
        shapes[shape.group] += 1;
    }
    // A group comes after the group that contains it.
    for (group, inside) in drawing.groups.iter_enumerated().skip(1).rev() {
        let held = shapes[group];
        shapes[inside.parent] += held;
    }
    let filled = shapes[GroupId::ROOT];
    let mut texts: TiVec<GroupId, usize> = ti_vec![0; drawing.groups.len()];
    for (_, group) in &drawing.labels {
        texts[*group] += 1;
    }
    let is_named = |(group, held): (GroupId, &usize)| {
        let is_group = drawing.groups[group].kind == GroupKind::Group;
        is_group && texts[group] == 1 && (1..filled).contains(held)
    };
    shapes.iter_enumerated().map(is_named).collect()
}

/// Whether the texts of a drawing without any sign of the language but `*` are names of parts: distinct words, two or more with the
/// `*`s, each on a filled shape or a line, beside one, joined to one by a line, or the only text in a group of shapes.
pub(super) fn name_parts(drawing: &Drawing) -> bool {
    let is_written = |(label, _): &&(Label, GroupId)| !label.text.as_str().trim().is_empty();
    let labels: Vec<_> = drawing.labels.iter().filter(is_written).collect();
    let mut seen = FxHashSet::default();
    let words = labels.iter().map(|(label, _)| label.text.as_str().trim());
    // A `*` leaves a shape out: beside a name it says that the texts are about the shapes.
    let mut names = words.filter(|word| !word.starts_with('*'));
    let distinct = names.all(|word| is_bare_name(word) && seen.insert(word));
    if !distinct || seen.is_empty() || labels.len() < FEWEST || is_lettering(&seen) {
        return false;
    }
    let fills = Fills::in_front(drawing, 0);
    let lines = drawing
        .shapes
        .iter()
        .filter_map(|shape| shape.line.as_ref());
    let ends: Vec<[DVec2; 2]> = lines.map(|line| line.ends).collect();
    let strokes = drawing.shapes.iter().filter(|shape| !is_filled(shape));
    let strokes: Vec<&StrokeSource> = strokes
        .filter_map(|shape| shape.stroke.as_deref())
        .collect();
    let named_by_its_text = named_by_its_text(drawing);
    labels.par_iter().all(|(label, group)| {
        if named_by_its_text[*group] {
            return true;
        }
        let reach = REACH * label.font_size;
        let (low, high) = label.position.bounds;
        let begins_at = |end: DVec2| end.distance(end.clamp(low, high)) <= reach;
        let leads_to_shape = |[from, to]: &[DVec2; 2]| {
            begins_at(*from) && fills.is_near(*to, reach)
                || begins_at(*to) && fills.is_near(*from, reach)
        };
        let points = label.position.points;
        points.iter().any(|point| fills.is_near(*point, reach))
            || ends.iter().any(leads_to_shape)
            || strokes
                .iter()
                .any(|stroke| is_beside(stroke, points, reach))
    })
}
