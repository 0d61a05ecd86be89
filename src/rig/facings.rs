//! Where the figures of a drawing look.

use typed_index_collections::{TiVec, ti_vec};

use super::{figures, rigging};
use crate::bind::{Bindings, PartId};
use crate::labels::{Facing, FoundFacing, Label, label_drawn};
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
    /// Those of them that are limbs.
    pub limbs: Vec<PartId>,
    /// Whether names tell parts of a body.
    pub has_names: bool,
    /// The direction, and why.
    pub found: FoundFacing,
}

/// From where a main part is drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Seen {
    /// No name tells, or it is a limb of a figure in profile.
    Anyhow,
    /// From the side: what is drawn on it is on its far side, too.
    InProfile,
    FromFront,
    FromBehind,
}

/// Per main part from where it is drawn.
pub(crate) fn seen(drawing: &Drawing, bindings: &Bindings) -> TiVec<PartId, Seen> {
    let mut seen = ti_vec![Seen::Anyhow; bindings.parts.len()];
    let figures = facings(drawing, bindings);
    let known = figures
        .iter()
        .filter(|figure| figure.has_names || figure.found.by_string);
    for figure in known {
        let from = match figure.found.facing {
            Facing::Viewer => Seen::FromFront,
            Facing::Away => Seen::FromBehind,
            Facing::Left | Facing::Right => Seen::InProfile,
        };
        figure.parts.iter().for_each(|part| seen[*part] = from);
        if from == Seen::InProfile {
            let limbs = figure.limbs.iter();
            limbs.for_each(|part| seen[*part] = Seen::Anyhow);
        }
    }
    seen
}

/// Where those figures look that have limbs, or whose strings say so.
pub(crate) fn facings(drawing: &Drawing, bindings: &Bindings) -> Vec<FigureFacing> {
    let parts_of_node = bindings.parts_of_nodes();
    let groups = figures::find(bindings);
    let groups = groups.into_iter().filter(|group| group.parts.len() > 1);
    let found = groups.filter_map(|group| {
        let figure = rigging::figure(drawing, bindings, &parts_of_node, &group);
        let labeled = label_drawn(&figure);
        let labels = group.parts.iter().zip(&labeled.labels);
        let is_limb = |label: &Label| label.class.is_limb();
        let limbs = labels.filter(|(_, label)| label.as_ref().is_some_and(is_limb));
        let limbs: Vec<PartId> = limbs.map(|(part, _)| *part).collect();
        let fewest = if labeled.has_names { 1 } else { FEWEST_UNNAMED };
        let has_limbs = limbs.len() >= fewest;
        (has_limbs || labeled.facing.by_string).then_some(FigureFacing {
            root: group.root,
            limbs,
            has_names: labeled.has_names,
            parts: group.parts.raw,
            found: labeled.facing,
        })
    });
    found.collect()
}
