//! The examples of the table are strings without diagnostics.

use super::*;
use crate::diagnostic::Code;
use crate::lang::keyword::{Keyword, kinds, vocabulary};

#[track_caller]
fn read_without_diagnostics(example: &str) -> Reading {
    let mut reading = read(&Text::plain(example, 0), Container::Text);
    reading
        .diagnostics
        .retain(|diagnostic| diagnostic.code != Code::NotBuiltYet);
    assert!(
        reading.diagnostics.is_empty(),
        "{}",
        show(example, &reading.diagnostics)
    );
    reading
}

#[test]
fn examples_of_keywords() {
    for keyword in Keyword::ALL {
        let row = keyword.row();
        let reading = read_without_diagnostics(row.example);
        let used = |setting: &Setting| {
            let performance = setting.performance.as_deref();
            setting.keyword == *keyword || performance.is_some_and(|own| own.keyword == *keyword)
        };
        assert!(reading.settings.iter().any(used), "{}", row.example);
    }
}

/// The example on the manual page of a code gives exactly that diagnostic.
#[test]
fn examples_of_diagnostics() {
    for code in Code::ALL {
        let language = matches!(code.id().as_bytes(), [b'E', b'1', ..])
            || ["E005", "W301", "W302", "W305", "W310", "H405"].contains(&code.id());
        if !language {
            continue;
        }
        let manual = code.manual();
        let (_, rest) = manual.split_once("```text\n").unwrap();
        let example = rest.split_once("```").unwrap().0.trim();
        let example = example.replace(
            "((((…))))",
            &format!("{}1{}", "(".repeat(99), ")".repeat(99)),
        );
        let mut reading = read(&Text::plain(&example, 0), Container::Text);
        reading
            .diagnostics
            .retain(|found| found.code != Code::NotBuiltYet || *code == Code::NotBuiltYet);
        let codes: Vec<_> = reading.diagnostics.iter().map(|found| found.code).collect();
        // The second string also breaks the word before it.
        let expected = match code {
            Code::UnexpectedSign => vec![Code::UnexpectedSign, Code::ArgumentType],
            code => vec![*code],
        };
        assert_eq!(codes, expected, "{example}");
    }
}

#[test]
fn examples_of_kinds_functions_and_strings() {
    for kind in &kinds::KINDS {
        let reading = read_without_diagnostics(kind.example);
        let words = &reading.settings[0].text;
        assert!(words.contains(kind.name), "{words}");
    }
    for row in &vocabulary::FUNCTIONS {
        read_without_diagnostics(row.example);
    }
    for row in &vocabulary::STRINGS {
        read_without_diagnostics(row.example);
    }
}
