//! Names for the parts of a drawing that nobody has named, as a careful person would give them.
//!
//! What eyes and wheels tell comes first. With these names the drawing is a figure, so a second look finds its limbs, with the labels by
//! which it moves. What hangs on what follows from the names, as for any drawing with names.

use rustc_hash::{FxHashMap, FxHashSet};
use typed_index_collections::TiSlice;

use super::open_groups::OpenGroups;
use super::taken::Taken;
use super::{Analysis, Refusal};
use crate::anatomy::{Language, Noun, terms};
use crate::bind::{Bindings, Numbers, Part, PartId, PartKind, written_by_a_person};
use crate::compile::{Compiled, Options, compile};
use crate::diagnostic::{Edit, applied};
use crate::ide::rename::label_edit;
use crate::labels::{
    BUST, Certainty, Class, Drawn, GRID_SIDE, Guess, Guesses, Label, LimbSegment, Mask, Profile,
    Side, guess,
};
use crate::resolver::MemoryResolver;
use crate::rig::FigureFacing;
use crate::source::Span;
use crate::svg::{Drawing, Element, GroupId, ShapeId};

/// How many shapes are looked at, the largest ones, …
const MAX_SHAPES: usize = 2000;
/// … and how many shapes and groups: the others are details.
const MAX_UNITS: usize = 400;
/// The second piece of a leg or an arm is a foot or a hand if it is at most this share of the first.
const FOOT: f64 = 0.75;
const HAND: f64 = 0.5;
/// How often the figure is looked at, with what was found before.
const ROUNDS: usize = 3;
/// What makes a figure of parts without names.
const MOVING: &str = "<text>%Motion walk</text>";

/// A name for a part that has none.
#[derive(Debug, Clone, PartialEq)]
pub struct Suggestion {
    /// The name.
    pub name: String,
    /// The start tag of the element that gets it.
    pub element: Span,
    /// The `id` of the element.
    pub id: Option<String>,
    /// How sure it is.
    pub certainty: Certainty,
    /// Why, a clause: `two dark spots lie on it`.
    pub why: String,
}

/// A shape, or a group that is one part.
struct Unit {
    group: Option<GroupId>,
    shapes: Vec<ShapeId>,
    drawn: Drawn,
    /// Per shape what it covers, and its colour.
    details: Vec<(Mask, [u8; 3])>,
    /// Whether it may be named: nothing names it, and its element is no one else's.
    is_free: bool,
}

impl Unit {
    /// Its shapes by themselves.
    fn details(&self, index: usize) -> impl Iterator<Item = (ShapeId, Drawn)> {
        let shapes = self.shapes.iter().zip(&self.details);
        shapes.map(move |(shape, (mask, color))| {
            let drawn = Drawn {
                name: String::new(),
                known: None,
                mask: mask.clone(),
                color: *color,
                unit: index,
            };
            (*shape, drawn)
        })
    }
}

/// A name before it is written.
#[derive(Clone)]
pub(super) struct Found {
    unit: usize,
    pub(super) noun: Noun,
    pub(super) side: Option<Side>,
    /// Whether it is a fore leg or a hind one.
    pub(super) fore: Option<bool>,
    certainty: Certainty,
    why: String,
}

impl From<Guess> for Found {
    fn from(guess: Guess) -> Self {
        Self {
            certainty: guess.certainty,
            why: guess.why.to_owned(),
            ..Self::new(guess.shape, guess.noun, guess.side)
        }
    }
}

impl Found {
    pub(super) fn new(unit: usize, noun: Noun, side: Option<Side>) -> Self {
        Self {
            unit,
            noun,
            side,
            fore: None,
            certainty: Certainty::Certain,
            why: String::new(),
        }
    }

    /// What has a name already, as far as others are found around it.
    fn named((index, unit): (usize, &Unit)) -> Option<Self> {
        Some(Self::new(index, unit.drawn.known?, None))
    }
}

impl Analysis {
    /// Whether no part has a name that a person gave it.
    pub(in crate::ide) fn is_nameless(&self) -> bool {
        let parts = self.bindings().parts.iter();
        self.is_sound()
            && parts
                .clone()
                .all(|part| part.is_automatic() || part.name.is_empty())
    }

