//! Seen from the front, models look like their drawings, for every kind of `Shape`.
//!
//! Drawings are drawings of our own without given depths, and clip art by others, each with all its parts of one kind.
//! `cargo test --test as_drawn -- --nocapture --ignored table` prints how all of them look for all kinds, and
//! `LOOK_DIR=FOLDER cargo test --test as_drawn -- --nocapture --ignored survey` does so for the drawings in a folder.
#![allow(clippy::print_stdout, reason = "tables are for people")]

mod common;

use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

use okoshi::bind::PartKind;
use okoshi::compile::Compiled;
use okoshi::diagnostic::Code;
use okoshi::disk::FolderResolver;
use okoshi::look::{DrawnView, Instead, Look, compare, hints};
use okoshi::render::{self, Options, PosedModel, Shading};
use okoshi::resolver::MemoryResolver;
use rayon::prelude::*;
use resvg::tiny_skia::{Pixmap, Transform};

/// The kinds of `Shape` that are measured.
const KINDS: [&str; 5] = ["default", "inflate", "round", "roundv", "roundh"];
/// The least share of right pixels.
const LEAST: f64 = 0.99;
/// The larger side of the pictures, pixels.
const SIDE: u32 = 400;
/// Parts with fewer pixels in the drawing are not looked for.
const LEAST_PIXELS: usize = 40;
/// A part of which a smaller share is right is lost.
const LOST: f64 = 0.5;

/// A drawing whose parts are of one kind unless their own strings say otherwise, and how it looks.
struct Sample {
    compiled: Compiled,
    look: Look,
}

