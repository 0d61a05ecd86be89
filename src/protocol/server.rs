//! The language server for an editor that has the program as a module: without threads, files, or a connection.
//!
//! Whoever has it hands over texts, the files that these link to, and requests, one after the other.

use std::collections::BTreeMap;
use std::fmt;
use std::sync::Arc;
use std::time::{Duration, SystemTime};

use ls_types::*;
use percent_encoding::{AsciiSet, NON_ALPHANUMERIC, utf8_percent_encode};
use serde::Serialize;
use serde::de::DeserializeOwned;
use serde_json::{Value, json};

use super::REFUSED;
use super::capabilities::initialize_result;
use super::convert::{self, PositionMap};
use super::document::{Analyzed, Document, View};
use super::news::Showing;
use super::positions::{Encoding, Positions};
use super::{changes, edits, queries};
use crate::compile::{Compiler, Options};
use crate::ide::changes::Change;
use crate::ide::{self, Analysis};
use crate::memo::Memo;
use crate::page::{Builds, Hub, editing_in_client};
use crate::resolver::{MemoryResolver, folder_and_name, inside, spellings};

/// The code of a request whose parameters cannot be read.
const INVALID_PARAMS: i64 = -32602;
/// The code of a request that is not known.
const METHOD_NOT_FOUND: i64 = -32601;

/// The ending of motion files.
const MOTION: &str = ".bvh";

/// What is not written as it is in a part of an address.
const ENCODED: &AsciiSet = &NON_ALPHANUMERIC
    .remove(b'-')
    .remove(b'.')
    .remove(b'_')
    .remove(b'~');

/// The texts that an editor has open.
pub struct Server {
    hub: Arc<Hub>,
    texts: BTreeMap<String, Open>,
    can: ClientCapabilities,
    generation: u64,
}

/// An open text.
struct Open {
    compiler: Compiler,
    /// The files that it may link to, from its folder.
    files: MemoryResolver,
    analyzed: Arc<Analyzed>,
    preview: Option<Preview>,
}

/// A text that a page shows.
#[derive(Default)]
struct Preview {
    surfaces: Memo,
    /// Until when the page has got messages.
    told: u64,
}

/// Why a request is not answered.
#[derive(Debug)]
struct Failure {
    code: i64,
    message: String,
}

type Answer = Result<Value, Failure>;

impl Failure {
    fn new(code: i64, message: impl fmt::Display) -> Self {
        Self {
            code,
            message: message.to_string(),
        }
    }
}

impl fmt::Debug for Server {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Server").finish_non_exhaustive()
    }
}

impl Default for Server {
    fn default() -> Self {
        Self {
            // An editor begins drawings by itself, and changes them in its own text.
            hub: Hub::new(|_, _| (), None, None, None),
            texts: BTreeMap::new(),
            can: ClientCapabilities::default(),
            generation: 0,
        }
    }
}

impl Server {
    /// Opens a text, or replaces it. `now` is in milliseconds since 1970.
    ///
    /// # Errors
    /// If the address is none.
    pub fn write(&mut self, uri: &str, version: i32, text: &str, now: f64) -> Result<(), String> {
        let uri: Uri = uri.parse().map_err(|_| format!("{uri} is no address"))?;
        self.analyze(uri, version, text.into(), now);
        Ok(())
    }

    /// Puts a file beside an open text, by its path from the text's folder; without bytes there is no such file. What the text
    /// links to is read again by `renew`.
    pub fn put(&mut self, uri: &str, path: &str, bytes: Option<Vec<u8>>) {
        if let Some(open) = self.texts.get_mut(uri) {
            let files = std::mem::take(&mut open.files);
            open.files = match bytes {
                Some(bytes) => files.with(path, bytes),
                None => files.without(path),
            };
        }
    }

    /// Analyses an open text again, because files that it links to have changed.
    pub fn renew(&mut self, uri: &str, now: f64) {
        if let Some(open) = self.texts.get(uri) {
            let document = open.analyzed.document.clone();
            let text = document.text().clone();
            self.analyze(document.uri.clone(), document.version, text, now);
        }
    }

    /// Closes a text.
    pub fn close(&mut self, uri: &str) {
        self.texts.remove(uri);
        self.hub.remove(uri);
    }

