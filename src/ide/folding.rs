//! Folding ranges: the elements of strings.

use super::Analysis;
use crate::bind::Place;
use crate::source::Span;

impl Analysis {
    /// The elements of all strings, in the order of the file.
    pub fn folds(&self) -> Vec<Span> {
        let strings = self.bindings().strings.iter();
        let mut folds: Vec<Span> = strings
            .filter(|string| !string.text.as_str().is_empty())
            .map(|string| match string.place {
                Place::Label(label) => self.drawing().labels[label].0.element,
                Place::Shape(_) | Place::Group(_) => string.text.whole(),
            })
            .collect();
        folds.sort_unstable();
        folds.dedup();
        folds
    }
}
