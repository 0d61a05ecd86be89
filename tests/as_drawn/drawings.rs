//! Drawings of our own without given depths, and clip art by others.

use std::fs;
use std::path::{Path, PathBuf};

use okoshi::FolderResolver;
use okoshi::compile::Compiled;
use okoshi::internals::bind::{PartId, PartKind};

use crate::common;
use crate::sample::Sample;
use crate::{KINDS, LEAST, assert_all_right, each, kinds_in_turn};

/// What the models of some drawings do not show on purpose: the drawing, the ids of the elements, and the reason.
const LEFT_OUT: [(&str, &[&str], &str); 6] = [
    (
        "examples/motion/ant",
        &["rect264", "rect270", "rect276", "rect282"],
        SAMPLES,
    ),
    (
        "examples/motion/boxer",
        &["rect212", "rect218", "rect224", "rect230", "rect236"],
        SAMPLES,
    ),
    (
        "examples/motion/kick",
        &[
            "rect248", "rect254", "rect260", "rect266", "rect272", "rect278",
        ],
        SAMPLES,
    ),
    (
        "examples/motion/lamp",
        &["pose-1", "pose-2", "pose-3", "pose-4"],
        "pose layers show where parts are at other times",
    ),
    ("examples/motion/robot-ja", &["rect250"], SAMPLES),
    (
        "examples/shapes/round",
        &[
            "rect210", "rect216", "rect222", "rect228", "rect234", "rect240",
        ],
        SAMPLES,
    ),
];
const SAMPLES: &str = "samples of colours in a legend are no parts";

/// The style sheet that hides what the model of a drawing does not show on purpose.
fn sheet(name: &str) -> String {
    let of_drawing = LEFT_OUT.iter().filter(|(drawing, ..)| *drawing == name);
    let ids = of_drawing.flat_map(|(_, ids, _)| ids.iter());
    ids.map(|id| format!("#{id} {{ display: none !important }}\n"))
        .collect()
}

/// The shares of resvg's pictures are those of all other elements, so the list must stay short, and every row must be needed.
#[test]
fn little_is_left_out_on_purpose() {
    assert_eq!(LEFT_OUT.len(), 6);
    let ids = LEFT_OUT.iter().map(|(_, ids, _)| ids.len());
    assert_eq!(ids.sum::<usize>(), 26);
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    for (name, ids, why) in LEFT_OUT {
        let path = root.join(name).with_extension("svg");
        let text = fs::read_to_string(&path).expect("a drawing");
        for id in ids {
            assert!(text.contains(&format!("id=\"{id}\"")), "{name}: {id}");
        }
        let [with, without] = ["", &sheet(name)].map(|sheet| {
            let sample = Sample::new(&path, sheet, KINDS[0]).expect("a model");
            sample.truth.share()
        });
        assert!(without > with, "{name}: {with} {without}, {why}");
    }
}

/// Whether a drawing leaves the depths of all parts to the program, and has parts.
fn is_free(compiled: &Compiled) -> bool {
    let parts = &compiled.bindings.parts;
    let built = |index: &PartId| matches!(parts[*index].kind, PartKind::Main | PartKind::Sub);
    let mut built = parts.keys().filter(built).peekable();
    built.peek().is_some() && built.all(|part| compiled.bindings.given_depth(part).is_none())
}

/// All drawings in a folder, in order.
fn drawings(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).expect("a folder");
    let paths = entries.map(|entry| entry.expect("an entry").path());
    let is_drawing = |path: &PathBuf| path.extension().is_some_and(|ending| ending == "svg");
    let mut drawings: Vec<PathBuf> = paths.filter(is_drawing).collect();
    drawings.sort();
    drawings
}

/// The path of a drawing for people.
fn name(path: &Path) -> String {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let name = path.strip_prefix(root).unwrap_or(path).with_extension("");
    name.to_string_lossy().replace('\\', "/")
}

/// The drawings that leave depths to the program: ours, and clip art.
fn free_drawings() -> Vec<PathBuf> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let example = |name: &String| root.join("examples").join(name).with_extension("svg");
    let mut found: Vec<PathBuf> = common::examples().iter().map(example).collect();
    found.extend(drawings(&root.join("tests/binding/art")));
    let cases = fs::read_dir(root.join("tests/cases")).expect("a folder");
    let cases = cases.map(|case| case.expect("an entry").path());
    let mut art: Vec<PathBuf> = cases.filter(|case| name(case).contains("/art-")).collect();
    art.sort();
    found.extend(art.iter().map(|case| case.join("drawing.svg")));
    found.retain(|path| {
        let text = fs::read_to_string(path).expect("a drawing");
        let resolver = FolderResolver::new(path.parent().expect("a folder"));
        is_free(&common::compiled(&text, &resolver))
    });
    found
}

#[test]
fn models_look_like_their_drawings() {
    drawings_are_right(2);
}

#[test]
#[ignore = "takes minutes; run it after a change of how shapes become solids"]
fn models_of_all_kinds_look_like_their_drawings() {
    drawings_are_right(KINDS.len());
}

/// Measures our drawings, each of them with so many kinds in turn.
fn drawings_are_right(kinds: usize) {
    let drawings = free_drawings();
    assert!(drawings.len() > 15, "only {} were found", drawings.len());
    let of_drawing = |(index, path)| kinds_in_turn(index, kinds).map(move |kind| (path, kind));
    let samples: Vec<(&PathBuf, &str)> = drawings.iter().enumerate().flat_map(of_drawing).collect();
    let rows = each(&samples, |(path, kind)| {
        let name = name(path);
        let sample =
            Sample::new(path, &sheet(&name), kind).unwrap_or_else(|why| panic!("{name}: {why}"));
        (sample.is_right(LEAST), sample.row(&name, kind))
    });
    rows.iter().for_each(|(_, row)| println!("{row}"));
    assert_all_right(rows);
}

#[test]
#[ignore = "measures the drawings in the folder LOOK_DIR"]
fn survey() {
    let folder = std::env::var("LOOK_DIR").expect("LOOK_DIR names a folder");
    let paths = drawings(Path::new(&folder));
    let of_drawing = |(index, path)| kinds_in_turn(index, 2).map(move |kind| (path, kind));
    let samples: Vec<(&PathBuf, &str)> = paths.iter().enumerate().flat_map(of_drawing).collect();
    let rows = each(&samples, |(path, kind)| {
        let name = path.file_stem().unwrap_or_default().to_string_lossy();
        let sample =
            Sample::without_outlines(path, kind).unwrap_or_else(|why| panic!("{name}: {why}"));
        (sample.is_right(LEAST), sample.row(&name, kind))
    });
    rows.iter().for_each(|(_, row)| println!("{row}"));
    assert_all_right(rows);
    assert!(!paths.is_empty(), "there is no drawing in {folder}");
}
