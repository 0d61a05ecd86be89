//! Full-width signs read as ASCII.
//!
//! Japanese input methods type `＄`, `２`, `（` and the ideographic space where the language has
//! ASCII. Every character that compatibility normalisation (NFKC) maps to ASCII is folded, except in
//! comments and quotes; places in the folded text lead back to the text as it was written.

use std::borrow::Cow;
use std::ops::Range;

use unicode_normalization::char::decompose_compatible;

/// A string with full-width signs folded to ASCII.
#[derive(Debug)]
pub(super) struct Folded<'a> {
    text: Cow<'a, str>,
    changes: Vec<Change>,
}

/// A character that was folded.
#[derive(Debug, Clone)]
struct Change {
    folded: Range<usize>,
    original: Range<usize>,
}

impl<'a> Folded<'a> {
    /// Folds `text`.
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
            fold(c, &mut out);
            if out[start..] != text[at..next] {
                changes.push(Change {
                    folded: start..out.len(),
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

    /// The folded text.
    pub(super) fn as_str(&self) -> &str {
        &self.text
    }

    /// Where the folded characters `range` stand in the text as it was written.
    pub(super) fn original(&self, range: Range<usize>) -> Range<usize> {
        let start = self.place(range.start, |change| change.original.start);
        if range.is_empty() {
            return start..start;
        }
        start..self.place(range.end, |change| change.original.end)
    }

    /// The characters that were folded, neighbours together: where they stand in the text as it was
    /// written, and what they were read as.
    pub(super) fn folds(&self) -> Vec<(Range<usize>, &str)> {
        let mut runs: Vec<(Range<usize>, Range<usize>)> = vec![];
        for change in &self.changes {
            match runs.last_mut() {
                Some((original, folded)) if original.end == change.original.start => {
                    original.end = change.original.end;
                    folded.end = change.folded.end;
                }
                _ => runs.push((change.original.clone(), change.folded.clone())),
            }
        }
        runs.into_iter()
            .map(|(original, folded)| (original, &self.text[folded]))
            .collect()
    }

    /// The original offset of a folded one; `inside` says what holds within a folded character.
    fn place(&self, offset: usize, inside: fn(&Change) -> usize) -> usize {
        let next = self
            .changes
            .partition_point(|change| change.folded.start < offset);
        match next.checked_sub(1).map(|index| &self.changes[index]) {
            None => offset,
            Some(change) if offset < change.folded.end => inside(change),
            Some(change) => change.original.end + (offset - change.folded.end),
        }
    }
}

/// `text` as the language reads it: full-width signs, letters and digits as ASCII, except in comments and quotes.
pub fn folded(text: &str) -> Cow<'_, str> {
    Folded::new(text).text
}

/// Appends `c`, or the ASCII that it stands for.
fn fold(c: char, out: &mut String) {
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
/// quote, either kind closes. So reading the folded text again gives the same quotes.
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
    fn everything_that_is_ascii_at_heart_is_folded() {
        for (text, folded) in [
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
            assert_eq!(Folded::new(text).as_str(), folded, "{text}");
        }
    }

    #[test]
    fn places_lead_back() {
        let text = "a㎝　é＄b";
        let folded = Folded::new(text);
        assert_eq!(folded.as_str(), "acm é$b");
        let find = |part: &str| {
            let at = folded.as_str().find(part).unwrap();
            &text[folded.original(at..at + part.len())]
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
        assert_eq!(folded.folds().len(), 2);
    }
}
