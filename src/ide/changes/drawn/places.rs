//! Where the places of a text are after edits of it.

use crate::diagnostic::Edit;

/// Places of a text before and after edits. What is cut out whole and put in elsewhere has moved there.
pub(super) struct Places<'a> {
    source: &'a str,
    /// In order.
    edits: &'a [Edit],
}

impl<'a> Places<'a> {
    pub(super) fn new(source: &'a str, edits: &'a [Edit]) -> Self {
        Self { source, edits }
    }

    /// Where a byte is afterwards; `None` if it is gone.
    pub(super) fn after(&self, at: usize) -> Option<usize> {
        let cut = self
            .edits
            .iter()
            .find(|edit| edit.span.start <= at && at < edit.span.end);
        let Some(cut) = cut else {
            return Some(self.shifted(at));
        };
        let text = &self.source[cut.span.start..cut.span.end];
        let put = self.edits.iter().find_map(|edit| {
            let inside = edit.text.find(text)?;
            let is_elsewhere = edit.span != cut.span;
            is_elsewhere.then(|| self.start_of(edit) + inside)
        });
        put.map(|start| start + at - cut.span.start)
    }

    /// Where the new text of an edit begins.
    pub(super) fn start_of(&self, edit: &Edit) -> usize {
        let before = self.edits.iter().take_while(|other| *other != edit);
        before.fold(edit.span.start, |at, other| {
            at + other.text.len() - (other.span.end - other.span.start)
        })
    }

    fn shifted(&self, at: usize) -> usize {
        let before = self.edits.iter().filter(|edit| edit.span.end <= at);
        let (added, removed) = before.fold((0, 0), |(added, removed), edit| {
            (
                added + edit.text.len(),
                removed + edit.span.end - edit.span.start,
            )
        });
        at + added - removed
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::source::Span;

    #[test]
    fn what_is_put_in_elsewhere_has_moved() {
        let edit = |start, end, text: &str| Edit {
            span: Span::new(start, end),
            text: text.to_owned(),
        };
        // `a<b>cd` becomes `axcd<b>`
        let edits = [edit(1, 4, "x"), edit(6, 6, "<b>")];
        let places = Places::new("a<b>cd", &edits);
        assert_eq!(
            [0, 1, 2, 4, 5].map(|at| places.after(at)),
            [Some(0), Some(4), Some(5), Some(2), Some(3)]
        );
        let gone = [edit(1, 4, "")];
        assert_eq!(Places::new("a<b>cd", &gone).after(2), None);
    }
}
