//! Binds strings to parts, and resolves attributes and the hierarchy of parts.
//!
//! This is the only module that knows both the drawing and the language. [`bind`] applies the rules of figure.md in their
//! order. The result, a [`Bindings`], has everything that models are built from and that editors ask about.

mod areas;
mod attributes;
mod bindings;
mod hierarchy;
mod layers;
mod leaders;
mod legends;
mod motions;
mod nearest;
mod node_groups;
mod parents;
mod settings;
mod strings;
#[cfg(test)]
mod tests;

pub use attributes::{
    Attribute, Attributes, MaterialFactors, Resolved, SetBy, SetColor, Source, plate_depth,
};
pub use bindings::{Binding, Bindings, BoundBy, DrawingString, Part, PartKind, Place};
pub use layers::{Layer, LayerKind, in_tile_layers};
pub use legends::Legend;
pub use motions::ClipRequest;
pub use nearest::DistanceMode;
pub use settings::{DrawingSettings, Strokes};

use std::sync::Arc;

use rayon::prelude::*;

use crate::diagnostic::{Code, Diagnostic};
use crate::lang::ast::Annotation;
use crate::memo::{Bits, Memo, Same};
use crate::svg::{Drawing, Element};
use crate::threads::GRAIN;
use areas::{Area, areas};
use node_groups::{GroupRole, NodeGroups};

/// Binds the strings of a drawing to its parts.
pub fn bind(drawing: &Drawing, memo: &Memo, diagnostics: &mut Vec<Diagnostic>) -> Bindings {
    let mut bindings = strings::read(drawing, diagnostics);
    layers::find(drawing, &mut bindings, diagnostics);
    layers::misplaced(&bindings, diagnostics);
    let node_groups = NodeGroups::read(drawing, &bindings);
    let areas = areas(drawing, &node_groups.sources, memo);
    bindings.parts = node_groups
        .sources
        .par_iter()
        .zip(areas)
        .with_min_len(GRAIN)
        .filter_map(|(source, area)| {
            let Area { outline, measure } = area?;
            Some(Part::new(source, outline, measure))
        })
        .collect();
    let mut binder = Binder::new(drawing, &node_groups, &mut bindings, diagnostics);
    binder.descriptions();
    binder.groups();
    binder.leaders();
    binder.nearest(memo);
    binder.report_unbound();
    classify(drawing, &mut bindings);
    legends::merge(drawing, &mut bindings, diagnostics);
    hierarchy::build(drawing, &mut bindings, memo, diagnostics);
    motions::without_motion(&bindings, diagnostics);
    hints(drawing, &bindings, diagnostics);
    bindings
}

/// A string with the part that it is bound to, and another part that is almost as near.
struct NearestMatch {
    string: usize,
    part: usize,
    runner_up: Option<usize>,
}

/// The state of binding.
struct Binder<'a> {
    drawing: &'a Drawing,
    node_groups: &'a NodeGroups,
    bindings: &'a mut Bindings,
    diagnostics: &'a mut Vec<Diagnostic>,
    /// Per group its back-most part.
    back_most: Vec<Option<usize>>,
    /// Per shape its first part.
    part_of_shape: Vec<Option<usize>>,
}

impl<'a> Binder<'a> {
    fn new(
        drawing: &'a Drawing,
        node_groups: &'a NodeGroups,
        bindings: &'a mut Bindings,
        diagnostics: &'a mut Vec<Diagnostic>,
    ) -> Self {
        let mut back_most = vec![None; drawing.groups.len()];
        let mut part_of_shape = vec![None; drawing.shapes.len()];
        for (index, part) in bindings.parts.iter().enumerate() {
            // If an inner group has a part already, so have the groups around it.
            let chain = node_groups.chain(drawing.shapes[part.shape].group);
            for group in chain
                .take_while(|group| back_most[*group].is_none())
                .collect::<Vec<_>>()
            {
                back_most[group] = Some(index);
            }
            part_of_shape[part.shape].get_or_insert(index);
        }
        node_groups::choose_mains(node_groups, bindings);
        Self {
            drawing,
            node_groups,
            bindings,
            diagnostics,
            back_most,
            part_of_shape,
        }
    }

    /// Rule 1: descriptions belong to their element.
    fn descriptions(&mut self) {
        for string in 0..self.bindings.strings.len() {
            let part = match self.bindings.strings[string].place {
                _ if !self.bindings.strings[string].wants_part() => continue,
                Place::Label(_) => continue,
                Place::Shape(shape) => self.part_of_shape[shape],
                Place::Group(group) => match self.node_groups.roles[group] {
                    GroupRole::Transparent => None,
                    _ => self.back_most[group],
                },
            };
            if let Some(part) = part {
                self.bind(string, part, BoundBy::Desc);
            }
        }
    }

