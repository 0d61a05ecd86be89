//! Inlay hints: automatic names and parents, inherited attributes.

use super::Analysis;
use super::uses::own_name;
use crate::bind::{NamedBy, PartId, PartKind, SetBy, StringHolder, StringId};
use crate::lang::looks_like_string;
use crate::source::Span;

/// The most inherited attributes that are shown after a string.
const MAX_INHERITED: usize = 4;

/// A hint that an editor shows between the characters.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Inlay {
    /// Its byte offset.
    pub at: usize,
    /// The words.
    pub pieces: Vec<InlayPiece>,
}

/// A piece of a hint, with its source.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct InlayPiece {
    /// The words.
    pub text: String,
    /// The span that they come from.
    pub from: Option<Span>,
    /// A sentence that explains them.
    pub about: String,
}

impl Analysis {
    /// The inlays within `window`, in the order of the file.
    pub fn inlays(&self, window: Span) -> Vec<Inlay> {
        let bindings = self.bindings();
        if !bindings.annotated {
            return vec![];
        }
        let mut out = vec![];
        for (index, part) in bindings.parts.iter_enumerated() {
            if part.kind != PartKind::Main {
                continue;
            }
            match part.string {
                Some(string)
                    if bindings.strings[string].text.whole().touches(window.start)
                        || (window.start..=window.end)
                            .contains(&bindings.strings[string].text.whole().start) =>
                {
                    out.extend(self.name_of_element(index, string));
                    out.extend(self.inherited_by(index, string));
                }
                None => out.extend(self.without_string(index)),
                Some(_) => {}
            }
        }
        out.retain(|inlay| (window.start..=window.end).contains(&inlay.at));
        out.sort_by_key(|inlay| inlay.at);
        out
    }

    /// After a shape's tag: its name, which no string gives, and its parent.
    fn without_string(&self, index: PartId) -> Option<Inlay> {
        let bindings = self.bindings();
        let part = &bindings.parts[index];
        let at = self.drawing().shapes[part.shape].element.span.end;
        let about = match part.named_by {
            NamedBy::Label { .. } => {
                "This shape has no string: its name is its label, or its group's"
            }
            NamedBy::Id { .. } => "This shape has no string: its name is its id, or its group's",
            NamedBy::String | NamedBy::Automatic => {
                "This shape has no string: its name is automatic"
            }
        };
        let naming = bindings.naming_element(self.drawing(), index);
        let mut pieces = vec![InlayPiece {
            text: part.name.clone(),
            from: naming.map(|element| element.span),
            about: about.to_owned(),
        }];
        let contact = bindings.hierarchy_by_contact;
        if let Some(parent) = part.parent {
            pieces.push(InlayPiece {
                text: format!("@{}", bindings.parts[parent].name),
                from: Some(self.span_of_part(parent)),
                about: if contact {
                    "It is attached to a part that it touches".to_owned()
                } else {
                    "It is attached to the nearest named part".to_owned()
                },
            });
        }
        Some(Inlay { at, pieces })
    }

    /// Before a description without a name: the name of its element.
    fn name_of_element(&self, index: PartId, string: StringId) -> Option<Inlay> {
        let bindings = self.bindings();
        let found = &bindings.strings[string];
        let text = found.text.as_str();
        let nameless = own_name(found).is_none() && looks_like_string(text);
        if matches!(found.holder, StringHolder::Label(_))
            || !nameless
            || bindings.parts[index].name.is_empty()
        {
            return None;
        }
        let start = text.len() - text.trim_start().len();
        Some(Inlay {
            at: found.text.span(start..start).start,
            pieces: vec![InlayPiece {
                text: bindings.parts[index].name.clone(),
                from: Some(
                    self.drawing().shapes[bindings.parts[index].shape]
                        .element
                        .span,
                ),
                about: "The name is the label or the id of the element".to_owned(),
            }],
        })
    }

    /// After a string: the attributes that its part inherits from a legend or `%`.
    fn inherited_by(&self, index: PartId, string: StringId) -> Option<Inlay> {
        let bindings = self.bindings();
        let text = &bindings.strings[string].text;
        let resolved = bindings.resolved(self.drawing(), index).into_iter();
        let inherited: Vec<_> = resolved
            .filter(|attribute| matches!(attribute.from, SetBy::Legend | SetBy::Default))
            .collect();
        if inherited.is_empty() {
            return None;
        }
        let mut pieces = vec![];
        for attribute in inherited.iter().take(MAX_INHERITED) {
            let space = if pieces.is_empty() { "" } else { " " };
            let source = bindings.setting(index, attribute.keyword)?;
            pieces.push(InlayPiece {
                text: format!("{space}{} {}", attribute.keyword.name(), attribute.value),
                from: Some(self.setting_span(source.string, &source.setting.range)),
                about: match attribute.from {
                    SetBy::Legend => "From the legend of its paint".to_owned(),
                    _ => "From a `%` string".to_owned(),
                },
            });
        }
        if inherited.len() > MAX_INHERITED {
            pieces.push(InlayPiece {
                text: " …".to_owned(),
                from: None,
                about: format!("And {} more", inherited.len() - MAX_INHERITED),
            });
        }
        let end = text.as_str().trim_end().len();
        Some(Inlay {
            at: text.span(end..end).start.max(text.span(0..end).end),
            pieces,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::super::fixtures::{analysis, figure};
    use super::*;

    #[test]
    fn automatic_names_and_inherited_attributes_are_shown() {
        let strings = [
            "Body",
            "Rarm@Body$Smooth 20",
            "",
            "$Offset 4",
            "%Smooth 10 Segments 8",
        ];
        let (analysis, _) = analysis(&figure(strings));
        let shown: Vec<_> = analysis
            .inlays(Span::new(0, analysis.source().len()))
            .into_iter()
            .map(|inlay| {
                let words: String = inlay
                    .pieces
                    .iter()
                    .map(|piece| piece.text.as_str())
                    .collect();
                let mut source = analysis.source().to_string();
                source.truncate(inlay.at);
                let before: String = source.chars().rev().take(5).collect();
                (before.chars().rev().collect::<String>(), words)
            })
            .collect();
        let expected = [
            ("<rect", "left@Body"),
            (">Body", "Segments 8 Smooth 10"),
            ("th 20", "Offset 4 Segments 8"),
        ];
        let expected = expected.map(|(before, words)| (before.to_owned(), words.to_owned()));
        assert_eq!(shown, expected);
    }

    #[test]
    fn descriptions_show_the_name_of_their_element() {
        let source = "<svg xmlns=\"http://www.w3.org/2000/svg\"><rect id=\"a\" width=\"9\" height=\"9\"><desc>$Offset 1</desc></rect></svg>";
        let (analysis, _) = analysis(source);
        let inlays = analysis.inlays(Span::new(0, source.len()));
        assert_eq!(inlays[0].pieces[0].text, "a");
        assert_eq!(&source[inlays[0].at..inlays[0].at + 1], "$");
    }
}
