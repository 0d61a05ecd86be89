//! How names are written: in quotes only where they need them.

use crate::lang::keyword::Keyword;
use crate::lang::{is_name_char, is_word_char, normalize};

/// The position of a name, which decides whether it needs quotes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Role {
    /// Before or after `@`.
    Head,
    /// Among the arguments of an attribute.
    Argument,
}

/// Whether `name` is read as itself without quotes.
pub(super) fn can_be_bare(name: &str, role: Role) -> bool {
    if name.is_empty() || normalize(name) != name {
        return false;
    }
    match role {
        Role::Head => name.chars().all(is_name_char) && !name.starts_with(['#', '%', '*', '^']),
        Role::Argument => {
            name.starts_with(char::is_alphabetic)
                && name.chars().all(is_word_char)
                && Keyword::from_name(name).is_none()
        }
    }
}

/// `name` as it is written in a string.
pub(super) fn written(name: &str, role: Role) -> String {
    match can_be_bare(name, role) {
        true => name.to_owned(),
        false => format!("\"{name}\""),
    }
}

/// The name that typed `input` means: quotes removed, white space collapsed, and without quotes
/// full-width signs as ASCII. `None` if there is no such name.
pub(super) fn meant(input: &str) -> Option<String> {
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
    fn names_are_quoted_where_necessary() {
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
            assert_eq!(written(name, Role::Head), head);
            assert_eq!(written(name, Role::Argument), argument);
        }
    }

    #[test]
    fn typed_names_are_read_like_names_in_strings() {
        assert_eq!(meant("  Ａrm ").as_deref(), Some("Arm"));
        assert_eq!(meant("\"Ａrm  x\"").as_deref(), Some("Ａrm x"));
        assert_eq!(meant("a\"b"), None);
        assert_eq!(meant(" \"\" "), None);
    }
}
