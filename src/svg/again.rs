//! A drawing in which nothing changed but the characters of one text.

use std::sync::Arc;

use super::{Drawing, Element, Label};
use crate::diagnostic::Diagnostic;
use crate::source::{Change, Span, Text};

/// A change that lies in the characters of texts alone: whatever else the drawing holds stays as it is, further
/// ahead or back in the file.
#[derive(Debug, Clone, Copy)]
pub struct Retyped<'a> {
    change: Change,
    inserted: &'a str,
}

impl<'a> Retyped<'a> {
    /// Looks whether `change`, which leads from the text `old` of `drawing` to `new`, is such a change.
    ///
    /// It must lie in character data that is written as it is read and was read into labels or descriptions. What
    /// is put in must not be markup or begin it; whatever depends on there being a text, on its lines or on the
    /// ids that `prepare` makes up must not change.
    pub fn find(drawing: &Drawing, old: &str, new: &'a str, change: Change) -> Option<Self> {
        let Change {
            start,
            old_end,
            new_end,
        } = change;
        // In front of the root element, texts stand in entities, which may be used several times.
        if start <= drawing.groups.first()?.element.span.start {
            return None;
        }
        let inserted = &new[start..new_end];
        if !inserted.chars().all(is_plain) || joins_markup(new, start, new_end) {
            return None;
        }
        let mut around: Option<Span> = None;
        for text in texts(drawing).filter(|text| text.reaches(change)) {
            let Some(found) = text.plain_around(change) else {
                continue;
            };
            if around.is_some_and(|around| around != found) {
                return None;
            }
            around = Some(found);
        }
        let around = around?;
        let before = &old[around.start..around.end];
        let after = &new[around.start..around.end - old_end + new_end];
        // A text's place is that of its first characters that are not blank.
        let blank = before.trim().is_empty() || after.trim().is_empty();
        // No line begins behind a line's end.
        let ends = before.ends_with('\n') != after.ends_with('\n');
        let like_ids = before.contains(ID) || after.contains(ID);
        if blank || ends || like_ids {
            return None;
        }
        let retyped = Self { change, inserted };
        let labels = drawing.labels.iter().map(|(label, _)| label);
        let has_place = |label: &Label| {
            label.text.plain_around(change).is_none() || {
                let mut text = Text::clone(&label.text);
                text.retype(change, inserted);
                label.frame.place(text.as_str()).is_some()
            }
        };
        labels
            .filter(|label| label.text.reaches(change))
            .all(has_place)
            .then_some(retyped)
    }

    /// Makes the change in a drawing.
    pub fn apply(self, drawing: &mut Drawing) {
        for group in &mut drawing.groups {
            self.element(&mut group.element);
        }
        for shape in &mut drawing.shapes {
            self.element(&mut shape.element);
        }
        for (label, _) in &mut drawing.labels {
            label.element = self.change.moved(label.element);
            let edited = label.text.plain_around(self.change).is_some();
            self.text(&mut label.text);
            if edited && let Some((corner, bounds)) = label.frame.place(label.text.as_str()) {
                (label.corner, label.bounds) = (corner, bounds);
            }
        }
    }

    /// Moves a finding that tells of the drawing and not of its texts.
    pub fn apply_to_finding(self, diagnostic: &mut Diagnostic) {
        let move_span = |span: &mut Span| *span = self.change.moved(*span);
        move_span(&mut diagnostic.span);
        for related in &mut diagnostic.related {
            move_span(&mut related.span);
        }
        for edit in diagnostic.fixes.iter_mut().flat_map(|fix| &mut fix.edits) {
            move_span(&mut edit.span);
        }
    }

    fn element(self, element: &mut Element) {
        element.span = self.change.moved(element.span);
        if let Some(desc) = &mut element.desc {
            self.text(desc);
        }
    }

    fn text(self, text: &mut Arc<Text>) {
        if text.reaches(self.change) {
            Arc::make_mut(text).retype(self.change, self.inserted);
        }
    }
}

/// What ids that are made up begin with, behind a quote.
const ID: &str = super::prepare::ID_PREFIX;

/// Whether a character may stand in an XML text and stands for nothing but itself there.
fn is_plain(c: char) -> bool {
    match c {
        '<' | '&' | '\r' => false,
        '\t' | '\n' => true,
        c => c >= ' ' && !matches!(c, '\u{fffe}' | '\u{ffff}'),
    }
}

/// Whether the borders of what was put in, or of what was taken away, make signs that mean something together.
fn joins_markup(new: &str, start: usize, new_end: usize) -> bool {
    let bytes = new.as_bytes();
    let from = start.saturating_sub(2);
    let to = (new_end + 2).min(bytes.len());
    let ends_cdata = bytes[from..to].windows(3).any(|signs| signs == b"]]>");
    // A line end of two characters is read as one.
    let line_end = bytes.get(start.saturating_sub(1)..=start) == Some(b"\r\n".as_slice());
    ends_cdata || line_end
}

/// All texts of a drawing.
fn texts(drawing: &Drawing) -> impl Iterator<Item = &Text> {
    let groups = drawing.groups.iter().map(|group| &group.element);
    let elements = groups.chain(drawing.shapes.iter().map(|shape| &shape.element));
    let descs = elements.filter_map(|element| element.desc.as_deref());
    descs.chain(drawing.labels.iter().map(|(label, _)| &*label.text))
}
