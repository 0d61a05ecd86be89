//! Drawings that are built anew whenever they, or what they link to, change.
//!
//! A file that is half written is no error until it has stayed so for a while, and one that is gone may come back:
//! programs write in pieces, and replace files. A drawing is built once a save, and not at all if nothing in it, and in
//! what it links to, is another than before.

mod drawing;
mod round;

use std::path::{Path, PathBuf};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::time::{Duration, Instant, SystemTime};

use crate::compile::{Compiled, TOLERANCE};
use crate::disk::{FolderWatch, Notice, WatchError};
use crate::export::Model;
use round::Round;

pub use drawing::Drawing;

/// How drawings are read.
#[derive(Debug, Clone, PartialEq)]
pub struct Options {
    /// The folder that linked files must lie in; `None`: the drawing's.
    pub root: Option<PathBuf>,
    /// See [`TOLERANCE`].
    pub tolerance: f64,
    /// How changes are noticed.
    pub notice: Notice,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            root: None,
            tolerance: TOLERANCE,
            notice: Notice::default(),
        }
    }
}

/// A drawing that was built.
#[derive(Debug)]
pub struct Build {
    /// Its text.
    pub text: String,
    /// What came of it.
    pub compiled: Compiled,
    /// The model as binary glTF, or why there is none.
    pub model: Result<Model, NoModel>,
    /// When it was built.
    pub steps: Steps,
}

/// Why there is no model.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum NoModel {
    /// The drawing has errors.
    #[error("the drawing has errors")]
    Errors,
    /// It does not fit into its container.
    #[error("{0}")]
    Unwritten(String),
}

/// The moments of a build.
#[derive(Debug, Clone, Copy)]
pub struct Steps {
    /// The first sign of a change.
    pub noticed: SystemTime,
    /// It has settled: the build begins.
    pub begun: SystemTime,
    /// The model is made.
    pub built: SystemTime,
}

impl Steps {
    /// How long building took.
    pub fn duration(&self) -> Duration {
        self.built.duration_since(self.begun).unwrap_or_default()
    }
}

/// What happens to the drawings that are watched.
#[derive(Debug)]
pub enum Event<'a> {
    /// A drawing was built.
    Built(&'a Path, &'a Build),
    /// A drawing's file is gone. It is built again when it is back.
    Gone(&'a Path),
    /// A drawing can be read again, and is what it was.
    Back(&'a Path),
    /// A drawing cannot be read, and why.
    Unreadable(&'a Path, String),
    /// Changes in a folder are not told of, and why.
    Deaf(&'a Path, String),
    /// Everything that there is has been built once; so many drawings.
    Ready(usize),
}

/// How often folders that were deleted are looked for.
const LOOK: Duration = Duration::from_secs(1);

/// Builds drawings, and all drawings below folders, and builds them again when they change. Ends only with an error.
///
/// # Errors
/// Where the system cannot tell of changes.
pub fn watch(
    targets: &[PathBuf],
    options: &Options,
    mut tell: impl FnMut(Event<'_>),
) -> Result<std::convert::Infallible, WatchError> {
    let (sender, changes) = channel();
    let watch = FolderWatch::new(options.notice, move |changed| {
        let _ = sender.send(changed);
    })?;
    let mut round = Round::new(targets, options);
    // Watched before they are read, so that no change falls in between.
    round.listen(&watch, &mut tell);
    round.build(&mut tell);
    round.listen(&watch, &mut tell);
    tell(Event::Ready(round.len()));
    loop {
        let wait = round.due().map_or(LOOK, |due| {
            due.saturating_duration_since(Instant::now()).min(LOOK)
        });
        match changes.recv_timeout(wait) {
            Ok(changed) => round.note(&changed),
            Err(RecvTimeoutError::Timeout) => {}
            // The watch lives as long as this function.
            Err(RecvTimeoutError::Disconnected) => std::thread::sleep(wait),
        }
        round.build(&mut tell);
        round.listen(&watch, &mut tell);
    }
}
