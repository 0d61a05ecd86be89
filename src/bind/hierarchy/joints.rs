//! The joints of parts: where they turn.

use glam::DVec2;
use rayon::prelude::*;
use rustc_hash::FxHashMap;
use typed_index_collections::TiSlice;

use super::limbs::Limbs;
use super::names::Names;
use super::{Axes, Context};
use crate::anatomy::{self, Role, Term};
use crate::bind::attributes::PartAttributes;
use crate::bind::bindings::{NamedBy, PartId};
use crate::diagnostic::{Code, Diagnostic};
use crate::geometry::{Measure, distance_squared};
use crate::lang::ast::Annotation;
use crate::lang::value::Origin;
use crate::threads::GRAIN;

/// The least ratio of length to width for the hint that a part turns about its middle.
const LONG: f64 = 2.0;
/// Ends of a limb whose distances from the parent differ by no more than this share of its length are equally near.
const EQUALLY_NEAR: f64 = 0.02;

/// What joints depend on.
pub(super) struct Joints<'a> {
    pub(super) context: Context<'a>,
    pub(super) limbs: &'a Limbs<'a>,
    pub(super) attributes: &'a PartAttributes,
    pub(super) names: &'a Names,
    pub(super) parents: &'a TiSlice<PartId, Option<PartId>>,
    pub(super) axes: &'a Axes,
    /// The necks that hang on parts.
    pub(super) necks: &'a FxHashMap<PartId, PartId>,
    /// What holds lines, and where, by these.
    pub(super) holders: &'a FxHashMap<PartId, (PartId, DVec2)>,
    /// Whether parts without names hang on what they touch, so that all that is long is a limb.
    pub(super) is_nameless: bool,
}

impl Joints<'_> {
    fn measure(&self, part: PartId) -> &Measure {
        self.axes.measure(self.context.matched, part)
    }

    fn chosen(&self, part: PartId) -> Option<Origin> {
        self.attributes
            .attributes(self.context.matched, part)
            .origin()
    }

    /// The joint of a main part (paper, section 3.5).
    pub(super) fn origin(&self, index: PartId) -> DVec2 {
        let measure = self.measure(index);
        let center = |parent: PartId| self.measure(parent).center;
        let parent = self.parents[index];
        let [start, end] = measure.sorted_ends(parent.map(center));
        let held = self.holders.get(&index);
        let held = held.filter(|(holder, _)| parent == Some(*holder));
        match self.chosen(index) {
            Some(Origin::Center) => measure.center,
            Some(Origin::Start) => start,
            Some(Origin::End) => end,
            Some(Origin::Point([x, y])) => DVec2::new(x, y),
            None => match (parent, held) {
                (None, _) => measure.center,
                (_, Some((_, at))) => *at,
                (Some(parent), None) => self.of_child(index, parent, [start, end]),
            },
        }
    }

    /// The joint of a part that hangs on another one, by what it is called.
    fn of_child(&self, index: PartId, parent: PartId, [start, end]: [DVec2; 2]) -> DVec2 {
        let measure = self.measure(index);
        let terms = anatomy::terms(self.names.of(index));
        let is_automatic = self.names.of_part[index].by == NamedBy::Automatic;
        let may_be_limb = self.is_nameless && is_automatic && measure.certain;
        if may_be_limb || is_hinged_by(&terms, self.names, self.parents, index) {
            // On the axis, so that the limb points along it.
            let on_axis = |at: DVec2| (at - measure.center).dot(measure.axis);
            let met = self.limbs.joint([index, parent]).map(on_axis);
            let met = met.map(|along| measure.center + along * measure.axis);
            let end = met.unwrap_or_else(|| self.hinge(index, parent, [start, end]));
            return self.limbs.off_its_end([index, parent], end).unwrap_or(end);
        }
        if Role::of(&terms) == Some(Role::Head) {
            // A head turns about its neck, whatever sticks out of it: a chin, a beak, a tuft.
            let neck = self.necks.get(&parent).copied();
            let below = neck.filter(|neck| *neck != index).unwrap_or(parent);
            if let Some(at) = self.limbs.head_joint([index, below]) {
                return at;
            }
        }
        // A wheel rolls about its axle.
        if anatomy::is_disc(self.names.of(index)) {
            return measure.center;
        }
        let candidates = [start, end, measure.center];
        let beside = self.measure(parent).center;
        // `min_by` takes the first of equals: an end rather than the centre, unless the part is centred on its parent.
        let near = |p: &DVec2| p.distance_squared(beside);
        candidates
            .into_iter()
            .min_by(|a, b| near(a).total_cmp(&near(b)))
            .unwrap_or(measure.center)
    }

    /// The end at which a limb is attached: the one that lies on its parent or nearer to its outline. Of ends that are equally near it
    /// is the upper one of what hangs, such as arms and legs, else the one nearer to the parent's centre, which is given first.
    fn hinge(&self, part: PartId, parent: PartId, [start, far]: [DVec2; 2]) -> DVec2 {
        let outline = &self.context.matched.parts[parent].outline;
        let gap = |end: DVec2| distance_squared(outline, end).sqrt();
        let (near, other) = (gap(start), gap(far));
        let way = far - start;
        if (near - other).abs() > EQUALLY_NEAR * way.length() {
            return if near < other { start } else { far };
        }
        let upright = way.y.abs() > way.x.abs();
        if upright && way.y < 0.0 && anatomy::hangs(&anatomy::terms(self.names.of(part))) {
            return far;
        }
        start
    }

    /// Reports a long part beside its parent that turns about its middle, which is seldom meant.
    pub(super) fn turns_about_middle(&self, index: PartId, origin: DVec2) -> Option<Diagnostic> {
        let Self { context, names, .. } = self;
        let Context {
            drawing, matched, ..
        } = *context;
        let measure = self.measure(index);
        let long = measure.half_along > LONG * measure.half_across;
        let (parent, string) = (self.parents[index]?, matched.string_of(index)?);
        let chosen = || self.chosen(index).is_some();
        let beside = self.measure(parent);
        // A hat or a foot lies across the end of its parent, and is meant to turn about its middle.
        let alike = !beside.certain
            || beside.axis.dot(measure.axis).abs() > std::f64::consts::FRAC_1_SQRT_2;
        if !long || !alike || origin != measure.center || chosen() {
            return None;
        }
        let text = &string.text;
        let has_attributes = match &string.annotation {
            Annotation::Part(annotation) => {
                !annotation.attributes.is_empty() || text.as_str().trim_end().ends_with(['$', '＄'])
            }
            _ => return None,
        };
        let end = text.as_str().trim_end().len();
        let place = text.span(end..end);
        let [start, far] = measure.sorted_ends(Some(beside.center));
        let way = far - start;
        let side = match (way.y.abs() >= way.x.abs(), way.x >= 0.0, way.y >= 0.0) {
            (true, _, true) => "upper",
            (true, _, false) => "lower",
            (false, true, _) => "left",
            (false, false, _) => "right",
        };
        let lead = if has_attributes { " " } else { "$" };
        let message = format!(
            "both ends of `{}` are about equally far from `{}`, so it turns about its middle",
            names.of(index),
            names.of(parent)
        );
        let mut diagnostic = Diagnostic::new(Code::TurnsAboutMiddle, text.whole(), message)
    .related(drawing.shapes[matched.parts[index].shape].element.span, "the part")
    .help(format!(
        "for an arm or a leg write `Origin start` (the end nearer to the centre of `{}`, here the {side} one) or `Origin end`",
        names.of(parent)
    ));
        for word in ["start", "end"] {
            diagnostic = diagnostic.fix(
                format!("Turn about its {word}"),
                place,
                format!("{lead}Origin {word}"),
            );
        }
        Some(diagnostic)
    }
}

