//! The command line.

use std::path::PathBuf;

use clap::builder::PossibleValue;
use clap::{Args, Parser, Subcommand, ValueEnum};

use crate::export::{EXPORTERS, extensions};
use crate::starters::Template;

mod annotate;
mod edit;
mod motion;
mod puppet;
mod render;
mod trace;
mod track;

pub(super) use annotate::Annotate;
pub(super) use edit::Edit;
pub(super) use motion::{Filming, Motion, Performing};
pub(super) use puppet::Puppet;
pub(super) use render::{Background, Bend, Projection, Render, Shading};
pub(super) use trace::Trace;
pub(super) use track::Track;

const EXAMPLES: &str = "\
Examples:
  okoshi new robot                       writes robot.svg, a drawing to start from
  okoshi trace photo.jpg                 makes a drawing of a photograph of one on paper, photo.svg
  okoshi annotate art.svg -o me.svg      gives the parts of a drawing names that nobody has named
  okoshi build human.svg                 writes human.glb beside the drawing
  okoshi build human.svg -o out/man.glb  writes it somewhere else
  okoshi check *.svg                     reports problems, writes nothing
  okoshi check --fix human.svg           corrects misspelled keywords and the like in the drawing
  okoshi render human.svg                draws a picture of the model, human.png
  okoshi watch human.svg                 builds it again on every save
  okoshi preview human.svg --open        shows it in the browser, live
  okoshi app --open                      opens a page in the browser to draw on, and to change drawings
  okoshi motion kick.bvh -o snappy.bvh   reduces a motion to limited animation, as if drawn by hand
  okoshi puppet human.svg                a sheet to cut out a puppet from, human-puppet.svg
  okoshi track puppet.gif --mark red     follows a coloured mark through a clip
  okoshi inspect human.svg               shows which string belongs to which part, and why
  okoshi explain Shape                   the manual page of a keyword
  okoshi explain E204                    the manual page of a diagnostic

A drawing is an SVG file, from Inkscape for example, with short strings beside its shapes:
`Rarm@Ubody$Shape roundv` names a shape Rarm, attaches it to Ubody and makes it a cylinder.
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

/// Options of every command.
#[derive(Debug, Clone, Copy, Args)]
pub(super) struct Common {
    /// Report errors only
    #[arg(short, long, global = true, conflicts_with = "verbose")]
    pub(super) quiet: bool,
    /// Report everything, including all hints
    #[arg(short, long, global = true)]
    pub(super) verbose: bool,
    /// When to use colours [NO_COLOR is respected]
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
    /// Make a drawing from a picture: a scan, a photograph of a drawing on paper
    Trace(Trace),
    /// Give the parts of a drawing names that nobody has named
    Annotate(Annotate),
    /// Change parts of a drawing: names, parents, attributes
    Edit(Edit),
    /// Build a model from a drawing
    Build(Build),
    /// Draw a picture of a model
    Render(Render),
    /// Report problems in drawings, and fix them with --fix
    Check(Check),
    /// Show the hierarchy of parts, and which string belongs to which part and why
    Inspect(Inspect),
    /// Show the manual page of a diagnostic, keyword or kind of shape, or an overview
    Explain {
        /// E204, Shape, roundv …
        topic: Option<String>,
    },
    /// Build drawings again whenever they are saved
    Watch(Watch),
    /// Show drawings on a live page in the browser
    Preview(Preview),
    /// Serve okoshi in the browser: a page to open, draw and change drawings on
    App(App),
    /// Edit a motion on its own: limited animation, frame rates, charts
    Motion(Motion),
    /// Write a sheet of paper pieces to cut out: a puppet of the figure, to move by hand and film
    Puppet(Puppet),
    /// Follow coloured marks through a clip, to perform a motion with them
    Track(Track),
    /// Run the language server on stdin and stdout, for editors
    ///
    /// Editors start it by themselves; docs/editors describes how to set each up. Positions are in UTF-8 or
    /// UTF-16, as the editor prefers.
    Lsp,
    /// Write a manual page, for `man`
    ///
    /// `okoshi man | man -l -` shows that of the program, `okoshi man build | man -l -` that of `okoshi build`.
    Man {
        /// The command that the page is about; without it, the program
        command: Option<String>,
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
    /// A folder that linked files may be in, besides the drawing's
    #[arg(long, value_name = "DIR")]
    pub(super) root: Option<PathBuf>,
    /// Where links start, for a drawing that is read from a copy or from stdin [default: the drawing's folder]
    #[arg(long, value_name = "DIR")]
    pub(super) base: Option<PathBuf>,
    /// How far a flattened curve may deviate, as a fraction of its part's larger side
    #[arg(long, value_name = "FRACTION", default_value_t = crate::compile::TOLERANCE, value_parser = tolerance)]
    pub(super) tolerance: f64,
}

fn tolerance(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(fraction) if (1e-6..=0.1).contains(&fraction) => Ok(fraction),
        _ => Err("expected a number from 0.000001 to 0.1, for example 0.001".to_owned()),
    }
}

