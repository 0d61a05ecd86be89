//! What is at an offset: the one query that all others go through.

use std::ops::Range;

use super::{Analysis, Subject, subject};
use crate::bind::{DrawingString, PartId, StringId};
use crate::lang::ast::{Annotation, ArgumentKind, Attribute};
use crate::lang::keyword::Keyword;
use crate::source::Span;
use crate::svg::{Element, ShapeId};

/// What is at an offset of a drawing.
#[derive(Debug, Clone)]
pub struct At<'a> {
    /// The span: of the word, of the string between words, or of the tag.
    pub span: Span,
    /// The string or tag.
    pub found: Found,
    /// The part that the string or the tag has, if any; of a region, the one in this view.
    pub part: Option<PartId>,
    /// What the string or the tag belongs to. The preview shows it.
    pub subject: Option<Subject<'a>>,
    /// What the word stands for: the part that it names as a parent, the subject if it is not about the language. Hovers describe
    /// it, and definitions lead to it.
    pub meant: Option<Subject<'a>>,
}

/// A string or a tag.
#[derive(Debug, Clone, PartialEq)]
pub enum Found {
    /// A string.
    String {
        /// Its id in the bindings.
        string: StringId,
        /// The offset in its decoded characters.
        offset: usize,
        /// The token there; `None` between tokens.
        token: Option<Token>,
    },
    /// The name of a shape's tag, `<rect`, or of a group that gives its part the name.
    Tag {
        /// Index of the shape in the drawing.
        shape: ShapeId,
    },
}

/// A word or sign of a string.
#[derive(Debug, Clone, PartialEq)]
pub struct Token {
    /// What it is.
    pub item: Item,
    /// Its range in the decoded string.
    pub range: Range<usize>,
}

/// The kind of a word or sign. The numbers are indices of attributes in their string, and of flags and
/// arguments in their attribute.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Item {
    /// One of `# % * $ @ ^`.
    Sign,
    /// The name that a string gives its part.
    Name,
    /// The name after `@`.
    Parent,
    /// The name of a feature point.
    Feature,
    /// A keyword.
    Keyword(usize),
    /// A flag.
    Flag(usize, usize),
    /// An argument.
    Argument(usize, usize),
    /// The text of a comment.
    Remark,
}

impl Analysis {
    /// What is at byte `offset`.
    pub fn at(&self, offset: usize) -> Option<At<'_>> {
        match self.string_at(offset) {
            Some((string, offset)) => Some(self.in_string(string, offset)),
            None => self.tag_at(offset),
        }
    }

    fn in_string(&self, string: StringId, offset: usize) -> At<'_> {
        let found = &self.bindings().strings[string];
        let token = token_at(found, offset);
        let subject = Subject::of_string(&self.compiled, string);
        let named = |name| Subject::of_part(&self.compiled, self.part_named(name)?);
        let meant = match (token.as_ref().map(|token| token.item), &found.annotation) {
            (None | Some(Item::Sign | Item::Name | Item::Remark), _) => subject,
            (Some(Item::Parent), Annotation::Part(part)) => {
                part.parent.as_ref().and_then(|parent| named(&parent.text))
            }
            (Some(Item::Argument(index, argument)), annotation) => {
                followed(&attributes(annotation)[index], argument).and_then(named)
            }
            _ => None,
        };
        At {
            span: match &token {
                Some(token) => found.text.span(token.range.clone()),
                None => found.text.whole(),
            },
            found: Found::String {
                string,
                offset,
                token,
            },
            part: self.part_of_string(string),
            subject,
            meant,
        }
    }

    fn tag_at(&self, offset: usize) -> Option<At<'_>> {
        let is_there = |element: &Element| {
            element.span.touches(offset) && element.span.start < element.span.end
        };
        let shapes = &self.drawing().shapes;
        let (span, shape, part) = match shapes.position(|shape| is_there(&shape.element)) {
            Some(shape) => {
                let span = shapes[shape].element.span;
                (span, shape, self.part_of_shape(shape))
            }
            None => {
                let bindings = self.bindings();
                let mut parts = bindings.parts.keys();
                let (part, naming) = parts.find_map(|part| {
                    let naming = bindings.naming_element(self.drawing(), part);
                    Some((part, naming.filter(|naming| is_there(naming))?))
                })?;
                (naming.span, bindings.parts[part].shape, Some(part))
            }
        };
        let subject = match part {
            Some(part) => Subject::of_part(&self.compiled, part),
            None => Subject::of_shape(&self.compiled, shape),
        };
        Some(At {
            span,
            found: Found::Tag { shape },
            part,
            subject,
            meant: subject,
        })
    }

    /// The name that the preview's page has for what is at byte `offset`.
    pub fn part_at(&self, offset: usize) -> Option<&str> {
        self.at(offset)?.subject?.shown_name()
    }

    /// The span of the text of what the preview's page calls so.
    pub fn place_of(&self, name: &str) -> Option<Span> {
        Subject::named(&self.compiled, name).map(Subject::span)
    }

    /// The string at byte `offset`, and the offset in its decoded characters.
    pub(super) fn string_at(&self, offset: usize) -> Option<(StringId, usize)> {
        let strings = &self.bindings().strings;
        let behind = strings.partition_point(|string| string.text.whole().start <= offset);
        let start = |string: StringId| strings[string].text.whole().start;
        let last = StringId::from(usize::from(behind).checked_sub(1)?);
        // A clone shares the description of its original, so several strings can have one span.
        let before = strings.keys().take(usize::from(behind)).rev();
        let string = before
            .take_while(|string| start(*string) == start(last))
            .last()?;
        let text = &strings[string].text;
        let inside = text.whole().touches(offset) && !text.as_str().is_empty();
        Some((string, text.offset_of(offset).filter(|_| inside)?))
    }

    pub(super) fn part_of_shape(&self, shape: ShapeId) -> Option<PartId> {
        subject::part_of_shape(&self.compiled, shape)
    }

    pub(super) fn part_of_string(&self, string: StringId) -> Option<PartId> {
        subject::part_of_string(&self.compiled, string)
    }

    pub(super) fn span_of_part(&self, part: PartId) -> Span {
        subject::span_of_part(&self.compiled, part)
    }

    pub(super) fn span_of_string(&self, string: StringId) -> Span {
        subject::span_of_string(&self.compiled, string)
    }
}

