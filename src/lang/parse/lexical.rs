//! The tokens of the language, as nom parsers.

use nom::IResult;
use nom::Parser as _;
use nom::branch::alt;
use nom::bytes::complete::{tag, take_while, take_while1};
use nom::character::complete::{char, digit0, digit1, one_of, satisfy};
use nom::combinator::{all_consuming, opt, recognize};
use nom::sequence::{delimited, preceded};

/// The result of a token parser.
pub(super) type Parsed<'a, T> = IResult<&'a str, T>;

/// White space, a line feed included.
pub(super) fn blank(input: &str) -> Parsed<'_, &str> {
    take_while(char::is_whitespace).parse(input)
}

/// A number without a sign: `12`, `.5`, `5.`, `1e3`.
pub(super) fn magnitude(input: &str) -> Parsed<'_, &str> {
    let mantissa = alt((
        recognize((digit1, opt((char('.'), digit0)))),
        recognize((char('.'), digit1)),
    ));
    let exponent = (one_of("eE"), opt(one_of("+-")), digit1);
    recognize((mantissa, opt(exponent))).parse(input)
}

/// A number that may have a sign.
pub(super) fn number(input: &str) -> Parsed<'_, &str> {
    recognize((opt(one_of("+-")), magnitude)).parse(input)
}

/// Letters, digits, `_` and `.`, beginning with a letter.
pub(super) fn word(input: &str) -> Parsed<'_, &str> {
    recognize((satisfy(char::is_alphabetic), take_while(is_word_char))).parse(input)
}

/// Whether a word may contain `c` after its first character, which is a letter.
pub fn is_word_char(c: char) -> bool {
    c.is_alphanumeric() || c == '_' || c == '.'
}

/// `-cd`: the letters.
pub(super) fn flags(input: &str) -> Parsed<'_, &str> {
    preceded(char('-'), take_while1(|c: char| c.is_ascii_alphabetic())).parse(input)
}

/// `"…"`: what is between the quotes.
pub(super) fn quoted(input: &str) -> Parsed<'_, &str> {
    delimited(char('"'), take_while(|c| c != '"'), char('"')).parse(input)
}

/// `+x` and the like.
pub(super) fn signed_axis(input: &str) -> Parsed<'_, &str> {
    recognize((one_of("+-"), one_of("xyzXYZ"))).parse(input)
}

/// `#rrggbb`: the digits.
pub(super) fn hex(input: &str) -> Parsed<'_, &str> {
    preceded(tag("#"), take_while1(|c: char| c.is_ascii_alphanumeric())).parse(input)
}

/// Whether `parser` reads all of `text`.
pub(super) fn is<'a>(text: &'a str, parser: fn(&'a str) -> Parsed<'a, &'a str>) -> bool {
    all_consuming(parser).parse(text).is_ok()
}

/// The length of the run of characters at the start of `input` that ends at white space or at a sign
/// that cannot be part of an argument.
pub(super) fn run(input: &str) -> usize {
    let mut chars = input.char_indices().peekable();
    while let Some((at, c)) = chars.next() {
        let ends = match c {
            '"' | '(' | ')' | '@' | '$' => true,
            // `5%` is a mistyped number; `5%Scale` is a number and another string.
            '%' => at == 0 || chars.peek().is_some_and(|(_, next)| next.is_alphabetic()),
            c => c.is_whitespace(),
        };
        if ends {
            return at;
        }
    }
    input.len()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_and_words_are_distinct() {
        for text in ["12", "-20", ".5", "-.5", "1e3", "5.", "+5", "1.5e-3"] {
            assert!(is(text, number), "{text}");
        }
        for text in ["1.0v", "", "-", ".", "1e", "--5", "0x10", "1,5"] {
            assert!(!is(text, number), "{text}");
        }
        for text in ["roundv", "a.b_2", "右腕"] {
            assert!(is(text, word), "{text}");
        }
        for text in ["2a", "_a", "a-b", ""] {
            assert!(!is(text, word), "{text}");
        }
    }

    #[test]
    fn a_run_ends_at_a_sign() {
        for (text, length) in [
            ("abc def", 3),
            ("abc$", 3),
            ("5% ", 2),
            ("5%Scale", 1),
            ("%", 0),
            ("右腕", 6),
        ] {
            assert_eq!(run(text), length, "{text}");
        }
    }
}
