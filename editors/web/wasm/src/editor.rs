//! The language server, callable from JavaScript.

use okoshi::internals::protocol::Server as LanguageServer;
use wasm_bindgen::prelude::wasm_bindgen;

/// The language server, for an editor that has the texts. `now` is always `Date.now()`.
#[wasm_bindgen]
#[derive(Debug, Default)]
pub struct Server(LanguageServer);

#[wasm_bindgen]
impl Server {
    /// A server without texts.
    #[wasm_bindgen(constructor)]
    pub fn new() -> Self {
        Self::default()
    }

    /// Opens a text, or replaces it. Throws a sentence if its address is none.
    pub fn write(&mut self, uri: &str, version: i32, text: &str, now: f64) -> Result<(), String> {
        self.0.write(uri, version, text, now)
    }

    /// Puts a file beside an open text, by its path from the text's folder; without bytes there is no such file. `renew` then analyses the
    /// text again.
    pub fn put(&mut self, uri: &str, path: &str, bytes: Option<Vec<u8>>) {
        self.0.put(uri, path, bytes);
    }

    /// Analyses a text again whose files have changed.
    pub fn renew(&mut self, uri: &str, now: f64) {
        self.0.renew(uri, now);
    }

    /// Closes a text.
    pub fn close(&mut self, uri: &str) {
        self.0.close(uri);
    }

    /// The paths of the files that a text may link to, from its folder, whether they are there or not.
    pub fn links(&self, uri: &str) -> Vec<String> {
        self.0.links(uri)
    }

    /// The diagnostics of a text, as JSON.
    pub fn diagnostics(&self, uri: &str) -> String {
        self.0.diagnostics(uri)
    }

    /// Answers a request of the protocol. Parameters and answer are JSON: `{"result": …}` or `{"error": {"code": …, "message": …}}`.
    pub fn request(&mut self, method: &str, params: &str, now: f64) -> String {
        self.0.request(method, params, now)
    }

    /// The messages for the page that shows a text since the last call, as JSON.
    pub fn news(&mut self, uri: &str) -> Vec<String> {
        let messages = self.0.news(uri);
        messages.iter().map(ToString::to_string).collect()
    }

    /// The bytes behind an address in a message.
    pub fn bytes(&self, address: &str) -> Option<Vec<u8>> {
        self.0.bytes(address).map(|bytes| bytes.to_vec())
    }

    /// A model of what a change would make of a text, as binary glTF; nothing if the change would be refused. Parameters are JSON.
    pub fn attempt(&self, params: &str) -> Option<Vec<u8>> {
        self.0.attempt(params)
    }
}
