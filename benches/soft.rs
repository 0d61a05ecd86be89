//! How long drawings of soft shapes take: `cargo bench --bench soft [-- PARTS…]`.
//!
//! Builds two drawings whose shapes are all inflated: in one each is alone on the page, in the other half of them lie on others.
//! 10,000 shapes are to take at most 1.5 seconds. For each it prints the median and the least time of a whole process, as a user starts it, the least time as
//! a ratio to the same drawing with plates in place of balloons, and the triangles. Ends with status 1 if they take longer.

#![allow(clippy::print_stdout, reason = "a benchmark prints its figures")]

mod process;
mod sizes;

use std::fmt::Write as _;
use std::process::ExitCode;

use process::{build, interleaved, timed, triangles};
use sizes::sizes;

/// Side of the cell that each shape has to itself, drawing units.
const CELL: f64 = 40.0;
/// The time that 10,000 shapes may take, seconds.
const MOST: f64 = 1.5;
const PARTS: usize = 10_000;
const ROUNDS: usize = 9;

fn main() -> ExitCode {
    let sizes = sizes(std::env::args().skip(1), &[PARTS]);
    println!("shapes                    ms (least)  to plates  triangles");
    let mut is_fast = true;
    for parts in sizes {
        for (name, drawing) in [("alone", alone(parts)), ("half of them laid", laid(parts))] {
            let least = measure(&format!("{parts} {name}"), &drawing);
            is_fast &= parts != PARTS || least <= MOST;
        }
    }
    if is_fast {
        return ExitCode::SUCCESS;
    }
    println!("{PARTS} shapes take more than {MOST} s");
    ExitCode::FAILURE
}

/// Builds a drawing several times, prints what was measured, and returns the least time, seconds.
fn measure(name: &str, drawing: &str) -> f64 {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let [input, plates, output] =
        ["drawing.svg", "plates.svg", "model.glb"].map(|name| folder.path().join(name));
    std::fs::write(&input, drawing).expect("room for it");
    std::fs::write(&plates, drawing.replace("inflate", "default")).expect("room for it");
    let flat = || timed(&mut build(&plates, &output));
    let soft = || timed(&mut build(&input, &output));
    let [flat, soft] = interleaved(ROUNDS, [&flat, &soft]);
    println!(
        "{name:<24}  {:>5.0} ({:>5.0})  {:>9.1}  {:>9}",
        soft.median * 1e3,
        soft.least * 1e3,
        soft.least / flat.least,
        triangles(&output),
    );
    soft.least
}

/// Ellipses, each in a cell of its own.
fn alone(parts: usize) -> String {
    page(parts, |svg, index, x, y| {
        let (rx, ry) = radii(index);
        let _ = writeln!(
            svg,
            "<ellipse cx=\"{x}\" cy=\"{y}\" rx=\"{rx:.2}\" ry=\"{ry:.2}\" fill=\"#f28c28\"/>"
        );
    })
}

/// Half as many ellipses, with a disc on each.
fn laid(parts: usize) -> String {
    page(parts / 2, |svg, index, x, y| {
        let (rx, ry) = radii(index);
        let (right, down) = (3.0 + turn(index, 3), turn(index, 4) - 0.5);
        let radius = 3.0 + 1.5 * turn(index, 5);
        let _ = writeln!(
            svg,
            "<ellipse cx=\"{x}\" cy=\"{y}\" rx=\"{rx:.2}\" ry=\"{ry:.2}\" fill=\"#f28c28\"/>\n\
             <circle cx=\"{:.2}\" cy=\"{:.2}\" r=\"{radius:.2}\" fill=\"#333333\"/>",
            x + right,
            y + 2.0 * down,
        );
    })
}

fn page(cells: usize, each: impl Fn(&mut String, usize, f64, f64)) -> String {
    let columns = (cells as f64).sqrt().ceil();
    let side = columns * CELL;
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{side}\" height=\"{side}\" viewBox=\"0 0 {side} {side}\">\n\
         <text x=\"2\" y=\"4\" font-size=\"4\">%Shape inflate</text>\n"
    );
    for index in 0..cells {
        let x = (index as f64 % columns + 0.5) * CELL;
        let y = ((index as f64 / columns).floor() + 0.5) * CELL;
        each(&mut svg, index, x, y);
    }
    svg.push_str("</svg>\n");
    svg
}

fn radii(index: usize) -> (f64, f64) {
    (12.0 + 6.0 * turn(index, 1), 12.0 + 6.0 * turn(index, 2))
}

/// Numbers from 0 to 1 that are spread evenly: multiples of the golden ratio and others.
fn turn(index: usize, kind: u32) -> f64 {
    let ratio = 1.0 / 1.618_033_988_75_f64.powi(kind as i32);
    (index as f64 * ratio).fract()
}
