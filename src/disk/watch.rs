//! Watches files, and reports changes once they have settled.
//!
//! Changes are debounced here, because the debouncers for notify wait a fixed time after every change: this one reports a
//! file as soon as its writer has closed it.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::time::{Duration, Instant, SystemTime};

use notify::event::{AccessKind, AccessMode, ModifyKind, RenameMode};
use notify::{Event, EventKind, RecommendedWatcher, RecursiveMode, Watcher};

use super::poll::Poll;

/// How long a file must stay unchanged to count as settled if the system does not report that it was closed: programs
/// write in pieces.
const SETTLED: Duration = Duration::from_millis(60);
/// How long files must stay unchanged after they were closed or renamed: programs save several files in a row.
const CLOSED: Duration = Duration::from_millis(3);
/// After how long files are reported even if they never settle.
const MAX_DELAY: Duration = Duration::from_secs(1);

/// How changes are detected.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) enum ChangeDetection {
    /// The operating system reports them.
    #[default]
    Native,
    /// Folders are polled at this interval, for file systems that do not report changes.
    Polling(Duration),
}

/// Files that changed and have settled.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Changed {
    /// The files, and the folders in which something was created or deleted, with the paths that the system reports.
    pub paths: BTreeSet<PathBuf>,
    /// When the first change was detected.
    pub noticed: SystemTime,
}

/// Watches folders rather than files, because programs replace files as well as write them, and files may not exist yet.
#[derive(Debug)]
pub(crate) struct FolderWatch {
    backend: Backend,
}

/// The implementation that watches the folders.
#[derive(Debug)]
enum Backend {
    Native(Mutex<(RecommendedWatcher, BTreeSet<PathBuf>)>),
    Polling(Poll),
}

impl FolderWatch {
    /// Calls `changed` on a thread of its own with the files that changed, once they have settled.
    ///
    /// # Errors
    ///
    /// If the system cannot report changes.
    pub(crate) fn new(
        detection: ChangeDetection,
        changed: impl FnMut(Changed) + Send + 'static,
    ) -> Result<Self, WatchError> {
        let (sender, receiver) = channel();
        let backend = match detection {
            ChangeDetection::Native => {
                let watcher = notify::recommended_watcher(move |event: notify::Result<Event>| {
                    if let Ok(event) = event
                        && let Some(state) = State::after(&event.kind)
                    {
                        // The receiver is gone only when the process ends.
                        let _ = sender.send((event.paths, state));
                    }
                })?;
                Backend::Native(Mutex::new((watcher, BTreeSet::new())))
            }
            ChangeDetection::Polling(pause) => Backend::Polling(Poll::new(pause, move |paths| {
                sender.send((paths, State::Open)).is_ok()
            })),
        };
        std::thread::spawn(move || debounce(&receiver, changed));
        Ok(Self { backend })
    }

    /// Sets the folders to watch. Returns those that cannot be watched, with the reasons.
    pub(crate) fn set(&self, folders: &BTreeSet<PathBuf>) -> Vec<(PathBuf, WatchError)> {
        let watch = match &self.backend {
            Backend::Native(watch) => watch,
            Backend::Polling(poll) => {
                poll.set(folders);
                return vec![];
            }
        };
        let mut guard = watch
            .lock()
            .unwrap_or_else(|poisoned| poisoned.into_inner());
        let (watcher, watched) = &mut *guard;
        for gone in watched.difference(folders) {
            let _ = watcher.unwatch(gone);
        }
        let mut kept: BTreeSet<PathBuf> = watched.intersection(folders).cloned().collect();
        let mut failed = vec![];
        for new in folders.difference(watched) {
            match watcher.watch(new, RecursiveMode::NonRecursive) {
                Ok(()) => {
                    kept.insert(new.clone());
                }
                Err(error) => failed.push((new.clone(), error.into())),
            }
        }
        *watched = kept;
        failed
    }
}

/// Why changes cannot be reported.
#[derive(Debug, thiserror::Error)]
#[error("{0}")]
pub(crate) struct WatchError(#[from] notify::Error);

/// The state of a file after a change.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum State {
    /// More changes may follow.
    Open,
    /// The writing program has closed it.
    Closed,
}

impl State {
    fn after(event: &EventKind) -> Option<Self> {
        match event {
            EventKind::Access(AccessKind::Close(AccessMode::Write))
            | EventKind::Modify(ModifyKind::Name(RenameMode::To | RenameMode::Both))
            | EventKind::Remove(_) => Some(Self::Closed),
            EventKind::Access(_) => None,
            _ => Some(Self::Open),
        }
    }
}

