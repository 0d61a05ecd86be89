//! The drawings in `examples/`: they compile without warnings, are in the gallery or on the page of the lesson that they belong to, and show
//! their features.
#![cfg(feature = "cli")]

mod common;

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

use common::program::Room;
use common::{Node, examples};
use okoshi::FolderResolver;
use okoshi::diagnostic::{Code, Severity};
use okoshi::internals::lang::keyword::kinds::KINDS;
use okoshi::internals::look::compare;
use serde_json::Value;

/// The size limit of pictures in the gallery, bytes.
const PICTURE: u64 = 60 << 10;
/// The size limit of pictures of lessons, bytes: their pages have many.
const LESSON_PICTURE: u64 = 40 << 10;
/// The folders of drawings that are not in the gallery but in a lesson: docs/FOLDER.md shows them, with pictures in docs/FOLDER.
const LESSONS: [&str; 2] = ["tutorial", "how-to"];

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn drawing(name: &str) -> PathBuf {
    root().join("examples").join(format!("{name}.svg"))
}

fn nodes(name: &str) -> Vec<Node> {
    let path = drawing(name);
    let text = fs::read_to_string(&path).expect("a drawing");
    let folder = path.parent().expect("a folder");
    let compiled = common::compiled(&text, &FolderResolver::new(folder));
    for diagnostic in &compiled.diagnostics {
        // Keywords of later versions are reported as not built yet.
        assert!(
            diagnostic.severity() == Severity::Hint || diagnostic.code == Code::NotBuiltYet,
            "{name}: {}",
            diagnostic.message
        );
    }
    common::nodes(&common::glb(&compiled)).expect("a valid model")
}

#[test]
fn nothing_is_wrong_with_the_examples() {
    for name in examples() {
        let nodes = nodes(&name);
        common::check_laws(&nodes).unwrap_or_else(|error| panic!("{name}: {error}"));
        assert_eq!(common::repeated_name(&nodes), None, "{name}");
        assert!(nodes.len() > 1, "{name} has no parts");
    }
}

/// The lesson that a drawing belongs to.
fn lesson(name: &str) -> Option<&str> {
    let (folder, _) = name.split_once('/')?;
    LESSONS.contains(&folder).then_some(folder)
}

#[test]
fn inkscape_saved_them() {
    for name in examples() {
        let text = fs::read_to_string(drawing(&name)).expect("a drawing");
        let file = name.rsplit('/').next().unwrap_or(&name);
        let document = format!("sodipodi:docname=\"{file}.svg\"");
        let mut pieces = vec![&*document, "inkscape:groupmode=\"layer\""];
        // A lesson begins without any string.
        if text.contains("<text") || lesson(&name).is_none() {
            pieces.push("sodipodi:role=\"line\"");
        }
        for piece in pieces {
            assert!(text.contains(piece), "{name} lacks {piece}");
        }
    }
}

#[test]
fn every_kind_of_shape_has_a_drawing() {
    let examples = examples();
    for kind in &KINDS {
        let name = format!("shapes/{}", kind.name);
        assert!(examples.contains(&name), "there is no examples/{name}.svg");
        let text = fs::read_to_string(drawing(&name)).expect("a drawing");
        assert!(text.contains(kind.name), "{name} does not use its kind");
    }
}

#[test]
fn the_gallery_shows_every_example() {
    let gallery = fs::read_to_string(root().join("docs/gallery.md")).expect("the gallery");
    let mut pictures = BTreeSet::new();
    let in_gallery = |name: &String| lesson(name).is_none();
    for name in examples().into_iter().filter(in_gallery) {
        assert!(
            gallery.contains(&format!("](../examples/{name}.svg)")),
            "docs/gallery.md lacks examples/{name}.svg"
        );
        for side in ["drawing", "model"] {
            let file = format!("{}-{side}.png", name.replace('/', "-"));
            assert!(
                gallery.contains(&format!("](gallery/{file})")),
                "docs/gallery.md lacks {file}"
            );
            let path = root().join("docs/gallery").join(&file);
            let size = fs::metadata(&path).map_or(0, |data| data.len());
            assert!(
                (1..=PICTURE).contains(&size),
                "{file} has {size} bytes; `bash tests/tools/gallery.sh` makes it"
            );
            pictures.insert(file);
        }
    }
    for entry in fs::read_dir(root().join("docs/gallery")).expect("the pictures") {
        let file = entry.expect("an entry").file_name();
        let file = file.to_string_lossy();
        assert!(pictures.contains(&*file), "{file} is of no example");
    }
}

#[test]
fn lessons_show_their_drawings() {
    for folder in LESSONS {
        let page = root().join(format!("docs/{folder}.md"));
        let page = fs::read_to_string(page).expect("the page");
        let mut drawings = 0;
        for name in examples()
            .iter()
            .filter(|name| lesson(name) == Some(folder))
        {
            drawings += 1;
            for link in [
                format!("](../examples/{name}.svg)"),
                format!("]({name}.png)"),
            ] {
                assert!(page.contains(&link), "docs/{folder}.md lacks {link}");
            }
        }
        assert!(drawings > 3, "{folder} has only {drawings} drawings");
        let mut pictures = 0;
        for entry in fs::read_dir(root().join("docs").join(folder)).expect("the pictures") {
            let path = entry.expect("an entry").path();
            let file = path.file_name().unwrap_or_default().to_string_lossy();
            assert!(
                page.contains(&format!("]({folder}/{file})")),
                "docs/{folder}.md does not show {file}"
            );
            let size = fs::metadata(&path).map_or(0, |data| data.len());
            assert!(
                (1..=LESSON_PICTURE).contains(&size),
                "{file} has {size} bytes; `bash tests/tools/tutorial.sh` makes it"
            );
            pictures += 1;
        }
        assert!(pictures >= drawings, "{folder}: {pictures} pictures");
    }
}

