//! Reports the outlines of filled shapes, which are not built unless the drawing asks for them.

use super::bindings::{Bindings, PartKind};
use super::settings::Strokes;
use crate::diagnostic::{Code, Diagnostic, listed};
use crate::svg::Drawing;

/// One warning about all filled shapes whose outlines are left out, unless a string says what happens to strokes.
pub(super) fn report(drawing: &Drawing, bindings: &Bindings, diagnostics: &mut Vec<Diagnostic>) {
    let is_undecided = match bindings.settings.strokes {
        Strokes::Ink => true,
        // In an annotated drawing, a string has set this.
        Strokes::Lines => !bindings.annotated,
        Strokes::None | Strokes::All => false,
    };
    if !is_undecided {
        return;
    }
    let is_built = |kind| matches!(kind, PartKind::Main | PartKind::Sub);
    let mut outlined: Vec<usize> = bindings
        .parts
        .iter()
        .filter(|part| is_built(part.kind))
        .map(|part| part.shape)
        .filter(|shape| {
            let shape = &drawing.shapes[*shape];
            shape.stroke.is_some() && !shape.outline.polygons.is_empty()
        })
        .collect();
    outlined.sort_unstable();
    outlined.dedup();
    let Some(first) = outlined.first() else {
        return;
    };
    let names = listed(outlined.iter().map(|shape| drawing.describe(*shape)));
    let message = match outlined.len() {
        1 => format!("the outline of {names} is not built, only its filled area"),
        count => format!(
            "the outlines of {count} filled shapes are not built, only their filled areas: {names}"
        ),
    };
    diagnostics.push(
        Diagnostic::new(Code::OutlinesLeftOut, drawing.shapes[*first].element.span, message).help(
            "write a text `%Strokes all` anywhere on the page to build outlines, or `%Strokes none` to do without",
        ),
    );
}
