//! Sheets of puppets: every piece is there once, can be cut out, and can be pinned where its holes are; and it shows what is drawn.
#![cfg(feature = "cli")]

mod common;

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;

use common::examples;
use common::program::Room;
use glam::{DAffine2, DVec2};
use okoshi::FolderResolver;
use okoshi::compile::Compiled;
use okoshi::internals::bind::PartId;
use okoshi::internals::geometry::{
    FillRule, Outline, area, border_distance_squared, bounds, contains, intersect, resolve_overlaps,
};
use okoshi::internals::puppet::{
    MarkOrigin, Options, PaperPiece, PuppetError, Sheet, pieces, sheet,
};
use okoshi::internals::svg::{LeftOut, raster};
use okoshi::resolver::{MemoryResolver, Resolver};
use proptest::prelude::*;
use resvg::tiny_skia::{Pixmap, Transform};
use roxmltree::{Document, Node};
use rustc_hash::FxHashMap;

const A4: DVec2 = DVec2::new(210.0, 297.0);
/// The radii of holes and of marks, millimetres.
const HOLE: f64 = 1.5;
const MARK: f64 = 7.0;
/// The least paper around the middle of a hole.
const RING: f64 = 4.5;
/// Pixels of pictures for a millimetre.
const PIXELS: f64 = 2.0;

const GOOD: &str = r##"<svg xmlns="http://www.w3.org/2000/svg" width="200" height="200">
  <g><rect x="20" y="20" width="60" height="80" fill="#cc0000" id="body"/>
  <rect x="76" y="30" width="60" height="14" fill="#0000cc" id="arm"/>
  <circle cx="140" cy="38" r="9" fill="#cc8888" id="hand"/>
  <circle cx="50" cy="40" r="4" fill="#ffffff" id="button"/></g>
  <text x="50" y="74" font-size="5">Body</text>
  <text x="100" y="39" font-size="5">Arm@Body</text>
  <text x="140" y="39" font-size="5">Hand@Arm$Mark #ff8000</text>
  <text x="50" y="40" font-size="2">Button@Body</text>
</svg>
"##;

/// A piece as a person sees it on the sheet.
#[derive(Debug)]
struct Seen {
    page: usize,
    cut: Outline,
    /// From the drawing to the sheet.
    drawn: DAffine2,
    /// Per hole its letters.
    holes: Vec<(DVec2, Vec<String>)>,
    mark: Option<DVec2>,
}

fn options() -> Options {
    Options {
        page: A4,
        scale: None,
    }
}

fn attribute(node: Node<'_, '_>, name: &str) -> f64 {
    node.attribute(name)
        .and_then(|value| value.parse().ok())
        .expect("a number")
}

fn point(node: Node<'_, '_>, names: [&str; 2]) -> DVec2 {
    DVec2::from(names.map(|name| attribute(node, name)))
}

fn numbers(text: &str) -> Vec<f64> {
    let numbers = text.split(|c: char| c.is_alphabetic() || c == ' ' || c == '(' || c == ')');
    numbers.filter_map(|number| number.parse().ok()).collect()
}

