//! How long an editor waits for the language server, as a ratio to what usvg alone needs to read the same drawing.
//!
//! `cargo bench --bench lsp [-- PARTS…]` opens drawings in a server over real stdio and types 200 characters into a
//! string: the time from each keystroke to its diagnostics, and of hovers and completions after it. Beside it, in
//! this process and in turn, usvg reads the text as it is then.

#![allow(clippy::print_stdout, reason = "a benchmark prints its figures")]

mod drawing;
#[path = "../tests/common/editor.rs"]
#[allow(dead_code, reason = "a benchmark asks less than the tests do")]
mod editor;

use std::time::{Duration, Instant};

use editor::{Editor, position, range};
use serde_json::json;

/// The server's allocator, so that both sides read drawings alike.
#[global_allocator]
static ALLOCATOR: mimalloc::MiMalloc = mimalloc::MiMalloc;

const URI: &str = "untitled:bench.svg";
const EDITS: usize = 200;
/// What is typed, over and over, behind a string that says only a name.
const TYPED: &str = "$Shape roundv -90 90 Smooth 20 Offset 3";

fn main() {
    let sizes = drawing::sizes(std::env::args().skip(1), &[1_000, 10_000]);
    println!("parts   what                median ms   p99 ms   to usvg's median: median   p99");
    for size in sizes {
        measure(size);
    }
}

fn measure(parts: usize) {
    let (mut text, _) = drawing::drawing(parts);
    let mut editor = Editor::new();
    editor.opened(URI, &text);
    let string = text.find("@P").expect("a string with a parent");
    let string = string + text[string..].find("</text>").expect("its end");
    let (mut usvg, mut diagnostics, mut hovers, mut completions) = (vec![], vec![], vec![], vec![]);
    let mut typed = 0;
    for version in 2..EDITS + 2 {
        usvg.push(timed(|| {
            let tree = usvg::Tree::from_str(&text, &usvg::Options::default());
            std::hint::black_box(tree.expect("a sound drawing"));
        }));
        let at = string + typed;
        let change = match TYPED[typed..].chars().next() {
            Some(letter) => {
                let change = json!({"range": range(&text, at, at), "text": letter.to_string()});
                text.insert(at, letter);
                typed += 1;
                change
            }
            None => {
                let change = json!({"range": range(&text, string, at), "text": ""});
                text.replace_range(string..at, "");
                typed = 0;
                change
            }
        };
        let version = i64::try_from(version).expect("a small number");
        diagnostics.push(timed(|| {
            editor.change(URI, version, &[change]);
            editor.diagnostics(URI, version);
        }));
        let here = json!({"textDocument": {"uri": URI}, "position": position(&text, string + typed), "context": {"triggerKind": 1}});
        hovers.push(timed(|| {
            editor.ask("textDocument/hover", here.clone());
        }));
        completions.push(timed(|| {
            editor.ask("textDocument/completion", here);
        }));
    }
    let base = at(&mut usvg, 50);
    let rows = [
        ("usvg's parse", usvg),
        ("keystroke", diagnostics),
        ("hover", hovers),
        ("completion", completions),
    ];
    for (what, mut times) in rows {
        let (median, p99) = (at(&mut times, 50), at(&mut times, 99));
        println!(
            "{parts:<7} {what:<19} {:>9.2} {:>8.2} {:>27.2} {:>5.2}",
            1e3 * median,
            1e3 * p99,
            median / base,
            p99 / base,
        );
    }
}

fn timed(work: impl FnOnce()) -> Duration {
    let start = Instant::now();
    work();
    start.elapsed()
}

/// A percentile, seconds.
fn at(times: &mut [Duration], percent: usize) -> f64 {
    times.sort();
    times[(times.len() * percent / 100).min(times.len() - 1)].as_secs_f64()
}
