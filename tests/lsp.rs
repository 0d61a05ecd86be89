//! The language server over real stdio.
#![cfg(feature = "cli")]

mod common;

use std::fs;

use common::editor::{Editor, address, edited, position, range, slice};
use common::patience::wait_until;
use serde_json::{Value, json};

const URI: &str = "untitled:a.svg";

/// A body and an arm with strings of all kinds; `¦` marks an offset.
const DRAWING: &str = r##"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 200 100">
  <rect id="body" x="80" y="20" width="40" height="60" fill="#336699"/>
  <rect id="right" x="20" y="40" width="60" height="10" fill="#ffcc99"/>
  <rect id="left" x="120" y="40" width="60" height="10" fill="#ffcc99"/>
  <rect id="swatch" x="2" y="2" width="5" height="5" fill="#ffcc99"/>
  <text x="100" y="54" font-size="5">Ubody</text>
  <text x="50" y="49" font-size="5">Rarm@Ubody$Shape roundv -90 90 Color #ff8000</text>
  <text x="5" y="8" font-size="5">$Offset thick</text>
  <text x="150" y="95" font-size="5">%Let thick 4 Smooth 20</text>
</svg>
"##;

fn place(text: &str, word: &str) -> Value {
    let offset = text.find(word).expect("the word is there");
    json!({"textDocument": {"uri": URI}, "position": position(text, offset)})
}

fn document() -> Value {
    json!({"textDocument": {"uri": URI}})
}

/// The drawing with many small parts added, each with its string.
fn many(parts: usize) -> String {
    let more: String = (0..parts)
        .map(|index| {
            let (x, y) = (10 * (index % 200), 200 + 10 * (index / 200));
            format!("<circle cx=\"{x}\" cy=\"{y}\" r=\"3\"/><text x=\"{x}\" y=\"{y}\" font-size=\"1\">c{index}</text>\n")
        })
        .collect();
    DRAWING.replace("</svg>", &format!("{more}</svg>"))
}

fn codes(diagnostics: &[Value]) -> Vec<&str> {
    diagnostics
        .iter()
        .map(|diagnostic| diagnostic["code"].as_str().expect("a code"))
        .collect()
}

#[test]
fn diagnostics_have_all_fields_that_editors_show() {
    let mut editor = Editor::new();
    let text = DRAWING.replace("Rarm@Ubody", "Rarm@Ubdoy");
    let found = editor.opened(URI, &text);
    let parent = found
        .iter()
        .find(|diagnostic| diagnostic["code"] == "E204")
        .expect("the mistyped parent is found");
    assert_eq!(slice(&text, &parent["range"]), "Ubdoy");
    assert_eq!(parent["severity"], 1);
    assert_eq!(parent["source"], "okoshi");
    let message = parent["message"].as_str().expect("text");
    assert!(message.contains("did you mean `Ubody`?"), "{message}");
    let page = parent["codeDescription"]["href"].as_str().expect("a link");
    let (file, line) = page.rsplit_once("#L").expect("a line");
    let manual =
        fs::read_to_string(file.strip_prefix("file://").expect("a file")).expect("the manual");
    let heading = manual
        .lines()
        .nth(line.parse::<usize>().expect("a number") - 1);
    assert!(heading.expect("a heading").contains("E204"));
    // A legend that no part uses has no effect.
    let text = DRAWING.replace(
        "width=\"5\" height=\"5\" fill=\"#ffcc99\"",
        "width=\"5\" height=\"5\" fill=\"#000001\"",
    );
    editor.change(URI, 2, &[json!({"text": text})]);
    let found = editor.diagnostics(URI, 2);
    let legend = found.iter().find(|diagnostic| diagnostic["code"] == "W303");
    let legend = legend.expect("the legend without parts is found");
    assert_eq!(legend["tags"], json!([1]));
    let related = &legend["relatedInformation"][0];
    assert_eq!(slice(&text, &related["location"]["range"]), "<rect");
    assert!(editor.shut_down().success());
}

