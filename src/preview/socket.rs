//! The WebSocket of a page.

use std::sync::Arc;
use std::time::{Duration, Instant};

use axum::extract::State;
use axum::extract::ws::{Message, WebSocket, WebSocketUpgrade};
use axum::http::StatusCode;
use axum::response::{IntoResponse, Response};

use super::hub::{Builds, Hub, Picked};
use super::message::FromPage;
use super::server::Shared;

/// The longest message that a page may send, in bytes.
const MAX_MESSAGE: usize = 16 << 10;
/// How long a page may take to read a message.
const SEND_TIMEOUT: Duration = Duration::from_secs(20);
/// How often a page is pinged.
pub(super) const PING_INTERVAL: Duration = Duration::from_secs(15);
/// After how long without an answer a page counts as gone.
pub(super) const PONG_TIMEOUT: Duration = Duration::from_secs(50);

/// Upgrades a request to a WebSocket.
pub(super) async fn open(State(shared): State<Shared>, upgrade: WebSocketUpgrade) -> Response {
    let Ok(permit) = shared.pages.clone().try_acquire_owned() else {
        let message = "too many pages are open; close some of them\n";
        return (StatusCode::SERVICE_UNAVAILABLE, message).into_response();
    };
    let upgrade = upgrade
        .max_message_size(MAX_MESSAGE)
        .max_frame_size(MAX_MESSAGE);
    upgrade.on_upgrade(move |socket| async move {
        converse(socket, &shared.hub).await;
        drop(permit);
    })
}

/// Sends all updates to a page until it disconnects.
async fn converse(mut socket: WebSocket, hub: &Arc<Hub>) {
    let mut clock = hub.clock();
    let mut since = 0;
    let mut last_message = Instant::now();
    loop {
        clock.borrow_and_update();
        let (updates, now) = hub.updates(since, None, Builds::Changes);
        since = now;
        for message in updates {
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
                    last_message = Instant::now();
                    handle(&message, hub);
                }
                _ => return,
            },
            () = tokio::time::sleep(PING_INTERVAL) => {
                let silent = last_message.elapsed() > PONG_TIMEOUT;
                if silent || !send(&mut socket, Message::Ping(Default::default())).await {
                    return;
                }
            }
        }
    }
}

/// Sends a message; `false` if the page is gone or does not read.
pub(super) async fn send(socket: &mut WebSocket, message: Message) -> bool {
    let sent = tokio::time::timeout(SEND_TIMEOUT, socket.send(message)).await;
    matches!(sent, Ok(Ok(())))
}

fn handle(message: &Message, hub: &Hub) {
    let Message::Text(text) = message else { return };
    match serde_json::from_str(text) {
        Ok(FromPage::Pick { drawing, part }) => hub.picked(&drawing, Picked::Part(&part)),
        Ok(FromPage::Open {
            drawing,
            line,
            column,
        }) => hub.picked(&drawing, Picked::Position { line, column }),
        Ok(FromPage::Want {} | FromPage::Other) | Err(_) => {}
    }
}
