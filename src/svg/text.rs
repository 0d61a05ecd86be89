//! The texts of a drawing: their characters with a source map, and their positions on the page.

use std::sync::Arc;

use glam::{DAffine2, DMat2, DVec2};
use roxmltree::Node;

use super::entities::character;
use super::prepare::Prepared;
use super::separate::start_tag_of;
use super::style::Styles;
use crate::source::{Form, Span, Text};

/// The height of a line above its baseline, as a fraction of the font size.
const ASCENT: f64 = 0.8;
/// The distance between baselines, as a multiple of the font size.
pub(super) const LINE_HEIGHT: f64 = 1.25;
/// The height above the baseline of the points by which a text is bound, as a fraction of the font size.
const POINT_HEIGHT: f64 = 0.35;
/// How far from the ends of the line the first and the last of them are, as a fraction of the font size.
const POINT_INSET: f64 = 0.3;

/// A visible text.
#[derive(Debug, Clone)]
pub struct Label {
    /// Its characters.
    pub text: Arc<Text>,
    /// Where it is on the page.
    pub position: TextPosition,
    /// The font size on the page, user units.
    pub font_size: f64,
    /// The element's `id`.
    pub id: Option<String>,
    /// The element.
    pub element: Span,
    /// Its start tag, without its brackets; empty for flowed text.
    pub(super) start_tag: Arc<str>,
    /// The inputs of its position.
    pub(super) frame: Frame,
}

/// Where a text is on the page, user units. No font is loaded: widths are estimates.
#[derive(Debug, Clone, Copy)]
pub struct TextPosition {
    /// The top left corner of its first line.
    pub corner: DVec2,
    /// The bounding box of all its lines: minimum and maximum corner.
    pub bounds: (DVec2, DVec2),
    /// The beginning, the middle and the end of its first line, at half the height of lower-case letters: what a person points
    /// at with it.
    pub points: [DVec2; 3],
}

/// The inputs of a text's position, besides its characters.
#[derive(Debug, Clone, Copy)]
pub(super) struct Frame {
    /// The base point of its first line, in the element's own coordinates.
    pub(super) base: DVec2,
    /// The anchor: which point of the line is at the base point.
    pub(super) anchor: Anchor,
    /// The font size, in the element's own coordinates.
    pub(super) size: f64,
    /// Maps the element's own coordinates to the page.
    transform: DAffine2,
}

/// The point of a text's first line that is at its position (`text-anchor`).
#[derive(Debug, Clone, Copy)]
pub(super) enum Anchor {
    Start,
    Middle,
    End,
}

impl Frame {
    /// The position of `text`; `None` if it is not finite.
    pub(super) fn place(&self, text: &str) -> Option<TextPosition> {
        let Self { base, size, .. } = *self;
        let left = |width: f64| match self.anchor {
            Anchor::Start => base.x,
            Anchor::Middle => base.x - width / 2.0,
            Anchor::End => base.x - width,
        };
        let widths = text.split('\n').map(|line| box_width(line) * size);
        let width = widths.fold(0.0, f64::max);
        let lines = text.split('\n').count() as f64;
        let top_left = DVec2::new(left(width), base.y - ASCENT * size);
        let bottom_right = top_left + DVec2::new(width, (1.0 + LINE_HEIGHT * (lines - 1.0)) * size);
        let corners = [
            top_left,
            DVec2::new(bottom_right.x, top_left.y),
            DVec2::new(top_left.x, bottom_right.y),
            bottom_right,
        ]
        .map(|corner| self.transform.transform_point2(corner));
        let corner = corners[0];
        let low = corners.iter().copied().fold(corner, DVec2::min);
        let high = corners.iter().copied().fold(corner, DVec2::max);
        let first = text.lines().map(str::trim).find(|line| !line.is_empty());
        let width = text_width(first.unwrap_or_default()) * size;
        let inset = (POINT_INSET * size).min(width / 2.0);
        let points = [inset, width / 2.0, width - inset].map(|along| {
            let point = DVec2::new(left(width) + along, base.y - POINT_HEIGHT * size);
            self.transform.transform_point2(point)
        });
        corner.is_finite().then_some(TextPosition {
            corner,
            bounds: (low, high),
            points,
        })
    }
}

