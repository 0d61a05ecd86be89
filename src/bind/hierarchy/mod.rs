//! Names, parents and joints.

mod contact;
mod details;
mod garments;
mod joints;
mod limbs;
mod lines;
mod names;
mod parents;
mod pieces;
mod unnamed;

use std::sync::Arc;

use glam::DVec2;
use rayon::prelude::*;
use rstar::primitives::GeomWithData;
use rstar::{PointDistance, RTree};
use rustc_hash::FxHashMap;
use typed_index_collections::{TiSlice, TiVec, ti_vec};

use super::attributes::PartAttributes;
use super::bindings::{NamedBy, PartId, PartKind};
use super::describe::describe;
use super::matching::{LayerId, Matched};
use super::names::OwnName;
use crate::diagnostic::{Code, Diagnostic, few_or_one, listed};
use crate::geometry::{Measure, Outline, measure_along};
use crate::index::par_keys;
use crate::math;
use crate::memo::{Bits, Long, Memo};
use crate::svg::Drawing;
use crate::threads::GRAIN;
use joints::Joints;
use limbs::Limbs;
use names::Names;

/// The parts as nodes of the hierarchy.
pub(in crate::bind) struct Tree {
    /// Whether parts hang on those that they touch, because no string names a part but labels or ids do.
    pub(in crate::bind) by_contact: bool,
    /// The parts that share nodes.
    pub(in crate::bind) nodes: Nodes,
    /// Per part its name; empty for sub-parts, legends and unused parts without one.
    pub(in crate::bind) names: TiVec<PartId, OwnName>,
    /// Per part its parent, for a main part; `None` for a child of the root.
    pub(in crate::bind) parents: TiVec<PartId, Option<PartId>>,
    /// Per layer its parent, likewise.
    pub(in crate::bind) parent_of_layer: TiVec<LayerId, Option<PartId>>,
    /// The axes of the parts.
    pub(in crate::bind) axes: Axes,
    /// Per part its joint, drawing units.
    pub(in crate::bind) origins: TiVec<PartId, DVec2>,
}

/// Which parts share a node.
pub(in crate::bind) struct Nodes {
    /// Per part the main part candidate of its node.
    pub(in crate::bind) main: TiVec<PartId, PartId>,
    /// Per part its kind.
    pub(in crate::bind) kind: TiVec<PartId, PartKind>,
}

/// The axes of parts that are not those of their main shapes as they are drawn.
pub(in crate::bind) struct Axes {
    /// Those that `Axis` turns.
    turned: FxHashMap<PartId, Measure>,
    /// Those of all shapes of a part together.
    of_groups: FxHashMap<PartId, Measure>,
}

impl Axes {
    /// The axis, center and ends of a shape that `Axis` turns.
    pub(in crate::bind) fn turned(&self, part: PartId) -> Option<Measure> {
        self.turned.get(&part).copied()
    }

    /// The axis, center and ends of all shapes of a part together, where they are not those of its main shape.
    pub(in crate::bind) fn of_group(&self, part: PartId) -> Option<Measure> {
        self.of_groups.get(&part).copied()
    }

    /// The axis, center and ends of a part.
    pub(in crate::bind) fn measure<'a>(
        &'a self,
        matched: &'a Matched,
        part: PartId,
    ) -> &'a Measure {
        let of_group = self.of_groups.get(&part);
        let own = of_group.or_else(|| self.turned.get(&part));
        own.unwrap_or(&matched.parts[part].measure)
    }
}

/// What every step knows, once details are with the parts that they lie on.
#[derive(Clone, Copy)]
struct Context<'a> {
    drawing: &'a Drawing,
    matched: &'a Matched,
    nodes: &'a Nodes,
}

impl<'a> Context<'a> {
    fn mains(self) -> impl Iterator<Item = PartId> + use<'a> {
        let kinds = self.nodes.kind.iter_enumerated();
        kinds.filter_map(|(part, kind)| (*kind == PartKind::Main).then_some(part))
    }
}

