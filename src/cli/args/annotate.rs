//! The arguments of `okoshi annotate`.

use std::path::PathBuf;

use clap::Args;

use super::Reading;

const EXAMPLES: &str = "\
Examples:
  okoshi annotate art.svg -o me.svg && okoshi preview me.svg
  okoshi annotate art.svg                writes the names into art.svg itself
  okoshi annotate art.svg -o - | okoshi inspect -

Heads are found by their eyes, vehicles by their wheels, limbs by where they touch the body. Each name is written as
the label of its shape or group, which programs show in their list of layers; nothing else changes, and what has a name
keeps it. The list of the names says what each hangs on, how certain it is, and why. Correct what is wrong in the
drawing, or in `okoshi preview`.";

#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(in crate::cli) struct Annotate {
    /// The drawing, an SVG file; `-` is stdin
    #[arg(value_name = "DRAWING")]
    pub(in crate::cli) drawing: PathBuf,
    /// Where to write: an .svg file, or `-` for stdout [default: the drawing itself]
    #[arg(short, long, value_name = "OUT.svg")]
    pub(in crate::cli) output: Option<PathBuf>,
    /// List the names as JSON
    #[arg(long)]
    pub(in crate::cli) json: bool,
    #[command(flatten)]
    pub(in crate::cli) reading: Reading,
}
