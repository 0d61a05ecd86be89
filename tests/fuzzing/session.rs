//! The language server survives every session: each request is answered, no answer reports a crash, and the diagnostics after
//! a history of changes are those of the same text when it is opened.
//!
//! An input is a drawing followed by steps, each after a zero byte: a change, as in [`changes`], a request, or a message as it
//! is. A request is a kind, two bytes for the place, and a text that some requests take.

use std::sync::mpsc::{Receiver, channel};
use std::sync::{LazyLock, Mutex, PoisonError};

use okoshi::internals::lsp::serve_client;
use serde_json::{Value, json};
use tokio::io::{AsyncReadExt as _, AsyncWriteExt as _, DuplexStream};
use tokio::runtime::Runtime;

use super::patience::PATIENCE;
use super::{changes, files};

/// The most steps of an input.
const MOST: usize = 12;

/// How many bytes wait for either side.
const PIPE: usize = 1 << 16;

const URI: &str = "untitled:a.svg";

/// The requests about a place or a range, by the kind of their step.
const REQUESTS: [(u8, &str); 14] = [
    (b'H', "hover"),
    (b'C', "completion"),
    (b'S', "signatureHelp"),
    (b'D', "definition"),
    (b'R', "references"),
    (b'L', "documentHighlight"),
    (b'P', "prepareRename"),
    (b'N', "rename"),
    (b'T', "semanticTokens/range"),
    (b'I', "inlayHint"),
    (b'A', "codeAction"),
    (b'F', "rangeFormatting"),
    (b'E', "selectionRange"),
    (b'K', "colorPresentation"),
];

/// The requests about a whole text.
const WHOLE: [&str; 6] = [
    "documentSymbol",
    "foldingRange",
    "semanticTokens/full",
    "documentColor",
    "codeLens",
    "formatting",
];

/// The kind of a step that is a message.
const MESSAGE: u8 = b'j';

/// The beginnings of the methods that a message may name: nothing that ends the session or opens a port.
const METHODS: [&str; 5] = [
    "textDocument/",
    "completionItem/",
    "workspace/symbol",
    "workspace/didChangeConfiguration",
    "$/",
];

/// One client for all inputs: a server keeps two threads until the process ends.
static CLIENT: LazyLock<Mutex<Client>> = LazyLock::new(|| Mutex::new(Client::new()));

pub(super) fn check(bytes: &[u8]) -> bool {
    let mut pieces = bytes.split(|byte| *byte == 0);
    let Ok(drawing) = std::str::from_utf8(pieces.next().unwrap_or_default()) else {
        return false;
    };
    let mut client = CLIENT.lock().unwrap_or_else(PoisonError::into_inner);
    let mut text = drawing.to_owned();
    client.open(&text);
    for (step, version) in pieces.take(MOST).zip(2..) {
        match step {
            [MESSAGE, message @ ..] => client.send_raw(message),
            [kind, ..] if REQUESTS.iter().any(|(request, _)| request == kind) => {
                client.ask_at(step, &text);
            }
            _ => {
                let Some((range, inserted)) = changes::replacement(step, &text) else {
                    continue;
                };
                let change =
                    json!({"range": range_of(&text, range.start, range.end), "text": inserted});
                text.replace_range(range, &inserted);
                let document = json!({"uri": URI, "version": version});
                let params = json!({"textDocument": document, "contentChanges": [change]});
                client.notify("textDocument/didChange", params);
            }
        }
    }
    for method in WHOLE {
        client.ask(
            method,
            json!({"textDocument": {"uri": URI}, "options": {"tabSize": 2, "insertSpaces": true}}),
        );
    }
    let after_changes = client.diagnostics();
    client.close();
    client.open(&text);
    let opened = client.diagnostics();
    client.close();
    assert_eq!(after_changes, opened, "{text}");
    true
}

/// A client in this process.
struct Client {
    runtime: Runtime,
    to_server: DuplexStream,
    from_server: Receiver<Value>,
    requests: u64,
}

impl Client {
    fn new() -> Self {
        let runtime = Runtime::new().expect("threads can be started");
        let (to_server, input) = tokio::io::duplex(PIPE);
        let (output, mut answers) = tokio::io::duplex(PIPE);
        let (sender, from_server) = channel();
        runtime.spawn(serve_client(input, output));
        runtime.spawn(async move {
            while let Some(message) = receive(&mut answers).await {
                if sender.send(message).is_err() {
                    return;
                }
            }
        });
        let mut client = Self {
            runtime,
            to_server,
            from_server,
            requests: 0,
        };
        client.request("initialize", json!({"capabilities": {}}));
        client.notify("initialized", json!({}));
        client
    }

    fn send(&mut self, body: &[u8]) {
        let head = format!("Content-Length: {}\r\n\r\n", body.len());
        let sending = async {
            self.to_server.write_all(head.as_bytes()).await?;
            self.to_server.write_all(body).await
        };
        self.runtime.block_on(sending).expect("the server listens");
    }

    fn notify(&mut self, method: &str, params: Value) {
        let message = json!({"jsonrpc": "2.0", "method": method, "params": params});
        self.send(message.to_string().as_bytes());
    }

