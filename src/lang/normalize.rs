//! Normalization: full-width characters are read as ASCII.
//!
//! Japanese input methods type `＄`, `２`, `（` and the ideographic space where the language uses
//! ASCII. Every character that Unicode compatibility normalization (NFKC) maps to ASCII is replaced,
//! except in comments and quotes. Offsets in the normalized text can be mapped back to the original.

use std::borrow::Cow;
use std::ops::Range;

use unicode_normalization::char::decompose_compatible;

/// A string with full-width characters replaced by ASCII.
#[derive(Debug)]
pub(super) struct Normalized<'a> {
    text: Cow<'a, str>,
    changes: Vec<Change>,
}

/// A character that was replaced.
#[derive(Debug, Clone)]
struct Change {
    normalized: Range<usize>,
    original: Range<usize>,
}

impl<'a> Normalized<'a> {
    pub(super) fn new(text: &'a str) -> Self {
        if text.is_ascii() {
            return Self {
                text: Cow::Borrowed(text),
                changes: vec![],
            };
        }
        let last_quote = text.rfind('"');
        let mut out = String::with_capacity(text.len());
        let mut changes = vec![];
        let mut at = 0;
        let mut blank = true;
        while let Some(c) = text[at..].chars().next() {
            let next = at + c.len_utf8();
            let start = out.len();
            normalize_char(c, &mut out);
            if out[start..] != text[at..next] {
                changes.push(Change {
                    normalized: start..out.len(),
                    original: at..next,
                });
            }
            let verbatim_to = match &out[start..] {
                "#" | "*" if blank => Some(text.len()),
                "\"" => closing_quote(text, at, last_quote),
                _ => None,
            };
            blank = blank && out[start..].trim().is_empty();
            at = verbatim_to.unwrap_or(next);
            out.push_str(&text[next..at]);
        }
        Self {
            text: Cow::Owned(out),
            changes,
        }
    }

    /// The normalized text.
    pub(super) fn as_str(&self) -> &str {
        &self.text
    }

    /// The range of the original text that `range` of the normalized text came from.
    pub(super) fn original(&self, range: Range<usize>) -> Range<usize> {
        let start = self.original_offset(range.start, |change| change.original.start);
        if range.is_empty() {
            return start..start;
        }
        start..self.original_offset(range.end, |change| change.original.end)
    }

    /// The replaced stretches of the original text, adjacent characters joined, each with its
    /// replacement.
    pub(super) fn replacements(&self) -> Vec<(Range<usize>, &str)> {
        let mut runs: Vec<(Range<usize>, Range<usize>)> = vec![];
        for change in &self.changes {
            match runs.last_mut() {
                Some((original, normalized)) if original.end == change.original.start => {
                    original.end = change.original.end;
                    normalized.end = change.normalized.end;
                }
                _ => runs.push((change.original.clone(), change.normalized.clone())),
            }
        }
        runs.into_iter()
            .map(|(original, normalized)| (original, &self.text[normalized]))
            .collect()
    }

    /// The original offset of a normalized one; `inside` gives the offset within a replaced character.
    fn original_offset(&self, offset: usize, inside: fn(&Change) -> usize) -> usize {
        let next = self
            .changes
            .partition_point(|change| change.normalized.start < offset);
        match next.checked_sub(1).map(|index| &self.changes[index]) {
            None => offset,
            Some(change) if offset < change.normalized.end => inside(change),
            Some(change) => change.original.end + (offset - change.normalized.end),
        }
    }
}

/// `text` with full-width characters replaced by ASCII, except in comments and quotes.
pub(crate) fn normalize(text: &str) -> Cow<'_, str> {
    Normalized::new(text).text
}

/// Appends `c`, or the ASCII characters it stands for.
fn normalize_char(c: char, out: &mut String) {
    if c.is_ascii() {
        out.push(c);
        return;
    }
    let start = out.len();
    decompose_compatible(c, |part| out.push(part));
    if !out[start..].is_ascii() {
        out.truncate(start);
        out.push(c);
    }
}

/// The offset of the quote that closes the one at `open`.
///
/// An ASCII quote is closed by the next ASCII quote if there is one; otherwise, and for a full-width
/// quote, either kind closes it. With this rule the normalized text has the same quotes when it is read again.
fn closing_quote(text: &str, open: usize, last_quote: Option<usize>) -> Option<usize> {
    let inside = open + text[open..].chars().next().map_or(0, char::len_utf8);
    let ascii = text[open..].starts_with('"') && last_quote.is_some_and(|last| last > open);
    text[inside..]
        .find(|c| c == '"' || (!ascii && c == '＂'))
        .map(|found| inside + found)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn compatibility_characters_become_ascii() {
        for (text, expected) in [
            (
                "Ｒａｒｍ＠Ｕｂｏｄｙ＄Ｓｈａｐｅ　（２＋１）",
                "Rarm@Ubody$Shape (2+1)",
            ),
            ("右腕＠胴", "右腕@胴"),
            ("＃ １２３", "# １２３"),
            ("＊ １２３", "* １２３"),
            ("１ \"２\" ３", "1 \"２\" 3"),
            ("１ ＂２＂ ３", "1 \"２\" 3"),
            ("１ \"２ ３", "1 \"2 3"),
            ("㎝½", "cm½"),
        ] {
            assert_eq!(Normalized::new(text).as_str(), expected, "{text}");
        }
    }

    #[test]
    fn ranges_map_back_to_the_original() {
        let text = "a㎝　é＄b";
        let normalized = Normalized::new(text);
        assert_eq!(normalized.as_str(), "acm é$b");
        let find = |part: &str| {
            let at = normalized.as_str().find(part).unwrap();
            &text[normalized.original(at..at + part.len())]
        };
        for (part, original) in [
            ("a", "a"),
            ("cm", "㎝"),
            ("c", "㎝"),
            (" ", "　"),
            ("é$b", "é＄b"),
        ] {
            assert_eq!(find(part), original);
        }
        assert_eq!(normalized.replacements().len(), 2);
    }
}