/// Names every main part, and finds its parent, axis and joint.
pub(in crate::bind) fn build(
    drawing: &Drawing,
    matched: &Matched,
    attributes: &PartAttributes,
    memo: &Memo,
    diagnostics: &mut Vec<Diagnostic>,
) -> Tree {
    let said = names::of_strings(drawing, matched);
    let by_contact = contact::decides(drawing, matched, &said);
    let mut nodes = Nodes {
        main: matched.parts.iter().map(|part| part.main).collect(),
        kind: matched.kinds.clone(),
    };
    let stacking = matched.stacking(drawing, memo);
    nodes = details::join(drawing, matched, nodes, by_contact, &stacking);
    let context = Context {
        drawing,
        matched,
        nodes: &nodes,
    };
    let mut names = Names::new(context, said, diagnostics);
    names.give_own(context);
    let mut holders = lines::holders(context);
    let (mut parents, unnamed) = automatic(context, &mut names, &holders, memo);
    let is_nameless = by_contact && contact::is_nameless(context, &names);
    if by_contact {
        let found = contact::parents(context, &names, is_nameless, &stacking);
        set(&mut parents, found);
        set(&mut parents, parents::of_groups(context));
    }
    parents::other_signs(matched, &names, diagnostics);
    set(
        &mut parents,
        parents::of_strings(context, &names, diagnostics),
    );
    if by_contact {
        pieces::chain(context, &names, &mut parents);
    }
    let limbs = Limbs::read(context, memo);
    garments::dress(context, &names, &limbs, &mut parents);
    if !by_contact {
        lines::hang(context, &names, &mut parents, &mut holders);
    }
    let parent_of_layer = parents::of_layers(context, &names, diagnostics);
    let parents = parents::without_cycles(context, &names, parents, diagnostics);
    if matched.annotated {
        for parts in &unnamed {
            unnamed::report(context, &names, &parents, by_contact, parts, diagnostics);
        }
    }
    let mut axes = axes(context, attributes, &names, diagnostics);
    let is_limb = |part: PartId| joints::is_hinged(&names, &parents, part);
    let axis = |part: PartId| attributes.attributes(matched, part).axis();
    axes.of_groups = limbs.measures(is_limb, axis);
    let necks = joints::necks(context, &names, &parents);
    let joints = Joints {
        context,
        limbs: &limbs,
        attributes,
        names: &names,
        parents: &parents,
        axes: &axes,
        necks: &necks,
        holders: &holders,
        is_nameless,
    };
    let mains: Vec<PartId> = context.mains().collect();
    let found: Vec<(PartId, DVec2, Option<Diagnostic>)> = mains
        .into_par_iter()
        .with_min_len(GRAIN)
        .map(|part| {
            let origin = joints.origin(part);
            (part, origin, joints.turns_about_middle(part, origin))
        })
        .collect();
    let centers = matched.parts.iter().map(|part| part.measure.center);
    let mut origins: TiVec<PartId, DVec2> = centers.collect();
    for (part, origin, finding) in found {
        origins[part] = origin;
        diagnostics.extend(finding);
    }
    Tree {
        by_contact,
        nodes,
        names: names.of_part,
        parents,
        parent_of_layer,
        axes,
        origins,
    }
}

/// Replaces the parents of some parts.
fn set(parents: &mut TiSlice<PartId, Option<PartId>>, found: Vec<(PartId, Option<PartId>)>) {
    for (part, parent) in found {
        parents[part] = parent;
    }
}

/// Names the parts without a name. Returns the parents of them and of the other parts without a string: the nearest named main
/// parts (rule 5); and both kinds of parts without a string, those that labels and ids name first.
fn automatic(
    context: Context<'_>,
    names: &mut Names,
    holders: &FxHashMap<PartId, (PartId, DVec2)>,
    memo: &Memo,
) -> (TiVec<PartId, Option<PartId>>, [Vec<PartId>; 2]) {
    let matched = context.matched;
    let (named, waiting): (Vec<PartId>, Vec<PartId>) = context
        .mains()
        .partition(|part| !names.of(*part).is_empty());
    // What has a string carries what labels and ids name, and both carry what nothing names. Without strings two names are needed:
    // one says nothing about what hangs on what.
    let (by_string, mut by_element): (Vec<PartId>, Vec<PartId>) = named
        .iter()
        .partition(|part| matched.parts[**part].string.is_some());
    let carriers = if by_string.is_empty() && by_element.len() < 2 {
        vec![]
    } else {
        named
    };
    if by_string.is_empty() {
        by_element.clear();
    }
    let mut parents = ti_vec![None; matched.parts.len()];
    let found = nearest(matched, by_string, &by_element, memo);
    let carrying = parents::carrying(matched, names);
    let held_by = |part: PartId| holders.get(&part).map(|(holder, _)| *holder);
    for (part, parent) in by_element.iter().copied().zip(found.iter().copied()) {
        // A part that others are attached to must not hang on one of those.
        let parent = parent.filter(|parent| {
            !carrying.contains(&part) || !parents::hangs_on(matched, names, &parents, *parent, part)
        });
        parents[part] = parent.map(|nearest| held_by(part).unwrap_or(nearest));
    }
    let found = nearest(matched, carriers, &waiting, memo);
    let mut counter = 0;
    for (part, parent) in waiting.iter().copied().zip(found.iter().copied()) {
        let name = loop {
            counter += 1;
            let name = format!("U-{counter}");
            if names.is_free(&name) {
                break name;
            }
        };
        names.give(part, name, NamedBy::Automatic);
        parents[part] = parent.map(|nearest| held_by(part).unwrap_or(nearest));
    }
    (parents, [by_element, waiting])
}

