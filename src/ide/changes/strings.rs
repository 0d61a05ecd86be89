//! Rewrites pieces of a string, and nothing else of it.

use std::ops::Range;

use super::{Analysis, Refusal};
use crate::bind::{DrawingString, StringHolder, StringId};
use crate::diagnostic::{Edit, Severity};
use crate::lang::ast::{Annotation, Part};
use crate::lang::keyword::Keyword;
use crate::lang::{Container, parse, settings, strings_in};
use crate::source::{Span, Text};

/// A piece of a string, in decoded bytes, and what takes its place.
pub(super) type Piece = (Range<usize>, String);

/// What a rewrite may change about a string; the rest must be read as before.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Means {
    /// One attribute.
    Attribute(Keyword),
    /// The clips.
    Clips,
    /// The parent.
    Parent,
    /// All of it.
    Everything,
}

impl Analysis {
    /// The edits that replace pieces of a string, which are in order.
    ///
    /// # Errors
    /// If more of the string would be read in another way, if the new pieces have mistakes, or if they are not written where they
    /// are read: an entity expands to several characters, and a clone shares the text of its original.
    pub(super) fn rewritten(
        &self,
        index: StringId,
        pieces: &[Piece],
        means: Means,
    ) -> Result<Vec<Edit>, Refusal> {
        let string = &self.bindings().strings[index];
        let old = string.text.as_str();
        let whole = string.text.whole();
        let twins = self.bindings().strings.iter();
        if twins.filter(|other| other.text.whole() == whole).count() > 1 {
            return Err(Refusal::new(format!(
                "clones share the string `{}`: give this one a description of its own in the drawing",
                old.trim()
            )));
        }
        let mut new = String::new();
        let mut at = 0;
        let mut edits = vec![];
        for (range, piece) in pieces {
            writable(piece)?;
            edits.extend(replacement(&string.text, range.clone(), piece).ok_or_else(|| {
                Refusal::new(format!(
                    "an XML entity stands for a part of `{}`: replace the entity by its text first",
                    old.trim()
                ))
            })?);
            new += &old[at..range.start];
            new += piece;
            at = range.end;
        }
        new += &old[at..];
        if strings_in(old).len() > 1 || strings_in(&new).len() > 1 {
            return Err(Refusal::new(format!(
                "the text `{}` seems to hold several strings: give each a text of its own first",
                old.trim()
            )));
        }
        self.compare(string, &new, means)?;
        Ok(edits)
    }

    /// Refuses a new wording of a string that changes more than it should.
    fn compare(&self, string: &DrawingString, new: &str, means: Means) -> Result<(), Refusal> {
        let container = match string.holder {
            StringHolder::Label(_) => Container::Text,
            StringHolder::Shape(_) | StringHolder::Group(_) => Container::Desc,
        };
        let read = |text: &str| {
            let text = Text::plain(text, 0);
            let (annotation, mut found) = parse(&text, container);
            let settings = settings(&text, &annotation, &self.bindings().variables, &mut found);
            found.retain(|found| found.severity() != Severity::Hint);
            (annotation, settings, found)
        };
        let (before, old_settings, old_found) = read(string.text.as_str());
        let (after, new_settings, new_found) = read(new);
        let known = |message: &str| old_found.iter().any(|found| found.message == message);
        if let Some(found) = new_found.iter().find(|found| !known(&found.message)) {
            return Err(Refusal::new(found.message.clone()));
        }
        let others = |annotation: &Annotation, settings: &[crate::lang::value::Setting]| {
            let is_meant = |keyword: Keyword| match means {
                Means::Attribute(attribute) => keyword == attribute,
                Means::Clips => keyword == Keyword::Motion,
                Means::Parent | Means::Everything => false,
            };
            let kept: Vec<_> = settings
                .iter()
                .filter(|setting| !is_meant(setting.keyword))
                .map(|setting| (setting.keyword, setting.text.clone()))
                .collect();
            let head = match annotation {
                Annotation::Part(Part { name, parent, .. }) => {
                    let text = |name: &Option<crate::lang::ast::Name>| {
                        name.as_ref().map(|name| name.text.clone())
                    };
                    let parent = text(parent).filter(|_| means != Means::Parent);
                    Some((text(name), parent))
                }
                _ => None,
            };
            (std::mem::discriminant(annotation), head, kept)
        };
        if means != Means::Everything
            && others(&before, &old_settings) != others(&after, &new_settings)
        {
            return Err(Refusal::new(format!(
                "`{}` would be read as something else with that: change it in the drawing",
                string.text.as_str().trim()
            )));
        }
        Ok(())
    }
}

/// Refuses what cannot be in a string.
pub(super) fn writable(text: &str) -> Result<(), Refusal> {
    let is_bad = |c: char| c.is_control() || matches!(c, '\u{fffe}' | '\u{ffff}');
    if text.contains(is_bad) {
        return Err(Refusal::new(
            "a string has no line ends and no control characters in it",
        ));
    }
    Ok(())
}

/// The edits that replace decoded characters of a text by others. What is inserted stands directly behind the character before it,
/// so that it is in the same element. `None` if that is not possible.
fn replacement(text: &Text, range: Range<usize>, new: &str) -> Option<Vec<Edit>> {
    if !range.is_empty() {
        if ends_section(text, range.start, new) {
            return None;
        }
        return Edit::replacing(text, range, new);
    }
    let before = text.as_str()[..range.start].chars().next_back();
    let Some(last) = before.map(char::len_utf8) else {
        return insertion(text, range.start, text.span(range).start, new);
    };
    let last = range.start - last;
    let place = text.span(last..range.start).end;
    if !text.can_replace(range.clone()) || !text.can_replace(last..range.start) {
        return None;
    }
    insertion(text, last, place, new)
}

fn insertion(text: &Text, context: usize, place: usize, new: &str) -> Option<Vec<Edit>> {
    (!ends_section(text, context, new)).then(|| {
        vec![Edit {
            span: Span::at(place),
            text: text.escape_at(context, new),
        }]
    })
}

/// Whether a text would end the CDATA section that it is written in.
fn ends_section(text: &Text, at: usize, new: &str) -> bool {
    text.escape_at(at, "<") == "<" && new.contains("]]")
}
