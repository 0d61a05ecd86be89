//! Draws a drawing as drawing programs show it, without some of its shapes, with resvg.

use resvg::tiny_skia::{Pixmap, Transform};
use rustc_hash::FxHashMap;

use super::links::{parsing, styled_tree};
use super::prepare::prepare;
use crate::resolver::Resolver;

/// What a picture does not show of an element.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LeftOut {
    /// All of it.
    Element,
    /// Its fill.
    Fill,
    /// Its stroke.
    Stroke,
}

impl LeftOut {
    /// What an element is marked with in [`STYLE`].
    fn mark(self) -> &'static str {
        match self {
            Self::Element => " data-okoshi-left-out=\"element\"",
            Self::Fill => " data-okoshi-left-out=\"fill\"",
            Self::Stroke => " data-okoshi-left-out=\"stroke\"",
        }
    }
}

/// Leaves out what is marked, and filters: they change no shapes, and the time that they take has no limit.
const STYLE: &str = r#"
* { filter: none !important }
[data-okoshi-left-out="element"] { display: none !important }
[data-okoshi-left-out="fill"] { fill: none !important }
[data-okoshi-left-out="stroke"] { stroke: none !important }
"#;

/// A picture of a drawing, or of some of it.
#[derive(Debug, Clone, PartialEq)]
pub struct Raster {
    /// Width and height, pixels.
    pub size: [u32; 2],
    /// Rows from the top: sRGB values multiplied by alpha, and alpha.
    pub pixels: Vec<[u8; 4]>,
}

/// Draws the text of a drawing at `scale` pixels a drawing unit, without texts and filters, and without what `left_out` says
/// for elements given by the first byte of their start tags. The picture begins at the top left corner of the page.
///
/// `None` if the drawing cannot be read, or the picture is too large. Needs a large stack, as [`read`](super::read) does.
pub fn raster(
    text: &str,
    resolver: &dyn Resolver,
    left_out: &FxHashMap<usize, LeftOut>,
    [width, height]: [u32; 2],
    scale: f64,
) -> Option<Raster> {
    let marked = marked(text, left_out)?;
    let tree = styled_tree(&marked, STYLE, resolver)?;
    let mut pixmap = Pixmap::new(width, height)?;
    let scale = scale as f32;
    resvg::render(
        &tree,
        Transform::from_scale(scale, scale),
        &mut pixmap.as_mut(),
    );
    let pixels = pixmap.pixels().iter();
    Some(Raster {
        size: [width, height],
        pixels: pixels
            .map(|pixel| [pixel.red(), pixel.green(), pixel.blue(), pixel.alpha()])
            .collect(),
    })
}

/// The text that is drawn, with a mark in the start tag of each element that is not drawn as it is.
fn marked(text: &str, left_out: &FxHashMap<usize, LeftOut>) -> Option<String> {
    let prepared = prepare(text).ok()?;
    let document = roxmltree::Document::parse_with_options(&prepared.text, parsing()).ok()?;
    let mut marked = String::with_capacity(prepared.text.len());
    let mut done = 0;
    for node in document.descendants().filter(roxmltree::Node::is_element) {
        let start = node.range().start;
        let Some(what) = left_out.get(&prepared.original(start)) else {
            continue;
        };
        let tag = &prepared.text[start..];
        let end = tag.find(|c: char| c.is_whitespace() || matches!(c, '>' | '/'))?;
        marked.push_str(prepared.text.get(done..start + end)?);
        marked.push_str(what.mark());
        done = start + end;
    }
    marked.push_str(&prepared.text[done..]);
    Some(marked)
}
