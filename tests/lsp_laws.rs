//! Laws of the language server, checked with random edits over real stdio.
#![cfg(feature = "cli")]

mod common;

use std::cell::RefCell;
use std::collections::BTreeSet;
use std::ops::Range;

use common::editor::{Editor, edited, offset, position, range};
use common::law::{self, Tally};
use common::{compiled, glb};
use okoshi::Span;
use okoshi::diagnostic::Severity;
use okoshi::internals::ide::Analysis;
use okoshi::resolver::MemoryResolver;
use proptest::prelude::*;
use proptest::sample::Index;
use proptest::test_runner::TestRunner;
use serde_json::{Value, json};

const URI: &str = "untitled:a.svg";

/// Drawings with strings in all notations that are hard to map to bytes.
const DRAWINGS: &[&str] = &[
    include_str!("../examples/human.svg"),
    include_str!("../examples/robot-ja.svg"),
    "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 90 60\">\r\n\
     <rect id=\"😀\" x=\"30\" y=\"20\" width=\"20\" height=\"30\" fill=\"#336699\"/>\r\n\
     \t<text x=\"30\" y=\"24\" text-anchor=\"middle\">胴😀</text><!-- 😀 -->\r\n\
     <rect x=\"50\" y=\"22\" width=\"30\" height=\"8\" fill=\"red\"/>\r\n\
     <text xml:space=\"preserve\" x=\"60\" y=\"25\">arm<tspan x=\"60\" y=\"30\">@胴😀 </tspan><tspan dy=\"5\">$Shape roundv -90 w</tspan></text>\r\n\
     <circle r=\"8\" cx=\"20\" cy=\"10\" fill=\"red\"/><text y=\"10\" x=\"19\">a&amp;b&#x40;arm<![CDATA[$Axis]]> 30 Color #f80</text>\r\n\
     <rect x=\"70\" y=\"50\" width=\"5\" height=\"5\" fill=\"red\"/><text x=\"71\" y=\"53\">$Offset (w * 2) Smooth 4</text>\r\n\
     <rect x=\"5\" y=\"50\" width=\"5\" height=\"9\" inkscape:label=\"Ｌeg\" xmlns:inkscape=\"http://www.inkscape.org/namespaces/inkscape\"><desc>@\"胴😀\"$Color red</desc></rect>\r\n\
     <text x=\"1\" y=\"5\">%Let w 3 Scale 2</text><text x=\"3\" y=\"60\"># Notiz 😀\n二行目</text></svg>\r\n",
];

/// Text that is typed into strings; XML stays well-formed.
const STRING_PIECES: &[&str] = &[
    "a",
    "7",
    " ",
    "$",
    "@",
    "%",
    "\"",
    "(",
    ")",
    "-",
    ".",
    "腕",
    "😀",
    "é",
    "＠",
    "\n",
    "\r\n",
    "\t",
    "&amp;",
    "&#x3042;",
    "Shape ",
    "roundv -90 90",
    "Color red",
    "Let w 3",
    "@arm",
    "arm",
    "Offset ",
    "",
];

/// Elements that are inserted whole.
const ELEMENTS: &[&str] = &[
    "<text x=\"3\" y=\"4\">Nase@arm</text>",
    "<text x=\"40\" y=\"30\">$Color <![CDATA[red]]></text>\r\n",
    "<rect x=\"1\" y=\"2\" width=\"9\" height=\"5\" fill=\"red\"/>",
    "<!-- 😀 -->",
];

/// Text that breaks XML in most places.
const DAMAGES: &[&str] = &[
    "<",
    ">",
    "&",
    "\"",
    "</text>",
    "<tspan>",
    "<![CDATA[",
    "]]>",
    "<!--",
    "-->",
    "",
];

/// What an edit changes.
#[derive(Debug, Clone, Copy)]
enum Kind {
    /// Characters of a string.
    String,
    /// A digit of a number in a tag.
    Digit,
    /// A whole element, inserted or removed.
    Element,
    /// Anything anywhere, which is repaired by a later edit of this kind.
    Damage,
}

/// A random edit. Its indices choose among the places that the text has.
#[derive(Debug, Clone)]
struct Edit {
    kind: Kind,
    element: Index,
    place: Index,
    removed: usize,
    piece: Index,
}

