//! Selection ranges: word, attribute, string, element.

use super::Analysis;
use super::at::{Item, attributes, token_at};
use crate::bind::StringHolder;
use crate::source::Span;

impl Analysis {
    /// The spans around byte `offset`, each inside the next; none outside of strings.
    pub fn selections(&self, offset: usize) -> Vec<Span> {
        let Some((index, at)) = self.string_at(offset) else {
            return vec![];
        };
        let string = &self.bindings().strings[index];
        let all = attributes(&string.annotation);
        let mut ranges = vec![];
        if let Some(token) = token_at(string, at) {
            if let Item::Keyword(index) | Item::Flag(index, _) | Item::Argument(index, _) =
                token.item
            {
                ranges.push(token.range);
                ranges.push(all[index].range.clone());
                ranges.push(all[0].range.start..all[all.len() - 1].range.end);
            } else {
                ranges.push(token.range);
            }
        }
        let text = string.text.as_str();
        let start = text.len() - text.trim_start().len();
        ranges.push(start..text.trim_end().len().max(start));
        let mut spans: Vec<Span> = ranges
            .into_iter()
            .map(|range| string.text.span(range))
            .collect();
        spans.push(string.text.whole());
        if let StringHolder::Label(label) = string.holder {
            spans.push(self.drawing().labels[label].0.element);
        }
        let mut nested: Vec<Span> = vec![];
        for span in spans {
            let grows = nested.last().is_none_or(|inner| {
                span.start <= inner.start && inner.end <= span.end && span != *inner
            });
            if grows {
                nested.push(span);
            }
        }
        nested
    }
}

#[cfg(test)]
mod tests {
    use super::super::fixtures::{analysis, figure};

    #[test]
    fn selections_grow_from_the_word_to_the_element() {
        let (analysis, at) = analysis(&figure([
            "Body",
            "Rarm@Body$Offset 1 Shape cone ¦0 20",
            "",
            "",
            "",
        ]));
        let texts: Vec<_> = analysis
            .selections(at)
            .into_iter()
            .map(|span| analysis.source()[span.start..span.end].to_owned())
            .collect();
        assert_eq!(
            texts[..4],
            [
                "0",
                "Shape cone 0 20",
                "Offset 1 Shape cone 0 20",
                "Rarm@Body$Offset 1 Shape cone 0 20"
            ]
        );
        assert!(texts[4].starts_with("<text ") && texts[4].ends_with("</text>"));
    }
}
