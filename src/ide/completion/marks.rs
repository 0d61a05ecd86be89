//! The marks that `Perform` can name.

use super::choice::{Choice, choose};
use super::{Cursor, Proposal, ProposalKind, simple};
use crate::lang::quoting::{NamePlace, quoted_if_needed};

impl Cursor<'_> {
    /// The words of the drawing's marks, of which `word` is typed, each with the part that it performs.
    pub(super) fn marks(&self, word: &str) -> Choice<Proposal> {
        let bindings = self.context.analysis.bindings();
        let mut marks: Vec<(&str, &str)> = Vec::new();
        for (index, part) in bindings.parts.iter_enumerated() {
            if let Some(mark) = bindings.mark(index).filter(|_| !part.name.is_empty())
                && !marks.iter().any(|(known, _)| *known == mark.word)
            {
                marks.push((mark.word, &part.name));
            }
        }
        choose(marks, |(mark, _)| mark, word).map(|(mark, part)| Proposal {
            text: self.escape(&quoted_if_needed(mark, NamePlace::Argument)),
            ..simple(mark, ProposalKind::Color, &format!("the mark of {part}"))
        })
    }
}
