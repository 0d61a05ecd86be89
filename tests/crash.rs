//! A panic is reported as a crash, with its message and its place.
#![cfg(feature = "cli")]

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use okoshi::compile::{Compiled, Compiler, Options, compile};
use okoshi::diagnostic::Code;
use okoshi::internals::cli::report::{Style, human};
use okoshi::internals::crash;
use okoshi::internals::report::Findings;
use okoshi::resolver::{LinkError, Resolver};

const DRAWING: &str = r#"<svg xmlns="http://www.w3.org/2000/svg" width="100" height="100">
<rect width="30" height="40"/><text x="5" y="9">Body$Texture a.png</text></svg>"#;

/// A resolver that panics, unless it has been mended.
#[derive(Default)]
struct Faulty {
    is_fixed: AtomicBool,
}

impl Resolver for Faulty {
    fn read(&self, link: &str) -> Result<Arc<[u8]>, LinkError> {
        assert!(self.is_fixed.load(Ordering::Relaxed), "no `{link}` today");
        Err(LinkError::Missing)
    }
}

fn assert_crashed(compiled: &Compiled) {
    let report = human(
        Findings {
            look: None,
            path: "drawing.svg",
            text: DRAWING,
            diagnostics: &compiled.diagnostics,
        },
        Style::Plain,
    );
    assert!(compiled.has_crashed() && compiled.has_errors(), "{report}");
    let start = "error[E008]: okoshi crashed: no `a.png` today (tests/crash.rs:";
    assert!(report.starts_with(start), "{report}");
    assert!(
        report.contains(
            "report it to the maintainers, with the drawing, this message and the version"
        ),
        "{report}"
    );
    assert!(report.contains(env!("CARGO_PKG_VERSION")), "{report}");
}

#[test]
fn a_panic_becomes_a_diagnostic() {
    crash::record_locations();
    assert_crashed(&compile(DRAWING, &Options::default(), &Faulty::default()));
}

#[test]
fn a_compiler_works_again_after_a_panic() {
    crash::record_locations();
    let (options, resolver) = (Options::default(), Faulty::default());
    let mut compiler = Compiler::default();
    let without = DRAWING.replace("$Texture a.png", "");
    assert!(
        !compiler
            .compile(&without, &options, &resolver)
            .has_crashed()
    );
    for _ in 0..2 {
        assert_crashed(&compiler.compile(DRAWING, &options, &resolver));
    }
    resolver.is_fixed.store(true, Ordering::Relaxed);
    let compiled = compiler.compile(DRAWING, &options, &resolver);
    let codes: Vec<Code> = compiled
        .diagnostics
        .iter()
        .map(|found| found.code)
        .collect();
    assert_eq!(codes, [Code::MissingFile]);
}
