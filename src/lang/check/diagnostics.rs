//! Diagnostics about a whole attribute.

use std::ops::Range;

use super::{Checker, takes_a_name};
use crate::diagnostic::{Code, Diagnostic};
use crate::lang::ast::Attribute;
use crate::lang::fixed_by_writing;
use crate::lang::keyword::{AttributeString, Keyword};

impl Checker<'_> {
    pub(super) fn diagnostic(
        &self,
        code: Code,
        range: &Range<usize>,
        message: impl Into<String>,
    ) -> Diagnostic {
        Diagnostic::new(code, self.text.span(range.clone()), message)
    }

    pub(super) fn not_allowed(&mut self, attribute: &Attribute, string: AttributeString) {
        let name = attribute.keyword.name();
        let here = match string {
            AttributeString::Part => "in a part string",
            AttributeString::Legend => "in a legend",
            AttributeString::Defaults => "in a `%` string",
        };
        let places = attribute.keyword.row().allowed.places();
        let message = format!("`{name}` is not allowed {here}");
        let diagnostic = self.diagnostic(Code::NotAllowedHere, &attribute.keyword_range, message);
        let help = format!("`{name}` is allowed {places}");
        self.diagnostics.push(diagnostic.help(help));
    }

    pub(super) fn given_twice(&mut self, later: &Attribute, earlier: &Attribute) {
        let name = later.keyword.name();
        let related = self.text.span(earlier.range.clone());
        let message = format!("`{name}` is given twice");
        let diagnostic = self.diagnostic(Code::GivenTwice, &later.keyword_range, message);
        self.diagnostics.push(
            diagnostic
                .label("this one counts")
                .related(related, "this one is ignored")
                .help("delete one of them"),
        );
    }

    pub(super) fn not_built(&mut self, name: &str, range: Range<usize>) {
        let message = format!("`{name}` has no effect in this version");
        self.diagnostics.push(
            Diagnostic::new(Code::NotBuiltYet, self.text.span(range), message)
                .label("read and checked, but not supported yet")
                .help("leave it in for a later version, or delete it"),
        );
    }

    pub(super) fn unknown_flag(
        &mut self,
        attribute: &Attribute,
        letter: char,
        range: Range<usize>,
    ) {
        let name = attribute.keyword.name();
        let flags = attribute.keyword.row().flags;
        let message = format!("`{name}` has no flag `-{letter}`");
        let mut diagnostic = self.diagnostic(Code::UnknownFlag, &range, message);
        let word: String = attribute.flags.iter().map(|(letter, _)| *letter).collect();
        if flags.is_empty() {
            // Directly after a keyword, `-w` is read as flags.
            let all = match (attribute.flags.first(), attribute.flags.last()) {
                (Some((_, first)), Some((_, last))) => first.start.saturating_sub(1)..last.end,
                _ => range,
            };
            let sign = self.text.as_str().get(all.clone());
            if sign.is_some_and(|written| written.starts_with('-')) {
                diagnostic = diagnostic.help(format!(
                    "if `{word}` is a variable, write it in parentheses: `(-{word})`"
                ));
                diagnostic = fixed_by_writing(diagnostic, self.text, &all, &format!("(-{word})"));
            }
        } else {
            let known = flags.iter();
            let known = known.map(|flag| format!("`-{}` {}", flag.letter, flag.summary));
            let known: Vec<_> = known.collect();
            diagnostic = diagnostic.help(format!("its flags are: {}", known.join("; ")));
        }
        self.diagnostics.push(diagnostic);
    }

    /// Reports a keyword that needs arguments and has none.
    pub(super) fn missing_arguments(&mut self, attribute: &Attribute, before: Option<&Attribute>) {
        let name = attribute.keyword.name();
        let usage = attribute.keyword.usages().join("`, or `");
        let range = attribute.keyword_range.clone();
        let span = self.text.span(range.clone());
        let message = format!("`{name}` needs arguments");
        let diagnostic = Diagnostic::new(Code::ArgumentCount, span, message);
        let written = self.text.as_str().get(range.clone()).unwrap_or(name);
        let diagnostic = match before.filter(|before| takes_a_name(before)) {
            Some(before) if before.keyword == Keyword::Let => diagnostic.help(format!(
                "a variable cannot be called `{written}`, because that is a keyword"
            )),
            Some(before) => diagnostic
                .help(format!(
                    "write `{usage}`; if it is a name that belongs to `{}`, put it in quotes",
                    before.keyword.name()
                ))
                .fix(
                    "Put it in quotes",
                    span,
                    self.text.escape_at(range.start, &format!("\"{written}\"")),
                ),
            _ if attribute.keyword == Keyword::Let => diagnostic.help(format!(
                "write `{usage}`; a variable cannot have the name of a keyword"
            )),
            None => diagnostic.help(format!("write `{usage}`")),
        };
        self.diagnostics.push(diagnostic);
    }
}
