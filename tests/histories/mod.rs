//! Histories of small drawings that have inputs of every kind: all keywords, motions, tracks of marks, characters, landscapes,
//! linked models and pictures, and files that change.

mod files;

use std::cell::{Cell, RefCell};
use std::collections::BTreeSet;

use okoshi::Memo;
use okoshi::compile::{Compiled, Compiler, Options, compile};
use okoshi::internals::lang::keyword::Keyword;
use okoshi::internals::lang::value::Setting;
use proptest::prelude::*;
use proptest::sample::Index;
use proptest::test_runner::{FileFailurePersistence, TestRunner};

use super::common::law::Tally;
use super::{common, equals, written};
use files::{Files, LINKS};

/// A small drawing with places for strings, each `{}`, and what is written there.
struct Subject {
    drawing: &'static str,
    strings: &'static [&'static [&'static str]],
}

const SUBJECTS: &[Subject] = &[
    // Solids, materials, and settings of the whole drawing.
    Subject {
        drawing: r##"<svg xmlns="http://www.w3.org/2000/svg" width="90" height="90">
<rect x="30" y="20" width="30" height="40" fill="#c86"/><text x="40" y="30" font-size="4">Body{}</text>
<rect x="58" y="24" width="25" height="9" fill="none" stroke="#222"/><circle cx="45" cy="10" r="9" fill="#eca"/><text x="43" y="11" font-size="4">Head@Body{}</text>
<rect x="58" y="36" width="25" height="9" fill="#36c"/><text x="64" y="41" font-size="4">Arm@Body{}</text>
<text x="2" y="80" font-size="4">%{}</text></svg>"##,
        strings: &[
            &[
                "",
                "$Color 1 0.8 0.6",
                "$Shape -cd default 20 30",
                "$Shape roundh -20 90 Segments 5",
                "$Metallic 1 Roughness 0.3",
                "$Stack 0.5 Offset 3",
                "$Texture \"picture.png\"",
                "$Shape model model.glb",
                "$Shape model other.glb",
            ],
            &[
                "",
                "$Offset 12",
                "$Stack 0.5",
                "$Axis 90",
                "$Roughness 0.1",
                "$Emissive 1 0.9 0.5",
                "$Alpha 0.3",
                "$Shape round Smooth 0",
            ],
            &[
                "",
                "$Origin start Shape cone",
                "$Texture \"picture.png\"",
                "$Shape -s model model.glb",
                "$Shape -s model other.glb",
                "$Segments 8",
                "$Smooth 0 Shape inflate 4",
                "$Depth 14",
            ],
            &[
                "Segments 8",
                "Smooth 0",
                "Scale 2",
                "Axes +x +z -y",
                "Ground 20 80",
                "Let thick 20 Let half (thick / 2) Shape default 0 (half)",
                "Bind center",
                "Bind outline",
                "Strokes all",
            ],
        ],
    },
    // A figure with motions, performed, limited and swinging, from files and built in.
    Subject {
        drawing: r##"<svg xmlns="http://www.w3.org/2000/svg" width="120" height="160">
<rect x="40" y="40" width="20" height="50"/><text x="50" y="65" font-size="4">Body{}</text>
<rect x="42" y="18" width="16" height="21"/><text x="50" y="28.5" font-size="4">Head@Body{}</text>
<rect x="12" y="44" width="30" height="8"/><text x="27" y="48" font-size="4">R{}</text>
<rect x="58" y="44" width="30" height="8"/><text x="73" y="48" font-size="4">L{}</text>
<rect x="40" y="91" width="8" height="54"/><text x="44" y="118" font-size="4">Rleg@Body</text>
<rect x="52" y="91" width="8" height="54"/><text x="56" y="118" font-size="4">Lleg@Body</text>
<text x="5" y="10" font-size="5">%{}</text></svg>"##,
        strings: &[
            &[
                "",
                "$Motion -l \"motion.bvh\"",
                "$Motion -i \"motion.bvh\"",
                "$Motion \"motion.bvh\" Perform \"marks.csv\" Limited 1 4",
                "$Size 1.5",
            ],
            // The last two are not strings of the part that they lie on.
            &[
                "",
                "$Swing 2",
                "$Carry change",
                "$Bend 3",
                "$Side both",
                "$Facing left",
                "$Mark green",
                "$Walk 40",
                "$Pose 1.5",
            ],
            // With both as legs it has four.
            &[
                "arm@Body$Mark red",
                "arm@Body$Mark red Follow Head",
                "arm@Body$Bone RightArm RightForeArm",
                "arm@Body",
                "leg@Body",
            ],
            &[
                "arm@Body",
                "arm@Body$Mark green",
                "arm@Body$Swing 3",
                "arm@Body$Bend 0",
                "arm@Body$Shape roundh",
                "arm@Body$Origin start",
                "leg@Body",
            ],
            &[
                // Such that one option after the other changes.
                "Motion \"motion.bvh\"",
                "Motion -i \"motion.bvh\"",
                "Motion -l \"motion.bvh\"",
                "Motion \"motion.bvh\" lying +z",
                "Motion \"motion.bvh\" Limited 1 4",
                "Motion \"motion.bvh\" Limited 2 6",
                "Motion \"motion.bvh\" Limited 2 6 Held 2 3",
                "Motion \"motion.bvh\" Held 1 2 2 0",
                "Motion punch Perform \"marks.csv\"",
                "Motion punch Perform -e \"marks.csv\"",
                "Motion punch Perform -ec \"marks.csv\"",
                "Motion walk",
                "Motion walk 1 wave",
                "Motion walk 1 wave speed 2",
                "Motion -i walk 1 wave speed 2",
                "Motion -l \"motion.bvh\" .3 walk 1",
                "Motion \"motion.bvh\" from .1 to .3",
                "Perform \"marks.csv\" Motion \"motion.bvh\"",
                "Perform \"marks.csv\" Motion punch Limited 2 12",
                "Motion walk Limited 4 30",
                "Limited 4 30 Motion punch",
            ],
        ],
    },
    // Shapes that lie on each other, gradients, a pattern, and lines.
    Subject {
        drawing: r##"<svg xmlns="http://www.w3.org/2000/svg" width="120" height="120"><defs>
<radialGradient id="r" gradientUnits="userSpaceOnUse" cx="50" cy="60" r="40" fx="45" fy="50"><stop offset="0" stop-color="#eec"/><stop offset="1" stop-color="#c42"/></radialGradient>
<linearGradient id="l" gradientUnits="userSpaceOnUse" x1="70" y1="60" x2="90" y2="64"><stop offset="0" stop-color="#482"/><stop offset="1" stop-color="#248"/></linearGradient>
<pattern id="p" width="4" height="4" patternUnits="userSpaceOnUse"><rect width="2" height="2" fill="#e42"/></pattern></defs>
<ellipse cx="50" cy="60" rx="30" ry="40" fill="url(#r)"/><text x="50" y="92" font-size="4">Body{}</text>
<circle cx="40" cy="45" r="9" fill="#eee"/><circle cx="42" cy="46" r="4" fill="#222"/><text x="36" y="52" font-size="2">Eye@Body{}</text>
<circle cx="60" cy="45" r="9" fill="#eee"/><path d="M36 75q14 12 28 0" fill="none" stroke="#242" stroke-width="2"/>
<rect x="22" y="80" width="56" height="9" fill="url(#p)" stroke="#224" stroke-width="1"/>
<ellipse cx="82" cy="60" rx="14" ry="9" fill="url(#l)"/><text x="84" y="60" font-size="4">Arm@Body{}</text>
<text x="2" y="116" font-size="4">%{}</text></svg>"##,
        strings: &[
            &[
                "",
                "$Shape inflate",
                "$Shape inflate Offset 2",
                "$Shape cone",
                "$Shape roundv",
                "$Shape roundh -20 40",
            ],
            &["", "$Shape inflate", "$Shape inflate Offset 8", "$Stack 2"],
            &[
                "",
                "$Shape inflate",
                "$Shape inflate Offset -20",
                "$Shape roundv",
                "$Axis 40",
            ],
            &[
                "Shape inflate",
                "Shape inflate 12",
                "Shape inflate Strokes lines",
                "Shape inflate Strokes all",
                "Shape inflate Strokes all Segments 6",
                "Shape inflate Strokes all Smooth 0",
                "Shape round Strokes all",
                "Strokes all",
                "Bind center",
                "Bind outline",
                "Stack 0.4",
            ],
        ],
    },
    // A character that is drawn twice.
    Subject {
        drawing: r##"<svg xmlns="http://www.w3.org/2000/svg" width="200" height="100">
<g><rect x="10" y="10" width="60" height="60" fill="#ecb"/><circle cx="40" cy="40" r="9" fill="#c42"/><circle cx="20" cy="25" r="5" fill="#246"/>
<text x="36" y="42" font-size="4">Nose{}</text><text x="18" y="26" font-size="4">Eye</text><text x="10" y="90" font-size="6">Boy{}</text></g>
<g><rect x="120" y="10" width="40" height="60" fill="#ecb"/><circle cx="152" cy="40" r="9" fill="#c42"/><circle cx="140" cy="25" r="4" fill="#246"/>
<text x="149" y="42" font-size="4">Nose</text><text x="138" y="26" font-size="4">Eye{}</text><text x="120" y="90" font-size="6">Boy{}</text></g></svg>"##,
        strings: &[
            &["", "$Depth 14", "$Depth -3"],
            &[
                "$View 0 0",
                "$View 0 0 Backing",
                "$View 0 0 Match thesis",
                "$View 0 0 Mirror off",
                "$View 15 0",
            ],
            &["", "$Hidden", "$Depth 2"],
            &[
                "$View 45 0",
                "$View 45 0 Backing",
                "$View 45 0 Backing Mirror",
                "$View 45 0 Mirror",
                "$View 45 10",
                "$View 40 10",
            ],
        ],
    },
    // A character in two pictures.
    Subject {
        drawing: r##"<svg xmlns="http://www.w3.org/2000/svg" width="200" height="100">
<g><image x="10" y="10" width="48" height="48" href="front.png"/><text x="10" y="90" font-size="6">Bird{}</text></g>
<g><image x="110" y="10" width="48" height="48" href="side.png"/><text x="110" y="90" font-size="6">Bird{}</text></g></svg>"##,
        strings: &[
            &[
                "$View 0 0",
                "$View 0 0 Backing",
                "$View 0 0 Mirror",
                "$View 0 0 Backing Match thesis",
                "$View 5 0",
            ],
            &["$View 30 0", "$View 45 0", "$View 45 10", "$View 0 30"],
        ],
    },
    // A landscape with props: clones, copies, loose shapes, one with a string of its own.
    Subject {
        drawing: r##"<svg xmlns="http://www.w3.org/2000/svg" width="120" height="100">
<g><rect width="100" height="40" fill="#4caf50"/><rect y="40" width="60" height="20" fill="#8d6e63"/><rect x="60" y="40" width="40" height="20" fill="#42a5f5"/>
<text y="90" font-size="6">Land{}</text></g>
<g><text x="20" y="90" font-size="6">Props{}</text>
<g id="t"><rect x="10" y="10" width="4" height="12" fill="#6b4a2f"/><circle cx="12" cy="8" r="7" fill="#2f7d3b"/><text x="10" y="8" font-size="2">Tree{}</text></g>
<use href="#t" x="20" y="4"/><use href="#t" x="70" y="30"/>
<rect x="40" y="20" width="4" height="12" fill="#6b4a2f"/><circle cx="42" cy="20" r="5" fill="#2f7d3b"/>
<image x="50" y="10" width="12" height="12" href="picture.png"/></g>
<text x="60" y="90" font-size="6">%{}</text></svg>"##,
        strings: &[
            &["$Tiles 10", "$Tiles 20", "$Tiles 10 Height 1", ""],
            &[
                "$Stand",
                "$Stand Shape inflate",
                "$Stand Shape flat",
                "",
                "$Tiles 10",
            ],
            &["", "$Shape round", "$Stand 30 40", "$Color 1 0 0", "@Land"],
            &["Smooth 0", "Stand", "Shape default -1 1", "Scale 5"],
        ],
    },
    // A landscape, drawn and in a picture.
    Subject {
        drawing: r##"<svg xmlns="http://www.w3.org/2000/svg" width="200" height="100">
<g><rect width="40" height="30" fill="#4caf50"/><rect y="30" width="40" height="10" fill="#8d6e63"/><rect x="60" width="10" height="10" fill="#4caf50"/>
<text x="62" y="6" font-size="4">{}</text><text y="80" font-size="6">Land{}</text></g>
<g><image x="100" width="40" height="40" href="picture.png"/><text x="100" y="80" font-size="6">Map{}</text></g></svg>"##,
        strings: &[
            &["$Tile green", "$Tile green Color #88bb44", "* sample"],
            &[
                "$Tiles 10",
                "$Tiles 10 Bevel 0.2",
                "$Tiles 10 Roof 0.5",
                "$Tiles 10 Height 2",
                "$Tiles 5",
            ],
            &["$Tiles 10", "$Tiles 8 Bevel 0.1", ""],
        ],
    },
];

/// A step of a history.
#[derive(Debug, Clone)]
enum Step {
    /// Writes another string at a place.
    Choose(Index, Index),
    /// Writes the string there that differs least from the one that is there.
    Next(Index),
    /// Removes characters from a string, or types some.
    Type(Index, Index, usize, &'static str),
    /// Changes a number or a colour of the drawing, by a little or by much, or changes it back.
    Attribute(Index, &'static str),
    /// Changes a linked file, or removes it.
    File(Index, usize),
    Undo,
    Tolerance(bool),
}

fn step() -> impl Strategy<Value = Step> {
    let index = any::<Index>;
    let digits = prop::sample::select(vec![".001", ".7", "0", COLOR]);
    let typed = prop::sample::select(vec!["", "1", " ", "$", "e", "@Body", ".5", "\""]);
    prop_oneof![
        4 => (index(), index()).prop_map(|(place, string)| Step::Choose(place, string)),
        5 => index().prop_map(Step::Next),
        4 => (index(), index(), 0..3_usize, typed)
            .prop_map(|(place, at, gone, typed)| Step::Type(place, at, gone, typed)),
        4 => (index(), digits).prop_map(|(which, digits)| Step::Attribute(which, digits)),
        5 => (index(), 0..files::VERSIONS).prop_map(|(file, version)| Step::File(file, version)),
        2 => Just(Step::Undo),
        1 => any::<bool>().prop_map(Step::Tolerance),
    ]
}

/// In place of digits: that a colour is changed.
const COLOR: &str = "";

/// The drawing with these strings.
fn text(drawing: &str, strings: &[String]) -> String {
    let mut pieces = drawing.split("{}");
    let mut text = pieces.next().unwrap_or_default().to_owned();
    for (piece, string) in pieces.zip(strings) {
        text += string;
        text += piece;
    }
    text
}

/// The text with these digits after a number of an attribute, or with another colour.
fn with_digits(text: &str, which: Index, digits: &str) -> String {
    let mut attributes: Vec<&str> = text.split('"').collect();
    let is_digits = |value: &str| !value.is_empty() && value.bytes().all(|b| b.is_ascii_digit());
    let is_chosen = |at: &usize| match digits {
        COLOR => attributes[*at].starts_with('#'),
        _ => is_digits(attributes[*at]),
    };
    let those: Vec<usize> = (0..attributes.len()).filter(is_chosen).collect();
    if those.is_empty() {
        return text.to_owned();
    }
    let chosen = *which.get(&those);
    let changed = match digits {
        COLOR => attributes[chosen].replacen(['c', 'e', '2', '4'], "7", 1),
        _ => format!("{}{digits}", attributes[chosen]),
    };
    attributes[chosen] = &changed;
    attributes.join("\"")
}

/// The names of all files.
fn links() -> impl Iterator<Item = &'static str> {
    LINKS.iter().map(|(link, _)| *link)
}

/// What the histories have seen.
#[derive(Default)]
struct Seen {
    compiles: Cell<usize>,
    partial: Tally,
    without_errors: Tally,
    /// The keywords that were bound in drawings without errors.
    keywords: RefCell<BTreeSet<Keyword>>,
    /// The links to files whose change changed the model.
    files: RefCell<BTreeSet<&'static str>>,
}

impl Seen {
    fn note(&self, compiled: &Compiled) {
        self.without_errors.count(!compiled.has_errors());
        if compiled.has_errors() {
            return;
        }
        let bindings = &compiled.bindings;
        let own = bindings.strings.iter().flat_map(|string| &string.settings);
        let defaults = bindings.defaults.iter().map(|(_, setting)| setting);
        let mut keywords = self.keywords.borrow_mut();
        for setting in own.chain(defaults) {
            let inner = [&setting.limited, &setting.held, &setting.performance];
            let inner = inner.into_iter().flatten().map(|inner| &**inner);
            let found = inner
                .chain([setting])
                .map(|setting: &Setting| setting.keyword);
            keywords.extend(found);
        }
    }
}

/// Follows a history and checks after each step that both ways to compile agree in everything.
fn agree(
    subject: &Subject,
    first: &[Index],
    steps: &[Step],
    seen: &Seen,
) -> Result<(), TestCaseError> {
    let mut files = Files::default();
    let mut options = Options::default();
    let mut compiler = Compiler::default();
    let mut surfaces = Memo::default();
    let chosen = subject.strings.iter().zip(first);
    let mut strings: Vec<String> = chosen
        .map(|(all, which)| (*which.get(all)).to_owned())
        .collect();
    let mut undo: Vec<Vec<String>> = Vec::new();
    let mut digits: Option<(Index, &str)> = None;
    let mut last: Option<Compiled> = None;
    for number in 0..=steps.len() {
        let act = number.checked_sub(1).map(|number| &steps[number]);
        let before = strings.clone();
        let mut changed = None;
        match act {
            None => {}
            Some(Step::Choose(place, which)) => {
                let place = place.index(strings.len());
                strings[place] = (*which.get(subject.strings[place])).to_owned();
                undo.push(before);
            }
            Some(Step::Next(place)) => {
                let place = place.index(strings.len());
                let all = subject.strings[place];
                let now = all.iter().position(|string| *string == strings[place]);
                strings[place] = all[now.map_or(0, |now| (now + 1) % all.len())].to_owned();
                undo.push(before);
            }
            Some(Step::Type(place, at, gone, typed)) => {
                let string = &mut strings[place.index(before.len())];
                let start = at.index(string.len() + 1);
                let end = (start + gone).min(string.len());
                string.replace_range(start..end, typed);
                undo.push(before);
            }
            Some(Step::Attribute(which, added)) => {
                digits = digits.is_none().then_some((*which, *added));
            }
            Some(Step::File(file, version)) => {
                // One that the drawing links to now, if there is any.
                let now = text(subject.drawing, &strings);
                let linked: Vec<&str> = links().filter(|link| now.contains(link)).collect();
                let link = if linked.is_empty() {
                    file.get(LINKS).0
                } else {
                    file.get(&linked)
                };
                files.set(link, *version);
                changed = Some(link);
            }
            Some(Step::Undo) => strings = undo.pop().unwrap_or(strings),
            Some(Step::Tolerance(coarse)) => options.tolerance = if *coarse { 0.01 } else { 0.001 },
        }
        let text = text(subject.drawing, &strings);
        let text = match digits {
            Some((which, digits)) => with_digits(&text, which, digits),
            None => text,
        };
        let incremental = compiler.compile(&text, &options, &files);
        let fresh = compile(&text, &options, &files);
        prop_assert!(!fresh.has_crashed(), "{:?} made {}", act, text);
        equals(&incremental, &fresh, &act, &text)?;
        let written = written(&incremental, &mut surfaces);
        prop_assert!(written == common::glb(&fresh), "{:?} made {}", act, text);
        seen.compiles.set(seen.compiles.get() + 1);
        seen.partial.count(compiler.last_was_partial());
        seen.note(&fresh);
        if let (Some(link), Some(last)) = (changed, &last)
            && last.scene != fresh.scene
        {
            seen.files.borrow_mut().insert(link);
        }
        // What is still held must not change; every other time it is dropped.
        last = Some(if number % 2 == 0 { incremental } else { fresh });
    }
    Ok(())
}

#[test]
fn inputs_of_every_kind_are_compiled_again_when_they_change() {
    let config = ProptestConfig {
        cases: 840,
        failure_persistence: Some(Box::new(FileFailurePersistence::Direct(
            "tests/regressions/histories.txt",
        ))),
        ..ProptestConfig::default()
    };
    let seen = Seen::default();
    let strategy = (
        any::<Index>(),
        prop::collection::vec(any::<Index>(), 5),
        prop::collection::vec(step(), 1..6),
    );
    let found = TestRunner::new(config).run(&strategy, |(which, first, steps)| {
        agree(which.get(SUBJECTS), &first, &steps, &seen)
    });
    if let Err(error) = found {
        panic!("{error}");
    }
    let keywords = seen.keywords.into_inner();
    let missing = Keyword::ALL
        .iter()
        .filter(|keyword| !keywords.contains(keyword));
    let missing: Vec<_> = missing.collect();
    assert!(
        missing.is_empty(),
        "never bound without an error: {missing:?}"
    );
    let changed = seen.files.into_inner();
    let unseen: Vec<&str> = links().filter(|link| !changed.contains(link)).collect();
    assert!(
        unseen.is_empty(),
        "whose changes changed no model: {unseen:?}"
    );
    let compiles = seen.compiles.get();
    assert!(compiles > 2000, "{compiles} compiles");
    // They are 56 % and 75 %.
    seen.partial
        .assert_share("compiles that only updated the drawing", 21);
    seen.without_errors
        .assert_share("drawings without errors", 51);
}
