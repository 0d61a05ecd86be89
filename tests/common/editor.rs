//! An editor: a client of the language server over real stdio.

use std::collections::VecDeque;
use std::io::{BufReader, Write as _};
use std::path::Path;
use std::process::{Child, ChildStdin, Command, ExitStatus, Stdio};
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};

use serde_json::{Value, json};

use super::patience::{PATIENCE, wait_until};

/// A server and the conversation with it.
pub(crate) struct Editor {
    server: Child,
    input: Option<ChildStdin>,
    messages: Receiver<Value>,
    /// Messages from the server that were not read yet.
    notes: VecDeque<Value>,
    next: i64,
    /// The server's answer to `initialize`.
    pub(crate) offered: Value,
}

impl Editor {
    /// Starts a server for an editor with the capabilities `can`.
    pub(crate) fn with(can: Value) -> Self {
        Self::initialized(json!({"processId": null, "rootUri": null, "capabilities": can}))
    }

    /// Starts a server and sends `initialize` with these parameters.
    pub(crate) fn initialized(params: Value) -> Self {
        let mut server = Command::new(env!("CARGO_BIN_EXE_okoshi"))
            .arg("lsp")
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()
            .expect("the program starts");
        let input = server.stdin.take();
        let mut output = BufReader::new(server.stdout.take().expect("a pipe"));
        let (sender, messages) = channel();
        std::thread::spawn(move || {
            while let Some(message) = read(&mut output) {
                if sender.send(message).is_err() {
                    return;
                }
            }
        });
        let mut editor = Self {
            server,
            input,
            messages,
            notes: VecDeque::new(),
            next: 0,
            offered: Value::Null,
        };
        editor.offered = editor.ask("initialize", params);
        editor.notify("initialized", json!({}));
        editor
    }

    /// A server for an editor with the capabilities that the tests need.
    pub(crate) fn new() -> Self {
        Self::with(json!({
            "textDocument": {
                "completion": {"completionItem": {"snippetSupport": true}},
                "documentSymbol": {"hierarchicalDocumentSymbolSupport": true},
                "publishDiagnostics": {"relatedInformation": true, "codeDescriptionSupport": true},
            },
        }))
    }

    pub(crate) fn id(&self) -> u32 {
        self.server.id()
    }

    /// Sends a message.
    pub(crate) fn send(&mut self, message: &Value) {
        let body = message.to_string();
        self.send_raw(&format!("Content-Length: {}\r\n\r\n{body}", body.len()));
    }

    /// Sends text that need not be a message.
    pub(crate) fn send_raw(&mut self, text: &str) {
        let input = self.input.as_mut().expect("the conversation is open");
        let written = input.write_all(text.as_bytes());
        written
            .and_then(|()| input.flush())
            .expect("the server listens");
    }

    /// The next answer to a message whose number the server could not read.
    pub(crate) fn answer_to_nothing(&mut self) -> Value {
        loop {
            let message = self.receive("an answer to no request");
            if message.get("error").is_some() && message["id"].is_null() {
                return message;
            }
            self.notes.push_back(message);
        }
    }

    /// Sends a notification.
    pub(crate) fn notify(&mut self, method: &str, params: Value) {
        self.send(&json!({"jsonrpc": "2.0", "method": method, "params": params}));
    }

    /// Sends a request without waiting for its answer.
    pub(crate) fn request(&mut self, method: &str, params: Value) -> i64 {
        self.next += 1;
        let id = self.next;
        let mut message = json!({"jsonrpc": "2.0", "id": id, "method": method});
        if !params.is_null() {
            message["params"] = params;
        }
        self.send(&message);
        id
    }

    /// The whole answer to a request.
    pub(crate) fn answer(&mut self, id: i64) -> Value {
        loop {
            let message = self.receive(&format!("an answer to {id}"));
            if message.get("method").is_none() && message["id"] == id {
                return message;
            }
            self.notes.push_back(message);
        }
    }

    /// Sends a request and returns its result; an error is a failure.
    pub(crate) fn ask(&mut self, method: &str, params: Value) -> Value {
        let id = self.request(method, params);
        let answer = self.answer(id);
        assert!(answer.get("error").is_none(), "{method}: {answer}");
        answer["result"].clone()
    }

    /// Sends an invalid request and returns its error.
    pub(crate) fn refused(&mut self, method: &str, params: Value) -> Value {
        let id = self.request(method, params);
        let answer = self.answer(id);
        assert!(answer.get("error").is_some(), "{method}: {answer}");
        answer["error"].clone()
    }

    /// The next message that `wanted` accepts; others are dropped.
    pub(crate) fn until(&mut self, mut wanted: impl FnMut(&Value) -> bool) -> Value {
        while let Some(note) = self.notes.pop_front() {
            if wanted(&note) {
                return note;
            }
        }
        loop {
            let message = self.receive("a message");
            if wanted(&message) {
                return message;
            }
        }
    }

    /// All diagnostics that the server has sent and still sends before it has done all that it was told: those of a small text that is
    /// opened now are the last, as it analyses one text after the other.
    pub(crate) fn remaining_diagnostics(&mut self) -> Vec<Value> {
        const LAST: &str = "untitled:last.svg";
        self.open(LAST, 1, "<svg/>");
        let mut all = Vec::new();
        self.until(|note| {
            if note["method"] != "textDocument/publishDiagnostics" {
                return false;
            }
            let is_last = note["params"]["uri"] == LAST;
            if !is_last {
                all.push(note.clone());
            }
            is_last
        });
        self.notify(
            "textDocument/didClose",
            json!({"textDocument": {"uri": LAST}}),
        );
        all
    }

