//! The tables in docs/characters.md.

#[path = "../../../../tests/common/rewrite.rs"]
mod rewrite;

use std::fs;
use std::path::Path;

/// Asserts that the page has this table between two marks, or writes it there: `<!-- what -->` and `<!-- /what -->`.
pub(super) fn keep(what: &str, table: &str) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/characters.md");
    let page = fs::read_to_string(&path).expect("a page");
    let [start, end] = ["", "/"].map(|slash| format!("<!-- {slash}{what} -->"));
    let (head, rest) = page.split_once(&start).expect("a mark before the table");
    let (old, tail) = rest.split_once(&end).expect("a mark after the table");
    let new = format!("\n{table}");
    if rewrite::rewrites("generated") {
        fs::write(&path, format!("{head}{start}{new}{end}{tail}")).expect("rewritten");
        return;
    }
    assert!(
        old == new,
        "docs/characters.md is out of date: run `OKOSHI_REWRITE=generated cargo test --lib measured` for\n{table}"
    );
}
