//! Generated drawings of shapes that lie over one another.

use std::fmt::Write as _;
use std::ops::Range;

use crate::sample::Sample;
use crate::{KINDS, LEAST, assert_all_right, each, kinds_in_turn};

/// The least share of right pixels of a single stack: stacks are small and wilder than what people draw.
const LEAST_OF_STACK: f64 = 0.97;
/// The larger side of the pictures, pixels.
const SIDE: u32 = 200;
/// The stacks that were looked at while the rules for depths were written.
const FITTED: Range<u64> = 0..200;
/// Stacks that nobody has looked at.
const HELD_BACK: Range<u64> = 9_000..9_100;

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

/// Measures the stacks with these seeds, each of them with so many kinds in turn.
fn check(seeds: Range<u64>, kinds: usize) {
    let of_seed = |seed: u64| kinds_in_turn(seed as usize, kinds).map(move |kind| (seed, kind));
    let samples: Vec<(u64, &str)> = seeds.flat_map(of_seed).collect();
    let measured = each(&samples, |(seed, kind)| {
        let sample = Sample::of(&stack(*seed), kind, SIDE);
        sample.unwrap_or_else(|why| panic!("stack {seed}: {why}"))
    });
    let of_samples = || samples.iter().zip(&measured);
    let row = |((seed, kind), sample): (&(u64, &str), &Sample)| {
        let is_right = sample.is_right(LEAST_OF_STACK);
        (is_right, sample.row(&format!("stack {seed}"), kind))
    };
    assert_all_right(of_samples().map(row).collect());
    for kind in KINDS {
        let of_kind = || of_samples().filter(|((_, other), _)| *other == kind);
        let sum = |count: fn(&Sample) -> usize| {
            of_kind().map(|(_, sample)| count(sample)).sum::<usize>() as f64
        };
        let share = sum(|sample| sample.truth.right) / sum(|sample| sample.truth.pixels);
        println!("stacks, {kind:8} {:.2} % right", share * 100.0);
        assert!(share >= LEAST, "{kind}: {share} of all pixels");
        let large = of_kind()
            .filter(|(_, sample)| sample.truth.pixels > 500)
            .count();
        assert!(
            large * 10 > of_kind().count() * 9,
            "{kind}: only {large} are large enough"
        );
    }
}

#[test]
fn generated_stacks_look_like_their_drawings() {
    check(FITTED, 1);
}

#[test]
fn generated_stacks_that_nobody_has_looked_at_look_like_their_drawings() {
    check(HELD_BACK, 2);
}
