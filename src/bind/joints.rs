//! The joints of parts: where they turn (figure.md, Hierarchy and local frames).

use glam::DVec2;

use super::bindings::{Bindings, Part};
use crate::anatomy::{self, Term};
use crate::diagnostic::{Code, Diagnostic};
use crate::geometry::distance_squared;
use crate::lang::ast::Annotation;
use crate::lang::value::Origin;
use crate::svg::Drawing;

/// The least ratio of length to width for the hint that a part turns about its middle.
const LONG: f64 = 2.0;
/// Ends of a limb whose distances from the parent differ by no more than this share of its length are equally near.
const EQUALLY_NEAR: f64 = 0.02;

/// The joint of a main part (paper, section 3.5).
pub(super) fn origin(bindings: &Bindings, index: usize) -> DVec2 {
    let part = &bindings.parts[index];
    let center = |parent: usize| bindings.parts[parent].measure.center;
    let parent = part.parent.map(center);
    let [start, end] = sorted_ends(part, parent);
    match bindings.attributes(index).origin() {
        Some(Origin::Center) => part.measure.center,
        Some(Origin::Start) => start,
        Some(Origin::End) => end,
        Some(Origin::Point([x, y])) => DVec2::new(x, y),
        None => match part.parent {
            None => part.measure.center,
            Some(parent) if is_hinged(bindings, index) => {
                hinge(part, &bindings.parts[parent], [start, end])
            }
            Some(parent) => {
                let candidates = [start, end, part.measure.center];
                // `min_by` takes the first of equals: an end rather than the centre, unless the part is centred on its parent.
                let near = |p: &DVec2| p.distance_squared(center(parent));
                candidates
                    .into_iter()
                    .min_by(|a, b| near(a).total_cmp(&near(b)))
                    .unwrap_or(part.measure.center)
            }
        },
    }
}

/// Whether a part is by its name a limb, which never turns about its middle.
fn is_hinged(bindings: &Bindings, index: usize) -> bool {
    let part = &bindings.parts[index];
    let terms = anatomy::terms(&part.name);
    // 足 is a leg, or a foot if it is attached to a leg.
    let is_foot = terms.contains(&Term::LegOrFoot)
        && part.parent.is_some_and(|parent| {
            let above = anatomy::terms(&bindings.parts[parent].name);
            let says = |wanted| above.contains(&wanted);
            (says(Term::Leg) || says(Term::Shin)) && !says(Term::LegOrFoot)
        });
    anatomy::is_hinged(&terms) && !is_foot
}

/// The end at which a limb is attached: the one that lies on its parent or nearer to its outline. Of ends that are equally near it
/// is the upper one of what hangs, such as arms and legs, else the one nearer to the parent's centre, which is given first.
fn hinge(part: &Part, parent: &Part, [start, far]: [DVec2; 2]) -> DVec2 {
    let gap = |end: DVec2| distance_squared(&parent.outline, end).sqrt();
    let (near, other) = (gap(start), gap(far));
    let way = far - start;
    if (near - other).abs() > EQUALLY_NEAR * way.length() {
        return if near < other { start } else { far };
    }
    let upright = way.y.abs() > way.x.abs();
    if upright && way.y < 0.0 && anatomy::hangs(&anatomy::terms(&part.name)) {
        return far;
    }
    start
}

/// The ends of the axis: the one nearer to the parent's centre first; without a parent, the upper one first.
fn sorted_ends(part: &Part, parent: Option<DVec2>) -> [DVec2; 2] {
    let [a, b] = part.measure.ends;
    let swapped = match parent {
        Some(parent) => b.distance_squared(parent) < a.distance_squared(parent),
        None => b.y < a.y,
    };
    if swapped { [b, a] } else { [a, b] }
}

/// Reports a long part beside its parent that turns about its middle, which is seldom meant.
pub(super) fn turns_about_middle(
    drawing: &Drawing,
    bindings: &Bindings,
    index: usize,
    origin: DVec2,
) -> Option<Diagnostic> {
    let part = &bindings.parts[index];
    let long = part.measure.half_along > LONG * part.measure.half_across;
    let (parent, string) = (part.parent?, part.string?);
    let chosen = || bindings.attributes(index).origin().is_some();
    let beside = &bindings.parts[parent].measure;
    // A hat or a foot lies across the end of its parent, and is meant to turn about its middle.
    let alike = !beside.certain
        || beside.axis.dot(part.measure.axis).abs() > std::f64::consts::FRAC_1_SQRT_2;
    if !long || !alike || origin != part.measure.center || chosen() {
        return None;
    }
    let string = &bindings.strings[string];
    let text = &string.text;
    let has_attributes = match &string.annotation {
        Annotation::Part(annotation) => {
            !annotation.attributes.is_empty() || text.as_str().trim_end().ends_with(['$', '＄'])
        }
        _ => return None,
    };
    let end = text.as_str().trim_end().len();
    let place = text.span(end..end);
    let [start, far] = sorted_ends(part, Some(bindings.parts[parent].measure.center));
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
        part.name, bindings.parts[parent].name
    );
    let mut diagnostic = Diagnostic::new(Code::TurnsAboutMiddle, text.whole(), message)
    .related(drawing.shapes[part.shape].element.span, "the part")
    .help(format!(
        "for an arm or a leg write `Origin start` (the end nearer to the centre of `{}`, here the {side} one) or `Origin end`",
        bindings.parts[parent].name
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
