//! Where the figures of a drawing look.

use typed_index_collections::{TiSlice, TiVec, ti_vec};

use super::{figures, rigging};
use crate::anatomy::{self, Term};
use crate::bind::{Bindings, PartId, Seen};
use crate::labels::{
    Class, Facing, Figure, FigurePartId, FoundFacing, Label, LabeledFigure, label_drawn,
};
use crate::svg::Drawing;

/// Without a name that tells part of a body, what sticks out of a thing is no limb unless there are as many as this.
const FEWEST_UNNAMED: usize = 3;

/// A figure, and the direction that it faces.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct FigureFacing {
    /// The part that carries the others.
    pub root: PartId,
    /// All its parts that are in the hierarchy.
    pub parts: Vec<PartId>,
    /// What those of them are that have a label, and whether they are limbs that the figure spreads.
    pub labels: Vec<(PartId, Label, bool)>,
    /// Those of them that are limbs.
    pub limbs: Vec<PartId>,
    /// Those of them that belong to a face that shows both eyes, which its figure has only once.
    pub face: Vec<PartId>,
    /// Whether names tell parts of a body, or of a vehicle.
    pub has_names: bool,
    /// The direction, and why.
    pub found: FoundFacing,
}

/// Per main part from where it is drawn, given where the figures of its drawing look.
pub(crate) fn seen(bindings: &Bindings, figures: &[FigureFacing]) -> TiVec<PartId, Seen> {
    let mut seen = ti_vec![Seen::Anyhow; bindings.parts.len()];
    let known = figures
        .iter()
        .filter(|figure| figure.has_names || figure.found.by_string);
    for figure in known {
        let from = match figure.found.facing {
            // What is seen from above stays as it is drawn until it moves.
            Facing::Viewer | Facing::Up | Facing::UpHeadDown => Seen::FromFront,
            Facing::Away => Seen::FromBehind,
            Facing::Left | Facing::Right if figure.found.is_vehicle => Seen::VehicleInProfile,
            Facing::Left | Facing::Right => Seen::InProfile,
        };
        figure.parts.iter().for_each(|part| seen[*part] = from);
        if from.is_in_profile() {
            let one_sided = figure.limbs.iter().chain(&figure.face);
            one_sided.for_each(|part| seen[*part] = Seen::Anyhow);
        }
    }
    seen
}

/// Where those figures look that have limbs or a body with a face, or whose strings say so; and vehicles.
pub(crate) fn facings(drawing: &Drawing, bindings: &Bindings) -> Vec<FigureFacing> {
    let parts_of_node = bindings.parts_of_nodes();
    let groups = figures::find(bindings);
    let groups = groups.into_iter().filter(|group| group.parts.len() > 1);
    let found = groups.filter_map(|group| {
        let figure = rigging::figure(drawing, bindings, &parts_of_node, &group, |_| 1);
        let labeled = label_drawn(&figure);
        let labels = group.parts.iter().zip(&labeled.labels);
        let is_limb = |label: &Label| label.class.is_limb();
        let limbs = labels.filter(|(_, label)| label.as_ref().is_some_and(is_limb));
        let limbs: Vec<PartId> = limbs.map(|(part, _)| *part).collect();
        let found = &labeled.facing;
        let fewest = if labeled.has_names { 1 } else { FEWEST_UNNAMED };
        let has_limbs = limbs.len() >= fewest;
        // A face alone, such as a smiley, is no figure.
        let is_body = |label: &Label| label.class == Class::Body;
        let has_body = labeled.labels.iter().flatten().any(is_body);
        let shows_face = labeled.has_names && has_body && found.has_face;
        let is_figure = has_limbs || found.by_string || found.is_vehicle || shows_face;
        is_figure.then(|| FigureFacing {
            root: group.root,
            labels: labels_of(&group.parts, &labeled),
            limbs,
            face: face(&figure, &labeled, &group.parts),
            has_names: labeled.has_names || labeled.facing.is_vehicle,
            parts: group.parts.raw,
            found: labeled.facing,
        })
    });
    found.collect()
}

fn labels_of(
    parts: &TiSlice<FigurePartId, PartId>,
    labeled: &LabeledFigure,
) -> Vec<(PartId, Label, bool)> {
    let labels = labeled.labels.iter_enumerated();
    labels
        .filter_map(|(place, label)| Some((parts[place], label.clone()?, labeled.splayed[place])))
        .collect()
}

/// The parts of a face that shows both eyes, unless a string says that its figure is in profile.
fn face(
    figure: &Figure,
    labeled: &LabeledFigure,
    parts: &TiSlice<FigurePartId, PartId>,
) -> Vec<PartId> {
    if labeled.facing.by_string || !labeled.facing.shows_two_eyes {
        return Vec::new();
    }
    let labels = labeled.labels.iter_enumerated();
    let is_face = labels.filter(|(part, label)| {
        let is_head = label
            .as_ref()
            .is_some_and(|label| label.class == Class::Head);
        let terms = anatomy::terms(&figure.parts[*part].name);
        let of_head = [Term::OfHead, Term::Face];
        is_head || terms.iter().any(|term| of_head.contains(term))
    });
    is_face.map(|(part, _)| parts[part]).collect()
}
