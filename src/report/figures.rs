//! The figures of a drawing, and where they look.

use serde::Serialize;

use crate::compile::Compiled;
use crate::rig::FigureFacing;

/// A figure with limbs.
#[derive(Debug, Clone, Serialize)]
pub(crate) struct Figure<'a> {
    /// The name of its root.
    pub figure: &'a str,
    /// Where it looks, as a word of `Facing`.
    pub facing: &'static str,
    /// Whether a string says so.
    pub by_string: bool,
    /// What speaks for it.
    pub reasons: &'a [String],
    /// What speaks against it.
    pub doubts: &'a [String],
    /// The names of its parts.
    pub parts: Vec<&'a str>,
}

/// The figures of a drawing that have limbs, in drawing order.
pub(crate) fn figures<'a>(compiled: &'a Compiled) -> Vec<Figure<'a>> {
    let parts = &compiled.bindings.parts;
    let figure = |figure: &'a FigureFacing| Figure {
        figure: &parts[figure.root].name,
        facing: figure.found.facing.word(),
        by_string: figure.found.by_string,
        reasons: &figure.found.reasons,
        doubts: &figure.found.doubts,
        parts: figure
            .parts
            .iter()
            .map(|part| parts[*part].name.as_str())
            .collect(),
    };
    compiled.facings.iter().map(figure).collect()
}