/// Reads the pieces of a sheet, by their number.
fn read(svg: &str) -> BTreeMap<usize, Seen> {
    let document = Document::parse(svg).expect("XML");
    let mut seen = BTreeMap::new();
    for node in document.descendants() {
        let id = node.attribute("id").unwrap_or_default();
        let number = id
            .strip_prefix("piece-")
            .and_then(|number| number.parse().ok());
        let (Some(number), Some(page)) = (number, node.parent()) else {
            continue;
        };
        let page = page.attribute("id").unwrap_or_default();
        let inner = |suffix: &str| {
            let mut children = node.children();
            let id = format!("piece-{number}-{suffix}");
            children.find(move |child| child.attribute("id") == Some(&id))
        };
        let cut = inner("cut")
            .and_then(|cut| cut.attribute("d"))
            .expect("a line");
        assert_eq!(
            cut.matches('M').count(),
            1,
            "{id} is one piece of paper without holes"
        );
        let ring = numbers(cut)
            .chunks(2)
            .map(|at| DVec2::new(at[0], at[1]))
            .collect();
        let drawn = inner("drawn").and_then(|drawn| drawn.attribute("transform"));
        let drawn = numbers(drawn.expect("a transform"));
        let mut holes: Vec<(DVec2, Vec<String>)> = Vec::new();
        for child in node.children() {
            if child.has_tag_name((SVG, "circle")) && attribute(child, "r") == HOLE {
                holes.push((point(child, ["cx", "cy"]), Vec::new()));
            }
            if child.attribute("font-weight").is_some() {
                let (_, letters) = holes.last_mut().expect("a hole");
                letters.push(child.text().unwrap_or_default().to_owned());
            }
        }
        let piece = Seen {
            page: page
                .strip_prefix("sheet-")
                .and_then(|page| page.parse().ok())
                .expect("a page"),
            cut: resolve_overlaps(vec![ring], FillRule::NonZero),
            drawn: DAffine2::from_cols_slice(&drawn),
            holes,
            mark: inner("mark").map(|mark| point(mark, ["cx", "cy"])),
        };
        assert!(seen.insert(number, piece).is_none(), "{id} is there once");
    }
    seen
}

const SVG: &str = "http://www.w3.org/2000/svg";

/// What must hold for the sheet of every drawing.
fn check_laws(compiled: &Compiled, sheet: &Sheet, page: DVec2) -> Result<(), String> {
    let fails = |what: String| -> Result<(), String> { Err(what) };
    let made = pieces(&compiled.drawing, &compiled.bindings).expect("few pieces");
    let seen = read(&sheet.svg);
    if seen.len() != made.len() || sheet.pieces != made.len() {
        return fails(format!("{} pieces of {}", seen.len(), made.len()));
    }
    // Each part is on one piece.
    let parts = made
        .iter()
        .flat_map(|piece| [&[piece.part][..], &piece.details].concat());
    let parts: Vec<PartId> = parts.collect();
    let distinct: BTreeSet<PartId> = parts.iter().copied().collect();
    if distinct.len() != parts.len() {
        return fails("a part is on two pieces".to_owned());
    }
    let mut holes_of: BTreeMap<&str, Vec<DVec2>> = BTreeMap::new();
    for (number, piece) in &seen {
        let corner = DVec2::new(0.0, (piece.page - 1) as f64 * (page.y + 10.0));
        let (low, high) = bounds(&piece.cut).ok_or("nothing to cut")?;
        if (low - corner).min_element() < 9.9 || (corner + page - high).min_element() < 9.9 {
            return fails(format!("piece {number} is not on the page"));
        }
        let on_paper = |at: DVec2, radius: f64| {
            let border = border_distance_squared(&piece.cut, at).sqrt();
            contains(&piece.cut, at) && border >= radius
        };
        for (at, letters) in &piece.holes {
            if !on_paper(*at, RING) {
                return fails(format!(
                    "hole {letters:?} of piece {number} is not on paper"
                ));
            }
            for letter in letters {
                let in_drawing = piece.drawn.inverse().transform_point2(*at);
                holes_of.entry(letter).or_default().push(in_drawing);
            }
        }
        if let Some(mark) = piece.mark {
            let mut holes = piece.holes.iter();
            if !on_paper(mark, MARK) || holes.any(|(hole, _)| hole.distance(mark) < MARK + HOLE) {
                return fails(format!("the mark of piece {number} is not on free paper"));
            }
        }
        for (other, seen) in seen.range(..number) {
            if area(&intersect(&seen.cut, &piece.cut)) > 1e-6 {
                return fails(format!("pieces {other} and {number} overlap"));
            }
        }
    }
    let joints = made.iter().filter(|piece| piece.joint.is_some()).count();
    if holes_of.len() != joints {
        return fails(format!("{} letters for {joints} joints", holes_of.len()));
    }
    let tolerance = 1.1 / sheet.scale;
    for (letter, places) in holes_of {
        if !matches!(places[..], [a, b] if a.distance(b) <= tolerance) {
            return fails(format!("the holes {letter} are at {places:?}"));
        }
    }
    // The sheet itself is a drawing without strings.
    let as_drawing = common::compiled(&sheet.svg, &MemoryResolver::default());
    if as_drawing.bindings.annotated || as_drawing.has_errors() {
        return fails(format!(
            "it is taken for a drawing: {:?}",
            as_drawing.diagnostics
        ));
    }
    Ok(())
}

