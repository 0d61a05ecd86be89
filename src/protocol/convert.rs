//! Conversion from the types of `ide` to those of the protocol.

use ls_types::{
    CodeDescription, Color, ColorInformation, CompletionItem, CompletionItemKind,
    CompletionTextEdit, Diagnostic, DiagnosticRelatedInformation, DiagnosticSeverity,
    DiagnosticTag, DocumentSymbol, Documentation, FoldingRange, InlayHint, InlayHintKind,
    InlayHintLabel, InlayHintLabelPart, InlayHintLabelPartTooltip, InsertTextFormat, Location,
    MarkupContent, MarkupKind, NumberOrString, ParameterInformation, ParameterLabel, Position,
    Range, SelectionRange, SemanticToken, SemanticTokenModifier, SemanticTokenType,
    SemanticTokensLegend, SignatureHelp, SignatureInformation, SymbolKind, TextEdit, Uri,
};

use super::document::{Analyzed, Pages};
use super::positions::Positions;
use crate::diagnostic::{Code, Edit, Severity};
use crate::ide::{self, ProposalKind, TokenClass};
use crate::lang::explain;
use crate::source::Span;

/// The source that diagnostics name.
pub(crate) const SOURCE: &str = "okoshi";

/// Maps positions between the client's text and an earlier state that was analysed: the texts are the same before and after
/// the stretch that was edited.
#[derive(Debug)]
pub(crate) struct PositionMap<'a> {
    /// The text that the client has.
    pub(crate) positions: &'a Positions,
    /// Where the two texts begin to differ, where in the analysed text they are the same again, and how much longer the
    /// client's is; `None` if they are the same.
    shift: Option<(usize, usize, isize)>,
}

impl<'a> PositionMap<'a> {
    /// For a text that is the analysed one.
    pub(crate) fn identity(positions: &'a Positions) -> Self {
        Self {
            positions,
            shift: None,
        }
    }

    /// For a text that was edited after it was analysed.
    pub(crate) fn after_edit(positions: &'a Positions, analyzed: &str) -> Self {
        let now = positions.text().as_bytes();
        let then = analyzed.as_bytes();
        let alike = |(a, b): &(&u8, &u8)| a == b;
        let head = now.iter().zip(then).take_while(alike).count();
        let most = now.len().min(then.len()) - head;
        let tail = now
            .iter()
            .rev()
            .zip(then.iter().rev())
            .take(most)
            .take_while(alike)
            .count();
        let longer = now.len() as isize - then.len() as isize;
        let shift = (head < now.len().max(then.len())).then_some((head, then.len() - tail, longer));
        Self { positions, shift }
    }

    /// The offset in the analysed text of a position in the client's; `None` in what was edited.
    pub(crate) fn offset(&self, position: Position) -> Option<usize> {
        let at = self.positions.offset(position);
        match self.shift {
            None => Some(at),
            Some((head, _, _)) if at <= head => Some(at),
            Some((_, tail, longer)) => at.checked_add_signed(-longer).filter(|at| *at >= tail),
        }
    }

    /// The span in the analysed text of a range in the client's, cut to what is in both.
    pub(crate) fn span(&self, range: Range) -> Span {
        let start = self
            .offset(range.start)
            .unwrap_or_else(|| self.shift.map_or(0, |shift| shift.0));
        let end = self
            .offset(range.end)
            .unwrap_or_else(|| self.shift.map_or(0, |shift| shift.1));
        Span::new(start, end.max(start))
    }

    /// The range in the client's text of a span in the analysed one; `None` if it was edited.
    pub(crate) fn range(&self, span: Span) -> Option<Range> {
        Some(self.positions.range(self.to_current(span)?))
    }

    /// The span in the client's text of a span in the analysed one; `None` if it was edited.
    pub(crate) fn to_current(&self, span: Span) -> Option<Span> {
        match self.shift {
            None => Some(span),
            Some((head, _, _)) if span.end <= head => Some(span),
            Some((_, tail, longer)) if span.start >= tail => Some(Span::new(
                span.start.checked_add_signed(longer)?,
                span.end.checked_add_signed(longer)?,
            )),
            Some(_) => None,
        }
    }

    pub(crate) fn position(&self, offset: usize) -> Option<Position> {
        Some(self.range(Span::at(offset))?.start)
    }

