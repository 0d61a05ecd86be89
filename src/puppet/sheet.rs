//! Writes the sheet as SVG. Lengths are millimetres, which are also the user units.

use crate::math;
use std::fmt::Write as _;

use glam::{DAffine2, DVec2};

use super::instructions::{BELOW_TITLE, FONT, LINE, Line, SAMPLE, TITLE, Texts};
use super::layout::{EDGE, Layout, NAME_LINE, PlacedPiece};
use super::marks::PieceMark;
use super::paper::{HOLE, MARK};
use crate::geometry::Outline;
use crate::source::escape_xml;
use crate::svg::Excerpts;

/// What lies between two pages.
const PAGE_GAP: f64 = 10.0;
/// The length of the line by which the print is checked.
const RULER: f64 = 50.0;
/// The radius of a sample of a mark's colour.
const DOT: f64 = 1.7;

/// A piece with all that is printed on and beside it.
pub(super) struct Printed<'a> {
    pub(super) placed: &'a PlacedPiece,
    pub(super) mark: Option<&'a PieceMark>,
    /// The part's name.
    pub(super) name: String,
    /// What stands below it.
    pub(super) caption: String,
    /// Per hole of the paper the letters of its joints; none where another hole is in the same place.
    pub(super) letters: Vec<Vec<String>>,
}

