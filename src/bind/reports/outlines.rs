//! Reports strokes that are not built unless the drawing asks for them: outlines of filled shapes, and lines beside all shapes.

use rustc_hash::FxHashSet;

use crate::bind::hierarchy::Tree;
use crate::bind::matching::{Matched, Strokes};
use crate::diagnostic::{Code, Diagnostic, listed};
use crate::svg::{Drawing, Shape, ShapeId};

/// One warning about all filled shapes whose outlines are left out, unless a string says what happens to strokes.
pub(super) fn report(
    drawing: &Drawing,
    matched: &Matched,
    tree: &Tree,
    diagnostics: &mut Vec<Diagnostic>,
) {
    if matched.settings.strokes != Strokes::Ink {
        return;
    }
    let parts = matched.parts.iter().zip(&tree.nodes.kind);
    let mut outlined: Vec<ShapeId> = parts
        .filter(|(_, kind)| kind.is_solid())
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

/// One hint about all lines that are left out, unless a string says what happens to strokes.
pub(super) fn lines(drawing: &Drawing, matched: &Matched, diagnostics: &mut Vec<Diagnostic>) {
    // Without any part it is an error that nothing is built.
    if matched.settings.strokes != Strokes::Ink || matched.parts.is_empty() {
        return;
    }
    let built: FxHashSet<ShapeId> = matched.parts.iter().map(|part| part.shape).collect();
    let is_left_out = |shape: &ShapeId| {
        let Shape {
            outline,
            stroke,
            group,
            ..
        } = &drawing.shapes[*shape];
        let is_line = stroke.iter().any(|stroke| !drawing.is_hairline(stroke));
        is_line
            && outline.polygons.is_empty()
            && !built.contains(shape)
            && !matched.leaders.leads(*shape)
            && matched.layers.with_content(*group).is_none()
    };
    let lines: Vec<ShapeId> = drawing.shapes.keys().filter(is_left_out).collect();
    let Some(first) = lines.first() else {
        return;
    };
    let names = listed(lines.iter().map(|shape| drawing.describe(*shape)));
    let message = match lines.len() {
        1 => format!(
            "{names} is taken for a guide and not built: it neither lies on a shape nor begins on one"
        ),
        count => format!(
            "{count} lines are taken for guides and not built: they neither lie on a shape nor begin on one: {names}"
        ),
    };
    diagnostics.push(
        Diagnostic::new(Code::LinesLeftOut, drawing.shapes[*first].element.span, message).help(
            "write a text `%Strokes lines` anywhere on the page to build lines, or `%Strokes none` to do without",
        ),
    );
}
