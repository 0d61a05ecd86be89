//! The WebSocket of a page that records.

use std::time::{Duration, Instant};

use axum::extract::State;
use axum::extract::ws::{Message, WebSocket, WebSocketUpgrade};
use axum::response::Response;

use super::super::server::Shared;
use super::super::socket::{PING_INTERVAL, PONG_TIMEOUT, send};
use super::frame::{MAX_BYTES, Picture};
use super::message::ToCamera;
use super::session::Session;

/// The shortest time between two frames: what comes faster waits.
const MIN_INTERVAL: Duration = Duration::from_millis(8);

/// Upgrades a request to a WebSocket.
pub(in crate::preview) async fn open(
    State(shared): State<Shared>,
    upgrade: WebSocketUpgrade,
) -> Response {
    let permit = shared.recorders.clone().try_acquire_owned();
    let upgrade = upgrade
        .max_message_size(MAX_BYTES)
        .max_frame_size(MAX_BYTES);
    upgrade.on_upgrade(move |mut socket| async move {
        let Ok(_permit) = permit else {
            // A page learns nothing about a request that is refused, so it is told here.
            let message = "other pages are recording; close their cameras first";
            let refused = [error(message.to_owned(), Kind::Other)];
            say(&mut socket, &refused).await;
            return;
        };
        converse(socket).await;
    })
}

/// Answers a page until it disconnects.
async fn converse(mut socket: WebSocket) {
    let mut session = Session::default();
    let mut last_message = Instant::now();
    let mut last_frame: Option<Instant> = None;
    loop {
        tokio::select! {
            message = socket.recv() => {
                let Some(Ok(message)) = message else { return };
                last_message = Instant::now();
                if matches!(message, Message::Binary(_)) {
                    if let Some(last) = last_frame {
                        tokio::time::sleep(MIN_INTERVAL.saturating_sub(last.elapsed())).await;
                    }
                    last_frame = Some(Instant::now());
                }
                // Tracking is computation: it must not hold up the pages that are served.
                let work = move || {
                    let answers = answers(&mut session, &message);
                    (session, answers)
                };
                let Ok((back, answers)) = tokio::task::spawn_blocking(work).await else {
                    return;
                };
                session = back;
                if !say(&mut socket, &answers).await {
                    return;
                }
            }
            () = tokio::time::sleep(PING_INTERVAL) => {
                let silent = last_message.elapsed() > PONG_TIMEOUT;
                if silent || !send(&mut socket, Message::Ping(Default::default())).await {
                    return;
                }
            }
        }
    }
}

/// Sends messages; `false` if the page is gone or does not read.
async fn say(socket: &mut WebSocket, messages: &[ToCamera]) -> bool {
    for message in messages {
        let text = serde_json::to_string(message).unwrap_or_default();
        if !send(socket, Message::text(text)).await {
            return false;
        }
    }
    true
}

/// What a page is told about its message.
fn answers(session: &mut Session, message: &Message) -> Vec<ToCamera> {
    match message {
        Message::Binary(bytes) => {
            let picture = Picture::read(bytes).map_err(Into::into);
            let answer = picture.and_then(|picture| session.frame(picture));
            vec![answer.unwrap_or_else(|refusal| error(refusal.to_string(), Kind::Frame))]
        }
        Message::Text(text) => match serde_json::from_str(text) {
            Ok(message) => session
                .handle(message)
                .unwrap_or_else(|refusal| vec![error(refusal.to_string(), Kind::Other)]),
            Err(_) => vec![error("this message is unknown".to_owned(), Kind::Other)],
        },
        Message::Ping(_) | Message::Pong(_) | Message::Close(_) => Vec::new(),
    }
}

/// What kind of message is refused.
#[derive(Clone, Copy, PartialEq)]
enum Kind {
    Frame,
    Other,
}

fn error(message: String, kind: Kind) -> ToCamera {
    ToCamera::Error {
        message,
        is_frame: kind == Kind::Frame,
    }
}
