//! Every string is read, as a text and as a description, and its settings are computed.
#![no_main]

use libfuzzer_sys::fuzz_target;
use okoshi::lang::{Container, parse, settings, variables::Variables};
use okoshi::source::Text;

fuzz_target!(|string: &str| {
    for container in [Container::Text, Container::Desc] {
        let text = Text::plain(string, 0);
        let (annotation, findings) = parse(&text, container);
        for finding in &findings {
            assert!(string.get(finding.span.start..finding.span.end).is_some(), "{finding:?}");
        }
        let mut findings = Vec::new();
        let variables = Variables::collect([(&text, &annotation)].into_iter(), &mut findings);
        settings(&text, &annotation, &variables, &mut findings);
    }
});