/// Writes the sheet.
pub(super) fn write(
    page: DVec2,
    layout: &Layout,
    printed: &[Printed<'_>],
    excerpts: &Excerpts,
    texts: &Texts,
) -> String {
    let mut out = String::new();
    head(&mut out, page, layout, texts, &excerpts.definitions);
    for number in 0..layout.pages {
        let corner = page_corner(page, number);
        let _ = writeln!(
            out,
            r#"<g id="sheet-{}" inkscape:groupmode="layer" inkscape:label="Page {0}">"#,
            number + 1
        );
        if number == 0 {
            instructions(&mut out, page, texts);
        }
        for (index, printed) in printed.iter().enumerate() {
            if printed.placed.page == number {
                piece(
                    &mut out,
                    index,
                    printed,
                    layout.scale,
                    corner,
                    &excerpts.excerpts[index],
                );
            }
        }
        out.push_str("</g>\n");
    }
    out.push_str("</svg>\n");
    out
}

/// The top left corner of a page. The first one is the page of the file, as Inkscape saves several pages: it prints each in its
/// real size only then.
fn page_corner(page: DVec2, number: usize) -> DVec2 {
    DVec2::new(0.0, number as f64 * (page.y + PAGE_GAP))
}

fn head(out: &mut String, page: DVec2, layout: &Layout, texts: &Texts, definitions: &str) {
    let [width, height] = page.to_array().map(number);
    let version = env!("CARGO_PKG_VERSION");
    let _ = write!(
        out,
        r#"<svg xmlns="http://www.w3.org/2000/svg" xmlns:xlink="http://www.w3.org/1999/xlink" xmlns:inkscape="http://www.inkscape.org/namespaces/inkscape" xmlns:sodipodi="http://sodipodi.sourceforge.net/DTD/sodipodi-0.dtd" width="{width}mm" height="{height}mm" viewBox="0 0 {width} {height}" font-family="sans-serif" font-size="{FONT}">
<!-- Puppet to cut out, written by okoshi {version} -->
<title>{}</title>
<sodipodi:namedview id="view" inkscape:document-units="mm">
"#,
        escape_xml(&texts.title),
    );
    for index in 0..layout.pages {
        let corner = page_corner(page, index);
        let _ = writeln!(
            out,
            r#"<inkscape:page id="page-{}" x="{}" y="{}" width="{width}" height="{height}"/>"#,
            index + 1,
            number(corner.x),
            number(corner.y)
        );
    }
    let _ = writeln!(out, "</sodipodi:namedview>\n<defs>{definitions}</defs>");
}

/// The text at the lower end of the first page.
fn instructions(out: &mut String, page: DVec2, texts: &Texts) {
    let mut y = page.y - EDGE - texts.height() + TITLE;
    let _ = writeln!(
        out,
        "<text x=\"{EDGE}\" y=\"{}\" font-size=\"{TITLE}\" font-weight=\"bold\">{}</text>",
        number(y),
        escape_xml(&texts.title)
    );
    y += BELOW_TITLE;
    for Line { text: line, color } in &texts.lines {
        y += LINE;
        let mut x = EDGE;
        if let Some(color) = color {
            let at = DVec2::new(EDGE + DOT, y - FONT * 0.35);
            circle(out, at, DOT, &format!("fill=\"{}\"", hex(*color)));
            x += SAMPLE;
        }
        text(out, DVec2::new(x, y), line, "");
    }
    y += LINE;
    let from = DVec2::new(EDGE, y - 1.0);
    let _ = writeln!(
        out,
        r##"<path id="ruler" d="M{} {}v2m0 -1h{RULER}m0 -1v2" fill="none" stroke="#000" stroke-width="0.3"/>"##,
        number(from.x),
        number(from.y - 1.0)
    );
    let at = DVec2::new(EDGE + RULER + 3.0, y);
    text(out, at, "50 mm, if it is printed in its real size", "");
}

fn piece(
    out: &mut String,
    index: usize,
    printed: &Printed<'_>,
    scale: f64,
    corner: DVec2,
    drawn: &str,
) {
    let PlacedPiece { paper, shift, .. } = printed.placed;
    let shift = *shift + corner;
    let place = |point: DVec2| paper.turned(point) + shift;
    let id = index + 1;
    let _ = writeln!(
        out,
        r#"<g id="piece-{id}" inkscape:label="{}">"#,
        escape_xml(&printed.name).replace('"', "&quot;")
    );
    let _ = writeln!(
        out,
        r##"<path id="piece-{id}-cut" d="{}" fill="#fff" stroke="#888" stroke-width="0.35" stroke-linejoin="round"/>"##,
        path(&paper.outline, place)
    );
    let to_sheet = DAffine2::from_mat2_translation(math::rotation(paper.turn) * scale, shift);
    let [a, b, c, d, e, f] = to_sheet.to_cols_array();
    let _ = writeln!(
        out,
        r#"<g id="piece-{id}-drawn" transform="matrix({a:.8} {b:.8} {c:.8} {d:.8} {} {})">{drawn}</g>"#,
        number(e),
        number(f)
    );
    if let (Some(at), Some(mark)) = (paper.mark, printed.mark) {
        let style = format!("id=\"piece-{id}-mark\" fill=\"{}\"", hex(mark.color));
        circle(out, place(at), MARK, &style);
    }
    for (hole, letters) in paper.holes.iter().zip(&printed.letters) {
        if letters.is_empty() {
            continue;
        }
        let at = place(*hole);
        circle(
            out,
            at,
            HOLE,
            r##"fill="#fff" stroke="#000" stroke-width="0.25""##,
        );
        let _ = writeln!(
            out,
            r##"<path d="M{} {}h{2}m-{HOLE} -{HOLE}v{2}" stroke="#000" stroke-width="0.25"/>"##,
            number(at.x - HOLE),
            number(at.y),
            2.0 * HOLE
        );
        // White around the letters, so that they can be read on what is drawn.
        let style =
            r##" font-weight="bold" paint-order="stroke" stroke="#fff" stroke-width="0.8""##;
        let first = 0.36 * FONT - 0.5 * FONT * (letters.len() as f64 - 1.0);
        for (line, letter) in letters.iter().enumerate() {
            let below = DVec2::new(HOLE + 0.4, first + FONT * line as f64);
            text(out, at + below, letter, style);
        }
    }
    let (low, high) = paper.bounds();
    let below = DVec2::new((low.x + high.x) / 2.0, high.y + NAME_LINE - 1.2) + shift;
    text(out, below, &printed.caption, " text-anchor=\"middle\"");
    out.push_str("</g>\n");
}

fn circle(out: &mut String, at: DVec2, radius: f64, style: &str) {
    let _ = writeln!(
        out,
        r#"<circle cx="{}" cy="{}" r="{radius}" {style}/>"#,
        number(at.x),
        number(at.y)
    );
}

fn text(out: &mut String, at: DVec2, text: &str, style: &str) {
    let _ = writeln!(
        out,
        r#"<text x="{}" y="{}"{style}>{}</text>"#,
        number(at.x),
        number(at.y),
        escape_xml(text)
    );
}

fn path(outline: &Outline, place: impl Fn(DVec2) -> DVec2) -> String {
    let mut out = String::new();
    for ring in outline.rings() {
        for (index, point) in ring.iter().enumerate() {
            let at = place(*point);
            let command = if index == 0 { 'M' } else { 'L' };
            let _ = write!(out, "{command}{} {}", number(at.x), number(at.y));
        }
        out.push('Z');
    }
    out
}

/// A length with three decimals, which is a micrometre.
fn number(value: f64) -> String {
    let rounded = (value * 1e3).round() / 1e3;
    // There is no -0 in SVG.
    format!("{}", rounded + 0.0)
}

fn hex([r, g, b]: [u8; 3]) -> String {
    format!("#{r:02x}{g:02x}{b:02x}")
}
