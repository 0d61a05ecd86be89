//! The files that open drawings link to, watched wherever the client does not tell of them.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard};

use super::analyst::Analyst;
use crate::disk::{FolderWatch, Notice, as_told};

/// See the module.
pub(super) struct Links {
    /// By text, the files that it links to.
    places: Arc<Mutex<BTreeMap<String, BTreeSet<PathBuf>>>>,
    watch: Option<FolderWatch>,
}

impl std::fmt::Debug for Links {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Links").finish_non_exhaustive()
    }
}

type Places = Mutex<BTreeMap<String, BTreeSet<PathBuf>>>;

fn lock(places: &Places) -> MutexGuard<'_, BTreeMap<String, BTreeSet<PathBuf>>> {
    places
        .lock()
        .unwrap_or_else(|poisoned| poisoned.into_inner())
}

impl Links {
    /// Has `analyst` look again at texts whose files change.
    pub(super) fn new(analyst: Arc<Analyst>) -> Self {
        let places: Arc<Places> = Arc::default();
        let known = places.clone();
        let watch = FolderWatch::new(Notice::Told, move |changed| {
            for uri in affected(&known, &changed.paths) {
                analyst.touched(&uri);
            }
        });
        // Where the system cannot tell, clients may.
        let watch = watch.ok();
        Self { places, watch }
    }

    /// The texts that link to one of these files.
    pub(super) fn affected(&self, changed: &BTreeSet<PathBuf>) -> Vec<String> {
        affected(&self.places, changed)
    }

    /// Watches the files that a text links to now.
    pub(super) fn watch(&self, uri: &str, files: Vec<PathBuf>) {
        let files: BTreeSet<PathBuf> = files.iter().map(|file| as_told(file)).collect();
        let mut places = lock(&self.places);
        if places.get(uri).is_some_and(|old| *old == files)
            || (files.is_empty() && !places.contains_key(uri))
        {
            return;
        }
        places.insert(uri.to_owned(), files);
        self.renew(&places);
    }

    /// A text was closed.
    pub(super) fn forget(&self, uri: &str) {
        let mut places = lock(&self.places);
        if places.remove(uri).is_some() {
            self.renew(&places);
        }
    }

    fn renew(&self, places: &BTreeMap<String, BTreeSet<PathBuf>>) {
        let folders = places.values().flatten().filter_map(|file| file.parent());
        let folders: BTreeSet<PathBuf> = folders.map(Path::to_owned).collect();
        if let Some(watch) = &self.watch {
            watch.set(&folders);
        }
    }
}

fn affected(places: &Places, changed: &BTreeSet<PathBuf>) -> Vec<String> {
    let changed: BTreeSet<PathBuf> = changed.iter().map(|file| as_told(file)).collect();
    let places = lock(places);
    let texts = places.iter();
    texts
        .filter(|(_, files)| !files.is_disjoint(&changed))
        .map(|(uri, _)| uri.clone())
        .collect()
}