    /// Names for the parts that have none, in the order of the file.
    ///
    /// # Errors
    /// If nothing in the drawing looks like a part of a figure or of a vehicle.
    pub fn suggestions(&self) -> Result<Vec<Suggestion>, Refusal> {
        let units = self.units();
        if units.is_empty() {
            return Err(Refusal::new(
                "no shape of the drawing can be a part of a figure: draw some with a fill, or open the drawing's groups",
            ));
        }
        if !units.iter().any(|unit| unit.is_free) {
            return Err(Refusal::new("every part has a name already"));
        }
        let parts = self.bindings().parts.iter();
        let names = parts.filter(|part| !part.is_automatic() && !part.name.is_empty());
        let names: Vec<&str> = names.map(|part| part.name.as_str()).collect();
        let language = Language::of(names.iter().copied());
        let taken = Taken::of(&names);
        let drawn: Vec<Drawn> = units.iter().map(|unit| unit.drawn.clone()).collect();
        let mut shapes: Vec<(ShapeId, Drawn)> = units
            .iter()
            .enumerate()
            .flat_map(|(index, unit)| unit.details(index))
            .collect();
        shapes.sort_by_key(|(shape, _)| *shape);
        let shapes: Vec<Drawn> = shapes.into_iter().map(|(_, drawn)| drawn).collect();
        let Guesses {
            all,
            has_head,
            profile,
        } = guess(&drawn, &shapes);
        let mut found: Vec<Found> = all.into_iter().map(Found::from).collect();
        found.retain(|found| units[found.unit].is_free && !taken.takes(found));
        let named: Vec<Found> = units.iter().enumerate().filter_map(Found::named).collect();
        // Each name says more about what hangs on what, and that says more about what it is.
        for _ in 0..ROUNDS {
            let so_far = self.written(&units, &found, language, &taken);
            let figure = self.named_so(&so_far, names.len());
            let known = [named.as_slice(), &found].concat();
            let more = by_labels(&units, &known, (has_head, profile), &taken, &figure);
            if more.is_empty() {
                break;
            }
            found.extend(more);
        }
        let all = self.written(&units, &found, language, &taken);
        if !names.is_empty() && all.is_empty() {
            return Err(Refusal::new(
                "nothing without a name looks like another part of the figure",
            ));
        }
        if names.is_empty() && !is_figure(&found) {
            return Err(Refusal::new(
                "nothing looks like a head with two eyes, like wheels, or like limbs around a body: name at least two parts, and the rest \
                 can be found from these",
            ));
        }
        Ok(all)
    }

    /// Those names with the edits that write them, in order.
    ///
    /// # Errors
    /// As [`Analysis::suggestions`], and if the drawing cannot be read.
    pub fn named_parts(&self) -> Result<(Vec<Edit>, Vec<Suggestion>), Refusal> {
        super::readable(self)?;
        let found = self.suggestions()?;
        let mut edits = self.labels(&found);
        edits.sort_by_key(|edit| edit.span);
        Ok((edits, found))
    }

    /// The part that a part of this name hangs on, or whose shape it belongs to.
    pub fn carrier_of(&self, name: &str) -> Option<String> {
        let parts = &self.bindings().parts;
        let part = parts.iter().find(|part| part.name == name)?;
        let above = if part.kind == PartKind::Sub {
            Some(part.main)
        } else {
            part.parent
        };
        Some(parts[above?].name.clone())
    }

    /// The edits that write suggested names.
    fn labels(&self, suggestions: &[Suggestion]) -> Vec<Edit> {
        let edit = |found: &Suggestion| label_edit(&self.source, found.element, &found.name);
        suggestions.iter().map(edit).collect()
    }

    /// The drawing as it would be with some names.
    fn named_so(&self, suggestions: &[Suggestion], names: usize) -> Compiled {
        let mut edits = self.labels(suggestions);
        edits.sort_by_key(|edit| edit.span);
        let mut text = applied(&self.source, &edits);
        // Fewer names do not say what hangs on what, but a motion does.
        if suggestions.len() + names < 2
            && let Some(end) = text.rfind("</svg")
        {
            text.insert_str(end, MOVING);
        }
        compile(&text, &Options::default(), &MemoryResolver::default())
    }

    /// The names, each only once, in the order of the file.
    fn written(
        &self,
        units: &[Unit],
        found: &[Found],
        language: Language,
        taken: &Taken,
    ) -> Vec<Suggestion> {
        let mut sorted: Vec<&Found> = found.iter().collect();
        sorted.sort_by_key(|found| found.unit);
        let mut taken = taken.names.clone();
        let mut numbers = Numbers::default();
        let mut suggestions = Vec::new();
        for found in sorted {
            let left = found.side.map(|side| side == Side::Left);
            let mut name = found.noun.written(left, found.fore, language);
            if taken.contains(&name) {
                name = numbers.free(&name, 2, |name| !taken.contains(name));
            }
            taken.insert(name.clone());
            let element = element(self.drawing(), &units[found.unit]);
            suggestions.push(Suggestion {
                name,
                element: element.span,
                id: element.id.clone(),
                certainty: found.certainty,
                why: found.why.clone(),
            });
        }
        suggestions
    }