    /// Sends a request, and returns its result or error.
    fn request(&mut self, method: &str, params: Value) -> Value {
        self.requests += 1;
        let id = format!("fuzzed {}", self.requests);
        let message = json!({"jsonrpc": "2.0", "id": id, "method": method, "params": params});
        self.send(message.to_string().as_bytes());
        loop {
            let answer = self.from_server.recv_timeout(PATIENCE);
            let answer = answer.unwrap_or_else(|error| panic!("{method}: {error}"));
            let told = answer.to_string();
            assert!(!told.contains("okoshi crashed"), "{told}");
            if answer["id"] == id {
                return answer;
            }
        }
    }

    fn ask(&mut self, method: &str, params: Value) -> Value {
        self.request(&format!("textDocument/{method}"), params)
    }

    /// Sends the request of a step.
    fn ask_at(&mut self, step: &[u8], text: &str) {
        let method = REQUESTS.iter().find(|(kind, _)| step.first() == Some(kind));
        let (Some((_, method)), Some((&[_, high, low], argument))) =
            (method, step.split_first_chunk())
        else {
            return;
        };
        let share = usize::from(u16::from_be_bytes([high, low]));
        let place = boundary(text, share * text.len() / usize::from(u16::MAX));
        let end = boundary(text, text.len().min(place + argument.len()));
        let mut params = json!({
            "textDocument": {"uri": URI},
            "position": position(text, place),
            "positions": [position(text, place)],
            "range": range_of(text, place, end),
            "newName": String::from_utf8_lossy(argument),
            "color": {"red": 1, "green": 0.5, "blue": 0, "alpha": 1},
            "options": {"tabSize": 2, "insertSpaces": true},
            "context": {"triggerKind": 1, "isRetrigger": false, "includeDeclaration": true, "diagnostics": []},
        });
        if *method == "completion" {
            params["context"] = json!({"triggerKind": 1});
        }
        self.ask(method, params);
    }

    /// Sends a message, unless its method could end the session, or it could be about a file.
    fn send_raw(&mut self, body: &[u8]) {
        if let Ok(message) = serde_json::from_slice::<Value>(body) {
            let is_allowed = message["method"]
                .as_str()
                .is_none_or(|method| METHODS.iter().any(|start| method.starts_with(start)));
            if !is_allowed || message.to_string().contains("file:") {
                return;
            }
        }
        self.send(body);
    }

    fn open(&mut self, text: &str) {
        let document = json!({"uri": URI, "languageId": "svg", "version": 1, "text": text});
        self.notify("textDocument/didOpen", json!({"textDocument": document}));
    }

    fn close(&mut self) {
        self.notify(
            "textDocument/didClose",
            json!({"textDocument": {"uri": URI}}),
        );
    }

    fn diagnostics(&mut self) -> Value {
        let answer = self.ask("diagnostic", json!({"textDocument": {"uri": URI}}));
        answer["result"]["items"].clone()
    }
}

/// The next message of the server; `None` at the end.
async fn receive(from: &mut DuplexStream) -> Option<Value> {
    let mut head = Vec::new();
    while !head.ends_with(b"\r\n\r\n") {
        head.push(from.read_u8().await.ok()?);
    }
    let head = String::from_utf8(head).ok()?;
    let mut lengths = head
        .lines()
        .filter_map(|line| line.strip_prefix("Content-Length: "));
    let mut body = vec![0; lengths.next()?.parse().ok()?];
    from.read_exact(&mut body).await.ok()?;
    serde_json::from_slice(&body).ok()
}

/// The last place between characters up to a byte.
fn boundary(text: &str, offset: usize) -> usize {
    let mut before = (0..=offset).rev();
    before.find(|at| text.is_char_boundary(*at)).unwrap_or(0)
}

/// The position of a byte, columns in UTF-16.
fn position(text: &str, offset: usize) -> Value {
    let head = &text[..offset];
    // A line ends with CR LF, CR or LF.
    let ends = head
        .char_indices()
        .filter(|(at, c)| *c == '\n' || *c == '\r' && !text[at + 1..].starts_with('\n'));
    let (line, start) = ends.fold((0, 0), |(line, _), (at, _)| (line + 1, at + 1));
    let character = head[start..].encode_utf16().count();
    json!({"line": line, "character": character})
}

fn range_of(text: &str, start: usize, end: usize) -> Value {
    json!({"start": position(text, start), "end": position(text, end)})
}

pub(super) fn seeds() -> Vec<Vec<u8>> {
    let steps: [&[u8]; 4] = [
        b"\0H\x80\x00\0C\x90\x00\0s\x80\x00a\0S\xa0\x00\0N\x90\x00Neu",
        b"\0D\x70\x00\0s\x81\x00$\0R\x80\x00\0L\xc0\x00\0\x02\x90\x00\0P\x90\x00\0C\x90\x00",
        b"\0T\x00\x00aaaaaaaaaaaa\0A\x80\x00aaaa\0a\x80\x00<\0E\x90\x00\0K\x90\x00abc\0F\x00\x00abcdefghi",
        b"\0I\x10\x00aaaaa\0s\x90\x00@Body\0C\x91\x00\0j{\"jsonrpc\":\"2.0\",\"id\":1,\"method\":\"workspace/symbol\",\"params\":{\"query\":\"a\"}}",
    ];
    files::cases_with(&steps)
}