/// Reads a `<text>` or `<flowRoot>` element; `None` if it is hidden or has no position.
pub(super) fn read(node: Node<'_, '_>, styles: &Styles<'_>, prepared: &Prepared) -> Option<Label> {
    if !styles.is_shown(node) {
        return None;
    }
    read_hidden(node, styles, prepared)
}

/// The same, whether it is hidden or not.
pub(super) fn read_hidden(
    node: Node<'_, '_>,
    styles: &Styles<'_>,
    prepared: &Prepared,
) -> Option<Label> {
    let text = content(node, prepared);
    let size = styles.font_size(first_run(node));
    let frame = Frame {
        base: position(node, styles)?,
        anchor: match styles.inherited(first_run(node), "text-anchor") {
            Some("middle") => Anchor::Middle,
            Some("end") => Anchor::End,
            _ => Anchor::Start,
        },
        size,
        transform: page_transform(node),
    };
    let position = frame.place(text.as_str())?;
    Some(Label {
        text: Arc::new(text),
        position,
        font_size: size * frame.transform.matrix2.determinant().abs().sqrt(),
        id: node.attribute("id").map(str::to_owned),
        element: prepared.span(node.range()),
        start_tag: start_tag_of(node, prepared),
        frame,
    })
}

/// The characters of an element: its lines joined by line feeds.
///
/// A new line begins at a `tspan` with `sodipodi:role="line"`, with a `y`, or with a `dy` other than 0, and
/// at every paragraph of flowed text.
pub(super) fn content(node: Node<'_, '_>, prepared: &Prepared) -> Text {
    let mut text = Text::default();
    collect(node, prepared, &mut text);
    text
}

fn collect(node: Node<'_, '_>, prepared: &Prepared, text: &mut Text) {
    for child in node.children() {
        if child.is_text() {
            decode(child, prepared, text);
        } else if child.is_element()
            && !matches!(
                child.tag_name().name(),
                "desc" | "title" | "style" | "flowRegion"
            )
        {
            if starts_line(child) && !text.as_str().is_empty() && !text.as_str().ends_with('\n') {
                let at = prepared.original(child.range().start);
                text.push("\n", Span::at(at), Form::Unit);
            }
            collect(child, prepared, text);
        }
    }
}

fn starts_line(node: Node<'_, '_>) -> bool {
    let moved = |name| {
        let value = node.attribute(name).unwrap_or("0");
        value
            .split([' ', ','])
            .next()
            .and_then(|first| first.trim_end_matches(char::is_alphabetic).parse().ok())
            != Some(0.0)
    };
    match node.tag_name().name() {
        "flowPara" | "flowDiv" => true,
        _ => {
            node.attributes()
                .any(|attribute| attribute.name() == "role" && attribute.value() == "line")
                || node.has_attribute("y")
                || moved("dy")
        }
    }
}

/// Appends a text node with the source position of each character.
fn decode(node: Node<'_, '_>, prepared: &Prepared, out: &mut Text) {
    let Some(expected) = node.text() else { return };
    let range = node.range();
    let written = decoded(range.clone(), prepared)
        .filter(|text| text.as_str() == expected)
        .or_else(|| {
            // Adjacent text and CDATA sections form one node, whose range is that of its beginning.
            let whole = decoded(range.start..end_of(node, prepared)?, prepared);
            whole.filter(|text| text.as_str() == expected)
        });
    match written {
        Some(text) => out.append(&text),
        // Markup from an entity: its characters have no source positions of their own.
        None => out.push(expected, prepared.span(range), Form::Unit),
    }
}

/// The end of a text node: the start of the next node or of the end tag.
fn end_of(node: Node<'_, '_>, prepared: &Prepared) -> Option<usize> {
    match node.next_sibling() {
        Some(next) => Some(next.range().start),
        None => prepared.text[..node.parent()?.range().end].rfind("</"),
    }
}

