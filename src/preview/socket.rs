//! The WebSocket of a page.

use std::sync::Arc;
use std::time::{Duration, Instant};

use axum::extract::State;
use axum::extract::ws::{Message, WebSocket, WebSocketUpgrade};
use axum::http::{HeaderMap, StatusCode, header};
use axum::response::{IntoResponse, Response};

use super::server::Shared;
use crate::page::{Builds, FromPage, Hub, Picked, ToPage, json};

/// The longest message that a page may send, in bytes.
const MAX_MESSAGE: usize = 16 << 10;
/// How long a page may take to read a message.
const SEND_TIMEOUT: Duration = Duration::from_secs(20);
/// How often a page is pinged.
pub(super) const PING_INTERVAL: Duration = Duration::from_secs(15);
/// After how long without an answer a page counts as gone.
pub(super) const PONG_TIMEOUT: Duration = Duration::from_secs(50);

/// Upgrades a request to a WebSocket.
pub(super) async fn open(
    State(shared): State<Shared>,
    headers: HeaderMap,
    upgrade: WebSocketUpgrade,
) -> Response {
    let Ok(permit) = shared.pages.clone().try_acquire_owned() else {
        let message = "too many pages are open; close some of them\n";
        return (StatusCode::SERVICE_UNAVAILABLE, message).into_response();
    };
    let upgrade = upgrade
        .max_message_size(MAX_MESSAGE)
        .max_frame_size(MAX_MESSAGE);
    // Browsers always send it with such requests, and `access` let no other than the page's own pass.
    let is_page = headers.contains_key(header::ORIGIN);
    upgrade.on_upgrade(move |socket| async move {
        converse(socket, &shared.hub, is_page).await;
        drop(permit);
    })
}

/// Sends all updates to a page until it disconnects. Only a page in a browser can have something written.
async fn converse(mut socket: WebSocket, hub: &Arc<Hub>, is_page: bool) {
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
                    if let Some(begin) = handle(&message, hub)
                        && let Err(why) = begun(begin, hub, is_page).await
                    {
                        let answer = json(&ToPage::NotBegun { why: &why });
                        if !send(&mut socket, Message::text(answer.as_ref())).await {
                            return;
                        }
                    }
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

/// A wish to begin a drawing: the key of the server, and which one.
struct Begin {
    key: String,
    starter: String,
}

/// Handles a message at once, unless that takes longer.
fn handle(message: &Message, hub: &Hub) -> Option<Begin> {
    let Message::Text(text) = message else {
        return None;
    };
    match serde_json::from_str(text) {
        Ok(FromPage::Begin { key, starter }) => return Some(Begin { key, starter }),
        Ok(FromPage::Pick { drawing, part }) => hub.picked(&drawing, Picked::Part(&part)),
        Ok(FromPage::Open {
            drawing,
            line,
            column,
        }) => hub.picked(&drawing, Picked::Position { line, column }),
        Ok(FromPage::Want {} | FromPage::Other) | Err(_) => {}
    }
    None
}

/// Writes a drawing to start from; an error says why not.
async fn begun(begin: Begin, hub: &Arc<Hub>, is_page: bool) -> Result<(), String> {
    if !is_page {
        return Err("only the page in a browser may begin drawings".to_owned());
    }
    let hub = hub.clone();
    let written = tokio::task::spawn_blocking(move || hub.begin(&begin.key, &begin.starter));
    let crashed = |_| Err("the drawing was not written".to_owned());
    written.await.unwrap_or_else(crashed)
}
