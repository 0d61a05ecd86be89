//! Strings of which it is not certain what they mean: a hint names both candidates, with a fix for each.

use rayon::prelude::*;

use crate::bind::bindings::{BoundBy, DrawingString, PartId, PartKind, StringHolder};
use crate::bind::matching::Matched;
use crate::diagnostic::{Code, Diagnostic, Edit, Fix};
use crate::lang::ast::Annotation;
use crate::source::Span;
use crate::svg::{Drawing, Element};
use crate::threads::GRAIN;

/// Reports the strings that may mean another part than the one that they are bound to.
pub(super) fn report(drawing: &Drawing, matched: &Matched, diagnostics: &mut Vec<Diagnostic>) {
    let strings = matched.strings.raw.par_iter().with_min_len(GRAIN);
    let hints = strings.filter_map(|string| hint(drawing, matched, string));
    diagnostics.extend(hints.collect::<Vec<_>>());
}

/// The hint about a string that may mean another part than its own.
fn hint(drawing: &Drawing, matched: &Matched, string: &DrawingString) -> Option<Diagnostic> {
    let (binding, rival) = (string.binding?, string.runner_up?);
    if matches!(matched.kinds[rival], PartKind::Tile | PartKind::Region) {
        return None;
    }
    // By its looks: the name of a part may be what this string, or another uncertain one, says.
    let shape = |part: PartId| drawing.describe(matched.parts[part].shape);
    let [own, other] = [binding.part, rival].map(shape);
    let text = string.text.as_str().trim();
    let text = text
        .split(['$', '\n'])
        .next()
        .unwrap_or_default()
        .trim_end();
    let message = match text {
        "" => format!("this string may mean {own} or {other}: it is bound to {own}"),
        text => format!("`{text}` may mean {own} or {other}: it is bound to {own}"),
    };
    let mut hint = Diagnostic::new(Code::Uncertain, string.text.whole(), message)
        .related(
            part_span(drawing, matched, binding.part),
            "the shape that it is bound to",
        )
        .related(
            part_span(drawing, matched, rival),
            "the shape that it may mean",
        )
        .help(match binding.by {
            BoundBy::Leader => "let the line end inside the shape that the string means",
            _ => "move the string onto the shape that it means, or group the two",
        });
    for (part, name) in [(binding.part, own), (rival, other)] {
        let element = element(drawing, matched, part);
        if let Some(edits) = described(drawing, string, element) {
            let title = format!("It means {name}: make it the description of that shape");
            hint.fixes.push(Fix {
                title,
                edits,
                safe: false,
            });
        }
    }
    Some(hint)
}

fn part_span(drawing: &Drawing, matched: &Matched, part: PartId) -> Span {
    drawing.shapes[matched.parts[part].shape].element.span
}

/// The element whose description names the unit of a main part: its group, or its shape.
fn element<'a>(drawing: &'a Drawing, matched: &Matched, part: PartId) -> &'a Element {
    let part = &matched.parts[part];
    match matched
        .node_groups
        .outermost(drawing.shapes[part.shape].group)
    {
        Some(group) => &drawing.groups[group].element,
        None => &drawing.shapes[part.shape].element,
    }
}

/// The edits that make a text the description of an element. A legend in a description would be the part's own string.
fn described(drawing: &Drawing, string: &DrawingString, element: &Element) -> Option<Vec<Edit>> {
    let StringHolder::Label(label) = string.holder else {
        return None;
    };
    if matches!(string.annotation, Annotation::Legend(_)) {
        return None;
    }
    let insert = element.with_description(string.text.as_str().trim())?;
    let remove = Edit {
        span: drawing.labels[label].0.element,
        text: String::new(),
    };
    let mut edits = vec![insert, remove];
    edits.sort_by_key(|edit| edit.span);
    Some(edits)
}