/// People among the examples.
const PEOPLE: [&str; 12] = [
    "girl",
    "human",
    "lady",
    "characters/boy",
    "characters/robot",
    "motion/boxer",
    "motion/girl",
    "motion/kick",
    "motion/knight",
    "motion/robot-ja",
    "motion/trousers",
    "tutorial/7-walk",
];

#[test]
fn people_and_maps_are_of_one_measure() {
    let mut maps = 0;
    for name in examples() {
        let path = drawing(&name);
        let path = path.to_str().expect("a path in UTF-8");
        let run = Room::new().run(&["inspect", "--json", path]);
        assert_eq!(run.status, 0, "{name}: {}", run.err);
        let report: Value = serde_json::from_str(&run.out).expect("JSON");
        if PEOPLE.contains(&&*name) {
            let height = report["size_in_metres"]["height"].as_f64();
            let height = height.unwrap_or_else(|| panic!("{name} has no height"));
            assert!((1.3..=2.15).contains(&height), "{name}: {height} m");
        }
        let text = fs::read_to_string(path).expect("a drawing");
        let scale = text.split_once("%Scale ").map_or("1", |(_, rest)| {
            rest.split('<').next().expect("a first piece")
        });
        for map in report["terrain"].as_array().into_iter().flatten() {
            maps += 1;
            let tile = map["tile"].as_f64().expect("the side of a tile");
            let scale: f64 = scale.parse().expect("a number");
            assert_eq!(tile * scale, 100.0, "{name}: centimetres of a tile");
        }
    }
    assert!(maps >= 16, "only {maps} maps");
}

/// The smallest and largest coordinates of a node's solids, in its own frame.
fn bounds(node: &Node) -> [[f32; 3]; 2] {
    let mut bounds = [[f32::INFINITY; 3], [f32::NEG_INFINITY; 3]];
    let corners = node.primitives.iter().flat_map(|solid| &solid.positions);
    for corner in corners {
        for axis in 0..3 {
            bounds[0][axis] = bounds[0][axis].min(corner[axis]);
            bounds[1][axis] = bounds[1][axis].max(corner[axis]);
        }
    }
    bounds
}

fn near(a: f32, b: f32) -> bool {
    (a - b).abs() < 1e-4
}

#[test]
fn the_cars_doors_and_tyres_are_on_both_sides() {
    let nodes = nodes("car");
    let named = |name: &str| {
        let found = nodes.iter().find(|node| node.name == name);
        found.unwrap_or_else(|| panic!("there is no `{name}`"))
    };
    // `Scale 1.25`: a unit of the drawing is 1.25 cm.
    let meters = |units: f32| units * 0.0125;
    for door in ["RearDoor", "FrontDoor"] {
        let [low, high] = bounds(named(door));
        assert!(near(high[2], -low[2]), "{door}: {low:?} {high:?}");
        assert!(high[2] >= meters(50.0), "{door}: {high:?}");
    }
    for (name, side) in [
        ("RearTyre", 1.0),
        ("FrontTyre", 1.0),
        ("RearTyre.back", -1.0),
        ("FrontTyre.back", -1.0),
    ] {
        let tyre = named(name);
        assert_eq!(tyre.parent.as_deref(), Some("Body"), "{name}");
        assert!(near(tyre.translation[2], side * meters(45.0)), "{name}");
        let [low, high] = bounds(tyre);
        for axis in 0..3 {
            assert!(near(high[axis], -low[axis]), "{name}: {low:?} {high:?}");
        }
        assert!(near(high[2], meters(5.0)), "{name}: {high:?}");
        assert!(near(high[0], meters(22.0)), "{name}: {high:?}");
    }
}

#[test]
fn the_dragon_is_rich() {
    let nodes = nodes("clockwork-dragon");
    assert!(nodes.len() >= 50, "{} nodes", nodes.len());
    let mut place = "Flame";
    let mut depth = 0;
    while let Some(parent) = nodes
        .iter()
        .find(|node| node.name == place)
        .and_then(|node| node.parent.as_deref())
    {
        place = parent;
        depth += 1;
    }
    // Chest, five pieces of neck, head, jaw, under the root.
    assert!(depth >= 9, "{depth}");
    assert!(nodes.iter().any(|node| node.name == "Finger4.back"));
}

#[test]
fn key_poses_are_not_compared_with_the_model() {
    let text = fs::read_to_string(drawing("motion/lamp")).expect("a drawing");
    let resolver = FolderResolver::new(root());
    let look = |text: &str| {
        let compiled = common::compiled(text, &resolver);
        compare(&compiled, text, &resolver, 400).expect("a look")
    };
    let poses = text.find("<g\n     id=\"pose-1\"").expect("a pose layer");
    let without = format!("{}</svg>", &text[..poses]);
    assert_eq!(look(&text), look(&without));
}
