//! Requests that change text (rename, code actions, formatting), and commands.

use std::collections::HashMap;
use std::sync::atomic::Ordering;

use tower_lsp::jsonrpc::{Error, ErrorCode, Result};
use tower_lsp::ls_types::*;

use super::backend::{Backend, PREVIEW, View, error};
use super::convert::{self, PositionMap};
use super::documents::Document;
use super::manual;
use super::ordered::{SNAPSHOTS, task_error};
use crate::compile::{Options, compile};
use crate::ide::{self, Analysis};
use crate::source::Span;

impl Backend {
    pub(super) async fn on_prepare_rename(
        &self,
        params: TextDocumentPositionParams,
    ) -> Result<Option<PrepareRenameResponse>> {
        let Some((document, analyzed)) = self.analyzed(&params.text_document.uri).await? else {
            return Ok(None);
        };
        let offset = document.positions.offset(params.position);
        match analyzed.analysis.prepare_rename(offset) {
            Ok((span, placeholder)) => Ok(Some(PrepareRenameResponse::RangeWithPlaceholder {
                range: document.positions.range(span),
                placeholder,
            })),
            Err(ide::RenameError::NoName) => Ok(None),
            Err(refused) => Err(error(REFUSED, refused)),
        }
    }

    pub(super) async fn on_rename(&self, params: RenameParams) -> Result<Option<WorkspaceEdit>> {
        let place = &params.text_document_position;
        let Some((document, analyzed)) = self.analyzed(&place.text_document.uri).await? else {
            return Ok(None);
        };
        let offset = document.positions.offset(place.position);
        let edits = analyzed.analysis.rename(offset, &params.new_name);
        let edits = edits.map_err(|refused| error(REFUSED, refused))?;
        let edits = PositionMap::identity(&document.positions).edits(&edits);
        Ok(Some(
            self.workspace_edit(&document, edits.unwrap_or_default()),
        ))
    }

    pub(super) async fn on_code_action(
        &self,
        params: CodeActionParams,
    ) -> Result<Option<CodeActionResponse>> {
        let Some((document, analyzed)) = self.analyzed(&params.text_document.uri).await? else {
            return Ok(None);
        };
        let map = PositionMap::identity(&document.positions);
        let analysis = &analyzed.analysis;
        let wanted = |kind: &CodeActionKind| {
            let only = params.context.only.as_deref();
            only.is_none_or(|only| {
                only.iter().any(|wanted| {
                    let inner = kind.as_str().strip_prefix(wanted.as_str());
                    inner.is_some_and(|inner| {
                        inner.is_empty() || inner.starts_with('.') || wanted.as_str().is_empty()
                    })
                })
            })
        };
        let links = manual::links(self.client_support.links_at_codes.load(Ordering::Relaxed));
        let actions = analysis
            .actions(document.positions.span(params.range))
            .into_iter();
        let actions = actions.filter_map(|action| {
            let kind = match action.diagnostic {
                Some(_) => CodeActionKind::QUICKFIX,
                None => CodeActionKind::REFACTOR_REWRITE,
            };
            if !wanted(&kind) {
                return None;
            }
            let fixed = action.diagnostic.map(|index| {
                let found = &analysis.diagnostics()[index];
                vec![convert::diagnostic(&analyzed, found, links)]
            });
            let edits = map.edits(&action.edits)?;
            Some(CodeActionOrCommand::CodeAction(CodeAction {
                title: action.title,
                kind: Some(kind),
                diagnostics: fixed,
                edit: Some(self.workspace_edit(&document, edits)),
                is_preferred: action.is_preferred.then_some(true),
                ..CodeAction::default()
            }))
        });
        let actions: Vec<_> = actions.collect();
        Ok((!actions.is_empty()).then_some(actions))
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
            let map = view.map();
            let window = match range {
                Some(range) => map.span(range),
                None => Span::new(0, view.document.text().len()),
            };
            let resolver = view.document.resolver();
            let again = |text: &str| {
                let compiled = compile(text, &Options::default(), resolver.as_ref());
                Analysis::new(text, compiled)
            };
            map.edits(&view.analysis().format(window, &again))
        });
        edits.await.map_err(task_error)
    }

    /// The edits of one text, with its version if the client supports versioned edits.
    fn workspace_edit(&self, document: &Document, edits: Vec<TextEdit>) -> WorkspaceEdit {
        let can = self
            .client_capabilities()
            .workspace
            .and_then(|can| can.workspace_edit);
        let versions = can.and_then(|can| can.document_changes).unwrap_or(false);
        if !versions {
            let changes = HashMap::from([(document.uri.clone(), edits)]);
            return WorkspaceEdit::new(changes);
        }
        WorkspaceEdit {
            document_changes: Some(DocumentChanges::Edits(vec![TextDocumentEdit {
                text_document: OptionalVersionedTextDocumentIdentifier {
                    uri: document.uri.clone(),
                    version: Some(document.version),
                },
                edits: edits.into_iter().map(OneOf::Left).collect(),
            }])),
            ..WorkspaceEdit::default()
        }
    }
}

/// The code of a request that is understood but cannot be met, such as an impossible rename.
const REFUSED: ErrorCode = ErrorCode::ServerError(-32803);

/// What to write for a color that was chosen in place of the one in a range.
pub(super) fn color_presentations(
    view: &View,
    range: Range,
    color: Color,
) -> Vec<ColorPresentation> {
    let map = view.map();
    let rgba = [color.red, color.green, color.blue, color.alpha].map(f64::from);
    let forms = view.analysis().color_edits(map.span(range), rgba);
    let presentations = forms.into_iter().filter_map(|(label, edits)| {
        let mut edits = map.edits(&edits)?.into_iter();
        let first = edits.next()?;
        let others: Vec<_> = edits.collect();
        Some(ColorPresentation {
            label,
            text_edit: Some(first),
            additional_text_edits: (!others.is_empty()).then_some(others),
        })
    });
    presentations.collect()
}
