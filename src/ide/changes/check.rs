//! Whether a change did what it says, and nothing else.

use super::{Analysis, Change, Place, Refusal};
use crate::bind::{Part, PartId, PartKind};
use crate::diagnostic::Severity;
use crate::lang::keyword::Keyword;

/// Compares a drawing before and after a change was made. A text that grows may come to mean another part, a first string changes
/// what is built by rule, and an attribute may be wrong only beside others: then the change is refused.
///
/// # Errors
/// If there are new errors, or something else has changed.
pub fn check(before: &Analysis, after: &Analysis, change: &Change) -> Result<(), Refusal> {
    let errors = |analysis: &Analysis| -> Vec<String> {
        let found = analysis.diagnostics().iter();
        let errors = found.filter(|found| found.severity() == Severity::Error);
        errors.map(|found| found.message.clone()).collect()
    };
    let (old, new) = (errors(before), errors(after));
    if let Some(error) = new.iter().find(|error| !old.contains(error)) {
        return Err(Refusal::new(format!("that would be an error: {error}")));
    }
    if new.len() > old.len() {
        return Err(Refusal::new("there would be one more error"));
    }
    let (old, new) = (&before.bindings().parts, &after.bindings().parts);
    if old.len() != new.len() {
        return Err(Refusal::new(
            "other shapes of the drawing would become parts, or no longer be: change it in the drawing",
        ));
    }
    for part in old.keys() {
        let difference = compare(before, after, part, change);
        if let Some(what) = difference {
            let name = before.bindings().describe(before.drawing(), part);
            return Err(Refusal::new(format!("{what} of {name} would change, too")));
        }
    }
    Ok(())
}

/// What has changed about a part that should not have.
fn compare(
    before: &Analysis,
    after: &Analysis,
    index: PartId,
    change: &Change,
) -> Option<&'static str> {
    let (old, new) = (
        &before.bindings().parts[index],
        &after.bindings().parts[index],
    );
    let is_it = |name: &str| old.name == name && !name.is_empty();
    if matches!(change, Change::LeaveOut { part } if is_it(part)) {
        return (new.kind != PartKind::Unused).then_some("the kind");
    }
    if old.kind != new.kind {
        return Some("the kind");
    }
    if !is_called_so(old, new, change) {
        return Some("the name");
    }
    let parent = |analysis: &Analysis, part: &Part| {
        // A circle has no meaning to keep.
        part.parent
            .map(|parent| (parent, analysis.bindings().parts[parent].shape))
    };
    let hung = match change {
        Change::Hang { part, parent } if is_it(part) => {
            let found = new
                .parent
                .map(|parent| after.bindings().parts[parent].name.clone());
            return (found != *parent).then_some("the parent");
        }
        _ => parent(before, old) == parent(after, new),
    };
    if !hung {
        return Some("the parent");
    }
    let set = changed_keyword(before, old, change);
    let values = |analysis: &Analysis| {
        let resolved = analysis.bindings().resolved(analysis.drawing(), index);
        let others = resolved.into_iter().filter(|one| Some(one.keyword) != set);
        let others = others.filter(|one| !depends(one.keyword, change));
        let all: Vec<_> = others
            .map(|one| (one.keyword, one.value, one.from))
            .collect();
        all
    };
    let has_form = |analysis: &Analysis| analysis.bindings().form(index);
    if has_form(before) == has_form(after) && values(before) != values(after) {
        return Some("another attribute");
    }
    None
}

/// Whether a part has the name that it should have.
fn is_called_so(old: &Part, new: &Part, change: &Change) -> bool {
    match change {
        Change::Name { part, name } if old.name == *part && old.kind == PartKind::Main => {
            crate::lang::quoting::read_name(name).as_deref() == Some(new.name.as_str())
        }
        // Automatic names are numbers in the order of the file.
        _ => old.name == new.name || old.is_automatic() && new.is_automatic(),
    }
}

/// The attribute of a part that a change is about.
fn changed_keyword(before: &Analysis, old: &Part, change: &Change) -> Option<Keyword> {
    let (Change::Set {
        part,
        attribute,
        place,
        ..
    }
    | Change::Reset {
        part,
        attribute,
        place,
    }) = change
    else {
        return None;
    };
    let changed = before.part_to_change(part).ok()?;
    let changed = &before.bindings().parts[changed];
    let by_legend = *place == Place::Legend || changed.kind == PartKind::Legend;
    let shares = by_legend && old.legend.is_some() && old.legend == changed.legend;
    let shares = shares || by_legend && old.kind == PartKind::Legend;
    (old.shape == changed.shape && old.is_stroke == changed.is_stroke || shares)
        .then_some(*attribute)
}

/// Whether an attribute may change with a variable, or with what a person agreed to.
fn depends(keyword: Keyword, change: &Change) -> bool {
    match change {
        Change::Variable { .. } => true,
        Change::Set {
            attribute: Keyword::Shape,
            place: Place::Own,
            ..
        }
        | Change::Reset {
            attribute: Keyword::Shape,
            place: Place::Own,
            ..
        } => keyword == Keyword::Shape,
        _ => false,
    }
}
