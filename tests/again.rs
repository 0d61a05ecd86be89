//! Incremental compiling gives what compiling from scratch gives, whatever was edited before.

mod common;
mod histories;

use std::fmt::Debug;
use std::fs;
use std::path::Path;
use std::sync::{Arc, LazyLock};

use common::law::{self, Tally};
use okoshi::Memo;
use okoshi::compile::{Compiled, Compiler, Options, compile};
use okoshi::export::{GLB, to_memory};
use okoshi::internals::source::Text;
use okoshi::resolver::{LinkError, Resolver};
use proptest::prelude::*;
use proptest::sample::Index;
use proptest::test_runner::{FileFailurePersistence, TestRunner};

/// What is typed or pasted into strings.
const PIECES: &[&str] = &[
    "a",
    "k",
    "1",
    "-",
    ".",
    " ",
    "  ",
    "$",
    "@",
    "%",
    "*",
    "#",
    "\"",
    "(",
    ")",
    "あ",
    "Ｕ",
    "🦀",
    "é",
    "e\u{301}",
    "\t",
    "\n",
    "\u{a0}",
    "\u{3000}",
    "\u{200b}",
    "]",
    "]]",
    ">",
    "=>",
    "'",
    "@Ubody",
    "@arm",
    "$Shape ",
    "roundv -90 90",
    " Axis 30",
    " -s",
    " -d",
    " Color red",
    "Shape none",
    "$Texture gull.png",
    "$Tiles 16",
    "$Tile green",
    " Roof 0.5",
    "Shape model duck.glb",
    " Origin start",
    "%Let a = 3",
    "(a * 2)",
    "%Scale 2",
    "%Strokes all",
    "%Bind outline",
    "#",
    "* ",
    "arm",
    "body",
    "okoshi-",
    "\"okoshi-1",
    "'okoshi--",
    "legend",
    "Group",
];

/// Markup that is inserted anywhere.
const SIGNS: &[&str] = &[
    "<",
    ">",
    "&",
    "\"",
    "'",
    "/",
    "=",
    ";",
    "]]>",
    "<!--",
    "-->",
    "</text>",
    "<tspan>",
    "<desc>a$</desc>",
    "&amp;",
    "&e;",
    "\r",
    "\n",
    "\r\n",
    "\u{1}",
    "\u{fffe}",
    "\u{feff}",
    "0",
    "9",
    "-",
    " ",
    "x",
    "url(#g)",
    "display=\"none\"",
    "<text x=\"3\" y=\"4\">new</text>",
    "<rect width=\"4\" height=\"3\"/>",
    "<![CDATA[",
    "id=\"b\"",
];

