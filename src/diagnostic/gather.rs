//! Findings of one kind: a few are reported one by one, many as one.

use super::{Diagnostic, Fix};

/// The most findings of one kind that are reported one by one.
pub(crate) const FEW: usize = 3;

/// Reports findings of one kind: as one with the given message if there are many, at the place of the first and with the
/// fixes of all.
pub(crate) fn few_or_one(
    findings: Vec<Diagnostic>,
    message: impl FnOnce(usize) -> String,
    diagnostics: &mut Vec<Diagnostic>,
) {
    let count = findings.len();
    if count <= FEW {
        diagnostics.extend(findings);
        return;
    }
    let mut findings = findings.into_iter();
    let Some(mut one) = findings.next() else {
        return;
    };
    one.message = message(count);
    for other in findings {
        for fix in other.fixes {
            let same = one.fixes.iter_mut().find(|own| own.title == fix.title);
            match same {
                Some(own) => own.edits.extend(fix.edits),
                None => one.fixes.push(fix),
            }
        }
    }
    let each = |fix: &mut Fix| fix.title.push_str(", everywhere");
    one.fixes.iter_mut().for_each(each);
    diagnostics.push(one);
}
