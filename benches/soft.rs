//! How long drawings of soft shapes take: `cargo bench --bench soft [-- PARTS…]`.
//!
//! Builds two drawings whose shapes are all inflated: in one each is alone on the page, in the other half of them lie on others.
//! 10,000 shapes are to take at most 1.5 seconds. For each it prints the median and the least time of a whole process, as a user starts it, the least time as
//! a ratio to the same drawing with plates in place of balloons, and the triangles. Then a figure of 60 shapes, of which six are limbs that bend: it is to
//! take at most a quarter longer than with rigid limbs. Ends with status 1 if something takes longer.

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
/// How much longer a figure may take if its limbs bend.
const MOST_BENT: f64 = 1.25;
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
    let bent = bent();
    println!("limbs that bend take {bent:.2} times as long as rigid ones");
    if is_fast && bent <= MOST_BENT {
        return ExitCode::SUCCESS;
    }
    println!(
        "{PARTS} shapes may take {MOST} s, and limbs that bend {MOST_BENT} times as long as rigid ones"
    );
    ExitCode::FAILURE
}

/// How much longer a figure takes whose limbs bend.
fn bent() -> f64 {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let [bent, rigid, output] =
        ["bent.svg", "rigid.svg", "model.glb"].map(|name| folder.path().join(name));
    std::fs::write(&bent, figure("")).expect("room for it");
    std::fs::write(&rigid, figure(" Bend 0")).expect("room for it");
    let [bent, rigid] = [bent, rigid].map(|input| {
        let output = output.clone();
        move || timed(&mut build(&input, &output))
    });
    let [bent, rigid] = interleaved(5 * ROUNDS, [&bent, &rigid]);
    bent.least / rigid.least
}

/// A figure of 60 shapes, with six limbs of one piece; `setting` goes to the whole page.
fn figure(setting: &str) -> String {
    let mut svg = format!(
        r##"<svg xmlns="http://www.w3.org/2000/svg" width="400" height="520">
<text x="10" y="20" font-size="8">%Shape inflate{setting}</text>
<path id="tail" d="M235 270C300 300 340 260 330 200 328 190 340 190 342 200 356 280 300 330 230 300Z" fill="#a70"/>
<path id="left_arm" d="M245 130C275 140 300 200 310 250 312 268 292 272 286 256 276 220 262 180 240 165Z" fill="#eb9"/>
<path id="right_arm" d="M155 130C125 140 100 200 90 250 88 268 108 272 114 256 124 220 138 180 160 165Z" fill="#eb9"/>
<path id="left_leg" d="M205 280C212 340 214 400 214 450 220 470 250 470 250 450 252 400 250 340 244 280Z" fill="#345"/>
<path id="right_leg" d="M195 280C188 340 186 400 186 450 180 470 150 470 150 450 148 400 150 340 156 280Z" fill="#345"/>
<path id="neck" d="M185 60 188 130 212 130 215 60Z" fill="#eb9"/>
<path id="torso" d="M150 125C180 110 220 110 250 125 262 180 258 250 248 300 220 312 180 312 152 300 142 250 138 180 150 125Z"
  fill="#c33"/>
<ellipse id="head" cx="200" cy="50" rx="42" ry="44" fill="#eb9"/>
<text x="160" y="240" font-size="6">torso</text>
"##
    );
    for index in 0..52 {
        let [right, down] = [1, 2].map(|kind| turn(index, kind));
        let (x, y) = match index % 2 {
            0 => (175.0 + 50.0 * right, 25.0 + 50.0 * down),
            _ => (165.0 + 70.0 * right, 140.0 + 145.0 * down),
        };
        let [rx, ry] = [3, 4].map(|kind| 2.0 + 4.0 * turn(index, kind));
        let _ = writeln!(
            svg,
            "<ellipse cx=\"{x:.1}\" cy=\"{y:.1}\" rx=\"{rx:.1}\" ry=\"{ry:.1}\" fill=\"#333333\"/>"
        );
    }
    svg.push_str("</svg>\n");
    svg
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
