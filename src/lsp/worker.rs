//! The thread that compiles the open texts: one text at a time, always the newest state.
//!
//! An analysis whose state is out of date is thrown away. Diagnostics are sent in the order in which they
//! were found, with the version of their state. The thread survives panics, which become
//! diagnostics.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use tokio::runtime::Handle;
use tower_lsp::Client;
use tower_lsp::ls_types::{Diagnostic, Uri};

use super::documents::{Documents, resolver};
use super::preview::Previews;
use super::scheduler::{Scheduler, Task};
use super::{links::Links, manual, progress};
use crate::compile::{Compiled, Compiler, Options};
use crate::crash::{self, Crash};
use crate::disk::FolderResolver;
use crate::ide::Analysis;
use crate::protocol::convert;
use crate::protocol::document::{Analyzed, Document};
use crate::threads;

/// How long after a text was closed the allocator is used, and how many bytes it is asked for: enough to go beyond what
/// a thread keeps for itself.
const RELEASE_DELAY: Duration = Duration::from_millis(200);
const RELEASE_SIZE: usize = 1 << 20;

/// The state of the thread.
#[derive(Debug)]
pub(super) struct Worker {
    pub(super) scheduler: Arc<Scheduler>,
    pub(super) documents: Arc<Documents>,
    pub(super) client: Client,
    pub(super) runtime: Handle,
    pub(super) links: Arc<Links>,
    pub(super) client_support: Arc<ClientSupport>,
    pub(super) previews: Arc<Previews>,
    /// The incremental compiler of each text.
    pub(super) compilers: BTreeMap<String, Compiler>,
}

/// The client's capabilities that decide what is sent without a request.
#[derive(Debug, Default)]
pub(super) struct ClientSupport {
    pub(super) progress: AtomicBool,
    pub(super) links_at_codes: AtomicBool,
    pub(super) pulls_diagnostics: AtomicBool,
}

impl Worker {
    /// Runs tasks until the process ends.
    pub(super) fn work(&mut self) {
        loop {
            let task = self.scheduler.next_task();
            let done = crash::catch(|| self.run(task.clone()));
            if let (Err(crash), Task::Analyze(uri)) = (done, task) {
                // If even that panics, the next change tries again.
                let _ = crash::catch(|| self.report_crash(&uri, &crash));
            }
        }
    }

    fn run(&mut self, task: Task) {
        match task {
            Task::ClearDiagnostics(uri) => self.send(uri, vec![], None),
            Task::Close(uri) => {
                // If it is open again, a later task analyses it.
                self.compilers.remove(uri.as_str());
                self.links.forget(uri.as_str());
                self.previews.closed(uri.as_str());
                self.send(uri, vec![], None);
                self.release_memory();
            }
            Task::Analyze(uri) => {
                let Some(document) = self.documents.current(&uri) else {
                    return;
                };
                // Dropped after the diagnostics are sent, because dropping takes time.
                let before = self.documents.last(&uri);
                if let Some((analyzed, only_links_changed)) = self.analyze(document) {
                    self.publish_diagnostics(&analyzed, only_links_changed);
                    self.previews.analyzed(&analyzed);
                }
                drop(before);
            }
        }
    }

    /// Gives the memory of a closed text back to the system.
    ///
    /// The allocator does that itself a while after memory was freed, but only when it is used again, and a server that
    /// waits for messages does not use it.
    fn release_memory(&self) {
        self.runtime.spawn(async {
            tokio::time::sleep(RELEASE_DELAY).await;
            let use_allocator = || drop(std::hint::black_box(vec![0_u8; RELEASE_SIZE]));
            use_allocator();
            // Each thread has memory of its own.
            threads::run_on_each(use_allocator);
        });
    }

    /// Sends the diagnostics of an analysis, if that was requested.
    fn publish_diagnostics(&self, analyzed: &Analyzed, only_links_changed: bool) {
        let document = &analyzed.document;
        let uri = document.uri.as_str();
        if !self.scheduler.take_due(document) {
            return;
        }
        if self.scheduler.is_pulled(uri) {
            // A client that requests diagnostics does so when the text changes; it does not know of other changes.
            if only_links_changed {
                let client = self.client.clone();
                self.runtime
                    .spawn(async move { client.workspace_diagnostic_refresh().await });
            }
            return;
        }
        let links = self.client_support.links_at_codes.load(Ordering::Relaxed);
        let diagnostics = convert::diagnostics(analyzed, manual::links(links));
        // If the text changes before this is sent, the diagnostics of that change are due and follow later.
        self.send(document.uri.clone(), diagnostics, Some(document.version));
    }

    fn send(&self, uri: Uri, diagnostics: Vec<Diagnostic>, version: Option<i32>) {
        let sending = self.client.publish_diagnostics(uri, diagnostics, version);
        self.runtime.block_on(sending);
    }

    /// Analyses a state of a text, unless that is done, and hands it to the waiting requests. `None` if its state is out of date
    /// meanwhile: a later task analyses the newer one. Also returns whether only a file that it links to has
    /// changed.
    fn analyze(&mut self, document: Arc<Document>) -> Option<(Arc<Analyzed>, bool)> {
        let uri = document.uri.to_string();
        let last = self.documents.last(&uri);
        if let Some(last) = &last
            && last.document.generation == document.generation
        {
            return Some((last.clone(), false));
        }
        let shows_progress = self.client_support.progress.load(Ordering::Relaxed);
        let progress =
            shows_progress.then(|| progress::begin(&self.client, &self.runtime, &document));
        let resolver = resolver(&document);
        let compiler = self.compilers.entry(uri.clone()).or_default();
        let compiled = compiler.compile(document.text(), &Options::default(), resolver.as_ref());
        self.links.watch(&uri, linked_files(&document, &compiled));
        let only_links_changed = last
            .as_ref()
            .is_some_and(|last| last.document.version == document.version);
        let analysis = Analysis::new(document.text().clone(), compiled);
        let analyzed = Analyzed::new(document, analysis, last);
        drop(progress);
        let arrived = self.documents.publish(analyzed.clone());
        arrived.then_some((analyzed, only_links_changed))
    }

    /// Answers the requests that wait for an analysis that panicked outside of compiling with one whose only diagnostic is the
    /// crash.
    fn report_crash(&mut self, uri: &str, crash: &Crash) {
        self.compilers.remove(uri);
        if let Some(document) = self.documents.current(uri) {
            let last = self.documents.last(uri);
            let analysis = Analysis::new(document.text().clone(), Compiled::crashed(crash));
            let analyzed = Analyzed::new(document, analysis, last);
            if self.documents.publish(analyzed.clone()) {
                self.publish_diagnostics(&analyzed, false);
            }
        }
    }
}

/// The files that a drawing links to, also those that do not exist yet.
fn linked_files(document: &Document, compiled: &Compiled) -> Vec<PathBuf> {
    let Some(folder) = document.folder() else {
        return vec![];
    };
    let resolver = FolderResolver::new(folder);
    let links = compiled.dependencies.iter();
    links.filter_map(|link| resolver.place(link).ok()).collect()
}
