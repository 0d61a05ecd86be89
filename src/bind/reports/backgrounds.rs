//! Backgrounds and shadows on the ground, which are left out.

use crate::bind::matching::Matched;
use crate::diagnostic::{Code, Diagnostic};
use crate::svg::Drawing;

/// Reports the backgrounds that no string names.
pub(super) fn report(drawing: &Drawing, matched: &Matched, diagnostics: &mut Vec<Diagnostic>) {
    for part in &matched.parts {
        if !matched.node_groups.backgrounds[part.shape]
            || part.attributes_from().is_some()
            || part.is_stroke
        {
            continue;
        }
        let element = &drawing.shapes[part.shape].element;
        let what = drawing.describe(part.shape);
        let (message, help) = if matched.node_groups.shadows.contains(&part.shape) {
            (
                format!(
                    "{what} lies flat below all else, so it is taken for a shadow on the ground and left out"
                ),
                "to build it too, write a name on it, such as `Disc`",
            )
        } else {
            (
                format!(
                    "{what} fills the page behind everything else, so it is taken for a background and left out"
                ),
                "to build it too, write a name on it, such as `Wall`",
            )
        };
        diagnostics.push(Diagnostic::new(Code::Background, element.span, message).help(help));
    }
}
