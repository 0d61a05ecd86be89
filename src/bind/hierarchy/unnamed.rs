//! Reports parts that have their name and their parent without a string.

use typed_index_collections::TiSlice;

use super::Context;
use super::names::Names;
use crate::bind::bindings::{NamedBy, PartId};
use crate::diagnostic::{Code, Diagnostic, FEW, listed};

/// Reports parts without a string: all those with automatic names, or all those that labels and ids name.
pub(super) fn report(
    context: Context<'_>,
    names: &Names,
    parents: &TiSlice<PartId, Option<PartId>>,
    by_contact: bool,
    parts: &[PartId],
    diagnostics: &mut Vec<Diagnostic>,
) {
    let Context {
        drawing, matched, ..
    } = context;
    let described = |part: &PartId| drawing.describe(matched.parts[*part].shape);
    let report = |part: PartId, message: String| {
        let element = &drawing.shapes[matched.parts[part].shape].element;
        Diagnostic::new(Code::AutomaticName, element.span, message)
    };
    if parts.len() <= FEW {
        diagnostics.extend(parts.iter().map(|part| {
            let on = parents[*part].map_or(String::new(), |parent| {
                format!(" and is attached to `{}`", names.of(parent))
            });
            let name = names.of(*part);
            let by = match names.of_part[*part].by {
                NamedBy::Label { .. } => " by its label",
                NamedBy::Id { .. } => " by its id",
                NamedBy::String | NamedBy::Automatic => "",
            };
            let message = format!(
                "{} has no string: it is named `{name}`{by}{on}",
                described(part)
            );
            report(*part, message).help("write a name beside it, or `*` to leave it out")
        }));
        return;
    }
    let ends = [parts[0], parts[parts.len() - 1]];
    let [first, last] = ends.map(|part| names.of(part));
    let named = if names.of_part[parts[0]].by == NamedBy::Automatic {
        format!("named `{first}` to `{last}`")
    } else {
        "named by their labels or ids".to_owned()
    };
    let to = if by_contact {
        "to a part that it touches"
    } else {
        "to the nearest named part"
    };
    let message = format!(
        "{} shapes have no string: they are {named}, and each is attached {to}: {}",
        parts.len(),
        listed(parts.iter().map(described))
    );
    diagnostics.push(report(parts[0], message).help(
        "write a name beside each, or `*` to leave it out; `okoshi inspect` lists them all, each with its parent",
    ));
}
