//! What an editor asks about a drawing, in plain terms: byte places, texts, edits.
//!
//! Everything here reads an [`Analysis`], a drawing with what the compiler found in it, and is a pure function of it.
//! Hover, definition, highlight and the rest go through one query, [`Analysis::at`]; names and variables
//! through [`Symbol`]. No module here knows of any protocol.

mod actions;
mod at;
mod colours;
mod completion;
mod folding;
mod format;
mod goto;
mod hover;
mod inlay;
mod quoting;
mod rename;
mod selection;
mod signature;
mod symbols;
mod tokens;
mod typed;
mod uses;

pub use actions::Action;
pub use at::{At, Item, Token};
pub use colours::Swatch;
pub use completion::{Completion, Context, Proposal, ProposalKind, completion};
pub use goto::Target;
pub use hover::Hover;
pub use inlay::{Inlay, InlayPiece};
pub use rename::RenameError;
pub use signature::{Signature, SignatureHelp, signature};
pub use symbols::Outline;
pub use tokens::{Colouring, Paint};
pub use uses::{Symbol, Use};

use std::sync::Arc;

use crate::bind::{PartKind, Sheet};
use crate::compile::Compiled;
use crate::diagnostic::Diagnostic;
use crate::source::Span;
use crate::svg::Drawing;

/// A drawing and what the compiler found in it.
#[derive(Debug)]
pub struct Analysis {
    source: Arc<str>,
    compiled: Compiled,
}

impl Analysis {
    /// Puts a drawing's text and its compilation together.
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

    /// What the compiler made of it.
    pub fn compiled(&self) -> &Compiled {
        &self.compiled
    }

    /// What is wrong with the drawing.
    pub fn diagnostics(&self) -> &[Diagnostic] {
        &self.compiled.diagnostics
    }

    /// Whether the text could be read as a drawing at all.
    pub fn is_sound(&self) -> bool {
        !self.compiled.drawing.groups.is_empty()
    }

    /// Whether the drawing has strings, or its text, if it cannot be read, looks as if it had: of other drawings
    /// editors show nothing.
    pub fn is_annotated(&self) -> bool {
        match self.is_sound() {
            true => self.sheet().annotated,
            false => typed::looks_annotated(&self.source),
        }
    }

    fn sheet(&self) -> &Sheet {
        &self.compiled.sheet
    }

    fn drawing(&self) -> &Drawing {
        &self.compiled.drawing
    }

    /// The main part of a name; of several the hindmost.
    fn part_named(&self, name: &str) -> Option<usize> {
        let named = |part: &crate::bind::Part| part.kind == PartKind::Main && part.name == name;
        self.sheet().parts.iter().position(named)
    }

    /// Where a part is named: in its string, or at its shape's tag.
    fn place_of_part(&self, part: usize) -> Span {
        let sheet = self.sheet();
        let part = &sheet.parts[part];
        match part.string {
            Some(string) => self.place_of_string(string),
            None => self.drawing().shapes[part.shape].element.span,
        }
    }

    /// Where a string says whom it is about: its name, or all of it.
    fn place_of_string(&self, string: usize) -> Span {
        let string = &self.sheet().strings[string];
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
        self.sheet().variables.get(name).is_some()
            || self
                .sheet()
                .variables
                .iter()
                .any(|(known, _)| known == name)
    }
}

#[cfg(test)]
mod samples {
    use super::*;
    use crate::compile::{Options, compile};
    use crate::resolver::MemoryResolver;

    /// A drawing's analysis, with the place of `¦` in it, which is taken out.
    pub(super) fn analysis(source: &str) -> (Analysis, usize) {
        let at = source.find('¦').unwrap_or(0);
        let source = source.replacen('¦', "", 1);
        let compiled = compile(&source, &Options::default(), &MemoryResolver::default());
        (Analysis::new(source, compiled), at)
    }

    /// A drawing of a body, two arms and a swatch, with these strings beside them: body, right arm, left arm, swatch, and
    /// one for the whole drawing.
    pub(super) fn figure(strings: [&str; 5]) -> String {
        let [body, right, left, swatch, defaults] = strings;
        let text = |x: i32, y: i32, string: &str| match string {
            "" => String::new(),
            string => format!("<text x=\"{x}\" y=\"{y}\" font-size=\"5\">{string}</text>\n"),
        };
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 200 100\">\n\
             <rect id=\"body\" x=\"80\" y=\"20\" width=\"40\" height=\"60\" fill=\"#336699\"/>\n\
             <rect id=\"right\" x=\"20\" y=\"40\" width=\"60\" height=\"10\" fill=\"#ffcc99\"/>\n\
             <rect id=\"left\" x=\"120\" y=\"40\" width=\"60\" height=\"10\" fill=\"#ffcc99\"/>\n\
             <rect id=\"swatch\" x=\"2\" y=\"2\" width=\"5\" height=\"5\" fill=\"#ffcc99\"/>\n\
             {}{}{}{}{}</svg>\n",
            text(100, 54, body),
            text(50, 49, right),
            text(150, 49, left),
            text(5, 8, swatch),
            text(150, 95, defaults),
        )
    }
}
