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
//!   <text x="70" y="50">Arm@Body$Shape roundv Bend 0</text>
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
//! Everything that is documented here is kept stable between minor versions. All else is private.
#![cfg_attr(
    test,
    allow(clippy::unwrap_used, reason = "a test that fails to unwrap has failed")
)]
// Tests may compute what they draw in any way.
#![cfg_attr(not(test), warn(clippy::disallowed_methods))]
#![cfg_attr(
    not(feature = "cli"),
    allow(
        dead_code,
        unreachable_pub,
        unused_imports,
        reason = "what only the rim uses is unused without it"
    )
)]
#![allow(
    rustdoc::private_intra_doc_links,
    reason = "what is public for the program's own tests is documented for readers of the source"
)]

mod anatomy;
mod assemble;
mod assignment;
mod bend;
mod billboard;
mod bind;
mod budget;
#[cfg(feature = "cli")]
mod cli;
mod clips;
pub mod compile;
mod crash;
pub mod diagnostic;
#[cfg(feature = "disk")]
mod disk;
pub mod export;
mod figure;
mod geometry;
mod ide;
mod import;
mod index;
#[doc(hidden)]
pub mod internals;
mod labels;
mod lang;
mod limited;
#[cfg(feature = "render")]
mod look;
#[cfg(feature = "lsp")]
mod lsp;
mod mark_tracks;
mod math;
mod memo;
mod mocap;
mod motion;
#[cfg(feature = "page")]
mod page;
mod performance;
mod prepare;
#[cfg(feature = "preview")]
mod preview;
#[cfg(feature = "protocol")]
mod protocol;
mod puppet;
mod raster;
mod regions;
#[cfg(feature = "render")]
pub mod render;
mod report;
pub mod resolver;
mod retarget;
mod rig;
pub mod scene;
mod smoothing;
mod solid;
mod source;
#[cfg(feature = "page")]
mod starters;
mod svg;
mod terrain;
mod texture;
mod threads;
mod trace;
#[cfg(feature = "tracking")]
mod tracking;
#[cfg(feature = "watch")]
mod watch;

// Shared with the tests outside.
#[cfg(test)]
#[path = "../tests/common/law.rs"]
mod law;
#[cfg(test)]
#[path = "../tests/common/patience.rs"]
mod patience;

pub use compile::{Compiled, Compiler, Options, compile};
pub use diagnostic::Diagnostic;
#[cfg(feature = "disk")]
pub use disk::FolderResolver;
pub use memo::Memo;
pub use resolver::{MemoryResolver, Resolver};
pub use source::{LineIndex, Span};