/// The characters at a range of the copy; `None` if they cannot be read.
fn decoded(range: std::ops::Range<usize>, prepared: &Prepared) -> Option<Text> {
    let source = prepared.text.get(range.clone())?;
    let origin = prepared.original(range.start);
    let mut text = Text::default();
    let mut rest = 0;
    let unit = |text: &mut Text, decoded: &str, from: usize, to: usize| {
        text.push(decoded, Span::new(origin + from, origin + to), Form::Unit);
    };
    while rest < source.len() {
        let tail = &source[rest..];
        if let Some(cdata) = tail.strip_prefix("<![CDATA[") {
            let end = cdata.find("]]>").unwrap_or(cdata.len());
            let start = rest + "<![CDATA[".len();
            plain(&mut text, &cdata[..end], origin + start, Form::Cdata);
            rest = (start + end + "]]>".len()).min(source.len());
        } else if tail.starts_with('&') {
            let end = tail.find(';')?;
            let name = &tail[1..end];
            match (character(name), prepared.entities.get(name)) {
                (Some(c), _) => unit(&mut text, c.encode_utf8(&mut [0; 4]), rest, rest + end + 1),
                (None, Some(value)) => unit(&mut text, value, rest, rest + end + 1),
                (None, None) => return None,
            }
            rest += end + 1;
        } else {
            let end = tail.find(['&', '<']).unwrap_or(tail.len());
            if end == 0 {
                return None;
            }
            plain(&mut text, &tail[..end], origin + rest, Form::Plain);
            rest += end;
        }
    }
    Some(text)
}

/// Appends unescaped characters; line ends become line feeds, as XML requires.
fn plain(text: &mut Text, source: &str, origin: usize, form: Form) {
    let mut done = 0;
    for (at, _) in source.match_indices('\r') {
        let len = if source[at..].starts_with("\r\n") {
            2
        } else {
            1
        };
        text.push(
            &source[done..at],
            Span::new(origin + done, origin + at),
            form,
        );
        text.push("\n", Span::new(origin + at, origin + at + len), Form::Unit);
        done = at + len;
    }
    text.push(
        &source[done..],
        Span::new(origin + done, origin + source.len()),
        form,
    );
}

/// The first element that directly contains characters: its font size and anchor are those of the first line.
fn first_run<'a, 'input>(node: Node<'a, 'input>) -> Node<'a, 'input> {
    node.descendants()
        .find(|inner| inner.is_text() && inner.text().is_some_and(|text| !text.trim().is_empty()))
        .and_then(|inner| inner.parent_element())
        .unwrap_or(node)
}

/// The base point of the first line, in the element's own coordinates.
fn position(node: Node<'_, '_>, styles: &Styles<'_>) -> Option<DVec2> {
    if node.tag_name().name() == "flowRoot" {
        let region = node
            .descendants()
            .find(|inner| inner.tag_name().name() == "rect")?;
        return Some(DVec2::new(
            number(region, "x")?,
            number(region, "y")? + ASCENT * styles.font_size(node),
        ));
    }
    let mut chain: Vec<_> = first_run(node)
        .ancestors()
        .take_while(|inner| *inner != node)
        .collect();
    chain.push(node);
    let find = |name| chain.iter().find_map(|element| number(*element, name));
    if let (None, None, Some(shape)) = (find("x"), find("y"), styles.own(node, "shape-inside")) {
        let id = shape.strip_prefix("url(#")?.strip_suffix(')')?;
        let frame = node
            .document()
            .descendants()
            .find(|inner| inner.attribute("id") == Some(id))?;
        return Some(DVec2::new(
            number(frame, "x")?,
            number(frame, "y")? + ASCENT * styles.font_size(node),
        ));
    }
    Some(DVec2::new(
        find("x").unwrap_or(0.0),
        find("y").unwrap_or(0.0),
    ))
}

/// The first number of an attribute that can be a list of lengths.
fn number(node: Node<'_, '_>, name: &str) -> Option<f64> {
    let value = node.attribute(name)?;
    let first = value
        .split([' ', ',', '\n', '\t'])
        .find(|part| !part.is_empty())?;
    first.parse::<svgtypes::Length>().ok().map(|length| {
        use svgtypes::LengthUnit as Unit;
        length.number
            * match length.unit {
                Unit::Pt => 96.0 / 72.0,
                Unit::Pc => 16.0,
                Unit::In => 96.0,
                Unit::Cm => 96.0 / 2.54,
                Unit::Mm => 96.0 / 25.4,
                _ => 1.0,
            }
    })
}

/// The width of a line's box in font sizes: one half per character, one for wide characters.
fn box_width(line: &str) -> f64 {
    use unicode_width::UnicodeWidthChar;
    line.chars()
        .map(|c| c.width().unwrap_or(0) as f64 * 0.5)
        .sum()
}

/// How much wider than Helvetica the usual sans-serif fonts are on average.
const WIDER: f64 = 1.04;

