//! The problems at an offset, explained for a hover.

use super::Analysis;
use crate::diagnostic::{Diagnostic, Severity};
use crate::lang::explain;
use crate::source::Span;

impl Analysis {
    /// The errors and warnings at an offset: the span of the first, and what each code means and what to do here, in short.
    pub(super) fn problems_at(&self, offset: usize) -> Option<(Span, String)> {
        let here = self.diagnostics().iter().filter(|found| {
            let Span { start, end } = found.span;
            found.code.severity() != Severity::Hint
                && start <= offset
                && offset < end.max(start + 1)
        });
        let mut first: Vec<&Diagnostic> = vec![];
        for found in here {
            if first.iter().all(|known| known.code != found.code) {
                first.push(found);
            }
        }
        let span = first.first()?.span;
        let pages = first.iter().map(|found| {
            let fixes = found.fixes.iter().map(|fix| fix.title.as_str());
            let fixes = fixes.collect::<Vec<_>>().join(", or ");
            let advice = Some(fixes.as_str()).filter(|fixes| !fixes.is_empty());
            explain::code_in_short(found.code, advice.or(found.help.as_deref()))
        });
        Some((span, pages.collect::<Vec<_>>().join("\n")))
    }
}
