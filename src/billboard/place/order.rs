//! Puts what is painted over something else in front of it.

use std::collections::VecDeque;

use typed_index_collections::{TiSlice, TiVec};

use super::{RegionId, RegionInView, Scene, TrackId, TrackPosition, ViewId, angle, snapped};
use crate::geometry::{area, bounds, intersect};

/// How far what is in front lies before what is behind, heights.
const GAP: f64 = 0.002;
/// Regions with a smaller common area do not overlap, squared heights.
const LEAST_OVERLAP: f64 = 1e-6;
/// An overlap by a smaller share of the smaller region says nothing about other views.
const LEAST_SHARE: f64 = 0.1;

/// One track that is painted over another.
#[derive(Debug, Clone, Copy)]
struct Over {
    lower: TrackId,
    upper: TrackId,
    /// Whether it also holds in views in which the two do not overlap.
    everywhere: bool,
}

/// Moves tracks towards the viewer of each view until everything that is painted over something else lies in front of it.
///
/// A view's own order comes first. Then that of the other views, the nearest first, as far as it does not contradict.
pub(super) fn put_in_front(scene: &Scene, placed: &mut TiSlice<TrackId, TrackPosition>) {
    let painted: TiVec<ViewId, Vec<Over>> = scene.views.keys().map(|v| painted(scene, v)).collect();
    for view in scene.views.keys() {
        let direction = scene.views[view].direction;
        let mut others: Vec<ViewId> = painted.keys().filter(|v| *v != view).collect();
        let degrees = |v: &ViewId| angle(direction, scene.views[*v].direction);
        others.sort_by(|a, b| degrees(a).total_cmp(&degrees(b)));
        let elsewhere = others.iter().flat_map(|v| &painted[*v]);
        let mut stacks = Stacks::new(placed.len());
        for over in painted[view]
            .iter()
            .chain(elsewhere.filter(|o| o.everywhere))
        {
            stacks.add(over.lower, over.upper);
        }
        let toward = direction.axes()[2];
        for (lower, upper) in stacks.upwards() {
            if scene.is_set(view, upper) {
                continue;
            }
            let room = scene.rooms.get(lower).copied().unwrap_or_default();
            let least = snapped(placed[lower].depths[view] + GAP + room);
            let placed = &mut placed[upper];
            let missing = least - placed.depths[view];
            if missing > 0.0 {
                placed.in_views[view] += toward * missing;
                placed.depths[view] = least;
            }
        }
    }
}

impl Scene<'_> {
    /// Whether the drawing sets the depth of a track in a view.
    fn is_set(&self, view: ViewId, track: TrackId) -> bool {
        let region = self.tracks[track].regions.get(view).copied().flatten();
        region.is_some_and(|id| self.set_depth(RegionInView { view, id }).is_some())
    }
}

/// Which tracks a view paints over which: contents over their containers, and overlapping regions in their order.
fn painted(scene: &Scene, view: ViewId) -> Vec<Over> {
    let regions = &scene.views[view].regions;
    let tracks = &scene.track_of[view];
    let height = scene.frames[view].height;
    let boxes: TiVec<RegionId, _> = regions.iter().map(|r| bounds(&r.outline)).collect();
    let areas: TiVec<RegionId, _> = regions.iter().map(|r| area(&r.outline)).collect();
    let mut all = Vec::new();
    let mut add = |lower: RegionId, upper: RegionId, everywhere| {
        if let (Some(lower), Some(upper)) = (tracks[lower], tracks[upper]) {
            all.push(Over {
                lower,
                upper,
                everywhere,
            });
        }
    };
    let within = |inner: RegionId| {
        let mut outer = Vec::new();
        let mut next = regions[inner].container;
        while let Some(container) = next.filter(|c| *c < regions.next_key() && !outer.contains(c)) {
            outer.push(container);
            next = regions[container].container;
        }
        outer
    };
    let containers: TiVec<RegionId, Vec<RegionId>> = regions.keys().map(within).collect();
    for (inner, outer) in containers.iter_enumerated() {
        for outer in outer {
            add(*outer, inner, true);
        }
    }
    for upper in regions.keys() {
        for lower in regions.keys().take_while(|lower| *lower < upper) {
            if containers[upper].contains(&lower) || containers[lower].contains(&upper) {
                continue;
            }
            let (Some(a), Some(b)) = (boxes[lower], boxes[upper]) else {
                continue;
            };
            let common = (a.1.min(b.1) - a.0.max(b.0)).max(glam::DVec2::ZERO);
            let least = LEAST_OVERLAP * height * height;
            if common.element_product() <= least {
                continue;
            }
            let common = area(&intersect(&regions[lower].outline, &regions[upper].outline));
            if common > least {
                let everywhere = common > LEAST_SHARE * areas[lower].min(areas[upper]);
                add(lower, upper, everywhere);
            }
        }
    }
    all
}

/// What lies over what, without cycles.
struct Stacks {
    over: TiVec<TrackId, Vec<TrackId>>,
    /// For each track, one bit for everything that lies over it.
    reached: TiVec<TrackId, Vec<u64>>,
}

impl Stacks {
    fn new(count: usize) -> Self {
        Self {
            over: vec![Vec::new(); count].into(),
            reached: vec![vec![0; count.div_ceil(64)]; count].into(),
        }
    }

    fn reaches(&self, from: TrackId, to: TrackId) -> bool {
        let to = usize::from(to);
        self.reached[from][to / 64] >> (to % 64) & 1 == 1
    }

    /// Adds a pair unless the opposite follows from those before, or it follows itself.
    fn add(&mut self, lower: TrackId, upper: TrackId) {
        if lower == upper || self.reaches(upper, lower) || self.reaches(lower, upper) {
            return;
        }
        self.over[lower].push(upper);
        let mut above = self.reached[upper].clone();
        let bit = usize::from(upper);
        above[bit / 64] |= 1 << (bit % 64);
        for below in self.reached.keys() {
            if below == lower || self.reaches(below, lower) {
                for (bits, new) in self.reached[below].iter_mut().zip(&above) {
                    *bits |= new;
                }
            }
        }
    }

    /// All pairs, each after those that end at its lower one.
    fn upwards(&self) -> Vec<(TrackId, TrackId)> {
        let mut waiting: TiVec<TrackId, usize> = vec![0; self.over.len()].into();
        for upper in self.over.iter().flatten() {
            waiting[*upper] += 1;
        }
        let free = waiting.keys().filter(|t| waiting[*t] == 0);
        let mut free: VecDeque<TrackId> = free.collect();
        let mut pairs = Vec::new();
        while let Some(lower) = free.pop_front() {
            for &upper in &self.over[lower] {
                pairs.push((lower, upper));
                waiting[upper] -= 1;
                if waiting[upper] == 0 {
                    free.push_back(upper);
                }
            }
        }
        pairs
    }
}
