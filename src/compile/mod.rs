//! From a drawing to a model: a pure function of the source and what the resolver gives it.

mod again;

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex};

use crate::assemble::{self, Assembled};
use crate::bind::{self, Bindings};
use crate::diagnostic::{self, Code, Diagnostic, Severity};
use crate::resolver::{LinkError, Resolver};
use crate::rig;
use crate::scene::Scene;
use crate::source::Span;
use crate::svg::{self, Drawing};
use crate::terrain;
use crate::threads;

pub use again::Compiler;

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
    pub bindings: Bindings,
    /// The tile maps.
    pub layers: Vec<terrain::Layer>,
    /// The clips that figures play.
    pub clips: Vec<rig::FigureClip>,
    /// The drawing. Its outlines and texts are shared with the bindings.
    pub drawing: Arc<Drawing>,
    /// What is wrong, in the order of the text.
    pub diagnostics: Vec<Diagnostic>,
    /// The links that were followed, or tried, in alphabetical order.
    pub dependencies: Vec<String>,
}

impl Compiled {
    /// What is said of a drawing whose bytes are no text.
    pub fn undecoded(why: &str) -> Self {
        let help = "in Inkscape, File → Save As writes UTF-8; in an editor, choose the encoding when saving";
        Self {
            diagnostics: vec![Diagnostic::new(Code::NotUtf8, Span::at(0), why).help(help)],
            ..Self::default()
        }
    }

    /// The nodes of the model with the clips of limited animation as they were before they were cut; `None` if none was.
    pub fn originals(&self) -> Option<Scene> {
        rig::originals(&self.scene, &self.clips)
    }

    /// Whether there are errors, which keep the model from being written.
    pub fn has_errors(&self) -> bool {
        self.diagnostics
            .iter()
            .any(|diagnostic| diagnostic.severity() == Severity::Error)
    }
}

/// Compiles a drawing. Never fails and never panics; takes about as long as parsing the SVG does.
pub fn compile(source: &str, options: &Options, resolver: &dyn Resolver) -> Compiled {
    threads::run(|| {
        let (reading, _) = Reading::of(source, options, resolver);
        reading.compiled(resolver, None)
    })
    .unwrap_or_else(given_up)
}

/// What is said where compiling panicked.
fn given_up() -> Compiled {
    let message = "the drawing cannot be compiled: okoshi gave up on it";
    let help = "open it in Inkscape, save it as Plain SVG, and tell us: this should not happen";
    let diagnostic = Diagnostic::new(Code::LimitPassed, Span::at(0), message).help(help);
    Compiled {
        diagnostics: vec![diagnostic],
        ..Compiled::default()
    }
}

/// A drawing that was read, and what there is to say of it and not of its strings.
#[derive(Debug)]
struct Reading {
    drawing: Arc<Drawing>,
    diagnostics: Vec<Diagnostic>,
    /// The links that reading it followed.
    links: Vec<String>,
}

/// What making models remembers from one time to the next.
#[derive(Debug, Default)]
struct Memory {
    areas: bind::Memory,
    things: assemble::Memory,
}

/// A link that was followed, and where it led.
type Followed = (String, Found);

/// The bytes of a file, or why there are none.
type Found = Result<Arc<[u8]>, LinkError>;

impl Reading {
    /// Reads a drawing, and tells what its links led to.
    fn of(source: &str, options: &Options, resolver: &dyn Resolver) -> (Self, Vec<Followed>) {
        let recorder = Recorder::new(resolver);
        let (drawing, diagnostics) =
            svg::read(source, options.tolerance, &recorder, &bind::in_tile_layers);
        let followed = recorder.followed();
        let reading = Self {
            drawing: Arc::new(drawing),
            diagnostics,
            links: followed.iter().map(|(link, _)| link.clone()).collect(),
        };
        (reading, followed)
    }

    /// Builds what was read.
    fn compiled(self, resolver: &dyn Resolver, memory: Option<&mut Memory>) -> Compiled {
        let Self {
            drawing,
            mut diagnostics,
            links: mut dependencies,
        } = self;
        let recorder = Recorder::new(resolver);
        let mut nothing = assemble::Memory::default();
        let (areas, things) = match memory {
            Some(Memory { areas, things }) => (Some(areas), things),
            None => (None, &mut nothing),
        };
        let bindings = bind::bind(&drawing, areas, &mut diagnostics);
        let Assembled {
            scene,
            layers,
            clips,
        } = assemble::assemble(&drawing, &bindings, &recorder, things, &mut diagnostics);
        diagnostic::sort(&mut diagnostics);
        dependencies.extend(recorder.followed().into_iter().map(|(link, _)| link));
        dependencies.sort();
        dependencies.dedup();
        Compiled {
            scene,
            bindings,
            layers,
            clips,
            drawing,
            diagnostics,
            dependencies,
        }
    }
}

/// A resolver that remembers what it was asked for.
struct Recorder<'a> {
    inner: &'a dyn Resolver,
    followed: Mutex<BTreeMap<String, Found>>,
}

impl<'a> Recorder<'a> {
    fn new(inner: &'a dyn Resolver) -> Self {
        Self {
            inner,
            followed: Mutex::default(),
        }
    }

    /// The links that were followed, each with where it led first.
    fn followed(self) -> Vec<Followed> {
        let followed = self.followed.into_inner().unwrap_or_default();
        followed.into_iter().collect()
    }
}

impl Resolver for Recorder<'_> {
    fn read(&self, link: &str) -> Result<Arc<[u8]>, LinkError> {
        let found = self.inner.read(link);
        if let Ok(mut followed) = self.followed.lock() {
            let known = followed.entry(link.to_owned());
            known.or_insert_with(|| found.clone());
        }
        found
    }
}
