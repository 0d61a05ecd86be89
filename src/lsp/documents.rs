//! The texts that the client has open, with their analyses.
//!
//! Changes are applied at once and in the client's order; each request is answered from the state
//! when it came ([`Snapshot`]).

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use tokio::sync::watch;
use tower_lsp::ls_types::{
    TextDocumentContentChangeEvent, TextDocumentItem, Uri, VersionedTextDocumentIdentifier,
};

use crate::disk::FolderResolver;
use crate::protocol::document::{Analyzed, Document};
use crate::protocol::positions::{Encoding, Positions};
use crate::resolver::{MemoryResolver, Resolver};
use crate::source::Span;

pub(super) type AnalysisReceiver = watch::Receiver<Option<Arc<Analyzed>>>;

#[derive(Debug)]
struct Entry {
    document: Arc<Document>,
    analyzed: watch::Sender<Option<Arc<Analyzed>>>,
}

/// All open texts.
impl Entry {
    fn replace(&mut self, positions: Positions, version: i32, generation: u64) {
        self.document = Arc::new(Document {
            uri: self.document.uri.clone(),
            version,
            generation,
            positions,
            path: self.document.path.clone(),
        });
    }
}

#[derive(Debug, Default)]
pub(super) struct Documents {
    state: Mutex<State>,
}

#[derive(Debug, Default)]
struct State {
    entries: BTreeMap<String, Entry>,
    encoding: Option<Encoding>,
    generation: u64,
}

/// One text when a request came.
#[derive(Debug, Clone)]
pub(super) struct Snapshot {
    pub(super) document: Arc<Document>,
    /// Receives its analysis.
    pub(super) analyses: AnalysisReceiver,
}

impl Documents {
    fn state(&self) -> MutexGuard<'_, State> {
        // Entries are replaced as a whole, so a panic while the lock was held left them consistent.
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Sets what columns count.
    pub(super) fn count(&self, encoding: Encoding) {
        self.state().encoding = Some(encoding);
    }

    /// The unit of columns.
    pub(super) fn encoding(&self) -> Encoding {
        self.state().encoding.unwrap_or(Encoding::Utf16)
    }

    /// Adds a text that the client has opened.
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
            analyzed: watch::Sender::new(None),
        };
        state.entries.insert(key, entry);
    }

    /// Applies the client's changes in order. Ignores a text that is not open.
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
        let old = &entry.document.positions;
        let positions = positions.unwrap_or_else(|| Positions::new(old.text().clone(), encoding));
        entry.replace(positions, id.version, generation);
        state.generation = generation;
    }

    /// Marks the analyses of a text as out of date, because a file that it links to has changed.
    pub(super) fn touch(&self, uri: &str) {
        let mut state = self.state();
        let generation = state.generation + 1;
        let encoding = state.encoding.unwrap_or(Encoding::Utf16);
        if let Some(entry) = state.entries.get_mut(uri) {
            let positions = Positions::new(entry.document.text().clone(), encoding);
            entry.replace(positions, entry.document.version, generation);
            state.generation = generation;
        }
    }

    /// Removes a text that the client has closed.
    pub(super) fn close(&self, uri: &str) {
        self.state().entries.remove(uri);
    }

    /// All open texts in their present state.
    pub(super) fn snapshots(&self) -> BTreeMap<String, Snapshot> {
        let state = self.state();
        let entries = state.entries.iter();
        entries
            .map(|(uri, entry)| {
                let snapshot = Snapshot {
                    document: entry.document.clone(),
                    analyses: entry.analyzed.subscribe(),
                };
                (uri.clone(), snapshot)
            })
            .collect()
    }

    /// A text in its present state, if it is open.
    pub(super) fn current(&self, uri: &str) -> Option<Arc<Document>> {
        let state = self.state();
        Some(state.entries.get(uri)?.document.clone())
    }

    /// The last analysis of a text.
    pub(super) fn last(&self, uri: &str) -> Option<Arc<Analyzed>> {
        let state = self.state();
        let entry = state.entries.get(uri);
        entry.and_then(|entry| entry.analyzed.borrow().clone())
    }

    /// Hands an analysis to the waiting requests, unless its state is out of date. Returns whether it was handed over.
    pub(super) fn publish(&self, analyzed: Arc<Analyzed>) -> bool {
        let state = self.state();
        match state.entries.get(analyzed.document.uri.as_str()) {
            Some(entry) if entry.document.generation == analyzed.document.generation => {
                entry.analyzed.send_replace(Some(analyzed));
                true
            }
            _ => false,
        }
    }
}

/// What reads the links of a text; one without a file has none.
pub(super) fn resolver(document: &Document) -> Box<dyn Resolver> {
    match document.folder() {
        Some(folder) => Box::new(FolderResolver::new(folder)),
        None => Box::new(MemoryResolver::default()),
    }
}

/// The path of a `file:` address.
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
