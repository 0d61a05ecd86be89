//! The texts of a drawing by themselves, for an editor that shows nothing else of it: each on one line.

use std::ops::Range;

use super::Analysis;
use super::actions::Action;
use crate::diagnostic::{Diagnostic, Edit};
use crate::source::{Change, Span, Text};

impl Analysis {
    /// The texts that are strings or can become some, in the order of the drawing, each place once. Those of several lines are left out.
    pub(crate) fn texts(&self) -> Vec<&Text> {
        let strings = self.bindings().strings.iter().map(|string| &*string.text);
        let labels = self.drawing().labels.iter().map(|(label, _)| &*label.text);
        let is_line = |text: &&Text| {
            !text.as_str().trim().is_empty() && !text.as_str().contains(['\n', '\r'])
        };
        let mut texts: Vec<&Text> = strings.chain(labels).filter(is_line).collect();
        texts.sort_by_key(|text| text.whole().start);
        texts.dedup_by_key(|text| text.whole().start);
        texts
    }

    /// The text that begins at byte `start`.
    pub(crate) fn text_from(&self, start: usize) -> Option<&Text> {
        let mut texts = self.texts().into_iter();
        texts.find(|text| text.whole().start == start)
    }

    /// What is wrong in a text, and where in its decoded characters.
    pub(crate) fn problems_of<'a>(
        &'a self,
        text: &'a Text,
    ) -> impl Iterator<Item = (Range<usize>, &'a Diagnostic)> {
        let whole = text.whole();
        self.diagnostics().iter().filter_map(move |found| {
            let Span { start, end } = found.span;
            let is_inside = whole.start <= start && end <= whole.end;
            let from = text.offset_of(start).filter(|_| is_inside)?;
            let to = text.offset_of(end).filter(|to| *to >= from)?;
            Some((from..to, found))
        })
    }

    /// What can be done at byte `at` of the decoded characters of a text: fixes, then rewrites.
    pub(crate) fn actions_in(&self, text: &Text, at: usize) -> Vec<Action> {
        self.actions(Span::at(text.span(at..at).start))
    }
}

/// The edits that write `new` in the place of a text, in as few characters as possible. `None` if that would split an entity.
pub(super) fn rewritten(text: &Text, new: &str) -> Option<Vec<Edit>> {
    let Change {
        start,
        old_end,
        new_end,
    } = Change::between(text.as_str(), new);
    let insertion = start == old_end && text.can_replace(start..start);
    if insertion {
        let span = Span::at(text.span(start..start).start);
        let text = text.escape_at(start, &new[start..new_end]);
        return Some(vec![Edit { span, text }]);
    }
    let written = Edit::replacing(text, start..old_end, &new[start..new_end]);
    written.or_else(|| Edit::replacing(text, 0..text.as_str().len(), new))
}
