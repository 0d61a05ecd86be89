//! Compiles a drawing to a model: a pure function of the source and of the files that the resolver reads.

mod incremental;

use std::io;
use std::sync::Arc;

use typed_index_collections::TiVec;

use crate::assemble::{self, Assembled};
use crate::billboard::Character;
use crate::bind::{self, Bindings, PartId};
use crate::crash::{self, Crash};
use crate::diagnostic::{self, Code, Diagnostic, Severity};
use crate::figure::{Behind, FormInFigure, NodeDepth};
use crate::memo::Memo;
use crate::resolver::{Dependency, LinkList, Recorder, Resolver};
use crate::rig;
use crate::scene::Scene;
use crate::source::Span;
use crate::svg::{self, Drawing};
use crate::terrain::{self, LandscapeId};
use crate::threads;

pub use incremental::Compiler;

/// How far a flattened curve may deviate, as a share of its part's larger extent.
pub const TOLERANCE: f64 = 0.001;

/// Options of a compile.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Options {
    /// See [`TOLERANCE`].
    pub tolerance: f64,
}

impl Options {
    /// These options with another tolerance, a share of each part's larger extent, above 0.
    #[must_use]
    pub fn with_tolerance(self, tolerance: f64) -> Self {
        Self { tolerance }
    }
}

impl Default for Options {
    fn default() -> Self {
        Self {
            tolerance: TOLERANCE,
        }
    }
}

/// A compiled drawing. Errors are in the diagnostics; whatever they do not affect is built.
#[derive(Debug, Default)]
#[non_exhaustive]
pub struct Compiled {
    /// The model.
    pub scene: Scene,
    /// Which strings are bound to which parts.
    #[doc(hidden)]
    pub bindings: Bindings,
    /// The tile maps.
    #[doc(hidden)]
    pub layers: TiVec<LandscapeId, terrain::Layer>,
    /// The characters that turn.
    #[doc(hidden)]
    pub characters: Vec<Character>,
    /// The clips that figures play.
    #[doc(hidden)]
    pub clips: Vec<rig::FigureClip>,
    /// Per part that has a node, how far in front of the drawing plane it lies.
    #[doc(hidden)]
    pub depths: TiVec<PartId, Option<NodeDepth>>,
    /// What parts show from behind beside their own backs.
    #[doc(hidden)]
    pub behind: Vec<(PartId, Behind)>,
    /// What figures do to the forms of parts.
    pub(crate) forms: Vec<(PartId, FormInFigure)>,
    /// Where figures look.
    pub(crate) facings: Vec<rig::FigureFacing>,
    /// Per prop of the bindings where it stands; empty without landscapes.
    pub(crate) props: Vec<assemble::StandingProp>,
    /// The drawing. Its outlines and texts are shared with the bindings.
    #[doc(hidden)]
    pub drawing: Arc<Drawing>,
    /// The diagnostics, in the order of the text.
    pub diagnostics: Vec<Diagnostic>,
    /// The links that were read, or could not be, in alphabetical order.
    pub dependencies: Vec<String>,
}

impl Compiled {
    /// The result for a drawing whose bytes are not text.
    pub fn undecoded(why: &str) -> Self {
        let help = "in Inkscape, File → Save As writes UTF-8; in an editor, choose the encoding when saving";
        Self {
            diagnostics: vec![Diagnostic::new(Code::NotUtf8, Span::at(0), why).help(help)],
            ..Self::default()
        }
    }

    /// The result for a drawing that could not be compiled because of a panic.
    pub fn crashed(crash: &Crash) -> Self {
        Self::failed(crash.to_string())
    }

    /// The result for a drawing that was compiled to a scene that cannot be written.
    pub fn unwritten(error: &io::Error) -> Self {
        Self::failed(format!("the model cannot be written: {error}"))
    }

    fn failed(message: String) -> Self {
        let diagnostic = Diagnostic::new(Code::Crash, Span::at(0), message);
        Self {
            diagnostics: vec![diagnostic.help(crash::HELP)],
            ..Self::default()
        }
    }

    /// Whether compiling ended in a panic (see [`Compiled::crashed`]).
    pub fn has_crashed(&self) -> bool {
        self.diagnostics
            .iter()
            .any(|diagnostic| diagnostic.code == Code::Crash)
    }

    /// The nodes of the model with its clips before they were performed and limited; `None` if no clip is either.
    pub fn originals(&self) -> Option<Scene> {
        rig::originals(&self.scene, &self.clips)
    }

    /// Whether there are errors: then no model is written.
    pub fn has_errors(&self) -> bool {
        self.diagnostics
            .iter()
            .any(|diagnostic| diagnostic.severity() == Severity::Error)
    }
}

/// Compiles a drawing. Never fails and never panics: a panic becomes a diagnostic. Takes about as long as parsing the SVG
/// does.
pub fn compile(source: &str, options: &Options, resolver: &dyn Resolver) -> Compiled {
    threads::run(|| {
        let reading = Reading::read(source, options, resolver);
        reading.build(resolver, &Memo::none())
    })
    .unwrap_or_else(|crash| Compiled::crashed(&crash))
}

/// A comment that makes compiling panic, for tests.
#[cfg(test)]
pub(crate) const PLANTED_CRASH: &str = "<!-- planted crash -->";

/// A drawing that was read, before its strings are.
#[derive(Debug, Clone)]
struct Reading {
    drawing: Arc<Drawing>,
    /// The diagnostics about the drawing, not about its strings.
    diagnostics: Vec<Diagnostic>,
    /// The links that were read on the way.
    dependencies: Vec<Dependency>,
}

impl Reading {
    fn read(source: &str, options: &Options, resolver: &dyn Resolver) -> Self {
        #[cfg(test)]
        assert!(!source.contains(PLANTED_CRASH), "planted");
        let recorder = Recorder::new(resolver);
        let (drawing, diagnostics) = svg::read(
            source,
            options.tolerance,
            &recorder,
            &bind::in_layers_of_pixels,
            &bind::makes_pose_layer,
        );
        Self {
            drawing: Arc::new(drawing),
            diagnostics,
            dependencies: recorder.into_dependencies(),
        }
    }

    /// Reads the strings and builds the model.
    fn build(self, resolver: &dyn Resolver, memo: &Memo) -> Compiled {
        let Self {
            drawing,
            mut diagnostics,
            dependencies,
        } = self;
        // Only their names are asked for: a motion file's text need not stay in memory beside its clip.
        let links = LinkList::new(resolver);
        let bindings = bind::bind(&drawing, memo, &mut diagnostics);
        let Assembled {
            scene,
            layers,
            characters,
            clips,
            depths,
            behind,
            forms,
            facings,
            props,
        } = assemble::assemble(&drawing, &bindings, &links, memo, &mut diagnostics);
        bind::locate(&drawing, &mut diagnostics);
        diagnostic::sort(&mut diagnostics);
        let mut links = links.into_links();
        links.extend(dependencies.into_iter().map(|read| read.link));
        Compiled {
            scene,
            bindings,
            layers,
            characters,
            clips,
            depths,
            behind,
            forms,
            facings,
            props,
            drawing,
            diagnostics,
            dependencies: links.into_iter().collect(),
        }
    }
}
