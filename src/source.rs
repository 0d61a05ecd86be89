//! Positions in the drawing's text.
//!
//! Invariant: every [`Span`] in the program is a byte range of the drawing's text as it is on disk
//! (of the unpacked text for `.svgz`), whatever was decoded or rewritten on the way.

mod change;
mod line_index;

use std::ops::Range;

pub(crate) use change::Change;
pub use line_index::LineIndex;
pub(crate) use line_index::{LineEnds, starts_character};

/// A byte range of the drawing's text, half open.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Default)]
pub struct Span {
    /// Offset of the first byte.
    pub start: usize,
    /// Offset after the last byte; equal to `start` for a position between two characters.
    pub end: usize,
}

impl Span {
    /// The span `start..end`.
    pub const fn new(start: usize, end: usize) -> Self {
        Self { start, end }
    }

    /// The empty span at `offset`.
    pub const fn at(offset: usize) -> Self {
        Self {
            start: offset,
            end: offset,
        }
    }

    /// The smallest span that contains both.
    pub fn join(self, other: Self) -> Self {
        Self {
            start: self.start.min(other.start),
            end: self.end.max(other.end),
        }
    }

    /// Whether `offset` lies in the span or at its end.
    pub fn touches(self, offset: usize) -> bool {
        (self.start..=self.end).contains(&offset)
    }
}

impl From<Range<usize>> for Span {
    fn from(range: Range<usize>) -> Self {
        Self::new(range.start, range.end)
    }
}

/// One stretch of a decoded text and the bytes that it was decoded from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Run {
    /// Its start in the decoded text.
    at: usize,
    /// Its start in the drawing.
    raw: usize,
    /// Its length in the drawing.
    raw_len: usize,
    /// How it is written there.
    form: Form,
}

/// How a stretch of text is written in the drawing.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Form {
    /// Byte for byte.
    Plain,
    /// Byte for byte inside a CDATA section, where nothing is escaped.
    Cdata,
    /// As one unit: an entity, a line end, or a line break between elements.
    Unit,
}

/// A decoded text with a source map: for each of its characters the bytes of the drawing.
///
/// A text may contain XML entities and CDATA sections and extend over several elements; the annotation language sees
/// only the decoded characters, and gets their spans here.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Text {
    text: String,
    runs: Vec<Run>,
    end: usize,
}

impl Text {
    /// A text that is written byte for byte in the drawing, at `offset`. For tests.
    pub fn plain(text: &str, offset: usize) -> Self {
        let mut out = Self::default();
        out.push(text, Span::new(offset, offset + text.len()), Form::Plain);
        out
    }

    /// Appends decoded characters that are written at `raw`.
    ///
    /// # Panics
    ///
    /// If it is [`Form::Plain`] or [`Form::Cdata`], and both lengths are not equal.
    pub fn push(&mut self, decoded: &str, raw: Span, form: Form) {
        assert!(form == Form::Unit || decoded.len() == raw.end - raw.start);
        if decoded.is_empty() {
            return;
        }
        let continues = form != Form::Unit
            && self
                .runs
                .last()
                .is_some_and(|run| run.form == form && run.raw + run.raw_len == raw.start);
        match self.runs.last_mut() {
            Some(run) if continues => run.raw_len += raw.end - raw.start,
            _ => self.runs.push(Run {
                at: self.text.len(),
                raw: raw.start,
                raw_len: raw.end - raw.start,
                form,
            }),
        }
        self.text.push_str(decoded);
        self.end = raw.end;
    }

    /// Appends another text.
    pub fn append(&mut self, other: &Self) {
        for (index, run) in other.runs.iter().enumerate() {
            let end = other
                .runs
                .get(index + 1)
                .map_or(other.text.len(), |next| next.at);
            self.push(
                &other.text[run.at..end],
                Span::new(run.raw, run.raw + run.raw_len),
                run.form,
            );
        }
    }

    /// The text up to the decoded offset `end`.
    #[must_use]
    pub fn truncated(&self, end: usize) -> Self {
        let end_raw = self.span(0..end).end;
        let runs = self.runs.iter().copied().take_while(|run| run.at < end);
        let mut short = Self {
            text: self.text[..end].to_owned(),
            runs: runs.collect(),
            end: end_raw,
        };
        if let Some(last) = short.runs.last_mut() {
            last.raw_len = last.raw_len.min(end_raw.saturating_sub(last.raw));
        }
        short
    }

