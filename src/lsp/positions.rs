//! Lines and columns as the protocol counts them. The one file that knows UTF-16.
//!
//! A line ends at LF, CR LF or CR; a column counts bytes or UTF-16 code units, as client and server agreed.

use std::sync::{Arc, OnceLock};

use tower_lsp::ls_types::{Position, PositionEncodingKind, Range};

use crate::source::Span;

/// The distance in bytes between offsets whose UTF-16 units are cached, so that long lines are fast.
const STEP: usize = 4096;

/// The unit of columns.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Encoding {
    /// Bytes.
    Utf8,
    /// UTF-16 code units, which every client knows.
    Utf16,
}

impl Encoding {
    /// The first of the client's encodings that the server supports.
    pub(super) fn negotiated(offered: &[PositionEncodingKind]) -> Self {
        let known = offered.iter().find_map(|kind| match kind.as_str() {
            "utf-8" => Some(Self::Utf8),
            "utf-16" => Some(Self::Utf16),
            _ => None,
        });
        known.unwrap_or(Self::Utf16)
    }

    /// Its name in the protocol.
    pub(super) fn kind(self) -> PositionEncodingKind {
        match self {
            Self::Utf8 => PositionEncodingKind::UTF8,
            Self::Utf16 => PositionEncodingKind::UTF16,
        }
    }
}

/// A text with its line index.
#[derive(Debug)]
pub(super) struct Positions {
    text: Arc<str>,
    encoding: Encoding,
    /// Where each line begins.
    starts: Vec<usize>,
    /// How many units begin before each multiple of [`STEP`]; counted on first use.
    units: OnceLock<Vec<usize>>,
}

impl Positions {
    pub(super) fn new(text: Arc<str>, encoding: Encoding) -> Self {
        let mut starts = vec![0];
        let bytes = text.as_bytes();
        for at in memchr::memchr2_iter(b'\n', b'\r', bytes) {
            // Of CR LF the second one counts.
            if bytes[at] == b'\n' || bytes.get(at + 1) != Some(&b'\n') {
                starts.push(at + 1);
            }
        }
        // In ASCII a byte is a unit.
        let encoding = match text.is_ascii() {
            true => Encoding::Utf8,
            false => encoding,
        };
        Self {
            text,
            encoding,
            starts,
            units: OnceLock::new(),
        }
    }

    /// The text.
    pub(super) fn text(&self) -> &Arc<str> {
        &self.text
    }

    /// The line that holds byte `offset`, from 0.
    pub(super) fn line(&self, offset: usize) -> usize {
        self.starts.partition_point(|start| *start <= offset) - 1
    }

    /// The position of byte `offset`; within a character that of its start, after the end that of the end, within a line
    /// break that before it.
    pub(super) fn position(&self, offset: usize) -> Position {
        let offset = floor(&self.text, offset);
        let line = self.line(offset);
        let offset = offset.min(self.end_of(line));
        let character = match self.encoding {
            Encoding::Utf8 => offset - self.starts[line],
            Encoding::Utf16 => self.units_before(offset) - self.units_before(self.starts[line]),
        };
        Position::new(number(line), number(character))
    }

    /// The range of a span.
    pub(super) fn range(&self, span: Span) -> Range {
        Range::new(self.position(span.start), self.position(span.end))
    }

    /// The length of a span within one line, in units.
    pub(super) fn length(&self, span: Span) -> u32 {
        number(match self.encoding {
            Encoding::Utf8 => span.end - span.start,
            Encoding::Utf16 => self.units_before(span.end) - self.units_before(span.start),
        })
    }

    /// The byte at a position; after the end of a line its end, within a character its start.
    pub(super) fn offset(&self, position: Position) -> usize {
        let line = position.line as usize;
        let Some(start) = self.starts.get(line).copied() else {
            return self.text.len();
        };
        let end = self.end_of(line);
        let character = position.character as usize;
        match self.encoding {
            Encoding::Utf8 => floor(&self.text, start.saturating_add(character).min(end)),
            Encoding::Utf16 => self.offset_of_unit(start, character, end),
        }
    }

    /// The span of a range; empty if its end is before its start.
    pub(super) fn span(&self, range: Range) -> Span {
        let start = self.offset(range.start);
        Span::new(start, self.offset(range.end).max(start))
    }

    /// Where a line ends, its line break left out.
    fn end_of(&self, line: usize) -> usize {
        let next = self.starts.get(line + 1).copied();
        let end = next.unwrap_or(self.text.len());
        let line = &self.text[self.starts[line]..end];
        match next {
            None => end,
            Some(_) if line.ends_with("\r\n") => end - 2,
            Some(_) => end - 1,
        }
    }

