//! The names of parts: those that strings give them, and those that people gave their shapes and groups.

use rustc_hash::{FxHashMap, FxHashSet};
use typed_index_collections::{TiSlice, TiVec};

use super::Context;
use crate::anatomy::{self, Term, Thing};
use crate::bind::bindings::{DrawingString, NamedBy, PartId, PartKind, StringHolder};
use crate::bind::matching::Matched;
use crate::bind::names::{Numbers, OwnName, ROOT, of_element};
use crate::diagnostic::{Code, Diagnostic};
use crate::lang::ast::{self, Annotation, Name};
use crate::source::Span;
use crate::svg::Drawing;

/// The names of the parts.
pub(super) struct Names {
    /// Per part; empty for parts without a name.
    pub(super) of_part: TiVec<PartId, OwnName>,
    /// The main parts by name; of several with the same name, the first.
    pub(super) by_name: FxHashMap<String, PartId>,
    /// The names of the tile layers, which no part may have.
    of_layers: FxHashSet<String>,
}

/// Per part the name that its string gives it: the name that it says, or else that of the element that it describes.
pub(super) fn of_strings(drawing: &Drawing, matched: &Matched) -> TiVec<PartId, OwnName> {
    let name = |part: PartId| {
        let string = matched.string_of(part)?;
        let Annotation::Part(annotation) = &string.annotation else {
            return None;
        };
        if let Some(name) = &annotation.name {
            return Some(OwnName {
                name: name.text.clone(),
                by: NamedBy::String,
            });
        }
        let group = match string.holder {
            StringHolder::Group(group) => Some(group),
            StringHolder::Label(_) | StringHolder::Shape(_) => None,
        };
        let element = group.map_or(
            &drawing.shapes[matched.parts[part].shape].element,
            |group| &drawing.groups[group].element,
        );
        Some(OwnName {
            name: element.own_name().to_owned(),
            by: match element.label {
                Some(_) => NamedBy::Label { group },
                None => NamedBy::Id { group },
            },
        })
    };
    let nameless = || OwnName {
        name: String::new(),
        by: NamedBy::String,
    };
    let parts = matched.parts.keys();
    parts
        .map(|part| name(part).unwrap_or_else(nameless))
        .collect()
}

/// The name that a main part has without a string: that of its node's group, else that of its shape.
pub(super) fn of_main_part(drawing: &Drawing, matched: &Matched, part: PartId) -> Option<OwnName> {
    let part = &matched.parts[part];
    part.node_group
        .and_then(|group| of_element(&drawing.groups[group].element, Some(group)))
        .or_else(|| {
            let element = &drawing.shapes[part.shape].element;
            of_element(element, None).filter(|_| !part.is_rest)
        })
}

/// A part that carries what lies before it only if nothing else does, by its name.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Behind {
    Cape,
    Wheel,
}

impl Behind {
    /// What a name with these terms says.
    pub(super) fn of(name: &str, terms: &[Term]) -> Option<Self> {
        if anatomy::thing(name) == Some(Thing::Wheel) {
            return Some(Self::Wheel);
        }
        terms.contains(&Term::Cape).then_some(Self::Cape)
    }
}

impl Names {
    /// The names of main parts that strings give. Reports those that are given twice.
    pub(super) fn new(
        context: Context<'_>,
        of_part: TiVec<PartId, OwnName>,
        diagnostics: &mut Vec<Diagnostic>,
    ) -> Self {
        let by_name = by_name(context, &of_part, diagnostics);
        let layers = context.matched.layers.tile_layers();
        Self {
            of_part,
            by_name,
            of_layers: layers.map(|(_, layer)| layer.name.clone()).collect(),
        }
    }

    /// The name of a part.
    pub(super) fn of(&self, part: PartId) -> &str {
        &self.of_part[part].name
    }

    /// Whether no part and no tile layer has a name.
    pub(super) fn is_free(&self, name: &str) -> bool {
        !self.by_name.contains_key(name) && !self.of_layers.contains(name)
    }

    /// Names a main part.
    pub(super) fn give(&mut self, part: PartId, name: String, by: NamedBy) {
        self.by_name.insert(name.clone(), part);
        self.of_part[part] = OwnName { name, by };
    }

    /// Names the main parts that have no name yet by what a person called them. A name that is taken gets a number.
    pub(super) fn give_own(&mut self, context: Context<'_>) {
        let mut numbers = Numbers::default();
        for part in context.mains() {
            if !self.of(part).is_empty() {
                continue;
            }
            let Some(own) = of_main_part(context.drawing, context.matched, part) else {
                continue;
            };
            let is_free = |name: &str| self.is_free(name) && name != ROOT;
            let name = if is_free(&own.name) {
                own.name
            } else {
                numbers.free(&own.name, 2, is_free)
            };
            self.give(part, name, own.by);
        }
    }
}

/// The name that a part's string says.
fn said(matched: &Matched, part: PartId) -> Option<&Name> {
    match &matched.string_of(part)?.annotation {
        Annotation::Part(part) => part.name.as_ref(),
        _ => None,
    }
}

/// The main parts by the names that strings give them; of several with the same name, the first.
fn by_name(
    context: Context<'_>,
    of_part: &TiSlice<PartId, OwnName>,
    diagnostics: &mut Vec<Diagnostic>,
) -> FxHashMap<String, PartId> {
    let Context {
        drawing,
        matched,
        nodes,
    } = context;
    let mut names: FxHashMap<String, PartId> = FxHashMap::default();
    names.reserve(of_part.len());
    let span = |part: PartId| match (said(matched, part), matched.string_of(part)) {
        (Some(name), Some(string)) => string.text.span(name.range.clone()),
        (None, Some(string)) => string.text.whole(),
        _ => drawing.shapes[matched.parts[part].shape].element.span,
    };
    for (part, OwnName { name, .. }) in of_part.iter_enumerated() {
        if nodes.kind[part] != PartKind::Main || name.is_empty() {
            continue;
        }
        if let Some(first) = names.get(name) {
            let message = format!("two parts are named `{name}`");
            diagnostics.push(
                Diagnostic::new(Code::DuplicateName, span(part), message)
                    .label("the second one")
                    .related(span(*first), "the first one")
                    .help("rename one of them"),
            );
        } else {
            names.insert(name.clone(), part);
        }
    }
    let mut layers: FxHashMap<&str, Span> = FxHashMap::default();
    for (_, layer) in matched.layers.tile_layers() {
        let own = name_span(&matched.strings[layer.string]);
        let part = names.get(&layer.name).map(|part| span(*part));
        let Some(first) = part.or_else(|| layers.get(layer.name.as_str()).copied()) else {
            layers.insert(&layer.name, own);
            continue;
        };
        let what = if part.is_some() {
            "a part"
        } else {
            "another tile layer"
        };
        let message = format!("this tile layer and {what} are both named `{}`", layer.name);
        diagnostics.push(
            Diagnostic::new(Code::DuplicateName, own, message)
                .related(first, "the first one")
                .help("rename one of them"),
        );
    }
    names
}

/// The place of the name in a string; the whole string if it has none.
fn name_span(string: &DrawingString) -> Span {
    match &string.annotation {
        Annotation::Part(ast::Part {
            name: Some(name), ..
        }) => string.text.span(name.range.clone()),
        _ => string.text.whole(),
    }
}
