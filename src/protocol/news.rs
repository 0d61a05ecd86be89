//! What the page of a client is told of a text.

use std::time::SystemTime;

use super::document::Document;
use crate::compile::Compiled;
use crate::export::{self, GLB};
use crate::memo::Memo;
use crate::page::{Hub, Shown, Times};

/// A text that is being shown.
pub(crate) struct Showing<'a> {
    pub(crate) hub: &'a Hub,
    pub(crate) document: &'a Document,
    /// What it is called.
    pub(crate) name: &'a str,
    pub(crate) compiled: &'a Compiled,
    pub(crate) clock: &'a dyn Fn() -> SystemTime,
    /// Whether it is still to be shown once it is built.
    pub(crate) is_open: &'a dyn Fn() -> bool,
}

impl Showing<'_> {
    /// Builds the model, unless the last good one stays, and hands it to the hub.
    pub(crate) fn publish(&self, memory: &mut Memo) {
        let Self {
            hub,
            document,
            compiled,
            ..
        } = *self;
        let uri = document.uri.as_str();
        let begun = (self.clock)();
        // At first the page shows what can be built of a drawing with errors. Later on, most errors are half typed words, and
        // the last good model stays.
        let empty = compiled.scene.nodes.is_empty();
        let keep = compiled.has_errors() && (empty || hub.was_good(uri));
        let model = if keep {
            None
        } else {
            match export::to_memory(&GLB, &compiled.scene, Some(memory)) {
                Ok(model) => Some((model.bytes.into(), model.written)),
                Err(_) if compiled.has_errors() => None,
                Err(error) => {
                    let compiled = &Compiled::unwritten(&error);
                    return Showing { compiled, ..*self }.publish(memory);
                }
            }
        };
        let shown = Shown {
            text: document.text(),
            compiled,
            model: model.as_ref().map(|(bytes, written)| (bytes, *written)),
            times: Times {
                noticed: begun,
                started: begun,
                finished: (self.clock)(),
                pushed: (self.clock)(),
            },
        };
        if (self.is_open)() {
            hub.publish(uri, ["", self.name], &shown);
        }
    }
}
