//! Polls folders, for file systems that do not report changes.
//!
//! notify has a polling watcher, too, but it compares modification times in whole seconds: it misses the second of two
//! saves in one second, unless it reads all files in the folder every time.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError, Weak};
use std::time::Duration;

use super::search::{Stamp, stamp};

/// Folders that are polled until this is dropped.
#[derive(Debug)]
pub(super) struct Poll {
    folders: Arc<Mutex<BTreeMap<PathBuf, Listing>>>,
}

/// The files of a folder.
type Listing = BTreeMap<PathBuf, Stamp>;

impl Poll {
    /// Polls the folders every `pause`, and calls `changed` with the new, deleted and modified files.
    pub(super) fn new(
        pause: Duration,
        changed: impl Fn(Vec<PathBuf>) -> bool + Send + 'static,
    ) -> Self {
        let folders: Arc<Mutex<BTreeMap<PathBuf, Listing>>> = Arc::default();
        let polled = Arc::downgrade(&folders);
        std::thread::spawn(move || {
            loop {
                std::thread::sleep(pause);
                match poll(&polled) {
                    Some(paths) if paths.is_empty() || changed(paths.clone()) => {}
                    _ => return,
                }
            }
        });
        Self { folders }
    }

    pub(super) fn set(&self, folders: &BTreeSet<PathBuf>) {
        let mut known = self.folders.lock().unwrap_or_else(PoisonError::into_inner);
        known.retain(|folder, _| folders.contains(folder));
        for folder in folders {
            let listing = || listing(folder);
            known.entry(folder.clone()).or_insert_with(listing);
        }
    }
}

/// The files that changed since the last poll; `None` if the watch was dropped.
fn poll(folders: &Weak<Mutex<BTreeMap<PathBuf, Listing>>>) -> Option<Vec<PathBuf>> {
    let folders = folders.upgrade()?;
    let mut folders = folders.lock().unwrap_or_else(PoisonError::into_inner);
    let mut paths = vec![];
    for (folder, before) in folders.iter_mut() {
        let now = listing(folder);
        let changed = |(path, stamp): &(&PathBuf, &Stamp)| before.get(*path) != Some(*stamp);
        paths.extend(now.iter().filter(changed).map(|(path, _)| path.clone()));
        let gone = before.keys().filter(|path| !now.contains_key(*path));
        paths.extend(gone.cloned());
        *before = now;
    }
    Some(paths)
}

fn listing(folder: &Path) -> Listing {
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    let stamped = entries.filter_map(|entry| Some((entry.path(), stamp(&entry.path())?)));
    stamped.collect()
}