    /// Rule 2: strings in a group belong to the back-most part of the innermost group that holds a part.
    fn groups(&mut self) {
        for string in 0..self.bindings.strings.len() {
            let Some(group) = self
                .waiting_label(string)
                .map(|label| self.drawing.labels[label].1)
            else {
                continue;
            };
            let roles = &self.node_groups.roles;
            let holder = self.node_groups.chain(group).find(|group| {
                roles[*group] == GroupRole::Container
                    || (roles[*group] == GroupRole::Node && self.back_most[*group].is_some())
            });
            match holder {
                Some(group) if roles[group] == GroupRole::Container => {
                    self.bindings.strings[string].scope = Some(group);
                }
                Some(group) => {
                    if let Some(part) = self.back_most[group] {
                        self.bind(string, part, BoundBy::Group);
                    }
                }
                None => {
                    self.bindings.strings[string].scope = self.node_groups.scope_of_layer(group)
                }
            }
        }
    }

    /// Rule 3: leaders and connectors.
    fn leaders(&mut self) {
        for (string, part) in leaders::find(self.drawing, self.bindings, &self.part_of_shape) {
            self.bind(string, part, BoundBy::Leader);
        }
    }

    /// Rule 4: every other string belongs to the nearest main part candidate. Containers bind their own strings first.
    fn nearest(&mut self, memo: &Memo) {
        let mode = self.bindings.settings.bind;
        let mut waiting: Vec<(Option<usize>, usize)> = (0..self.bindings.strings.len())
            .filter(|string| self.waiting_label(*string).is_some())
            .map(|string| (self.bindings.strings[string].scope, string))
            .collect();
        waiting.sort_by_key(|(scope, string)| (scope.is_none(), *scope, *string));
        let free = waiting.partition_point(|(scope, _)| scope.is_some());
        let contained = node_groups::candidates_by_container(self.node_groups, self.bindings);
        let scopes: Vec<&[(Option<usize>, usize)]> = waiting[..free]
            .chunk_by(|(one, _), (other, _)| one == other)
            .collect();
        let found: Vec<Vec<NearestMatch>> = scopes
            .par_iter()
            .map(|strings| {
                let candidates = strings[0].0.and_then(|container| contained.get(&container));
                let candidates = candidates.map_or(&[][..], Vec::as_slice);
                self.matches(strings, candidates, mode, memo)
            })
            .collect();
        self.bind_matches(found.into_iter().flatten());
        if free < waiting.len() {
            // Parts in a tile layer are reserved for the strings in it.
            let is_free =
                |part: &Part| part.is_candidate() && !self.node_groups.in_layer[part.source];
            let candidates: Vec<usize> = (0..self.bindings.parts.len())
                .filter(|part| is_free(&self.bindings.parts[*part]))
                .collect();
            let found = self.matches(&waiting[free..], &candidates, mode, memo);
            self.bind_matches(found.into_iter());
        }
    }

    /// Assigns the strings of one scope to their nearest parts.
    fn matches(
        &self,
        strings: &[(Option<usize>, usize)],
        candidates: &[usize],
        mode: nearest::DistanceMode,
        memo: &Memo,
    ) -> Vec<NearestMatch> {
        let corner =
            |(_, string): &(Option<usize>, usize)| match self.bindings.strings[*string].place {
                Place::Label(label) => self.drawing.labels[label].0.corner,
                Place::Shape(_) | Place::Group(_) => glam::DVec2::ZERO,
            };
        let candidates: Vec<usize> = candidates
            .iter()
            .copied()
            .filter(|part| self.bindings.parts[*part].string.is_none())
            .collect();
        let target = |part: &usize| nearest::Target {
            center: Bits(self.bindings.parts[*part].measure.center),
            outline: Same(Arc::clone(&self.bindings.parts[*part].outline)),
        };
        let problem = nearest::AssignmentProblem {
            corners: strings.iter().map(corner).map(Bits).collect(),
            targets: candidates.iter().map(target).collect(),
            mode,
        };
        let found = memo.get(problem, |problem| Arc::<[_]>::from(problem.solve()));
        let pairs = strings.iter().zip(found.iter());
        pairs
            .filter_map(|((_, string), found)| {
                Some(NearestMatch {
                    string: *string,
                    part: candidates[found.target?],
                    runner_up: found.runner_up.map(|runner_up| candidates[runner_up]),
                })
            })
            .collect()
    }

    fn bind_matches(&mut self, matches: impl Iterator<Item = NearestMatch>) {
        for NearestMatch {
            string,
            part,
            runner_up,
        } in matches
        {
            self.bind(string, part, BoundBy::Nearest);
            self.bindings.strings[string].runner_up = runner_up;
        }
    }

