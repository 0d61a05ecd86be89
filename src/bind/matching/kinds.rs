//! The kinds of parts, now that the strings are bound.

use typed_index_collections::{TiSlice, TiVec};

use super::layers::{LayerKind, Layers};
use super::parts::MatchedPart;
use crate::bind::bindings::{DrawingString, PartId, PartKind, StringId};
use crate::lang::ast::Annotation;
use crate::svg::{Drawing, ShapeId};

/// The kind of every part. `backgrounds` says of each shape whether it is a background, unless a string names it.
pub(super) fn classify(
    drawing: &Drawing,
    strings: &TiSlice<StringId, DrawingString>,
    parts: &TiSlice<PartId, MatchedPart>,
    layers: &Layers,
    backgrounds: &TiSlice<ShapeId, bool>,
) -> TiVec<PartId, PartKind> {
    let kind = |(index, part): (PartId, &MatchedPart)| {
        let is_main = part.main == index;
        match part
            .attributes_from()
            .map(|string| &strings[string].annotation)
        {
            None if backgrounds[part.shape] => PartKind::Unused,
            Some(Annotation::Unused) => PartKind::Unused,
            Some(Annotation::Legend(_)) if is_main => PartKind::Legend,
            _ if is_main => PartKind::Main,
            _ => PartKind::Sub,
        }
    };
    let mut kinds: TiVec<PartId, PartKind> = parts.iter_enumerated().map(kind).collect();
    // Sub-parts are left out together with their main part.
    for (index, part) in parts.iter_enumerated() {
        let of_main = kinds[part.main];
        if part.main != index && matches!(of_main, PartKind::Unused | PartKind::Legend) {
            kinds[index] = of_main;
        }
    }
    if !layers.is_empty() {
        // Parts in views are regions of their characters, and those without a string in tile layers are tiles.
        for (part, kind) in parts.iter().zip(&mut kinds) {
            let group = drawing.shapes[part.shape].group;
            let in_layer = |kind| layers.of_group_and_kind(group, kind).is_some();
            if layers.of_props(group).is_some() && matches!(kind, PartKind::Main | PartKind::Sub) {
                *kind = PartKind::Prop;
            }
            let unbound =
                part.attributes_from().is_none() && parts[part.main].attributes_from().is_none();
            if in_layer(LayerKind::View) && *kind != PartKind::Unused {
                *kind = PartKind::Region;
            } else if unbound && in_layer(LayerKind::Tiles) {
                *kind = PartKind::Tile;
            }
        }
    }
    for (index, part) in parts.iter_enumerated() {
        if let Some(host) = part.host {
            kinds[index] = of_ink(kinds[host]);
        }
    }
    kinds
}

/// The kind of ink on a part of this kind: it is in the same node, or is left out too.
pub(in crate::bind) fn of_ink(host: PartKind) -> PartKind {
    match host {
        PartKind::Main => PartKind::Sub,
        other => other,
    }
}
