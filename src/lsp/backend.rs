//! The requests of the protocol, each answered by `ide`.

use std::collections::BTreeSet;
use std::fmt::Display;
use std::path::PathBuf;
use std::sync::atomic::Ordering;
use std::sync::{Arc, Mutex, PoisonError};

use tower_lsp::jsonrpc::{Error, ErrorCode, Result};
use tower_lsp::ls_types::*;
use tower_lsp::{Client, LanguageServer};

use super::capabilities::pulls_diagnostics;
use super::documents::{Documents, Snapshot, file_path};
use super::links::Links;
use super::manual;
use super::ordered::{SNAPSHOTS, task_error};
use super::preview::Previews;
use super::scheduler::Scheduler;
use super::worker::ClientSupport;
use super::workspace::Workspace;
use crate::disk::{FolderResolver, names_below};
use crate::ide;
use crate::protocol::capabilities::initialize_result;
use crate::protocol::convert::{self, PositionMap};
use crate::protocol::document::{Analyzed, Document, View};
use crate::protocol::positions::Encoding;
use crate::protocol::{edits, queries};

#[derive(Debug)]
pub(super) struct Backend {
    pub(super) client: Client,
    pub(super) documents: Arc<Documents>,
    pub(super) scheduler: Arc<Scheduler>,
    pub(super) client_support: Arc<ClientSupport>,
    pub(super) links: Arc<Links>,
    pub(super) workspace: Arc<Workspace>,
    pub(super) previews: Arc<Previews>,
    pub(super) client_capabilities: Mutex<ClientCapabilities>,
    pub(super) shut_down: Arc<std::sync::atomic::AtomicBool>,
}

impl Backend {
    /// The analysis of the text in its state when the request came; waits for it.
    ///
    /// # Errors
    /// If the text has changed since: the answer would be about another text.
    pub(super) async fn analyzed(
        &self,
        uri: &Uri,
    ) -> Result<Option<(Arc<Document>, Arc<Analyzed>)>> {
        let snapshot = SNAPSHOTS.with(|snapshots| snapshots.get(uri.as_str()).cloned());
        let Some(Snapshot {
            document,
            mut analyses,
        }) = snapshot
        else {
            return Ok(None);
        };
        self.scheduler.request(uri.as_str());
        let arrived = analyses
            .wait_for(|analyzed| {
                let analyzed = analyzed.as_ref();
                analyzed.is_some_and(|analyzed| analyzed.document.generation >= document.generation)
            })
            .await;
        // The sender is gone when the text was closed.
        let Ok(Some(analyzed)) = arrived.map(|analyzed| analyzed.clone()) else {
            return Ok(None);
        };
        if analyzed.document.generation != document.generation
            && analyzed.document.text() != document.text()
        {
            return Err(error(
                ErrorCode::ContentModified,
                "the text has changed meanwhile",
            ));
        }
        Ok(Some((analyzed.document.clone(), analyzed)))
    }

    /// The text with its analysis, or, if it is not well-formed, the last analysis that was. Nothing for drawings
    /// without strings.
    pub(super) async fn view(&self, uri: &Uri) -> Result<Option<View>> {
        let analyzed = self.analyzed(uri).await?;
        Ok(analyzed.and_then(|(_, analyzed)| View::of(analyzed)))
    }

    /// Answers a request about a position in a text.
    pub(super) async fn at<T>(
        &self,
        place: &TextDocumentPositionParams,
        answer: impl FnOnce(&View, &PositionMap<'_>, usize) -> Option<T>,
    ) -> Result<Option<T>> {
        let Some(view) = self.view(&place.text_document.uri).await? else {
            return Ok(None);
        };
        let map = view.map();
        let offset = map.offset(place.position);
        Ok(offset.and_then(|offset| answer(&view, &map, offset)))
    }

    /// The text with its analysis, if that is of this very text.
    pub(super) async fn current_view(&self, uri: &Uri) -> Result<Option<View>> {
        Ok(self.view(uri).await?.filter(View::is_current))
    }

    pub(super) fn client_capabilities(&self) -> ClientCapabilities {
        let can = self.client_capabilities.lock();
        can.unwrap_or_else(PoisonError::into_inner).clone()
    }

    fn text_capabilities(&self) -> Option<TextDocumentClientCapabilities> {
        self.client_capabilities().text_document
    }
}

impl LanguageServer for Backend {
    async fn initialize(&self, params: InitializeParams) -> Result<InitializeResult> {
        let can = params.capabilities.clone();
        let general = can.general.as_ref();
        let encodings = general.and_then(|general| general.position_encodings.as_deref());
        let encoding = Encoding::negotiated(encodings.unwrap_or_default());
        self.documents.count(encoding);
        self.client_support.record(&can);
        if let Some(options) = &params.initialization_options {
            self.scheduler.configure(options);
            if options.get("preview").and_then(serde_json::Value::as_bool) == Some(true) {
                self.previews.use_panels();
            }
        }
        #[allow(deprecated, reason = "older clients name one folder so")]
        let root = || params.root_uri.iter().filter_map(file_path).collect();
        let folders = params.workspace_folders.as_deref();
        self.workspace
            .change(folders.map_or_else(root, folder_paths), &[]);
        let answer = initialize_result(encoding, true, pulls_diagnostics(&can));
        let known = self.client_capabilities.lock();
        *known.unwrap_or_else(PoisonError::into_inner) = can;
        super::exit_with_client(params.process_id);
        Ok(answer)
    }

