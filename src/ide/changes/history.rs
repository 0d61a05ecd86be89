//! Undo and redo: edits of a text, applied to the text as it is now.

use std::sync::Arc;

use rustc_hash::FxHashMap;

use super::Change;
use crate::diagnostic::{Edit, applied};
use crate::source::{Change as Stretch, Span};

/// How many bytes of texts a history keeps; the oldest steps are forgotten first.
const MAX_BYTES: usize = 64 << 20;
/// How many steps it keeps.
const MAX_STEPS: usize = 1000;

/// A change that was made, with what undoes it.
#[derive(Debug, Clone)]
pub struct Step {
    /// The change.
    pub change: Change,
    /// The text after it.
    after: Arc<str>,
    /// The edits of that text that undo it.
    inverse: Vec<Edit>,
}

impl Step {
    /// The step of a change that made these edits of a text, and the text after it.
    pub fn new(change: Change, before: &str, edits: &[Edit]) -> Self {
        let mut inverse = Vec::with_capacity(edits.len());
        let (mut added, mut removed) = (0, 0);
        for edit in edits {
            let start = edit.span.start + added - removed;
            inverse.push(Edit {
                span: Span::new(start, start + edit.text.len()),
                text: before[edit.span.start..edit.span.end].to_owned(),
            });
            added += edit.text.len();
            removed += edit.span.end - edit.span.start;
        }
        Self {
            change,
            after: applied(before, edits).into(),
            inverse,
        }
    }

    /// The text after the change.
    pub fn after(&self) -> &Arc<str> {
        &self.after
    }

    /// The edits that undo the change in a text as it is now; `None` if something has changed there since.
    pub fn undone(&self, now: &str) -> Option<Vec<Edit>> {
        rebased(&self.inverse, &self.after, now)
    }
}

/// The steps that can be undone and redone.
#[derive(Debug, Default)]
pub struct History {
    done: Vec<Step>,
    undone: Vec<Step>,
}

impl History {
    /// Adds a change that a person made: what was undone before cannot be redone any more.
    pub fn add(&mut self, step: Step) {
        self.undone.clear();
        self.done.push(step);
        let bytes = |steps: &[Step]| steps.iter().map(|step| step.after.len()).sum::<usize>();
        while self.done.len() > MAX_STEPS || self.done.len() > 1 && bytes(&self.done) > MAX_BYTES {
            self.done.remove(0);
        }
    }

    /// Makes the last step one with what was done after it, up to this text of the drawing.
    pub fn go_on(&mut self, change: Change, now: &str) {
        let Some(last) = self.done.pop() else { return };
        self.undone.clear();
        let before = applied(&last.after, &last.inverse);
        let stretch = Stretch::between(&before, now);
        if stretch.is_empty() {
            return;
        }
        let edit = Edit {
            span: Span::new(stretch.start, stretch.old_end),
            text: now[stretch.start..stretch.new_end].to_owned(),
        };
        self.add(Step::new(change, &before, &[edit]));
    }

    /// The step that would be undone next.
    pub fn last(&self) -> Option<&Step> {
        self.done.last()
    }

    /// The step that would be redone next: what it undoes is that the change was undone.
    pub fn next(&self) -> Option<&Step> {
        self.undone.last()
    }

    /// Forgets the last step, because what it changed was changed elsewhere since.
    pub fn forget_last(&mut self) {
        self.done.pop();
    }

    /// Forgets the step that would be redone next, for the same reason.
    pub fn forget_next(&mut self) {
        self.undone.pop();
    }

    /// Moves the last step to those that can be redone, after these edits of a text have undone it.
    pub fn undo(&mut self, now: &str, edits: &[Edit]) {
        if let Some(step) = self.done.pop() {
            self.undone.push(Step::new(step.change, now, edits));
        }
    }

    /// The other way round.
    pub fn redo(&mut self, now: &str, edits: &[Edit]) {
        if let Some(step) = self.undone.pop() {
            self.done.push(Step::new(step.change, now, edits));
        }
    }
}

/// A stretch that two texts have in common.
#[derive(Debug, Clone, Copy)]
struct Common {
    from: usize,
    to: usize,
    len: usize,
}

