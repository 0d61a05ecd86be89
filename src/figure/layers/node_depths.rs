//! The depths of nodes, from the order of drawing and the hierarchy.

use glam::DVec2;
use rayon::prelude::*;
use rustc_hash::FxHashMap;
use typed_index_collections::TiSlice;

use super::nodes::Nodes;
use super::overlaps::{Overlap, SAMPLES, Scratch};
use super::shapes::Shape;
use super::{Cover, Reason, vehicles};
use crate::bind::{Part, PartId};

/// The share of an overlap in front of which what is drawn later lies.
const QUANTILE: f64 = 0.9;
/// Below this share of the smaller unit, an overlap counts in proportion.
const RAMP: f64 = 0.25;
/// How far a unit is moved away from its parent at most, in its own heights.
const FARTHEST: f64 = 1.5;
/// In a drawing with more pairs of shapes that overlap, fewer points of each pair are looked at.
const MANY_OVERLAPS: usize = 1 << 12;
/// How much of a backdrop a later shape of what it hangs on covers, at least.
const BACKDROP: f64 = 0.5;
/// The same for a cape or a wing.
const SHEET: f64 = 0.01;
/// How high a backdrop is at most, in heights of what covers it.
const THIN: f64 = 0.5;
/// How far a near limb is in front of its parent, at least, in its own heights.
const NEAR: f64 = 0.3;
/// The ratios between the areas of twins.
const ALIKE: std::ops::Range<f64> = 0.4..2.5;
/// The cosine of the angle between the axes of twins, at least.
const PARALLEL: f64 = 0.7;

/// The nodes' depths with their reasons.
pub(super) struct NodeDepths {
    /// Per node its depth, drawing units.
    pub(super) depths: Vec<f64>,
    pub(super) reasons: Vec<Reason>,
}

impl NodeDepths {
    /// Those of a figure that lies in one plane, but for arms that have room to turn in front of it.
    pub(super) fn in_one_plane(nodes: &Nodes, room: &[f64]) -> Self {
        let mut depths = vec![0.0; nodes.len()];
        let mut reasons = vec![Reason::Plane; nodes.len()];
        for node in nodes.by_level() {
            let Some(parent) = nodes.parent[node] else {
                continue;
            };
            depths[node] = depths[parent] + room[node];
            if room[node] > 0.0 {
                reasons[node] = Reason::DrawnOver {
                    part: nodes.main[parent],
                };
            }
        }
        Self { depths, reasons }
    }
}

/// Per shape the later shapes that it is a backdrop of; makes backdrops thin.
pub(super) fn backdrops(
    shapes: &mut [Shape],
    nodes: &Nodes,
    overlaps: &[Vec<Overlap>],
    covers: &[Cover],
) -> Vec<Vec<usize>> {
    let mut found = vec![Vec::new(); shapes.len()];
    for (above, below) in overlaps.iter().enumerate() {
        for overlap in below.iter().filter(|_| shapes[above].is_main) {
            let shape = &shapes[overlap.below];
            let [node, later] = [overlap.below, above].map(|shape| nodes.of_shape[shape]);
            // A cape hangs behind arms and legs, too.
            let parent = nodes.parent[node].filter(|_| shape.is_sheet);
            let (is_near, least) = match parent {
                Some(parent) => (nodes.hangs_on(later, parent), SHEET),
                // A detail has no back of its own that something could be behind.
                None => {
                    let is_volume = !covers[above].is_detail;
                    (is_volume && nodes.hangs_on(node, later), BACKDROP)
                }
            };
            if shape.is_soft
                && shape.is_main
                && !shape.is_given
                && shape.of_vehicle.is_none()
                && shape.girth.is_none()
                && node != later
                && is_near
                && overlap.area >= least * shape.area
            {
                found[overlap.below].push(above);
            }
        }
    }
    for (shape, later) in found.iter().enumerate() {
        let highest = later.iter().map(|later| shapes[*later].height());
        if let Some(highest) = highest.reduce(f64::max) {
            shapes[shape].flatten(THIN * highest);
        }
    }
    found
}

/// What the depths of nodes are computed from.
pub(super) struct Figure<'a> {
    pub(super) parts: &'a TiSlice<PartId, Part>,
    pub(super) shapes: &'a [Shape],
    pub(super) nodes: &'a Nodes,
    pub(super) overlaps: &'a [Vec<Overlap>],
    pub(super) covers: &'a [Cover],
    /// Per node what `Stack` sets.
    pub(super) spread: &'a [f64],
    /// Per node how far it lies in front of what it hangs on to have room to turn.
    pub(super) room: &'a [f64],
    /// Per node whether it stays in the plane of what it hangs on.
    pub(super) is_in_plane: &'a [bool],
}

