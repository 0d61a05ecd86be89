//! Changes of drawings' files: made in the text as it is now, and undone.

use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread::sleep;
use std::time::{Duration, Instant};

use super::Options;
use crate::disk::{self, ReadError, WriteError, decode, is_packed, read_file, rewrite_if, stamp};
use crate::export;
use crate::ide::Analysis;
use crate::ide::changes::{Action, Change, Done, Reading, Refusal, Session, Steps};
use crate::memo::Memo;

/// How often a change is tried again if another program writes the file meanwhile.
const TRIES: usize = 5;
/// How long a file that is being written in pieces is waited for.
const PATIENCE: Duration = Duration::from_secs(2);
/// How long a file must have stayed the same: programs write in pieces.
const SETTLED: Duration = Duration::from_millis(30);

/// Why a drawing is not changed.
#[derive(Debug, thiserror::Error)]
pub(crate) enum NotChanged {
    /// The change cannot be made in this drawing.
    #[error("{0}")]
    Refused(#[from] Refusal),
    /// The file cannot be read.
    #[error("{0}")]
    Unread(#[from] ReadError),
    /// The file cannot be written.
    #[error("{}", unwritten(.0))]
    Unwritten(#[from] WriteError),
    /// There is no model of it.
    #[error("{0}")]
    NoModel(#[from] std::io::Error),
}

/// Why a drawing is not written, for somebody who did not name a file.
fn unwritten(error: &WriteError) -> String {
    match error {
        WriteError::Protected(path) => {
            format!(
                "`{}` is write-protected: change that to edit it here",
                path.display()
            )
        }
        WriteError::FolderDenied(folder) => format!(
            "there is no permission to write in the folder `{}`: change that to edit the drawing here",
            folder.display()
        ),
        error => error.to_string(),
    }
}

impl From<NotChanged> for Refusal {
    fn from(error: NotChanged) -> Self {
        match error {
            NotChanged::Refused(refusal) => refusal,
            error => Self::without_choice(error.to_string()),
        }
    }
}

/// Changes the files of drawings, one at a time.
#[derive(Debug)]
pub(crate) struct Editor {
    options: Options,
    drawings: Mutex<HashMap<PathBuf, Edited>>,
}

/// A drawing that is edited.
#[derive(Debug, Default)]
struct Edited {
    session: Session,
    /// The surfaces of the last model of a change that was only tried.
    surfaces: Memo,
}

impl Editor {
    /// An editor of drawings that are built with these options.
    pub(crate) fn new(options: Options) -> Self {
        Self {
            options,
            drawings: Mutex::default(),
        }
    }

    fn drawings(&self) -> MutexGuard<'_, HashMap<PathBuf, Edited>> {
        self.drawings.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Does something with the session of a drawing, and how that is read.
    fn with<R>(&self, path: &Path, work: impl FnOnce(&mut Edited, Reading<'_>) -> R) -> R {
        let (options, resolver) = self.options.reading(path);
        let reading = Reading {
            options,
            resolver: &resolver,
        };
        let mut drawings = self.drawings();
        work(drawings.entry(path.to_owned()).or_default(), reading)
    }

    /// Forgets what was compiled of a drawing: a file that it links to may have changed.
    pub(crate) fn forget(&self, path: &Path) {
        if let Some(edited) = self.drawings().get_mut(path) {
            edited.session.forget();
        }
    }

    /// The drawing as its file is now.
    ///
    /// # Errors
    /// If the file cannot be read, or is no drawing at the moment.
    pub(crate) fn analysis(&self, path: &Path) -> Result<Arc<Analysis>, NotChanged> {
        self.with(path, |edited, reading| {
            settled(self.file(path), &mut edited.session, reading)
        })
    }

    /// The file that is changed: of a drawing that is open elsewhere, the program that has it open writes the file itself, and takes over
    /// what was changed in the copy.
    fn file<'a>(&'a self, path: &'a Path) -> &'a Path {
        self.options.unsaved.as_deref().unwrap_or(path)
    }

    /// Whether a copy is changed instead of the drawing.
    pub(crate) fn changes_copy(&self) -> bool {
        self.options.unsaved.is_some()
    }

    /// The motion files in a drawing's folder, as the drawing names them.
    pub(crate) fn motion_files(&self, path: &Path) -> Vec<String> {
        disk::motions(path.parent().unwrap_or(Path::new("")))
    }

    /// What can be undone and redone in a drawing.
    pub(crate) fn steps(&self, path: &Path) -> Steps {
        let drawings = self.drawings();
        drawings
            .get(path)
            .map_or_else(Steps::default, |edited| edited.session.steps())
    }

    /// Changes a drawing's file: reads it, makes the change in its text, compiles that, and writes it if nothing else has changed.
    /// `shown` is the text for which the change was decided; `None` if that is not known any more. Returns what was done.
    ///
    /// # Errors
    /// If the change is refused, or the file cannot be read or written, or has changed so that the change would mean something else.
    /// Then the file stays as it is.
    pub(crate) fn act(
        &self,
        path: &Path,
        action: &Action,
        shown: Option<&str>,
    ) -> Result<Done, NotChanged> {
        self.with(path, |Edited { session, .. }, reading| {
            for _ in 0..TRIES {
                let before = settled(self.file(path), session, reading)?;
                let pending = session.pending(&before, action, shown, reading)?;
                let (old, new) = (before.source(), &pending.text);
                if old == new || rewrite_if(self.file(path), old.as_bytes(), new.as_bytes())? {
                    return Ok(session.done(action, pending));
                }
            }
            Err(refused(
                "another program writes the drawing at the moment: try again",
            ))
        })
    }

    /// What a change would make of a drawing, in the format of its models. The file stays as it is, and nothing is to be undone.
    ///
    /// # Errors
    /// If the change would be refused.
    pub(crate) fn tried(
        &self,
        path: &Path,
        change: &Change,
        shown: Option<&str>,
    ) -> Result<Vec<u8>, NotChanged> {
        self.with(path, |Edited { session, surfaces }, reading| {
            let before = settled(self.file(path), session, reading)?;
            let tried = session.tried(&before, change, shown, reading)?;
            let scene = &tried.compiled().scene;
            Ok(export::to_memory(self.options.exporter, scene, Some(surfaces))?.bytes)
        })
    }
}

/// The drawing as its file is now, once it has stayed the same for a while and can be read.
fn settled(
    path: &Path,
    session: &mut Session,
    reading: Reading<'_>,
) -> Result<Arc<Analysis>, NotChanged> {
    let begun = Instant::now();
    loop {
        let is_over = begun.elapsed() > PATIENCE;
        let old = stamp(path);
        let text = match text_of(path) {
            // Programs replace files: for a moment there may be none.
            Err(NotChanged::Unread(ReadError::Missing { .. })) if !is_over => {
                sleep(SETTLED);
                continue;
            }
            text => text?,
        };
        let age = old.and_then(|(_, time)| time.elapsed().ok());
        let is_quiet = session.knows(&text) || age.is_none_or(|age| age > SETTLED);
        if is_quiet || is_over {
            match session.current(&text, reading) {
                Ok(analysis) => return Ok(analysis),
                Err(refusal) if is_over => return Err(refusal.into()),
                Err(_) => {}
            }
        }
        sleep(SETTLED);
    }
}

fn refused(why: &str) -> NotChanged {
    NotChanged::Refused(Refusal::without_choice(why))
}

/// The text of a drawing that can be written back as it is.
fn text_of(path: &Path) -> Result<String, NotChanged> {
    if is_packed(path) {
        return Err(refused(
            "the drawing is packed: save it as plain SVG to change it here",
        ));
    }
    let bytes = read_file(path)?;
    let text = decode(bytes).map_err(|error| refused(&error.to_string()))?;
    Ok(text)
}