    /// The paths of the files that a text may link to, from its folder, whether they are there or not.
    pub fn links(&self, uri: &str) -> Vec<String> {
        let open = self.texts.get(uri);
        let links = open.map(|open| &open.analyzed.analysis.compiled().dependencies);
        let links = links.into_iter().flatten();
        let paths = links.flat_map(|link| spellings(link));
        paths.filter_map(|path| inside(&path).ok()).collect()
    }

    /// The diagnostics of a text, as JSON.
    pub fn diagnostics(&self, uri: &str) -> String {
        let open = self.texts.get(uri);
        let found = open.map(|open| convert::diagnostics(&open.analyzed, None));
        json!(found.unwrap_or_default()).to_string()
    }

    /// Answers a request. Parameters and answer are JSON: `{"result": …}` or `{"error": {"code": …, "message": …}}`.
    pub fn request(&mut self, method: &str, params: &str, now: f64) -> String {
        let params = serde_json::from_str(params)
            .map_err(|error| Failure::new(INVALID_PARAMS, error.to_string()));
        let answer = params.and_then(|params| self.answer(method, params, now));
        let answer = match answer {
            Ok(result) => json!({ "result": result }),
            Err(Failure { code, message }) => {
                json!({ "error": { "code": code, "message": message } })
            }
        };
        answer.to_string()
    }

    /// The messages for the page that shows a text since the last call, as JSON.
    pub fn news(&mut self, uri: &str) -> Vec<Arc<str>> {
        let preview = self.texts.get_mut(uri).map(|open| &mut open.preview);
        let Some(Some(preview)) = preview.filter(|_| self.hub.shows(uri)) else {
            return vec![];
        };
        let is_first = preview.told == 0;
        let (mut messages, told) = self.hub.updates(preview.told, Some(uri), Builds::Whole);
        preview.told = told;
        if is_first {
            messages.insert(0, editing_in_client());
        }
        messages
    }

    /// The bytes behind an address in a message.
    pub fn bytes(&self, address: &str) -> Option<Arc<[u8]>> {
        self.hub.bytes(address)
    }

    /// A model of what a change would make of a text, as binary glTF; `None` if the change would be refused. Parameters are JSON.
    pub fn attempt(&self, params: &str) -> Option<Vec<u8>> {
        let params: Value = serde_json::from_str(params).ok()?;
        let open = self.open(&params).ok()?;
        let change: Change = read(&params["change"]).ok()?;
        changes::attempt(&open.analyzed, &change, &open.files)
    }

    fn analyze(&mut self, uri: Uri, version: i32, text: Arc<str>, now: f64) {
        self.generation += 1;
        let key = uri.to_string();
        let old = self.texts.remove(&key);
        let (mut compiler, files, last, preview) = match old {
            Some(old) => (old.compiler, old.files, Some(old.analyzed), old.preview),
            None => (Compiler::default(), MemoryResolver::default(), None, None),
        };
        let compiled = compiler.compile(&text, &Options::default(), &files);
        let document = Arc::new(Document {
            uri,
            version,
            generation: self.generation,
            positions: Positions::new(text.clone(), Encoding::Utf16),
            path: None,
        });
        let open = Open {
            compiler,
            files,
            analyzed: Analyzed::new(document, Analysis::new(text, compiled), last),
            preview,
        };
        self.texts.insert(key.clone(), open);
        self.show(&key, now);
    }

    /// Builds a text for the page that shows it, if there is one.
    fn show(&mut self, uri: &str, now: f64) {
        let Some(open) = self.texts.get_mut(uri) else {
            return;
        };
        let Some(preview) = &mut open.preview else {
            return;
        };
        let now = SystemTime::UNIX_EPOCH + Duration::from_secs_f64(now.max(0.0) / 1e3);
        let document = &open.analyzed.document;
        let (_, name) = folder_and_name(document.uri.path().as_str());
        let name = percent_encoding::percent_decode_str(name).decode_utf8_lossy();
        let showing = Showing {
            hub: &self.hub,
            document,
            name: &name,
            compiled: open.analyzed.analysis.compiled(),
            clock: &|| now,
            is_open: &|| true,
        };
        showing.publish(&mut preview.surfaces);
    }

    /// The text that parameters are about.
    fn open(&self, params: &Value) -> Result<&Open, Failure> {
        let uri = params["textDocument"]["uri"].as_str().unwrap_or_default();
        let open = self.texts.get(uri);
        open.ok_or_else(|| Failure::new(INVALID_PARAMS, "this drawing is not open"))
    }