fn edits(most: usize) -> impl Strategy<Value = Vec<Edit>> {
    let kind = prop_oneof![
        16 => Just(Kind::String),
        2 => Just(Kind::Digit),
        2 => Just(Kind::Element),
        2 => Just(Kind::Damage),
    ];
    let index = any::<Index>;
    let edit = (kind, index(), index(), 0_usize..4, index());
    let edit = edit.prop_map(|(kind, element, place, removed, piece)| Edit {
        kind,
        element,
        place,
        removed,
        piece,
    });
    prop::collection::vec(edit, 1..most)
}

/// A byte range and its replacement.
type Replacement = (Range<usize>, String);

/// A well-formed drawing that is edited, and sometimes damaged and repaired.
struct Draft {
    /// The drawing without damage.
    sound: String,
    /// The damaged range of it, and the text that replaces it.
    damage: Option<Replacement>,
    repairs: usize,
}

impl Draft {
    fn new(text: &str) -> Self {
        Self {
            sound: text.to_owned(),
            damage: None,
            repairs: 0,
        }
    }

    fn text(&self) -> String {
        let mut text = self.sound.clone();
        if let Some((range, damage)) = &self.damage {
            text.replace_range(range.clone(), damage);
        }
        text
    }

    /// Makes an edit, and returns it in terms of [`Draft::text`] before it; `None` if the text has no place for it.
    fn edit(&mut self, edit: &Edit) -> Option<Replacement> {
        if matches!(edit.kind, Kind::Damage) {
            return Some(if self.damage.is_some() {
                self.repair()
            } else {
                self.break_at(edit)
            });
        }
        let (range, new) = self.plan(edit)?;
        let grown = new.len() as isize - range.len() as isize;
        let mut place = range.clone();
        if let Some((damaged, damage)) = &mut self.damage {
            if range.start > damaged.end {
                let shift = damage.len() as isize - damaged.len() as isize;
                place = moved(&range, shift);
            } else if range.end < damaged.start {
                *damaged = moved(damaged, grown);
            } else {
                return None;
            }
        }
        self.sound.replace_range(range, &new);
        Some((place, new))
    }

    fn break_at(&mut self, edit: &Edit) -> Replacement {
        let bounds = bounds(&self.sound);
        let start = edit.place.index(bounds.len());
        let end = (start + edit.removed).min(bounds.len() - 1);
        let damage = DAMAGES[edit.piece.index(DAMAGES.len())].to_owned();
        let replacement = (bounds[start]..bounds[end], damage);
        self.damage = Some(replacement.clone());
        replacement
    }

    fn repair(&mut self) -> Replacement {
        let (range, damage) = self.damage.take().expect("damage");
        self.repairs += 1;
        let whole = self.sound[range.clone()].to_owned();
        (range.start..range.start + damage.len(), whole)
    }

    /// An edit of the drawing without damage that keeps it well-formed.
    fn plan(&self, edit: &Edit) -> Option<Replacement> {
        let text = &self.sound;
        match edit.kind {
            Kind::String => {
                let strings = strings(text);
                let string = strings.get(edit.element.index(strings.len().max(1)))?;
                let bounds = bounds(&text[string.clone()]);
                let start = edit.place.index(bounds.len());
                let end = (start + edit.removed).min(bounds.len() - 1);
                let range = string.start + bounds[start]..string.start + bounds[end];
                let piece = STRING_PIECES[edit.piece.index(STRING_PIECES.len())];
                Some((range, piece.to_owned()))
            }
            Kind::Digit => {
                let digits: Vec<usize> = [" x=\"", " y=\""]
                    .iter()
                    .flat_map(|name| text.match_indices(name))
                    .map(|(at, name)| at + name.len())
                    .filter(|at| text[*at..].starts_with(|c: char| c.is_ascii_digit()))
                    .collect();
                let at = *digits.get(edit.place.index(digits.len().max(1)))?;
                Some((at..at + 1, edit.piece.index(10).to_string()))
            }
            Kind::Element => {
                let starts: Vec<usize> = text.match_indices("<text").map(|(at, _)| at).collect();
                let at = *starts.get(edit.place.index(starts.len().max(1)))?;
                let end = text[at..].find("</text>")? + at + "</text>".len();
                Some(match edit.removed {
                    0 => (at..end, String::new()),
                    _ => (
                        at..at,
                        ELEMENTS[edit.piece.index(ELEMENTS.len())].to_owned(),
                    ),
                })
            }
            Kind::Damage => None,
        }
    }
}

fn moved(range: &Range<usize>, by: isize) -> Range<usize> {
    let [start, end] = [range.start, range.end].map(|at| at.saturating_add_signed(by));
    start..end
}

