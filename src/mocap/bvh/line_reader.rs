//! The input as a stream of blocks of complete lines.

use std::io::Read;

use super::MAX_LINE_BYTES;
use super::error::Error;

/// How many bytes are read at once.
const BLOCK_BYTES: usize = 4 << 20;

/// An input of which some complete lines are in memory.
pub(super) struct LineReader<R> {
    input: R,
    buffer: Vec<u8>,
    /// Where the line that was returned last begins, where the line after it begins, and where the last complete line ends.
    last: usize,
    start: usize,
    end: usize,
    /// The number of the line that begins at `start`, counted from 1.
    line: usize,
    ended: bool,
}

impl<R: Read> LineReader<R> {
    /// An input before its first line.
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

    /// Makes sure that there is a line to return; `false` at the end.
    fn fill(&mut self) -> Result<bool, Error> {
        while self.start == self.end {
            if self.ended {
                return Ok(false);
            }
            let begins = self.buffer.is_empty() && self.line == 1;
            self.buffer.drain(..self.start);
            (self.last, self.start, self.end) = (0, 0, 0);
            if self.buffer.len() > MAX_LINE_BYTES {
                let message = format!(
                    "the line is longer than {} MiB, which is the limit",
                    MAX_LINE_BYTES >> 20
                );
                let help = "BVH has one frame per line. Is this another kind of file?";
                return Err(Error::at(self.line, b"", 0, message, help));
            }
            self.buffer.reserve(BLOCK_BYTES);
            match self
                .input
                .by_ref()
                .take(BLOCK_BYTES as u64)
                .read_to_end(&mut self.buffer)
            {
                Ok(read) => self.ended = read < BLOCK_BYTES,
                Err(error) => {
                    let message = format!("reading the file failed: {error}");
                    return Err(Error::at(
                        self.line,
                        b"",
                        0,
                        message,
                        "check the disk or the connection",
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

    /// The next line, without its line ending, and its number.
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

    /// Un-reads the line that was returned last, with spaces in place of the bytes before `from`.
    pub(super) fn back(&mut self, from: usize) {
        if self.last < self.start {
            let read = self.last..(self.last + from).min(self.start);
            self.buffer[read].fill(b' ');
            self.start = self.last;
            self.line -= 1;
        }
    }

    /// All lines that are in memory and were not yet returned, with the number of the first. The caller reports with
    /// [`Self::passed`] how many there were.
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

/// The length of the line ending at a byte: 1, 2 for CR LF, 0 if there is none.
pub(super) fn line_end(text: &[u8], at: usize) -> usize {
    match text.get(at..).unwrap_or_default() {
        [b'\r', b'\n', ..] => 2,
        [b'\r' | b'\n', ..] => 1,
        _ => 0,
    }
}

/// The end of the last line ending, or 0. A CR as the last byte does not count yet, because a LF may follow.
fn last_line_end(text: &[u8]) -> usize {
    let sure = text.strip_suffix(b"\r").unwrap_or(text);
    sure.iter()
        .rposition(|b| matches!(b, b'\n' | b'\r'))
        .map_or(0, |at| at + 1)
}
