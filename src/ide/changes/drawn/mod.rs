//! Changes of what is drawn, instead of what strings say of it: new shapes, and places, order, paint and end of those that are there.
//!
//! What is written is plain SVG. A string that is beside its part goes where the part goes.

mod draw;
mod erase;
mod kept;
mod paint;
mod path;
mod places;
mod restack;
mod shift;

use glam::DVec2;
use roxmltree::{Document, Node, ParsingOptions};
use serde::{Deserialize, Serialize};

pub(super) use kept::{check, part_after};

use super::{Analysis, Refusal};
use crate::bind::{BoundBy, Part, PartId, PartKind, StringHolder, StringId};
use crate::math;
use crate::source::Span;
use crate::svg::{Drawing, Element, Label};

/// To how many parts of the page's larger side places are rounded: less than a pixel on any screen.
const STEPS: f64 = 20_000.0;
/// How many digits behind the point are ever written.
const MOST_DIGITS: usize = 9;

/// A shape that is drawn, in user units of the drawing, y down.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum NewShape {
    /// Path data, as in SVG; each of its pieces is closed.
    Path(String),
    /// Centre and radii of an ellipse.
    Ellipse([f64; 4]),
    /// Left, top, width and height of a rectangle.
    Rect([f64; 4]),
}

/// Where a part goes in the order of drawing, among what is in the same layer or group.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Stacking {
    /// In front of everything else.
    Front,
    /// In front of the next one.
    Forward,
    /// Behind the one before it.
    Backward,
    /// Behind everything else.
    Back,
}

impl Analysis {
    /// The drawing's text as XML.
    fn document(&self) -> Result<Document<'_>, Refusal> {
        let options = ParsingOptions {
            allow_dtd: true,
            ..ParsingOptions::default()
        };
        Document::parse_with_options(&self.source, options)
            .map_err(|error| Refusal::new(format!("the drawing cannot be read: {error}")))
    }

    /// The part of a name, and the elements that draw it. A shape that belongs to a part, such as an eye, is drawn by itself.
    fn drawn_part(&self, name: &str) -> Result<(PartId, Vec<&Element>), Refusal> {
        let bindings = self.bindings();
        let of_shape = |part: PartId| &self.drawing().shapes[bindings.parts[part].shape].element;
        let mut part = self.part_to_change(name)?;
        let Part { kind, main, .. } = bindings.parts[part];
        // The line around a shape is one with it.
        if kind == PartKind::Sub && of_shape(part).span == of_shape(main).span {
            part = main;
        }
        let elements = match bindings.parts[part].kind {
            PartKind::Sub => vec![of_shape(part)],
            _ => self.drawn_as(self.node_to_change(&bindings.parts[part].name)?),
        };
        let has = |element: &Element| elements.iter().any(|own| own.span == element.span);
        let mut others = bindings.parts.keys();
        if let Some(other) = others.find(|other| !self.is_of(*other, part) && has(of_shape(*other)))
        {
            return Err(Refusal::new(format!(
                "`{name}` and {} are drawn by one element: draw each by itself, or unlink the clone (in Inkscape, Edit > Clone > Unlink Clone)",
                bindings.describe(self.drawing(), other)
            )));
        }
        Ok((part, elements))
    }

    /// Whether a part is another one or belongs to it.
    fn is_of(&self, part: PartId, whole: PartId) -> bool {
        let parts = &self.bindings().parts;
        let is_line = parts[part].shape == parts[whole].shape && parts[part].kind != PartKind::Main;
        part == whole || parts[part].main == whole || is_line
    }

    /// The strings that are written beside a part on the page.
    fn strings_beside(&self, part: PartId) -> impl Iterator<Item = (StringId, &Label)> {
        let (bindings, drawing) = (self.bindings(), self.drawing());
        let strings = bindings.strings.iter_enumerated();
        strings.filter_map(move |(index, string)| {
            let StringHolder::Label(label) = string.holder else {
                return None;
            };
            let bound = string.binding?.part;
            let (label, _) = &drawing.labels[label];
            self.is_of(bound, part).then_some((index, label))
        })
    }

    /// Whether a line leads from a string of the part to it.
    fn has_leader(&self, part: PartId) -> bool {
        let strings = &self.bindings().strings;
        let mut beside = self.strings_beside(part);
        beside.any(|(index, _)| {
            strings[index]
                .binding
                .is_some_and(|binding| binding.by == BoundBy::Leader)
        })
    }
}

