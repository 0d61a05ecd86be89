//! The live preview of open texts, in a client's own panel and on a page.
#![cfg(feature = "cli")]

mod common;

use base64::Engine;
use common::editor::{Editor, position};
use common::patience::PATIENCE;
use serde_json::{Value, json};
use tungstenite::Message;
use tungstenite::stream::MaybeTlsStream;

const URI: &str = "untitled:a.svg";

const DRAWING: &str = r##"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 200 100">
  <rect id="body" x="80" y="20" width="40" height="60" fill="#336699"/>
  <rect id="right" x="20" y="40" width="60" height="10" fill="#ffcc99"/>
  <text x="100" y="54" font-size="5">Ubody$Shape default -5 5</text>
  <text x="50" y="49" font-size="5">Rarm@Ubody</text>
</svg>
"##;

fn document() -> Value {
    json!({"textDocument": {"uri": URI}})
}

/// The next message of a kind to the panel.
fn news(editor: &mut Editor, kind: &str) -> Value {
    let is_wanted = |message: &Value| {
        let messages = message["params"]["messages"].as_array();
        message["method"] == "okoshi/preview/news"
            && messages.is_some_and(|all| all.iter().any(|one| one["type"] == kind))
    };
    let found = editor.until(is_wanted);
    assert_eq!(found["params"]["textDocument"]["uri"], URI);
    let messages = found["params"]["messages"].as_array().expect("messages");
    let wanted = messages.iter().rfind(|message| message["type"] == kind);
    wanted.expect("it is there").clone()
}

/// The model of a build, fetched as a panel does.
fn model(editor: &mut Editor, build: &Value) -> Vec<u8> {
    let address = &build["build"]["model"];
    let answer = editor.ask("okoshi/preview/model", json!({"address": address}));
    let bytes = answer["bytes"].as_str().expect("base64");
    let standard = base64::engine::general_purpose::STANDARD;
    standard.decode(bytes).expect("base64")
}

fn insert(editor: &mut Editor, text: &mut String, version: i64, at: usize, what: &str) {
    let place = position(text, at);
    let change = json!({"range": {"start": place, "end": place}, "text": what});
    text.insert_str(at, what);
    editor.change(URI, version, &[change]);
}

