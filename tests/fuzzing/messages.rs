//! Whatever a client sends, the first stage of the language server passes on only messages that the framework can decode,
//! and changes nothing about those.

use futures::executor::block_on;
use okoshi::internals::lsp::pass_on;
use serde_json::{Value, json};

pub(super) fn check(bytes: &[u8]) -> bool {
    let passed = passed_on(bytes);
    let mut rest = passed.as_slice();
    while !rest.is_empty() {
        rest = check_message(rest);
    }
    assert!(passed_on(&passed) == passed, "it is not passed on again");
    !passed.is_empty()
}

/// Checks the first message, and returns what follows it.
fn check_message(stream: &[u8]) -> &[u8] {
    let end = stream.windows(4).position(|four| four == b"\r\n\r\n");
    let (head, rest) = stream.split_at(end.expect("a header has an end") + 4);
    let head = std::str::from_utf8(head).expect("a header is text");
    let length = head.trim_end().strip_prefix("Content-Length: ");
    let length = length.and_then(|length| length.parse().ok());
    let (body, rest) = rest.split_at(length.expect("a length"));
    let message: Value = serde_json::from_slice(body).expect("a message is JSON");
    assert_eq!(message["jsonrpc"], "2.0", "{message}");
    rest
}

fn passed_on(bytes: &[u8]) -> Vec<u8> {
    let mut passed = Vec::new();
    block_on(pass_on(bytes, &mut passed)).expect("streams in memory do not fail");
    passed
}

pub(super) fn seeds() -> Vec<Vec<u8>> {
    let position =
        json!({"textDocument": {"uri": "untitled:a"}, "position": {"line": 1, "character": 2}});
    let messages = [
        json!({"jsonrpc": "2.0", "id": 1, "method": "initialize", "params": {"capabilities": {}}})
            .to_string(),
        json!({"jsonrpc": "2.0", "id": "b", "method": "textDocument/hover", "params": position})
            .to_string(),
        json!({"jsonrpc": "2.0", "method": "exit"}).to_string(),
        json!({"jsonrpc": "2.0", "id": 1, "result": null}).to_string(),
        json!({"jsonrpc": "2.0", "id": null, "error": {"code": -32700, "message": "?"}})
            .to_string(),
        r#"{"jsonrpc":"2.0","id":2,"method":"a","params":["\ud83d\ude00 \ud83d \\ud83d \ude00"]}"#
            .to_owned(),
        "[]".to_owned(),
        String::new(),
    ];
    let framed = |body: &String| format!("Content-Length: {}\r\n\r\n{body}", body.len());
    let mut seeds: Vec<Vec<u8>> = messages.iter().map(|body| framed(body).into()).collect();
    let all: String = messages.iter().map(framed).collect();
    seeds.push(all.into_bytes());
    seeds.push(
        b"content-length: 2\r\nContent-Type: x\r\n\r\n{}\n\nContent-Length: -1\r\n\r\nnoise"
            .to_vec(),
    );
    seeds
}
