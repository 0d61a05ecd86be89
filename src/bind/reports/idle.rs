//! Attributes that have no effect without another one.

use crate::bind::attributes::PartAttributes;
use crate::bind::bindings::{DrawingString, PartKind};
use crate::bind::hierarchy::Tree;
use crate::bind::matching::{LayerKind, Matched};
use crate::bind::reports::misplaced::is_of_props;
use crate::diagnostic::{Code, Diagnostic};
use crate::lang::ast::Annotation;
use crate::lang::keyword::Keyword;
use crate::source::Span;
use crate::svg::Drawing;

/// Reports `Limited`, `Held`, `Bone`, `Carry`, `Swing` and `Perform`, each once, in a drawing without a motion. In strings of props, which never move,
/// they are reported elsewhere.
pub(super) fn without_motion(
    drawing: &Drawing,
    matched: &Matched,
    diagnostics: &mut Vec<Diagnostic>,
) {
    let is_posed = matched
        .layers
        .iter()
        .any(|layer| layer.kind == LayerKind::Pose);
    if is_posed || matched.asks_for_motion() {
        return;
    }
    for keyword in [
        Keyword::Limited,
        Keyword::Held,
        Keyword::Bone,
        Keyword::Carry,
        Keyword::Swing,
        Keyword::Perform,
    ] {
        let found = matched.strings.iter().find_map(|string| {
            let counts = !matches!(string.annotation, Annotation::Legend(_))
                && !is_of_props(drawing, matched, string);
            let mut settings = string.settings.iter().filter(|_| counts);
            let setting = settings.find(|setting| setting.keyword == keyword)?;
            Some(string.text.span(setting.range.clone()))
        });
        if let Some(span) = found {
            let name = keyword.name();
            let message = format!("`{name}` has no effect: the drawing has no motion");
            let help = "write `Motion walk` or `Motion \"file.bvh\"` in a `%` string, or in the string of a figure's root part";
            diagnostics.push(Diagnostic::new(Code::IdleMotion, span, message).help(help));
        }
    }
}

/// Reports each `Follow` of which no part has a `Mark`.
pub(super) fn without_mark(
    matched: &Matched,
    attributes: &PartAttributes,
    tree: &Tree,
    diagnostics: &mut Vec<Diagnostic>,
) {
    let writes_follow = |string: &DrawingString| {
        let mut settings = string.settings.iter();
        settings.any(|setting| setting.keyword == Keyword::Follow)
    };
    if !matched.strings.iter().any(writes_follow) {
        return;
    }
    let mut found: Vec<(Span, bool)> = Vec::new();
    for (part, kind) in tree.nodes.kind.iter_enumerated() {
        let attributes = attributes.attributes(matched, part);
        let follow = attributes.source(Keyword::Follow);
        let Some(source) = follow.filter(|_| *kind == PartKind::Main) else {
            continue;
        };
        let span = source.span(&matched.strings);
        let is_marked = attributes.mark().is_some();
        match found.iter_mut().find(|(known, _)| *known == span) {
            Some((_, any)) => *any |= is_marked,
            None => found.push((span, is_marked)),
        }
    }
    for (span, is_marked) in found {
        if is_marked {
            continue;
        }
        let message = "`Follow` has no effect: the part has no `Mark`";
        let help = "write the colour of the mark that performs the part, `Mark red` for example";
        diagnostics.push(Diagnostic::new(Code::NoMark, span, message).help(help));
    }
}
