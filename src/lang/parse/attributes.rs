//! Attributes: a keyword, its flags, its arguments.

use super::{Parser, lexical, slips};
use crate::diagnostic::{Code, Diagnostic};
use crate::lang::ast::{ArgumentKind, Attribute};
use crate::lang::keyword::signature::Takes;
use crate::lang::keyword::{Keyword, kinds, words};

impl Parser<'_> {
    /// Reads attributes to the end of the string.
    pub(super) fn attributes(&mut self) -> Vec<Attribute> {
        let mut attributes: Vec<Attribute> = vec![];
        loop {
            self.skip_blank();
            let rest = self.rest();
            if rest.is_empty() {
                return attributes;
            }
            if starts_sign(rest) {
                self.disown_name(attributes.last_mut());
                self.unexpected_sign();
            } else if let Some((keyword, length)) = keyword_at(rest) {
                let attribute = self.attribute(keyword, length);
                attributes.push(attribute);
            } else {
                self.no_keyword();
            }
        }
    }

    fn attribute(&mut self, keyword: Keyword, length: usize) -> Attribute {
        let start = self.at;
        self.at += length;
        let keyword_range = self.range(start..self.at);
        let mut end = self.at;
        let mut flags = vec![];
        if !takes_axes(keyword) {
            loop {
                self.skip_blank();
                let Ok((rest, letters)) = lexical::flags(self.rest()) else {
                    break;
                };
                for (index, letter) in letters.char_indices() {
                    let at = self.at + 1 + index;
                    flags.push((letter, self.range(at..at + 1)));
                }
                self.move_to(rest);
                end = self.at;
            }
        }
        let mut arguments = vec![];
        loop {
            self.skip_blank();
            let rest = self.rest();
            if rest.is_empty() || starts_sign(rest) || keyword_at(rest).is_some() {
                break;
            }
            let argument = self.argument(keyword, &flags, &arguments);
            arguments.push(argument);
            end = self.at;
        }
        Attribute {
            keyword,
            keyword_range,
            flags,
            arguments,
            range: self.range(start..end.max(start + length)),
        }
    }

    /// Something stands where a keyword is due: says so and goes on at the next attribute.
    fn no_keyword(&mut self) {
        let rest = self.rest();
        let length = match lexical::run(rest) {
            0 => rest.chars().next().map_or(0, char::len_utf8),
            length => length,
        };
        let found = &rest[..length];
        let range = self.range(self.at..self.at + length);
        let diagnostic = slips::no_keyword(self.text, range, found);
        self.report(diagnostic);
        self.at += match found {
            // What stands in quotes or parentheses is skipped with them.
            "\"" | "(" => 0,
            _ => length,
        };
        self.skip_to_attribute(found.starts_with(char::is_lowercase));
    }

    /// Goes to the next keyword, word that is nearly one, or sign. Words in parentheses and quotes
    /// do not count, and lower-case words only where the string is written in lower case.
    pub(super) fn skip_to_attribute(&mut self, lower_case: bool) {
        let mut depth = 0_usize;
        loop {
            self.skip_blank();
            let rest = self.rest();
            let Some(c) = rest.chars().next() else {
                return;
            };
            if starts_sign(rest) || keyword_at(rest).is_some() {
                return;
            }
            if let Ok((behind, _)) = lexical::quoted(rest) {
                self.move_to(behind);
                continue;
            }
            match c {
                '(' => depth += 1,
                ')' => depth = depth.saturating_sub(1),
                _ => {}
            }
            let run = lexical::run(rest);
            if run > 0 && depth == 0 && slips::is_nearly_keyword(&rest[..run], lower_case) {
                return;
            }
            self.at += run.max(c.len_utf8());
        }
    }

    /// Reports the sign that comes next, once a string, and goes on behind it and the name it brings.
    pub(super) fn unexpected_sign(&mut self) {
        let at = self.at;
        let rest = self.rest();
        let Some(sign) = rest.chars().next() else {
            return;
        };
        self.at += sign.len_utf8();
        if !self.sign_reported {
            self.sign_reported = true;
            let span = self.span(at..self.at);
            let diagnostic = Diagnostic::new(
                Code::UnexpectedSign,
                span,
                format!("`{sign}` cannot stand here"),
            );
            let doubled = self.folded.as_str()[..at].ends_with(sign);
            let diagnostic = match doubled {
                true => diagnostic.label("the sign is typed twice").fix(
                    "Delete the second sign",
                    span,
                    "",
                ),
                false => diagnostic.label("a new string seems to begin here").help(
                    "two strings seem to have been typed into one text: cut the second one out and \
                     give it a text of its own",
                ),
            };
            self.report(diagnostic);
        }
        if matches!(sign, '@' | '*' | '^') {
            self.skip_blank();
            match lexical::quoted(self.rest()) {
                Ok((behind, _)) => self.move_to(behind),
                Err(_) => self.at += lexical::run(self.rest()),
            }
        }
    }

    /// In `Shape round Larm@Body` the word before the sign is the name of another string's part.
    fn disown_name(&self, attribute: Option<&mut Attribute>) {
        let Some(attribute) = attribute else { return };
        let sign = self.range(self.at..self.at).start;
        let Some(last) = attribute.arguments.last() else {
            return;
        };
        let ArgumentKind::Word(word) = &last.kind else {
            return;
        };
        let glued = last.range.end == sign;
        if glued && !words::is_known(word) && fits_without_last(attribute) {
            attribute.arguments.pop();
        }
    }
}

/// Whether the number of arguments is still right without the last.
fn fits_without_last(attribute: &Attribute) -> bool {
    let left = attribute.arguments.len().saturating_sub(1);
    let kind = match attribute.arguments.first().map(|first| &first.kind) {
        Some(ArgumentKind::Word(kind)) if attribute.keyword == Keyword::Shape => {
            kinds::from_name(kind)
        }
        _ => None,
    };
    match kind {
        Some(kind) => left >= 1 && kind.form.fits(left - 1),
        None => attribute
            .keyword
            .row()
            .forms
            .iter()
            .any(|form| form.fits(left)),
    }
}

/// The keyword that `rest` begins with, and its length. Flags, a number or a colour may touch it.
fn keyword_at(rest: &str) -> Option<(Keyword, usize)> {
    let run = &rest[..lexical::run(rest)];
    let (behind, word) = lexical::word(run).ok()?;
    (behind.is_empty() || behind.starts_with(['-', '#']))
        .then(|| Keyword::from_name(word))?
        .map(|keyword| (keyword, word.len()))
}

/// Whether `rest` begins with a sign that begins another string.
fn starts_sign(rest: &str) -> bool {
    let mut chars = rest.chars();
    match chars.next() {
        Some('$' | '@' | '%') => true,
        Some('*' | '^') => chars.next().is_some_and(char::is_alphabetic),
        _ => false,
    }
}

fn takes_axes(keyword: Keyword) -> bool {
    let mut parameters = keyword.row().forms.iter().flat_map(|form| form.parameters);
    parameters.any(|parameter| matches!(parameter.takes, Takes::SignedAxis))
}
