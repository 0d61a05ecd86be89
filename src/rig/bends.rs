//! Which parts bend, and how: limbs, necks and tails that are drawn as one shape, and those whose strings say `Bend`.

use std::sync::Arc;

use rayon::prelude::*;
use rustc_hash::FxHashMap;
use typed_index_collections::{TiSlice, TiVec};

use super::facings::FigureFacing;
use crate::anatomy::{self, Term};
use crate::bend::{Bend, Centerline};
use crate::bind::{Bindings, Part, PartId, PartKind};
use crate::diagnostic::{Code, Diagnostic};
use crate::geometry::{self, Outline, area, y_up};
use crate::index::par_keys;
use crate::labels::{Class, Label, LimbSegment};
use crate::svg::Drawing;

/// A part that is at least this much longer than it is wide bends without a string that says so.
const SLENDER: f64 = 2.2;
/// How many joints a part has that bends all along its length.
const SUPPLE: usize = 4;
/// A shape of a limb's group belongs to its outline if it has at least this share of the main shape's area.
const OF_OUTLINE: f64 = 0.1;

/// Per main part how it bends; `None` for one that is rigid. `figures` are the drawing's figures.
pub(crate) fn bends(
    drawing: &Drawing,
    bindings: &Bindings,
    figures: &[FigureFacing],
) -> TiVec<PartId, Option<Arc<Bend>>> {
    // Parts of what is no body, such as a machine, are limbs only if they are to move like ones.
    let is_moving = !bindings.clip_requests().is_empty();
    let bodies = figures
        .iter()
        .filter(|figure| figure.has_names || is_moving);
    let labels = bodies.filter(|figure| !figure.found.is_vehicle);
    let labels = labels.flat_map(|figure| &figure.labels);
    // What is spread, such as the legs of a spider, keeps its drawn pose.
    let hanging = labels.filter(|(_, _, is_splayed)| !is_splayed);
    let labels: FxHashMap<PartId, &Label> =
        hanging.map(|(part, label, _)| (*part, label)).collect();
    let parts_of_node = bindings.parts_of_nodes();
    let bend = |index: PartId| {
        let part = &bindings.parts[index];
        if part.kind != PartKind::Main {
            return None;
        }
        let asked = bindings.attributes(index).bend();
        let joints = match asked {
            Some(joints) => joints,
            None if part.parent.is_some() => joints(part, labels.get(&index).copied()),
            None => 0,
        };
        if joints == 0 {
            return None;
        }
        let profile = bindings.profile(drawing, index)?;
        if asked.is_none() && !profile.is_flexible() {
            return None;
        }
        let outline = outline(bindings, index, &parts_of_node[index]);
        let line = Centerline::new(&outline, y_up(part.origin))?;
        if asked.is_none() && line.length() < SLENDER * line.width() {
            return None;
        }
        Some(Arc::new(match joints {
            1 => Bend::limb(line),
            _ => Bend::chain(line, joints),
        }))
    };
    par_keys(&bindings.parts)
        .map(bend)
        .collect::<Vec<_>>()
        .into()
}

/// Reports each `Bend` in a string whose part has no joints inside nevertheless. `bends` are those of the main parts.
pub(crate) fn idle_bends(
    drawing: &Drawing,
    bindings: &Bindings,
    bends: &TiSlice<PartId, Option<Arc<Bend>>>,
) -> Vec<Diagnostic> {
    let idle = |(index, part): (PartId, &Part)| {
        if part.kind != PartKind::Main || bends[index].is_some() {
            return None;
        }
        let span = bindings.bend_span(index)?;
        bindings
            .attributes(index)
            .bend()
            .filter(|joints| *joints > 0)?;
        let (reason, help) = if bindings.profile(drawing, index).is_none() {
            (
                "has no solid",
                "delete it, or write `Bend` in the string of the shape that should bend",
            )
        } else {
            (
                "is too short for a joint",
                "draw it longer than it is wide, or delete `Bend`",
            )
        };
        let name = &part.name;
        let message = format!("`Bend` has no effect: `{name}` {reason}");
        Some(Diagnostic::new(Code::IdleBend, span, message).help(help))
    };
    bindings.parts.iter_enumerated().filter_map(idle).collect()
}

/// How many joints a part has inside by its name and by what it is of its figure.
fn joints(part: &Part, label: Option<&Label>) -> usize {
    if anatomy::is_supple(&part.name) {
        return SUPPLE;
    }
    // A wing folds in its own ways, and what is cloth hangs.
    let terms = anatomy::terms(&part.name);
    if terms.contains(&Term::Wing) || part.is_sheet() {
        return 0;
    }
    match label {
        Some(label) if label.segment == LimbSegment::Whole => match label.class {
            Class::Arm | Class::Leg | Class::Neck => 1,
            Class::Tail => SUPPLE,
            Class::Head | Class::Body | Class::Hips => 0,
        },
        _ => 0,
    }
}

/// The outline of a part with the larger shapes of its group: a sleeve with its hand.
fn outline(bindings: &Bindings, main: PartId, members: &[PartId]) -> Arc<Outline> {
    let own = &bindings.parts[main].outline;
    let least = OF_OUTLINE * area(own);
    let others = members.iter().filter(|part| **part != main);
    let others = others.map(|part| &bindings.parts[*part]);
    let others = others.filter(|part| part.host.is_none() && area(&part.outline) >= least);
    let mut all: Vec<Outline> = others.map(|part| part.outline.as_ref().clone()).collect();
    if all.is_empty() {
        return Arc::clone(own);
    }
    all.push(own.as_ref().clone());
    Arc::new(geometry::union(&all))
}
