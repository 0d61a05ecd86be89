//! The item at an offset: the one query that all others go through.

use std::ops::Range;

use super::Analysis;
use crate::bind::{DrawingString, StringId};
use crate::lang::ast::{Annotation, Attribute};
use crate::svg::ShapeId;

/// The item at an offset of a drawing.
#[derive(Debug, Clone, PartialEq)]
pub enum At {
    /// A string.
    String {
        /// Its id in the bindings.
        string: StringId,
        /// The offset in its decoded characters.
        offset: usize,
        /// The token there; `None` between tokens.
        token: Option<Token>,
    },
    /// The name of a shape's tag: `<rect`.
    Tag {
        /// Index of the shape in the drawing.
        shape: ShapeId,
        /// Index of its part, if it has one.
        part: Option<usize>,
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
    /// The item at byte `offset`.
    pub fn at(&self, offset: usize) -> Option<At> {
        if let Some((string, offset)) = self.string_at(offset) {
            let token = token_at(&self.bindings().strings[string], offset);
            return Some(At::String {
                string,
                offset,
                token,
            });
        }
        let shape = self.drawing().shapes.position(|shape| {
            shape.element.span.touches(offset) && shape.element.span.start < shape.element.span.end
        })?;
        let part = self.part_of_shape(shape);
        Some(At::Tag { shape, part })
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

    /// The part of a shape; the fill if fill and border are two.
    pub(super) fn part_of_shape(&self, shape: ShapeId) -> Option<usize> {
        let mut parts = self.bindings().parts.iter();
        parts.position(|part| part.shape == shape)
    }

    pub(super) fn part_of_string(&self, string: StringId) -> Option<usize> {
        let binding = self.bindings().strings[string].binding?;
        let part = &self.bindings().parts[binding.part];
        (part.string == Some(string)).then_some(binding.part)
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
        match analysis.at(at) {
            Some(At::String { token, .. }) => token.map(|token| token.item),
            _ => None,
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
        let Some(At::Tag {
            part: Some(part), ..
        }) = analysis.at(at)
        else {
            panic!("the tag is not found");
        };
        assert_eq!(analysis.bindings().parts[part].name, "Arm");
        assert_eq!(analysis.at(0), None);
    }
}
