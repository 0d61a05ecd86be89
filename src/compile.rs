//! From a drawing to a model: a pure function of the source and what the resolver gives it.

use std::sync::{Arc, Mutex};

use crate::bind::{self, Sheet};
use crate::diagnostic::{self, Code, Diagnostic, Severity};
use crate::figure;
use crate::resolver::{LinkError, Resolver};
use crate::scene::Scene;
use crate::source::Span;
use crate::svg::{self, Drawing};
use crate::threads;

/// How far a flattened curve may lie off, as a share of its part's larger extent (figure.md, Parts).
pub const TOLERANCE: f64 = 0.001;

/// What can be chosen.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Options {
    /// See [`TOLERANCE`].
    pub tolerance: f64,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            tolerance: TOLERANCE,
        }
    }
}

/// A compiled drawing. It is never missing: what is wrong is in the diagnostics, the rest is built.
#[derive(Debug, Default)]
pub struct Compiled {
    /// The model.
    pub scene: Scene,
    /// Who is bound to what.
    pub sheet: Sheet,
    /// The drawing. Its outlines have moved to the sheet's parts.
    pub drawing: Drawing,
    /// What is wrong, in the order of the text.
    pub diagnostics: Vec<Diagnostic>,
    /// The links that were followed, or tried, in alphabetical order.
    pub dependencies: Vec<String>,
}

impl Compiled {
    /// Whether there are errors, which keep the model from being written.
    pub fn has_errors(&self) -> bool {
        self.diagnostics
            .iter()
            .any(|diagnostic| diagnostic.severity() == Severity::Error)
    }
}

/// Compiles a drawing. Never fails and never panics; takes about as long as parsing the SVG does.
pub fn compile(source: &str, options: &Options, resolver: &dyn Resolver) -> Compiled {
    threads::run(|| compile_here(source, options, resolver)).unwrap_or_else(|| {
        let message = "the drawing cannot be compiled: okoshi gave up on it";
        let help = "open it in Inkscape, save it as Plain SVG, and tell us: this should not happen";
        let diagnostic = Diagnostic::new(Code::LimitPassed, Span::at(0), message).help(help);
        Compiled {
            diagnostics: vec![diagnostic],
            ..Compiled::default()
        }
    })
}

fn compile_here(source: &str, options: &Options, resolver: &dyn Resolver) -> Compiled {
    let recorder = Recorder {
        inner: resolver,
        links: Mutex::default(),
    };
    let (mut drawing, mut diagnostics) = svg::read(source, options.tolerance, &recorder);
    let sheet = bind::bind(&mut drawing, &mut diagnostics);
    let scene = figure::build(&drawing, &sheet, &recorder, &mut diagnostics);
    diagnostic::sort(&mut diagnostics);
    let mut dependencies = recorder.links.into_inner().unwrap_or_default();
    dependencies.sort();
    dependencies.dedup();
    Compiled {
        scene,
        sheet,
        drawing,
        diagnostics,
        dependencies,
    }
}

/// A resolver that remembers what it was asked for.
struct Recorder<'a> {
    inner: &'a dyn Resolver,
    links: Mutex<Vec<String>>,
}

impl Resolver for Recorder<'_> {
    fn read(&self, link: &str) -> Result<Arc<[u8]>, LinkError> {
        if let Ok(mut links) = self.links.lock() {
            links.push(link.to_owned());
        }
        self.inner.read(link)
    }
}
