//! Reading, from the first line to the last.

use std::io::Read;
use std::sync::Arc;

use crate::motion::skeleton::{Clip, Skeleton};

use super::error::{Error, Note, Notes, column};
use super::header::Header;
use super::rows::{More, Rows};
use super::source::Source;
use super::timing::{Next, Timing};
use super::words::is_space;

/// What a file holds, and what was put right in it.
#[derive(Debug, Clone, PartialEq)]
pub struct Reading {
    /// The motion.
    pub clip: Clip,
    /// What was put right, in the order of the file.
    pub notes: Vec<Note>,
}

/// Reads BVH that is in memory; see [`read`].
///
/// # Errors
/// As [`read`].
pub fn read_bytes(text: &[u8]) -> Result<Reading, Error> {
    read(text)
}

/// Reads BVH. The text is never whole in memory: what is needed beside the clip is a few blocks of 4 MiB.
///
/// Read as they come are: any letter case, line end, order of channels and number of roots; positions on any joint; names with
/// spaces, or in Latin-1; frames broken into lines, where all are broken alike. A count of frames that is not right, a frame time
/// that makes no sense, a name or an offset that is missing and the like are put right, with a note. Numbers are finite and
/// within [`super::LARGEST`].
///
/// # Errors
/// Where the text stops making sense, with the line, the column, what to do, and the whole frames before that place; where one of
/// the limits of [`super`] is passed; where the input cannot be read on.
pub fn read(input: impl Read) -> Result<Reading, Error> {
    let mut source = Source::new(input);
    let mut notes = Notes::default();
    let mut last = [1, 1];

    let (skeleton, mut timing) = hierarchy(&mut source, &mut notes, &mut last)?;
    let begins = loop {
        let Some((number, text)) = source.line()? else {
            break None;
        };
        remember(&mut last, number, text);
        if timing.line(number, text, 0, &mut notes)? == Next::Frames {
            source.back();
            break Some(number);
        }
    };
    timing.finish(begins.unwrap_or(last[0]), &mut notes);

    let mut rows = Rows::new(skeleton.width(), timing.stated());
    let read = frames(&mut source, &mut rows, &mut notes);
    let stated_line = timing.frames_line(last[0]);
    let read = read.and_then(|()| match timing.stated() {
        Some(stated @ 1..) if rows.values.is_empty() && skeleton.width() > 0 => Err(Error {
            line: last[0],
            column: last[1],
            message: format!("the file ends before the first of {stated} frames"),
            help: "the file was cut off here".to_owned(),
            partial: None,
        }),
        Some(stated) if stated != rows.frames() => {
            let message = format!(
                "Frames says {stated}, but there are {}: these are taken",
                rows.frames()
            );
            notes.add(stated_line, message);
            Ok(())
        }
        _ => Ok(()),
    });
    let clip = Clip::new(Arc::new(skeleton), timing.seconds(), rows.values);
    match read {
        Ok(()) => {
            if clip.frames() == 0 {
                notes.add(last[0], "the clip has no frames");
            }
            let notes = notes.done();
            Ok(Reading { clip, notes })
        }
        Err(error) => Err(Error {
            partial: (clip.frames() > 0).then(|| Box::new(clip)),
            ..error
        }),
    }
}

/// Reads up to MOTION, and what stands behind that on its line.
fn hierarchy<R: Read>(
    source: &mut Source<R>,
    notes: &mut Notes,
    last: &mut [usize; 2],
) -> Result<(Skeleton, Timing), Error> {
    let mut header = Header::default();
    while let Some((number, text)) = source.line()? {
        remember(last, number, text);
        if let Some(behind) = header.line(number, text, notes)? {
            let mut timing = Timing::default();
            timing.line(number, text, behind, notes)?;
            return Ok((header.skeleton(), timing));
        }
    }
    Err(Error {
        line: last[0],
        column: last[1],
        message: "the file ends before MOTION".to_owned(),
        help: "the file was cut off here, or is empty".to_owned(),
        partial: None,
    })
}

fn frames<R: Read>(
    source: &mut Source<R>,
    rows: &mut Rows,
    notes: &mut Notes,
) -> Result<(), Error> {
    while let Some((line, text)) = source.block()? {
        match rows.block(line, text, notes)? {
            More::Lines(lines) => source.passed(lines),
            More::Nothing => break,
        }
    }
    rows.finish()
}

/// Keeps where the last line ends that is not blank: there is what is missing at the end of a file.
fn remember(last: &mut [usize; 2], number: usize, text: &[u8]) {
    let blank = text.iter().rev().take_while(|b| is_space(**b)).count();
    if blank < text.len() {
        *last = [number, column(text, text.len() - blank)];
    }
}
