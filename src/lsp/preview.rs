//! The live preview of open texts, saved or not: in the client's own panel, or on a page in the browser.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, OnceLock, PoisonError};
use std::time::SystemTime;

use base64::Engine;
use percent_encoding::{AsciiSet, NON_ALPHANUMERIC, PercentEncode, utf8_percent_encode};
use serde::{Deserialize, Serialize};
use serde_json::Value;
use serde_json::value::RawValue;
use tokio::runtime::Handle;
use tower_lsp::Client;
use tower_lsp::jsonrpc::{Error, Result};
use tower_lsp::ls_types::notification::Notification;
use tower_lsp::ls_types::*;

use super::backend::Backend;
use super::documents::Documents;
use crate::compile::Compiled;
use crate::crash;
use crate::memo::Memo;
use crate::page::{Builds, Hub, Picked, editing_in_client};
use crate::preview::{PORT, bind, serve};
use crate::protocol::document::Analyzed;
use crate::protocol::news::Showing;
use crate::source::Span;

/// The texts that are previewed, and the connections to panel and page.
pub(super) struct Previews {
    hub: Arc<Hub>,
    client: Client,
    runtime: Handle,
    documents: Arc<Documents>,
    queue: Mutex<Queue>,
    wakeup: Condvar,
    /// The page's address, once one is served.
    page: OnceLock<String>,
    /// Whether the client has panels of its own.
    panels: OnceLock<()>,
}

impl std::fmt::Debug for Previews {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Previews").finish_non_exhaustive()
    }
}

#[derive(Default)]
struct Queue {
    /// The texts that are shown, with the generation that was last queued of each.
    open: BTreeMap<String, Option<u64>>,
    /// The newest states that are not built yet.
    waiting: BTreeMap<String, Arc<Analyzed>>,
}

