//! The head of a string: its name and its parent's name.

use super::{Container, Parser, is_name_char, lexical};
use crate::diagnostic::{Code, Diagnostic};
use crate::lang::ast::{Annotation, Name, Part};
use crate::lang::keyword::Keyword;

/// What a name refers to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum NameKind {
    Part,
    Parent,
    Feature,
}

impl Parser<'_> {
    /// `^ name`
    pub(super) fn feature(&mut self) -> Annotation {
        let sign = self.at;
        self.at += 1;
        let name = self.name(NameKind::Feature);
        self.skip_blank();
        if self.peek().is_some() {
            self.unexpected_sign();
        }
        match name {
            Some(name) => Annotation::Feature(name),
            None => {
                self.no_name(sign, "a feature point needs a name after `^`");
                Annotation::Comment
            }
        }
    }

    /// `name@parent$ …`, or a caption.
    pub(super) fn part(&mut self, container: Container) -> Annotation {
        let start = self.at;
        if self.is_caption() {
            return Annotation::Caption;
        }
        let mut part = Part {
            name: self.name(NameKind::Part),
            ..Part::default()
        };
        if part.name.is_none() && container == Container::Text {
            self.no_name(start, "this string does not name its part");
        }
        self.skip_blank();
        if self.peek() == Some('@') {
            let sign = self.at;
            self.at += 1;
            part.signs.push(self.range(sign..self.at));
            part.parent = self.name(NameKind::Parent);
            if part.parent.is_none() {
                self.no_name(sign, "there is no parent's name after `@`");
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
        words > 1 || (words == 1 && !rest.starts_with('"') && !rest.chars().all(is_name_char))
    }

    /// Reads a name up to the next sign.
    fn name(&mut self, kind: NameKind) -> Option<Name> {
        self.skip_blank();
        let rest = self.rest();
        if let Ok((after, name)) = lexical::quoted(rest) {
            return self.quoted_name(kind, name, rest.len() - after.len());
        }
        if rest.starts_with('"') {
            return self.unclosed_name();
        }
        let region = rest.split(['@', '$', '"']).next().unwrap_or_default();
        let written = region.trim_end();
        if written.is_empty() {
            return None;
        }
        let first = written
            .split(|c| !is_name_char(c))
            .next()
            .unwrap_or_default();
        if first.len() == written.len() {
            return Some(self.take_name(first, first.len()));
        }
        if kind == NameKind::Parent
            && let Some(name) = self.name_before_keyword(written)
        {
            return Some(name);
        }
        let range = self.at..self.at + written.len();
        let message = format!("the name `{}` needs quotes", shorten(written));
        let mut diagnostic = Diagnostic::new(Code::UnquotedName, self.span(range.clone()), message)
            .label("a name with spaces or parentheses needs quotes");
        if !written.contains('"') {
            let quoted = format!(
                "\"{}\"",
                written.split_whitespace().collect::<Vec<_>>().join(" ")
            );
            diagnostic = diagnostic
                .fix(
                    "Put the name in quotes",
                    self.span(range.clone()),
                    self.escape(range.start, &quoted),
                )
                .safe();
        }
        self.report(diagnostic);
        Some(self.take_name(written, written.len()))
    }

    fn quoted_name(&mut self, kind: NameKind, name: &str, length: usize) -> Option<Name> {
        let start = self.at;
        let taken = (!name.trim().is_empty()).then(|| Name {
            text: name.split_whitespace().collect::<Vec<_>>().join(" "),
            range: self.range(start..start + length),
        });
        self.at += length;
        self.skip_blank();
        let rest = self.rest();
        let excess = rest.split(['@', '$']).next().unwrap_or_default().trim_end();
        if excess.is_empty() {
            return taken;
        }
        let word = &excess[..lexical::run(excess)];
        if kind != NameKind::Feature && Keyword::from_name(word).is_some() {
            self.missing_sign(word.len());
            return taken;
        }
        let span = self.span(self.at..self.at + excess.len());
        let message = format!("`{}` follows the closing quote of a name", shorten(excess));
        let diagnostic = Diagnostic::new(Code::UnquotedName, span, message)
            .label("put the whole name inside the quotes");
        self.report(diagnostic);
        self.at += excess.len();
        taken
    }

    /// Reports the unclosed quote at `start`, with a fix that closes it at `end`.
    pub(super) fn unclosed_quote(&mut self, start: usize, end: usize) {
        let message = "this quote is never closed";
        let diagnostic = Diagnostic::new(Code::UnclosedQuote, self.span(start..start + 1), message)
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

    /// The name in `Ubody Shape roundv`, where `$` is missing.
    fn name_before_keyword(&mut self, written: &str) -> Option<Name> {
        let mut from = 0;
        for word in written.split_whitespace() {
            // Words are found from left to right, so each search begins after the previous word.
            let at = from + written[from..].find(word)?;
            from = at + word.len();
            if at > 0 && Keyword::from_name(word.trim_end_matches([':', '='])).is_some() {
                let name = written[..at].trim_end();
                if !name.chars().all(is_name_char) {
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

    /// Reports that `$` is missing before the next word, a keyword of `length` bytes.
    fn missing_sign(&mut self, length: usize) {
        let at = self.at;
        let word = &self.rest()[..length];
        let message = format!("`$` is missing before `{word}`");
        let diagnostic = Diagnostic::new(Code::MissingSign, self.span(at..at + length), message)
            .label("attributes come after `$`")
            .fix("Insert `$`", self.span(at..at), self.escape(at, "$"))
            .safe();
        self.report(diagnostic);
        // A `$` further on belongs to the same mistake.
        self.sign_reported = true;
    }

    fn no_name(&mut self, sign: usize, message: &str) {
        let diagnostic = Diagnostic::new(Code::NoName, self.span(sign..sign + 1), message)
            .label("expected a name")
            .help("write `Name@Parent$ attributes`; a name with spaces needs quotes");
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

/// `text`, shortened for messages.
pub(super) fn shorten(text: &str) -> String {
    const MAX_CHARS: usize = 40;
    if text.chars().nth(MAX_CHARS).is_none() {
        return text.to_owned();
    }
    let head: String = text.chars().take(MAX_CHARS - 1).collect();
    format!("{head}…")
}