/// Runs with a stack for deeply nested drawings.
fn with_stack<T: Send>(work: impl FnOnce() -> T + Send) -> T {
    std::thread::scope(|scope| {
        let thread = std::thread::Builder::new().stack_size(256 << 20);
        thread
            .spawn_scoped(scope, work)
            .expect("a thread")
            .join()
            .expect("no panic")
    })
}

/// The picture of a sheet's first page, and those below it.
fn picture(sheet: &Sheet) -> Pixmap {
    let tree = usvg::Tree::from_str(&sheet.svg, &usvg::Options::default()).expect("a drawing");
    let height = sheet.pages as f64 * (A4.y + 10.0);
    let size = (DVec2::new(A4.x, height) * PIXELS).as_uvec2();
    let mut pixmap = Pixmap::new(size.x, size.y).expect("a picture");
    // usvg's unit is a pixel of 1/96 inch.
    let scale = (PIXELS * 25.4 / 96.0) as f32;
    resvg::render(
        &tree,
        Transform::from_scale(scale, scale),
        &mut pixmap.as_mut(),
    );
    pixmap
}

/// What an element that is not on a piece shows.
fn all_but(compiled: &Compiled, piece: &PaperPiece) -> FxHashMap<usize, LeftOut> {
    let mut left_out = FxHashMap::default();
    for shape in &compiled.drawing.shapes {
        if !piece.leaves.contains(&shape.leaf) {
            left_out.insert(shape.element.span.start, LeftOut::Element);
        }
    }
    left_out
}

/// The share of the pixels of each piece that are as in the drawing, and how many were compared.
fn compare(
    compiled: &Compiled,
    text: &str,
    resolver: &dyn Resolver,
    sheet: &Sheet,
) -> Vec<(f64, usize)> {
    let picture = picture(sheet);
    let seen = read(&sheet.svg);
    let made = pieces(&compiled.drawing, &compiled.bindings).expect("few pieces");
    let compared = made.iter().zip(seen.values()).map(|(piece, seen)| {
        let scale = sheet.scale * PIXELS;
        let size = (compiled.drawing.page.1 * scale)
            .ceil()
            .as_uvec2()
            .to_array();
        let left_out = all_but(compiled, piece);
        let drawn = raster(text, resolver, &left_out, size, scale).expect("a picture");
        let pixel = |x: u32, y: u32| drawn.pixels[(y * size[0] + x) as usize];
        let (mut right, mut all) = (0, 0);
        for y in 1..size[1] - 1 {
            for x in 1..size[0] - 1 {
                let here = pixel(x, y);
                let around = (y - 1..=y + 1).flat_map(|y| (x - 1..=x + 1).map(move |x| (x, y)));
                let is_plain = around.into_iter().all(|(x, y)| {
                    let other = pixel(x, y);
                    (0..4).all(|channel| other[channel].abs_diff(here[channel]) < 8)
                });
                let at = DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5) / scale;
                let place = seen.drawn.transform_point2(at);
                let near = |other: &DVec2, radius: f64| other.distance(place) < radius;
                let is_covered = seen.mark.iter().any(|mark| near(mark, MARK + 1.0))
                    || seen.holes.iter().any(|(hole, _)| near(hole, HOLE + 1.0));
                if !is_plain || here[3] == 0 || is_covered {
                    continue;
                }
                let place = (place * PIXELS).floor().as_uvec2();
                let Some(found) = picture.pixel(place.x, place.y) else {
                    continue;
                };
                // The paper is white.
                let behind = 255 - here[3];
                let found = [found.red(), found.green(), found.blue()];
                let is_right =
                    (0..3).all(|c| found[c].abs_diff(here[c].saturating_add(behind)) < 24);
                all += 1;
                right += usize::from(is_right);
            }
        }
        (right as f64 / f64::from(all.max(1) as u32), all)
    });
    compared.collect()
}