#[test]
fn drawings_without_strings_are_left_alone() {
    let mut editor = Editor::new();
    let text = DRAWING
        .lines()
        .filter(|line| !line.contains("<text"))
        .collect::<Vec<_>>()
        .join("\n");
    assert_eq!(editor.opened(URI, &text), Vec::<Value>::new());
    // Not even malformed XML is reported: other servers do that.
    let broken = text.replace("</svg>", "<");
    editor.change(URI, 2, &[json!({"text": broken})]);
    assert_eq!(editor.diagnostics(URI, 2), Vec::<Value>::new());
    for method in ["documentSymbol", "codeLens", "foldingRange"] {
        let answer = editor.ask(&format!("textDocument/{method}"), document());
        assert!(answer.is_null(), "{method}: {answer}");
    }
    let hover = editor.ask("textDocument/hover", place(&text, "rect id=\"body\""));
    assert!(hover.is_null());
}

#[test]
fn hovers_describe_tiles() {
    let mut editor = Editor::new();
    let text = "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 50 60'><g id='g'>
        <text x='0' y='5' font-size='5'>Hill$Tiles 10</text>
        <rect id='top' x='0' y='10' width='30' height='20' fill='#4caf50'/>
        <path id='cliff' d='M0 30h30v20h-30z' fill='#8d6e63'/></g></svg>";
    assert_eq!(editor.opened(URI, text), Vec::<Value>::new());
    for (tag, told) in [
        (
            "rect id='top'",
            "6 tiles of ground at height 2, in a group of 6",
        ),
        (
            "path id='cliff'",
            "6 tiles of cliff, between the heights 0 and 2",
        ),
    ] {
        let hover = editor.ask("textDocument/hover", place(text, tag));
        let markdown = hover["contents"]["value"].as_str().expect("text");
        assert!(markdown.contains("**Tiles** of Hill"), "{markdown}");
        assert!(markdown.contains(told), "{markdown}");
    }
    assert!(editor.shut_down().success());
}

/// A box from two sides with a badge whose colour differs so much that its two drawings are no pair.
const TURNING: &str = r##"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 200 100">
  <g id="front">
    <rect id="body" x="30" y="20" width="40" height="50" fill="#3366cc"/>
    <circle id="badge" cx="40" cy="40" r="5" fill="#ffcc00"/>
    <text x="10" y="90" font-size="8">Box$View 0 0</text>
  </g>
  <g id="side">
    <rect id="body-2" x="130" y="20" width="42" height="50" fill="#3366cc"/>
    <ellipse id="star" cx="138" cy="40" rx="4" ry="5" fill="#333333"/>
    <text x="110" y="90" font-size="8">Box$View 45 0</text>
  </g>
</svg>
"##;

#[test]
fn regions_of_characters_have_partners() {
    let mut editor = Editor::new();
    let found = editor.opened(URI, TURNING);
    assert_eq!(codes(&found), ["W324", "W324"]);
    let marked = found.iter().map(|found| slice(TURNING, &found["range"]));
    assert_eq!(marked.collect::<Vec<_>>(), ["<circle", "<ellipse"]);
    for (word, told) in [
        ("rect id=\"body\"", "- in `45 0`: `#body-2`, similarity 0."),
        ("circle id", "- in `45 0`: `#star`, similarity 0.00, cost "),
        ("Box$View 45", "- `#star` has no partner"),
    ] {
        let hover = editor.ask("textDocument/hover", place(TURNING, word));
        let markdown = hover["contents"]["value"].as_str().expect("text");
        assert!(markdown.contains(told), "{word}: {markdown}");
    }
    let body = editor.ask(
        "textDocument/definition",
        place(TURNING, "rect id=\"body\""),
    );
    assert_eq!(
        body[0]["range"]["start"],
        position(
            TURNING,
            TURNING.find("<rect id=\"body-2\"").expect("a shape")
        )
    );

    let at = place(TURNING, "circle id")["position"].clone();
    let asked = json!({
        "textDocument": {"uri": URI},
        "range": {"start": at, "end": at},
        "context": {"diagnostics": [found[0].clone()]},
    });
    let actions = editor.ask("textDocument/codeAction", asked);
    let actions = actions.as_array().expect("actions");
    let naming = actions.iter().find(|action| {
        let title = action["title"].as_str().expect("a title");
        title == "Name both `badge`: this region and `#star`"
    });
    let naming = naming.unwrap_or_else(|| panic!("{actions:#?}"));
    assert_eq!(naming["kind"], "quickfix");
    assert_eq!(naming["diagnostics"][0]["code"], "W324");
    let text = edited(TURNING, &naming["edit"]["changes"][URI]);
    editor.change(URI, 2, &[json!({"text": text})]);
    assert_eq!(editor.diagnostics(URI, 2), Vec::<Value>::new(), "{text}");
    let named = editor.ask("textDocument/hover", place(&text, "badge</desc></circle>"));
    let markdown = named["contents"]["value"].as_str().expect("text");
    assert!(markdown.contains("**badge** (`#star`)"), "{markdown}");
    // From one name to the other.
    let other = editor.ask(
        "textDocument/definition",
        place(&text, "badge</desc></circle>"),
    );
    let second = text.rfind("badge</desc>").expect("a name");
    assert_eq!(other[0]["range"]["start"], position(&text, second));
    assert!(editor.shut_down().success());
}

