//! The frames: numbers of many lines at once, and then line after line whether they are as many as they have to be.

use rayon::prelude::*;

use super::MOST_NUMBERS;
use super::error::{Error, Notes};
use super::number::{explain, number};
use super::source::line_end;
use super::timing::begins_frame;
use super::words::{Word, is_space};

/// Bytes that a thread takes at once.
const PIECE: usize = 128 << 10;

/// Numbers that are made room for before they are seen, because a file says that they come: 256 MiB that are not touched if
/// they do not.
const TRUSTED: usize = 1 << 25;

/// The numbers of some lines.
struct Piece {
    numbers: Vec<f64>,
    rows: Vec<Row>,
    /// How many lines there are, blank ones too.
    lines: usize,
    /// A word that is no number; nothing behind it was read.
    bad: Option<Bad>,
}

/// A line that is not blank.
struct Row {
    /// Which line of the piece it is, from 0, and the byte where it begins.
    line: usize,
    start: usize,
    /// How many numbers it has.
    count: usize,
}

/// A word that is no number: in which line of the piece, where that begins, and where the word is.
struct Bad {
    line: usize,
    start: usize,
    word: std::ops::Range<usize>,
}

/// The frames that were read, and what the next line has to have.
pub(super) struct Rows {
    width: usize,
    stated: Option<usize>,
    /// The numbers of whole lines.
    pub values: Vec<f64>,
    /// How many numbers the lines of a frame have: one line, or as many as the first frame was broken into.
    breaks: Vec<usize>,
    /// Whether the first frame is whole, so that `breaks` is.
    known: bool,
    /// Which of the breaks is next, and how many numbers of the frame were before.
    due: usize,
    part: usize,
    /// Where the first line of frames ends: line, column, numbers.
    first: Option<[usize; 3]>,
    /// Where the last line of frames ends: line, column.
    last: [usize; 2],
    several: bool,
}

/// Whether there is more to read.
#[derive(Debug, PartialEq, Eq)]
pub(super) enum More {
    /// Lines, so many.
    Lines(usize),
    /// What comes is none of the clip.
    Nothing,
}

impl Rows {
    /// No frames yet, of so many numbers each.
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

    /// Takes a block of whole lines, the first of which is `line`.
    pub(super) fn block(
        &mut self,
        line: usize,
        text: &[u8],
        notes: &mut Notes,
    ) -> Result<More, Error> {
        let texts = pieces(text);
        let read: Vec<Piece> = texts.par_iter().map(|text| piece(text)).collect();
        let mut before = line;
        for (text, piece) in texts.iter().zip(&read) {
            self.reserve(piece.numbers.len());
            let taken = self.check(before, text, piece, notes);
            let whole = taken
                .as_ref()
                .map_or_else(|(_, taken)| *taken, |taken| *taken);
            self.values
                .extend_from_slice(&piece.numbers[..whole.min(piece.numbers.len())]);
            taken.map_err(|(error, _)| error)?;
            if self.values.len() > MOST_NUMBERS {
                let message =
                    format!("the clip has more than {MOST_NUMBERS} numbers, which is the limit");
                return Err(self.error(before, b"", 0, message, "cut the clip into shorter ones"));
            }
            if let Some(bad) = &piece.bad {
                let line = before + bad.line;
                let word = &text[bad.word.clone()];
                let begins = text[bad.start..bad.word.start].iter().all(|b| is_space(*b));
                let enough =
                    self.part == 0 && self.stated.is_some_and(|stated| self.frames() >= stated);
                if begins && enough && !begins_frame(Word { at: 0, text: word }) {
                    notes.add(line, "text behind the last frame: left out");
                    return Ok(More::Nothing);
                }
                let (message, help) = explain(word);
                return Err(self.error(
                    line,
                    &text[bad.start..],
                    bad.word.start - bad.start,
                    message,
                    help,
                ));
            }
            before += piece.lines;
        }
        Ok(More::Lines(before - line))
    }

    /// How many whole frames there are.
    pub(super) fn frames(&self) -> usize {
        self.values.len().checked_div(self.width).unwrap_or(0)
    }

    /// Whether the last frame is whole.
    pub(super) fn finish(&self) -> Result<(), Error> {
        if self.part == 0 {
            return Ok(());
        }
        let message = format!(
            "{} numbers, but a frame of this skeleton has {}",
            self.part, self.width
        );
        Err(Error {
            line: self.last[0],
            column: self.last[1],
            message,
            help: CUT.to_owned(),
            partial: None,
        })
    }

    fn error(&self, line: usize, text: &[u8], at: usize, message: String, help: &str) -> Error {
        Error::at(line, text, at, message, help)
    }

