//! Parses the header of the motion: the number of frames, and the frame time.

use super::error::{Error, Notes, quoted};
use super::number::{explain, parse_word};
use super::tokens::{Line, Token};

/// The frame time, in seconds, if a file states none that makes sense: the rate of most files that do not come from a capture
/// system.
pub(crate) const DEFAULT_FRAME_TIME: f64 = 1.0 / 30.0;

/// The frame times that are accepted, seconds.
const SENSIBLE: std::ops::RangeInclusive<f64> = 1e-5..=10.0;

/// The header of the motion.
#[derive(Debug, Default)]
pub(super) struct MotionHeader {
    /// The stated number of frames, and its line.
    frames: Option<(usize, Option<usize>)>,
    frame_time: Option<f64>,
}

/// What follows a line of the header.
#[derive(Debug, PartialEq, Eq)]
pub(super) enum Next {
    /// Another line of the header.
    Head,
    /// The frames, beginning at this byte of the line.
    Frames(usize),
}

impl MotionHeader {
    /// Parses a line, or the rest of one.
    pub(super) fn line(&mut self, line: &mut Line<'_>) -> Result<Next, Error> {
        let from = line.tokens.at;
        let mut begins = from == 0;
        while let Some(word) = line.tokens.next() {
            // Behind the frame time a number is a mistake, unless line breaks are spaces to the program that wrote the file.
            let is_one_line = from > 0 && self.frame_time.is_some();
            let begins_frames = std::mem::take(&mut begins) || is_one_line;
            if word.is("frames") {
                self.frames(line);
            } else if word.is("frametime") {
                self.frame_time(line)?;
            } else if word.is("frame") {
                if line.tokens.peek().is_some_and(|time| time.is("time")) {
                    line.tokens.next();
                    self.frame_time(line)?;
                } else {
                    self.frames(line);
                }
            } else if word.is("motion") {
                line.note("a second MOTION: ignored");
            } else if begins_frames && begins_frame(word) {
                return Ok(Next::Frames(word.at));
            } else {
                let message = format!("{} is not expected here", quoted(word.text));
                let help = "after MOTION come `Frames:`, `Frame Time:`, and then the frames, each on a line of its own";
                return Err(line.error(word.at, message, help));
            }
        }
        Ok(Next::Head)
    }

    fn frames(&mut self, line: &mut Line<'_>) {
        let word = line.tokens.next();
        if self.frames.is_some() {
            return line.note("a second number of frames: ignored");
        }
        let number = word.and_then(|word| parse_word(word.text));
        let count = number
            .filter(|count| *count >= 0.0 && count.fract() == 0.0)
            .map(|count| count as usize);
        if count.is_none() {
            line.note("no number of frames is given: they are counted");
        }
        self.frames = Some((line.number, count));
    }

    fn frame_time(&mut self, line: &mut Line<'_>) -> Result<(), Error> {
        let word = line.tokens.next();
        if self.frame_time.is_some() {
            line.note("a second frame time: ignored");
            return Ok(());
        }
        if let Some(word) = word.filter(|word| word.text.contains(&b',')) {
            let (message, help) = explain(word.text);
            return Err(line.error(word.at, message, help));
        }
        let given = word.and_then(|word| parse_word(word.text));
        let sensible = given.filter(|time| SENSIBLE.contains(time));
        if sensible.is_none() {
            let found = word.map_or_else(|| "nothing".to_owned(), |word| quoted(word.text));
            line.note(format!("the frame time is {found}: taken as 1/30 s"));
        }
        self.frame_time = Some(sensible.unwrap_or(DEFAULT_FRAME_TIME));
        Ok(())
    }

    /// The stated number of frames, if there is one.
    pub(super) fn stated(&self) -> Option<usize> {
        self.frames.and_then(|(_, count)| count)
    }

    /// The line that states the number of frames, or `or`.
    pub(super) fn frames_line(&self, or: usize) -> usize {
        self.frames.map_or(or, |(line, _)| line)
    }

    /// The frame time, seconds.
    pub(super) fn seconds(&self) -> f64 {
        self.frame_time.unwrap_or(DEFAULT_FRAME_TIME)
    }

    /// Adds notes for fields that are missing before the line where the frames begin.
    pub(super) fn finish(&self, line: usize, notes: &mut Notes) {
        if self.frames.is_none() {
            notes.add(line, "`Frames:` is missing: the frames are counted");
        }
        if self.frame_time.is_none() {
            notes.add(line, "`Frame Time:` is missing: taken as 1/30 s");
        }
    }
}

/// Whether a line that begins with this word is meant to be a frame, correct or not.
pub(super) fn begins_frame(word: Token<'_>) -> bool {
    let bare = match word.text {
        [b'+' | b'-', bare @ ..] => bare,
        bare => bare,
    };
    let number = bare
        .first()
        .is_none_or(|b| b.is_ascii_digit() || matches!(b, b'.' | b','));
    let lost = |name: &[u8]| {
        bare.get(..3)
            .is_some_and(|start| start.eq_ignore_ascii_case(name))
    };
    number || lost(b"nan") || lost(b"inf")
}
