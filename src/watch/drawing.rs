//! One drawing that is built repeatedly.

use std::collections::BTreeMap;
use std::hash::{DefaultHasher, Hasher};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex};
use std::time::SystemTime;

use super::{Build, BuildTimes, NoModel, Options};
use crate::compile::{self, Compiled, Compiler};
use crate::disk::{FolderResolver, ReadError, decode, read_drawing};
use crate::export::{self, GLB, SurfaceCache};
use crate::resolver::{LinkError, Resolver};

/// A drawing with the caches that make its next build incremental.
#[derive(Debug)]
pub struct Drawing {
    path: PathBuf,
    options: compile::Options,
    resolver: FolderResolver,
    compiler: Compiler,
    surfaces: SurfaceCache,
    last: Option<Inputs>,
}

/// Hashes of the files that a build was made from.
#[derive(Debug)]
struct Inputs {
    drawing: u64,
    /// By link; `None` for a file that is missing.
    linked: BTreeMap<String, Option<u64>>,
}

/// The outcome of building a drawing.
#[derive(Debug)]
pub enum Outcome {
    /// All files are equal to those of the last build.
    Unchanged,
    /// The drawing looks half written.
    Incomplete,
    /// The drawing was built.
    Built(Box<Build>),
}

impl Drawing {
    /// A drawing that has not been built yet.
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

    /// The files that it links to, including missing ones.
    pub(super) fn linked(&self) -> impl Iterator<Item = PathBuf> {
        let links = self.last.iter().flat_map(|last| last.linked.keys());
        links.filter_map(|link| self.resolver.place(link).ok())
    }

    /// Builds it, unless nothing has changed. A text without any elements counts as half written, unless `is_final`.
    ///
    /// # Errors
    /// If its file cannot be read.
    pub fn build(&mut self, noticed: SystemTime, is_final: bool) -> Result<Outcome, ReadError> {
        let started = SystemTime::now();
        let bytes = read_drawing(&self.path)?;
        let drawing = hash(&bytes);
        if self.is_unchanged(drawing) {
            return Ok(Outcome::Unchanged);
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
            return Ok(Outcome::Incomplete);
        }
        let linked = recorder.found.into_inner().unwrap_or_default();
        let model = match compiled.has_errors() {
            true => Err(NoModel::Errors),
            false => self.model(&compiled),
        };
        self.last = Some(Inputs { drawing, linked });
        let times = BuildTimes {
            noticed,
            started,
            finished: SystemTime::now(),
        };
        Ok(Outcome::Built(Box::new(Build {
            text,
            compiled,
            model,
            times,
        })))
    }

    /// Whether the drawing and all linked files are equal to those of the last build.
    fn is_unchanged(&self, drawing: u64) -> bool {
        let Some(last) = &self.last else { return false };
        let now = |link: &str| self.resolver.read(link).ok().map(|bytes| hash(&bytes));
        last.drawing == drawing && last.linked.iter().all(|(link, was)| now(link) == *was)
    }

    fn model(&mut self, compiled: &Compiled) -> Result<export::Model, NoModel> {
        let model = export::to_memory(&GLB, &compiled.scene, Some(&mut self.surfaces));
        model.map_err(|error| NoModel::Unwritten(error.to_string()))
    }
}

/// A hash of a file's content.
fn hash(bytes: &[u8]) -> u64 {
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
            let content = found.as_ref().ok().map(|bytes| hash(bytes));
            known.entry(link.to_owned()).or_insert(content);
        }
        found
    }
}
