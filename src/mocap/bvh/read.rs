//! Reads a file from its first line to its last.

use std::io::Read;
use std::sync::Arc;

use crate::mocap::{Clip, Skeleton};

use super::error::{Error, Note, Notes, column};
use super::frames::{FrameReader, Progress};
use super::hierarchy::HierarchyParser;
use super::line_reader::LineReader;
use super::motion_header::{MotionHeader, Next};
use super::tokens::{Line, is_space};

/// The contents of a file, and what was corrected in it.
#[derive(Debug, Clone, PartialEq)]
pub struct Reading {
    /// The motion.
    pub clip: Clip,
    /// What was corrected, in the order of the file.
    pub notes: Vec<Note>,
}

/// Reads BVH from memory; see [`read`].
///
/// # Errors
/// Those of [`read`].
pub fn read_bytes(text: &[u8]) -> Result<Reading, Error> {
    read(text)
}

/// Reads BVH. The text is never in memory as a whole: apart from the clip, reading needs a few blocks of 4 MiB.
///
/// Accepted are any letter case, line ending, order of channels and number of roots; positions on any joint; names with spaces,
/// or in Latin-1; frames broken into several lines, if all are broken alike. A wrong frame count, an impossible frame time, a
/// missing name or offset and the like are corrected, with a note. All numbers are finite and within [`super::MAX_MAGNITUDE`].
///
/// # Errors
/// Returns an error where the text makes no sense, with line, column, a way to fix it, and the complete frames before that
/// place; where one of the limits of [`super`] is exceeded; and where the input cannot be read.
pub fn read(input: impl Read) -> Result<Reading, Error> {
    let mut source = LineReader::new(input);
    let mut notes = Notes::default();
    let mut last = [1, 1];

    let (skeleton, mut header, mut next) = hierarchy(&mut source, &mut notes, &mut last)?;
    let begins = loop {
        if let Next::Frames(from) = next {
            source.back(from);
            break Some(last[0]);
        }
        let Some((number, text)) = source.line()? else {
            break None;
        };
        remember(&mut last, number, text);
        next = header.line(&mut Line::of_motion(number, text, 0, &mut notes))?;
    };
    header.finish(begins.unwrap_or(last[0]), &mut notes);

    let mut reader = FrameReader::new(skeleton.channel_count(), header.stated());
    let read = frames(&mut source, &mut reader, &mut notes);
    let stated_line = header.frames_line(last[0]);
    let read = read.and_then(|()| match header.stated() {
        Some(stated @ 1..) if reader.values.is_empty() && skeleton.channel_count() > 0 => {
            let message = format!("the file ends before the first of {stated} frames");
            Err(Error::behind(last, message, "the file was cut off here"))
        }
        Some(stated) if stated != reader.frames() => {
            let found = reader.frames();
            let message = format!("Frames says {stated}, but there are {found}: these are taken");
            notes.add(stated_line, message);
            Ok(())
        }
        _ => Ok(()),
    });
    let clip = Clip::new(Arc::new(skeleton), header.seconds(), reader.values);
    match read {
        Ok(()) => {
            if clip.frames == 0 {
                notes.add(last[0], "the clip has no frames");
            }
            let notes = notes.done();
            Ok(Reading { clip, notes })
        }
        Err(error) => Err(Error {
            partial: (clip.frames > 0).then(|| Box::new(clip)),
            ..error
        }),
    }
}

/// Reads up to MOTION, and what follows that on its line.
fn hierarchy<R: Read>(
    source: &mut LineReader<R>,
    notes: &mut Notes,
    last: &mut [usize; 2],
) -> Result<(Skeleton, MotionHeader, Next), Error> {
    let mut parser = HierarchyParser::default();
    while let Some((number, text)) = source.line()? {
        remember(last, number, text);
        if let Some(behind) = parser.line(&mut Line::of_hierarchy(number, text, notes))? {
            let mut header = MotionHeader::default();
            let next = header.line(&mut Line::of_motion(number, text, behind, notes))?;
            return Ok((parser.skeleton, header, next));
        }
    }
    let help = "the file was cut off here, or is empty";
    Err(Error::behind(*last, "the file ends before MOTION", help))
}

fn frames<R: Read>(
    source: &mut LineReader<R>,
    reader: &mut FrameReader,
    notes: &mut Notes,
) -> Result<(), Error> {
    while let Some((line, text)) = source.block()? {
        match reader.block(line, text, notes)? {
            Progress::Lines(lines) => source.passed(lines),
            Progress::Nothing => break,
        }
    }
    reader.finish()
}

/// Remembers where the last line ends that is not blank: errors about a file that ends too early point there.
fn remember(last: &mut [usize; 2], number: usize, text: &[u8]) {
    let blank = text.iter().rev().take_while(|b| is_space(**b)).count();
    if blank < text.len() {
        *last = [number, column(text, text.len() - blank)];
    }
}
