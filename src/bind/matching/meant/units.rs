//! Units, which texts name, and what each would cost a text.

use std::collections::hash_map::Entry;
use std::sync::Arc;

use glam::DVec2;
use rayon::prelude::*;
use rstar::{AABB, PointDistance, RTree, RTreeObject};
use rustc_hash::FxHashMap;
use typed_index_collections::{TiSlice, TiVec, ti_vec};

use super::words::{self, Place, Sense};
use crate::bind::bindings::PartId;
use crate::bind::matching::parts::MatchedPart;
use crate::bind::matching::stacking::{Facts, Stacking};
use crate::budget::{self, Step};
use crate::geometry::{BoxTree, Outline, area_around, connected, distance_squared, indexed_box};
use crate::math;
use crate::memo::{Bits, Long, Memo, Same};
use crate::svg::GroupId;
use crate::threads::GRAIN;

// The costs, in font sizes. They were fitted to 1,682 texts laid on thirteen drawings, natural and beside, above, below,
// inside; see docs/figures.md for the rule in words, and for how it does on drawings that were held back.

/// Up to here a distance costs as much as it is long.
const NEAR: f64 = 3.0;
/// A unit that is covered where the text lies on it.
const COVERED: f64 = 0.5;
/// A unit that only the end of the text lies on or is near to: a text begins at what it means, or is centred on it.
const END: f64 = 0.4;
/// A detail, unless the whole text lies on it.
const DETAIL: f64 = 0.33;
/// A unit of which less than [`HARDLY_SHOWS`] shows, unless the text lies on what shows.
const HIDDEN: f64 = 1.5;
/// The share of its area below which a unit hardly shows.
const HARDLY_SHOWS: f64 = 0.25;
/// A text beside a unit: each font size that it is off the unit's middle, up to [`MAX_OFF`].
const OFF: f64 = 0.2;
/// A text that is farther off the middle than this costs no more, font sizes.
const MAX_OFF: f64 = 4.0;
/// A text that is neither level with the unit nor above or below it.
const DIAGONAL: f64 = 1.0;
/// A unit smaller than [`LARGE`], times the logarithm of how much smaller: people name large parts rather than small ones.
const SMALL: f64 = 0.1;
/// A unit about as large as a word, square font sizes.
const LARGE: f64 = 15.0;
/// Each font size between the middles of text and unit: it decides between what costs the same otherwise.
const MIDDLES: f64 = 0.002;
/// Half the height of a line of text, font sizes.
const HALF_LINE: f64 = 0.35;

/// How many leaves of the index are visited for each unit that is wanted: a group may have many members.
const VISITS: usize = 32;

/// What a text can name: a shape, or a group. Its members share a node.
#[derive(Debug)]
pub(super) struct Unit {
    /// Its parts, in paint order.
    pub(super) members: Vec<PartId>,
    /// The one that a text for the unit is bound to.
    pub(super) main: PartId,
    /// Its bounding box.
    bounds: (DVec2, DVec2),
    /// Its area, square units.
    area: f64,
    /// The unit on which it lies, if it is a detail.
    host: Option<usize>,
    /// Whether so little of it shows that it was hardly meant.
    hidden: bool,
    ground: bool,
    is_background: bool,
    /// What its own name says, which its label or id gives it.
    own: Sense,
    /// Where it is in its figure; `None` for ground and backgrounds.
    place: Option<Place>,
    /// Which texts may name it; `None` if none may.
    pub(super) scope: Option<Scope>,
}

/// The container whose texts may name a unit; `None` for texts outside of containers.
pub(in crate::bind) type Scope = Option<GroupId>;

/// The units of a drawing.
#[derive(Debug)]
pub(super) struct Units {
    stacking: Arc<Stacking>,
    pub(super) units: Vec<Unit>,
    /// Per part its unit.
    of_part: TiVec<PartId, usize>,
    /// Per scope the members of its units.
    trees: FxHashMap<Scope, RTree<Member>>,
}

/// What units are computed from.
#[derive(Debug, PartialEq, Eq, Hash)]
struct UnitsKey {
    stacking: Same<Stacking>,
    /// Per part the main part candidate of its node, and for such a candidate the scope, if texts may name it.
    parts: Long<(PartId, Option<Scope>, UnitName)>,
}

/// What is known of a unit apart from its shapes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub(in crate::bind::matching) struct UnitName {
    /// What its own name says.
    pub(in crate::bind::matching) own: Sense,
    /// Whether it is a background.
    pub(in crate::bind::matching) is_background: bool,
}