#[derive(Debug, Args)]
#[command(after_help = NEW_EXAMPLES)]
pub(super) struct New {
    /// The drawing's name; `.svg` is added if it is missing, `-` is stdout
    #[arg(value_name = "NAME", required_unless_present = "list")]
    pub(super) name: Option<PathBuf>,
    /// The drawing to start from [default: the template that is called NAME, or else girl]
    #[arg(short, long, value_name = "TEMPLATE")]
    pub(super) template: Option<Template>,
    /// List the templates; terminals that show pictures show them, too
    #[arg(short, long, conflicts_with_all = ["name", "template"])]
    pub(super) list: bool,
}

const NEW_EXAMPLES: &str = "\
Examples:
  okoshi new me                     writes me.svg, a girl who walks
  okoshi new robot                  writes robot.svg, a robot, because there is a template of that name
  okoshi new rex --template dragon  writes rex.svg
  okoshi new --list                 lists the templates";

impl ValueEnum for Template {
    fn value_variants<'a>() -> &'a [Self] {
        &Self::ALL
    }

    fn to_possible_value(&self) -> Option<PossibleValue> {
        let value = PossibleValue::new(self.name());
        Some(match self.alias() {
            Some(alias) => value
                .alias(alias)
                .help(format!("{}; also `{alias}`", self.about())),
            None => value.help(self.about()),
        })
    }
}

/// The formats of models, with their descriptions.
fn formats() -> String {
    EXPORTERS
        .iter()
        .fold("Formats:\n".to_owned(), |text, exporter| {
            format!(
                "{text}  .{:<5} {}\n",
                exporter.extension(),
                exporter.description()
            )
        })
}

fn output_help() -> String {
    format!(
        "Where to write: a {} file, `-` for stdout, or a folder [default: beside the drawing]",
        extensions(|_| true)
    )
}

