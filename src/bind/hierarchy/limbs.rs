//! Parts drawn in several shapes: their axis, their ends, and where they meet what they hang on, are those of all shapes together.

use std::sync::Arc;

use glam::DVec2;
use rayon::prelude::*;
use rustc_hash::FxHashMap;

use super::{Context, measure_turned};
use crate::bind::bindings::PartId;
use crate::bind::matching::united;
use crate::geometry::{Measure, Outline, centroid, distance_squared, intersect, measure};
use crate::memo::{Memo, Same};

/// The most shapes that are united. Of more, the main one stands for all.
const MAX_SHAPES: usize = 64;
/// A limb that overlaps its parent by more than this share of its length lies on it, and where it is attached is not where they
/// overlap.
const MAX_OVERLAP: f64 = 0.45;
/// Points of a limb are equally near to its parent if their distances differ by at most this share of the limb's length.
const STRETCH: f64 = 0.02;

/// A limb and its parent.
#[derive(Debug, PartialEq, Eq, Hash)]
struct Meeting {
    limb: Same<Outline>,
    parent: Same<Outline>,
}

/// The areas of the parts that are drawn in several shapes.
#[derive(Debug, Default)]
pub(super) struct Limbs {
    /// Per main part the area of all its shapes.
    areas: FxHashMap<PartId, Arc<Outline>>,
}

impl Limbs {
    /// Unites the shapes of each node of which several were drawn as one group.
    pub(super) fn read(context: Context<'_>, memo: &Memo) -> Self {
        let matched = context.matched;
        let mut shapes: FxHashMap<PartId, Vec<PartId>> = FxHashMap::default();
        for (index, part) in matched.parts.iter_enumerated() {
            let is_drawn = part.host.is_none() && part.node_group.is_some();
            if is_drawn && matched.parts[part.main].node_group == part.node_group {
                shapes.entry(part.main).or_default().push(index);
            }
        }
        let is_one = |parts: &Vec<PartId>| (2..=MAX_SHAPES).contains(&parts.len());
        let mut groups: Vec<(PartId, Vec<PartId>)> = shapes
            .into_iter()
            .filter(|(_, parts)| is_one(parts))
            .collect();
        groups.sort_unstable_by_key(|(main, _)| *main);
        let outline = |part: &PartId| Arc::clone(&matched.parts[*part].outline);
        let lists = groups
            .iter()
            .map(|(_, parts)| parts.iter().map(outline).collect());
        let united = united(lists.collect(), memo);
        let mains = groups.into_iter().map(|(main, _)| main);
        Self {
            areas: mains.zip(united).collect(),
        }
    }

    /// The area of a part.
    fn area(&self, context: Context<'_>, part: PartId) -> Arc<Outline> {
        let own = || &context.matched.parts[part].outline;
        Arc::clone(self.areas.get(&part).unwrap_or_else(own))
    }

    /// Whether a part is several areas that do not touch, such as the windows of a car.
    pub(super) fn is_scattered(&self, part: PartId) -> bool {
        let area = self.areas.get(&part);
        area.is_some_and(|area| area.polygons.len() > 1)
    }

    /// The axis, centre and ends of the parts whose back-most shape is not their main one. `axis` is what `Axis` says of a part.
    pub(super) fn measures(
        &self,
        context: Context<'_>,
        axis: impl Fn(PartId) -> Option<f64> + Sync,
    ) -> FxHashMap<PartId, Measure> {
        let mut back_most: FxHashMap<_, PartId> = FxHashMap::default();
        for (index, part) in context.matched.parts.iter_enumerated() {
            if part.host.is_none() {
                back_most.entry(part.main).or_insert(index);
            }
        }
        let is_in_front = |main: &PartId| back_most.get(main).is_some_and(|first| first != main);
        let areas = self.areas.par_iter().filter(|(main, _)| is_in_front(main));
        let measured = areas.filter_map(|(main, area)| {
            let measure = match axis(*main) {
                Some(degrees) => measure_turned(area, degrees),
                None => measure(area),
            };
            Some((*main, measure?))
        });
        measured.collect()
    }

    /// Where a limb in several shapes meets its parent: the middle of their overlap, or of the stretch that is nearest to it.
    /// `None` for one in a single shape, and for one that lies on its parent along much of its length.
    pub(super) fn joint(
        &self,
        context: Context<'_>,
        [limb, parent]: [PartId; 2],
        memo: &Memo,
    ) -> Option<DVec2> {
        let meeting = Meeting {
            limb: Same(Arc::clone(self.areas.get(&limb)?)),
            parent: Same(self.area(context, parent)),
        };
        memo.get(meeting, Meeting::place)
    }
}

impl Meeting {
    fn place(&self) -> Option<DVec2> {
        let (limb, parent) = (&*self.limb.0, &*self.parent.0);
        let Measure {
            axis, half_along, ..
        } = measure(limb)?;
        let length = 2.0 * half_along;
        let overlap = intersect(limb, parent);
        if let Some(middle) = centroid(&overlap) {
            let along = points(&overlap).map(|point| point.dot(axis));
            let none = (f64::INFINITY, f64::NEG_INFINITY);
            let (low, high) = along.fold(none, |(low, high), at| (low.min(at), high.max(at)));
            return (high - low <= MAX_OVERLAP * length).then_some(middle);
        }
        let gaps = points(limb).map(|point| (point, distance_squared(parent, point).sqrt()));
        let gaps: Vec<(DVec2, f64)> = gaps.collect();
        let nearest = gaps.iter().map(|(_, gap)| *gap).min_by(f64::total_cmp)?;
        let near = gaps
            .iter()
            .filter(|(_, gap)| *gap <= nearest + STRETCH * length);
        let near: Vec<DVec2> = near.map(|(point, _)| *point).collect();
        let sum: DVec2 = near.iter().sum();
        Some(sum / near.len() as f64)
    }
}

/// The points of an outline's borders.
fn points(outline: &Outline) -> impl Iterator<Item = DVec2> + '_ {
    let rings = outline.polygons.iter().flat_map(|polygon| &polygon.rings);
    rings.flatten().copied()
}
