//! Tests that need a planted panic: in a handler, and while compiling.

use serde_json::{Value, json};
use tokio::io::{AsyncReadExt, AsyncWriteExt, DuplexStream};
use tower_lsp::LspServiceBuilder;
use tower_lsp::jsonrpc::Result;

use super::backend::Backend;
use crate::compile::PLANTED_CRASH;

impl Backend {
    async fn planted_panic(&self) -> Result<()> {
        tokio::task::yield_now().await;
        panic!("planted");
    }
}

/// Adds a request that panics.
pub(super) fn plant(builder: LspServiceBuilder<Backend>) -> LspServiceBuilder<Backend> {
    builder.custom_method("test/panic", Backend::planted_panic)
}

async fn send(to: &mut DuplexStream, message: Value) {
    let body = message.to_string();
    let text = format!("Content-Length: {}\r\n\r\n{body}", body.len());
    to.write_all(text.as_bytes()).await.unwrap();
}

async fn receive(from: &mut DuplexStream) -> Value {
    let mut head = vec![];
    while !head.ends_with(b"\r\n\r\n") {
        head.push(from.read_u8().await.unwrap());
    }
    let head = String::from_utf8(head).unwrap();
    let length = head
        .lines()
        .find_map(|line| line.strip_prefix("Content-Length: "));
    let mut body = vec![0; length.unwrap().parse().unwrap()];
    from.read_exact(&mut body).await.unwrap();
    serde_json::from_slice(&body).unwrap()
}

#[tokio::test(flavor = "multi_thread")]
async fn a_panic_is_answered_with_an_error() {
    let (mut client, input) = tokio::io::duplex(1 << 16);
    let (output, mut answers) = tokio::io::duplex(1 << 16);
    let server = tokio::spawn(super::serve_client(input, output));
    let request = |id: u32, method: &str| json!({"jsonrpc": "2.0", "id": id, "method": method, "params": {"capabilities": {}}});
    send(&mut client, request(1, "initialize")).await;
    assert_eq!(receive(&mut answers).await["id"], 1);
    for id in 2..8 {
        send(
            &mut client,
            json!({"jsonrpc": "2.0", "id": id, "method": "test/panic"}),
        )
        .await;
        let answer = receive(&mut answers).await;
        assert_eq!(answer["id"], id);
        assert_eq!(answer["error"]["code"], -32603);
        let message = answer["error"]["message"].as_str().unwrap();
        assert!(message.starts_with("okoshi crashed: planted"), "{message}");
    }
    send(
        &mut client,
        json!({"jsonrpc": "2.0", "id": 9, "method": "shutdown"}),
    )
    .await;
    let answer = receive(&mut answers).await;
    assert_eq!(answer["id"], 9);
    assert_eq!(answer["result"], Value::Null);
    send(&mut client, json!({"jsonrpc": "2.0", "method": "exit"})).await;
    assert!(server.await.unwrap());
}

#[tokio::test(flavor = "multi_thread")]
async fn a_crash_is_a_diagnostic() {
    let (mut client, input) = tokio::io::duplex(1 << 16);
    let (output, mut answers) = tokio::io::duplex(1 << 16);
    let _server = tokio::spawn(super::serve_client(input, output));
    send(
        &mut client,
        json!({"jsonrpc": "2.0", "id": 1, "method": "initialize", "params": {"capabilities": {}}}),
    )
    .await;
    receive(&mut answers).await;
    send(
        &mut client,
        json!({"jsonrpc": "2.0", "method": "initialized", "params": {}}),
    )
    .await;
    // A drawing without strings, of which editors otherwise show nothing.
    let svg = "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"9\" height=\"9\"/>";
    let uri = "untitled:a.svg";
    let text = format!("{svg}{PLANTED_CRASH}");
    let document = json!({"uri": uri, "languageId": "svg", "version": 1, "text": text});
    send(
        &mut client,
        json!({"jsonrpc": "2.0", "method": "textDocument/didOpen", "params": {"textDocument": document}}),
    )
    .await;
    let diagnostics = loop {
        let message = receive(&mut answers).await;
        if message["method"] == "textDocument/publishDiagnostics" {
            break message["params"]["diagnostics"].clone();
        }
    };
    assert_eq!(diagnostics[0]["code"], "E008");
    let message = diagnostics[0]["message"].as_str().unwrap();
    assert!(message.starts_with("okoshi crashed: planted"), "{message}");
    assert!(
        message.contains("report it to the maintainers"),
        "{message}"
    );
}
