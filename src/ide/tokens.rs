//! The colours of strings: what each word is.

use std::ops::Range;

use super::Analysis;
use super::at::{Item, attributes, tokens};
use crate::lang::ast::{ArgumentKind, Function};
use crate::lang::keyword::signature::Takes;
use crate::lang::{is_word_char, parameter_at};
use crate::source::Span;

/// What a stretch of characters is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Paint {
    /// A sign of the language, or of a calculation.
    Sign,
    /// A part's name, or a joint's.
    Part,
    /// A feature point's name.
    Feature,
    /// A keyword.
    Keyword,
    /// A flag.
    Flag,
    /// A kind of shape, a colour's name, or another word of the language.
    Word,
    /// A number, or a colour as digits.
    Number,
    /// A variable.
    Variable,
    /// A function of calculations.
    Function,
    /// Text in quotes.
    Quoted,
    /// What a comment says.
    Comment,
}

/// A stretch of characters of one kind, within one line.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Colouring {
    /// Where.
    pub span: Span,
    /// What it is.
    pub paint: Paint,
    /// Whether a name or variable is defined here.
    pub defines: bool,
}

impl Analysis {
    /// What the words of all strings within `window` are, in the order of the file.
    pub fn colouring(&self, window: Span) -> Vec<Colouring> {
        let strings = &self.bindings().strings;
        let first = strings.partition_point(|string| string.text.whole().end < window.start);
        let mut out: Vec<Colouring> = vec![];
        for (index, string) in strings.iter().enumerate().skip(first) {
            let whole = string.text.whole();
            if whole.start > window.end {
                break;
            }
            // A clone's description is the description of what it shows: it is coloured once.
            if out.last().is_none_or(|last| last.span.end <= whole.start) {
                self.colouring_of(index, &mut out);
            }
        }
        out.retain(|colouring| {
            colouring.span.end > window.start && colouring.span.start < window.end
        });
        out
    }

    fn colouring_of(&self, index: usize, out: &mut Vec<Colouring>) {
        let string = &self.bindings().strings[index];
        let mut push = |range: Range<usize>, paint, defines| {
            for piece in string.text.pieces(range) {
                for span in self.lines_of(piece) {
                    out.push(Colouring {
                        span,
                        paint,
                        defines,
                    });
                }
            }
        };
        for token in tokens(string) {
            let (paint, defines) = match token.item {
                Item::Sign => (Paint::Sign, false),
                Item::Name => (Paint::Part, true),
                Item::Parent => (Paint::Part, false),
                Item::Feature => (Paint::Feature, false),
                Item::Keyword(_) => (Paint::Keyword, false),
                Item::Flag(..) => (Paint::Flag, false),
                Item::Remark => (Paint::Comment, false),
                Item::Argument(attribute, argument) => {
                    let attribute = &attributes(&string.annotation)[attribute];
                    let given = &attribute.arguments[argument];
                    let takes = parameter_at(attribute, argument, &|name| self.is_variable(name))
                        .map(|slot| &slot.parameter().takes);
                    match (&given.kind, takes) {
                        (ArgumentKind::Expression(_), _) => {
                            let text = string.text.as_str();
                            for (range, paint) in calculation(text, token.range) {
                                push(range, paint, false);
                            }
                            continue;
                        }
                        (ArgumentKind::Number(_) | ArgumentKind::Hex(_), _) => {
                            (Paint::Number, false)
                        }
                        (_, Some(Takes::Names)) => (Paint::Part, false),
                        (ArgumentKind::Quoted(_), _) => (Paint::Quoted, false),
                        (ArgumentKind::Word(_), Some(Takes::Number(_))) => (Paint::Variable, false),
                        (ArgumentKind::Word(_), Some(Takes::Variable)) => (Paint::Variable, true),
                        (ArgumentKind::Word(_), Some(Takes::File | Takes::Text)) => {
                            (Paint::Quoted, false)
                        }
                        (ArgumentKind::Word(_), Some(_)) => (Paint::Word, false),
                        (ArgumentKind::Word(_) | ArgumentKind::Unreadable, _) => continue,
                    }
                }
            };
            push(token.range, paint, defines);
        }
    }

    /// A stretch, line by line.
    fn lines_of(&self, span: Span) -> impl Iterator<Item = Span> {
        let mut at = span.start;
        let lines = self.source[span.start..span.end].split_inclusive(['\n', '\r']);
        lines.filter_map(move |line| {
            let start = at;
            at += line.len();
            let end = start + line.trim_end_matches(['\n', '\r']).len();
            (end > start).then_some(Span::new(start, end))
        })
    }
}

/// The words of a calculation in parentheses.
fn calculation(text: &str, range: Range<usize>) -> Vec<(Range<usize>, Paint)> {
    let mut out = vec![];
    let mut at = range.start;
    while let Some(c) = text[at..range.end].chars().next() {
        let word =
            text[at..range.end].len() - text[at..range.end].trim_start_matches(is_word_char).len();
        let paint = match c {
            c if c.is_alphabetic() => {
                let name = &text[at..at + word];
                match Function::from_name(name) {
                    Some(_) => Some(Paint::Function),
                    None => Some(Paint::Variable),
                }
            }
            c if c.is_numeric() || c == '.' => Some(Paint::Number),
            '+' | '-' | '*' | '/' => Some(Paint::Sign),
            _ => None,
        };
        let end = at + if word > 0 { word } else { c.len_utf8() };
        if let Some(paint) = paint {
            out.push((at..end, paint));
        }
        at = end;
    }
    out
}

#[cfg(test)]
mod tests {
    use super::super::samples::{analysis, figure};
    use super::*;

    fn words(string: &str) -> Vec<(String, Paint)> {
        let (analysis, _) = analysis(&figure(["Body", string, "", "", "%Let w 1"]));
        let start = analysis.source().find("y=\"49\"").unwrap();
        let end = start + analysis.source()[start..].find("</text>").unwrap();
        let words = analysis.colouring(Span::new(start, end)).into_iter();
        words
            .map(|word| {
                (
                    analysis.source()[word.span.start..word.span.end].to_owned(),
                    word.paint,
                )
            })
            .collect()
    }

    #[test]
    fn words_have_their_colours() {
        use Paint::*;
        let found =
            words("Rarm@Body$Shape -d cone 0 (max(w, 2.5) * 3) Color #f00 Texture \"a.png\"");
        let expected = [
            ("Rarm", Part),
            ("@", Sign),
            ("Body", Part),
            ("$", Sign),
            ("Shape", Keyword),
            ("d", Flag),
            ("cone", Word),
            ("0", Number),
            ("max", Function),
            ("w", Variable),
            ("2.5", Number),
            ("*", Sign),
            ("3", Number),
            ("Color", Keyword),
            ("#f00", Number),
            ("Texture", Keyword),
            ("\"a.png\"", Quoted),
        ];
        let found: Vec<_> = found
            .iter()
            .map(|(word, paint)| (word.as_str(), *paint))
            .collect();
        assert_eq!(found, expected);
    }

    #[test]
    fn a_word_over_several_elements_is_coloured_piece_by_piece() {
        let found = words("# one<tspan x=\"0\" y=\"50\">two\nthree</tspan>");
        let found: Vec<_> = found.iter().map(|(word, _)| word.as_str()).collect();
        assert_eq!(found, ["#", "one", "two", "three"]);
    }
}
