//! Tells when files change.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::time::Duration;

use notify::{EventKind, RecommendedWatcher, RecursiveMode, Watcher};

/// How long nothing must happen before files count as settled: programs write in pieces.
const SETTLED: Duration = Duration::from_millis(60);

/// Watches folders, since programs replace files as well as write them, and files may not be there yet.
#[derive(Debug)]
pub struct FolderWatch {
    watcher: Mutex<(RecommendedWatcher, BTreeSet<PathBuf>)>,
}

impl FolderWatch {
    /// A watch that calls `changed` with the paths that changed, on a thread of its own, once they have settled.
    /// `None` where the system cannot tell of changes.
    pub fn new(changed: impl Fn(&BTreeSet<PathBuf>) + Send + 'static) -> Option<Self> {
        let (sender, receiver) = channel();
        let watcher = notify::recommended_watcher(move |event: notify::Result<notify::Event>| {
            if let Ok(event) = event
                && !matches!(event.kind, EventKind::Access(_))
            {
                // Nobody listens any more only when the process ends.
                let _ = sender.send(event.paths);
            }
        });
        let watcher = watcher.ok()?;
        std::thread::spawn(move || tell(&receiver, &changed));
        Some(Self {
            watcher: Mutex::new((watcher, BTreeSet::new())),
        })
    }

    /// Watches these folders and no others. Folders that are not there are passed over.
    pub fn set(&self, folders: &BTreeSet<PathBuf>) {
        let mut guard = self
            .watcher
            .lock()
            .unwrap_or_else(|poisoned| poisoned.into_inner());
        let (watcher, watched) = &mut *guard;
        for gone in watched.difference(folders) {
            let _ = watcher.unwatch(gone);
        }
        let mut kept = watched
            .intersection(folders)
            .cloned()
            .collect::<BTreeSet<_>>();
        for new in folders.difference(watched) {
            if watcher.watch(new, RecursiveMode::NonRecursive).is_ok() {
                kept.insert(new.clone());
            }
        }
        *watched = kept;
    }
}

/// Gathers paths until nothing has happened for a while, then tells them.
fn tell(receiver: &Receiver<Vec<PathBuf>>, changed: &dyn Fn(&BTreeSet<PathBuf>)) {
    while let Ok(first) = receiver.recv() {
        let mut paths: BTreeSet<PathBuf> = first.into_iter().collect();
        loop {
            match receiver.recv_timeout(SETTLED) {
                Ok(more) => paths.extend(more),
                Err(RecvTimeoutError::Timeout) => break,
                Err(RecvTimeoutError::Disconnected) => return,
            }
        }
        changed(&paths);
    }
}

/// A folder as the system names it in what it tells of changes; itself if it is not there.
pub fn real_path(path: &Path) -> PathBuf {
    std::fs::canonicalize(path).unwrap_or_else(|_| path.to_owned())
}
