//! Which proposals are listed if there are too many.

use crate::ide::letters::{begins_with, has_letters};

/// How many parts, joints, variables or files are listed. An editor filters and sorts the list at every keystroke, so
/// thousands are slow to send and to show.
pub(super) const MAX_LISTED: usize = 500;

/// What is listed.
#[derive(Debug)]
pub(super) struct Choice<T> {
    pub items: Vec<T>,
    /// Whether others are not listed because there are too many.
    pub is_cut: bool,
}

impl<T> Choice<T> {
    /// The same choice of other items.
    pub(super) fn map<U>(self, change: impl FnMut(T) -> U) -> Choice<U> {
        Choice {
            items: self.items.into_iter().map(change).collect(),
            is_cut: self.is_cut,
        }
    }

    /// Appends another choice.
    pub(super) fn extend(&mut self, other: Self) {
        self.items.extend(other.items);
        self.is_cut |= other.is_cut;
    }
}

impl<T> Default for Choice<T> {
    fn default() -> Self {
        Vec::new().into()
    }
}

impl<T> From<Vec<T>> for Choice<T> {
    fn from(items: Vec<T>) -> Self {
        Self {
            items,
            is_cut: false,
        }
    }
}

impl<T> FromIterator<T> for Choice<T> {
    fn from_iter<I: IntoIterator<Item = T>>(items: I) -> Self {
        Vec::from_iter(items).into()
    }
}

/// All candidates if they are at most [`MAX_LISTED`], since editors filter by rules of their own. Otherwise as many of
/// those that begin with `word`, the typed part of a name with or without its quote, and then of those that have its
/// letters in the same order, which is what editors look for.
pub(super) fn choose<T>(candidates: Vec<T>, name: impl Fn(&T) -> &str, word: &str) -> Choice<T> {
    if candidates.len() <= MAX_LISTED {
        return candidates.into();
    }
    let word = word.trim_start_matches(['"', '＂']);
    let (mut items, mut others) = (vec![], vec![]);
    for candidate in candidates {
        let fitting = if begins_with(name(&candidate), word) {
            &mut items
        } else if has_letters(name(&candidate), word) {
            &mut others
        } else {
            continue;
        };
        if fitting.len() < MAX_LISTED {
            fitting.push(candidate);
        }
    }
    others.truncate(MAX_LISTED - items.len());
    items.append(&mut others);
    Choice {
        items,
        is_cut: true,
    }
}