    /// Makes room: first for what the file says, later for what it must be if that was wrong.
    fn reserve(&mut self, more: usize) {
        let needed = self.values.len() + more;
        if needed <= self.values.capacity() {
            return;
        }
        let stated = self
            .stated
            .unwrap_or(0)
            .saturating_mul(self.width)
            .min(MOST_NUMBERS);
        let trusted = TRUSTED.max(self.values.len().saturating_mul(4));
        let room = if stated >= needed {
            stated.min(trusted)
        } else {
            self.values.len() * 3 / 2
        };
        // Without room here it is made, or refused, where the numbers are added.
        let _ = self
            .values
            .try_reserve_exact(room.max(needed) - self.values.len());
    }

    /// How many numbers of a piece belong to lines that are right; all of them, or an error at the first wrong line.
    fn check(
        &mut self,
        before: usize,
        text: &[u8],
        piece: &Piece,
        notes: &mut Notes,
    ) -> Result<usize, (Error, usize)> {
        let mut taken = 0;
        for row in &piece.rows {
            let end = |row: &Row| row_end(&text[row.start..]);
            let line = before + row.line;
            if let Err(wrong) = self.row(row.count) {
                let text = &text[row.start..];
                let error = match (wrong, self.first) {
                    (Wrong::First, Some([line, column, count])) => Error {
                        line,
                        column,
                        message: format!(
                            "{count} numbers, but a frame of this skeleton has {}",
                            self.width
                        ),
                        help: CUT.to_owned(),
                        partial: None,
                    },
                    (Wrong::First, None) => self.count_error(line, text, row.count, self.width),
                    (Wrong::Due(due), _) => self.count_error(line, text, row.count, due),
                };
                return Err((error, taken));
            }
            if row.count > self.width && !std::mem::replace(&mut self.several, true) {
                notes.add(line, "several frames on a line: taken one after the other");
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
        if let Some(row) = piece.rows.last() {
            let text = &text[row.start..];
            self.last = [before + row.line, super::error::column(text, row_end(text))];
        }
        Ok(taken)
    }

    /// Takes a line of so many numbers.
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
            format!(
                "{count} numbers, but {due} are due in this line of a frame of {}",
                self.width
            )
        } else {
            format!("{count} numbers, but a frame of this skeleton has {due}")
        };
        let help = match (self.breaks.len() > 1, count < due) {
            (true, _) => {
                let breaks: Vec<_> = self.breaks.iter().take(8).map(usize::to_string).collect();
                let more = if self.breaks.len() > 8 { ", …" } else { "" };
                let breaks = breaks.join(", ");
                format!(
                    "the first frame is broken into lines of {breaks}{more} numbers, so the others have to be too; best is one line a frame"
                )
            }
            (false, true) => CUT.to_owned(),
            (false, false) => {
                "look whether the ends of two lines were lost, or a joint of the hierarchy"
                    .to_owned()
            }
        };
        let at = if count < due {
            row_end(text)
        } else {
            word_at(text, due)
        };
        self.error(line, text, at, message, &help)
    }
}

/// What to do about a frame that is too short.
const CUT: &str =
    "the file was cut off here, or a line was broken; the frames before this one are whole";

/// What is wrong with a line.
enum Wrong {
    /// The first frame was not whole, and this line is too long for what is missing.
    First,
    /// So many numbers are due.
    Due(usize),
}

/// Cuts a text into pieces of whole lines.
fn pieces(text: &[u8]) -> Vec<&[u8]> {
    let mut pieces = Vec::with_capacity(text.len() / PIECE + 1);
    let mut left = text;
    while !left.is_empty() {
        let end = left
            .iter()
            .skip(PIECE)
            .position(|b| matches!(b, b'\n' | b'\r'));
        let at = end.map_or(left.len(), |end| PIECE + end);
        let (piece, rest) = left.split_at(at + line_end(left, at));
        pieces.push(piece);
        left = rest;
    }
    pieces
}

/// Reads the numbers of some lines.
fn piece(text: &[u8]) -> Piece {
    let mut piece = Piece {
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
                let count = piece.numbers.len() - before;
                if count > 0 {
                    piece.rows.push(Row {
                        line: piece.lines,
                        start,
                        count,
                    });
                    before = piece.numbers.len();
                }
                if byte.is_none() {
                    return piece;
                }
                piece.lines += 1;
                at += line_end(text, at);
                start = at;
            }
            Some(_) => {
                let (number, end) = number(text, at);
                let Some(number) = number else {
                    piece.bad = Some(Bad {
                        line: piece.lines,
                        start,
                        word: at..end,
                    });
                    return piece;
                };
                piece.numbers.push(number);
                at = end;
            }
        }
    }
}

/// Behind the last word of the line that a text begins with.
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

/// Where a word begins, counted from 0, in the line that a text begins with.
fn word_at(text: &[u8], word: usize) -> usize {
    let mut words = super::words::Words::of_hierarchy(&text[..row_end(text)]);
    words.nth(word).map_or(0, |word| word.at)
}
