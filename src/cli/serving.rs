//! What commands have in common that serve a page.

use tokio::runtime::{Builder, Runtime};

use super::Failure;
use crate::preview::{Bound, bind};

/// The port to serve on: the one that was asked for, or else the usual one or any free one.
pub(super) fn bound(asked: Option<u16>, usual: u16) -> Result<Bound, Failure> {
    let bound = bind(asked, usual).map_err(|error| {
        let port = asked.unwrap_or_default();
        format!("port {port} is not available ({error}); choose another with --port, or leave --port out")
    });
    Ok(bound?)
}

/// What the server runs on.
pub(super) fn runtime() -> Result<Runtime, Failure> {
    let runtime = Builder::new_multi_thread()
        .worker_threads(2)
        .enable_all()
        .build();
    Ok(runtime.map_err(|error| format!("the page cannot be served: {error}"))?)
}

/// Opens the page in the browser.
pub(super) fn open(url: &str) {
    if let Err(error) = open::that_detached(url) {
        eprintln!("the browser cannot be opened ({error}); open {url} by hand");
    }
}
