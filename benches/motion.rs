//! How long limited animation takes, beside the plain algorithm that computes all speeds again in each step.
//!
//!   cargo bench --bench motion [-- FRAMES…]
//!
//! Then a whole run, from BVH to BVH in memory, compared with reading and computing joint positions alone.
//!
//! 30 joints sway smoothly, with a swing now and then; 4 poses are omitted and a third of the frames held. If the plain algorithm
//! would take too long, it does fewer steps, and the time per step is compared.

#![allow(clippy::print_stdout, reason = "a benchmark prints its figures")]

#[path = "../tests/common/plain_limited.rs"]
mod plain_limited;

use std::hint::black_box;
use std::time::{Duration, Instant};

use glam::DVec3;
use okoshi::internals::limited::{Length, Options, Poses, compare, drawings, limit};
use okoshi::internals::mocap::bvh;
use okoshi::internals::mocap::{Axis, Channel, Clip, Joint, Skeleton};
use okoshi::internals::motion::PointChoice;
use okoshi::internals::motion::edit::{self, ExposureMethod, edit};
use okoshi::internals::prepare;
use plain_limited::{plain, repeats};

/// Joints of the figure.
const JOINTS: usize = 30;
/// Repetitions, of which the median is printed.
const ROUNDS: usize = 7;
/// The most speeds that the plain algorithm computes.
const MAX_SPEEDS: usize = 1 << 27;

fn main() {
    let lengths = std::env::args()
        .skip(1)
        .filter_map(|word| word.parse().ok());
    let lengths: Vec<usize> = lengths.collect();
    let lengths = if lengths.is_empty() {
        vec![129, 10_000, 100_000]
    } else {
        lengths
    };
    for frames in lengths {
        measure(frames);
        whole(frames);
    }
}

/// A clip of swaying chains, as text.
fn text(frames: usize) -> Vec<u8> {
    let turns = [Axis::Z, Axis::X, Axis::Y].map(Channel::Rotation);
    let places = [Axis::X, Axis::Y, Axis::Z].map(Channel::Position);
    let joint = |index: usize| Joint {
        name: format!("J{index}"),
        parent: (index > 0).then(|| {
            let parent = if index.is_multiple_of(5) {
                0
            } else {
                index - 1
            };
            parent.into()
        }),
        offset: DVec3::new(0.0, 12.5, 0.25),
        channels: match index {
            0 => [places, turns].concat(),
            _ => turns.to_vec(),
        },
        ends: Vec::new(),
    };
    let skeleton = Skeleton {
        joints: (0..JOINTS).map(joint).collect(),
    };
    let width = skeleton.channel_count();
    let number = |place: usize| {
        let (time, own) = ((place / width) as f64 / 24.0, (place % width) as f64);
        // The number of digits that capture systems write.
        ((20.0 * (time * (1.0 + 0.01 * own) + own).sin()) * 1e4).round() / 1e4
    };
    let values = (0..frames * width).map(number).collect();
    let mut out = Vec::new();
    let clip = Clip::new(skeleton.into(), 1.0 / 24.0, values);
    let written = bvh::write(&clip, bvh::Decimals::All, &mut out);
    assert!(written.is_ok(), "memory takes everything");
    out
}

fn read(text: &[u8]) -> Clip {
    match bvh::read_bytes(text) {
        Ok(reading) => reading.clip,
        Err(error) => panic!("what was written can be read: {error}"),
    }
}

/// Alternates both, so that other load on the machine affects both alike.
fn whole(frames: usize) {
    let text = text(frames);
    let method = ExposureMethod::Limited {
        omit: None,
        hold: None,
        length: Length::Kept,
    };
    let mut out = Vec::with_capacity(text.len() * 2);
    let mut times = [const { Vec::new() }; 2];
    for _ in 0..ROUNDS {
        let begun = Instant::now();
        black_box(read(&text).positions());
        times[0].push(begun.elapsed());
        let begun = Instant::now();
        out.clear();
        let prepared = prepare::prepare(read(&text), &prepare::Options::default());
        let edited = prepared.map(|prepared| {
            edit(
                prepared,
                &edit::Options {
                    method,
                    points: PointChoice::Seen,
                    camera: None,
                    key: None,
                },
            )
        });
        let written = edited.map(|edited| edited.write_bvh(&mut out).is_ok());
        assert_eq!(written, Ok(true));
        times[1].push(begun.elapsed());
    }
    let [floor, run] = times.map(|mut times| {
        times.sort_unstable();
        times[times.len() / 2].as_secs_f64() * 1e3
    });
    println!(
        "  whole run: {run:.1} ms; reading and positions alone {floor:.1} ms: {:.2} × as long",
        run / floor
    );
}

