//! The requests of the protocol, each answered from what `ide` knows.

use std::collections::{BTreeSet, HashMap};
use std::path::PathBuf;
use std::sync::atomic::Ordering;
use std::sync::{Arc, Mutex};

use serde_json::Value;
use tower_lsp::jsonrpc::{Error, ErrorCode, Result};
use tower_lsp::ls_types::*;
use tower_lsp::{Client, LanguageServer};

use super::analyst::{Abilities, Analyst};
use super::convert::{self, Places};
use super::documents::{Analysed, Document, Documents, Snapshot, file_path};
use super::links::Links;
use super::ordered::SNAPSHOTS;
use super::positions::Encoding;
use super::workspace::Workspace;
use super::{capabilities, manual, preview};
use crate::compile::{Options, compile};
use crate::disk::{FolderResolver, files_below};
use crate::ide::{self, Analysis, Target};
use crate::resolver::MemoryResolver;
use crate::source::Span;

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
    pub(super) client_can: Mutex<ClientCapabilities>,
    pub(super) ended: Arc<std::sync::atomic::AtomicBool>,
}

/// A text, what is known of it, and how places of the two go together.
struct View {
    document: Arc<Document>,
    analysed: Arc<Analysed>,
}

impl View {
    fn analysis(&self) -> &Analysis {
        &self.analysed.analysis
    }

    fn places(&self) -> Places<'_> {
        match Arc::ptr_eq(&self.document, &self.analysed.document) {
            true => Places::same(&self.document.positions),
            false => Places::shifted(&self.document.positions, self.analysed.document.text()),
        }
    }

    /// Whether the text is the one that was analysed, so that it can be edited.
    fn is_current(&self) -> bool {
        Arc::ptr_eq(&self.document, &self.analysed.document) && self.analysis().is_sound()
    }
}

impl Backend {
    /// A text as it was when the request came.
    fn snapshot(&self, uri: &Uri) -> Option<Snapshot> {
        SNAPSHOTS.with(|snapshots| snapshots.get(uri.as_str()).cloned())
    }

