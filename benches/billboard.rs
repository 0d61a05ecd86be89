//! How long a character in two large pictures takes, stage by stage and as a whole, beside decoding the pictures and filling their
//! areas of equal colour with the plain flood fill.
//!
//!   cargo bench --bench billboard [-- SIDE…]
//!
//! Each picture shows 25 regions. The stages are called on their own; the whole is a compile with the
//! writing of the model into memory.

#![allow(clippy::print_stdout, reason = "a benchmark prints its figures")]
use std::io::Cursor;
use std::time::{Duration, Instant};

use image::{Rgba, RgbaImage};
use okoshi::compile::{Options, compile};
use okoshi::internals::billboard::stages;
use okoshi::resolver::MemoryResolver;

/// Repetitions, of which the median is printed.
const ROUNDS: usize = 7;

/// The times of several steps, in the order in which they came first.
#[derive(Default)]
struct Medians(Vec<(&'static str, Vec<Duration>)>);

impl Medians {
    fn add<T>(&mut self, step: &'static str, work: impl FnOnce() -> T) -> T {
        let (time, done) = timed(work);
        match self.0.iter_mut().find(|(known, _)| *known == step) {
            Some((_, times)) => times.push(time),
            None => self.0.push((step, vec![time])),
        }
        done
    }

    /// The median of a step, milliseconds.
    fn of(&self, step: &str) -> f64 {
        let found = self.0.iter().find(|(known, _)| *known == step);
        let mut times = found.map(|(_, times)| times.clone()).unwrap_or_default();
        times.sort_unstable();
        times
            .get(times.len() / 2)
            .map_or(f64::NAN, |time| time.as_secs_f64() * 1e3)
    }
}

fn timed<T>(work: impl FnOnce() -> T) -> (Duration, T) {
    let begun = Instant::now();
    let done = work();
    (begun.elapsed(), done)
}

fn main() {
    let sides = std::env::args()
        .skip(1)
        .filter_map(|word| word.parse().ok());
    let sides: Vec<u32> = sides.collect();
    let sides = if sides.is_empty() { vec![1000] } else { sides };
    for side in sides {
        measure(side);
    }
}

/// Adds the times of the stages from two decoded pictures to the shapes. Returns how many regions were found, and how many tracks.
fn add_stages(pictures: &[RgbaImage; 2], times: &mut Medians) -> [usize; 2] {
    let found = times.add("segment", || stages::segment(pictures));
    let matched = times.add("match", || stages::match_regions(&found));
    times.add("place", || stages::place(&found, &matched));
    times.add("morph and triangulate", || stages::shape(&found, &matched));
    [stages::region_count(&found), stages::track_count(&matched)]
}

/// A round trunk, a head, 23 spots that turn with them, and soft edges.
fn drawing(side: u32, theta: f64) -> RgbaImage {
    // Per spot its centre and radius, shares of the side; spots lie on the surfaces of two balls.
    let (sin, cos) = theta.to_radians().sin_cos();
    let mut discs = vec![([0.5, 0.68], [0.3, 0.3], [90, 140, 210])];
    discs.push(([0.5, 0.26], [0.22, 0.22], [250, 200, 150]));
    for index in 0..23_u8 {
        let on_head = index < 8;
        let ([x, y], radius) = if on_head {
            ([0.5, 0.26], 0.22)
        } else {
            ([0.5, 0.68], 0.3)
        };
        let number = f64::from(index);
        // Along a spiral.
        let turn = number * 2.4;
        let out = if on_head {
            (number + 0.8) / 11.0
        } else {
            (number - 7.2) / 20.0
        };
        let out = out.sqrt() * 0.8;
        let (across, down) = (out * turn.cos() * 0.7, out * turn.sin());
        let depth = (1.0 - across * across - down * down).max(0.0).sqrt();
        let seen = across * cos - depth * sin;
        let size = 0.025 + 0.002 * f64::from(index % 5);
        let narrow = (depth * cos + across * sin).max(0.3);
        let color = [index * 11, 255 - index * 9, (index % 4) * 80];
        discs.push((
            [x + radius * seen * 0.9, y + radius * down * 0.9],
            [size * narrow, size],
            color,
        ));
    }
    RgbaImage::from_fn(side, side, |column, row| {
        let mut pixel = [0.0; 4];
        for ([x, y], [wide, high], color) in &discs {
            let at = [column, row].map(|at| (f64::from(at) + 0.5) / f64::from(side));
            let [u, v] = [(at[0] - x) / wide, (at[1] - y) / high];
            let inside = (1.0 - u.hypot(v)) * wide.min(*high) * f64::from(side) + 0.5;
            let cover = inside.clamp(0.0, 1.0);
            for (channel, own) in pixel.iter_mut().zip(color.map(f64::from)) {
                *channel += (own - *channel) * cover;
            }
            pixel[3] += (255.0 - pixel[3]) * cover;
        }
        // Straight alpha: the mixture with nothing is the colour itself.
        let alpha = pixel[3].max(1.0) / 255.0;
        let [r, g, b] = [0, 1, 2].map(|channel| (pixel[channel] / alpha).min(255.0) as u8);
        Rgba([r, g, b, pixel[3] as u8])
    })
}

fn png(picture: &RgbaImage) -> Vec<u8> {
    let mut bytes = Cursor::new(Vec::new());
    let written = picture.write_to(&mut bytes, image::ImageFormat::Png);
    written.expect("a PNG");
    bytes.into_inner()
}

/// How many areas of equal colour a picture has: a flood fill with a stack.
fn flood(picture: &RgbaImage) -> usize {
    let (width, height) = (picture.width() as usize, picture.height() as usize);
    let pixels: Vec<[u8; 4]> = picture.pixels().map(|pixel| pixel.0).collect();
    let mut area = vec![0_u32; pixels.len()];
    let mut areas = 0;
    let mut open = Vec::new();
    for start in 0..pixels.len() {
        if area[start] != 0 {
            continue;
        }
        areas += 1;
        area[start] = areas;
        open.push(start);
        while let Some(at) = open.pop() {
            let column = at % width;
            let beside = [
                (column > 0).then(|| at - 1),
                (column + 1 < width).then_some(at + 1),
                (at >= width).then(|| at - width),
                (at + width < width * height).then_some(at + width),
            ];
            for next in beside.into_iter().flatten() {
                if area[next] == 0 && pixels[next] == pixels[at] {
                    area[next] = areas;
                    open.push(next);
                }
            }
        }
    }
    areas as usize
}

fn measure(side: u32) {
    let files = [0.0, 45.0].map(|theta| png(&drawing(side, theta)));
    let view = |file: &str, theta: u32| {
        format!(
            r#"<g inkscape:groupmode="layer"><image href="{file}" width="{side}" height="{side}"/><text y="9">Who$View {theta} 0</text></g>"#
        )
    };
    let text = format!(
        r#"<svg xmlns="http://www.w3.org/2000/svg" xmlns:inkscape="http://www.inkscape.org/namespaces/inkscape" width="{side}" height="{side}">{}{}</svg>"#,
        view("front.png", 0),
        view("side.png", 45)
    );
    let resolver = MemoryResolver::default()
        .with("front.png", files[0].clone())
        .with("side.png", files[1].clone());
    let mut times = Medians::default();
    let mut found = [0; 2];
    // The first round warms up.
    for round in 0..=ROUNDS {
        if round == 1 {
            times = Medians::default();
        }
        let decode = |file: &Vec<u8>| image::load_from_memory(file).expect("a PNG").into_rgba8();
        let pictures = times.add("decode", || files.each_ref().map(decode));
        let areas = times.add("flood", || pictures.each_ref().map(flood));
        assert!(areas.iter().all(|count| *count > 25));
        found = add_stages(&pictures, &mut times);
        let compiled = times.add("compile", || compile(&text, &Options::default(), &resolver));
        assert_eq!(compiled.characters.len(), 1, "{:?}", compiled.diagnostics);
        let file = times.add("write", || {
            okoshi::export::to_memory(&okoshi::export::GLB, &compiled.scene, None)
        });
        assert!(file.is_ok());
    }
    let plain = times.of("decode") + times.of("flood");
    let whole = times.of("compile") + times.of("write");
    let [regions, tracks] = found;
    println!(
        "2 × {side} × {side} pixels, {regions} regions, {tracks} things: {whole:.0} ms, {:.1} × decoding and flood fill",
        whole / plain
    );
    for (step, _) in &times.0 {
        println!("    {step}: {:.1} ms", times.of(step));
    }
}
