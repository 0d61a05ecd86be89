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
use crate::resolver::{MemoryResolver, Resolver};

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
    waiting: VecDeque<String>,
    closed: Vec<Uri>,
    /// Texts whose diagnostics the client fetches itself.
    pulled: BTreeSet<String>,
    when: When,
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

    /// A text was opened: it is analysed.
    pub(super) fn opened(&self, uri: &str) {
        self.ask(uri);
    }

    /// A text has changed: it is analysed, if that is wanted while typing.
    pub(super) fn changed(&self, uri: &str) {
        if self.queue().when == When::OnType {
            self.ask(uri);
        }
    }

    /// A text was saved.
    pub(super) fn saved(&self, uri: &str) {
        self.ask(uri);
    }

    /// Something that a text links to has changed.
    pub(super) fn touched(&self, uri: &str) {
        self.documents.touch(uri);
        self.ask(uri);
    }

    /// A text was closed: its diagnostics go.
    pub(super) fn closed(&self, uri: &Uri) {
        let mut queue = self.queue();
        queue.waiting.retain(|waiting| waiting != uri.as_str());
        queue.pulled.remove(uri.as_str());
        queue.closed.push(uri.clone());
        self.woken.notify_one();
    }

    /// The client fetches a text's diagnostics itself: they are no longer sent. Says whether this is new.
    pub(super) fn pulled(&self, uri: &str) -> bool {
        self.queue().pulled.insert(uri.to_owned())
    }

    /// Has a text analysed, unless it is or will be.
    pub(super) fn ask(&self, uri: &str) {
        if !self.documents.ask(uri) {
            return;
        }
        let mut queue = self.queue();
        if !queue.waiting.iter().any(|waiting| waiting == uri) {
            queue.waiting.push_back(uri.to_owned());
        }
        self.woken.notify_one();
    }

    /// What is to be done next; waits for it.
    fn next(&self) -> Task {
        let mut queue = self.queue();
        loop {
            if let Some(uri) = queue.closed.pop() {
                return Task::Clear(uri);
            }
            if let Some(uri) = queue.waiting.pop_front() {
                return Task::Analyse(uri);
            }
            queue = self
                .woken
                .wait(queue)
                .unwrap_or_else(|poisoned| poisoned.into_inner());
        }
    }

    fn sends(&self, uri: &str) -> bool {
        !self.queue().pulled.contains(uri)
    }
}

enum Task {
    Analyse(String),
    Clear(Uri),
}

/// What the thread needs besides the texts.
#[derive(Debug)]
pub(super) struct Desk {
    pub(super) client: Client,
    pub(super) runtime: Handle,
    pub(super) links: Arc<Links>,
    /// Whether the client shows progress, links at codes, and can be asked to fetch diagnostics anew.
    pub(super) abilities: Arc<Abilities>,
}

/// What the client can do, as far as it matters to what is sent unasked.
#[derive(Debug, Default)]
pub(super) struct Abilities {
    pub(super) progress: AtomicBool,
    pub(super) links_at_codes: AtomicBool,
    pub(super) fetches_diagnostics: AtomicBool,
    pub(super) fetches_again: AtomicBool,
}

/// Works until the process ends.
pub(super) fn work(analyst: &Analyst, desk: &Desk) {
    // What is remembered of each text from one keystroke to the next.
    let mut compilers: BTreeMap<String, Compiler> = BTreeMap::new();
    loop {
        match analyst.next() {
            Task::Clear(uri) => {
                compilers.remove(uri.as_str());
                desk.links.forget(uri.as_str());
                let sending = desk.client.publish_diagnostics(uri, vec![], None);
                desk.runtime.block_on(sending);
            }
            Task::Analyse(uri) => {
                if let Some(document) = analyst.documents.current(&uri) {
                    let compiler = compilers.entry(uri).or_default();
                    analyse(analyst, desk, compiler, document);
                }
            }
        }
    }
}

fn analyse(analyst: &Analyst, desk: &Desk, compiler: &mut Compiler, document: Arc<Document>) {
    let uri = document.uri.clone();
    let progress = desk
        .abilities
        .progress
        .load(Ordering::Relaxed)
        .then(|| progress::begin(desk, &document));
    let last = analyst.documents.last(uri.as_str());
    let compiled = compiled(compiler, &document);
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
    if !analyst.documents.arrive(analysed.clone()) {
        return;
    }
    if !analyst.sends(uri.as_str()) {
        // Who fetches diagnostics after changes of the text cannot know of changes elsewhere.
        if by_a_link && desk.abilities.fetches_again.load(Ordering::Relaxed) {
            let client = desk.client.clone();
            desk.runtime
                .spawn(async move { client.workspace_diagnostic_refresh().await });
        }
        return;
    }
    let links = desk.abilities.links_at_codes.load(Ordering::Relaxed);
    let diagnostics = convert::diagnostics(&analysed, manual::links(links));
    // Between here and the wire the text may change again; what is sent then is sent behind this.
    let version = Some(analysed.document.version);
    let sending = desk.client.publish_diagnostics(uri, diagnostics, version);
    desk.runtime.block_on(sending);
}

/// Compiles a state of a text; links are read from its folder.
fn compiled(compiler: &mut Compiler, document: &Document) -> Compiled {
    let resolver: Box<dyn Resolver> = match document.folder() {
        Some(folder) => Box::new(FolderResolver::new(folder)),
        None => Box::new(MemoryResolver::default()),
    };
    compiler.compile(document.text(), &Options::default(), resolver.as_ref())
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
