//! A server on loopback, with limits on everything.

use std::convert::Infallible;
use std::io;
use std::net::{Ipv4Addr, SocketAddr};
use std::sync::Arc;
use std::time::Duration;

use axum::Router;
use hyper::server::conn::http1;
use hyper_util::rt::{TokioIo, TokioTimer};
use hyper_util::service::TowerToHyperService;
use tokio::net::{TcpListener, TcpStream};
use tokio::sync::Semaphore;

use super::access::Hosts;

/// The most connections; a page needs a few. Further ones are closed at once.
const MAX_CONNECTIONS: usize = 256;
/// How long the headers of a request may take to arrive.
const HEADER_TIMEOUT: Duration = Duration::from_secs(5);
/// How long a connection other than a WebSocket may stay open.
const CONNECTION_TIMEOUT: Duration = Duration::from_secs(300);
/// How long to wait after the system refused a connection.
const ACCEPT_RETRY_INTERVAL: Duration = Duration::from_millis(50);

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

    /// The number of the port.
    pub(crate) fn port(&self) -> u16 {
        self.address.port()
    }
}

/// Binds a port on loopback: the given one, where 0 stands for any free one, or else the usual one or any free one.
///
/// # Errors
/// If the given port is not available.
pub(crate) fn bind(port: Option<u16>, usual: u16) -> io::Result<Bound> {
    let take = |port| std::net::TcpListener::bind((Ipv4Addr::LOCALHOST, port));
    let listener = match port {
        Some(port) => take(port),
        None => take(usual).or_else(|_| take(0)),
    }?;
    listener.set_nonblocking(true)?;
    let address = listener.local_addr()?;
    Ok(Bound { listener, address })
}

/// Serves what the router has until the program ends.
///
/// # Errors
/// If the system cannot listen.
pub(super) async fn serve(
    bound: Bound,
    router: impl FnOnce(Hosts) -> Router,
) -> io::Result<Infallible> {
    let router = router(Hosts::of(bound.address));
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
