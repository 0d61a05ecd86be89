//! The last texts of a drawing.

use std::collections::VecDeque;
use std::sync::Arc;

/// How many texts of a drawing are kept: a page may still show an older build when somebody changes something there.
const MAX_TEXTS: usize = 64;
/// How many bytes they may have together, besides the last one.
const MAX_TEXT_BYTES: usize = 16 << 20;

/// The last texts of a drawing, by their revisions.
#[derive(Default)]
pub(super) struct Texts(VecDeque<(u64, Arc<str>)>);

impl Texts {
    /// Keeps the text of a new revision, and lets old ones go.
    pub(super) fn keep(&mut self, revision: u64, text: &Arc<str>) {
        let text = match self.0.back() {
            Some((_, last)) if last == text => last,
            _ => text,
        };
        self.0.push_back((revision, text.clone()));
        let bytes = |texts: &VecDeque<(u64, Arc<str>)>| -> usize {
            texts.iter().map(|(_, text)| text.len()).sum()
        };
        while self.0.len() > MAX_TEXTS || self.0.len() > 1 && bytes(&self.0) > MAX_TEXT_BYTES {
            self.0.pop_front();
        }
    }

    /// The text of a revision; `None` if it is not known any more.
    pub(super) fn of(&self, revision: u64) -> Option<Arc<str>> {
        let known = self.0.iter().find(|(known, _)| *known == revision);
        known.map(|(_, text)| text.clone())
    }
}
