//! Assigns strings to parts one to one, closest pairs first.
//!
//! Sorting all pairs is quadratic. If each of a pair is the nearest of the other, no closer pair can separate them, so the pair
//! can be assigned at once. Following nearest neighbours from any string ends in such a pair: the nearest-neighbour chain
//! algorithm of hierarchical clustering (Benzécri 1982, Juan 1982). It takes a few look-ups in two R-trees for each string.

use std::cmp::Reverse;
use std::collections::BinaryHeap;
use std::sync::Arc;

use glam::DVec2;
use rayon::prelude::*;
use rstar::primitives::GeomWithData;
use rstar::{AABB, PointDistance, RTree, RTreeObject};
use rustc_hash::FxHashMap;

use super::parts::MatchedPart;
use crate::geometry::{Outline, bounds, distance_squared};
use crate::memo::{Bits, Long, Same};
use crate::threads::GRAIN;

/// How the distance from a string to a part is measured.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum DistanceMode {
    /// From a string's corner to a part's centre, as in the paper.
    Center,
    /// From a string's corner to a part's outline.
    Outline,
}

/// A part that a string can be bound to.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub(super) struct Target {
    pub(super) center: Bits<DVec2>,
    pub(super) outline: Same<Outline>,
}

/// The corners of strings, and the parts that they can be bound to.
#[derive(Debug, PartialEq, Eq, Hash)]
pub(super) struct AssignmentProblem {
    pub(super) corners: Long<Bits<DVec2>>,
    pub(super) targets: Long<Target>,
    pub(super) mode: DistanceMode,
}

/// The part that a string is bound to.
#[derive(Debug, Clone, Copy)]
pub(super) struct Assignment {
    /// Index of its target. Ties go to the earlier string, then to the earlier target.
    pub(super) target: Option<usize>,
    /// Another target that is at most a tenth farther away.
    pub(super) runner_up: Option<usize>,
}

impl AssignmentProblem {
    /// The assignment of each string.
    pub(super) fn solve(&self) -> Vec<Assignment> {
        let corners: Vec<DVec2> = self.corners.0.iter().map(|corner| corner.0).collect();
        let targets = &self.targets.0;
        let pairs = pairs(&corners, targets, self.mode);
        let runners_up = runners_up(&corners, targets, &pairs, self.mode);
        let found = pairs.into_iter().zip(runners_up);
        found
            .map(|(target, runner_up)| Assignment { target, runner_up })
            .collect()
    }
}

impl Target {
    /// The target that a part is.
    pub(super) fn of(part: &MatchedPart) -> Self {
        Self {
            center: Bits(part.measure.center),
            outline: Same(Arc::clone(&part.outline)),
        }
    }

    fn distance_squared(&self, corner: DVec2, mode: DistanceMode) -> f64 {
        match mode {
            DistanceMode::Center => self.center.0.distance_squared(corner),
            DistanceMode::Outline => distance_squared(&self.outline.0, corner),
        }
    }
}

/// Up to this many pairs, sorting all of them is faster.
const MAX_ALL_PAIRS: usize = 4096;

/// For each string's corner the index of its target. Ties go to the earlier string, then to the earlier target.
fn pairs(corners: &[DVec2], targets: &[Target], mode: DistanceMode) -> Vec<Option<usize>> {
    if corners.len() * targets.len() <= MAX_ALL_PAIRS {
        return all_pairs(corners, targets, mode);
    }
    neighbor_chains(corners, targets, mode)
}

/// All pairs in order of distance, then of strings, then of targets.
fn all_pairs(corners: &[DVec2], targets: &[Target], mode: DistanceMode) -> Vec<Option<usize>> {
    let mut all = Vec::with_capacity(corners.len() * targets.len());
    for (string, corner) in corners.iter().enumerate() {
        all.extend(
            targets
                .iter()
                .enumerate()
                .map(|(part, target)| (target.distance_squared(*corner, mode), string, part)),
        );
    }
    all.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then((a.1, a.2).cmp(&(b.1, b.2))));
    let mut bound = vec![None; corners.len()];
    let mut taken = vec![false; targets.len()];
    for (_, string, part) in all {
        if bound[string].is_none() && !taken[part] {
            bound[string] = Some(part);
            taken[part] = true;
        }
    }
    bound
}

/// The same by nearest-neighbour chains.
fn neighbor_chains(
    corners: &[DVec2],
    targets: &[Target],
    mode: DistanceMode,
) -> Vec<Option<usize>> {
    let mut strings = Points::new(corners.iter().copied());
    let mut parts = Parts::new(targets, mode);
    let mut bound = vec![None; corners.len()];
    let mut chain = Vec::new();
    for first in 0..corners.len() {
        if bound[first].is_some() {
            continue;
        }
        chain.clear();
        chain.push(first);
        while let Some(&string) = chain.last() {
            let Some(part) = parts.nearest(corners[string]) else {
                return bound;
            };
            let back = parts.nearest_string(part, &strings, corners);
            if back == Some(string) || back.is_none() {
                bound[string] = Some(part);
                strings.remove(corners[string]);
                parts.remove(part);
                chain.pop();
            } else if let Some(other) = back {
                chain.push(other);
            }
        }
    }
    bound
}

