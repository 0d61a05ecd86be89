//! The hints about depths that bury parts.

use super::super::FigureContext;
use super::{Buried, Harm};
use crate::bind::PartId;
use crate::diagnostic::{Code, Diagnostic, Fix, listed};
use crate::source::Span;

/// Limit of the places that a hint refers to.
const MAX_RELATED: usize = 3;

/// Adds a hint for each given depth that hides parts, and for each that lets parts float.
pub(in super::super::super) fn report(
    context: &FigureContext<'_>,
    found: Vec<Buried>,
    diagnostics: &mut Vec<Diagnostic>,
) {
    let bindings = context.bindings;
    let placed = found.into_iter().filter_map(|found| {
        let given = bindings.given_depth(found.given)?;
        let floats = matches!(found.harm, Harm::Floats(_));
        Some(((bindings.span_of_depth(&given), floats), found))
    });
    let mut placed: Vec<((Span, bool), Buried)> = placed.collect();
    placed.sort_by_key(|(place, _)| *place);
    let groups = placed.chunk_by(|(a, _), (b, _)| a == b);
    diagnostics.extend(groups.filter_map(|group| {
        let ((span, floats), _) = group[0];
        let mut found: Vec<&Buried> = group.iter().map(|(_, found)| found).collect();
        // The worst first.
        found.sort_by(|a, b| b.harm.amount().total_cmp(&a.harm.amount()));
        hint(context, span, floats, &found)
    }));
}

/// The hint for the depth at `span` that hides these parts or lets them float.
fn hint(
    context: &FigureContext<'_>,
    span: Span,
    floats: bool,
    found: &[&Buried],
) -> Option<Diagnostic> {
    let FigureContext {
        drawing, bindings, ..
    } = context;
    let given = bindings.given_depth(found.first()?.given)?;
    let name = |part: PartId| bindings.describe_as_drawn(drawing, part);
    let mut others: Vec<PartId> = found.iter().map(|found| found.other).collect();
    others.sort_unstable();
    others.dedup();
    let what = listed(found.iter().map(|found| match found.harm {
        Harm::Hidden(share) => format!("{:.0} % of {}", share * 100.0, name(found.part)),
        Harm::Floats(_) => name(found.part),
    }));
    let by = listed(others.iter().map(|other| name(*other)));
    let is_one = found.len() == 1;
    let message = match (floats, is_one) {
        (false, true) => format!("{what} is hidden by {by}, although it is drawn later"),
        (false, false) => format!("{what} are hidden by {by}, although they are drawn later"),
        (true, true) => {
            let gap = found[0].harm.amount();
            format!("{what} floats {gap:.1} in front of {by}, on which it is drawn")
        }
        (true, false) => format!("{what} float in front of {by}, on which they are drawn"),
    };
    let whose = if given.is_in_legend() {
        "parts with this paint lie".to_owned()
    } else {
        format!("{} lies", name(found[0].given))
    };
    let mut hint = Diagnostic::new(Code::Buried, span, message).label(format!(
        "this says how deep {whose}, whatever the order of drawing"
    ));
    let [of_part, of_other] = if floats {
        ["this floats", "it is drawn on this"]
    } else {
        ["this is hidden", "this hides it"]
    };
    let place = |part: PartId| drawing.shapes[bindings.parts[part].shape].element.span;
    let parts = found.iter().map(|found| (found.part, of_part));
    let others = others.into_iter().map(|other| (other, of_other));
    for (part, what) in parts.take(MAX_RELATED).chain(others.take(MAX_RELATED)) {
        hint = hint.related(place(part), what);
    }
    let Some(edits) = bindings.without_depth(&given) else {
        return Some(hint.help("change the depth, or draw in the order in which things lie"));
    };
    hint.fixes.push(Fix {
        title: if given.is_in_legend() {
            "Take the depth out of the legend".to_owned()
        } else {
            format!("Take the depth of {} away", name(found[0].given))
        },
        edits,
        safe: false,
    });
    Some(hint.help(match given.shape {
        Some(_) => "without a depth, a part lies as it is drawn; `%Shape` with depths sets a thickness for all parts",
        None => "without `Offset`, a part lies as it is drawn",
    }))
}
