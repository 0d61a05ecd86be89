//! Every drawing compiles, its scene can be written, and diagnostics point into the drawing.
#![no_main]

use libfuzzer_sys::fuzz_target;
use okoshi::compile::{Options, compile};
use okoshi::export::{GLB, to_memory};
use okoshi::resolver::MemoryResolver;

fuzz_target!(|drawing: &str| {
    let compiled = compile(drawing, &Options::default(), &MemoryResolver::default());
    for finding in &compiled.diagnostics {
        assert!(drawing.get(finding.span.start..finding.span.end).is_some(), "{finding:?}");
    }
    to_memory(&GLB, &compiled.scene, None).expect("a scene keeps its own rules");
});
