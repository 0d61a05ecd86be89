//! Reads messages one by one before the framework does, so that one that cannot be read does not end the session.
//!
//! The framework stops reading after the first message that it cannot decode. This stage passes on what it can decode, and
//! in the place of everything else a request that [`Ordered`](super::ordered::Ordered) answers with the error.

use std::fmt::Display;
use std::io;

use serde_json::json;
use tokio::io::{
    AsyncBufRead, AsyncBufReadExt as _, AsyncRead, AsyncReadExt as _, AsyncWrite,
    AsyncWriteExt as _, BufReader,
};
use tower_lsp::jsonrpc::{Error, ErrorCode, Request, Response};

use super::backend::error;

/// The method that stands for a message that cannot be read; its parameter is the error.
pub(super) const UNREADABLE: &str = "okoshi/unreadable";

/// The longest message that is read, in bytes; the largest drawings are shorter.
const MAX_MESSAGE: u64 = 512 << 20;

/// The longest header field that is read, in bytes.
const MAX_FIELD: u64 = 1 << 10;

/// Passes on the messages of a client until it disconnects.
///
/// # Errors
/// Those of the streams.
pub async fn pass_on(
    input: impl AsyncRead + Unpin,
    mut output: impl AsyncWrite + Unpin,
) -> io::Result<()> {
    let mut input = BufReader::new(input);
    while let Some(length) = header(&mut input).await? {
        let message = match length {
            Ok(length) if length <= MAX_MESSAGE => {
                // Grows with what arrives, not with what is announced.
                let mut body = Vec::new();
                let read = (&mut input).take(length).read_to_end(&mut body).await?;
                if (read as u64) < length {
                    break;
                }
                readable(body)
            }
            Ok(length) => {
                tokio::io::copy(&mut (&mut input).take(length), &mut tokio::io::sink()).await?;
                Err(invalid(format!(
                    "the message is longer than the limit of {} MiB",
                    MAX_MESSAGE >> 20
                )))
            }
            Err(error) => Err(error),
        };
        let body = match message {
            Ok(Some(body)) => body,
            Ok(None) => continue,
            Err(error) => in_place_of(&error),
        };
        let head = format!("Content-Length: {}\r\n\r\n", body.len());
        output.write_all(head.as_bytes()).await?;
        output.write_all(body.as_bytes()).await?;
        output.flush().await?;
    }
    Ok(())
}

/// Reads the header of a message, and returns the length of its content in bytes; `None` at the end of the input.
async fn header(input: &mut (impl AsyncBufRead + Unpin)) -> io::Result<Option<Result<u64, Error>>> {
    let mut length = None;
    let mut field = Vec::new();
    loop {
        field.clear();
        if (&mut *input)
            .take(MAX_FIELD)
            .read_until(b'\n', &mut field)
            .await?
            == 0
        {
            return Ok(None);
        }
        let text = String::from_utf8_lossy(&field);
        match (text.trim(), length) {
            // Blank lines between messages.
            ("", None) => {}
            ("", Some(length)) => return Ok(Some(Ok(length))),
            (text, _) => match text.split_once(':') {
                Some((name, value)) if name.eq_ignore_ascii_case("Content-Length") => {
                    match value.trim().parse() {
                        Ok(number) => length = Some(number),
                        Err(_) => return Ok(Some(Err(invalid("Content-Length is no number")))),
                    }
                }
                // Other fields, and the rest of what could not be read: the next message is found by its length.
                _ => {}
            },
        }
    }
}

/// The text of a message that the framework can decode; `None` if it is empty.
fn readable(body: Vec<u8>) -> Result<Option<String>, Error> {
    let text = String::from_utf8(body).map_err(|_| parse_error("it is not UTF-8"))?;
    if text.trim().is_empty() {
        return Ok(None);
    }
    let text = without_lone_surrogates(text);
    // The framework would read a list as the fields of a request, in their order.
    if text.trim_start().starts_with('[') {
        return Err(invalid(
            "the protocol has no batches: send the messages one by one",
        ));
    }
    match serde_json::from_str::<Request>(&text) {
        Err(error) if !error.is_data() => Err(parse_error(error)),
        Err(_) if serde_json::from_str::<Response>(&text).is_err() => Err(invalid(
            "it is neither a request nor a notification nor a response",
        )),
        _ => Ok(Some(text)),
    }
}

/// Replaces the halves of characters that JSON can write as `\ud83d`, but text cannot contain. Editors send them when a
/// person edits a text between the two halves.
///
/// The replacement is as long as the half in UTF-16, so that positions stay right.
fn without_lone_surrogates(text: String) -> String {
    let escape = |at: usize| {
        let digits = text.get(at..at + 6)?.strip_prefix("\\u")?;
        u16::from_str_radix(digits, 16).ok()
    };
    let mut lone = Vec::new();
    let mut at = 0;
    while let Some(next) = memchr::memchr(b'\\', &text.as_bytes()[at..]) {
        at += next;
        at += match escape(at) {
            Some(0xD800..=0xDBFF) if matches!(escape(at + 6), Some(0xDC00..=0xDFFF)) => 12,
            Some(0xD800..=0xDFFF) => {
                lone.push(at);
                6
            }
            // The backslash and what it escapes.
            _ => 2,
        };
        if at >= text.len() {
            break;
        }
    }
    if lone.is_empty() {
        return text;
    }
    let mut out = String::with_capacity(text.len());
    let mut done = 0;
    for at in lone {
        out.push_str(&text[done..at]);
        out.push_str("\\ufffd");
        done = at + 6;
    }
    out.push_str(&text[done..]);
    out
}

