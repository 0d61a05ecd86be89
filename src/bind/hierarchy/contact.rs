//! The hierarchy of a drawing in which no string names a part, but labels or ids do, or which moves: parts that touch hang on each
//! other.

use std::cmp::Reverse;
use std::collections::{BinaryHeap, VecDeque};

use glam::DVec2;
use rayon::prelude::*;
use rustc_hash::{FxHashMap, FxHashSet};
use typed_index_collections::TiSlice;

use super::Context;
use super::names::{self, Behind, Names};
use crate::anatomy::{self, Role, Term, Thing, sides};
use crate::bind::bindings::{NamedBy, PartId, PartKind};
use crate::bind::matching::{Matched, Stacking};
use crate::bind::names::OwnName;
use crate::geometry::{self, Body, Outline, area, intersect};
use crate::lang::ast::Annotation;
use crate::svg::Drawing;
use crate::threads::GRAIN;

/// Parts of one figure may be this far apart, as a share of the height of all named parts.
const GAP: f64 = 0.02;
/// An arm that touches nothing may be this far beside the trunk, as a share of the same height.
const BESIDE: f64 = 0.08;
/// How many points the outlines may have whose overlaps are computed. After that, bounding boxes decide.
const MAX_OVERLAP_POINTS: usize = 1 << 19;
/// A part that shares less than this with another one, as a share of the most that it shares with a part of a body, only brushes it.
const BRUSH: f64 = 0.1;
/// What a way to a part that is only brushed costs more, in parts.
const BRUSHED: u32 = 2;
/// What a way through a part without a name costs, in parts.
const UNNAMED: u32 = 1000;

/// In larger groups of parts without names the largest part is the root.
const MAX_MEMBERS: usize = 400;

/// Whether the hierarchy comes from contact: no string names a part, but people named at least two otherwise, or want the drawing to
/// move.
pub(super) fn decides(
    drawing: &Drawing,
    matched: &Matched,
    names: &TiSlice<PartId, OwnName>,
) -> bool {
    let parts = matched.parts.keys();
    let mains = parts.filter(|part| matched.kinds[*part] == PartKind::Main);
    let by_string =
        |part: PartId| names[part].by == NamedBy::String && !names[part].name.is_empty();
    let otherwise = |part: &PartId| {
        !names[*part].name.is_empty() || names::of_main_part(drawing, matched, *part).is_some()
    };
    !mains.clone().any(by_string)
        && (mains.filter(otherwise).nth(1).is_some() || matched.asks_for_motion())
}

/// Whether at most one part has a name of its own, so that names say nothing about what hangs on what.
pub(super) fn is_nameless(context: Context<'_>, names: &Names) -> bool {
    let mut named = context
        .mains()
        .filter(|part| is_named(&names.of_part[*part]));
    named.nth(1).is_none()
}

fn is_named(name: &OwnName) -> bool {
    name.by != NamedBy::Automatic && !name.name.is_empty()
}

/// Finds the parents of all parts that touch others, apart from those that a string attaches.
///
/// In each connected group the root is the trunk by its name, else the largest named part. If at most one part of the drawing has a
/// name, all count as named, and the root is the part in the middle, from which the others are least far. From there the others are
/// attached in the order of their distance: to the part that carries them by anatomy if they touch it, else to the one that they
/// overlap most of those nearest to the root. A part without a name hangs on the named part that it overlaps most.
///
/// `nameless` is the answer of [`is_nameless`].
pub(super) fn parents(
    context: Context<'_>,
    names: &Names,
    nameless: bool,
    stacking: &Stacking,
) -> Vec<(PartId, Option<PartId>)> {
    let bodies = NamedBodies::read(context, names, nameless, stacking);
    let part = |place: usize| bodies.parts[place];
    let found = bodies.parents().into_iter();
    found
        .map(|(place, parent)| (part(place), parent.map(part)))
        .collect()
}

