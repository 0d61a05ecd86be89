//! Parses a string into its syntax tree.
//!
//! The parser recovers from errors: it continues at the next keyword, the next misspelled keyword, or
//! the next sign. One mistake gives one diagnostic, and the rest of the string still counts. Parsing
//! takes time linear in the string's length.

mod arguments;
mod attributes;
mod expression;
mod lexical;
mod names;
pub(in crate::lang) mod suggestions;

pub use lexical::is_word_char;

use std::ops::Range;

use super::ast::{Annotation, Part};
use super::normalize::Normalized;
use crate::diagnostic::{Code, Diagnostic, Edit, Fix};
use crate::source::{Span, Text};

/// The element that contains a string.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Container {
    /// A `<text>` element.
    Text,
    /// The `<desc>` of a shape or a group, which the string is bound to.
    Desc,
}

/// Parses a string.
pub fn parse(text: &Text, container: Container) -> (Annotation, Vec<Diagnostic>) {
    let normalized = Normalized::new(text.as_str());
    let mut parser = Parser {
        text,
        normalized: &normalized,
        at: 0,
        sign_reported: false,
        diagnostics: vec![],
    };
    let annotation = parser.annotation(container);
    let mut diagnostics = parser.diagnostics;
    if !matches!(annotation, Annotation::Caption | Annotation::Empty) {
        diagnostics.extend(full_width(text, &normalized));
    }
    super::keep_safe_fixes(text, &mut diagnostics);
    (annotation, diagnostics)
}

/// Whether `text` looks like a string, so that its drawing counts as annotated: it starts with one
/// of `% $ * @`, or has the form `Name@…` or `Name$…`.
pub fn looks_like_string(text: &str) -> bool {
    let normalized = Normalized::new(text);
    let text = normalized.as_str().trim_start();
    if text.starts_with(['%', '$', '*', '@']) {
        return true;
    }
    if text.starts_with(['#', '^']) {
        return false;
    }
    let after_name = match lexical::quoted(text) {
        Ok((rest, _)) => rest,
        Err(_) => text.trim_start_matches(is_name_char),
    };
    after_name.len() < text.len() && after_name.starts_with(['@', '$'])
}

/// Whether a name without quotes may contain `c`.
pub fn is_name_char(c: char) -> bool {
    !c.is_whitespace() && !matches!(c, '@' | '$' | '"' | '(' | ')')
}

/// The position in the normalized string, and the diagnostics so far.
struct Parser<'a> {
    text: &'a Text,
    normalized: &'a Normalized<'a>,
    at: usize,
    /// Whether a misplaced sign was reported. Signs after it belong to the same mistake.
    sign_reported: bool,
    diagnostics: Vec<Diagnostic>,
}

impl<'a> Parser<'a> {
    fn annotation(&mut self, container: Container) -> Annotation {
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
                match container {
                    Container::Text => Annotation::Legend(attributes),
                    Container::Desc => Annotation::Part(Part {
                        attributes,
                        signs: vec![sign],
                        ..Part::default()
                    }),
                }
            }
            '^' => self.feature(),
            _ => self.part(container),
        }
    }

    /// The unread rest of the string.
    fn rest(&self) -> &'a str {
        &self.normalized.as_str()[self.at..]
    }

    fn peek(&self) -> Option<char> {
        self.rest().chars().next()
    }

    fn skip_blank(&mut self) {
        if let Ok((rest, _)) = lexical::blank(self.rest()) {
            self.move_to(rest);
        }
    }

    /// Continues at `rest`, a tail of the string.
    fn move_to(&mut self, rest: &str) {
        self.at = self.normalized.as_str().len() - rest.len();
    }

    /// The range in the decoded string of a range in the normalized string.
    fn range(&self, range: Range<usize>) -> Range<usize> {
        self.normalized.original(range)
    }

    /// The span in the drawing of a range in the normalized string.
    fn span(&self, range: Range<usize>) -> Span {
        self.text.span(self.range(range))
    }

    /// `written`, escaped for insertion at `offset` of the normalized string.
    fn escape(&self, offset: usize, written: &str) -> String {
        self.text
            .escape_at(self.range(offset..offset).start, written)
    }

    fn report(&mut self, diagnostic: Diagnostic) {
        self.diagnostics.push(diagnostic);
    }
}

/// The hint that full-width characters were read as ASCII.
fn full_width(text: &Text, normalized: &Normalized<'_>) -> Option<Diagnostic> {
    let replacements = normalized.replacements();
    let (first, last) = (replacements.first()?, replacements.last()?);
    let span = text.span(first.0.start..last.0.end);
    let edits = replacements
        .iter()
        .map(|(range, ascii)| Edit {
            span: text.span(range.clone()),
            text: text.escape_at(range.start, ascii),
        })
        .collect();
    let visible = replacements
        .iter()
        .find(|(_, ascii)| !ascii.trim().is_empty());
    let message = match visible {
        Some((range, ascii)) => format!(
            "`{}` is read as `{}`",
            names::shorten(&text.as_str()[range.clone()]),
            names::shorten(ascii)
        ),
        None => "a special space is read as a plain one".to_owned(),
    };
    let mut hint = Diagnostic::new(Code::FullWidth, span, message)
        .label("full-width characters")
        .help("switch the input method to half-width, or apply the fix");
    hint.fixes.push(Fix {
        title: "Write full-width characters as ASCII".to_owned(),
        edits,
    });
    Some(hint)
}
