//! okoshi turns one annotated 2D drawing into a moving 3D model.
//!
//! [`compile()`] is the whole of it: a pure function from an SVG drawing to a [`scene::Scene`], with [`Diagnostic`]s beside it.
//! [`export`] writes the scene.
//!
//! ```
//! use okoshi::export::{GLB, to_memory};
//! use okoshi::{MemoryResolver, Options, compile};
//!
//! let drawing = r##"<svg xmlns="http://www.w3.org/2000/svg" width="100" height="100">
//!   <rect x="40" y="40" width="20" height="40" fill="#c30"/>
//!   <rect x="58" y="45" width="30" height="8" fill="#fc9"/>
//!   <text x="45" y="60">Body</text>
//!   <text x="70" y="50">Arm@Body$Shape roundv</text>
//! </svg>"##;
//! let compiled = compile(drawing, &Options::default(), &MemoryResolver::default());
//! assert!(compiled.diagnostics.is_empty());
//! let names: Vec<&str> = compiled.scene.nodes.iter().map(|node| node.name.as_str()).collect();
//! assert_eq!(names, ["Body", "Arm"]);
//!
//! let model = to_memory(&GLB, &compiled.scene, None)?;
//! assert!(model.bytes.starts_with(b"glTF"));
//! # Ok::<(), std::io::Error>(())
//! ```
//!
//! What is wrong in a drawing is never an error of the function: it is a diagnostic, with the bytes that it is about and what to do,
//! and the rest is built.
//!
//! ```
//! use okoshi::diagnostic::Code;
//! use okoshi::{LineIndex, MemoryResolver, Options, compile};
//!
//! let drawing = r#"<svg xmlns="http://www.w3.org/2000/svg" width="9" height="9">
//!   <rect width="5" height="5"/>
//!   <text x="2" y="3">Body$Colr 1 0 0</text>
//! </svg>"#;
//! let compiled = compile(drawing, &Options::default(), &MemoryResolver::default());
//! let found = &compiled.diagnostics[0];
//! assert_eq!(found.code, Code::UnknownKeyword);
//! assert_eq!(&drawing[found.span.start..found.span.end], "Colr");
//! assert_eq!(LineIndex::new(drawing).line_column(found.span.start), (3, 26));
//! assert!(compiled.has_errors() && compiled.scene.nodes.len() == 1);
//! ```
//!
//! A drawing that changes a little at a time is compiled by a [`Compiler`], which keeps what the change does not affect:
//!
//! ```
//! use okoshi::scene::MaterialId;
//! use okoshi::{Compiler, MemoryResolver, Options};
//!
//! let drawing = r#"<svg xmlns="http://www.w3.org/2000/svg" width="9" height="9">
//!   <rect width="5" height="5"/>
//!   <text x="2" y="3">Body$Alpha 1</text>
//! </svg>"#;
//! let (options, files) = (Options::default(), MemoryResolver::default());
//! let mut compiler = Compiler::default();
//! compiler.compile(drawing, &options, &files);
//! let changed = compiler.compile(&drawing.replace("Alpha 1", "Alpha .5"), &options, &files);
//! assert!(compiler.last_was_partial());
//! assert_eq!(changed.scene.materials[MaterialId::from(0)].base_color[3], 0.5);
//! ```
//!
//! Files that a drawing links to are read by a [`Resolver`]: motions, models, pictures. [`MemoryResolver`] has them in memory, and
//! `FolderResolver` (feature `disk`) reads those beside the drawing.
//!
//! # Features
//!
//! Without default features the crate is the core: no files, threads, clock or C code, and it builds for `wasm32-unknown-unknown`.
//! `render` draws pictures of models, `disk` reads and writes files, `cli` (the default) is the program. The modules behind
//! `tracking`, `watch`, `preview` and `lsp` are parts of the program.
//!
//! Everything that is documented here is kept stable between minor versions; what is hidden is not.
#![cfg_attr(
    test,
    allow(clippy::unwrap_used, reason = "a test that fails to unwrap has failed")
)]
#![cfg_attr(
    not(feature = "cli"),
    allow(
        dead_code,
        unused_imports,
        reason = "what only the rim uses is unused without it"
    )
)]

mod anatomy;
#[doc(hidden)]
pub mod assemble;
mod assignment;
#[doc(hidden)]
pub mod billboard;
#[doc(hidden)]
pub mod bind;
#[cfg(feature = "cli")]
#[doc(hidden)]
pub mod cli;
#[doc(hidden)]
pub mod clips;
pub mod compile;
#[doc(hidden)]
pub mod crash;
pub mod diagnostic;
#[cfg(feature = "disk")]
#[doc(hidden)]
pub mod disk;
pub mod export;
#[doc(hidden)]
pub mod figure;
#[doc(hidden)]
pub mod geometry;
#[doc(hidden)]
pub mod ide;
#[doc(hidden)]
pub mod import;
mod index;
#[doc(hidden)]
pub mod labels;
#[doc(hidden)]
pub mod lang;
#[doc(hidden)]
pub mod limited;
#[cfg(feature = "render")]
#[doc(hidden)]
pub mod look;
#[cfg(feature = "lsp")]
#[doc(hidden)]
pub mod lsp;
#[doc(hidden)]
pub mod mark_tracks;
#[doc(hidden)]
pub mod memo;
#[doc(hidden)]
pub mod mocap;
#[doc(hidden)]
pub mod motion;
#[doc(hidden)]
pub mod performance;
#[doc(hidden)]
pub mod prepare;
#[cfg(feature = "preview")]
#[doc(hidden)]
pub mod preview;
#[doc(hidden)]
pub mod puppet;
mod regions;
#[cfg(feature = "render")]
pub mod render;
#[doc(hidden)]
pub mod report;
pub mod resolver;
#[doc(hidden)]
pub mod retarget;
#[doc(hidden)]
pub mod rig;
pub mod scene;
mod smoothing;
#[doc(hidden)]
pub mod solid;
#[doc(hidden)]
pub mod source;
#[doc(hidden)]
pub mod svg;
#[doc(hidden)]
pub mod terrain;
#[doc(hidden)]
pub mod texture;
mod threads;
#[cfg(feature = "tracking")]
#[doc(hidden)]
pub mod tracking;
#[cfg(feature = "watch")]
#[doc(hidden)]
pub mod watch;

pub use compile::{Compiled, Compiler, Options, compile};
pub use diagnostic::Diagnostic;
#[cfg(feature = "disk")]
pub use disk::FolderResolver;
pub use memo::Memo;
pub use resolver::{MemoryResolver, Resolver};
pub use source::{LineIndex, Span};
