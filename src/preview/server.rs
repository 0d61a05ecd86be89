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
use super::films::Shot;
use super::hub::Hub;
use super::{camera, changes, films, page, socket};

/// The port that is tried first, so that an open page finds the server again after a restart.
const PORT: u16 = 4173;
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
        .route("/films/{file}", get(film))
        .route("/starters/{file}", get(starter));
    for (path, kind, bytes) in page::ASSETS {
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

async fn build(State(shared): State<Shared>, uri: Uri) -> Response {
    let address = uri.path_and_query().map_or("", PathAndQuery::as_str);
    let address = address.trim_start_matches('/').to_owned();
    // Comparing large models takes a while.
    let bytes = tokio::task::spawn_blocking(move || shared.hub.bytes(&address)).await;
    binary(bytes.ok().flatten())
}

async fn originals(State(shared): State<Shared>, Path(file): Path<String>) -> Response {
    let model = number(&file, ".glb").and_then(|number| shared.hub.model(number));
    binary(model.and_then(|model| model.originals.clone()))
}

fn binary(model: Option<Arc<[u8]>>) -> Response {
    served("model/gltf-binary", model)
}

pub(super) fn served(media_type: &'static str, bytes: Option<Arc<[u8]>>) -> Response {
    match bytes.map(Bytes::from_owner) {
        Some(bytes) => ([(header::CONTENT_TYPE, media_type)], bytes).into_response(),
        None => StatusCode::NOT_FOUND.into_response(),
    }
}

async fn picture(State(shared): State<Shared>, Path(file): Path<String>) -> Response {
    let model = number(&file, ".png").and_then(|number| shared.hub.model(number));
    let Some(model) = model else {
        return StatusCode::NOT_FOUND.into_response();
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
    let drawn = tokio::task::spawn_blocking(move || films::gif(&model.bytes, shot)).await;
    match drawn {
        Ok(Ok(bytes)) => served("image/gif", Some(bytes)),
        Ok(Err(why)) => (StatusCode::UNPROCESSABLE_ENTITY, why.to_string()).into_response(),
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