/// Drawings with strings in every notation.
const DRAWINGS: &[&str] = &[
    // Entities, CDATA, lines, spaces, comments between.
    r#"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 90 60" width="9cm">
<rect id="body" x="30" y="20" width="20" height="30"/>
<text x="30" y="24" text-anchor="middle">Ubody</text>
<rect x="50" y="22" width="30" height="8" fill="red"/>
<text xml:space="preserve" x="60" y="25">arm<tspan x="60" y="30">@Ubody </tspan><tspan dy="5">$Shape roundv -90 90</tspan> <!-- an --> end</text>
<text x="70" y="50">c&amp;d&#x40;Ubody$Axis 35</text><circle r="8" cx="20" cy="10"/><text y="10" x="19" text-anchor="end" font-size="6">a&amp;b&#x40;Ubody<![CDATA[$Axis]]> 30</text>
<text x="1" y="5"><![CDATA[%Let a = 3]]></text><text x="2" y="9">%Scale 2&lt;</text><text x="3" y="60"># Notiz</text></svg>"#,
    // Descriptions, clones, groups, leaders, connectors, titles, hidden texts and texts in definitions.
    r##"<svg xmlns="http://www.w3.org/2000/svg" xmlns:xlink="http://www.w3.org/1999/xlink" xmlns:inkscape="http://www.inkscape.org/namespaces/inkscape" width="200" height="200">
<title>arm</title><style>.c { fill: blue } text { font-size: 5px }</style>
<defs><text id="unseen">in definitions</text><linearGradient id="g"><stop offset="0" stop-color="red"/><stop offset="1" stop-color="blue"/></linearGradient>
<pattern id="p" width="4" height="4" patternUnits="userSpaceOnUse"><rect width="2" height="2"/></pattern></defs>
<g id="limbs"><desc>torso$Shape default -5 5</desc><rect x="60" y="60" width="40" height="70" fill="url(#g)"/><rect x="70" y="70" width="9" height="9" fill="url(#p)"/></g>
<rect id="one" x="100" y="60" width="50" height="12" class="c"><title>not this</title><desc>arm@torso$Shape roundh -90 90</desc></rect>
<use xlink:href="#one" y="40"><desc>leg@torso</desc></use><use xlink:href="#limbs" x="90" y="60"/>
<g><text x="10" y="10">outer <tspan y="20">line</tspan></text><text x="20" y="100">second</text><circle cx="10" cy="100" r="8"/><circle cx="30" cy="150" r="8"/></g>
<text id="far" x="150" y="180">head@torso</text><circle id="head" cx="80" cy="40" r="15" fill="green"/>
<path d="M150 178 L82 42" fill="none" stroke="black"/><path d="M0 0 9 9" fill="none" stroke="black" inkscape:connection-start="#far" inkscape:connection-end="#head"/>
<text x="5" y="190" display="none">hidden</text><text x="9" y="199"> </text><text x="5" y="195"><desc>of a text</desc>* left out</text><rect x="2" y="188" width="5" height="5"/>
<rect x="180" y="5" width="9" height="9" fill="#00f"/><text x="181" y="9">=$Color red</text></svg>"##,
    // Entities of the drawing; Japanese, emoji; a link to a file and a broken one.
    "<!DOCTYPE svg [<!ENTITY e \"胴\"><!ENTITY m \"腕＠胴\"><!ENTITY t \"twice\">]>\r\n\
<svg xmlns=\"http://www.w3.org/2000/svg\" xmlns:xlink=\"http://www.w3.org/1999/xlink\" width=\"100\" height=\"100\">\r\n\
<rect x=\"20\" y=\"20\" width=\"30\" height=\"40\"/><text x=\"22\" y=\"30\">&e;＄形 丸 －９０ ９０</text>\r\n\
<rect x=\"60\" y=\"20\" width=\"30\" height=\"10\"/><text x=\"62\" y=\"25\">&m;</text>\r\n\
<circle cx=\"30\" cy=\"80\" r=\"9\"/><text x=\"30\" y=\"80\">🦀🦀@胴\r\n  $Offset 3\r\n</text><text x='5' y='30'>&t;</text><text x='5' y='30'>&t;</text><rect x=\"3\" y=\"29\" width=\"4\" height=\"4\"/>\r\n\
<image x=\"60\" y=\"60\" width=\"30\" height=\"30\" xlink:href=\"gull.png\"/><text x=\"70\" y=\"75\">bird$Texture gull.png</text>\
<image x=\"0\" y=\"60\" width=\"9\" height=\"9\" xlink:href=\"missing.png\"/></svg>\r\n",
    // Tiles: drawn, in a readable picture and in a broken one.
    r##"<svg xmlns="http://www.w3.org/2000/svg" xmlns:xlink="http://www.w3.org/1999/xlink" width="200" height="200">
<g><rect width="40" height="30" fill="#4caf50"/><rect y="30" width="40" height="10" fill="#8d6e63"/><rect x="60" width="10" height="10" fill="#4caf50"/>
<text x="65" y="4" font-size="5">$Tile green</text><text y="150">Land$Tiles 10</text></g>
<g><image x="100" width="40" height="40" xlink:href="gull.png"/><text x="100" y="150">Picture$Tiles 10</text></g>
<g><image x="100" y="60" width="40" height="40" xlink:href="nothing.png"/><text x="100" y="190">Nothing$Tiles 10</text></g>
<rect x="10" y="100" width="9" height="30" fill="red"/><text x="12" y="110">Tower@Roof$Tile</text></svg>"##,
];

