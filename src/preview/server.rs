//! The server: a few addresses, on loopback, with bounds on everything.

use std::io;
use std::net::{Ipv4Addr, SocketAddr};
use std::sync::Arc;
use std::time::Duration;

use axum::Router;
use axum::body::Bytes;
use axum::extract::{Path, State};
use axum::http::{StatusCode, header};
use axum::middleware::from_fn_with_state;
use axum::response::{IntoResponse, Response};
use axum::routing::get;
use hyper::server::conn::http1;
use hyper_util::rt::{TokioIo, TokioTimer};
use hyper_util::service::TowerToHyperService;
use tokio::net::{TcpListener, TcpStream};
use tokio::sync::Semaphore;

use super::guard::{Names, guard};
use super::hub::Hub;
use super::{page, socket};

/// The port that is tried first, so that an open page finds the next server again.
const PORT: u16 = 4173;
/// How many connections there may be: a page needs a few. Those that are too many are closed at once.
const MOST_CONNECTIONS: usize = 256;
/// How many pages may listen.
pub(super) const MOST_PAGES: usize = 64;
/// How long a request may take to come.
const PATIENCE: Duration = Duration::from_secs(5);
/// How long a connection may be used that is no page's socket.
const LONGEST: Duration = Duration::from_secs(300);
/// How long to wait where the system has no more room for connections.
const PAUSE: Duration = Duration::from_millis(50);

/// A place to serve at.
#[derive(Debug)]
pub struct Bound {
    listener: std::net::TcpListener,
    address: SocketAddr,
}

impl Bound {
    /// The page's address.
    pub fn url(&self) -> String {
        format!("http://{}/", self.address)
    }
}

/// Takes a port on loopback: the one that is asked for, or else the usual one, or any.
///
/// # Errors
/// If the port that is asked for cannot be had.
pub fn bind(port: Option<u16>) -> io::Result<Bound> {
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
pub async fn serve(bound: Bound, hub: Arc<Hub>) -> io::Result<std::convert::Infallible> {
    let router = router(hub, Names::of(bound.address));
    let listener = TcpListener::from_std(bound.listener)?;
    let room = Arc::new(Semaphore::new(MOST_CONNECTIONS));
    loop {
        let stream = match listener.accept().await {
            Ok((stream, _)) => stream,
            Err(_) => {
                tokio::time::sleep(PAUSE).await;
                continue;
            }
        };
        // What is too much is closed, by dropping it.
        let Ok(place) = room.clone().try_acquire_owned() else {
            continue;
        };
        let router = router.clone();
        tokio::spawn(async move {
            let _ = tokio::time::timeout(LONGEST, converse(stream, router)).await;
            drop(place);
        });
    }
}

async fn converse(stream: TcpStream, router: Router) {
    // Small messages must not wait for more.
    let _ = stream.set_nodelay(true);
    let service = TowerToHyperService::new(router);
    let connection = http1::Builder::new()
        .timer(TokioTimer::new())
        .header_read_timeout(PATIENCE)
        .serve_connection(TokioIo::new(stream), service)
        .with_upgrades();
    // A client that goes away is no news.
    let _ = connection.await;
}

#[derive(Clone)]
pub(super) struct Shared {
    pub(super) hub: Arc<Hub>,
    pub(super) pages: Arc<Semaphore>,
}

fn router(hub: Arc<Hub>, names: Names) -> Router {
    let shared = Shared {
        hub,
        pages: Arc::new(Semaphore::new(MOST_PAGES)),
    };
    let mut router = Router::new()
        .route("/live", get(socket::open))
        .route("/builds/{file}", get(build))
        .route("/originals/{file}", get(originals))
        .route("/pictures/{file}", get(picture));
    for (path, kind, bytes) in page::ASSETS {
        router = router.route(
            path,
            get(move || async move { ([(header::CONTENT_TYPE, kind)], bytes) }),
        );
    }
    router
        .fallback(|| async { (StatusCode::NOT_FOUND, "there is nothing here\n") })
        .with_state(shared)
        .layer(from_fn_with_state(names, guard))
}

async fn build(State(shared): State<Shared>, Path(file): Path<String>) -> Response {
    let model = number(&file, ".glb").and_then(|number| shared.hub.model(number));
    binary(model.map(|model| model.bytes.clone()))
}

async fn originals(State(shared): State<Shared>, Path(file): Path<String>) -> Response {
    let model = number(&file, ".glb").and_then(|number| shared.hub.model(number));
    binary(model.and_then(|model| model.originals.clone()))
}

fn binary(model: Option<Bytes>) -> Response {
    match model {
        Some(bytes) => ([(header::CONTENT_TYPE, "model/gltf-binary")], bytes).into_response(),
        None => StatusCode::NOT_FOUND.into_response(),
    }
}

async fn picture(State(shared): State<Shared>, Path(file): Path<String>) -> Response {
    let model = number(&file, ".png").and_then(|number| shared.hub.model(number));
    let Some(model) = model else {
        return StatusCode::NOT_FOUND.into_response();
    };
    let _turn = shared.hub.drawing_pictures.acquire().await;
    let drawn = tokio::task::spawn_blocking(move || model.picture()).await;
    match drawn {
        Ok(Some(png)) => ([(header::CONTENT_TYPE, "image/png")], png).into_response(),
        _ => StatusCode::NOT_FOUND.into_response(),
    }
}

/// `12` of `12.glb`
fn number(file: &str, ending: &str) -> Option<u64> {
    file.strip_suffix(ending)?.parse().ok()
}