/// Chains of joints that sway, with a swing every five seconds.
fn motion(frames: usize) -> Vec<DVec3> {
    let mut positions = Vec::with_capacity(frames * JOINTS);
    for frame in 0..frames {
        let time = frame as f64 / 24.0;
        let into = (time % 5.0 - 2.5) * 6.0;
        let swing = 2.6 / (1.0 + (-into).exp());
        for joint in 0..JOINTS {
            let [reach, own] = [(joint % 5) as f64, joint as f64];
            let sway = 0.12 * ((0.31 + 0.017 * own) * time * std::f64::consts::TAU + own).sin();
            let angle = sway + if joint % 5 > 2 { swing } else { 0.0 };
            let walk = DVec3::new(0.0, 0.02 * (time * 7.0).sin(), 0.3 * time);
            let rest = DVec3::new((joint / 5) as f64 * 0.2, 1.0, 0.1 * sway);
            positions.push(walk + rest + DVec3::new(angle.sin(), angle.cos(), 0.0) * 0.2 * reach);
        }
    }
    positions
}

fn median(rounds: usize, mut work: impl FnMut()) -> f64 {
    let mut times: Vec<Duration> = Vec::new();
    for _ in 0..rounds {
        let begun = Instant::now();
        work();
        times.push(begun.elapsed());
    }
    times.sort_unstable();
    times[times.len() / 2].as_secs_f64() * 1e3
}

fn measure(frames: usize) {
    let positions = motion(frames);
    let usual = Options::recommended(frames);
    let fast = median(ROUNDS, || {
        drop(black_box(limit(Poses::new(&positions, JOINTS), &usual)))
    });
    let holds = usual.hold.min(MAX_SPEEDS / JOINTS / frames.max(1));
    let few = Options {
        omit: usual.omit,
        hold: holds,
        length: Length::Kept,
    };
    let steps = |options: &Options| (options.omit + options.hold) as f64;
    let mut shown = Vec::new();
    let rounds = if frames > 1000 { 1 } else { ROUNDS };
    let slow = median(rounds, || {
        shown = plain(
            &positions,
            JOINTS,
            &repeats(&positions, JOINTS),
            [few.omit, few.hold],
            true,
            None,
        )
        .shown;
    });
    let equal = limit(Poses::new(&positions, JOINTS), &few).exposure.sources == shown;
    assert!(equal, "{frames} frames: not what the plain algorithm makes");
    println!(
        "{frames} frames: {fast:.3} ms for {} steps; plain {slow:.1} ms for {}{}: {:.0} × as long",
        steps(&usual),
        steps(&few),
        if holds < usual.hold {
            ", compared per step"
        } else {
            ""
        },
        slow / steps(&few) / (fast / steps(&usual)),
    );

    let cut = limit(Poses::new(&positions, JOINTS), &usual).exposure;
    let count = cut.drawings().count();
    let mut best = None;
    let time = median(ROUNDS, || {
        best = Some(drawings(Poses::new(&positions, JOINTS), count, 8))
    });
    if let Some(best) = best {
        let over = 100.0 * (best.cost - best.bound) / best.bound.max(f64::MIN_POSITIVE);
        println!(
            "  the best {count} drawings: {time:.1} ms, at most {over:.1e} % over the least cost"
        );
    }
    for (method, error) in compare(Poses::new(&positions, JOINTS), 2.0, &cut) {
        let percent = error.percent.unwrap_or_default();
        println!(
            "  {method:?}: {} drawings, RMS {percent:.2} % of the height",
            error.drawings
        );
    }
}
