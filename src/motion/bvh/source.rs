//! The text as it passes by: blocks of whole lines.

use std::io::Read;

use super::LONGEST_LINE;
use super::error::Error;

/// How much is read at once, bytes.
const BLOCK: usize = 4 << 20;

/// A text of which some whole lines are in memory.
pub(super) struct Source<R> {
    input: R,
    buffer: Vec<u8>,
    /// Where the line that was given last begins, where what follows it begins, and where the last whole line ends.
    last: usize,
    start: usize,
    end: usize,
    /// The line that begins at `start`, from 1.
    line: usize,
    ended: bool,
}

impl<R: Read> Source<R> {
    /// A text before its first line.
    pub(super) fn new(input: R) -> Self {
        Self {
            input,
            buffer: Vec::new(),
            last: 0,
            start: 0,
            end: 0,
            line: 1,
            ended: false,
        }
    }

    /// Sees to it that there is a line to give; `false` at the end.
    fn fill(&mut self) -> Result<bool, Error> {
        while self.start == self.end {
            if self.ended {
                return Ok(false);
            }
            let begins = self.buffer.is_empty() && self.line == 1;
            self.buffer.drain(..self.start);
            (self.last, self.start, self.end) = (0, 0, 0);
            if self.buffer.len() > LONGEST_LINE {
                let message = format!(
                    "the line is longer than {} MiB, which is the limit",
                    LONGEST_LINE >> 20
                );
                let help = "BVH has one frame a line. Is this another kind of file?";
                return Err(Error::at(self.line, b"", 0, message, help));
            }
            self.buffer.reserve(BLOCK);
            match self
                .input
                .by_ref()
                .take(BLOCK as u64)
                .read_to_end(&mut self.buffer)
            {
                Ok(read) => self.ended = read < BLOCK,
                Err(error) => {
                    let message = format!("the file cannot be read on: {error}");
                    return Err(Error::at(
                        self.line,
                        b"",
                        0,
                        message,
                        "look whether the disk or the connection is there",
                    ));
                }
            }
            self.end = if self.ended {
                self.buffer.len()
            } else {
                last_line_end(&self.buffer)
            };
            if begins && self.buffer.starts_with(b"\xEF\xBB\xBF") {
                self.buffer.drain(..3);
                self.end = self.end.saturating_sub(3);
            }
        }
        Ok(true)
    }

    /// The next line, with its number, without its end.
    pub(super) fn line(&mut self) -> Result<Option<(usize, &[u8])>, Error> {
        if !self.fill()? {
            return Ok(None);
        }
        let left = &self.buffer[self.start..self.end];
        let long = left
            .iter()
            .position(|b| matches!(b, b'\n' | b'\r'))
            .unwrap_or(left.len());
        let ends = long + line_end(left, long);
        let number = self.line;
        self.last = self.start;
        self.start += ends;
        self.line += 1;
        Ok(Some((number, &self.buffer[self.last..self.last + long])))
    }

    /// Takes the line that was given last back, to be given again.
    pub(super) fn back(&mut self) {
        if self.last < self.start {
            self.start = self.last;
            self.line -= 1;
        }
    }

    /// All lines that are in memory and not yet given, with the number of the first. Tell with [`Self::passed`] how many those
    /// were.
    pub(super) fn block(&mut self) -> Result<Option<(usize, &[u8])>, Error> {
        if !self.fill()? {
            return Ok(None);
        }
        let start = std::mem::replace(&mut self.start, self.end);
        self.last = self.start;
        Ok(Some((self.line, &self.buffer[start..self.end])))
    }

    /// Counts the lines of a block.
    pub(super) fn passed(&mut self, lines: usize) {
        self.line += lines;
    }
}

/// How many bytes the line end has that stands at a byte: 1, 2 for CR LF, 0 where there is none.
pub(super) fn line_end(text: &[u8], at: usize) -> usize {
    match text.get(at..).unwrap_or_default() {
        [b'\r', b'\n', ..] => 2,
        [b'\r' | b'\n', ..] => 1,
        _ => 0,
    }
}

/// Behind the last line end, or 0. A CR that is the last byte is none yet: its LF may follow.
fn last_line_end(text: &[u8]) -> usize {
    let sure = text.strip_suffix(b"\r").unwrap_or(text);
    sure.iter()
        .rposition(|b| matches!(b, b'\n' | b'\r'))
        .map_or(0, |at| at + 1)
}