    fn answer(&mut self, method: &str, params: Value, now: f64) -> Answer {
        match method {
            "initialize" => {
                let params: InitializeParams = read(&params)?;
                self.can = params.capabilities;
                return written(initialize_result(Encoding::Utf16, false, false));
            }
            "completionItem/resolve" => {
                let mut item: CompletionItem = read(&params)?;
                item.documentation = convert::page(&item);
                return written(item);
            }
            "okoshi/preview/open" => {
                let uri = self.open(&params)?.analyzed.document.uri.to_string();
                if let Some(open) = self.texts.get_mut(&uri) {
                    open.preview = Some(Preview::default());
                }
                // Events of a text that was shown before are sent again.
                self.hub.remove(&uri);
                self.show(&uri, now);
                return Ok(Value::Null);
            }
            "okoshi/preview/close" => {
                let uri = self.open(&params)?.analyzed.document.uri.to_string();
                if let Some(open) = self.texts.get_mut(&uri) {
                    open.preview = None;
                }
                self.hub.remove(&uri);
                return Ok(Value::Null);
            }
            _ => {}
        }
        let open = self.open(&params)?;
        open.answer(method, &params, &self.can, &self.hub)
    }
}

impl Open {
    fn answer(&self, method: &str, params: &Value, can: &ClientCapabilities, hub: &Hub) -> Answer {
        let analyzed = &self.analyzed;
        let document = &analyzed.document;
        let can_text = can.text_document.as_ref();
        match method {
            "textDocument/hover" => self.at(params, queries::hover),
            "textDocument/completion" => {
                let item =
                    can_text.and_then(|can| can.completion.as_ref()?.completion_item.as_ref());
                let snippets = item.and_then(|can| can.snippet_support) == Some(true);
                let files = || self.files.paths().map(str::to_owned).collect();
                let known = analyzed.known();
                let at = position(params)?;
                written(queries::completion(document, known, at, snippets, &files))
            }
            "textDocument/signatureHelp" => {
                let offset = document.positions.offset(position(params)?);
                let help = ide::signature(document.text(), &analyzed.known().analysis, offset);
                written(help.map(convert::signatures))
            }
            "textDocument/definition" => {
                let can = can_text.and_then(|can| can.definition.as_ref());
                let links = can.and_then(|can| can.link_support) == Some(true);
                let file = |path: &str| self.file(path);
                self.at(params, |view, map, offset| {
                    queries::definition(view, map, offset, links, &file)
                })
            }
            "textDocument/references" => {
                let with_definition = params["context"]["includeDeclaration"] == true;
                self.at(params, |view, map, offset| {
                    queries::references(view, map, offset, with_definition)
                })
            }
            "textDocument/documentHighlight" => self.at(params, queries::highlights),
            "textDocument/documentSymbol" => {
                let can = can_text.and_then(|can| can.document_symbol.as_ref());
                let nested = can.and_then(|can| can.hierarchical_document_symbol_support);
                self.view(|view| queries::symbols(view, nested == Some(true)))
            }
            "textDocument/foldingRange" => self.view(queries::folds),
            "textDocument/selectionRange" => {
                let SelectionRangeParams { positions, .. } = read(params)?;
                self.view(|view| queries::selections(view, &positions))
            }
            "textDocument/semanticTokens/full" => {
                self.view(|view| queries::semantic_tokens(view, None))
            }
            "textDocument/semanticTokens/range" => {
                let range = read(&params["range"])?;
                self.view(|view| queries::semantic_tokens(view, Some(range)))
            }
            "textDocument/inlayHint" => {
                let range = read(&params["range"])?;
                self.view(|view| queries::inlays(view, range))
            }
            "textDocument/documentColor" => {
                let view = View::of(analyzed.clone());
                written(view.as_ref().map(queries::colors).unwrap_or_default())
            }
            "textDocument/colorPresentation" => {
                let params: ColorPresentationParams = read(params)?;
                let view = self.current_view();
                let found =
                    view.map(|view| edits::color_presentations(&view, params.range, params.color));
                written(found.unwrap_or_default())
            }
            "textDocument/codeLens" => written(
                View::of(analyzed.clone())
                    .as_ref()
                    .and_then(queries::preview_lens),
            ),
            "textDocument/codeAction" => {
                let params: CodeActionParams = read(params)?;
                let edit = |edits| edits::workspace_edit(document, edits, can);
                written(edits::actions(analyzed, &params, None, &edit))
            }
            "textDocument/prepareRename" => {
                let found = edits::prepare_rename(analyzed, position(params)?);
                written(found.map_err(|refused| Failure::new(REFUSED, refused))?)
            }
            "textDocument/rename" => {
                let new_name: String = read(&params["newName"])?;
                let found = edits::rename(analyzed, position(params)?, &new_name);
                let found = found.map_err(|refused| Failure::new(REFUSED, refused))?;
                written(edits::workspace_edit(document, found, can))
            }
            "textDocument/formatting" => self.formatted(None),
            "textDocument/rangeFormatting" => self.formatted(Some(read(&params["range"])?)),
            "okoshi/preview/place" => {
                let part: String = read(&params["part"])?;
                let place = View::of(analyzed.clone()).and_then(|view| {
                    let range = view.map().range(view.analysis().place_of(&part)?)?;
                    Some(Location::new(document.uri.clone(), range))
                });
                written(place)
            }
            "okoshi/preview/form" => {
                let part: String = read(&params["part"])?;
                let motions = self.files.paths().filter(|path| is_motion(path));
                let motions = motions.map(str::to_owned).collect();
                Ok(changes::form(analyzed, &part, motions))
            }
            "okoshi/preview/change" => {
                let change: Change = read(&params["change"])?;
                Ok(changes::change(analyzed, &change, &self.files))
            }
            "okoshi/preview/cursor" => {
                let position: Option<Position> = read(&params["position"])?;
                if let Some(view) = View::of(analyzed.clone()) {
                    let offset = position.and_then(|position| view.map().offset(position));
                    let part = offset.and_then(|offset| view.analysis().part_at(offset));
                    hub.light(document.uri.as_str(), part);
                }
                Ok(Value::Null)
            }
            _ => Err(Failure::new(
                METHOD_NOT_FOUND,
                format_args!("there is no method {method}"),
            )),
        }
    }

