//! Reports figures that are far larger or smaller than what they show.

use crate::anatomy::{self, Role};
use crate::bind::bindings::{DrawingString, PartId, PartKind, StringHolder};
use crate::bind::hierarchy::Tree;
use crate::bind::matching::Matched;
use crate::diagnostic::{Code, Diagnostic, Edit, Fix};
use crate::lang::ast::Annotation;
use crate::lang::keyword::Keyword;
use crate::source::Span;
use crate::svg::Drawing;

/// The heights that a figure with arms or legs may have, metres.
const USUAL: std::ops::RangeInclusive<f64> = 0.3..=4.0;
/// The height that is proposed, metres.
const PERSON: f64 = 1.7;

/// Reports a figure with arms or legs of an unusual height, unless a string says `Scale`.
pub(super) fn report(
    drawing: &Drawing,
    matched: &Matched,
    tree: &Tree,
    diagnostics: &mut Vec<Diagnostic>,
) {
    let mut defaults = matched.defaults.iter();
    if defaults.any(|(_, setting)| setting.keyword == Keyword::Scale) {
        return;
    }
    let mains = tree.nodes.kind.iter_enumerated();
    let mut mains = mains.filter(|(_, kind)| **kind == PartKind::Main);
    let is_limb = |part: PartId| {
        let role = Role::of(&anatomy::terms(&tree.names[part].name));
        matches!(
            role,
            Some(Role::UpperArm | Role::LowerArm | Role::Thigh | Role::Shin)
        )
    };
    let Some((limb, _)) = mains.find(|(part, _)| is_limb(*part)) else {
        return;
    };
    let built = matched.parts.iter().zip(&tree.nodes.kind);
    let built = built.filter(|(_, kind)| matches!(kind, PartKind::Main | PartKind::Sub));
    let none = (f64::INFINITY, f64::NEG_INFINITY);
    let (top, bottom) = built.fold(none, |(top, bottom), (part, _)| {
        let (low, high) = part.measure.bounds;
        (top.min(low.y), bottom.max(high.y))
    });
    let height = (bottom - top) * matched.settings.meters();
    if USUAL.contains(&height) || !(height.is_finite() && height > 0.0) {
        return;
    }
    let scale = two_digits(PERSON / height);
    let shape = &drawing.shapes[matched.parts[limb].shape].element;
    let place = matched
        .string_of(limb)
        .map_or(shape.span, |string| string.text.whole());
    let message = format!("the figure is {} m tall", two_digits(height));
    let mut finding = Diagnostic::new(Code::UnusualSize, place, message).help(format!(
        "a drawing unit is one centimetre: write `%Scale {scale}` anywhere on the page to make the figure {PERSON} m tall, or `%Scale 1` to keep its size"
    ));
    finding.fixes.extend(fix(drawing, matched, scale));
    diagnostics.push(finding);
}

/// The fix that writes `Scale` into the last `%` string, or into a text of its own beside the last string.
fn fix(drawing: &Drawing, matched: &Matched, scale: f64) -> Option<Fix> {
    let texts = matched.strings.iter().rev();
    let mut texts = texts.filter_map(|string| match string.holder {
        StringHolder::Label(label) => Some((string, label)),
        StringHolder::Shape(_) | StringHolder::Group(_) => None,
    });
    let is_default = |string: &DrawingString| matches!(string.annotation, Annotation::Defaults(_));
    let edit = match texts.clone().find(|(string, _)| is_default(string)) {
        Some((string, _)) => {
            let end = string.text.as_str().trim_end().len();
            Edit {
                span: string.text.span(end..end),
                text: format!(" Scale {scale}"),
            }
        }
        None => {
            let (string, label) = texts.next()?;
            let label = &drawing.labels[label].0;
            let end = string.text.as_str().len();
            let markup = label.as_own_element(end, &format!("%Scale {scale}"))?;
            Edit {
                span: Span::at(label.element.end),
                text: format!("\n{markup}"),
            }
        }
    };
    Some(Fix {
        title: format!("Make the figure {PERSON} m tall"),
        edits: vec![edit],
        safe: true,
    })
}

/// A number with two significant digits.
fn two_digits(number: f64) -> f64 {
    format!("{number:.1e}").parse().unwrap_or(number)
}
