//! The command line.

use std::path::PathBuf;

use clap::{Args, Parser, Subcommand, ValueEnum};

use crate::motion::limited::Camera;
use crate::motion::resample::{Range, parse_range};

mod render;

pub(super) use render::{Bend, Projection, Render, Shading};

const EXAMPLES: &str = "\
Examples:
  okoshi new robot                       writes robot.svg, a drawing to begin with
  okoshi build human.svg                 writes human.glb beside the drawing
  okoshi build human.svg -o out/man.glb  writes it elsewhere
  okoshi check *.svg                     says what is wrong, writes nothing
  okoshi render human.svg                draws a picture of the model, human.png
  okoshi watch human.svg                 builds it again at every save
  okoshi preview human.svg --open        shows it in the browser, live
  okoshi motion kick.bvh -o snappy.bvh   cuts a motion like hand-drawn animation
  okoshi inspect human.svg               shows who is bound to what, and why
  okoshi explain Shape                   the manual of a keyword
  okoshi explain E204                    the manual of a diagnostic

A drawing is an SVG file, from Inkscape for example, with short strings beside its shapes:
`Rarm@Ubody$Shape roundv` names a shape Rarm, hangs it on Ubody and makes it a cylinder.
`okoshi explain` lists everything that strings can say.";

/// Turns one annotated 2D drawing into a moving 3D model.
#[derive(Debug, Parser)]
#[command(name = "okoshi", version, about, after_help = EXAMPLES, propagate_version = true, max_term_width = 100)]
pub(super) struct Cli {
    #[command(flatten)]
    pub(super) common: Common,
    #[command(subcommand)]
    pub(super) command: Command,
}

/// What every command takes.
#[derive(Debug, Clone, Copy, Args)]
pub(super) struct Common {
    /// Say errors only
    #[arg(short, long, global = true, conflicts_with = "verbose")]
    pub(super) quiet: bool,
    /// Say everything, hints included
    #[arg(short, long, global = true)]
    pub(super) verbose: bool,
    /// When to use colours [NO_COLOR is honoured]
    #[arg(long, global = true, value_name = "WHEN", default_value = "auto")]
    pub(super) color: Color,
}

/// When to use colours.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(super) enum Color {
    /// On a terminal
    Auto,
    /// Always
    Always,
    /// Never
    Never,
}

#[derive(Debug, Subcommand)]
pub(super) enum Command {
    /// Write a starter drawing, ready to build
    New(New),
    /// Build a model from a drawing
    Build(Build),
    /// Draw a picture of a model
    Render(Render),
    /// Say what is wrong with drawings; write nothing
    Check(Check),
    /// Show the hierarchy, and who is bound to what and why
    Inspect(Inspect),
    /// The manual: of a diagnostic, a keyword, a kind of shape, or an overview
    Explain {
        /// E204, Shape, roundv …
        topic: Option<String>,
    },
    /// Build drawings again whenever they are saved
    Watch(Watch),
    /// Show drawings on a live page in the browser
    Preview(Preview),
    /// Edit a motion by itself: limited animation, other rates, charts
    Motion(Motion),
    /// Language server on stdin and stdout, for editors
    ///
    /// Editors start it by themselves; docs/editors says how each is set up. Positions are counted in
    /// UTF-8 or UTF-16, as the editor likes.
    Lsp,
    /// Write a completion script for a shell
    Completions {
        /// The shell
        shell: clap_complete::Shell,
    },
}

/// How drawings are read.
#[derive(Debug, Clone, Args)]
pub(super) struct Reading {
    /// The folder that linked files must lie in [default: the drawing's]
    #[arg(long, value_name = "DIR")]
    pub(super) root: Option<PathBuf>,
    /// How far a flattened curve may lie off, as a share of its part's larger extent
    #[arg(long, value_name = "SHARE", default_value_t = crate::compile::TOLERANCE, value_parser = tolerance)]
    pub(super) tolerance: f64,
}

fn tolerance(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(share) if (1e-6..=0.1).contains(&share) => Ok(share),
        _ => Err("expected a number from 0.000001 to 0.1, for example 0.001".to_owned()),
    }
}

#[derive(Debug, Args)]
pub(super) struct New {
    /// The drawing's name; `.svg` is added if it is missing, `-` is stdout
    #[arg(value_name = "NAME")]
    pub(super) name: PathBuf,
    /// What to begin with
    #[arg(short, long, value_name = "TEMPLATE", default_value = "human")]
    pub(super) template: Template,
}