/// The characters of strings: after the tags of texts and descriptions, and in CDATA sections.
fn strings(text: &str) -> Vec<Range<usize>> {
    let inside = |open: &'static str, until: &'static str, close: &'static str| {
        text.match_indices(open).filter_map(move |(at, _)| {
            let start = at + text[at..].find(until)? + until.len();
            let end = start + text[start..].find(close)?;
            // A self-closing tag has no characters.
            (!text[..start].ends_with("/>")).then_some(start..end)
        })
    };
    let tags = ["<text", "<tspan", "<desc"].into_iter();
    tags.flat_map(|tag| inside(tag, ">", "<"))
        .chain(inside("<![CDATA[", "CDATA[", "]]>"))
        .collect()
}

/// The offsets of characters, and the end; entities and line ends count as one character.
fn bounds(text: &str) -> Vec<usize> {
    let mut bounds = vec![];
    let mut at = 0;
    while let Some(c) = text[at..].chars().next() {
        bounds.push(at);
        let entity = text[at..].find(';').filter(|_| c == '&');
        at += match entity {
            Some(end) => end + 1,
            None if text[at..].starts_with("\r\n") => 2,
            None => c.len_utf8(),
        };
    }
    bounds.push(at);
    bounds
}

/// The requests: for whole texts, at offsets, and others.
const METHODS: [&str; 17] = [
    "documentSymbol",
    "foldingRange",
    "semanticTokens/full",
    "documentColor",
    "codeLens",
    "hover",
    "completion",
    "signatureHelp",
    "definition",
    "references",
    "documentHighlight",
    "prepareRename",
    "selectionRange",
    "rename",
    "inlayHint",
    "codeAction",
    "formatting",
];

/// The answers to all requests about a text.
fn answers(editor: &mut Editor, text: &str, places: &[usize]) -> Vec<(String, Value)> {
    let document = json!({"uri": URI});
    let whole = range(text, 0, text.len());
    let mut asked = vec![];
    for method in &METHODS[..5] {
        asked.push((*method, json!({"textDocument": document})));
    }
    asked.push((
        "inlayHint",
        json!({"textDocument": document, "range": whole}),
    ));
    asked.push((
        "codeAction",
        json!({"textDocument": document, "range": whole, "context": {"diagnostics": []}}),
    ));
    asked.push((
        "formatting",
        json!({"textDocument": document, "options": {"tabSize": 2, "insertSpaces": true}}),
    ));
    for place in places {
        let here = position(text, *place);
        let at = json!({"textDocument": document, "position": here, "context": {"triggerKind": 1, "isRetrigger": false, "includeDeclaration": true}});
        for method in &METHODS[5..12] {
            asked.push((*method, at.clone()));
        }
        asked.push((
            "selectionRange",
            json!({"textDocument": document, "positions": [here]}),
        ));
        let mut rename = at.clone();
        rename["newName"] = json!("neu & 😀");
        asked.push(("rename", rename));
    }
    asked
        .into_iter()
        .map(|(method, params)| {
            let id = editor.request(&format!("textDocument/{method}"), params);
            let answer = editor.answer(id);
            let what = match answer.get("error") {
                Some(error) => error["message"].clone(),
                None => answer["result"].clone(),
            };
            (method.to_owned(), what)
        })
        .collect()
}

/// Fails if an answer contains a position outside of the text.
fn check_positions(text: &str, answer: &Value) -> Result<(), String> {
    match answer {
        Value::Object(fields) => {
            if fields.contains_key("line")
                && fields.contains_key("character")
                && offset(text, answer).is_none()
            {
                return Err(format!("{answer} is no place of the text"));
            }
            fields
                .values()
                .try_for_each(|value| check_positions(text, value))
        }
        Value::Array(values) => values
            .iter()
            .try_for_each(|value| check_positions(text, value)),
        _ => Ok(()),
    }
}

/// Fails if a token is not within one line.
fn check_tokens(text: &str, tokens: &Value) -> Result<(), String> {
    let (mut line, mut character) = (0, 0);
    for token in tokens["data"]
        .as_array()
        .into_iter()
        .flatten()
        .collect::<Vec<_>>()
        .chunks(5)
    {
        let number = |index: usize| token[index].as_u64().unwrap_or(0);
        line += number(0);
        character = if number(0) > 0 {
            number(1)
        } else {
            character + number(1)
        };
        let ends = [0, number(2)].map(|length| {
            offset(
                text,
                &json!({"line": line, "character": character + length}),
            )
        });
        let [Some(start), Some(end)] = ends else {
            return Err(format!(
                "a token at {line}:{character} is no stretch of the text"
            ));
        };
        if start >= end || text[start..end].contains('\n') {
            return Err(format!("{:?} is no token", &text[start..end]));
        }
    }
    Ok(())
}

