//! Characteristic joints: the parts with `Mark`, and what `Follow` names.

use crate::bind::bindings::{Bindings, PartId};
use crate::lang::ast::ArgumentKind;
use crate::source::Span;

/// The colour mark that performs a part.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct PartMark<'a> {
    /// Its colour as it is written, in lower case: `red`, `#ff8000`.
    pub word: &'a str,
    /// Red, green, blue, sRGB.
    pub color: [u8; 3],
    /// The place of the setting.
    pub span: Span,
}

/// A name in a `Follow`: that of a part, or of a joint of the motion.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct FollowedName<'a> {
    /// The name.
    pub name: &'a str,
    /// Its place, quotes included.
    pub span: Span,
}

impl Bindings {
    /// The mark of a part, from its own string, the legend of its paint or a `%` string.
    pub fn mark(&self, part: PartId) -> Option<PartMark<'_>> {
        let mark = self.attributes(part).mark()?;
        Some(PartMark {
            word: &mark.value.word,
            color: mark.value.color,
            span: self.span_of(&mark.source),
        })
    }

    /// What is edited together with a part, in the order of its `Follow`.
    pub fn follows(&self, part: PartId) -> Vec<FollowedName<'_>> {
        let Some(follows) = self.attributes(part).follows() else {
            return Vec::new();
        };
        let string = &self.strings[follows.source.string];
        let attribute = string
            .annotation
            .attribute_at(&follows.source.setting.range);
        let arguments = attribute.map_or(&[][..], |attribute| attribute.arguments.as_slice());
        let names = arguments.iter().filter_map(|argument| {
            let (ArgumentKind::Word(name) | ArgumentKind::Quoted(name)) = &argument.kind else {
                return None;
            };
            Some(FollowedName {
                name,
                span: string.text.span(argument.range.clone()),
            })
        });
        names.collect()
    }
}
