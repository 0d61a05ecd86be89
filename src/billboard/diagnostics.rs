//! What is reported about characters.

use super::drawn::{DrawnView, MOST_REGIONS};
use super::matching::{Candidate, Matching, Place, Reason, Unmatched, Warning};
use crate::bind::Bindings;
use crate::diagnostic::{Code, Diagnostic, few_or_one, listed};
use crate::geometry::bounds;
use crate::source::Span;
use crate::svg::Drawing;

/// The string of a view's layer.
fn span(bindings: &Bindings, layer: usize) -> Span {
    bindings.strings[bindings.layers[layer].string].text.whole()
}

/// A character with a single view.
pub(super) fn alone(bindings: &Bindings, name: &str, only: &DrawnView) -> Diagnostic {
    let message =
        format!("`{name}` is drawn from one side only, so it cannot turn and is not built");
    Diagnostic::new(Code::UnusableView, span(bindings, only.layer), message).help(format!(
        "draw it from another side in a layer or group of its own, and write `{name}$View 45 0` there (the viewer's angles around and up)"
    ))
}

/// A view without a region.
pub(super) fn empty(drawing: &Drawing, bindings: &Bindings, layer: usize) -> Diagnostic {
    let group = drawing.describe_group(bindings.layers[layer].group);
    let message = format!("this view is left out: nothing is drawn in {group}");
    Diagnostic::new(Code::UnusableView, span(bindings, layer), message)
        .help("put the string into the layer or group that holds the character's shapes")
}

/// A view with more regions than can be matched.
pub(super) fn too_many(bindings: &Bindings, layer: usize, count: usize) -> Diagnostic {
    let message = format!(
        "this view is left out: it has {count} shapes, and at most {MOST_REGIONS} can be matched with those of another view"
    );
    Diagnostic::new(Code::UnusableView, span(bindings, layer), message)
        .help("draw the character with fewer shapes, or join those of one colour (in Inkscape, Path → Union)")
}

/// A view in the direction of another one.
pub(super) fn same_direction(bindings: &Bindings, layer: usize, first: usize) -> Diagnostic {
    let name = &bindings.layers[layer].name;
    let message = format!("this view of `{name}` is left out: another one has the same angles");
    Diagnostic::new(Code::UnusableView, span(bindings, layer), message)
        .related(span(bindings, first), "the other view")
        .help(format!(
            "write the angles from which it is drawn, for example `{name}$View 45 0`"
        ))
}

/// Reports what was not matched, and views that do not fit each other.
pub(super) fn report(
    drawing: &Drawing,
    bindings: &Bindings,
    name: &str,
    views: &[DrawnView],
    matching: &Matching,
    diagnostics: &mut Vec<Diagnostic>,
) {
    for warning in &matching.warnings {
        let (of, message, help) = match warning {
            Warning::SmallAngle { views, degrees } => (
                views,
                format!("two views of `{name}` are only {degrees:.0}° apart, so the depths of its regions are uncertain"),
                "draw them at least 15° apart, or set depths with `Depth`".to_owned(),
            ),
            Warning::BehindContainers { views, behind, of } => (
                views,
                format!("in `{name}`, {behind} of {of} details come to lie behind what they are drawn on, as if it turned the other way"),
                "change the sign of `View`'s first number: it is positive if the viewer walks to the character's left, so that its face moves to the left of the picture".to_owned(),
            ),
        };
        let place = span(bindings, views[of[1]].layer);
        let other = span(bindings, views[of[0]].layer);
        diagnostics.push(
            Diagnostic::new(Code::UnlikelyViews, place, message)
                .related(other, "the view that it was compared with")
                .help(help),
        );
    }
    let describe = |place: Place| describe(drawing, views, place);
    let finding = |unmatched: &Unmatched| {
        let Place { view, region } = unmatched.place;
        let what = describe(unmatched.place);
        let mut message = format!(
            "{what} has no partner in another view of `{name}`, and shrinks to nothing on the way there"
        );
        if let Some(candidate) = unmatched.candidates.first() {
            message.push_str(&format!("; {}", why_not(candidate, &describe)));
        }
        let shape = views[view].drawn[region].shape;
        Diagnostic::new(Code::NoPartner, drawing.shapes[shape].element.span, message).help(
            "if it is hidden there, draw it and mark it with `Hidden`; if it is another region, write the same name beside both",
        )
    };
    let findings: Vec<Diagnostic> = matching.unmatched.iter().map(finding).collect();
    let all = || {
        listed(
            matching
                .unmatched
                .iter()
                .map(|unmatched| describe(unmatched.place)),
        )
    };
    few_or_one(
        findings,
        |count| {
            format!(
                "{count} regions of `{name}` have no partner in another view, and shrink to nothing on the way there: {}",
                all()
            )
        },
        diagnostics,
    );
}

fn why_not(candidate: &Candidate, describe: &dyn Fn(Place) -> String) -> String {
    let other = describe(candidate.place);
    match candidate.reason {
        Reason::Color => format!("the colour of {other}, the nearest, differs"),
        Reason::Names => format!("{other}, the nearest, has another name"),
        Reason::Cost => format!("{other}, the nearest, is too far away or too different in size"),
        Reason::Taken(by) => format!("{other}, the nearest, belongs to {}", describe(by)),
    }
}

/// A region for people.
pub(super) fn describe(drawing: &Drawing, views: &[DrawnView], place: Place) -> String {
    let Place { view, region } = place;
    let (drawn, found) = (
        &views[view].drawn[region],
        &views[view].view.regions[region],
    );
    let shape = &drawing.shapes[drawn.shape];
    if let Some(name) = &found.name {
        return format!("`{name}`");
    }
    if shape.picture.is_none() {
        return drawing.describe(drawn.shape);
    }
    // Regions of a picture have no element of their own.
    let [r, g, b] = [0, 1, 2].map(|i| (found.color[i] * 255.0).round() as u8);
    let place = bounds(&found.outline).zip(views[view].view.bounds());
    let place = place.map(|((low, high), (least, greatest))| {
        let at = ((low + high) / 2.0 - least) / (greatest - least);
        let (x, y) = (at.x * 100.0, at.y * 100.0);
        format!(", {x:.0} % from the left and {y:.0} % from the top,")
    });
    let place = place.unwrap_or_default();
    format!(
        "the region in #{r:02x}{g:02x}{b:02x}{place} of {}",
        drawing.describe(drawn.shape)
    )
}