/// A part, as far as its place in the hierarchy depends on it.
struct NamedBody {
    named: bool,
    role: Option<Role>,
    /// Whether its name says left, right.
    sides: [bool; 2],
    area: f64,
    behind: Option<Behind>,
    /// Whether nothing in its figure is called a head.
    is_headless: bool,
    /// Whether it is the hub or the rim of a wheel.
    is_hub: bool,
    /// If its string attaches it, the place of the part that it names; `None` for the root.
    attached: Option<Option<usize>>,
}

impl NamedBody {
    fn read(
        matched: &Matched,
        names: &Names,
        part: PartId,
        places: &FxHashMap<&str, usize>,
    ) -> Self {
        let annotation = matched.string_of(part).map(|string| &string.annotation);
        Self {
            named: is_named(&names.of_part[part]),
            role: None,
            sides: [false; 2],
            area: area(&matched.parts[part].outline),
            behind: None,
            is_headless: false,
            is_hub: false,
            attached: match annotation {
                Some(Annotation::Part(part)) => part
                    .parent
                    .as_ref()
                    .map(|parent| places.get(parent.text.as_str()).copied()),
                _ => None,
            },
        }
    }

    /// Whether it is a hand or a foot that may hang on the other part, which is larger.
    fn is_end_of(&self, other: &Self) -> bool {
        matches!(self.role, Some(Role::Hand | Role::Foot | Role::Toe)) && self.area < other.area
    }

    /// How well another part carries this one by their names, 0 the best; `None` if names do not tell.
    fn carried_by(&self, other: &Self) -> Option<usize> {
        let (role, carrier) = (self.role?, other.role?);
        let carriers = role.carriers();
        let place = carriers.iter().position(|role| *role == carrier);
        // An animal in one shape has its eyes on its body.
        let is_on_body = self.is_headless && role == Role::OfHead && carrier == Role::Body;
        let place = place.or(is_on_body.then_some(carriers.len()));
        place.filter(|_| !self.is_opposite(other))
    }

    /// Whether the names say that one is left and the other is right.
    fn is_opposite(&self, other: &Self) -> bool {
        let has_side = |sides: [bool; 2]| sides[0] != sides[1];
        self.sides != other.sides && has_side(self.sides) && has_side(other.sides)
    }
}

/// The main parts of a drawing, with those that they touch. Places are indices into `parts`.
struct NamedBodies {
    parts: Vec<PartId>,
    /// Whether at most one of them has a name of its own, so that all count as named.
    nameless: bool,
    /// Per part its bounding box, and the longer side of that.
    bounds: Vec<(DVec2, DVec2)>,
    lengths: Vec<f64>,
    /// The height of all named parts.
    height: f64,
    bodies: Vec<NamedBody>,
    /// Per part those that their strings attach to it.
    followers: Vec<Vec<usize>>,
    touching: Vec<Vec<usize>>,
    /// Per pair that touches, lower place first, the area that both share.
    shared: FxHashMap<(usize, usize), f64>,
    /// The same without the area where others lie between them.
    direct: FxHashMap<(usize, usize), f64>,
    /// Per part the largest area that it shares with a part of a body. Wheels carry nothing, however much lies over them.
    most_on_body: Vec<f64>,
}

