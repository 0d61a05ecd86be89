//! `OKOSHI_REWRITE`: expected results that tests rewrite instead of comparing them.

/// What can be rewritten.
const ALL: [&str; 3] = ["cases", "pictures", "generated"];

/// Whether `OKOSHI_REWRITE`, a list with commas, names `what`.
pub(crate) fn rewrites(what: &str) -> bool {
    let list = std::env::var("OKOSHI_REWRITE").unwrap_or_default();
    let mut named = list.split(',').filter(|word| !word.is_empty());
    let unknown = named.clone().find(|word| !ALL.contains(word));
    assert_eq!(
        unknown, None,
        "OKOSHI_REWRITE is a list of these, with commas: {ALL:?}"
    );
    named.any(|word| word == what)
}
