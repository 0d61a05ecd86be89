//! Drawings that are short and might take long.
//!
//! The tests build small ones and count the steps that this takes, which are the same in every run: each must be about twice as many for a
//! drawing that is twice as large.
//!
//! `OKOSHI_HOSTILE=FOLDER cargo test --test hostile` writes them into a folder, in a quarter, half and all of their size, for
//! tests/tools/hostile.py, which measures what they take.

mod geometry;
mod kinds;
mod writing;

use std::path::Path;
use std::{env, fs};

use kinds::Kind;
use okoshi::compile::{Options, compile};
use okoshi::export::{GLB, to_memory};
use okoshi::internals::budget::{STEPS, counted};
use okoshi::resolver::MemoryResolver;

/// The steps of a drawing grow at most with this power of its size.
const POWER: f64 = 1.3;
/// Fewer steps are not looked at: they may be those of another way to do the same.
const FEW: u64 = 20_000;

/// What grows faster, until a limit stops it: discs among many rings, tips and teeth, and what overlaps itself or others everywhere. Each
/// must be needed.
const KNOWN: [(&str, &str); 32] = [
    ("circles-overlapping-inflated", "Cell"),
    ("circles-of-one-path-overlapping", "Pair"),
    ("rings-nested-round", "Pair"),
    ("rings-nested-inflated", "Pair"),
    ("star-roundv", "Pair"),
    ("star-roundv", "DiscEdge"),
    ("star-roundh", "Pair"),
    ("star-roundh", "DiscEdge"),
    ("star-round", "Pair"),
    ("star-lathe", "Pair"),
    ("star-inflated", "Pair"),
    ("star-inflated", "DiscEdge"),
    ("star-conev", "Pair"),
    ("star-conev", "DiscEdge"),
    ("stars-of-one-path-roundv", "Pair"),
    ("scribbles", "Pair"),
    ("scribbles", "Triangle"),
    ("bars-crossed", "Point"),
    ("bars-crossed", "Pair"),
    ("bars-crossed", "Triangle"),
    ("spiral", "Pair"),
    ("spiral-inflated", "Pair"),
    ("spiral-inflated", "DiscEdge"),
    ("spiral-roundv", "Pair"),
    ("spiral-roundv", "DiscEdge"),
    ("spiral-line", "Pair"),
    ("markers", "Point"),
    ("markers", "Pair"),
    ("comb-inflated", "DiscEdge"),
    ("comb-roundv", "DiscEdge"),
    ("comb-roundh", "DiscEdge"),
    ("holes-in-a-row-roundv", "DiscEdge"),
];

/// The kinds of all subjects.
fn all() -> impl Iterator<Item = &'static Kind> {
    [geometry::KINDS, writing::KINDS].into_iter().flatten()
}

#[test]
fn each_is_short() {
    let mut names: Vec<_> = all().map(|kind| kind.name).collect();
    names.sort_unstable();
    names.dedup();
    assert_eq!(names.len(), all().count(), "each has a name of its own");
    for Kind {
        name,
        full,
        small,
        make,
    } in all()
    {
        let [length, shorter] = [full, small].map(|size| make(*size).len());
        assert!(length < 1 << 20, "{name}: {length}");
        assert!(shorter <= length, "{name}: {shorter} of {length}");
    }
}

/// Writes them, if that is asked for.
#[test]
fn written_for_measurements() {
    let Some(folder) = env::var_os("OKOSHI_HOSTILE") else {
        return;
    };
    fs::create_dir_all(&folder).expect("a folder can be made");
    for Kind {
        name, full, make, ..
    } in all()
    {
        for share in [4, 2, 1] {
            let file = Path::new(&folder).join(format!("{name}-{}.svg", full / share));
            fs::write(file, make(full / share)).expect("the folder is writable");
        }
    }
}

/// The only test that builds anything: steps are counted for the whole process.
#[test]
fn work_grows_with_the_drawing() {
    let (mut looked_at, mut met) = (0, Vec::new());
    let mut broken = Vec::new();
    for Kind {
        name, small, make, ..
    } in all()
    {
        let steps = |size: usize| {
            let drawing = make(size);
            counted(|| {
                let files = MemoryResolver::default();
                let compiled = compile(&drawing, &Options::default(), &files);
                to_memory(&GLB, &compiled.scene, None).expect("a scene keeps its own rules");
            })
        };
        let [one, four] = [*small, 4 * small].map(steps);
        for (step, (one, four)) in STEPS.iter().zip(one.into_iter().zip(four)) {
            if four <= FEW {
                continue;
            }
            looked_at += 1;
            let most = (one.max(FEW / 4) as f64 * 4.0_f64.powf(POWER)) as u64;
            let step = format!("{step:?}");
            let known = KNOWN.iter().find(|known| **known == (*name, &*step));
            met.extend(known);
            if (four > most) != known.is_some() {
                broken.push(format!(
                    "(\"{name}\", {step:?}): {one}, and {four} for four times as much"
                ));
            }
        }
    }
    assert!(broken.is_empty(), "{broken:#?}");
    let unmet: Vec<_> = KNOWN.iter().filter(|known| !met.contains(*known)).collect();
    assert!(unmet.is_empty(), "few steps are taken now: {unmet:?}");
    assert!(
        looked_at - met.len() >= 50,
        "{looked_at} counts were looked at, {} are known to grow faster",
        met.len()
    );
}
