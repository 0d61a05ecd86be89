//! Reads the frames: parses many lines at once, then checks line by line that the count of numbers is right.

use rayon::prelude::*;

use super::MAX_NUMBERS;
use super::error::{Error, Notes};
use super::line_reader::line_end;
use super::motion_header::begins_frame;
use super::number::{explain, parse_number};
use super::tokens::{Token, is_space};

/// Bytes that a thread parses at once.
const CHUNK_BYTES: usize = 128 << 10;

/// How many numbers are allocated in advance on the strength of the file's frame count: 256 MiB, whose pages are only touched
/// once they are used.
const TRUSTED: usize = 1 << 25;

/// The numbers of some consecutive lines.
struct Chunk {
    numbers: Vec<f64>,
    rows: Vec<FrameLine>,
    /// The number of lines, including blank ones.
    lines: usize,
    /// A word that is not a number; the rest of the chunk was not parsed.
    bad: Option<BadNumber>,
}

/// A line that is not blank.
struct FrameLine {
    /// Its line in the chunk, counted from 0, and the byte where it begins.
    line: usize,
    start: usize,
    /// How many numbers it has.
    count: usize,
}

/// A word that is not a number: its line in the chunk, where that line begins, and the bytes of the word.
struct BadNumber {
    line: usize,
    start: usize,
    word: std::ops::Range<usize>,
}

/// The frames so far, and what the next line has to look like.
pub(super) struct FrameReader {
    width: usize,
    stated: Option<usize>,
    /// The numbers of complete lines.
    pub values: Vec<f64>,
    /// How many numbers each line of a frame has: one line, or as many as the first frame is broken into.
    breaks: Vec<usize>,
    /// Whether the whole first frame has been read, so that `breaks` is complete.
    known: bool,
    /// The index of the next break, and how many numbers of the frame came before.
    due: usize,
    part: usize,
    /// Where the first line of frames ends, and its count of numbers: line, column, count.
    first: Option<[usize; 3]>,
    /// Where the last line of frames ends: line, column.
    last: [usize; 2],
    several: bool,
}

/// Whether there is more to read.
#[derive(Debug, PartialEq, Eq)]
pub(super) enum Progress {
    /// Yes, after this many lines.
    Lines(usize),
    /// No: the rest of the file is not part of the clip.
    Nothing,
}

impl FrameReader {
    /// Starts without frames, for frames of `width` numbers.
    pub(super) fn new(width: usize, stated: Option<usize>) -> Self {
        Self {
            width,
            stated,
            values: Vec::new(),
            breaks: Vec::new(),
            known: false,
            due: 0,
            part: 0,
            first: None,
            last: [1, 1],
            several: false,
        }
    }

    /// Parses a block of complete lines, the first of which is line number `line`.
    pub(super) fn block(
        &mut self,
        line: usize,
        text: &[u8],
        notes: &mut Notes,
    ) -> Result<Progress, Error> {
        let texts = split_chunks(text);
        let read: Vec<Chunk> = texts.par_iter().map(|text| parse_chunk(text)).collect();
        let mut before = line;
        for (text, chunk) in texts.iter().zip(&read) {
            self.reserve(chunk.numbers.len());
            let taken = self.check(before, text, chunk, notes);
            let whole = taken
                .as_ref()
                .map_or_else(|(_, taken)| *taken, |taken| *taken);
            self.values
                .extend_from_slice(&chunk.numbers[..whole.min(chunk.numbers.len())]);
            taken.map_err(|(error, _)| error)?;
            if self.values.len() > MAX_NUMBERS {
                let message =
                    format!("the clip has more than {MAX_NUMBERS} numbers, which is the limit");
                return Err(Error::at(
                    before,
                    b"",
                    0,
                    message,
                    "cut the clip into shorter ones",
                ));
            }
            if let Some(bad) = &chunk.bad {
                let line = before + bad.line;
                let word = &text[bad.word.clone()];
                let begins = text[bad.start..bad.word.start].iter().all(|b| is_space(*b));
                let enough =
                    self.part == 0 && self.stated.is_some_and(|stated| self.frames() >= stated);
                if begins && enough && !begins_frame(Token { at: 0, text: word }) {
                    notes.add(line, "text after the last frame: ignored");
                    return Ok(Progress::Nothing);
                }
                let (message, help) = explain(word);
                return Err(Error::at(
                    line,
                    &text[bad.start..],
                    bad.word.start - bad.start,
                    message,
                    help,
                ));
            }
            before += chunk.lines;
        }
        Ok(Progress::Lines(before - line))
    }

