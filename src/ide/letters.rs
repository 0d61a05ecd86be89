//! Names that are looked for by some of their letters.

/// Whether `name` contains the letters of `query` in this order, ignoring case.
pub(crate) fn has_letters(name: &str, query: &str) -> bool {
    let mut letters = lower(name);
    lower(query).all(|wanted| letters.any(|letter| letter == wanted))
}

/// Whether `name` begins with `start`, ignoring case.
pub(super) fn begins_with(name: &str, start: &str) -> bool {
    let mut letters = lower(name);
    lower(start).all(|wanted| letters.next() == Some(wanted))
}

fn lower(text: &str) -> impl Iterator<Item = char> {
    text.chars().flat_map(char::to_lowercase)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn queries_match_letters_in_order() {
        for (name, query, expected) in [
            ("Ubody", "", true),
            ("Ubody", "ubd", true),
            ("Ubody", "bu", false),
            ("右腕", "腕", true),
        ] {
            assert_eq!(has_letters(name, query), expected, "{name} {query}");
        }
    }
}