fn parse_error(why: impl Display) -> Error {
    unread(ErrorCode::ParseError, why)
}

fn invalid(why: impl Display) -> Error {
    unread(ErrorCode::InvalidRequest, why)
}

fn unread(code: ErrorCode, why: impl Display) -> Error {
    error(code, format!("the message cannot be read: {why}"))
}

/// The request that stands for a message that cannot be read.
fn in_place_of(error: &Error) -> String {
    json!({ "jsonrpc": "2.0", "id": null, "method": UNREADABLE, "params": error }).to_string()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn framed(body: &str) -> Vec<u8> {
        format!("Content-Length: {}\r\n\r\n{body}", body.len()).into_bytes()
    }

    /// The bodies of what is passed on.
    fn passed_on(input: &[u8]) -> Vec<serde_json::Value> {
        let mut output = Vec::new();
        futures::executor::block_on(pass_on(input, &mut output)).unwrap();
        let text = String::from_utf8(output).unwrap();
        let mut bodies = Vec::new();
        let mut rest = text.as_str();
        while let Some((head, tail)) = rest.split_once("\r\n\r\n") {
            let length = head.strip_prefix("Content-Length: ").unwrap();
            let (body, next) = tail.split_at(length.parse().unwrap());
            bodies.push(serde_json::from_str(body).unwrap());
            rest = next;
        }
        bodies
    }

    const GOOD: &str = r#"{"jsonrpc":"2.0","id":1,"method":"shutdown"}"#;

    #[test]
    fn what_cannot_be_read_becomes_an_error() {
        let long = format!("Content-Length: {}\r\n\r\n", MAX_MESSAGE + 1);
        let deep = format!(
            r#"{{"jsonrpc":"2.0","method":"a","params":{}"#,
            "[".repeat(100_000)
        );
        for (bad, code) in [
            (framed("{"), -32700),
            (framed("nonsense"), -32700),
            (framed(&deep), -32700),
            (b"Content-Length: 2\r\n\r\n\xff\xff".to_vec(), -32700),
            (framed("{}"), -32600),
            (framed("7"), -32600),
            (framed("null"), -32600),
            (framed(r#"{"jsonrpc":"1.0","method":"a"}"#), -32600),
            (framed(r#"{"jsonrpc":"2.0","method":7}"#), -32600),
            (framed(r#"{"jsonrpc":"2.0","method":"a","id":[]}"#), -32600),
            (framed(&format!("[{GOOD},{GOOD}]")), -32600),
            (framed(r#"["2.0","shutdown",1]"#), -32600),
            (b"Content-Length: many\r\n\r\n".to_vec(), -32600),
            (b"Content-Length: -1\r\n\r\n".to_vec(), -32600),
        ] {
            let input = [bad.clone(), framed(GOOD)].concat();
            let bodies = passed_on(&input);
            let name = String::from_utf8_lossy(&bad[..bad.len().min(60)]).into_owned();
            assert_eq!(bodies.len(), 2, "{name}");
            assert_eq!(bodies[0]["method"], UNREADABLE, "{name}");
            assert_eq!(bodies[0]["params"]["code"], code, "{name}");
            assert_eq!(bodies[1]["method"], "shutdown", "{name}");
        }
        // The end of the input ends a message that is too long, too.
        assert_eq!(passed_on(long.as_bytes())[0]["params"]["code"], -32600);
    }

    #[test]
    fn what_can_be_read_is_passed_on() {
        let response = r#"{"jsonrpc":"2.0","id":1,"result":null}"#;
        let typed = format!(
            "content-length: {}\r\nContent-Type: application/vscode-jsonrpc\r\n\r\n{GOOD}",
            GOOD.len()
        );
        let noise = b"hello\r\n\r\n".to_vec();
        let input = [
            noise,
            framed(GOOD),
            framed(response),
            framed(""),
            typed.into_bytes(),
            b"Content-Length: 50\r\n\r\n{".to_vec(),
        ];
        let bodies = passed_on(&input.concat());
        let methods: Vec<_> = bodies.iter().map(|body| body["method"].as_str()).collect();
        assert_eq!(methods, [Some("shutdown"), None, Some("shutdown")]);
    }

    #[test]
    fn halves_of_characters_are_replaced() {
        for (text, expected) in [
            (r"\ud83d", r"\ufffd"),
            (r"a\udE00b", r"a\ufffdb"),
            (r"\ud83d\ude00", r"\ud83d\ude00"),
            (r"\ud83d\ud83d\ude00\ude00", r"\ufffd\ud83d\ude00\ufffd"),
            (r"\\ud83d", r"\\ud83d"),
            (r"\\\ud83d\n", r"\\\ufffd\n"),
            (r"\u00e9 é \", r"\u00e9 é \"),
            (r"\ud8", r"\ud8"),
        ] {
            assert_eq!(without_lone_surrogates(text.to_owned()), expected);
        }
    }
}
