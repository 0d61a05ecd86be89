//! Requests that only read: hover, completion, definitions, symbols, tokens and hints.

use std::path::{Path, PathBuf};

use serde_json::Value;
use tower_lsp::jsonrpc::Result;
use tower_lsp::ls_types::*;

use super::backend::{Backend, PREVIEW, View};
use super::convert::{self, PositionMap};
use super::documents::Document;
use super::ordered::{SNAPSHOTS, task_error};
use crate::disk::{FolderResolver, below};
use crate::ide::{self, Target};
use crate::source::Span;

impl Backend {
    pub(super) async fn on_hover(&self, params: HoverParams) -> Result<Option<Hover>> {
        let place = &params.text_document_position_params;
        self.at(place, |view, map, offset| {
            let hover = view.analysis().hover(offset)?;
            Some(Hover {
                contents: HoverContents::Markup(convert::markdown(hover.markdown)),
                range: map.range(hover.span),
            })
        })
        .await
    }

    pub(super) async fn on_completion(
        &self,
        params: CompletionParams,
    ) -> Result<Option<CompletionResponse>> {
        let place = &params.text_document_position;
        let Some((document, analyzed)) = self.analyzed(&place.text_document.uri).await? else {
            return Ok(None);
        };
        let known = analyzed.last_sound.as_ref().unwrap_or(&analyzed);
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
        Ok(Some(if found.is_incomplete {
            CompletionResponse::List(CompletionList {
                is_incomplete: true,
                items: items.collect(),
            })
        } else {
            CompletionResponse::Array(items.collect())
        }))
    }

    pub(super) async fn on_completion_resolve(
        &self,
        mut item: CompletionItem,
    ) -> Result<CompletionItem> {
        item.documentation = convert::page(&item);
        Ok(item)
    }

    pub(super) async fn on_signature_help(
        &self,
        params: SignatureHelpParams,
    ) -> Result<Option<SignatureHelp>> {
        let place = &params.text_document_position_params;
        let Some((document, analyzed)) = self.analyzed(&place.text_document.uri).await? else {
            return Ok(None);
        };
        let known = analyzed.last_sound.as_ref().unwrap_or(&analyzed);
        let offset = document.positions.offset(place.position);
        Ok(ide::signature(document.text(), &known.analysis, offset).map(convert::signatures))
    }

    pub(super) async fn on_goto_definition(
        &self,
        params: GotoDefinitionParams,
    ) -> Result<Option<GotoDefinitionResponse>> {
        let can = self
            .client_capabilities()
            .text_document
            .and_then(|can| can.definition);
        let links = can.and_then(|can| can.link_support).unwrap_or(false);
        let place = &params.text_document_position_params;
        self.at(place, |view, map, offset| {
            let (from, targets) = view.analysis().definition(offset)?;
            let targets = targets.iter();
            let locations = targets.filter_map(|target| self.target(&view.document, target, map));
            Some(if links {
                GotoDefinitionResponse::Link(
                    locations
                        .map(|location| LocationLink {
                            origin_selection_range: map.range(from),
                            target_uri: location.uri,
                            target_range: location.range,
                            target_selection_range: location.range,
                        })
                        .collect(),
                )
            } else {
                GotoDefinitionResponse::Array(locations.collect())
            })
        })
        .await
    }

    pub(super) async fn on_references(
        &self,
        params: ReferenceParams,
    ) -> Result<Option<Vec<Location>>> {
        let with_definition = params.context.include_declaration;
        self.at(&params.text_document_position, |view, map, offset| {
            let spans = view.analysis().references(offset, with_definition);
            (!spans.is_empty()).then(|| self.locations(view, &spans, map))
        })
        .await
    }

    pub(super) async fn on_document_highlight(
        &self,
        params: DocumentHighlightParams,
    ) -> Result<Option<Vec<DocumentHighlight>>> {
        let place = &params.text_document_position_params;
        self.at(place, |view, map, offset| {
            let found = view.analysis().highlights(offset);
            let highlights = found.iter().filter_map(|(span, defines)| {
                Some(DocumentHighlight {
                    range: map.range(*span)?,
                    kind: Some(if *defines {
                        DocumentHighlightKind::WRITE
                    } else {
                        DocumentHighlightKind::READ
                    }),
                })
            });
            Some(highlights.collect())
        })
        .await
    }

    pub(super) async fn on_document_symbol(
        &self,
        params: DocumentSymbolParams,
    ) -> Result<Option<DocumentSymbolResponse>> {
        let Some(view) = self.view(&params.text_document.uri).await? else {
            return Ok(None);
        };
        let can = self
            .client_capabilities()
            .text_document
            .and_then(|can| can.document_symbol);
        let nested = can.and_then(|can| can.hierarchical_document_symbol_support);
        let symbols = convert::symbols(view.analysis().outline(), &view.map());
        Ok(Some(if nested.unwrap_or(false) {
            DocumentSymbolResponse::Nested(symbols)
        } else {
            DocumentSymbolResponse::Flat(flat(symbols, &view.document.uri))
        }))
    }

