//! The command line.

use std::path::PathBuf;

use clap::{Args, Parser, Subcommand, ValueEnum};

const EXAMPLES: &str = "\
Examples:
  okoshi new robot                       writes robot.svg, a drawing to begin with
  okoshi build human.svg                 writes human.glb beside the drawing
  okoshi build human.svg -o out/man.glb  writes it elsewhere
  okoshi check *.svg                     says what is wrong, writes nothing
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
    /// Say what is wrong with drawings; write nothing
    Check(Check),
    /// Show the hierarchy, and who is bound to what and why
    Inspect(Inspect),
    /// The manual: of a diagnostic, a keyword, a kind of shape, or an overview
    Explain {
        /// E204, Shape, roundv …
        topic: Option<String>,
    },
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
        _ => Err("a number from 0.000001 to 0.1 is due, 0.001 for example".to_owned()),
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