/// A group of nodes that keep their distances: a node with those that it wears or that lie on it.
struct Unit {
    /// The sum of the areas of its volumes.
    area: f64,
    /// The shapes that it is as high as.
    shapes: Vec<usize>,
}

impl Figure<'_> {
    /// The depths of all nodes.
    pub(super) fn place(&self) -> NodeDepths {
        let nodes = self.nodes;
        let unit_of = self.units();
        let units = self.measure(&unit_of);
        let constraints = self.constraints(&unit_of, &units);
        let mut near: Vec<Vec<usize>> = vec![Vec::new(); nodes.len()];
        let mut pairs: Vec<[usize; 2]> = constraints.keys().copied().collect();
        pairs.sort_unstable();
        for [below, above] in pairs {
            near[below].push(above);
            near[above].push(below);
        }
        let mut order: Vec<usize> = (0..nodes.len())
            .filter(|node| unit_of[*node] == *node)
            .collect();
        order.sort_by(|a, b| {
            let level = |node: usize| nodes.level[node];
            (level(*a).cmp(&level(*b)))
                .then(units[*b].area.total_cmp(&units[*a].area))
                .then(a.cmp(b))
        });
        let mut depths: Vec<Option<f64>> = vec![None; nodes.len()];
        let mut reasons = vec![Reason::Plane; nodes.len()];
        for node in order {
            let parent = nodes.parent[node];
            let base = parent
                .and_then(|parent| depths[unit_of[parent]])
                .unwrap_or(0.0);
            let base = base + nodes.shift[node];
            let cover = nodes.shape[node].map(|shape| &self.covers[shape]);
            let shape = nodes.shape[node].map(|shape| &self.shapes[shape]);
            let (depth, reason) = if let Some(offset) = nodes.given[node] {
                (base + offset, Reason::Given)
            } else if let Some(reason) = shape.and_then(vehicles::reason) {
                (base, reason)
            } else if cover.is_some_and(|cover| !cover.behind.is_empty()) {
                let height = self.height(&units[node]);
                let first = cover.and_then(|cover| cover.behind.first());
                let reason = first.map_or(Reason::Plane, |later| Reason::Backdrop {
                    of: self.shapes[*later].part,
                });
                (base - height, reason)
            } else if parent.is_none() || self.is_in_plane[node] {
                (base, Reason::Plane)
            } else {
                self.nearest(node, base, &near[node], &constraints, &depths, &units)
            };
            depths[node] = Some(depth);
            reasons[node] = reason;
        }
        let mut depths: Vec<f64> = depths.into_iter().map(Option::unwrap_or_default).collect();
        self.twins(&unit_of, &mut depths, &mut reasons);
        let depths = (0..nodes.len()).map(|node| depths[unit_of[node]]).collect();
        for node in 0..nodes.len() {
            if unit_of[node] != node
                && let Some(on) = nodes.parent[node]
            {
                reasons[node] = Reason::With {
                    part: nodes.main[on],
                };
            }
        }
        NodeDepths { depths, reasons }
    }

    /// Per node the one with which it keeps its distance.
    fn units(&self) -> Vec<usize> {
        let nodes = self.nodes;
        let mut unit_of: Vec<usize> = (0..nodes.len()).collect();
        for node in nodes.by_level() {
            let (Some(parent), Some(shape)) = (nodes.parent[node], nodes.shape[node]) else {
                continue;
            };
            let cover = &self.covers[shape];
            let mut wrapped = cover.wraps.iter().map(|other| nodes.of_shape[*other]);
            let is_worn = wrapped.any(|other| other == parent) || cover.is_detail;
            let is_free = nodes.given[node].is_none() && cover.behind.is_empty();
            if is_worn && is_free && !self.shapes[shape].is_given {
                unit_of[node] = unit_of[parent];
            }
        }
        unit_of
    }

    fn is_volume(&self, shape: usize) -> bool {
        !self.covers[shape].is_detail && !self.shapes[shape].is_given
    }

    fn measure(&self, unit_of: &[usize]) -> Vec<Unit> {
        let nodes = self.nodes;
        let mut units: Vec<Unit> = (0..nodes.len())
            .map(|_| Unit {
                area: 0.0,
                shapes: Vec::new(),
            })
            .collect();
        for (index, shape) in self.shapes.iter().enumerate() {
            if self.is_volume(index) {
                let node = nodes.of_shape[index];
                let unit = &mut units[unit_of[node]];
                unit.area += shape.area;
                if unit_of[node] == node {
                    unit.shapes.push(index);
                }
            }
        }
        for (node, unit) in units.iter_mut().enumerate() {
            if let Some(shape) = nodes.shape[node].filter(|_| unit.area == 0.0) {
                *unit = Unit {
                    area: self.shapes[shape].area,
                    shapes: vec![shape],
                };
            }
        }
        units
    }

    /// How high a unit is.
    fn height(&self, unit: &Unit) -> f64 {
        let heights = unit.shapes.iter().map(|shape| self.shapes[*shape].height());
        heights.fold(0.0, f64::max)
    }

    /// For pairs of units that overlap, how far the later one is to be in front of the earlier one.
    fn constraints(&self, unit_of: &[usize], units: &[Unit]) -> FxHashMap<[usize; 2], f64> {
        let unit = |shape: usize| unit_of[self.nodes.of_shape[shape]];
        let count: usize = self.overlaps.iter().map(Vec::len).sum();
        let on_line = if count > MANY_OVERLAPS {
            SAMPLES / 4
        } else {
            SAMPLES
        };
        let pairs = self.overlaps.par_iter().enumerate();
        let pairs = pairs
            .flat_map_iter(|(above, below)| below.iter().map(move |overlap| (above, *overlap)));
        let pairs = pairs.filter(|(above, overlap)| {
            unit(*above) != unit(overlap.below)
                && !self.covers[*above].is_detail
                && !self.covers[overlap.below].is_detail
        });
        let measured: Vec<([usize; 2], f64, f64)> = pairs
            .map_init(Scratch::default, |scratch, (above, overlap)| {
                let pair = [unit(overlap.below), unit(above)];
                let [earlier, later] = [&self.shapes[overlap.below], &self.shapes[above]];
                let by = |point: DVec2| earlier.front(point) - later.front(point);
                let distance = match (&earlier.natural, &later.natural) {
                    (None, None) => by(DVec2::ZERO),
                    _ => {
                        let samples = scratch.samples(later, earlier, on_line);
                        quantile(samples.into_iter().map(by).collect())
                    }
                };
                let share = pair.map(|unit| overlap.area / units[unit].area.max(f64::MIN_POSITIVE));
                (pair, distance, share[0].max(share[1]))
            })
            .collect();
        let mut constraints: FxHashMap<[usize; 2], [f64; 2]> = FxHashMap::default();
        for (pair, distance, share) in measured {
            let constraint = constraints.entry(pair).or_insert([f64::NEG_INFINITY, 0.0]);
            constraint[0] = constraint[0].max(distance);
            constraint[1] += share;
        }
        let ramped = |[distance, share]: [f64; 2]| {
            if distance > 0.0 {
                distance * (share / RAMP).min(1.0)
            } else {
                distance
            }
        };
        constraints
            .into_iter()
            .map(|(pair, constraint)| (pair, ramped(constraint)))
            .collect()
    }

    /// The depth nearest to `base` that keeps the distances to the units that are placed already.
    fn nearest(
        &self,
        node: usize,
        base: f64,
        near: &[usize],
        constraints: &FxHashMap<[usize; 2], f64>,
        depths: &[Option<f64>],
        units: &[Unit],
    ) -> (f64, Reason) {
        let (mut low, mut high) = (f64::NEG_INFINITY, f64::INFINITY);
        let (mut over, mut under) = (None, None);
        for &other in near {
            let Some(depth) = depths[other] else { continue };
            if let Some(distance) = constraints.get(&[other, node])
                && depth + distance > low
            {
                (low, over) = (depth + distance, Some(other));
            }
            // A neck that stays in the plane pushes no leg behind it: its surface is lifted over that.
            let gives_way = self.is_in_plane[other] && self.nodes.parent[node] != Some(other);
            if let Some(distance) = constraints.get(&[node, other])
                && depth - distance < high
                && !gives_way
            {
                (high, under) = (depth - distance, Some(other));
            }
        }
        let room = self.room[node];
        if room > 0.0 && base + room > low {
            (low, over) = (base + room, self.nodes.parent[node]);
        }
        let wanted = if low > high {
            low.midpoint(high)
        } else {
            base.max(low).min(high)
        };
        let farthest = room.max(FARTHEST * self.height(&units[node]));
        let by = self.spread[node] * (wanted - base).clamp(-farthest, farthest);
        let part = |other: Option<usize>| other.map(|other| self.nodes.main[other]);
        let reason = match (by > 0.0, by < 0.0, part(over), part(under)) {
            (true, _, Some(over), _) => Reason::DrawnOver { part: over },
            (_, true, _, Some(under)) => Reason::DrawnUnder { part: under },
            _ => Reason::Plane,
        };
        (base + by, reason)
    }

    /// Moves far limbs behind their parents by as much as near ones like them are in front.
    fn twins(&self, unit_of: &[usize], depths: &mut [f64], reasons: &mut [Reason]) {
        let nodes = self.nodes;
        let mut limbs: Vec<Vec<usize>> = vec![Vec::new(); nodes.len()];
        let mut worn: Vec<Vec<usize>> = vec![Vec::new(); nodes.len()];
        for node in 0..nodes.len() {
            let Some(parent) = nodes.parent[node].map(|parent| unit_of[parent]) else {
                continue;
            };
            let Some(shape) = nodes.shape[node] else {
                continue;
            };
            if unit_of[node] == node {
                limbs[parent].push(node);
            } else if unit_of[node] == parent
                && self.covers[shape].is_detail
                && self.shapes[shape].is_named
            {
                worn[parent].push(node);
            }
        }
        let mut pairs: Vec<(f64, usize, usize)> = Vec::new();
        let mut relative: FxHashMap<usize, f64> = FxHashMap::default();
        for (parent, limbs) in limbs.iter().enumerate() {
            let Some(trunk) = nodes.shape[parent] else {
                continue;
            };
            for &far in limbs {
                let Some(first) = nodes.shape[far].filter(|far| *far < trunk && self.is_free(*far))
                else {
                    continue;
                };
                if !self.overlaps[trunk]
                    .iter()
                    .any(|overlap| overlap.below == first)
                {
                    continue;
                }
                for &near in limbs.iter().chain(&worn[parent]) {
                    let Some(second) =
                        nodes.shape[near].filter(|near| *near > trunk && self.is_free(*near))
                    else {
                        continue;
                    };
                    if !self.overlaps[second]
                        .iter()
                        .any(|overlap| overlap.below == trunk)
                    {
                        continue;
                    }
                    let [a, b] = [first, second].map(|shape| &self.shapes[shape]);
                    let [one, other] = [a, b].map(|shape| &self.parts[shape.part].measure);
                    let ratio = a.area / b.area;
                    let distance = one.center.distance(other.center);
                    let is_alike = ALIKE.contains(&ratio)
                        && one.axis.dot(other.axis).abs() > PARALLEL
                        && distance < 2.0 * other.half_along;
                    if !is_alike {
                        continue;
                    }
                    let by = *relative.entry(near).or_insert_with(|| {
                        if unit_of[near] == near {
                            depths[near] - depths[parent]
                        } else {
                            self.stands_out(second, parent, unit_of)
                        }
                    });
                    if by >= NEAR * b.height() {
                        pairs.push((distance, far, near));
                    }
                }
            }
        }
        pairs.sort_by(|a, b| a.0.total_cmp(&b.0).then((a.1, a.2).cmp(&(b.1, b.2))));
        let mut used = vec![false; nodes.len()];
        let mut moved = vec![0.0; nodes.len()];
        for (_, far, near) in pairs {
            if used[far] || used[near] {
                continue;
            }
            (used[far], used[near]) = (true, true);
            let parent = nodes.parent[far].map_or(far, |parent| unit_of[parent]);
            let own = depths[far] - depths[parent];
            moved[far] = -(relative[&near] * self.spread[far]) - own;
            reasons[far] = Reason::Twin {
                of: nodes.main[near],
            };
        }
        // All that hangs on a limb moves with it.
        for node in nodes.by_level() {
            if unit_of[node] != node {
                continue;
            }
            if let Some(parent) = nodes.parent[node] {
                moved[node] += moved[unit_of[parent]];
            }
            depths[node] += moved[node];
        }
    }

    fn is_free(&self, shape: usize) -> bool {
        let node = self.nodes.of_shape[shape];
        self.covers[shape].behind.is_empty()
            && !self.shapes[shape].is_given
            && self.shapes[shape].of_vehicle.is_none()
            && self.nodes.given[node].is_none()
    }

    /// How far a limb that lies on its parent as a detail stands out from the parent's plane.
    fn stands_out(&self, shape: usize, parent: usize, unit_of: &[usize]) -> f64 {
        let mut scratch = Scratch::default();
        let mut fronts = Vec::new();
        for overlap in &self.overlaps[shape] {
            if unit_of[self.nodes.of_shape[overlap.below]] == parent {
                let below = &self.shapes[overlap.below];
                let samples = scratch.samples(&self.shapes[shape], below, SAMPLES);
                fronts.extend(samples.into_iter().map(|point| below.front(point)));
            }
        }
        fronts.sort_unstable_by(f64::total_cmp);
        let median = fronts.get(fronts.len() / 2).copied().unwrap_or(0.0);
        median.min(FARTHEST * self.shapes[shape].height())
    }
}

/// The value that nine tenths of these do not exceed.
pub(super) fn quantile(mut values: Vec<f64>) -> f64 {
    if values.is_empty() {
        return f64::NEG_INFINITY;
    }
    let place = (QUANTILE * (values.len() - 1) as f64).round() as usize;
    let (_, value, _) = values.select_nth_unstable_by(place, f64::total_cmp);
    *value
}
