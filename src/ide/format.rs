//! Formatting of strings: canonical keywords, single blanks, ASCII signs.

use super::Analysis;
use super::at::{Item, Token, attributes, tokens};
use crate::bind::DrawingString;
use crate::diagnostic::{Edit, applied};
use crate::lang::ast::{Annotation, ArgumentKind};
use crate::lang::keyword::kinds;
use crate::lang::keyword::signature::Takes;
use crate::lang::keyword::vocabulary::{AXES, Word};
use crate::lang::{normalize, parameter_at};
use crate::source::{Span, Text};

impl Analysis {
    /// The edits that format the strings within `window`. Line breaks, comments, quoted text
    /// and what could not be parsed stay unchanged.
    ///
    /// White space can move a text that is not aligned to its start, and so bind it to another part: `analyze` compiles
    /// the result, and if its meaning differs, only edits that keep the width are made.
    pub fn format(&self, window: Span, analyze: &dyn Fn(&str) -> Analysis) -> Vec<Edit> {
        if !self.is_sound() {
            return vec![];
        }
        let strings = self.bindings().strings.iter().filter(|string| {
            let whole = string.text.whole();
            !string.text.as_str().is_empty()
                && whole.start <= window.end
                && window.start <= whole.end
        });
        let mut edits: Vec<Edit> = strings.flat_map(|string| self.formatted(string)).collect();
        edits.sort_by_key(|edit| edit.span);
        // A clone shares the description of its original: it is edited once.
        edits.dedup();
        if edits.is_empty() || self.is_equivalent(&analyze(&applied(&self.source, &edits))) {
            return edits;
        }
        edits.retain(|edit| {
            let old = &self.source[edit.span.start..edit.span.end];
            old.len() == edit.text.len() && old.eq_ignore_ascii_case(&edit.text)
        });
        edits
    }

    /// Whether the strings of both have the same meaning for the same parts.
    fn is_equivalent(&self, other: &Self) -> bool {
        let (one, two) = (self.bindings(), other.bindings());
        let strings = one.strings.iter().zip(&two.strings);
        let parts = one.parts.iter().zip(&two.parts);
        one.strings.len() == two.strings.len()
            && one.parts.len() == two.parts.len()
            && strings.into_iter().all(|(one, two)| {
                let values = |string: &DrawingString| -> Vec<_> {
                    let settings = string.settings.iter();
                    settings
                        .map(|setting| (setting.keyword, setting.value.clone()))
                        .collect()
                };
                one.binding == two.binding && values(one) == values(two)
            })
            && parts.into_iter().all(|(one, two)| {
                one.name == two.name && one.parent == two.parent && one.kind == two.kind
            })
    }

    fn formatted(&self, string: &DrawingString) -> Vec<Edit> {
        if matches!(
            string.annotation,
            Annotation::Comment | Annotation::Unused | Annotation::Caption | Annotation::Empty
        ) {
            return vec![];
        }
        let text = string.text.as_str();
        let tokens = tokens(string);
        let mut edits = vec![];
        let mut end = 0;
        let mut before: Option<&Token> = None;
        for token in &tokens {
            // Overlapping tokens, from words that could not be parsed, are left unchanged.
            if token.range.start < end {
                return vec![];
            }
            edits.extend(gap(
                &string.text,
                end..token.range.start,
                before,
                Some(token),
            ));
            let written = &text[token.range.clone()];
            let usual = self.canonical(string, token, written);
            if usual != written {
                edits.extend(
                    Edit::replacing(&string.text, token.range.clone(), &usual)
                        .into_iter()
                        .flatten(),
                );
            }
            end = token.range.end;
            before = Some(token);
        }
        edits.extend(gap(&string.text, end..text.len(), before, None));
        edits
    }

    /// A token in its canonical form.
    fn canonical(&self, string: &DrawingString, token: &Token, written: &str) -> String {
        if written.starts_with(['"', '＂']) {
            return written.to_owned();
        }
        let all = attributes(&string.annotation);
        match token.item {
            Item::Keyword(index) => all[index].keyword.name().to_owned(),
            Item::Flag(..) => normalize(written).to_ascii_lowercase(),
            Item::Argument(index, argument) => {
                let known = |name: &str| self.is_variable(name);
                let takes =
                    parameter_at(&all[index], argument, &known).map(|slot| &slot.parameter().takes);
                let known = match (&all[index].arguments[argument].kind, takes) {
                    (ArgumentKind::Word(word), Some(Takes::Kind)) => {
                        kinds::from_name(word).map(|kind| kind.name)
                    }
                    (ArgumentKind::Word(word), Some(Takes::Choice(words))) => named(words, word),
                    (ArgumentKind::Word(word), Some(Takes::SignedAxis)) => named(&AXES, word),
                    _ => None,
                };
                known.map_or_else(|| normalize(written).into_owned(), str::to_owned)
            }
            Item::Sign | Item::Name | Item::Parent | Item::Feature => {
                normalize(written).into_owned()
            }
            Item::Remark => written.to_owned(),
        }
    }
}

