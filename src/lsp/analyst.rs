//! What is to be analysed, in which order, and whether its diagnostics are to be sent. Who does it is the worker.
//!
//! A text that changes while it waits is analysed once, as it is then.

use std::collections::{BTreeSet, VecDeque};
use std::sync::{Arc, Condvar, Mutex, MutexGuard};

use tower_lsp::ls_types::Uri;

use super::documents::{Analysed, Documents};

/// When texts are analysed that nobody asks about.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) enum When {
    /// At every change.
    #[default]
    OnType,
    /// When they are opened and saved.
    OnSave,
}

/// See the module.
#[derive(Debug)]
pub(super) struct Analyst {
    documents: Arc<Documents>,
    queue: Mutex<Queue>,
    woken: Condvar,
}

#[derive(Debug, Default)]
struct Queue {
    tasks: VecDeque<Task>,
    /// Texts whose diagnostics are to be sent as soon as they are found.
    due: BTreeSet<String>,
    /// Texts whose diagnostics the client fetches itself.
    fetched: BTreeSet<String>,
    when: When,
}

/// Something for the worker to do.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Task {
    /// Analyse the newest state of a text, and send its diagnostics if they are due.
    Analyse(String),
    /// A text was closed: forget it.
    Close(Uri),
    /// Take back the diagnostics of a text that were sent.
    TakeBack(Uri),
}

impl Analyst {
    pub(super) fn new(documents: Arc<Documents>) -> Self {
        Self {
            documents,
            queue: Mutex::default(),
            woken: Condvar::new(),
        }
    }

    fn queue(&self) -> MutexGuard<'_, Queue> {
        self.queue
            .lock()
            .unwrap_or_else(|poisoned| poisoned.into_inner())
    }

    /// Takes the client's settings, `{"analyse": "onType"}` or the same below `okoshi`; others are not its own.
    pub(super) fn configure(&self, settings: &serde_json::Value) {
        let own = settings.get("okoshi").unwrap_or(settings);
        match own.get("analyse").and_then(serde_json::Value::as_str) {
            Some("onSave") => self.queue().when = When::OnSave,
            Some("onType") => self.queue().when = When::OnType,
            _ => {}
        }
    }

    /// A text was opened or saved: its diagnostics are sent.
    pub(super) fn opened_or_saved(&self, uri: &str) {
        let mut queue = self.queue();
        queue.due.insert(uri.to_owned());
        self.add(queue, Task::Analyse(uri.to_owned()));
    }

    /// A text has changed: its diagnostics are sent, if that is wanted while typing.
    pub(super) fn changed(&self, uri: &str) {
        if self.queue().when == When::OnType {
            self.opened_or_saved(uri);
        }
    }

    /// Something that a text links to has changed.
    pub(super) fn touched(&self, uri: &str) {
        self.documents.touch(uri);
        self.opened_or_saved(uri);
    }

    /// A text was closed: its diagnostics go.
    pub(super) fn closed(&self, uri: &Uri) {
        let mut queue = self.queue();
        queue.due.remove(uri.as_str());
        queue.fetched.remove(uri.as_str());
        self.add(queue, Task::Close(uri.clone()));
    }

    /// The client fetches a text's diagnostics: they are no longer sent, and what was sent is taken back, or it would
    /// be shown twice.
    pub(super) fn fetched(&self, uri: &Uri) {
        let mut queue = self.queue();
        if queue.fetched.insert(uri.to_string()) {
            self.add(queue, Task::TakeBack(uri.clone()));
        }
    }

    /// Has a text analysed, unless it is.
    pub(super) fn ask(&self, uri: &str) {
        let current = self.documents.current(uri);
        let last = self.documents.last(uri);
        let generation = |analysed: &Analysed| analysed.document.generation;
        if current.map(|document| document.generation) != last.as_deref().map(generation) {
            self.add(self.queue(), Task::Analyse(uri.to_owned()));
        }
    }

    fn add(&self, mut queue: MutexGuard<'_, Queue>, task: Task) {
        if !queue.tasks.contains(&task) {
            queue.tasks.push_back(task);
        }
        self.woken.notify_one();
    }

    /// What is to be done next; waits for it.
    pub(super) fn next(&self) -> Task {
        let mut queue = self.queue();
        loop {
            if let Some(task) = queue.tasks.pop_front() {
                return task;
            }
            queue = self
                .woken
                .wait(queue)
                .unwrap_or_else(|poisoned| poisoned.into_inner());
        }
    }

    /// Whether diagnostics of a text are to be sent; they are no longer due then.
    pub(super) fn is_due(&self, uri: &str) -> bool {
        let mut queue = self.queue();
        queue.due.remove(uri)
    }

    pub(super) fn is_fetched(&self, uri: &str) -> bool {
        self.queue().fetched.contains(uri)
    }
}
