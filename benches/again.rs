//! How long incremental compiling takes after a keystroke, as a ratio to what usvg alone needs to read the drawing.
//!
//! `cargo bench --bench again [-- PARTS…]` prints, for drawings of 1,000 and 10,000 parts, a third of them with
//! strings: medians and 99th percentiles of 200 interleaved rounds, all in one warm process on okoshi's allocator. As
//! in an editor, what the last keystroke gave is held until the next is done; dropping it is not counted.

#![allow(clippy::print_stdout, reason = "a benchmark prints its figures")]

mod drawing;
mod sizes;

use std::hint::black_box;
use std::time::{Duration, Instant};

use okoshi::compile::{Compiled, Compiler, Options, compile};
use okoshi::resolver::MemoryResolver;

use drawing::{Random, drawing};
use sizes::sizes;

#[global_allocator]
static ALLOCATOR: mimalloc::MiMalloc = mimalloc::MiMalloc;

/// How often each is done.
const ROUNDS: usize = 200;

fn main() {
    let sizes = sizes(std::env::args().skip(1), &[1_000, 10_000]);
    println!("parts   what                    median ms   p99 ms   ratios to usvg's median");
    for size in sizes {
        measure(size);
    }
}

fn measure(parts: usize) {
    let (text, _) = drawing(parts);
    let resolver = MemoryResolver::default();
    let options = Options::default();
    let mut random = Random(7);
    let mut typist = Typist::new(text.clone());
    let mut draughtsman = Typist::new(text.clone());
    let names: [&str; 4] = [
        "usvg's parse",
        "compile",
        "keystroke in a string",
        "number in a tag",
    ];
    let mut times: [Vec<Duration>; 4] = Default::default();
    for round in 0..=ROUNDS {
        let usvg_options = usvg::Options::default();
        let (tree, usvg) = timed(|| usvg::Tree::from_str(&text, &usvg_options));
        drop(black_box(tree.expect("a sound drawing")));
        let (compiled, whole) = timed(|| compile(&text, &options, &resolver));
        drop(black_box(compiled));
        typist.edit(&mut random, "\">P", "x");
        let keystroke = typist.compile(&options, &resolver);
        draughtsman.edit(&mut random, "width=\"", "1");
        let number = draughtsman.compile(&options, &resolver);
        // The first round warms up.
        if round > 0 {
            assert!(typist.compiler.last_was_partial(), "{round}");
            for (times, time) in times.iter_mut().zip([usvg, whole, keystroke, number]) {
                times.push(time);
            }
        }
    }
    let found = times.map(|mut times| {
        times.sort();
        [times[ROUNDS / 2], times[ROUNDS * 99 / 100]].map(|time| time.as_secs_f64())
    });
    let base = found[0][0];
    for (name, [median, late]) in names.into_iter().zip(found) {
        println!(
            "{parts:>6}  {name:<22}  {:>9.2}  {:>7.2}   {:>5.2} {:>5.2}",
            median * 1e3,
            late * 1e3,
            median / base,
            late / base
        );
    }
}

fn timed<R>(work: impl FnOnce() -> R) -> (R, Duration) {
    let start = Instant::now();
    let made = work();
    (made, start.elapsed())
}

/// An editor that types into a drawing.
struct Typist {
    text: String,
    compiler: Compiler,
    last: Compiled,
    /// Where a character was inserted that the next edit removes.
    put_in: Option<usize>,
}

impl Typist {
    fn new(text: String) -> Self {
        Self {
            text,
            compiler: Compiler::default(),
            last: Compiled::default(),
            put_in: None,
        }
    }

    /// Removes the inserted character, or replaces or inserts one after an occurrence of `mark`.
    fn edit(&mut self, random: &mut Random, mark: &str, character: &str) {
        if let Some(at) = self.put_in.take() {
            self.text.replace_range(at..at + character.len(), "");
            return;
        }
        let places: Vec<usize> = self.text.match_indices(mark).map(|(at, _)| at).collect();
        let at = places[random.below(places.len())] + mark.len();
        self.text.insert_str(at, character);
        self.put_in = Some(at);
    }

    fn compile(&mut self, options: &Options, resolver: &MemoryResolver) -> Duration {
        let (compiled, time) = timed(|| self.compiler.compile(&self.text, options, resolver));
        self.last = compiled;
        time
    }
}
