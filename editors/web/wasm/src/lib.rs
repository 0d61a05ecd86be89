//! okoshi in a page: the studio of the program, callable from JavaScript.
//!
//! A panic is a trap here: every later call of the module fails, and whoever runs it has to start it again.

use okoshi::internals::page::{
    Studio as Inner, Tried as TriedModel, film as drawn, trace as traced,
};
use wasm_bindgen::prelude::wasm_bindgen;

#[cfg(feature = "editor")]
mod editor;

/// Drawings and the files that they link to, shown on one page. `now` is always `Date.now()`.
#[wasm_bindgen]
#[derive(Debug, Default)]
pub struct Studio(Inner);

/// A model of a change that was only tried.
#[wasm_bindgen]
#[derive(Debug)]
pub struct Tried(TriedModel);

#[wasm_bindgen]
impl Tried {
    /// By which the model is known.
    #[wasm_bindgen(getter)]
    pub fn address(&self) -> String {
        self.0.address.clone()
    }

    /// What differs from the model that the page shows, or all of it, as binary glTF.
    #[wasm_bindgen(getter)]
    pub fn bytes(&self) -> Vec<u8> {
        self.0.bytes.to_vec()
    }
}

#[wasm_bindgen]
impl Studio {
    /// A studio without drawings.
    #[wasm_bindgen(constructor)]
    pub fn new() -> Self {
        Self::default()
    }

    /// Puts a file into the project, or replaces it, by its path from the project's folder. One that ends in `.svg` is a drawing, which
    /// is shown; those that link to another file are built again. Throws a sentence if a drawing is not text.
    pub fn put(&mut self, path: &str, bytes: Vec<u8>, now: f64) -> Result<(), String> {
        self.0.put(path, bytes, now)
    }

    /// Takes a file out of the project.
    pub fn remove(&mut self, path: &str, now: f64) {
        self.0.remove(path, now);
    }

    /// The text of a drawing, with the changes that were made on the page.
    pub fn text(&self, path: &str) -> Option<String> {
        self.0.text(path).map(|text| text.to_string())
    }

    /// The links of a drawing as it is shown, to files that may be there or not.
    pub fn links(&self, path: &str) -> Vec<String> {
        self.0.links(path)
    }

    /// Offers drawings to start from, as long as there are none.
    pub fn offer(&self) {
        self.0.offer();
    }

    /// Handles a message of the page, which is JSON.
    pub fn receive(&mut self, message: &str, now: f64) {
        self.0.receive(message, now);
    }

    /// The messages for the page since the last call, as JSON.
    pub fn messages(&mut self) -> Vec<String> {
        let messages = self.0.messages();
        messages.iter().map(ToString::to_string).collect()
    }

    /// The bytes behind an address in a message: a model, or a picture of one.
    pub fn bytes(&self, address: &str) -> Option<Vec<u8>> {
        self.0.bytes(address).map(|bytes| bytes.to_vec())
    }

    /// Makes a change that a page asks for, undoes or redoes one. Request and answer are JSON: `{"ok": …, "body": …}`.
    pub fn change(&mut self, request: &str, now: f64) -> String {
        self.0.change(request, now)
    }

    /// What is known of the texts of a drawing. Request and answer are JSON: `{"ok": …, "body": …}`.
    pub fn ask(&self, request: &str) -> String {
        self.0.ask(request)
    }

    /// What can be changed about a part. Request and answer are JSON: `{"ok": …, "body": …}`.
    pub fn form(&self, request: &str) -> String {
        self.0.form(request)
    }

    /// A model of what a change would make of a drawing, while it is being decided; nothing if the change would be refused.
    pub fn attempt(&self, request: &str) -> Option<Tried> {
        self.0.attempt(request).map(Tried)
    }
}

/// A moving picture of a model in binary glTF, as GIF: of a clip, by its number, or of the model that turns around once; from a direction
/// in degrees to its left and up. Throws why there is none.
#[wasm_bindgen]
pub fn film(model: &[u8], clip: Option<usize>, left: f64, up: f64) -> Result<Vec<u8>, String> {
    drawn(model, clip, [left, up])
}

/// The text of a drawing with the shapes of a picture (PNG, JPEG, GIF or WebP), which may be a photograph of a drawing on paper. Throws why
/// there is none; the words follow the picture's name.
#[wasm_bindgen]
pub fn trace(picture: &[u8]) -> Result<String, String> {
    traced(picture)
}
