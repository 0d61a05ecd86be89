//! A figure as a tree of bounding boxes: parents, children, and what stands on the ground.

use glam::DVec2;
use rstar::primitives::{GeomWithData, Rectangle};
use rstar::{AABB, RTree};
use rustc_hash::FxHashSet;
use typed_index_collections::{TiSlice, TiVec, ti_vec};

use crate::labels::{Facing, Figure, FigurePart, FigurePartId};

/// Parts whose lowest point is at most this share of the figure's height above the ground stand on it.
const GROUND: f64 = 0.12;

/// Centres that differ by at most about this share of the figure's height mirror each other.
const MIRRORED: f64 = 0.06;
/// The least share of the parts beside the axis that a symmetric figure mirrors, and the least number of them.
const SYMMETRIC: f64 = 0.9;
const FEWEST_MIRRORED: usize = 4;

/// Parts whose bounding boxes are at most this share of the figure's height apart may touch.
const GAP: f64 = 0.03;
/// What meets more boxes than this is part of the figure, without a look at whether all of them hang on it.
const MANY: usize = 64;
/// A shadow is at least this much wider than high, and this share of the trunk's width wide.
const FLAT: f64 = 3.0;
const SHADOW: f64 = 0.8;

/// The parts of a figure as a tree.
#[derive(Debug)]
pub(super) struct PartTree<'a> {
    pub(super) parts: &'a TiSlice<FigurePartId, FigurePart>,
    /// Parents; a part that would be its own ancestor has none.
    pub(super) parents: TiVec<FigurePartId, Option<FigurePartId>>,
    pub(super) children: TiVec<FigurePartId, Vec<FigurePartId>>,
    /// All parts, parents before children.
    pub(super) order: Vec<FigurePartId>,
    /// Per part the number of its descendants.
    pub(super) descendants: TiVec<FigurePartId, usize>,
    /// Per part the lowest point of itself and its descendants.
    lowest: TiVec<FigurePartId, f64>,
    /// Per part whether it has no name of a person's, and touches nothing that does not hang on it.
    pub(super) loose: TiVec<FigurePartId, bool>,
    ground: f64,
    pub(super) height: f64,
    /// The direction that the figure faces, if a string says so.
    pub(super) facing: Option<Facing>,
}

impl<'a> PartTree<'a> {
    pub(super) fn new(figure: &'a Figure) -> Self {
        let parts = figure.parts.as_ref();
        let parents = parents(parts);
        let mut children = ti_vec![Vec::new(); parts.len()];
        for (index, parent) in parents.iter_enumerated() {
            if let Some(parent) = parent {
                children[*parent].push(index);
            }
        }
        let roots = parts.keys().filter(|part| parents[*part].is_none());
        let mut order: Vec<FigurePartId> = roots.collect();
        let mut next = 0;
        while let Some(part) = order.get(next) {
            order.extend(&children[*part]);
            next += 1;
        }
        let mut descendants = ti_vec![0; parts.len()];
        let mut lowest: TiVec<_, f64> = parts.iter().map(|part| corners(part)[0].y).collect();
        for part in order.iter().rev() {
            if let Some(parent) = parents[*part] {
                descendants[parent] += descendants[*part] + 1;
                lowest[parent] = lowest[parent].min(lowest[*part]);
            }
        }
        let loose = loose(parts, &parents, &order);
        let [ground, top] = reach(
            parts
                .iter_enumerated()
                .filter(|(id, _)| !loose[*id])
                .map(|(_, part)| part),
        );
        Self {
            parts,
            parents,
            children,
            order,
            descendants,
            lowest,
            loose,
            ground,
            height: top - ground,
            facing: figure.facing,
        }
    }

    /// Whether a part or one of its descendants stands on the figure's ground.
    pub(super) fn stands(&self, part: FigurePartId) -> bool {
        self.lowest[part] <= self.ground + GROUND * self.height
    }

    /// The height of a point above the ground by a share of the figure's height.
    pub(super) fn above_ground(&self, share: f64) -> f64 {
        self.ground + share * self.height
    }

