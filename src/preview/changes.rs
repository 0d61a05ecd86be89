//! Changes of the drawing that a page shows, over HTTP.
//!
//! A page asks by POST with JSON, and names the key of the server that it got in its first messages. Other pages in the same browser do
//! not have that key, and `access` lets none of their requests pass.

use std::path::Path;
use std::sync::Arc;
use std::time::Duration;

use axum::body::{Body, Bytes, to_bytes};
use axum::extract::State;
use axum::http::header::HeaderName;
use axum::http::{HeaderMap, StatusCode, header};
use axum::response::{IntoResponse, Response};
use serde::Serialize;
use serde::de::DeserializeOwned;

use super::server::{GLB, Shared, served};
use crate::ide::Analysis;
use crate::ide::changes::{Action, Change, Done, Refusal, Steps};
use crate::page::{Editing, Editor, Hub, Refused, ToChange, ToShow, ToTry, random_key};
use crate::watch::Editor as FileEditor;

/// The longest request, in bytes.
const MAX_REQUEST: usize = 64 << 10;
/// The longest request that is read to its end, in bytes. A browser that is still sending when the connection closes reports a network
/// error instead of the answer that says why.
const MAX_READ: usize = 4 << 20;
/// How long a request may take to arrive.
const ARRIVAL: Duration = Duration::from_secs(5);
/// The header with the key of the server.
const KEY: HeaderName = HeaderName::from_static("okoshi-key");
/// The header with the address of a model that was only tried.
const MODEL: HeaderName = HeaderName::from_static("okoshi-model");

impl Editor for FileEditor {
    fn act(&self, id: &str, action: &Action, shown: Option<&str>) -> Result<Done, Refusal> {
        Ok(Self::act(self, Path::new(id), action, shown)?)
    }

    fn tried(&self, id: &str, change: &Change, shown: Option<&str>) -> Result<Vec<u8>, Refusal> {
        Ok(Self::tried(self, Path::new(id), change, shown)?)
    }

    fn analysis(&self, id: &str) -> Result<Arc<Analysis>, Refusal> {
        Ok(Self::analysis(self, Path::new(id))?)
    }

    fn steps(&self, id: &str) -> Steps {
        Self::steps(self, Path::new(id))
    }

    fn forget(&self, id: &str) {
        Self::forget(self, Path::new(id));
    }

    fn changes_copy(&self) -> bool {
        Self::changes_copy(self)
    }

    fn motion_files(&self, id: &str) -> Vec<String> {
        Self::motion_files(self, Path::new(id))
    }
}

impl Editing {
    /// Changes are made in files. The ids of drawings are their paths.
    pub(crate) fn of_files(editor: FileEditor) -> Self {
        Self::new(random_key(), editor)
    }
}

/// Makes a change, undoes or redoes one.
pub(super) async fn change(
    State(shared): State<Shared>,
    headers: HeaderMap,
    body: Body,
) -> Response {
    let asked: ToChange = match asked(&shared.hub, &headers, body).await {
        Ok(asked) => asked,
        Err(refused) => return refused,
    };
    answered(move || shared.hub.change_as_asked(asked)).await
}

/// Shows what a change would make of a drawing, while it is being decided: as binary glTF, what differs from the model that the page
/// shows. There is nothing to show of a change that would be refused; why is said once it is made.
pub(super) async fn attempt(
    State(shared): State<Shared>,
    headers: HeaderMap,
    body: Body,
) -> Response {
    let asked: ToTry = match asked(&shared.hub, &headers, body).await {
        Ok(asked) => asked,
        Err(refused) => return refused,
    };
    let tried = tokio::task::spawn_blocking(move || shared.hub.tried_as_asked(&asked));
    match tried.await {
        Ok(Ok((address, bytes))) => ([(MODEL, address)], served(GLB, Some(bytes))).into_response(),
        _ => StatusCode::NO_CONTENT.into_response(),
    }
}

/// Says what can be changed about a part.
pub(super) async fn form(State(shared): State<Shared>, headers: HeaderMap, body: Body) -> Response {
    let asked: ToShow = match asked(&shared.hub, &headers, body).await {
        Ok(asked) => asked,
        Err(refused) => return refused,
    };
    answered(move || shared.hub.form_as_asked(&asked)).await
}

/// The request of a page that has the key.
async fn asked<T: DeserializeOwned>(
    hub: &Hub,
    headers: &HeaderMap,
    body: Body,
) -> Result<T, Response> {
    let Some(editing) = &hub.editing else {
        return Err(said(
            StatusCode::METHOD_NOT_ALLOWED,
            "this page is read-only",
        ));
    };
    let has = |name: HeaderName, value: &str| {
        let mut all = headers.get_all(name).iter();
        let first = all.next().and_then(|one| one.to_str().ok());
        all.next().is_none() && first == Some(value)
    };
    if !has(KEY, &editing.key) {
        return Err(said(
            StatusCode::FORBIDDEN,
            "the program was started anew: reload the page",
        ));
    }
    if !has(header::CONTENT_TYPE, "application/json") {
        return Err(said(
            StatusCode::UNSUPPORTED_MEDIA_TYPE,
            "a change is sent as JSON",
        ));
    }
    let too_long = || {
        said(
            StatusCode::PAYLOAD_TOO_LARGE,
            "that is too much for one change",
        )
    };
    let length = headers.get(header::CONTENT_LENGTH);
    let length = length.and_then(|length| length.to_str().ok()?.parse::<u64>().ok());
    if length.is_some_and(|length| length > MAX_READ as u64) {
        return Err(too_long());
    }
    let arrived: Bytes = match tokio::time::timeout(ARRIVAL, to_bytes(body, MAX_READ)).await {
        Ok(Ok(bytes)) if bytes.len() <= MAX_REQUEST => bytes,
        Ok(_) => return Err(too_long()),
        Err(_) => {
            return Err(said(
                StatusCode::REQUEST_TIMEOUT,
                "the change did not arrive",
            ));
        }
    };
    serde_json::from_slice(&arrived).map_err(|error| {
        said(
            StatusCode::BAD_REQUEST,
            format!("the change cannot be read: {error}"),
        )
    })
}

/// The answer of something that reads and writes files.
async fn answered<T: Serialize + Send + 'static>(
    work: impl FnOnce() -> Result<T, Refusal> + Send + 'static,
) -> Response {
    match tokio::task::spawn_blocking(work).await {
        Ok(Ok(answer)) => json(StatusCode::OK, &answer),
        Ok(Err(refusal)) => json(StatusCode::CONFLICT, &Refused::from(refusal)),
        Err(_) => said(
            StatusCode::INTERNAL_SERVER_ERROR,
            "the program failed at this change; the drawing is as it was",
        ),
    }
}

fn said(status: StatusCode, why: impl Into<String>) -> Response {
    json(status, &Refused::from(Refusal::without_choice(why)))
}

fn json(status: StatusCode, answer: &impl Serialize) -> Response {
    // Answers hold only text and numbers, so this cannot fail.
    let text = serde_json::to_string(answer).unwrap_or_default();
    let kind = [(header::CONTENT_TYPE, "application/json")];
    (status, kind, text).into_response()
}