    /// The number of complete frames.
    pub(super) fn frames(&self) -> usize {
        self.values.len().checked_div(self.width).unwrap_or(0)
    }

    /// Checks that the last frame is complete.
    pub(super) fn finish(&self) -> Result<(), Error> {
        if self.part == 0 {
            return Ok(());
        }
        Err(Error::behind(
            self.last,
            wrong_count(self.part, self.width),
            CUT,
        ))
    }

    /// Allocates memory: first for the stated number of frames, and if that was wrong, in growing steps.
    fn reserve(&mut self, more: usize) {
        let needed = self.values.len() + more;
        if needed <= self.values.capacity() {
            return;
        }
        let stated = self
            .stated
            .unwrap_or(0)
            .saturating_mul(self.width)
            .min(MAX_NUMBERS);
        let trusted = TRUSTED.max(self.values.len().saturating_mul(4));
        let room = if stated >= needed {
            stated.min(trusted)
        } else {
            self.values.len() * 3 / 2
        };
        // If this fails, extending the list allocates again, or aborts.
        let _ = self
            .values
            .try_reserve_exact(room.max(needed) - self.values.len());
    }

    /// Checks the lines of a chunk. Returns how many of its numbers belong to correct lines: all, or with an error those before
    /// the first wrong line.
    fn check(
        &mut self,
        before: usize,
        text: &[u8],
        chunk: &Chunk,
        notes: &mut Notes,
    ) -> Result<usize, (Error, usize)> {
        let mut taken = 0;
        for row in &chunk.rows {
            let end = |row: &FrameLine| row_end(&text[row.start..]);
            let line = before + row.line;
            if let Err(wrong) = self.row(row.count) {
                let text = &text[row.start..];
                let error = match (wrong, self.first) {
                    (Wrong::First, Some([line, column, count])) => {
                        Error::behind([line, column], wrong_count(count, self.width), CUT)
                    }
                    (Wrong::First, None) => self.count_error(line, text, row.count, self.width),
                    (Wrong::Due(due), _) => self.count_error(line, text, row.count, due),
                };
                return Err((error, taken));
            }
            if row.count > self.width && !std::mem::replace(&mut self.several, true) {
                notes.add(line, "several frames on one line: read one after the other");
            }
            taken += row.count;
            if self.first.is_none() {
                self.first = Some([
                    line,
                    super::error::column(&text[row.start..], end(row)),
                    row.count,
                ]);
            }
        }
        if let Some(row) = chunk.rows.last() {
            let text = &text[row.start..];
            self.last = [before + row.line, super::error::column(text, row_end(text))];
        }
        Ok(taken)
    }

    /// Takes a line of `count` numbers.
    fn row(&mut self, count: usize) -> Result<(), Wrong> {
        let frames = self.part == 0 && count.checked_rem(self.width) == Some(0);
        if !self.known {
            let part = self.part + count;
            if frames {
                self.breaks = vec![self.width];
                self.known = true;
            } else if part > self.width {
                return Err(Wrong::First);
            } else {
                self.breaks.push(count);
                self.known = part == self.width;
                self.part = if self.known { 0 } else { part };
            }
            return Ok(());
        }
        let due = self.breaks.get(self.due).copied().unwrap_or(self.width);
        if count == due {
            self.due += 1;
            self.part += count;
            if self.due >= self.breaks.len() {
                (self.due, self.part) = (0, 0);
            }
            return Ok(());
        }
        if frames && self.breaks.len() == 1 {
            Ok(())
        } else {
            Err(Wrong::Due(due))
        }
    }

