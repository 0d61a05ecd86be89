//! Changes that a panel of the client asks for.

use std::sync::Arc;

use base64::Engine;
use serde::Deserialize;
use serde_json::{Value, json};
use tower_lsp::jsonrpc::{Error, Result};
use tower_lsp::ls_types::TextDocumentIdentifier;

use super::backend::Backend;
use super::documents::resolver;
use crate::disk::motions;
use crate::ide::changes::Change;
use crate::protocol::changes;
use crate::protocol::document::Analyzed;

/// A request for what can be changed about a part.
#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct FormParams {
    text_document: TextDocumentIdentifier,
    part: String,
}

/// A change that is wanted, or only tried.
#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct ChangeParams {
    text_document: TextDocumentIdentifier,
    change: Change,
}

impl Backend {
    /// Says what can be changed about a part.
    pub(super) async fn preview_form(&self, params: FormParams) -> Result<Value> {
        let analyzed = self.shown(&params.text_document).await?;
        let files = analyzed.document.folder().map(motions).unwrap_or_default();
        Ok(changes::form(&analyzed, &params.part, files))
    }

    /// The edits of the text that make a change, and the version that they are for.
    pub(super) async fn preview_change(&self, params: ChangeParams) -> Result<Value> {
        let analyzed = self.shown(&params.text_document).await?;
        let found = tokio::task::spawn_blocking(move || {
            let resolver = resolver(&analyzed.document);
            changes::change(&analyzed, &params.change, resolver.as_ref())
        });
        found.await.map_err(|_| Error::internal_error())
    }

    /// A model of what a change would make of the drawing, in Base64; none if the change would be refused, or changes nothing.
    pub(super) async fn preview_try(&self, params: ChangeParams) -> Result<Option<Value>> {
        let analyzed = self.shown(&params.text_document).await?;
        let model = tokio::task::spawn_blocking(move || {
            let resolver = resolver(&analyzed.document);
            let bytes = changes::attempt(&analyzed, &params.change, resolver.as_ref())?;
            Some(base64::engine::general_purpose::STANDARD.encode(bytes))
        });
        let bytes = model.await.map_err(|_| Error::internal_error())?;
        Ok(bytes.map(|bytes| json!({ "bytes": bytes })))
    }

    /// The state of a text that edits are for.
    async fn shown(&self, text: &TextDocumentIdentifier) -> Result<Arc<Analyzed>> {
        let analyzed = self.analyzed(&text.uri).await?;
        let (_, analyzed) =
            analyzed.ok_or_else(|| Error::invalid_params("this drawing is not open"))?;
        Ok(analyzed)
    }
}
