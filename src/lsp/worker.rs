//! Who compiles the open texts: one thread, one text at a time, always the newest state.
//!
//! What was found in a state that is no longer the newest is thrown away. Diagnostics leave in the order in which they
//! were found, with the number of their state. The thread outlives whatever panics in it.

use std::collections::BTreeMap;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use tokio::runtime::Handle;
use tower_lsp::Client;
use tower_lsp::ls_types::{Diagnostic, Uri};

use super::analyst::{Analyst, Task};
use super::documents::{Analysed, Document, Documents};
use super::preview::Previews;
use super::{convert, links::Links, manual, progress};
use crate::compile::{Compiled, Compiler, Options};
use crate::disk::FolderResolver;
use crate::ide::Analysis;

/// What the thread works with.
#[derive(Debug)]
pub(super) struct Worker {
    pub(super) analyst: Arc<Analyst>,
    pub(super) documents: Arc<Documents>,
    pub(super) client: Client,
    pub(super) runtime: Handle,
    pub(super) links: Arc<Links>,
    pub(super) abilities: Arc<Abilities>,
    pub(super) previews: Arc<Previews>,
    /// What is remembered of each text from one keystroke to the next.
    pub(super) compilers: BTreeMap<String, Compiler>,
}

/// What the client can do, as far as it matters to what is sent unasked.
#[derive(Debug, Default)]
pub(super) struct Abilities {
    pub(super) progress: AtomicBool,
    pub(super) links_at_codes: AtomicBool,
    pub(super) fetches_diagnostics: AtomicBool,
}

impl Worker {
    /// Works until the process ends.
    pub(super) fn work(&mut self) {
        loop {
            let task = self.analyst.next();
            let done = catch_unwind(AssertUnwindSafe(|| self.does(task.clone())));
            if let (Err(_), Task::Analyse(uri)) = (done, task) {
                self.gives_up(&uri);
            }
        }
    }

    fn does(&mut self, task: Task) {
        match task {
            Task::TakeBack(uri) => self.send(uri, vec![], None),
            Task::Close(uri) => {
                // It may be open again, and then be analysed behind this.
                self.compilers.remove(uri.as_str());
                self.links.forget(uri.as_str());
                self.previews.closed(uri.as_str());
                self.send(uri, vec![], None);
            }
            Task::Analyse(uri) => {
                let Some(document) = self.documents.current(&uri) else {
                    return;
                };
                // Held until all is said: taking it apart takes time.
                let before = self.documents.last(&uri);
                if let Some((analysed, by_a_link)) = self.analysed(document) {
                    self.tell(&analysed, by_a_link);
                    self.previews.analysed(&analysed);
                }
                drop(before);
            }
        }
    }

    /// Sends the diagnostics of an analysis, if they are due.
    fn tell(&self, analysed: &Analysed, by_a_link: bool) {
        let document = &analysed.document;
        let uri = document.uri.as_str();
        if !self.analyst.is_due(uri) {
            return;
        }
        if self.analyst.is_fetched(uri) {
            // Who fetches diagnostics after changes of the text cannot know of changes elsewhere.
            if by_a_link {
                let client = self.client.clone();
                self.runtime
                    .spawn(async move { client.workspace_diagnostic_refresh().await });
            }
            return;
        }
        let links = self.abilities.links_at_codes.load(Ordering::Relaxed);
        let diagnostics = convert::diagnostics(analysed, manual::links(links));
        // Between here and the wire the text may change again; what is sent then is sent behind this.
        self.send(document.uri.clone(), diagnostics, Some(document.version));
    }

    fn send(&self, uri: Uri, diagnostics: Vec<Diagnostic>, version: Option<i32>) {
        let sending = self.client.publish_diagnostics(uri, diagnostics, version);
        self.runtime.block_on(sending);
    }

    /// Analyses a state of a text, unless that is done, and hands it to those who wait. `None` if its state is gone
    /// meanwhile: it is analysed behind this as it is then. Says too whether only something that it links to has
    /// changed.
    fn analysed(&mut self, document: Arc<Document>) -> Option<(Arc<Analysed>, bool)> {
        let uri = document.uri.to_string();
        let last = self.documents.last(&uri);
        if let Some(last) = &last
            && last.document.generation == document.generation
        {
            return Some((last.clone(), false));
        }
        let shows_progress = self.abilities.progress.load(Ordering::Relaxed);
        let progress =
            shows_progress.then(|| progress::begin(&self.client, &self.runtime, &document));
        let resolver = document.resolver();
        let compiler = self.compilers.entry(uri.clone()).or_default();
        let compiled = compiler.compile(document.text(), &Options::default(), resolver.as_ref());
        self.links.watch(&uri, places(&document, &compiled));
        let by_a_link = last
            .as_ref()
            .is_some_and(|last| last.document.version == document.version);
        let analysed = put_together(document, compiled, last);
        drop(progress);
        let arrived = self.documents.arrive(analysed.clone());
        arrived.then_some((analysed, by_a_link))
    }

    /// Answers those who wait for an analysis that panicked: with one that knows nothing.
    fn gives_up(&mut self, uri: &str) {
        self.compilers.remove(uri);
        if let Some(document) = self.documents.current(uri) {
            let last = self.documents.last(uri);
            let nothing = put_together(document, Compiled::default(), last);
            self.documents.arrive(nothing);
        }
    }
}

fn put_together(
    document: Arc<Document>,
    compiled: Compiled,
    last: Option<Arc<Analysed>>,
) -> Arc<Analysed> {
    let analysis = Analysis::new(document.text().clone(), compiled);
    let good = match (analysis.is_sound(), last) {
        (false, Some(last)) if last.analysis.is_sound() => Some(last),
        (false, Some(last)) => last.good.clone(),
        _ => None,
    };
    Arc::new(Analysed {
        document,
        analysis,
        good,
    })
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
