//! The head of the motion: how many frames there are, and how long one lasts.

use super::error::{Error, Notes, quoted};
use super::number::{explain, whole};
use super::words::{Word, Words};

/// What a frame is taken to last, seconds, where a file does not say it in a way that makes sense: the rate that most files
/// without a capture system behind them have.
pub const DEFAULT_FRAME_TIME: f64 = 1.0 / 30.0;

/// The frame times that make sense, seconds.
const SENSIBLE: std::ops::RangeInclusive<f64> = 1e-5..=10.0;

/// What the head of the motion says.
#[derive(Debug, Default)]
pub(super) struct Timing {
    /// How many frames there should be, and the line that says it.
    frames: Option<(usize, Option<usize>)>,
    frame_time: Option<f64>,
}

/// What comes after a line of the motion's head.
#[derive(Debug, PartialEq, Eq)]
pub(super) enum Next {
    /// Another line of it.
    Head,
    /// The frames, which begin with this very line.
    Frames,
}

impl Timing {
    /// Takes a line, from a byte on.
    pub(super) fn line(
        &mut self,
        number: usize,
        text: &[u8],
        from: usize,
        notes: &mut Notes,
    ) -> Result<Next, Error> {
        let mut words = Words::of_motion(text, from);
        let mut first = from == 0;
        while let Some(word) = words.next() {
            if word.is("frames") {
                self.frames(number, words.next(), notes);
            } else if word.is("frametime") {
                self.frame_time(number, text, words.next(), notes)?;
            } else if word.is("frame") {
                match words.peek() {
                    Some(time) if time.is("time") => {
                        words.next();
                        self.frame_time(number, text, words.next(), notes)?;
                    }
                    _ => self.frames(number, words.next(), notes),
                }
            } else if word.is("motion") {
                notes.add(number, "MOTION stands here twice: taken once");
            } else if first && begins_frame(word) {
                return Ok(Next::Frames);
            } else {
                let message = format!("{} is not expected here", quoted(word.text));
                let help = "after MOTION come `Frames:`, `Frame Time:`, and then the frames, each on a line of its own";
                return Err(Error::at(number, text, word.at, message, help));
            }
            first = false;
        }
        Ok(Next::Head)
    }

    fn frames(&mut self, line: usize, word: Option<Word<'_>>, notes: &mut Notes) {
        if self.frames.is_some() {
            return notes.add(
                line,
                "the number of frames stands here twice: the first counts",
            );
        }
        let number = word.and_then(|word| whole(word.text));
        let count = number
            .filter(|count| *count >= 0.0 && count.fract() == 0.0)
            .map(|count| count as usize);
        if count.is_none() {
            notes.add(line, "no number of frames is given: they are counted");
        }
        self.frames = Some((line, count));
    }

    fn frame_time(
        &mut self,
        line: usize,
        text: &[u8],
        word: Option<Word<'_>>,
        notes: &mut Notes,
    ) -> Result<(), Error> {
        if self.frame_time.is_some() {
            notes.add(line, "the frame time stands here twice: the first counts");
            return Ok(());
        }
        if let Some(word) = word.filter(|word| word.text.contains(&b',')) {
            let (message, help) = explain(word.text);
            return Err(Error::at(line, text, word.at, message, help));
        }
        let given = word.and_then(|word| whole(word.text));
        let sensible = given.filter(|time| SENSIBLE.contains(time));
        if sensible.is_none() {
            let found = word.map_or_else(|| "nothing".to_owned(), |word| quoted(word.text));
            notes.add(line, format!("the frame time is {found}: taken as 1/30 s"));
        }
        self.frame_time = Some(sensible.unwrap_or(DEFAULT_FRAME_TIME));
        Ok(())
    }

    /// How many frames there should be, where it is said.
    pub(super) fn stated(&self) -> Option<usize> {
        self.frames.and_then(|(_, count)| count)
    }

    /// The line that says how many frames there are, or another.
    pub(super) fn frames_line(&self, or: usize) -> usize {
        self.frames.map_or(or, |(line, _)| line)
    }

    /// What a frame lasts, seconds.
    pub(super) fn seconds(&self) -> f64 {
        self.frame_time.unwrap_or(DEFAULT_FRAME_TIME)
    }

    /// Notes what is missing before the line where the frames begin.
    pub(super) fn finish(&self, line: usize, notes: &mut Notes) {
        if self.frames.is_none() {
            notes.add(line, "`Frames:` is missing: the frames are counted");
        }
        if self.frame_time.is_none() {
            notes.add(line, "`Frame Time:` is missing: taken as 1/30 s");
        }
    }
}

/// Whether a line that begins with this word is meant as a frame, right or wrong.
pub(super) fn begins_frame(word: Word<'_>) -> bool {
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