    pub(super) async fn on_symbol(
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

    pub(super) async fn on_folding_range(
        &self,
        params: FoldingRangeParams,
    ) -> Result<Option<Vec<FoldingRange>>> {
        let Some(view) = self.view(&params.text_document.uri).await? else {
            return Ok(None);
        };
        let map = view.map();
        let folds = view.analysis().folds();
        let folds = folds
            .into_iter()
            .filter_map(|span| convert::fold(map.to_current(span)?, map.positions));
        Ok(Some(folds.collect()))
    }

    pub(super) async fn on_selection_range(
        &self,
        params: SelectionRangeParams,
    ) -> Result<Option<Vec<SelectionRange>>> {
        let Some(view) = self.view(&params.text_document.uri).await? else {
            return Ok(None);
        };
        let map = view.map();
        let ranges = params.positions.iter().map(|position| {
            let spans = map
                .offset(*position)
                .map(|offset| view.analysis().selections(offset));
            let nested = spans.and_then(|spans| convert::selection(&spans, &map));
            // Every position needs an answer: outside of strings the empty range.
            nested.unwrap_or(SelectionRange {
                range: Range::new(*position, *position),
                parent: None,
            })
        });
        Ok(Some(ranges.collect()))
    }

    pub(super) async fn on_semantic_tokens_full(
        &self,
        params: SemanticTokensParams,
    ) -> Result<Option<SemanticTokensResult>> {
        let Some(view) = self.view(&params.text_document.uri).await? else {
            return Ok(None);
        };
        let all = Span::new(0, view.analyzed.document.text().len());
        let data = convert::tokens(&view.analysis().semantic_tokens(all), &view.map());
        Ok(Some(
            SemanticTokens {
                result_id: None,
                data,
            }
            .into(),
        ))
    }

    pub(super) async fn on_semantic_tokens_range(
        &self,
        params: SemanticTokensRangeParams,
    ) -> Result<Option<SemanticTokensRangeResult>> {
        let Some(view) = self.view(&params.text_document.uri).await? else {
            return Ok(None);
        };
        let map = view.map();
        let data = convert::tokens(
            &view.analysis().semantic_tokens(map.span(params.range)),
            &map,
        );
        Ok(Some(
            SemanticTokens {
                result_id: None,
                data,
            }
            .into(),
        ))
    }

    pub(super) async fn on_inlay_hint(
        &self,
        params: InlayHintParams,
    ) -> Result<Option<Vec<InlayHint>>> {
        let Some(view) = self.view(&params.text_document.uri).await? else {
            return Ok(None);
        };
        let map = view.map();
        let inlays = view.analysis().inlays(map.span(params.range)).into_iter();
        let hints = inlays.filter_map(|inlay| convert::inlay(inlay, &map, &view.document.uri));
        Ok(Some(hints.collect()))
    }

    pub(super) async fn on_document_color(
        &self,
        params: DocumentColorParams,
    ) -> Result<Vec<ColorInformation>> {
        let Some(view) = self.view(&params.text_document.uri).await? else {
            return Ok(vec![]);
        };
        let map = view.map();
        let swatches = view.analysis().swatches().into_iter();
        Ok(swatches
            .filter_map(|swatch| convert::swatch(swatch, &map))
            .collect())
    }

    pub(super) async fn on_code_lens(
        &self,
        params: CodeLensParams,
    ) -> Result<Option<Vec<CodeLens>>> {
        let Some(view) = self.view(&params.text_document.uri).await? else {
            return Ok(None);
        };
        let root = view.analysis().compiled().drawing.groups.first();
        let range = root.and_then(|root| view.map().range(root.element.span));
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

    fn target(
        &self,
        document: &Document,
        target: &Target,
        map: &PositionMap<'_>,
    ) -> Option<Location> {
        match target {
            Target::Here(span) => Some(Location::new(document.uri.clone(), map.range(*span)?)),
            Target::File(name) => {
                let path = FolderResolver::new(document.folder()?).place(name).ok()?;
                Some(Location::new(Uri::from_file_path(path)?, Range::default()))
            }
        }
    }

    fn locations(&self, view: &View, spans: &[Span], map: &PositionMap<'_>) -> Vec<Location> {
        let ranges = spans.iter().filter_map(|span| map.range(*span));
        let uri = &view.document.uri;
        ranges
            .map(|range| Location::new(uri.clone(), range))
            .collect()
    }

    fn snippets(&self) -> bool {
        let can = self
            .client_capabilities()
            .text_document
            .and_then(|can| can.completion);
        can.and_then(|can| can.completion_item)
            .and_then(|can| can.snippet_support)
            .unwrap_or(false)
    }
}

/// Symbols for clients that do not support nested ones.
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

/// The files that a drawing in a folder can link to, as it names them.
fn files_in(folder: Option<&Path>) -> Vec<String> {
    let Some(folder) = folder else {
        return vec![];
    };
    let files = below(folder).files.into_iter();
    let names = files.filter_map(|file| {
        let parts = file.strip_prefix(folder).ok()?.components();
        let parts: Option<Vec<_>> = parts.map(|part| part.as_os_str().to_str()).collect();
        Some(parts?.join("/"))
    });
    names.collect()
}