fn runner(cases: u32) -> TestRunner {
    TestRunner::new(ProptestConfig {
        max_shrink_iters: 200,
        ..law::config(cases)
    })
}

/// After any edits the server answers like a fresh one for the final text, and all positions are in the text.
#[test]
fn answers_do_not_depend_on_history() {
    let histories = (
        any::<Index>(),
        edits(120),
        any::<[Index; 3]>(),
        prop::bool::weighted(0.9),
    );
    let (compared, repaired) = (Tally::default(), Tally::default());
    let answered = RefCell::new(BTreeSet::new());
    let outcome = runner(96).run(&histories, |(drawing, edits, places, repair)| {
        let mut draft = Draft::new(DRAWINGS[drawing.index(DRAWINGS.len())]);
        let mut editor = Editor::new();
        editor.open(URI, 1, &draft.text());
        let mut version = 1;
        let mut change = |draft: &mut Draft, edits: &[Edit]| {
            version += 1;
            let mut changes = vec![];
            for edit in edits {
                let text = draft.text();
                if let Some((bytes, new)) = draft.edit(edit) {
                    changes
                        .push(json!({"range": range(&text, bytes.start, bytes.end), "text": new}));
                }
            }
            editor.change(URI, version, &changes);
            if version % 7 == 0 {
                editor.request(
                    "textDocument/semanticTokens/full",
                    json!({"textDocument": {"uri": URI}}),
                );
            }
        };
        for edits in edits.chunks(3) {
            change(&mut draft, edits);
        }
        if repair && draft.damage.is_some() {
            let edit = Edit {
                kind: Kind::Damage,
                ..edits[0].clone()
            };
            change(&mut draft, &[edit]);
        }
        let text = draft.text();
        let found = editor.diagnostics(URI, version);
        let mut fresh = Editor::new();
        fresh.open(URI, version, &text);
        let expected = fresh.diagnostics(URI, version);
        prop_assert_eq!(&found, &expected, "{}", text);
        check_positions(&text, &json!(found)).map_err(TestCaseError::fail)?;
        let characters = bounds(&text);
        let places: Vec<usize> = places
            .iter()
            .map(|place| characters[place.index(characters.len())])
            .chain(text.match_indices(['@', '$']).map(|(at, _)| at + 1).take(6))
            .collect();
        let sound = !expected
            .iter()
            .any(|diagnostic| diagnostic["code"] == "E001");
        let old = answers(&mut editor, &text, &places);
        for (method, answer) in &old {
            check_positions(&text, answer)
                .map_err(|error| TestCaseError::fail(format!("{method}: {error} in {text}")))?;
            if method == "semanticTokens/full" {
                check_tokens(&text, answer).map_err(TestCaseError::fail)?;
            }
        }
        // Of broken XML the old server knows more, from the last state that was well-formed.
        if sound {
            let new = answers(&mut fresh, &text, &places);
            prop_assert_eq!(&old, &new, "{}", text);
            let says = old.into_iter().filter(|(_, answer)| !empty(answer));
            answered.borrow_mut().extend(says.map(|(method, _)| method));
        }
        compared.count(sound);
        repaired.count(sound && draft.repairs > 0);
        Ok(())
    });
    outcome.unwrap_or_else(|error| panic!("{error}"));
    compared.assert_share("histories that end in XML", 80);
    repaired.assert_share("histories in which it was broken", 60);
    if runner(96).config().cases >= 96 {
        let answered = answered.into_inner();
        let silent: Vec<_> = METHODS
            .iter()
            .filter(|method| !answered.contains(**method))
            .collect();
        assert!(silent.is_empty(), "no answer was compared of {silent:?}");
    }
}

/// Whether an answer is empty or an error.
fn empty(answer: &Value) -> bool {
    match answer {
        Value::Null => true,
        Value::Array(all) => all.is_empty(),
        // The message of an error.
        Value::String(_) => true,
        _ => false,
    }
}

fn analysis(text: &str) -> Analysis {
    Analysis::new(text, compiled(text, &MemoryResolver::default()))
}

/// A text after edits of `ide`.
fn after(text: &str, edits: &[okoshi::diagnostic::Edit]) -> String {
    let edits = edits.iter().map(
        |edit| json!({"range": range(text, edit.span.start, edit.span.end), "newText": edit.text}),
    );
    edited(text, &json!(edits.collect::<Vec<_>>()))
}