/// The starter drawings.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(super) enum Template {
    /// A person with arms and legs that turn
    Human,
    /// A toy car, drawn from its side, with wheels on both
    Car,
    /// A landscape, drawn as a map of tiles: a hill, a pond, a house in the sea
    Island,
}

#[derive(Debug, Args)]
pub(super) struct Build {
    /// The drawing, an SVG file; `-` is stdin
    #[arg(required = true, value_name = "DRAWING")]
    pub(super) drawings: Vec<PathBuf>,
    /// Where to write: a .glb or .gltf file, `-` for stdout, or a folder [default: beside the drawing]
    #[arg(short, long, value_name = "FILE")]
    pub(super) output: Option<PathBuf>,
    /// Write one skinned mesh with a joint a part, for engines that want that
    #[arg(long)]
    pub(super) skin: bool,
    /// Write what can be made in spite of errors
    #[arg(long)]
    pub(super) keep_going: bool,
    /// Write the files that the model was made from, in make's form
    #[arg(long, value_name = "FILE")]
    pub(super) depfile: Option<PathBuf>,
    /// Print what was built and how long it took
    #[arg(long)]
    pub(super) stats: bool,
    #[command(flatten)]
    pub(super) reading: Reading,
}

const WATCH_EXAMPLES: &str = "\
Examples:
  okoshi watch human.svg            writes human.glb now, and at every save
  okoshi watch drawings -o models   all drawings below a folder, also those that come
  okoshi watch human.svg --poll     where the system does not tell of saves: network folders, WSL

What a drawing links to is watched too: models, pictures, motions. While a drawing has errors, the last good
model stays. Ctrl-C ends it; a model is never left half written.";

#[derive(Debug, Args)]
#[command(after_help = WATCH_EXAMPLES)]
pub(super) struct Watch {
    /// Drawings, and folders of drawings
    #[arg(required = true, value_name = "PATH")]
    pub(super) paths: Vec<PathBuf>,
    /// The folder that models are written to [default: beside each drawing]
    #[arg(short, long, value_name = "DIR")]
    pub(super) output: Option<PathBuf>,
    #[command(flatten)]
    pub(super) noticing: Noticing,
    #[command(flatten)]
    pub(super) reading: Reading,
}

const PREVIEW_EXAMPLES: &str = "\
Examples:
  okoshi preview human.svg --open   shows the model in the browser, and again at every save
  okoshi preview drawings           a gallery of all drawings below a folder

The page's address is printed. It is served on this machine only, and to its own page only. Nothing is written:
the page has a button for the model. Ctrl-C ends it.";

#[derive(Debug, Args)]
#[command(after_help = PREVIEW_EXAMPLES)]
pub(super) struct Preview {
    /// A drawing, or a folder of drawings
    #[arg(value_name = "DRAWING|FOLDER")]
    pub(super) path: PathBuf,
    /// The port on 127.0.0.1 [default: 4173, or any that is free]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    pub(super) port: Option<u16>,
    /// Open the browser
    #[arg(long)]
    pub(super) open: bool,
    #[command(flatten)]
    pub(super) noticing: Noticing,
    #[command(flatten)]
    pub(super) reading: Reading,
}

const MOTION_EXAMPLES: &str = "\
Examples:
  okoshi motion kick.bvh                          lists its joints, and what they are taken for
  okoshi motion kick.bvh -o snappy.bvh            limited animation: 4 drawings omitted, a third of the frames held
  okoshi motion kick.bvh -o snappy.bvh --omit 6 --hold 40
  okoshi motion kick.bvh -o kick.svg              a chart of how fast it is, and of what is omitted and held
  okoshi motion kick.bvh -o kick.glb              a model of its skeleton that plays it
  okoshi motion kick.bvh -o shot.bvh --drawings 14   the best 14 drawings for it
  okoshi motion kick.bvh -o twos.bvh --every 2    on twos
  okoshi motion take.bvh -o part.bvh --full --range 25:72 --fps 30

Motions are BVH files, as motion capture is exchanged in. First a T-pose at the beginning is left out, then the motion gets 24
frames a second, then it is cut. Frames count from 1. A drawing links to a motion by `Motion \"kick.bvh\"`.";