impl NamedBodies {
    fn read(context: Context<'_>, names: &Names, nameless: bool, stacking: &Stacking) -> Self {
        let Context { matched, nodes, .. } = context;
        let parts: Vec<PartId> = context.mains().collect();
        let called = parts.iter().map(|part| names.of(*part));
        let places: FxHashMap<&str, usize> = called.zip(0..).collect();
        let mut bodies: Vec<NamedBody> = parts
            .iter()
            .map(|part| NamedBody::read(matched, names, *part, &places))
            .collect();
        for body in &mut bodies {
            body.named |= nameless;
        }
        let mut followers = vec![vec![]; parts.len()];
        for (place, body) in bodies.iter().enumerate() {
            if let Some(Some(parent)) = body.attached {
                followers[parent].push(place);
            }
        }
        let named = parts.iter().zip(&bodies).filter(|(_, body)| body.named);
        let (top, bottom) =
            named.fold((f64::INFINITY, f64::NEG_INFINITY), |(top, bottom), part| {
                let (low, high) = matched.parts[*part.0].measure.bounds;
                (top.min(low.y), bottom.max(high.y))
            });
        let place: FxHashMap<PartId, usize> = parts.iter().copied().zip(0..).collect();
        let mut outlines: Vec<Vec<&Outline>> = vec![vec![]; parts.len()];
        let mut bounds: Vec<_> = parts
            .iter()
            .map(|part| matched.parts[*part].measure.bounds)
            .collect();
        for (part, main) in matched.parts.iter().zip(&nodes.main) {
            // A group touches with all of its shapes.
            if let Some(&place) = place.get(main) {
                outlines[place].push(&part.outline);
                let (low, high) = part.measure.bounds;
                bounds[place] = (bounds[place].0.min(low), bounds[place].1.max(high));
            }
        }
        let slack = GAP * (bottom - top).max(0.0);
        let areas: Vec<Body<'_>> = outlines
            .iter()
            .zip(bounds.iter().copied())
            .map(|(outlines, bounds)| Body {
                outlines: outlines.clone(),
                bounds,
                slack,
            })
            .collect();
        let touching = geometry::touching(&areas);
        for figure in geometry::connected(&touching) {
            read_names(names, &parts, figure, &mut bodies);
        }
        let lengths = areas
            .iter()
            .map(|body| (body.bounds.1 - body.bounds.0).max_element());
        let lengths = lengths.collect();
        let shared = shared(&areas, &touching);
        let direct = direct(context, stacking, &place, &shared);
        let mut read = Self {
            parts,
            nameless,
            bounds,
            lengths,
            height: (bottom - top).max(0.0),
            bodies,
            followers,
            touching,
            shared,
            direct,
            most_on_body: Vec::new(),
        };
        let places = 0..read.parts.len();
        read.most_on_body = places.map(|place| read.most_on_body(place)).collect();
        read
    }

    fn most_on_body(&self, place: usize) -> f64 {
        let others = self.touching[place].iter();
        let of_body = others.filter(|other| self.bodies[**other].role.is_some());
        let areas = of_body.map(|other| self.shared(place, *other));
        areas.fold(0.0, f64::max)
    }

    fn shared(&self, one: usize, other: usize) -> f64 {
        let pair = (one.min(other), one.max(other));
        self.shared.get(&pair).copied().unwrap_or(0.0)
    }

    /// The area by which a part lies on another one, as far as that decides what carries it: a part without a name belongs to what is
    /// seen beside it.
    fn on(&self, place: usize, other: usize) -> f64 {
        if self.bodies[place].named {
            return self.shared(place, other);
        }
        let pair = (place.min(other), place.max(other));
        self.direct.get(&pair).copied().unwrap_or(0.0)
    }

