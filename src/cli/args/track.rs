//! The arguments of `okoshi track`.

use std::path::PathBuf;

use clap::Args;

use crate::mark_tracks::{MAX_NAME, is_name, named_color, parse_hex};
use crate::tracking::Mark;

const EXAMPLES: &str = "\
Examples:
  okoshi track puppet.mp4 --mark red --mark green     writes puppet.json beside the clip
  okoshi track puppet.gif -o kick.csv --mark red      a table, for spreadsheets
  okoshi track puppet.gif --mark hand=blue --mark foot=#e0a020
                                                      marks with names of their own
  okoshi track frames --fps 12 --mark red             a folder of pictures, 12 for each second
  okoshi track puppet.mp4 --mark red --annotated check.gif
                                                      also the clip with what was found, to check it by

Clips are GIF, APNG and WebP animations, pictures, and every video that the program ffmpeg reads, if it is installed.
Marks are found by their hue, so give each another one: red, yellow, green and blue are told apart best.
A drawing uses the track with `Perform \"puppet.json\"`, and its parts name the marks with `Mark red`.";

#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(in crate::cli) struct Track {
    /// A clip, a folder of pictures, or several pictures
    #[arg(required = true, value_name = "CLIP")]
    pub(in crate::cli) clips: Vec<PathBuf>,
    /// Where to write: a .json or .csv file, `-` for JSON on stdout [default: beside the clip, as .json]
    #[arg(short, long, value_name = "TRACK")]
    pub(in crate::cli) output: Option<PathBuf>,
    /// A mark to find: a colour as CSS names it or as #rrggbb, after a name of your own if you like
    #[arg(short, long = "mark", required = true, value_name = "[NAME=]COLOUR", value_parser = mark)]
    pub(in crate::cli) marks: Vec<Mark>,
    /// Frames a second [default: as the clip says; 24 for pictures]
    #[arg(long, value_name = "F", value_parser = fps)]
    pub(in crate::cli) fps: Option<f64>,
    /// Also write the clip with the marks that were found: a .gif, .apng, .mp4 or .webm file, or .png for numbered pictures
    #[arg(long, value_name = "FILE")]
    pub(in crate::cli) annotated: Option<PathBuf>,
}

fn mark(text: &str) -> Result<Mark, String> {
    let (name, color) = match text.split_once('=') {
        Some((name, color)) => (name, color),
        None => (text.trim_start_matches('#'), text),
    };
    if !is_name(name) {
        return Err(format!(
            "the name of a mark has letters, digits, `-` and `_`, {MAX_NAME} at most, as in `hand=red`"
        ));
    }
    let rgb = parse_hex(color).or_else(|| named_color(color));
    let rgb = rgb.ok_or_else(|| {
        format!("`{color}` is no colour: expected a CSS name or a number, such as `{name}=red` or `{name}=#d03020`")
    })?;
    Mark::new(name, rgb).map_err(|_| {
        format!(
            "`{color}` has no hue to find it by: marks are red, yellow, green or blue, for example"
        )
    })
}

fn fps(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(fps) if (0.1..=1000.0).contains(&fps) => Ok(fps),
        _ => Err("expected a number from 0.1 to 1000".to_owned()),
    }
}