/// Whether a part is by its name a limb, which never turns about its middle.
pub(super) fn is_hinged(
    names: &Names,
    parents: &TiSlice<PartId, Option<PartId>>,
    part: PartId,
) -> bool {
    is_hinged_by(&anatomy::terms(names.of(part)), names, parents, part)
}

/// Likewise, given the terms of the part's name.
fn is_hinged_by(
    terms: &[Term],
    names: &Names,
    parents: &TiSlice<PartId, Option<PartId>>,
    part: PartId,
) -> bool {
    // 足 is a leg, or a foot if it is attached to a leg.
    let is_foot = terms.contains(&Term::LegOrFoot)
        && parents[part].is_some_and(|parent| {
            let above = anatomy::terms(names.of(parent));
            let says = |wanted| above.contains(&wanted);
            (says(Term::Leg) || says(Term::Shin)) && !says(Term::LegOrFoot)
        });
    anatomy::is_hinged(terms) && !is_foot
}

/// Per part with a neck that hangs on it by its name, the neck.
pub(super) fn necks(
    context: Context<'_>,
    names: &Names,
    parents: &TiSlice<PartId, Option<PartId>>,
) -> FxHashMap<PartId, PartId> {
    let mains: Vec<PartId> = context.mains().collect();
    let mains = mains.into_par_iter().with_min_len(GRAIN);
    let named = mains.filter(|part| names.of_part[*part].by != NamedBy::Automatic);
    let necks = named.filter_map(|part| {
        let parent = parents[part]?;
        let role = Role::of(&anatomy::terms(names.of(part)));
        (role == Some(Role::Neck)).then_some((parent, part))
    });
    // In order, so that of several necks the last one counts on every machine.
    let necks: Vec<(PartId, PartId)> = necks.collect();
    necks.into_iter().collect()
}