#[derive(Debug, Args)]
#[command(after_help = formats())]
pub(super) struct Build {
    /// The drawing, an SVG file; `-` is stdin
    #[arg(required = true, value_name = "DRAWING")]
    pub(super) drawings: Vec<PathBuf>,
    #[arg(short, long, value_name = "FILE", help = output_help())]
    pub(super) output: Option<PathBuf>,
    /// Write one skinned mesh with one joint per part, for engines that need that
    #[arg(long)]
    pub(super) skin: bool,
    /// Write whatever can be built despite errors
    #[arg(long)]
    pub(super) keep_going: bool,
    /// Write a dependency file for make that lists the files that the model is made from
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
  okoshi watch human.svg            writes human.glb now and on every save
  okoshi watch human.svg -o h.gltf  the same in another file or format
  okoshi watch drawings -o models   all drawings below a folder, including new ones
  okoshi watch human.svg --poll     where the system does not report saves: network folders, WSL

Files that a drawing links to are watched too: models, images, motions. While a drawing has errors, the last good
model stays. Press Ctrl-C to stop; a model is never left half written.";

#[derive(Debug, Args)]
#[command(after_help = WATCH_EXAMPLES)]
pub(super) struct Watch {
    /// Drawings and folders of drawings
    #[arg(required = true, value_name = "PATH")]
    pub(super) paths: Vec<PathBuf>,
    /// The folder that models are written to, or for one drawing the file, in the format of its ending [default: beside each drawing]
    #[arg(short, long, value_name = "DIR|FILE")]
    pub(super) output: Option<PathBuf>,
    #[command(flatten)]
    pub(super) noticing: Noticing,
    #[command(flatten)]
    pub(super) reading: Reading,
}

const PREVIEW_EXAMPLES: &str = "\
Examples:
  okoshi preview human.svg --open   shows the model in the browser, updated on every save
  okoshi preview drawings           a gallery of all drawings below a folder

The address of the page is printed. It can be opened on this machine only. Nothing is written to disk: the page
has a button that saves the model. Press Ctrl-C to stop.";

#[derive(Debug, Args)]
#[command(after_help = PREVIEW_EXAMPLES)]
pub(super) struct Preview {
    /// A drawing, or a folder of drawings
    #[arg(value_name = "DRAWING|FOLDER")]
    pub(super) path: PathBuf,
    /// The port on 127.0.0.1; 0 takes any free one [default: 4173, or any free one]
    #[arg(long, value_name = "N")]
    pub(super) port: Option<u16>,
    /// Open the browser
    #[arg(long)]
    pub(super) open: bool,
    /// A copy of the drawing as it is in an editor: shown until the drawing is saved, and again whenever the copy is written; the page
    /// changes the copy, not the drawing
    #[arg(long, value_name = "FILE")]
    pub(super) unsaved: Option<PathBuf>,
    /// Change no file: the page has no Edit button
    #[arg(long)]
    pub(super) read_only: bool,
    #[command(flatten)]
    pub(super) noticing: Noticing,
    #[command(flatten)]
    pub(super) reading: Reading,
}

const APP_EXAMPLES: &str = "\
Examples:
  okoshi app --open      opens okoshi in the browser
  okoshi app okoshi-app  serves a folder that `bash editors/web/app.sh okoshi-app` made

The address of the page is printed. It can be opened on this machine only. Drawings are opened,
drawn, changed and saved on the page. The browser keeps them for this address, and none is sent
anywhere, not even to this server. Once it was opened, the page also opens while the server is not
running. Press Ctrl-C to stop.";

#[derive(Debug, Args)]
#[command(after_help = APP_EXAMPLES)]
pub(super) struct App {
    /// A folder that is okoshi in the browser [default: the one in this program]
    #[arg(value_name = "FOLDER")]
    pub(super) folder: Option<PathBuf>,
    /// The port on 127.0.0.1; 0 takes any free one [default: 4174, or any free one]
    #[arg(long, value_name = "N")]
    pub(super) port: Option<u16>,
    /// Open the browser
    #[arg(long)]
    pub(super) open: bool,
}

/// How changes of files are detected.
#[derive(Debug, Clone, Args)]
pub(super) struct Noticing {
    /// Check the files every MS milliseconds, for systems that do not report changes [default: 200]
    #[arg(long, value_name = "MS", num_args = 0..=1, require_equals = true, default_missing_value = "200", value_parser = clap::value_parser!(u64).range(10..=60_000))]
    pub(super) poll: Option<u64>,
}

const CHECK_EXAMPLES: &str = "\
Examples:
  okoshi check *.svg               reports problems, writes nothing
  okoshi check --fix human.svg     corrects misspelled keywords and the like in the drawing
  okoshi check --look human.svg    also says where the model, seen from the front, differs from the drawing";

#[derive(Debug, Args)]
#[command(after_help = CHECK_EXAMPLES)]
pub(super) struct Check {
    /// The drawings, SVG files; `-` is stdin
    #[arg(required = true, value_name = "DRAWING")]
    pub(super) drawings: Vec<PathBuf>,
    /// The output format
    #[arg(long, default_value = "human")]
    pub(super) format: Format,
    /// Apply the fixes that cannot change what you meant, and write the drawings; `-` writes the drawing to stdout
    #[arg(long)]
    pub(super) fix: bool,
    /// Build the models too, and say where they look different from the drawings from the front
    #[arg(long)]
    pub(super) look: bool,
    #[command(flatten)]
    pub(super) reading: Reading,
}

/// How `check` reports.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(super) enum Format {
    /// Text for people
    Human,
    /// JSON for programs
    Json,
    /// SARIF 2.1.0 for code hosts
    Sarif,
}

const INSPECT_EXAMPLES: &str = "\
Examples:
  okoshi inspect human.svg                     lists the parts, and why each has its string
  okoshi inspect --json human.svg              everything about them, for programs
  okoshi inspect human.svg --form Rarm         what can be changed about a part; `okoshi edit` changes it
  okoshi inspect boy.svg --matches pairs.png   draws which regions of a character's views belong together

In the picture of --matches, regions that okoshi takes for the same thing have the same colour and number in all views, and
regions without a partner are grey with stripes. The list of parts shows the same numbers. If two regions should be a pair
and are not, give both the same name.";

#[derive(Debug, Args)]
#[command(after_help = INSPECT_EXAMPLES)]
pub(super) struct Inspect {
    /// The drawing, an SVG file; `-` is stdin
    #[arg(value_name = "DRAWING")]
    pub(super) drawing: PathBuf,
    /// Print JSON, for programs
    #[arg(long)]
    pub(super) json: bool,
    /// Print what can be changed about a part, and what each attribute is and may be, as JSON; PART is its name, or the `id` of a
    /// shape, a text or a group that belongs to it, as `#path12`
    #[arg(long = "form", value_name = "PART", conflicts_with_all = ["json", "matches"])]
    pub(super) forms: Vec<String>,
    /// Also draw the views of characters side by side, with one colour for what is the same in all of them: a .png file, or `-`
    /// for stdout, which then shows nothing else
    #[arg(long, value_name = "OUT.png")]
    pub(super) matches: Option<PathBuf>,
    #[command(flatten)]
    pub(super) reading: Reading,
}
