//! Names as they are written in strings: in quotes only if they need them.

use super::keyword::Keyword;
use super::{is_name_char, is_word_char, normalize};

/// The place of a name in a string, which decides whether it needs quotes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum NamePlace {
    /// Before or after `@`.
    Head,
    /// Among the arguments of an attribute.
    Argument,
}

/// Whether `name` is read as itself without quotes.
pub(crate) fn can_be_bare(name: &str, place: NamePlace) -> bool {
    if name.is_empty() || normalize(name) != name {
        return false;
    }
    match place {
        NamePlace::Head => {
            name.chars().all(is_name_char) && !name.starts_with(['#', '%', '*', '^'])
        }
        NamePlace::Argument => {
            name.starts_with(char::is_alphabetic)
                && name.chars().all(is_word_char)
                && Keyword::from_name(name).is_none()
        }
    }
}

/// `name` as it is written in a string.
pub(crate) fn quoted_if_needed(name: &str, place: NamePlace) -> String {
    if can_be_bare(name, place) {
        name.to_owned()
    } else {
        format!("\"{name}\"")
    }
}

/// The name that a user means who types `input`, with or without quotes, as the parser would read it: white space is
/// collapsed, and outside quotes full-width characters become ASCII. `None` if there is no such name.
pub(crate) fn read_name(input: &str) -> Option<String> {
    let input = input.trim();
    let inner = input
        .strip_prefix('"')
        .and_then(|rest| rest.strip_suffix('"'));
    let name = match inner {
        Some(inner) => inner.to_owned(),
        None => normalize(input).into_owned(),
    };
    let name = name.split_whitespace().collect::<Vec<_>>().join(" ");
    (!name.is_empty() && !name.contains(['"', '＂']) && !name.contains(char::is_control))
        .then_some(name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_quoted_only_if_they_need_it() {
        for (name, head, argument) in [
            ("Arm", "Arm", "Arm"),
            ("右腕", "右腕", "右腕"),
            ("Left arm", "\"Left arm\"", "\"Left arm\""),
            ("a$b", "\"a$b\"", "\"a$b\""),
            ("U-1", "U-1", "\"U-1\""),
            ("Shape", "Shape", "\"Shape\""),
            ("#1", "\"#1\"", "\"#1\""),
            ("Ａ", "\"Ａ\"", "\"Ａ\""),
        ] {
            assert_eq!(quoted_if_needed(name, NamePlace::Head), head);
            assert_eq!(quoted_if_needed(name, NamePlace::Argument), argument);
        }
    }

    #[test]
    fn typed_names_are_read_as_in_a_string() {
        assert_eq!(read_name("  Ａrm ").as_deref(), Some("Arm"));
        assert_eq!(read_name("\"Ａrm  x\"").as_deref(), Some("Ａrm x"));
        assert_eq!(read_name("a\"b"), None);
        assert_eq!(read_name(" \"\" "), None);
    }
}