/// Collects paths until nothing has changed for a while, then reports them.
fn debounce(receiver: &Receiver<(Vec<PathBuf>, State)>, mut changed: impl FnMut(Changed)) {
    while let Ok((paths, state)) = receiver.recv() {
        let noticed = SystemTime::now();
        let late = Instant::now() + MAX_DELAY;
        let mut states: BTreeMap<PathBuf, State> = BTreeMap::new();
        let add = |states: &mut BTreeMap<_, _>, paths: Vec<PathBuf>, state| {
            states.extend(paths.into_iter().map(|path| (path, state)));
        };
        add(&mut states, paths, state);
        loop {
            let closed = states.values().all(|state| *state == State::Closed);
            let quiet = if closed { CLOSED } else { SETTLED };
            let quiet = quiet.min(late.saturating_duration_since(Instant::now()));
            match receiver.recv_timeout(quiet) {
                Ok((paths, state)) => add(&mut states, paths, state),
                Err(RecvTimeoutError::Timeout) => break,
                Err(RecvTimeoutError::Disconnected) => return,
            }
            if Instant::now() >= late {
                break;
            }
        }
        let paths = states.into_keys().collect();
        changed(Changed { paths, noticed });
    }
}

/// The path by which the system reports a file: symbolic links in the path of its folder are resolved. The file need not
/// exist.
pub(crate) fn event_path(file: &Path) -> PathBuf {
    let folder = match file.parent() {
        Some(folder) if folder.as_os_str().is_empty() => Path::new("."),
        Some(folder) => folder,
        None => return file.to_owned(),
    };
    let folder = std::fs::canonicalize(folder).unwrap_or_else(|_| folder.to_owned());
    match file.file_name() {
        Some(name) => folder.join(name),
        None => std::fs::canonicalize(file).unwrap_or_else(|_| file.to_owned()),
    }
}

/// All paths by which the system may report a file: its own, and that of the file it links to.
pub(crate) fn event_paths(file: &Path) -> BTreeSet<PathBuf> {
    let target = std::fs::canonicalize(file);
    target.into_iter().chain([event_path(file)]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;
    use std::io::Write;
    use std::sync::mpsc;

    /// The changes that are reported while `act` works in a folder.
    fn changes(detection: ChangeDetection, act: impl FnOnce(&Path)) -> Vec<BTreeSet<String>> {
        let folder = tempfile::tempdir().unwrap();
        let real = fs::canonicalize(folder.path()).unwrap();
        fs::write(real.join("a.svg"), "old").unwrap();
        let (sender, receiver) = mpsc::channel();
        let watch = FolderWatch::new(detection, move |changed| {
            let _ = sender.send(changed.paths);
        })
        .unwrap();
        assert!(watch.set(&BTreeSet::from([real.clone()])).is_empty());
        act(&real);
        let mut all = vec![];
        while let Ok(paths) = receiver.recv_timeout(Duration::from_millis(700)) {
            let names = paths.iter().filter_map(|path| path.file_name());
            all.push(
                names
                    .map(|name| name.to_string_lossy().into_owned())
                    .filter(|name| name.ends_with(".svg"))
                    .collect(),
            );
        }
        all.retain(|paths: &BTreeSet<String>| !paths.is_empty());
        all
    }

    fn a() -> BTreeSet<String> {
        BTreeSet::from(["a.svg".to_owned()])
    }

    #[test]
    fn a_save_in_pieces_is_reported_once() {
        let save = |folder: &Path| {
            let mut file = fs::File::create(folder.join("a.svg")).unwrap();
            for _ in 0..5 {
                file.write_all(&[b' '; 4096]).unwrap();
                std::thread::sleep(Duration::from_millis(10));
            }
        };
        assert_eq!(changes(ChangeDetection::Native, save), [a()]);
        let polled = changes(ChangeDetection::Polling(Duration::from_millis(50)), save);
        assert!(!polled.is_empty() && polled.iter().all(|paths| *paths == a()));
    }

    #[test]
    fn replaced_deleted_and_recreated_files_are_reported() {
        let replace = |folder: &Path| {
            fs::write(folder.join("b"), "new").unwrap();
            fs::rename(folder.join("b"), folder.join("a.svg")).unwrap();
        };
        assert_eq!(changes(ChangeDetection::Native, replace), [a()]);
        let again = |folder: &Path| {
            fs::remove_file(folder.join("a.svg")).unwrap();
            std::thread::sleep(Duration::from_millis(200));
            fs::write(folder.join("a.svg"), "new").unwrap();
        };
        assert_eq!(changes(ChangeDetection::Native, again), [a(), a()]);
    }

    #[test]
    fn files_that_never_settle_are_reported() {
        let restless = |folder: &Path| {
            let start = Instant::now();
            while start.elapsed() < Duration::from_millis(2200) {
                let mut file = fs::File::options()
                    .append(true)
                    .open(folder.join("a.svg"))
                    .unwrap();
                file.write_all(b" ").unwrap();
                std::thread::sleep(Duration::from_millis(1));
            }
        };
        assert!(changes(ChangeDetection::Native, restless).len() >= 2);
    }

    #[test]
    fn missing_folders_are_returned() {
        let watch = FolderWatch::new(ChangeDetection::Native, |_| ()).unwrap();
        let nowhere = PathBuf::from("nowhere/at/all");
        let failed = watch.set(&BTreeSet::from([nowhere.clone()]));
        assert_eq!(failed.len(), 1);
        assert_eq!(failed[0].0, nowhere);
    }
}