/// For each bound string another target that is at most a tenth farther away.
fn runners_up(
    corners: &[DVec2],
    targets: &[Target],
    pairs: &[Option<usize>],
    mode: DistanceMode,
) -> Vec<Option<usize>> {
    let index = (corners.len() * targets.len() > MAX_ALL_PAIRS).then(|| Parts::new(targets, mode));
    let mut string_of = vec![None; targets.len()];
    for (string, target) in pairs.iter().enumerate() {
        if let Some(target) = target {
            string_of[*target] = Some(string);
        }
    }
    let find = |(corner, bound): (&DVec2, &Option<usize>)| {
        let bound = (*bound)?;
        let own = targets[bound].distance_squared(*corner, mode);
        let near = |distance: f64| distance <= own * 1.1 * 1.1 && own > 0.0;
        let (runner_up, distance) = match &index {
            Some(index) => index
                .two_nearest(*corner)
                .into_iter()
                .find(|(part, _)| *part != bound)?,
            None => targets
                .iter()
                .enumerate()
                .filter(|(part, _)| *part != bound)
                .map(|(part, target)| (part, target.distance_squared(*corner, mode)))
                .min_by(|a, b| a.1.total_cmp(&b.1))?,
        };
        // A part whose own string is much closer was hardly meant.
        let taken = string_of[runner_up];
        let settled = taken.is_some_and(|string| {
            targets[runner_up].distance_squared(corners[string], mode) * 4.0 < distance
        });
        (near(distance) && !settled).then_some(runner_up)
    };
    let corners = corners.par_iter().with_min_len(GRAIN);
    corners.zip(pairs).map(find).collect()
}

type Key = [u64; 2];

fn key(p: DVec2) -> Key {
    // Adding zero turns -0 into 0, so that both have the same key.
    [(p.x + 0.0).to_bits(), (p.y + 0.0).to_bits()]
}

/// A shrinking set of points, each with the indices at its position.
struct Points {
    tree: RTree<GeomWithData<[f64; 2], ()>>,
    indices: FxHashMap<Key, BinaryHeap<Reverse<usize>>>,
}

impl Points {
    fn new(points: impl Iterator<Item = DVec2>) -> Self {
        let mut indices: FxHashMap<Key, BinaryHeap<Reverse<usize>>> = FxHashMap::default();
        let mut unique = Vec::new();
        for (index, point) in points.enumerate() {
            let heap = indices.entry(key(point)).or_default();
            if heap.is_empty() {
                unique.push(GeomWithData::new([point.x + 0.0, point.y + 0.0], ()));
            }
            heap.push(Reverse(index));
        }
        Self {
            tree: RTree::bulk_load(unique),
            indices,
        }
    }

    fn first_at(&self, point: &[f64; 2]) -> Option<usize> {
        self.indices
            .get(&key(DVec2::from(*point)))?
            .peek()
            .map(|Reverse(index)| *index)
    }

    /// The nearest index; the least of several at the same distance.
    fn nearest(&self, to: DVec2) -> Option<usize> {
        let to = [to.x, to.y];
        self.tree
            .nearest_neighbors(&to)
            .into_iter()
            .filter_map(|point| self.first_at(point.geom()))
            .min()
    }

    /// Removes the least index at a point.
    fn remove(&mut self, point: DVec2) {
        if let Some(heap) = self.indices.get_mut(&key(point)) {
            heap.pop();
            if heap.is_empty() {
                self.indices.remove(&key(point));
                self.tree.remove_at_point([point.x + 0.0, point.y + 0.0]);
            }
        }
    }
}

/// The outline of a part in an R-tree.
struct Shape<'a> {
    index: usize,
    envelope: AABB<[f64; 2]>,
    outline: &'a Outline,
}

impl RTreeObject for Shape<'_> {
    type Envelope = AABB<[f64; 2]>;

    fn envelope(&self) -> Self::Envelope {
        self.envelope
    }
}

impl PointDistance for Shape<'_> {
    fn distance_2(&self, point: &[f64; 2]) -> f64 {
        distance_squared(self.outline, DVec2::from(*point))
    }
}

/// The parts that have no string yet.
enum Parts<'a> {
    Centers {
        targets: &'a [Target],
        points: Points,
    },
    Outlines {
        targets: &'a [Target],
        tree: RTree<Shape<'a>>,
    },
}

impl<'a> Parts<'a> {
    fn new(targets: &'a [Target], mode: DistanceMode) -> Self {
        match mode {
            DistanceMode::Center => Self::Centers {
                targets,
                points: Points::new(targets.iter().map(|target| target.center.0)),
            },
            DistanceMode::Outline => {
                let shapes = targets.iter().enumerate().map(|(index, target)| Shape {
                    index,
                    envelope: envelope(target),
                    outline: &target.outline.0,
                });
                Self::Outlines {
                    targets,
                    tree: RTree::bulk_load(shapes.collect()),
                }
            }
        }
    }

