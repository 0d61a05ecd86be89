//! Builds drawings again whenever they, or files that they link to, change.
//!
//! Programs write files in pieces, and replace them: a half-written file is an error only after a while, and a missing one
//! may come back. A drawing is built once per save, and only if it or a linked file differs from before.

mod drawing;
mod editing;
mod source;
mod watcher;

use std::path::{Path, PathBuf};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::time::{Duration, Instant, SystemTime};

use crate::compile::{self, Compiled, TOLERANCE};
use crate::disk::{ChangeDetection, FolderResolver, FolderWatch, WatchError};
use crate::export::{Exporter, GLB, Model};
pub(crate) use editing::Editor;
use watcher::Watcher;

/// How drawings are read.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Options {
    /// Where links start; `None` means the drawing's folder.
    pub base: Option<PathBuf>,
    /// A folder that linked files may be in, besides the drawing's.
    pub root: Option<PathBuf>,
    /// A copy of the drawing with changes that are not saved yet, for one drawing: of the two files, the one that was written
    /// last is built, at first the copy.
    pub unsaved: Option<PathBuf>,
    /// See [`TOLERANCE`].
    pub tolerance: f64,
    /// How changes are noticed.
    pub detection: ChangeDetection,
    /// Whether to build what can be built of drawings with errors, to show it.
    pub shows_incomplete: bool,
    /// The format of the models.
    pub exporter: &'static dyn Exporter,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            base: None,
            root: None,
            unsaved: None,
            tolerance: TOLERANCE,
            detection: ChangeDetection::default(),
            shows_incomplete: false,
            exporter: &GLB,
        }
    }
}

impl Options {
    /// How the drawing at a path is compiled, and what resolves its links.
    pub(crate) fn reading(&self, path: &Path) -> (compile::Options, FolderResolver) {
        let folder = path.parent().map_or_else(PathBuf::new, Path::to_path_buf);
        let base = self.base.clone().unwrap_or(folder);
        let resolver = FolderResolver::new(base).allowing(self.root.as_deref());
        let options = compile::Options {
            tolerance: self.tolerance,
        };
        (options, resolver)
    }
}

/// The result of building a drawing.
#[derive(Debug)]
pub(crate) struct Build {
    /// The drawing's text.
    pub text: String,
    /// The compiled drawing.
    pub compiled: Compiled,
    /// The model, or why there is none.
    pub model: Result<Model, NoModel>,
    /// The files that the drawing links to, including missing ones.
    pub linked: Vec<PathBuf>,
    /// What can be built of a drawing with errors, if that is wanted.
    pub incomplete: Option<Model>,
    /// When it was built.
    pub times: BuildTimes,
}

/// Why there is no model.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub(crate) enum NoModel {
    /// The drawing has errors.
    #[error("the drawing has errors")]
    Errors,
    /// It cannot be written in its format.
    #[error("{0}")]
    Unwritten(String),
}

/// The times of a build.
#[derive(Debug, Clone, Copy)]
pub(crate) struct BuildTimes {
    /// When the change was noticed.
    pub noticed: SystemTime,
    /// When building started, after the files had settled.
    pub started: SystemTime,
    /// When the model was finished.
    pub finished: SystemTime,
}

impl BuildTimes {
    /// How long building took.
    pub(crate) fn duration(&self) -> Duration {
        let duration = self.finished.duration_since(self.started);
        duration.unwrap_or_default()
    }
}

/// An event while drawings are watched.
#[derive(Debug)]
pub(crate) enum Event<'a> {
    /// A drawing was built.
    Built(&'a Path, &'a Build),
    /// A drawing's file is gone. It is built again when it is back.
    Gone(&'a Path),
    /// A drawing can be read again, and has not changed.
    Back(&'a Path),
    /// A drawing cannot be read, and why.
    Unreadable(&'a Path, String),
    /// A folder cannot be watched, and why.
    Unwatchable(&'a Path, String),
    /// All drawings have been built once; their number.
    Ready(usize),
}

/// The time between two searches for folders that were deleted.
const FOLDER_SEARCH_INTERVAL: Duration = Duration::from_secs(1);

/// Builds drawings and all drawings below folders, and builds them again when they change. Returns only on an error.
///
/// # Errors
/// If the system cannot watch files.
pub(crate) fn watch(
    targets: &[PathBuf],
    options: &Options,
    mut report: impl FnMut(Event<'_>),
) -> Result<std::convert::Infallible, WatchError> {
    let (sender, changes) = channel();
    let watch = FolderWatch::new(options.detection, move |changed| {
        let _ = sender.send(changed);
    })?;
    let mut watcher = Watcher::new(targets, options, Instant::now());
    // The folders are watched before the drawings are read, so that no change is missed.
    watcher.watch_folders(&watch, Instant::now(), &mut report);
    watcher.build(Instant::now(), &mut report);
    watcher.watch_folders(&watch, Instant::now(), &mut report);
    report(Event::Ready(watcher.len()));
    loop {
        let wait = watcher.next_due().map_or(FOLDER_SEARCH_INTERVAL, |due| {
            due.saturating_duration_since(Instant::now())
                .min(FOLDER_SEARCH_INTERVAL)
        });
        match changes.recv_timeout(wait) {
            Ok(changed) => watcher.schedule(&changed, Instant::now()),
            Err(RecvTimeoutError::Timeout) => {}
            // `watch` holds the sender, and lives as long as this function.
            Err(RecvTimeoutError::Disconnected) => std::thread::sleep(wait),
        }
        watcher.build(Instant::now(), &mut report);
        watcher.watch_folders(&watch, Instant::now(), &mut report);
    }
}
