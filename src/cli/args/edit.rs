//! The arguments of `okoshi edit`.

use std::path::PathBuf;

use clap::Args;

use super::Reading;
use crate::ide::changes::Change;

const EXAMPLES: &str = r##"Examples:
  okoshi edit human.svg --change '{"change": "set", "part": "Rarm", "attribute": "Shape", "value": "roundv -60 60"}'
  okoshi edit human.svg --change '{"change": "name", "part": "U-1", "name": "Rleg"}' -o me.svg
  okoshi edit human.svg --change '{"change": "hang", "part": "Head", "parent": null}' -o - | okoshi inspect -
  okoshi inspect human.svg --form Rarm   what can be changed about a part, and what each attribute may be

Changes, as JSON; parts are called as in `okoshi inspect`:
  {"change": "set", "part": …, "attribute": …, "value": …}   the attribute gets this value, written as in a string
  {"change": "reset", "part": …, "attribute": …}             the part's string no longer says the attribute
  {"change": "name", "part": …, "name": …}                   the part is called otherwise, wherever it is mentioned
  {"change": "hang", "part": …, "parent": …}                 the part hangs on another one, with null on nothing
  {"change": "leave-out", "part": …}                         the part is no longer built
  {"change": "variable", "name": …, "value": …}              a variable of `Let` gets this number
  {"change": "clip", "part": …, "clip": 0, "motion": …}      a clip of the part's figure; with null it is taken away
  {"change": "keep-pose", "turns": [{"part": …, "degrees": 40}]}
                                                             the next key pose, turned from how the parts are drawn
  {"change": "keep-movement", "moments": [{"seconds": 0, "turns": …}, …]}
                                                             key poses that show a movement
  {"change": "draw", "shape": …, "fill": "#cc4422"}          a new shape in front of the others: {"path": "M 0 0 H 20 V 30 Z"},
                                                             {"ellipse": [cx, cy, rx, ry]} or {"rect": [x, y, width, height]}
  {"change": "move", "part": …, "by": [5, -2]}               the part lies so many user units to the right and down
  {"change": "restack", "part": …, "to": "front"}            it is drawn in front of the others; also back, forward, backward
  {"change": "erase", "part": …}                             it is deleted, and its string with it
  {"change": "paint", "part": …, "fill": "#cc4422"}          its shape is drawn in this colour

Only what says it is changed, byte for byte. Several changes are made in turn, all or none. A change that is about more than its
part, or would lose a calculation, is refused with the changes that can be made instead: `"place": "own"` writes a value into the
string of the part, `"place": "legend"` into that of its legend. Then the drawing stays as it is, and the exit status is 1."##;

#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(in crate::cli) struct Edit {
    /// The drawing, an SVG file; `-` is stdin
    #[arg(value_name = "DRAWING")]
    pub(in crate::cli) drawing: PathBuf,
    /// A change; several are made in turn
    #[arg(short, long = "change", value_name = "JSON", required = true, value_parser = change)]
    pub(in crate::cli) changes: Vec<Change>,
    /// Where to write: an .svg file, or `-` for stdout [default: the drawing itself]
    #[arg(short, long, value_name = "OUT.svg")]
    pub(in crate::cli) output: Option<PathBuf>,
    /// Report what was changed, or why not and what can be done instead, as JSON
    #[arg(long)]
    pub(in crate::cli) json: bool,
    #[command(flatten)]
    pub(in crate::cli) reading: Reading,
}

fn change(text: &str) -> Result<Change, String> {
    serde_json::from_str(text).map_err(|error| {
        format!("{error}\n  a change is JSON, for example {{\"change\": \"set\", \"part\": \"Rarm\", \"attribute\": \"Shape\", \"value\": \"round\"}}")
    })
}