    pub(crate) fn edit(&self, edit: &Edit) -> Option<TextEdit> {
        Some(TextEdit::new(self.range(edit.span)?, edit.text.clone()))
    }

    /// Edits, if none of their spans was edited.
    pub(crate) fn edits(&self, edits: &[Edit]) -> Option<Vec<TextEdit>> {
        edits.iter().map(|edit| self.edit(edit)).collect()
    }
}

/// The most diagnostics that are sent for a drawing: more of them stall editors, and nobody reads them.
const MAX_SHOWN: usize = 1000;

/// The diagnostics of an analysis, only the most severe if there are too many; none for a drawing without strings.
pub(crate) fn diagnostics(analyzed: &Analyzed, pages: Option<&Pages>) -> Vec<Diagnostic> {
    if !analyzed.analysis.is_annotated() {
        return vec![];
    }
    let mut found: Vec<_> = analyzed.analysis.diagnostics().iter().collect();
    if found.len() > MAX_SHOWN {
        found.sort_by_key(|diagnostic| diagnostic.severity());
        found.truncate(MAX_SHOWN);
        found.sort_by_key(|diagnostic| diagnostic.span);
    }
    let found = found.into_iter();
    found
        .map(|diagnostic| self::diagnostic(analyzed, diagnostic, pages))
        .collect()
}

pub(crate) fn diagnostic(
    analyzed: &Analyzed,
    diagnostic: &crate::diagnostic::Diagnostic,
    pages: Option<&Pages>,
) -> Diagnostic {
    let positions = &analyzed.document.positions;
    let code = diagnostic.code;
    let mut message = diagnostic.message.clone();
    if let Some(label) = &diagnostic.label {
        message.push_str(": ");
        message.push_str(label);
    }
    if let Some(help) = &diagnostic.help {
        message.push('\n');
        message.push_str(help);
    }
    let related: Vec<_> = diagnostic
        .related
        .iter()
        .map(|related| DiagnosticRelatedInformation {
            location: Location::new(analyzed.document.uri.clone(), positions.range(related.span)),
            message: related.message.clone(),
        })
        .collect();
    Diagnostic {
        range: positions.range(diagnostic.span),
        severity: Some(match diagnostic.severity() {
            Severity::Error => DiagnosticSeverity::ERROR,
            Severity::Warning => DiagnosticSeverity::WARNING,
            Severity::Hint => DiagnosticSeverity::HINT,
        }),
        code: Some(NumberOrString::String(code.id().to_owned())),
        code_description: pages
            .and_then(|pages| pages.get(&code))
            .map(|href| CodeDescription { href: href.clone() }),
        source: Some(SOURCE.to_owned()),
        message,
        related_information: (!related.is_empty()).then_some(related),
        tags: has_no_effect(code).then(|| vec![DiagnosticTag::UNNECESSARY]),
        data: None,
    }
}

/// Whether a code is about something that has no effect, which editors show faded.
fn has_no_effect(code: Code) -> bool {
    matches!(code, Code::UnusedLegend | Code::NotBuiltYet | Code::NoMark)
}

/// Text in Markdown.
pub(crate) fn markdown(value: String) -> MarkupContent {
    MarkupContent {
        kind: MarkupKind::Markdown,
        value,
    }
}

/// A completion item; `index` keeps the order.
pub(crate) fn proposal(
    proposal: &ide::Proposal,
    index: usize,
    range: Range,
    snippets: bool,
) -> CompletionItem {
    let kind = match proposal.kind {
        ProposalKind::String => CompletionItemKind::SNIPPET,
        ProposalKind::Keyword => CompletionItemKind::PROPERTY,
        ProposalKind::Word => CompletionItemKind::ENUM_MEMBER,
        ProposalKind::Flag => CompletionItemKind::OPERATOR,
        ProposalKind::Part => CompletionItemKind::CLASS,
        ProposalKind::Joint => CompletionItemKind::REFERENCE,
        ProposalKind::Variable => CompletionItemKind::VARIABLE,
        ProposalKind::Function => CompletionItemKind::FUNCTION,
        ProposalKind::Color => CompletionItemKind::COLOR,
        ProposalKind::File => CompletionItemKind::FILE,
    };
    let snippet = proposal.snippet.as_ref().filter(|_| snippets);
    CompletionItem {
        label: proposal.label.clone(),
        kind: Some(kind),
        detail: Some(proposal.detail.clone()),
        sort_text: Some(format!("{index:04}")),
        // The replaced word may begin with a quote or a sign, so items are filtered by the text that they insert. Always given,
        // since some clients take its absence to mean a filtered list.
        filter_text: Some(proposal.text.clone()),
        insert_text_format: Some(match snippet {
            Some(_) => InsertTextFormat::SNIPPET,
            None => InsertTextFormat::PLAIN_TEXT,
        }),
        text_edit: Some(CompletionTextEdit::Edit(TextEdit::new(
            range,
            snippet.unwrap_or(&proposal.text).clone(),
        ))),
        data: proposal
            .page
            .map(|page| serde_json::Value::String(page.to_owned())),
        ..CompletionItem::default()
    }
}

