//! Tells when files change.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::time::{Duration, Instant, SystemTime};

use notify::event::{AccessKind, AccessMode, ModifyKind, RenameMode};
use notify::{Event, EventKind, RecommendedWatcher, RecursiveMode, Watcher};

use super::poll::Poll;

/// How long nothing must happen before files count as settled, where the system does not say that they were closed:
/// programs write in pieces.
const SETTLED: Duration = Duration::from_millis(60);
/// How long nothing must happen to files that were closed, or renamed to their name: programs touch several in a row.
const CLOSED: Duration = Duration::from_millis(3);
/// After how long files are told of that never settle.
const PATIENCE: Duration = Duration::from_secs(1);

/// How changes are noticed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Notice {
    /// The system tells of them.
    #[default]
    Told,
    /// Folders are looked at again and again, so often: for file systems that tell nothing.
    Polled(Duration),
}

/// Files that changed, and have settled.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Changed {
    /// The files, and folders in which something was created or deleted, as the system names them.
    pub paths: BTreeSet<PathBuf>,
    /// When the first sign of it came.
    pub noticed: SystemTime,
}

/// Watches folders, since programs replace files as well as write them, and files may not be there yet.
#[derive(Debug)]
pub struct FolderWatch {
    way: Way,
}

/// How folders are watched.
#[derive(Debug)]
enum Way {
    Told(Mutex<(RecommendedWatcher, BTreeSet<PathBuf>)>),
    Polled(Poll),
}

impl FolderWatch {
    /// A watch that calls `changed` with the files that changed, on a thread of its own, once they have settled.
    ///
    /// # Errors
    /// Where the system cannot tell of changes.
    pub fn new(
        notice: Notice,
        changed: impl FnMut(Changed) + Send + 'static,
    ) -> Result<Self, WatchError> {
        let (sender, receiver) = channel();
        let way = match notice {
            Notice::Told => {
                let watcher = notify::recommended_watcher(move |event: notify::Result<Event>| {
                    if let Ok(event) = event
                        && let Some(state) = State::after(&event.kind)
                    {
                        // Nobody listens any more only when the process ends.
                        let _ = sender.send((event.paths, state));
                    }
                })?;
                Way::Told(Mutex::new((watcher, BTreeSet::new())))
            }
            Notice::Polled(pause) => Way::Polled(Poll::new(pause, move |paths| {
                sender.send((paths, State::Open)).is_ok()
            })),
        };
        std::thread::spawn(move || tell(&receiver, changed));
        Ok(Self { way })
    }

    /// Watches these folders and no others. Those that cannot be watched are answered, with the reason.
    pub fn set(&self, folders: &BTreeSet<PathBuf>) -> Vec<(PathBuf, WatchError)> {
        let watch = match &self.way {
            Way::Told(watch) => watch,
            Way::Polled(poll) => {
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

/// Why changes are not told of.
#[derive(Debug, thiserror::Error)]
#[error("{0}")]
pub struct WatchError(#[from] notify::Error);

/// What a file is in after something happened to it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum State {
    /// More may come.
    Open,
    /// What wrote it has closed it.
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

/// Gathers paths until nothing has happened for a while, then tells them.
fn tell(receiver: &Receiver<(Vec<PathBuf>, State)>, mut changed: impl FnMut(Changed)) {
    while let Ok((paths, state)) = receiver.recv() {
        let noticed = SystemTime::now();
        let late = Instant::now() + PATIENCE;
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

/// A file's path as the system tells it: links in the path of its folder are followed, and the file need not be there.
pub fn as_told(file: &Path) -> PathBuf {
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

/// All paths by which the system may tell of a file: its own, and that of the file that it is a link to.
pub fn names_told(file: &Path) -> BTreeSet<PathBuf> {
    let target = std::fs::canonicalize(file);
    target.into_iter().chain([as_told(file)]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;
    use std::io::Write;
    use std::sync::mpsc;

    /// What is told while `act` works in a folder.
    fn told(notice: Notice, act: impl FnOnce(&Path)) -> Vec<BTreeSet<String>> {
        let folder = tempfile::tempdir().unwrap();
        let real = fs::canonicalize(folder.path()).unwrap();
        fs::write(real.join("a.svg"), "old").unwrap();
        let (sender, receiver) = mpsc::channel();
        let watch = FolderWatch::new(notice, move |changed| {
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
    fn a_save_in_pieces_is_told_once() {
        let save = |folder: &Path| {
            let mut file = fs::File::create(folder.join("a.svg")).unwrap();
            for _ in 0..5 {
                file.write_all(&[b' '; 4096]).unwrap();
                std::thread::sleep(Duration::from_millis(10));
            }
        };
        assert_eq!(told(Notice::Told, save), [a()]);
        let polled = told(Notice::Polled(Duration::from_millis(50)), save);
        assert!(!polled.is_empty() && polled.iter().all(|paths| *paths == a()));
    }

    #[test]
    fn files_may_be_replaced_deleted_and_made_anew() {
        let replace = |folder: &Path| {
            fs::write(folder.join("b"), "new").unwrap();
            fs::rename(folder.join("b"), folder.join("a.svg")).unwrap();
        };
        assert_eq!(told(Notice::Told, replace), [a()]);
        let again = |folder: &Path| {
            fs::remove_file(folder.join("a.svg")).unwrap();
            std::thread::sleep(Duration::from_millis(200));
            fs::write(folder.join("a.svg"), "new").unwrap();
        };
        assert_eq!(told(Notice::Told, again), [a(), a()]);
    }

    #[test]
    fn what_never_settles_is_told_too() {
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
        assert!(told(Notice::Told, restless).len() >= 2);
    }

    #[test]
    fn folders_that_are_not_there_are_named() {
        let watch = FolderWatch::new(Notice::Told, |_| ()).unwrap();
        let nowhere = PathBuf::from("nowhere/at/all");
        let failed = watch.set(&BTreeSet::from([nowhere.clone()]));
        assert_eq!(failed.len(), 1);
        assert_eq!(failed[0].0, nowhere);
    }
}
