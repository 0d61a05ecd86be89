//! Seen from the front, models look like their drawings, for every kind of `Shape`.
//!
//! The truth is resvg's picture of the SVG itself (`truth.rs`); what okoshi leaves out or changes on purpose is listed for each
//! drawing (`drawings.rs`). Which parts are lost is what `okoshi check --look` finds (`look::compare`).
//!
//! Drawings are drawings of our own without given depths, clip art by others, and generated stacks, each with all its parts of one
//! kind. `LOOK_DIR=FOLDER cargo test --test as_drawn -- --nocapture --ignored survey` measures the drawings in a folder;
//! `tests/tools/clip_art.mjs` fills one from packages.
#![cfg(feature = "cli")]
#![allow(clippy::print_stdout, reason = "tables are for people")]

#[path = "../common/mod.rs"]
mod common;

mod comparison;
mod drawings;
mod limbs;
mod sample;
mod stacks;
mod truth;

use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;

/// The kinds of `Shape` that are measured.
const KINDS: [&str; 5] = ["default", "inflate", "round", "roundv", "roundh"];
/// The least share of right pixels.
const LEAST: f64 = 0.99;

/// So many of the kinds; which, goes by the index of what is built with them, so that all have their turn.
fn kinds_in_turn(index: usize, count: usize) -> impl Iterator<Item = &'static str> {
    let kinds = KINDS.into_iter().cycle();
    kinds.skip(index % KINDS.len()).take(count)
}

/// The results of `measure` for each sample, found on all processors. The pool of the program itself would begin with further
/// samples while it waits for pieces of one, deeper and deeper on the same stack.
fn each<S: Sync, R: Send>(samples: &[S], measure: impl Fn(&S) -> R + Sync) -> Vec<R> {
    let next = AtomicUsize::new(0);
    let found: Mutex<Vec<(usize, R)>> = Mutex::default();
    let threads = thread::available_parallelism().map_or(2, usize::from);
    thread::scope(|scope| {
        for _ in 0..threads {
            scope.spawn(|| {
                loop {
                    let index = next.fetch_add(1, Ordering::Relaxed);
                    let Some(sample) = samples.get(index) else {
                        break;
                    };
                    let result = measure(sample);
                    found.lock().expect("no panic").push((index, result));
                }
            });
        }
    });
    let mut found = found.into_inner().expect("no panic");
    found.sort_by_key(|(index, _)| *index);
    found.into_iter().map(|(_, result)| result).collect()
}

fn assert_all_right(rows: Vec<(bool, String)>) {
    let wrong = rows.into_iter().filter(|(is_right, _)| !is_right);
    let wrong: Vec<String> = wrong.map(|(_, row)| row).collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
