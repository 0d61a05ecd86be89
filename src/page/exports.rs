//! Files that are made of a drawing when a page asks for them: what is too seldom wanted to be made with every build.

use super::hub::Hub;
use crate::compile::{self, compile};
use crate::export::{self, OBJ};
use crate::puppet;
use crate::resolver::Resolver;

/// How a drawing is read again: called with its id.
pub(crate) type Reads = dyn Fn(&str) -> (compile::Options, Box<dyn Resolver>) + Send + Sync;

/// A file that can be made.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Export {
    /// The model as OBJ.
    Obj,
    /// The sheet of a puppet, as SVG.
    Puppet,
}

impl Export {
    /// By the ending of an address.
    pub(crate) fn by_ending(ending: &str) -> Option<Self> {
        match ending {
            "obj" => Some(Self::Obj),
            "svg" => Some(Self::Puppet),
            _ => None,
        }
    }
}

impl Hub {
    /// A file of the drawing that has the model of this number; `None` if there is no such model, or newer ones replaced it.
    ///
    /// # Errors
    /// A sentence without a full stop, if the drawing cannot be exported so.
    pub(crate) fn exported(&self, number: u64, export: Export) -> Option<Result<Vec<u8>, String>> {
        let reads = self.exporting.as_ref()?;
        let (id, name, text) = self.drawing_of(number)?;
        let (options, resolver) = reads(&id);
        let compiled = compile(&text, &options, &*resolver);
        Some(match export {
            Export::Obj if compiled.scene.nodes.is_empty() => {
                Err("the drawing has errors: correct them first".to_owned())
            }
            Export::Obj => export::to_memory(&OBJ, &compiled.scene, None)
                .map(|model| model.bytes)
                .map_err(|error| error.to_string()),
            Export::Puppet if compiled.has_errors() => {
                Err("the drawing has errors: correct them first".to_owned())
            }
            Export::Puppet => {
                let title = name.rsplit_once('.').map_or(&*name, |(stem, _)| stem);
                let options = puppet::Options {
                    page: puppet::A4,
                    scale: None,
                };
                puppet::sheet(&compiled, &text, title, &*resolver, &options)
                    .map(|sheet| sheet.svg.into_bytes())
                    .map_err(|why| format!("the drawing {why}"))
            }
        })
    }
}
