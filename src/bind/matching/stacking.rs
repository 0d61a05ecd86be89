//! What parts cover of each other on the page: the order of drawing as people see it.

use std::sync::Arc;

use glam::DVec2;
use rayon::prelude::*;
use typed_index_collections::{TiSlice, TiVec, ti_vec};

use super::parts::MatchedPart;
use crate::bind::bindings::PartId;
use crate::geometry::{EdgeRanges, Intervals, OrderedBoxes, Outline, Scanlines, area, contains};
use crate::index::par_keys;
use crate::memo::{Bits, Long, Memo, Same};
use crate::threads::GRAIN;

/// How far inside the page its corners are taken, as a share of the page: a rectangle as large as the page holds them.
const CORNER: f64 = 0.005;
/// How many page corners a part of the ground holds at least.
const GROUND_CORNERS: usize = 2;
/// What share of a part lies on another one that it is said to lie on.
const LIES_ON: f64 = 0.9;
/// How many parts are compared with a part at most: in a higher pile, the rest would hardly be seen.
const MAX_NEIGHBORS: usize = 512;
/// As soon as it is known what is seen directly under a part, no more than this many of the parts that it lies on are recorded.
const MAX_HOSTS: usize = 8;

/// How the parts of a drawing cover each other. The parts are in paint order.
#[derive(Debug)]
pub(in crate::bind) struct Stacking {
    parts: TiVec<PartId, StackedPart>,
    boxes: OrderedBoxes,
    facts: TiVec<PartId, Facts>,
    /// The first part that is no ground.
    ground: PartId,
}

#[derive(Debug)]
struct StackedPart {
    outline: Arc<Outline>,
    bounds: (DVec2, DVec2),
    ranges: EdgeRanges,
    /// Whether it covers anything.
    takes_part: bool,
}

/// What is known about a part, or about several that are one unit.
#[derive(Debug, Clone, Default)]
pub(in crate::bind) struct Facts {
    /// Its area, square units.
    pub(in crate::bind) area: f64,
    /// Its visible area, which nothing covers, square units.
    pub(in crate::bind) shown: f64,
    /// The parts directly under it, each with the share of its area that lies on the part.
    pub(in crate::bind) under: Box<[(PartId, f64)]>,
    /// The earlier parts on which nearly all of it lies, the topmost first.
    pub(super) lies_on: Box<[PartId]>,
}

/// What stacking is computed from.
#[derive(Debug, PartialEq, Eq, Hash)]
struct StackingKey {
    parts: Long<PartKey>,
    page: Bits<[f64; 4]>,
}

#[derive(Debug, PartialEq, Eq, Hash)]
struct PartKey {
    outline: Same<Outline>,
    bounds: Bits<[[f64; 2]; 2]>,
    takes_part: bool,
}

/// Memory that is used again for the next part.
#[derive(Default)]
struct Scratch {
    own: Intervals,
    other: Intervals,
    rest: Intervals,
    near: Vec<PartId>,
}

impl Stacking {
    /// The stacking of the parts that `takes_part` names. `page`: minimum corner and size.
    pub(super) fn read(
        parts: &TiSlice<PartId, MatchedPart>,
        page: (DVec2, DVec2),
        takes_part: impl Fn(&MatchedPart) -> bool,
        memo: &Memo,
    ) -> Arc<Self> {
        let part = |part: &MatchedPart| PartKey {
            outline: Same(Arc::clone(&part.outline)),
            bounds: Bits(<[DVec2; 2]>::from(part.measure.bounds).map(|corner| corner.to_array())),
            takes_part: takes_part(part),
        };
        let key = StackingKey {
            parts: parts.iter().map(part).collect(),
            page: Bits([page.0.x, page.0.y, page.1.x, page.1.y]),
        };
        memo.get(key, |key| Arc::new(Self::new(key)))
    }

    fn new(key: &StackingKey) -> Self {
        let [x, y, width, height] = key.page.0;
        let page = (DVec2::new(x, y), DVec2::new(width, height));
        let stacked = key.parts.0.par_iter().with_min_len(GRAIN);
        let parts: Vec<StackedPart> = stacked
            .map(|part| StackedPart {
                outline: Arc::clone(&part.outline.0),
                bounds: part.bounds.0.map(DVec2::from).into(),
                ranges: EdgeRanges::new(&part.outline.0),
                takes_part: part.takes_part,
            })
            .collect();
        let parts: TiVec<PartId, StackedPart> = parts.into();
        let boxes = parts.iter_enumerated().filter(|(_, part)| part.takes_part);
        let boxes = OrderedBoxes::new(boxes.map(|(index, part)| (index.into(), part.bounds)));
        let nothing = Outline::default();
        let outlines = parts.iter().map(|part| {
            if part.takes_part {
                &*part.outline
            } else {
                &nothing
            }
        });
        let ground = ground_count(outlines, page);
        let mut stacking = Self {
            parts,
            boxes,
            facts: ti_vec![],
            ground: ground.into(),
        };
        let facts = par_keys(&stacking.parts)
            .with_min_len(GRAIN)
            .map_init(Scratch::default, |scratch, part| {
                let takes_part = stacking.parts[part].takes_part;
                takes_part.then(|| stacking.measure(&[part], scratch))
            })
            .map(Option::unwrap_or_default);
        stacking.facts = facts.collect::<Vec<_>>().into();
        stacking
    }

