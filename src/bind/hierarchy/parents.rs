//! The parents of parts and tile layers: the names after `@`.

use rustc_hash::{FxHashMap, FxHashSet};
use typed_index_collections::{TiSlice, TiVec, ti_vec};

use super::Context;
use super::names::Names;
use crate::bind::bindings::{DrawingString, PartId, PartKind};
use crate::bind::matching::{LayerId, LayerKind, Matched};
use crate::bind::names::ROOT;
use crate::diagnostic::{Code, Diagnostic, nearest_word};
use crate::lang::ast::Annotation;
use crate::lang::quoting::{NamePlace, quoted_if_needed};
use crate::svg::GroupId;

/// Finds the parents that strings name.
pub(super) fn of_strings(
    context: Context<'_>,
    names: &Names,
    diagnostics: &mut Vec<Diagnostic>,
) -> Vec<(PartId, Option<PartId>)> {
    let mut unknown = Unknown::new(&names.by_name);
    let mut found = Vec::new();
    for part in context.mains() {
        let Some(string) = context.matched.string_of(part) else {
            continue;
        };
        match parent(context, names, string, names.of(part), &mut unknown) {
            Ok(None) => {}
            Ok(parent) => found.push((part, parent)),
            Err(finding) => diagnostics.push(*finding),
        }
    }
    found
}

/// Finds the parents that groups in groups give: a hand in the group of its arm hangs on that, whatever else it touches.
pub(super) fn of_groups(context: Context<'_>) -> Vec<(PartId, Option<PartId>)> {
    let Context { matched, .. } = context;
    let mains = context.mains();
    let grouped = mains.filter_map(|part| Some((part, matched.parts[part].node_group?)));
    let grouped: Vec<(PartId, GroupId)> = grouped.collect();
    let of_group: FxHashMap<GroupId, PartId> = grouped
        .iter()
        .rev()
        .map(|(part, group)| (*group, *part))
        .collect();
    let carried = grouped.into_iter().filter_map(|(part, group)| {
        let carrier = matched.node_groups.carrier(group)?;
        let parent = *of_group.get(&carrier)?;
        (parent != part).then_some((part, Some(parent)))
    });
    carried.collect()
}

/// The part that a part's string names after `@`.
fn named_parent(matched: &Matched, part: PartId, names: &Names) -> Option<PartId> {
    match &matched.string_of(part)?.annotation {
        Annotation::Part(part) => names.by_name.get(&part.parent.as_ref()?.text).copied(),
        _ => None,
    }
}

/// Whether a string names what a part hangs on.
pub(super) fn is_attached(matched: &Matched, part: PartId) -> bool {
    let string = matched.string_of(part);
    matches!(string.map(|string| &string.annotation), Some(Annotation::Part(part)) if part.parent.is_some())
}

/// How many parts hang on each other at most where hierarchies are changed; deeper ones stay as they are.
const MAX_DEPTH: usize = 1024;

/// A part and what it hangs on, directly or not; `None` if that is very deep, or a circle.
pub(super) fn chain(
    parents: &TiSlice<PartId, Option<PartId>>,
    part: PartId,
) -> Option<Vec<PartId>> {
    let above = std::iter::successors(Some(part), |part| parents[*part]);
    let chain: Vec<PartId> = above.take(MAX_DEPTH + 1).collect();
    (chain.len() <= MAX_DEPTH).then_some(chain)
}

/// Hangs a part on another one, unless a string says what it hangs on. If the other one hangs on the part, what leads from it to the part
/// hangs on what the part did.
pub(super) fn rehang(
    matched: &Matched,
    parents: &mut TiSlice<PartId, Option<PartId>>,
    part: PartId,
    onto: PartId,
) {
    let Some(chain) = chain(parents, onto).filter(|_| !is_attached(matched, part)) else {
        return;
    };
    match chain.iter().position(|above| *above == part) {
        Some(0) => return,
        Some(place) => {
            let below = chain[place - 1];
            if is_attached(matched, below) {
                return;
            }
            parents[below] = parents[part];
        }
        None => {}
    }
    parents[part] = Some(onto);
}

