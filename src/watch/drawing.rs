//! One drawing that is built repeatedly.

use std::hash::BuildHasher;
use std::path::{Path, PathBuf};
use std::time::SystemTime;

use rustc_hash::FxBuildHasher;

use super::source::Source;
use super::{Build, BuildTimes, NoModel, Options};
use crate::compile::{self, Compiled, Compiler};
use crate::disk::{FolderResolver, ReadError, decode, read_drawing};
use crate::export::{self, Exporter};
use crate::memo::Memo;
use crate::resolver::{Dependency, Recorder};

/// A drawing with the caches that make its next build incremental.
#[derive(Debug)]
pub(crate) struct Drawing {
    source: Source,
    options: compile::Options,
    resolver: FolderResolver,
    compiler: Compiler,
    /// The surfaces of the last model.
    surfaces: Memo,
    last: Option<Inputs>,
    shows_incomplete: bool,
    exporter: &'static dyn Exporter,
}

/// The files that a build was made from.
#[derive(Debug)]
struct Inputs {
    /// A hash of the drawing's file.
    drawing: u64,
    /// The linked files, whose contents the compiler keeps as well.
    linked: Vec<Dependency>,
}

/// The outcome of building a drawing.
#[derive(Debug)]
pub(crate) enum Outcome {
    /// All files are equal to those of the last build.
    Unchanged,
    /// The drawing looks half written.
    Incomplete,
    /// The drawing was built.
    Built(Box<Build>),
}

impl Drawing {
    /// A drawing that has not been built yet.
    pub(crate) fn new(path: &Path, options: &Options) -> Self {
        let (reading, resolver) = options.reading(path);
        Self {
            source: Source::new(path, options.unsaved.as_deref()),
            options: reading,
            resolver,
            compiler: Compiler::default(),
            surfaces: Memo::default(),
            last: None,
            shows_incomplete: options.shows_incomplete,
            exporter: options.exporter,
        }
    }

    /// Its file.
    pub(crate) fn path(&self) -> &Path {
        &self.source.saved
    }

    /// Its file, and the copy with unsaved changes, if there is one.
    pub(super) fn files(&self) -> impl Iterator<Item = &Path> {
        self.source.files()
    }

    /// The files that it links to, including missing ones.
    pub(super) fn linked(&self) -> impl Iterator<Item = PathBuf> {
        let linked = self.last.iter().flat_map(|last| &last.linked);
        linked.filter_map(|file| self.resolver.place(&file.link).ok())
    }

    /// Builds it, unless nothing has changed. A text without any elements counts as half written, unless `is_final`.
    ///
    /// # Errors
    /// If its file cannot be read.
    pub(crate) fn build(
        &mut self,
        noticed: SystemTime,
        is_final: bool,
    ) -> Result<Outcome, ReadError> {
        let started = SystemTime::now();
        let bytes = read_drawing(self.source.newest())?;
        let drawing = FxBuildHasher.hash_one(&bytes);
        if self.is_unchanged(drawing) {
            return Ok(Outcome::Unchanged);
        }
        let recorder = Recorder::new(&self.resolver);
        let lossy = String::from_utf8_lossy(&bytes[..bytes.len().min(1 << 12)]).into_owned();
        let (text, compiled) = match decode(bytes) {
            Ok(text) => {
                let compiled = self.compiler.compile(&text, &self.options, &recorder);
                (text, compiled)
            }
            Err(error) => (lossy, Compiled::undecoded(&error.to_string())),
        };
        if !is_final && compiled.drawing.groups.is_empty() && !compiled.has_crashed() {
            return Ok(Outcome::Incomplete);
        }
        let linked = recorder.into_dependencies();
        let model = if compiled.has_errors() {
            Err(NoModel::Errors)
        } else {
            self.model(&compiled)
        };
        let incomplete = if compiled.has_errors() && self.shows_incomplete {
            self.incomplete(&compiled)
        } else {
            None
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
            linked: self.linked().collect(),
            incomplete,
            times,
        })))
    }

    /// Whether the drawing and all linked files are equal to those of the last build.
    fn is_unchanged(&self, drawing: u64) -> bool {
        let Some(last) = &self.last else { return false };
        let mut linked = last.linked.iter();
        last.drawing == drawing && linked.all(|file| file.is_unchanged(&self.resolver))
    }

    /// What can be built of a drawing with errors, if anything can.
    fn incomplete(&mut self, compiled: &Compiled) -> Option<export::Model> {
        let something = !compiled.scene.nodes.is_empty();
        something.then(|| self.model(compiled).ok()).flatten()
    }

    fn model(&mut self, compiled: &Compiled) -> Result<export::Model, NoModel> {
        let model = export::to_memory(self.exporter, &compiled.scene, Some(&mut self.surfaces));
        model.map_err(|error| NoModel::Unwritten(error.to_string()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::compile::PLANTED_CRASH;
    use crate::diagnostic::Code;

    #[test]
    fn a_crash_is_not_an_unfinished_file() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("drawing.svg");
        let svg = "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"9\" height=\"9\"/>";
        let mut drawing = Drawing::new(&path, &Options::default());
        let mut build = |text: &str| {
            std::fs::write(&path, text).unwrap();
            drawing.build(SystemTime::now(), false).unwrap()
        };
        assert!(matches!(build("<svg"), Outcome::Incomplete));
        let Outcome::Built(crashed) = build(&format!("{svg}{PLANTED_CRASH}")) else {
            panic!("it is built");
        };
        assert_eq!(crashed.compiled.diagnostics[0].code, Code::Crash);
        assert_eq!(crashed.model.unwrap_err(), NoModel::Errors);
        let Outcome::Built(build) = build(svg) else {
            panic!("it is built");
        };
        assert!(!build.compiled.has_crashed() && build.model.is_ok());
    }
}
