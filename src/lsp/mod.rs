//! The language server: the strings of drawings, understood in any editor that speaks the protocol.
//!
//! ```text
//!  stdin ─► messages ─► Ordered ─► Backend ─► protocol ─► ide          (requests, answered from the state when they came)
//!                          │                   ▲
//!                          └► Documents ─► Scheduler ─► Worker ─► diagnostics     (one thread, the newest state of each text)
//!                                              ▲
//!                                    Links ────┘           (linked files that change)
//! ```
//!
//! Answers to requests are those of [`crate::protocol`], which come from [`crate::ide`]. The framework is
//! tower-lsp, in its maintained continuation `tower-lsp-server` under the old name: the original has had no release
//! since 2023 and depends on an unmaintained crate of types. What it leaves open, the order of changes and panics of handlers, is
//! handled by the service in `ordered`; messages that it cannot decode, by `messages`.

mod backend;
mod capabilities;
mod changes;
mod documents;
mod edits;
mod links;
mod manual;
mod messages;
mod ordered;
mod preview;
mod progress;
mod scheduler;
#[cfg(test)]
mod tests;
mod worker;
mod workspace;

use std::pin::pin;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use futures::future::{Either, select};
use tokio::io::{AsyncRead, AsyncWrite};
use tokio::runtime::Handle;
use tower_lsp::{LspService, Server};

pub use messages::pass_on;

use backend::Backend;
use documents::Documents;
use links::Links;
use ordered::Ordered;
use preview::Previews;
use scheduler::Scheduler;
use worker::{ClientSupport, Worker};

/// How many bytes of messages wait for the server.
const PIPE: usize = 64 << 10;

/// Serves one client on stdin and stdout until it disconnects. Returns whether the client ended the session as the protocol wants,
/// by `shutdown` and `exit`.
///
/// # Errors
/// If the system gives no threads to serve with.
pub(crate) fn serve() -> std::io::Result<bool> {
    let runtime = tokio::runtime::Builder::new_multi_thread()
        .worker_threads(2)
        .enable_all()
        .build()?;
    let shut_down = runtime.block_on(serve_client(tokio::io::stdin(), tokio::io::stdout()));
    // A read of stdin or a compilation may still be running: do not wait for them.
    runtime.shutdown_background();
    Ok(shut_down)
}

/// Serves one client on any streams until it disconnects, as [`serve`] does on those of the process. Must be called in a
/// multi-threaded runtime of tokio.
///
/// Two threads are started for the client, which stay until the process ends.
pub async fn serve_client(input: impl AsyncRead + Unpin, output: impl AsyncWrite) -> bool {
    let (service, socket, shut_down) = service();
    let (passed_on, to_server) = tokio::io::duplex(PIPE);
    let serving = pin!(Server::new(passed_on, output, socket).serve(service));
    let passing = pin!(messages::pass_on(input, to_server));
    match select(serving, passing).await {
        // The client has sent `exit`, and what it still sends is nobody's.
        Either::Left(_) => {}
        // The client has disconnected; the server answers what was passed on.
        Either::Right((_, serving)) => serving.await,
    }
    shut_down.load(Ordering::Relaxed)
}

type Parts = (
    Ordered<LspService<Backend>>,
    tower_lsp::ClientSocket,
    Arc<AtomicBool>,
);

/// The service, the connection to the client, and whether the client has asked to shut down.
fn service() -> Parts {
    let documents: Arc<Documents> = Arc::default();
    let scheduler = Arc::new(Scheduler::new(documents.clone()));
    let shut_down = Arc::new(AtomicBool::new(false));
    let builder = LspService::build(|client| {
        let links = Arc::new(Links::new(scheduler.clone()));
        let client_support = Arc::new(ClientSupport::default());
        let previews = Previews::new(client.clone(), Handle::current(), documents.clone());
        let mut worker = Worker {
            scheduler: scheduler.clone(),
            documents: documents.clone(),
            client: client.clone(),
            runtime: Handle::current(),
            links: links.clone(),
            client_support: client_support.clone(),
            previews: previews.clone(),
            compilers: std::collections::BTreeMap::new(),
        };
        std::thread::spawn(move || worker.work());
        Backend {
            client,
            documents: documents.clone(),
            scheduler: scheduler.clone(),
            client_support,
            links,
            workspace: Arc::default(),
            previews,
            client_capabilities: std::sync::Mutex::default(),
            shut_down: shut_down.clone(),
        }
    });
    let builder = builder
        .custom_method("okoshi/preview/open", Backend::preview_open)
        .custom_method("okoshi/preview/close", Backend::preview_close)
        .custom_method("okoshi/preview/model", Backend::preview_model)
        .custom_method("okoshi/preview/place", Backend::preview_place)
        .custom_method("okoshi/preview/form", Backend::preview_form)
        .custom_method("okoshi/preview/change", Backend::preview_change)
        .custom_method("okoshi/preview/try", Backend::preview_try)
        .custom_method("okoshi/preview/cursor", Backend::preview_cursor);
    #[cfg(test)]
    let builder = tests::plant(builder);
    let (service, socket) = builder.finish();
    (
        Ordered::new(service, documents, scheduler),
        socket,
        shut_down,
    )
}

/// Ends the process when its client's process is gone: a crashed client may leave the pipes open in another process.
#[cfg(unix)]
fn exit_with_client(client: Option<u32>) {
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

/// On other systems the end of stdin must do.
#[cfg(not(unix))]
fn exit_with_client(_client: Option<u32>) {}
