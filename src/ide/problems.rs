//! The problems at an offset, explained for a hover.

use super::Analysis;
use crate::diagnostic::{Code, Severity};
use crate::lang::explain;
use crate::source::Span;

impl Analysis {
    /// The errors and warnings at an offset: the span of the first, and what the manual says about each code in short.
    pub(super) fn problems_at(&self, offset: usize) -> Option<(Span, String)> {
        let here = self.diagnostics().iter().filter(|found| {
            let Span { start, end } = found.span;
            found.code.severity() != Severity::Hint
                && start <= offset
                && offset < end.max(start + 1)
        });
        let mut codes: Vec<(Code, Span)> = vec![];
        for found in here {
            if codes.iter().all(|(code, _)| *code != found.code) {
                codes.push((found.code, found.span));
            }
        }
        let (_, span) = *codes.first()?;
        let pages = codes.iter().map(|(code, _)| explain::code_in_short(*code));
        Some((span, pages.collect::<Vec<_>>().join("\n")))
    }
}
