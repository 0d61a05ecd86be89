//! The names that are in a drawing without a string: labels and ids that a person wrote.

use std::borrow::Cow;

use rustc_hash::FxHashMap;

use super::bindings::NamedBy;
use super::words::{PROGRAM_WORDS, PROGRAM_WORDS_WITH_NUMBERS};
use crate::svg::{Element, GroupId};

/// The name of the virtual node that is the parent of parts without one.
pub(super) const ROOT: &str = "Root";
/// Longer labels are texts, not names; in characters.
const MAX_NAME: usize = 64;
/// The least length of a run of hexadecimal digits that no person writes.
const HEX_RUN: usize = 6;
/// How often letters and digits alternate in a word that a program drew by lot.
const MIXED: usize = 4;

/// The name that an element has from a person, and where it is written.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct OwnName {
    pub(super) name: String,
    pub(super) by: NamedBy,
}

/// Numbers for names that are taken, as in `Tree-2`: per name the number to try next.
#[derive(Debug, Default)]
pub(crate) struct Numbers(FxHashMap<String, usize>);

impl Numbers {
    /// A name with a number that makes it free: the first one that was not tried for it yet, from `first` on.
    pub(crate) fn free(
        &mut self,
        name: &str,
        first: usize,
        is_free: impl Fn(&str) -> bool,
    ) -> String {
        let next = self.0.entry(name.to_owned()).or_insert(first);
        loop {
            let numbered = format!("{name}-{next}");
            *next += 1;
            if is_free(&numbered) {
                return numbered;
            }
        }
    }
}

/// The name in a label or an id if a person wrote it; `None` if a program made it.
///
/// Programs make words of theirs, alone or with numbers (`path123`, `Layer 1 copy`), runs of hexadecimal digits, and single
/// letters with numbers. Escapes of Illustrator and CorelDRAW are decoded, and the number dropped that Illustrator adds to an id
/// that is taken (`arm_x5F_left_2_`).
pub(crate) fn written_by_a_person(raw: &str) -> Option<String> {
    let raw = raw.trim();
    // Inkscape shows ids as `#id`, and old versions wrote that into the label.
    let raw = raw.strip_prefix('#').unwrap_or(raw);
    let decoded = decoded(without_copy_number(raw));
    let words: Vec<&str> = decoded.split_whitespace().collect();
    // A quotation mark cannot be written in a string.
    let name = words.join(" ").replace(['"', '＂'], "'");
    let fits = name.chars().count() <= MAX_NAME && !name.chars().any(char::is_control);
    (fits && !is_made_by_a_program(&name)).then_some(name)
}

/// Without the number that Illustrator adds to an id that is taken: `arm_2_`.
fn without_copy_number(id: &str) -> &str {
    let Some(rest) = id.strip_suffix('_') else {
        return id;
    };
    let bare = rest.trim_end_matches(|c: char| c.is_ascii_digit());
    match bare.strip_suffix('_') {
        Some(name) if bare.len() < rest.len() && !name.is_empty() => name,
        _ => id,
    }
}

/// With the characters that `_x5F_` or `_x0020_` stand for.
fn decoded(id: &str) -> Cow<'_, str> {
    if !id.contains("_x") {
        return Cow::Borrowed(id);
    }
    let mut out = String::new();
    let mut rest = id;
    while let Some(at) = rest.find("_x") {
        out.push_str(&rest[..at]);
        let code = &rest[at + 2..];
        let digits = code.bytes().take_while(u8::is_ascii_hexdigit).count();
        let escaped = (2..=6).contains(&digits) && code[digits..].starts_with('_');
        let letter = u32::from_str_radix(&code[..digits], 16)
            .ok()
            .filter(|_| escaped)
            .and_then(char::from_u32);
        match letter {
            Some(letter) => {
                out.push(letter);
                rest = &code[digits + 1..];
            }
            None => {
                out.push_str("_x");
                rest = code;
            }
        }
    }
    out.push_str(rest);
    Cow::Owned(out)
}

/// Whether no person chose a name: it has no letters, or its words are those of programs.
fn is_made_by_a_program(name: &str) -> bool {
    let lower = name.to_lowercase();
    let chunks = lower.split(|c: char| !c.is_alphanumeric());
    let chunks: Vec<&str> = chunks.filter(|chunk| !chunk.is_empty()).collect();
    let mut words = Vec::new();
    let mut numbers = false;
    for chunk in chunks {
        if is_random(chunk) {
            numbers = true;
            continue;
        }
        for word in chunk.split(char::is_numeric) {
            if !word.is_empty() {
                words.push(word);
            }
        }
        numbers |= chunk.chars().any(char::is_numeric);
    }
    // `Mask group` is as clear as `Mask 1`.
    let beside = numbers || words.iter().any(|word| PROGRAM_WORDS.contains(word));
    let program = |word: &&str| {
        PROGRAM_WORDS.contains(*word) || beside && PROGRAM_WORDS_WITH_NUMBERS.contains(*word)
    };
    // One letter says nothing, a sign of a script of syllables or words does.
    let letter = |word: &&str| word.len() == 1;
    match words.as_slice() {
        [only] if letter(only) => true,
        words => words.iter().all(|word| program(word) || letter(word)),
    }
}

