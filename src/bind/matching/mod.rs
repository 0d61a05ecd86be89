//! Matches the strings of a drawing with its parts.

mod areas;
mod bare_names;
mod binder;
mod converted;
mod doubt;
mod fills;
mod fork;
mod ground_shadows;
mod held;
mod ink;
mod islands;
mod kinds;
mod layers;
mod leaders;
mod meant;
mod nearest;
mod node_groups;
mod parts;
mod pictures;
mod props;
mod said;
mod settings;
mod stacking;
mod strings;
mod wrappers;

pub(in crate::bind) use bare_names::is_bare_name;
pub(in crate::bind) use doubt::is_doubtful;
pub(in crate::bind) use held::Hold;
pub(in crate::bind) use kinds::of_ink;
pub(in crate::bind) use layers::group_of;
pub(crate) use layers::has_same_pose_layers;
pub(crate) use layers::{LayerId, LayerKind, Layers};
pub use layers::{in_layers_of_pixels, makes_pose_layer};
pub(in crate::bind) use leaders::Leaders;
pub(crate) use nearest::DistanceMode;
pub(in crate::bind) use parts::MatchedPart;
pub(in crate::bind) use props::foot;
pub(crate) use settings::{BindRule, DrawingSettings, Strokes};
pub(in crate::bind) use stacking::Stacking;
pub(in crate::bind) use strings::{Texts, wants_part};

use std::sync::Arc;

use typed_index_collections::TiVec;

use super::bindings::{DrawingString, PartId, PartKind, StringId};
use crate::diagnostic::Diagnostic;
use crate::lang::Variables;
use crate::lang::ast::Annotation;
use crate::lang::value::{Setting, Value};
use crate::memo::Memo;
use crate::svg::Drawing;
use areas::Area;
use binder::{Binder, Bound, Rules};
use node_groups::{NodeGroups, PartSource};

/// The strings and parts of a drawing, matched with each other.
pub(in crate::bind) struct Matched {
    /// Whether the drawing is annotated at all.
    pub(in crate::bind) annotated: bool,
    /// Whether no string says `Shape`, so that what is rounded is inflated.
    pub(in crate::bind) is_first_look: bool,
    /// The strings, in the order of the file.
    pub(in crate::bind) strings: TiVec<StringId, DrawingString>,
    /// The parts, back-most first.
    pub(in crate::bind) parts: TiVec<PartId, MatchedPart>,
    /// Per part its kind, before details join what they lie on.
    pub(in crate::bind) kinds: TiVec<PartId, PartKind>,
    /// The layers.
    pub(in crate::bind) layers: Layers,
    /// The settings of all `%` strings, each with its string; for each keyword the last one.
    pub(in crate::bind) defaults: Vec<(StringId, Setting)>,
    /// The variables that the `%` strings define.
    pub(in crate::bind) variables: Variables,
    /// The settings of the whole drawing.
    pub(in crate::bind) settings: DrawingSettings,
    /// The lines that lead from strings to what they mean.
    pub(in crate::bind) leaders: Leaders,
    /// The groups that became nodes.
    pub(in crate::bind) node_groups: NodeGroups,
    /// How the parts cover each other, if binding had to find it out.
    stacking: Option<Arc<Stacking>>,
}

/// The share of its border that is drawn as curves, from which on a shape is inflated in a drawing that never says `Shape`.
pub(super) const ROUNDED: f64 = 0.5;

/// Reads the strings of a drawing, finds its parts, and binds each string to the part that it means.
pub(in crate::bind) fn find(
    drawing: &Drawing,
    texts: Texts,
    memo: &Memo,
    diagnostics: &mut Vec<Diagnostic>,
) -> Matched {
    let mut read = strings::read(drawing, texts, diagnostics);
    let settings = read.settings;
    let layers = layers::find(drawing, &read.all, diagnostics);
    let mut node_groups = NodeGroups::read(drawing, &read.all, &layers);
    let leaders = Leaders::find(drawing, &read.all, &node_groups, &layers);
    pictures::mark(drawing, &mut read.all, &layers, &leaders);
    node_groups.find_sources(
        drawing,
        &read.all,
        &layers,
        &leaders,
        settings.strokes,
        memo,
    );
    let areas = areas::areas(drawing, &node_groups.sources, memo);
    let drawn = node_groups.sources.iter().copied().zip(areas);
    let drawn = drawn.filter_map(|(source, area)| Some((source, area?)));
    let mut drawn: Vec<(PartSource, Area)> = drawn.collect();
    if !strings::texts_mean_parts(&read.all) {
        let is_described = strings::described(drawing, &read.all);
        drawn = islands::split(drawing, drawn, &is_described, memo);
    }
    let parts = ink::attach(drawn);
    let binder = Binder::new(
        drawing,
        &read.all,
        &leaders,
        parts,
        node_groups,
        memo,
        diagnostics,
    );
    let Rules {
        bound,
        mut parts,
        node_groups,
        stacking,
    } = binder.apply_rules(settings.bind);
    props::join_loose(drawing, &layers, &mut parts);
    if read.is_first_look {
        for part in &mut parts {
            // Lines are tubes.
            part.is_balloon = part.is_stroke || drawing.shapes[part.shape].curved > ROUNDED;
        }
    }
    let strings = read.all.into_iter().zip(bound);
    let strings: TiVec<StringId, _> = strings.map(|(read, bound)| joined(read, bound)).collect();
    let backgrounds = &node_groups.backgrounds;
    let kinds = kinds::classify(drawing, &strings, &parts, &layers, backgrounds);
    props::give_thickness(drawing, &layers, &kinds, &mut parts);
    Matched {
        annotated: read.annotated,
        is_first_look: read.is_first_look,
        strings,
        parts,
        kinds,
        layers,
        defaults: read.defaults,
        variables: read.variables,
        settings,
        leaders,
        node_groups,
        stacking,
    }
}

/// A string with what it is bound to.
fn joined(read: strings::ReadString, bound: Bound) -> DrawingString {
    let strings::ReadString {
        holder,
        text,
        annotation,
        settings,
        is_of_picture,
    } = read;
    let Bound {
        binding,
        runner_up,
        scope,
    } = bound;
    DrawingString {
        holder,
        text,
        annotation,
        settings,
        // Some are grouped with a shape.
        is_of_picture: is_of_picture && binding.is_none(),
        binding,
        runner_up,
        scope,
    }
}

impl Matched {
    /// How the parts cover each other.
    pub(in crate::bind) fn stacking(&self, drawing: &Drawing, memo: &Memo) -> Arc<Stacking> {
        let read = || {
            let is_scoped = self.strings.iter().any(|string| string.scope.is_some());
            binder::stacking(drawing, &self.parts, &self.node_groups, is_scoped, memo)
        };
        self.stacking.clone().unwrap_or_else(read)
    }

    /// Whether a string asks for a motion.
    pub(in crate::bind) fn asks_for_motion(&self) -> bool {
        // As `Bindings::clip_requests`.
        self.strings.iter().any(|string| {
            let applies = matches!(string.annotation, Annotation::Defaults(_));
            let mut settings = string.settings.iter();
            (applies || string.binding.is_some())
                && settings.any(|setting| matches!(setting.value, Value::Motion(_)))
        })
    }

    /// The string of a part.
    pub(in crate::bind) fn string_of(&self, part: PartId) -> Option<&DrawingString> {
        Some(&self.strings[self.parts[part].string?])
    }
}