#[test]
fn every_request_is_answered() {
    let mut editor = Editor::new();
    let text = DRAWING;
    assert_eq!(codes(&editor.opened(URI, text)), ["H402"]);
    let hover = editor.ask("textDocument/hover", place(text, "Rarm@"));
    assert!(
        hover["contents"]["value"]
            .as_str()
            .expect("text")
            .contains("Root › Ubody › **Rarm**")
    );
    assert_eq!(slice(text, &hover["range"]), "Rarm");
    let mut completion = place(text, "undv");
    completion["context"] = json!({"triggerKind": 1});
    let items = editor.ask("textDocument/completion", completion);
    let items = items.as_array().expect("items");
    let cone = items
        .iter()
        .find(|item| item["label"] == "cone")
        .expect("a kind");
    assert_eq!(slice(text, &cone["textEdit"]["range"]), "roundv");
    assert_eq!(cone["textEdit"]["newText"], "cone ${1:0} ${2:12} ${3:0.2}");
    let resolved = editor.ask("completionItem/resolve", cone.clone());
    assert!(
        resolved["documentation"]["value"]
            .as_str()
            .expect("text")
            .starts_with("**Shape cone**")
    );
    let help = editor.ask("textDocument/signatureHelp", place(text, " 90 Color"));
    assert_eq!(help["signatures"][0]["label"], "Shape roundv [a0 a1]");
    assert_eq!(help["activeParameter"], 0);
    let definition = editor.ask("textDocument/definition", place(text, "Ubody$"));
    assert_eq!(slice(text, &definition[0]["range"]), "Ubody");
    let mut references = place(text, "Ubody$");
    references["context"] = json!({"includeDeclaration": true});
    assert_eq!(
        editor
            .ask("textDocument/references", references)
            .as_array()
            .expect("places")
            .len(),
        2
    );
    let highlights = editor.ask("textDocument/documentHighlight", place(text, "thick 4"));
    assert_eq!(highlights.as_array().expect("places").len(), 2);
    let prepared = editor.ask("textDocument/prepareRename", place(text, "Ubody<"));
    assert_eq!(prepared["placeholder"], "Ubody");
    let symbols = editor.ask("textDocument/documentSymbol", document());
    assert_eq!(symbols[0]["name"], "Ubody");
    assert_eq!(
        symbols[0]["children"].as_array().expect("children").len(),
        2
    );
    let selections =
        json!({"textDocument": {"uri": URI}, "positions": [place(text, "roundv")["position"]]});
    let selections = editor.ask("textDocument/selectionRange", selections);
    assert_eq!(slice(text, &selections[0]["range"]), "roundv");
    assert_eq!(
        slice(text, &selections[0]["parent"]["range"]),
        "Shape roundv -90 90"
    );
    let colors = editor.ask("textDocument/documentColor", document());
    assert_eq!(slice(text, &colors[0]["range"]), "#ff8000");
    let mut wanted = json!({"textDocument": {"uri": URI}, "range": colors[0]["range"]});
    wanted["color"] = json!({"red": 0, "green": 0, "blue": 1, "alpha": 1});
    let forms = editor.ask("textDocument/colorPresentation", wanted);
    assert_eq!(forms[0]["label"], "#0000ff");
    let lenses = editor.ask("textDocument/codeLens", document());
    assert_eq!(lenses[0]["command"]["command"], "okoshi.preview");
    let whole = json!({"textDocument": {"uri": URI}, "range": range(text, 0, text.len())});
    let hints = editor.ask("textDocument/inlayHint", whole.clone());
    let hints: Vec<String> = hints
        .as_array()
        .expect("hints")
        .iter()
        .map(|hint| {
            hint["label"]
                .as_array()
                .expect("parts")
                .iter()
                .map(|part| part["value"].as_str().unwrap_or(""))
                .collect()
        })
        .collect();
    assert_eq!(hints, ["left@Ubody", "Smooth 20", "Offset 4 Smooth 20"]);
    let full = editor.ask("textDocument/semanticTokens/full", document());
    let ranged = editor.ask("textDocument/semanticTokens/range", whole);
    assert_eq!(full, ranged);
    assert_eq!(full["data"].as_array().expect("tokens").len() % 5, 0);
    let unknown = editor.refused("workspace/executeCommand", json!({"command": "nonsense"}));
    assert!(
        unknown["message"]
            .as_str()
            .expect("text")
            .contains("nonsense")
    );
    assert!(editor.shut_down().success());
}

