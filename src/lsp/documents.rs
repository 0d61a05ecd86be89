//! The texts that the client has open, and what was found in them.
//!
//! Texts change in the order in which the client says so, and at once; each request is answered from the state
//! that held when it came ([`Snapshot`]).

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard};

use tokio::sync::watch;
use tower_lsp::ls_types::{
    TextDocumentContentChangeEvent, TextDocumentItem, Uri, VersionedTextDocumentIdentifier,
};

use super::positions::{Encoding, Positions};
use crate::disk::FolderResolver;
use crate::ide::Analysis;
use crate::resolver::{MemoryResolver, Resolver};
use crate::source::Span;

/// One state of a text.
#[derive(Debug)]
pub(super) struct Document {
    /// What the client calls it.
    pub(super) uri: Uri,
    /// The client's number of this state.
    pub(super) version: i32,
    /// The server's own number: it grows too when only a linked file has changed.
    pub(super) generation: u64,
    /// The text with its lines.
    pub(super) positions: Positions,
    /// The file, if it is one.
    pub(super) path: Option<PathBuf>,
}

impl Document {
    /// The text.
    pub(super) fn text(&self) -> &Arc<str> {
        self.positions.text()
    }

    /// The folder that its links start from.
    pub(super) fn folder(&self) -> Option<&Path> {
        self.path.as_deref().and_then(Path::parent)
    }

    /// What reads its links; a text that is no file has none.
    pub(super) fn resolver(&self) -> Box<dyn Resolver> {
        match self.folder() {
            Some(folder) => Box::new(FolderResolver::new(folder)),
            None => Box::new(MemoryResolver::default()),
        }
    }
}

/// A state of a text and what was found in it.
#[derive(Debug)]
pub(super) struct Analysed {
    /// The state.
    pub(super) document: Arc<Document>,
    /// What was found.
    pub(super) analysis: Analysis,
    /// The last one before it that could be read as a drawing, if this one cannot.
    pub(super) good: Option<Arc<Analysed>>,
}

/// The place where analyses arrive.
pub(super) type Arrivals = watch::Receiver<Option<Arc<Analysed>>>;

#[derive(Debug)]
struct Entry {
    document: Arc<Document>,
    analysed: watch::Sender<Option<Arc<Analysed>>>,
}

/// All open texts.
#[derive(Debug)]
pub(super) struct Documents {
    state: Mutex<State>,
}

#[derive(Debug, Default)]
struct State {
    entries: BTreeMap<String, Entry>,
    encoding: Option<Encoding>,
    generation: u64,
}

/// One text as it was when a request came.
#[derive(Debug, Clone)]
pub(super) struct Snapshot {
    /// The text.
    pub(super) document: Arc<Document>,
    /// Where its analysis arrives.
    pub(super) arrivals: Arrivals,
}

impl Documents {
    pub(super) fn new() -> Self {
        Self {
            state: Mutex::default(),
        }
    }