/// The manual page of a completion item.
pub(crate) fn page(item: &CompletionItem) -> Option<Documentation> {
    let page = item.data.as_ref()?.as_str()?;
    Some(Documentation::MarkupContent(markdown(
        explain::without_headings(&explain::page(page)?),
    )))
}

pub(crate) fn signatures(help: ide::SignatureHelp) -> SignatureHelp {
    let signatures = help.signatures.into_iter().map(|signature| {
        let parameters = signature
            .parameters
            .iter()
            .map(|(range, about)| ParameterInformation {
                label: ParameterLabel::Simple(signature.label[range.clone()].to_owned()),
                documentation: Some(Documentation::String(about.clone())),
            });
        SignatureInformation {
            parameters: Some(parameters.collect()),
            documentation: Some(Documentation::String(signature.summary.to_owned())),
            label: signature.label,
            active_parameter: None,
        }
    });
    SignatureHelp {
        signatures: signatures.collect(),
        active_signature: u32::try_from(help.active).ok(),
        active_parameter: u32::try_from(help.parameter).ok(),
    }
}

/// The outline as symbols.
pub(crate) fn symbols(outline: Vec<ide::Outline>, map: &PositionMap<'_>) -> Vec<DocumentSymbol> {
    let symbols = outline.into_iter().flat_map(|part| {
        let children = symbols(part.children, map);
        let (Some(range), Some(selection)) = (map.range(part.span), map.range(part.selection))
        else {
            // A part whose string is being edited: its children are shown in its place.
            return children;
        };
        #[allow(deprecated, reason = "the field must be given, and stays empty")]
        let symbol = DocumentSymbol {
            name: part.name,
            detail: Some(part.detail),
            kind: symbol_kind(part.is_joint),
            tags: None,
            deprecated: None,
            range,
            selection_range: selection,
            children: (!children.is_empty()).then_some(children),
        };
        vec![symbol]
    });
    symbols.collect()
}

/// The symbol kind of a part: one with children, or without.
pub(crate) fn symbol_kind(is_joint: bool) -> SymbolKind {
    if is_joint {
        SymbolKind::CLASS
    } else {
        SymbolKind::FIELD
    }
}

/// The lines of a folding range; `None` if it is within one line.
pub(crate) fn fold(span: Span, positions: &Positions) -> Option<FoldingRange> {
    let [start, end] = [span.start, span.end].map(|offset| positions.position(offset).line);
    (start < end).then(|| FoldingRange {
        start_line: start,
        end_line: end,
        ..FoldingRange::default()
    })
}

/// Nested selections, the innermost first.
pub(crate) fn selection(spans: &[Span], map: &PositionMap<'_>) -> Option<SelectionRange> {
    let mut outer = None;
    for span in spans.iter().rev() {
        let range = map.range(*span)?;
        outer = Some(SelectionRange {
            range,
            parent: outer.map(Box::new),
        });
    }
    outer
}