#[test]
fn the_sheets_of_all_examples_can_be_cut_and_pinned() {
    let mut made = 0;
    for name in examples() {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("examples/{name}.svg"));
        let text = fs::read_to_string(&path).expect("a drawing");
        let resolver = FolderResolver::new(path.parent().expect("a folder"));
        let compiled = common::compiled(&text, &resolver);
        let sheet = match sheet(&compiled, &text, &name, &resolver, &options()) {
            Ok(sheet) => sheet,
            Err(PuppetError::NoFigure) => continue,
            Err(error) => panic!("{name} {error}"),
        };
        check_laws(&compiled, &sheet, A4).unwrap_or_else(|error| panic!("{name}: {error}"));
        made += 1;
    }
    assert!(made > 20, "{made} sheets");
}

#[test]
fn pieces_show_what_is_drawn() {
    for name in [
        "human",
        "doll",
        "lady",
        "motion/bird",
        "looks",
        "clockwork-dragon",
    ] {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("examples/{name}.svg"));
        let text = fs::read_to_string(&path).expect("a drawing");
        let resolver = FolderResolver::new(path.parent().expect("a folder"));
        let compiled = common::compiled(&text, &resolver);
        let sheet = sheet(&compiled, &text, name, &resolver, &options()).expect("a sheet");
        let found = with_stack(|| compare(&compiled, &text, &resolver, &sheet));
        assert!(
            found.iter().map(|(_, count)| count).sum::<usize>() > 5000,
            "{name}"
        );
        for (piece, (right, count)) in found.iter().enumerate() {
            // A mark may hide most of a small piece.
            assert!(
                *right > 0.97 || *count < 20,
                "{name}, piece {}: {right} of {count}",
                piece + 1
            );
        }
    }
}

#[test]
fn details_stay_on_their_piece() {
    let resolver = MemoryResolver::default();
    let compiled = common::compiled(GOOD, &resolver);
    let made = pieces(&compiled.drawing, &compiled.bindings).expect("few pieces");
    let names = |piece: &PaperPiece| {
        let parts = [&[piece.part][..], &piece.details].concat();
        let names = parts
            .iter()
            .map(|part| compiled.bindings.parts[*part].name.clone());
        names.collect::<Vec<_>>()
    };
    let names: Vec<_> = made.iter().map(names).collect();
    assert_eq!(names, [vec!["Body", "Button"], vec!["Arm"], vec!["Hand"]]);
    let sheet = sheet(&compiled, GOOD, "a", &resolver, &options()).expect("a sheet");
    let marks: Vec<_> = sheet
        .marks
        .iter()
        .map(|mark| (mark.word.as_str(), mark.origin))
        .collect();
    assert_eq!(marks, [("#ff8000", MarkOrigin::Given)]);
    assert!(
        sheet.svg.contains("--mark '#ff8000=#ff8000'"),
        "{}",
        sheet.svg
    );
}