static EXAMPLES: LazyLock<Vec<String>> = LazyLock::new(|| {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples");
    let read = |name: String| fs::read_to_string(root.join(name + ".svg")).expect("an example");
    common::examples().into_iter().map(read).collect()
});

/// The pictures and models beside the examples, which can be missing.
struct Files {
    gull: Option<Arc<[u8]>>,
    canvas: Arc<[u8]>,
    model: Arc<[u8]>,
}

impl Files {
    fn new() -> Self {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples");
        let read = |name: &str| Arc::from(fs::read(root.join(name)).expect("a file"));
        Self {
            gull: Some(read("gull.png")),
            canvas: read("canvas.png"),
            model: read("shapes/biscuit.glb"),
        }
    }
}

impl Resolver for Files {
    fn read(&self, link: &str) -> Result<Arc<[u8]>, LinkError> {
        match link {
            "gull.png" => self.gull.clone().ok_or(LinkError::Missing),
            "canvas.png" => Ok(Arc::clone(&self.canvas)),
            "duck.glb" | "biscuit.glb" => Ok(Arc::clone(&self.model)),
            _ => Err(LinkError::Missing),
        }
    }
}

/// A step of a history.
#[derive(Debug, Clone)]
enum Step {
    /// Replaces so many characters of a text by a piece.
    Type(Index, Index, Index, usize),
    /// Replaces so many characters anywhere by signs.
    Anywhere(Index, Index, usize),
    /// Changes a digit in a tag.
    Tag(Index, u8),
    /// Undoes so many steps.
    Undo(usize),
    /// Changes a linked file.
    File(u8),
    /// Clears the caches.
    Forget,
    /// Chooses a tolerance.
    Tolerance(bool),
}

fn step() -> impl Strategy<Value = Step> {
    let index = any::<Index>;
    prop_oneof![
        12 => (index(), index(), index(), 0..3_usize).prop_map(|(t, at, piece, gone)| Step::Type(t, at, piece, gone)),
        6 => (index(), index(), index()).prop_map(|(t, at, piece)| Step::Type(t, at, piece, 0)),
        2 => (index(), index(), 0..3_usize).prop_map(|(at, signs, gone)| Step::Anywhere(at, signs, gone)),
        2 => (index(), 0..10_u8).prop_map(|(at, digit)| Step::Tag(at, digit)),
        3 => (1..4_usize).prop_map(Step::Undo),
        1 => (0..3_u8).prop_map(Step::File),
        1 => Just(Step::Forget),
        1 => any::<bool>().prop_map(Step::Tolerance),
    ]
}

/// The texts of a drawing that can be typed in.
fn texts(compiled: &Compiled) -> Vec<&Text> {
    let drawing = &compiled.drawing;
    let groups = drawing.groups.iter().map(|group| &group.element);
    let elements = groups.chain(drawing.shapes.iter().map(|shape| &shape.element));
    let descs = elements.filter_map(|element| element.desc.as_deref());
    let labels = drawing.labels.iter().map(|(label, _)| &*label.text);
    descs.chain(labels).collect()
}

/// The byte range of so many characters of a text from a random one on.
fn range(text: &str, at: &Index, count: usize) -> (usize, usize) {
    let mut bounds: Vec<usize> = text.char_indices().map(|(at, _)| at).collect();
    bounds.push(text.len());
    let from = at.index(bounds.len());
    (bounds[from], bounds[(from + count).min(bounds.len() - 1)])
}