/// Where a text lies.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(in crate::bind) struct TextPlace {
    /// Its beginning, middle and end; or three times the end of its leader.
    pub(in crate::bind) points: Bits<[[f64; 2]; 3]>,
    /// Its font size.
    pub(in crate::bind) em: Bits<f64>,
    /// Whether a leader points to what it names.
    pub(in crate::bind) has_leader: bool,
    pub(in crate::bind) scope: Scope,
    /// What its name says.
    pub(in crate::bind) sense: Sense,
}

/// Which units would a text name at the least cost?
#[derive(Debug, PartialEq, Eq, Hash)]
struct CandidatesKey {
    units: Same<Units>,
    text: TextPlace,
    count: usize,
}

/// A unit that a text can have.
#[derive(Debug, Clone, Copy)]
pub(super) struct Candidate {
    /// Its number: small, because there are many candidates for each of very many texts.
    unit: u32,
    /// What it costs, font sizes.
    pub(super) cost: f64,
    /// At how many of the text's points it shows.
    pub(super) shows_at: u8,
}

impl Candidate {
    /// The number of the unit.
    pub(super) fn unit(&self) -> usize {
        self.unit as usize
    }
}

/// The units that a text can have.
pub(super) type Candidates = Arc<[Candidate]>;

impl Units {
    /// The units of `parts`; `scope` tells for a main part candidate which texts may name its unit.
    pub(super) fn read(
        stacking: &Arc<Stacking>,
        parts: &TiSlice<PartId, MatchedPart>,
        scope: impl Fn(PartId) -> Option<Scope>,
        name: impl Fn(PartId) -> UnitName,
        memo: &Memo,
    ) -> Arc<Self> {
        let part = |(index, part): (PartId, &MatchedPart)| {
            if part.main == index {
                (part.main, scope(index), name(index))
            } else {
                (part.main, None, UnitName::default())
            }
        };
        let key = UnitsKey {
            stacking: Same(Arc::clone(stacking)),
            parts: parts.iter_enumerated().map(part).collect(),
        };
        memo.get(key, |key| Arc::new(Self::new(key)))
    }

