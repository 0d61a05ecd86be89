//! Every string is read, as a text and as a description, and its settings are computed.

use okoshi::internals::lang::{Container, parse, settings, variables::Variables};
use okoshi::internals::source::Text;

pub(super) fn check(bytes: &[u8]) -> bool {
    let Ok(string) = std::str::from_utf8(bytes) else {
        return false;
    };
    for container in [Container::Text, Container::Desc] {
        let text = Text::plain(string, 0);
        let (annotation, mut found) = parse(&text, container);
        let variables = Variables::collect([(&text, &annotation)], &mut found);
        settings(&text, &annotation, &variables, &mut found);
        super::drawing::check_places(string, &found);
    }
    true
}

/// The strings of the cases.
pub(super) fn seeds() -> Vec<Vec<u8>> {
    let cases = super::files::cases();
    let strings = cases.iter().flat_map(|case| {
        let tags = ["<text", "<tspan", "<desc"].into_iter();
        tags.flat_map(|tag| case.split(tag).skip(1))
            .filter_map(|rest| {
                let (_, characters) = rest.split_once('>')?;
                characters.split('<').next()
            })
    });
    let mut strings: Vec<Vec<u8>> = strings
        .filter(|string| !string.trim().is_empty())
        .map(|string| string.as_bytes().to_vec())
        .collect();
    strings.sort();
    strings.dedup();
    strings
}
