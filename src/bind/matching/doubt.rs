//! Whether strings may be lettering that looks like strings: the pins `A` and `B` of a chip, the price `US$5`, an address.

use rustc_hash::FxHashSet;
use typed_index_collections::TiSlice;

use super::meant::{Sense, Topic};
use crate::bind::bindings::{DrawingString, StringId};
use crate::bind::names::{ROOT, of_element};
use crate::diagnostic::nearest_word;
use crate::lang::ast::{Annotation, Part};
use crate::lang::says_keyword;
use crate::svg::Drawing;

/// So many parents are compared with all names for a misspelling: nobody misspells more and none right.
const COMPARED: usize = 8;
/// Shorter names are as near to all others of their length.
const MISSPELLED: usize = 3;

/// Whether nothing in the strings of a drawing can only be meant for okoshi: no keyword, no parent that the drawing knows, and
/// most names say nothing about a figure.
pub(in crate::bind) fn is_doubtful(
    drawing: &Drawing,
    strings: &TiSlice<StringId, DrawingString>,
) -> bool {
    if strings.is_empty() || strings.iter().any(|one| says_keyword(one.text.as_str())) {
        return false;
    }
    let parts = strings
        .iter()
        .filter_map(|string| match &string.annotation {
            Annotation::Part(part) => Some(part),
            _ => None,
        });
    let parts: Vec<&Part> = parts.collect();
    let names = parts.iter().filter_map(|part| part.name.as_ref());
    let names: Vec<&str> = names.map(|name| name.text.as_str()).collect();
    let understood = names.iter().filter(|name| is_understood(name)).count();
    2 * understood <= names.len() && !knows_a_parent(drawing, &parts, &names)
}

/// Whether a name says which piece of a figure it means: `Head`, not the pin `L`, nor a word for a place.
fn is_understood(name: &str) -> bool {
    let topic = Sense::of(name).topic;
    topic.is_some_and(|topic| topic != Topic::Scenery)
}

/// Whether a name has letters: those of the pins of a chip are often numbers.
fn is_word(name: &str) -> bool {
    name.chars().any(char::is_alphabetic)
}

/// Whether one of the parents is a name in the drawing, or nearly.
fn knows_a_parent(drawing: &Drawing, parts: &[&Part], names: &[&str]) -> bool {
    let parents = parts.iter().filter_map(|part| part.parent.as_ref());
    let parents = parents.map(|name| name.text.as_str());
    let parents: Vec<&str> = parents.filter(|parent| is_word(parent)).collect();
    if parents.is_empty() {
        return false;
    }
    let shapes = drawing.shapes.iter();
    let shapes = shapes.filter_map(|shape| of_element(&shape.element, None));
    let groups = drawing.groups.iter();
    let groups = groups.filter_map(|group| of_element(&group.element, None));
    let own: Vec<String> = shapes.chain(groups).map(|own| own.name).collect();
    let mut known: FxHashSet<&str> = own.iter().map(String::as_str).collect();
    known.extend(names);
    known.insert(ROOT);
    parents.iter().any(|parent| known.contains(parent))
        || parents.iter().take(COMPARED).any(|parent| {
            let known = known.iter().copied();
            parent.chars().count() >= MISSPELLED && nearest_word(parent, known).is_some()
        })
}