/// The text after a step.
fn edited(text: &str, last: &Compiled, act: &Step) -> String {
    let mut text = text.to_owned();
    match act {
        Step::Type(which, at, piece, count) => {
            let texts = texts(last);
            if !texts.is_empty() {
                let chosen = texts[which.index(texts.len())];
                let (from, to) = range(chosen.as_str(), at, *count);
                let span = chosen.span(from..to);
                // Half of the replacements only delete.
                let piece = match piece.index(2 * PIECES.len()) {
                    pick if pick < PIECES.len() => PIECES[pick],
                    pick if *count == 0 => PIECES[pick - PIECES.len()],
                    _ => "",
                };
                text.replace_range(span.start..span.end, piece);
            }
        }
        Step::Anywhere(at, signs, count) => {
            let (from, to) = range(&text, at, *count);
            text.replace_range(from..to, SIGNS[signs.index(SIGNS.len())]);
        }
        Step::Tag(at, digit) => {
            let digits: Vec<usize> = text
                .char_indices()
                .filter(|(_, c)| c.is_ascii_digit())
                .map(|(at, _)| at)
                .collect();
            if !digits.is_empty() {
                let at = digits[at.index(digits.len())];
                text.replace_range(at..=at, &digit.to_string());
            }
        }
        Step::Undo(_) | Step::File(_) | Step::Forget | Step::Tolerance(_) => {}
    }
    text
}

/// A compiled drawing without its scene, as text.
fn described(compiled: &Compiled) -> String {
    format!(
        "{:#?}\n{:#?}\n{:#?}\n{:#?}",
        compiled.diagnostics,
        compiled.dependencies,
        compiled.bindings.strings,
        compiled.drawing.labels
    )
}

/// Bindings and drawing, in one line.
fn all(compiled: &Compiled) -> String {
    format!("{:?}\n{:?}", compiled.bindings, compiled.drawing)
}

/// Whether both ways to compile a text give the same. `act` is the step that made it.
fn equals(
    incremental: &Compiled,
    fresh: &Compiled,
    act: &dyn Debug,
    text: &str,
) -> Result<(), TestCaseError> {
    let (found, expected) = (described(incremental), described(fresh));
    prop_assert_eq!(found, expected, "{:?} made {}", act, text);
    prop_assert!(all(incremental) == all(fresh), "{:?} made {}", act, text);
    prop_assert!(incremental.scene == fresh.scene, "{:?} made {}", act, text);
    Ok(())
}

/// The model, written with cached surfaces of the one before.
fn written(compiled: &Compiled, surfaces: &mut Memo) -> Vec<u8> {
    let model = to_memory(&GLB, &compiled.scene, Some(surfaces));
    model.expect("a scene keeps its own rules").bytes
}

/// Does some steps and checks after each that both ways to compile agree. Returns how often the
/// drawing was only updated, not parsed again.
fn agree(drawing: &str, acts: &[Step]) -> Result<usize, TestCaseError> {
    let mut files = Files::new();
    let mut options = Options::default();
    let mut compiler = Compiler::default();
    let mut text = drawing.to_owned();
    let mut undo = Vec::new();
    let mut last = compiler.compile(&text, &options, &files);
    let mut partial = 0;
    let mut surfaces = Memo::default();
    for (step, act) in acts.iter().enumerate() {
        match act {
            Step::Undo(count) => {
                for _ in 0..*count {
                    text = undo.pop().unwrap_or(text);
                }
            }
            Step::File(0) => files.gull = None,
            Step::File(1) => files.gull = Some(Arc::clone(&files.canvas)),
            Step::File(_) => files.gull = Files::new().gull,
            Step::Forget => compiler.forget(),
            Step::Tolerance(coarse) => options.tolerance = if *coarse { 0.01 } else { 0.001 },
            _ => {
                let next = edited(&text, &last, act);
                undo.push(std::mem::replace(&mut text, next));
            }
        }
        let incremental = compiler.compile(&text, &options, &files);
        let fresh = compile(&text, &options, &files);
        partial += usize::from(compiler.last_was_partial());
        equals(&incremental, &fresh, &act, &text)?;
        if step % 3 == 0 {
            let written = written(&incremental, &mut surfaces);
            prop_assert!(written == common::glb(&fresh), "{:?} made {}", act, text);
        }
        // A result that is still held must not change; every other time it is dropped.
        last = if undo.len() % 2 == 0 {
            incremental
        } else {
            fresh
        };
    }
    let fresh = compile(&text, &options, &files);
    let incremental = compiler.compile(&text, &options, &files);
    prop_assert!(common::glb(&incremental) == common::glb(&fresh), "{}", text);
    Ok(partial)
}

