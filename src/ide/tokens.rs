//! Semantic tokens: the class of each word in strings.

use std::ops::Range;

use super::Analysis;
use super::at::{Item, attributes, tokens};
use crate::bind::StringId;
use crate::lang::ast::{ArgumentKind, Function};
use crate::lang::keyword::signature::Takes;
use crate::lang::{is_word_char, parameter_at};
use crate::source::Span;

/// The class of a semantic token.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TokenClass {
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
    /// The text of a comment.
    Comment,
}

/// Characters of one class, within one line.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SemanticToken {
    /// Where.
    pub span: Span,
    /// What it is.
    pub class: TokenClass,
    /// Whether it defines a name or variable.
    pub defines: bool,
}

impl Analysis {
    /// The semantic tokens of all strings within `window`, in the order of the file.
    pub fn semantic_tokens(&self, window: Span) -> Vec<SemanticToken> {
        let strings = &self.bindings().strings;
        let first = strings.partition_point(|string| string.text.whole().end < window.start);
        let mut out: Vec<SemanticToken> = vec![];
        for (index, string) in strings.iter_enumerated().skip(usize::from(first)) {
            let whole = string.text.whole();
            if whole.start > window.end {
                break;
            }
            // A clone shares the description of its original: its tokens are given once.
            if out.last().is_none_or(|last| last.span.end <= whole.start) {
                self.semantic_tokens_of(index, &mut out);
            }
        }
        out.retain(|semantic_tokens| {
            semantic_tokens.span.end > window.start && semantic_tokens.span.start < window.end
        });
        out
    }

    fn semantic_tokens_of(&self, index: StringId, out: &mut Vec<SemanticToken>) {
        let string = &self.bindings().strings[index];
        let mut push = |range: Range<usize>, class, defines| {
            for piece in string.text.spans(range) {
                for span in self.lines_of(piece) {
                    out.push(SemanticToken {
                        span,
                        class,
                        defines,
                    });
                }
            }
        };
        for token in tokens(string) {
            let (class, defines) = match token.item {
                Item::Sign => (TokenClass::Sign, false),
                Item::Name => (TokenClass::Part, true),
                Item::Parent => (TokenClass::Part, false),
                Item::Feature => (TokenClass::Feature, false),
                Item::Keyword(_) => (TokenClass::Keyword, false),
                Item::Flag(..) => (TokenClass::Flag, false),
                Item::Remark => (TokenClass::Comment, false),
                Item::Argument(attribute, argument) => {
                    let attribute = &attributes(&string.annotation)[attribute];
                    let given = &attribute.arguments[argument];
                    let takes = parameter_at(attribute, argument, &|name| self.is_variable(name))
                        .map(|slot| &slot.parameter().takes);
                    match (&given.kind, takes) {
                        (ArgumentKind::Expression(_), _) => {
                            let text = string.text.as_str();
                            for (range, class) in calculation(text, token.range) {
                                push(range, class, false);
                            }
                            continue;
                        }
                        (ArgumentKind::Number(_) | ArgumentKind::Hex(_), _) => {
                            (TokenClass::Number, false)
                        }
                        (_, Some(Takes::Names)) => (TokenClass::Part, false),
                        (ArgumentKind::Quoted(_), _) => (TokenClass::Quoted, false),
                        (ArgumentKind::Word(_), Some(Takes::Number(_))) => {
                            (TokenClass::Variable, false)
                        }
                        (ArgumentKind::Word(_), Some(Takes::Variable)) => {
                            (TokenClass::Variable, true)
                        }
                        (ArgumentKind::Word(_), Some(Takes::File | Takes::Text)) => {
                            (TokenClass::Quoted, false)
                        }
                        (ArgumentKind::Word(_), Some(_)) => (TokenClass::Word, false),
                        (ArgumentKind::Word(_) | ArgumentKind::Unreadable, _) => continue,
                    }
                }
            };
            push(token.range, class, defines);
        }
    }

    /// The lines of a span.
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

/// The tokens of a calculation in parentheses.
fn calculation(text: &str, range: Range<usize>) -> Vec<(Range<usize>, TokenClass)> {
    let mut out = vec![];
    let mut at = range.start;
    while let Some(c) = text[at..range.end].chars().next() {
        let word =
            text[at..range.end].len() - text[at..range.end].trim_start_matches(is_word_char).len();
        let class = match c {
            c if c.is_alphabetic() => {
                let name = &text[at..at + word];
                match Function::from_name(name) {
                    Some(_) => Some(TokenClass::Function),
                    None => Some(TokenClass::Variable),
                }
            }
            c if c.is_numeric() || c == '.' => Some(TokenClass::Number),
            '+' | '-' | '*' | '/' => Some(TokenClass::Sign),
            _ => None,
        };
        let end = at + if word > 0 { word } else { c.len_utf8() };
        if let Some(class) = class {
            out.push((at..end, class));
        }
        at = end;
    }
    out
}

#[cfg(test)]
mod tests {
    use super::super::fixtures::{analysis, figure};
    use super::*;

    fn words(string: &str) -> Vec<(String, TokenClass)> {
        let (analysis, _) = analysis(&figure(["Body", string, "", "", "%Let w 1"]));
        let start = analysis.source().find("y=\"49\"").unwrap();
        let end = start + analysis.source()[start..].find("</text>").unwrap();
        let words = analysis.semantic_tokens(Span::new(start, end)).into_iter();
        words
            .map(|word| {
                (
                    analysis.source()[word.span.start..word.span.end].to_owned(),
                    word.class,
                )
            })
            .collect()
    }

    #[test]
    fn words_have_their_colors() {
        use TokenClass::*;
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
            .map(|(word, class)| (word.as_str(), *class))
            .collect();
        assert_eq!(found, expected);
    }

    #[test]
    fn a_word_over_several_elements_is_colored_piece_by_piece() {
        let found = words("# one<tspan x=\"0\" y=\"50\">two\nthree</tspan>");
        let found: Vec<_> = found.iter().map(|(word, _)| word.as_str()).collect();
        assert_eq!(found, ["#", "one", "two", "three"]);
    }
}
