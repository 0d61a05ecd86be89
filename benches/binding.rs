//! How long it takes to find what texts mean, as a share of the build.
//!
//! `cargo bench --bench binding [-- SHAPES…]` prints, for drawings of 1,000 and 10,000 shapes with a text for three in ten: the
//! median time of binding (strings, hierarchy and joints included), that of the paper's rule, and of the whole build in memory, in
//! interleaved rounds. One drawing has its shapes side by side; in the other they are heaped up to figures, with details on them.

#![allow(clippy::print_stdout, reason = "a benchmark prints its figures")]

mod drawing;
mod sizes;

use std::fmt::Write as _;
use std::hint::black_box;
use std::time::{Duration, Instant};

use okoshi::Memo;
use okoshi::compile::{Options, compile};
use okoshi::export::{GLB, to_memory};
use okoshi::internals::bind::{bind, in_layers_of_pixels, makes_pose_layer};
use okoshi::internals::svg;
use okoshi::resolver::MemoryResolver;

use drawing::{Random, drawing};
use sizes::sizes;

#[global_allocator]
static ALLOCATOR: mimalloc::MiMalloc = mimalloc::MiMalloc;

/// How often each is done.
const ROUNDS: usize = 15;
/// The shapes of a figure.
const FIGURE: usize = 40;

fn main() {
    let sizes = sizes(std::env::args().skip(1), &[1_000, 10_000]);
    println!("shapes  texts  drawing  bind ms  paper's rule ms  build ms  share of the build");
    for size in sizes {
        measure("apart", &drawing(size).0);
        measure("heaped", &figures(size));
    }
}

/// Figures of shapes that overlap: each with a body, limbs on its border and details on what is there already.
fn figures(shapes: usize) -> String {
    let mut random = Random(3);
    let side = (shapes as f64 / FIGURE as f64).sqrt().ceil() * 300.0;
    let mut svg =
        format!("<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{side}\" height=\"{side}\">\n");
    let columns = (side / 300.0) as usize;
    for index in 0..shapes {
        let (figure, member) = (index / FIGURE, index % FIGURE);
        let corner = [figure % columns, figure / columns].map(|cell| cell as f64 * 300.0 + 150.0);
        let mut around = |reach: f64| (random.unit() - 0.5) * reach;
        let (reach, size) = match member {
            0 => (0.0, 70.0),
            1..10 => (160.0, 30.0),
            _ => (140.0, 6.0),
        };
        let [x, y] = corner.map(|middle| middle + around(reach));
        let (rx, ry) = (size + around(size), size + around(size));
        let color = random.below(0xff_ffff);
        let _ = writeln!(
            svg,
            "<ellipse cx=\"{x:.2}\" cy=\"{y:.2}\" rx=\"{rx:.2}\" ry=\"{ry:.2}\" fill=\"#{color:06x}\"/>"
        );
        if random.below(10) < 3 {
            let (x, y) = (x - rx * random.unit(), y + ry * random.unit());
            let _ = writeln!(
                svg,
                "<text x=\"{x:.2}\" y=\"{y:.2}\" font-size=\"8\">P{index}$</text>"
            );
        }
    }
    svg.push_str("</svg>\n");
    svg
}

fn measure(kind: &str, text: &str) {
    let resolver = MemoryResolver::default();
    let read = |text: &str| {
        svg::read(
            text,
            0.001,
            &resolver,
            &in_layers_of_pixels,
            &makes_pose_layer,
        )
        .0
    };
    let paper = text.replace("</svg>", "<text>%Bind center</text></svg>");
    let (meant, paper) = (read(text), read(&paper));
    let mut times: [Vec<Duration>; 3] = Default::default();
    for round in 0..=ROUNDS {
        let of_binding = [&meant, &paper]
            .map(|drawing| timed(|| black_box(bind(drawing, &Memo::none(), &mut Vec::new()))));
        let build = timed(|| {
            let compiled = compile(text, &Options::default(), &resolver);
            black_box(to_memory(&GLB, &compiled.scene, None).expect("a model"))
        });
        // The first round warms up.
        if round > 0 {
            let [own, papers] = of_binding;
            for (times, time) in times.iter_mut().zip([own, papers, build]) {
                times.push(time);
            }
        }
    }
    let [own, papers, build] = times.map(|mut times| {
        times.sort();
        times[times.len() / 2].as_secs_f64() * 1e3
    });
    println!(
        "{:>6}  {:>5}  {kind:7}  {own:>7.2}  {papers:>15.2}  {build:>8.1}  {:.3}",
        meant.shapes.len(),
        meant.labels.len(),
        own / build
    );
}

/// The time that something takes; what it makes is dropped afterwards.
fn timed<T>(work: impl FnOnce() -> T) -> Duration {
    let start = Instant::now();
    let made = work();
    let time = start.elapsed();
    drop(made);
    time
}
