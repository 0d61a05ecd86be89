//! Progress that is shown when reading a drawing takes long.

use std::time::Duration;

use tokio::runtime::Handle;
use tokio::sync::oneshot;
use tower_lsp::Client;
use tower_lsp::ls_types::ProgressToken;

use super::documents::Document;

/// After how long it is shown: before, it would only flicker.
const LONG: Duration = Duration::from_millis(500);

/// Work under way; dropping it ends it.
#[derive(Debug)]
pub(super) struct Progress {
    _ended: oneshot::Sender<()>,
}

/// Says that a text is being read, if that takes long.
pub(super) fn begin(client: &Client, runtime: &Handle, document: &Document) -> Progress {
    let (sender, ended) = oneshot::channel();
    let client = client.clone();
    let token = ProgressToken::String(format!("okoshi/reading/{}", document.generation));
    let name = document.path.as_deref().and_then(|path| path.file_name());
    let name = name.map_or_else(
        || "the drawing".to_owned(),
        |name| name.to_string_lossy().into_owned(),
    );
    runtime.spawn(async move {
        let mut ended = ended;
        if tokio::time::timeout(LONG, &mut ended).await.is_ok() {
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
        let _ = ended.await;
        shown.finish().await;
    });
    Progress { _ended: sender }
}
