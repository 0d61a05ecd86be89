//! What the server of the live page answers.

use std::convert::Infallible;
use std::io;
use std::sync::Arc;

use axum::Router;
use axum::body::Bytes;
use axum::extract::{Path, State};
use axum::http::uri::PathAndQuery;
use axum::http::{StatusCode, Uri, header};
use axum::middleware::from_fn_with_state;
use axum::response::{IntoResponse, Response};
use axum::routing::{get, post};
use tokio::sync::Semaphore;

use super::access::{Access, Hosts, control};
use super::loopback::{self, Bound};
use super::{assets, camera, changes, socket};
use crate::page::{self, Export, Hub, Shot};

/// The port that is tried first, so that an open page finds the server again after a restart.
pub(crate) const PORT: u16 = 4173;
/// The media type of models.
pub(super) const GLB: &str = "model/gltf-binary";
/// The most pages that may be connected.
pub(super) const MAX_PAGES: usize = 64;
/// The most pages that may record at the same time: each recording is held in memory.
const MAX_RECORDERS: usize = 2;

/// Where changes are sent to.
const CHANGES: &str = "/changes";
/// Where pages ask what a change would look like.
const TRIES: &str = "/tries";
/// Where pages ask what can be changed.
const FORMS: &str = "/forms";
/// The rules of the live page.
const ACCESS: Access = Access {
    posted: &[CHANGES, TRIES, FORMS],
    policy: Some(
        "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' blob: data:; \
         connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'",
    ),
    caching: "no-store",
};

/// Serves the live page until the program ends.
///
/// # Errors
/// If the system cannot listen.
pub(crate) async fn serve(bound: Bound, hub: Arc<Hub>) -> io::Result<Infallible> {
    loopback::serve(bound, |hosts| router(hub, hosts)).await
}

#[derive(Clone)]
pub(super) struct Shared {
    pub(super) hub: Arc<Hub>,
    pub(super) pages: Arc<Semaphore>,
    pub(super) recorders: Arc<Semaphore>,
}

fn router(hub: Arc<Hub>, hosts: Hosts) -> Router {
    let shared = Shared {
        hub,
        pages: Arc::new(Semaphore::new(MAX_PAGES)),
        recorders: Arc::new(Semaphore::new(MAX_RECORDERS)),
    };
    let mut router = Router::new()
        .route("/live", get(socket::open))
        .route("/camera", get(camera::open))
        .route(CHANGES, post(changes::change))
        .route(TRIES, post(changes::attempt))
        .route(FORMS, post(changes::form))
        .route("/builds/{file}", get(build))
        .route("/originals/{file}", get(originals))
        .route("/pictures/{file}", get(picture))
        .route("/papers/{file}", get(paper))
        .route("/films/{file}", get(film))
        .route("/exports/{file}", get(export))
        .route("/starters/{file}", get(starter));
    for (path, kind, bytes) in assets::ASSETS {
        router = router.route(
            path,
            get(move || async move { ([(header::CONTENT_TYPE, kind)], bytes) }),
        );
    }
    router
        .fallback(|| async { (StatusCode::NOT_FOUND, "not found\n") })
        .with_state(shared)
        .layer(from_fn_with_state((hosts, ACCESS), control))
}

async fn build(State(shared): State<Shared>, Path(file): Path<String>, uri: Uri) -> Response {
    let address = uri.path_and_query().map_or("", PathAndQuery::as_str);
    let address = address.trim_start_matches('/').to_owned();
    match bytes(&shared, address).await {
        Some(bytes) => served(GLB, Some(bytes)),
        None => without_model(&shared, number(&file, ".glb")),
    }
}

async fn originals(State(shared): State<Shared>, Path(file): Path<String>) -> Response {
    let number = number(&file, ".glb");
    match number.and_then(|number| shared.hub.model(number)) {
        Some(model) => served(GLB, model.originals.clone()),
        None => without_model(&shared, number),
    }
}

/// What an address stands for. Comparing large models and writing large pages takes a while.
async fn bytes(shared: &Shared, address: String) -> Option<Arc<[u8]>> {
    let hub = shared.hub.clone();
    let bytes = tokio::task::spawn_blocking(move || hub.bytes(&address)).await;
    bytes.ok().flatten()
}

/// The page of a drawing. One that a newer build replaced was asked for before the page read of that.
async fn paper(State(shared): State<Shared>, Path(file): Path<String>) -> Response {
    match bytes(&shared, format!("papers/{file}")).await {
        Some(bytes) => served("application/json", Some(bytes)),
        None if number(&file, ".json").is_some() => StatusCode::NO_CONTENT.into_response(),
        None => StatusCode::NOT_FOUND.into_response(),
    }
}

