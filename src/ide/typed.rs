//! Strings in a text that is not well-formed at the moment, because it is being edited.

use crate::lang::looks_like_string;
use crate::source::{Form, Span, Text};
use crate::svg::character;

/// Elements whose characters can be a string.
const HOLDERS: &[&str] = &["text", "tspan", "desc", "flowPara", "flowSpan"];

/// The characters between two tags.
#[derive(Debug)]
pub(super) struct Typed {
    /// The characters.
    pub text: Text,
    /// The requested offset among them.
    pub offset: usize,
    /// Whether it is a description.
    pub in_desc: bool,
}

/// Whether a text has something that looks like a string. Reads it tag by tag, whether it is well-formed or not.
pub(super) fn looks_annotated(source: &str) -> bool {
    let mut rest = source;
    while let Some(open) = rest.find('<') {
        rest = &rest[open + 1..];
        let Some(end) = rest.find(['<', '>']) else {
            return false;
        };
        if rest[end..].starts_with('>') && HOLDERS.contains(&tag(rest)) {
            let content = &rest[end + 1..];
            let content = content.split('<').next().unwrap_or_default();
            if looks_like_string(&decoded(content, 0).as_str().replace('\u{FFFD}', "")) {
                return true;
            }
        }
        rest = &rest[end..];
    }
    false
}

/// The characters around byte `offset`, if their element can hold a string.
pub(super) fn typed_at(source: &str, offset: usize) -> Option<Typed> {
    let head = source.get(..offset)?;
    let start = head.rfind(['<', '>'])?;
    if !head[start..].starts_with('>') {
        return None;
    }
    let open = head[..start].rfind('<')?;
    let inside = &head[open + 1..start];
    let holder = tag(inside);
    if inside.ends_with('/') || !HOLDERS.contains(&holder) {
        return None;
    }
    let content = source[start + 1..].split('<').next().unwrap_or_default();
    let text = decoded(content, start + 1);
    let offset = if text.as_str().is_empty() {
        0
    } else {
        text.offset_of(offset)?
    };
    Some(Typed {
        text,
        offset,
        in_desc: holder == "desc",
    })
}

/// The name of the tag that `inside` begins with, without its prefix.
fn tag(inside: &str) -> &str {
    let name = inside.split(|c: char| c.is_whitespace() || matches!(c, '>' | '/'));
    let name = name.into_iter().next().unwrap_or_default();
    name.rsplit(':').next().unwrap_or_default()
}

/// Decodes the characters of XML; an `&` that begins no entity stands for itself.
fn decoded(raw: &str, origin: usize) -> Text {
    let mut text = Text::default();
    let mut at = 0;
    while at < raw.len() {
        let tail = &raw[at..];
        let entity = tail.strip_prefix('&').and_then(|name| {
            let end = name.find([';', '&'])?;
            let c = name[end..]
                .starts_with(';')
                .then(|| character(&name[..end]))??;
            Some((c, end + 2))
        });
        match entity {
            Some((c, length)) => {
                let span = Span::new(origin + at, origin + at + length);
                text.push(c.encode_utf8(&mut [0; 4]), span, Form::Unit);
                at += length;
            }
            None => {
                let first = tail.chars().next().map_or(1, char::len_utf8);
                let end = tail[first..]
                    .find('&')
                    .map_or(tail.len(), |end| first + end);
                let span = Span::new(origin + at, origin + at + end);
                text.push(&tail[..end], span, Form::Plain);
                at += end;
            }
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    fn typed(source: &str) -> Option<(String, usize, bool)> {
        let at = source.find('¦').unwrap();
        let found = typed_at(&source.replacen('¦', "", 1), at)?;
        Some((found.text.as_str().to_owned(), found.offset, found.in_desc))
    }

    #[test]
    fn strings_are_found_in_broken_xml() {
        for (source, expected) in [
            ("<svg><text x='1'>Arm@¦", Some(("Arm@", 4, false))),
            ("<text>a&amp;b¦ c</text>", Some(("a&b c", 3, false))),
            ("<text>a & b¦ &x; c<", Some(("a & b &x; c", 5, false))),
            ("<svg:desc>¦</svg:desc>", Some(("", 0, true))),
            ("<text ¦x='1'>", None),
            ("<title>a¦</title>", None),
            ("<text/>¦", None),
            ("a¦", None),
        ] {
            let expected = expected.map(|(text, offset, desc)| (text.to_owned(), offset, desc));
            assert_eq!(typed(source), expected, "{source}");
        }
    }

    #[test]
    fn broken_texts_show_whether_they_had_strings() {
        assert!(looks_annotated("<svg><text>Arm@Body<"));
        assert!(looks_annotated(
            "<svg><text><tspan x='0'>&#x25;Scale 2</tspan"
        ));
        assert!(!looks_annotated(
            "<svg><text>Figure 1</text><title>a@b</title>"
        ));
        assert!(!looks_annotated("<<<<<text<text"));
    }
}