    fn receive(&mut self, what: &str) -> Value {
        let message = match self.messages.recv_timeout(PATIENCE) {
            Ok(message) => message,
            Err(RecvTimeoutError::Timeout) => panic!("waited in vain for {what}"),
            Err(RecvTimeoutError::Disconnected) => panic!("the server ended before {what} came"),
        };
        // Requests from the server are accepted.
        if let (Some(id), Some(_)) = (message.get("id"), message.get("method")) {
            let id = id.clone();
            self.send(&json!({"jsonrpc": "2.0", "id": id, "result": null}));
        }
        message
    }

    /// Opens a text.
    pub(crate) fn open(&mut self, uri: &str, version: i64, text: &str) {
        let document = json!({"uri": uri, "languageId": "xml", "version": version, "text": text});
        self.notify("textDocument/didOpen", json!({"textDocument": document}));
    }

    /// Opens a text and gives its diagnostics.
    pub(crate) fn opened(&mut self, uri: &str, text: &str) -> Vec<Value> {
        self.open(uri, 1, text);
        self.diagnostics(uri, 1)
    }

    /// Changes a text by successive edits.
    pub(crate) fn change(&mut self, uri: &str, version: i64, changes: &[Value]) {
        let document = json!({"uri": uri, "version": version});
        let params = json!({"textDocument": document, "contentChanges": changes});
        self.notify("textDocument/didChange", params);
    }

    /// The diagnostics of a state of a text.
    pub(crate) fn diagnostics(&mut self, uri: &str, version: i64) -> Vec<Value> {
        let note = self.until(|note| {
            note["method"] == "textDocument/publishDiagnostics"
                && note["params"]["uri"] == uri
                && note["params"]["version"] == version
        });
        note["params"]["diagnostics"]
            .as_array()
            .expect("a list")
            .clone()
    }

    /// Ends the session with `shutdown` and `exit`.
    pub(crate) fn shut_down(mut self) -> ExitStatus {
        self.ask("shutdown", Value::Null);
        self.notify("exit", Value::Null);
        self.wait()
    }

    /// Closes the connection without `exit`.
    pub(crate) fn disconnect(mut self) -> ExitStatus {
        self.input = None;
        self.wait()
    }

    fn wait(&mut self) -> ExitStatus {
        let mut status = None;
        wait_until("the server to end", || {
            status = self.server.try_wait().expect("a process");
            status.is_some()
        });
        status.expect("it has ended")
    }
}

impl Drop for Editor {
    fn drop(&mut self) {
        let _ = self.server.kill();
        let _ = self.server.wait();
    }
}

fn read(output: &mut impl std::io::BufRead) -> Option<Value> {
    let mut length = None;
    loop {
        let mut line = String::new();
        if output.read_line(&mut line).ok()? == 0 {
            return None;
        }
        match line.trim_end() {
            "" => break,
            line => {
                if let Some(number) = line.strip_prefix("Content-Length: ") {
                    length = number.parse().ok();
                }
            }
        }
    }
    let mut body = vec![0; length?];
    output.read_exact(&mut body).ok()?;
    serde_json::from_slice(&body).ok()
}

/// The address of a file.
pub(crate) fn address(path: &Path) -> String {
    let path = path.to_str().expect("a plain name").replace('\\', "/");
    format!(
        "file://{}{path}",
        if path.starts_with('/') { "" } else { "/" }
    )
}

/// The position of byte `offset`, columns in UTF-16.
pub(crate) fn position(text: &str, offset: usize) -> Value {
    let head = &text[..offset];
    let start = head.rfind('\n').map_or(0, |at| at + 1);
    // CR alone ends a line too; the drawings here have it only before LF.
    let line = head.matches('\n').count();
    let character = head[start..].encode_utf16().count();
    json!({"line": line, "character": character})
}

/// The byte at a position, columns in UTF-16; `None` if the text has no character boundary there.
pub(crate) fn offset(text: &str, position: &Value) -> Option<usize> {
    let line = usize::try_from(position["line"].as_u64()?).ok()?;
    let character = usize::try_from(position["character"].as_u64()?).ok()?;
    let start = match line {
        0 => 0,
        line => text.match_indices('\n').nth(line - 1)?.0 + 1,
    };
    let end = text[start..].find('\n').map_or(text.len(), |at| start + at);
    let mut units = 0;
    for (at, c) in text[start..end].char_indices() {
        if units == character {
            return Some(start + at);
        }
        units += c.len_utf16();
    }
    (units == character).then_some(end)
}

/// A range of bytes.
pub(crate) fn range(text: &str, start: usize, end: usize) -> Value {
    json!({"start": position(text, start), "end": position(text, end)})
}

/// The characters at a range.
pub(crate) fn slice<'a>(text: &'a str, range: &Value) -> &'a str {
    let [start, end] = ["start", "end"].map(|end| offset(text, &range[end]).expect("a place"));
    &text[start..end]
}

/// A text after edits, all in terms of the original.
pub(crate) fn edited(text: &str, edits: &Value) -> String {
    let mut places: Vec<(usize, usize, &str)> = edits
        .as_array()
        .expect("edits")
        .iter()
        .map(|edit| {
            let [start, end] = ["start", "end"]
                .map(|end| offset(text, &edit["range"][end]).expect("a place of the text"));
            (start, end, edit["newText"].as_str().expect("text"))
        })
        .collect();
    places.sort_by_key(|(start, end, _)| (*start, *end));
    let mut out = String::new();
    let mut at = 0;
    for (start, end, new) in places {
        assert!(at <= start, "edits overlap");
        out.push_str(&text[at..start]);
        out.push_str(new);
        at = end;
    }
    out.push_str(&text[at..]);
    out
}