    /// The decoded characters.
    pub fn as_str(&self) -> &str {
        &self.text
    }

    /// The span in the drawing of the decoded characters `range` (byte offsets in [`Text::as_str`]).
    ///
    /// An empty range gives the position between two characters.
    pub fn span(&self, range: Range<usize>) -> Span {
        let start = self.raw_start(range.start);
        if range.is_empty() {
            return Span::at(start);
        }
        Span::new(start, self.raw_end(range.end).max(start))
    }

    /// The span of the whole text.
    pub fn whole(&self) -> Span {
        self.span(0..self.text.len())
    }

    /// Whether all bytes of `span` belong to this text, without tags or comments between its runs and without entities
    /// for several characters: only then can they be replaced as one.
    pub fn is_whole(&self, span: Span) -> bool {
        let from = self
            .runs
            .partition_point(|run| run.raw + run.raw_len <= span.start);
        let mut at = span.start;
        for (index, run) in self.runs.iter().enumerate().skip(from) {
            if at >= span.end || run.raw > at {
                break;
            }
            let end = self
                .runs
                .get(index + 1)
                .map_or(self.text.len(), |run| run.at);
            if run.form == Form::Unit && self.text[run.at..end].chars().nth(1).is_some() {
                return false;
            }
            at = at.max(run.raw + run.raw_len);
        }
        at >= span.end
    }

    /// Whether the decoded characters `range` can be replaced without their neighbours: an entity may expand to several
    /// characters.
    pub fn can_replace(&self, range: Range<usize>) -> bool {
        let splits = |offset: usize| {
            let run = self.run_at(offset);
            run.is_some_and(|run| {
                run.form == Form::Unit && run.at < offset && offset < self.text.len()
            })
        };
        !splits(range.start) && !splits(range.end)
    }

    /// The spans of the drawing that the decoded characters `range` were read from: one, unless tags or comments are
    /// between them.
    pub fn spans(&self, range: Range<usize>) -> Vec<Span> {
        let mut spans: Vec<Span> = vec![];
        let mut at = range.start;
        while at < range.end {
            let next = self.runs.partition_point(|run| run.at <= at);
            let end = self.runs.get(next).map_or(self.text.len(), |run| run.at);
            let end = end.min(range.end);
            let piece = self.span(at..end);
            match spans.last_mut() {
                Some(last) if last.end == piece.start => last.end = piece.end,
                _ => spans.push(piece),
            }
            at = end;
        }
        spans
    }

    /// The decoded offset of the character at the drawing's byte `raw`, if it belongs to this text (or is its end).
    pub fn offset_of(&self, raw: usize) -> Option<usize> {
        for (index, run) in self.runs.iter().enumerate() {
            if (run.raw..run.raw + run.raw_len.max(1)).contains(&raw) {
                return Some(match run.form {
                    Form::Unit => run.at,
                    Form::Plain | Form::Cdata => run.at + (raw - run.raw),
                });
            }
            let next = self.runs.get(index + 1);
            if raw == run.raw + run.raw_len && next.is_none_or(|next| next.raw != raw) {
                return Some(next.map_or(self.text.len(), |next| next.at));
            }
        }
        None
    }

    /// `text`, written so that it can replace the decoded characters from `offset` on: escaped for XML
    /// unless it goes into a CDATA section.
    pub fn escape_at(&self, offset: usize, text: &str) -> String {
        match self.run_at(offset).map(|run| run.form) {
            Some(Form::Cdata) => text.to_owned(),
            _ => escape_xml(text),
        }
    }

    fn run_at(&self, offset: usize) -> Option<&Run> {
        let next = self.runs.partition_point(|run| run.at <= offset);
        self.runs.get(next.checked_sub(1)?)
    }

    fn raw_start(&self, offset: usize) -> usize {
        match self.run_at(offset) {
            None => self.end,
            Some(_) if offset >= self.text.len() => self.end,
            Some(run) if run.form == Form::Unit => run.raw,
            Some(run) => run.raw + (offset - run.at),
        }
    }

