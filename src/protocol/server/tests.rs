use serde_json::{Value, json};

use super::Server;
use crate::resolver::inside;

const URI: &str = "vscode-vfs://github/ann/a%20b/figure%201.svg";
const DRAWING: &str = r##"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 200 200">
  <rect id="body" x="70" y="80" width="60" height="90" fill="#d9534f"/>
  <rect id="arm" x="40" y="84" width="40" height="14" fill="#f2c19c"/>
  <text x="100" y="125">Body$Shape default -12 12</text>
  <text x="60" y="92">Arm@Body$Shap roundv</text>
</svg>"##;

fn opened(text: &str) -> Server {
    let mut server = Server::default();
    let capabilities = json!({ "textDocument": { "definition": { "linkSupport": false } } });
    ask(
        &mut server,
        "initialize",
        &json!({ "capabilities": capabilities }),
    );
    server.write(URI, 1, text, 0.0).unwrap();
    server
}

fn answer(server: &mut Server, method: &str, params: &Value) -> Value {
    serde_json::from_str(&server.request(method, &params.to_string(), 0.0)).unwrap()
}

fn ask(server: &mut Server, method: &str, params: &Value) -> Value {
    let answer = answer(server, method, params);
    assert!(answer.get("error").is_none(), "{method}: {answer}");
    answer["result"].clone()
}

fn about(more: Value) -> Value {
    let mut params = json!({ "textDocument": { "uri": URI } });
    if let (Some(params), Value::Object(more)) = (params.as_object_mut(), more) {
        params.extend(more);
    }
    params
}

/// The position of a text in the drawing.
fn at(text: &str, wanted: &str) -> Value {
    let before = &text[..text.find(wanted).unwrap()];
    let line = before.matches('\n').count();
    let column = before.len() - before.rfind('\n').map_or(0, |end| end + 1);
    json!({ "line": line, "character": column })
}

fn codes(server: &Server) -> Vec<String> {
    let found: Vec<Value> = serde_json::from_str(&server.diagnostics(URI)).unwrap();
    let codes = found.iter().map(|one| one["code"].as_str().unwrap());
    codes.map(str::to_owned).collect()
}

#[test]
fn a_text_is_analysed_whenever_it_is_written() {
    let mut server = opened(DRAWING);
    assert_eq!(codes(&server), ["E101"]);
    let right = DRAWING.replace("Shap roundv", "Shape roundv");
    server.write(URI, 2, &right, 0.0).unwrap();
    assert!(codes(&server).is_empty());
    server.close(URI);
    let answer = answer(
        &mut server,
        "textDocument/hover",
        &about(json!({ "position": at(DRAWING, "Arm@") })),
    );
    assert_eq!(answer["error"]["code"], -32602);
    assert!(server.write("no address", 1, "", 0.0).is_err());
}

#[test]
fn while_a_text_is_no_xml_the_last_one_that_was_is_asked() {
    let mut server = opened(DRAWING);
    let broken = DRAWING.replace("</svg>", "<rect </svg>");
    server.write(URI, 2, &broken, 0.0).unwrap();
    let hover = ask(
        &mut server,
        "textDocument/hover",
        &about(json!({ "position": at(DRAWING, "Arm@") })),
    );
    assert!(hover["contents"]["value"].as_str().unwrap().contains("Arm"));
}

