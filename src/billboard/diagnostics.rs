//! What is reported about characters.

use typed_index_collections::TiSlice;

use super::drawn::{DrawnView, MOST_REGIONS};
use super::matching::{Candidate, Matching, Reason, RegionInView, Unmatched, Warning};
use crate::bind::{Bindings, DrawingString, LayerId, StringId};
use crate::diagnostic::{Code, Diagnostic, few_or_one, listed};
use crate::lang::ast::{Annotation, ArgumentKind};
use crate::lang::keyword::Keyword;
use crate::raster::Shades;
use crate::scene::ViewId;
use crate::source::Span;
use crate::svg::{Drawing, ShapeId};

/// The string of a view's layer.
fn span(bindings: &Bindings, layer: LayerId) -> Span {
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
pub(super) fn empty(drawing: &Drawing, bindings: &Bindings, layer: LayerId) -> Diagnostic {
    let group = drawing.describe_group(bindings.layers[layer].group);
    let message = format!("this view is left out: nothing is drawn in {group}");
    Diagnostic::new(Code::UnusableView, span(bindings, layer), message)
        .help("put the string into the layer or group that holds the character's shapes")
}

/// A view with more regions than can be matched.
pub(super) fn too_many(bindings: &Bindings, layer: LayerId, count: usize) -> Diagnostic {
    let message = format!(
        "this view is left out: it has {count} shapes, and at most {MOST_REGIONS} can be matched with those of another view"
    );
    Diagnostic::new(Code::UnusableView, span(bindings, layer), message)
        .help("draw the character with fewer shapes, or join those of one colour (in Inkscape, Path → Union)")
}

/// A picture with soft shades, which became so many regions; `None` for one without.
pub(super) fn shaded(
    drawing: &Drawing,
    picture: ShapeId,
    shades: Shades,
    regions: usize,
) -> Option<Diagnostic> {
    let what = drawing.describe(picture);
    let message = match shades {
        Shades::None => return None,
        Shades::Flattened => format!(
            "{what} has soft shades; each of its {regions} regions has one colour in the model"
        ),
        Shades::Steps => format!(
            "{what} has soft shades, and each step of them became a region: {regions} in all"
        ),
    };
    let span = drawing.shapes[picture].element.span;
    let finding = Diagnostic::new(Code::SoftShades, span, message);
    Some(finding.help("paint each area in one colour (in Krita or GIMP: Posterize), or trace the picture with few colours (in Inkscape: Path → Trace Bitmap) and write the names beside the shapes"))
}

/// The strings of a view's pictures for which no region is left.
pub(super) fn without_region(
    bindings: &Bindings,
    strings: &[StringId],
    diagnostics: &mut Vec<Diagnostic>,
) {
    let called = |string: &StringId| {
        let text = &bindings.strings[*string].text;
        format!("`{}`", text.as_str().trim())
    };
    let cause = "every region of the pictures in its view has a string already";
    let findings = strings.iter().map(|string| {
        let message = format!("there is no region left for {}: {cause}", called(string));
        Diagnostic::new(
            Code::NoPartLeft,
            bindings.strings[*string].text.whole(),
            message,
        )
        .help("delete the string, or put `#` before it to make it a comment")
    });
    let all = || listed(strings.iter().map(called));
    few_or_one(
        findings.collect(),
        |_| format!("there is no region left for {}: {cause}", all()),
        diagnostics,
    );
}

/// The attributes that have no effect in the string of a region in a picture.
pub(super) fn without_effect_in_picture(
    string: &DrawingString,
) -> impl Iterator<Item = Diagnostic> + '_ {
    let attributes = string.annotation.attributes().iter();
    let others = attributes
        .filter(|attribute| !matches!(attribute.keyword, Keyword::Depth | Keyword::Hidden));
    others.map(|attribute| {
        let name = attribute.keyword.name();
        let message = format!("`{name}` has no effect on a region of a picture");
        let span = string.text.span(attribute.range.clone());
        Diagnostic::new(Code::NoTileLayer, span, message)
            .help("delete it, and paint the picture as the region should look")
    })
}

/// A view in the direction of another one.
pub(super) fn same_direction(bindings: &Bindings, layer: LayerId, first: LayerId) -> Diagnostic {
    let name = &bindings.layers[layer].name;
    let message = format!("this view of `{name}` is left out: another one has the same angles");
    Diagnostic::new(Code::UnusableView, span(bindings, layer), message)
        .related(span(bindings, first), "the other view")
        .help(format!(
            "write the angles from which it is drawn, for example `{name}$View 45 0`"
        ))
}

/// `Mirror` where there is nothing to mirror.
pub(super) fn idle_mirror(
    bindings: &Bindings,
    layer: LayerId,
    name: &str,
    cause: &str,
) -> Diagnostic {
    let message = format!("`Mirror` has no effect on `{name}`: {cause}");
    Diagnostic::new(Code::UnlikelyViews, span(bindings, layer), message).help(format!(
        "draw it from the front (`{name}$View 0 0`) and from one side, or delete `Mirror`"
    ))
}