/// The name of the part that an argument of `Follow` means.
fn followed(attribute: &Attribute, argument: usize) -> Option<&str> {
    match &attribute.arguments[argument].kind {
        ArgumentKind::Word(name) | ArgumentKind::Quoted(name)
            if attribute.keyword == Keyword::Follow =>
        {
            Some(name)
        }
        _ => None,
    }
}

pub(super) fn attributes(annotation: &Annotation) -> &[Attribute] {
    annotation.attributes()
}

/// The words and signs of a string, in order, without what could not be parsed.
pub(super) fn tokens(string: &DrawingString) -> Vec<Token> {
    let text = string.text.as_str();
    let mut tokens = vec![];
    let mut push = |item, range: &Range<usize>| {
        tokens.push(Token {
            item,
            range: range.clone(),
        });
    };
    let first = text.len() - text.trim_start().len();
    let sign = first..first + text[first..].chars().next().map_or(0, char::len_utf8);
    match &string.annotation {
        Annotation::Empty | Annotation::Caption => return vec![],
        Annotation::Comment | Annotation::Unused => {
            push(Item::Sign, &sign);
            let remark = &text[sign.end..];
            let blank = remark.len() - remark.trim_start().len();
            push(Item::Remark, &(sign.end + blank..text.trim_end().len()));
        }
        Annotation::Defaults(_) | Annotation::Legend(_) => push(Item::Sign, &sign),
        Annotation::Feature(name) => {
            push(Item::Sign, &sign);
            push(Item::Feature, &name.range);
        }
        Annotation::Part(part) => {
            for sign in &part.signs {
                push(Item::Sign, sign);
            }
            if let Some(name) = &part.name {
                push(Item::Name, &name.range);
            }
            if let Some(parent) = &part.parent {
                push(Item::Parent, &parent.range);
            }
        }
    }
    for (index, attribute) in attributes(&string.annotation).iter().enumerate() {
        push(Item::Keyword(index), &attribute.keyword_range);
        for (flag, (_, range)) in attribute.flags.iter().enumerate() {
            push(Item::Flag(index, flag), range);
        }
        for (argument, given) in attribute.arguments.iter().enumerate() {
            push(Item::Argument(index, argument), &given.range);
        }
    }
    tokens.retain(|token| !token.range.is_empty());
    tokens.sort_by_key(|token| token.range.start);
    tokens
}

/// The word or sign at an offset of a string: the one that begins there rather than the one that ends there, and a
/// word rather than a sign.
pub(super) fn token_at(string: &DrawingString, offset: usize) -> Option<Token> {
    let touching = tokens(string)
        .into_iter()
        .filter(|token| (token.range.start..=token.range.end).contains(&offset));
    touching.min_by_key(|token| {
        let ends = token.range.end == offset;
        (token.item == Item::Sign, ends)
    })
}

#[cfg(test)]
mod tests {
    use super::super::fixtures::{analysis, figure};
    use super::*;

    fn item(strings: [&str; 5]) -> Option<Item> {
        let (analysis, at) = analysis(&figure(strings));
        match analysis.at(at)?.found {
            Found::String { token, .. } => token.map(|token| token.item),
            Found::Tag { .. } => None,
        }
    }

    #[test]
    fn words_are_found() {
        for (string, expected) in [
            ("¦Arm@Body$Shape -c round", Item::Name),
            ("Arm¦@Body$Shape -c round", Item::Name),
            ("Arm@¦Body$Shape -c round", Item::Parent),
            ("Arm@Body¦$Shape -c round", Item::Parent),
            ("Arm@Body$¦Shape -c round", Item::Keyword(0)),
            ("Arm@Body$Shape -¦c round", Item::Flag(0, 0)),
            ("Arm@Body$Shape -c ro¦und", Item::Argument(0, 0)),
            (
                "Arm@Body$Offset 3 Shape ¦cone 0 (1 + 2)",
                Item::Argument(1, 0),
            ),
            ("Arm@Body$Shape cone 0 (1 +¦ 2)", Item::Argument(0, 2)),
            ("¦$Shape round", Item::Sign),
            ("#¦ note", Item::Sign),
            ("# n¦ote", Item::Remark),
        ] {
            assert_eq!(
                item(["Body", string, "", "", "%Scale 1"]),
                Some(expected),
                "{string}"
            );
        }
        assert_eq!(item(["Body", "Arm@Body$Offset  ¦  3", "", "", ""]), None);
    }

    #[test]
    fn tags_are_found() {
        let source = figure(["Body", "Arm@Body", "", "", ""])
            .replace("<rect id=\"right\"", "<re¦ct id=\"right\"");
        let (analysis, at) = analysis(&source);
        let found = analysis.at(at).unwrap();
        assert!(matches!(found.found, Found::Tag { .. }));
        assert_eq!(found.subject.unwrap().name(), "Arm");
        assert!(analysis.at(0).is_none());
    }
}