    /// A part's name.
    pub(super) fn name(&self, part: FigurePartId) -> &'a str {
        &self.parts[part].name
    }

    /// Width and height of a part's bounding box.
    pub(super) fn size(&self, part: FigurePartId) -> DVec2 {
        let [low, high] = corners(&self.parts[part]);
        high - low
    }

    /// Whether at least this share of a part's bounding box lies within another box. A box without area lies there with its
    /// centre.
    pub(super) fn is_over(&self, part: FigurePartId, [low, high]: [DVec2; 2], share: f64) -> bool {
        let own = corners(&self.parts[part]);
        let shared = (own[1].min(high) - own[0].max(low)).max(DVec2::ZERO);
        let middle = self.middle(part);
        match self.size(part).element_product() {
            area if area > 0.0 => shared.element_product() >= share * area,
            _ => middle.cmpge(low).all() && middle.cmple(high).all(),
        }
    }

    /// Whether a part can be the head that wears a hat: their boxes touch, and the head is no detail of the hat.
    pub(super) fn may_wear(&self, part: FigurePartId, hat: FigurePartId) -> bool {
        let [own, hats] = [part, hat].map(|part| corners(&self.parts[part]));
        let touches = own[0].cmple(hats[1]).all() && hats[0].cmple(own[1]).all();
        touches && self.size(part).element_product() * 2.0 >= self.size(hat).element_product()
    }

    /// Per part the length of the longest chain of parts that begins with it.
    pub(super) fn reaches(&self) -> TiVec<FigurePartId, f64> {
        let own = |part: FigurePartId| self.joint(part).distance(self.tip(part));
        let mut reaches: TiVec<FigurePartId, f64> = self.parts.keys().map(own).collect();
        for part in self.order.iter().rev() {
            let longest = self.children[*part].iter().map(|child| reaches[*child]);
            reaches[*part] += longest.fold(0.0, f64::max);
        }
        reaches
    }

    /// Whether most parts beside an upright axis have another part as their mirror image.
    pub(super) fn is_symmetric(&self, axis: f64) -> bool {
        let cell = (MIRRORED * self.height).max(f64::MIN_POSITIVE);
        let cells = |part: FigurePartId| {
            let middle = self.middle(part);
            [
                ((middle.x - axis) / cell).round() as i64,
                (middle.y / cell).round() as i64,
            ]
        };
        let beside = self.parts.keys().map(cells);
        let beside: Vec<[i64; 2]> = beside.filter(|[x, _]| x.unsigned_abs() > 1).collect();
        let all: FxHashSet<[i64; 2]> = beside.iter().copied().collect();
        let near = |at: i64| [at.saturating_sub(1), at, at.saturating_add(1)];
        let is_mirrored = |[x, y]: &&[i64; 2]| {
            let xs = near(x.saturating_neg()).into_iter();
            let mut cells = xs.flat_map(|x| near(*y).map(|y| [x, y]));
            cells.any(|cell| all.contains(&cell))
        };
        let mirrored = beside.iter().filter(is_mirrored).count();
        mirrored >= FEWEST_MIRRORED && mirrored as f64 >= SYMMETRIC * beside.len() as f64
    }

    /// Whether a part lies on the ground and is wider than high, as a penguin's foot is.
    pub(super) fn is_foot_on_ground(&self, part: FigurePartId) -> bool {
        let size = self.size(part);
        let top = corners(&self.parts[part])[1].y;
        size.x > size.y && top <= self.above_ground(GROUND)
    }

    /// Whether a part lies flat on the ground below the whole trunk, as a shadow, a rug or a board does.
    pub(super) fn is_below_all(&self, part: FigurePartId, trunk: [DVec2; 2]) -> bool {
        let [low, high] = corners(&self.parts[part]);
        let size = high - low;
        let middle = trunk[0].midpoint(trunk[1]).x;
        self.is_foot_on_ground(part)
            && size.x >= FLAT * size.y
            && size.x >= SHADOW * (trunk[1].x - trunk[0].x)
            && low.x < middle
            && middle < high.x
            && high.y <= trunk[0].y
    }

    /// The bounding box of some parts; an empty box at the origin if there are none.
    pub(super) fn around(&self, parts: impl Iterator<Item = FigurePartId>) -> [DVec2; 2] {
        parts
            .map(|part| corners(&self.parts[part]))
            .reduce(|a, b| [a[0].min(b[0]), a[1].max(b[1])])
            .unwrap_or_default()
    }

    /// The centre of a part's bounding box.
    pub(super) fn middle(&self, part: FigurePartId) -> DVec2 {
        let [low, high] = corners(&self.parts[part]);
        low.midpoint(high)
    }

    /// Where a part turns.
    pub(super) fn joint(&self, part: FigurePartId) -> DVec2 {
        finite(self.parts[part].joint)
    }

    /// The ends of a part's axis, the far one last.
    pub(super) fn ends(&self, part: FigurePartId) -> [DVec2; 2] {
        let near = self.parts[part].near_end.map(finite);
        [near.unwrap_or(self.joint(part)), self.tip(part)]
    }

    /// The far end of a part.
    pub(super) fn tip(&self, part: FigurePartId) -> DVec2 {
        finite(self.parts[part].tip)
    }
}

