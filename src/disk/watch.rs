//! Watches files, and reports changes once they have settled.
//!
//! Changes are debounced here, because the debouncers for notify wait a fixed time after every change: this one reports a
//! file as soon as its writer has closed it.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError, Weak};
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

/// Watches folders rather than files, because programs replace files as well as write them, and files may not exist yet. Nor need the
/// folders: each is watched as soon as it exists.
#[derive(Debug)]
pub(crate) struct FolderWatch {
    backend: Backend,
}

/// The implementation that watches the folders.
#[derive(Debug)]
enum Backend {
    Native(Arc<Mutex<Native>>),
    Polling(Poll),
}

/// Folders whose changes the system reports.
#[derive(Debug)]
struct Native<W = RecommendedWatcher> {
    watcher: W,
    wanted: BTreeSet<PathBuf>,
    /// Those of them that exist, and of the others the nearest folder above that does.
    watched: BTreeSet<PathBuf>,
}

impl<W: Watcher> Native<W> {
    /// Watches the wanted folders that exist now. Returns those that cannot be watched, with the reasons.
    fn renew(&mut self) -> Vec<(PathBuf, WatchError)> {
        loop {
            let folders = self.wanted.iter().filter_map(|folder| nearest(folder));
            let folders: BTreeSet<PathBuf> = folders.map(Path::to_owned).collect();
            for gone in self.watched.difference(&folders) {
                // Of a folder that was deleted the system forgot this already.
                let _ = self.watcher.unwatch(gone);
            }
            self.watched.retain(|folder| folders.contains(folder));
            let mut failed = vec![];
            let mut is_changed = false;
            for new in folders {
                if self.watched.contains(&new) {
                    continue;
                }
                match self.watcher.watch(&new, RecursiveMode::NonRecursive) {
                    Ok(()) => is_changed |= self.watched.insert(new),
                    // It was deleted since it was found: the one above it is watched instead.
                    Err(_) if !new.is_dir() => is_changed = true,
                    Err(error) if self.wanted.contains(&new) => failed.push((new, error.into())),
                    Err(_) => {}
                }
            }
            // A wanted folder may have been created before the one above it was watched.
            if !is_changed {
                return failed;
            }
        }
    }

    /// Watches the folders that were created, and those that were deleted and created again.
    fn follow(&mut self, changed: &BTreeSet<PathBuf>) {
        let lost = self.watched.intersection(changed).cloned();
        for folder in lost.collect::<Vec<_>>() {
            let _ = self.watcher.unwatch(&folder);
            self.watched.remove(&folder);
        }
        // Whoever sets the folders was told about those that cannot be watched.
        self.renew();
    }
}

/// A folder, or the nearest one above it that exists.
fn nearest(folder: &Path) -> Option<&Path> {
    folder.ancestors().find(|folder| folder.is_dir())
}

impl FolderWatch {
    /// Calls `changed` on a thread of its own with the files that changed, once they have settled.
    ///
    /// # Errors
    ///
    /// If the system cannot report changes.
    pub(crate) fn new(
        detection: ChangeDetection,
        mut changed: impl FnMut(Changed) + Send + 'static,
    ) -> Result<Self, WatchError> {
        let (sender, receiver) = channel();
        let (backend, native) = match detection {
            ChangeDetection::Native => {
                let watcher = notify::recommended_watcher(move |event: notify::Result<Event>| {
                    if let Ok(event) = event
                        && let Some(state) = State::after(&event.kind)
                    {
                        // The receiver is gone only when the process ends.
                        let _ = sender.send((event.paths, state));
                    }
                })?;
                let native = Arc::new(Mutex::new(Native {
                    watcher,
                    wanted: BTreeSet::new(),
                    watched: BTreeSet::new(),
                }));
                let weak = Arc::downgrade(&native);
                (Backend::Native(native), weak)
            }
            ChangeDetection::Polling(pause) => {
                let poll = Poll::new(pause, move |paths| {
                    sender.send((paths, State::Open)).is_ok()
                });
                (Backend::Polling(poll), Weak::new())
            }
        };
        std::thread::spawn(move || {
            debounce(&receiver, |settled: Changed| {
                // First, so that a file which is written after it was reported is reported again.
                if let Some(native) = native.upgrade() {
                    lock(&native).follow(&settled.paths);
                }
                changed(settled);
            });
        });
        Ok(Self { backend })
    }

