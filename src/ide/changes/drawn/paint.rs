//! Gives the shape of a part another colour.

use roxmltree::Node;

use super::{color, element_at};
use crate::diagnostic::Edit;
use crate::ide::changes::{Analysis, Change, Place, Refusal};
use crate::lang::keyword::Keyword;
use crate::source::Span;

impl Analysis {
    /// Paints the shape of a part: its fill, or the line that it is drawn as.
    pub(in crate::ide::changes) fn paint(
        &self,
        name: &str,
        fill: &str,
    ) -> Result<Vec<Edit>, Refusal> {
        let fill = color(fill)?;
        let (part, _) = self.drawn_part(name)?;
        let resolved = self.bindings().resolved(self.drawing(), part).into_iter();
        let mut said = resolved.filter(|one| one.keyword == Keyword::Color && one.string.is_some());
        if let Some(said) = said.next() {
            let set = Change::Set {
                part: name.to_owned(),
                attribute: Keyword::Color,
                value: fill,
                place: Place::Ask,
            };
            return Err(Refusal::new(format!(
                "a string says the colour of `{name}` in the model, `Color {}`",
                said.value
            ))
            .or("Change what the string says", set));
        }
        let found = &self.bindings().parts[part];
        let property = if found.is_stroke { "stroke" } else { "fill" };
        let element = &self.drawing().shapes[found.shape].element;
        let document = self.document()?;
        let node = element_at(&document, element.span.start)?;
        painted(&self.source, node, property, &fill).ok_or_else(|| {
            Refusal::new(format!(
                "an XML entity stands for a part of how `{name}` is painted: replace the entity by its text first"
            ))
        })
    }
}

/// The edits that give an element a paint: in its style, where that says one, in its attribute otherwise.
fn painted(source: &str, node: Node<'_, '_>, property: &str, color: &str) -> Option<Vec<Edit>> {
    let by_name = |name: &str| {
        let mut attributes = node.attributes();
        attributes.find(|one| one.name() == name && one.namespace().is_none())
    };
    let value_of = |name: &str| {
        let attribute = by_name(name)?;
        let span: Span = attribute.range_value().into();
        Some((
            span,
            source.get(span.start..span.end) == Some(attribute.value()),
        ))
    };
    let edit = |start: usize, end: usize, text: String| {
        Some(vec![Edit {
            span: Span::new(start, end),
            text,
        }])
    };
    if let Some((span, is_plain)) = value_of("style") {
        let style = &source[span.start..span.end];
        if !is_plain {
            return None;
        }
        if let Some((start, end)) = declared(style, property) {
            return edit(span.start + start, span.start + end, color.to_owned());
        }
        if by_name(property).is_none() {
            let kept = style.trim_end();
            let sign = if kept.is_empty() || kept.ends_with(';') {
                ""
            } else {
                ";"
            };
            let at = span.start + kept.len();
            return edit(at, at, format!("{sign}{property}:{color}"));
        }
    }
    if let Some((span, _)) = value_of(property) {
        return edit(span.start, span.end, color.to_owned());
    }
    let name = &source[node.range().start + 1..];
    let length = name.find(|c: char| c.is_whitespace() || matches!(c, '/' | '>'))?;
    let at = node.range().start + 1 + length;
    edit(at, at, format!(" {property}=\"{color}\""))
}

/// Where the value of a property stands in a style; the last one, which is the one that holds.
fn declared(style: &str, property: &str) -> Option<(usize, usize)> {
    let mut start = 0;
    let mut found = None;
    for piece in style.split(';') {
        if let Some((name, value)) = piece.split_once(':')
            && name.trim() == property
        {
            let lead = value.len() - value.trim_start().len();
            let from = start + name.len() + 1 + lead;
            found = Some((from, from + value.trim().len()));
        }
        start += piece.len() + 1;
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    fn after(text: &str) -> String {
        let document = roxmltree::Document::parse(text).unwrap();
        let edits = painted(text, document.root_element(), "fill", "#123456").unwrap();
        crate::diagnostic::applied(text, &edits)
    }

    #[test]
    fn a_colour_is_written_where_one_stands() {
        for (before, expected) in [
            (
                "<rect style=\"stroke:red; fill : #ff0000 ;x:y\"/>",
                "<rect style=\"stroke:red; fill : #123456 ;x:y\"/>",
            ),
            (
                "<rect fill=\"red\" style=\"stroke:red\"/>",
                "<rect fill=\"#123456\" style=\"stroke:red\"/>",
            ),
            (
                "<rect style=\"stroke:red\"/>",
                "<rect style=\"stroke:red;fill:#123456\"/>",
            ),
            ("<rect style=\"\"/>", "<rect style=\"fill:#123456\"/>"),
            (
                "<rect style='fill-opacity:1;'/>",
                "<rect style='fill-opacity:1;fill:#123456'/>",
            ),
            ("<rect/>", "<rect fill=\"#123456\"/>"),
        ] {
            assert_eq!(after(before), expected);
        }
    }
}
