//! Lines and columns of a text.

use std::ops::Deref;
use std::sync::OnceLock;

/// Bytes between two places up to which the units are counted, so that columns are found fast in long lines: a drawing
/// that another program has minified is one line of megabytes.
const STEP: usize = 4096;

/// What ends a line.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LineEnds {
    /// LF, and CR LF.
    LineFeed,
    /// LF, CR LF and CR, as the language server protocol has it.
    Any,
}

/// The line and column of every byte of a text. Columns count units: characters, unless it is made
/// [`with_units`](Self::with_units) of another kind.
#[derive(Debug)]
pub struct LineIndex<T> {
    text: T,
    /// The start of each line.
    starts: Vec<usize>,
    /// How many units begin in a stretch of UTF-8.
    units_in: fn(&[u8]) -> usize,
    /// How many units begin before each multiple of [`STEP`]; counted when first needed.
    units: OnceLock<Vec<usize>>,
}

impl<T: Deref<Target = str>> LineIndex<T> {
    /// The index of a text as reports show it: lines end at LF, columns count characters.
    pub fn new(text: T) -> Self {
        let characters =
            |bytes: &[u8]| bytes.iter().filter(|byte| starts_character(**byte)).count();
        Self::with_units(text, LineEnds::LineFeed, characters)
    }

    /// The index of a text whose columns count what `units_in` counts in a stretch of UTF-8.
    pub fn with_units(text: T, ends: LineEnds, units_in: fn(&[u8]) -> usize) -> Self {
        let bytes = text.as_bytes();
        let mut starts = vec![0];
        match ends {
            LineEnds::LineFeed => starts.extend(memchr::memchr_iter(b'\n', bytes).map(|at| at + 1)),
            LineEnds::Any => {
                let ends = memchr::memchr2_iter(b'\n', b'\r', bytes);
                // The line ends behind the second character of CR LF.
                let ends = ends.filter(|at| !bytes[*at..].starts_with(b"\r\n"));
                starts.extend(ends.map(|at| at + 1));
            }
        }
        Self {
            text,
            starts,
            units_in,
            units: OnceLock::new(),
        }
    }

    /// The text.
    pub fn text(&self) -> &T {
        &self.text
    }

    /// `offset`, moved back to the start of its character, or to the end of the text.
    pub fn clamp(&self, offset: usize) -> usize {
        let offset = offset.min(self.text.len());
        let boundary = |offset: &usize| self.text.is_char_boundary(*offset);
        (0..=offset).rev().find(boundary).unwrap_or(0)
    }

    /// The line of byte `offset`, from 1.
    pub fn line(&self, offset: usize) -> usize {
        self.starts.partition_point(|start| *start <= offset)
    }

    /// The number of lines.
    pub fn line_count(&self) -> usize {
        self.starts.len()
    }

    /// The line and column of byte `offset`, both from 1.
    pub fn line_column(&self, offset: usize) -> (usize, usize) {
        let offset = self.clamp(offset);
        let line = self.line(offset);
        // A byte order mark is no column: editors do not show it.
        let mark = line == 1 && offset > 0 && self.text.starts_with('\u{FEFF}');
        let units = self.units_before(offset) - self.units_before(self.starts[line - 1]);
        (line, units + 1 - usize::from(mark))
    }

    /// The start and the end of a line, counted from 1, without its line break.
    pub fn extent(&self, line: usize) -> (usize, usize) {
        let start = self.starts[line - 1];
        let Some(next) = self.starts.get(line) else {
            return (start, self.text.len());
        };
        let line = &self.text[start..*next];
        let break_length = if line.ends_with("\r\n") { 2 } else { 1 };
        (start, next - break_length)
    }

    /// How many units begin before byte `offset`.
    pub fn units_before(&self, offset: usize) -> usize {
        let units = self.units();
        let step = (offset / STEP).min(units.len().saturating_sub(1));
        let known = units.get(step).copied().unwrap_or(0);
        known + (self.units_in)(&self.text.as_bytes()[step * STEP..offset])
    }

    /// The byte at which unit `unit` of the text begins, in the line from `start` to `end`: the start of its character, or
    /// the end of the line if it is behind it.
    pub fn offset_of_unit(&self, unit: usize, [start, end]: [usize; 2]) -> usize {
        let step = self.units().partition_point(|before| *before <= unit);
        let near = self.clamp(step.saturating_sub(1) * STEP);
        let near = near.max(start).min(end);
        let mut next = self.units_before(near);
        for (at, character) in self.text[near..end].char_indices() {
            let at = near + at;
            next += (self.units_in)(&self.text.as_bytes()[at..at + character.len_utf8()]);
            if unit < next {
                return at;
            }
        }
        end
    }

    fn units(&self) -> &[usize] {
        self.units.get_or_init(|| {
            let mut total = 0;
            let chunks = self.text.as_bytes().chunks(STEP);
            let before = chunks.map(|chunk| {
                let before = total;
                total += (self.units_in)(chunk);
                before
            });
            before.collect()
        })
    }
}

/// Whether a byte of UTF-8 is the first of a character.
pub(crate) fn starts_character(byte: u8) -> bool {
    (byte & 0xC0) != 0x80
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_lines_agree_with_counting() {
        let mut text = "a\nb腕\r\n\n".repeat(900);
        text.push_str(&"長い line\t".repeat(5000));
        let index = LineIndex::new(&*text);
        for (offset, _) in text.char_indices().step_by(7).chain([(text.len(), ' ')]) {
            let head = &text[..offset];
            let line = head.rsplit('\n').next().unwrap();
            let expected = (head.matches('\n').count() + 1, line.chars().count() + 1);
            assert_eq!(index.line_column(offset), expected);
        }
    }

    #[test]
    fn lines_and_columns_count_from_one() {
        let index = LineIndex::new("a\nbあc\n");
        assert_eq!(index.line_column(0), (1, 1));
        assert_eq!(index.line_column(2), (2, 1));
        assert_eq!(index.line_column(6), (2, 3));
    }

    #[test]
    fn offsets_within_a_character_are_moved() {
        let index = LineIndex::new("a腕");
        assert_eq!(index.line_column(2), (1, 2));
        assert_eq!(index.line_column(99), (1, 3));
        assert_eq!(LineIndex::new("").line_column(3), (1, 1));
    }

    #[test]
    fn a_byte_order_mark_is_no_column() {
        let index = LineIndex::new("\u{FEFF}<svg>\n<g>");
        assert_eq!(index.line_column(0), (1, 1));
        assert_eq!(index.line_column(3), (1, 1));
        assert_eq!(index.line_column(4), (1, 2));
        assert_eq!(index.line_column(10), (2, 2));
    }

    #[test]
    fn lines_end_before_their_break() {
        let text = "ab\r\nc\nd\r";
        let index = LineIndex::new(text);
        assert_eq!(index.extent(1), (0, 2));
        assert_eq!(index.extent(2), (4, 5));
        assert_eq!(index.extent(3), (6, 8));
        let index = LineIndex::with_units(text, LineEnds::Any, <[u8]>::len);
        assert_eq!(index.extent(1), (0, 2));
        assert_eq!(index.extent(3), (6, 7));
        assert_eq!(index.extent(4), (8, 8));
    }
}
