//! All parts, landscapes, characters and clips of a drawing: `inspect --json`.

use serde::Serialize;

use super::{
    Billboard, Clip, Figure, Part, Terrain, billboards, clips, figures, parts, pretty, terrain,
};
use crate::compile::Compiled;
use crate::scene::Size;

#[derive(Serialize)]
struct Inspection<'a> {
    drawing: &'a str,
    size_in_metres: Option<Size>,
    parts: Vec<Part<'a>>,
    terrain: Vec<Terrain<'a>>,
    billboards: Vec<Billboard<'a>>,
    figures: Vec<Figure<'a>>,
    clips: Vec<Clip<'a>>,
}

/// A drawing's content as JSON, with a line feed at the end. `path` is as the user wrote it, `text` what was compiled, `size`
/// that of the model.
pub(crate) fn inspection_json(
    path: &str,
    compiled: &Compiled,
    text: &str,
    size: Option<Size>,
) -> String {
    pretty(&Inspection {
        drawing: path,
        size_in_metres: size,
        parts: parts(compiled, text),
        terrain: terrain(compiled),
        billboards: billboards(compiled),
        figures: figures(compiled),
        clips: clips(compiled),
    })
}
