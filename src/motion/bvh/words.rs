//! A line of the hierarchy, word by word.

/// Whether a byte stands between words of a line.
pub(super) fn is_space(byte: u8) -> bool {
    matches!(byte, b' ' | b'\t' | 0x0B | 0x0C)
}

/// A word, and the byte of the line that it begins at.
#[derive(Debug, Clone, Copy)]
pub(super) struct Word<'a> {
    /// Where it begins.
    pub at: usize,
    /// Its bytes.
    pub text: &'a [u8],
}

impl Word<'_> {
    /// Whether it is this keyword, in any letter case.
    pub(super) fn is(self, keyword: &str) -> bool {
        self.text.eq_ignore_ascii_case(keyword.as_bytes())
    }
}

/// The words of a line. Some bytes are words by themselves (`{`), some are skipped like spaces (`:`).
#[derive(Debug, Clone)]
pub(super) struct Words<'a> {
    line: &'a [u8],
    at: usize,
    alone: &'static [u8],
    skipped: &'static [u8],
}

impl<'a> Words<'a> {
    /// The words of a line of the hierarchy: braces stand alone.
    pub(super) fn of_hierarchy(line: &'a [u8]) -> Self {
        Self {
            line,
            at: 0,
            alone: b"{}",
            skipped: b"",
        }
    }

    /// The words of a line of the motion's head, from a byte on: colons are skipped.
    pub(super) fn of_motion(line: &'a [u8], at: usize) -> Self {
        Self {
            line,
            at,
            alone: b"",
            skipped: b":",
        }
    }

    /// Where the next word is looked for.
    pub(super) fn at(&self) -> usize {
        self.at
    }

    fn skip(&mut self) {
        let left = self.line.get(self.at..).unwrap_or_default();
        let spaces = left
            .iter()
            .take_while(|b| is_space(**b) || self.skipped.contains(b));
        self.at += spaces.count();
    }

    /// The next word, which is still the next one afterwards.
    pub(super) fn peek(&mut self) -> Option<Word<'a>> {
        self.clone().next()
    }

    /// What is left of the line up to a brace, without the spaces around it.
    pub(super) fn until_brace(&mut self) -> Word<'a> {
        self.skip();
        let left = self.line.get(self.at..).unwrap_or_default();
        let long = left
            .iter()
            .position(|b| self.alone.contains(b))
            .unwrap_or(left.len());
        let text = &left[..long];
        let blank = text.iter().rev().take_while(|b| is_space(**b)).count();
        let word = Word {
            at: self.at,
            text: &text[..long - blank],
        };
        self.at += long;
        word
    }
}

impl<'a> Iterator for Words<'a> {
    type Item = Word<'a>;

    fn next(&mut self) -> Option<Word<'a>> {
        self.skip();
        let left = self.line.get(self.at..)?;
        let first = left.first()?;
        let ends = |b: &u8| is_space(*b) || self.skipped.contains(b) || self.alone.contains(b);
        let long = if self.alone.contains(first) {
            1
        } else {
            left.iter().position(ends).unwrap_or(left.len())
        };
        let word = Word {
            at: self.at,
            text: &left[..long],
        };
        self.at += long;
        Some(word)
    }
}