/// The parts to which strings attach others.
pub(super) fn carrying(matched: &Matched, names: &Names) -> FxHashSet<PartId> {
    let parts = matched.parts.keys();
    parts
        .filter_map(|part| named_parent(matched, part, names))
        .collect()
}

/// Whether a part hangs on another one, directly or not, by strings or by these parents.
pub(super) fn hangs_on(
    matched: &Matched,
    names: &Names,
    parents: &TiSlice<PartId, Option<PartId>>,
    part: PartId,
    other: PartId,
) -> bool {
    let mut at = part;
    // More steps than parts lead in a circle, which is reported later.
    for _ in 0..matched.parts.len() {
        if at == other {
            return true;
        }
        match named_parent(matched, at, names).or(parents[at]) {
            Some(parent) => at = parent,
            None => return false,
        }
    }
    false
}

/// Finds the parents of tile layers.
pub(super) fn of_layers(
    context: Context<'_>,
    names: &Names,
    diagnostics: &mut Vec<Diagnostic>,
) -> TiVec<LayerId, Option<PartId>> {
    let mut unknown = Unknown::new(&names.by_name);
    let layers = context.matched.layers.iter().map(|layer| {
        if layer.kind != LayerKind::Tiles {
            return None;
        }
        let string = &context.matched.strings[layer.string];
        let parent = parent(context, names, string, &layer.name, &mut unknown);
        parent.unwrap_or_else(|finding| {
            diagnostics.push(*finding);
            None
        })
    });
    layers.collect()
}

/// The part that a string names after `@`, if it names one; `own` is the name of the string's own part or layer.
fn parent(
    context: Context<'_>,
    names: &Names,
    string: &DrawingString,
    own: &str,
    unknown: &mut Unknown<'_>,
) -> Result<Option<PartId>, Box<Diagnostic>> {
    let Annotation::Part(annotation) = &string.annotation else {
        return Ok(None);
    };
    let Some(parent) = &annotation.parent else {
        return Ok(None);
    };
    if let Some(parent) = unknown.names.get(&parent.text) {
        return Ok(Some(*parent));
    }
    // `Root` names the virtual root, unless a part has that name.
    if parent.text == ROOT {
        return Ok(None);
    }
    let Context {
        drawing, matched, ..
    } = context;
    let text = &string.text;
    let span = text.span(parent.range.clone());
    let message = format!("there is no part named `{}`", parent.text);
    let mut diagnostic = Diagnostic::new(Code::UnknownParent, span, message);
    let mut layers = matched.layers.tile_layers();
    if let Some(other) = unknown.sub_part(context, names, &parent.text) {
        diagnostic = diagnostic
            .related(
                drawing.shapes[matched.parts[other].shape].element.span,
                "this sub-part has that name, but sub-parts have no joints",
            )
            .help("name the main part of its group instead");
    } else if let Some((_, layer)) = layers.find(|(_, layer)| layer.name == parent.text) {
        diagnostic = diagnostic
            .related(
                matched.strings[layer.string].text.whole(),
                "this tile layer has that name, but tile layers have no joints",
            )
            .help("attach both to the same part, or to none");
    } else {
        if let Some(near) = unknown.nearest(&parent.text, own) {
            diagnostic = diagnostic.label(format!("did you mean `{near}`?")).fix(
                format!("Write `{near}`"),
                span,
                text.escape_at(parent.range.start, &quoted_if_needed(near, NamePlace::Head)),
            );
        }
        diagnostic = diagnostic
            .help("the name after `@` must be the name of a part, spelled exactly the same");
    }
    Err(Box::new(diagnostic))
}

/// How many characters of names are compared with unknown names in one drawing; then no more offers are made.
const MAX_COMPARED: usize = 1 << 22;

/// What is known about names that no main part has, so that one that many strings name is looked up once.
struct Unknown<'a> {
    /// The main parts by name.
    names: &'a FxHashMap<String, PartId>,
    sorted: Option<Vec<&'a str>>,
    /// The nearest names of those looked up: at most two, as one may be that of the part itself.
    near: FxHashMap<String, [Option<&'a str>; 2]>,
    /// The first part that is no main part, by name.
    sub_parts: Option<FxHashMap<String, PartId>>,
    compared: usize,
}

