//! Parts off the page or far from it: a few are reported one by one, many as one.

use crate::bind::attributes::PartAttributes;
use crate::bind::bindings::{PartId, PartKind};
use crate::bind::describe::describe;
use crate::bind::hierarchy::Tree;
use crate::bind::matching::Matched;
use crate::diagnostic::{Code, Diagnostic, few_or_one, listed};
use crate::svg::Drawing;

/// How many times the larger side of the page a part may be moved.
const FAR: f64 = 10.0;

/// Reports the parts that `Offset` moves far away.
pub(super) fn far_away(
    drawing: &Drawing,
    matched: &Matched,
    attributes: &PartAttributes,
    tree: &Tree,
    diagnostics: &mut Vec<Diagnostic>,
) {
    if !matched.annotated {
        return;
    }
    let size = drawing.page.1.max_element();
    let mut findings = Vec::new();
    for (part, kind) in tree.nodes.kind.iter_enumerated() {
        let offset = attributes.attributes(matched, part).offset();
        let Some(offset) = offset.filter(|_| *kind == PartKind::Main) else {
            continue;
        };
        if offset.value.abs() > FAR * size {
            let name = describe(drawing, &tree.names[part].name, matched.parts[part].shape);
            let message = format!(
                "{name} is moved by {}, although the page is only {size:.0} wide",
                offset.value
            );
            let place = offset.source.span(&matched.strings);
            findings.push(
                Diagnostic::new(Code::FarAway, place, message)
                    .help("`Offset` is in drawing units, like all lengths"),
            );
        }
    }
    few_or_one(
        findings,
        |count| format!("{count} parts are moved far away from the page, which is {size:.0} wide"),
        diagnostics,
    );
}

/// Reports the parts that are off the page.
pub(super) fn report(
    drawing: &Drawing,
    matched: &Matched,
    tree: &Tree,
    diagnostics: &mut Vec<Diagnostic>,
) {
    if !matched.annotated {
        return;
    }
    let (page_low, page_size) = drawing.page;
    let parts = matched.parts.keys();
    let off: Vec<PartId> = parts
        .filter(|part| {
            let (low, high) = tree.axes.measure(matched, *part).bounds;
            let off = high.cmplt(page_low).any() || low.cmpgt(page_low + page_size).any();
            off && tree.nodes.kind[*part] == PartKind::Main
        })
        .collect();
    let name = |part: PartId| format!("`{}`", tree.names[part].name);
    let findings = off.iter().map(|part| {
        let element = &drawing.shapes[matched.parts[*part].shape].element;
        let message = format!("{} is off the page", name(*part));
        Diagnostic::new(Code::OffPage, element.span, message)
            .help("write `*` beside it to leave it out, or move it onto the page")
    });
    let names = || listed(off.iter().map(|part| name(*part)));
    few_or_one(
        findings.collect(),
        |count| format!("{count} parts are off the page: {}", names()),
        diagnostics,
    );
}
