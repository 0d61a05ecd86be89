//! What hangs on what: laws of the hierarchy over drawings of many kinds.

mod common;

use std::collections::BTreeMap;
use std::fs;
use std::path::PathBuf;

use common::law::{self, Tally};
use okoshi::Memo;
use okoshi::internals::bind::{PartId, PartKind, bind, in_layers_of_pixels, makes_pose_layer};
use okoshi::internals::svg;
use okoshi::resolver::MemoryResolver;
use proptest::prelude::*;

/// Larger drawings take long, and say no more.
const LONGEST: usize = 200_000;

/// The drawings in a folder and those in it.
fn drawings(folder: &str) -> Vec<(PathBuf, String)> {
    let read = |path: PathBuf| {
        let text = fs::read(&path).expect("a file");
        let text = String::from_utf8_lossy(&text).into_owned();
        (path, text)
    };
    common::drawings_in(folder).into_iter().map(read).collect()
}

/// A shape, by where its element is in the file, and whether it is its stroke.
type Place = (usize, bool);

/// A node of the hierarchy.
#[derive(Debug, Clone, PartialEq, Eq)]
struct Node {
    /// Empty for one that the program named: its number says how many others there are.
    name: String,
    parent: Option<Place>,
    /// Whether it is a line that may be a guide: without a name, or with an id where strings name the parts.
    may_be_guide: bool,
}

/// What hangs on what in a drawing.
#[derive(Default)]
struct Hierarchy {
    nodes: BTreeMap<Place, Node>,
    /// Whether its texts are strings, or it has none.
    is_read: bool,
}

impl Hierarchy {
    fn of(text: &str) -> Self {
        let resolver = MemoryResolver::default();
        let (drawing, _) = svg::read(
            text,
            0.001,
            &resolver,
            &in_layers_of_pixels,
            &makes_pose_layer,
        );
        let bindings = bind(&drawing, &Memo::none(), &mut Vec::new());
        let place = |part: PartId| {
            let part = &bindings.parts[part];
            (
                drawing.shapes[part.shape].element.span.start,
                part.is_stroke,
            )
        };
        let named_by_strings = bindings
            .strings
            .iter()
            .any(|string| string.binding.is_some());
        let parts = bindings.parts.iter_enumerated();
        let mains = parts.filter(|(_, part)| part.kind == PartKind::Main);
        let nodes = mains.map(|(index, part)| {
            let node = Node {
                name: match part.is_automatic() {
                    true => String::new(),
                    false => part.name.clone(),
                },
                parent: part.parent.map(place),
                may_be_guide: part.is_stroke
                    && (part.is_automatic() || named_by_strings && part.named_by.name() == "id"),
            };
            (place(index), node)
        });
        Self {
            nodes: nodes.collect(),
            is_read: bindings.annotated || drawing.labels.is_empty(),
        }
    }
}

/// A drawing with one more text.
fn with_text(drawing: &str, string: &str) -> Option<String> {
    let end = drawing.rfind("</svg>")?;
    let (start, end) = drawing.split_at(end);
    Some(format!(
        "{start}<text x=\"-9999\" y=\"-9999\" font-size=\"1\">{string}</text>{end}"
    ))
}

/// Drawings of 200 by 200 whose parts come and go most easily: lines with names, and names without strings.
const LINES: [&str; 5] = [
    // A bobble hangs on an antenna, and that on a head.
    r##"<circle cx="90" cy="90" r="30" id="head"/><rect x="60" y="115" width="60" height="60" id="body"/>
<path d="M 90 65 V 20" stroke="#000" stroke-width="3" fill="none" inkscape:label="antenna"/><circle cx="90" cy="16" r="8" id="bobble"/>"##,
    // Lines beside all shapes: one with a name, one in a group with a name, one without.
    r##"<rect x="60" y="115" width="60" height="60" id="body"/><circle cx="90" cy="90" r="30" id="head"/>
<path d="M 10 10 H 50" stroke="#000" stroke-width="3" fill="none" id="wire"/>
<g id="spring"><path d="M 10 30 H 50" stroke="#000" stroke-width="3" fill="none"/></g>
<path d="M 10 50 H 50" stroke="#000" stroke-width="3" fill="none"/>"##,
    // The same with strings, and hairlines.
    r##"<rect x="60" y="115" width="60" height="60" id="body"/><text x="80" y="150">Body</text>
<circle cx="90" cy="90" r="30"/><text x="80" y="90">Head@Body</text><circle cx="15" cy="40" r="9" id="bead"/>
<path d="M 10 10 H 50" stroke="#000" stroke-width="3" fill="none" inkscape:label="wire"/>
<path d="M 10 20 H 50" stroke="#000" stroke-width="3" fill="none" id="rope"/><text font-size="5" x="20" y="41">Bead@rope</text>
<path d="M 10 30 H 50" stroke="#000" stroke-width="0.1" fill="none" inkscape:label="thread"/>"##,
    // One name, and hairlines.
    r##"<circle cx="90" cy="90" r="30"/><circle cx="80" cy="80" r="5" id="eye"/>
<path d="M 10 30 H 50" stroke="#000" stroke-width="0.1" fill="none"/>"##,
    // A description that is no name as long as no string is about a part.
    r##"<circle cx="90" cy="90" r="30"><desc>Drawing</desc></circle><circle cx="80" cy="80" r="5"><desc>Drawing</desc></circle>"##,
];

