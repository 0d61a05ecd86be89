//! How many frames a second marks are tracked in, on one core.
//!
//!   cargo bench --bench tracking
//!
//! Four discs before clutter, at 640 × 480 pixels, with noise and motion blur. Frames are in memory; what decoding them takes is not counted.

#![allow(clippy::print_stdout, reason = "a benchmark prints its figures")]

#[path = "../tests/tracking/synthetic.rs"]
#[allow(dead_code, reason = "the tests use all of it")]
mod synthetic;

use std::time::Instant;

use okoshi::internals::tracking::{Frame, Learner, Mark, Tracker};
use synthetic::{Disc, FITTED, Scene, ellipse};

/// Frames of the clip.
const FRAMES: usize = 120;
/// Repetitions, of which the fastest is printed.
const ROUNDS: usize = 5;

fn main() {
    let scene = Scene {
        seeds: FITTED,
        size: [640, 480],
        discs: vec![
            Disc::new(("red", [205, 40, 45]), 16.0, |time| {
                ellipse(time, [320.0, 240.0], [220.0, 140.0], 25.0, 0.0)
            }),
            Disc::new(("green", [40, 150, 60]), 14.0, |time| {
                ellipse(time, [300.0, 220.0], [120.0, 180.0], 15.0, 0.3)
            }),
            Disc::new(("blue", [40, 70, 190]), 18.0, |time| {
                ellipse(time, [340.0, 260.0], [240.0, 80.0], 20.0, 0.6)
            }),
            Disc::new(("yellow", [225, 205, 40]), 12.0, |time| {
                ellipse(time, [280.0, 240.0], [80.0, 80.0], 8.0, 0.5)
            }),
        ],
        colorful: 14,
        patches: vec![[205, 40, 45], [40, 150, 60]],
        noise: 6.0,
        shutter: 0.5,
        light: |_| 1.0,
    };
    let background = scene.background();
    let frames: Vec<Vec<u8>> = (0..FRAMES)
        .map(|frame| scene.frame(&background, frame))
        .collect();
    let frames: Vec<Frame<'_>> = frames
        .iter()
        .filter_map(|pixels| Frame::new(scene.size, pixels))
        .collect();
    let mut best = [f64::INFINITY; 2];
    let mut found = 0;
    for _ in 0..ROUNDS {
        let marks = scene
            .discs
            .iter()
            .map(|disc| Mark::new(disc.mark.0, disc.mark.1));
        let marks = marks.collect::<Result<_, _>>().expect("they are coloured");
        let start = Instant::now();
        let mut learner = Learner::new(scene.size, marks);
        frames.iter().for_each(|frame| learner.push(*frame));
        let learned = learner.learned().expect("they are in the clip");
        best[0] = best[0].min(start.elapsed().as_secs_f64());
        let start = Instant::now();
        let mut tracker = Tracker::new(learned);
        let sightings = frames.iter().map(|frame| tracker.push(*frame));
        found = sightings.map(|marks| marks.iter().flatten().count()).sum();
        best[1] = best[1].min(start.elapsed().as_secs_f64());
    }
    let [learning, tracking] = best;
    let count = FRAMES as f64;
    println!("{FRAMES} frames of 640 × 480 pixels with 4 marks, on one core:");
    println!(
        "  tracking: {:.0} frames a second, marks found in {found} of {}",
        count / tracking,
        4 * FRAMES
    );
    println!(
        "  learning before: {:.0} ms for the clip",
        1000.0 * learning
    );
    println!(
        "  both: {:.0} frames a second",
        count / (learning + tracking)
    );
}