#[test]
fn panels_show_unsaved_texts() {
    let mut editor = Editor::initialized(json!({
        "processId": null,
        "capabilities": {},
        "initializationOptions": {"preview": true},
    }));
    let mut text = DRAWING.to_owned();
    editor.opened(URI, &text);
    editor.ask("okoshi/preview/open", document());
    let build = news(&mut editor, "build");
    assert_eq!(build["drawing"], URI);
    assert_eq!(build["build"]["parts"][1]["name"], "Rarm");
    let first = model(&mut editor, &build);
    // The root, the body, the arm with four more nodes inside, and the node that shows its mesh.
    assert_eq!(common::nodes(&first).expect("a sound model").len(), 8);

    // A keystroke that is an error keeps the model; the next one fixes it.
    let at = text.find("-5 5<").expect("the depths");
    insert(&mut editor, &mut text, 2, at, "x");
    let build = news(&mut editor, "build");
    assert_eq!(build["build"]["stale"], true);
    assert_eq!(build["build"]["findings"][0]["severity"], "error");
    assert!(model(&mut editor, &build) == first);
    let place = |at| position(&text, at);
    let change = json!({"range": {"start": place(at), "end": place(at + 2)}, "text": "-1"});
    text.replace_range(at..at + 2, "-1");
    editor.change(URI, 3, &[change]);
    let build = news(&mut editor, "build");
    assert_eq!(build["build"]["stale"], false);
    assert!(model(&mut editor, &build) != first);

    // The cursor highlights parts, in strings and in tags, and nothing elsewhere.
    for (word, part) in [
        ("Rarm@", json!("Rarm")),
        ("rect id=\"body", json!("Ubody")),
        ("viewBox", Value::Null),
    ] {
        let at = text.find(word).expect("the word is there");
        let cursor = json!({"textDocument": {"uri": URI}, "position": position(&text, at)});
        editor.notify("okoshi/preview/cursor", cursor);
        assert_eq!(news(&mut editor, "light")["part"], part, "{word}");
    }

    let place = editor.ask(
        "okoshi/preview/place",
        json!({"textDocument": {"uri": URI}, "part": "Rarm"}),
    );
    assert_eq!(
        place["range"]["start"],
        position(&text, text.find("Rarm@").expect("there"))
    );
    let nowhere = editor.ask(
        "okoshi/preview/place",
        json!({"textDocument": {"uri": URI}, "part": "Nobody"}),
    );
    assert!(nowhere.is_null());

    editor.notify("okoshi/preview/close", document());
    editor.ask("okoshi/preview/model", json!({"address": "builds/1.glb"}));
    insert(&mut editor, &mut text, 4, at, " ");
    editor.diagnostics(URI, 4);
    // Texts are built in the order of their addresses: nothing is heard of the closed one before this one is shown.
    const LAST: &str = "untitled:b.svg";
    editor.opened(LAST, DRAWING);
    editor.ask(
        "okoshi/preview/open",
        json!({"textDocument": {"uri": LAST}}),
    );
    editor.until(|message| {
        let is_news = message["method"] == "okoshi/preview/news";
        let uri = &message["params"]["textDocument"]["uri"];
        assert!(!is_news || uri == LAST, "{message}");
        is_news && message.to_string().contains("\"revision\"")
    });
    editor.notify(
        "okoshi/preview/close",
        json!({"textDocument": {"uri": LAST}}),
    );
    editor.ask("okoshi/preview/open", document());
    news(&mut editor, "build");
    assert!(editor.shut_down().success());
}

#[test]
fn panels_get_forms_and_the_edits_of_changes() {
    let mut editor = Editor::initialized(json!({
        "capabilities": {},
        "initializationOptions": {"preview": true},
    }));
    editor.opened(URI, DRAWING);
    editor.ask("okoshi/preview/open", document());
    assert_eq!(news(&mut editor, "editing")["key"], "");
    let about = |rest: Value| {
        let mut params = document();
        let fields = params.as_object_mut().expect("fields");
        fields.extend(rest.as_object().expect("fields").clone());
        params
    };
    let form = editor.ask("okoshi/preview/form", about(json!({"part": "Rarm"})));
    assert_eq!(form["form"]["parent"], "Ubody");
    let set = |value: &str| {
        let change =
            json!({"change": "set", "part": "Ubody", "attribute": "Shape", "value": value});
        about(json!({"change": change}))
    };
    let answer = editor.ask("okoshi/preview/change", set("default -5 9"));
    let at = DRAWING.find("5<").expect("a depth");
    assert_eq!(
        answer,
        json!({
            "version": 1,
            "edits": [{"range": {"start": position(DRAWING, at), "end": position(DRAWING, at + 1)}, "newText": "9"}],
            "part": "Ubody",
            "note": null,
        })
    );
    // What is only tried has a model, and the text stays as it is.
    let tried = editor.ask("okoshi/preview/try", set("default -5 9"));
    let standard = base64::engine::general_purpose::STANDARD;
    let bytes = standard.decode(tried["bytes"].as_str().expect("base64"));
    assert!(common::nodes(&bytes.expect("base64")).is_ok());
    let answer = editor.ask("okoshi/preview/change", set("nonsense"));
    let why = answer["refused"]["why"].as_str().expect("a sentence");
    assert!(why.contains("nonsense"), "{why}");
    assert!(editor.ask("okoshi/preview/try", set("nonsense")).is_null());
    let nobody = editor.ask("okoshi/preview/form", about(json!({"part": "Nobody"})));
    assert_eq!(nobody["refused"]["why"], "there is no part `Nobody`");
    assert!(editor.shut_down().success());
}

