//! Splits the names of joints and parts into words.

use std::borrow::Cow;

use unicode_normalization::UnicodeNormalization;

/// How many letters of a name are read: no meaningful name is longer.
const MAX_LETTERS: usize = 128;
/// How many quarters of all names must share a beginning up to `_` for it to count as a prefix; the root may lack it.
const PREFIX_QUARTERS: usize = 3;

/// The kind of a letter, for splitting words.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Kind {
    Upper,
    Lower,
    Digit,
    /// A letter of a script without case.
    Plain,
    Separator,
}

impl Kind {
    fn of(letter: char) -> Self {
        if letter.is_numeric() {
            Self::Digit
        } else if letter.is_uppercase() {
            Self::Upper
        } else if letter.is_lowercase() {
            Self::Lower
        } else if letter.is_alphabetic() {
            Self::Plain
        } else {
            Self::Separator
        }
    }
}

/// The words of a name in lower case, split at changes of case, digits and separators: `lForeArm` gives l, fore, arm;
/// `LHipJoint` gives l, hip, joint; `左腕2` gives 左腕, 2. Katakana become hiragana, full-width and half-width letters the usual
/// ones (NFKC).
pub(crate) fn split(name: &str) -> Vec<String> {
    // Most names are ASCII, which normalizing leaves as it is: splitting names took a sixth of the time after a keystroke.
    let letters: Vec<char> = if name.is_ascii() {
        name.chars().take(MAX_LETTERS).collect()
    } else {
        name.nfkc().take(MAX_LETTERS).map(hiragana).collect()
    };
    let mut words: Vec<String> = Vec::new();
    let mut before = Kind::Separator;
    for (index, letter) in letters.iter().enumerate() {
        let kind = Kind::of(*letter);
        // The last of several capitals belongs to the next word: `LHip`.
        let capital_of_next = kind == Kind::Upper
            && before == Kind::Upper
            && letters
                .get(index + 1)
                .is_some_and(|next| Kind::of(*next) == Kind::Lower);
        let same_word =
            kind == before && !capital_of_next || (before, kind) == (Kind::Upper, Kind::Lower);
        if kind != Kind::Separator {
            match words.last_mut() {
                Some(word) if same_word => word.extend(letter.to_lowercase()),
                _ => words.push(letter.to_lowercase().collect()),
            }
        }
        before = kind;
    }
    words
}

/// Whether a name has one of these words, which are given in lower case and hiragana, in the singular; words with kanji also count
/// within others, as in `奥の足`.
pub(crate) fn has_word(name: &str, known: &str) -> bool {
    let is_kanji = |word: &str| word.contains(|letter| ('\u{3400}'..='\u{9fff}').contains(&letter));
    split(name).iter().any(|word| {
        let singular = word.strip_suffix('s').unwrap_or(word);
        let mut known = known.split_whitespace();
        known.any(|known| {
            known == word || known == singular || is_kanji(known) && word.contains(known)
        })
    })
}

/// Whether a word is a number.
pub(crate) fn is_number(word: &str) -> bool {
    word.chars().all(char::is_numeric)
}

fn hiragana(letter: char) -> char {
    /// Distance between the katakana and hiragana blocks in Unicode.
    const APART: u32 = 0x60;
    match letter {
        'ァ'..='ヶ' => char::from_u32(u32::from(letter) - APART).unwrap_or(letter),
        _ => letter,
    }
}

/// The names without everything up to their last `:`, and without the beginnings up to `_` that most of them share. `says`
/// tells whether a beginning is meaningful and must stay.
pub(crate) fn without_prefixes<'a>(names: &[&'a str], says: impl Fn(&str) -> bool) -> Vec<&'a str> {
    let mut names: Vec<&str> = names
        .iter()
        .map(|name| match name.rsplit_once(':') {
            Some((_, rest)) if !rest.is_empty() => rest,
            _ => name,
        })
        .collect();
    // Each round removes one prefix; more than a few are not prefixes but a naming style.
    for _ in 0..4 {
        let Some(prefix) = shared_prefix(&names) else {
            break;
        };
        if says(&prefix) {
            break;
        }
        for name in &mut names {
            *name = name.strip_prefix(prefix.as_ref()).unwrap_or(name);
        }
    }
    names
}

/// The beginning up to and including the first `_` that most names share.
fn shared_prefix(names: &[&str]) -> Option<Cow<'static, str>> {
    let mut prefixes: Vec<&str> = names
        .iter()
        .filter_map(|name| {
            let end = name.find('_')? + 1;
            (end < name.len()).then(|| &name[..end])
        })
        .collect();
    prefixes.sort_unstable();
    let most = prefixes
        .chunk_by(|a, b| a == b)
        .max_by_key(|group| group.len())?;
    (names.len() > 1 && most.len() * 4 >= names.len() * PREFIX_QUARTERS)
        .then(|| Cow::Owned(most[0].to_owned()))
}
