//! Progress that is shown when analysing a drawing takes long.

use std::time::Duration;

use tokio::runtime::Handle;
use tokio::sync::oneshot;
use tower_lsp::Client;
use tower_lsp::ls_types::ProgressToken;

use crate::protocol::document::Document;

/// Shown only after this time, so that it does not flicker.
const SHOW_AFTER: Duration = Duration::from_millis(500);

/// Progress that is shown until this is dropped.
#[derive(Debug)]
pub(super) struct Progress {
    _finished: oneshot::Sender<()>,
}

/// Shows that a text is being read, if that takes long.
pub(super) fn begin(client: &Client, runtime: &Handle, document: &Document) -> Progress {
    let (sender, finished) = oneshot::channel();
    let client = client.clone();
    let token = ProgressToken::String(format!("okoshi/reading/{}", document.generation));
    let name = document.path.as_deref().and_then(|path| path.file_name());
    let name = name.map_or_else(
        || "the drawing".to_owned(),
        |name| name.to_string_lossy().into_owned(),
    );
    runtime.spawn(async move {
        let mut finished = finished;
        if tokio::time::timeout(SHOW_AFTER, &mut finished)
            .await
            .is_ok()
        {
            return;
        }
        if client
            .create_work_done_progress(token.clone())
            .await
            .is_err()
        {
            return;
        }
        let title = format!("okoshi: reading {name}");
        let shown = client.progress(token, title).begin().await;
        let _ = finished.await;
        shown.finish().await;
    });
    Progress { _finished: sender }
}
