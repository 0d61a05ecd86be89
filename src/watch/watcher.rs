//! All watched drawings, and when each is built next. The time is given to it, so that tests need not wait.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant, SystemTime};

use super::drawing::{Drawing, Outcome};
use super::{Event, Options};
use crate::disk::{
    Changed, FolderWatch, ReadError, below, event_path, event_paths, is_concerned, is_drawing,
};

/// How long a file may look half written before it is reported.
const INCOMPLETE_TIMEOUT: Duration = Duration::from_secs(1);
/// How long a file may be missing before it is reported: programs replace files.
const MISSING_TIMEOUT: Duration = Duration::from_millis(300);
/// The time between two attempts to read a file that looks half written or is missing.
const RETRY_INTERVAL: Duration = Duration::from_millis(50);

/// The drawings that are watched, and the folders in which they are looked for.
pub(super) struct Watcher {
    options: Options,
    folders: Vec<PathBuf>,
    /// These folders and all below them.
    subfolders: BTreeSet<PathBuf>,
    drawings: BTreeMap<PathBuf, Watched>,
    /// The folders whose changes the system reports.
    watched_folders: BTreeSet<PathBuf>,
    /// Folders that cannot be watched; each is reported once.
    unwatchable: BTreeSet<PathBuf>,
}

/// A drawing and the state of its file.
struct Watched {
    drawing: Drawing,
    /// The files that it is made from, under the names by which the system reports them.
    files: BTreeSet<PathBuf>,
    due: Option<Due>,
    /// Why the last attempt to build it failed, if it did: each failure is reported once.
    failure: Option<Failure>,
}

/// When a drawing is built next.
#[derive(Debug, Clone, Copy)]
struct Due {
    at: Instant,
    noticed: SystemTime,
    /// From this time on, a half-written file is read as it is.
    incomplete_until: Instant,
    /// From this time on, a missing file is reported.
    missing_until: Instant,
}

/// Why a drawing could not be read.
#[derive(Debug, PartialEq, Eq)]
enum Failure {
    Gone,
    Unreadable(String),
}

impl Due {
    /// After a change, whose writer may not have finished yet.
    fn after_change(noticed: SystemTime, now: Instant) -> Self {
        Self {
            at: now,
            noticed,
            incomplete_until: now + INCOMPLETE_TIMEOUT,
            missing_until: now + MISSING_TIMEOUT,
        }
    }

    /// For a drawing that nobody is known to be writing.
    fn at_once(now: Instant) -> Self {
        Self {
            at: now,
            noticed: SystemTime::now(),
            incomplete_until: now,
            missing_until: now,
        }
    }
}

impl Watcher {
    pub(super) fn new(targets: &[PathBuf], options: &Options, now: Instant) -> Self {
        let (folders, files): (Vec<PathBuf>, Vec<PathBuf>) =
            targets.iter().cloned().partition(|target| target.is_dir());
        let mut watcher = Self {
            options: options.clone(),
            folders,
            subfolders: BTreeSet::new(),
            drawings: BTreeMap::new(),
            watched_folders: BTreeSet::new(),
            unwatchable: BTreeSet::new(),
        };
        for file in files {
            watcher.add(&file, Due::at_once(now));
        }
        watcher.scan_folders(Due::at_once(now));
        watcher
    }

    pub(super) fn len(&self) -> usize {
        self.drawings.len()
    }

    /// Adds the drawings below the folders that are not there yet.
    fn scan_folders(&mut self, due: Due) {
        self.subfolders.clear();
        let mut drawings = vec![];
        for folder in &self.folders {
            let found = below(folder);
            let real = found.folders.iter().map(|folder| folder.join("any"));
            let real = real.filter_map(|file| event_path(&file).parent().map(Path::to_owned));
            self.subfolders.extend(real);
            drawings.extend(found.files.into_iter().filter(|file| is_drawing(file)));
        }
        for drawing in drawings {
            // Users write `a.svg`, not `./a.svg`.
            self.add(drawing.strip_prefix(".").unwrap_or(&drawing), due);
        }
    }