impl<'a> Unknown<'a> {
    fn new(names: &'a FxHashMap<String, PartId>) -> Self {
        Self {
            names,
            sorted: None,
            near: FxHashMap::default(),
            sub_parts: None,
            compared: 0,
        }
    }

    /// The nearest name to an unknown one, except the part's own.
    fn nearest(&mut self, unknown: &str, own: &str) -> Option<&'a str> {
        let near = match self.near.get(unknown) {
            Some(near) => *near,
            None => {
                let near = self.two_nearest(unknown);
                self.near.insert(unknown.to_owned(), near);
                near
            }
        };
        near.into_iter().flatten().find(|name| *name != own)
    }

    fn two_nearest(&mut self, unknown: &str) -> [Option<&'a str>; 2] {
        let names = self.names;
        let sorted = self.sorted.get_or_insert_with(|| {
            let mut sorted: Vec<&str> = names.keys().map(String::as_str).collect();
            sorted.sort_unstable();
            sorted
        });
        self.compared += sorted.len() * unknown.len();
        if self.compared > MAX_COMPARED {
            return [None; 2];
        }
        let first = nearest_word(unknown, sorted.iter().copied());
        let others = sorted.iter().copied().filter(|name| Some(*name) != first);
        let second = first.and_then(|_| nearest_word(unknown, others));
        [first, second]
    }

    /// A sub-part, or a part that is left out, with a name.
    fn sub_part(&mut self, context: Context<'_>, names: &Names, name: &str) -> Option<PartId> {
        let sub_parts = self.sub_parts.get_or_insert_with(|| {
            let mut found = FxHashMap::default();
            for (part, kind) in context.nodes.kind.iter_enumerated() {
                if *kind != PartKind::Main && !names.of(part).is_empty() {
                    found.entry(names.of(part).to_owned()).or_insert(part);
                }
            }
            found
        });
        sub_parts.get(name).copied()
    }
}

/// Signs that people write in place of `@`.
const OTHER_SIGNS: [char; 7] = [':', '>', '<', '/', '=', '→', '+'];

/// Reports names such as `Arm:Body`, where `Body` is a part.
pub(super) fn other_signs(matched: &Matched, names: &Names, diagnostics: &mut Vec<Diagnostic>) {
    for part in matched.parts.keys() {
        let Some(string) = matched.string_of(part) else {
            continue;
        };
        let Annotation::Part(annotation) = &string.annotation else {
            continue;
        };
        let (Some(name), None) = (&annotation.name, &annotation.parent) else {
            continue;
        };
        let written = &string.text.as_str()[name.range.clone()];
        let Some(at) = written.find(OTHER_SIGNS) else {
            continue;
        };
        let parent = written[at..].trim_start_matches(OTHER_SIGNS);
        if at == 0 || !names.by_name.contains_key(parent) {
            continue;
        }
        let sign = name.range.start + at..name.range.end - parent.len();
        let span = string.text.span(sign);
        let message = format!("`{written}` is read as one name, although `{parent}` is a part");
        diagnostics.push(
            Diagnostic::new(
                Code::SignInName,
                string.text.span(name.range.clone()),
                message,
            )
            .help("what a part is attached to comes after `@`; a name can have other signs")
            .fix("Write `@`", span, "@"),
        );
    }
}