    /// Sets the folders to watch. Returns those that exist and cannot be watched, with the reasons.
    pub(crate) fn set(&self, folders: &BTreeSet<PathBuf>) -> Vec<(PathBuf, WatchError)> {
        match &self.backend {
            Backend::Native(native) => {
                let mut native = lock(native);
                native.wanted.clone_from(folders);
                native.renew()
            }
            Backend::Polling(poll) => {
                poll.set(folders);
                vec![]
            }
        }
    }
}

fn lock(native: &Mutex<Native>) -> MutexGuard<'_, Native> {
    native.lock().unwrap_or_else(PoisonError::into_inner)
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

/// Changes that have not settled.
struct Unsettled {
    noticed: SystemTime,
    /// When they are reported in any case.
    late: Instant,
    states: BTreeMap<PathBuf, State>,
}

impl Unsettled {
    fn new(now: Instant) -> Self {
        Self {
            noticed: SystemTime::now(),
            late: now + MAX_DELAY,
            states: BTreeMap::new(),
        }
    }

    fn add(&mut self, paths: Vec<PathBuf>, state: State) {
        self.states
            .extend(paths.into_iter().map(|path| (path, state)));
    }

    /// For how long nothing must change until they have settled.
    fn quiet(&self, now: Instant) -> Duration {
        let closed = self.states.values().all(|state| *state == State::Closed);
        let quiet = if closed { CLOSED } else { SETTLED };
        quiet.min(self.late.saturating_duration_since(now))
    }

    fn settled(self) -> Changed {
        Changed {
            paths: self.states.into_keys().collect(),
            noticed: self.noticed,
        }
    }
}

/// Collects paths until nothing has changed for a while, then reports them.
fn debounce(receiver: &Receiver<(Vec<PathBuf>, State)>, mut changed: impl FnMut(Changed)) {
    while let Ok((paths, state)) = receiver.recv() {
        let mut unsettled = Unsettled::new(Instant::now());
        unsettled.add(paths, state);
        loop {
            let quiet = unsettled.quiet(Instant::now());
            match receiver.recv_timeout(quiet) {
                Ok((paths, state)) => unsettled.add(paths, state),
                Err(RecvTimeoutError::Timeout) => break,
                Err(RecvTimeoutError::Disconnected) => return,
            }
            if Instant::now() >= unsettled.late {
                break;
            }
        }
        changed(unsettled.settled());
    }
}

/// The path by which the system reports a file: symbolic links in the path of its folder are resolved. Neither the file nor its folder
/// need exist.
pub(crate) fn event_path(file: &Path) -> PathBuf {
    if file.file_name().is_none() {
        return fs::canonicalize(file).unwrap_or_else(|_| file.to_owned());
    }
    for folder in file.ancestors().skip(1) {
        let real = if folder.as_os_str().is_empty() {
            Path::new(".")
        } else {
            folder
        };
        if let Ok(real) = fs::canonicalize(real)
            && let Ok(rest) = file.strip_prefix(folder)
        {
            return real.join(rest);
        }
    }
    file.to_owned()
}

/// Whether a file, or a folder that it is in, is among those that changed.
pub(crate) fn is_concerned(file: &Path, changed: &BTreeSet<PathBuf>) -> bool {
    file.ancestors().any(|path| changed.contains(path))
}

/// All paths by which the system may report a file: its own, and that of the file it links to.
pub(crate) fn event_paths(file: &Path) -> BTreeSet<PathBuf> {
    let target = fs::canonicalize(file);
    target.into_iter().chain([event_path(file)]).collect()
}

#[cfg(test)]
mod tests {
    use std::io::Write;

    use super::*;
    use crate::patience::{PATIENCE, wait_until};

    /// A watched folder with a drawing, and what is reported of it.
    struct Watched {
        folder: tempfile::TempDir,
        reports: Receiver<BTreeSet<PathBuf>>,
        _watch: FolderWatch,
    }

