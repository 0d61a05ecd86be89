//! Parts that are cloth by their names: a cape is a sheet, not a sack.

use typed_index_collections::{TiSlice, TiVec, ti_vec};

use super::bindings::{Part, PartId};
use super::extents;
use crate::anatomy;

/// How far cloth reaches to either side of its plane at most, as a share of its figure's width.
const THICKNESS: f64 = 0.06;

/// Per part how far it reaches to either side of its plane at most, drawing units, if it is cloth or belongs to cloth.
pub(super) fn reaches(parts: &TiSlice<PartId, Part>) -> TiVec<PartId, Option<f64>> {
    let is_cloth = |part: &Part| part.is_candidate() && anatomy::is_sheet(&part.name);
    let cloth: TiVec<PartId, bool> = parts.iter().map(is_cloth).collect();
    if !cloth.contains(&true) {
        return ti_vec![None; parts.len()];
    }
    let figures = extents::of_figures(parts);
    let reach = |(index, part): (PartId, &Part)| {
        let (low, high) = figures[index].bounds.filter(|_| cloth[part.main])?;
        Some(THICKNESS * (high.x - low.x))
    };
    parts.iter_enumerated().map(reach).collect()
}
