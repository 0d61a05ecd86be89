//! Every drawing compiles; diagnostics and fixes point into its text; its scene is written in every format; and the model
//! is one that okoshi reads.

use okoshi::compile::{Compiled, Options, compile};
use okoshi::diagnostic::Diagnostic;
use okoshi::export::{EXPORTERS, GLB, to_memory};
use okoshi::internals::disk::decode;
use okoshi::internals::import::{ImportError, read_static_model};
use okoshi::render;
use okoshi::resolver::{MemoryResolver, Resolver};

use super::files;

pub(super) fn check(bytes: &[u8]) -> bool {
    match decode(bytes.to_vec()) {
        Err(error) => {
            assert!(error.offset() < bytes.len(), "{error}");
            false
        }
        Ok(text) => !check_compiled(&text, &linked()).scene.nodes.is_empty(),
    }
}

/// What the drawings of the cases may link to.
pub(super) fn linked() -> MemoryResolver {
    MemoryResolver::default()
        .with("biscuit.glb", files::read("examples/shapes/biscuit.glb"))
        .with(
            "walk.bvh",
            files::read("tests/motion/data/mixed_orders.bvh"),
        )
}

/// Compiles a drawing and checks what must hold for each.
pub(super) fn check_compiled(text: &str, resolver: &dyn Resolver) -> Compiled {
    let compiled = compile(text, &Options::default(), resolver);
    assert!(!compiled.has_crashed(), "{:?}", compiled.diagnostics);
    check_places(text, &compiled.diagnostics);
    for exporter in EXPORTERS {
        let written = to_memory(*exporter, &compiled.scene, None);
        written.expect("a scene keeps its own rules");
    }
    check_model(&compiled);
    compiled
}

/// What was written can be read.
fn check_model(compiled: &Compiled) {
    let model = to_memory(&GLB, &compiled.scene, None).expect("it was written before");
    let nothing = MemoryResolver::default();
    render::read(&model.bytes, &nothing).expect("okoshi reads what it writes");
    match read_static_model(&model.bytes, &nothing) {
        Ok(_) | Err(ImportError::Empty) => {}
        Err(error) => panic!("what okoshi wrote {error}"),
    }
}

/// Fails if a diagnostic or one of its fixes is about something outside of the text.
pub(super) fn check_places(text: &str, diagnostics: &[Diagnostic]) {
    for diagnostic in diagnostics {
        let fixes = diagnostic.fixes.iter().flat_map(|fix| &fix.edits);
        let spans = fixes.map(|edit| edit.span);
        let related = diagnostic.related.iter().map(|related| related.span);
        for span in spans.chain(related).chain([diagnostic.span]) {
            assert!(text.get(span.start..span.end).is_some(), "{diagnostic:?}");
        }
    }
}

pub(super) fn seeds() -> Vec<Vec<u8>> {
    files::cases().into_iter().map(String::into_bytes).collect()
}
