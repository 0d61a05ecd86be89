//! Answers to requests that only read: hover, completion, definitions, symbols, tokens and hints.

use ls_types::*;
use serde_json::Value;

use super::capabilities::PREVIEW;
use super::convert::{self, PositionMap};
use super::document::{Analyzed, Document, View};
use crate::ide::{self, Target};
use crate::source::Span;

pub(crate) fn hover(view: &View, map: &PositionMap<'_>, offset: usize) -> Option<Hover> {
    let hover = view.analysis().hover(offset)?;
    Some(Hover {
        contents: HoverContents::Markup(convert::markdown(hover.markdown)),
        range: map.range(hover.span),
    })
}

/// What can be written at a position; `files` are those that the drawing can link to, as it names them.
pub(crate) fn completion(
    document: &Document,
    known: &Analyzed,
    position: Position,
    snippets: bool,
    files: &dyn Fn() -> Vec<String>,
) -> Option<CompletionResponse> {
    let context = ide::Context {
        source: document.text(),
        analysis: &known.analysis,
        files,
    };
    let found = ide::completion(&context, document.positions.offset(position))?;
    let range = document.positions.range(found.span);
    let proposals = found.proposals.iter().enumerate();
    let items =
        proposals.map(|(index, proposal)| convert::proposal(proposal, index, range, snippets));
    Some(if found.is_incomplete {
        CompletionResponse::List(CompletionList {
            is_incomplete: true,
            items: items.collect(),
        })
    } else {
        CompletionResponse::Array(items.collect())
    })
}

/// The definitions of what is at an offset, with the place that they are asked for from if the client knows `links`. `file` is the
/// address of a file that the drawing links to.
pub(crate) fn definition(
    view: &View,
    map: &PositionMap<'_>,
    offset: usize,
    links: bool,
    file: &dyn Fn(&str) -> Option<Uri>,
) -> Option<GotoDefinitionResponse> {
    let (from, targets) = view.analysis().definition(offset)?;
    let targets = targets.iter();
    let locations = targets.filter_map(|target| {
        Some(match target {
            Target::Here(span) => Location::new(view.document.uri.clone(), map.range(*span)?),
            Target::File(name) => Location::new(file(name)?, Range::default()),
        })
    });
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
}

pub(crate) fn references(
    view: &View,
    map: &PositionMap<'_>,
    offset: usize,
    with_definition: bool,
) -> Option<Vec<Location>> {
    let spans = view.analysis().references(offset, with_definition);
    let ranges = spans.iter().filter_map(|span| map.range(*span));
    let locations = ranges.map(|range| Location::new(view.document.uri.clone(), range));
    (!spans.is_empty()).then(|| locations.collect())
}

pub(crate) fn highlights(
    view: &View,
    map: &PositionMap<'_>,
    offset: usize,
) -> Option<Vec<DocumentHighlight>> {
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
}

pub(crate) fn symbols(view: &View, nested: bool) -> DocumentSymbolResponse {
    let symbols = convert::symbols(view.analysis().outline(), &view.map());
    if nested {
        DocumentSymbolResponse::Nested(symbols)
    } else {
        DocumentSymbolResponse::Flat(flat(symbols, &view.document.uri))
    }
}

pub(crate) fn folds(view: &View) -> Vec<FoldingRange> {
    let map = view.map();
    let folds = view.analysis().folds().into_iter();
    folds
        .filter_map(|span| convert::fold(map.to_current(span)?, map.positions))
        .collect()
}

pub(crate) fn selections(view: &View, positions: &[Position]) -> Vec<SelectionRange> {
    let map = view.map();
    let ranges = positions.iter().map(|position| {
        let offset = map.offset(*position);
        let spans = offset.map(|offset| view.analysis().selections(offset));
        let nested = spans.and_then(|spans| convert::selection(&spans, &map));
        // Every position needs an answer: outside of strings the empty range.
        nested.unwrap_or(SelectionRange {
            range: Range::new(*position, *position),
            parent: None,
        })
    });
    ranges.collect()
}

/// The tokens of a text, or of a range of it.
pub(crate) fn semantic_tokens(view: &View, range: Option<Range>) -> SemanticTokens {
    let map = view.map();
    let span = match range {
        Some(range) => map.span(range),
        None => Span::new(0, view.analyzed.document.text().len()),
    };
    SemanticTokens {
        result_id: None,
        data: convert::tokens(&view.analysis().semantic_tokens(span), &map),
    }
}

pub(crate) fn inlays(view: &View, range: Range) -> Vec<InlayHint> {
    let map = view.map();
    let inlays = view.analysis().inlays(map.span(range)).into_iter();
    inlays
        .filter_map(|inlay| convert::inlay(inlay, &map, &view.document.uri))
        .collect()
}

pub(crate) fn colors(view: &View) -> Vec<ColorInformation> {
    let map = view.map();
    let swatches = view.analysis().swatches().into_iter();
    swatches
        .filter_map(|swatch| convert::swatch(swatch, &map))
        .collect()
}

/// The lens above a drawing that shows its preview.
pub(crate) fn preview_lens(view: &View) -> Option<Vec<CodeLens>> {
    let root = view.analysis().compiled().drawing.groups.first()?;
    let command = Command {
        title: "Preview in 3D".to_owned(),
        command: PREVIEW.to_owned(),
        arguments: Some(vec![Value::String(view.document.uri.to_string())]),
    };
    Some(vec![CodeLens {
        range: view.map().range(root.element.span)?,
        command: Some(command),
        data: None,
    }])
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