impl Previews {
    /// Starts the thread that builds; nothing is shown yet.
    pub(super) fn new(client: Client, runtime: Handle, documents: Arc<Documents>) -> Arc<Self> {
        let (client_of_hub, runtime_of_hub) = (client.clone(), runtime.clone());
        let texts = documents.clone();
        let show = move |uri: &str, picked: Picked<'_>| {
            let found = texts.last(uri).and_then(|last| {
                let span = match picked {
                    Picked::Part(part) => last.analysis.place_of(part)?,
                    Picked::Position { line, column } => {
                        Span::at(offset(last.document.text(), line, column))
                    }
                };
                Some((
                    last.document.uri.clone(),
                    last.document.positions.range(span),
                ))
            });
            let Some((uri, range)) = found else { return };
            let client = client_of_hub.clone();
            runtime_of_hub.spawn(async move {
                let params = ShowDocumentParams {
                    uri,
                    external: None,
                    take_focus: Some(true),
                    selection: Some(range),
                };
                // A client that cannot show it needs no error.
                let _ = client.show_document(params).await;
            });
        };
        // An editor begins drawings by itself.
        let hub = Hub::new(show, None, None, None);
        let previews = Arc::new(Self {
            hub,
            client,
            runtime,
            documents,
            queue: Mutex::default(),
            wakeup: Condvar::new(),
            page: OnceLock::new(),
            panels: OnceLock::new(),
        });
        let builder = previews.clone();
        std::thread::spawn(move || builder.build());
        previews
    }

    fn queue(&self) -> MutexGuard<'_, Queue> {
        self.queue.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// The client has panels: events are sent to it, and no page is served.
    pub(super) fn use_panels(self: &Arc<Self>) {
        if self.panels.set(()).is_ok() {
            let previews = self.clone();
            self.runtime
                .spawn(async move { previews.forward_news().await });
        }
    }

    /// A state of a text was analysed: queues it once if its text is shown.
    pub(super) fn analyzed(&self, analyzed: &Arc<Analyzed>) {
        let mut queue = self.queue();
        let uri = analyzed.document.uri.to_string();
        let generation = Some(analyzed.document.generation);
        let Some(last) = queue.open.get_mut(&uri) else {
            return;
        };
        if *last < generation {
            *last = generation;
            queue.waiting.insert(uri, analyzed.clone());
            self.wakeup.notify_one();
        }
    }

    /// A text was closed in the editor.
    pub(super) fn closed(&self, uri: &str) {
        self.hub.gone(uri);
    }

    /// Shows an analysed text from now on.
    fn open(&self, uri: &Uri) {
        let uri = uri.as_str();
        let mut queue = self.queue();
        if !queue.open.contains_key(uri) {
            queue.open.insert(uri.to_owned(), None);
            // Events of a text that was shown before are sent again.
            self.hub.remove(uri);
        }
        drop(queue);
        // Only now, since later analyses are queued by themselves.
        if let Some(last) = self.documents.last(uri) {
            self.analyzed(&last);
        }
    }

    fn close(&self, uri: &str) {
        let mut queue = self.queue();
        queue.open.remove(uri);
        queue.waiting.remove(uri);
        drop(queue);
        self.hub.remove(uri);
    }

    /// Builds the queued states, always the newest, until the process ends.
    fn build(&self) {
        let mut memories: BTreeMap<String, Memo> = BTreeMap::new();
        loop {
            let mut queue = self.queue();
            let next = loop {
                if let Some(next) = queue.waiting.pop_first() {
                    break next;
                }
                let woken = self.wakeup.wait(queue);
                queue = woken.unwrap_or_else(PoisonError::into_inner);
            };
            memories.retain(|uri, _| queue.open.contains_key(uri));
            drop(queue);
            let (uri, analyzed) = next;
            let memory = memories.entry(uri.clone()).or_default();
            let compiled = analyzed.analysis.compiled();
            if let Err(crash) = crash::catch(|| self.publish(&uri, &analyzed, compiled, memory)) {
                memories.remove(&uri);
                let crashed = Compiled::crashed(&crash);
                self.publish(&uri, &analyzed, &crashed, &mut Memo::default());
            }
        }
    }

    fn publish(&self, uri: &str, analyzed: &Analyzed, compiled: &Compiled, memory: &mut Memo) {
        let document = &analyzed.document;
        let path = document.path.as_deref();
        let name = path.and_then(|path| path.file_name());
        let name = name.map_or("untitled".into(), |name| name.to_string_lossy());
        let showing = Showing {
            hub: &self.hub,
            document,
            name: &name,
            compiled,
            clock: &SystemTime::now,
            // The text may have been closed meanwhile.
            is_open: &|| self.queue().open.contains_key(uri),
        };
        showing.publish(memory);
    }

    /// Sends the client's panels all events, until the client disconnects.
    async fn forward_news(&self) {
        let mut clock = self.hub.clock();
        let mut sent: BTreeMap<String, u64> = BTreeMap::new();
        loop {
            clock.borrow_and_update();
            let open: BTreeSet<String> = self.queue().open.keys().cloned().collect();
            sent.retain(|uri, _| open.contains(uri));
            for uri in open.iter().filter(|uri| self.hub.shows(uri)) {
                let since = sent.entry(uri.clone()).or_default();
                let is_first = *since == 0;
                let (mut messages, now) = self.hub.updates(*since, Some(uri), Builds::Whole);
                *since = now;
                if is_first {
                    messages.insert(0, editing_in_client());
                }
                let Ok(uri) = uri.parse() else { continue };
                let messages = messages.iter();
                let raw = messages.map(|message| RawValue::from_string(message.to_string()));
                let messages: Vec<_> = raw.flatten().collect();
                if messages.is_empty() {
                    continue;
                }
                let news = News {
                    text_document: TextDocumentIdentifier { uri },
                    messages,
                };
                self.client
                    .send_notification::<NewsNotification>(news)
                    .await;
            }
            if clock.changed().await.is_err() {
                return;
            }
        }
    }

    /// The address of the page that shows a text.
    fn page(&self, uri: &str) -> std::io::Result<String> {
        let url = match self.page.get() {
            Some(url) => url.clone(),
            None => {
                let bound = bind(None, PORT)?;
                let url = bound.url();
                if self.page.set(url.clone()).is_ok() {
                    self.runtime.spawn(serve(bound, self.hub.clone()));
                }
                self.page.get().cloned().unwrap_or(url)
            }
        };
        Ok(format!("{url}#{}", escaped(uri)))
    }
}

/// The byte offset of a line and a column, which count from 1.
fn offset(text: &str, line: usize, column: usize) -> usize {
    let mut lines = text.split_inclusive('\n');
    let before: usize = lines
        .by_ref()
        .take(line.saturating_sub(1))
        .map(str::len)
        .sum();
    let line = lines.next().unwrap_or("");
    let mut places = line.char_indices().map(|(at, _)| at);
    before + places.nth(column.saturating_sub(1)).unwrap_or(line.len())
}