#[test]
fn joints_without_paper_are_passed_over() {
    // An axle between body and arm, and a hub that carries two things and hangs on nothing.
    let text = r##"<svg xmlns="http://www.w3.org/2000/svg" width="200" height="200">
  <rect x="20" y="20" width="60" height="80" fill="#c00"><desc>Body$</desc></rect>
  <circle cx="78" cy="37" r="3" fill="#000"><desc>Axle@Body$Shape none</desc></circle>
  <rect x="76" y="30" width="60" height="14" fill="#00c"><desc>Arm@Axle$</desc></rect>
  <circle cx="150" cy="150" r="3" fill="#000"><desc>Hub$Shape none</desc></circle>
  <rect x="150" y="140" width="40" height="9" fill="#0c0"><desc>One@Hub$</desc></rect>
  <rect x="100" y="151" width="50" height="9" fill="#0cc"><desc>Two@Hub$</desc></rect>
</svg>"##;
    let resolver = MemoryResolver::default();
    let compiled = common::compiled(text, &resolver);
    let made = pieces(&compiled.drawing, &compiled.bindings).expect("few pieces");
    let names = made.iter().map(|piece| {
        let carrier = piece.joint.map(|joint| made[joint.parent].part);
        let name = |part: PartId| compiled.bindings.parts[part].name.as_str();
        (name(piece.part), carrier.map(name))
    });
    let names: Vec<_> = names.collect();
    assert_eq!(
        names,
        [
            ("Body", None),
            ("Arm", Some("Body")),
            ("One", None),
            ("Two", None)
        ]
    );
    let sheet = sheet(&compiled, text, "a", &resolver, &options()).expect("a sheet");
    check_laws(&compiled, &sheet, A4).expect("a good sheet");
}

#[test]
fn long_names_are_shortened() {
    let name = "very".repeat(100);
    let text = GOOD.replace("Hand", &name);
    let resolver = MemoryResolver::default();
    let compiled = common::compiled(&text, &resolver);
    let page = DVec2::splat(120.0);
    let options = Options { page, scale: None };
    let sheet = sheet(&compiled, &text, &name, &resolver, &options).expect("a sheet");
    check_laws(&compiled, &sheet, page).expect("a good sheet");
    let texts = sheet
        .svg
        .split("</text>")
        .filter(|text| text.ends_with('…'));
    assert!(texts.count() >= 3, "the title, the caption and the mark");
}

#[test]
fn without_marks_the_sheet_suggests_some() {
    let text = GOOD.replace("$Mark #ff8000", "");
    let resolver = MemoryResolver::default();
    let compiled = common::compiled(&text, &resolver);
    let sheet = sheet(&compiled, &text, "a", &resolver, &options()).expect("a sheet");
    let marks = sheet.marks.iter().map(|mark| {
        let name = compiled.bindings.parts[mark.part].name.as_str();
        (name, mark.word.as_str(), mark.origin)
    });
    let marks: Vec<_> = marks.collect();
    // Red and blue are in the drawing. An arm that carries a hand is not an end.
    assert_eq!(
        marks,
        [
            ("Arm", "magenta", MarkOrigin::Suggested),
            ("Hand", "lime", MarkOrigin::Suggested)
        ]
    );
    assert!(sheet.svg.contains("add Mark lime to the string of Hand"));
}

/// The markup of a figure: a trunk and limbs anywhere around it, each with the number of what carries it.
fn figure(limbs: &[([f64; 4], f64, usize)]) -> String {
    let mut out = String::from(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"400\" height=\"400\">\n\
         <ellipse cx=\"200\" cy=\"200\" rx=\"40\" ry=\"60\" fill=\"#888\"><desc>P0$</desc></ellipse>\n",
    );
    for (index, ([x, y, width, height], angle, parent)) in limbs.iter().enumerate() {
        let number = index + 1;
        out.push_str(&format!(
            "<rect x=\"{x}\" y=\"{y}\" width=\"{width}\" height=\"{height}\" transform=\"rotate({angle} {x} {y})\" fill=\"#8{index}8\"><desc>P{number}@P{}</desc></rect>\n",
            parent % number
        ));
    }
    out + "</svg>"
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 24, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn sheets_of_generated_figures_can_be_cut_and_pinned(
        limbs in prop::collection::vec(
            ((60.0..300.0, 60.0..300.0, 4.0..120.0, 4.0..60.0), 0.0..360.0, 0_usize..20),
            0..9,
        ),
        letter in any::<bool>(),
    ) {
        let limbs: Vec<_> = limbs
            .into_iter()
            .map(|((x, y, width, height), angle, parent)| ([x, y, width, height], angle, parent))
            .collect();
        let text = figure(&limbs);
        let resolver = MemoryResolver::default();
        let compiled = common::compiled(&text, &resolver);
        prop_assert!(!compiled.has_errors(), "{text}");
        let page = if letter { DVec2::new(215.9, 279.4) } else { A4 };
        let options = Options { page, scale: None };
        let made = sheet(&compiled, &text, "$a@b", &resolver, &options).expect("a sheet");
        if let Err(error) = check_laws(&compiled, &made, page) {
            return Err(TestCaseError::fail(format!("{error}\n{text}")));
        }
        let again = sheet(&compiled, &text, "$a@b", &resolver, &options).expect("a sheet");
        prop_assert_eq!(made, again);
    }
}