/// A drawing's model without its strings, which the file quotes.
fn model(analysis: &Analysis) -> (Value, Vec<u8>) {
    let bytes = glb(analysis.compiled());
    let glb = gltf::Glb::from_slice(&bytes).expect("a model");
    let mut json: Value = serde_json::from_slice(&glb.json).expect("JSON");
    for node in json["nodes"].as_array_mut().into_iter().flatten() {
        if let Some(extras) = node["extras"]["okoshi"].as_object_mut() {
            extras.remove("string");
        }
    }
    (json, glb.bin.unwrap_or_default().into_owned())
}

/// Formatting again changes nothing, and formatting does not change the model.
#[test]
fn formatting_is_idempotent_and_keeps_the_model() {
    let (sound, changed) = (Tally::default(), Tally::default());
    let outcome = runner(192).run(&(any::<Index>(), edits(12)), |(drawing, edits)| {
        let mut draft = Draft::new(DRAWINGS[drawing.index(DRAWINGS.len())]);
        for edit in &edits {
            draft.edit(edit);
        }
        let text = draft.text();
        let before = analysis(&text);
        let all = |text: &str| Span::new(0, text.len());
        let formatted = after(&text, &before.format(all(&text), &analysis));
        let again = analysis(&formatted);
        let twice = after(&formatted, &again.format(all(&formatted), &analysis));
        prop_assert_eq!(&twice, &formatted, "from {}", text);
        prop_assert!(
            model(&before) == model(&again),
            "another model from {}",
            text
        );
        sound.count(before.is_sound());
        changed.count(before.is_sound() && formatted != text);
        Ok(())
    });
    outcome.unwrap_or_else(|error| panic!("{error}"));
    sound.assert_share("drawings that are formatted", 60);
    changed.assert_share("drawings that formatting changes", 25);
}

/// Renaming there and back restores the bytes and keeps all errors. (A name that is written with
/// needless quotes or entities or in full-width letters comes back in its plain form.)
#[test]
fn renaming_can_be_reverted() {
    let names = prop_oneof![
        Just("Zz"),
        Just("zwei Wörter"),
        Just("a & b"),
        Just("<x>"),
        Just("腕😀"),
        Just("U-9"),
        Just("%x"),
        Just("a$b"),
        Just("(x)"),
    ];
    let strategy = (any::<Index>(), any::<Index>(), names);
    let config = ProptestConfig {
        max_shrink_iters: 200,
        ..law::config(256)
    };
    // 88 % are renamed.
    law::check(config, 70, strategy, |(drawing, place, name)| {
        let text = DRAWINGS[drawing.index(DRAWINGS.len())]
            .replace("&#x40;", "@")
            .replace("@\"胴😀\"", "@胴😀");
        let before = analysis(&text);
        // Where names begin.
        let mut places: Vec<usize> = bounds(&text)
            .into_iter()
            .filter_map(|at| Some(before.prepare_rename(at).ok()?.0.start))
            .collect();
        places.dedup();
        let at = places[place.index(places.len())];
        let (_, old) = before.prepare_rename(at).expect("a name");
        // Some renames are refused.
        let Ok(edits) = before.rename(at, name) else {
            return Ok(false);
        };
        // A description without a name keeps the one that it is given.
        if ["Ｌeg", "Leg"].contains(&&*old) {
            return Ok(false);
        }
        let there = after(&text, &edits);
        let renamed = analysis(&there);
        prop_assert!(renamed.is_sound(), "{}", there);
        // A centred text may move nearer to another part, which is a hint.
        let errors = |analysis: &Analysis| {
            let found = analysis.diagnostics().iter();
            let errors = found.filter(|found| found.severity() == Severity::Error);
            errors.map(|found| found.code).collect::<Vec<_>>()
        };
        prop_assert_eq!(errors(&renamed), errors(&before), "{}", there);
        let moved = edits
            .iter()
            .filter(|edit| edit.span.end <= at)
            .map(|edit| edit.text.len() as isize - (edit.span.end - edit.span.start) as isize)
            .sum::<isize>();
        let back = renamed.rename(
            at.checked_add_signed(moved).expect("a place"),
            &format!("\"{old}\""),
        );
        let back = back.map_err(|error| TestCaseError::fail(format!("{error} in {there}")))?;
        prop_assert_eq!(after(&there, &back), text);
        Ok(true)
    });
}