    /// The shapes and groups that can be parts, in the order in which they are drawn.
    fn units(&self) -> Vec<Unit> {
        let drawing = self.drawing();
        let mut members: Vec<(Option<GroupId>, Vec<ShapeId>)> = Vec::new();
        let mut places: FxHashMap<(Option<GroupId>, Option<ShapeId>), usize> = FxHashMap::default();
        let solid = |kind: PartKind| matches!(kind, PartKind::Main | PartKind::Sub);
        let parts = self.bindings().parts.iter();
        let mut parts: Vec<(usize, &Part)> = parts
            .filter(|part| solid(part.kind) && part.host.is_none())
            .enumerate()
            .collect();
        if parts.len() > MAX_SHAPES {
            let area = |part: &Part| {
                let (low, high) = part.measure.bounds;
                (high - low).element_product()
            };
            parts.sort_by(|(_, a), (_, b)| area(b).total_cmp(&area(a)));
            parts.truncate(MAX_SHAPES);
            parts.sort_unstable_by_key(|(place, _)| *place);
        }
        let parts: Vec<&Part> = parts.into_iter().map(|(_, part)| part).collect();
        let boxes = parts.iter().map(|part| (part.shape, part.measure.bounds));
        let open = OpenGroups::find(drawing, boxes);
        for part in &parts {
            let group = open.holder(drawing, drawing.shapes[part.shape].group);
            let key = (group, group.is_none().then_some(part.shape));
            let place = *places.entry(key).or_insert_with(|| {
                members.push((group, vec![]));
                members.len() - 1
            });
            if !members[place].1.contains(&part.shape) {
                members[place].1.push(part.shape);
            }
        }
        let extent = (open.high - open.low).max_element();
        let scale = GRID_SIDE as f64 / extent.max(f64::MIN_POSITIVE);
        let mut masks: FxHashMap<ShapeId, Mask> = FxHashMap::default();
        for part in &parts {
            let rings = part.outline.rings().map(|ring| {
                let points = ring.iter().map(|at| (*at - open.low) * scale);
                points.collect::<Vec<_>>()
            });
            let rings: Vec<_> = rings.collect();
            let mask = Mask::of_rings(rings.iter().map(Vec::as_slice));
            masks
                .entry(part.shape)
                .or_insert_with(Mask::empty)
                .add(&mask);
        }
        let named: FxHashMap<ShapeId, &str> = parts
            .iter()
            .filter(|part| !part.is_automatic() && !part.name.is_empty() || part.string.is_some())
            .map(|part| (part.shape, part.name.as_str()))
            .collect();
        let units = members.into_iter().map(|(group, shapes)| {
            let mut mask = Mask::empty();
            shapes.iter().for_each(|shape| mask.add(&masks[shape]));
            let largest = shapes.iter().max_by_key(|shape| masks[shape].count());
            let color = largest.map_or([0; 3], |shape| drawing.shapes[*shape].paint.color);
            let known = shapes.iter().find_map(|shape| named.get(shape));
            let mut unit = Unit {
                group,
                drawn: Drawn {
                    name: known.map_or_else(String::new, |name| (*name).to_owned()),
                    known: known.and_then(|name| Noun::of(name, &terms(name))),
                    mask,
                    color,
                    unit: 0,
                },
                details: shapes
                    .iter()
                    .map(|shape| (masks[shape].clone(), drawing.shapes[*shape].paint.color))
                    .collect(),
                is_free: known.is_none(),
                shapes,
            };
            unit.is_free &= self.is_alone(&unit);
            unit
        });
        let mut units: Vec<Unit> = units.collect();
        if units.len() > MAX_UNITS {
            let mut sizes: Vec<usize> = units.iter().map(|unit| unit.drawn.mask.count()).collect();
            sizes.sort_unstable_by(|a, b| b.cmp(a));
            let least = sizes[MAX_UNITS];
            units.retain(|unit| unit.drawn.mask.count() > least);
        }
        units
    }

    /// Whether an element is written once, and has no name and no description of a person's.
    fn is_alone(&self, unit: &Unit) -> bool {
        let own = element(self.drawing(), unit);
        let all = self.drawing().shapes.iter();
        let alike = all.filter(|shape| shape.element.span == own.span).count();
        let is_written = own.span.start < own.span.end;
        let is_named =
            |name: &Option<String>| name.as_deref().and_then(written_by_a_person).is_some();
        is_written
            && alike <= 1
            && !is_named(&own.label)
            && !is_named(&own.id)
            && own.desc.is_none()
    }
}