/// Checks so many random histories of drawings. In a share of the steps, though not all, the drawing must only be
/// updated, or the law says nothing.
fn check_histories(drawings: &[&str], histories: u32, longest: usize) {
    let config = ProptestConfig {
        failure_persistence: Some(Box::new(FileFailurePersistence::Direct(
            "tests/regressions/again.txt",
        ))),
        ..law::config(histories)
    };
    let (partial, parsed) = (Tally::default(), Tally::default());
    let strategy = (any::<Index>(), prop::collection::vec(step(), 1..longest));
    let found = TestRunner::new(config).run(&strategy, |(which, acts)| {
        let updated = agree(drawings[which.index(drawings.len())], &acts)?;
        partial.add(updated, acts.len());
        parsed.add(acts.len() - updated, acts.len());
        Ok(())
    });
    if let Err(error) = found {
        panic!("{error}");
    }
    // 60 % are; of the examples' 73 %.
    partial.assert_share("steps after which the drawing was only updated", 21);
    parsed.assert_share("steps after which it was parsed again", 11);
}

#[test]
fn incremental_compiling_equals_compiling() {
    check_histories(DRAWINGS, 300, 24);
}

#[test]
fn incremental_compiling_of_examples_equals_compiling() {
    let examples: Vec<&str> = EXAMPLES.iter().map(String::as_str).collect();
    check_histories(&examples, 24, 12);
}

/// Whether a drawing was only updated, not parsed again, after a replacement in its text.
fn is_partial(drawing: &str, from: &str, to: &str) -> bool {
    let (options, files) = (Options::default(), Files::new());
    let mut compiler = Compiler::default();
    let first = compiler.compile(drawing, &options, &files);
    assert!(!compiler.last_was_partial());
    assert!(drawing.contains(from), "{from}");
    let text = drawing.replacen(from, to, 1);
    let before = all(&first);
    let incremental = compiler.compile(&text, &options, &files);
    assert_eq!(all(&first), before, "what was given away has changed");
    let fresh = compile(&text, &options, &files);
    assert_eq!(described(&incremental), described(&fresh), "{from} -> {to}");
    assert!(
        all(&incremental) == all(&fresh) && incremental.scene == fresh.scene,
        "{from} -> {to}"
    );
    compiler.last_was_partial()
}

#[test]
fn keystrokes_in_strings_do_not_parse_the_drawing_again() {
    for (which, from, to) in [
        (0, ">Ubody", ">Uboody"),
        (0, ">Ubody<", ">Ubody$<"),
        (0, ">Ubody<", ">xUbody<"),
        (0, ">Ubody<", ">U<"),
        (0, ">arm<", ">armあ🦀<"),
        (0, "@Ubody <", "@Ubody  <"),
        (0, "roundv -90", "roundh -9"),
        (0, "c&amp;d", "cx&amp;d"),
        (0, "c&amp;d", "c&amp;xd"),
        (0, " 35<", " 35.5<"),
        (0, "%Scale 2&lt;", "%Scale 23&lt;"),
        (0, "# Notiz", "Notiz"),
        (1, "torso$Shape", "torso$ Shape"),
        (1, "arm@torso$", "arm$"),
        (1, "leg@torso", "leg"),
        (1, "head@torso", "head\n@torso"),
        (1, "line</tspan>", "lines</tspan>"),
        (2, "🦀🦀", "🦀"),
        (2, "$Offset 3", "$Offset 33"),
        (2, "$Offset 3\r\n", "$Offset 30\r\n"),
        (2, "$Texture gull.png", "$Texture gull.pn"),
    ] {
        assert!(is_partial(DRAWINGS[which], from, to), "{from} -> {to}");
    }
}