    fn units(&self) -> &[usize] {
        self.units.get_or_init(|| {
            let mut total = 0;
            let chunks = self.text.as_bytes().chunks(STEP);
            let before = chunks.map(|chunk| {
                let before = total;
                total += units_of(chunk);
                before
            });
            before.collect()
        })
    }

    fn units_before(&self, offset: usize) -> usize {
        let units = self.units();
        let step = (offset / STEP).min(units.len().saturating_sub(1));
        let known = units.get(step).copied().unwrap_or(0);
        known + units_of(&self.text.as_bytes()[step * STEP..offset])
    }

    fn offset_of_unit(&self, start: usize, character: usize, end: usize) -> usize {
        let wanted = self.units_before(start).saturating_add(character);
        let step = self.units().partition_point(|before| *before <= wanted);
        let step = floor(&self.text, step.saturating_sub(1) * STEP);
        let from = step.max(start).min(end);
        let mut left = wanted - self.units_before(from).min(wanted);
        for (at, c) in self.text[from..end].char_indices() {
            if left < c.len_utf16() {
                return from + at;
            }
            left -= c.len_utf16();
        }
        end
    }
}

/// The number of UTF-16 units of the characters that begin in these bytes of UTF-8: two for those of four bytes.
fn units_of(bytes: &[u8]) -> usize {
    bytes
        .iter()
        .map(|byte| usize::from((byte & 0xC0) != 0x80) + usize::from(*byte >= 0xF0))
        .sum()
}

/// The start of the character that holds byte `offset`.
fn floor(text: &str, offset: usize) -> usize {
    let offset = offset.min(text.len());
    let boundary = |offset: &usize| text.is_char_boundary(*offset);
    (0..=offset).rev().find(boundary).unwrap_or(0)
}

fn number(count: usize) -> u32 {
    u32::try_from(count).unwrap_or(u32::MAX)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn positions(text: &str, encoding: Encoding) -> Positions {
        Positions::new(Arc::from(text), encoding)
    }

    #[test]
    fn lines_end_in_three_ways() {
        let positions = positions("a\nb\r\nc\rd", Encoding::Utf8);
        for (offset, line, character) in [
            (0, 0, 0),
            (1, 0, 1),
            (2, 1, 0),
            (3, 1, 1),
            (4, 1, 1),
            (5, 2, 0),
            (7, 3, 0),
            (8, 3, 1),
        ] {
            assert_eq!(
                positions.position(offset),
                Position::new(line, character),
                "{offset}"
            );
        }
    }

    #[test]
    fn columns_count_in_the_clients_unit() {
        let text = "a腕😀b";
        for (encoding, columns) in [
            (Encoding::Utf8, [0, 1, 4, 8, 9]),
            (Encoding::Utf16, [0, 1, 2, 4, 5]),
        ] {
            let positions = positions(text, encoding);
            let starts = text.char_indices().map(|(at, _)| at).chain([text.len()]);
            for (offset, column) in starts.zip(columns) {
                assert_eq!(positions.position(offset), Position::new(0, column));
                assert_eq!(positions.offset(Position::new(0, column)), offset);
            }
            // Positions after the end of the line or of the text are moved there.
            assert_eq!(positions.offset(Position::new(0, 99)), text.len());
            assert_eq!(positions.offset(Position::new(9, 0)), text.len());
        }
        assert_eq!(
            positions(text, Encoding::Utf16).offset(Position::new(0, 3)),
            4
        );
    }

    #[test]
    fn the_clients_preferred_encoding_is_chosen() {
        let of = |kinds: &[&'static str]| {
            let kinds: Vec<_> = kinds
                .iter()
                .map(|kind| PositionEncodingKind::new(kind))
                .collect();
            Encoding::negotiated(&kinds)
        };
        assert_eq!(of(&[]), Encoding::Utf16);
        assert_eq!(of(&["utf-32", "utf-8", "utf-16"]), Encoding::Utf8);
        assert_eq!(of(&["utf-16", "utf-8"]), Encoding::Utf16);
    }

    proptest! {
        #[test]
        fn positions_lead_back(text in "([a-c腕😀é]|\n|\r\n|\r|\t){0,60}", copies in 1_usize..400) {
            let text = text.repeat(copies);
            for encoding in [Encoding::Utf8, Encoding::Utf16] {
                let positions = positions(&text, encoding);
                let last = text.char_indices().count();
                for (offset, _) in text.char_indices().step_by((last / 50).max(1)) {
                    let position = positions.position(offset);
                    let back = positions.offset(position);
                    let in_break = text[..offset].ends_with('\r') && text[offset..].starts_with('\n');
                    prop_assert_eq!(back, if in_break { offset - 1 } else { offset });
                    let line = text[..offset].matches('\n').count()
                        + text[..offset].matches('\r').count()
                        - text[..offset].matches("\r\n").count()
                        - usize::from(in_break);
                    prop_assert_eq!(position.line as usize, line);
                }
            }
        }
    }
}
