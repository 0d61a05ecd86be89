//! The requests of the protocol, each answered from what `ide` knows.

use std::collections::BTreeSet;
use std::path::PathBuf;
use std::sync::atomic::Ordering;
use std::sync::{Arc, Mutex};

use tower_lsp::jsonrpc::{Error, ErrorCode, Result};
use tower_lsp::ls_types::*;
use tower_lsp::{Client, LanguageServer};

use super::analyst::Analyst;
use super::convert::{self, Places};
use super::documents::{Analysed, Document, Documents, Snapshot, file_path};
use super::links::Links;
use super::ordered::SNAPSHOTS;
use super::positions::Encoding;
use super::preview::Previews;
use super::worker::Abilities;
use super::workspace::Workspace;
use super::{capabilities, manual};
use crate::ide::Analysis;

/// The command behind the code lens.
pub(super) const PREVIEW: &str = "okoshi.preview";

/// The server.
#[derive(Debug)]
pub(super) struct Backend {
    pub(super) client: Client,
    pub(super) documents: Arc<Documents>,
    pub(super) analyst: Arc<Analyst>,
    pub(super) abilities: Arc<Abilities>,
    pub(super) links: Arc<Links>,
    pub(super) workspace: Arc<Workspace>,
    pub(super) previews: Arc<Previews>,
    pub(super) client_can: Mutex<ClientCapabilities>,
    pub(super) ended: Arc<std::sync::atomic::AtomicBool>,
}

/// A text, what is known of it, and how places of the two go together.
pub(super) struct View {
    pub(super) document: Arc<Document>,
    pub(super) analysed: Arc<Analysed>,
}

impl View {
    pub(super) fn analysis(&self) -> &Analysis {
        &self.analysed.analysis
    }

    pub(super) fn places(&self) -> Places<'_> {
        match Arc::ptr_eq(&self.document, &self.analysed.document) {
            true => Places::same(&self.document.positions),
            false => Places::shifted(&self.document.positions, self.analysed.document.text()),
        }
    }

    /// Whether the text is the one that was analysed, so that it can be edited.
    pub(super) fn is_current(&self) -> bool {
        Arc::ptr_eq(&self.document, &self.analysed.document) && self.analysis().is_sound()
    }
}

impl Backend {
    /// A text as it was when the request came.
    pub(super) fn snapshot(&self, uri: &Uri) -> Option<Snapshot> {
        SNAPSHOTS.with(|snapshots| snapshots.get(uri.as_str()).cloned())
    }

    /// The analysis of the text as it was when the request came; waits for it.
    ///
    /// # Errors
    /// If the text has changed meanwhile: then the answer would be about another text.
    pub(super) async fn analysed(
        &self,
        uri: &Uri,
    ) -> Result<Option<(Arc<Document>, Arc<Analysed>)>> {
        let Some(snapshot) = self.snapshot(uri) else {
            return Ok(None);
        };
        let Snapshot {
            document,
            mut arrivals,
        } = snapshot;
        self.analyst.ask(uri.as_str());
        let arrived = arrivals
            .wait_for(|analysed| {
                let generation = analysed
                    .as_ref()
                    .map(|analysed| analysed.document.generation);
                generation >= Some(document.generation)
            })
            .await;
        // The sender is gone when the text was closed.
        let Ok(Some(analysed)) = arrived.map(|analysed| analysed.clone()) else {
            return Ok(None);
        };
        if analysed.document.generation != document.generation
            && analysed.document.text() != document.text()
        {
            return Err(Error {
                code: ErrorCode::ServerError(-32801),
                message: "the text has changed meanwhile".into(),
                data: None,
            });
        }
        Ok(Some((analysed.document.clone(), analysed)))
    }

    /// The text with what is known of it: of a text that cannot be read what was known before. Nothing for drawings
    /// without strings.
    pub(super) async fn view(&self, uri: &Uri) -> Result<Option<View>> {
        let Some((document, analysed)) = self.analysed(uri).await? else {
            return Ok(None);
        };
        let analysed = match &analysed.good {
            Some(good) => good.clone(),
            None => analysed,
        };
        let view = View { document, analysed };
        Ok(Some(view).filter(|view| view.analysis().is_annotated()))
    }

    /// An answer from a text and a place in it.
    pub(super) async fn at<T>(
        &self,
        place: &TextDocumentPositionParams,
        answer: impl FnOnce(&View, &Places<'_>, usize) -> Option<T>,
    ) -> Result<Option<T>> {
        let Some(view) = self.view(&place.text_document.uri).await? else {
            return Ok(None);
        };
        let places = view.places();
        let offset = places.offset(place.position);
        Ok(offset.and_then(|offset| answer(&view, &places, offset)))
    }

    pub(super) fn client_can(&self) -> ClientCapabilities {
        let can = self.client_can.lock();
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
        self.abilities.take(&can);
        if let Some(options) = &params.initialization_options {
            self.analyst.configure(options);
            if options.get("preview").and_then(serde_json::Value::as_bool) == Some(true) {
                self.previews.into_panels();
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
        let answer = capabilities::offer(&can, encoding);
        *self
            .client_can
            .lock()
            .unwrap_or_else(|poisoned| poisoned.into_inner()) = can;
        super::leave_with(params.process_id);
        Ok(answer)
    }

    async fn shutdown(&self) -> Result<()> {
        self.ended.store(true, Ordering::Relaxed);
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
            self.analyst.touched(&uri);
        }
    }

    async fn diagnostic(
        &self,
        params: DocumentDiagnosticParams,
    ) -> Result<DocumentDiagnosticReportResult> {
        let uri = &params.text_document.uri;
        let analysed = self.analysed(uri).await?;
        if analysed.is_some() && self.abilities.fetches_diagnostics.load(Ordering::Relaxed) {
            self.analyst.fetched(uri);
        }
        let id = analysed
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
        let links = self.abilities.links_at_codes.load(Ordering::Relaxed);
        let items = analysed.map_or_else(Vec::new, |(_, analysed)| {
            convert::diagnostics(&analysed, manual::links(links))
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
