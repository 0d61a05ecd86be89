//! The arguments of `okoshi puppet`.

use std::path::PathBuf;

use clap::Args;
use glam::DVec2;

use super::Reading;

const EXAMPLES: &str = "\
Examples:
  okoshi puppet human.svg                      writes human-puppet.svg beside the drawing
  okoshi puppet human.svg -o sheet.svg --page Letter
  okoshi puppet human.svg -o sheet.svg --page 297x420    a page of 297 × 420 mm, which is A3
  okoshi puppet human.svg -o sheet.svg --scale 0.5       half a millimetre of paper for a unit of the drawing

Each part that moves becomes a piece of paper, and what is drawn on it stays on it. Print the sheet at 100 %, glue it
onto thin card, cut along the grey lines, and pin holes with the same letter together. `Mark red` in the string of a
hand puts a red disc on it; if no part has a mark, the sheet suggests some. Film the puppet while you move it; then
`okoshi track` finds the marks in the film, and `Perform` in a string gives the figure's motion your timing.

The sheet is as large as one page allows; a puppet that would be smaller than 20 cm gets more pages.";

#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(in crate::cli) struct Puppet {
    /// The drawing, an SVG file; `-` is stdin
    #[arg(value_name = "DRAWING")]
    pub(in crate::cli) drawing: PathBuf,
    /// Where to write: an .svg file, `-` for stdout, or a folder [default: DRAWING-puppet.svg beside the drawing]
    #[arg(short, long, value_name = "SHEET.svg")]
    pub(in crate::cli) output: Option<PathBuf>,
    /// The paper: A4, Letter, or width and height in millimetres
    #[arg(long, value_name = "A4|Letter|WxH", default_value = "A4", value_parser = page)]
    pub(in crate::cli) page: DVec2,
    /// Millimetres on paper for a unit of the drawing [default: as large as fits]
    #[arg(long, value_name = "MM", value_parser = scale)]
    pub(in crate::cli) scale: Option<f64>,
    #[command(flatten)]
    pub(in crate::cli) reading: Reading,
}

/// Width and height in millimetres.
fn page(text: &str) -> Result<DVec2, String> {
    let sides = text.split_once(['x', 'X', '×']);
    let side = |text: &str| {
        let side: f64 = text.trim().trim_end_matches("mm").parse().ok()?;
        (80.0..=2000.0).contains(&side).then_some(side)
    };
    match text.to_lowercase().as_str() {
        "a4" => Ok(crate::puppet::A4),
        "letter" => Ok(DVec2::new(215.9, 279.4)),
        _ => sides
            .and_then(|(width, height)| Some(DVec2::new(side(width)?, side(height)?)))
            .ok_or_else(|| {
                "expected A4, Letter, or width and height from 80 to 2000 millimetres, for example 297x420"
                    .to_owned()
            }),
    }
}

fn scale(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(scale) if (1e-6..=1e6).contains(&scale) => Ok(scale),
        _ => Err("expected a number above 0, for example 0.5".to_owned()),
    }
}
