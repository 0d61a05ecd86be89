//! How deep figures are at most.
//!
//! What is inflated is as deep as it is wide, which makes a ball of a large head and a barrel of a trunk. Parts whose `Shape` no
//! string says are therefore kept within a share of their figure's size.

use glam::DVec2;
use typed_index_collections::{TiVec, ti_vec};

use crate::bind::{Bindings, FigureExtent, PartId, Seen};

/// How far a part reaches to either side of its plane at most: a share of its figure's width, which leaves room for a nose or hair on
/// it, so that the figure is at most .6 of its width deep.
const OF_WIDTH: f64 = 0.24;
/// The same for animals in profile as a share of their height, which leaves room for legs on both sides below .5.
const OF_HEIGHT: f64 = 0.2;

/// Per part how far it reaches to either side of its plane at most, drawing units; `None` for what belongs to no figure.
pub(super) fn reaches(
    bindings: &Bindings,
    seen: &TiVec<PartId, Seen>,
) -> TiVec<PartId, Option<f64>> {
    let mut reaches = ti_vec![None; bindings.parts.len()];
    if seen.iter().all(|seen| *seen == Seen::Anyhow) {
        return reaches;
    }
    let extents = bindings.extents_of_figures();
    for (part, FigureExtent { root, bounds }) in extents.iter_enumerated() {
        let (low, high) = bounds.unwrap_or_default();
        let DVec2 {
            x: width,
            y: height,
        } = high - low;
        let reach = match seen[part] {
            Seen::Anyhow => continue,
            Seen::InProfile => (OF_WIDTH * width).min(OF_HEIGHT * height),
            Seen::VehicleInProfile | Seen::FromFront | Seen::FromBehind => OF_WIDTH * width,
        };
        reaches[*root] = Some(reach);
    }
    extents.iter().map(|extent| reaches[extent.root]).collect()
}