#[test]
fn edits_touch_nothing_else() {
    let mut editor = Editor::new();
    let text = DRAWING
        .replace("$Shape roundv", "$ shape  ROUNDV")
        .replace("Ubody</text>", "<![CDATA[Ubody]]></text>")
        .replace('\n', "\r\n");
    editor.opened(URI, &text);
    let options =
        json!({"textDocument": {"uri": URI}, "options": {"tabSize": 2, "insertSpaces": true}});
    let edits = editor.ask("textDocument/formatting", options);
    let formatted = edited(&text, &edits);
    assert_eq!(formatted, text.replace("$ shape  ROUNDV", "$Shape roundv"));
    let mut rename = place(&text, "Ubody$");
    if rename["position"].is_null() {
        rename = place(&text, "Ubody$ shape");
    }
    rename["newName"] = json!("a & b");
    let edits = editor.ask("textDocument/rename", rename);
    let renamed = edited(&text, &edits["changes"][URI]);
    let expected = text
        .replace("<![CDATA[Ubody]]>", "<![CDATA[\"a & b\"]]>")
        .replace("@Ubody", "@\"a &amp; b\"");
    assert_eq!(renamed, expected);
}

#[test]
fn sixty_changes_at_once_give_the_last_state() {
    let mut editor = Editor::new();
    editor.open(URI, 1, DRAWING);
    let mut text = DRAWING.to_owned();
    for version in 2..=61 {
        // Each change inserts a letter into the parent's name.
        let at = text.find("$Shape roundv").expect("the string");
        let change = json!({"range": range(&text, at, at), "text": "x"});
        editor.change(URI, version, &[change]);
        text.insert(at, 'x');
    }
    let last = editor.diagnostics(URI, 61);
    let parent = last.iter().find(|diagnostic| diagnostic["code"] == "E204");
    let word = format!("Ubody{}", "x".repeat(60));
    assert_eq!(
        slice(&text, &parent.expect("the parent is unknown")["range"]),
        word
    );
    let later = editor.remaining_diagnostics();
    assert!(later.is_empty(), "{later:?}");
}

#[test]
fn versions_of_diagnostics_never_decrease() {
    let mut editor = Editor::new();
    editor.open(URI, 1, DRAWING);
    for version in 2..=200 {
        editor.change(
            URI,
            version,
            &[json!({"text": DRAWING.replace("Rarm", &format!("Rarm{version}"))})],
        );
        if version % 20 == 0 {
            editor.ask("textDocument/documentSymbol", document());
        }
    }
    let mut last = 0;
    while last < 200 {
        let note = editor.until(|note| note["method"] == "textDocument/publishDiagnostics");
        let version = note["params"]["version"].as_i64().expect("a version");
        assert!(version > last, "{version} came after {last}");
        last = version;
    }
}

