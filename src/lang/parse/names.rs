//! The head of a string: names and parents.

use super::{Parser, Place, in_name, lexical};
use crate::diagnostic::{Code, Diagnostic};
use crate::lang::ast::{Annotation, Name, Part};
use crate::lang::keyword::Keyword;

/// What a name names, for messages.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Role {
    Part,
    Parent,
    Feature,
}

impl Parser<'_> {
    /// `^ name`
    pub(super) fn feature(&mut self) -> Annotation {
        let sign = self.at;
        self.at += 1;
        let name = self.name(Role::Feature);
        self.skip_blank();
        if self.peek().is_some() {
            self.unexpected_sign();
        }
        match name {
            Some(name) => Annotation::Feature(name),
            None => {
                self.no_name(sign, "a feature point needs a name behind `^`");
                Annotation::Comment
            }
        }
    }

    /// `name@parent$ …`, or a caption.
    pub(super) fn part(&mut self, place: Place) -> Annotation {
        let start = self.at;
        if self.is_caption() {
            return Annotation::Caption;
        }
        let mut part = Part {
            name: self.name(Role::Part),
            ..Part::default()
        };
        if part.name.is_none() && place == Place::Text {
            self.no_name(start, "this string does not name its part");
        }
        self.skip_blank();
        if self.peek() == Some('@') {
            let sign = self.at;
            self.at += 1;
            part.signs.push(self.range(sign..self.at));
            part.parent = self.name(Role::Parent);
            if part.parent.is_none() {
                self.no_name(sign, "no parent is named behind `@`");
            }
        }
        self.skip_blank();
        while self.peek() == Some('@') {
            self.unexpected_sign();
            self.skip_blank();
        }
        if self.peek() == Some('$') {
            part.signs.push(self.range(self.at..self.at + 1));
            self.at += 1;
        }
        part.attributes = self.attributes();
        Annotation::Part(part)
    }

    /// Whether the string is several words without a sign.
    fn is_caption(&self) -> bool {
        let rest = self.rest().trim_end();
        let mut words = 0;
        let mut in_word = false;
        let mut quoted = false;
        for c in rest.chars() {
            match c {
                '"' => {
                    words += usize::from(!quoted && !in_word);
                    quoted = !quoted;
                    in_word = true;
                }
                _ if quoted => {}
                '@' | '$' => return false,
                c if c.is_whitespace() => in_word = false,
                _ => {
                    words += usize::from(!in_word);
                    in_word = true;
                }
            }
        }
        words > 1 || (words == 1 && !rest.starts_with('"') && !rest.chars().all(in_name))
    }

    /// Reads a name up to the next sign.
    fn name(&mut self, role: Role) -> Option<Name> {
        self.skip_blank();
        let rest = self.rest();
        if let Ok((behind, name)) = lexical::quoted(rest) {
            return self.quoted_name(role, name, rest.len() - behind.len());
        }
        if rest.starts_with('"') {
            return self.unclosed_name();
        }
        let region = rest.split(['@', '$', '"']).next().unwrap_or_default();
        let written = region.trim_end();
        if written.is_empty() {
            return None;
        }
        let first = written.split(|c| !in_name(c)).next().unwrap_or_default();
        if first.len() == written.len() {
            return Some(self.take_name(first, first.len()));
        }
        if role == Role::Parent
            && let Some(name) = self.name_before_keyword(written)
        {
            return Some(name);
        }
        let range = self.at..self.at + written.len();
        let mut diagnostic = Diagnostic::new(
            Code::UnquotedName,
            self.span(range.clone()),
            format!("the name `{}` needs quotes", shorten(written)),
        )
        .label("a name with spaces or parentheses stands in quotes");
        if !written.contains('"') {
            let quoted = format!(
                "\"{}\"",
                written.split_whitespace().collect::<Vec<_>>().join(" ")
            );
            diagnostic = diagnostic.fix(
                "Put the name in quotes",
                self.span(range.clone()),
                self.escape(range.start, &quoted),
            );
        }
        self.report(diagnostic);
        Some(self.take_name(written, written.len()))
    }

    fn quoted_name(&mut self, role: Role, name: &str, length: usize) -> Option<Name> {
        let start = self.at;
        let taken = (!name.trim().is_empty()).then(|| Name {
            text: name.split_whitespace().collect::<Vec<_>>().join(" "),
            range: self.range(start..start + length),
        });
        self.at += length;
        self.skip_blank();
        let rest = self.rest();
        let junk = rest.split(['@', '$']).next().unwrap_or_default().trim_end();
        if junk.is_empty() {
            return taken;
        }
        let word = &junk[..lexical::run(junk)];
        if role != Role::Feature && Keyword::from_name(word).is_some() {
            self.missing_sign(word.len());
            return taken;
        }
        let span = self.span(self.at..self.at + junk.len());
        let diagnostic = Diagnostic::new(
            Code::UnquotedName,
            span,
            format!("`{}` stands behind the quotes of a name", shorten(junk)),
        )
        .label("put all of the name into the quotes");
        self.report(diagnostic);
        self.at += junk.len();
        taken
    }

    /// Reports the quote at `start`, which could be closed at `end`.
    pub(super) fn unclosed_quote(&mut self, start: usize, end: usize) {
        let diagnostic = Diagnostic::new(
            Code::UnclosedQuote,
            self.span(start..start + 1),
            "this quote is never closed",
        )
        .fix(
            "Close the quote",
            self.span(end..end),
            self.escape(end, "\""),
        );
        self.report(diagnostic);
    }

    fn unclosed_name(&mut self) -> Option<Name> {
        let start = self.at;
        let region = self.rest()[1..]
            .split(['@', '$'])
            .next()
            .unwrap_or_default();
        let written = region.trim();
        let end = start + 1 + region.trim_end().len();
        self.unclosed_quote(start, end);
        self.at += 1 + region.len();
        (!written.is_empty()).then(|| Name {
            text: written.to_owned(),
            range: self.range(start..end),
        })
    }

    /// The name in `Ubody Shape roundv`, where somebody forgot `$`.
    fn name_before_keyword(&mut self, written: &str) -> Option<Name> {
        let mut from = 0;
        for word in written.split_whitespace() {
            // Words are found from left to right, so each is searched for behind the last.
            let at = from + written[from..].find(word)?;
            from = at + word.len();
            if at > 0 && Keyword::from_name(word).is_some() {
                let name = written[..at].trim_end();
                if !name.chars().all(in_name) {
                    return None;
                }
                let name = self.take_name(name, name.len());
                self.skip_blank();
                self.missing_sign(word.len());
                return Some(name);
            }
        }
        None
    }

    /// Says that `$` is missing before the keyword of `length` that comes next.
    fn missing_sign(&mut self, length: usize) {
        let at = self.at;
        let word = &self.rest()[..length];
        let diagnostic = Diagnostic::new(
            Code::MissingSign,
            self.span(at..at + length),
            format!("`$` is missing before `{word}`"),
        )
        .label("attributes stand behind `$`")
        .fix("Insert `$`", self.span(at..at), self.escape(at, "$"));
        self.report(diagnostic);
        // A `$` further on belongs to the same slip.
        self.sign_reported = true;
    }

    fn no_name(&mut self, sign: usize, message: &str) {
        let diagnostic = Diagnostic::new(Code::NoName, self.span(sign..sign + 1), message)
            .label("a name is due here")
            .help("write `Name@Parent$ attributes`; a name with spaces stands in quotes");
        self.report(diagnostic);
    }

    fn take_name(&mut self, name: &str, length: usize) -> Name {
        let start = self.at;
        self.at += length;
        Name {
            text: name.split_whitespace().collect::<Vec<_>>().join(" "),
            range: self.range(start..start + length),
        }
    }
}

/// The beginning of `text`, for messages.
pub(super) fn shorten(text: &str) -> String {
    const LONGEST: usize = 40;
    if text.chars().nth(LONGEST).is_none() {
        return text.to_owned();
    }
    let head: String = text.chars().take(LONGEST - 1).collect();
    format!("{head}…")
}
