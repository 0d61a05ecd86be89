//! Parts drawn in several shapes: their axis, their ends, and where they meet what they hang on, are those of all shapes together.

use std::sync::{Arc, OnceLock};

use glam::DVec2;
use rayon::prelude::*;
use rustc_hash::FxHashMap;

use super::{Context, measure_turned};
use crate::bind::bindings::PartId;
use crate::geometry::{
    Measure, Outline, area, centroid, distance_squared, intersect, measure, union,
};
use crate::memo::{Bits, Long, Memo, Same};

/// The most shapes that are united. Of more, the main one stands for all.
const MAX_SHAPES: usize = 64;
/// The least share of a limb's area that its main shape covers to give the limb its axis.
const LEADS: f64 = 0.5;
/// A limb that overlaps its parent by more than this share of its length lies on it, and where it is attached is not where they
/// overlap.
const MAX_OVERLAP: f64 = 0.45;
/// Points of a limb are equally near to its parent if their distances differ by at most this share of the limb's length.
const STRETCH: f64 = 0.02;
/// The end of a limb may be this much farther from its parent than the rest of it, as a share of its length, or else of half its width:
/// an arm that hangs beside the body touches it with its border only, and turns about its own middle nevertheless.
const AT_END: f64 = 0.05;
const BESIDE: f64 = 1.6;
/// The most points of a limb whose distances from its parent are compared.
const MAX_POINTS: usize = 512;
/// The most pairs of points of a limb and its parent that are compared.
const MAX_COMPARED: usize = 1 << 18;

/// Outlines that are made one.
#[derive(Debug, PartialEq, Eq, Hash)]
struct United(Long<Same<Outline>>);

/// A limb and its parent.
#[derive(Debug, PartialEq, Eq, Hash)]
struct Meeting {
    limb: Same<Outline>,
    parent: Same<Outline>,
    kind: Kind,
}

/// What is asked of a limb and its parent.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
enum Kind {
    /// Where a limb meets its parent.
    Limb,
    /// Where a head does.
    Head,
    /// Where a limb does whose end is here, unless that is there.
    Off(Bits<[f64; 2]>),
}

/// The parts that are drawn in several shapes of one group.
pub(super) struct Limbs<'a> {
    context: Context<'a>,
    memo: &'a Memo,
    /// By their main parts.
    groups: FxHashMap<PartId, Shapes>,
}

/// The shapes of a part.
#[derive(Default)]
struct Shapes {
    /// Back-most first.
    parts: Vec<PartId>,
    /// The area of all, once it has been asked for.
    area: OnceLock<Arc<Outline>>,
}

impl<'a> Limbs<'a> {
    pub(super) fn read(context: Context<'a>, memo: &'a Memo) -> Self {
        let matched = context.matched;
        let mut groups: FxHashMap<PartId, Shapes> = FxHashMap::default();
        for (index, part) in matched.parts.iter_enumerated() {
            let is_drawn = part.host.is_none() && part.node_group.is_some();
            if is_drawn && matched.parts[part.main].node_group == part.node_group {
                groups.entry(part.main).or_default().parts.push(index);
            }
        }
        groups.retain(|_, shapes| (2..=MAX_SHAPES).contains(&shapes.parts.len()));
        Self {
            context,
            memo,
            groups,
        }
    }

    /// The area of a part in several shapes.
    fn area_of_group(&self, part: PartId) -> Option<&Arc<Outline>> {
        let shapes = self.groups.get(&part)?;
        Some(shapes.area.get_or_init(|| {
            let outlines = shapes.parts.iter().map(|part| self.outline(*part));
            let key = United(outlines.cloned().map(Same).collect());
            self.memo.get(key, |United(outlines)| {
                let outlines = outlines.0.iter().map(|outline| (*outline.0).clone());
                Arc::new(union(&outlines.collect::<Vec<Outline>>()))
            })
        }))
    }

    /// The area of a part with all of its shapes.
    pub(super) fn whole(&self, part: PartId) -> &Outline {
        self.area_of_group(part).unwrap_or(self.outline(part))
    }