#[test]
fn landscapes_are_listed_with_their_strings() {
    let mut editor = Editor::initialized(json!({
        "capabilities": {},
        "initializationOptions": {"preview": true},
    }));
    let text = r##"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 50 60"><g id="map">
        <text x="0" y="5" font-size="5">Hill$Tiles 10</text>
        <rect id="top" x="0" y="10" width="30" height="20" fill="#4caf50"/>
        <rect id="cliff" x="0" y="30" width="30" height="20" fill="#8d6e63"/></g></svg>"##;
    editor.opened(URI, text);
    editor.ask("okoshi/preview/open", document());
    let build = news(&mut editor, "build");
    let parts = build["build"]["parts"].as_array().expect("parts");
    assert_eq!(parts.len(), 1);
    assert_eq!(
        (&parts[0]["name"], &parts[0]["kind"], &parts[0]["element"]),
        (&json!("Hill"), &json!("terrain"), &json!("map"))
    );
    let place = editor.ask(
        "okoshi/preview/place",
        json!({"textDocument": {"uri": URI}, "part": "Hill"}),
    );
    let string = text.find("Hill$").expect("there");
    assert_eq!(place["range"]["start"], position(text, string));
    let at = text.find("rect id=\"cliff\"").expect("there");
    let cursor = json!({"textDocument": {"uri": URI}, "position": position(text, at)});
    editor.notify("okoshi/preview/cursor", cursor);
    assert_eq!(news(&mut editor, "light")["part"], "Hill");
    assert!(editor.shut_down().success());
}

#[test]
fn texts_of_editors_without_panels_are_shown_on_a_page() {
    let mut editor = Editor::with(json!({"window": {"showDocument": {"support": true}}}));
    let mut text = DRAWING.to_owned();
    editor.opened(URI, &text);
    let id = editor.request(
        "workspace/executeCommand",
        json!({"command": "okoshi.preview", "arguments": [URI]}),
    );
    let asked = |editor: &mut Editor| {
        let request = editor.until(|message| message["method"] == "window/showDocument");
        editor.send(&json!({"jsonrpc": "2.0", "id": request["id"], "result": {"success": true}}));
        request["params"].clone()
    };
    let shown = asked(&mut editor);
    assert_eq!(shown["external"], true);
    assert!(editor.answer(id)["result"].is_null());
    let page = shown["uri"].as_str().expect("an address");
    let (address, drawing) = page.split_once("/#").expect("the drawing behind a #");
    assert_eq!(drawing, "untitled%3Aa.svg");
    let socket = address.replace("http://127.0.0.1", "ws://127.0.0.1");
    let (mut socket, _) = tungstenite::connect(format!("{socket}/live")).expect("let in");
    if let MaybeTlsStream::Plain(stream) = socket.get_ref() {
        stream.set_read_timeout(Some(PATIENCE)).expect("a timeout");
    }
    let mut heard = |kind: &str| {
        loop {
            if let Message::Text(text) = socket.read().expect("a message") {
                let message: Value = serde_json::from_str(&text).expect("JSON");
                if message["type"] == kind {
                    return message;
                }
            }
        }
    };
    assert_eq!(heard("build")["drawing"], URI);
    let at = text.find("5<").expect("a depth");
    insert(&mut editor, &mut text, 2, at, "1");
    assert_eq!(heard("build")["build"]["revision"], 2);
    let pick = json!({"type": "pick", "drawing": URI, "part": "Rarm"});
    socket.send(Message::text(pick.to_string())).expect("sent");
    let shown = asked(&mut editor);
    assert_eq!(shown["uri"], URI);
    assert_eq!(
        shown["selection"]["start"],
        position(&text, text.find("Rarm@").expect("there"))
    );
    let open = json!({"type": "open", "drawing": URI, "line": 5, "column": 36});
    socket.send(Message::text(open.to_string())).expect("sent");
    let shown = asked(&mut editor);
    assert_eq!(
        shown["selection"]["start"],
        json!({"line": 4, "character": 35})
    );
    assert!(editor.shut_down().success());
}
