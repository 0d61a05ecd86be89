//! `okoshi trace`

use super::args::{Common, Trace};
use super::new::{explained, quoted};
use super::progress::spinning;
use super::rewriting::is_svg;
use super::{Failure, Outcome, counted, print_out};
use crate::disk::{ReadError, is_standard_stream, read_file, write_new};
use crate::trace::trace;

/// Writes a drawing with the regions of a picture as shapes, and suggests the next commands.
pub(super) fn run(arguments: &Trace, common: Common) -> Result<Outcome, Failure> {
    let picture = &arguments.picture;
    let output = arguments.output.clone();
    let output = output.unwrap_or_else(|| picture.with_extension("svg"));
    let file = read_file(picture).map_err(|error| match error {
        ReadError::Folder { path, .. } => {
            format!("`{}` is a folder; name a picture in it", path.display())
        }
        error => error.to_string(),
    })?;
    is_svg(&output)?;
    let name = picture.display();
    let traced = spinning("looking for shapes", || trace(&file));
    let traced = traced.map_err(|error| format!("`{name}` {error}"))?;
    if traced.is_shaded && !common.quiet {
        eprintln!(
            "`{name}` has soft shading or fine texture: most of the {} are only steps of it; draw areas in one colour, or flatten the picture first",
            counted(traced.shapes, "shape")
        );
    }
    if is_standard_stream(&output) {
        return Ok(print_out(&traced.svg));
    }
    write_new(&output, traced.svg.as_bytes()).map_err(|error| explained(&error))?;
    if !common.quiet {
        let sheet = if traced.is_straightened {
            " from the sheet of paper in the picture"
        } else {
            ""
        };
        let drawing = quoted(&output);
        eprint!(
            "wrote {}: {}{sheet}; try next:\n  okoshi annotate {drawing}\n  okoshi preview {drawing} --open\n",
            output.display(),
            counted(traced.shapes, "shape")
        );
    }
    Ok(Outcome::Done)
}
