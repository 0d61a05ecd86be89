//! Which groups of a drawing are looked at as one part, and which are opened.

use glam::DVec2;
use rustc_hash::{FxHashMap, FxHashSet};

use crate::svg::{Drawing, GroupId, GroupKind, ShapeId};

/// A group that reaches over this share of the drawing, both ways, is a figure; a smaller one is a part of it.
const WHOLE: f64 = 0.6;

/// Which groups are no parts but hold several.
pub(super) struct OpenGroups {
    open: FxHashSet<GroupId>,
    /// The box around all.
    pub(super) low: DVec2,
    pub(super) high: DVec2,
}

impl OpenGroups {
    pub(super) fn find(
        drawing: &Drawing,
        boxes: impl Iterator<Item = (ShapeId, (DVec2, DVec2))>,
    ) -> Self {
        let none = (DVec2::INFINITY, DVec2::NEG_INFINITY);
        let mut all = none;
        let mut of_groups: FxHashMap<GroupId, (DVec2, DVec2)> = FxHashMap::default();
        for (shape, (low, high)) in boxes {
            all = (all.0.min(low), all.1.max(high));
            for group in chain(drawing, drawing.shapes[shape].group) {
                let found = of_groups.entry(group).or_insert(none);
                *found = (found.0.min(low), found.1.max(high));
            }
        }
        let whole = all.1 - all.0;
        let open = of_groups
            .into_iter()
            .filter(|(group, (low, high))| {
                drawing.groups[*group].kind != GroupKind::Group
                    || (*high - *low).cmpge(WHOLE * whole).all()
            })
            .map(|(group, _)| group)
            .collect();
        Self {
            open,
            low: all.0,
            high: all.1,
        }
    }

    /// The outermost group around a place that is a part.
    pub(super) fn holder(&self, drawing: &Drawing, group: GroupId) -> Option<GroupId> {
        let closed = chain(drawing, group).filter(|group| !self.open.contains(group));
        closed.last()
    }
}

/// A group and those that it is in.
fn chain(drawing: &Drawing, group: GroupId) -> impl Iterator<Item = GroupId> {
    std::iter::successors(Some(group), |group| {
        let parent = drawing.groups[*group].parent;
        (parent != *group).then_some(parent)
    })
}
