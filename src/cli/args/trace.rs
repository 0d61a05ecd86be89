//! The arguments of `okoshi trace`.

use std::path::PathBuf;

use clap::Args;

const EXAMPLES: &str = "\
Examples:
  okoshi trace robot.jpg                 writes robot.svg: a shape for each region of the picture
  okoshi trace robot.jpg && okoshi annotate robot.svg && okoshi preview robot.svg
  okoshi trace scan.png -o - | okoshi annotate - -o hero.svg

A photograph of a drawing on paper is straightened if the whole sheet is in it, and its shadows are evened out. Draw with
dark, closed outlines or in solid colours, on light paper; each area of one colour becomes a shape. Then `okoshi
annotate` gives the shapes names, and strings make them move.";

#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(in crate::cli) struct Trace {
    /// The picture: PNG, JPEG, GIF or WebP
    #[arg(value_name = "PICTURE")]
    pub(in crate::cli) picture: PathBuf,
    /// Where to write: a new .svg file, or `-` for stdout [default: beside the picture]
    #[arg(short, long, value_name = "OUT.svg")]
    pub(in crate::cli) output: Option<PathBuf>,
}
