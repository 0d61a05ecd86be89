//! The language server: the strings of drawings, understood in any editor that speaks the protocol.
//!
//! ```text
//!  stdin ─► Ordered ─► Backend ─► ide          (requests, answered from the state they came in)
//!              │                   ▲
//!              └► Documents ─► Analyst ─► Worker ─► diagnostics     (one thread, the newest state of each text)
//!                                  ▲
//!                        Links ────┘           (linked files that change)
//! ```
//!
//! Only this room names the protocol's types; what is said about drawings comes from [`crate::ide`]. The framework is
//! tower-lsp, in its maintained continuation `tower-lsp-server` under the old name: the original has had no release
//! since 2023 and names an unkept crate of types. What it leaves open, the order of changes and panics of handlers, is
//! closed by the service in `ordered`.

mod alter;
mod analyst;
mod backend;
mod capabilities;
mod convert;
mod documents;
mod links;
mod look;
mod manual;
mod ordered;
mod positions;
mod preview;
mod progress;
#[cfg(test)]
mod tests;
mod worker;
mod workspace;

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use tokio::io::{AsyncRead, AsyncWrite};
use tokio::runtime::Handle;
use tower_lsp::{LspService, Server};

use analyst::Analyst;
use backend::Backend;
use documents::Documents;
use links::Links;
use ordered::Ordered;
use preview::Previews;
use worker::{Abilities, Worker};

/// Serves one client on stdin and stdout until it goes. Says whether the client took its leave as the protocol wants,
/// by `shutdown` and `exit`.
///
/// # Errors
/// If the system gives no threads to serve with.
pub fn serve() -> std::io::Result<bool> {
    let runtime = tokio::runtime::Builder::new_multi_thread()
        .worker_threads(2)
        .enable_all()
        .build()?;
    let left = runtime.block_on(converse(tokio::io::stdin(), tokio::io::stdout()));
    // A read of stdin may still be waiting, and a drawing may still be compiled: nobody waits for them.
    runtime.shutdown_background();
    Ok(left)
}

/// Serves one client; see [`serve`].
async fn converse(input: impl AsyncRead + Unpin, output: impl AsyncWrite) -> bool {
    let (service, socket, left) = service();
    Server::new(input, output, socket).serve(service).await;
    left.load(Ordering::Relaxed)
}

type Parts = (
    Ordered<LspService<Backend>>,
    tower_lsp::ClientSocket,
    Arc<AtomicBool>,
);

/// The service, the way to the client, and whether the client has asked to end.
fn service() -> Parts {
    let documents = Arc::new(Documents::new());
    let analyst = Arc::new(Analyst::new(documents.clone()));
    let left = Arc::new(AtomicBool::new(false));
    let builder = LspService::build(|client| {
        let links = Arc::new(Links::new(analyst.clone()));
        let abilities = Arc::new(Abilities::default());
        let previews = Previews::new(client.clone(), Handle::current(), documents.clone());
        let mut worker = Worker {
            analyst: analyst.clone(),
            documents: documents.clone(),
            client: client.clone(),
            runtime: Handle::current(),
            links: links.clone(),
            abilities: abilities.clone(),
            previews: previews.clone(),
            compilers: std::collections::BTreeMap::new(),
        };
        std::thread::spawn(move || worker.work());
        Backend {
            client,
            documents: documents.clone(),
            analyst: analyst.clone(),
            abilities,
            links,
            workspace: Arc::default(),
            previews,
            client_can: std::sync::Mutex::default(),
            ended: left.clone(),
        }
    });
    let builder = builder
        .custom_method("okoshi/preview/open", Backend::preview_open)
        .custom_method("okoshi/preview/close", Backend::preview_close)
        .custom_method("okoshi/preview/model", Backend::preview_model)
        .custom_method("okoshi/preview/place", Backend::preview_place)
        .custom_method("okoshi/preview/cursor", Backend::preview_cursor);
    #[cfg(test)]
    let builder = tests::plant(builder);
    let (service, socket) = builder.finish();
    (Ordered::new(service, documents, analyst), socket, left)
}

/// Ends the process when its client's process is gone: some leave their pipes open to others when they crash.
#[cfg(unix)]
fn leave_with(client: Option<u32>) {
    use rustix::process::{Pid, test_kill_process};
    let client = client.and_then(|id| Pid::from_raw(i32::try_from(id).ok()?));
    let Some(client) = client else { return };
    std::thread::spawn(move || {
        while test_kill_process(client) != Err(rustix::io::Errno::SRCH) {
            std::thread::sleep(std::time::Duration::from_secs(2));
        }
        std::process::exit(1);
    });
}

/// Elsewhere the end of stdin tells.
#[cfg(not(unix))]
fn leave_with(_client: Option<u32>) {}
