//! Who compiles the open texts: one thread, one text at a time, always the newest state.
//!
//! A text that changes while it waits is compiled once, as it is then. What was found in a state that is no longer the
//! newest is thrown away. Diagnostics leave in the order in which they were found, with the number of their state.

use std::collections::{BTreeMap, BTreeSet, VecDeque};
use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Condvar, Mutex, MutexGuard};

use tokio::runtime::Handle;
use tower_lsp::Client;
use tower_lsp::ls_types::Uri;

use super::documents::{Analysed, Document, Documents};
use super::{convert, links::Links, manual, progress};
use crate::compile::{Compiled, Compiler, Options};
use crate::disk::FolderResolver;
use crate::ide::Analysis;

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

#[derive(Debug, PartialEq)]
enum Task {
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
    fn next(&self) -> Task {
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
    fn is_due(&self, uri: &str) -> bool {
        let mut queue = self.queue();
        queue.due.remove(uri)
    }

    fn is_fetched(&self, uri: &str) -> bool {
        self.queue().fetched.contains(uri)
    }
}

/// What the thread needs besides the texts.
#[derive(Debug)]
pub(super) struct Desk {
    pub(super) client: Client,
    pub(super) runtime: Handle,
    pub(super) links: Arc<Links>,
    /// What the client can do.
    pub(super) abilities: Arc<Abilities>,
}

/// What the client can do, as far as it matters to what is sent unasked.
#[derive(Debug, Default)]
pub(super) struct Abilities {
    pub(super) progress: AtomicBool,
    pub(super) links_at_codes: AtomicBool,
    pub(super) fetches_diagnostics: AtomicBool,
}

/// Works until the process ends.
pub(super) fn work(analyst: &Analyst, desk: &Desk) {
    // What is remembered of each text from one keystroke to the next.
    let mut compilers: BTreeMap<String, Compiler> = BTreeMap::new();
    let send = |uri, diagnostics, version| {
        let sending = desk.client.publish_diagnostics(uri, diagnostics, version);
        desk.runtime.block_on(sending);
    };
    loop {
        match analyst.next() {
            Task::TakeBack(uri) => send(uri, vec![], None),
            Task::Close(uri) => {
                // It may be open again, and then be analysed behind this.
                compilers.remove(uri.as_str());
                desk.links.forget(uri.as_str());
                send(uri, vec![], None);
            }
            Task::Analyse(uri) => {
                let Some(document) = analyst.documents.current(&uri) else {
                    continue;
                };
                let compiler = compilers.entry(uri.clone()).or_default();
                let Some((analysed, by_a_link)) = analysed(analyst, desk, compiler, document)
                else {
                    continue;
                };
                if !analyst.is_due(&uri) {
                    continue;
                }
                if analyst.is_fetched(&uri) {
                    // Who fetches diagnostics after changes of the text cannot know of changes elsewhere.
                    if by_a_link {
                        let client = desk.client.clone();
                        desk.runtime
                            .spawn(async move { client.workspace_diagnostic_refresh().await });
                    }
                    continue;
                }
                let links = desk.abilities.links_at_codes.load(Ordering::Relaxed);
                let diagnostics = convert::diagnostics(&analysed, manual::links(links));
                // Between here and the wire the text may change again; what is sent then is sent behind this.
                let document = &analysed.document;
                send(document.uri.clone(), diagnostics, Some(document.version));
            }
        }
    }
}

/// Analyses a state of a text, unless that is done, and hands it to those who wait. `None` if its state is gone
/// meanwhile: it is analysed behind this as it is then. Says too whether only something that it links to has changed.
fn analysed(
    analyst: &Analyst,
    desk: &Desk,
    compiler: &mut Compiler,
    document: Arc<Document>,
) -> Option<(Arc<Analysed>, bool)> {
    let uri = document.uri.clone();
    let last = analyst.documents.last(uri.as_str());
    if let Some(last) = &last
        && last.document.generation == document.generation
    {
        return Some((last.clone(), false));
    }
    let shows_progress = desk.abilities.progress.load(Ordering::Relaxed);
    let progress = shows_progress.then(|| progress::begin(desk, &document));
    let resolver = document.resolver();
    let compiled = compiler.compile(document.text(), &Options::default(), resolver.as_ref());
    let places = places(&document, &compiled);
    desk.links.watch(uri.as_str(), places);
    let analysis = Analysis::new(document.text().clone(), compiled);
    let by_a_link = last
        .as_ref()
        .is_some_and(|last| last.document.version == document.version);
    let good = match (analysis.is_sound(), last) {
        (false, Some(last)) if last.analysis.is_sound() => Some(last),
        (false, Some(last)) => last.good.clone(),
        _ => None,
    };
    let analysed = Arc::new(Analysed {
        document,
        analysis,
        good,
    });
    drop(progress);
    let arrived = analyst.documents.arrive(analysed.clone());
    arrived.then_some((analysed, by_a_link))
}

/// The files that a drawing links to, also those that are not there yet.
fn places(document: &Document, compiled: &Compiled) -> Vec<PathBuf> {
    let Some(folder) = document.folder() else {
        return vec![];
    };
    let resolver = FolderResolver::new(folder);
    let links = compiled.dependencies.iter();
    links.filter_map(|link| resolver.place(link).ok()).collect()
}