#[test]
fn requests_are_answered_while_xml_is_broken() {
    let mut editor = Editor::new();
    editor.opened(URI, DRAWING);
    let at = DRAWING.find("  <text x=\"5\"").expect("a line");
    let typed = "<text>Larm@<";
    editor.change(
        URI,
        2,
        &[json!({"range": range(DRAWING, at, at), "text": typed})],
    );
    let mut text = DRAWING.to_owned();
    text.insert_str(at, typed);
    assert_eq!(codes(&editor.diagnostics(URI, 2)), ["E001"]);
    // Before and after the edit.
    for (word, told) in [
        ("Rarm@", "Root › Ubody › **Rarm**"),
        ("Let thick", "**Let**"),
    ] {
        let hover = editor.ask("textDocument/hover", place(&text, word));
        assert!(
            hover["contents"]["value"]
                .as_str()
                .expect("text")
                .contains(told)
        );
        let expected = word.split([' ', '@']).next().expect("a word");
        assert_eq!(slice(&text, &hover["range"]), expected);
    }
    let symbols = editor.ask("textDocument/documentSymbol", document());
    assert_eq!(slice(&text, &symbols[0]["selectionRange"]), "Ubody");
    let here = text.find("Larm@<").expect("the typed text") + "Larm@".len();
    let completion = json!({"textDocument": {"uri": URI}, "position": position(&text, here), "context": {"triggerKind": 1}});
    let items = editor.ask("textDocument/completion", completion);
    let labels: Vec<_> = items
        .as_array()
        .expect("items")
        .iter()
        .map(|item| item["label"].as_str().unwrap_or(""))
        .collect();
    assert!(
        labels.contains(&"Ubody") && labels.contains(&"Rarm"),
        "{labels:?}"
    );
    // A text that is not well-formed is not edited.
    let mut rename = place(&text, "Ubody<");
    rename["newName"] = json!("x");
    let error = editor.refused("textDocument/rename", rename);
    assert!(
        error["message"]
            .as_str()
            .expect("text")
            .contains("not well-formed")
    );
}

#[test]
fn columns_count_in_the_negotiated_encoding() {
    let text = DRAWING.replace("Rarm@Ubody", "腕😀@Ubdoy");
    for (offered, agreed, expected) in [
        (json!(["utf-8", "utf-16"]), "utf-8", 8),
        (json!(["utf-16"]), "utf-16", 4),
        (json!(["utf-32"]), "utf-16", 4),
        (Value::Null, "utf-16", 4),
    ] {
        let mut editor = Editor::with(json!({"general": {"positionEncodings": offered}}));
        assert_eq!(editor.offered["capabilities"]["positionEncoding"], agreed);
        let found = editor.opened(URI, &text);
        let parent = found.iter().find(|diagnostic| diagnostic["code"] == "E204");
        let start = &parent.expect("the parent is unknown")["range"]["start"];
        let line = text
            .lines()
            .position(|line| line.contains("腕"))
            .expect("a line");
        let column = text
            .lines()
            .nth(line)
            .expect("a line")
            .find('腕')
            .expect("a place");
        assert_eq!(
            start,
            &json!({"line": line, "character": column + expected})
        );
    }
}

#[test]
fn changed_links_are_analyzed_again() {
    let folder = tempfile::tempdir().expect("a folder");
    let text = DRAWING.replace("Color #ff8000", "Texture \"sail.png\"");
    let uri = address(&folder.path().join("a.svg"));
    let mut editor = Editor::new();
    assert!(codes(&editor.opened(&uri, &text)).contains(&"E006"));
    let gull = concat!(env!("CARGO_MANIFEST_DIR"), "/examples/gull.png");
    fs::copy(gull, folder.path().join("sail.png")).expect("a picture");
    let without = |editor: &mut Editor, wanted: bool| {
        editor.until(|note| {
            let found = note["params"]["diagnostics"].as_array();
            note["method"] == "textDocument/publishDiagnostics"
                && found.is_some_and(|found| codes(found).contains(&"E006") == wanted)
        });
    };
    without(&mut editor, false);
    fs::remove_file(folder.path().join("sail.png")).expect("gone");
    without(&mut editor, true);
    // Completion lists the folder, and the definition is the file.
    fs::copy(gull, folder.path().join("sail.png")).expect("a picture");
    without(&mut editor, false);
    let at = text.find("sail.png").expect("the name");
    let here = json!({"textDocument": {"uri": uri}, "position": position(&text, at), "context": {"triggerKind": 1}});
    let items = editor.ask("textDocument/completion", here.clone());
    assert_eq!(items[0]["textEdit"]["newText"], "\"sail.png\"");
    let definition = editor.ask("textDocument/definition", here);
    assert_eq!(
        definition[0]["uri"],
        address(&folder.path().join("sail.png"))
    );
}