    /// Reports the strings without a part.
    fn report_unbound(&mut self) {
        for (index, string) in self.bindings.strings.iter().enumerate() {
            let unbound = string.wants_part() && string.binding.is_none();
            if unbound && !self.bindings.leaves_picture_out(self.drawing, index) {
                let what = match &string.annotation {
                    Annotation::Part(part) => part
                        .name
                        .as_ref()
                        .map_or("this string".to_owned(), |name| format!("`{}`", name.text)),
                    Annotation::Legend(_) => "this legend".to_owned(),
                    _ => "this string".to_owned(),
                };
                let place = if string.scope.is_some() {
                    "in its group"
                } else {
                    "of the drawing"
                };
                let message = format!(
                    "there is no part left for {what}: every shape {place} has a string already"
                );
                self.diagnostics.push(
                    Diagnostic::new(Code::NoPartLeft, string.text.whole(), message)
                    .help("delete the string, draw its shape, or put `#` before it to make it a comment"),
                );
            }
        }
    }

    /// The label of a string that still needs a part.
    fn waiting_label(&self, string: usize) -> Option<usize> {
        let string = &self.bindings.strings[string];
        match string.place {
            Place::Label(label) if string.wants_part() && string.binding.is_none() => Some(label),
            _ => None,
        }
    }

    fn bind(&mut self, string: usize, part: usize, by: BoundBy) {
        if let Some(other) = self.bindings.parts[part].string {
            let other_span = self.bindings.strings[other].text.whole();
            let element = &self.drawing.shapes[self.bindings.parts[part].shape].element;
            let message = format!(
                "this string and another one describe the same part, {}",
                element.describe()
            );
            self.diagnostics.push(
                Diagnostic::new(
                    Code::TwoStrings,
                    self.bindings.strings[string].text.whole(),
                    message,
                )
                .related(other_span, "the other string")
                .related(element.span, "the part")
                .help("delete one of them, or move it out of the group"),
            );
            // Bound all the same, so that it is not reported as unbound too.
            self.bindings.strings[string].binding = Some(Binding { part, by });
            return;
        }
        self.bindings.parts[part].string = Some(string);
        self.bindings.strings[string].binding = Some(Binding { part, by });
    }
}

/// Sets the kind of every part, now that the strings are bound.
fn classify(drawing: &Drawing, bindings: &mut Bindings) {
    for index in 0..bindings.parts.len() {
        let annotation = bindings.parts[index]
            .string
            .map(|string| &bindings.strings[string].annotation);
        let main = bindings.parts[index].is_candidate();
        bindings.parts[index].kind = match annotation {
            Some(Annotation::Unused) => PartKind::Unused,
            Some(Annotation::Legend(_)) if main => PartKind::Legend,
            _ if main => PartKind::Main,
            _ => PartKind::Sub,
        };
        if let Some(Annotation::Part(part)) = annotation {
            let name = part.name.as_ref().map(|name| name.text.clone());
            bindings.parts[index].name = name.unwrap_or_else(|| {
                described_element(drawing, bindings, index)
                    .own_name()
                    .to_owned()
            });
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
}

/// The element that a part's string describes: the shape, or a group around it.
fn described_element<'a>(drawing: &'a Drawing, bindings: &Bindings, part: usize) -> &'a Element {
    let part = &bindings.parts[part];
    match part.string.map(|string| bindings.strings[string].place) {
        Some(Place::Group(group)) => &drawing.groups[group].element,
        _ => &drawing.shapes[part.shape].element,
    }
}

/// Reports doubtful bindings, and parts off the page.
fn hints(drawing: &Drawing, bindings: &Bindings, diagnostics: &mut Vec<Diagnostic>) {
    if !bindings.annotated {
        return;
    }
    for string in &bindings.strings {
        if let (Some(binding), Some(runner_up)) = (string.binding, string.runner_up)
            && bindings.parts[runner_up].kind != PartKind::Tile
        {
            let (bound, runner_up) = (
                bindings.describe(drawing, binding.part),
                bindings.describe(drawing, runner_up),
            );
            let message =
                format!("this string belongs to {bound}, but {runner_up} is almost as near");
            diagnostics.push(
                Diagnostic::new(Code::NearlyAsNear, string.text.whole(), message)
                .related(drawing.shapes[bindings.parts[binding.part].shape].element.span, "the part it belongs to")
                .help("move the string's top left corner closer to the centre of its part, or group the two"),
            );
        }
    }
    let (page_low, page_size) = drawing.page;
    for part in &bindings.parts {
        let (low, high) = part.measure.bounds;
        let off = high.cmplt(page_low).any() || low.cmpgt(page_low + page_size).any();
        if off && part.kind == PartKind::Main {
            let message = format!("`{}` is off the page", part.name);
            diagnostics.push(
                Diagnostic::new(
                    Code::OffPage,
                    drawing.shapes[part.shape].element.span,
                    message,
                )
                .help("it is built anyway; to leave it out, write `*` beside it"),
            );
        }
    }
}
