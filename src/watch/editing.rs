//! Changes of drawings' files: made in the text as it is now, and undone.

use std::collections::{HashMap, VecDeque};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread::sleep;
use std::time::{Duration, Instant};

use super::Options;
use crate::compile::{self, Compiler};
use crate::diagnostic::{Edit, applied};
use crate::disk::{
    FolderResolver, ReadError, WriteError, decode, is_packed, read_file, rewrite_if, stamp,
};
use crate::export;
use crate::ide::Analysis;
use crate::ide::changes::{Change, History, Refusal, Step, check, edits, no_worse};
use crate::memo::Memo;

/// How often a change is tried again if another program writes the file meanwhile.
const TRIES: usize = 5;
/// How long a file that is being written in pieces is waited for.
const PATIENCE: Duration = Duration::from_secs(2);
/// How long a file must have stayed the same: programs write in pieces.
const SETTLED: Duration = Duration::from_millis(30);

/// How many of the last changes are known by their texts: a page may make one after the other before it has seen a build.
const MAX_KNOWN: usize = 16;
/// How many bytes these texts may have together.
const MAX_KNOWN_BYTES: usize = 32 << 20;

/// What is to be done to a drawing.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Action {
    /// A change is made.
    Make(Change),
    /// The last change is undone.
    Undo,
    /// What was undone last is made again.
    Redo,
}

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

/// What was done to a drawing.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub(crate) struct Done {
    /// The part that it was about, by the name that it has now.
    pub part: Option<String>,
    /// What else has changed, as a sentence without a full stop.
    pub note: Option<String>,
}

/// What can be undone and redone, in words.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub(crate) struct Steps {
    /// The change that would be undone.
    pub undo: Option<String>,
    /// The change that would be made again.
    pub redo: Option<String>,
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
    history: History,
    compiler: Compiler,
    /// The last state that was compiled.
    last: Option<Arc<Analysis>>,
    /// The texts before and after the last changes.
    made: VecDeque<[Arc<str>; 2]>,
    /// The surfaces of the last model of a change that was only tried.
    surfaces: Memo,
}

/// A change that is possible.
struct Possible {
    edits: Vec<Edit>,
    /// The drawing with the change; `None` if nothing changes.
    after: Option<Arc<Analysis>>,
    /// What else it does, as a sentence without a full stop.
    note: Option<String>,
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

    /// Forgets what was compiled of a drawing: a file that it links to may have changed.
    pub(crate) fn forget(&self, path: &Path) {
        if let Some(edited) = self.drawings().get_mut(path) {
            edited.last = None;
        }
    }

    /// The drawing as its file is now.
    ///
    /// # Errors
    /// If the file cannot be read, or is no drawing at the moment.
    pub(crate) fn analysis(&self, path: &Path) -> Result<Arc<Analysis>, NotChanged> {
        let mut drawings = self.drawings();
        let edited = drawings.entry(path.to_owned()).or_default();
        self.settled(path, edited)
    }

    /// What can be undone and redone in a drawing.
    pub(crate) fn steps(&self, path: &Path) -> Steps {
        let drawings = self.drawings();
        let title = |step: &Step| step.change.title();
        drawings
            .get(path)
            .map_or_else(Steps::default, |edited| Steps {
                undo: edited.history.last().map(title),
                redo: edited.history.next().map(title),
            })
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
        let mut drawings = self.drawings();
        let edited = drawings.entry(path.to_owned()).or_default();
        for _ in 0..TRIES {
            let before = self.settled(path, edited)?;
            let text = before.source();
            let (found, note) = match action {
                Action::Make(change) => {
                    let possible = self.possible(path, edited, &before, change, shown)?;
                    if possible.after.is_some() {
                        edited.last = possible.after;
                    }
                    (possible.edits, possible.note)
                }
                Action::Undo | Action::Redo => (self.stepped(path, edited, &before, action)?, None),
            };
            let new: Arc<str> = applied(text, &found).into();
            if new != *text && !rewrite_if(path, text.as_bytes(), new.as_bytes())? {
                continue;
            }
            let history = &mut edited.history;
            let part = match action {
                Action::Make(change) => change.part_after(),
                Action::Undo => history
                    .last()
                    .and_then(|step| step.change.part().map(str::to_owned)),
                Action::Redo => history.next().and_then(|step| step.change.part_after()),
            };
            match action {
                Action::Make(_) if new == *text => {}
                Action::Make(change) => history.add(Step::new(change.clone(), text, &found)),
                Action::Undo => history.undo(text, &found),
                Action::Redo => history.redo(text, &found),
            }
            if new != *text {
                edited.know([text.clone(), new]);
            }
            return Ok(Done { part, note });
        }
        Err(refused(
            "another program writes the drawing at the moment: try again",
        ))
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
        let mut drawings = self.drawings();
        let edited = drawings.entry(path.to_owned()).or_default();
        let before = self.settled(path, edited)?;
        let possible = self.possible(path, edited, &before, change, shown)?;
        let after = possible.after.unwrap_or(before);
        let scene = &after.compiled().scene;
        let model = export::to_memory(self.options.exporter, scene, Some(&mut edited.surfaces))?;
        Ok(model.bytes)
    }