/// Edits of one text as edits of another one, which was made of it by changes elsewhere. `None` if they are not all in stretches that
/// both have in common, with a character on each side that is the same.
pub fn rebased(edits: &[Edit], from: &str, to: &str) -> Option<Vec<Edit>> {
    if from == to {
        return Some(edits.to_vec());
    }
    let stretches = common(from, to);
    let moved = edits.iter().map(|edit| {
        let Span { start, end } = edit.span;
        let inside = |one: &&Common| {
            (one.from < start || start == 0 && one.to == 0)
                && (end < one.from + one.len
                    || end == from.len()
                        && one.to + one.len == to.len()
                        && one.from + one.len == end)
        };
        let one = stretches.iter().find(inside)?;
        Some(Edit {
            span: Span::new(start - one.from + one.to, end - one.from + one.to),
            text: edit.text.clone(),
        })
    });
    moved.collect()
}

/// The stretches that two texts have in common, in order: their beginnings, their ends, and between them the tags that are in both
/// once.
fn common(from: &str, to: &str) -> Vec<Common> {
    let equal = |(one, other): &(u8, u8)| one == other;
    let head = from.bytes().zip(to.bytes()).take_while(equal).count();
    let head = (0..=head)
        .rev()
        .find(|at| from.is_char_boundary(*at) && to.is_char_boundary(*at))
        .unwrap_or(0);
    let most = from.len().min(to.len()) - head;
    let tail = from.bytes().rev().zip(to.bytes().rev()).take(most);
    let tail = tail.take_while(equal).count();
    let tail = (0..=tail)
        .rev()
        .find(|tail| {
            from.is_char_boundary(from.len() - tail) && to.is_char_boundary(to.len() - tail)
        })
        .unwrap_or(0);
    let mut found = vec![Common {
        from: 0,
        to: 0,
        len: head,
    }];
    let between = (&from[head..from.len() - tail], &to[head..to.len() - tail]);
    for (old, new, len) in anchors(between.0, between.1) {
        found.push(Common {
            from: head + old,
            to: head + new,
            len,
        });
    }
    found.push(Common {
        from: from.len() - tail,
        to: to.len() - tail,
        len: tail,
    });
    let mut joined: Vec<Common> = vec![];
    for one in found {
        match joined.last_mut() {
            Some(last) if last.from + last.len == one.from && last.to + last.len == one.to => {
                last.len += one.len;
            }
            _ => joined.push(one),
        }
    }
    joined
}

/// The tags, with the text behind each, that are in both texts once and in the same order: their places and lengths.
fn anchors(from: &str, to: &str) -> Vec<(usize, usize, usize)> {
    let once = |text: &'_ str| {
        let mut places: FxHashMap<String, Option<usize>> = FxHashMap::default();
        for (at, tag) in tags(text) {
            let place = places.entry(tag.to_owned()).or_insert(Some(at));
            if *place != Some(at) {
                *place = None;
            }
        }
        places
    };
    let old = once(from);
    let pairs = tags(to).filter_map(|(at, tag)| Some(((*old.get(tag)?)?, at, tag.len())));
    let new = once(to);
    let pairs: Vec<_> = pairs
        .filter(|(_, at, len)| new.get(&to[*at..at + len]).copied().flatten() == Some(*at))
        .collect();
    increasing(&pairs)
}

/// The pieces of a text that begin with `<`, each with its place.
fn tags(text: &str) -> impl Iterator<Item = (usize, &str)> {
    let mut at = 0;
    std::iter::from_fn(move || {
        let rest = text.get(at..).filter(|rest| !rest.is_empty())?;
        let first = rest.chars().next().map_or(0, char::len_utf8);
        let len = rest[first..]
            .find('<')
            .map_or(rest.len(), |next| first + next);
        let start = at;
        at += len;
        Some((start, &rest[..len]))
    })
}

/// The longest list of pairs whose first numbers ascend; the second ones do already.
fn increasing(pairs: &[(usize, usize, usize)]) -> Vec<(usize, usize, usize)> {
    let mut tops: Vec<usize> = vec![];
    let mut before: Vec<Option<usize>> = vec![None; pairs.len()];
    for (index, pair) in pairs.iter().enumerate() {
        let place = tops.partition_point(|top| pairs[*top].0 < pair.0);
        before[index] = place.checked_sub(1).map(|last| tops[last]);
        if place == tops.len() {
            tops.push(index);
        } else {
            tops[place] = index;
        }
    }
    let chain = std::iter::successors(tops.last().copied(), |index| before[*index]);
    let mut found: Vec<_> = chain.map(|index| pairs[index]).collect();
    found.reverse();
    found
}
