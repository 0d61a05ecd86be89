//! What looks different from the drawing, in words.

use super::{Instead, Look, PartLook};
use crate::bind::{PartId, PartKind};
use crate::compile::Compiled;
use crate::diagnostic::{Code, Diagnostic};

/// Parts with fewer pixels are not reported.
const LEAST_PIXELS: usize = 20;
/// Parts of which a larger share is right are not reported.
const MOSTLY: f64 = 0.9;
/// A hint for each part that the model shows less of than the drawing does, in the order of drawing.
pub fn hints(compiled: &Compiled, look: &Look) -> Vec<Diagnostic> {
    let parts = look.parts.iter();
    let parts = parts.filter(|part| part.pixels >= LEAST_PIXELS && part.share() < MOSTLY);
    parts
        .filter_map(|part| hint(compiled, part, part.instead?.0))
        .collect()
}

fn hint(compiled: &Compiled, look: &PartLook, instead: Instead) -> Option<Diagnostic> {
    let Compiled {
        bindings, drawing, ..
    } = compiled;
    let name = |part: PartId| bindings.describe_as_drawn(drawing, part);
    let who = name(look.part);
    let span = |part: PartId| drawing.shapes[bindings.parts[part].shape].element.span;
    let (why, help) = match instead {
        Instead::OtherColor => (
            "it has another colour there".to_owned(),
            "check its opacity, its mask and its gradient, and what lies behind it".to_owned(),
        ),
        Instead::Nothing => (
            "nothing is built there".to_owned(),
            "give it another `Shape`".to_owned(),
        ),
        Instead::Landscape(layer) => (
            format!(
                "the landscape `{}` is in front",
                compiled.layers.get(layer)?.name
            ),
            "move one of the two on the page".to_owned(),
        ),
        Instead::Part(other) if bindings.parts[other].kind == PartKind::Region => (
            format!("{} is seen there", name(other)),
            "draw what is in front last, or set its depth with `Depth`".to_owned(),
        ),
        Instead::Part(other) => {
            let seen = name(other);
            let why = if other < look.part {
                format!("it is inside or behind {seen}, which is drawn before it")
            } else {
                format!("{seen} covers more of it than is drawn")
            };
            let given = [look.part, other].into_iter();
            let given = given.filter(|part| bindings.given_depth(*part).is_some());
            let given: Vec<String> = given.map(name).collect();
            let help = match given.as_slice() {
                [] => format!(
                    "bring it to the front with `Offset`, or make {seen} flatter with `Shape`"
                ),
                given => format!(
                    "take away or change the depth that is given for {}",
                    given.join(" and ")
                ),
            };
            (why, help)
        }
    };
    let percent = (look.share() * 100.0).floor();
    let message = format!("{who} shows {percent} % of what is drawn of it: {why}");
    let hint = Diagnostic::new(Code::LooksDifferent, span(look.part), message).help(help);
    Some(match instead {
        Instead::Part(other) => hint.related(span(other), "this is seen there"),
        _ => hint,
    })
}