    fn state(&self) -> MutexGuard<'_, State> {
        // A panic while it was held has left each entry whole: entries are replaced, not rewritten.
        self.state
            .lock()
            .unwrap_or_else(|poisoned| poisoned.into_inner())
    }

    /// Says what columns count; they are counted so from now on.
    pub(super) fn count(&self, encoding: Encoding) {
        self.state().encoding = Some(encoding);
    }

    /// What columns count.
    pub(super) fn encoding(&self) -> Encoding {
        self.state().encoding.unwrap_or(Encoding::Utf16)
    }

    /// Takes a text that the client has opened.
    pub(super) fn open(&self, item: TextDocumentItem) {
        let mut state = self.state();
        state.generation += 1;
        let encoding = state.encoding.unwrap_or(Encoding::Utf16);
        let document = Document {
            path: file_path(&item.uri),
            version: item.version,
            generation: state.generation,
            positions: Positions::new(Arc::from(item.text), encoding),
            uri: item.uri,
        };
        let key = document.uri.to_string();
        let entry = Entry {
            document: Arc::new(document),
            analysed: watch::Sender::new(None),
        };
        state.entries.insert(key, entry);
    }

    /// Makes the client's changes, in their order. Of a text that is not open nothing is changed.
    pub(super) fn change(
        &self,
        id: &VersionedTextDocumentIdentifier,
        changes: Vec<TextDocumentContentChangeEvent>,
    ) {
        let mut state = self.state();
        let generation = state.generation + 1;
        let encoding = state.encoding.unwrap_or(Encoding::Utf16);
        let Some(entry) = state.entries.get_mut(id.uri.as_str()) else {
            return;
        };
        let mut positions = None;
        for change in changes {
            let now = positions.as_ref().unwrap_or(&entry.document.positions);
            let text = match change.range {
                None => Arc::from(change.text),
                Some(range) => replaced(now.text(), now.span(range), &change.text),
            };
            positions = Some(Positions::new(text, encoding));
        }
        let old = &entry.document;
        let positions = positions.unwrap_or_else(|| Positions::new(old.text().clone(), encoding));
        entry.document = Arc::new(Document {
            uri: old.uri.clone(),
            version: id.version,
            generation,
            positions,
            path: old.path.clone(),
        });
        state.generation = generation;
    }

    /// Says that something which a text links to has changed: its analyses are out of date.
    pub(super) fn touch(&self, uri: &str) {
        let mut state = self.state();
        let generation = state.generation + 1;
        let encoding = state.encoding.unwrap_or(Encoding::Utf16);
        if let Some(entry) = state.entries.get_mut(uri) {
            let old = &entry.document;
            entry.document = Arc::new(Document {
                uri: old.uri.clone(),
                version: old.version,
                generation,
                positions: Positions::new(old.text().clone(), encoding),
                path: old.path.clone(),
            });
            state.generation = generation;
        }
    }

    /// Forgets a text that the client has closed.
    pub(super) fn close(&self, uri: &str) {
        self.state().entries.remove(uri);
    }

    /// All open texts as they are now.
    pub(super) fn snapshots(&self) -> BTreeMap<String, Snapshot> {
        let state = self.state();
        let entries = state.entries.iter();
        entries
            .map(|(uri, entry)| {
                let snapshot = Snapshot {
                    document: entry.document.clone(),
                    arrivals: entry.analysed.subscribe(),
                };
                (uri.clone(), snapshot)
            })
            .collect()
    }

    /// A text as it is now, if it is open.
    pub(super) fn current(&self, uri: &str) -> Option<Arc<Document>> {
        let state = self.state();
        Some(state.entries.get(uri)?.document.clone())
    }

    /// The last analysis of a text.
    pub(super) fn last(&self, uri: &str) -> Option<Arc<Analysed>> {
        let state = self.state();
        let entry = state.entries.get(uri);
        entry.and_then(|entry| entry.analysed.borrow().clone())
    }

    /// Hands an analysis to those who wait for it, unless its state is gone. Says whether it was handed over.
    pub(super) fn arrive(&self, analysed: Arc<Analysed>) -> bool {
        let state = self.state();
        match state.entries.get(analysed.document.uri.as_str()) {
            Some(entry) if entry.document.generation == analysed.document.generation => {
                entry.analysed.send_replace(Some(analysed));
                true
            }
            _ => false,
        }
    }
}

/// The path of a file's address.
pub(super) fn file_path(uri: &Uri) -> Option<PathBuf> {
    let is_file = uri.scheme().as_str().eq_ignore_ascii_case("file");
    is_file.then(|| uri.to_file_path().map(|path| path.into_owned()))?
}

fn replaced(text: &str, span: Span, new: &str) -> Arc<str> {
    let mut out = String::with_capacity(text.len() + new.len());
    out.push_str(&text[..span.start]);
    out.push_str(new);
    out.push_str(&text[span.end..]);
    Arc::from(out)
}
