//! What is too fine to be round: outlines with too many corners for their `Shape`, and solids of too many triangles.

use glam::DVec2;

use super::bindings::{Bindings, Part, PartId};
use crate::budget::Work;
use crate::diagnostic::{Code, Diagnostic, listed};
use crate::solid::{self, LEAST_SEGMENTS, Placement, Profile};
use crate::source::Span;
use crate::svg::Drawing;

/// Shapes with so many corners are never too fine.
const FEW: u64 = 512;
/// Triangles of a plate for each of its points.
const OF_PLATES: u64 = 4;

/// Makes plates of the shapes that would cause the most work if all of them together would go over the budgets of the drawing, and says
/// so.
pub(super) fn limit(drawing: &Drawing, bindings: &mut Bindings, diagnostics: &mut Vec<Diagnostic>) {
    if bindings.is_first_look {
        let small = small(drawing, bindings);
        make_plates(bindings, &small);
    }
    let corners = |index| compared_corners(drawing, bindings, index);
    if let Some((parts, share)) = parts_over(drawing, bindings, Work::ComparedCorners, corners) {
        let kind = bindings.attributes(bindings.form(parts[0])).shape().kind;
        let have = if parts.len() == 1 {
            "it has"
        } else {
            "they have"
        };
        let most = (share * FEW).isqrt();
        let message = format!(
            "{}: {have} too many corners for `{kind}`, which takes {most} in this drawing",
            are_plates(bindings, &parts),
        );
        let help = "simplify the path (in Inkscape: Path → Simplify), or write `Shape inflate`, which has no such limit";
        let warning = Diagnostic::new(Code::TooFine, place(drawing, bindings, parts[0]), message);
        diagnostics.push(warning.help(help));
        make_plates(bindings, &parts);
    }
    let triangles = |index| least_triangles(drawing, bindings, index);
    if let Some((parts, _)) = parts_over(drawing, bindings, Work::LeastTriangles, triangles) {
        let most = drawing.budget.most(Work::LeastTriangles);
        let message = format!(
            "{}: if all were round, the drawing would have more than {most} triangles for them, even with `Segments {LEAST_SEGMENTS}`",
            are_plates(bindings, &parts),
        );
        let help = "draw fewer or simpler shapes (in Inkscape: Path → Simplify), or write `Shape default` for those that may be flat";
        let warning = Diagnostic::new(
            Code::TooMuchRound,
            place(drawing, bindings, parts[0]),
            message,
        );
        diagnostics.push(warning.help(help));
        make_plates(bindings, &parts);
    }
}

/// The smallest of the parts that are rounded although no string says so, if the drawing has too many triangles with all of them: in
/// such a drawing nobody sees that they are round, and all that lies on them would have to follow them.
fn small(drawing: &Drawing, bindings: &Bindings) -> Vec<PartId> {
    let most = drawing.budget.most(Work::UnaskedTriangles);
    let rounded =
        built(bindings).filter_map(|part| Some((part, least_triangles(drawing, bindings, part)?)));
    let mut rounded: Vec<(PartId, u64)> = rounded.collect();
    let width = |part: PartId| bindings.half_width(drawing, part);
    rounded.sort_by(|a, b| width(b.0).total_cmp(&width(a.0)));
    let points = bindings
        .parts
        .iter()
        .map(|part| part.outline.point_count() as u64);
    let mut used = OF_PLATES * points.sum::<u64>();
    let over = rounded.iter().find(|(_, triangles)| {
        used += triangles;
        used > most
    });
    let Some(widest) = over.map(|(part, _)| width(*part)) else {
        return Vec::new();
    };
    // Those that are as wide as one another are all alike.
    let parts = rounded.iter().map(|(part, _)| *part);
    parts.filter(|part| width(*part) <= widest).collect()
}

/// The parts that become solids.
fn built(bindings: &Bindings) -> impl Iterator<Item = PartId> + '_ {
    let parts = bindings.parts.iter_enumerated();
    let built = parts.filter(|(_, part)| part.kind.is_solid());
    built.map(|(index, _)| index)
}

/// The parts for which more of a kind of work is wanted than each of them may have at most, if there are any, and how much that is.
fn parts_over(
    drawing: &Drawing,
    bindings: &Bindings,
    work: Work,
    wanted: impl Fn(PartId) -> Option<u64>,
) -> Option<(Vec<PartId>, u64)> {
    let wanted = built(bindings).filter_map(|index| Some((index, wanted(index)?)));
    let wanted: Vec<(PartId, u64)> = wanted.collect();
    let amounts = wanted.iter().map(|(_, amount)| *amount);
    let share = drawing.budget.share(work, amounts.collect())?;
    let over = wanted.iter().filter(|(_, amount)| *amount > share);
    Some((over.map(|(part, _)| *part).collect(), share))
}

/// How a part becomes round; `None` if it does not.
fn soft(drawing: &Drawing, bindings: &Bindings, part: PartId) -> Option<Profile> {
    bindings
        .profile(drawing, part)
        .filter(|profile| profile.is_soft())
}

/// The pairs of corners that are compared to round an outline, but for what is inflated.
fn compared_corners(drawing: &Drawing, bindings: &Bindings, part: PartId) -> Option<u64> {
    let corners = bindings.parts[part].outline.point_count() as u64;
    let is_compared =
        || soft(drawing, bindings, part).is_some_and(|profile| profile.height_field().is_none());
    (corners > FEW && is_compared()).then_some(corners * corners / FEW)
}

/// The triangles that a solid has if it is as coarse as may be.
fn least_triangles(drawing: &Drawing, bindings: &Bindings, part: PartId) -> Option<u64> {
    let profile = soft(drawing, bindings, part)?;
    let Part {
        outline, measure, ..
    } = &bindings.parts[part];
    let half = DVec2::new(measure.half_across, measure.half_along);
    let options = solid::Options {
        segments: LEAST_SEGMENTS,
        crease: 0.0,
        placement: Placement::default(),
    };
    Some(profile.triangles(outline, half, &options))
}

/// Says which parts are plates.
fn are_plates(bindings: &Bindings, parts: &[PartId]) -> String {
    let names = parts.iter();
    let names = listed(names.map(|part| format!("`{}`", bindings.parts[*part].name)));
    match parts.len() {
        1 => format!("{names} is a plate"),
        count => format!("{count} shapes are plates, {names}"),
    }
}

/// Where it is said that a part is a plate: its string or its shape.
fn place(drawing: &Drawing, bindings: &Bindings, part: PartId) -> Span {
    let Part { string, shape, .. } = &bindings.parts[part];
    match string {
        Some(string) => bindings.strings[*string].text.whole(),
        None => drawing.shapes[*shape].element.span,
    }
}

fn make_plates(bindings: &mut Bindings, parts: &[PartId]) {
    for part in parts {
        bindings.parts[*part].is_too_fine = true;
    }
}