impl Sample {
    /// Compares a drawing with its model; the reason if that is not possible.
    fn new(path: &Path, kind: &str) -> Result<Self, String> {
        let text = fs::read_to_string(path).map_err(|error| error.to_string())?;
        let end = text.rfind("</svg").ok_or("it has no end")?;
        let (before, after) = text.split_at(end);
        let string = format!(r#"<text x="-900" y="-900" font-size="5">%Shape {kind}</text>"#);
        let text = format!("{before}{string}{after}");
        let resolver = FolderResolver::new(path.parent().unwrap_or(Path::new("")));
        let compiled = common::compiled(&text, &resolver);
        if compiled.has_errors() {
            return Err(format!("{:?}", compiled.diagnostics));
        }
        let look = compare(&compiled, &text, &resolver, SIDE).map_err(|error| error.to_string())?;
        Ok(Self { compiled, look })
    }

    /// The names of the parts that are lost.
    fn lost(&self) -> Vec<String> {
        let parts = self.look.parts.iter();
        let lost = parts.filter(|part| part.pixels > LEAST_PIXELS && part.share() < LOST);
        let Compiled {
            bindings, drawing, ..
        } = &self.compiled;
        lost.map(|part| bindings.describe(drawing, part.part))
            .collect()
    }

    /// A row of the table.
    fn row(&self, name: &str, kind: &str) -> String {
        let (look, lost) = (&self.look, self.lost());
        let mut row = format!(
            "{name:36} {kind:8} {:7.2} % of {:6} pixels, {:3} lost of {:3}",
            look.right * 100.0,
            look.pixels,
            lost.len(),
            look.parts.len()
        );
        if !lost.is_empty() {
            let _ = write!(row, ": {}", lost[..lost.len().min(3)].join(", "));
        }
        row
    }
}

/// Whether a drawing leaves the depths of all parts to the program, and has parts.
fn is_free(compiled: &Compiled) -> bool {
    let parts = &compiled.bindings.parts;
    let built = |index: &usize| matches!(parts[*index].kind, PartKind::Main | PartKind::Sub);
    let mut built = (0..parts.len()).filter(built).peekable();
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
    let drawings = free_drawings();
    assert!(drawings.len() > 15, "only {} were found", drawings.len());
    let samples = drawings
        .iter()
        .flat_map(|path| KINDS.map(|kind| (path, kind)));
    let samples: Vec<(&PathBuf, &str)> = samples.collect();
    let measured = samples.par_iter().map(|(path, kind)| {
        let name = name(path);
        let sample = Sample::new(path, kind).unwrap_or_else(|why| panic!("{name}: {why}"));
        let is_right = sample.look.right >= LEAST && sample.lost().is_empty();
        (is_right, sample.row(&name, kind))
    });
    let rows: Vec<(bool, String)> = measured.collect();
    rows.iter().for_each(|(_, row)| println!("{row}"));
    let wrong = rows.into_iter().filter(|(is_right, _)| !is_right);
    let wrong: Vec<String> = wrong.map(|(_, row)| row).collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// A drawing on a page that does not begin at the origin.
fn page(body: &str) -> String {
    format!(
        r#"<svg xmlns="http://www.w3.org/2000/svg" width="300mm" viewBox="-20 10 100 80.5">{body}</svg>"#
    )
}

/// Compiles and compares a drawing without links.
fn looked_at(text: &str) -> (Compiled, Look) {
    let resolver = MemoryResolver::default();
    let compiled = common::compiled(text, &resolver);
    assert!(!compiled.has_errors(), "{:?}", compiled.diagnostics);
    let look = compare(&compiled, text, &resolver, 200).expect("a look");
    (compiled, look)
}

#[test]
fn the_picture_lies_on_the_drawing() {
    let shapes = r##"<rect x="-10" y="20" width="60" height="40" fill="#3060c0"/>
        <rect x="10" y="30" width="60" height="40" fill="#f0d020" opacity="0.5"/>
        <rect x="40" y="15" width="20" height="30" fill="#000000" fill-opacity="0.25"/>"##;
    for strings in ["", "%Axes +x +z -y", "%Scale 7 Ground 3 4"] {
        let text = page(&format!(
            r#"{shapes}<text x="0" y="85" font-size="5">{strings}</text>"#
        ));
        let compiled = common::compiled(&text, &MemoryResolver::default());
        assert!(!compiled.has_errors(), "{:?}", compiled.diagnostics);
        let view = DrawnView::new(&compiled, compiled.scene.clone(), 2.0).expect("a page");
        assert_eq!(view.size, [200, 161]);
        let file = okoshi::export::to_memory(&okoshi::export::GLB, &view.scene, None);
        let bytes = file.expect("written").bytes;
        let model = render::read(&bytes, &MemoryResolver::default()).expect("a model");
        let posed = PosedModel::new(&model, &model.rest()).expect("triangles");
        let options = Options {
            size: view.size,
            shading: Shading::Unlit,
            ..Options::default()
        };
        let picture = posed.picture_of(&options, &view.sheet).expect("a picture");
        let plain = text.replace("width=\"300mm\"", "width=\"100\" height=\"80.5\"");
        let tree = usvg::Tree::from_str(&plain, &usvg::Options::default()).expect("a drawing");
        let mut drawn = Pixmap::new(200, 161).expect("a pixmap");
        let twice = Transform::from_scale(2.0, 2.0);
        resvg::render(&tree, twice, &mut drawn.as_mut());
        for (at, (pixel, drawn)) in picture.pixels().zip(drawn.pixels()).enumerate() {
            let drawn = drawn.demultiply();
            let drawn = [drawn.red(), drawn.green(), drawn.blue(), drawn.alpha()];
            let apart = (0..4).map(|channel| pixel.0[channel].abs_diff(drawn[channel]));
            assert!(
                apart.max() <= Some(2),
                "{strings}: pixel {}, {}: {:?}, not {drawn:?}",
                at % 200,
                at / 200,
                pixel.0
            );
        }
    }
}

#[test]
fn what_is_not_built_is_not_compared() {
    let (_, look) = looked_at(&page(
        r##"<rect x="0" y="20" width="40" height="40" fill="#3060c0" stroke="#ff0000" stroke-width="6"/>
        <text x="20" y="40" font-size="5">Body</text>
        <rect x="50" y="20" width="20" height="20" fill="#000000"/>
        <text x="60" y="30" font-size="5">*</text>
        <path d="M 5 85 H 60" stroke="#00ff00" stroke-width="8" fill="none"/>"##,
    ));
    assert_eq!(look.right, 1.0);
    assert_eq!(look.parts.len(), 1);
    // What is near the border of the only part does not count.
    assert_eq!(look.pixels, 76 * 76);
}

#[test]
fn colours_that_strings_give_are_right() {
    let (_, look) = looked_at(&page(
        r##"<rect x="0" y="20" width="40" height="40" fill="#3060c0"/>
        <text x="20" y="40" font-size="5">Body$Color 1 0 0</text>"##,
    ));
    assert_eq!(look.right, 1.0);
}

#[test]
fn a_part_behind_another_is_reported() {
    let body = |eye: &str| {
        page(&format!(
            r##"<rect x="0" y="20" width="40" height="40" fill="#3060c0"/>
            <text x="5" y="50" font-size="5">Head$Shape default -4 4</text>
            <ellipse cx="20" cy="35" rx="9" ry="6" fill="#ff0000"/>
            <text x="20" y="35" font-size="5">Eye@Head{eye}</text>"##
        ))
    };
    let (compiled, look) = looked_at(&body("$Offset 1"));
    assert_eq!(look.right, 1.0);
    assert_eq!(hints(&compiled, &look), []);
    let (compiled, look) = looked_at(&body("$Offset -30"));
    assert!((0.8..0.98).contains(&look.right), "{}", look.right);
    let eye = look.parts[1];
    assert_eq!(eye.right, 0);
    assert_eq!(eye.instead, Some((Instead::Part(0), eye.pixels)));
    let found = hints(&compiled, &look);
    let [hint] = found.as_slice() else {
        panic!("{found:?}");
    };
    assert_eq!(hint.code, Code::LooksDifferent);
    assert_eq!(
        hint.message,
        "`Eye` shows 0 % of what is drawn of it: it is inside or behind `Head`, which is drawn before it"
    );
    let help = "take away or change the depth that is given for `Eye` and `Head`";
    assert_eq!(hint.help.as_deref(), Some(help));
}

#[test]
fn landscapes_look_as_drawn_at_their_places() {
    let (_, look) = looked_at(&page(
        r##"<g><text x="-20" y="5" font-size="5">Land$Tiles 10</text>
        <rect x="-20" y="20" width="60" height="20" fill="#4caf50"/>
        <rect x="-20" y="40" width="60" height="10" fill="#8d6e63"/></g>
        <g><text x="50" y="5" font-size="5">Isle$Tiles 5</text>
        <rect x="50" y="70" width="20" height="5" fill="#4caf50"/>
        <rect x="50" y="75" width="20" height="15" fill="#8d6e63"/></g>
        <rect x="0" y="25" width="10" height="20" fill="#ff0000"/>"##,
    ));
    assert!(look.right > 0.999, "{}", look.right);
    assert_eq!(look.parts.len(), 1);
    assert_eq!(look.parts[0].right, look.parts[0].pixels);
}

#[test]
#[ignore = "measures the drawings in the folder LOOK_DIR"]
fn survey() {
    let folder = std::env::var("LOOK_DIR").expect("LOOK_DIR names a folder");
    let mut rows = 0;
    for kind in KINDS {
        let (mut right, mut pixels, mut lost) = (0.0, 0, 0);
        for path in drawings(Path::new(&folder)) {
            let name = path.file_stem().unwrap_or_default().to_string_lossy();
            match Sample::new(&path, kind) {
                Ok(sample) => {
                    println!("{}", sample.row(&name, kind));
                    right += sample.look.right * sample.look.pixels as f64;
                    pixels += sample.look.pixels;
                    lost += sample.lost().len();
                    rows += 1;
                }
                Err(why) => println!("{name:36} {kind:8} {why}"),
            }
        }
        println!(
            "{:36} {kind:8} {:7.2} % of {pixels:6} pixels, {lost:3} lost",
            "all",
            right / pixels.max(1) as f64 * 100.0
        );
    }
    assert!(rows > 0, "there is no drawing in {folder}");
}