/// Whether a word was drawn by lot: a run of hexadecimal digits, or letters and digits in turns.
fn is_random(word: &str) -> bool {
    let digits = word.bytes().filter(u8::is_ascii_digit).count();
    let hex = word.len() >= HEX_RUN && word.bytes().all(|byte| byte.is_ascii_hexdigit());
    let turns = word
        .as_bytes()
        .windows(2)
        .filter(|pair| pair[0].is_ascii_digit() != pair[1].is_ascii_digit())
        .count();
    hex && (digits >= 2 && turns >= 2 || digits * 2 >= word.len()) || turns >= MIXED
}

/// The name that an element has from a person: its label, else its id.
pub(super) fn of_element(element: &Element, group: Option<GroupId>) -> Option<OwnName> {
    let by_label = element.label.as_deref().and_then(written_by_a_person);
    let by_label = by_label.map(|name| (name, NamedBy::Label { group }));
    let (name, by) = by_label.or_else(|| {
        let id = element.id.as_deref().and_then(written_by_a_person)?;
        Some((id, NamedBy::Id { group }))
    })?;
    Some(OwnName { name, by })
}

#[cfg(test)]
mod tests {
    use super::written_by_a_person;

    #[test]
    fn words_of_programs_are_no_names() {
        for id in [
            "path123",
            "g45",
            "rect7-3",
            "Layer_1",
            "Layer 1",
            "Ebene 1",
            "Calque 1",
            "レイヤー 1",
            "Vector_3",
            "Group 12",
            "XMLID_2_",
            "SVGID_1_",
            "Artboard",
            "Frame 1",
            "Ellipse 4",
            "svg8",
            "use12",
            "clip0_1_2",
            "Union",
            "Subtract",
            "Rectangle",
            "Path",
            "Shape",
            "path3304-6-1-5",
            "Layer_x0020_1",
            "_x31_",
            "_Group_2",
            "<Path>",
            "Oval-Copy-2",
            "Fill-1",
            "Page-1",
            "Combined-Shape",
            "(Curve)",
            "_1234567",
            "17",
            "a",
            "s12",
            "l3",
            "uuid-3f2504e0-4f89-11d3-9a0c-0305e82c3301",
            "d41d8cd98f00b204",
            "layer1",
            "#path3304",
            "Layer 1 copy 2",
            "Слой_1",
            "图层 1",
            "Star 1",
            "Mask group",
            "Clip path group",
            "Compound_Path",
            "Isolation_Mode",
            "surface12",
            "",
            "  ",
            "-",
            "e8Xk2b9qQ1z",
            "Plan_x0020_1",
            "グループ 3",
            "Isolationsmodus",
            "svg_12",
            "Layer_1-2",
            "Objekt 2",
            "Réunion",
            "Linked Path Group",
            "圆角矩形 1",
            "角丸長方形 2",
        ] {
            assert_eq!(written_by_a_person(id), None, "{id}");
        }
    }

    #[test]
    fn what_people_write_are_names() {
        for (id, name) in [
            ("pants_x5F_front", "pants_front"),
            ("pants_x5F_front_2_", "pants_front"),
            ("hand_1_", "hand"),
            ("Left_x20_arm", "Left arm"),
            ("Left arm_2", "Left arm_2"),
            ("arm2", "arm2"),
            ("finger_3", "finger_3"),
            ("頭", "頭"),
            ("右腕", "右腕"),
            ("Group arm", "Group arm"),
            ("star", "star"),
            ("ball", "ball"),
            ("facade", "facade"),
            ("bed2", "bed2"),
            ("  two \n words ", "two words"),
            ("the \"big\" one", "the 'big' one"),
            ("hair_2", "hair_2"),
            ("Linked arms", "Linked arms"),
            ("Objekt", "Objekt"),
            ("hairHighlights_1_", "hairHighlights"),
            ("L arm", "L arm"),
            ("path to the house", "path to the house"),
            ("mer_x2D_body", "mer-body"),
            ("_x5F_x_wing", "_x_wing"),
        ] {
            assert_eq!(written_by_a_person(id).as_deref(), Some(name), "{id}");
        }
    }
}
