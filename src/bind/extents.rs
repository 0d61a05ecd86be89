//! How large the figures of a drawing are.

use glam::DVec2;
use typed_index_collections::{TiSlice, TiVec, ti_vec};

use super::bindings::{Bindings, Part, PartId, PartKind};

/// The figure that a part belongs to: all that hangs on the same root.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct FigureExtent {
    /// The part that carries all others.
    pub root: PartId,
    /// The bounds of all its filled shapes and lines.
    pub bounds: Option<(DVec2, DVec2)>,
}

impl Bindings {
    /// Per part the figure that it belongs to.
    pub(crate) fn extents_of_figures(&self) -> TiVec<PartId, FigureExtent> {
        of_figures(&self.parts)
    }
}

/// Per part the figure that it belongs to.
pub(super) fn of_figures(parts: &TiSlice<PartId, Part>) -> TiVec<PartId, FigureExtent> {
    let roots = roots(parts);
    let mut bounds: TiVec<PartId, Option<(DVec2, DVec2)>> = ti_vec![None; parts.len()];
    for (index, part) in parts.iter_enumerated() {
        if matches!(part.kind, PartKind::Main | PartKind::Sub) {
            let (low, high) = part.measure.bounds;
            let all = &mut bounds[roots[index]];
            *all = Some(all.map_or((low, high), |all| (all.0.min(low), all.1.max(high))));
        }
    }
    let extent = |root: PartId| FigureExtent {
        root,
        bounds: bounds[root],
    };
    roots.into_iter().map(extent).collect()
}

/// Per part the main part that carries its figure.
fn roots(parts: &TiSlice<PartId, Part>) -> TiVec<PartId, PartId> {
    let mut known: TiVec<PartId, Option<PartId>> = ti_vec![None; parts.len()];
    let mut path = Vec::new();
    let root_of = |part: PartId| {
        let mut at = parts[part].main;
        let root = loop {
            if let Some(root) = known[at] {
                break root;
            }
            path.push(at);
            match parts[at].parent {
                Some(parent) if path.len() <= parts.len() => at = parts[parent].main,
                _ => break at,
            }
        };
        path.drain(..)
            .for_each(|on_path| known[on_path] = Some(root));
        root
    };
    parts.keys().map(root_of).collect()
}
