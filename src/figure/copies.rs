//! Reports copies (`-s`, `-d`) that coincide with their original or with another copy of it.

use rayon::prelude::*;
use typed_index_collections::TiSlice;

use super::FigureContext;
use crate::bind::{PartId, PartKind};
use crate::diagnostic::{Code, Diagnostic};
use crate::index::par_keys;
use crate::threads::GRAIN;

/// Limit of the ancestors that are checked: each `-d` among them doubles the parts below it.
const MAX_ANCESTORS: usize = 64;

/// Warns of copies that coincide.
pub(super) fn check(context: &FigureContext<'_>, diagnostics: &mut Vec<Diagnostic>) {
    let parts = par_keys(&context.bindings.parts).with_min_len(GRAIN);
    let doubled: Vec<bool> = parts
        .clone()
        .map(|part| context.bindings.attributes(part).shape().doubled)
        .collect();
    let doubled = TiSlice::from_ref(&doubled);
    let copied = doubled.contains(&true);
    let found: Vec<Diagnostic> = parts
        // Copies of ink coincide where those of its part do.
        .filter(|part| context.bindings.form(*part) == *part)
        .filter_map(|part| {
            let own = coincident(context, part);
            own.or_else(|| copied.then(|| inherited(context, part, doubled))?)
        })
        .collect();
    diagnostics.extend(found);
}

/// The least and the greatest depth of a part's solid in its parent's frame; `None` without a solid.
fn depths(context: &FigureContext<'_>, part: PartId) -> Option<[f64; 2]> {
    let built = matches!(
        context.bindings.parts[part].kind,
        PartKind::Main | PartKind::Sub
    );
    if built {
        Some(context.thickness(part, context.offset(part))?.depths)
    } else {
        None
    }
}

/// Whether a solid reaches equally far to both sides of a plane.
fn is_symmetric([low, high]: [f64; 2], plane: f64) -> bool {
    (low + high - 2.0 * plane).abs() <= 1e-9 * (high - low).abs().max(1e-12)
}

/// A copy that the part's own flag makes.
fn coincident(context: &FigureContext<'_>, part: PartId) -> Option<Diagnostic> {
    let shape = context.bindings.attributes(part).shape();
    if !(shape.mirrored || shape.doubled) || !is_symmetric(depths(context, part)?, 0.0) {
        return None;
    }
    let flag = if shape.doubled { "-d" } else { "-s" };
    let name = context.bindings.describe(context.drawing, part);
    let message =
        format!("the copy that `{flag}` makes of {name} is in exactly the same place as {name}");
    Some(coincidence(context, part, message))
}

/// A copy that an ancestor's `-d` makes.
fn inherited(
    context: &FigureContext<'_>,
    part: PartId,
    doubled: &TiSlice<PartId, bool>,
) -> Option<Diagnostic> {
    let parts = &context.bindings.parts;
    let main = parts[part].main;
    let shape = context.bindings.attributes(part).shape();
    let depths = depths(context, part)?;
    // From the node that the part hangs on to the plane that an ancestor is mirrored in.
    let mut plane = 0.0;
    // A sub-part hangs on its main part's node.
    let mut next = if main == part {
        parts[part].parent
    } else {
        Some(main)
    };
    for _ in 0..MAX_ANCESTORS {
        let ancestor = next?;
        plane -= context.node_offset(ancestor);
        let both = shape.mirrored || shape.doubled;
        let symmetric = if both {
            plane.abs() <= 1e-9 * (depths[1] - depths[0]).abs().max(1e-12)
        } else {
            is_symmetric(depths, plane)
        };
        if doubled[ancestor] && symmetric {
            let name = context.bindings.describe(context.drawing, part);
            let other = context.bindings.describe(context.drawing, ancestor);
            let message = format!(
                "copies of {name} that `-d` on {other} makes are in exactly the same place as {name}"
            );
            return Some(coincidence(context, part, message));
        }
        next = parts[ancestor].parent;
    }
    None
}

fn coincidence(context: &FigureContext<'_>, part: PartId, message: String) -> Diagnostic {
    let bindings = context.bindings;
    let shape = bindings.attributes(part).shape_if_set();
    let element = &context.drawing.shapes[bindings.parts[part].shape].element;
    let span = shape.map_or(element.span, |shape| bindings.span_of(&shape.source));
    Diagnostic::new(Code::CopiesCoincide, span, message).help(
        "move the two sides apart with `Offset`, or give depths on one side only, as in `default 45 50`",
    )
}
