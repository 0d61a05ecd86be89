//! Edits of a text that requests ask for: rename, code actions, formatting and colors.

use std::collections::HashMap;

use ls_types::*;

use super::convert::{self, PositionMap};
use super::document::{Analyzed, Document, Pages, View};
use crate::compile::{Options, compile};
use crate::ide::{Analysis, RenameError};
use crate::resolver::Resolver;
use crate::source::Span;

/// What is renamed at a position; `None` where there is no name.
///
/// # Errors
/// If what is there cannot be renamed.
pub(crate) fn prepare_rename(
    analyzed: &Analyzed,
    position: Position,
) -> Result<Option<PrepareRenameResponse>, RenameError> {
    let positions = &analyzed.document.positions;
    match analyzed.analysis.prepare_rename(positions.offset(position)) {
        Ok((span, placeholder)) => Ok(Some(PrepareRenameResponse::RangeWithPlaceholder {
            range: positions.range(span),
            placeholder,
        })),
        Err(RenameError::NoName) => Ok(None),
        Err(refused) => Err(refused),
    }
}

/// The edits that rename what is at a position.
///
/// # Errors
/// If that is not possible.
pub(crate) fn rename(
    analyzed: &Analyzed,
    position: Position,
    new_name: &str,
) -> Result<Vec<TextEdit>, RenameError> {
    let positions = &analyzed.document.positions;
    let edits = analyzed
        .analysis
        .rename(positions.offset(position), new_name)?;
    let edits = PositionMap::identity(positions).edits(&edits);
    Ok(edits.unwrap_or_default())
}

/// The code actions for a range; `edit` makes an edit of the workspace of edits of the text.
pub(crate) fn actions(
    analyzed: &Analyzed,
    params: &CodeActionParams,
    pages: Option<&Pages>,
    edit: &dyn Fn(Vec<TextEdit>) -> WorkspaceEdit,
) -> Option<CodeActionResponse> {
    let positions = &analyzed.document.positions;
    let map = PositionMap::identity(positions);
    let analysis = &analyzed.analysis;
    let only = params.context.only.as_deref();
    let wanted = |kind: &CodeActionKind| {
        only.is_none_or(|only| {
            only.iter().any(|wanted| {
                let inner = kind.as_str().strip_prefix(wanted.as_str());
                inner.is_some_and(|inner| {
                    inner.is_empty() || inner.starts_with('.') || wanted.as_str().is_empty()
                })
            })
        })
    };
    let actions = analysis.actions(positions.span(params.range)).into_iter();
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
            vec![convert::diagnostic(analyzed, found, pages)]
        });
        let edits = map.edits(&action.edits)?;
        Some(CodeActionOrCommand::CodeAction(CodeAction {
            title: action.title,
            kind: Some(kind),
            diagnostics: fixed,
            edit: Some(edit(edits)),
            is_preferred: action.is_preferred.then_some(true),
            ..CodeAction::default()
        }))
    });
    let actions: Vec<_> = actions.collect();
    (!actions.is_empty()).then_some(actions)
}

/// The edits that format a text, or a range of it; compiles the result.
pub(crate) fn formatted(
    view: &View,
    range: Option<Range>,
    resolver: &dyn Resolver,
) -> Option<Vec<TextEdit>> {
    let map = view.map();
    let window = match range {
        Some(range) => map.span(range),
        None => Span::new(0, view.document.text().len()),
    };
    let again = |text: &str| {
        let compiled = compile(text, &Options::default(), resolver);
        Analysis::new(text, compiled)
    };
    map.edits(&view.analysis().format(window, &again))
}

/// The edits of one text, with its version if the client supports versioned edits.
pub(crate) fn workspace_edit(
    document: &Document,
    edits: Vec<TextEdit>,
    can: &ClientCapabilities,
) -> WorkspaceEdit {
    let can = can.workspace.as_ref();
    let can = can.and_then(|can| can.workspace_edit.as_ref());
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

/// What to write for a color that was chosen in place of the one in a range.
pub(crate) fn color_presentations(
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