    async fn shutdown(&self) -> Result<()> {
        self.shut_down.store(true, Ordering::Relaxed);
        Ok(())
    }

    async fn did_change_workspace_folders(&self, params: DidChangeWorkspaceFoldersParams) {
        let removed = folder_paths(&params.event.removed);
        self.workspace
            .change(folder_paths(&params.event.added), &removed);
    }

    async fn did_change_watched_files(&self, params: DidChangeWatchedFilesParams) {
        let changed: BTreeSet<PathBuf> = params
            .changes
            .iter()
            .filter_map(|change| file_path(&change.uri))
            .collect();
        for uri in self.links.affected(&changed) {
            self.scheduler.link_changed(&uri);
        }
    }

    async fn diagnostic(
        &self,
        params: DocumentDiagnosticParams,
    ) -> Result<DocumentDiagnosticReportResult> {
        let uri = &params.text_document.uri;
        let analyzed = self.analyzed(uri).await?;
        let can = &self.client_support;
        if analyzed.is_some() && can.pulls_diagnostics.load(Ordering::Relaxed) {
            self.scheduler.pulled(uri);
        }
        let document = analyzed.as_ref().map(|(document, _)| document);
        let id = document.map(|document| document.generation.to_string());
        if id.is_some() && id == params.previous_result_id {
            let unchanged = RelatedUnchangedDocumentDiagnosticReport {
                related_documents: None,
                unchanged_document_diagnostic_report: UnchangedDocumentDiagnosticReport {
                    result_id: id.unwrap_or_default(),
                },
            };
            return Ok(DocumentDiagnosticReport::Unchanged(unchanged).into());
        }
        let links = can.links_at_codes.load(Ordering::Relaxed);
        let items = analyzed.map_or_else(Vec::new, |(_, analyzed)| {
            convert::diagnostics(&analyzed, manual::links(links))
        });
        let full = RelatedFullDocumentDiagnosticReport {
            related_documents: None,
            full_document_diagnostic_report: FullDocumentDiagnosticReport {
                result_id: id,
                items,
            },
        };
        Ok(DocumentDiagnosticReport::Full(full).into())
    }

    async fn hover(&self, params: HoverParams) -> Result<Option<Hover>> {
        self.at(&params.text_document_position_params, queries::hover)
            .await
    }

    async fn completion(&self, params: CompletionParams) -> Result<Option<CompletionResponse>> {
        let place = &params.text_document_position;
        let analyzed = self.analyzed(&place.text_document.uri).await?;
        let can = self.text_capabilities().and_then(|can| can.completion);
        let item = can.and_then(|can| can.completion_item);
        let snippets = item.and_then(|can| can.snippet_support) == Some(true);
        Ok(analyzed.and_then(|(document, analyzed)| {
            let files = || document.folder().map(names_below).unwrap_or_default();
            let known = analyzed.known();
            queries::completion(&document, known, place.position, snippets, &files)
        }))
    }

    async fn completion_resolve(&self, mut item: CompletionItem) -> Result<CompletionItem> {
        item.documentation = convert::page(&item);
        Ok(item)
    }

    async fn signature_help(&self, params: SignatureHelpParams) -> Result<Option<SignatureHelp>> {
        let place = &params.text_document_position_params;
        let analyzed = self.analyzed(&place.text_document.uri).await?;
        Ok(analyzed.and_then(|(document, analyzed)| {
            let offset = document.positions.offset(place.position);
            let help = ide::signature(document.text(), &analyzed.known().analysis, offset)?;
            Some(convert::signatures(help))
        }))
    }

    async fn goto_definition(
        &self,
        params: GotoDefinitionParams,
    ) -> Result<Option<GotoDefinitionResponse>> {
        let can = self.text_capabilities().and_then(|can| can.definition);
        let links = can.and_then(|can| can.link_support) == Some(true);
        let place = &params.text_document_position_params;
        self.at(place, |view, map, offset| {
            let file = |name: &str| {
                let path = FolderResolver::new(view.document.folder()?).place(name);
                Uri::from_file_path(path.ok()?)
            };
            queries::definition(view, map, offset, links, &file)
        })
        .await
    }

    async fn references(&self, params: ReferenceParams) -> Result<Option<Vec<Location>>> {
        let with_definition = params.context.include_declaration;
        self.at(&params.text_document_position, |view, map, offset| {
            queries::references(view, map, offset, with_definition)
        })
        .await
    }