    fn add(&mut self, path: &Path, due: Due) {
        let key = event_path(path);
        let options = &self.options;
        self.drawings.entry(key).or_insert_with(|| {
            let drawing = Drawing::new(path, options);
            Watched {
                files: drawing.files().flat_map(event_paths).collect(),
                drawing,
                due: Some(due),
                failure: None,
            }
        });
    }

    /// When the next drawing is to be built.
    pub(super) fn next_due(&self) -> Option<Instant> {
        let dues = self.drawings.values().filter_map(|watched| watched.due);
        dues.map(|due| due.at).min()
    }

    /// Schedules builds of the drawings that a change concerns.
    pub(super) fn schedule(&mut self, changed: &Changed, now: Instant) {
        let due = Due::after_change(changed.noticed, now);
        for watched in self.drawings.values_mut() {
            if watched
                .files
                .iter()
                .any(|file| is_concerned(file, &changed.paths))
            {
                watched.due = Some(due);
            }
        }
        let is_new = |path: &PathBuf| {
            path.is_dir() || (is_drawing(path) && !self.drawings.contains_key(path))
        };
        if !self.folders.is_empty() && changed.paths.iter().any(is_new) {
            self.scan_folders(due);
        }
    }

    /// Builds the drawings that are due.
    pub(super) fn build(&mut self, now: Instant, report: &mut impl FnMut(Event<'_>)) {
        for watched in self.drawings.values_mut() {
            if let Some(due) = watched.due.filter(|due| due.at <= now) {
                watched.due = None;
                watched.build(due, now, report);
            }
        }
    }

    /// Watches the folders of all files.
    pub(super) fn watch_folders(
        &mut self,
        watch: &FolderWatch,
        now: Instant,
        report: &mut impl FnMut(Event<'_>),
    ) {
        let files = self.drawings.values().flat_map(|watched| &watched.files);
        let mut folders: BTreeSet<PathBuf> = files
            .filter_map(|file| file.parent().map(Path::to_owned))
            .collect();
        folders.extend(self.subfolders.iter().cloned());
        let failed = watch.set(&folders);
        folders.retain(|folder| folder.is_dir());
        for (folder, error) in failed {
            if self.unwatchable.insert(folder.clone()) {
                report(Event::Unwatchable(&folder, error.to_string()));
            }
        }
        // The system does not report what changed after a file was read, or a folder was searched, and before the folder was watched.
        let due = Due::after_change(SystemTime::now(), now);
        let is_new = |file: &PathBuf| {
            let folder = file.parent();
            folder.is_some_and(|folder| {
                folders.contains(folder) && !self.watched_folders.contains(folder)
            })
        };
        for watched in self.drawings.values_mut() {
            if watched.due.is_none() && watched.files.iter().any(is_new) {
                watched.due = Some(due);
            }
        }
        let known = std::mem::replace(&mut self.watched_folders, folders);
        let mut searched = self.subfolders.intersection(&self.watched_folders);
        if searched.any(|folder| !known.contains(folder)) {
            self.scan_folders(due);
        }
    }
}

impl Watched {
    fn build(&mut self, due: Due, now: Instant, report: &mut impl FnMut(Event<'_>)) {
        let retry = Some(Due {
            at: now + RETRY_INTERVAL,
            ..due
        });
        let is_final = now >= due.incomplete_until;
        let failure = match self.drawing.build(due.noticed, is_final) {
            Ok(Outcome::Incomplete) => {
                self.due = retry;
                return;
            }
            Ok(Outcome::Unchanged) => {
                if self.failure.take().is_some() {
                    report(Event::Back(self.drawing.path()));
                }
                return;
            }
            Ok(Outcome::Built(build)) => {
                self.failure = None;
                let linked = self.drawing.linked();
                let files = linked.chain(self.drawing.files().map(Path::to_owned));
                self.files = files.flat_map(|file| event_paths(&file)).collect();
                report(Event::Built(self.drawing.path(), &build));
                return;
            }
            Err(ReadError::Missing { .. }) if now < due.missing_until => {
                self.due = retry;
                return;
            }
            Err(ReadError::Damaged { .. }) if !is_final => {
                self.due = retry;
                return;
            }
            Err(ReadError::Missing { .. }) => Failure::Gone,
            Err(error) => Failure::Unreadable(error.to_string()),
        };
        if self.failure.as_ref() != Some(&failure) {
            report(match &failure {
                Failure::Gone => Event::Gone(self.drawing.path()),
                Failure::Unreadable(why) => Event::Unreadable(self.drawing.path(), why.clone()),
            });
            self.failure = Some(failure);
        }
    }
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;
    use crate::disk::ChangeDetection;
    use crate::watch::NoModel;

    const DRAWING: &str = r#"<svg xmlns="http://www.w3.org/2000/svg" width="100" height="100">
        <circle id="ball" cx="50" cy="50" r="20"/></svg>"#;

    fn watcher(target: &Path, now: Instant) -> Watcher {
        Watcher::new(&[target.to_owned()], &Options::default(), now)
    }

    /// The events that are due at a time, in words.
    fn events(watcher: &mut Watcher, now: Instant) -> Vec<String> {
        let mut events = vec![];
        watcher.build(now, &mut |event| {
            events.push(match event {
                Event::Built(path, build) => match &build.model {
                    Ok(model) => format!("built {} {}", name(path), model.written.triangles > 0),
                    Err(NoModel::Errors) => format!("errors {}", name(path)),
                    Err(NoModel::Unwritten(why)) => format!("unwritten {why}"),
                },
                Event::Gone(path) => format!("gone {}", name(path)),
                Event::Back(path) => format!("back {}", name(path)),
                Event::Unreadable(path, _) => format!("unreadable {}", name(path)),
                Event::Unwatchable(path, _) => format!("unwatchable {}", name(path)),
                Event::Ready(count) => format!("ready {count}"),
            });
        });
        events
    }

    fn name(path: &Path) -> String {
        path.file_name().unwrap().to_string_lossy().into_owned()
    }

    fn changed(paths: &[&Path]) -> Changed {
        Changed {
            noticed: SystemTime::now(),
            paths: paths.iter().map(|path| event_path(path)).collect(),
        }
    }

    /// The first events, and how long after a time they come.
    fn next_events(watcher: &mut Watcher, start: Instant) -> (Vec<String>, Duration) {
        loop {
            let due = watcher.next_due().expect("a build is due");
            let events = events(watcher, due);
            if !events.is_empty() {
                return (events, due - start);
            }
        }
    }

    #[test]
    fn a_drawing_is_built_once_a_change() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.svg");
        fs::write(&path, DRAWING).unwrap();
        let now = Instant::now();
        let mut watcher = watcher(&path, now);
        assert_eq!(events(&mut watcher, now), ["built a.svg true"]);
        assert_eq!(watcher.next_due(), None);
        // A change of another file, and one that leaves the content as it was.
        watcher.schedule(&changed(&[&folder.path().join("b.svg")]), now);
        assert_eq!(watcher.next_due(), None);
        watcher.schedule(&changed(&[&path]), now);
        assert_eq!(events(&mut watcher, now), [""; 0]);
        fs::write(&path, DRAWING.replace("\"20\"", "\"30\"")).unwrap();
        watcher.schedule(&changed(&[&path]), now);
        assert_eq!(events(&mut watcher, now), ["built a.svg true"]);
        assert_eq!(events(&mut watcher, now), [""; 0]);
    }

    #[test]
    fn new_drawings_below_a_folder_are_found() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("sub/b.svg");
        let now = Instant::now();
        let mut watcher = watcher(folder.path(), now);
        assert_eq!((watcher.len(), watcher.next_due()), (0, None));
        fs::create_dir(folder.path().join("sub")).unwrap();
        fs::write(&path, DRAWING).unwrap();
        watcher.schedule(&changed(&[&path]), now);
        assert_eq!(watcher.len(), 1);
        assert_eq!(events(&mut watcher, now), ["built b.svg true"]);
    }

    #[test]
    fn a_missing_file_is_reported_once_and_only_after_a_while() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.svg");
        fs::write(&path, DRAWING).unwrap();
        let now = Instant::now();
        let mut watcher = watcher(&path, now);
        events(&mut watcher, now);
        fs::remove_file(&path).unwrap();
        watcher.schedule(&changed(&[&path]), now);
        let (reported, after) = next_events(&mut watcher, now);
        assert_eq!(reported, ["gone a.svg"]);
        assert_eq!(after, MISSING_TIMEOUT);
        assert_eq!(watcher.next_due(), None);
        fs::write(&path, DRAWING).unwrap();
        watcher.schedule(&changed(&[&path]), now);
        assert_eq!(events(&mut watcher, now), ["back a.svg"]);
    }