    fn nearest(&self, corner: DVec2) -> Option<usize> {
        match self {
            Self::Centers { points, .. } => points.nearest(corner),
            Self::Outlines { tree, .. } => tree
                .nearest_neighbors(&[corner.x, corner.y])
                .into_iter()
                .map(|shape| shape.index)
                .min(),
        }
    }

    fn nearest_string(&self, part: usize, strings: &Points, corners: &[DVec2]) -> Option<usize> {
        match self {
            Self::Centers { targets, .. } => strings.nearest(targets[part].center.0),
            Self::Outlines { targets, .. } => {
                let target = &targets[part];
                let reach = reach(target);
                let mut best: Option<(f64, usize)> = None;
                let center = target.center.0.to_array();
                for (point, from_center) in
                    strings.tree.nearest_neighbor_iter_with_distance_2(center)
                {
                    if best
                        .is_some_and(|(distance, _)| from_center.sqrt() - reach > distance.sqrt())
                    {
                        break;
                    }
                    let Some(string) = strings.first_at(point.geom()) else {
                        continue;
                    };
                    let candidate = (distance_squared(&target.outline.0, corners[string]), string);
                    if best.is_none_or(|best| candidate < best) {
                        best = Some(candidate);
                    }
                }
                best.map(|(_, string)| string)
            }
        }
    }

    fn two_nearest(&self, corner: DVec2) -> Vec<(usize, f64)> {
        let corner = [corner.x, corner.y];
        match self {
            Self::Centers { points, .. } => points
                .tree
                .nearest_neighbor_iter_with_distance_2(corner)
                .take(2)
                .filter_map(|(point, distance)| Some((points.first_at(point.geom())?, distance)))
                .collect(),
            Self::Outlines { tree, .. } => tree
                .nearest_neighbor_iter_with_distance_2(corner)
                .take(2)
                .map(|(shape, distance)| (shape.index, distance))
                .collect(),
        }
    }

    fn remove(&mut self, part: usize) {
        match self {
            Self::Centers { targets, points } => points.remove(targets[part].center.0),
            Self::Outlines { targets, tree } => {
                let envelope = envelope(&targets[part]);
                tree.remove_with_selection_function(Selected { part, envelope });
            }
        }
    }
}

/// Selects one part in the R-tree of outlines.
struct Selected {
    part: usize,
    envelope: AABB<[f64; 2]>,
}

impl<'a> rstar::SelectionFunction<Shape<'a>> for Selected {
    fn should_unpack_parent(&self, envelope: &AABB<[f64; 2]>) -> bool {
        use rstar::Envelope;
        envelope.contains_envelope(&self.envelope)
    }

    fn should_unpack_leaf(&self, shape: &Shape<'a>) -> bool {
        shape.index == self.part
    }
}

fn envelope(target: &Target) -> AABB<[f64; 2]> {
    let (low, high) = bounds(&target.outline.0).unwrap_or((target.center.0, target.center.0));
    AABB::from_corners(low.to_array(), high.to_array())
}

/// The distance from a part's centre to the farthest point of its outline.
fn reach(target: &Target) -> f64 {
    let points = target
        .outline
        .0
        .polygons
        .iter()
        .flat_map(|polygon| polygon.rings.iter().flatten());
    points
        .map(|point| point.distance(target.center.0))
        .fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use proptest::prelude::*;

    fn square(center: DVec2) -> Outline {
        let ring = [(-1.0, -1.0), (-1.0, 1.0), (1.0, 1.0), (1.0, -1.0)]
            .map(|c| center + DVec2::from(c))
            .to_vec();
        Outline {
            polygons: vec![crate::geometry::Polygon { rings: vec![ring] }],
        }
    }

    proptest! {
        #[test]
        fn chains_bind_as_all_pairs_do(
            // A small grid makes ties and repeats common.
            corners in prop::collection::vec((0..8_i32, 0..8_i32), 0..24),
            centers in prop::collection::vec((0..8_i32, 0..8_i32), 0..24),
        ) {
            let point = |(x, y): (i32, i32)| DVec2::new(f64::from(x), f64::from(y));
            let corners: Vec<_> = corners.into_iter().map(point).collect();
            let outlines = centers.iter().map(|center| square(point(*center)));
            let targets: Vec<_> = centers
                .iter()
                .zip(outlines)
                .map(|(center, outline)| Target { center: Bits(point(*center)), outline: Same(Arc::new(outline)) })
                .collect();
            for mode in [DistanceMode::Center, DistanceMode::Outline] {
                prop_assert_eq!(neighbor_chains(&corners, &targets, mode), all_pairs(&corners, &targets, mode));
            }
        }
    }
}
