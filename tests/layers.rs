//! The rooms of `src` know only what docs/architecture.md lets them know.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

/// Each room, and the rooms that it may name.
const MAY_KNOW: &[(&str, &[&str])] = &[
    ("source", &[]),
    ("resolver", &[]),
    ("kept", &[]),
    ("geometry", &[]),
    ("diagnostic", &["source"]),
    ("lang", &["diagnostic", "source"]),
    ("threads", &[]),
    (
        "svg",
        &[
            "diagnostic",
            "geometry",
            "resolver",
            "scene",
            "source",
            "texture",
            "threads",
        ],
    ),
    (
        "terrain",
        &[
            "bind",
            "diagnostic",
            "geometry",
            "lang",
            "resolver",
            "scene",
            "source",
            "svg",
            "texture",
            "threads",
        ],
    ),
    ("texture", &["scene"]),
    ("motion", &["scene"]),
    ("solid", &["geometry", "lang", "scene"]),
    ("scene", &["solid"]),
    ("gltf", &["scene", "solid", "threads"]),
    (
        "bind",
        &[
            "diagnostic",
            "geometry",
            "kept",
            "lang",
            "source",
            "svg",
            "threads",
        ],
    ),
    (
        "figure",
        &[
            "bind",
            "diagnostic",
            "geometry",
            "import",
            "kept",
            "lang",
            "motion",
            "resolver",
            "scene",
            "solid",
            "source",
            "svg",
            "terrain",
            "texture",
            "threads",
        ],
    ),
    (
        "compile",
        &[
            "bind",
            "diagnostic",
            "figure",
            "resolver",
            "scene",
            "source",
            "svg",
            "terrain",
            "threads",
        ],
    ),
    ("import", &["resolver", "scene"]),
    ("render", &["import", "resolver", "threads"]),
    ("disk", &["resolver"]),
    (
        "cli",
        &[
            "bind",
            "compile",
            "diagnostic",
            "disk",
            "gltf",
            "lang",
            "lsp",
            "motion",
            "preview",
            "render",
            "report",
            "source",
            "terrain",
            "watch",
        ],
    ),
    ("report", &["bind", "compile", "figure", "terrain"]),
    ("watch", &["compile", "disk", "gltf", "resolver"]),
    (
        "preview",
        &[
            "compile",
            "diagnostic",
            "gltf",
            "render",
            "report",
            "resolver",
            "watch",
        ],
    ),
    (
        "ide",
        &[
            "bind",
            "compile",
            "diagnostic",
            "figure",
            "geometry",
            "lang",
            "report",
            "source",
            "svg",
            "terrain",
        ],
    ),
    (
        "lsp",
        &[
            "compile",
            "diagnostic",
            "disk",
            "gltf",
            "ide",
            "lang",
            "preview",
            "resolver",
            "source",
            "watch",
        ],
    ),
    ("lib", &[]),
    ("main", &[]),
];

/// What only some rooms may touch: a piece of code, those rooms, and why.
const ONLY_IN: &[(&str, &[&str], &str)] = &[
    ("std::fs", &["disk"], "only `disk` touches files"),
    ("File::", &["disk"], "only `disk` touches files"),
    (
        "std::env",
        &["cli", "main"],
        "compiling knows no environment",
    ),
    (
        "std::process",
        &["cli", "lsp", "main"],
        "compiling starts nothing",
    ),
    (
        "ls_types",
        &["lsp"],
        "only `lsp` names the protocol's types",
    ),
    (
        "Instant::",
        &["cli", "disk", "preview", "watch"],
        "compiling knows no clock",
    ),
    (
        "SystemTime",
        &["cli", "disk", "lsp", "preview", "watch"],
        "compiling knows no clock",
    ),
    ("println!", &["cli"], "only `cli` prints"),
    ("eprintln!", &["cli"], "only `cli` prints"),
];

struct Source {
    room: String,
    path: PathBuf,
    /// Without comments and tests.
    code: String,
}

fn sources() -> Vec<Source> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut found = Vec::new();
    let mut folders = vec![root.clone()];
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(&folder).expect("a folder") {
            let path = entry.expect("an entry").path();
            if path.is_dir() {
                folders.push(path);
                continue;
            }
            let inside = path.strip_prefix(&root).expect("in src").to_owned();
            let words: Vec<String> = inside
                .with_extension("")
                .iter()
                .map(|word| word.to_string_lossy().into_owned())
                .collect();
            let for_tests = |word: &String| {
                matches!(word.as_str(), "tests" | "laws" | "samples") || word.ends_with("_tests")
            };
            if words.iter().any(for_tests) {
                continue;
            }
            let text = fs::read_to_string(&path).expect("text");
            let text = text
                .split("#[cfg(test)]\nmod tests {")
                .next()
                .unwrap_or_default();
            let code = text
                .lines()
                .filter(|line| !line.trim_start().starts_with("//"))
                .map(|line| format!("{line}\n"))
                .collect();
            found.push(Source {
                room: words[0].clone(),
                path: inside,
                code,
            });
        }
    }
    found
}

/// The rooms that code names by `crate::`.
fn named(code: &str) -> BTreeSet<&str> {
    code.split("crate::")
        .skip(1)
        .filter_map(|rest| {
            rest.split(|c: char| !c.is_ascii_lowercase() && c != '_')
                .next()
        })
        .filter(|word| !word.is_empty())
        .collect()
}

#[test]
fn rooms_know_only_what_they_may() {
    let may_know: BTreeMap<&str, &[&str]> = MAY_KNOW.iter().copied().collect();
    let sources = sources();
    assert!(
        sources.len() > 50,
        "only {} files were found",
        sources.len()
    );
    let mut rooms = BTreeSet::new();
    for source in &sources {
        let room = source.room.as_str();
        rooms.insert(room);
        let allowed = may_know.get(room).unwrap_or_else(|| {
            panic!("`{room}` is a new room: give it a line here and in docs/architecture.md")
        });
        for other in named(&source.code) {
            assert!(
                other == room || allowed.contains(&other),
                "{} names `{other}`, which `{room}` must not know",
                source.path.display()
            );
        }
    }
    for (room, _) in MAY_KNOW {
        assert!(rooms.contains(room), "`{room}` is gone: take its line away");
    }
}

#[test]
fn only_the_rim_touches_the_world() {
    for source in sources() {
        for (piece, rooms, why) in ONLY_IN {
            let touches = source.code.contains(piece) && !rooms.contains(&source.room.as_str());
            assert!(!touches, "{} has `{piece}`: {why}", source.path.display());
        }
    }
}

#[test]
fn the_map_names_every_room() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/architecture.md");
    let map = fs::read_to_string(path).expect("docs/architecture.md");
    for (room, _) in MAY_KNOW {
        let on_map = map.contains(&format!("| `{room}` |"));
        assert!(
            on_map || matches!(*room, "lib" | "main"),
            "docs/architecture.md lacks `{room}`"
        );
    }
}