#[test]
fn the_command_writes_a_sheet() {
    let room = Room::with("a.svg", GOOD);
    room.run(&["puppet", "a.svg"])
        .ends(0, "", "wrote a-puppet.svg: 3 pieces on 1 page");
    let first = room.read("a-puppet.svg");
    room.run(&["puppet", "a.svg"])
        .ends(0, "", "marks: #ff8000 on Hand");
    assert_eq!(first, room.read("a-puppet.svg"), "the same bytes twice");
    assert_eq!(room.files(), ["a-puppet.svg", "a.svg"]);
    let run = room.run(&[
        "puppet", "a.svg", "-o", "-", "--page", "Letter", "--scale", "0.5", "-q",
    ]);
    assert!(
        run.out
            .contains("width=\"215.9mm\" height=\"279.4mm\" viewBox=\"0 0 215.9 279.4\"")
    );
    assert!(run.out.contains("matrix(0.5"));
    room.run(&["puppet", "a.svg", "-o", "big.svg", "--scale", "1.5"])
        .ends(0, "", "--scale 1.5");
    assert_eq!(room.run(&["check", "big.svg"]).status, 0);
}

#[test]
fn wrong_uses_of_the_command_are_explained() {
    let room = Room::with("a.svg", GOOD);
    room.write(
        "empty.svg",
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"9\" height=\"9\"/>",
    );
    room.write("wrong.svg", GOOD.replace("Hand@Arm", "Hand@Leg"));
    room.write("b-puppet.svg", "<svg/>");
    room.write("b.svg", GOOD);
    for (arguments, status, message) in [
        (
            &["puppet", "a.svg", "-o", "a.svg"][..],
            2,
            "is the file that is read",
        ),
        (&["puppet", "a.svg", "-o", "empty.svg"], 2, "is a drawing"),
        (&["puppet", "b.svg"], 2, "`b-puppet.svg` is a drawing"),
        (&["puppet", "a.svg", "-o", "a.png"], 2, "must end in .svg"),
        (
            &["puppet", "empty.svg"],
            2,
            "`empty.svg` has no figure to cut out",
        ),
        (
            &["puppet", "wrong.svg"],
            1,
            "`wrong-puppet.svg` was not written",
        ),
        (&["puppet", "none.svg"], 2, "none.svg"),
        (
            &["puppet", "a.svg", "--page", "A5x"],
            2,
            "expected A4, Letter",
        ),
        (
            &["puppet", "a.svg", "--page", "10x10"],
            2,
            "from 80 to 2000 millimetres",
        ),
        (
            &["puppet", "a.svg", "--scale", "0"],
            2,
            "expected a number above 0",
        ),
        (
            &["puppet", "a.svg", "--scale", "100"],
            2,
            "the largest is `--scale ",
        ),
    ] {
        room.run(arguments).ends(status, "", message);
    }
    assert!(!room.files().contains(&"wrong-puppet.svg".to_owned()));
}
