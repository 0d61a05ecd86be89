//! The queue of texts to analyse, and which of them have diagnostics to send. The worker takes its tasks from here.
//!
//! A text that changes while it waits is analysed once, in its newest state.

use std::collections::{BTreeMap, BTreeSet, VecDeque};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};

use tower_lsp::ls_types::Uri;

use super::documents::Documents;
use crate::protocol::document::{Analyzed, Document};

/// When texts are analysed without a request.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) enum When {
    /// At every change.
    #[default]
    OnType,
    /// When a text is opened or saved.
    OnSave,
}

/// See the [module](self).
#[derive(Debug)]
pub(super) struct Scheduler {
    documents: Arc<Documents>,
    queue: Mutex<Queue>,
    wakeup: Condvar,
}

#[derive(Debug, Default)]
struct Queue {
    tasks: VecDeque<Task>,
    /// Texts whose diagnostics are sent as soon as those of this state, or of a newer one, are known.
    due: BTreeMap<String, u64>,
    /// Texts whose diagnostics the client requests itself.
    pulled: BTreeSet<String>,
    when: When,
}

/// A task for the worker.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Task {
    /// Analyse the newest state of a text, and send its diagnostics if that was requested.
    Analyze(String),
    /// A text was closed: drop what is kept of it.
    Close(Uri),
    /// Clear the diagnostics that were sent for a text.
    ClearDiagnostics(Uri),
}

impl Scheduler {
    pub(super) fn new(documents: Arc<Documents>) -> Self {
        Self {
            documents,
            queue: Mutex::default(),
            wakeup: Condvar::new(),
        }
    }

    fn queue(&self) -> MutexGuard<'_, Queue> {
        self.queue.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Applies the client's settings, `{"analyze": "onType"}`, alone or under `okoshi`; others are ignored.
    pub(super) fn configure(&self, settings: &serde_json::Value) {
        let own = settings.get("okoshi").unwrap_or(settings);
        match own.get("analyse").and_then(serde_json::Value::as_str) {
            Some("onSave") => self.queue().when = When::OnSave,
            Some("onType") => self.queue().when = When::OnType,
            _ => {}
        }
    }

    /// A text was opened or saved: analyses it and sends its diagnostics.
    pub(super) fn opened_or_saved(&self, uri: &str) {
        let current = self.documents.current(uri);
        let mut queue = self.queue();
        if let Some(document) = current {
            queue.due.insert(uri.to_owned(), document.generation);
        }
        self.add(queue, Task::Analyze(uri.to_owned()));
    }

    /// A text has changed: its diagnostics are sent, unless the client wants them only after saving.
    pub(super) fn changed(&self, uri: &str) {
        if self.queue().when == When::OnType {
            self.opened_or_saved(uri);
        }
    }

    /// A file that a text links to has changed.
    pub(super) fn link_changed(&self, uri: &str) {
        self.documents.touch(uri);
        self.opened_or_saved(uri);
    }

    /// A text was closed: its diagnostics are cleared.
    pub(super) fn closed(&self, uri: &Uri) {
        let mut queue = self.queue();
        queue.due.remove(uri.as_str());
        queue.pulled.remove(uri.as_str());
        self.add(queue, Task::Close(uri.clone()));
    }

    /// The client requests a text's diagnostics: they are no longer sent, and what was sent is cleared, or it would
    /// be shown twice.
    pub(super) fn pulled(&self, uri: &Uri) {
        let mut queue = self.queue();
        if queue.pulled.insert(uri.to_string()) {
            self.add(queue, Task::ClearDiagnostics(uri.clone()));
        }
    }

    /// Queues a text for analysis, unless its newest state is analysed.
    pub(super) fn request(&self, uri: &str) {
        let current = self.documents.current(uri);
        let last = self.documents.last(uri);
        let generation = |analyzed: &Analyzed| analyzed.document.generation;
        if current.map(|document| document.generation) != last.as_deref().map(generation) {
            self.add(self.queue(), Task::Analyze(uri.to_owned()));
        }
    }

    fn add(&self, mut queue: MutexGuard<'_, Queue>, task: Task) {
        if !queue.tasks.contains(&task) {
            queue.tasks.push_back(task);
        }
        self.wakeup.notify_one();
    }

    /// The next task; waits for one.
    pub(super) fn next_task(&self) -> Task {
        let mut queue = self.queue();
        loop {
            if let Some(task) = queue.tasks.pop_front() {
                return task;
            }
            let woken = self.wakeup.wait(queue);
            queue = woken.unwrap_or_else(PoisonError::into_inner);
        }
    }

    /// Whether diagnostics of a state of a text are to be sent: those of this one or an earlier one were due, and not also those of a
    /// newer one. Resets that.
    pub(super) fn take_due(&self, document: &Document) -> bool {
        let mut queue = self.queue();
        let uri = document.uri.as_str();
        let due = queue.due.get(uri);
        let is_due = due.is_some_and(|generation| *generation <= document.generation);
        is_due && queue.due.remove(uri).is_some()
    }

    pub(super) fn is_pulled(&self, uri: &str) -> bool {
        self.queue().pulled.contains(uri)
    }
}

#[cfg(test)]
mod tests {
    use tower_lsp::ls_types::{
        TextDocumentContentChangeEvent, TextDocumentItem, VersionedTextDocumentIdentifier,
    };

    use super::*;

    #[test]
    fn a_change_while_diagnostics_are_sent_has_its_own_sent() {
        let documents = Arc::new(Documents::default());
        let scheduler = Scheduler::new(Arc::clone(&documents));
        let uri: Uri = "file:///drawing.svg".parse().unwrap();
        documents.open(TextDocumentItem {
            uri: uri.clone(),
            language_id: "xml".to_owned(),
            version: 1,
            text: "<svg/>".to_owned(),
        });
        scheduler.opened_or_saved(uri.as_str());
        let opened = documents.current(uri.as_str()).unwrap();
        // The text changes when its first state has been analysed, but not sent yet.
        let identifier = VersionedTextDocumentIdentifier {
            uri: uri.clone(),
            version: 2,
        };
        let change = TextDocumentContentChangeEvent {
            range: None,
            range_length: None,
            text: "<svg></svg>".to_owned(),
        };
        documents.change(&identifier, vec![change]);
        scheduler.changed(uri.as_str());
        assert!(!scheduler.take_due(&opened));
        let changed = documents.current(uri.as_str()).unwrap();
        assert!(scheduler.take_due(&changed));
        assert!(!scheduler.take_due(&changed));
    }
}
