//! How much CPU time a picture of a film takes, of all threads together.
//!
//!   cargo bench --bench film [-- DRAWING…]
//!
//! It renders the first clip of drawings below `examples`, at 24 pictures per second and 300 × 300 pixels, without writing files: the
//! best of a few rounds. Models without a clip are turned once round. If a figure takes longer than required, the program fails;
//! much larger drawings are measured only.

#![allow(clippy::print_stdout, reason = "a benchmark prints its figures")]

use std::path::Path;
use std::process::ExitCode;
use std::time::Instant;

use okoshi::FolderResolver;
use okoshi::compile::{Options, compile};
use okoshi::export::{GLB, to_memory};
use okoshi::render::{self, Film, Model, PosedModel, RenderError};
use okoshi::resolver::MemoryResolver;

/// What is required of figures of up to about 40 shapes, in milliseconds a picture.
const REQUIRED: f64 = 60.0;
/// The aim, in milliseconds a picture.
const AIM: f64 = 40.0;
/// Figures.
const FIGURES: [&str; 6] = [
    "motion/kick",
    "motion/ant",
    "motion/boxer",
    "motion/beetle",
    "motion/bird",
    "motion/spider",
];
/// Drawings of 50 shapes and more.
const LARGE: [&str; 2] = ["lady", "clockwork-dragon"];
/// Repetitions, of which the fastest is printed.
const ROUNDS: usize = 3;
/// The side of a picture, in pixels.
const SIDE: u32 = 300;
/// Pictures of a turn.
const TURN: u32 = 24;

fn main() -> ExitCode {
    // cargo passes `--bench`.
    let asked: Vec<String> = std::env::args()
        .skip(1)
        .filter(|argument| argument != "--bench")
        .collect();
    let drawings: Vec<&str> = if asked.is_empty() {
        FIGURES.into_iter().chain(LARGE).collect()
    } else {
        asked.iter().map(String::as_str).collect()
    };
    let mut code = ExitCode::SUCCESS;
    for drawing in drawings {
        let model = model(drawing);
        let rounds = (0..ROUNDS).map(|_| measure(&model));
        let (time, pictures) = rounds
            .min_by(|a, b| a.0.total_cmp(&b.0))
            .expect("there are rounds");
        let shown = format!("{drawing}: {time:.1} ms for each of {pictures} pictures");
        if LARGE.contains(&drawing) {
            println!("{shown}");
            continue;
        }
        let verdict = match time {
            ..=AIM => "",
            ..=REQUIRED => ": more than the aim",
            _ => ": too long",
        };
        println!("{shown}; required {REQUIRED}, aim {AIM}{verdict}");
        if time > REQUIRED {
            code = ExitCode::FAILURE;
        }
    }
    code
}

/// The model of a drawing below `examples`.
fn model(drawing: &str) -> Model {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("examples/{drawing}.svg"));
    let text = std::fs::read_to_string(&path).expect("a drawing");
    let folder = FolderResolver::new(path.parent().expect("a folder"));
    let compiled = compile(&text, &Options::default(), &folder);
    let model = to_memory(&GLB, &compiled.scene, None).expect("a model");
    render::read(&model.bytes, &MemoryResolver::default()).expect("what was written can be read")
}

/// The milliseconds of CPU time of a picture, and the number of pictures.
fn measure(model: &Model) -> (f64, usize) {
    let options = render::Options::default()
        .with_size([SIDE; 2])
        .with_background([255; 3]);
    let mut pictures = 0;
    let count = |_| {
        pictures += 1;
        Ok::<_, RenderError>(())
    };
    let begun = cpu_seconds();
    let drawn = match model.clips().first() {
        Some(clip) => Film::new(model, clip, [0.0, clip.seconds]).and_then(|film| {
            let times = film.held_frames(24)?;
            let times: Vec<f64> = times.iter().map(|frame| frame.time).collect();
            film.shooting(&options)?.draw(times, count)
        }),
        None => PosedModel::new(model, &model.rest())
            .and_then(|posed| posed.turntable(&options, TURN, count)),
    };
    assert!(drawn.is_ok() && pictures > 0, "{drawn:?}");
    let took = cpu_seconds() - begun;
    (took * 1e3 / pictures as f64, pictures)
}

/// The CPU time of this process so far. Where the system does not tell it as Linux does, it is the time on the clock: then let
/// `RAYON_NUM_THREADS` be 1.
fn cpu_seconds() -> f64 {
    /// In hundredths of a second.
    fn ticks() -> Option<f64> {
        let stat = std::fs::read_to_string("/proc/self/stat").ok()?;
        let fields = stat.rsplit_once(')')?.1;
        // Those after the name of the program: user time and system time are the 12th and 13th.
        let times = fields.split_whitespace().skip(11).take(2);
        times
            .map(|field| field.parse::<f64>().ok())
            .sum::<Option<f64>>()
    }
    static BEGUN: std::sync::LazyLock<Instant> = std::sync::LazyLock::new(Instant::now);
    match ticks() {
        Some(ticks) => ticks / 100.0,
        None => BEGUN.elapsed().as_secs_f64(),
    }
}
