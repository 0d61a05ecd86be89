//! Reports the outlines of filled shapes, which are not built unless the drawing asks for them.

use crate::bind::bindings::PartKind;
use crate::bind::hierarchy::Tree;
use crate::bind::matching::{Matched, Strokes};
use crate::diagnostic::{Code, Diagnostic, listed};
use crate::svg::{Drawing, ShapeId};

/// One warning about all filled shapes whose outlines are left out, unless a string says what happens to strokes.
pub(super) fn report(
    drawing: &Drawing,
    matched: &Matched,
    tree: &Tree,
    diagnostics: &mut Vec<Diagnostic>,
) {
    let is_undecided = match matched.settings.strokes {
        Strokes::Ink => true,
        // In an annotated drawing, a string has set this.
        Strokes::Lines => !matched.annotated,
        Strokes::None | Strokes::All => false,
    };
    if !is_undecided {
        return;
    }
    let is_built = |kind: &PartKind| matches!(kind, PartKind::Main | PartKind::Sub);
    let parts = matched.parts.iter().zip(&tree.nodes.kind);
    let mut outlined: Vec<ShapeId> = parts
        .filter(|(_, kind)| is_built(kind))
        .map(|(part, _)| part.shape)
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
