//! After any changes an incremental compile gives what a compile from scratch gives.
//!
//! An input is a drawing followed by changes, each after a zero byte: a kind, two bytes for the place, and the text that is
//! inserted.

use std::ops::Range;

use okoshi::Memo;
use okoshi::compile::{Compiled, Compiler, Options, compile};
use okoshi::export::{GLB, to_memory};

use super::{drawing, files};

/// The most changes of an input.
const MOST: usize = 12;

pub(super) fn check(bytes: &[u8]) -> bool {
    let mut pieces = bytes.split(|byte| *byte == 0);
    let Ok(drawing) = std::str::from_utf8(pieces.next().unwrap_or_default()) else {
        return false;
    };
    let (options, resolver) = (Options::default(), drawing::linked());
    let mut history = vec![drawing.to_owned()];
    let mut compiler = Compiler::default();
    let mut surfaces = Memo::default();
    let mut held = compiler.compile(drawing, &options, &resolver);
    assert!(!held.has_crashed(), "{:?}", held.diagnostics);
    let is_drawn = !held.scene.nodes.is_empty();
    for change in pieces.take(MOST) {
        apply(change, &mut history);
        let text = history.last().expect("the drawing");
        let incremental = compiler.compile(text, &options, &resolver);
        let fresh = compile(text, &options, &resolver);
        assert!(!fresh.has_crashed(), "{:?}", fresh.diagnostics);
        assert_eq!(
            format!("{:#?}", incremental.diagnostics),
            format!("{:#?}", fresh.diagnostics),
            "{text}"
        );
        assert_eq!(incremental.dependencies, fresh.dependencies, "{text}");
        assert_eq!(described(&incremental), described(&fresh), "{text}");
        assert!(incremental.scene == fresh.scene, "{text}");
        let models = [
            to_memory(&GLB, &incremental.scene, Some(&mut surfaces)),
            to_memory(&GLB, &fresh.scene, None),
        ];
        let [cached, made] = models.map(|model| model.expect("a scene keeps its own rules").bytes);
        assert!(cached == made, "{text}");
        // What is still held must not change; every other time it is dropped.
        held = match history.len() % 2 {
            0 => incremental,
            _ => fresh,
        };
    }
    drop(held);
    is_drawn
}

fn described(compiled: &Compiled) -> String {
    format!("{:?}\n{:?}", compiled.bindings, compiled.drawing)
}

/// Adds the text after a change to the history, or undoes the last one.
fn apply(change: &[u8], history: &mut Vec<String>) {
    if change.first() == Some(&UNDO) {
        if history.len() > 1 {
            history.pop();
        }
        return;
    }
    let text = history.last().expect("the drawing");
    if let Some((range, inserted)) = replacement(change, text) {
        let mut next = text.clone();
        next.replace_range(range, &inserted);
        history.push(next);
    }
}

/// The kind of a change that undoes the last one.
const UNDO: u8 = b'u';

/// The kind of a change anywhere in the text, and not only in the characters between tags.
const ANYWHERE: u8 = b'a';

/// The byte range that a change replaces, and the text that takes its place; `None` if the text has no place for it.
pub(super) fn replacement(change: &[u8], text: &str) -> Option<(Range<usize>, String)> {
    let (&[kind, high, low], inserted) = change.split_first_chunk()?;
    let places = match kind {
        ANYWHERE => boundaries(text, 0, text.len()),
        _ => between_tags(text),
    };
    let last = places.len().checked_sub(1)?;
    let share = usize::from(u16::from_be_bytes([high, low]));
    let start = share * last / usize::from(u16::MAX);
    // Control characters delete as many characters as their code, all others none.
    let deleted = usize::from(kind) * usize::from(kind < 32);
    let (start, end) = (places[start], places[(start + deleted).min(last)]);
    // From one string to another there is markup, which is only deleted by chance.
    let end = text[start..end].find('<').map_or(end, |at| start + at);
    Some((start..end, String::from_utf8_lossy(inserted).into_owned()))
}

/// The places between characters in a range of the text, its end included.
fn boundaries(text: &str, start: usize, end: usize) -> Vec<usize> {
    (start..=end)
        .filter(|at| text.is_char_boundary(*at))
        .collect()
}

/// The places in the characters between tags.
fn between_tags(text: &str) -> Vec<usize> {
    let ends = text.match_indices('>').map(|(at, _)| at + 1);
    let places = ends.flat_map(|start| {
        let length = text[start..].find('<').unwrap_or(0);
        boundaries(text, start, start + length)
    });
    let mut places: Vec<usize> = places.collect();
    // Characters may contain a `>`, too.
    places.sort_unstable();
    places.dedup();
    places
}

pub(super) fn seeds() -> Vec<Vec<u8>> {
    let changes: [&[u8]; 3] = [
        b"\0s\x80\x00a\0s\x81\x00$\0\x01\x81\x00\0s\x70\x00@Body",
        b"\0s\xff\xffShape round\0u\0\x02\xf0\x00%Scale 2\0a\x40\x00\"",
        b"\0\x05\xc0\x00&amp;\0s\x20\x00 Color red\0u\0u\0s\x60\x00\xe8\x85\x95",
    ];
    files::cases_with(&changes)
}