    fn outline(&self, part: PartId) -> &'a Arc<Outline> {
        &self.context.matched.parts[part].outline
    }

    /// The axis, centre and ends of the limbs whose main shape covers less than half of their area, as a hand does that is drawn before its
    /// sleeve. `axis` is what `Axis` says of a part.
    pub(super) fn measures(
        &self,
        is_limb: impl Fn(PartId) -> bool + Sync,
        axis: impl Fn(PartId) -> Option<f64> + Sync,
    ) -> FxHashMap<PartId, Measure> {
        let limbs = self.groups.par_iter().filter(|(main, _)| is_limb(**main));
        let measured = limbs.filter_map(|(main, _)| {
            let whole = self.area_of_group(*main)?;
            if area(self.outline(*main)) >= LEADS * area(whole) {
                return None;
            }
            let measure = match axis(*main) {
                Some(degrees) => measure_turned(whole, degrees),
                None => measure(whole),
            };
            Some((*main, measure?))
        });
        measured.collect()
    }

    /// Where a limb in several shapes meets its parent: the middle of their overlap, or of the stretch that is nearest to it.
    /// `None` for one in a single shape, and for one that lies on its parent along much of its length.
    pub(super) fn joint(&self, pair: [PartId; 2]) -> Option<DVec2> {
        self.area_of_group(pair[0])?;
        self.meet(pair, Kind::Limb)
    }

    /// Where a head meets what it hangs on: likewise, in however many shapes it is drawn.
    pub(super) fn head_joint(&self, pair: [PartId; 2]) -> Option<DVec2> {
        self.meet(pair, Kind::Head)
    }

    /// Where a limb meets its parent if that is elsewhere than at its end: a spider's leg bends back to the body. `None` if the end is
    /// about as near to the parent as any point of the limb.
    pub(super) fn off_its_end(&self, pair: [PartId; 2], end: DVec2) -> Option<DVec2> {
        self.meet(pair, Kind::Off(Bits(end.to_array())))
    }

    fn meet(&self, pair: [PartId; 2], kind: Kind) -> Option<DVec2> {
        let [limb, parent] = pair.map(|part| {
            let own = || self.outline(part);
            Same(Arc::clone(self.area_of_group(part).unwrap_or_else(own)))
        });
        self.memo
            .get(Meeting { limb, parent, kind }, Meeting::place)
    }
}

impl Meeting {
    fn place(&self) -> Option<DVec2> {
        let (limb, parent) = (&*self.limb.0, &*self.parent.0);
        let Measure {
            axis, half_along, ..
        } = measure(limb)?;
        let length = 2.0 * half_along;
        // Not the extent across the axis, which is large where a limb is bent.
        let half_width = area(limb) / length / 2.0;
        let slack = (AT_END * length).max(BESIDE * half_width);
        let end = match self.kind {
            Kind::Off(Bits(end)) => Some(DVec2::from_array(end)),
            Kind::Limb | Kind::Head => None,
        };
        // An end on the parent is where a limb is attached, whatever else of it lies there.
        let gap = end.map(|end| distance_squared(parent, end).sqrt());
        if gap.is_some_and(|gap| gap <= slack) {
            return None;
        }
        let overlap = intersect(limb, parent);
        if let Some(middle) = centroid(&overlap) {
            let is_short = match self.kind {
                // A wide head on a wide body: its axis is level, and says nothing.
                Kind::Head => area(&overlap) <= MAX_OVERLAP * area(limb),
                Kind::Limb | Kind::Off(_) => {
                    let along = points(&overlap).map(|point| point.dot(axis));
                    let none = (f64::INFINITY, f64::NEG_INFINITY);
                    let (low, high) =
                        along.fold(none, |(low, high), at| (low.min(at), high.max(at)));
                    high - low <= MAX_OVERLAP * length
                }
            };
            return match (is_short, end) {
                (true, _) => Some(middle),
                (false, Some(end)) => nearest_to(points(&overlap), end),
                (false, None) => None,
            };
        }
        let (own, others) = (points(limb).count(), points(parent).count());
        let compared = MAX_POINTS.min(MAX_COMPARED / others.max(1)).max(1);
        let step = own.div_ceil(compared).max(1);
        let some = points(limb).step_by(step);
        let gaps = some.map(|point| (point, distance_squared(parent, point).sqrt()));
        let gaps: Vec<(DVec2, f64)> = gaps.collect();
        let nearest = gaps.iter().map(|(_, gap)| *gap).min_by(f64::total_cmp)?;
        let near = gaps
            .iter()
            .filter(|(_, gap)| *gap <= nearest + STRETCH * length);
        let near = near.map(|(point, _)| *point);
        match (end, gap) {
            (Some(_), Some(gap)) if gap <= nearest + slack => None,
            (Some(end), _) => nearest_to(near, end),
            (None, _) => {
                let near: Vec<DVec2> = near.collect();
                let sum: DVec2 = near.iter().sum();
                Some(sum / near.len() as f64)
            }
        }
    }
}

fn nearest_to(points: impl Iterator<Item = DVec2>, to: DVec2) -> Option<DVec2> {
    let distance = |point: &DVec2| point.distance_squared(to);
    points.min_by(|a, b| distance(a).total_cmp(&distance(b)))
}

/// The points of an outline's borders.
fn points(outline: &Outline) -> impl Iterator<Item = DVec2> + '_ {
    let rings = outline.rings();
    rings.flatten().copied()
}
