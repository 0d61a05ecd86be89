//! The answers to an editor's requests about a drawing, in plain terms: byte offsets, texts, edits.
//!
//! Everything here is a pure function of an [`Analysis`], a drawing with what the compiler found in it.
//! Hover, definition, highlights and the rest use one query, [`Analysis::at`]; names and variables
//! use [`Symbol`]. No module here knows any protocol.

mod actions;
mod at;
mod colors;
mod completion;
#[cfg(test)]
mod fixtures;
mod folding;
mod format;
mod goto;
mod hover;
mod inlay;
mod letters;
mod motion;
mod pairing;
mod performances;
mod problems;
mod regions;
mod rename;
mod selection;
mod signature;
mod symbols;
mod tiles;
mod tokens;
mod typed;
mod uses;

pub use at::Item;
pub use colors::Swatch;
pub use completion::{Context, Proposal, ProposalKind, completion};
pub use goto::Target;
pub use inlay::Inlay;
pub(crate) use letters::has_letters;
pub use rename::RenameError;
pub use signature::{SignatureHelp, signature};
pub use symbols::Outline;
pub use tokens::{SemanticToken, TokenClass};
pub use uses::{Symbol, Use};

use std::sync::Arc;

use crate::bind::{Bindings, PartKind, StringId};
use crate::compile::Compiled;
use crate::diagnostic::Diagnostic;
use crate::source::Span;
use crate::svg::Drawing;

/// A drawing with its compilation.
#[derive(Debug)]
pub struct Analysis {
    source: Arc<str>,
    compiled: Compiled,
}

impl Analysis {
    /// Combines a drawing's text and its compilation.
    pub fn new(source: impl Into<Arc<str>>, compiled: Compiled) -> Self {
        Self {
            source: source.into(),
            compiled,
        }
    }

    /// The drawing's text.
    pub fn source(&self) -> &Arc<str> {
        &self.source
    }

    /// Its compilation.
    pub fn compiled(&self) -> &Compiled {
        &self.compiled
    }

    /// The diagnostics of the drawing.
    pub fn diagnostics(&self) -> &[Diagnostic] {
        &self.compiled.diagnostics
    }

    /// Whether the text is well-formed and could be read as a drawing.
    pub fn is_sound(&self) -> bool {
        !self.compiled.drawing.groups.is_empty()
    }

    /// Whether the drawing has strings, or, if it cannot be read, its text seems to have some: for other drawings
    /// editors show nothing, unless compiling crashed.
    pub fn is_annotated(&self) -> bool {
        if self.is_sound() {
            self.bindings().annotated
        } else {
            self.compiled.has_crashed() || typed::looks_annotated(&self.source)
        }
    }

    fn bindings(&self) -> &Bindings {
        &self.compiled.bindings
    }

    fn drawing(&self) -> &Drawing {
        &self.compiled.drawing
    }

    /// The main part with a name; the back-most if there are several.
    fn part_named(&self, name: &str) -> Option<usize> {
        let named = |part: &crate::bind::Part| part.kind == PartKind::Main && part.name == name;
        self.bindings().parts.iter().position(named)
    }

    /// The span that names a part: in its string, or the tag of its shape or group.
    fn span_of_part(&self, part: usize) -> Span {
        let bindings = self.bindings();
        let naming = bindings.naming_element(self.drawing(), part);
        let part = &bindings.parts[part];
        match part.string {
            Some(string) => self.span_of_string(string),
            None => naming.map_or(self.drawing().shapes[part.shape].element.span, |element| {
                element.span
            }),
        }
    }

    /// The span that names a string's part: the name, or the whole string.
    fn span_of_string(&self, string: StringId) -> Span {
        let string = &self.bindings().strings[string];
        let name = at::tokens(string)
            .into_iter()
            .find(|token| token.item == Item::Name);
        match name {
            Some(name) => string.text.span(name.range),
            None => string.text.whole(),
        }
    }

    /// Whether a variable of this name is defined.
    fn is_variable(&self, name: &str) -> bool {
        self.bindings().variables.get(name).is_some()
            || self
                .bindings()
                .variables
                .iter()
                .any(|(known, _)| known == name)
    }
}
