//! Changes that a panel of the client asks for. The client applies their edits to its text, so that its own undo takes them back;
//! nothing is written here.

use std::sync::Arc;

use base64::Engine;
use serde::Deserialize;
use serde_json::{Value, json};
use tower_lsp::jsonrpc::{Error, Result};
use tower_lsp::ls_types::{TextDocumentIdentifier, TextEdit};

use super::backend::Backend;
use super::documents::{Analyzed, Document};
use crate::compile::{Options, compile};
use crate::disk::motions;
use crate::export::{self, GLB};
use crate::ide::Analysis;
use crate::ide::changes::{Change, Possible, Refusal, possible};

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
        let (document, analyzed) = self.shown(&params.text_document).await?;
        let files = document.folder().map(motions).unwrap_or_default();
        Ok(match analyzed.analysis.form(&params.part) {
            Ok(form) => json!({ "form": form.with_motion_files(files) }),
            Err(refusal) => refused(&refusal),
        })
    }

    /// The edits of the text that make a change, and the version that they are for.
    pub(super) async fn preview_change(&self, params: ChangeParams) -> Result<Value> {
        let (document, analyzed) = self.shown(&params.text_document).await?;
        let change = params.change;
        let text = document.clone();
        let found = tokio::task::spawn_blocking(move || wanted(&text, &analyzed, &change));
        Ok(match found.await.map_err(|_| Error::internal_error())? {
            Ok(Possible {
                edits, part, note, ..
            }) => {
                let edits = edits.into_iter().map(|edit| TextEdit {
                    range: document.positions.range(edit.span),
                    new_text: edit.text,
                });
                let edits: Vec<_> = edits.collect();
                json!({ "version": document.version, "edits": edits, "part": part, "note": note })
            }
            Err(refusal) => refused(&refusal),
        })
    }

    /// A model of what a change would make of the drawing, in Base64; none if the change would be refused, or changes nothing.
    pub(super) async fn preview_try(&self, params: ChangeParams) -> Result<Option<Value>> {
        let (document, analyzed) = self.shown(&params.text_document).await?;
        let model = tokio::task::spawn_blocking(move || {
            let after = wanted(&document, &analyzed, &params.change).ok()?.after?;
            let model = export::to_memory(&GLB, &after.compiled().scene, None).ok()?;
            Some(base64::engine::general_purpose::STANDARD.encode(model.bytes))
        });
        let bytes = model.await.map_err(|_| Error::internal_error())?;
        Ok(bytes.map(|bytes| json!({ "bytes": bytes })))
    }

    async fn shown(
        &self,
        text: &TextDocumentIdentifier,
    ) -> Result<(Arc<Document>, Arc<Analyzed>)> {
        let (_, analyzed) = self
            .analyzed(&text.uri)
            .await?
            .ok_or_else(|| Error::invalid_params("this drawing is not open"))?;
        // Edits are for the text that they were found in.
        Ok((analyzed.document.clone(), analyzed))
    }
}

/// What a change makes of a copy of the text.
fn wanted(
    document: &Document,
    before: &Analyzed,
    change: &Change,
) -> std::result::Result<Possible, Refusal> {
    possible(&before.analysis, change, |text| {
        let compiled = compile(text, &Options::default(), document.resolver().as_ref());
        Arc::new(Analysis::new(text, compiled))
    })
}

fn refused(Refusal { why, choices }: &Refusal) -> Value {
    json!({ "refused": { "why": why, "choices": choices } })
}