#[test]
fn every_capability_is_answered() {
    let mut server = opened(DRAWING);
    let position = at(DRAWING, "Arm@");
    let range = json!({ "start": position, "end": position });
    for (method, more) in [
        ("hover", json!({ "position": position })),
        ("completion", json!({ "position": position })),
        (
            "signatureHelp",
            json!({ "position": at(DRAWING, " -12 12") }),
        ),
        ("definition", json!({ "position": at(DRAWING, "Body$") })),
        (
            "references",
            json!({ "position": position, "context": { "includeDeclaration": true } }),
        ),
        ("documentHighlight", json!({ "position": position })),
        ("documentSymbol", json!({})),
        (
            "codeAction",
            json!({ "range": { "start": at(DRAWING, "Shap r"), "end": at(DRAWING, "Shap r") }, "context": { "diagnostics": [] } }),
        ),
        ("codeLens", json!({})),
        (
            "formatting",
            json!({ "options": { "tabSize": 2, "insertSpaces": true } }),
        ),
        ("rangeFormatting", json!({ "range": range })),
        ("prepareRename", json!({ "position": position })),
        ("rename", json!({ "position": position, "newName": "Hand" })),
        ("documentColor", json!({})),
        ("foldingRange", json!({})),
        ("selectionRange", json!({ "positions": [position] })),
        ("semanticTokens/full", json!({})),
        ("semanticTokens/range", json!({ "range": range })),
        (
            "inlayHint",
            json!({ "range": { "start": { "line": 0, "character": 0 }, "end": { "line": 6, "character": 0 } } }),
        ),
    ] {
        let found = ask(&mut server, &format!("textDocument/{method}"), &about(more));
        assert!(!found.is_null(), "{method}");
    }
    let unknown = answer(&mut server, "textDocument/moniker", &about(json!({})));
    assert_eq!(unknown["error"]["code"], -32601);
}

#[test]
fn linked_files_are_named_read_and_gone_to() {
    let link = "%20motions/walk%201.bvh";
    let text = DRAWING.replace(
        "Body$Shape default -12 12",
        &format!("Body$Motion &quot;{link}&quot;"),
    );
    let mut server = opened(&text);
    let links = server.links(URI);
    assert!(
        links.contains(&" motions/walk 1.bvh".to_owned()),
        "{links:?}"
    );
    assert!(links.iter().all(|link| inside(link).as_deref() == Ok(link)));
    let before = codes(&server);
    server.put(URI, " motions/walk 1.bvh", Some(b"HIERARCHY".to_vec()));
    server.renew(URI, 0.0);
    assert_ne!(codes(&server), before);
    let place = about(json!({ "position": at(&text, "motions/walk") }));
    let found = ask(&mut server, "textDocument/definition", &place);
    assert_eq!(
        found[0]["uri"],
        "vscode-vfs://github/ann/a%20b/%20motions/walk%201.bvh"
    );
    server.put(URI, " motions/walk 1.bvh", None);
    server.renew(URI, 0.0);
    assert_eq!(codes(&server), before);
}

#[test]
fn a_panel_gets_the_models_of_its_text_alone() {
    let right = DRAWING.replace("Shap roundv", "Shape roundv");
    let mut server = opened(&right);
    server.write("untitled:Untitled-1", 1, &right, 0.0).unwrap();
    assert!(server.news(URI).is_empty());
    ask(&mut server, "okoshi/preview/open", &about(json!({})));
    let types = |server: &mut Server| -> Vec<Value> {
        let news = server.news(URI);
        news.iter()
            .map(|message| serde_json::from_str(message).unwrap())
            .collect()
    };
    let news = types(&mut server);
    assert_eq!(news[0]["type"], "editing");
    let listed = news.iter().find(|one| one["type"] == "drawings").unwrap();
    assert_eq!(
        listed["drawings"],
        json!([{ "id": URI, "name": "figure 1.svg", "folder": "" }])
    );
    let build = news.iter().find(|one| one["type"] == "build").unwrap();
    let bytes = server
        .bytes(build["build"]["model"].as_str().unwrap())
        .unwrap();
    assert!(bytes.starts_with(b"glTF"));
    assert!(types(&mut server).is_empty());

    let change = json!({ "change": "set", "part": "Arm", "attribute": "Segments", "value": "12" });
    let params = about(json!({ "change": change }));
    let made = ask(&mut server, "okoshi/preview/change", &params);
    assert_eq!(
        (&made["version"], made["edits"].as_array().unwrap().len()),
        (&json!(1), 1)
    );
    assert!(
        server
            .attempt(&params.to_string())
            .unwrap()
            .starts_with(b"glTF")
    );
    // The text is the editor's.
    assert!(types(&mut server).is_empty());
    ask(&mut server, "okoshi/preview/close", &about(json!({})));
    server.write(URI, 2, &right, 0.0).unwrap();
    assert!(server.news(URI).is_empty());
}