/// The widths of the characters from space to `~` in Helvetica (Adobe's font metrics), thousandths of the font size.
const HELVETICA: [u16; 95] = [
    278, 278, 355, 556, 556, 889, 667, 191, 333, 333, 389, 584, 278, 333, 278,
    278, // space to /
    556, 556, 556, 556, 556, 556, 556, 556, 556, 556, 278, 278, 584, 584, 584, 556, // 0 to ?
    1015, 667, 667, 722, 722, 667, 611, 778, 722, 278, 500, 667, 556, 833, 722, 778, // @ to O
    667, 778, 722, 667, 611, 722, 667, 944, 667, 667, 611, 278, 278, 278, 469, 556, // P to _
    333, 556, 556, 500, 556, 556, 278, 556, 556, 222, 222, 500, 222, 833, 556, 556, // ` to o
    556, 556, 333, 500, 278, 556, 500, 722, 500, 500, 500, 334, 260, 334, 584, // p to ~
];

/// The estimated width of a line in font sizes, closer than that of its box.
pub(super) fn text_width(line: &str) -> f64 {
    use unicode_width::UnicodeWidthChar;
    let width = |c: char| match (c as usize).checked_sub(' ' as usize) {
        Some(index) if index < HELVETICA.len() => WIDER * f64::from(HELVETICA[index]) / 1000.0,
        _ => c.width().unwrap_or(0) as f64 * 0.5,
    };
    line.chars().map(width).sum()
}

/// Maps an element's own coordinates to the page's user units.
pub(super) fn page_transform(node: Node<'_, '_>) -> DAffine2 {
    let mut chain: Vec<_> = node
        .ancestors()
        .filter(|inner| inner.is_element())
        .collect();
    chain.reverse();
    let mut transform = DAffine2::IDENTITY;
    for (depth, element) in chain.iter().enumerate() {
        if let Some(value) = element.attribute("transform")
            && let Ok(own) = value.parse::<svgtypes::Transform>()
        {
            transform *= DAffine2::from_mat2_translation(
                DMat2::from_cols(DVec2::new(own.a, own.b), DVec2::new(own.c, own.d)),
                DVec2::new(own.e, own.f),
            );
        }
        if depth > 0 && element.tag_name().name() == "svg" {
            transform *= viewport(*element);
        }
    }
    transform
}

/// Maps the inside of a nested `<svg>` to the outside.
fn viewport(node: Node<'_, '_>) -> DAffine2 {
    let place = DVec2::new(
        number(node, "x").unwrap_or(0.0),
        number(node, "y").unwrap_or(0.0),
    );
    let view_box = node
        .attribute("viewBox")
        .and_then(|value| value.parse::<svgtypes::ViewBox>().ok());
    let (Some(view_box), Some(width), Some(height)) =
        (view_box, number(node, "width"), number(node, "height"))
    else {
        return DAffine2::from_translation(place);
    };
    let aspect = node
        .attribute("preserveAspectRatio")
        .and_then(|value| value.parse::<svgtypes::AspectRatio>().ok());
    let aspect = aspect.unwrap_or_default();
    let mut scale = DVec2::new(width / view_box.w, height / view_box.h);
    let mut spare = DVec2::ZERO;
    if aspect.align != svgtypes::Align::None {
        let both = if aspect.slice {
            scale.max_element()
        } else {
            scale.min_element()
        };
        scale = DVec2::splat(both);
        spare = DVec2::new(width, height) - both * DVec2::new(view_box.w, view_box.h);
    }
    use svgtypes::Align;
    let share = match aspect.align {
        Align::None | Align::XMinYMin => DVec2::new(0.0, 0.0),
        Align::XMidYMin => DVec2::new(0.5, 0.0),
        Align::XMaxYMin => DVec2::new(1.0, 0.0),
        Align::XMinYMid => DVec2::new(0.0, 0.5),
        Align::XMidYMid => DVec2::new(0.5, 0.5),
        Align::XMaxYMid => DVec2::new(1.0, 0.5),
        Align::XMinYMax => DVec2::new(0.0, 1.0),
        Align::XMidYMax => DVec2::new(0.5, 1.0),
        Align::XMaxYMax => DVec2::new(1.0, 1.0),
    };
    DAffine2::from_translation(place + spare * share)
        * DAffine2::from_scale(scale)
        * DAffine2::from_translation(-DVec2::new(view_box.x, view_box.y))
}