/// The word of the language that equals `word`, ignoring case.
fn named(words: &'static [Word], word: &str) -> Option<&'static str> {
    let mut names = words.iter().map(|known| known.name);
    names.find(|name| name.eq_ignore_ascii_case(word))
}

/// The edits between two tokens: only white space and the sign of flags are changed.
fn gap(
    text: &Text,
    range: std::ops::Range<usize>,
    before: Option<&Token>,
    after: Option<&Token>,
) -> Vec<Edit> {
    let written = &text.as_str()[range.clone()];
    let signs = normalize(written);
    let is_flag =
        |token: Option<&Token>| matches!(token.map(|token| token.item), Some(Item::Flag(..)));
    let is_sign = |token: Option<&Token>| matches!(token.map(|token| token.item), Some(Item::Sign));
    let usual = match (before, after) {
        (None, _) | (_, None) => "",
        _ if is_flag(before) && is_flag(after) => "",
        _ if is_flag(after) => " -",
        _ if is_sign(before) || is_sign(after) => "",
        _ => " ",
    };
    let dash = if is_flag(after) { "-" } else { "" };
    let is_plain = signs.trim() == dash || (signs.trim().is_empty() && is_flag(before));
    if written == usual || !is_plain || written.contains(['\n', '\r']) {
        return vec![];
    }
    if range.is_empty() {
        return vec![Edit {
            span: text.span(range.clone()),
            text: usual.to_owned(),
        }];
    }
    match text.spans(range.clone()).as_slice() {
        [_] => Edit::replacing(text, range, usual).unwrap_or_default(),
        // There are tags between the tokens.
        _ => vec![],
    }
}

#[cfg(test)]
mod tests {
    use super::super::fixtures::{analysis, figure};
    use super::*;

    fn formatted(source: &str) -> String {
        let (before, _) = analysis(source);
        let all = Span::new(0, before.source().len());
        let edits = before.format(all, &|text| analysis(text).0);
        applied(before.source(), &edits)
    }

    #[test]
    fn strings_are_formatted() {
        for (before, after) in [
            (
                "Rarm @ Body $ shape   ROUNDV  -90   90",
                "Rarm@Body$Shape roundv -90 90",
            ),
            ("  Rarm@Body$Shape-D -C round ", "Rarm@Body$Shape -dc round"),
            (
                "Ｒａｒｍ＠Body＄Ｓｈａｐｅ　ｒｏｕｎｄ",
                "Rarm@Body$Shape round",
            ),
            (
                "Rarm@Body$Color#f00 offset(1+2)",
                "Rarm@Body$Color #f00 Offset (1+2)",
            ),
            ("\"Ｒ  arm\"@Body", "\"Ｒ  arm\"@Body"),
            (
                "Rarm@Body$Origin CENTER\n  smooth 3",
                "Rarm@Body$Origin center\n  Smooth 3",
            ),
            ("#  a   note", "#  a   note"),
            (
                "Rarm@Body$Offset   3px   Smooth  1",
                "Rarm@Body$Offset 3px Smooth 1",
            ),
            (
                "Rarm@Body$Offset <tspan>3</tspan>",
                "Rarm@Body$Offset <tspan>3</tspan>",
            ),
            (
                "Rarm@Body$Offset &#x33;  Smooth 1",
                "Rarm@Body$Offset &#x33; Smooth 1",
            ),
        ] {
            let after = figure(["Body", after, "", "", "%Scale 1"]);
            assert_eq!(
                formatted(&figure(["Body", before, "", "", "%Scale 1"])),
                after
            );
            assert_eq!(formatted(&after), after);
        }
    }

    #[test]
    fn a_text_that_would_move_to_another_part_keeps_its_width() {
        let source = figure(["Body", "Rarm@Body", "%Bind center", "", ""]).replace(
            "<text x=\"50\" y=\"49\"",
            "<text text-anchor=\"end\" x=\"100\" y=\"49\"",
        );
        let wide = source.replace(
            ">Rarm@Body",
            &format!(">Rarm@Body$shape{}round", " ".repeat(60)),
        );
        let out = formatted(&wide);
        let (one, two) = (analysis(&wide).0, analysis(&out).0);
        assert!(one.is_equivalent(&two));
        assert!(out.contains("$Shape  "), "{out}");
    }
}
