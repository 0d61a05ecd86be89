//! All drawings that are watched, and what is to be done about them.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant, SystemTime};

use super::drawing::{Again, Drawing};
use super::{Event, Options};
use crate::disk::{Changed, FolderWatch, ReadError, as_told, below, is_drawing, names_told};

/// How long a file may look half written before that is told.
const PATIENCE: Duration = Duration::from_secs(1);
/// How long a file may be missing before that is told: programs replace files.
const ABSENCE: Duration = Duration::from_millis(300);
/// How long until a file that looks half written is looked at again.
const PAUSE: Duration = Duration::from_millis(50);

/// See the module.
pub(super) struct Round {
    options: Options,
    folders: Vec<PathBuf>,
    /// These and the folders below them.
    inner: BTreeSet<PathBuf>,
    drawings: BTreeMap<PathBuf, Watched>,
    /// The folders that are watched.
    heard: BTreeSet<PathBuf>,
    /// Folders that are not watched, told once.
    deaf: BTreeSet<PathBuf>,
}

/// A drawing, and what is known of its file.
struct Watched {
    drawing: Drawing,
    /// The files that it is made from, as the system tells them.
    files: BTreeSet<PathBuf>,
    due: Option<Due>,
    /// What was told last that was no build.
    told: Option<Told>,
}

/// When a drawing is to be looked at.
#[derive(Clone, Copy)]
struct Due {
    at: Instant,
    noticed: SystemTime,
    /// Until when it may look half written, and until when it may be missing.
    final_from: Instant,
    gone_from: Instant,
}

#[derive(PartialEq)]
enum Told {
    Gone,
    Unreadable(String),
}

impl Due {
    fn after(noticed: SystemTime) -> Self {
        let now = Instant::now();
        Self {
            at: now,
            noticed,
            final_from: now + PATIENCE,
            gone_from: now + ABSENCE,
        }
    }

    /// A drawing that nobody is writing, as far as is known.
    fn at_once() -> Self {
        let now = Instant::now();
        Self {
            at: now,
            noticed: SystemTime::now(),
            final_from: now,
            gone_from: now,
        }
    }
}

impl Round {
    pub(super) fn new(targets: &[PathBuf], options: &Options) -> Self {
        let (folders, files): (Vec<PathBuf>, Vec<PathBuf>) =
            targets.iter().cloned().partition(|target| target.is_dir());
        let mut round = Self {
            options: options.clone(),
            folders,
            inner: BTreeSet::new(),
            drawings: BTreeMap::new(),
            heard: BTreeSet::new(),
            deaf: BTreeSet::new(),
        };
        for file in files {
            round.add(&file, Due::at_once());
        }
        round.find(Due::at_once());
        round
    }

    pub(super) fn len(&self) -> usize {
        self.drawings.len()
    }

    /// Takes up the drawings below the folders.
    fn find(&mut self, due: Due) {
        self.inner.clear();
        let mut drawings = vec![];
        for folder in &self.folders {
            let found = below(folder);
            let real = found.folders.iter().map(|folder| folder.join("any"));
            let real = real.filter_map(|file| as_told(&file).parent().map(Path::to_owned));
            self.inner.extend(real);
            drawings.extend(found.files.into_iter().filter(|file| is_drawing(file)));
        }
        for drawing in drawings {
            // `./a.svg` is `a.svg` to people.
            self.add(drawing.strip_prefix(".").unwrap_or(&drawing), due);
        }
    }

    fn add(&mut self, path: &Path, due: Due) {
        let key = as_told(path);
        let options = &self.options;
        self.drawings.entry(key).or_insert_with(|| Watched {
            drawing: Drawing::new(path, options),
            files: names_told(path),
            due: Some(due),
            told: None,
        });
    }

    /// When the next drawing is to be looked at.
    pub(super) fn due(&self) -> Option<Instant> {
        let dues = self.drawings.values().filter_map(|watched| watched.due);
        dues.map(|due| due.at).min()
    }

    /// Takes down what is to be built.
    pub(super) fn note(&mut self, changed: &Changed) {
        let due = Due::after(changed.noticed);
        for watched in self.drawings.values_mut() {
            if !watched.files.is_disjoint(&changed.paths) {
                watched.due = Some(due);
            }
        }
        let unknown = |path: &&PathBuf| is_drawing(path) && !self.drawings.contains_key(*path);
        let folders = |path: &&PathBuf| path.is_dir();
        let is_new = changed
            .paths
            .iter()
            .any(|path| unknown(&path) || folders(&path));
        if is_new && !self.folders.is_empty() {
            self.find(due);
        }
    }

    /// Builds what is due.
    pub(super) fn build(&mut self, tell: &mut impl FnMut(Event<'_>)) {
        let now = Instant::now();
        for watched in self.drawings.values_mut() {
            if let Some(due) = watched.due.filter(|due| due.at <= now) {
                watched.due = None;
                watched.look(due, tell);
            }
        }
    }

    /// Watches the folders in which all files lie.
    pub(super) fn listen(&mut self, watch: &FolderWatch, tell: &mut impl FnMut(Event<'_>)) {
        let files = self.drawings.values().flat_map(|watched| &watched.files);
        let mut folders: BTreeSet<PathBuf> = files
            .filter_map(|file| file.parent().map(Path::to_owned))
            .collect();
        folders.extend(self.inner.iter().cloned());
        // One that was deleted is watched anew when it is back.
        folders.retain(|folder| folder.is_dir());
        for (folder, error) in watch.set(&folders) {
            if self.deaf.insert(folder.clone()) {
                tell(Event::Deaf(&folder, error.to_string()));
            }
        }
        // What changed after it was read, and before its folder was watched, was not told.
        let is_new = |file: &PathBuf| {
            let folder = file.parent();
            folder.is_some_and(|folder| folders.contains(folder) && !self.heard.contains(folder))
        };
        for watched in self.drawings.values_mut() {
            if watched.due.is_none() && watched.files.iter().any(is_new) {
                watched.due = Some(Due::after(SystemTime::now()));
            }
        }
        self.heard = folders;
    }
}

impl Watched {
    fn look(&mut self, due: Due, tell: &mut impl FnMut(Event<'_>)) {
        let now = Instant::now();
        let again = Some(Due {
            at: now + PAUSE,
            ..due
        });
        match self.drawing.build(due.noticed, now >= due.final_from) {
            Ok(Again::Unfinished) => self.due = again,
            Ok(Again::Same) => {
                if self.told.take().is_some() {
                    tell(Event::Back(self.drawing.path()));
                }
            }
            Ok(Again::Built(build)) => {
                self.told = None;
                let linked = self.drawing.linked();
                let files = linked.chain([self.drawing.path().to_owned()]);
                self.files = files.flat_map(|file| names_told(&file)).collect();
                tell(Event::Built(self.drawing.path(), &build));
            }
            Err(ReadError::Missing(_)) if now < due.gone_from => self.due = again,
            Err(ReadError::Damaged { .. }) if now < due.final_from => self.due = again,
            Err(error) => {
                let told = match error {
                    ReadError::Missing(_) => Told::Gone,
                    error => Told::Unreadable(error.to_string()),
                };
                if self.told.as_ref() == Some(&told) {
                    return;
                }
                match &told {
                    Told::Gone => tell(Event::Gone(self.drawing.path())),
                    Told::Unreadable(why) => {
                        tell(Event::Unreadable(self.drawing.path(), why.clone()));
                    }
                }
                self.told = Some(told);
            }
        }
    }
}