/// The element that a name is written on.
fn element<'a>(drawing: &'a Drawing, unit: &Unit) -> &'a Element {
    match unit.group {
        Some(group) => &drawing.groups[group].element,
        None => &drawing.shapes[unit.shapes[0]].element,
    }
}

/// Whether what was found makes a figure or a vehicle: a lamp has a body and a foot, too.
fn is_figure(found: &[Found]) -> bool {
    let has = |nouns: &[Noun]| found.iter().any(|found| nouns.contains(&found.noun));
    let limbs = found
        .iter()
        .filter(|found| found.side.is_some() || found.noun == Noun::Tail);
    has(&[
        Noun::Eye,
        Noun::Eyes,
        Noun::Wheel,
        Noun::Wheels,
        Noun::FarLegs,
        Noun::NearLegs,
    ]) || found
        .iter()
        .any(|found| found.certainty == Certainty::Certain)
        || limbs.count() >= if has(&[Noun::Head]) { 1 } else { 3 }
}

/// What the labels of the figures say about parts without names.
fn by_labels(
    units: &[Unit],
    known: &[Found],
    (has_head, profile): (bool, Option<Profile>),
    taken: &Taken,
    compiled: &Compiled,
) -> Vec<Found> {
    let mut unit_of: FxHashMap<ShapeId, usize> = FxHashMap::default();
    for (index, unit) in units.iter().enumerate() {
        unit.shapes.iter().for_each(|shape| {
            unit_of.insert(*shape, index);
        });
    }
    let parts = &compiled.bindings.parts;
    let has = |nouns: &[Noun]| known.iter().any(|found| nouns.contains(&found.noun));
    let is_bust = has(&[Noun::Head]) && stands_on_body(units, known);
    let mut seen: FxHashSet<usize> = known.iter().map(|found| found.unit).collect();
    let mut found = Vec::new();
    for figure in &compiled.facings {
        let leg_pairs = figure
            .labels
            .iter()
            .filter(|(_, label, _)| label.class == Class::Leg)
            .map(|(_, label, _)| label.pair + 1)
            .max();
        let noun_of =
            |index: PartId, label: &Label| noun(label, ends(&compiled.bindings, figure, index));
        // Names need not say a side or a pair.
        let named = figure
            .labels
            .iter()
            .filter(|(index, ..)| taken.names.contains(&parts[*index].name));
        let named: Vec<_> = named
            .map(|(index, label, _)| (noun_of(*index, label).role(), label.side, label.pair))
            .collect();
        for (index, label, _) in &figure.labels {
            let part = &parts[*index];
            let Some(unit) = unit_of.get(&part.shape).copied() else {
                continue;
            };
            let is_known = match label.class {
                Class::Body => has(&[Noun::Body]),
                Class::Head => has_head,
                Class::Neck => has(&[Noun::Neck]),
                Class::Arm | Class::Leg | Class::Tail | Class::Hips => is_bust,
            };
            // Pairs that are one shape were looked at before: a limb by itself is one piece.
            let mask = &units[unit].drawn.mask;
            let is_no_limb = profile.is_some_and(|profile| match label.class {
                Class::Arm => !profile.may_be_arm(mask) || profile.is_between_legs(mask),
                Class::Tail => profile.is_between_legs(mask),
                _ => false,
            });
            let is_pair = label.class.is_limb() && units[unit].drawn.has_several_pieces();
            if is_pair
                || is_no_limb
                || !part.is_automatic()
                || is_known
                || !units[unit].is_free
                || !seen.insert(unit)
            {
                continue;
            }
            let fore =
                (label.class == Class::Leg && leg_pairs == Some(2)).then_some(label.pair > 0);
            let noun = noun_of(*index, label);
            let new = Found {
                unit,
                noun,
                side: label.side,
                fore,
                certainty: certainty(label, known.is_empty()),
                why: without_names(&label.why, part, figure, parts),
            };
            if !taken.takes(&new) && !named.contains(&(noun.role(), label.side, label.pair)) {
                found.push(new);
            }
        }
    }
    found
}

/// A reason that speaks of parts by what they are: the names that they have so far are numbers.
fn without_names(
    why: &str,
    own: &Part,
    figure: &FigureFacing,
    parts: &TiSlice<PartId, Part>,
) -> String {
    let mut why = why.replace(&format!("`{}`", own.name), "it");
    for (other, label, _) in &figure.labels {
        let other = &parts[*other];
        if other.is_automatic() {
            let is = format!("the {}", label.class.name());
            why = why.replace(&format!("`{}`", other.name), &is);
        }
    }
    why
}

