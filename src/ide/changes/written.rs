//! Texts that are written by hand, and what an editor offers about them.

use super::{Analysis, Refusal};
use crate::diagnostic::Edit;
use crate::ide::strings::rewritten;
use crate::source::Text;

impl Analysis {
    /// Writes a text otherwise.
    pub(super) fn write_text(
        &self,
        start: usize,
        was: &str,
        new: &str,
    ) -> Result<Vec<Edit>, Refusal> {
        let text = self.text_that_was(start, was)?;
        if new.trim().is_empty() {
            return Err(Refusal::new(
                "a string is not empty: to be rid of it, delete its text in the drawing",
            ));
        }
        if new.contains(|c: char| c.is_control() && c != '\t') {
            return Err(Refusal::new("a string is one line of text"));
        }
        rewritten(text, new).ok_or_else(|| {
            Refusal::new(
                "a part of this text is an entity of the drawing: change it in the drawing",
            )
        })
    }

    /// Does what was offered at a place of a text.
    pub(super) fn apply(
        &self,
        start: usize,
        was: &str,
        at: usize,
        title: &str,
    ) -> Result<Vec<Edit>, Refusal> {
        let text = self.text_that_was(start, was)?;
        let offered = self.actions_in(text, at).into_iter();
        let mut offered = offered.filter(|action| action.title == title);
        let action = offered.next().ok_or_else(|| {
            Refusal::new(format!(
                "`{title}` is not possible any more: look at the string again"
            ))
        })?;
        Ok(action.edits)
    }

    /// The text that begins at a byte, if it is still the one that a person saw there.
    fn text_that_was(&self, start: usize, was: &str) -> Result<&Text, Refusal> {
        let text = self.text_from(start).filter(|text| text.as_str() == was);
        text.ok_or_else(|| {
            Refusal::new("the drawing has changed since, and this string with it: look at it again")
        })
    }
}