    #[test]
    fn a_half_written_drawing_is_read_again() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.svg");
        fs::write(&path, DRAWING).unwrap();
        let now = Instant::now();
        let mut watcher = watcher(&path, now);
        events(&mut watcher, now);
        fs::write(&path, "").unwrap();
        watcher.schedule(&changed(&[&path]), now);
        assert_eq!(events(&mut watcher, now), [""; 0]);
        fs::write(&path, DRAWING.replace("ball", "wheel")).unwrap();
        let (reported, after) = next_events(&mut watcher, now);
        assert_eq!(reported, ["built a.svg true"]);
        assert_eq!(after, RETRY_INTERVAL);
    }

    #[test]
    fn a_cut_drawing_is_an_error_once_and_only_after_a_while() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.svg");
        fs::write(&path, DRAWING).unwrap();
        let now = Instant::now();
        let mut watcher = watcher(&path, now);
        events(&mut watcher, now);
        fs::write(&path, &DRAWING[..DRAWING.len() / 2]).unwrap();
        watcher.schedule(&changed(&[&path]), now);
        let (reported, after) = next_events(&mut watcher, now);
        assert_eq!(reported, ["errors a.svg"]);
        assert_eq!(after, INCOMPLETE_TIMEOUT);
        assert_eq!(watcher.next_due(), None);
    }

    #[test]
    fn a_drawing_written_before_its_folder_is_watched_is_found() {
        let folder = tempfile::tempdir().unwrap();
        let inner = folder.path().join("sub");
        let watch = FolderWatch::new(ChangeDetection::default(), |_| ()).unwrap();
        let now = Instant::now();
        let mut watcher = watcher(folder.path(), now);
        watcher.watch_folders(&watch, now, &mut |_| ());
        fs::create_dir(&inner).unwrap();
        watcher.schedule(&changed(&[&inner]), now);
        assert_eq!(watcher.len(), 0);
        fs::write(inner.join("b.svg"), DRAWING).unwrap();
        watcher.watch_folders(&watch, now, &mut |_| ());
        assert_eq!(events(&mut watcher, now), ["built b.svg true"]);
    }

    #[test]
    fn files_that_change_before_their_folder_is_watched_are_read_again() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.svg");
        fs::write(&path, DRAWING).unwrap();
        let watch = FolderWatch::new(ChangeDetection::default(), |_| ()).unwrap();
        let now = Instant::now();
        let mut watcher = watcher(&path, now);
        events(&mut watcher, now);
        watcher.watch_folders(&watch, now, &mut |_| ());
        assert!(watcher.next_due().is_some());
        assert_eq!(events(&mut watcher, now), [""; 0]);
        watcher.watch_folders(&watch, now, &mut |_| ());
        assert_eq!(watcher.next_due(), None);
    }
}
