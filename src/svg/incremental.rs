//! Updates a drawing in place if only the characters of one text changed.

use std::sync::Arc;

use super::{Drawing, Element, Label};
use crate::diagnostic::Diagnostic;
use crate::source::{Change, Span, Text};

/// An edit that only changes the characters of one text: everything else in the drawing stays, or moves as a whole.
#[derive(Debug, Clone, Copy)]
pub(crate) struct TextEdit<'a> {
    change: Change,
    inserted: &'a str,
}

impl<'a> TextEdit<'a> {
    /// The edit that `change`, from the text `old` of `drawing` to `new`, amounts to; `None` if it may be more than an
    /// edit of one text.
    ///
    /// The change must lie in character data that is written as it is read and that became part of a label or a
    /// description. The inserted text must neither be markup nor complete any. Nothing may change that depends on
    /// whether there is a text, on its lines, or on the ids that `prepare` generates.
    pub(crate) fn find(drawing: &Drawing, old: &str, new: &'a str, change: Change) -> Option<Self> {
        let Change {
            start,
            old_end,
            new_end,
        } = change;
        // Text before the root element is in entities, which may be used several times.
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
        // A text is placed by its first characters that are not blank.
        let blank = before.trim().is_empty() || after.trim().is_empty();
        // A line end at the end of a stretch starts no line.
        let ends = before.ends_with('\n') != after.ends_with('\n');
        let has_id = before.contains(ID) || after.contains(ID);
        if blank || ends || has_id {
            return None;
        }
        let edit = Self { change, inserted };
        let labels = drawing.labels.iter().map(|(label, _)| label);
        let can_be_placed = |label: &Label| {
            label.text.plain_around(change).is_none() || {
                let mut text = Text::clone(&label.text);
                text.edit(change, inserted);
                label.frame.place(text.as_str()).is_some()
            }
        };
        labels
            .filter(|label| label.text.reaches(change))
            .all(can_be_placed)
            .then_some(edit)
    }

    /// Edits the drawing's texts, and moves the spans behind the edit.
    pub(crate) fn apply(self, drawing: &mut Drawing) {
        for group in &mut drawing.groups {
            self.apply_to_element(&mut group.element);
        }
        for shape in &mut drawing.shapes {
            self.apply_to_element(&mut shape.element);
        }
        for hidden in &mut drawing.unseen.hidden {
            self.apply_to_element(&mut hidden.element);
            hidden
                .texts
                .iter_mut()
                .for_each(|text| self.apply_to_text(text));
        }
        for converted in &mut drawing.unseen.converted {
            self.apply_to_element(&mut converted.element);
            converted.whole = self.change.moved(converted.whole);
        }
        for copy in &mut drawing.poses.copies {
            let around = copy.around.iter_mut();
            std::iter::once(&mut copy.element)
                .chain(around)
                .for_each(|element| self.apply_to_element(element));
        }
        for posed in &mut drawing.poses.texts {
            self.apply_to_text(&mut posed.text);
        }
        for (label, _) in &mut drawing.labels {
            label.element = self.change.moved(label.element);
            let edited = label.text.plain_around(self.change).is_some();
            self.apply_to_text(&mut label.text);
            if edited && let Some(position) = label.frame.place(label.text.as_str()) {
                label.position = position;
            }
        }
    }

    /// Moves the spans of a diagnostic about the drawing, not about its texts.
    pub(crate) fn apply_to_diagnostic(self, diagnostic: &mut Diagnostic) {
        let move_span = |span: &mut Span| *span = self.change.moved(*span);
        move_span(&mut diagnostic.span);
        for related in &mut diagnostic.related {
            move_span(&mut related.span);
        }
        for edit in diagnostic.fixes.iter_mut().flat_map(|fix| &mut fix.edits) {
            move_span(&mut edit.span);
        }
    }

    fn apply_to_element(self, element: &mut Element) {
        element.span = self.change.moved(element.span);
        if let Some(slot) = &mut element.desc_slot {
            slot.span = self.change.moved(slot.span);
        }
        if let Some(desc) = &mut element.desc {
            self.apply_to_text(desc);
        }
    }

    fn apply_to_text(self, text: &mut Arc<Text>) {
        if text.reaches(self.change) {
            Arc::make_mut(text).edit(self.change, self.inserted);
        }
    }
}

/// What generated ids begin with, after a quote.
const ID: &str = super::prepare::ID_PREFIX;

/// Whether a character is allowed in XML character data and means itself there.
fn is_plain(c: char) -> bool {
    match c {
        '<' | '&' | '\r' => false,
        '\t' | '\n' => true,
        c => c >= ' ' && !matches!(c, '\u{fffe}' | '\u{ffff}'),
    }
}

/// Whether characters on both sides of an edge of the edit form markup, or a line end, together.
fn joins_markup(new: &str, start: usize, new_end: usize) -> bool {
    let bytes = new.as_bytes();
    let from = start.saturating_sub(2);
    let to = (new_end + 2).min(bytes.len());
    let ends_cdata = bytes[from..to].windows(3).any(|signs| signs == b"]]>");
    // XML reads the two characters of such a line end as one.
    let line_end = bytes.get(start.saturating_sub(1)..=start) == Some(b"\r\n".as_slice());
    ends_cdata || line_end
}

fn texts(drawing: &Drawing) -> impl Iterator<Item = &Text> {
    let groups = drawing.groups.iter().map(|group| &group.element);
    let elements = groups.chain(drawing.shapes.iter().map(|shape| &shape.element));
    let descs = elements.filter_map(|element| element.desc.as_deref());
    descs.chain(drawing.labels.iter().map(|(label, _)| &*label.text))
}
