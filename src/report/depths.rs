//! How far in front of others parts lie, and why, for people.

use crate::compile::Compiled;
use crate::figure::{Behind, Reason};
use crate::ide::PartId;

/// Differences that are smaller are none, drawing units.
const NONE: f64 = 5e-3;

/// Why a main part lies at its depth; `None` for one that lies in the plane of what it hangs on, and for parts without a node.
pub(crate) fn depth_reason(compiled: &Compiled, part: PartId) -> Option<String> {
    let (parts, depths) = (&compiled.bindings.parts, &compiled.depths);
    let name = |part: PartId| &parts[parts[part].main].name;
    let own = depths[part]?;
    let from = |other: PartId| match depths[other] {
        Some(other) => own.depth - other.depth,
        None => 0.0,
    };
    let place = |other: PartId| {
        let (name, by) = (name(other), from(other));
        match by {
            _ if by.abs() < NONE => format!("as deep as {name}"),
            by if by > 0.0 => format!("in front of {name} by {}", short(by)),
            by => format!("behind {name} by {}", short(-by)),
        }
    };
    Some(match own.reason {
        Reason::Plane => return None,
        Reason::Given => "depth given".to_owned(),
        Reason::DrawnOver { part } => format!("{}: drawn over it", place(part)),
        Reason::DrawnUnder { part } => format!("{}: drawn before it", place(part)),
        Reason::With { part } => format!("lies on {}", name(part)),
        Reason::Backdrop { of } => format!("{}: covered by it", place(of)),
        Reason::Twin { of } => {
            let parent = parts[part].parent;
            let parent = parent.map(|parent| format!("{}: ", place(parent)));
            let parent = parent.unwrap_or_default();
            format!("{parent}twin of {}", name(of))
        }
    })
}

/// What a part shows from behind beside its own back; `None` for nothing.
pub(crate) fn back_reason(compiled: &Compiled, part: PartId) -> Option<String> {
    back(compiled, |of, _| of == part)
}

/// What the parts of a node show from behind other nodes; `None` for nothing.
pub(crate) fn node_back_reason(compiled: &Compiled, main: PartId) -> Option<String> {
    let main_of = |part: PartId| compiled.bindings.parts[part].main;
    back(compiled, |of, why| {
        let is_apart = match why {
            Behind::Closes { on } => main_of(on) != main,
            Behind::Mirrored | Behind::Round => of == main,
        };
        main_of(of) == main && is_apart
    })
}

fn back(compiled: &Compiled, is_meant: impl Fn(PartId, Behind) -> bool) -> Option<String> {
    let parts = &compiled.bindings.parts;
    let mut on: Vec<&str> = Vec::new();
    let (mut is_mirrored, mut is_round) = (false, false);
    for (_, why) in compiled
        .behind
        .iter()
        .filter(|(of, why)| is_meant(*of, *why))
    {
        match why {
            Behind::Mirrored => is_mirrored = true,
            Behind::Round => is_round = true,
            Behind::Closes { on: other } => {
                let other = &parts[*other];
                let name = Some(other.name.as_str()).filter(|name| !name.is_empty());
                let name = name.unwrap_or(&parts[other.main].name);
                if !on.contains(&name) {
                    on.push(name);
                }
            }
        }
    }
    let closes = (!on.is_empty()).then(|| format!("closes behind {}", on.join(", ")));
    let mirrored = is_mirrored.then(|| "on the back as well".to_owned());
    let round = is_round.then(|| "round about what wears it".to_owned());
    let reasons = closes.into_iter().chain(mirrored).chain(round);
    let reasons: Vec<String> = reasons.collect();
    (!reasons.is_empty()).then(|| reasons.join("; "))
}

/// A length with two digits after the point, without zeros at its end.
fn short(length: f64) -> String {
    let text = format!("{length:.2}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}