/// Breaks every cycle of parents by making one of its parts a child of the root.
pub(super) fn without_cycles(
    context: Context<'_>,
    names: &Names,
    mut parents: TiVec<PartId, Option<PartId>>,
    diagnostics: &mut Vec<Diagnostic>,
) -> TiVec<PartId, Option<PartId>> {
    let Context {
        drawing, matched, ..
    } = context;
    // For each part, the part at which the walk that visited it began.
    let mut seen: TiVec<PartId, Option<PartId>> = ti_vec![None; parents.len()];
    for start in parents.keys() {
        let mut part = start;
        while seen[part].is_none() {
            seen[part] = Some(start);
            match parents[part] {
                Some(parent) => part = parent,
                None => break,
            }
        }
        if seen[part] != Some(start) || parents[part].is_none() {
            continue;
        }
        let mut cycle = vec![part];
        while let Some(parent) = cycle
            .last()
            .and_then(|last| parents[*last])
            .filter(|parent| *parent != part)
        {
            cycle.push(parent);
        }
        let span = |part: PartId| {
            let string = matched.string_of(part);
            match string.map(|string| (&string.annotation, &string.text)) {
                Some((Annotation::Part(annotation), text)) => annotation
                    .parent
                    .as_ref()
                    .map_or(text.whole(), |parent| text.span(parent.range.clone())),
                _ => drawing.shapes[matched.parts[part].shape].element.span,
            }
        };
        let chain: Vec<String> = cycle
            .iter()
            .chain([&part])
            .map(|part| format!("`{}`", names.of(*part)))
            .collect();
        let message = if cycle.len() == 1 {
            format!("{} is its own parent", chain[0])
        } else {
            format!(
                "parts are attached to each other in a circle: {}",
                chain.join(" on ")
            )
        };
        let mut diagnostic = Diagnostic::new(Code::ParentCycle, span(part), message)
            .help("attach one of them to a part outside the circle, or to none");
        for other in &cycle[1..] {
            diagnostic = diagnostic.related(
                span(*other),
                format!("`{}` is attached to this", names.of(*other)),
            );
        }
        diagnostics.push(diagnostic);
        parents[part] = None;
    }
    parents
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::compile::{Options, compile};
    use crate::resolver::MemoryResolver;

    fn names(count: usize) -> FxHashMap<String, PartId> {
        (0..count)
            .map(|index| (format!("Part{index}"), index.into()))
            .collect()
    }

    #[test]
    fn a_name_that_many_misspell_is_looked_up_once() {
        let names = names(3000);
        let mut unknown = Unknown::new(&names);
        let offer = unknown.nearest("Part10x", "Head");
        assert!(offer.is_some_and(|offer| offer.starts_with("Part10")));
        let compared = unknown.compared;
        for _ in 0..3000 {
            assert_eq!(unknown.nearest("Part10x", "Head"), offer);
        }
        assert_eq!(unknown.compared, compared);
        // A part is no parent of itself.
        let own = offer.unwrap();
        assert_ne!(unknown.nearest("Part10x", own), Some(own));
    }

    #[test]
    fn many_unknown_names_get_a_limited_number_of_offers() {
        let names = names(3000);
        let mut unknown = Unknown::new(&names);
        let offers = (0..3000).filter_map(|index| unknown.nearest(&format!("Prat{index}"), ""));
        assert!(offers.count() < 1000);
    }

    /// The fix for a misspelled parent names the part as the parser reads it: a name in full-width letters without
    /// quotes would be read in ASCII letters, which is another name.
    #[test]
    fn fixes_quote_names_that_need_it() {
        for (name, misspelled, fixed) in [
            ("\"Ｂody\"", "\"Ｂodi\"", "@\"Ｂody\""),
            ("\"#Body\"", "\"#Bodi\"", "@\"#Body\""),
            ("\"left arm\"", "\"left arn\"", "@\"left arm\""),
            ("Body", "Bodi", "@Body"),
        ] {
            let svg = format!(
                r#"<svg xmlns="http://www.w3.org/2000/svg" width="90" height="90">
<rect width="30" height="40"/><text x="9" y="9">{name}</text>
<rect x="50" width="30" height="40"/><text x="59" y="9">Arm@{misspelled}</text></svg>"#
            );
            let compile = |svg: &str| compile(svg, &Options::default(), &MemoryResolver::default());
            let compiled = compile(&svg);
            let mut found = compiled.diagnostics.iter();
            let found = found.find(|found| found.code == Code::UnknownParent);
            let edit = &found.unwrap().fixes[0].edits[0];
            let mut after = svg.clone();
            after.replace_range(edit.span.start..edit.span.end, &edit.text);
            assert!(after.contains(fixed), "{after}");
            let codes: Vec<Code> = compile(&after).diagnostics.iter().map(|d| d.code).collect();
            assert!(!codes.contains(&Code::UnknownParent), "{after}");
        }
    }
}