    /// The analysis of the text as it was when the request came; waits for it.
    ///
    /// # Errors
    /// If the text has changed meanwhile: then the answer would be about another text.
    async fn analysed(&self, uri: &Uri) -> Result<Option<(Arc<Document>, Arc<Analysed>)>> {
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
    async fn view(&self, uri: &Uri) -> Result<Option<View>> {
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
    async fn at<T>(
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

    fn target(
        &self,
        document: &Document,
        target: &Target,
        places: &Places<'_>,
    ) -> Option<Location> {
        match target {
            Target::Here(span) => Some(Location::new(document.uri.clone(), places.range(*span)?)),
            Target::File(name) => {
                let path = FolderResolver::new(document.folder()?).place(name).ok()?;
                Some(Location::new(Uri::from_file_path(path)?, Range::default()))
            }
        }
    }

    fn locations(&self, view: &View, spans: &[Span], places: &Places<'_>) -> Vec<Location> {
        let ranges = spans.iter().filter_map(|span| places.range(*span));
        let uri = &view.document.uri;
        ranges
            .map(|range| Location::new(uri.clone(), range))
            .collect()
    }

    fn client_can(&self) -> ClientCapabilities {
        let can = self.client_can.lock();
        can.unwrap_or_else(|poisoned| poisoned.into_inner()).clone()
    }

    fn snippets(&self) -> bool {
        let can = self
            .client_can()
            .text_document
            .and_then(|can| can.completion);
        can.and_then(|can| can.completion_item)
            .and_then(|can| can.snippet_support)
            .unwrap_or(false)
    }

    /// The edits of one text, with its version where the client can tell versions.
    fn workspace_edit(&self, document: &Document, edits: Vec<TextEdit>) -> WorkspaceEdit {
        let can = self
            .client_can()
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

    async fn formatted(&self, uri: &Uri, range: Option<Range>) -> Result<Option<Vec<TextEdit>>> {
        let Some(view) = self.view(uri).await?.filter(View::is_current) else {
            return Ok(None);
        };
        // Compiling anew may take as long as it did before.
        let edits = tokio::task::spawn_blocking(move || {
            let places = view.places();
            let window = match range {
                Some(range) => places.span(range),
                None => Span::new(0, view.document.text().len()),
            };
            let again = |text: &str| match view.document.folder() {
                Some(folder) => Analysis::new(
                    text,
                    compile(text, &Options::default(), &FolderResolver::new(folder)),
                ),
                None => Analysis::new(
                    text,
                    compile(text, &Options::default(), &MemoryResolver::default()),
                ),
            };
            places.edits(&view.analysis().format(window, &again))
        });
        edits.await.map_err(|_| Error::internal_error())
    }

    async fn show_preview(&self, uri: &Uri) -> Result<()> {
        let Some((document, analysed)) = self.analysed(uri).await? else {
            return Err(Error::invalid_params("this drawing is not open"));
        };
        let name = document.path.as_deref().and_then(|path| path.file_stem());
        let name = name.map_or_else(
            || "untitled".to_owned(),
            |name| name.to_string_lossy().into_owned(),
        );
        let drawn =
            tokio::task::spawn_blocking(move || preview::picture(&analysed.analysis, &name)).await;
        let picture = match drawn {
            Ok(Ok(picture)) => picture,
            Ok(Err(error)) => {
                self.client.show_message(MessageType::WARNING, error).await;
                return Ok(());
            }
            Err(_) => return Err(Error::internal_error()),
        };
        let can = self.client_can().window.and_then(|can| can.show_document);
        let shown = match (
            can.is_some_and(|can| can.support),
            Uri::from_file_path(&picture),
        ) {
            (true, Some(uri)) => {
                let params = ShowDocumentParams {
                    uri,
                    // Editors of text cannot show it: the system's viewer can.
                    external: Some(true),
                    take_focus: Some(false),
                    selection: None,
                };
                self.client.show_document(params).await.unwrap_or(false)
            }
            _ => false,
        };
        if !shown {
            let message = format!("the model's picture is {}", picture.display());
            self.client.show_message(MessageType::INFO, message).await;
        }
        Ok(())
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
        let place = &params.text_document_position_params;
        self.at(place, |view, places, offset| {
            let hover = view.analysis().hover(offset)?;
            Some(Hover {
                contents: HoverContents::Markup(convert::markdown(hover.markdown)),
                range: places.range(hover.span),
            })
        })
        .await
    }

    async fn completion(&self, params: CompletionParams) -> Result<Option<CompletionResponse>> {
        let place = &params.text_document_position;
        let Some((document, analysed)) = self.analysed(&place.text_document.uri).await? else {
            return Ok(None);
        };
        let known = analysed.good.as_ref().unwrap_or(&analysed);
        let folder = document.folder().map(PathBuf::from);
        let files = || files_in(folder.as_deref());
        let context = ide::Context {
            source: document.text(),
            analysis: &known.analysis,
            files: &files,
        };
        let offset = document.positions.offset(place.position);
        let Some(found) = ide::completion(&context, offset) else {
            return Ok(None);
        };
        let range = document.positions.range(found.span);
        let snippets = self.snippets();
        let proposals = found.proposals.iter().enumerate();
        let items =
            proposals.map(|(index, proposal)| convert::proposal(proposal, index, range, snippets));
        Ok(Some(CompletionResponse::Array(items.collect())))
    }

    async fn completion_resolve(&self, mut item: CompletionItem) -> Result<CompletionItem> {
        item.documentation = convert::page(&item);
        Ok(item)
    }

    async fn signature_help(&self, params: SignatureHelpParams) -> Result<Option<SignatureHelp>> {
        let place = &params.text_document_position_params;
        let Some((document, analysed)) = self.analysed(&place.text_document.uri).await? else {
            return Ok(None);
        };
        let known = analysed.good.as_ref().unwrap_or(&analysed);
        let offset = document.positions.offset(place.position);
        Ok(ide::signature(document.text(), &known.analysis, offset).map(convert::signatures))
    }

    async fn goto_definition(
        &self,
        params: GotoDefinitionParams,
    ) -> Result<Option<GotoDefinitionResponse>> {
        let can = self
            .client_can()
            .text_document
            .and_then(|can| can.definition);
        let links = can.and_then(|can| can.link_support).unwrap_or(false);
        let place = &params.text_document_position_params;
        self.at(place, |view, places, offset| {
            let (from, targets) = view.analysis().definition(offset)?;
            let targets = targets.iter();
            let locations =
                targets.filter_map(|target| self.target(&view.document, target, places));
            Some(match links {
                false => GotoDefinitionResponse::Array(locations.collect()),
                true => GotoDefinitionResponse::Link(
                    locations
                        .map(|location| LocationLink {
                            origin_selection_range: places.range(from),
                            target_uri: location.uri,
                            target_range: location.range,
                            target_selection_range: location.range,
                        })
                        .collect(),
                ),
            })
        })
        .await
    }

    async fn references(&self, params: ReferenceParams) -> Result<Option<Vec<Location>>> {
        let with_definition = params.context.include_declaration;
        self.at(&params.text_document_position, |view, places, offset| {
            let spans = view.analysis().references(offset, with_definition);
            (!spans.is_empty()).then(|| self.locations(view, &spans, places))
        })
        .await
    }

    async fn document_highlight(
        &self,
        params: DocumentHighlightParams,
    ) -> Result<Option<Vec<DocumentHighlight>>> {
        let place = &params.text_document_position_params;
        self.at(place, |view, places, offset| {
            let found = view.analysis().highlights(offset);
            let highlights = found.iter().filter_map(|(span, defines)| {
                Some(DocumentHighlight {
                    range: places.range(*span)?,
                    kind: Some(match defines {
                        true => DocumentHighlightKind::WRITE,
                        false => DocumentHighlightKind::READ,
                    }),
                })
            });
            Some(highlights.collect())
        })
        .await
    }

    async fn prepare_rename(
        &self,
        params: TextDocumentPositionParams,
    ) -> Result<Option<PrepareRenameResponse>> {
        let Some((document, analysed)) = self.analysed(&params.text_document.uri).await? else {
            return Ok(None);
        };
        let offset = document.positions.offset(params.position);
        match analysed.analysis.prepare_rename(offset) {
            Ok((span, placeholder)) => Ok(Some(PrepareRenameResponse::RangeWithPlaceholder {
                range: document.positions.range(span),
                placeholder,
            })),
            Err(ide::RenameError::NoName) => Ok(None),
            Err(error) => Err(refused(&error)),
        }
    }

    async fn rename(&self, params: RenameParams) -> Result<Option<WorkspaceEdit>> {
        let place = &params.text_document_position;
        let Some((document, analysed)) = self.analysed(&place.text_document.uri).await? else {
            return Ok(None);
        };
        let offset = document.positions.offset(place.position);
        let edits = analysed
            .analysis
            .rename(offset, &params.new_name)
            .map_err(|error| refused(&error))?;
        let edits = Places::same(&document.positions)
            .edits(&edits)
            .unwrap_or_default();
        Ok(Some(self.workspace_edit(&document, edits)))
    }

    async fn document_symbol(
        &self,
        params: DocumentSymbolParams,
    ) -> Result<Option<DocumentSymbolResponse>> {
        let Some(view) = self.view(&params.text_document.uri).await? else {
            return Ok(None);
        };
        let can = self
            .client_can()
            .text_document
            .and_then(|can| can.document_symbol);
        let nested = can.and_then(|can| can.hierarchical_document_symbol_support);
        let symbols = convert::symbols(view.analysis().outline(), &view.places());
        Ok(Some(match nested.unwrap_or(false) {
            true => DocumentSymbolResponse::Nested(symbols),
            false => DocumentSymbolResponse::Flat(flat(symbols, &view.document.uri)),
        }))
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
        let found = found.await.map_err(|_| Error::internal_error())?;
        Ok(Some(WorkspaceSymbolResponse::Nested(found)))
    }

    async fn folding_range(&self, params: FoldingRangeParams) -> Result<Option<Vec<FoldingRange>>> {
        let Some(view) = self.view(&params.text_document.uri).await? else {
            return Ok(None);
        };
        let places = view.places();
        let folds = view.analysis().folds();
        let folds = folds
            .into_iter()
            .filter_map(|span| convert::fold(places.now(span)?, places.positions));
        Ok(Some(folds.collect()))
    }

    async fn selection_range(
        &self,
        params: SelectionRangeParams,
    ) -> Result<Option<Vec<SelectionRange>>> {
        let Some(view) = self.view(&params.text_document.uri).await? else {
            return Ok(None);
        };
        let places = view.places();
        let ranges = params.positions.iter().map(|position| {
            let spans = places
                .offset(*position)
                .map(|offset| view.analysis().selections(offset));
            let nested = spans.and_then(|spans| convert::selection(&spans, &places));
            // Every position is answered: where no string is, by the empty range.
            nested.unwrap_or(SelectionRange {
                range: Range::new(*position, *position),
                parent: None,
            })
        });
        Ok(Some(ranges.collect()))
    }

    async fn semantic_tokens_full(
        &self,
        params: SemanticTokensParams,
    ) -> Result<Option<SemanticTokensResult>> {
        let Some(view) = self.view(&params.text_document.uri).await? else {
            return Ok(None);
        };
        let all = Span::new(0, view.analysed.document.text().len());
        let data = convert::tokens(&view.analysis().colouring(all), &view.places());
        Ok(Some(
            SemanticTokens {
                result_id: None,
                data,
            }
            .into(),
        ))
    }

    async fn semantic_tokens_range(
        &self,
        params: SemanticTokensRangeParams,
    ) -> Result<Option<SemanticTokensRangeResult>> {
        let Some(view) = self.view(&params.text_document.uri).await? else {
            return Ok(None);
        };
        let places = view.places();
        let data = convert::tokens(
            &view.analysis().colouring(places.span(params.range)),
            &places,
        );
        Ok(Some(
            SemanticTokens {
                result_id: None,
                data,
            }
            .into(),
        ))
    }

    async fn inlay_hint(&self, params: InlayHintParams) -> Result<Option<Vec<InlayHint>>> {
        let Some(view) = self.view(&params.text_document.uri).await? else {
            return Ok(None);
        };
        let places = view.places();
        let inlays = view
            .analysis()
            .inlays(places.span(params.range))
            .into_iter();
        let hints = inlays.filter_map(|inlay| convert::inlay(inlay, &places, &view.document.uri));
        Ok(Some(hints.collect()))
    }

    async fn document_color(&self, params: DocumentColorParams) -> Result<Vec<ColorInformation>> {
        let Some(view) = self.view(&params.text_document.uri).await? else {
            return Ok(vec![]);
        };
        let places = view.places();
        let swatches = view.analysis().swatches().into_iter();
        Ok(swatches
            .filter_map(|swatch| convert::swatch(swatch, &places))
            .collect())
    }

    async fn color_presentation(
        &self,
        params: ColorPresentationParams,
    ) -> Result<Vec<ColorPresentation>> {
        let Some(view) = self
            .view(&params.text_document.uri)
            .await?
            .filter(View::is_current)
        else {
            return Ok(vec![]);
        };
        let places = view.places();
        let Color {
            red,
            green,
            blue,
            alpha,
        } = params.color;
        let rgba = [red, green, blue, alpha].map(f64::from);
        let forms = view
            .analysis()
            .colour_edits(places.span(params.range), rgba)
            .into_iter();
        let presentations = forms.filter_map(|(label, edits)| {
            let mut edits = places.edits(&edits)?.into_iter();
            let first = edits.next()?;
            let others: Vec<_> = edits.collect();
            Some(ColorPresentation {
                label,
                text_edit: Some(first),
                additional_text_edits: (!others.is_empty()).then_some(others),
            })
        });
        Ok(presentations.collect())
    }

    async fn code_action(&self, params: CodeActionParams) -> Result<Option<CodeActionResponse>> {
        let Some((document, analysed)) = self.analysed(&params.text_document.uri).await? else {
            return Ok(None);
        };
        let places = Places::same(&document.positions);
        let analysis = &analysed.analysis;
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
        let links = manual::links(self.abilities.links_at_codes.load(Ordering::Relaxed));
        let actions = analysis
            .actions(document.positions.span(params.range))
            .into_iter();
        let actions = actions.filter_map(|action| {
            let kind = match action.mends {
                Some(_) => CodeActionKind::QUICKFIX,
                None => CodeActionKind::REFACTOR_REWRITE,
            };
            if !wanted(&kind) {
                return None;
            }
            let mends = action.mends.map(|index| {
                let found = &analysis.diagnostics()[index];
                vec![convert::diagnostic(&analysed, found, links)]
            });
            let edits = places.edits(&action.edits)?;
            Some(CodeActionOrCommand::CodeAction(CodeAction {
                title: action.title,
                kind: Some(kind),
                diagnostics: mends,
                edit: Some(self.workspace_edit(&document, edits)),
                is_preferred: action.is_preferred.then_some(true),
                ..CodeAction::default()
            }))
        });
        let actions: Vec<_> = actions.collect();
        Ok((!actions.is_empty()).then_some(actions))
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
        let Some(view) = self.view(&params.text_document.uri).await? else {
            return Ok(None);
        };
        let root = view.analysis().compiled().drawing.groups.first();
        let range = root.and_then(|root| view.places().range(root.element.span));
        let command = Command {
            title: "Preview in 3D".to_owned(),
            command: PREVIEW.to_owned(),
            arguments: Some(vec![Value::String(view.document.uri.to_string())]),
        };
        Ok(range.map(|range| {
            vec![CodeLens {
                range,
                command: Some(command),
                data: None,
            }]
        }))
    }

    async fn execute_command(&self, params: ExecuteCommandParams) -> Result<Option<LSPAny>> {
        if params.command != PREVIEW {
            return Err(Error::invalid_params(format!(
                "there is no command `{}`",
                params.command
            )));
        }
        let uri = match params.arguments.first() {
            Some(argument) => argument.as_str().and_then(|uri| uri.parse().ok()),
            // Some editors send commands without arguments: then it is the text that changed last.
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
        self.show_preview(&uri).await?;
        Ok(None)
    }
}

/// A rename that cannot be made, told to the person.
fn refused(error: &ide::RenameError) -> Error {
    Error {
        code: ErrorCode::ServerError(-32803),
        message: error.to_string().into(),
        data: None,
    }
}

/// Symbols for clients that know no hierarchy.
#[allow(deprecated, reason = "a field that must be given, and stays empty")]
fn flat(symbols: Vec<DocumentSymbol>, uri: &Uri) -> Vec<SymbolInformation> {
    let mut out = vec![];
    let mut waiting: Vec<(DocumentSymbol, Option<String>)> = symbols
        .into_iter()
        .rev()
        .map(|symbol| (symbol, None))
        .collect();
    while let Some((symbol, on)) = waiting.pop() {
        let name = Some(symbol.name.clone());
        let children = symbol.children.into_iter().flatten().rev();
        waiting.extend(children.map(|child| (child, name.clone())));
        out.push(SymbolInformation {
            name: symbol.name,
            kind: symbol.kind,
            tags: None,
            deprecated: None,
            location: Location::new(uri.clone(), symbol.selection_range),
            container_name: on,
        });
    }
    out
}

/// The files that a drawing in a folder can link to, as it would name them.
fn files_in(folder: Option<&std::path::Path>) -> Vec<String> {
    let Some(folder) = folder else {
        return vec![];
    };
    let files = files_below(folder).into_iter();
    let names = files.filter_map(|file| {
        let parts = file.strip_prefix(folder).ok()?.components();
        let parts: Option<Vec<_>> = parts.map(|part| part.as_os_str().to_str()).collect();
        Some(parts?.join("/"))
    });
    names.collect()
}
