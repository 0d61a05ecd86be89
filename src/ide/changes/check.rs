//! Whether a change did what it says, and nothing else.

use super::{Analysis, Change, Place, Refusal, drawn, unnamed};
use crate::bind::{Part, PartId, PartKind};
use crate::diagnostic::Severity;
use crate::lang::keyword::Keyword;
use crate::svg::ShapeId;

/// Compares a drawing before and after a change was made. A text that grows may come to mean another part, a first string changes
/// what is built by rule, and an attribute may be wrong only beside others: then the change is refused.
///
/// Nobody has said what parts without a string hang on: that is found by rule, from names and from what touches what. A name, or a
/// parent that is said, may therefore hang others elsewhere; then the answer says so, as a sentence without a full stop.
///
/// # Errors
/// If there are new errors, or something else has changed.
pub fn check(
    before: &Analysis,
    after: &Analysis,
    change: &Change,
) -> Result<Option<String>, Refusal> {
    if matches!(change, Change::Write { .. } | Change::Apply { .. }) {
        // What is typed is wrong until it is whole; that other strings stay as they are is in the nature of the edits.
        return is_readable(before, after).map(|()| None);
    }
    if change.is_drawn() {
        return drawn::check(before, after, change);
    }
    no_worse(before, after)?;
    if *change == Change::NameParts {
        // All that has no name may come to hang elsewhere, and pairs of limbs in one shape become two parts.
        return if unnamed::keeps_names(before, after) {
            Ok(None)
        } else {
            Err(Refusal::new(
                "parts that have names would be called otherwise",
            ))
        };
    }
    let (old, new) = (&before.bindings().parts, &after.bindings().parts);
    if old.len() != new.len() && is_first_shape(before, change) {
        // The person agreed to that.
        return Ok(None);
    }
    if old.len() != new.len() {
        return Err(Refusal::new(
            "other shapes of the drawing would become parts, or no longer be: change it in the drawing",
        ));
    }
    let mut moved = vec![];
    for part in old.keys() {
        let hangs_elsewhere = parent_of(before, &old[part]) != parent_of(after, &new[part]);
        if hangs_elsewhere && is_hung_by_rule(&old[part], &new[part], change) {
            moved.push(part);
        }
        let difference = compare(before, after, part, change);
        if let Some(what) = difference {
            let name = before.bindings().describe(before.drawing(), part);
            return Err(Refusal::new(format!("{what} of {name} would change, too")));
        }
    }
    if let Change::Clip { motion, .. } = change
        && !after.has_all_other_clips(before, motion.is_some())
    {
        return Err(Refusal::new("another clip would change, too"));
    }
    Ok(match moved.as_slice() {
        [] => None,
        [one] => Some(format!(
            "{} hangs elsewhere now, because nobody has said on what",
            after.bindings().describe(after.drawing(), *one)
        )),
        many => Some(format!(
            "{} parts hang elsewhere now, because nobody has said on what",
            many.len()
        )),
    })
}

/// Whether a drawing gets its first `Shape`, after a person was told what that means for all others.
fn is_first_shape(before: &Analysis, change: &Change) -> bool {
    let is_agreed = matches!(
        change,
        Change::Set {
            attribute: Keyword::Shape,
            place: Place::Own,
            ..
        }
    );
    is_agreed && before.bindings().is_first_look
}

/// Whether a part has its parent by rule, and a change is one that such parents follow from.
fn is_hung_by_rule(old: &Part, new: &Part, change: &Change) -> bool {
    let by_rule = |part: &Part| part.string.is_none();
    let is_followed = match change {
        Change::Name { .. } => true,
        Change::Hang { part, .. } => *part != old.name,
        _ => false,
    };
    is_followed && by_rule(old) && by_rule(new)
}

/// The parent of a part, and its shape. A circle has no meaning to keep.
fn parent_of(analysis: &Analysis, part: &Part) -> Option<(PartId, ShapeId)> {
    let parent = part.parent?;
    Some((parent, analysis.bindings().parts[parent].shape))
}

/// Whether a drawing can be read, and has no error that it did not have before.
///
/// # Errors
/// If it has one.
pub(crate) fn no_worse(before: &Analysis, after: &Analysis) -> Result<(), Refusal> {
    is_readable(before, after)?;
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
    Ok(())
}

/// Whether a drawing can still be read.
fn is_readable(before: &Analysis, after: &Analysis) -> Result<(), Refusal> {
    if before.is_sound() && !after.is_sound() {
        return Err(Refusal::new("the drawing could not be read any more"));
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
    let hung = match change {
        Change::Hang { part, parent } if is_it(part) => {
            let found = new
                .parent
                .map(|parent| after.bindings().parts[parent].name.clone());
            return (found != *parent).then_some("the parent");
        }
        _ => parent_of(before, old) == parent_of(after, new) || is_hung_by_rule(old, new, change),
    };
    if !hung {
        return Some("the parent");
    }
    let set = changed_keyword(before, old, change);
    let is_renamed = matches!(change, Change::Name { .. });
    let values = |analysis: &Analysis| {
        let resolved = analysis.bindings().resolved(analysis.drawing(), index);
        let others = resolved.into_iter().filter(|one| Some(one.keyword) != set);
        let others = others.filter(|one| !depends(one.keyword, change));
        // What nobody has said may follow from names.
        let others = others.filter(|one| one.string.is_some() || !is_renamed);
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
        Change::Clip { .. } => keyword == Keyword::Motion,
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