    fn raw_end(&self, offset: usize) -> usize {
        match offset.checked_sub(1).and_then(|last| self.run_at(last)) {
            None => self.end,
            Some(run) if run.form == Form::Unit => run.raw + run.raw_len,
            Some(run) => run.raw + (offset - run.at).min(run.raw_len),
        }
    }
}

/// Where a start tag ends, after its `>`; `from` is a place in the tag, outside of quotes.
pub(crate) fn end_of_tag(source: &str, from: usize) -> Option<usize> {
    let mut quote = None;
    for (at, c) in source.get(from..)?.char_indices() {
        match (quote, c) {
            (None, '"' | '\'') => quote = Some(c),
            (Some(open), c) if c == open => quote = None,
            (None, '>') => return Some(from + at + 1),
            _ => {}
        }
    }
    None
}

/// `text` with the characters that XML reserves written as entities.
pub fn escape_xml(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            c => out.push(c),
        }
    }
    out
}

/// What [`escape_xml`] wrote, as it was.
pub(crate) fn unescape_xml(text: &str) -> String {
    let signs = [("&lt;", "<"), ("&gt;", ">"), ("&amp;", "&")];
    let signs = signs.into_iter();
    signs.fold(text.to_owned(), |text, (entity, sign)| {
        text.replace(entity, sign)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn mixed() -> Text {
        // raw: `ab&amp;c` then, in another element, `de`
        let mut text = Text::default();
        text.push("ab", Span::new(10, 12), Form::Plain);
        text.push("&", Span::new(12, 17), Form::Unit);
        text.push("c", Span::new(17, 18), Form::Plain);
        text.push("\n", Span::new(18, 18), Form::Unit);
        text.push("de", Span::new(40, 42), Form::Plain);
        text
    }

    #[test]
    fn spans_go_through_entities_and_elements() {
        let text = mixed();
        assert_eq!(text.as_str(), "ab&c\nde");
        assert_eq!(text.span(0..2), Span::new(10, 12));
        assert_eq!(text.span(2..3), Span::new(12, 17));
        assert_eq!(text.span(1..4), Span::new(11, 18));
        assert_eq!(text.span(5..7), Span::new(40, 42));
        assert_eq!(text.span(5..5), Span::at(40));
        assert_eq!(text.span(7..7), Span::at(42));
        assert_eq!(text.whole(), Span::new(10, 42));
    }

    #[test]
    fn bytes_between_the_parts_are_not_the_texts() {
        let text = mixed();
        assert!(text.is_whole(Span::new(10, 18)));
        assert!(text.is_whole(Span::new(40, 42)));
        assert!(text.is_whole(Span::at(30)));
        assert!(!text.is_whole(Span::new(17, 41)));
    }

    #[test]
    fn what_an_entity_stands_for_is_replaced_as_a_whole() {
        let mut text = Text::default();
        text.push("a", Span::new(0, 1), Form::Plain);
        text.push("bcd", Span::new(1, 4), Form::Unit);
        text.push("e", Span::new(4, 5), Form::Plain);
        for (range, can) in [
            (0..1, true),
            (1..4, true),
            (0..5, true),
            (1..2, false),
            (2..5, false),
            (4..5, true),
        ] {
            assert_eq!(text.can_replace(range.clone()), can, "{range:?}");
        }
        assert!(text.is_whole(Span::new(0, 1)) && !text.is_whole(Span::new(0, 4)));
    }

    #[test]
    fn spans_leave_out_what_stands_between() {
        let text = mixed();
        assert_eq!(text.spans(1..4), [Span::new(11, 18)]);
        assert_eq!(text.spans(1..6), [Span::new(11, 18), Span::new(40, 41)]);
        assert_eq!(text.spans(2..2), []);
    }

    #[test]
    fn offsets_come_back() {
        let text = mixed();
        for (raw, offset) in [
            (10, Some(0)),
            (14, Some(2)),
            (17, Some(3)),
            (40, Some(5)),
            (42, Some(7)),
            (30, None),
        ] {
            assert_eq!(text.offset_of(raw), offset, "raw {raw}");
        }
    }
}
