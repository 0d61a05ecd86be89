//! How long building takes, as a ratio to what usvg alone needs to read the same drawing.
//!
//! `cargo bench --bench build [-- PARTS…]` prints, for drawings of 1,000, 10,000 and 100,000 parts, a third of
//! them with strings: medians and least times of interleaved rounds, the triangles that were made, and how near the
//! parts' area comes to the true one, so that coarse curves gain nothing. Both sides are whole processes, as a user
//! starts them: `okoshi build` into a new file, and this program, on the system's allocator, calling usvg on the drawing.

#![allow(clippy::print_stdout, reason = "a benchmark prints its figures")]

mod drawing;
mod process;
mod sizes;

use std::process::Command;

use okoshi::compile::{Options, compile};
use okoshi::internals::geometry::area;
use okoshi::resolver::MemoryResolver;

use drawing::drawing;
use process::{build, interleaved, timed, triangles};
use sizes::sizes;

/// With this argument, the program is the baseline: it only reads the drawing.
const BASELINE: &str = "--usvg";
/// With this one, it prints a drawing of so many parts.
const DRAWING: &str = "--drawing";

fn main() {
    // cargo passes `--bench`.
    let mut arguments = std::env::args()
        .skip(1)
        .filter(|argument| argument != "--bench")
        .peekable();
    if arguments.next_if(|argument| argument == BASELINE).is_some() {
        let path = arguments.next().expect("a drawing");
        let text = std::fs::read_to_string(path).expect("a drawing");
        let tree = usvg::Tree::from_str(&text, &usvg::Options::default()).expect("a sound drawing");
        // Dropping it is not measured.
        std::mem::forget(std::hint::black_box(tree));
        return;
    }
    if arguments.next_if(|argument| argument == DRAWING).is_some() {
        let parts = arguments.next().and_then(|parts| parts.parse().ok());
        print!("{}", drawing(parts.expect("a number of parts")).0);
        return;
    }
    let sizes = sizes(arguments, &[1_000, 10_000, 100_000]);
    println!("parts   usvg ms (least)  okoshi ms (least)  ratio (least)  triangles   MB  area");
    for size in sizes {
        measure(size);
    }
}

fn measure(parts: usize) {
    let (drawing, true_area) = drawing(parts);
    let folder = tempfile::tempdir().expect("a temporary folder");
    let [input, output] = ["drawing.svg", "model.glb"].map(|name| folder.path().join(name));
    std::fs::write(&input, &drawing).expect("room for it");
    let this = std::env::current_exe().expect("this program");
    let rounds = (200_000 / parts).clamp(5, 21);
    let read = || timed(Command::new(&this).arg(BASELINE).arg(&input));
    let write = || timed(&mut build(&input, &output));
    let [usvg, okoshi] = interleaved(rounds, [&read, &write]);
    let bytes = std::fs::metadata(&output).expect("a model").len();
    let compiled = compile(&drawing, &Options::default(), &MemoryResolver::default());
    let found_area: f64 = compiled
        .bindings
        .parts
        .iter()
        .map(|part| area(&part.outline))
        .sum();
    println!(
        "{parts:>6}  {:>7.1} ({:>6.1})  {:>8.1} ({:>6.1})  {:>5.2} ({:>5.2})  {:>9}  {:>4.0}  {:.4}",
        usvg.median * 1e3,
        usvg.least * 1e3,
        okoshi.median * 1e3,
        okoshi.least * 1e3,
        okoshi.median / usvg.median,
        okoshi.least / usvg.least,
        triangles(&output),
        bytes as f64 / 1e6,
        found_area / true_area,
    );
}