    /// The part that carries another by anatomy, or for a part without a name the named part that it overlaps most; one without a name
    /// if it overlaps none with one, and is only near a limb. A leg overlaps
    /// the cape behind it most, and a fork the wheel, and both hang on the body; so does what lies over limbs
    /// of both sides, and an arm rather than on its hand.
    fn carrier(&self, place: usize) -> Option<usize> {
        let own = &self.bodies[place];
        let joins_sides = !own.named && self.joins_sides(place);
        let most = self.touching[place].iter();
        let most = most.map(|other| self.on(place, *other));
        let most = most.fold(0.0, f64::max);
        let rank = |index: &usize| {
            let other = &self.bodies[*index];
            // A hub turns with its wheel, over which more of the body may lie.
            if own.is_hub && other.behind == Some(Behind::Wheel) {
                return Some(0);
            }
            if own.named {
                return own.carried_by(other);
            }
            let is_limb = other.role.is_some_and(Role::is_piece_of_limb);
            let shared = self.on(place, *index);
            if !other.named {
                return (shared > 0.0).then_some(2);
            }
            // The weights on a bar are beside the hands that hold it.
            let is_near = is_limb && shared <= 0.0 && most > 0.0;
            // What is behind ears or hair is behind the head, if there is one.
            let is_behind =
                other.role == Some(Role::OfHead) && !other.is_headless && place < *index;
            let is_last = other.behind.is_some()
                || joins_sides && is_limb
                || other.is_end_of(own)
                || is_behind;
            Some(if is_near { 3 } else { usize::from(is_last) })
        };
        let ranked = self.touching[place]
            .iter()
            .filter_map(|other| Some((rank(other)?, *other)));
        let best = ranked.min_by(|(a, one), (b, other)| {
            let shared = [*other, *one].map(|of| self.on(place, of));
            a.cmp(b).then(shared[0].total_cmp(&shared[1]))
        });
        best.map(|(_, other)| other)
    }

    /// Whether a part touches limbs of both sides, as a belt does.
    fn joins_sides(&self, place: usize) -> bool {
        let touched = self.touching[place].iter();
        let touched = touched.map(|other| &self.bodies[*other]);
        let limbs = touched.filter(|other| other.role.is_some_and(Role::is_piece_of_limb));
        let has = |sides: [bool; 2]| limbs.clone().any(|limb| limb.sides == sides);
        // Of legs in one shape, no name says a side.
        let unsided = limbs.clone().filter(|limb| limb.sides == [false; 2]);
        let mut roles = unsided.map(|limb| limb.role);
        let first = roles.next();
        has([true, false]) && has([false, true]) || roles.any(|role| Some(role) == first)
    }

    /// The root of a connected group; `None` if nothing in it has a name.
    fn root(&self, members: &[usize]) -> Option<usize> {
        let named = members.iter().filter(|place| self.bodies[**place].named);
        let rank = |place: usize| {
            let trunk = self.bodies[place].role.and_then(Role::trunk);
            trunk.unwrap_or(u8::MAX)
        };
        // The least is taken.
        let size = |place: usize| match self.nameless && members.len() <= MAX_MEMBERS {
            true => self.distance_to_all(place),
            false => -self.bodies[place].area,
        };
        let ranked = named.map(|place| (rank(*place), size(*place), *place));
        let least = ranked.min_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
        least.map(|(.., place)| place)
    }

    /// How far a part is from all others of its group: how many parts on, each as often as it is long.
    fn distance_to_all(&self, place: usize) -> f64 {
        let mut steps = FxHashMap::from_iter([(place, 0.0)]);
        let mut queue = VecDeque::from([place]);
        let mut sum = 0.0;
        while let Some(place) = queue.pop_front() {
            let own: f64 = steps[&place];
            sum += own * self.lengths[place];
            for &other in &self.touching[place] {
                steps.entry(other).or_insert_with(|| {
                    queue.push_back(other);
                    own + 1.0
                });
            }
        }
        sum
    }

    /// The places with their parents, for all parts in groups with a name that no string attaches.
    fn parents(&self) -> Vec<(usize, Option<usize>)> {
        let carriers: Vec<Option<usize>> = (0..self.parts.len())
            .map(|place| self.carrier(place))
            .collect();
        let mut search = Search {
            found: Vec::new(),
            reached: vec![false; self.parts.len()],
            queue: BinaryHeap::new(),
        };
        for members in geometry::connected(&self.touching) {
            let root = self.root(&members);
            if let Some(root) = root.filter(|root| self.bodies[*root].attached.is_none()) {
                search.found.push((root, None));
                self.reach(root, 0, &carriers, &mut search);
            }
        }
        for place in 0..self.parts.len() {
            if self.bodies[place].attached == Some(None) {
                self.reach(place, 0, &carriers, &mut search);
            }
        }
        while let Some(Reverse(way)) = search.queue.pop() {
            if !search.reached[way.to] {
                search.found.push((way.to, Some(way.from)));
                self.reach(way.to, way.steps, &carriers, &mut search);
            }
        }
        self.hang_beside(&mut search.found);
        search.found
    }

