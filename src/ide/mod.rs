//! The answers to an editor's requests about a drawing, in plain terms: byte offsets, texts, edits.
//!
//! Everything here is a pure function of an [`Analysis`], a drawing with what the compiler found in it.
//! Hover, definition, the preview's page, highlights and the rest use one query, [`Analysis::at`], whose answer is a [`Subject`];
//! `inspect` lists the same subjects. Names and variables use [`Symbol`]. No module here knows any protocol.

mod actions;
#[cfg(test)]
mod agreement_tests;
mod at;
pub(crate) mod changes;
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
mod strings;
mod subject;
mod symbols;
mod tiles;
mod tokens;
mod typed;
mod uses;

pub(crate) use at::Item;
pub(crate) use colors::Swatch;
pub(crate) use completion::{Context, Proposal, ProposalKind, completion};
pub(crate) use goto::Target;
pub(crate) use inlay::Inlay;
pub(crate) use letters::has_letters;
pub(crate) use rename::RenameError;
pub(crate) use signature::{SignatureHelp, signature};
#[cfg(test)]
pub(crate) use subject::VISITED;
pub(crate) use subject::{Subject, Which};
pub(crate) use symbols::Outline;
pub(crate) use tokens::{SemanticToken, TokenClass};
pub(crate) use uses::{Symbol, Use};

pub(crate) use crate::bind::{FormByName, PartId};

use std::sync::Arc;

use crate::bind::{Bindings, PartKind};
use crate::compile::Compiled;
use crate::diagnostic::Diagnostic;
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
    fn part_named(&self, name: &str) -> Option<PartId> {
        let named = |part: &crate::bind::Part| part.kind == PartKind::Main && part.name == name;
        self.bindings().parts.position(named)
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
