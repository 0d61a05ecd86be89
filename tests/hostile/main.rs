//! Drawings that are short and might take long.
//!
//! `OKOSHI_HOSTILE=FOLDER cargo test --test hostile` writes them into a folder, in a quarter, half and all of their size, for
//! tests/tools/hostile.py, which measures what they take.

mod geometry;
mod kinds;

use std::path::Path;
use std::{env, fs};

use kinds::Kind;

/// The kinds of all subjects.
fn all() -> impl Iterator<Item = &'static Kind> {
    [geometry::KINDS].into_iter().flatten()
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
