//! Errors of files that cannot be read, and notes on what was corrected.

use std::fmt;

use crate::mocap::Clip;

use super::MAX_NOTES;

/// Why a file cannot be read, and where.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("line {line}, column {column}: {message}")]
pub struct Error {
    /// The line, counted from 1.
    pub line: usize,
    /// The column in characters, counted from 1; after the last one if something is missing there.
    pub column: usize,
    /// What is wrong.
    pub message: String,
    /// How to fix it.
    pub help: String,
    /// The complete frames before that place, if there are any.
    pub partial: Option<Box<Clip>>,
}

impl Error {
    /// An error at a byte of a line.
    pub(super) fn at(
        line: usize,
        text: &[u8],
        byte: usize,
        message: impl Into<String>,
        help: &str,
    ) -> Self {
        Self::behind([line, column(text, byte)], message, help)
    }

    /// An error at a line and column.
    pub(super) fn behind(
        [line, column]: [usize; 2],
        message: impl Into<String>,
        help: &str,
    ) -> Self {
        Self {
            line,
            column,
            message: message.into(),
            help: help.to_owned(),
            partial: None,
        }
    }
}

/// A problem that was corrected while reading.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Note {
    /// The line, counted from 1.
    pub line: usize,
    /// What was found, and how it was read.
    pub message: String,
}

impl fmt::Display for Note {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "line {}: {}", self.line, self.message)
    }
}

/// Notes, limited to as many as anyone reads.
#[derive(Debug, Default)]
pub(super) struct Notes {
    notes: Vec<Note>,
    left_out: usize,
}

impl Notes {
    /// Adds a note.
    pub(super) fn add(&mut self, line: usize, message: impl Into<String>) {
        if self.notes.len() < MAX_NOTES {
            let message = message.into();
            self.notes.push(Note { line, message });
        } else {
            self.left_out += 1;
        }
    }

    /// The notes; the last one says how many were left out.
    pub(super) fn done(mut self) -> Vec<Note> {
        if let (1.., Some(last)) = (self.left_out, self.notes.last()) {
            let (line, message) = (
                last.line,
                format!("{} more notes are left out", self.left_out),
            );
            self.notes.push(Note { line, message });
        }
        self.notes
    }
}

/// The column of a byte of a line, counted from 1: in characters, or in bytes if the line is not UTF-8.
pub(super) fn column(text: &[u8], byte: usize) -> usize {
    let before = text.get(..byte).unwrap_or(text);
    1 + std::str::from_utf8(before).map_or(before.len(), |before| before.chars().count())
}

/// A word of the file as messages quote it: shortened, and without control characters or invalid UTF-8.
pub(super) fn quoted(word: &[u8]) -> String {
    /// Enough characters to recognize a word.
    const SHOWN: usize = 40;

    let text = String::from_utf8_lossy(word.get(..4 * SHOWN).unwrap_or(word));
    let mut shown: String = text
        .chars()
        .map(|c| if c.is_control() { '\u{FFFD}' } else { c })
        .take(SHOWN)
        .collect();
    if text.chars().nth(SHOWN).is_some() {
        shown.push('…');
    }
    format!("`{shown}`")
}
