//! The service between the connection and the handlers: keeps the order of messages, takes snapshots, catches panics.
//!
//! Kept by hand, because no tower layer and no option of the framework keeps the order: it
//! runs up to four handlers at once, and a handler begins only when it is first polled, so that handlers of `didChange`
//! can store versions out of order. So texts are not changed by handlers: this service sees the messages one by one and changes the texts
//! before it reads the next. With every request it keeps a snapshot of all texts; the
//! request is answered from that, however late it is polled. A handler that panics is answered as an error,
//! and the server goes on.

use std::collections::BTreeMap;
use std::panic::AssertUnwindSafe;
use std::sync::Arc;
use std::task::{Context, Poll};

use futures::FutureExt;
use futures::future::BoxFuture;
use serde::Deserialize;
use serde_json::Value;
use tokio::task::JoinError;
use tower::Service;
use tower_lsp::jsonrpc::{Error, Id, Request, Response};
use tower_lsp::ls_types::{
    DidChangeConfigurationParams, DidChangeTextDocumentParams, DidCloseTextDocumentParams,
    DidOpenTextDocumentParams, DidSaveTextDocumentParams,
};

use super::documents::{Documents, Snapshot};
use super::messages::UNREADABLE;
use super::scheduler::Scheduler;
use crate::crash::{self, Crash};

tokio::task_local! {
    /// The open texts when the request came that is being answered.
    pub(super) static SNAPSHOTS: Arc<BTreeMap<String, Snapshot>>;
}

/// See the [module](self).
#[derive(Debug)]
pub(super) struct Ordered<S> {
    inner: S,
    documents: Arc<Documents>,
    scheduler: Arc<Scheduler>,
}

impl<S> Ordered<S> {
    pub(super) fn new(inner: S, documents: Arc<Documents>, scheduler: Arc<Scheduler>) -> Self {
        Self {
            inner,
            documents,
            scheduler,
        }
    }

    /// Applies a message that changes texts or settings; `false` if it is another message.
    fn changes_texts(&self, request: &Request) -> bool {
        let Some(params) = request.params() else {
            return false;
        };
        match request.method() {
            "textDocument/didOpen" => {
                if let Some(params) = read::<DidOpenTextDocumentParams>(params) {
                    let uri = params.text_document.uri.to_string();
                    self.documents.open(params.text_document);
                    self.scheduler.opened_or_saved(&uri);
                }
            }
            "textDocument/didChange" => {
                if let Some(params) = read::<DidChangeTextDocumentParams>(params) {
                    self.documents
                        .change(&params.text_document, params.content_changes);
                    self.scheduler.changed(params.text_document.uri.as_str());
                }
            }
            "textDocument/didClose" => {
                if let Some(params) = read::<DidCloseTextDocumentParams>(params) {
                    self.documents.close(params.text_document.uri.as_str());
                    self.scheduler.closed(&params.text_document.uri);
                }
            }
            "textDocument/didSave" => {
                if let Some(params) = read::<DidSaveTextDocumentParams>(params) {
                    let uri = params.text_document.uri.as_str();
                    self.scheduler.opened_or_saved(uri);
                }
            }
            "workspace/didChangeConfiguration" => {
                if let Some(params) = read::<DidChangeConfigurationParams>(params) {
                    self.scheduler.configure(&params.settings);
                }
            }
            _ => return false,
        }
        true
    }
}

fn read<'a, T: Deserialize<'a>>(params: &'a Value) -> Option<T> {
    T::deserialize(params).ok()
}

impl<S> Service<Request> for Ordered<S>
where
    S: Service<Request, Response = Option<Response>>,
    S::Future: Send + 'static,
    S::Error: Send + 'static,
{
    type Response = Option<Response>;
    type Error = S::Error;
    type Future = BoxFuture<'static, Result<Self::Response, Self::Error>>;

    fn poll_ready(&mut self, context: &mut Context<'_>) -> Poll<Result<(), Self::Error>> {
        self.inner.poll_ready(context)
    }

    fn call(&mut self, request: Request) -> Self::Future {
        if let Some(error) = unreadable(&request) {
            let answer = Response::from_error(Id::Null, error);
            return Box::pin(std::future::ready(Ok(Some(answer))));
        }
        let request = without_empty_params(request);
        let id = request.id().cloned();
        let begun = crash::catch(|| {
            if self.changes_texts(&request) {
                return None;
            }
            let snapshots = Arc::new(self.documents.snapshots());
            Some(SNAPSHOTS.scope(snapshots, self.inner.call(request)))
        });
        let running = match begun {
            Ok(Some(running)) => running,
            Ok(None) => return Box::pin(std::future::ready(Ok(None))),
            Err(crash) => {
                return Box::pin(std::future::ready(Ok(id.map(|id| crashed(id, &crash)))));
            }
        };
        Box::pin(async move {
            match AssertUnwindSafe(running).catch_unwind().await {
                Ok(answer) => answer,
                Err(payload) => Ok(id.map(|id| crashed(id, &Crash::from_panic(&*payload)))),
            }
        })
    }
}

/// Removes the empty parameters that some clients send with `shutdown` and `exit`, and the framework refuses.
fn without_empty_params(request: Request) -> Request {
    match (request.method(), request.id().cloned()) {
        ("shutdown", Some(id)) => Request::build("shutdown").id(id).finish(),
        ("exit", None) => Request::build("exit").finish(),
        _ => request,
    }
}

/// The error that stands for a message that could not be read.
fn unreadable(request: &Request) -> Option<Error> {
    let params = request
        .params()
        .filter(|_| request.method() == UNREADABLE)?;
    Some(read(params).unwrap_or_else(Error::invalid_request))
}

/// The answer to a request whose handler panicked.
fn crashed(id: Id, crash: &Crash) -> Response {
    Response::from_error(id, crash_error(crash))
}

fn crash_error(crash: &Crash) -> Error {
    let mut error = Error::internal_error();
    error.message = format!("{crash}; {}", crash::HELP).into();
    error
}

/// The answer to a request whose task, on a thread of its own, panicked or was cancelled.
pub(super) fn task_error(error: JoinError) -> Error {
    match error.try_into_panic() {
        Ok(payload) => crash_error(&Crash::from_panic(&*payload)),
        Err(_) => Error::internal_error(),
    }
}