/// A text about the whole drawing leaves the hierarchy as it is, but for lines that may be guides if it ends the first look or says what
/// becomes of lines.
#[test]
fn settings_of_a_drawing_change_no_hierarchy() {
    let tally = Tally::default();
    let inline = LINES.iter().map(|elements| {
        let text = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" xmlns:inkscape=\"http://www.inkscape.org/namespaces/inkscape\" width=\"200\" height=\"200\">{elements}</svg>"
        );
        (PathBuf::from(*elements), text)
    });
    let folders = ["tests/cases", "examples", "tests/binding/art"];
    let all = inline.chain(folders.into_iter().flat_map(drawings));
    for (path, text) in all.filter(|(_, text)| text.len() < LONGEST) {
        let before = Hierarchy::of(&text);
        tally.count(before.is_read && !before.nodes.is_empty());
        if !before.is_read {
            continue;
        }
        for string in [
            "%Shape inflate",
            "%Color #ff0000 Roughness 0.4",
            "%Strokes all",
        ] {
            let Some(text) = with_text(&text, string) else {
                continue;
            };
            let after = Hierarchy::of(&text);
            let says_lines = string.contains("Strokes");
            let may_change =
                |node: &Node| node.may_be_guide && (says_lines || string.contains("Shape"));
            for (place, node) in &before.nodes {
                let now = after.nodes.get(place);
                let gone = now.is_none() && may_change(node);
                assert!(
                    gone || now == Some(node),
                    "{} with {string}: {node:?} became {now:?}\n{}",
                    path.display(),
                    &text[place.0..text.len().min(place.0 + 300)],
                );
            }
            for (place, node) in &after.nodes {
                let is_new = !before.nodes.contains_key(place);
                assert!(
                    !is_new || says_lines && place.1,
                    "{} with {string}: {node:?} is new",
                    path.display()
                );
            }
        }
    }
    tally.assert_share("drawings with parts that are read", 80);
}

/// The pieces of limbs, from the trunk outward.
const LIMBS: [[&str; 3]; 4] = [
    ["upper arm", "forearm", "hand"],
    ["thigh", "shin", "foot"],
    ["上腕", "前腕", "手"],
    ["太もも", "脛", "足首"],
];

/// Words for both sides in front of a name, and for none.
const SIDES: [[&str; 2]; 3] = [["left ", "right "], ["左", "右"], ["", ""]];

/// Pieces of limbs that are siblings in a named group hang on each other from the trunk outward, wherever they lie and in whatever order
/// they are drawn; each on its own side.
#[test]
fn pieces_in_one_group_hang_on_each_other_outward() {
    let names = (0..LIMBS.len(), 0..SIDES.len()).prop_map(|(limb, sides)| {
        let sides = SIDES[sides].map(|side| LIMBS[limb].map(|piece| format!("{side}{piece}")));
        let is_sided = sides[0] != sides[1];
        sides[..if is_sided { 2 } else { 1 }].concat()
    });
    let places = prop::collection::vec((0.0..160.0_f64, 0.0..160.0_f64), 6);
    let inputs = (
        names.prop_flat_map(|names| (Just(names.clone()), Just(names).prop_shuffle())),
        places,
    );
    law::check(law::config(200), 30, inputs, |((names, order), places)| {
        let pieces = order.iter().zip(&places).map(|(name, (x, y))| {
            format!("<rect x=\"{x}\" y=\"{y}\" width=\"30\" height=\"20\" id=\"{name}\"/>\n")
        });
        let pieces = pieces.collect::<String>();
        let text = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"200\" height=\"200\">\
             <rect x=\"60\" y=\"60\" width=\"60\" height=\"80\" id=\"body\"/><g id=\"limbs\">{pieces}</g></svg>"
        );
        let hierarchy = Hierarchy::of(&text);
        let parent = |name: &str| {
            let mut nodes = hierarchy.nodes.values();
            let node = nodes.find(|node| node.name == name)?;
            Some(hierarchy.nodes[&node.parent?].name.as_str())
        };
        for limb in names.chunks(3) {
            prop_assert_eq!(parent(&limb[1]), Some(limb[0].as_str()), "{}", text);
            prop_assert_eq!(parent(&limb[2]), Some(limb[1].as_str()), "{}", text);
            let outer = parent(&limb[0]);
            prop_assert!(outer.is_none_or(|outer| !limb.iter().any(|name| name == outer)));
        }
        Ok(names.len() == 6)
    });
}

/// The paw of a near leg lies over the far leg, too, and more of it may than over its own.
#[test]
fn what_is_left_hangs_on_no_limb_that_is_right() {
    for [near, far] in [["left", "right"], ["right", "left"], ["左", "右"]] {
        let text = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 100 90\">\
             <path id=\"{far} leg\" d=\"M30 40h10v34h-10z\"/><path id=\"body\" d=\"M15 20h70v28h-70z\"/>\
             <path id=\"{near} leg\" d=\"M22 40h10v34h-10z\"/>\
             <ellipse id=\"{near} leg end\" cx=\"34\" cy=\"72\" rx=\"10\" ry=\"4\"/></svg>"
        );
        let hierarchy = Hierarchy::of(&text);
        let named = |name: String| {
            let mut nodes = hierarchy.nodes.iter();
            nodes.find(|(_, node)| node.name == name).expect("a part")
        };
        let (_, end) = named(format!("{near} leg end"));
        let (leg, _) = named(format!("{near} leg"));
        assert_eq!(end.parent, Some(*leg), "{near}");
    }
}