/// The kinds of words, in the order of [`TokenClass`].
const TOKEN_TYPES: [(TokenClass, SemanticTokenType); 11] = [
    (TokenClass::Sign, SemanticTokenType::OPERATOR),
    (TokenClass::Part, SemanticTokenType::CLASS),
    (TokenClass::Feature, SemanticTokenType::EVENT),
    (TokenClass::Keyword, SemanticTokenType::KEYWORD),
    (TokenClass::Flag, SemanticTokenType::MODIFIER),
    (TokenClass::Word, SemanticTokenType::ENUM_MEMBER),
    (TokenClass::Number, SemanticTokenType::NUMBER),
    (TokenClass::Variable, SemanticTokenType::VARIABLE),
    (TokenClass::Function, SemanticTokenType::FUNCTION),
    (TokenClass::Quoted, SemanticTokenType::STRING),
    (TokenClass::Comment, SemanticTokenType::COMMENT),
];

/// The meaning of the numbers in tokens.
pub(crate) fn legend() -> SemanticTokensLegend {
    SemanticTokensLegend {
        token_types: TOKEN_TYPES.iter().map(|(_, kind)| kind.clone()).collect(),
        token_modifiers: vec![SemanticTokenModifier::DECLARATION],
    }
}

/// Tokens in the encoding of the protocol, each relative to the one before.
pub(crate) fn tokens(words: &[ide::SemanticToken], map: &PositionMap<'_>) -> Vec<SemanticToken> {
    let mut before = Position::new(0, 0);
    let words = words.iter().filter_map(|word| {
        let span = map.to_current(word.span)?;
        let at = map.positions.position(span.start);
        let kind = TOKEN_TYPES
            .iter()
            .position(|(class, _)| *class == word.class)?;
        let delta_line = at.line.checked_sub(before.line)?;
        let delta_start = match delta_line {
            0 => at.character.checked_sub(before.character)?,
            _ => at.character,
        };
        before = at;
        Some(SemanticToken {
            delta_line,
            delta_start,
            length: map.positions.length(span),
            token_type: u32::try_from(kind).ok()?,
            token_modifiers_bitset: u32::from(word.defines),
        })
    });
    words.collect()
}

pub(crate) fn inlay(inlay: ide::Inlay, map: &PositionMap<'_>, uri: &Uri) -> Option<InlayHint> {
    let parts = inlay.pieces.into_iter().map(|piece| InlayHintLabelPart {
        value: piece.text,
        tooltip: Some(InlayHintLabelPartTooltip::String(piece.about)),
        location: piece
            .from
            .and_then(|span| map.range(span))
            .map(|range| Location::new(uri.clone(), range)),
        command: None,
    });
    Some(InlayHint {
        position: map.position(inlay.at)?,
        label: InlayHintLabel::LabelParts(parts.collect()),
        kind: Some(InlayHintKind::TYPE),
        text_edits: None,
        tooltip: None,
        padding_left: Some(true),
        padding_right: Some(false),
        data: None,
    })
}

pub(crate) fn swatch(swatch: ide::Swatch, map: &PositionMap<'_>) -> Option<ColorInformation> {
    let [red, green, blue, alpha] = swatch.rgba.map(|channel| channel as f32);
    Some(ColorInformation {
        range: map.range(swatch.span)?,
        color: Color {
            red,
            green,
            blue,
            alpha,
        },
    })
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::protocol::positions::Encoding;

    #[test]
    fn positions_move_with_edits() {
        let now = Positions::new(Arc::from("abcXYZdef"), Encoding::Utf8);
        let map = PositionMap::after_edit(&now, "abcdef");
        assert_eq!(map.to_current(Span::new(0, 3)), Some(Span::new(0, 3)));
        assert_eq!(map.to_current(Span::new(3, 6)), Some(Span::new(6, 9)));
        assert_eq!(map.to_current(Span::new(2, 4)), None);
        assert_eq!(map.offset(Position::new(0, 2)), Some(2));
        assert_eq!(map.offset(Position::new(0, 4)), None);
        assert_eq!(map.offset(Position::new(0, 7)), Some(4));
        let same = PositionMap::after_edit(&now, "abcXYZdef");
        assert_eq!(same.to_current(Span::new(2, 4)), Some(Span::new(2, 4)));
        let shorter = PositionMap::after_edit(&now, "abcXYZ1def");
        assert_eq!(shorter.to_current(Span::new(7, 10)), Some(Span::new(6, 9)));
    }

    #[test]
    fn every_class_has_a_token_type() {
        for (index, (class, _)) in TOKEN_TYPES.iter().enumerate() {
            assert_eq!(*class as usize, index);
        }
    }
}
