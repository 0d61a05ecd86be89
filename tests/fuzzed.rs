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
#[path = "common/law.rs"]
#[allow(dead_code, reason = "only the counting is needed here")]
mod law;

use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::path::Path;
use std::time::{Duration, Instant};
use std::{env, fs};

use fastrand::Rng;
use law::Tally;

/// The longest input that is tried, in bytes: as long as the longest that the search begins with.
const LONGEST: usize = 64 << 10;

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

/// Checks so many inputs of a target, of which so many percent can be read; `OKOSHI_FUZZ_SECONDS` says how long it goes on. One that fails is
/// written to a file whose path is printed.
fn check(name: &str, count: usize, percent: usize) {
    let target = fuzzing::target(name);
    for regression in regressions(name) {
        checked(target, &regression);
    }
    let seconds = env::var("OKOSHI_FUZZ_SECONDS").ok();
    let seconds: Option<f64> = seconds.and_then(|seconds| seconds.parse().ok());
    let end = seconds.map(|seconds| Instant::now() + Duration::from_secs_f64(seconds));
    let mut seeds = (target.seeds)();
    let mut random = Rng::with_seed(20_240_229);
    random.shuffle(&mut seeds);
    let read = Tally::default();
    let mut inputs = 0;
    while inputs < count || end.is_some_and(|end| Instant::now() < end) {
        let mut input = seeds[inputs % seeds.len()].clone();
        input.truncate(LONGEST);
        let wild = random.u8(..4) == 0;
        let most = if wild { MUTATIONS } else { 2 };
        for _ in 0..random.usize(1..=most) {
            let other = &seeds[random.usize(..seeds.len())];
            if wild || !change_digit(&mut input, &mut random) {
                mutate(&mut input, other, &mut random);
            }
        }
        input.truncate(LONGEST);
        read.count(checked(target, &input));
        inputs += 1;
    }
    println!("{name}: {inputs} inputs, {read:?}");
    read.assert_share("inputs that can be read", percent);
}

/// Runs the law on an input; if it fails, the input is kept. Returns whether it could be read.
fn checked(target: &fuzzing::Target, input: &[u8]) -> bool {
    catch_unwind(AssertUnwindSafe(|| (target.check)(input))).unwrap_or_else(|failure| {
        let file = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("fuzzed-{}", target.name));
        fs::write(&file, input).expect("the folder for temporary files is writable");
        println!("the input is in {}", file.display());
        resume_unwind(failure)
    })
}

/// Changes a digit, which leaves most texts readable; others are refused early. Returns whether there is one.
fn change_digit(input: &mut [u8], random: &mut Rng) -> bool {
    let digits: Vec<usize> = (0..input.len())
        .filter(|at| input[*at].is_ascii_digit())
        .collect();
    if !digits.is_empty() {
        input[digits[random.usize(..digits.len())]] = random.u8(b'0'..=b'9');
    }
    !digits.is_empty()
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
    ($($name:ident: $count:literal inputs, $percent:literal %;)*) => {
        $(
            #[test]
            fn $name() {
                check(stringify!($name), $count, $percent);
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

// The shares are two thirds of what they are now: 76 % of strings, 64 % of drawings, but 30 % of models and 20 % of pictures, whose checksums no
// longer hold.
tests! {
    string: 20000 inputs, 50 %;
    drawing: 1000 inputs, 40 %;
    changes: 120 inputs, 40 %;
    motion: 1500 inputs, 60 %;
    model: 1000 inputs, 20 %;
    scene: 200 inputs, 20 %;
    picture: 2000 inputs, 10 %;
    character: 40 inputs, 40 %;
    messages: 20000 inputs, 40 %;
    session: 400 inputs, 60 %;
    track: 20000 inputs, 45 %;
    performance: 60 inputs, 45 %;
    puppet: 100 inputs, 40 %;
    tiled: 400 inputs, 10 %;
}

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
