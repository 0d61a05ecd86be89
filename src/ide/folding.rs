//! Folding ranges: the elements of strings.

use super::Analysis;
use crate::bind::StringHolder;
use crate::source::Span;

impl Analysis {
    /// The elements of all strings, in the order of the file.
    pub fn folds(&self) -> Vec<Span> {
        let strings = self.bindings().strings.iter();
        let mut folds: Vec<Span> = strings
            .filter(|string| !string.text.as_str().is_empty())
            .map(|string| match string.holder {
                StringHolder::Label(label) => self.drawing().labels[label].0.element,
                StringHolder::Shape(_) | StringHolder::Group(_) => string.text.whole(),
            })
            .collect();
        folds.sort_unstable();
        folds.dedup();
        folds
    }
}
