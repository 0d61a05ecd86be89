//! Snippets: words with placeholders.

use crate::ide::at::attributes;
use crate::lang;
use crate::lang::ast::Argument;
use crate::lang::keyword::Keyword;
use crate::lang::keyword::kinds::Kind;
use crate::source::Text;

/// A word with the arguments of its example as placeholders.
pub(super) fn filled(word: &str, arguments: &[String]) -> Option<String> {
    if arguments.is_empty() {
        return None;
    }
    let mut out = word.to_owned();
    for (index, argument) in arguments.iter().enumerate() {
        let (open, inner, close) = match argument.strip_prefix('"') {
            Some(inner) => ("\"", inner.trim_end_matches('"'), "\""),
            None => ("", argument.as_str(), ""),
        };
        let inner = inner
            .replace('\\', "\\\\")
            .replace('$', "\\$")
            .replace('}', "\\}");
        out.push_str(&format!(" {open}${{{}:{inner}}}{close}", index + 1));
    }
    Some(out)
}

/// The arguments that a keyword has in its example.
pub(super) fn example_arguments(keyword: Keyword) -> Vec<String> {
    arguments_of(keyword.row().example, keyword, 0)
}

/// The parameters that a kind of shape has in its example.
pub(super) fn kind_arguments(kind: &Kind) -> Vec<String> {
    arguments_of(kind.example, Keyword::Shape, 1)
}

/// The arguments of a keyword in a string, without the first few.
fn arguments_of(string: &str, keyword: Keyword, skipped: usize) -> Vec<String> {
    let (annotation, _) = lang::parse(&Text::plain(string, 0), lang::Container::Text);
    let found = attributes(&annotation)
        .iter()
        .find(|attribute| attribute.keyword == keyword);
    let arguments = found.map_or(&[][..], |attribute| attribute.arguments.as_slice());
    let words = arguments.iter().skip(skipped);
    words
        .map(|argument: &Argument| string[argument.range.clone()].to_owned())
        .collect()
}

/// A snippet's text with the defaults of its placeholders.
pub(super) fn plain(snippet: &str) -> String {
    let mut out = String::new();
    let mut rest = snippet;
    while let Some(c) = rest.chars().next() {
        rest = &rest[c.len_utf8()..];
        match c {
            '\\' => {
                let escaped = rest.chars().next();
                out.extend(escaped);
                rest = &rest[escaped.map_or(0, char::len_utf8)..];
            }
            '$' => {
                let inner = rest
                    .split_once(':')
                    .and_then(|(_, inner)| inner.split_once('}'));
                let (inner, behind) = inner.unwrap_or_default();
                out.push_str(inner);
                rest = behind;
            }
            c => out.push(c),
        }
    }
    out
}