    fn new(key: &UnitsKey) -> Self {
        let stacking = &key.stacking.0;
        let parts: &TiSlice<PartId, _> = TiSlice::from_ref(&key.parts.0);
        let mut of_part = ti_vec![usize::MAX; parts.len()];
        let mains = parts.iter_enumerated();
        let mains = mains.filter(|(index, (main, ..))| index == main);
        let mains: Vec<PartId> = mains.map(|(index, _)| index).collect();
        for (unit, main) in mains.iter().enumerate() {
            of_part[*main] = unit;
        }
        // In paint order: a line may come before the main part of its group.
        let mut members: Vec<Vec<PartId>> = vec![vec![]; mains.len()];
        for (index, (main, ..)) in parts.iter_enumerated() {
            of_part[index] = of_part[*main];
            if *main == index || stacking.has(index) {
                members[of_part[*main]].push(index);
            }
        }
        let units = mains.into_par_iter().zip(members).with_min_len(GRAIN);
        let mut units: Vec<Unit> = units
            .map(|(main, members)| {
                let bounds = members.iter().map(|part| stacking.bounds(*part));
                let (low, high) = bounds
                    .reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)))
                    .unwrap_or_default();
                let facts = stacking.of_unit(&members);
                let host = host(stacking, &facts);
                let (_, scope, UnitName { own, is_background }) = parts[main];
                let is_ground = members.iter().all(|part| stacking.is_ground(*part));
                Unit {
                    bounds: (low, high),
                    area: facts.area,
                    host: host.map(|part| of_part[part]),
                    hidden: facts.shown < HARDLY_SHOWS * facts.area,
                    ground: is_ground || is_background,
                    is_background,
                    own,
                    place: None,
                    scope,
                    main,
                    members,
                }
            })
            .collect();
        find_places(&mut units);
        let mut leaves: FxHashMap<Scope, Vec<Member>> = FxHashMap::default();
        for (index, unit) in units.iter().enumerate() {
            let Some(scope) = unit.scope else { continue };
            let members = unit.members.iter().map(|part| {
                let (low, high) = stacking.bounds(*part);
                Member {
                    unit: index,
                    envelope: AABB::from_corners(low.to_array(), high.to_array()),
                    outline: Arc::clone(stacking.outline(*part)),
                }
            });
            leaves.entry(scope).or_default().extend(members);
        }
        let trees = leaves
            .into_iter()
            .map(|(scope, leaves)| (scope, RTree::bulk_load(leaves)));
        Self {
            stacking: Arc::clone(stacking),
            trees: trees.collect(),
            units,
            of_part,
        }
    }

    /// The units under each text and the `count` nearest ones.
    pub(super) fn candidates(
        self: &Arc<Self>,
        texts: impl Iterator<Item = (TextPlace, usize)>,
        memo: &Memo,
    ) -> Vec<Candidates> {
        let key = |(text, count)| CandidatesKey {
            units: Same(Arc::clone(self)),
            text,
            count,
        };
        memo.get_each(texts.map(key).collect(), |key| {
            key.units.0.candidates_of(&key.text, key.count).into()
        })
    }

    fn candidates_of(&self, text: &TextPlace, count: usize) -> Vec<Candidate> {
        let points = text.points.0.map(DVec2::from);
        let em = text.em.0;
        let mut found: Vec<Candidate> = Vec::new();
        let mut places: FxHashMap<usize, usize> = FxHashMap::default();
        let mut offer = |unit: usize, cost: f64, shows: bool| {
            let place = *places.entry(unit).or_insert(found.len());
            if place == found.len() {
                found.push(Candidate {
                    unit: unit as u32,
                    cost,
                    shows_at: 0,
                });
            }
            let found = &mut found[place];
            found.cost = found.cost.min(cost);
            found.shows_at += u8::from(shows);
        };
        let distinct = if text.has_leader { 1 } else { points.len() };
        for (index, point) in points[..distinct].iter().enumerate() {
            let place = if index == 2 { END } else { 0.0 };
            let stack = self.stacking.topmost(*point, count.max(1));
            let mut seen = stack.first().map(|part| self.of_part[*part]);
            let mut shows = true;
            while let Some(unit) = seen {
                offer(unit, place, shows);
                seen = self.units[unit].host;
                shows = false;
            }
            // As many as of those beside it: each is looked for among those found so far.
            for part in stack {
                offer(self.of_part[part], place + COVERED, false);
            }
            let Some(tree) = self.trees.get(&text.scope) else {
                continue;
            };
            for (unit, distance) in nearest(tree, *point, count) {
                // What contains the point is in the stack.
                if distance > 0.0 {
                    offer(unit, place + cost_of(distance.sqrt() / em), false);
                }
            }
        }
        budget::count(Step::Candidate, found.len());
        found.retain(|found| self.units[found.unit()].scope == Some(text.scope));
        for candidate in &mut found {
            candidate.cost += self.penalties(candidate, text, &points);
        }
        found
    }

    /// What a unit costs besides its distance.
    fn penalties(&self, candidate: &Candidate, text: &TextPlace, points: &[DVec2; 3]) -> f64 {
        let unit = &self.units[candidate.unit()];
        let em = text.em.0;
        let mut cost = 0.0;
        let lies_on = |point: &DVec2| {
            let mut members = unit.members.iter();
            members.any(|part| self.stacking.is_on(*part, *point))
        };
        if unit.host.is_some() && (text.has_leader || !points.iter().all(lies_on)) {
            cost += DETAIL;
        }
        if unit.hidden && candidate.shows_at == 0 {
            cost += HIDDEN;
        }
        cost += if unit.ground {
            words::cost_of_ground(text.sense, unit.own, unit.is_background)
        } else {
            words::cost(text.sense, unit.own, unit.place.as_ref())
        };
        let (low, high) = unit.bounds;
        let middle = points[0].midpoint(points[2]);
        let off = (low.midpoint(high) - middle).abs() / em;
        if !text.has_leader {
            let half_line = DVec2::new(0.0, HALF_LINE * em);
            let first = points[0].min(points[2]) - half_line;
            let last = points[0].max(points[2]) + half_line;
            let beside = first.x > high.x || last.x < low.x;
            let above_or_below = first.y > high.y || last.y < low.y;
            cost += match (beside, above_or_below) {
                (false, false) => 0.0,
                (true, false) => OFF * off.y.min(MAX_OFF),
                (false, true) => OFF * off.x.min(MAX_OFF),
                (true, true) => DIAGONAL + OFF * off.min_element().min(MAX_OFF),
            };
        }
        let smaller = LARGE * em * em / unit.area.max(f64::MIN_POSITIVE);
        cost + SMALL * math::ln(smaller).max(0.0) + MIDDLES * off.length()
    }

    /// How many units the texts of each scope may name.
    pub(super) fn count_by_scope(&self) -> FxHashMap<Scope, usize> {
        let mut counts = FxHashMap::default();
        for scope in self.units.iter().filter_map(|unit| unit.scope) {
            *counts.entry(scope).or_insert(0) += 1;
        }
        counts
    }
}