/// What is not written as it is in the fragment of an address.
const ENCODED: &AsciiSet = &NON_ALPHANUMERIC
    .remove(b'-')
    .remove(b'.')
    .remove(b'_')
    .remove(b'~');

/// Percent-encodes text for the fragment of an address.
fn escaped(text: &str) -> PercentEncode<'_> {
    utf8_percent_encode(text, ENCODED)
}

/// Events of one drawing.
#[derive(Debug, Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct News {
    text_document: TextDocumentIdentifier,
    messages: Vec<Box<RawValue>>,
}

struct NewsNotification;

impl Notification for NewsNotification {
    type Params = News;
    const METHOD: &'static str = "okoshi/preview/news";
}

#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct OpenParams {
    text_document: TextDocumentIdentifier,
}

#[derive(Debug, Deserialize)]
pub(super) struct ModelParams {
    address: String,
}

#[derive(Debug, Serialize)]
pub(super) struct ModelAnswer {
    bytes: String,
}

#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct PartParams {
    text_document: TextDocumentIdentifier,
    part: String,
}

#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct CursorParams {
    text_document: TextDocumentIdentifier,
    position: Option<Position>,
}

impl Backend {
    /// Starts the preview of a text in the client's panel.
    pub(super) async fn preview_open(&self, params: OpenParams) -> Result<Value> {
        self.preview(&params.text_document.uri).await?;
        Ok(Value::Null)
    }

    /// Previews a text from now on.
    async fn preview(&self, uri: &Uri) -> Result<()> {
        if self.analyzed(uri).await?.is_none() {
            return Err(Error::invalid_params("this drawing is not open"));
        }
        self.previews.open(uri);
        Ok(())
    }

    /// Ends the preview of a text.
    pub(super) async fn preview_close(&self, params: OpenParams) {
        self.previews.close(params.text_document.uri.as_str());
    }

    /// The bytes of a model, in Base64.
    pub(super) async fn preview_model(&self, params: ModelParams) -> Result<Option<ModelAnswer>> {
        let bytes = self.previews.hub.bytes(&params.address);
        Ok(bytes.map(|bytes| ModelAnswer {
            bytes: base64::engine::general_purpose::STANDARD.encode(bytes),
        }))
    }

    /// The location of a part's string.
    pub(super) async fn preview_place(&self, params: PartParams) -> Result<Option<Location>> {
        let Some(view) = self.view(&params.text_document.uri).await? else {
            return Ok(None);
        };
        let span = view.analysis().place_of(&params.part);
        let range = span.and_then(|span| view.map().range(span));
        Ok(range.map(|range| Location::new(params.text_document.uri, range)))
    }

    /// Highlights the part at the cursor.
    pub(super) async fn preview_cursor(&self, params: CursorParams) {
        let uri = &params.text_document.uri;
        let Ok(Some(view)) = self.view(uri).await else {
            return;
        };
        let map = view.map();
        let offset = params.position.and_then(|position| map.offset(position));
        let part = offset.and_then(|offset| view.analysis().part_at(offset));
        self.previews.hub.light(uri.as_str(), part);
    }

    /// Shows a text on a page in the browser, or says where that page is.
    pub(super) async fn show_page(&self, uri: &Uri) -> Result<()> {
        self.preview(uri).await?;
        let page = match self.previews.page(uri.as_str()) {
            Ok(page) => page,
            Err(error) => {
                let message = format!("the preview cannot be served: {error}");
                self.client.show_message(MessageType::ERROR, message).await;
                return Ok(());
            }
        };
        let can = self
            .client_capabilities()
            .window
            .and_then(|can| can.show_document);
        let shown = match (can.is_some_and(|can| can.support), page.parse()) {
            (true, Ok(uri)) => {
                let params = ShowDocumentParams {
                    uri,
                    external: Some(true),
                    take_focus: Some(false),
                    selection: None,
                };
                self.client.show_document(params).await.unwrap_or(false)
            }
            _ => false,
        };
        if !shown {
            let message = format!("the preview is at {page}");
            self.client.show_message(MessageType::INFO, message).await;
        }
        Ok(())
    }
}