    fn view<T: Serialize>(&self, answer: impl FnOnce(&View) -> T) -> Answer {
        written(View::of(self.analyzed.clone()).as_ref().map(answer))
    }

    fn current_view(&self) -> Option<View> {
        View::of(self.analyzed.clone()).filter(View::is_current)
    }

    /// Answers a request about a position.
    fn at<T: Serialize>(
        &self,
        params: &Value,
        answer: impl FnOnce(&View, &PositionMap<'_>, usize) -> Option<T>,
    ) -> Answer {
        let position = position(params)?;
        let found = View::of(self.analyzed.clone()).and_then(|view| {
            let map = view.map();
            let offset = map.offset(position)?;
            answer(&view, &map, offset)
        });
        written(found)
    }

    fn formatted(&self, range: Option<Range>) -> Answer {
        let view = self.current_view();
        written(view.and_then(|view| edits::formatted(&view, range, &self.files)))
    }

    /// The address of a file beside the text.
    fn file(&self, path: &str) -> Option<Uri> {
        let path = spellings(path).find_map(|path| {
            let path = inside(&path).ok()?;
            self.files.file(&path).is_ok().then_some(path)
        })?;
        let parts = path.split('/');
        let parts = parts.map(|part| utf8_percent_encode(part, ENCODED).to_string());
        let (folder, _) = folder_and_name(self.analyzed.document.uri.as_str());
        let address = format!("{folder}{}", parts.collect::<Vec<_>>().join("/"));
        address.parse().ok()
    }
}

fn is_motion(path: &str) -> bool {
    let split = path.len().checked_sub(MOTION.len());
    let ending = split.and_then(|at| path.get(at..));
    ending.is_some_and(|ending| ending.eq_ignore_ascii_case(MOTION))
}

fn position(params: &Value) -> Result<Position, Failure> {
    read(&params["position"])
}

fn read<T: DeserializeOwned>(params: &Value) -> Result<T, Failure> {
    T::deserialize(params).map_err(|error| Failure::new(INVALID_PARAMS, error))
}

fn written(answer: impl Serialize) -> Answer {
    serde_json::to_value(answer).map_err(|error| Failure::new(INVALID_PARAMS, error))
}

#[cfg(test)]
mod tests;
