//! Lines and columns of a text, fast even for long lines: a drawing that another program
//! has minified is one line of megabytes.

/// The distance in bytes between offsets whose number of characters is cached.
const STEP: usize = 4096;

/// Knows the line and column of every byte of a text.
#[derive(Debug)]
pub struct Places<'a> {
    text: &'a str,
    /// Where each line begins.
    starts: Vec<usize>,
    /// How many characters begin before each multiple of [`STEP`].
    characters: Vec<usize>,
}

impl<'a> Places<'a> {
    /// The places of a text.
    pub fn new(text: &'a str) -> Self {
        let mut starts = vec![0];
        let ends = text.bytes().enumerate().filter(|(_, byte)| *byte == b'\n');
        starts.extend(ends.map(|(at, _)| at + 1));
        let mut total = 0;
        let characters = text.as_bytes().chunks(STEP).map(|chunk| {
            let before = total;
            total += count(chunk);
            before
        });
        Self {
            text,
            starts,
            characters: characters.collect(),
        }
    }

    /// `offset`, moved to the start of its character, and at most the end of the text.
    pub fn clamp(&self, offset: usize) -> usize {
        let offset = offset.min(self.text.len());
        let boundary = |offset: &usize| self.text.is_char_boundary(*offset);
        (0..=offset).rev().find(boundary).unwrap_or(0)
    }

    /// Line and column of byte `offset`, both from 1; columns count characters.
    pub fn line_column(&self, offset: usize) -> (usize, usize) {
        let offset = self.clamp(offset);
        let line = self.line(offset);
        let start = self.starts[line - 1];
        // A byte order mark is no column: editors do not show it.
        let mark = line == 1 && offset > 0 && self.text.starts_with('\u{FEFF}');
        let characters = self.characters_before(offset) - self.characters_before(start);
        (line, characters + 1 - usize::from(mark))
    }

    /// The number of the line that holds `offset`, from 1.
    pub fn line(&self, offset: usize) -> usize {
        self.starts.partition_point(|start| *start <= offset)
    }

    /// Where a line begins and where it ends, its line break left out.
    pub fn extent(&self, line: usize) -> (usize, usize) {
        let start = self.starts[line - 1];
        let next = self.starts.get(line).copied();
        let end = next.map_or(self.text.len(), |next| next - 1);
        let carriage_return = end > start && self.text.as_bytes()[end - 1] == b'\r';
        (start, end - usize::from(carriage_return && next.is_some()))
    }

    fn characters_before(&self, offset: usize) -> usize {
        let step = (offset / STEP).min(self.characters.len().saturating_sub(1));
        let known = self.characters.get(step).copied().unwrap_or(0);
        known + count(&self.text.as_bytes()[step * STEP..offset])
    }
}

/// How many characters begin in a stretch of UTF-8.
fn count(bytes: &[u8]) -> usize {
    bytes.iter().filter(|byte| (**byte & 0xC0) != 0x80).count()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::source::Lines;

    #[test]
    fn line_columns_agree_with_the_plain_method() {
        let mut text = "a\nb腕\r\n\n".repeat(900);
        text.push_str(&"長い line\t".repeat(5000));
        let (lines, places) = (Lines::new(&text), Places::new(&text));
        for (offset, _) in text.char_indices().step_by(7).chain([(text.len(), ' ')]) {
            assert_eq!(places.line_column(offset), lines.line_column(&text, offset));
        }
    }

    #[test]
    fn odd_offsets_are_moved_to_a_character() {
        let places = Places::new("a腕");
        assert_eq!(places.line_column(2), (1, 2));
        assert_eq!(places.line_column(99), (1, 3));
        assert_eq!(Places::new("").line_column(3), (1, 1));
    }

    #[test]
    fn a_byte_order_mark_is_no_column() {
        let places = Places::new("\u{FEFF}<svg>\n<g>");
        assert_eq!(places.line_column(0), (1, 1));
        assert_eq!(places.line_column(3), (1, 1));
        assert_eq!(places.line_column(4), (1, 2));
        assert_eq!(places.line_column(10), (2, 2));
    }

    #[test]
    fn lines_end_before_their_break() {
        let places = Places::new("ab\r\nc\nd\r");
        assert_eq!(places.extent(1), (0, 2));
        assert_eq!(places.extent(2), (4, 5));
        assert_eq!(places.extent(3), (6, 8));
    }
}
