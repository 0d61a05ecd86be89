//! Finds texts into which several strings were typed.

use std::ops::Range;

use super::{is_name_char, lexical, starts_with_keyword};
use crate::lang::keyword::{Keyword, vocabulary};
use crate::lang::normalize::Normalized;

/// The strings in a text, as byte ranges without the white space around them: one, unless the cursor was still in the first
/// text when another string was typed.
pub fn strings_in(text: &str) -> Vec<Range<usize>> {
    let normalized = Normalized::new(text);
    let whole = normalized.as_str();
    let start = whole.len() - whole.trim_start().len();
    let mut starts = vec![start];
    // A comment, an unused string and a feature point take the whole text.
    if !whole[start..].starts_with(['#', '*', '^']) {
        let mut scan = Scan {
            text: whole,
            at: start,
            depth: 0,
        };
        let mut before = Before::at(start);
        while let Some(at) = scan.next_word() {
            before.extend_to(whole, at);
            if !before.text.is_empty() && before.is_left_at(&whole[at..]) {
                starts.push(at);
                before = Before::at(at);
            }
        }
    }
    let ends = starts.iter().skip(1).copied().chain([whole.len()]);
    let pieces = starts.iter().zip(ends);
    let pieces = pieces.map(|(start, end)| *start..start + whole[*start..end].trim_end().len());
    pieces.map(|piece| normalized.original(piece)).collect()
}

/// Goes from word to word. Quotes are one word, and parentheses hold none.
struct Scan<'a> {
    text: &'a str,
    at: usize,
    depth: usize,
}

impl Scan<'_> {
    /// The start of the next word outside of parentheses.
    fn next_word(&mut self) -> Option<usize> {
        loop {
            let rest = &self.text[self.at..];
            let start = self.at + (rest.len() - rest.trim_start().len());
            let outside = self.depth == 0;
            let word = &self.text[start..];
            if word.is_empty() {
                return None;
            }
            self.at = start + self.skip(word);
            if outside {
                return Some(start);
            }
        }
    }

    /// The length of a word, with its quotes.
    fn skip(&mut self, word: &str) -> usize {
        let mut quoted = false;
        for (at, c) in word.char_indices() {
            match c {
                '"' => quoted = !quoted,
                _ if quoted => {}
                '(' => self.depth += 1,
                ')' => self.depth = self.depth.saturating_sub(1),
                c if c.is_whitespace() => return at,
                _ => {}
            }
        }
        word.len()
    }
}

/// The string before a word. What is known about it is kept while it grows: texts can be a megabyte long.
#[derive(Default)]
struct Before<'a> {
    text: &'a str,
    /// Where it starts.
    start: usize,
    has_name_sign: bool,
    has_attributes: bool,
}

impl<'a> Before<'a> {
    /// Nothing yet, from byte `start` on.
    fn at(start: usize) -> Self {
        Self {
            start,
            ..Self::default()
        }
    }

    /// Extends it up to byte `at`.
    fn extend_to(&mut self, whole: &'a str, at: usize) {
        let new = &whole[self.start + self.text.len()..at];
        self.text = &whole[self.start..at];
        self.has_name_sign |= new.contains(['@', '$']);
        self.has_attributes |= new.contains(['$', '%']);
    }

    /// Whether it ends, and a new string begins at `rest`.
    fn is_left_at(&self, rest: &str) -> bool {
        let head = self.text.trim_end();
        let has_sign = head.starts_with(['%', '$']) || self.has_name_sign;
        if !has_sign || head.ends_with(['@', '$']) {
            return false;
        }
        if let Some(defaults) = rest.strip_prefix('%') {
            return starts_with_keyword(defaults);
        }
        let (name, after) = match lexical::quoted(rest) {
            Ok((after, name)) => (name, after),
            Err(_) => {
                let after = rest.trim_start_matches(is_name_char);
                (&rest[..rest.len() - after.len()], after)
            }
        };
        let last = head.rsplit(char::is_whitespace).next().unwrap_or_default();
        let last = last.rsplit(['$', '%']).next().unwrap_or_default();
        if !name.starts_with(char::is_alphabetic) {
            return false;
        }
        if let Some(parent) = after.strip_prefix('@') {
            return parent.starts_with(|c: char| c == '"' || c.is_alphabetic());
        }
        if let Some(attributes) = after.strip_prefix('$') {
            let is_argument = Keyword::from_name(last).is_some() || vocabulary::is_known(name);
            return !is_argument && starts_with_keyword(attributes);
        }
        // A name on a line of its own, below a string without attributes.
        let is_alone = || {
            let line = after.split('\n').next().unwrap_or_default();
            line.trim().is_empty()
        };
        self.text.ends_with('\n')
            && !self.has_attributes
            && is_alone()
            && Keyword::from_name(name).is_none()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn strings_typed_into_one_text_are_found() {
        for (text, expected) in [
            ("Rarm@Ubody Larm@Ubody", &["Rarm@Ubody", "Larm@Ubody"][..]),
            ("Rarm@Ubody\nLarm@Ubody", &["Rarm@Ubody", "Larm@Ubody"]),
            ("Rarm＠Ubody　Larm＠Ubody", &["Rarm＠Ubody", "Larm＠Ubody"]),
            (
                "A@B$Color red C@B$Shape round",
                &["A@B$Color red", "C@B$Shape round"],
            ),
            ("A$Color red B$Color blue", &["A$Color red", "B$Color blue"]),
            (
                "%Scale 2\n%Strokes all\nA@B",
                &["%Scale 2", "%Strokes all", "A@B"],
            ),
            (
                "\"left arm\"@B \"right arm\"@B",
                &["\"left arm\"@B", "\"right arm\"@B"],
            ),
            ("Arm@Body\nLeg", &["Arm@Body", "Leg"]),
            ("  A@B  ", &["A@B"]),
            ("A@B$Shape round Color red", &["A@B$Shape round Color red"]),
            ("A@B$Shape round$Color red", &["A@B$Shape round$Color red"]),
            ("A@B$Shape\nround", &["A@B$Shape\nround"]),
            ("A@ B $Shape round", &["A@ B $Shape round"]),
            ("A@B$Offset (x\n y)", &["A@B$Offset (x\n y)"]),
            ("# A@B C@B", &["# A@B C@B"]),
            ("Left arm@Body", &["Left arm@Body"]),
            ("two words", &["two words"]),
            ("A@B$Motion \"x y@z\"", &["A@B$Motion \"x y@z\""]),
        ] {
            let found: Vec<&str> = strings_in(text)
                .into_iter()
                .map(|range| &text[range])
                .collect();
            assert_eq!(found, expected, "{text}");
        }
    }
}
