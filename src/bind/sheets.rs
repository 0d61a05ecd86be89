//! Parts that are cloth by their names: a cape is a sheet, not a sack.

use glam::DVec2;
use typed_index_collections::{TiSlice, TiVec, ti_vec};

use super::bindings::{Part, PartId, PartKind};
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
    let roots = roots(parts);
    let mut widths: TiVec<PartId, Option<DVec2>> = ti_vec![None; parts.len()];
    for (index, part) in parts.iter_enumerated() {
        if matches!(part.kind, PartKind::Main | PartKind::Sub) {
            let (low, high) = part.measure.bounds;
            let own = DVec2::new(low.x, high.x);
            let all = &mut widths[roots[index]];
            *all = Some(all.map_or(own, |all| DVec2::new(all.x.min(own.x), all.y.max(own.y))));
        }
    }
    let reach = |(index, part): (PartId, &Part)| {
        let width = widths[roots[index]].filter(|_| cloth[part.main])?;
        Some(THICKNESS * (width.y - width.x))
    };
    parts.iter_enumerated().map(reach).collect()
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
