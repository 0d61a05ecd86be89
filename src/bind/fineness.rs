//! Outlines with too many corners for their `Shape`: what is rounded or pointed, but for what is inflated, takes work that grows faster
//! than the number of corners.

use super::bindings::{Bindings, Part, PartId, PartKind};
use crate::budget::Work;
use crate::diagnostic::{Code, Diagnostic, listed};
use crate::svg::Drawing;

/// Shapes with so many corners are never too fine.
const FEW: u64 = 512;

/// Makes plates of the shapes with the most corners if all of them together would go over the budget of the drawing, and says so.
pub(super) fn limit(drawing: &Drawing, bindings: &mut Bindings, diagnostics: &mut Vec<Diagnostic>) {
    let parts = bindings.parts.iter_enumerated();
    let built = parts.filter(|(_, part)| matches!(part.kind, PartKind::Main | PartKind::Sub));
    let counted = built.map(|(index, part)| (index, part.outline.point_count() as u64));
    let fine = counted.filter(|(part, corners)| {
        let profile = || bindings.profile(drawing, *part);
        *corners > FEW
            && profile()
                .is_some_and(|profile| profile.is_soft() && profile.height_field().is_none())
    });
    let fine: Vec<(PartId, u64)> = fine.collect();
    let work = |corners: u64| corners * corners / FEW;
    let wanted = fine.iter().map(|(_, corners)| work(*corners)).collect();
    let Some(share) = drawing.budget.share(Work::ComparedCorners, wanted) else {
        return;
    };
    let too_fine = fine.iter().filter(|(_, corners)| work(*corners) > share);
    let too_fine: Vec<PartId> = too_fine.map(|(part, _)| *part).collect();
    let Some(first) = too_fine.first().copied() else {
        return;
    };
    let names = too_fine.iter();
    let names = listed(names.map(|part| format!("`{}`", bindings.parts[*part].name)));
    let are_plates = match too_fine.len() {
        1 => format!("{names} is a plate: it has"),
        count => format!("{count} shapes are plates, {names}: they have"),
    };
    let kind = bindings.attributes(bindings.form(first)).shape().kind;
    let most = (share * FEW).isqrt();
    let message =
        format!("{are_plates} too many corners for `{kind}`, which takes {most} in this drawing");
    let Part { string, shape, .. } = &bindings.parts[first];
    let span = match string {
        Some(string) => bindings.strings[*string].text.whole(),
        None => drawing.shapes[*shape].element.span,
    };
    let help = "simplify the path (in Inkscape: Path → Simplify), or write `Shape inflate`, which has no such limit";
    diagnostics.push(Diagnostic::new(Code::TooFine, span, message).help(help));
    for part in too_fine {
        bindings.parts[part].is_too_fine = true;
    }
}
