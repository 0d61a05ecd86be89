//! The table's examples are strings without a fault.

use super::*;
use crate::diagnostic::Code;
use crate::lang::keyword::{Keyword, kinds, words};

#[track_caller]
fn faultless(example: &str) -> Reading {
    let mut reading = read(&Text::plain(example, 0), Place::Text);
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
        let reading = faultless(row.example);
        let used = |setting: &Setting| setting.keyword == *keyword;
        assert!(reading.settings.iter().any(used), "{}", row.example);
    }
}

#[test]
fn examples_of_kinds_functions_and_strings() {
    for kind in &kinds::KINDS {
        let reading = faultless(kind.example);
        let words = &reading.settings[0].words;
        assert!(words.contains(kind.name), "{words}");
    }
    for row in &words::FUNCTIONS {
        faultless(row.example);
    }
    for row in &words::STRINGS {
        faultless(row.example);
    }
}