#[test]
fn a_long_list_of_parts_is_incomplete() {
    let part = |index: usize| {
        let (x, y) = (40 * (index % 50), 40 * (index / 50));
        format!(
            "<rect x=\"{x}\" y=\"{y}\" width=\"30\" height=\"30\"/><text x=\"{}\" y=\"{}\">Part{index}@Part0</text>\n",
            x + 15,
            y + 15
        )
    };
    let parts: String = (0..600).map(part).collect();
    let text = format!("<svg xmlns=\"http://www.w3.org/2000/svg\">\n{parts}</svg>");
    let mut editor = Editor::new();
    editor.opened(URI, &text);
    let listed = |editor: &mut Editor, text: &str, at: usize| {
        let here = json!({"textDocument": {"uri": URI}, "position": position(text, at), "context": {"triggerKind": 1}});
        let list = editor.ask("textDocument/completion", here);
        assert_eq!(list["isIncomplete"], true);
        list["items"].as_array().expect("items").clone()
    };
    let sign = text.find("Part599@").expect("the last string") + "Part599@".len();
    assert_eq!(listed(&mut editor, &text, sign).len(), 500);
    let end = sign + "Part0".len();
    let change = json!({"range": range(&text, sign, end), "text": "Part598"});
    editor.change(URI, 2, &[change]);
    let text = format!("{}Part598{}", &text[..sign], &text[end..]);
    let found = listed(&mut editor, &text, sign + "Part598".len());
    assert_eq!(found.len(), 1);
    assert_eq!(found[0]["label"], "Part598");
    assert_eq!(slice(&text, &found[0]["textEdit"]["range"]), "Part598");
}

#[test]
fn diagnostics_can_be_requested() {
    let mut editor = Editor::with(json!({
        "textDocument": {"diagnostic": {}},
        "workspace": {"diagnostics": {"refreshSupport": true}},
    }));
    assert!(editor.offered["capabilities"]["diagnosticProvider"].is_object());
    let sent = editor.opened(URI, DRAWING);
    let report = editor.ask("textDocument/diagnostic", document());
    assert_eq!(report["kind"], "full");
    assert_eq!(report["items"], json!(sent));
    let mut again = document();
    again["previousResultId"] = report["resultId"].clone();
    let same = editor.ask("textDocument/diagnostic", again.clone());
    assert_eq!(same["kind"], "unchanged");
    editor.change(
        URI,
        2,
        &[json!({"text": DRAWING.replace("@Ubody", "@Nobody")})],
    );
    let report = editor.ask("textDocument/diagnostic", again);
    assert!(codes(report["items"].as_array().expect("items")).contains(&"E204"));
    // A client that requests diagnostics is not sent them.
    let sent = editor.remaining_diagnostics();
    assert!(
        sent.iter()
            .all(|note| note["params"]["diagnostics"] == json!([])),
        "{sent:?}"
    );
    // A client without that capability is not asked to refresh.
    assert!(Editor::new().offered["capabilities"]["diagnosticProvider"].is_null());
}