    async fn document_highlight(
        &self,
        params: DocumentHighlightParams,
    ) -> Result<Option<Vec<DocumentHighlight>>> {
        self.at(&params.text_document_position_params, queries::highlights)
            .await
    }

    async fn prepare_rename(
        &self,
        params: TextDocumentPositionParams,
    ) -> Result<Option<PrepareRenameResponse>> {
        self.on_prepare_rename(params).await
    }

    async fn rename(&self, params: RenameParams) -> Result<Option<WorkspaceEdit>> {
        self.on_rename(params).await
    }

    async fn document_symbol(
        &self,
        params: DocumentSymbolParams,
    ) -> Result<Option<DocumentSymbolResponse>> {
        let can = self.text_capabilities().and_then(|can| can.document_symbol);
        let nested = can.and_then(|can| can.hierarchical_document_symbol_support);
        let view = self.view(&params.text_document.uri).await?;
        Ok(view.map(|view| queries::symbols(&view, nested == Some(true))))
    }

    async fn symbol(
        &self,
        params: WorkspaceSymbolParams,
    ) -> Result<Option<WorkspaceSymbolResponse>> {
        let open = SNAPSHOTS.with(Clone::clone);
        let workspace = self.workspace.clone();
        let encoding = self.documents.encoding();
        let found =
            tokio::task::spawn_blocking(move || workspace.symbols(&params.query, &open, encoding));
        let found = found.await.map_err(task_error)?;
        Ok(Some(WorkspaceSymbolResponse::Nested(found)))
    }

    async fn folding_range(&self, params: FoldingRangeParams) -> Result<Option<Vec<FoldingRange>>> {
        let view = self.view(&params.text_document.uri).await?;
        Ok(view.as_ref().map(queries::folds))
    }

    async fn selection_range(
        &self,
        params: SelectionRangeParams,
    ) -> Result<Option<Vec<SelectionRange>>> {
        let view = self.view(&params.text_document.uri).await?;
        Ok(view.map(|view| queries::selections(&view, &params.positions)))
    }

    async fn semantic_tokens_full(
        &self,
        params: SemanticTokensParams,
    ) -> Result<Option<SemanticTokensResult>> {
        let view = self.view(&params.text_document.uri).await?;
        Ok(view.map(|view| queries::semantic_tokens(&view, None).into()))
    }

    async fn semantic_tokens_range(
        &self,
        params: SemanticTokensRangeParams,
    ) -> Result<Option<SemanticTokensRangeResult>> {
        let view = self.view(&params.text_document.uri).await?;
        Ok(view.map(|view| queries::semantic_tokens(&view, Some(params.range)).into()))
    }

    async fn inlay_hint(&self, params: InlayHintParams) -> Result<Option<Vec<InlayHint>>> {
        let view = self.view(&params.text_document.uri).await?;
        Ok(view.map(|view| queries::inlays(&view, params.range)))
    }

    async fn document_color(&self, params: DocumentColorParams) -> Result<Vec<ColorInformation>> {
        let view = self.view(&params.text_document.uri).await?;
        Ok(view.as_ref().map(queries::colors).unwrap_or_default())
    }

    async fn color_presentation(
        &self,
        params: ColorPresentationParams,
    ) -> Result<Vec<ColorPresentation>> {
        let view = self.current_view(&params.text_document.uri).await?;
        Ok(view
            .map(|view| edits::color_presentations(&view, params.range, params.color))
            .unwrap_or_default())
    }

    async fn code_action(&self, params: CodeActionParams) -> Result<Option<CodeActionResponse>> {
        self.on_code_action(params).await
    }

    async fn formatting(&self, params: DocumentFormattingParams) -> Result<Option<Vec<TextEdit>>> {
        self.formatted(&params.text_document.uri, None).await
    }

    async fn range_formatting(
        &self,
        params: DocumentRangeFormattingParams,
    ) -> Result<Option<Vec<TextEdit>>> {
        self.formatted(&params.text_document.uri, Some(params.range))
            .await
    }

    async fn code_lens(&self, params: CodeLensParams) -> Result<Option<Vec<CodeLens>>> {
        let view = self.view(&params.text_document.uri).await?;
        Ok(view.as_ref().and_then(queries::preview_lens))
    }

    async fn execute_command(&self, params: ExecuteCommandParams) -> Result<Option<LSPAny>> {
        self.on_execute_command(params).await
    }
}

fn folder_paths(folders: &[WorkspaceFolder]) -> Vec<PathBuf> {
    let paths = folders.iter().map(|folder| file_path(&folder.uri));
    paths.flatten().collect()
}

/// An error of the protocol; editors show its message.
pub(super) fn error(code: ErrorCode, message: impl Display) -> Error {
    Error {
        code,
        message: message.to_string().into(),
        data: None,
    }
}