/// The answer to whoever asks for something of a model that is not there. One that newer models replaced was asked for before the page
/// read of those: that is no mistake, which browsers would report.
fn without_model(shared: &Shared, number: Option<u64>) -> Response {
    if number.is_some_and(|number| shared.hub.is_replaced(number)) {
        StatusCode::NO_CONTENT.into_response()
    } else {
        StatusCode::NOT_FOUND.into_response()
    }
}

pub(super) fn served(media_type: &'static str, bytes: Option<Arc<[u8]>>) -> Response {
    match bytes.map(Bytes::from_owner) {
        Some(bytes) => ([(header::CONTENT_TYPE, media_type)], bytes).into_response(),
        None => StatusCode::NOT_FOUND.into_response(),
    }
}

async fn picture(State(shared): State<Shared>, Path(file): Path<String>) -> Response {
    let number = number(&file, ".png");
    let Some(model) = number.and_then(|number| shared.hub.model(number)) else {
        return without_model(&shared, number);
    };
    let _permit = shared.hub.drawing_pictures.acquire().await;
    let drawn = tokio::task::spawn_blocking(move || model.picture()).await;
    served("image/png", drawn.ok().flatten())
}

/// A moving picture of a model: of a clip with `?clip=` and its number, and from the direction `view=` yaw and pitch in degrees.
async fn film(State(shared): State<Shared>, Path(file): Path<String>, uri: Uri) -> Response {
    let model = number(&file, ".gif").and_then(|number| shared.hub.model(number));
    let (Some(model), Some(shot)) = (model, shot(uri.query().unwrap_or_default())) else {
        return StatusCode::NOT_FOUND.into_response();
    };
    let _permit = shared.hub.drawing_films.acquire().await;
    let drawn = tokio::task::spawn_blocking(move || page::gif(&model.bytes, shot)).await;
    match drawn {
        Ok(Ok(bytes)) => served("image/gif", Some(bytes)),
        Ok(Err(why)) => (StatusCode::UNPROCESSABLE_ENTITY, why.to_string()).into_response(),
        Err(_) => StatusCode::INTERNAL_SERVER_ERROR.into_response(),
    }
}

/// Another file of the drawing of a model: the model as OBJ, or the sheet of a puppet as SVG. It is for saving, not for looking at: a
/// sheet has pieces of the drawing in it, which anybody may have drawn.
async fn export(State(shared): State<Shared>, Path(file): Path<String>) -> Response {
    let asked = file
        .split_once('.')
        .and_then(|(number, ending)| Some((number.parse().ok()?, Export::by_ending(ending)?)));
    let Some((number, export)) = asked else {
        return StatusCode::NOT_FOUND.into_response();
    };
    let _permit = shared.hub.drawing_films.acquire().await;
    let hub = shared.hub.clone();
    match tokio::task::spawn_blocking(move || hub.exported(number, export)).await {
        Ok(Some(Ok(bytes))) => {
            let saved = [(header::CONTENT_DISPOSITION, "attachment")];
            (
                saved,
                served("application/octet-stream", Some(bytes.into())),
            )
                .into_response()
        }
        Ok(Some(Err(why))) => (StatusCode::UNPROCESSABLE_ENTITY, why).into_response(),
        Ok(None) => StatusCode::NOT_FOUND.into_response(),
        Err(_) => StatusCode::INTERNAL_SERVER_ERROR.into_response(),
    }
}

/// What a query asks for; `None` if it asks for anything else.
fn shot(query: &str) -> Option<Shot> {
    let (mut clip, mut view) = (None, None);
    for (name, value) in query.split('&').filter_map(|pair| pair.split_once('=')) {
        match name {
            "clip" => clip = Some(value.parse().ok()?),
            "view" => {
                let (yaw, pitch) = value.split_once(',')?;
                let angle = |text: &str| text.parse().ok().filter(|angle: &f64| angle.is_finite());
                view = Some([angle(yaw)?, angle(pitch)?]);
            }
            _ => return None,
        }
    }
    Some(Shot { clip, view: view? })
}

async fn starter(State(shared): State<Shared>, Path(file): Path<String>) -> Response {
    let hub = shared.hub.clone();
    let _permit = shared.hub.drawing_pictures.acquire().await;
    let drawn = tokio::task::spawn_blocking(move || {
        let name = file.strip_suffix(".png")?;
        hub.starters.as_ref()?.picture(name)
    });
    served("image/png", drawn.await.ok().flatten())
}

/// `12` of `12.glb`
fn number(file: &str, ending: &str) -> Option<u64> {
    file.strip_suffix(ending)?.parse().ok()
}
