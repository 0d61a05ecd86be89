//! Shapes of drawings by others.

use std::sync::Arc;

use glam::DVec2;

use super::measured::{Bent, bent_at};
use super::{check, depth};
use crate::bend::{Bend, Centerline};
use crate::bind::plate_depth;
use crate::compile::compile;
use crate::geometry::{Outline, y_up};
use crate::resolver::MemoryResolver;

/// The largest share of triangles that are turned over: some shapes have knobs and notches where they bend.
const MOST_FOLDED: f64 = 0.003;
/// How many shapes are measured.
const COUNT: usize = 40;

struct Slender {
    outline: Arc<Outline>,
    joint: DVec2,
    /// Half the thickness of a plate in its drawing.
    plate: f64,
}

/// The slender shapes of the drawings in the folder that LOOK_DIR names, as if they were limbs that hang on the middle of their drawing.
fn slender() -> Vec<Slender> {
    let folder = std::env::var_os("LOOK_DIR").expect("LOOK_DIR is a folder of drawings");
    let files = std::fs::read_dir(folder).unwrap();
    let mut files: Vec<_> = files.map(|entry| entry.unwrap().path()).collect();
    files.sort();
    let mut found = Vec::new();
    // One of each drawing in turn, so that a drawing of many alike does not count more.
    let mut by_turn: Vec<Vec<Slender>> = Vec::new();
    for file in files {
        let Ok(text) = std::fs::read_to_string(&file) else {
            continue;
        };
        let compiled = compile(&text, &Default::default(), &MemoryResolver::default());
        let parts = &compiled.bindings.parts;
        let plate = plate_depth(&compiled.drawing);
        let middle =
            parts.iter().map(|part| part.measure.center).sum::<DVec2>() / parts.len().max(1) as f64;
        let mut turn = 0;
        for part in parts {
            let is_plain = matches!(&part.outline.polygons[..], [one] if one.rings.len() == 1);
            let ends = part.measure.ends;
            let joint = if ends[0].distance(middle) < ends[1].distance(middle) {
                ends[0]
            } else {
                ends[1]
            };
            let line = Centerline::new(&part.outline, y_up(joint));
            let is_limb =
                |line: Centerline| line.is_slender() && Bend::limb(line, f64::INFINITY).fits();
            if is_plain && line.is_some_and(is_limb) {
                by_turn.resize_with(by_turn.len().max(turn + 1), Vec::new);
                by_turn[turn].push(Slender {
                    outline: Arc::clone(&part.outline),
                    joint,
                    plate,
                });
                turn += 1;
            }
        }
    }
    found.extend(by_turn.into_iter().flatten());
    println!("{} slender shapes", found.len());
    assert!(found.len() >= COUNT, "too few: {}", found.len());
    found
}

/// Measures 40 shapes. Every second one is reported for itself: what was chosen by looking at the others is judged by these.
#[test]
#[ignore = "needs drawings in LOOK_DIR"]
fn limbs_of_clip_art() {
    let found = slender();
    let chosen: Vec<&Slender> = found.iter().take(COUNT).collect();
    let limbs: Vec<[Bent; 2]> = chosen
        .iter()
        .map(|shape| {
            ["inflate", "default"].map(|kind| {
                bent_at(&shape.outline, shape.joint, kind, shape.plate, |line| {
                    Bend::limb(line, depth(kind, shape.plate))
                })
            })
        })
        .collect();
    for (name, first) in [("seen", 0), ("held back", 1)] {
        println!("{name}:");
        check(limbs.iter().skip(first).step_by(2).flatten(), MOST_FOLDED);
    }
}
