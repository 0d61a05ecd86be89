//! The requests of the protocol, each answered by `ide`.

use std::collections::BTreeSet;
use std::path::PathBuf;
use std::sync::atomic::Ordering;
use std::sync::{Arc, Mutex};

use tower_lsp::jsonrpc::{Error, ErrorCode, Result};
use tower_lsp::ls_types::*;
use tower_lsp::{Client, LanguageServer};

use super::convert::{self, PositionMap};
use super::documents::{Analyzed, Document, Documents, Snapshot, file_path};
use super::links::Links;
use super::ordered::SNAPSHOTS;
use super::positions::Encoding;
use super::preview::Previews;
use super::scheduler::Scheduler;
use super::worker::ClientSupport;
use super::workspace::Workspace;
use super::{capabilities, manual};
use crate::ide::Analysis;

/// The command behind the code lens.
pub(super) const PREVIEW: &str = "okoshi.preview";

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

/// A text and its analysis, which may be one of an earlier state.
pub(super) struct View {
    pub(super) document: Arc<Document>,
    pub(super) analyzed: Arc<Analyzed>,
}

impl View {
    pub(super) fn analysis(&self) -> &Analysis {
        &self.analyzed.analysis
    }

    pub(super) fn map(&self) -> PositionMap<'_> {
        if Arc::ptr_eq(&self.document, &self.analyzed.document) {
            PositionMap::identity(&self.document.positions)
        } else {
            PositionMap::after_edit(&self.document.positions, self.analyzed.document.text())
        }
    }

    /// Whether the analysis is of this very text, so that it can be edited.
    pub(super) fn is_current(&self) -> bool {
        Arc::ptr_eq(&self.document, &self.analyzed.document) && self.analysis().is_sound()
    }
}

impl Backend {
    /// A text in its state when the request came.
    pub(super) fn snapshot(&self, uri: &Uri) -> Option<Snapshot> {
        SNAPSHOTS.with(|snapshots| snapshots.get(uri.as_str()).cloned())
    }

    /// The analysis of the text in its state when the request came; waits for it.
    ///
    /// # Errors
    /// If the text has changed since: the answer would be about another text.
    pub(super) async fn analyzed(
        &self,
        uri: &Uri,
    ) -> Result<Option<(Arc<Document>, Arc<Analyzed>)>> {
        let Some(snapshot) = self.snapshot(uri) else {
            return Ok(None);
        };
        let Snapshot {
            document,
            mut analyses,
        } = snapshot;
        self.scheduler.request(uri.as_str());
        let arrived = analyses
            .wait_for(|analyzed| {
                let generation = analyzed
                    .as_ref()
                    .map(|analyzed| analyzed.document.generation);
                generation >= Some(document.generation)
            })
            .await;
        // The sender is gone when the text was closed.
        let Ok(Some(analyzed)) = arrived.map(|analyzed| analyzed.clone()) else {
            return Ok(None);
        };
        if analyzed.document.generation != document.generation
            && analyzed.document.text() != document.text()
        {
            return Err(Error {
                code: ErrorCode::ServerError(-32801),
                message: "the text has changed meanwhile".into(),
                data: None,
            });
        }
        Ok(Some((analyzed.document.clone(), analyzed)))
    }