#[test]
fn texts_are_analyzed_on_type_or_on_save() {
    let params = json!({"processId": null, "capabilities": {}, "initializationOptions": {"analyse": "onSave"}});
    let mut editor = Editor::initialized(params);
    editor.opened(URI, DRAWING);
    let wrong = DRAWING.replace("@Ubody", "@Nobody");
    editor.change(URI, 2, &[json!({"text": wrong})]);
    // It is analysed for a request, though not for its diagnostics.
    editor.ask("textDocument/definition", place(DRAWING, "Rarm@"));
    assert_eq!(editor.remaining_diagnostics(), [Value::Null; 0]);
    editor.notify("textDocument/didSave", document());
    assert!(codes(&editor.diagnostics(URI, 2)).contains(&"E204"));
    // Requests are answered for the present text, saved or not.
    editor.change(URI, 3, &[json!({"text": DRAWING})]);
    let definition = editor.ask("textDocument/definition", place(DRAWING, "Ubody$"));
    assert_eq!(definition.as_array().expect("places").len(), 1);
    editor.notify(
        "workspace/didChangeConfiguration",
        json!({"settings": {"okoshi": {"analyse": "onType"}}}),
    );
    editor.change(URI, 4, &[json!({"text": wrong})]);
    assert!(codes(&editor.diagnostics(URI, 4)).contains(&"E204"));
}

#[test]
fn requests_can_be_canceled() {
    let mut editor = Editor::new();
    // Large enough that its analysis is still running when the request is cancelled.
    let text = many(4_000);
    editor.open(URI, 1, &text);
    // In one piece, so that the server reads both at once.
    let [hover, cancel] = [
        json!({"jsonrpc": "2.0", "id": 99, "method": "textDocument/hover", "params": place(&text, "Rarm@")}),
        json!({"jsonrpc": "2.0", "method": "$/cancelRequest", "params": {"id": 99}}),
    ]
    .map(|message| message.to_string())
    .map(|body| format!("Content-Length: {}\r\n\r\n{body}", body.len()));
    editor.send_raw(&(hover + &cancel));
    assert_eq!(editor.answer(99)["error"]["code"], -32800);
    editor.diagnostics(URI, 1);
    assert!(editor.shut_down().success());
}

#[test]
fn a_long_analysis_shows_progress() {
    let mut editor = Editor::with(json!({"window": {"workDoneProgress": true}}));
    let text = many(40_000).replace("</svg>", &format!("<!--{}--></svg>", "あ".repeat(1 << 20)));
    assert!(text.len() > 5_000_000, "{} bytes", text.len());
    editor.open(URI, 1, &text);
    let created = editor.until(|note| note["method"] == "window/workDoneProgress/create");
    let token = created["params"]["token"].clone();
    let mut is_published = false;
    for kind in ["begin", "end"] {
        let note = editor.until(|note| {
            // The findings and the end of the progress may come in any order.
            is_published |= note["method"] == "textDocument/publishDiagnostics";
            note["method"] == "$/progress"
        });
        assert_eq!(note["params"]["token"], token);
        assert_eq!(note["params"]["value"]["kind"], kind);
    }
    if !is_published {
        editor.diagnostics(URI, 1);
    }
}

#[test]
fn the_server_ends_with_its_client() {
    assert_eq!(Editor::new().shut_down().code(), Some(0));
    // Without `exit` it ends too, with an error status.
    assert_eq!(Editor::new().disconnect().code(), Some(1));
    let mut editor = Editor::new();
    editor.notify("exit", Value::Null);
    assert_eq!(editor.disconnect().code(), Some(1));
    // Some clients send `shutdown` with empty parameters.
    let mut editor = Editor::new();
    editor.ask("shutdown", json!({}));
    editor.notify("exit", json!({}));
    assert_eq!(editor.disconnect().code(), Some(0));
}

#[cfg(target_os = "linux")]
#[test]
fn the_server_ends_with_its_clients_process() {
    let mut client = std::process::Command::new("sleep")
        .arg("60")
        .spawn()
        .expect("a process");
    let editor = Editor::initialized(json!({"processId": client.id(), "capabilities": {}}));
    client.kill().expect("killed");
    client.wait().expect("gone");
    let here = format!("/proc/{}/stat", editor.id());
    wait_until("the server to end", || {
        !fs::read_to_string(&here).is_ok_and(|stat| !stat.contains(") Z "))
    });
}