#[test]
fn edits_that_may_change_markup_parse_the_drawing_again() {
    for (which, from, to) in [
        // Texts that appear, vanish, or are not strings.
        (0, ">Ubody<", "><"),
        (0, ">Ubody<", "> <"),
        (1, "\"199\"> <", "\"199\"> x<"),
        (1, "in definitions", "in definition"),
        (1, ">hidden", ">hiden"),
        (1, ">not this", ">not that"),
        (1, "fill: blue", "fill: red"),
        (1, ">of a text", ">of text"),
        // Markup, and characters that become markup.
        (0, ">Ubody<", ">U<b/>ody<"),
        (0, ">Ubody<", ">U&amp;body<"),
        (0, "a&amp;b", "a&gt;b"),
        (0, "$Axis]]>", "$Axs]]>"),
        (0, "<!-- an -->", "<!-- a -->"),
        (0, ">Ubody<", ">]]>Ubody<"),
        (0, "\"30\"", "\"31\""),
        // Entities count wherever they are used.
        (2, "\"twice\"", "\"thrice\""),
        (2, "\"胴\"", "\"体\""),
        // A line end beside another, and a name like a generated one.
        (2, "3\r\n<", "3\r<"),
        (0, ">Ubody<", ">\"okoshi-Ubody<"),
    ] {
        assert!(!is_partial(DRAWINGS[which], from, to), "{from} -> {to}");
    }
    // A change that repairs what the one before broke.
    let broken = DRAWINGS[0].replacen("Ubody", "U]]body", 1);
    assert!(!is_partial(&broken, "]]body", "]]>body"));
    let held_apart = DRAWINGS[0].replacen("Ubody", "U]x]&gt;body", 1);
    assert!(is_partial(&held_apart, "]x]", "]]"));
    let held_apart = DRAWINGS[0].replacen("Ubody", "U]x]>body", 1);
    assert!(!is_partial(&held_apart, "]x]", "]]"));
}

#[test]
fn changed_links_are_read_again() {
    let options = Options::default();
    let mut files = Files::new();
    let mut compiler = Compiler::default();
    let text = DRAWINGS[2];
    let first = compiler.compile(text, &options, &files);
    compiler.compile(text, &options, &files);
    assert!(compiler.last_was_partial());
    files.gull = None;
    let gone = compiler.compile(text, &options, &files);
    assert!(!compiler.last_was_partial());
    assert!(gone.diagnostics.len() > first.diagnostics.len());
    assert_eq!(
        described(&gone),
        described(&compile(text, &options, &files))
    );
    files = Files::new();
    compiler.forget();
    let back = compiler.compile(text, &options, &files);
    assert!(!compiler.last_was_partial());
    assert_eq!(described(&back), described(&first));
}

#[test]
fn only_solids_that_changed_are_made_again() {
    let files = Files::new();
    let circles: String = (0..300)
        .map(|index| {
            let (x, y) = (30 * (index % 20), 30 * (index / 20));
            format!("<circle cx=\"{x}\" cy=\"{y}\" r=\"{}\"/>\n", 5 + index % 7)
        })
        .collect();
    let text = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"600\" height=\"450\">\n{circles}\
         <text x=\"30\" y=\"30\" font-size=\"3\">Wheel$Shape round</text></svg>"
    );
    let mut compiler = Compiler::default();
    let mut surfaces = Memo::default();
    let mut made = |text: &str| {
        let compiled = compiler.compile(text, &Options::default(), &files);
        let incremental = written(&compiled, &mut surfaces);
        assert!(incremental == common::glb(&compile(text, &Options::default(), &files)));
        surfaces.last_misses
    };
    assert_eq!(made(&text), 300);
    assert_eq!(made(&text), 0);
    assert_eq!(made(&text.replace("Shape round", "Shape roundv")), 1);
    assert_eq!(made(&text.replacen("r=\"9\"", "r=\"9.5\"", 1)), 2);
    // A deeper page makes all plates deeper.
    assert!(made(&text.replacen("width=\"600\"", "width=\"700\"", 1)) > 290);
}
