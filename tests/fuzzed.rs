//! The laws of the fuzzing targets, on inputs that are mutated without coverage feedback, and on all inputs that once broke
//! them (tests/regressions/fuzzed).
//!
//! `OKOSHI_FUZZ_SECONDS=600 cargo test --test fuzzed` tries more, `fuzz/run.sh` searches with coverage feedback.
#![cfg(feature = "cli")]
#![allow(
    clippy::print_stdout,
    reason = "with --nocapture it says how much was tried, and where the input of a failure is"
)]

mod fuzzing;

use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::path::Path;
use std::time::{Duration, Instant};
use std::{env, fs};

use fastrand::Rng;

/// How long each target is tried, in seconds.
const SECONDS: f64 = 1.5;

/// The longest input that is tried, in bytes.
const LONGEST: usize = 16 << 10;

/// The most mutations of one input.
const MUTATIONS: usize = 6;

/// Bytes at which readers make decisions.
const TOKENS: &[&str] = &[
    "<",
    ">",
    "/>",
    "\"",
    "&",
    ";",
    "\0",
    "\n",
    "\r\n",
    " ",
    "$",
    "@",
    "%",
    "(",
    ")",
    "-",
    "0",
    "1e30",
    "-1",
    "nan",
    "4294967295",
    "\u{feff}",
    "\u{3000}",
    "é",
    "🦀",
    "\\ud83d",
    "[",
    "{",
    "}",
    ",",
    "null",
    "Content-Length: 9\r\n\r\n",
];

/// Checks inputs of a target until the time is over. One that fails is written to a file whose path is printed.
fn check(name: &str) {
    let target = fuzzing::target(name);
    for regression in regressions(name) {
        checked(target, &regression);
    }
    let seconds = env::var("OKOSHI_FUZZ_SECONDS")
        .ok()
        .and_then(|seconds| seconds.parse().ok())
        .unwrap_or(SECONDS);
    let mut seeds = (target.seeds)();
    let end = Instant::now() + Duration::from_secs_f64(seconds);
    let mut random = Rng::with_seed(20_240_229);
    random.shuffle(&mut seeds);
    let mut inputs = 0;
    while Instant::now() < end || inputs == 0 {
        let mut input = seeds[inputs % seeds.len()].clone();
        for _ in 0..random.usize(1..=MUTATIONS) {
            let other = &seeds[random.usize(..seeds.len())];
            mutate(&mut input, other, &mut random);
        }
        input.truncate(LONGEST);
        checked(target, &input);
        inputs += 1;
    }
    println!("{name}: {inputs} inputs");
}

/// Runs the law on an input; if it fails, the input is kept.
fn checked(target: &fuzzing::Target, input: &[u8]) {
    if let Err(failure) = catch_unwind(AssertUnwindSafe(|| (target.check)(input))) {
        let file = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("fuzzed-{}", target.name));
        fs::write(&file, input).expect("the folder for temporary files is writable");
        println!("the input is in {}", file.display());
        resume_unwind(failure);
    }
}

/// Changes an input in one place.
fn mutate(input: &mut Vec<u8>, other: &[u8], random: &mut Rng) {
    let at = random.usize(..=input.len());
    let end = (at + random.usize(..=16)).min(input.len());
    match random.u8(..7) {
        0 if at < input.len() => input[at] ^= 1 << random.u8(..8),
        1 if at < input.len() => input[at] = random.u8(..),
        2 => drop(input.drain(at..end)),
        3 => {
            let piece = input[at..end].to_vec();
            let copies = random.usize(1..=8);
            input.splice(at..at, piece.repeat(copies));
        }
        4 => {
            let from = random.usize(..=other.len());
            let until = (from + random.usize(..=64)).min(other.len());
            input.splice(at..end, other[from..until].iter().copied());
        }
        5 => drop(input.splice(at..at, random.u32(..).to_le_bytes())),
        _ => {
            let token = TOKENS[random.usize(..TOKENS.len())];
            input.splice(at..end, token.bytes());
        }
    }
}

/// The inputs that once broke the law of a target.
fn regressions(name: &str) -> Vec<Vec<u8>> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/regressions/fuzzed");
    let Ok(entries) = fs::read_dir(folder.join(name)) else {
        return Vec::new();
    };
    entries
        .map(|entry| fs::read(entry.expect("an entry").path()).expect("a file"))
        .collect()
}

macro_rules! tests {
    ($($name:ident)*) => {
        $(
            #[test]
            fn $name() {
                check(stringify!($name));
            }
        )*

        /// A target without a test would be fuzzed by hand only.
        #[test]
        fn every_target_has_a_test() {
            let tested = [$(stringify!($name)),*];
            let targets = fuzzing::TARGETS.map(|target| target.name);
            assert_eq!(tested, targets);
        }
    };
}

tests!(string drawing changes motion model picture messages session track);

/// The names under `[dependencies]` and `[dev-dependencies]` of a manifest.
fn dependencies(manifest: &str) -> Vec<String> {
    let text = fs::read_to_string(manifest).expect("a manifest");
    let mut section = "";
    let mut names = vec![];
    for line in text.lines() {
        if line.starts_with('[') {
            section = line;
        } else if let Some((name, _)) = line.split_once(" = ")
            && ["[dependencies]", "[dev-dependencies]"].contains(&section)
        {
            names.push(name.replace('-', "_"));
        }
    }
    names
}

/// The targets are built by a package of its own, which the tests do not build.
#[test]
fn the_targets_use_what_their_package_depends_on() {
    let [own, fuzzing] = ["Cargo.toml", "fuzz/Cargo.toml"].map(dependencies);
    let mut used = 0;
    for file in fs::read_dir("tests/fuzzing").expect("the targets") {
        let path = file.expect("a target").path();
        let text = fs::read_to_string(&path).expect("its source");
        for name in &own {
            let is_used = text.match_indices(&format!("{name}::")).any(|(at, _)| {
                let before = text[..at].chars().next_back();
                !before.is_some_and(|c| c.is_alphanumeric() || c == '_' || c == ':')
            });
            used += usize::from(is_used);
            let known = fuzzing.contains(name);
            assert!(!is_used || known, "{} uses {name}", path.display());
        }
    }
    assert!(used > 3, "{used} uses were found");
}