#[test]
fn invalid_requests_are_answered() {
    let mut editor = Editor::new();
    assert_eq!(
        editor.refused("textDocument/hover", json!({"nonsense": 1}))["code"],
        -32602
    );
    assert_eq!(editor.refused("no/such", json!({}))["code"], -32601);
    // A text that was never opened.
    assert!(
        editor
            .ask("textDocument/hover", place(DRAWING, "Rarm@"))
            .is_null()
    );
    editor.change(URI, 1, &[json!({"text": "x"})]);
    editor.notify("textDocument/didChange", json!({"nonsense": 1}));
    // Positions outside of the text are clamped.
    editor.opened(URI, DRAWING);
    let far = json!({"line": 99_999, "character": 99_999});
    editor.change(
        URI,
        2,
        &[json!({"range": {"start": far, "end": far}, "text": "<!-- end -->"})],
    );
    editor.diagnostics(URI, 2);
    let hover = json!({"textDocument": {"uri": URI}, "position": far});
    assert!(editor.ask("textDocument/hover", hover).is_null());
    assert!(editor.shut_down().success());
}

#[test]
fn parts_of_all_drawings_are_found_by_name() {
    let folder = tempfile::tempdir().expect("a folder");
    fs::create_dir(folder.path().join("inner")).expect("a folder");
    fs::write(
        folder.path().join("inner/b.svg"),
        DRAWING.replace("Rarm", "Wing"),
    )
    .expect("written");
    let root = address(folder.path());
    let mut editor = Editor::initialized(json!({
        "processId": null,
        "capabilities": {},
        "workspaceFolders": [{"uri": root, "name": "drawings"}],
    }));
    let uri = address(&folder.path().join("a.svg"));
    editor.opened(&uri, DRAWING);
    let found = editor.ask("workspace/symbol", json!({"query": "w"}));
    let names: Vec<_> = found
        .as_array()
        .expect("symbols")
        .iter()
        .map(|symbol| symbol["name"].as_str().unwrap_or(""))
        .collect();
    assert_eq!(names, ["Wing"]);
    assert_eq!(found[0]["containerName"], "Ubody");
    let all = editor.ask("workspace/symbol", json!({"query": ""}));
    assert_eq!(all.as_array().expect("symbols").len(), 6);
}

#[test]
fn messages_that_cannot_be_read_are_answered() {
    let mut editor = Editor::new();
    editor.opened(URI, DRAWING);
    let notify = |text: &str| {
        format!(
            r#"{{"jsonrpc":"2.0","method":"textDocument/didChange","params":{{"textDocument":{{"uri":"{URI}","version":2}},"contentChanges":[{{"range":{{"start":{{"line":10,"character":0}},"end":{{"line":10,"character":0}}}},"text":"{text}"}}]}}}}"#
        )
    };
    for (bad, code) in [
        ("{\"jsonrpc\": \"2.0\", ", -32700),
        (
            "[{\"jsonrpc\": \"2.0\", \"method\": \"initialized\"}]",
            -32600,
        ),
        ("{\"id\": 1}", -32600),
    ] {
        editor.send_raw(&format!("Content-Length: {}\r\n\r\n{bad}", bad.len()));
        assert_eq!(editor.answer_to_nothing()["error"]["code"], code, "{bad}");
    }
    // Half a character is a change like any other, as long as one character of UTF-16.
    let half = notify("<!-- \\ud83d -->\\n");
    editor.send_raw(&format!("Content-Length: {}\r\n\r\n{half}", half.len()));
    editor.diagnostics(URI, 2);
    assert!(editor.ask("textDocument/hover", place(DRAWING, "Rarm@"))["contents"].is_object());
    assert!(editor.shut_down().success());
}

#[cfg(target_os = "linux")]
#[test]
fn closed_texts_give_their_memory_back() {
    let mut editor = Editor::new();
    let status = format!("/proc/{}/status", editor.id());
    let resident = || {
        let status = fs::read_to_string(&status).expect("it runs");
        let line = status.lines().find(|line| line.starts_with("VmRSS:"));
        let number = line.and_then(|line| line.split_whitespace().nth(1)?.parse::<u64>().ok());
        number.expect("a number") >> 10
    };
    let idle = resident();
    editor.opened(URI, &many(10_000));
    let open = resident();
    editor.notify("textDocument/didClose", document());
    // Without optimisation, and with other threads at work, less is given back.
    wait_until(
        &format!("a third of {open} - {idle} MiB to be given back"),
        || resident().saturating_sub(idle) <= (open - idle) * 2 / 3,
    );
}
