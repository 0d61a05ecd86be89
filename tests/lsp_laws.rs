//! Laws of the language server, tried with many random edits over real stdio.

mod common;

use common::editor::{Editor, edited, offset, position, range};
use common::{compiled, glb};
use okoshi::diagnostic::Severity;
use okoshi::ide::Analysis;
use okoshi::resolver::MemoryResolver;
use okoshi::source::Span;
use proptest::prelude::*;
use proptest::sample::Index;
use proptest::test_runner::{FileFailurePersistence, TestRunner};
use serde_json::{Value, json};

const URI: &str = "untitled:a.svg";

/// Drawings with strings in all the places where they can be hard to read.
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

/// What is typed and pasted.
const PIECES: &[&str] = &[
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
    "<",
    ">",
    "&",
    "</text>",
    "<tspan>",
    "<![CDATA[",
    "]]>",
    "<!--",
    "-->",
    "<text x=\"3\" y=\"4\">Nase@arm</text>",
    "",
];

/// An edit: where, how much is taken away, what is put in, and whether it is near a string.
type Edit = (Index, usize, Index, bool);

fn edits(most: usize) -> impl Strategy<Value = Vec<Edit>> {
    prop::collection::vec(
        (
            any::<Index>(),
            0_usize..4,
            any::<Index>(),
            prop::bool::weighted(0.8),
        ),
        1..most,
    )
}

/// The bytes that an edit takes away, and what it puts in.
fn plan(text: &str, (place, taken, piece, near): &Edit) -> (usize, usize, &'static str) {
    let texts: Vec<usize> = text.match_indices("<text").map(|(at, _)| at).collect();
    let from = match near {
        true if !texts.is_empty() => {
            let start = texts[place.index(texts.len())];
            let inside = text[start..].find('>').map_or(start, |at| start + at + 1);
            inside + place.index(30)
        }
        _ => place.index(text.len() + 1),
    };
    let boundary = |mut at: usize| {
        at = at.min(text.len());
        while !text.is_char_boundary(at) {
            at -= 1;
        }
        // A position between CR and LF is that before both.
        if text[..at].ends_with('\r') && text[at..].starts_with('\n') {
            at -= 1;
        }
        at
    };
    let start = boundary(from);
    let end = boundary(start + taken * 2).max(start);
    (start, end, PIECES[piece.index(PIECES.len())])
}

/// Everything that is asked about a text.
fn answers(editor: &mut Editor, text: &str, places: &[usize]) -> Vec<(String, Value)> {
    let document = json!({"uri": URI});
    let whole = range(text, 0, text.len());
    let mut asked = vec![];
    for method in [
        "documentSymbol",
        "foldingRange",
        "semanticTokens/full",
        "documentColor",
        "codeLens",
    ] {
        asked.push((method, json!({"textDocument": document})));
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
        for method in [
            "hover",
            "completion",
            "signatureHelp",
            "definition",
            "references",
            "documentHighlight",
            "prepareRename",
        ] {
            asked.push((method, at.clone()));
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

/// Fails if a position anywhere in an answer is none of the text.
fn check_places(text: &str, answer: &Value) -> Result<(), String> {
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
                .try_for_each(|value| check_places(text, value))
        }
        Value::Array(values) => values
            .iter()
            .try_for_each(|value| check_places(text, value)),
        _ => Ok(()),
    }
}

/// Fails if a token is not a stretch of characters in one line.
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
        cases: std::env::var("PROPTEST_CASES")
            .ok()
            .and_then(|cases| cases.parse().ok())
            .unwrap_or(cases),
        failure_persistence: Some(Box::new(FileFailurePersistence::Off)),
        max_shrink_iters: 200,
        ..ProptestConfig::default()
    })
}