#[derive(Debug, Args)]
#[command(after_help = MOTION_EXAMPLES)]
pub(super) struct Motion {
    /// The motion, a BVH file; `-` is stdin
    #[arg(value_name = "IN.bvh")]
    pub(super) motion: PathBuf,
    /// Where to write: a .bvh, .glb, .gltf or .svg file, `-` for BVH on stdout [default: nowhere, the joints are listed]
    #[arg(short, long, value_name = "OUT")]
    pub(super) output: Option<PathBuf>,
    /// Drawings to omit where it is fastest [default: 4]
    #[arg(long, value_name = "N")]
    pub(super) omit: Option<usize>,
    /// Frames to hold where it is slowest [default: a third]
    #[arg(long, value_name = "N")]
    pub(super) hold: Option<usize>,
    /// Let the motion get shorter by what is omitted
    #[arg(long)]
    pub(super) shorten: bool,
    /// Shoot on twos or threes: a drawing for every N frames
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=24), conflicts_with_all = ["omit", "hold", "shorten"])]
    pub(super) every: Option<u32>,
    /// The best N drawings for the motion
    #[arg(long, value_name = "N", conflicts_with_all = ["omit", "hold", "shorten", "every"])]
    pub(super) drawings: Option<usize>,
    /// Cut nothing: every frame stays
    #[arg(long, conflicts_with_all = ["omit", "hold", "shorten", "every", "drawings"])]
    pub(super) full: bool,
    /// Compare with other ways to cut it: on twos, on threes, the best drawings
    #[arg(long)]
    pub(super) compare: bool,
    /// Frames a second
    #[arg(long, value_name = "F", default_value_t = crate::motion::prepare::FPS)]
    pub(super) fps: f64,
    /// Take a part of it: frames as they are shown, from 1, both ends within; `10:` and `:48` are open
    #[arg(long, value_name = "A:B", value_parser = range)]
    pub(super) range: Option<Range>,
    /// Keep the T-pose that it begins with
    #[arg(long)]
    pub(super) keep_rest: bool,
    /// Measure speed in the picture of a camera: degrees to the body's left, degrees up, and its distance in the
    /// file's unit for perspective
    #[arg(long, value_name = "YAW,PITCH[,DISTANCE]", value_parser = camera, allow_hyphen_values = true)]
    pub(super) camera: Option<Camera>,
    /// Write a chart of its speed beside the output, an SVG file
    #[arg(long, value_name = "FILE.svg", value_parser = plot)]
    pub(super) plot: Option<PathBuf>,
    /// Go on with the frames before a damaged one
    #[arg(long)]
    pub(super) keep_going: bool,
}

fn range(text: &str) -> Result<Range, String> {
    parse_range(text).map_err(|error| error.to_string())
}

fn plot(text: &str) -> Result<PathBuf, String> {
    match text.to_lowercase().ends_with(".svg") {
        true => Ok(PathBuf::from(text)),
        false => Err("the chart must end in .svg".to_owned()),
    }
}

fn camera(text: &str) -> Result<Camera, String> {
    let numbers: Option<Vec<f64>> = text
        .split(',')
        .map(|number| number.trim().parse().ok())
        .collect();
    let finite = numbers.filter(|numbers| numbers.iter().all(|number: &f64| number.is_finite()));
    match finite.as_deref() {
        Some([yaw, pitch]) => Ok(Camera {
            yaw: *yaw,
            pitch: *pitch,
            distance: None,
        }),
        Some([yaw, pitch, distance]) if *distance > 0.0 => Ok(Camera {
            yaw: *yaw,
            pitch: *pitch,
            distance: Some(*distance),
        }),
        _ => Err(
            "two numbers are due, `30,15` for example, or three with the camera's distance"
                .to_owned(),
        ),
    }
}

/// How changes are noticed.
#[derive(Debug, Clone, Args)]
pub(super) struct Noticing {
    /// Look at the files every so many milliseconds, where the system does not tell of changes [default: 200]
    #[arg(long, value_name = "MS", num_args = 0..=1, require_equals = true, default_missing_value = "200", value_parser = clap::value_parser!(u64).range(10..=60_000))]
    pub(super) poll: Option<u64>,
}

#[derive(Debug, Args)]
pub(super) struct Check {
    /// The drawings, SVG files; `-` is stdin
    #[arg(required = true, value_name = "DRAWING")]
    pub(super) drawings: Vec<PathBuf>,
    /// For people, for programs, or for code hosts
    #[arg(long, default_value = "human")]
    pub(super) format: Format,
    #[command(flatten)]
    pub(super) reading: Reading,
}

/// How `check` reports.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(super) enum Format {
    /// For people
    Human,
    /// For programs
    Json,
    /// SARIF 2.1.0, for code hosts
    Sarif,
}

#[derive(Debug, Args)]
pub(super) struct Inspect {
    /// The drawing, an SVG file; `-` is stdin
    #[arg(value_name = "DRAWING")]
    pub(super) drawing: PathBuf,
    /// For programs
    #[arg(long)]
    pub(super) json: bool,
    #[command(flatten)]
    pub(super) reading: Reading,
}
