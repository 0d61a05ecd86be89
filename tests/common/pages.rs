//! The server of the live preview, as a page in a browser talks to it.

use std::io::{Read, Write};
use std::net::TcpStream;
use std::path::Path;

use serde_json::Value;
use tungstenite::client::IntoClientRequest;
use tungstenite::stream::MaybeTlsStream;
use tungstenite::{Message, WebSocket, connect};

use super::live::Live;
use super::patience::PATIENCE;

/// A page of a drawing, and its port.
pub(crate) fn served(folder: &Path, target: &str) -> (Live, u16) {
    // On any free port.
    let live = Live::start(folder, &["preview", target]);
    let port = port_of(&live);
    (live, port)
}

/// The port of a server that was started, once it watches.
pub(crate) fn port_of(live: &Live) -> u16 {
    // Drawings are watched, or waited for; or the program is served.
    let [address, _] = live.lines(["http://127.0.0.1:", "press Ctrl-C to stop"]);
    let port = address.rsplit_once("127.0.0.1:").map(|(_, rest)| rest);
    let port = port.and_then(|port| port.trim_end_matches('/').parse().ok());
    port.expect("a port")
}

/// The status and the body of the answer to a raw request.
pub(crate) fn asked(port: u16, request: &str) -> (u16, Vec<u8>) {
    let (status, _, body) = answered(port, request);
    (status, body)
}

/// The status, the head and the body of the answer to a raw request.
pub(crate) fn answered(port: u16, request: &str) -> (u16, String, Vec<u8>) {
    let mut stream = TcpStream::connect(("127.0.0.1", port)).expect("connected");
    stream.set_read_timeout(Some(PATIENCE)).expect("a timeout");
    let request = request
        .replace('\n', "\r\n")
        .replace("PORT", &port.to_string());
    stream.write_all(request.as_bytes()).expect("sent");
    let mut answer = Vec::new();
    let _ = stream.read_to_end(&mut answer);
    let head = answer.windows(4).position(|bytes| bytes == b"\r\n\r\n");
    let body = head.map_or_else(Vec::new, |head| answer[head + 4..].to_vec());
    answer.truncate(head.unwrap_or(answer.len()));
    let text = String::from_utf8_lossy(&answer).into_owned();
    let status = text
        .split(' ')
        .nth(1)
        .and_then(|status| status.parse().ok());
    (status.unwrap_or(0), text, body)
}

pub(crate) fn got(port: u16, path: &str) -> (u16, Vec<u8>) {
    asked(
        port,
        &format!("GET {path} HTTP/1.1\nHost: 127.0.0.1:PORT\nConnection: close\n\n"),
    )
}

pub(crate) type Socket = WebSocket<MaybeTlsStream<TcpStream>>;

/// A page's web socket, with an origin.
pub(crate) fn socket(port: u16, origin: Option<&str>) -> tungstenite::Result<Socket> {
    let mut request = format!("ws://127.0.0.1:{port}/live").into_client_request()?;
    if let Some(origin) = origin {
        let origin = origin.parse().expect("an origin");
        request.headers_mut().insert("origin", origin);
    }
    connect(request).map(|(socket, _)| socket)
}

/// The web socket of a page in a browser.
pub(crate) fn page(port: u16) -> Socket {
    socket(port, Some(&format!("http://127.0.0.1:{port}"))).expect("let in")
}

pub(crate) fn say(socket: &mut Socket, message: &Value) {
    let text = Message::text(message.to_string());
    socket.send(text).expect("sent");
}

/// The next message.
pub(crate) fn next(socket: &mut Socket) -> Value {
    if let MaybeTlsStream::Plain(stream) = socket.get_ref() {
        stream.set_read_timeout(Some(PATIENCE)).expect("a timeout");
    }
    loop {
        if let Message::Text(text) = socket.read().expect("a message") {
            return serde_json::from_str(&text).expect("JSON");
        }
    }
}

/// The next message of a kind.
pub(crate) fn heard(socket: &mut Socket, kind: &str) -> Value {
    loop {
        let message = next(socket);
        if message["type"] == kind {
            return message;
        }
    }
}

/// How many meshes differ, as a page is told.
pub(crate) fn changed_meshes(delta: &[u8]) -> usize {
    assert!(delta.starts_with(b"okdl"), "what changed, and no model");
    let length: [u8; 4] = delta[4..8].try_into().expect("four bytes");
    let text = &delta[8..][..u32::from_le_bytes(length) as usize];
    let text: Value = serde_json::from_slice(text).expect("JSON");
    text["meshes"].as_array().expect("a list").len()
}