/// The units nearest to a point, each with the square of its distance.
fn nearest(tree: &RTree<Member>, point: DVec2, count: usize) -> Vec<(usize, f64)> {
    let mut nearest: Vec<(usize, f64)> = Vec::with_capacity(count + 1);
    let mut known: FxHashMap<usize, f64> = FxHashMap::default();
    // By the distance of boxes, which is never more than that of outlines and much quicker to find.
    let members = tree.nearest_neighbor_iter_with_distance_2(point.to_array());
    for (member, least) in members.take(VISITS * count) {
        let farthest = nearest
            .last()
            .map_or(f64::INFINITY, |(_, distance)| *distance);
        if nearest.len() == count && least >= farthest {
            break;
        }
        let distance = distance_squared(&member.outline, point);
        if nearest.len() == count && distance >= farthest {
            continue;
        }
        match known.entry(member.unit) {
            Entry::Occupied(entry) if *entry.get() <= distance => continue,
            Entry::Occupied(mut entry) => {
                entry.insert(distance);
                nearest.retain(|(unit, _)| *unit != member.unit);
            }
            Entry::Vacant(entry) => {
                entry.insert(distance);
            }
        }
        let place = nearest.partition_point(|(_, other)| *other <= distance);
        nearest.insert(place, (member.unit, distance));
        // One that is forgotten may have a member that is nearer.
        if let Some((unit, _)) = nearest.get(count) {
            known.remove(unit);
            nearest.truncate(count);
        }
    }
    nearest
}

/// The cost of a distance in font sizes: the distance itself, but what is far is about equally far, so that a text far from
/// everything does not displace one that lies on what it means.
fn cost_of(distance: f64) -> f64 {
    if distance > NEAR {
        NEAR * (1.0 + math::ln(distance / NEAR))
    } else {
        distance
    }
}

/// With how many others a unit is found to touch at most; a heap of shapes is not a figure.
const MAX_TOUCHED: usize = 64;

/// Finds where units are in their figures: those whose boxes overlap are one, apart from ground.
fn find_places(units: &mut [Unit]) {
    let figures = units.iter().enumerate();
    let figures: Vec<usize> = figures
        .filter_map(|(index, unit)| (!unit.ground && unit.area > 0.0).then_some(index))
        .collect();
    let boxes = figures.iter().enumerate();
    let boxes = boxes.map(|(place, index)| indexed_box(units[*index].bounds, place));
    let tree = BoxTree::bulk_load(boxes.collect());
    let touched = figures.par_iter().with_min_len(GRAIN).map(|index| {
        let around = area_around(units[*index].bounds, 0.0);
        let found = tree.locate_in_envelope_intersecting(around);
        found.map(|found| found.data).take(MAX_TOUCHED).collect()
    });
    let mut touched: Vec<Vec<usize>> = touched.collect();
    // What touches nothing that touches it was beyond the most.
    for place in 0..touched.len() {
        for other in touched[place].clone() {
            if other < place && touched[other].len() >= MAX_TOUCHED {
                touched[other].push(place);
            }
        }
    }
    for members in connected(&touched) {
        let members = members.into_iter().map(|place| figures[place]);
        let members: Vec<usize> = members.collect();
        let bounds = members.iter().map(|index| units[*index].bounds);
        let Some((low, high)) = bounds.reduce(|a, b| (a.0.min(b.0), a.1.max(b.1))) else {
            continue;
        };
        let largest = members.iter().map(|index| units[*index].area);
        let largest = largest.fold(f64::MIN_POSITIVE, f64::max);
        let size = (high - low).max(DVec2::splat(f64::MIN_POSITIVE));
        for (drawn, index) in members.iter().enumerate() {
            let unit = &mut units[*index];
            let (from, to) = unit.bounds;
            let extent = (to - from).max(DVec2::splat(f64::MIN_POSITIVE));
            unit.place = Some(Place {
                low: (from - low) / size,
                high: (to - low) / size,
                size: unit.area / largest,
                slender: extent.max_element() / extent.min_element(),
                fills: unit.area / extent.element_product().max(f64::MIN_POSITIVE),
                is_detail: unit.host.is_some(),
                drawn: drawn as f64 / members.len() as f64,
            });
        }
    }
}

/// The part on which a unit lies, if it is a detail: a larger, earlier one that is no ground and of which more shows.
fn host(stacking: &Stacking, facts: &Facts) -> Option<PartId> {
    let is_host = |part: &PartId| {
        let other = stacking.of_part(*part);
        !stacking.is_ground(*part) && other.area > facts.area && other.shown >= facts.area
    };
    facts.lies_on.iter().copied().find(is_host)
}

/// A member of a unit, found by its box.
#[derive(Debug)]
struct Member {
    unit: usize,
    envelope: AABB<[f64; 2]>,
    outline: Arc<Outline>,
}

impl RTreeObject for Member {
    type Envelope = AABB<[f64; 2]>;

    fn envelope(&self) -> Self::Envelope {
        self.envelope
    }
}

impl PointDistance for Member {
    /// The distance of its box.
    fn distance_2(&self, point: &[f64; 2]) -> f64 {
        self.envelope.distance_2(point)
    }
}
