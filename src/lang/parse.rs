//! From a string as it is written to its syntax tree.
//!
//! Nothing stops the parser: after a slip it goes on at the next keyword, the next word that is
//! nearly a keyword, or the next sign, so that one slip costs one diagnostic and all else counts.
//! It takes time linear in the string's length.

mod arguments;
mod attributes;
mod expression;
mod lexical;
mod names;
pub(in crate::lang) mod slips;

pub use lexical::in_word;

use std::ops::Range;

use super::ast::{Annotation, Part};
use super::folded::Folded;
use crate::diagnostic::{Code, Diagnostic, Edit, Fix};
use crate::source::{Span, Text};

/// Where a string stands.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Place {
    /// In a `<text>` element.
    Text,
    /// In the `<desc>` of a shape or a group, to which it is bound.
    Desc,
}

/// Reads a string.
pub fn parse(text: &Text, place: Place) -> (Annotation, Vec<Diagnostic>) {
    let folded = Folded::new(text.as_str());
    let mut parser = Parser {
        text,
        folded: &folded,
        at: 0,
        sign_reported: false,
        diagnostics: vec![],
    };
    let annotation = parser.annotation(place);
    let mut diagnostics = parser.diagnostics;
    if !matches!(annotation, Annotation::Caption | Annotation::Empty) {
        diagnostics.extend(full_width(text, &folded));
    }
    super::keep_safe_fixes(text, &mut diagnostics);
    (annotation, diagnostics)
}

/// Whether `text` looks like a string, which makes its drawing an annotated one: it starts with one
/// of `% $ * @`, or has the form `Name@…` or `Name$…`.
pub fn looks_like_string(text: &str) -> bool {
    let folded = Folded::new(text);
    let text = folded.as_str().trim_start();
    if text.starts_with(['%', '$', '*', '@']) {
        return true;
    }
    if text.starts_with(['#', '^']) {
        return false;
    }
    let behind_name = match lexical::quoted(text) {
        Ok((rest, _)) => rest,
        Err(_) => text.trim_start_matches(in_name),
    };
    behind_name.len() < text.len() && behind_name.starts_with(['@', '$'])
}

/// Whether a name without quotes may have `c`.
pub fn in_name(c: char) -> bool {
    !c.is_whitespace() && !matches!(c, '@' | '$' | '"' | '(' | ')')
}

/// A place in the folded string, and what was found so far.
struct Parser<'a> {
    text: &'a Text,
    folded: &'a Folded<'a>,
    at: usize,
    /// Whether a sign where none can stand was reported: those behind it are of the same slip.
    sign_reported: bool,
    diagnostics: Vec<Diagnostic>,
}

impl<'a> Parser<'a> {
    fn annotation(&mut self, place: Place) -> Annotation {
        self.skip_blank();
        let Some(sign) = self.peek() else {
            return Annotation::Empty;
        };
        match sign {
            '#' => Annotation::Comment,
            '*' => Annotation::Unused,
            '%' => {
                self.at += 1;
                Annotation::Defaults(self.attributes())
            }
            '$' => {
                let sign = self.range(self.at..self.at + 1);
                self.at += 1;
                let attributes = self.attributes();
                match place {
                    Place::Text => Annotation::Legend(attributes),
                    Place::Desc => Annotation::Part(Part {
                        attributes,
                        signs: vec![sign],
                        ..Part::default()
                    }),
                }
            }
            '^' => self.feature(),
            _ => self.part(place),
        }
    }

    /// What is still to be read.
    fn rest(&self) -> &'a str {
        &self.folded.as_str()[self.at..]
    }

    fn peek(&self) -> Option<char> {
        self.rest().chars().next()
    }

    fn skip_blank(&mut self) {
        if let Ok((rest, _)) = lexical::blank(self.rest()) {
            self.move_to(rest);
        }
    }

    /// Goes on at `rest`, a tail of the string.
    fn move_to(&mut self, rest: &str) {
        self.at = self.folded.as_str().len() - rest.len();
    }

    /// Where the folded characters `range` stand in the decoded string.
    fn range(&self, range: Range<usize>) -> Range<usize> {
        self.folded.original(range)
    }

    /// Where the folded characters `range` stand in the drawing.
    fn span(&self, range: Range<usize>) -> Span {
        self.text.span(self.range(range))
    }

    /// `written`, escaped to take the place of the folded characters from `offset` on.
    fn escape(&self, offset: usize, written: &str) -> String {
        self.text
            .escape_at(self.range(offset..offset).start, written)
    }

    fn report(&mut self, diagnostic: Diagnostic) {
        self.diagnostics.push(diagnostic);
    }
}

/// The hint that full-width signs were read as ASCII.
fn full_width(text: &Text, folded: &Folded<'_>) -> Option<Diagnostic> {
    let folds = folded.folds();
    let (first, last) = (folds.first()?, folds.last()?);
    let span = text.span(first.0.start..last.0.end);
    let edits = folds
        .iter()
        .map(|(range, ascii)| Edit {
            span: text.span(range.clone()),
            text: text.escape_at(range.start, ascii),
        })
        .collect();
    let sign = folds.iter().find(|(_, ascii)| !ascii.trim().is_empty());
    let message = match sign {
        Some((range, ascii)) => format!(
            "`{}` is read as `{}`",
            names::shorten(&text.as_str()[range.clone()]),
            names::shorten(ascii)
        ),
        None => "a special space is read as a plain one".to_owned(),
    };
    let mut hint = Diagnostic::new(Code::FullWidth, span, message)
        .label("full-width signs")
        .help("switch the input method to half-width, or apply the fix");
    hint.fixes.push(Fix {
        title: "Write full-width signs as ASCII".to_owned(),
        edits,
    });
    Some(hint)
}