    /// Hangs arms that touch nothing on the trunk beside which they lie, if there is only one.
    fn hang_beside(&self, found: &mut [(usize, Option<usize>)]) {
        let role = |place: usize| self.bodies[place].role;
        let mut trunks = (0..self.parts.len()).filter(|place| role(*place) == Some(Role::Body));
        let (Some(trunk), None) = (trunks.next(), trunks.next()) else {
            return;
        };
        let body = self.bounds[trunk];
        for (place, parent) in found {
            let own = self.bounds[*place];
            let gap = (own.0.x - body.1.x).max(body.0.x - own.1.x);
            let is_level = own.0.y < body.1.y && body.0.y < own.1.y;
            let is_arm = role(*place) == Some(Role::UpperArm);
            let is_beside = is_level && (0.0..=BESIDE * self.height).contains(&gap);
            if parent.is_none() && is_arm && is_beside && self.touching[*place].is_empty() {
                *parent = Some(trunk);
            }
        }
    }

    /// Reaches a part, and with it the parts that strings attach to it: those lead on only from here, so that nothing hangs on itself.
    fn reach(&self, place: usize, steps: u32, carriers: &[Option<usize>], search: &mut Search) {
        let mut waiting = vec![place];
        while let Some(place) = waiting.pop() {
            if std::mem::replace(&mut search.reached[place], true) {
                continue;
            }
            self.extend(place, steps, carriers, search);
            waiting.extend_from_slice(&self.followers[place]);
        }
    }

    /// Queues the ways from a part that was reached to those that it touches.
    fn extend(&self, from: usize, steps: u32, carriers: &[Option<usize>], search: &mut Search) {
        let through = match &self.bodies[from] {
            // A hand before a cape is that of an arm, even of one without a name.
            body if body.behind == Some(Behind::Cape) => 2 * UNNAMED,
            body if body.named => 1,
            _ => UNNAMED,
        };
        for to in self.touching[from].iter().copied() {
            if search.reached[to] || self.bodies[to].attached.is_some() {
                continue;
            }
            let doubt = match carriers[to] {
                Some(carrier) if carrier == from => 0,
                // The paw of a near leg lies over the far leg, too.
                _ if self.bodies[from].is_opposite(&self.bodies[to]) => 3,
                // A leg hangs on what has no name of the body rather than on a wing.
                None if self.bodies[from].role.is_none() || self.bodies[to].role.is_none() => 1,
                _ => 2,
            };
            let shared = self.shared(from, to);
            // A shield on an arm, whose edge is at the body's, hardly hangs on the body.
            let brushed = if shared < BRUSH * self.most_on_body[to] {
                BRUSHED
            } else {
                0
            };
            search.queue.push(Reverse(Way {
                doubt,
                steps: steps.saturating_add(through + brushed),
                // Areas are not negative, so their bits are in their order. No area may be -0, of which `max` makes either zero.
                shared: Reverse((shared.max(0.0) + 0.0).to_bits()),
                to,
                from,
            }));
        }
    }
}

/// Reads what the names of one figure's parts say. Clothes name what wears them if nothing else does.
fn read_names(names: &Names, parts: &[PartId], mut figure: Vec<usize>, bodies: &mut [NamedBody]) {
    figure.retain(|place| bodies[*place].named);
    let terms = |place: &usize| anatomy::terms(names.of(parts[*place]));
    let mut said: Vec<Vec<Term>> = figure.iter().map(terms).collect();
    anatomy::dress(&mut said);
    let is_headless = !said.iter().any(|terms| Role::of(terms) == Some(Role::Head));
    for (place, terms) in figure.into_iter().zip(said) {
        bodies[place].is_headless = is_headless;
        bodies[place].role = Role::of(&terms);
        bodies[place].sides = sides(&terms);
        let name = names.of(parts[place]);
        bodies[place].behind = Behind::of(name, &terms);
        bodies[place].is_hub = anatomy::thing(name) == Some(Thing::Hub);
    }
}