/// A part's bounding box, lower left corner first, with finite numbers.
fn corners(part: &FigurePart) -> [DVec2; 2] {
    let [a, b] = part.bounds.map(finite);
    [a.min(b), a.max(b)]
}

fn finite(point: DVec2) -> DVec2 {
    /// Beyond every drawing; sums and products of such numbers stay finite.
    const FAR: f64 = 1e100;
    DVec2::from_array(point.to_array().map(|number| {
        if number.is_nan() {
            0.0
        } else {
            number.clamp(-FAR, FAR)
        }
    }))
}

/// The lowest and the highest point of some parts.
fn reach<'a>(parts: impl Iterator<Item = &'a FigurePart>) -> [f64; 2] {
    parts.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], part| {
        let [from, to] = corners(part);
        [low.min(from.y), high.max(to.y)]
    })
}

/// Per part whether it is a loose shape, such as a swatch of a legend: it has a parent, but no name of a person's, and its bounding box is
/// apart from those of all others that do not hang on it.
fn loose(
    parts: &TiSlice<FigurePartId, FigurePart>,
    parents: &TiSlice<FigurePartId, Option<FigurePartId>>,
    order: &[FigurePartId],
) -> TiVec<FigurePartId, bool> {
    let mut loose = ti_vec![false; parts.len()];
    let all = parts.keys().map(|part| {
        let [low, high] = corners(&parts[part]);
        let rectangle = Rectangle::from_corners(low.to_array(), high.to_array());
        GeomWithData::new(rectangle, part)
    });
    let boxes = RTree::bulk_load(all.collect());
    let [ground, top] = reach(parts.iter());
    let gap = DVec2::splat(GAP * (top - ground).max(0.0));
    for part in order.iter().copied() {
        if parents[part].is_none() || !parts[part].is_automatic {
            continue;
        }
        let [low, high] = corners(&parts[part]);
        let around = AABB::from_corners((low - gap).to_array(), (high + gap).to_array());
        let near = boxes.locate_in_envelope_intersecting(around);
        let hangs_here = |other: FigurePartId| parents[other] == Some(part);
        let mut others = near.map(|found| found.data).enumerate();
        loose[part] =
            !others.any(|(met, other)| met >= MANY || other != part && !hangs_here(other));
    }
    loose
}

fn parents(parts: &TiSlice<FigurePartId, FigurePart>) -> TiVec<FigurePartId, Option<FigurePartId>> {
    let mut parents: TiVec<FigurePartId, Option<FigurePartId>> = parts
        .iter()
        .map(|part| part.parent.filter(|parent| parts.get(*parent).is_some()))
        .collect();
    // For each part, the part at which the walk that visited it began.
    let mut seen: TiVec<FigurePartId, Option<FigurePartId>> = ti_vec![None; parts.len()];
    for start in parts.keys() {
        let mut part = start;
        while seen[part].is_none() {
            seen[part] = Some(start);
            match parents[part] {
                // Back on the same walk: a cycle, cut where it closes.
                Some(parent) if seen[parent] == Some(start) => parents[part] = None,
                Some(parent) => part = parent,
                None => break,
            }
        }
    }
    parents
}
