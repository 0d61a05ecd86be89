//! Splits a line of the hierarchy into tokens.

use super::error::{Error, Notes};

/// Whether a byte separates words of a line.
pub(super) fn is_space(byte: u8) -> bool {
    matches!(byte, b' ' | b'\t' | 0x0B | 0x0C)
}

/// A word, and where it begins.
#[derive(Debug, Clone, Copy)]
pub(super) struct Token<'a> {
    /// The byte of the line at which it begins.
    pub at: usize,
    /// Its bytes.
    pub text: &'a [u8],
}

impl Token<'_> {
    /// Whether it is not a brace.
    pub(super) fn is_word(&self) -> bool {
        !matches!(self.text, b"{" | b"}")
    }

    /// Whether it is this keyword, in any letter case.
    pub(super) fn is(self, keyword: &str) -> bool {
        self.text.eq_ignore_ascii_case(keyword.as_bytes())
    }
}

/// The tokens of a line. Some bytes are tokens by themselves (`{`), some are skipped like spaces (`:`).
#[derive(Debug, Clone)]
pub(super) struct Tokens<'a> {
    line: &'a [u8],
    pub(super) at: usize,
    alone: &'static [u8],
    skipped: &'static [u8],
}

/// A line that is being parsed, and where notes on it go.
pub(super) struct Line<'a> {
    pub number: usize,
    pub text: &'a [u8],
    pub tokens: Tokens<'a>,
    pub notes: &'a mut Notes,
}

impl<'a> Line<'a> {
    /// A line of the hierarchy: braces are separate tokens.
    pub(super) fn of_hierarchy(number: usize, text: &'a [u8], notes: &'a mut Notes) -> Self {
        let tokens = Tokens::of_hierarchy(text);
        Self {
            number,
            text,
            tokens,
            notes,
        }
    }

    /// A line of the motion's header, starting at a byte: colons are skipped.
    pub(super) fn of_motion(
        number: usize,
        text: &'a [u8],
        at: usize,
        notes: &'a mut Notes,
    ) -> Self {
        let tokens = Tokens {
            line: text,
            at,
            alone: b"",
            skipped: b":",
        };
        Self {
            number,
            text,
            tokens,
            notes,
        }
    }

    pub(super) fn error(&self, at: usize, message: impl Into<String>, help: &str) -> Error {
        Error::at(self.number, self.text, at, message, help)
    }

    pub(super) fn note(&mut self, message: impl Into<String>) {
        self.notes.add(self.number, message);
    }
}

impl<'a> Tokens<'a> {
    /// The tokens of a line of the hierarchy: braces are separate tokens.
    pub(super) fn of_hierarchy(line: &'a [u8]) -> Self {
        Self {
            line,
            at: 0,
            alone: b"{}",
            skipped: b"",
        }
    }

    fn skip(&mut self) {
        let left = self.line.get(self.at..).unwrap_or_default();
        let spaces = left
            .iter()
            .take_while(|b| is_space(**b) || self.skipped.contains(b));
        self.at += spaces.count();
    }

    /// The next token, without consuming it.
    pub(super) fn peek(&mut self) -> Option<Token<'a>> {
        self.clone().next()
    }

    /// The rest of the line up to a brace, without surrounding spaces.
    pub(super) fn until_brace(&mut self) -> Token<'a> {
        self.skip();
        let left = self.line.get(self.at..).unwrap_or_default();
        let long = left
            .iter()
            .position(|b| self.alone.contains(b))
            .unwrap_or(left.len());
        let text = &left[..long];
        let blank = text.iter().rev().take_while(|b| is_space(**b)).count();
        let word = Token {
            at: self.at,
            text: &text[..long - blank],
        };
        self.at += long;
        word
    }
}

impl<'a> Iterator for Tokens<'a> {
    type Item = Token<'a>;

    fn next(&mut self) -> Option<Token<'a>> {
        self.skip();
        let left = self.line.get(self.at..)?;
        let first = left.first()?;
        let ends = |b: &u8| is_space(*b) || self.skipped.contains(b) || self.alone.contains(b);
        let long = if self.alone.contains(first) {
            1
        } else {
            left.iter().position(ends).unwrap_or(left.len())
        };
        let word = Token {
            at: self.at,
            text: &left[..long],
        };
        self.at += long;
        Some(word)
    }
}