    impl Watched {
        fn new(detection: ChangeDetection) -> Self {
            let folder = tempfile::tempdir().unwrap();
            let real = fs::canonicalize(folder.path()).unwrap();
            fs::write(real.join("a.svg"), "old").unwrap();
            let (sender, reports) = channel();
            let watch = FolderWatch::new(detection, move |changed| {
                let _ = sender.send(changed.paths);
            })
            .unwrap();
            assert!(watch.set(&BTreeSet::from([real])).is_empty());
            Self {
                folder,
                reports,
                _watch: watch,
            }
        }

        fn path(&self, name: &str) -> PathBuf {
            self.folder.path().join(name)
        }

        /// Waits until a file is reported. Gives the names of all drawings that were reported until then.
        fn until(&self, name: &str) -> BTreeSet<String> {
            let mut names = BTreeSet::new();
            while !names.contains(name) {
                let paths = self.reports.recv_timeout(PATIENCE).expect(name);
                let reported = paths.iter().filter_map(|path| path.file_name());
                let reported = reported.map(|name| name.to_string_lossy().into_owned());
                names.extend(reported.filter(|name| name.ends_with(".svg")));
            }
            names
        }
    }

    fn only(name: &str) -> BTreeSet<String> {
        BTreeSet::from([name.to_owned()])
    }

    #[test]
    fn saved_replaced_deleted_and_recreated_files_are_reported() {
        for detection in [
            ChangeDetection::Native,
            ChangeDetection::Polling(Duration::from_millis(50)),
        ] {
            let watched = Watched::new(detection);
            let path = watched.path("a.svg");
            let mut file = fs::File::create(&path).unwrap();
            for _ in 0..5 {
                file.write_all(&[b' '; 4096]).unwrap();
            }
            drop(file);
            assert_eq!(watched.until("a.svg"), only("a.svg"));
            fs::write(watched.path("b"), "new").unwrap();
            fs::rename(watched.path("b"), &path).unwrap();
            assert_eq!(watched.until("a.svg"), only("a.svg"));
            fs::remove_file(&path).unwrap();
            assert_eq!(watched.until("a.svg"), only("a.svg"));
            fs::write(&path, "newer").unwrap();
            assert_eq!(watched.until("a.svg"), only("a.svg"));
        }
    }

    #[test]
    fn changes_settle_sooner_when_files_are_closed() {
        let now = Instant::now();
        let mut unsettled = Unsettled::new(now);
        let path = |name: &str| vec![PathBuf::from(name)];
        unsettled.add(path("a"), State::Open);
        assert_eq!(unsettled.quiet(now), SETTLED);
        unsettled.add(path("b"), State::Closed);
        assert_eq!(unsettled.quiet(now), SETTLED);
        unsettled.add(path("a"), State::Closed);
        assert_eq!(unsettled.quiet(now), CLOSED);
        // What never settles is reported late.
        unsettled.add(path("a"), State::Open);
        let later = |delay| unsettled.quiet(now + delay);
        assert_eq!(later(MAX_DELAY - SETTLED), SETTLED);
        assert_eq!(later(MAX_DELAY - CLOSED), CLOSED);
        assert_eq!(later(2 * MAX_DELAY), Duration::ZERO);
        let paths = unsettled.settled().paths;
        assert_eq!(paths, ["a", "b"].map(PathBuf::from).into());
    }

    /// Many saves at once are one report.
    #[test]
    fn changes_before_a_pause_are_reported_together() {
        let (sender, receiver) = channel();
        for state in [State::Open, State::Open, State::Closed] {
            sender.send((vec![PathBuf::from("a")], state)).unwrap();
        }
        let (reports, reported) = channel();
        std::thread::spawn(move || {
            debounce(&receiver, |changed| reports.send(changed.paths).unwrap());
        });
        let all = reported.recv_timeout(PATIENCE).unwrap();
        assert_eq!(all, BTreeSet::from([PathBuf::from("a")]));
        sender
            .send((vec![PathBuf::from("b")], State::Closed))
            .unwrap();
        let next = reported.recv_timeout(PATIENCE).unwrap();
        assert_eq!(next, BTreeSet::from([PathBuf::from("b")]));
    }