/// After any edits the server says what a fresh one says of the text that came out, and all its places are in it.
#[test]
fn history_does_not_matter() {
    let histories = (any::<Index>(), edits(120), any::<[Index; 3]>());
    let outcome = runner(96).run(&histories, |(drawing, edits, places)| {
        let mut text = DRAWINGS[drawing.index(DRAWINGS.len())].to_owned();
        let mut editor = Editor::new();
        editor.open(URI, 1, &text);
        let mut version = 1;
        for chunk in edits.chunks(3) {
            version += 1;
            let mut changes = vec![];
            for edit in chunk {
                let (start, end, piece) = plan(&text, edit);
                changes.push(json!({"range": range(&text, start, end), "text": piece}));
                text.replace_range(start..end, piece);
            }
            editor.change(URI, version, &changes);
            if version % 7 == 0 {
                editor.request(
                    "textDocument/semanticTokens/full",
                    json!({"textDocument": {"uri": URI}}),
                );
            }
        }
        let found = editor.diagnostics(URI, version);
        let mut fresh = Editor::new();
        fresh.open(URI, version, &text);
        let expected = fresh.diagnostics(URI, version);
        prop_assert_eq!(&found, &expected, "{}", text);
        check_places(&text, &json!(found)).map_err(TestCaseError::fail)?;
        let places: Vec<usize> = places
            .iter()
            .map(|place| {
                let starts: Vec<usize> = text.char_indices().map(|(at, _)| at).collect();
                if starts.is_empty() {
                    0
                } else {
                    starts[place.index(starts.len())]
                }
            })
            .chain(
                text.match_indices(['@', '$'])
                    .map(|(at, _)| at + 1)
                    .filter(|at| text.is_char_boundary(*at))
                    .take(6),
            )
            .collect();
        let sound = !expected
            .iter()
            .any(|diagnostic| diagnostic["code"] == "E001");
        let old = answers(&mut editor, &text, &places);
        for (method, answer) in &old {
            check_places(&text, answer)
                .map_err(|error| TestCaseError::fail(format!("{method}: {error} in {text}")))?;
            if method == "semanticTokens/full" {
                check_tokens(&text, answer).map_err(TestCaseError::fail)?;
            }
        }
        if sound {
            prop_assert_eq!(old, answers(&mut fresh, &text, &places), "{}", text);
        }
        Ok(())
    });
    outcome.unwrap_or_else(|error| panic!("{error}"));
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

/// A drawing's model without the strings that it was made from, which the file quotes.
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
fn formatting_is_done_once_and_changes_no_model() {
    let outcome = runner(192).run(&(any::<Index>(), edits(12)), |(drawing, edits)| {
        let mut text = DRAWINGS[drawing.index(DRAWINGS.len())].to_owned();
        for edit in &edits {
            let (start, end, piece) = plan(&text, edit);
            text.replace_range(start..end, piece);
        }
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
        Ok(())
    });
    outcome.unwrap_or_else(|error| panic!("{error}"));
}

/// Renaming there and back restores the bytes, and leaves all errors as they were. (A name that is written with
/// needless quotes, in entities that it does not need or in full-width letters comes back in its plain form.)
#[test]
fn renaming_leads_back() {
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
    let outcome = runner(192).run(&strategy, |(drawing, place, name)| {
        let text = DRAWINGS[drawing.index(DRAWINGS.len())]
            .replace("&#x40;", "@")
            .replace("@\"胴😀\"", "@胴😀");
        let before = analysis(&text);
        let signs: Vec<usize> = text
            .match_indices(['@', '$', '＠', '＄'])
            .map(|(at, sign)| at + sign.len())
            .collect();
        let at = signs[place.index(signs.len())];
        let Ok((_, old)) = before.prepare_rename(at) else {
            return Ok(());
        };
        let Ok(edits) = before.rename(at, name) else {
            return Ok(());
        };
        // A description without a name is given one, which it keeps.
        prop_assume!(old != "Ｌeg" && old != "Leg");
        let there = after(&text, &edits);
        let renamed = analysis(&there);
        prop_assert!(renamed.is_sound(), "{}", there);
        // A text that is aligned to its middle may come nearer to another part, and a hint says so.
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
        Ok(())
    });
    outcome.unwrap_or_else(|error| panic!("{error}"));
}
