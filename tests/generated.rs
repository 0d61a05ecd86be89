//! The pages and grammars that are generated from the keyword table are up to date.
//!
//! `OKOSHI_REWRITE=generated cargo test --test generated` rewrites it.

#[path = "common/rewrite.rs"]
mod rewrite;

use std::fs;
use std::path::{Path, PathBuf};

use okoshi::lang::reference;

fn path(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(name)
}

#[track_caller]
fn same(name: &str, generated: &str) {
    let path = path(name);
    if rewrite::rewrites("generated") {
        if let Some(folder) = path.parent() {
            fs::create_dir_all(folder).expect("folder");
        }
        fs::write(&path, generated).expect("rewritten");
        return;
    }
    let written = fs::read_to_string(&path).unwrap_or_default();
    assert!(
        written == generated,
        "{name} is out of date: run `OKOSHI_REWRITE=generated cargo test --test generated`"
    );
}

#[test]
fn reference_page() {
    same("docs/reference.md", &reference::reference());
}

#[test]
fn diagnostics_page() {
    same("docs/diagnostics.md", &reference::diagnostics());
}

#[test]
fn ebnf() {
    same("grammar/okoshi.ebnf", &reference::ebnf());
}

#[test]
fn textmate() {
    same("grammar/okoshi.tmLanguage.json", &reference::textmate());
}

#[test]
fn injection() {
    same(
        "grammar/okoshi-injection.tmLanguage.json",
        &reference::injection(),
    );
}

#[test]
fn readme_table() {
    let readme = fs::read_to_string(path("README.md")).expect("README.md");
    let renewed =
        reference::update_readme(&readme).expect("README.md has the markers of its table");
    same("README.md", &renewed);
}
