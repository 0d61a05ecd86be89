//! Binds strings to parts, and resolves attributes and the hierarchy of parts.
//!
//! This is the only module that knows both the drawing and the language. [`bind`] applies the rules of figure.md in their
//! order. The result, a [`Bindings`], has everything that models are built from and that editors ask about.

mod areas;
mod attributes;
mod bare_names;
mod binder;
mod bindings;
mod contact;
mod describe;
mod details;
mod fills;
mod given_depths;
mod hierarchy;
mod ink;
mod joints;
mod layers;
mod leaders;
mod legends;
mod located;
mod many;
mod marks;
mod meant;
mod motions;
mod names;
mod nearest;
mod node_groups;
mod outlines;
mod parents;
mod settings;
mod stacking;
mod strings;
#[cfg(test)]
mod tests;
mod unbound;
mod uncertain;
mod unseen;
mod words;
mod wrappers;

pub use attributes::{
    Attribute, Attributes, Carry, MaterialFactors, Resolved, SetBy, SetColor, Source, plate_depth,
};
pub use bindings::{Binding, Bindings, BoundBy, DrawingString, NamedBy, Part, PartKind, Place};
pub use given_depths::GivenDepth;
pub use layers::{Layer, LayerKind, in_layers_of_pixels};
pub use legends::Legend;
pub use located::locate;
pub use marks::{FollowedName, PartMark};
pub use motions::{
    Camerawork, ClipLimits, ClipRequest, MotionSource, PerformanceEffects, PerformanceRequest,
    SignedAxis,
};
pub use names::written_by_a_person;
pub use nearest::DistanceMode;
pub use settings::{BindRule, DrawingSettings, Strokes};

use rayon::prelude::*;

use crate::diagnostic::Diagnostic;
use crate::lang::ast::Annotation;
use crate::memo::Memo;
use crate::svg::Drawing;
use crate::threads::GRAIN;
use areas::{Area, areas};
use binder::Binder;
use leaders::Leaders;
use node_groups::NodeGroups;

/// Binds the strings of a drawing to its parts.
pub fn bind(drawing: &Drawing, memo: &Memo, diagnostics: &mut Vec<Diagnostic>) -> Bindings {
    let mut bindings = strings::read(drawing, diagnostics);
    layers::find(drawing, &mut bindings, diagnostics);
    layers::misplaced(drawing, &bindings, diagnostics);
    let mut node_groups = NodeGroups::read(drawing, &bindings);
    let leaders = Leaders::find(drawing, &bindings, &node_groups);
    node_groups.find_sources(drawing, &bindings, &leaders, memo);
    let areas = areas(drawing, &node_groups.sources, memo);
    let parts: Vec<(Part, Option<usize>)> = node_groups
        .sources
        .par_iter()
        .zip(areas)
        .with_min_len(GRAIN)
        .filter_map(|(source, area)| {
            let Area { outline, measure } = area?;
            Some((Part::new(source, outline, measure), source.host))
        })
        .collect();
    bindings.parts = ink::attach(parts);
    let binder = Binder::new(drawing, &mut node_groups, &mut bindings, memo, diagnostics);
    let stacking = binder.apply_rules(&leaders);
    bindings.leaders = leaders;
    unbound::report(drawing, &bindings, diagnostics);
    classify(drawing, &mut bindings, &node_groups.backgrounds);
    wrappers::report(drawing, &bindings, &node_groups.backgrounds, diagnostics);
    bindings.hierarchy_by_contact = contact::decides(drawing, &bindings);
    if bindings.annotated || bindings.hierarchy_by_contact {
        let read = || binder::stacking(drawing, &bindings, &node_groups, memo);
        let stacking = stacking.unwrap_or_else(read);
        details::join(drawing, &mut bindings, &stacking);
    }
    legends::merge(drawing, &mut bindings, diagnostics);
    hierarchy::build(drawing, &mut bindings, memo, diagnostics);
    motions::without_motion(&bindings, diagnostics);
    marks::without_mark(&bindings, diagnostics);
    uncertain::report(drawing, &bindings, &node_groups, diagnostics);
    many::off_page(drawing, &bindings, diagnostics);
    outlines::report(drawing, &bindings, diagnostics);
    many::far_away(drawing, &bindings, diagnostics);
    unseen::hidden(drawing, &bindings, diagnostics);
    unseen::converted(drawing, diagnostics);
    bindings
}

/// Sets the kind of every part, now that the strings are bound.
fn classify(drawing: &Drawing, bindings: &mut Bindings, backgrounds: &[bool]) {
    for index in 0..bindings.parts.len() {
        let annotation = bindings.parts[index]
            .string
            .map(|string| &bindings.strings[string].annotation);
        let main = bindings.parts[index].is_candidate();
        bindings.parts[index].kind = match annotation {
            None if backgrounds[bindings.parts[index].shape] => PartKind::Unused,
            Some(Annotation::Unused) => PartKind::Unused,
            Some(Annotation::Legend(_)) if main => PartKind::Legend,
            _ if main => PartKind::Main,
            _ => PartKind::Sub,
        };
        if let Some(Annotation::Part(part)) = annotation {
            if let Some(name) = &part.name {
                bindings.parts[index].name = name.text.clone();
            } else {
                let group = described_group(bindings, index);
                let element = group.map_or(
                    &drawing.shapes[bindings.parts[index].shape].element,
                    |group| &drawing.groups[group].element,
                );
                bindings.parts[index].name = element.own_name().to_owned();
                bindings.parts[index].named_by = match element.label {
                    Some(_) => NamedBy::Label { group },
                    None => NamedBy::Id { group },
                };
            }
        }
    }
    // Sub-parts are left out together with their main part.
    for index in 0..bindings.parts.len() {
        let main = bindings.parts[index].main;
        if main != index
            && matches!(
                bindings.parts[main].kind,
                PartKind::Unused | PartKind::Legend
            )
        {
            bindings.parts[index].kind = bindings.parts[main].kind;
        }
    }
    layers::classify(drawing, bindings);
    ink::follow(bindings);
}

/// The group that a part's string describes; `None` if it describes the shape.
fn described_group(bindings: &Bindings, part: usize) -> Option<usize> {
    match bindings.strings[bindings.parts[part].string?].place {
        Place::Group(group) => Some(group),
        Place::Label(_) | Place::Shape(_) => None,
    }
}
