//! Where the figures of a drawing look.

use typed_index_collections::{TiVec, ti_vec};

use super::{figures, rigging};
use crate::bind::{Bindings, PartId, PartKind};
use crate::labels::{FoundFacing, label_drawn};
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
    /// The direction, and why.
    pub found: FoundFacing,
}

/// Where those figures look that have limbs, or whose strings say so.
pub(crate) fn facings(drawing: &Drawing, bindings: &Bindings) -> Vec<FigureFacing> {
    let mut parts_of_node: TiVec<PartId, Vec<PartId>> = ti_vec![Vec::new(); bindings.parts.len()];
    for (index, part) in bindings.parts.iter_enumerated() {
        if matches!(part.kind, PartKind::Main | PartKind::Sub) {
            parts_of_node[part.main].push(index);
        }
    }
    let groups = figures::find(bindings);
    let groups = groups.into_iter().filter(|group| group.parts.len() > 1);
    let found = groups.filter_map(|group| {
        let figure = rigging::figure(drawing, bindings, &parts_of_node, &group);
        let labeled = label_drawn(&figure);
        let labels = labeled.labels.iter().flatten();
        let limbs = labels.filter(|label| label.class.is_limb()).count();
        let has_limbs = limbs >= if labeled.has_names { 1 } else { FEWEST_UNNAMED };
        (has_limbs || labeled.facing.by_string).then_some(FigureFacing {
            root: group.root,
            parts: group.parts.raw,
            found: labeled.facing,
        })
    });
    found.collect()
}