/// Whether a figure ends with its body, as a bust does.
fn stands_on_body(units: &[Unit], known: &[Found]) -> bool {
    let bottom = |unit: &Unit| unit.drawn.mask.lowest();
    let ground = units.iter().filter_map(bottom).max();
    let bodies = known.iter().filter(|found| found.noun == Noun::Body);
    let flat = bodies.filter(|found| units[found.unit].drawn.mask.foot() >= BUST);
    let body = flat.filter_map(|found| bottom(&units[found.unit])).max();
    let legs = known.iter().any(|found| {
        matches!(
            found.noun,
            Noun::Leg
                | Noun::Legs
                | Noun::Foot
                | Noun::Shoes
                | Noun::FarLegs
                | Noun::NearLegs
                | Noun::Feet
        )
    });
    !legs && matches!((ground, body), (Some(ground), Some(body)) if body + GRID_SIDE / 20 >= ground)
}

/// What a limb ends with.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Ends {
    /// This piece is a hand or a foot.
    Here,
    /// The next one is.
    Next,
    Elsewhere,
}

/// Where a limb in two pieces ends: the second one may be a shin, or a foot.
fn ends(bindings: &Bindings, figure: &FigureFacing, index: PartId) -> Ends {
    let parts = &bindings.parts;
    let label_of = |part: PartId| figure.labels.iter().find(|(other, ..)| *other == part);
    let size = |part: PartId| {
        let (low, high) = parts[part].measure.bounds;
        high - low
    };
    let is_end = |part: PartId| {
        let Some(((_, label, _), parent)) = label_of(part).zip(parts[part].parent) else {
            return false;
        };
        let is_last = !figure.labels.iter().any(|(other, next, _)| {
            parts[*other].parent == Some(part) && next.class == label.class
        });
        let (own, above) = (size(part), size(parent));
        let share = if label.class == Class::Leg {
            FOOT
        } else {
            HAND
        };
        let lies = label.class == Class::Arm || own.y <= 1.3 * own.x;
        label.segment == LimbSegment::Lower
            && is_last
            && lies
            && own.max_element() <= share * above.max_element()
    };
    if is_end(index) {
        return Ends::Here;
    }
    let mut next = figure.labels.iter().map(|(other, ..)| *other);
    if next.any(|other| parts[other].parent == Some(index) && is_end(other)) {
        Ends::Next
    } else {
        Ends::Elsewhere
    }
}

/// How sure a label is that only shape and place tell.
fn certainty(label: &Label, is_alone: bool) -> Certainty {
    match label.class {
        Class::Leg | Class::Body | Class::Hips | Class::Head if !is_alone => Certainty::Likely,
        Class::Leg | Class::Body => Certainty::Likely,
        _ => Certainty::Uncertain,
    }
}

fn noun(label: &Label, ends: Ends) -> Noun {
    match (label.class, label.segment, ends) {
        (Class::Head, _, _) => Noun::Head,
        (Class::Neck, _, _) => Noun::Neck,
        (Class::Body, _, _) => Noun::Body,
        (Class::Hips, _, _) => Noun::Hips,
        (Class::Tail, _, _) => Noun::Tail,
        (Class::Arm, _, Ends::Here) => Noun::Hand,
        (Class::Arm, _, Ends::Next) => Noun::Arm,
        (Class::Leg, _, Ends::Here) => Noun::Foot,
        (Class::Leg, _, Ends::Next) => Noun::Leg,
        (Class::Arm, LimbSegment::Upper, _) => Noun::UpperArm,
        (Class::Arm, LimbSegment::Lower, _) => Noun::Forearm,
        (Class::Arm, LimbSegment::End | LimbSegment::Beyond, _) => Noun::Hand,
        (Class::Arm, _, _) => Noun::Arm,
        (Class::Leg, LimbSegment::Upper, _) => Noun::Thigh,
        (Class::Leg, LimbSegment::Lower, _) => Noun::Shin,
        (Class::Leg, LimbSegment::End | LimbSegment::Beyond, _) => Noun::Foot,
        (Class::Leg, _, _) => Noun::Leg,
    }
}

/// Whether names that were suggested changed nothing else: what had a name has it still.
pub(super) fn keeps_names(before: &Analysis, after: &Analysis) -> bool {
    let names = |analysis: &Analysis| -> FxHashSet<String> {
        let parts = analysis.bindings().parts.iter();
        let named = parts.filter(|part| !part.is_automatic() && !part.name.is_empty());
        named.map(|part| part.name.clone()).collect()
    };
    names(before).is_subset(&names(after))
}
