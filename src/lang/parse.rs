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
mod several;
pub(in crate::lang) mod suggestions;

pub use lexical::is_word_char;
pub use several::strings_in;

use std::ops::Range;

use super::ast::{Annotation, Part};
use super::keyword::Keyword;
use super::normalize::Normalized;
use crate::diagnostic::{Code, Diagnostic, Edit, Fix, nearest_word};
use crate::source::{Span, Text};

/// Shorter keywords are too near to other words to be meant by one of these alone.
const DISTINCT: usize = 5;

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

/// Whether `text` makes its drawing an annotated one: `%` or `$` with a keyword, which may be misspelled, or the form `Name@…`
/// or `Name$…`. What only begins with a sign, as on keypads, price tags and in templates, does not: in drawings without
/// strings, such texts are art.
pub fn annotates(text: &str) -> bool {
    let normalized = Normalized::new(text);
    let trimmed = normalized.as_str().trim_start();
    match trimmed.strip_prefix(['%', '$']) {
        Some(attributes) => starts_with_near_keyword(attributes),
        None if trimmed.starts_with(['*', '@']) => trimmed
            .split_once('$')
            .is_some_and(|(_, attributes)| starts_with_keyword(attributes)),
        None => looks_like_string(text),
    }
}

/// Whether a keyword, which may be misspelled, follows a sign of `text`, or nothing follows its `$` or `@`, as while it is typed: hardly
/// anybody writes that by chance.
pub fn says_keyword(text: &str) -> bool {
    let normalized = Normalized::new(text);
    let text = normalized.as_str().trim_start();
    let attributes = match text.strip_prefix('%') {
        Some(defaults) => Some(defaults),
        None => text.split_once('$').map(|(_, attributes)| attributes),
    };
    let is_bare = text.len() > 1 && text.trim_end().ends_with(['$', '@']);
    is_bare || attributes.is_some_and(starts_with_near_keyword)
}

/// Whether a description is a string: what [annotates] a drawing, a `*`, or the parent of a part without a name, which nobody
/// describes a shape with by chance.
pub fn describes(text: &str) -> bool {
    let normalized = Normalized::new(text);
    annotates(text) || normalized.as_str().trim_start().starts_with(['*', '@'])
}

/// Whether `text` looks like a string in an annotated drawing: it starts with one
/// of `% $ * @`, or has the form `Name@…` or `Name$…`. White space before `$` counts if a keyword follows, white space
/// around `@` if a name follows: `costs $5` and `see you @ 5 pm` are captions.
pub fn looks_like_string(text: &str) -> bool {
    let normalized = Normalized::new(text);
    let text = normalized.as_str().trim_start();
    if text.starts_with(['%', '$', '*', '@']) {
        return true;
    }
    if text.starts_with(['#', '^']) {
        return false;
    }
    // Several words before `$` are a name without its quotes.
    let attributes = text.split_once('$').map(|(_, attributes)| attributes);
    if attributes
        .is_some_and(|text| text.starts_with(char::is_alphabetic) && starts_with_keyword(text))
    {
        return true;
    }
    let after_name = match lexical::quoted(text) {
        Ok((rest, _)) => rest,
        Err(_) => text.trim_start_matches(is_name_char),
    };
    if after_name.len() == text.len() {
        return false;
    }
    if after_name.starts_with(['@', '$']) {
        return true;
    }
    let mut rest = after_name.trim_start().chars();
    match rest.next() {
        Some('@') => names_a_parent(rest.as_str()),
        Some('$') => starts_with_keyword(rest.as_str()),
        _ => false,
    }
}

/// Whether the text after `@` is a name, and the string ends or its attributes begin after it.
fn names_a_parent(text: &str) -> bool {
    let text = text.trim_start();
    let rest = match lexical::quoted(text) {
        Ok((rest, _)) => rest,
        Err(_) if !text.starts_with(char::is_alphabetic) => return false,
        Err(_) => text.trim_start_matches(is_name_char),
    };
    let rest = rest.trim_start();
    rest.is_empty() || rest.starts_with('$')
}

/// Whether a text starts with a keyword, or with what could be a misspelled one and its arguments, if it takes any; it may have
/// another sign before it.
fn starts_with_near_keyword(text: &str) -> bool {
    let text = text.trim_start_matches(|c: char| c.is_whitespace() || matches!(c, '%' | '$'));
    let Ok((rest, word)) = lexical::word(text) else {
        return false;
    };
    // `%name%`, `${name}` and `$name` are fields of templates.
    if rest.starts_with(['%', '$', '}']) {
        return false;
    }
    let is_alone = rest.trim().is_empty();
    let stands_alone = |keyword: &Keyword| {
        keyword.name().len() >= DISTINCT && keyword.row().forms.iter().any(|form| form.accepts(0))
    };
    let keywords = Keyword::ALL.iter();
    let keywords = keywords.filter(|keyword| !is_alone || stands_alone(keyword));
    let is_capital = word.starts_with(char::is_uppercase);
    Keyword::from_name(word).is_some()
        || is_capital && nearest_word(word, keywords.map(|keyword| keyword.name())).is_some()
}

/// Whether what follows a sign is a price or another number: `$5.99`, `% 20`.
fn is_amount(text: &str) -> bool {
    let digits = text.trim_start().trim_start_matches(['-', '+', '.', ',']);
    digits.starts_with(|c: char| c.is_ascii_digit())
}

/// Whether a text starts with a keyword.
fn starts_with_keyword(text: &str) -> bool {
    let word = lexical::word(text.trim_start());
    word.is_ok_and(|(_, word)| Keyword::from_name(word).is_some())
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
            '%' | '$' | '@' if container == Container::Text && is_amount(&self.rest()[1..]) => {
                Annotation::Caption
            }
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
        safe: true,
    });
    Some(hint)
}
