//! How long an editor waits for the language server, as a ratio to what usvg alone needs to read the same drawing.
//!
//! `cargo bench --bench lsp [-- PARTS…]` opens drawings in a server over real stdio and types 200 characters into a
//! string: the time from each keystroke to its diagnostics, and of hovers and completions after it, one of them of the
//! parts after `@`. Beside it, in this process and in turn, usvg reads the text as it is then.
//!
//! The same 200 edits are made five times over. The second p99 is that of each edit's median time: a slow edit shows
//! there, a moment in which the machine did something else does not.

#![allow(clippy::print_stdout, reason = "a benchmark prints its figures")]

mod drawing;
#[path = "../tests/common/editor.rs"]
#[allow(dead_code, reason = "a benchmark asks less than the tests do")]
mod editor;
#[path = "../tests/common/patience.rs"]
#[allow(dead_code, reason = "a benchmark asks less than the tests do")]
mod patience;
mod sizes;

use std::time::{Duration, Instant};

use editor::{Editor, position, range};
use serde_json::json;

/// The server's allocator, for a fair comparison.
#[global_allocator]
static ALLOCATOR: mimalloc::MiMalloc = mimalloc::MiMalloc;

const URI: &str = "untitled:bench.svg";
/// A multiple of what it takes to type [`TYPED`] and to delete it, so that every round finds the same text.
const EDITS: usize = 200;
const ROUNDS: usize = 5;
/// The text that is typed again and again after a string with only a name.
const TYPED: &str = "$Shape roundv -90 90 Smooth 20 Offset 3";

fn main() {
    let sizes = sizes::sizes(std::env::args().skip(1), &[1_000, 10_000]);
    println!(
        "parts   what                median ms   p99 ms   to usvg's median: median   p99   p99 of edits' medians"
    );
    for size in sizes {
        measure(size);
    }
}

fn measure(parts: usize) {
    let (mut text, _) = drawing::drawing(parts);
    let mut editor = Editor::new();
    editor.opened(URI, &text);
    let sign = text.find("@P").expect("a string with a parent");
    let string = sign + text[sign..].find("</text>").expect("its end");
    let (mut usvg, mut diagnostics, mut hovers) = (vec![], vec![], vec![]);
    let (mut completions, mut parents) = (vec![], vec![]);
    let mut typed = 0;
    for version in 2..EDITS * ROUNDS + 2 {
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
        let place = |at| json!({"textDocument": {"uri": URI}, "position": position(&text, at), "context": {"triggerKind": 1}});
        let here = place(string + typed);
        hovers.push(timed(|| {
            editor.ask("textDocument/hover", here.clone());
        }));
        completions.push(timed(|| {
            editor.ask("textDocument/completion", here);
        }));
        let behind = place(sign + 1);
        parents.push(timed(|| {
            editor.ask("textDocument/completion", behind);
        }));
    }
    let base = at(&usvg, 50);
    let rows = [
        ("usvg's parse", usvg),
        ("keystroke", diagnostics),
        ("hover", hovers),
        ("completion", completions),
        ("completion of parts", parents),
    ];
    for (what, times) in rows {
        let (median, p99) = (at(&times, 50), at(&times, 99));
        let of_edits = at(&each(&times), 99);
        println!(
            "{parts:<7} {what:<19} {:>9.2} {:>8.2} {:>27.2} {:>5.2} {:>23.2}",
            1e3 * median,
            1e3 * p99,
            median / base,
            p99 / base,
            of_edits / base,
        );
    }
}

fn timed(work: impl FnOnce()) -> Duration {
    let start = Instant::now();
    work();
    start.elapsed()
}

/// Each edit's median over the rounds.
fn each(times: &[Duration]) -> Vec<Duration> {
    let of = |edit| times.iter().skip(edit).step_by(EDITS).copied();
    let median = |edit| {
        let mut times: Vec<Duration> = of(edit).collect();
        times.sort();
        times[times.len() / 2]
    };
    (0..EDITS).map(median).collect()
}

/// A percentile, seconds.
fn at(times: &[Duration], percent: usize) -> f64 {
    let mut times = times.to_vec();
    times.sort();
    times[(times.len() * percent / 100).min(times.len() - 1)].as_secs_f64()
}
