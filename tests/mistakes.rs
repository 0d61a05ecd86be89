//! No mistake in a string goes unnoticed: drawings whose strings were right get one letter wrong, and what okoshi says must be about that.
#![cfg(feature = "disk")]

mod common;

use std::collections::BTreeSet;
use std::fs;
use std::ops::Range;
use std::path::Path;

use common::compiled;
use common::law::Tally;
use okoshi::FolderResolver;
use okoshi::diagnostic::{Code, Diagnostic, Severity};
use okoshi::internals::lang::keyword::Keyword;

/// Mistakes of a kind that are made in a drawing, at most: some drawings have hundreds of strings alike.
const MOST_OF_A_KIND: usize = 2;
/// Words that are shorter have another word within one mistake too often.
const SHORTEST: usize = 4;

/// A slip of the pen, and its place in the source.
struct Slip {
    place: Range<usize>,
    written: String,
}

/// The texts of a drawing: what stands between tags, with its place.
fn texts(source: &str) -> impl Iterator<Item = (usize, &str)> {
    let ends = source.match_indices('>').map(|(at, _)| at + 1);
    ends.filter_map(|start| {
        let length = source[start..].find('<')?;
        let text = &source[start..start + length];
        (!text.trim().is_empty() && !text.trim_start().starts_with('#')).then_some((start, text))
    })
}

/// The words of a text that begin after something, with their places in the source.
fn words((start, text): (usize, &str)) -> impl Iterator<Item = (usize, Option<char>, &str)> {
    let is_in_word = |letter: char| letter.is_alphanumeric() || letter == '_';
    let begins = text.char_indices().filter(move |(at, letter)| {
        let before = text[..*at].chars().next_back();
        is_in_word(*letter) && !before.is_some_and(is_in_word)
    });
    begins.map(move |(at, _)| {
        let word = &text[at..];
        let end = word.find(|letter| !is_in_word(letter));
        let before = text[..at].chars().next_back();
        (start + at, before, &word[..end.unwrap_or(word.len())])
    })
}

/// A word with the first two neighbours from its second letter on that differ in each other's place.
fn swapped(word: &str) -> Option<String> {
    let mut letters: Vec<char> = word.chars().collect();
    let differs = (1..letters.len().saturating_sub(1)).find(|i| letters[*i] != letters[i + 1])?;
    letters.swap(differs, differs + 1);
    (letters.len() >= SHORTEST).then(|| letters.into_iter().collect())
}

fn is_keyword(word: &str) -> bool {
    Keyword::ALL.iter().any(|keyword| keyword.name() == word)
}

/// Keywords and parents with two letters swapped, and keywords whose sign was forgotten.
fn slips(source: &str) -> [(&'static str, Vec<Slip>); 3] {
    let (mut keywords, mut parents, mut signs) = (Vec::new(), Vec::new(), Vec::new());
    for text in texts(source) {
        if !text.1.contains(['$', '@', '%']) {
            continue;
        }
        for (at, before, word) in words(text) {
            let place = at..at + word.len();
            match (before, swapped(word)) {
                (Some('@'), Some(written)) => parents.push(Slip { place, written }),
                (Some('$' | '%' | ' '), Some(written)) if is_keyword(word) => {
                    keywords.push(Slip { place, written });
                }
                _ => {}
            }
            if before == Some('$') && is_keyword(word) && text.1[..at - 1 - text.0].contains('@') {
                signs.push(Slip {
                    place: at - 1..at,
                    written: " ".to_owned(),
                });
            }
        }
    }
    [
        ("keywords misspelled", keywords),
        ("parents misspelled", parents),
        ("signs forgotten", signs),
    ]
}

fn said(findings: &[Diagnostic]) -> BTreeSet<(Code, String)> {
    let said = findings.iter();
    said.map(|finding| (finding.code, finding.message.clone()))
        .collect()
}

/// Whether something that was found is a consequence of the slip, and says so.
fn is_noticed(found: &[Diagnostic], before: &BTreeSet<(Code, String)>) -> bool {
    found.iter().any(|finding| {
        let is_new = !before.contains(&(finding.code, finding.message.clone()));
        is_new && finding.severity() != Severity::Hint
    })
}

#[test]
#[allow(
    clippy::print_stdout,
    reason = "with --nocapture it says what goes unnoticed"
)]
fn slips_of_the_pen_are_noticed() {
    let mut drawings = common::drawings_in("examples");
    drawings.extend(common::drawings_in("tests/cases"));
    let tallies = [Tally::default(), Tally::default(), Tally::default()];
    let mut kinds = [""; 3];
    let mut eaten = Vec::new();
    for path in drawings {
        // Some cases are no text.
        let Ok(source) = fs::read_to_string(&path) else {
            continue;
        };
        let resolver = FolderResolver::new(path.parent().unwrap_or(Path::new(".")));
        let right = compiled(&source, &resolver);
        if right.has_errors() {
            continue;
        }
        let before = said(&right.diagnostics);
        for (kind, (name, slips)) in slips(&source).into_iter().enumerate() {
            kinds[kind] = name;
            let step = slips.len().div_ceil(MOST_OF_A_KIND).max(1);
            for Slip { place, written } in slips.into_iter().step_by(step) {
                let mut wrong = source.clone();
                wrong.replace_range(place.clone(), &written);
                let found = compiled(&wrong, &resolver).diagnostics;
                let is_noticed = is_noticed(&found, &before);
                tallies[kind].count(is_noticed);
                let slip = format!("{}: {} -> {written}", path.display(), &source[place]);
                if !is_noticed {
                    println!("not noticed: {slip}");
                }
                if found.iter().any(|finding| finding.code == Code::Lettering) {
                    eaten.push(slip);
                }
            }
        }
    }
    for (tally, kind) in tallies.iter().zip(kinds) {
        tally.assert_share(kind, 98);
    }
    // One mistake does not make lettering of a drawing's strings; the one case is about lettering with an address.
    assert!(eaten.len() <= 1, "{eaten:#?}");
}
