//! One drawing, built again and again.

use std::collections::BTreeMap;
use std::hash::{DefaultHasher, Hasher};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex};
use std::time::SystemTime;

use super::{Build, NoModel, Options, Steps};
use crate::compile::{self, Compiled, Compiler};
use crate::disk::{FolderResolver, ReadError, decode, read_drawing};
use crate::export::{self, GLB, SurfaceCache};
use crate::resolver::{LinkError, Resolver};

/// A drawing and what is remembered of it, so that the next build takes no longer than it must.
#[derive(Debug)]
pub struct Drawing {
    path: PathBuf,
    options: compile::Options,
    resolver: FolderResolver,
    compiler: Compiler,
    surfaces: SurfaceCache,
    last: Option<Last>,
}

/// What a build was made from: numbers that stand for contents.
#[derive(Debug)]
struct Last {
    drawing: u64,
    /// By link.
    linked: BTreeMap<String, Option<u64>>,
}

/// What came of building a drawing again.
#[derive(Debug)]
pub enum Again {
    /// Nothing is another than before.
    Same,
    /// It looks half written.
    Unfinished,
    /// It was built.
    Built(Box<Build>),
}

impl Drawing {
    /// A drawing that is to be built.
    pub fn new(path: &Path, options: &Options) -> Self {
        let folder = path.parent().map_or_else(PathBuf::new, Path::to_path_buf);
        Self {
            path: path.to_owned(),
            options: compile::Options {
                tolerance: options.tolerance,
            },
            resolver: FolderResolver::new(options.root.clone().unwrap_or(folder)),
            compiler: Compiler::default(),
            surfaces: SurfaceCache::default(),
            last: None,
        }
    }

    /// Its file.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The files that it links to, also those that are not there yet.
    pub(super) fn linked(&self) -> impl Iterator<Item = PathBuf> {
        let links = self.last.iter().flat_map(|last| last.linked.keys());
        links.filter_map(|link| self.resolver.place(link).ok())
    }

    /// Builds it, unless nothing has changed. A text that is no drawing is taken for one that is half written, unless
    /// it `is_final`.
    ///
    /// # Errors
    /// If its file cannot be read.
    pub fn build(&mut self, noticed: SystemTime, is_final: bool) -> Result<Again, ReadError> {
        let begun = SystemTime::now();
        let bytes = read_drawing(&self.path)?;
        let drawing = number(&bytes);
        if self.is_same(drawing) {
            return Ok(Again::Same);
        }
        let recorder = Recorder {
            inner: &self.resolver,
            found: Mutex::default(),
        };
        let lossy = String::from_utf8_lossy(&bytes[..bytes.len().min(1 << 12)]).into_owned();
        let (text, compiled) = match decode(bytes) {
            Ok(text) => {
                let compiled = self.compiler.compile(&text, &self.options, &recorder);
                (text, compiled)
            }
            Err(error) => (lossy, Compiled::undecoded(&error.to_string())),
        };
        if !is_final && compiled.drawing.groups.is_empty() {
            return Ok(Again::Unfinished);
        }
        let linked = recorder.found.into_inner().unwrap_or_default();
        let model = match compiled.has_errors() {
            true => Err(NoModel::Errors),
            false => self.model(&compiled),
        };
        self.last = Some(Last { drawing, linked });
        let steps = Steps {
            noticed,
            begun,
            built: SystemTime::now(),
        };
        Ok(Again::Built(Box::new(Build {
            text,
            compiled,
            model,
            steps,
        })))
    }

    /// Whether the drawing and what it links to are what they were.
    fn is_same(&self, drawing: u64) -> bool {
        let Some(last) = &self.last else { return false };
        let now = |link: &str| self.resolver.read(link).ok().map(|bytes| number(&bytes));
        last.drawing == drawing && last.linked.iter().all(|(link, was)| now(link) == *was)
    }

    fn model(&mut self, compiled: &Compiled) -> Result<export::Model, NoModel> {
        let model = export::to_memory(&GLB, &compiled.scene, Some(&mut self.surfaces));
        model.map_err(|error| NoModel::Unwritten(error.to_string()))
    }
}

/// A number that stands for a content.
fn number(bytes: &[u8]) -> u64 {
    let mut hasher = DefaultHasher::new();
    hasher.write(bytes);
    hasher.finish()
}

/// A resolver that remembers what it gave.
struct Recorder<'a> {
    inner: &'a FolderResolver,
    found: Mutex<BTreeMap<String, Option<u64>>>,
}

impl Resolver for Recorder<'_> {
    fn read(&self, link: &str) -> Result<Arc<[u8]>, LinkError> {
        let found = self.inner.read(link);
        if let Ok(mut known) = self.found.lock() {
            let content = found.as_ref().ok().map(|bytes| number(bytes));
            known.entry(link.to_owned()).or_insert(content);
        }
        found
    }
}