    /// A change that a person wants.
    fn possible(
        &self,
        path: &Path,
        edited: &mut Edited,
        before: &Analysis,
        change: &Change,
        shown: Option<&str>,
    ) -> Result<Possible, NotChanged> {
        let shown = shown.ok_or_else(|| {
            Refusal::without_choice(
                "the drawing has changed too often since: look at it again, and try once more",
            )
        })?;
        // What was changed here meanwhile did not come from elsewhere.
        let shown = edited.since(shown);
        if *shown != **before.source() {
            let shown = self.compiled(path, edited, &shown);
            before.still_means(&shown, change)?;
        }
        let edits = edits(before, change)?;
        let text = before.source();
        let new = applied(text, &edits);
        let (mut after, mut note) = (None, None);
        if new != **text {
            let compiled = self.compiled(path, edited, &new);
            note = check(before, &compiled, change)?;
            after = Some(compiled);
        }
        Ok(Possible { edits, after, note })
    }

    /// The edits that undo or redo a step. A step that does not fit any more is forgotten, so that those before it can be undone.
    fn stepped(
        &self,
        path: &Path,
        edited: &mut Edited,
        before: &Analysis,
        action: &Action,
    ) -> Result<Vec<Edit>, NotChanged> {
        let is_undo = *action == Action::Undo;
        let step = match is_undo {
            true => edited.history.last(),
            false => edited.history.next(),
        };
        let step = step.ok_or_else(|| {
            refused(match is_undo {
                true => "there is nothing to undo",
                false => "there is nothing to redo",
            })
        })?;
        let title = step.change.title();
        let text = before.source();
        let found = step.undone(text).ok_or_else(|| {
            format!("what was changed is not there any more, because another program saved the drawing: {title} stays as it is")
        });
        let found = found.and_then(|found| {
            let after = self.compiled(path, edited, &applied(text, &found));
            let worse = no_worse(before, &after);
            worse.map_err(|refusal| refusal.why)?;
            edited.last = Some(after);
            Ok(found)
        });
        found.map_err(|why| {
            match is_undo {
                true => edited.history.forget_last(),
                false => edited.history.forget_next(),
            }
            refused(&why)
        })
    }

    /// The drawing as its file is now, once it has stayed the same for a while and can be read.
    fn settled(&self, path: &Path, edited: &mut Edited) -> Result<Arc<Analysis>, NotChanged> {
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
            let is_own = edited
                .made
                .back()
                .is_some_and(|[_, after]| **after == *text);
            let is_known = edited
                .last
                .as_ref()
                .is_some_and(|last| **last.source() == *text);
            let age = old.and_then(|(_, time)| time.elapsed().ok());
            let is_quiet = is_own || is_known || age.is_none_or(|age| age > SETTLED);
            if is_quiet || is_over {
                let analysis = self.compiled(path, edited, &text);
                if analysis.is_sound() {
                    edited.last = Some(analysis.clone());
                    return Ok(analysis);
                }
                if is_over {
                    return Err(refused(
                        "the drawing cannot be read as it is, or is being written: correct its errors first",
                    ));
                }
            }
            sleep(SETTLED);
        }
    }

    fn compiled(&self, path: &Path, edited: &mut Edited, text: &str) -> Arc<Analysis> {
        if let Some(last) = &edited.last
            && **last.source() == *text
        {
            return last.clone();
        }
        let folder = path.parent().map_or_else(PathBuf::new, Path::to_path_buf);
        let base = self.options.base.clone().unwrap_or(folder);
        let resolver = FolderResolver::new(base).allowing(self.options.root.as_deref());
        let options = compile::Options {
            tolerance: self.options.tolerance,
        };
        let compiled = edited.compiler.compile(text, &options, &resolver);
        Arc::new(Analysis::new(text, compiled))
    }
}

impl Edited {
    /// Keeps the texts before and after a change.
    fn know(&mut self, texts: [Arc<str>; 2]) {
        self.made.push_back(texts);
        let bytes = |made: &VecDeque<[Arc<str>; 2]>| -> usize {
            made.iter().map(|[_, after]| after.len()).sum()
        };
        while self.made.len() > MAX_KNOWN
            || self.made.len() > 1 && bytes(&self.made) > MAX_KNOWN_BYTES
        {
            self.made.pop_front();
        }
    }

    /// The text that changes made here have led to from this one.
    fn since(&self, shown: &str) -> Arc<str> {
        let mut text: Arc<str> = shown.into();
        for [before, after] in &self.made {
            if *before == text {
                text = after.clone();
            }
        }
        text
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
