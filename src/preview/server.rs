//! The HTTP server, on loopback, with limits on everything.

use std::io;
use std::net::{Ipv4Addr, SocketAddr};
use std::sync::Arc;
use std::time::Duration;

use axum::Router;
use axum::body::Bytes;
use axum::extract::{Path, State};
use axum::http::uri::PathAndQuery;
use axum::http::{StatusCode, Uri, header};
use axum::middleware::from_fn_with_state;
use axum::response::{IntoResponse, Response};
use axum::routing::{get, post};
use hyper::server::conn::http1;
use hyper_util::rt::{TokioIo, TokioTimer};
use hyper_util::service::TowerToHyperService;
use tokio::net::{TcpListener, TcpStream};
use tokio::sync::Semaphore;

use super::access::{Hosts, control};
use super::{assets, camera, changes, socket};
use crate::page::{self, Export, Hub, Shot};

/// The port that is tried first, so that an open page finds the server again after a restart.
const PORT: u16 = 4173;
/// The media type of models.
pub(super) const GLB: &str = "model/gltf-binary";
/// The most connections; a page needs a few. Further ones are closed at once.
const MAX_CONNECTIONS: usize = 256;
/// The most pages that may be connected.
pub(super) const MAX_PAGES: usize = 64;
/// The most pages that may record at the same time: each recording is held in memory.
const MAX_RECORDERS: usize = 2;
/// How long the headers of a request may take to arrive.
const HEADER_TIMEOUT: Duration = Duration::from_secs(5);
/// How long a connection other than a WebSocket may stay open.
const CONNECTION_TIMEOUT: Duration = Duration::from_secs(300);
/// How long to wait after the system refused a connection.
const ACCEPT_RETRY_INTERVAL: Duration = Duration::from_millis(50);

/// Where changes are sent to.
const CHANGES: &str = "/changes";
/// Where pages ask what a change would look like.
const TRIES: &str = "/tries";
/// Where pages ask what can be changed.
const FORMS: &str = "/forms";
/// The addresses to which a page may send something other than a question.
pub(super) const POSTED: [&str; 3] = [CHANGES, TRIES, FORMS];

/// A port to serve on.
#[derive(Debug)]
pub(crate) struct Bound {
    listener: std::net::TcpListener,
    address: SocketAddr,
}

impl Bound {
    /// The page's address.
    pub(crate) fn url(&self) -> String {
        format!("http://{}/", self.address)
    }
}

/// Binds a port on loopback: the given one, where 0 stands for any free one, or else the default one or any free one.
///
/// # Errors
/// If the given port is not available.
pub(crate) fn bind(port: Option<u16>) -> io::Result<Bound> {
    let take = |port| std::net::TcpListener::bind((Ipv4Addr::LOCALHOST, port));
    let listener = match port {
        Some(port) => take(port),
        None => take(PORT).or_else(|_| take(0)),
    }?;
    listener.set_nonblocking(true)?;
    let address = listener.local_addr()?;
    Ok(Bound { listener, address })
}

/// Serves pages until the program ends.
///
/// # Errors
/// If the system cannot listen.
pub(crate) async fn serve(bound: Bound, hub: Arc<Hub>) -> io::Result<std::convert::Infallible> {
    let router = router(hub, Hosts::of(bound.address));
    let listener = TcpListener::from_std(bound.listener)?;
    let permits = Arc::new(Semaphore::new(MAX_CONNECTIONS));
    loop {
        let stream = match listener.accept().await {
            Ok((stream, _)) => stream,
            Err(_) => {
                tokio::time::sleep(ACCEPT_RETRY_INTERVAL).await;
                continue;
            }
        };
        // A connection beyond the limit is closed by dropping it.
        let Ok(permit) = permits.clone().try_acquire_owned() else {
            continue;
        };
        let router = router.clone();
        tokio::spawn(async move {
            let _ = tokio::time::timeout(CONNECTION_TIMEOUT, converse(stream, router)).await;
            drop(permit);
        });
    }
}

async fn converse(stream: TcpStream, router: Router) {
    // Small messages are sent at once.
    let _ = stream.set_nodelay(true);
    let service = TowerToHyperService::new(router);
    let connection = http1::Builder::new()
        .timer(TokioTimer::new())
        .header_read_timeout(HEADER_TIMEOUT)
        .serve_connection(TokioIo::new(stream), service)
        .with_upgrades();
    // A client that disconnects is not an error.
    let _ = connection.await;
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
        .layer(from_fn_with_state(hosts, control))
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
