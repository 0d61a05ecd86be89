//! Lines and columns as the protocol counts them. The one file that knows UTF-16.
//!
//! A line ends at LF, CR LF or CR; a column counts bytes or UTF-16 code units, as client and server agreed.

use std::sync::Arc;

use ls_types::{Position, PositionEncodingKind, Range};

use crate::source::{LineEnds, LineIndex, Span, starts_character};

/// The unit of columns.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Encoding {
    /// Bytes.
    Utf8,
    /// UTF-16 code units, which every client knows.
    Utf16,
}

impl Encoding {
    /// The first of the client's encodings that the server supports.
    pub(crate) fn negotiated(offered: &[PositionEncodingKind]) -> Self {
        let known = offered.iter().find_map(|kind| match kind.as_str() {
            "utf-8" => Some(Self::Utf8),
            "utf-16" => Some(Self::Utf16),
            _ => None,
        });
        known.unwrap_or(Self::Utf16)
    }

    /// Its name in the protocol.
    pub(crate) fn kind(self) -> PositionEncodingKind {
        match self {
            Self::Utf8 => PositionEncodingKind::UTF8,
            Self::Utf16 => PositionEncodingKind::UTF16,
        }
    }
}

/// A text with its line index.
#[derive(Debug)]
pub(crate) struct Positions {
    index: LineIndex<Arc<str>>,
}

impl Positions {
    pub(crate) fn new(text: Arc<str>, encoding: Encoding) -> Self {
        let units_in = match encoding {
            Encoding::Utf16 if !text.is_ascii() => utf16_units,
            _ => <[u8]>::len,
        };
        Self {
            index: LineIndex::with_units(text, LineEnds::Any, units_in),
        }
    }

    pub(crate) fn text(&self) -> &Arc<str> {
        self.index.text()
    }

    /// The position of byte `offset`: of the start of its character, of the end of the text if it is behind it, and of
    /// the end of the line if it is within a line break.
    pub(crate) fn position(&self, offset: usize) -> Position {
        let offset = self.index.clamp(offset);
        let line = self.index.line(offset);
        let (start, end) = self.index.extent(line);
        let character = self.length(Span::new(start, offset.min(end)));
        Position::new(number(line - 1), character)
    }

    pub(crate) fn range(&self, span: Span) -> Range {
        Range::new(self.position(span.start), self.position(span.end))
    }

    /// The length of a span within one line, in units.
    pub(crate) fn length(&self, span: Span) -> u32 {
        number(self.index.units_before(span.end) - self.index.units_before(span.start))
    }

    /// The byte at a position: the end of the line if the position is behind it, or the start of its character.
    pub(crate) fn offset(&self, position: Position) -> usize {
        let line = position.line as usize + 1;
        if line > self.index.line_count() {
            return self.text().len();
        }
        let (start, end) = self.index.extent(line);
        let unit = self.index.units_before(start);
        let unit = unit.saturating_add(position.character as usize);
        self.index.offset_of_unit(unit, [start, end])
    }

    /// The span of a range; empty if its end is before its start.
    pub(crate) fn span(&self, range: Range) -> Span {
        let start = self.offset(range.start);
        Span::new(start, self.offset(range.end).max(start))
    }
}

/// How many UTF-16 units the characters have that begin in a stretch of UTF-8: two for those of four bytes.
fn utf16_units(bytes: &[u8]) -> usize {
    let units = |byte: &u8| usize::from(starts_character(*byte)) + usize::from(*byte >= 0xF0);
    bytes.iter().map(units).sum()
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
    fn characters_count_as_the_client_wants() {
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
            // Places behind the end of the line or of the text are moved there.
            assert_eq!(positions.offset(Position::new(0, 99)), text.len());
            assert_eq!(positions.offset(Position::new(9, 0)), text.len());
        }
        assert_eq!(
            positions(text, Encoding::Utf16).offset(Position::new(0, 3)),
            4
        );
    }

    #[test]
    fn the_clients_order_decides() {
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
