//! Errors of files that are no tracks.

use std::fmt;

/// Where in a file something is wrong.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum ErrorLocation {
    /// The file as a whole.
    File,
    /// A line and a column in characters, both counted from 1.
    Position {
        /// The line.
        line: usize,
        /// The column.
        column: usize,
    },
    /// A field of JSON, such as `marks[0].points[3]`; counted from 0.
    Field(String),
}

/// Why a file is no track, and where.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{location}{message}")]
pub struct Error {
    /// Where it is.
    pub location: ErrorLocation,
    /// What is wrong.
    pub message: String,
    /// How to fix it.
    pub help: String,
}

impl Error {
    /// An error of the file as a whole.
    pub(super) fn whole(message: impl Into<String>, help: impl Into<String>) -> Self {
        Self::new(ErrorLocation::File, message, help)
    }

    /// An error of a field of JSON.
    pub(super) fn field(
        field: impl Into<String>,
        message: impl Into<String>,
        help: impl Into<String>,
    ) -> Self {
        Self::new(ErrorLocation::Field(field.into()), message, help)
    }

    /// This error, at a line and a column.
    pub(super) fn at(self, line: usize, column: usize) -> Self {
        let location = ErrorLocation::Position { line, column };
        Self { location, ..self }
    }

    /// This error, of a field of JSON.
    pub(super) fn of(self, field: String) -> Self {
        let location = ErrorLocation::Field(field);
        Self { location, ..self }
    }

    /// An error at a location.
    fn new(location: ErrorLocation, message: impl Into<String>, help: impl Into<String>) -> Self {
        Self {
            location,
            message: message.into(),
            help: help.into(),
        }
    }
}

impl fmt::Display for ErrorLocation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::File => Ok(()),
            Self::Position { line, column } => write!(f, "line {line}, column {column}: "),
            Self::Field(field) => write!(f, "`{field}`: "),
        }
    }
}