/// The nearest of some parts to each of others.
fn nearest(
    matched: &Matched,
    named: Vec<PartId>,
    waiting: &[PartId],
    memo: &Memo,
) -> Arc<[Option<PartId>]> {
    let center = |part: PartId| Bits(matched.parts[part].measure.center.to_array());
    let question = NearestNamed {
        named: named.into_iter().map(|part| (center(part), part)).collect(),
        centers: waiting.iter().map(|part| center(*part)).collect(),
    };
    memo.get(question, NearestNamed::answer)
}

/// Which named part is nearest to each part without a string?
#[derive(PartialEq, Eq, Hash)]
struct NearestNamed {
    /// The centres of the named parts.
    named: Long<(Bits<[f64; 2]>, PartId)>,
    /// The centres of the parts without a string.
    centers: Long<Bits<[f64; 2]>>,
}

impl NearestNamed {
    /// The nearest named part of each; of several at the same distance, the back-most.
    fn answer(&self) -> Arc<[Option<PartId>]> {
        let named = self.named.0.iter();
        let named = named.map(|(center, part)| GeomWithData::new(center.0, *part));
        let tree = RTree::bulk_load(named.collect());
        let nearest = |Bits(center): &Bits<[f64; 2]>| {
            let distance = tree.nearest_neighbor(*center)?.distance_2(center);
            let as_near = tree.locate_within_distance(*center, distance);
            as_near.map(|found| found.data).min()
        };
        let centers = self.centers.0.par_iter().with_min_len(GRAIN);
        centers.map(nearest).collect::<Vec<_>>().into()
    }
}

/// Turns the axes of parts with `Axis`.
fn axes(
    context: Context<'_>,
    attributes: &PartAttributes,
    names: &Names,
    diagnostics: &mut Vec<Diagnostic>,
) -> Axes {
    let found: Vec<(PartId, Axis)> = par_keys(&context.matched.parts)
        .with_min_len(GRAIN)
        .filter_map(|part| Some((part, axis(context, attributes, names, part)?)))
        .collect();
    let mut turned = FxHashMap::default();
    let mut guessed = Vec::new();
    for (part, axis) in found {
        match axis {
            Axis::Turned(measure) => {
                turned.insert(part, measure);
            }
            Axis::Guessed(finding) => guessed.push((part, finding)),
        }
    }
    let (parts, findings): (Vec<PartId>, Vec<Diagnostic>) = guessed.into_iter().unzip();
    let described = || listed(parts.iter().map(|part| context.describe(names, *part)));
    few_or_one(
        findings,
        |count| {
            let names = described();
            format!(
                "{count} parts are as wide as they are long, so their axes are assumed to be upright: {names}"
            )
        },
        diagnostics,
    );
    Axes {
        turned,
        of_groups: FxHashMap::default(),
    }
}

/// The measures of an outline along an axis, degrees counter-clockwise from the drawing's right.
fn measure_turned(outline: &Outline, degrees: f64) -> Option<Measure> {
    let (sin, cos) = math::sin_cos(degrees.to_radians());
    let measure = measure_along(outline, DVec2::new(cos, -sin))?;
    Some(Measure {
        certain: true,
        ..measure
    })
}

/// A change to a part's axis, or a doubt about it.
enum Axis {
    /// `Axis` turns it.
    Turned(Measure),
    /// The solid depends on the axis, which the outline does not determine.
    Guessed(Diagnostic),
}

fn axis(
    context: Context<'_>,
    attributes: &PartAttributes,
    names: &Names,
    index: PartId,
) -> Option<Axis> {
    let Context {
        drawing,
        matched,
        nodes,
    } = context;
    let part = &matched.parts[index];
    let attributes = attributes.attributes(matched, index);
    let is_built = matches!(nodes.kind[index], PartKind::Main | PartKind::Sub);
    if !is_built || (part.host.is_some() && !attributes.have_own_form()) {
        return None;
    }
    if let Some(degrees) = attributes.axis() {
        return measure_turned(&part.outline, degrees).map(Axis::Turned);
    }
    let profile = || attributes.profile(drawing);
    let turns = !part.measure.certain && profile().is_some_and(|profile| profile.depends_on_axis());
    turns.then(|| {
        let name = context.describe(names, index);
        let shape = &drawing.shapes[part.shape].element;
        let string = matched.string_of(index);
        let place = string.map_or(shape.span, |string| string.text.whole());
        let message =
            format!("{name} is as wide as it is long, so its axis is assumed to be upright");
        Axis::Guessed(
            Diagnostic::new(Code::AxisGuess, place, message)
                .help("write `Axis 90` for an upright axis, `Axis 0` for a horizontal one"),
        )
    })
}

impl Context<'_> {
    /// A part for people.
    fn describe(self, names: &Names, part: PartId) -> String {
        describe(self.drawing, names.of(part), self.matched.parts[part].shape)
    }
}
