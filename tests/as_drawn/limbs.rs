//! Limbs of a figure that turn, as if they were drawn turned.

use std::fmt::Write as _;

use okoshi::internals::look::DrawnView;
use okoshi::resolver::MemoryResolver;
use resvg::tiny_skia::{Pixmap, Transform};

use crate::common;
use crate::truth::picture;
use crate::{KINDS, each};

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
    let picture = picture(&view, &MemoryResolver::default());
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
