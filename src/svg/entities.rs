//! The text that entities and character references stand for, and a limit of how much that may be.

use std::borrow::Cow;
use std::ops::Range;

use rustc_hash::FxHashMap;

use crate::diagnostic::{Code, Diagnostic};
use crate::source::Span;

/// How many bytes the entities of any drawing may expand to.
const ENTITY_TEXT: usize = 1 << 20;

/// How many more they may expand to, as a multiple of the drawing's own length: programs that write every style as an
/// entity stay far below.
const ENTITY_GROWTH: usize = 4;

/// The entities that a drawing declares.
pub(super) struct Entities {
    /// Their text, by name.
    texts: FxHashMap<String, String>,
    /// How many bytes the entities that were used so far expand to.
    used: usize,
    /// How many they may expand to.
    limit: usize,
}

impl Entities {
    /// No entities yet, of a drawing of this length in bytes.
    pub(super) fn new(length: usize) -> Self {
        Self {
            texts: FxHashMap::default(),
            used: 0,
            limit: ENTITY_TEXT + ENTITY_GROWTH * length,
        }
    }

    /// Declares an entity; the first declaration of a name counts. `at` is the position of its text.
    ///
    /// # Errors
    ///
    /// If entities expand to too much text.
    pub(super) fn declare(
        &mut self,
        name: &str,
        text: &str,
        at: usize,
    ) -> Result<(), Box<Diagnostic>> {
        self.count(text, at)?;
        let text = self.expand(text).into_owned();
        self.texts.entry(name.to_owned()).or_insert(text);
        Ok(())
    }

    /// Adds up the expanded size of the entities in a text at a position, before they are expanded.
    ///
    /// # Errors
    ///
    /// If entities expand to too much text.
    pub(super) fn count(&mut self, text: &str, at: usize) -> Result<(), Box<Diagnostic>> {
        if self.texts.is_empty() || !text.contains('&') {
            return Ok(());
        }
        for (name, _) in references(text) {
            self.used += self.texts.get(name).map_or(0, String::len);
            if self.used > self.limit {
                let message = format!(
                    "the drawing's entities expand to more than {} MiB and {ENTITY_GROWTH} times the drawing's length",
                    ENTITY_TEXT >> 20
                );
                return Err(Box::new(
                    Diagnostic::new(Code::LimitPassed, Span::new(at, at + text.len()), message)
                        .help("save the drawing without entities, as Plain SVG"),
                ));
            }
        }
        Ok(())
    }

    /// A text with its known references replaced, except those that exceed twice the limit.
    pub(super) fn expand<'t>(&self, text: &'t str) -> Cow<'t, str> {
        if !text.contains('&') {
            return Cow::Borrowed(text);
        }
        let mut out = String::new();
        let mut done = 0;
        for (name, range) in references(text) {
            if range.start < done {
                continue;
            }
            out.push_str(&text[done..range.start]);
            match self
                .texts
                .get(name)
                .cloned()
                .or_else(|| character(name).map(String::from))
            {
                // Nested entities may multiply; an entity above the limit is rejected where it is used.
                Some(value) if out.len() + value.len() <= 2 * self.limit => out.push_str(&value),
                _ => out.push_str(&text[range.clone()]),
            }
            done = range.end;
        }
        out.push_str(&text[done..]);
        Cow::Owned(out)
    }

    /// The text of each entity, by name.
    pub(super) fn into_texts(self) -> FxHashMap<String, String> {
        self.texts
    }
}

/// The references in `text`: name, and the byte range of `&name;`.
fn references(text: &str) -> impl Iterator<Item = (&str, Range<usize>)> {
    text.match_indices('&').filter_map(move |(at, _)| {
        let tail = &text[at + 1..];
        let end = tail.find(';')?;
        Some((&tail[..end], at..at + 1 + end + 1))
    })
}

/// The character of a predefined or numeric reference.
pub(crate) fn character(name: &str) -> Option<char> {
    match name {
        "amp" => Some('&'),
        "lt" => Some('<'),
        "gt" => Some('>'),
        "quot" => Some('"'),
        "apos" => Some('\''),
        _ => {
            let digits = name.strip_prefix('#')?;
            let code = match digits.strip_prefix('x') {
                Some(hex) => u32::from_str_radix(hex, 16).ok()?,
                None => digits.parse().ok()?,
            };
            char::from_u32(code)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn references_are_replaced_by_what_they_stand_for() {
        let mut entities = Entities::new(100);
        entities.declare("a", "x&amp;y", 0).unwrap();
        entities.declare("b", "<&a;>", 0).unwrap();
        entities.declare("a", "later", 0).unwrap();
        assert_eq!(entities.expand("&b;&#65;&#x42;"), "<x&y>AB");
        assert_eq!(entities.expand("&unknown; & plain;"), "&unknown; & plain;");
    }

    #[test]
    fn entities_that_multiply_are_refused() {
        let mut entities = Entities::new(100);
        entities.declare("a", &"a".repeat(32), 0).unwrap();
        let names = ["a", "b", "c", "d", "e", "f", "g"];
        let declare =
            |pair: &[&str]| entities.declare(pair[1], &format!("&{};", pair[0]).repeat(32), 0);
        let refused = names.windows(2).map(declare).find_map(Result::err);
        assert_eq!(refused.unwrap().code, Code::LimitPassed);
    }
}
