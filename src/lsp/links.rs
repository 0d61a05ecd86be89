//! The files that open drawings link to, watched because not every client reports changed files.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use super::scheduler::Scheduler;
use crate::disk::{ChangeDetection, FolderWatch, event_path, is_concerned};

/// See the [module](self).
pub(super) struct Links {
    /// Per text, the files that it links to.
    linked: Arc<Mutex<BTreeMap<String, BTreeSet<PathBuf>>>>,
    watch: Option<FolderWatch>,
}

impl std::fmt::Debug for Links {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Links").finish_non_exhaustive()
    }
}

type LinkedFiles = Mutex<BTreeMap<String, BTreeSet<PathBuf>>>;

fn lock(linked: &LinkedFiles) -> MutexGuard<'_, BTreeMap<String, BTreeSet<PathBuf>>> {
    linked.lock().unwrap_or_else(PoisonError::into_inner)
}

impl Links {
    /// Has `scheduler` analyse texts again when their linked files change.
    pub(super) fn new(scheduler: Arc<Scheduler>) -> Self {
        let linked: Arc<LinkedFiles> = Arc::default();
        let known = linked.clone();
        let watch = FolderWatch::new(ChangeDetection::Native, move |changed| {
            for uri in affected(&known, &changed.paths) {
                scheduler.link_changed(&uri);
            }
        });
        // Without system notifications, the client may still report changes.
        let watch = watch.ok();
        Self { linked, watch }
    }

    /// The texts that link to any of these files.
    pub(super) fn affected(&self, changed: &BTreeSet<PathBuf>) -> Vec<String> {
        affected(&self.linked, changed)
    }

    /// Watches the files that a text now links to.
    pub(super) fn watch(&self, uri: &str, files: Vec<PathBuf>) {
        let files: BTreeSet<PathBuf> = files.iter().map(|file| event_path(file)).collect();
        let mut linked = lock(&self.linked);
        if linked.get(uri).is_some_and(|old| *old == files)
            || (files.is_empty() && !linked.contains_key(uri))
        {
            return;
        }
        linked.insert(uri.to_owned(), files);
        self.renew(&linked);
    }

    /// A text was closed.
    pub(super) fn forget(&self, uri: &str) {
        let mut linked = lock(&self.linked);
        if linked.remove(uri).is_some() {
            self.renew(&linked);
        }
    }

    fn renew(&self, linked: &BTreeMap<String, BTreeSet<PathBuf>>) {
        let folders = linked.values().flatten().filter_map(|file| file.parent());
        let folders: BTreeSet<PathBuf> = folders.map(Path::to_owned).collect();
        if let Some(watch) = &self.watch {
            watch.set(&folders);
        }
    }
}

fn affected(linked: &LinkedFiles, changed: &BTreeSet<PathBuf>) -> Vec<String> {
    let changed: BTreeSet<PathBuf> = changed.iter().map(|file| event_path(file)).collect();
    let linked = lock(linked);
    let texts = linked.iter();
    texts
        .filter(|(_, files)| files.iter().any(|file| is_concerned(file, &changed)))
        .map(|(uri, _)| uri.clone())
        .collect()
}