/// The element whose start tag begins at a byte.
fn element_at<'a, 'input>(
    document: &'a Document<'input>,
    start: usize,
) -> Result<Node<'a, 'input>, Refusal> {
    let mut elements = document.descendants().filter(Node::is_element);
    elements
        .find(|node| node.range().start == start)
        .ok_or_else(|| Refusal::new("the element is not found in the text of the drawing"))
}

/// An element with the white space before it.
fn with_space_before(source: &str, node: Node<'_, '_>) -> Span {
    let Span { start, end } = node.range().into();
    Span::new(start - space_before(source, start).len(), end)
}

/// The white space that ends at a byte, from the last line end in it.
fn space_before(source: &str, end: usize) -> &str {
    let before = &source[..end];
    let space = &before[before.trim_end().len()..];
    let line = space
        .rfind('\n')
        .map_or(0, |at| at - usize::from(space[..at].ends_with('\r')));
    &space[line..]
}

/// The step to which lengths of a drawing are rounded, user units.
fn step(drawing: &Drawing) -> f64 {
    (drawing.page.1.max_element() / STEPS).max(f64::MIN_POSITIVE)
}

/// How many digits behind the point tell two steps apart.
fn digits(step: f64) -> usize {
    // The cast of a number that is no length gives none or most of them.
    (-math::log10(step)).ceil().clamp(0.0, MOST_DIGITS as f64) as usize
}

/// A number with so many digits behind the point at most.
fn written(number: f64, digits: usize) -> String {
    let text = format!("{number:.digits$}");
    let text = match text.contains('.') {
        true => text.trim_end_matches('0').trim_end_matches('.'),
        false => &text,
    };
    if text == "-0" { "0" } else { text }.to_owned()
}

/// A colour as it is written: `#rrggbb`.
fn color(text: &str) -> Result<String, Refusal> {
    let digits = text.strip_prefix('#').unwrap_or_default();
    if digits.len() == 6 && digits.bytes().all(|byte| byte.is_ascii_hexdigit()) {
        return Ok(text.to_ascii_lowercase());
    }
    Err(Refusal::new(format!(
        "`{text}` is no colour of a shape: write red, green and blue as in `#cc4422`"
    )))
}

/// Whether coordinates are near enough to the page.
fn is_near_page(drawing: &Drawing, point: DVec2) -> bool {
    const FAR: f64 = 100.0;
    let (corner, size) = drawing.page;
    let apart = (point - corner - size / 2.0).abs();
    // Not a number is not near.
    apart.max_element() <= FAR * size.max_element()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_no_more_digits_than_needed() {
        for (number, digits, text) in [
            (1.0, 2, "1"),
            (-0.001, 2, "0"),
            (12.345_6, 2, "12.35"),
            (120.0, 0, "120"),
            (0.5, 3, "0.5"),
        ] {
            assert_eq!(written(number, digits), text);
        }
        assert_eq!(
            [0.5, 0.01, 0.0105, 1e-30].map(digits),
            [1, 2, 2, MOST_DIGITS]
        );
    }

    #[test]
    fn space_is_taken_from_its_last_line() {
        for (text, space) in [
            ("<a>\n\n  ", "\n  "),
            ("<a>\r\n ", "\r\n "),
            ("<a>", ""),
            ("<a> ", " "),
        ] {
            assert_eq!(space_before(text, text.len()), space);
        }
    }
}