    #[test]
    fn files_that_never_settle_are_reported() {
        let watched = Watched::new(ChangeDetection::Native);
        let path = watched.path("a.svg");
        let mut reports = 0;
        wait_until("two reports while it is written", || {
            let mut file = fs::File::options().append(true).open(&path).unwrap();
            file.write_all(b" ").unwrap();
            reports += watched.reports.try_iter().count();
            reports >= 2
        });
    }

    /// Also those that are deleted and made again, at any depth.
    #[test]
    fn folders_that_are_made_later_are_watched() {
        for detection in [
            ChangeDetection::Native,
            ChangeDetection::Polling(Duration::from_millis(50)),
        ] {
            let folder = tempfile::tempdir().unwrap();
            let file = event_path(&folder.path().join("one/two/a.svg"));
            let inner = file.parent().unwrap();
            let (sender, reports) = channel();
            let watch = FolderWatch::new(detection, move |changed: Changed| {
                let _ = sender.send(changed.paths);
            })
            .unwrap();
            assert!(watch.set(&BTreeSet::from([inner.to_owned()])).is_empty());
            let is_reported = |what: &str| {
                wait_until(what, || {
                    let mut reports = reports.try_iter();
                    reports.any(|changed| is_concerned(&file, &changed))
                });
            };
            for _ in 0..3 {
                fs::create_dir_all(inner).unwrap();
                fs::write(&file, "new").unwrap();
                is_reported("the new file");
                // A later change is one of the file.
                std::thread::sleep(2 * SETTLED);
                while reports.try_recv().is_ok() {}
                fs::write(&file, "newer").unwrap();
                is_reported("the changed file");
                fs::remove_dir_all(folder.path().join("one")).unwrap();
                is_reported("the deleted file");
            }
        }
    }

    /// A watcher that is always late: the first folder that it is to watch is deleted before it is watched.
    struct Late {
        watched: BTreeSet<PathBuf>,
        is_late: bool,
    }

    impl Watcher for Late {
        fn new<F: notify::EventHandler>(_: F, _: notify::Config) -> notify::Result<Self> {
            Ok(Self {
                watched: BTreeSet::new(),
                is_late: false,
            })
        }

        fn watch(&mut self, path: &Path, _: RecursiveMode) -> notify::Result<()> {
            if !std::mem::replace(&mut self.is_late, true) {
                fs::remove_dir_all(path).unwrap();
            }
            if !path.is_dir() {
                return Err(notify::Error::path_not_found());
            }
            self.watched.insert(path.to_owned());
            Ok(())
        }

        fn unwatch(&mut self, path: &Path) -> notify::Result<()> {
            self.watched.remove(path);
            Ok(())
        }

        fn kind() -> notify::WatcherKind {
            notify::WatcherKind::NullWatcher
        }
    }

    #[test]
    fn above_a_folder_that_is_deleted_before_it_is_watched_the_next_one_is() {
        let root = tempfile::tempdir().unwrap();
        let one = root.path().join("one");
        for wanted in [&one, &one.join("two")] {
            fs::create_dir(&one).unwrap();
            let mut native = Native {
                watcher: Late::new(|_| (), notify::Config::default()).unwrap(),
                wanted: BTreeSet::from([wanted.clone()]),
                watched: BTreeSet::new(),
            };
            assert!(native.renew().is_empty());
            assert!(!one.exists());
            let above = BTreeSet::from([root.path().to_owned()]);
            assert_eq!(native.watched, above);
            assert_eq!(native.watcher.watched, above);
        }
    }

    #[test]
    fn a_file_in_a_missing_folder_has_the_path_that_it_will_have() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("one/two/a.svg");
        let before = event_path(&file);
        fs::create_dir_all(file.parent().unwrap()).unwrap();
        fs::write(&file, "").unwrap();
        assert_eq!(before, fs::canonicalize(&file).unwrap());
        assert_eq!(before, event_path(&file));
    }
}