    fn count_error(&self, line: usize, text: &[u8], count: usize, due: usize) -> Error {
        let message = if self.breaks.len() > 1 && due != self.width {
            let width = self.width;
            format!("{count} numbers, but {due} are due in this line of a frame of {width}")
        } else {
            wrong_count(count, due)
        };
        let help = match (self.breaks.len() > 1, count < due) {
            (true, _) => {
                let breaks: Vec<_> = self.breaks.iter().take(8).map(usize::to_string).collect();
                let more = if self.breaks.len() > 8 { ", …" } else { "" };
                let breaks = breaks.join(", ");
                format!(
                    "the first frame is broken into lines of {breaks}{more} numbers, so all others have to be too; one line per frame is best"
                )
            }
            (false, true) => CUT.to_owned(),
            (false, false) => {
                "check whether the ends of two lines were lost, or a joint of the hierarchy"
                    .to_owned()
            }
        };
        let at = if count < due {
            row_end(text)
        } else {
            word_at(text, due)
        };
        Error::at(line, text, at, message, &help)
    }
}

fn wrong_count(count: usize, width: usize) -> String {
    format!("{count} numbers, but a frame of this skeleton has {width}")
}

/// How to fix a frame that is too short.
const CUT: &str =
    "the file was cut off here, or a line was broken; the frames before this one are whole";

/// What is wrong with a line.
enum Wrong {
    /// The first frame is incomplete, and this line is too long to complete it.
    First,
    /// This many numbers were expected.
    Due(usize),
}

/// Splits a text into chunks of complete lines.
fn split_chunks(text: &[u8]) -> Vec<&[u8]> {
    let mut chunks = Vec::with_capacity(text.len() / CHUNK_BYTES + 1);
    let mut left = text;
    while !left.is_empty() {
        let end = left
            .iter()
            .skip(CHUNK_BYTES)
            .position(|b| matches!(b, b'\n' | b'\r'));
        let at = end.map_or(left.len(), |end| CHUNK_BYTES + end);
        let (chunk, rest) = left.split_at(at + line_end(left, at));
        chunks.push(chunk);
        left = rest;
    }
    chunks
}

fn parse_chunk(text: &[u8]) -> Chunk {
    let mut chunk = Chunk {
        numbers: Vec::with_capacity(text.len() / 8),
        rows: Vec::new(),
        lines: 0,
        bad: None,
    };
    let (mut at, mut start, mut before) = (0, 0, 0);
    loop {
        let byte = text.get(at).copied();
        match byte {
            Some(b' ' | b'\t' | 0x0B | 0x0C) => at += 1,
            None | Some(b'\n' | b'\r') => {
                let count = chunk.numbers.len() - before;
                if count > 0 {
                    chunk.rows.push(FrameLine {
                        line: chunk.lines,
                        start,
                        count,
                    });
                    before = chunk.numbers.len();
                }
                if byte.is_none() {
                    return chunk;
                }
                chunk.lines += 1;
                at += line_end(text, at);
                start = at;
            }
            Some(_) => {
                let (number, end) = parse_number(text, at);
                let Some(number) = number else {
                    chunk.bad = Some(BadNumber {
                        line: chunk.lines,
                        start,
                        word: at..end,
                    });
                    return chunk;
                };
                chunk.numbers.push(number);
                at = end;
            }
        }
    }
}

/// The end of the last word of the first line of a text.
fn row_end(text: &[u8]) -> usize {
    let long = text
        .iter()
        .position(|b| matches!(b, b'\n' | b'\r'))
        .unwrap_or(text.len());
    let blank = text[..long]
        .iter()
        .rev()
        .take_while(|b| is_space(**b))
        .count();
    long - blank
}

/// The start of word number `word`, counted from 0, of the first line of a text.
fn word_at(text: &[u8], word: usize) -> usize {
    let mut words = super::tokens::Tokens::of_hierarchy(&text[..row_end(text)]);
    words.nth(word).map_or(0, |word| word.at)
}