/// The state of the search for parents.
struct Search {
    found: Vec<(usize, Option<usize>)>,
    reached: Vec<bool>,
    queue: BinaryHeap<Reverse<Way>>,
}

/// A way to attach a part; the least is taken first.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Way {
    /// 0 if names tell it, 1 if they tell nothing, 2 if they tell otherwise, 3 if they tell that it is the other side's.
    doubt: u8,
    /// How many parts lie between the root and it.
    steps: u32,
    shared: Reverse<u64>,
    to: usize,
    from: usize,
}

/// The areas that touching bodies share.
fn shared(areas: &[Body<'_>], touching: &[Vec<usize>]) -> FxHashMap<(usize, usize), f64> {
    let points = |body: &Body<'_>| -> usize {
        let outlines = body.outlines.iter();
        let polygons = outlines.flat_map(|outline| &outline.polygons);
        polygons
            .flat_map(|polygon| &polygon.rings)
            .map(Vec::len)
            .sum()
    };
    let mut left = MAX_OVERLAP_POINTS;
    let mut pairs = Vec::new();
    for (one, others) in touching.iter().enumerate() {
        for &other in others.iter().filter(|other| **other > one) {
            let (a, b) = (&areas[one], &areas[other]);
            let cost = points(a) * b.outlines.len() + points(b) * a.outlines.len();
            let rest = left.checked_sub(cost);
            left = rest.unwrap_or(left);
            pairs.push((one, other, rest.is_some()));
        }
    }
    let pairs = pairs.into_par_iter().with_min_len(GRAIN);
    let shared = pairs.map(|(one, other, exact)| {
        let (a, b) = (&areas[one], &areas[other]);
        let both = if exact {
            let outlines = a.outlines.iter();
            let pairs = outlines.flat_map(|one| b.outlines.iter().map(move |other| (one, other)));
            pairs.map(|(one, other)| area(&intersect(one, other))).sum()
        } else {
            let low = a.bounds.0.max(b.bounds.0);
            let high = a.bounds.1.min(b.bounds.1);
            (high - low).max(DVec2::ZERO).element_product()
        };
        ((one, other), both)
    });
    shared.collect()
}

/// Of the areas that parts share, those where nothing lies between them: a visor lies on a face, however much of the hair is behind
/// that. What is not known to lie on anything keeps the whole.
fn direct(
    context: Context<'_>,
    stacking: &Stacking,
    places: &FxHashMap<PartId, usize>,
    shared: &FxHashMap<(usize, usize), f64>,
) -> FxHashMap<(usize, usize), f64> {
    let Context { matched, nodes, .. } = context;
    let place = |part: PartId| places.get(&nodes.main[part]).copied();
    let mut seen: FxHashMap<(usize, usize), f64> = FxHashMap::default();
    let mut unknown: FxHashSet<usize> = FxHashSet::default();
    for part in matched.parts.keys() {
        let Some(own) = place(part) else {
            continue;
        };
        if !stacking.has(part) {
            unknown.insert(own);
            continue;
        }
        let facts = stacking.of_part(part);
        for (other, share) in &facts.under {
            if let Some(other) = place(*other) {
                let pair = (own.min(other), own.max(other));
                *seen.entry(pair).or_default() += share * facts.area;
            }
        }
    }
    let shared = shared.iter().map(|(pair, area)| {
        let is_unknown = unknown.contains(&pair.0) || unknown.contains(&pair.1);
        let seen = seen.get(pair).copied().unwrap_or(0.0);
        (*pair, if is_unknown { *area } else { area.min(seen) })
    });
    shared.collect()
}