    /// The outline of a part.
    pub(super) fn outline(&self, part: PartId) -> &Arc<Outline> {
        &self.parts[part].outline
    }

    /// The corners of a part's bounding box, the smallest coordinates first.
    pub(super) fn bounds(&self, part: PartId) -> (DVec2, DVec2) {
        self.parts[part].bounds
    }

    /// Whether a part is ground: one of the back-most parts, which fill the page.
    pub(in crate::bind) fn is_ground(&self, part: PartId) -> bool {
        part < self.ground
    }

    /// Whether a part takes part: others cover nothing, and nothing is known about them.
    pub(in crate::bind) fn has(&self, part: PartId) -> bool {
        self.parts[part].takes_part
    }

    /// What is known about a part.
    pub(in crate::bind) fn of_part(&self, part: PartId) -> &Facts {
        &self.facts[part]
    }

    /// What is known about parts that are one unit; at least one, in paint order.
    pub(in crate::bind) fn of_unit(&self, members: &[PartId]) -> Facts {
        match members {
            [part] => self.facts[*part].clone(),
            _ => self.measure(members, &mut Scratch::default()),
        }
    }

    /// The parts at a point, the topmost first, and at most so many.
    pub(super) fn topmost(&self, point: DVec2, count: usize) -> Vec<PartId> {
        let mut found = Vec::new();
        let all = self.parts.len();
        self.boxes.before(all, (point, point), usize::MAX, |part| {
            let part = PartId::from(part);
            if contains(&self.parts[part].outline, point) {
                found.push(part);
            }
            found.len() < count
        });
        found
    }

    /// Whether a point lies on a part.
    pub(super) fn is_on(&self, part: PartId, point: DVec2) -> bool {
        let (low, high) = self.parts[part].bounds;
        let in_box = point.cmpge(low).all() && point.cmple(high).all();
        in_box && contains(&self.parts[part].outline, point)
    }

    fn measure(&self, members: &[PartId], scratch: &mut Scratch) -> Facts {
        let Scratch {
            own,
            other,
            rest,
            near,
        } = scratch;
        let bounds = members.iter().map(|part| self.parts[*part].bounds);
        let bounds = bounds.reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)));
        let Some((low, high)) = bounds else {
            return Facts::default();
        };
        near.clear();
        let found = self.boxes.meeting((low, high)).take(MAX_NEIGHBORS);
        near.extend(found.map(PartId::from));
        if near.len() == MAX_NEIGHBORS {
            near.extend(members);
        }
        if let ([part], [near]) = (members, near.as_slice())
            && part == near
        {
            // Nothing is near it: the usual case in a drawing of many parts.
            let area = area(&self.parts[*part].outline);
            return Facts {
                area,
                shown: area,
                ..Facts::default()
            };
        }
        let lines = Scanlines::across((low, high));
        let cut = |part: PartId, out: &mut Intervals| {
            let part = &self.parts[part];
            lines.cut(&part.outline, &part.ranges, out);
        };
        cut(members[0], own);
        for part in &members[1..] {
            cut(*part, other);
            own.add(other);
        }
        let whole = own.length();
        if whole <= 0.0 {
            return Facts::default();
        }
        near.sort_unstable_by(|a, b| b.cmp(a));
        near.dedup();
        rest.copy_from(own);
        let mut shown = 0.0;
        let mut under = Vec::new();
        let mut lies_on = Vec::new();
        let below = near.partition_point(|part| *part >= members[0]);
        for &part in &near[..below] {
            if rest.is_empty() {
                break;
            }
            cut(part, other);
            let removed = rest.remove(other);
            if members.binary_search(&part).is_ok() {
                shown += removed;
            }
        }
        // What lies under the unit lies under all of it, covered or not.
        rest.copy_from(own);
        for &part in &near[below..] {
            if rest.is_empty() && lies_on.len() >= MAX_HOSTS {
                break;
            }
            cut(part, other);
            let share = own.common(other) / whole;
            if share >= LIES_ON {
                lies_on.push(part);
            }
            let seen = rest.remove(other) / whole;
            if seen > 0.0 {
                under.push((part, seen));
            }
        }
        Facts {
            area: whole * lines.weight(),
            shown: shown * lines.weight(),
            under: under.into(),
            lies_on: lies_on.into(),
        }
    }
}

/// How many of the back-most outlines are ground: each of them holds two or more corners of the page, or has no area. `page`:
/// minimum corner and size.
pub(super) fn ground_count<'a>(
    outlines: impl Iterator<Item = &'a Outline>,
    (low, size): (DVec2, DVec2),
) -> usize {
    let corners = [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.0, 1.0)].map(|(x, y)| {
        let share = DVec2::new(x, y).clamp(DVec2::splat(CORNER), DVec2::splat(1.0 - CORNER));
        low + size * share
    });
    let is_ground = |outline: &&Outline| {
        let held = corners.iter().filter(|corner| contains(outline, **corner));
        outline.polygons.is_empty() || held.count() >= GROUND_CORNERS
    };
    outlines.take_while(is_ground).count()
}
