//! Findings about many parts: a few are reported one by one, many as one.

use super::bindings::{Bindings, NamedBy};
use crate::diagnostic::{Code, Diagnostic, FEW, few_or_one, listed};
use crate::svg::Drawing;

/// Reports parts without a string: all those with automatic names, or all those that labels and ids name.
pub(super) fn names_without_strings(
    drawing: &Drawing,
    bindings: &Bindings,
    parts: &[usize],
    diagnostics: &mut Vec<Diagnostic>,
) {
    let described = |part: &usize| drawing.describe(bindings.parts[*part].shape);
    let report = |part: usize, message: String| {
        let element = &drawing.shapes[bindings.parts[part].shape].element;
        Diagnostic::new(Code::AutomaticName, element.span, message)
    };
    if parts.len() <= FEW {
        diagnostics.extend(parts.iter().map(|part| {
            let on = bindings.parts[*part]
                .parent
                .map_or(String::new(), |parent| {
                    format!(" and is attached to `{}`", bindings.parts[parent].name)
                });
            let name = &bindings.parts[*part].name;
            let by = match bindings.parts[*part].named_by {
                NamedBy::Label { .. } => " by its label",
                NamedBy::Id { .. } => " by its id",
                NamedBy::String | NamedBy::Automatic => "",
            };
            let message = format!(
                "{} has no string: it is named `{name}`{by}{on}",
                described(part)
            );
            report(*part, message).help("write a name beside it, or `*` to leave it out")
        }));
        return;
    }
    let ends = [parts[0], parts[parts.len() - 1]];
    let [from, to] = ends.map(|part| &bindings.parts[part].name);
    let named = match bindings.parts[parts[0]].is_automatic() {
        true => format!("named `{from}` to `{to}`"),
        false => "named by their labels or ids".to_owned(),
    };
    let message = format!(
        "{} shapes have no string: they are {named}, and each is attached to the nearest named part: {}",
        parts.len(),
        listed(parts.iter().map(described))
    );
    diagnostics.push(report(parts[0], message).help(
        "write a name beside each, or `*` to leave it out; `okoshi inspect` lists them all, each with its parent",
    ));
}

/// How many times the larger side of the page a part may be moved.
const FAR: f64 = 10.0;

/// Reports the parts that `Offset` moves far away.
pub(super) fn far_away(drawing: &Drawing, bindings: &Bindings, diagnostics: &mut Vec<Diagnostic>) {
    if !bindings.annotated {
        return;
    }
    let size = drawing.page.1.max_element();
    let mut findings = Vec::new();
    for (index, part) in bindings.parts.iter().enumerate() {
        if part.kind != super::PartKind::Main {
            continue;
        }
        let Some(offset) = bindings.attributes(index).offset() else {
            continue;
        };
        if offset.value.abs() > FAR * size {
            let name = bindings.describe(drawing, index);
            let message = format!(
                "{name} is moved by {}, although the page is only {size:.0} wide",
                offset.value
            );
            let place = bindings.span_of(&offset.source);
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
pub(super) fn off_page(drawing: &Drawing, bindings: &Bindings, diagnostics: &mut Vec<Diagnostic>) {
    if !bindings.annotated {
        return;
    }
    let (page_low, page_size) = drawing.page;
    let parts = bindings.parts.iter();
    let off: Vec<_> = parts
        .filter(|part| {
            let (low, high) = part.measure.bounds;
            let off = high.cmplt(page_low).any() || low.cmpgt(page_low + page_size).any();
            off && part.kind == super::PartKind::Main
        })
        .collect();
    let name = |name: &str| format!("`{name}`");
    let findings = off.iter().map(|part| {
        let element = &drawing.shapes[part.shape].element;
        let message = format!("{} is off the page", name(&part.name));
        Diagnostic::new(Code::OffPage, element.span, message)
            .help("write `*` beside it to leave it out, or move it onto the page")
    });
    let names = || listed(off.iter().map(|part| name(&part.name)));
    few_or_one(
        findings.collect(),
        |count| format!("{count} parts are off the page: {}", names()),
        diagnostics,
    );
}