/// Reports what was not matched, and views that do not fit each other.
pub(super) fn report(
    drawing: &Drawing,
    bindings: &Bindings,
    name: &str,
    views: &TiSlice<ViewId, DrawnView>,
    matching: &Matching,
    diagnostics: &mut Vec<Diagnostic>,
) {
    for warning in &matching.warnings {
        let (Warning::SmallAngle { views: pair, .. }
        | Warning::BehindContainers { views: pair, .. }) = warning;
        let angle = angle_between(views, *pair);
        let (message, help) = match warning {
            Warning::SmallAngle { degrees, .. } => (
                format!("two views of `{name}` are only {degrees:.0}° apart, so the depths of its regions are uncertain"),
                "draw them at least 15° apart, or set depths with `Depth`".to_owned(),
            ),
            Warning::BehindContainers { behind, of, .. } => (
                format!("in `{name}`, {behind} of {of} details come to lie behind what they are drawn on, as if it turned the other way"),
                match angle {
                    Angle::Around => "change the sign of `View`'s first number: it is positive if the viewer walks to the character's left, so that its face moves to the left of the picture".to_owned(),
                    Angle::Up => "change the sign of `View`'s second number: it is positive if the viewer looks from above, so that the face moves down".to_owned(),
                },
            ),
        };
        let [other, own] = pair.map(|view| views[view].layer);
        let mut finding = Diagnostic::new(Code::UnlikelyViews, span(bindings, own), message)
            .related(span(bindings, other), "the view that it was compared with")
            .help(help);
        if matches!(warning, Warning::BehindContainers { .. }) {
            let fix = [own, other]
                .into_iter()
                .find_map(|layer| with_other_sign(bindings, layer, angle));
            if let Some((number, span, new)) = fix {
                finding = finding.fix(format!("Change `{number}` to `{new}`"), span, new);
            }
        }
        diagnostics.push(finding);
    }
    // That is said of the picture, once.
    if views.iter().any(|view| view.is_shaded) {
        return;
    }
    let describe = |region: RegionInView| describe(drawing, views, region);
    let finding = |unmatched: &Unmatched| {
        let RegionInView { view, id } = unmatched.region;
        let what = describe(unmatched.region);
        let mut message = format!(
            "{what} has no partner in another view of `{name}`, and shrinks to nothing within 15° of the view that shows it"
        );
        if let Some(candidate) = unmatched.candidates.first() {
            message.push_str(&format!("; {}", why_not(candidate, &describe)));
        }
        let shape = views[view].drawn[id].shape;
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
                .map(|unmatched| describe(unmatched.region)),
        )
    };
    few_or_one(
        findings,
        |count| {
            format!(
                "{count} regions of `{name}` have no partner in another view, and shrink to nothing within 15° of the views that show them: {}",
                all()
            )
        },
        diagnostics,
    );
}

/// One of the two angles of a view.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Angle {
    Around,
    Up,
}

/// The angle by which two views differ; if by both, the one around.
fn angle_between(views: &TiSlice<ViewId, DrawnView>, of: [ViewId; 2]) -> Angle {
    let [a, b] = of.map(|view| views[view].view.direction.theta);
    if a == b { Angle::Up } else { Angle::Around }
}

/// An angle as the string of a view gives it, the place where it does, and the angle with the other sign; `None` for an angle that
/// is 0 or no plain number.
fn with_other_sign(
    bindings: &Bindings,
    layer: LayerId,
    angle: Angle,
) -> Option<(String, Span, String)> {
    let string = &bindings.strings[bindings.layers[layer].string];
    let Annotation::Part(part) = &string.annotation else {
        return None;
    };
    let mut attributes = part.attributes.iter();
    let view = attributes.find(|attribute| attribute.keyword == Keyword::View)?;
    let argument = view.arguments.get(angle as usize)?;
    if !matches!(argument.kind, ArgumentKind::Number(number) if number != 0.0) {
        return None;
    }
    let number = &string.text.as_str()[argument.range.clone()];
    let new = match number.strip_prefix('-') {
        Some(positive) => positive.to_owned(),
        None => format!("-{number}"),
    };
    let span = string.text.span(argument.range.clone());
    Some((number.to_owned(), span, new))
}

fn why_not(candidate: &Candidate, describe: &dyn Fn(RegionInView) -> String) -> String {
    let other = describe(candidate.region);
    match candidate.reason {
        Reason::Color => format!("the colour of {other}, the nearest, differs"),
        Reason::Line => format!("of it and {other}, the nearest, only one is a line"),
        Reason::OtherRegion => format!("{other}, the nearest, is a line of another region"),
        Reason::Names => format!("{other}, the nearest, has another name"),
        Reason::Cost => format!("{other}, the nearest, is too far away or too different in size"),
        Reason::Taken(by) => format!("{other}, the nearest, belongs to {}", describe(by)),
    }
}

/// A region for people.
pub(super) fn describe(
    drawing: &Drawing,
    views: &TiSlice<ViewId, DrawnView>,
    region: RegionInView,
) -> String {
    let RegionInView { view, id } = region;
    let (drawn, found) = (&views[view].drawn[id], &views[view].view.regions[id]);
    let shape = &drawing.shapes[drawn.shape];
    if let Some(name) = &found.name {
        return format!("`{name}`");
    }
    if shape.picture.is_none() {
        return drawing.describe(drawn.shape);
    }
    // Regions of a picture have no element of their own.
    let looks = views[view].view.looks(id);
    format!(
        "the region in {looks}, of {}",
        drawing.describe(drawn.shape)
    )
}