    /// The text with its analysis, or, if it is not well-formed, the last analysis that was. Nothing for drawings
    /// without strings.
    pub(super) async fn view(&self, uri: &Uri) -> Result<Option<View>> {
        let Some((document, analyzed)) = self.analyzed(uri).await? else {
            return Ok(None);
        };
        let analyzed = match &analyzed.last_sound {
            Some(last_sound) => last_sound.clone(),
            None => analyzed,
        };
        let view = View { document, analyzed };
        Ok(Some(view).filter(|view| view.analysis().is_annotated()))
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

    pub(super) fn client_capabilities(&self) -> ClientCapabilities {
        let can = self.client_capabilities.lock();
        can.unwrap_or_else(|poisoned| poisoned.into_inner()).clone()
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
        let root = params
            .root_uri
            .iter()
            .filter_map(file_path)
            .collect::<Vec<_>>();
        let folders: Vec<PathBuf> = match &params.workspace_folders {
            Some(folders) => folders
                .iter()
                .filter_map(|folder| file_path(&folder.uri))
                .collect(),
            None => root,
        };
        self.workspace.change(folders, &[]);
        let answer = capabilities::initialize_result(&can, encoding);
        *self
            .client_capabilities
            .lock()
            .unwrap_or_else(|poisoned| poisoned.into_inner()) = can;
        super::exit_with_client(params.process_id);
        Ok(answer)
    }

    async fn shutdown(&self) -> Result<()> {
        self.shut_down.store(true, Ordering::Relaxed);
        Ok(())
    }

    async fn did_change_workspace_folders(&self, params: DidChangeWorkspaceFoldersParams) {
        let paths = |folders: &[WorkspaceFolder]| -> Vec<PathBuf> {
            folders
                .iter()
                .filter_map(|folder| file_path(&folder.uri))
                .collect()
        };
        let removed = paths(&params.event.removed);
        self.workspace.change(paths(&params.event.added), &removed);
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
        if analyzed.is_some()
            && self
                .client_support
                .pulls_diagnostics
                .load(Ordering::Relaxed)
        {
            self.scheduler.pulled(uri);
        }
        let id = analyzed
            .as_ref()
            .map(|(document, _)| document.generation.to_string());
        if id.is_some() && id == params.previous_result_id {
            let unchanged = RelatedUnchangedDocumentDiagnosticReport {
                related_documents: None,
                unchanged_document_diagnostic_report: UnchangedDocumentDiagnosticReport {
                    result_id: id.unwrap_or_default(),
                },
            };
            return Ok(DocumentDiagnosticReport::Unchanged(unchanged).into());
        }
        let links = self.client_support.links_at_codes.load(Ordering::Relaxed);
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
        self.on_hover(params).await
    }

    async fn completion(&self, params: CompletionParams) -> Result<Option<CompletionResponse>> {
        self.on_completion(params).await
    }

    async fn completion_resolve(&self, item: CompletionItem) -> Result<CompletionItem> {
        self.on_completion_resolve(item).await
    }

    async fn signature_help(&self, params: SignatureHelpParams) -> Result<Option<SignatureHelp>> {
        self.on_signature_help(params).await
    }

    async fn goto_definition(
        &self,
        params: GotoDefinitionParams,
    ) -> Result<Option<GotoDefinitionResponse>> {
        self.on_goto_definition(params).await
    }

    async fn references(&self, params: ReferenceParams) -> Result<Option<Vec<Location>>> {
        self.on_references(params).await
    }

    async fn document_highlight(
        &self,
        params: DocumentHighlightParams,
    ) -> Result<Option<Vec<DocumentHighlight>>> {
        self.on_document_highlight(params).await
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
        self.on_document_symbol(params).await
    }

    async fn symbol(
        &self,
        params: WorkspaceSymbolParams,
    ) -> Result<Option<WorkspaceSymbolResponse>> {
        self.on_symbol(params).await
    }

    async fn folding_range(&self, params: FoldingRangeParams) -> Result<Option<Vec<FoldingRange>>> {
        self.on_folding_range(params).await
    }

    async fn selection_range(
        &self,
        params: SelectionRangeParams,
    ) -> Result<Option<Vec<SelectionRange>>> {
        self.on_selection_range(params).await
    }

    async fn semantic_tokens_full(
        &self,
        params: SemanticTokensParams,
    ) -> Result<Option<SemanticTokensResult>> {
        self.on_semantic_tokens_full(params).await
    }

    async fn semantic_tokens_range(
        &self,
        params: SemanticTokensRangeParams,
    ) -> Result<Option<SemanticTokensRangeResult>> {
        self.on_semantic_tokens_range(params).await
    }

    async fn inlay_hint(&self, params: InlayHintParams) -> Result<Option<Vec<InlayHint>>> {
        self.on_inlay_hint(params).await
    }

    async fn document_color(&self, params: DocumentColorParams) -> Result<Vec<ColorInformation>> {
        self.on_document_color(params).await
    }

    async fn color_presentation(
        &self,
        params: ColorPresentationParams,
    ) -> Result<Vec<ColorPresentation>> {
        self.on_color_presentation(params).await
    }

    async fn code_action(&self, params: CodeActionParams) -> Result<Option<CodeActionResponse>> {
        self.on_code_action(params).await
    }

    async fn formatting(&self, params: DocumentFormattingParams) -> Result<Option<Vec<TextEdit>>> {
        self.on_formatting(params).await
    }

    async fn range_formatting(
        &self,
        params: DocumentRangeFormattingParams,
    ) -> Result<Option<Vec<TextEdit>>> {
        self.on_range_formatting(params).await
    }

    async fn code_lens(&self, params: CodeLensParams) -> Result<Option<Vec<CodeLens>>> {
        self.on_code_lens(params).await
    }

    async fn execute_command(&self, params: ExecuteCommandParams) -> Result<Option<LSPAny>> {
        self.on_execute_command(params).await
    }
}
