//! Says what becomes of a drawing whose strings never say `Shape`.

use crate::bind::bindings::{Bindings, PartKind};
use crate::bind::matching::Strokes;
use crate::diagnostic::{Code, Diagnostic};
use crate::svg::Drawing;

/// One hint about a drawing of which shapes are inflated or outlines are built because no string says `Shape`.
pub(in crate::bind) fn first_look(
    drawing: &Drawing,
    bindings: &Bindings,
    diagnostics: &mut Vec<Diagnostic>,
) {
    if !bindings.is_first_look {
        return;
    }
    let built = || {
        let parts = bindings.parts.iter();
        parts.filter(|part| matches!(part.kind, PartKind::Main | PartKind::Sub))
    };
    let (mut balloons, mut tubes, mut small, mut plates, mut outlines) = (0, 0, 0, 0, 0);
    for part in built() {
        let is_outline = part.is_stroke && !drawing.shapes[part.shape].outline.polygons.is_empty();
        match part.host {
            Some(_) if is_outline => outlines += 1,
            Some(_) => {}
            None if part.is_too_fine => small += 1,
            None if part.is_stroke => tubes += 1,
            None if part.is_balloon => balloons += 1,
            None => plates += 1,
        }
    }
    if !matches!(bindings.settings.strokes, Strokes::Visible | Strokes::All) {
        outlines = 0;
    }
    let Some(first) = built()
        .next()
        .filter(|_| balloons + tubes + small + outlines > 0)
    else {
        return;
    };
    let counted = |count: usize, one: &str, several: &str| match count {
        0 => None,
        1 => Some(one.to_owned()),
        _ => Some(format!("{count} {several}")),
    };
    let all = [
        counted(
            balloons,
            "one rounded shape is inflated",
            "rounded shapes are inflated",
        ),
        counted(tubes, "one line is a tube", "lines are tubes"),
        counted(
            small,
            "one small shape is a plate so that the model stays small",
            "small shapes are plates so that the model stays small",
        ),
        counted(
            plates,
            "one other shape is a plate",
            "other shapes are plates",
        ),
        counted(outlines, "one outline is built", "outlines are built"),
    ];
    let said: Vec<String> = all.into_iter().flatten().collect();
    let said = match said.as_slice() {
        [rest @ .., before, last] if !rest.is_empty() => {
            format!("{}, {before}, and {last}", rest.join(", "))
        }
        said => said.join(", and "),
    };
    let mut help =
        "to choose, write a text on the page: `%Shape default` makes plates of all shapes"
            .to_owned();
    if outlines > 0 {
        help += ", `%Strokes lines` leaves their outlines out";
    }
    help += "; or give one shape its own, as in `Head$Shape round`";
    let span = drawing.shapes[first.shape].element.span;
    diagnostics.push(
        Diagnostic::new(
            Code::FirstLook,
            span,
            format!("no string says `Shape`: {said}"),
        )
        .help(help),
    );
}
