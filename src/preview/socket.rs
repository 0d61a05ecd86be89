//! A page that listens.

use std::sync::Arc;
use std::time::{Duration, Instant};

use axum::extract::State;
use axum::extract::ws::{Message, WebSocket, WebSocketUpgrade};
use axum::http::StatusCode;
use axum::response::{IntoResponse, Response};

use super::hub::{Hub, Picked};
use super::message::FromPage;
use super::server::Shared;

/// The longest message that a page sends, bytes.
const LONGEST: usize = 16 << 10;
/// How long a page may take to read a message.
const PATIENCE: Duration = Duration::from_secs(20);
/// How often a page is asked whether it is still there, and after how long it is not.
const ASK: Duration = Duration::from_secs(15);
const SILENCE: Duration = Duration::from_secs(50);

/// Makes a request a socket.
pub(super) async fn open(State(shared): State<Shared>, upgrade: WebSocketUpgrade) -> Response {
    let Ok(place) = shared.pages.clone().try_acquire_owned() else {
        let message = "too many pages are open; close some of them\n";
        return (StatusCode::SERVICE_UNAVAILABLE, message).into_response();
    };
    let upgrade = upgrade.max_message_size(LONGEST).max_frame_size(LONGEST);
    upgrade.on_upgrade(move |socket| async move {
        converse(socket, &shared.hub).await;
        drop(place);
    })
}

/// Tells a page all news until it goes.
async fn converse(mut socket: WebSocket, hub: &Arc<Hub>) {
    let mut clock = hub.clock();
    let mut since = 0;
    let mut heard = Instant::now();
    loop {
        clock.borrow_and_update();
        let (news, now) = hub.news(since, None);
        since = now;
        for message in news {
            if !send(&mut socket, Message::text(message.as_ref())).await {
                return;
            }
        }
        tokio::select! {
            changed = clock.changed() => {
                if changed.is_err() {
                    return;
                }
            }
            message = socket.recv() => match message {
                Some(Ok(message)) => {
                    heard = Instant::now();
                    hear(&message, hub);
                }
                _ => return,
            },
            () = tokio::time::sleep(ASK) => {
                let silent = heard.elapsed() > SILENCE;
                if silent || !send(&mut socket, Message::Ping(Default::default())).await {
                    return;
                }
            }
        }
    }
}

/// Sends a message; `false` if the page is gone or does not read.
async fn send(socket: &mut WebSocket, message: Message) -> bool {
    let sent = tokio::time::timeout(PATIENCE, socket.send(message)).await;
    matches!(sent, Ok(Ok(())))
}

fn hear(message: &Message, hub: &Hub) {
    let Message::Text(text) = message else { return };
    match serde_json::from_str(text) {
        Ok(FromPage::Pick { drawing, part }) => hub.picked(&drawing, Picked::Part(&part)),
        Ok(FromPage::Open {
            drawing,
            line,
            column,
        }) => hub.picked(&drawing, Picked::Place { line, column }),
        Ok(FromPage::Want {} | FromPage::Other) | Err(_) => {}
    }
}
