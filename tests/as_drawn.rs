//! Seen from the front, models look like their drawings, for every kind of `Shape`.
//!
//! Drawings are drawings of our own without given depths, clip art by others, and generated stacks, each with all its parts of one
//! kind. `LOOK_DIR=FOLDER cargo test --test as_drawn -- --nocapture --ignored survey` measures the drawings in a folder;
//! `tests/tools/clip_art.mjs` fills one from packages.
#![cfg(feature = "cli")]
#![allow(clippy::print_stdout, reason = "tables are for people")]

mod common;

use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;

use okoshi::FolderResolver;
use okoshi::compile::Compiled;
use okoshi::diagnostic::Code;
use okoshi::internals::bind::PartKind;
use okoshi::internals::look::{DrawnView, Instead, Look, compare, hints};
use okoshi::render::{self, Options, PosedModel, Shading};
use okoshi::resolver::{MemoryResolver, Resolver};
use resvg::tiny_skia::{Pixmap, Transform};

/// The kinds of `Shape` that are measured.
const KINDS: [&str; 5] = ["default", "inflate", "round", "roundv", "roundh"];
/// The least share of right pixels.
const LEAST: f64 = 0.99;
/// The same for each of the generated stacks, which are small and wilder than what people draw.
const LEAST_OF_STACK: f64 = 0.97;
/// The larger side of the pictures, pixels.
const SIDE: u32 = 400;
/// The larger side of the pictures of generated stacks, pixels.
const STACK_SIDE: u32 = 200;
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
        let resolver = FolderResolver::new(path.parent().unwrap_or(Path::new("")));
        Self::of(&text, &resolver, kind, SIDE)
    }

    /// Compares a drawing with its model, in pictures whose larger side has so many pixels.
    fn of(text: &str, resolver: &dyn Resolver, kind: &str, side: u32) -> Result<Self, String> {
        let end = text.rfind("</svg").ok_or("it has no end")?;
        let (before, after) = text.split_at(end);
        let string = format!(r#"<text x="-900" y="-900" font-size="5">%Shape {kind}</text>"#);
        let text = format!("{before}{string}{after}");
        let compiled = common::compiled(&text, resolver);
        if compiled.has_errors() {
            return Err(format!("{:?}", compiled.diagnostics));
        }
        let look = compare(&compiled, &text, resolver, side).map_err(|error| error.to_string())?;
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

    /// Whether the model looks like its drawing.
    fn is_right(&self) -> bool {
        self.look.right >= LEAST && self.lost().is_empty()
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
    let rows = each(&samples, |(path, kind)| {
        let name = name(path);
        let sample = Sample::new(path, kind).unwrap_or_else(|why| panic!("{name}: {why}"));
        (sample.is_right(), sample.row(&name, kind))
    });
    rows.iter().for_each(|(_, row)| println!("{row}"));
    assert_all_right(rows);
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

/// Shapes that lie over one another in many ways: beside, inside and around each other, some of them with names and hung on others.
fn stack(seed: u64) -> String {
    let mut random = fastrand::Rng::with_seed(seed);
    let mut between = |low: f64, high: f64| low + (high - low) * random.f64();
    let count = between(3.0, 11.0) as usize;
    let has_names = seed % 2 == 1;
    let mut body = String::new();
    let mut texts = String::new();
    let mut drawn: Vec<([f64; 2], f64)> = Vec::new();
    for index in 0..count {
        let (middle, size) = if index == 0 {
            ([50.0, 50.0], between(15.0, 35.0))
        } else {
            let ([x, y], size) = drawn[between(0.0, index as f64) as usize];
            let angle = between(0.0, std::f64::consts::TAU);
            let away = between(0.0, 1.2) * size;
            let middle = [x + away * angle.cos(), y + away * angle.sin()];
            (
                middle.map(|x| x.clamp(15.0, 85.0)),
                (between(0.15, 0.9) * size).max(3.0),
            )
        };
        let [x, y] = middle;
        let fill = format!(
            "#{:02x}{:02x}{:02x}",
            30 + 20 * index,
            255 - 21 * index,
            (index * 67) % 256
        );
        let style = match between(0.0, 4.0) as usize {
            0 => format!(
                r##"fill="{fill}" stroke="#101010" stroke-width="{:.1}""##,
                0.1 * size
            ),
            _ => format!(r#"fill="{fill}""#),
        };
        let wide = size * between(0.4, 1.0);
        let turn = format!(
            r#"transform="rotate({:.0} {x:.2} {y:.2})""#,
            between(0.0, 180.0)
        );
        let _ = match between(0.0, 4.0) as usize {
            0 => write!(
                body,
                r#"<circle cx="{x:.2}" cy="{y:.2}" r="{size:.2}" {style}/>"#
            ),
            1 => write!(
                body,
                r#"<ellipse cx="{x:.2}" cy="{y:.2}" rx="{wide:.2}" ry="{size:.2}" {turn} {style}/>"#
            ),
            2 => write!(
                body,
                r#"<rect x="{:.2}" y="{:.2}" width="{:.2}" height="{:.2}" rx="{:.2}" {turn} {style}/>"#,
                x - wide,
                y - size,
                2.0 * wide,
                2.0 * size,
                between(0.0, 0.5) * wide
            ),
            _ => {
                let corners = between(3.0, 9.0) as usize;
                let corners = (0..2 * corners).map(|corner| {
                    let angle = corner as f64 / corners as f64 * std::f64::consts::PI;
                    let far = if corner % 2 == 0 {
                        size
                    } else {
                        size * between(0.4, 1.0)
                    };
                    format!("{:.2},{:.2} ", x + far * angle.cos(), y + far * angle.sin())
                });
                let corners: String = corners.collect();
                write!(body, r#"<polygon points="{corners}" {style}/>"#)
            }
        };
        if has_names {
            let parent = match index {
                0 => String::new(),
                _ => format!("@P{}", between(0.0, index as f64) as usize),
            };
            let _ = write!(
                texts,
                r#"<text x="{x:.2}" y="{y:.2}" font-size="0.5" text-anchor="middle">P{index}{parent}</text>"#
            );
        }
        drawn.push((middle, size));
    }
    format!(
        r#"<svg xmlns="http://www.w3.org/2000/svg" viewBox="-10 -10 120 120">{body}{texts}</svg>"#
    )
}

#[test]
fn generated_stacks_look_like_their_drawings() {
    const COUNT: u64 = 200;
    let samples = (0..COUNT).flat_map(|seed| KINDS.map(|kind| (seed, kind)));
    let samples: Vec<(u64, &str)> = samples.collect();
    let measured = each(&samples, |(seed, kind)| {
        let sample = Sample::of(&stack(*seed), &MemoryResolver::default(), kind, STACK_SIDE);
        sample.unwrap_or_else(|why| panic!("stack {seed}: {why}"))
    });
    let of_samples = || samples.iter().zip(&measured);
    let row = |((seed, kind), sample): (&(u64, &str), &Sample)| {
        let is_right = sample.look.right >= LEAST_OF_STACK && sample.lost().is_empty();
        (is_right, sample.row(&format!("stack {seed}"), kind))
    };
    assert_all_right(of_samples().map(row).collect());
    for kind in KINDS {
        let of_kind = || of_samples().filter(|((_, other), _)| *other == kind);
        let pixels = || of_kind().map(|(_, sample)| sample.look.pixels as f64);
        let right = of_kind().map(|(_, sample)| sample.look.right * sample.look.pixels as f64);
        let share = right.sum::<f64>() / pixels().sum::<f64>();
        assert!(share >= LEAST, "{kind}: {share} of all pixels");
        let large = pixels().filter(|pixels| *pixels > 500.0).count();
        assert!(
            large * 10 > of_kind().count() * 9,
            "{kind}: only {large} are large enough"
        );
    }
}

/// The limbs of a figure that turn, with their shapes: some drawn before the trunk, some after it, with clothes and details.
const LIMBS: [(&str, &str, &str); 5] = [
    (
        "FarArm",
        "@Trunk",
        r##"<path d="M 88 74 C 110 66 150 60 168 66 C 178 70 176 84 166 86 C 146 88 112 92 90 94 Z" fill="#c98a5b"/>
        <path d="M 86 72 C 100 66 118 64 130 64 L 132 90 C 116 92 100 94 88 96 Z" fill="#7a2f8f"/>"##,
    ),
    (
        "FarLeg",
        "@Trunk",
        r##"<path d="M 84 140 L 108 140 L 112 208 L 128 210 L 128 220 L 92 220 Z" fill="#35506e"/>"##,
    ),
    (
        "NearLeg",
        "@Trunk",
        r##"<path d="M 52 138 L 78 140 L 72 208 L 88 212 L 88 222 L 50 222 Z" fill="#4a6e96"/>
        <ellipse cx="70" cy="216" rx="20" ry="8" fill="#3a2a20"/>"##,
    ),
    (
        "NearArm",
        "@Trunk",
        r##"<path d="M 72 76 C 56 66 20 66 2 74 C -8 80 -6 94 6 96 C 24 98 54 98 70 98 Z" fill="#e8ad7c"/>
        <circle cx="0" cy="85" r="11" fill="#f3c79c"/><circle cx="50" cy="84" r="4" fill="#d03030"/>"##,
    ),
    (
        "Head",
        "@Trunk",
        r##"<circle cx="82" cy="36" r="30" fill="#f0b98d"/><circle cx="72" cy="32" r="4" fill="#202020"/>
        <circle cx="94" cy="32" r="4" fill="#202020"/><path d="M 70 48 Q 82 58 96 48 Q 82 52 70 48 Z" fill="#a03040"/>"##,
    ),
];
const TRUNK: &str = r##"<path d="M 58 66 Q 82 56 108 66 L 112 150 Q 82 160 50 150 Z" fill="#9b45b2"/>
    <circle cx="82" cy="90" r="5" fill="#f2d74e"/><circle cx="82" cy="116" r="5" fill="#f2d74e"/>"##;

/// The figure, each of its limbs with this transform.
fn figure(has_strings: bool, transform: impl Fn(&str) -> String) -> String {
    let mut body = String::new();
    for (index, (name, parent, shapes)) in LIMBS.iter().enumerate() {
        if index == 2 {
            let name = if has_strings {
                "<desc>Trunk</desc>"
            } else {
                ""
            };
            let _ = write!(body, "<g>{TRUNK}{name}</g>");
        }
        let string = if has_strings {
            format!("<desc>{name}{parent}</desc>")
        } else {
            String::new()
        };
        let _ = write!(body, "<g {}>{shapes}{string}</g>", transform(name));
    }
    format!(
        r#"<svg xmlns="http://www.w3.org/2000/svg" width="320" height="360" viewBox="-70 -60 320 360">{body}</svg>"#
    )
}

/// The picture of a model as it is drawn, without light.
fn picture(view: &DrawnView) -> render::Image {
    let file = okoshi::export::to_memory(&okoshi::export::GLB, &view.scene, None);
    let bytes = file.expect("written").bytes;
    let model = render::read(&bytes, &MemoryResolver::default()).expect("a model");
    let posed = PosedModel::new(&model, &model.rest()).expect("triangles");
    let options = Options::default()
        .with_size(view.size)
        .with_shading(Shading::Unlit);
    posed.picture_of(&options, &view.sheet).expect("a picture")
}

/// A figure with one limb turned: how many pixels of the drawing turned in the same way are looked at, how many of them show the
/// same part, and how many show nothing.
fn turned(kind: &str, limb: &str, degrees: f64) -> [usize; 3] {
    let text = figure(true, |_| String::new());
    let text = text.replace("</svg>", &format!("<desc>%Shape {kind}</desc></svg>"));
    let compiled = common::compiled(&text, &MemoryResolver::default());
    assert!(!compiled.has_errors(), "{:?}", compiled.diagnostics);
    let mut view = DrawnView::new(&compiled, compiled.scene.clone(), 1.0).expect("a page");
    let named = |name: &str| {
        let nodes = &view.scene.nodes;
        nodes.position(|node| node.name == name).expect(name)
    };
    let (node, trunk) = (named(limb), named("Trunk"));
    let nodes = &mut view.scene.nodes;
    let world = nodes[trunk].translation + nodes[node].translation;
    nodes[node].rotation *= glam::DQuat::from_rotation_z(degrees.to_radians());
    let [x, y] = [
        (world - view.sheet.corner).dot(view.sheet.right) / view.sheet.pixel - 70.0,
        (view.sheet.corner - world).dot(view.sheet.up) / view.sheet.pixel - 60.0,
    ];
    let picture = picture(&view);
    let reference = figure(false, |name| {
        if name == limb {
            format!(r#"transform="rotate({:.4} {x:.4} {y:.4})""#, -degrees)
        } else {
            String::new()
        }
    });
    let tree = usvg::Tree::from_str(&reference, &usvg::Options::default()).expect("a drawing");
    let mut drawn = Pixmap::new(view.size[0], view.size[1]).expect("a pixmap");
    resvg::render(&tree, Transform::default(), &mut drawn.as_mut());
    let [width, height] = view.size.map(|side| side as usize);
    let mut counts = [0; 3];
    for (at, (pixel, own)) in picture.pixels().zip(drawn.pixels()).enumerate() {
        let (column, row) = (at % width, at / width);
        let inside = (2..width - 2).contains(&column) && (2..height - 2).contains(&row);
        let is_even = || {
            (row - 2..=row + 2).all(|row| {
                let line = &drawn.pixels()[row * width + column - 2..=row * width + column + 2];
                line.iter().all(|other| other == own)
            })
        };
        if own.alpha() < 255 || !inside || !is_even() {
            continue;
        }
        let own = [own.red(), own.green(), own.blue()];
        let apart = (0..3).map(|channel| pixel.0[channel].abs_diff(own[channel]));
        counts[0] += 1;
        counts[1] += usize::from(pixel.0[3] == 255 && apart.max() <= Some(2));
        counts[2] += usize::from(pixel.0[3] == 0);
    }
    counts
}

#[test]
fn limbs_turn_without_gaps() {
    let samples: Vec<(&str, &str, f64)> = KINDS
        .iter()
        .flat_map(|kind| LIMBS.iter().map(move |(limb, ..)| (*kind, *limb)))
        .flat_map(|(kind, limb)| [-60.0, -25.0, 25.0, 60.0].map(|turn| (kind, limb, turn)))
        .collect();
    let found = each(&samples, |(kind, limb, turn)| turned(kind, limb, *turn));
    for ((kind, limb, turn), [pixels, right, gaps]) in samples.iter().zip(&found) {
        let [right, gaps] = [right, gaps].map(|count| *count as f64 / *pixels as f64);
        println!("{kind:8} {limb:8} {turn:4}°: {right:.4} right, {gaps:.4} gaps");
        assert!(*pixels > 5_000, "{pixels} pixels");
        assert!(
            right > 0.93 && gaps < 0.001,
            "{kind} {limb} {turn}°: {right} right, {gaps} gaps"
        );
    }
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
        let picture = picture(&view);
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
fn colors_that_strings_give_are_right() {
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
    let paths = drawings(Path::new(&folder));
    let samples: Vec<(&PathBuf, &str)> = paths
        .iter()
        .flat_map(|path| KINDS.map(|kind| (path, kind)))
        .collect();
    let rows = each(&samples, |(path, kind)| {
        let name = path.file_stem().unwrap_or_default().to_string_lossy();
        let sample = Sample::new(path, kind).unwrap_or_else(|why| panic!("{name}: {why}"));
        (sample.is_right(), sample.row(&name, kind))
    });
    rows.iter().for_each(|(_, row)| println!("{row}"));
    assert_all_right(rows);
    assert!(!paths.is_empty(), "there is no drawing in {folder}");
}
