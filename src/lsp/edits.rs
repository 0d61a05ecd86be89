//! Requests that change text (rename, code actions, formatting), and commands.

use std::sync::atomic::Ordering;

use tower_lsp::jsonrpc::{Error, ErrorCode, Result};
use tower_lsp::ls_types::*;

use super::backend::{Backend, error};
use super::documents::resolver;
use super::manual;
use super::ordered::{SNAPSHOTS, task_error};
use crate::protocol::capabilities::PREVIEW;
use crate::protocol::{REFUSED, edits};

impl Backend {
    pub(super) async fn on_prepare_rename(
        &self,
        params: TextDocumentPositionParams,
    ) -> Result<Option<PrepareRenameResponse>> {
        let Some((_, analyzed)) = self.analyzed(&params.text_document.uri).await? else {
            return Ok(None);
        };
        let found = edits::prepare_rename(&analyzed, params.position);
        found.map_err(|refused| error(ErrorCode::from(REFUSED), refused))
    }

    pub(super) async fn on_rename(&self, params: RenameParams) -> Result<Option<WorkspaceEdit>> {
        let place = &params.text_document_position;
        let Some((document, analyzed)) = self.analyzed(&place.text_document.uri).await? else {
            return Ok(None);
        };
        let edits = edits::rename(&analyzed, place.position, &params.new_name);
        let edits = edits.map_err(|refused| error(ErrorCode::from(REFUSED), refused))?;
        let can = self.client_capabilities();
        Ok(Some(edits::workspace_edit(&document, edits, &can)))
    }

    pub(super) async fn on_code_action(
        &self,
        params: CodeActionParams,
    ) -> Result<Option<CodeActionResponse>> {
        let Some((document, analyzed)) = self.analyzed(&params.text_document.uri).await? else {
            return Ok(None);
        };
        let links = manual::links(self.client_support.links_at_codes.load(Ordering::Relaxed));
        let can = self.client_capabilities();
        let edit = |edits| edits::workspace_edit(&document, edits, &can);
        Ok(edits::actions(&analyzed, &params, links, &edit))
    }

    pub(super) async fn on_execute_command(
        &self,
        params: ExecuteCommandParams,
    ) -> Result<Option<LSPAny>> {
        if params.command != PREVIEW {
            return Err(Error::invalid_params(format!(
                "there is no command `{}`",
                params.command
            )));
        }
        let uri = match params.arguments.first() {
            Some(argument) => argument.as_str().and_then(|uri| uri.parse().ok()),
            // Some editors send commands without arguments: then the text that changed last is meant.
            None => SNAPSHOTS.with(|snapshots| {
                let documents = snapshots.values().map(|snapshot| &snapshot.document);
                let newest = documents.max_by_key(|document| document.generation);
                newest.map(|document| document.uri.clone())
            }),
        };
        let Some(uri) = uri else {
            return Err(Error::invalid_params(
                "the command needs the address of an open drawing",
            ));
        };
        self.show_page(&uri).await?;
        Ok(None)
    }

    /// The edits that format a text, or a range of it.
    pub(super) async fn formatted(
        &self,
        uri: &Uri,
        range: Option<Range>,
    ) -> Result<Option<Vec<TextEdit>>> {
        let Some(view) = self.current_view(uri).await? else {
            return Ok(None);
        };
        // Formatting compiles the result, which may take long.
        let edits = tokio::task::spawn_blocking(move || {
            let resolver = resolver(&view.document);
            edits::formatted(&view, range, resolver.as_ref())
        });
        edits.await.map_err(task_error)
    }
}
