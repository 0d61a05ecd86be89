//! Figures that play a motion without the limbs that it moves.

use std::collections::BTreeMap;

use super::Context;
use super::builder::MatchedFigure;
use super::figures::FigureGroup;
use super::moves::Roles;
use crate::anatomy;
use crate::bind::PartId;
use crate::clips::BuiltIn;
use crate::diagnostic::{Code, Diagnostic, listed};
use crate::labels::Class;
use crate::source::Span;

/// The most names that are listed of a class of parts.
const MAX_NAMES: usize = 3;

/// A figure without the limbs that its motion moves.
pub(super) struct Limbless {
    /// Its name.
    name: String,
    /// Whether the motion is a gait, which needs legs.
    is_gait: bool,
    /// What it has instead, for people to read.
    has: String,
    /// The clip that comes along for what it has.
    fitting: Option<BuiltIn>,
    /// The name of the shape that is all its limbs in one.
    merged: Option<String>,
}

/// A figure without limbs, or without legs for a gait: `which` is the clip if it comes along, `fitting` the one that fits the figure.
/// Parts with `Bone` may be anything.
pub(super) fn find(
    context: &Context<'_>,
    which: Option<BuiltIn>,
    matched: &MatchedFigure,
    fitting: BuiltIn,
) -> Option<Limbless> {
    if matched.moves.is_some() {
        return None;
    }
    let is_gait = which.is_some_and(BuiltIn::is_gait);
    let parts = &context.bindings.parts;
    let mut found: BTreeMap<Class, Vec<&str>> = BTreeMap::new();
    for (index, part) in matched.matching.parts.iter_enumerated() {
        if !matched.figure.parts[index].bones.is_empty() {
            return None;
        }
        if let Some(label) = &part.label {
            let name = parts[matched.group.parts[index]].name.as_str();
            found.entry(label.class).or_default().push(name);
        }
    }
    let mut names = matched.figure.parts.iter().map(|part| &part.name);
    let merged = names.find(|name| anatomy::is_several_limbs(name));
    let has = |class: Class| found.contains_key(&class);
    let has_limbs = has(Class::Arm) || has(Class::Leg);
    if has(Class::Leg) || has_limbs && !is_gait {
        return None;
    }
    let classes = found.iter().map(|(class, names)| {
        let count = match (names.len(), class) {
            (1, Class::Arm) => "an arm".to_owned(),
            (1, Class::Hips) => "hips".to_owned(),
            (1, class) => format!("a {}", class.name()),
            (count, Class::Body) => format!("{count} pieces of a body"),
            (count, class) => format!("{count} {}s", class.name()),
        };
        let more = if names.len() > MAX_NAMES { ", …" } else { "" };
        let names = names.iter().take(MAX_NAMES).map(|name| format!("`{name}`"));
        format!("{count} ({}{more})", names.collect::<Vec<_>>().join(", "))
    });
    let listed_classes: Vec<String> = classes.collect();
    Some(Limbless {
        name: name(context, matched.group.root),
        is_gait,
        fitting: Some(fitting).filter(|fitting| fitting.moves_parts()),
        has: listed(listed_classes.into_iter()),
        merged: merged.cloned(),
    })
}

fn name(context: &Context<'_>, root: PartId) -> String {
    context.bindings.parts[root].name.clone()
}

/// Reports the figures that play one motion without the limbs that it moves.
pub(super) fn report(
    figures: &[Limbless],
    link: &str,
    span: Span,
    diagnostics: &mut Vec<Diagnostic>,
) {
    let Some(first) = figures.first() else {
        return;
    };
    let what = if first.is_gait { "legs" } else { "limbs" };
    let whose = match figures {
        [_] => format!("the figure of `{}`", first.name),
        _ => {
            let names = figures.iter().map(|figure| format!("`{}`", figure.name));
            format!("the figures of {}", listed(names))
        }
    };
    let effect = match (first.is_gait, figures.len()) {
        (true, 1) => format!("it glides in `{link}`"),
        (true, _) => format!("they glide in `{link}`"),
        (false, _) => format!("`{link}` hardly moves anything"),
    };
    let has = match figures {
        [only] if !only.has.is_empty() => format!(": it has {}", only.has),
        _ => String::new(),
    };
    let message = format!("no {what} are found in {whose}, so {effect}{has}");
    let root = &first.name;
    let (left, right) = (format!("`Lleg@{root}`"), format!("`Rleg@{root}`"));
    let help = match figures {
        [
            Limbless {
                merged: Some(name), ..
            },
        ] => format!(
            "`{name}` is one shape, which moves as one piece: draw each of them as a shape of its own"
        ),
        [
            Limbless {
                fitting: Some(fitting),
                ..
            },
        ] => format!(
            "write `Motion {}`, which fits it; or, if it stands on legs, name them after what they are, such as {left} and {right}",
            fitting.name()
        ),
        [_] => format!(
            "name what it stands on after what it is, such as {left} and {right}, or say which joints drive a part: `Bone LeftUpLeg LeftFoot`"
        ),
        _ => format!(
            "if they are to stay, write `Motion` in the string of the figure that moves; else name what they stand on, such as {left} and {right}"
        ),
    };
    diagnostics.push(Diagnostic::new(Code::NoLimbs, span, message).help(help));
}

/// A figure that lacks what a clip moves.
pub(super) struct Misfit {
    name: String,
    which: BuiltIn,
    lacks: &'static str,
    has: String,
    fitting: BuiltIn,
}

impl Misfit {
    /// A figure without the parts that a clip moves.
    pub(super) fn find(
        context: &Context<'_>,
        group: &FigureGroup,
        which: BuiltIn,
        roles: &Roles,
    ) -> Option<Self> {
        Some(Self {
            name: name(context, group.root),
            which,
            lacks: roles.lacks(which)?,
            has: roles.found(),
            fitting: roles.fitting(),
        })
    }
}

/// Reports the figures that lack what one clip moves.
pub(super) fn report_misfits(figures: &[Misfit], span: Span, diagnostics: &mut Vec<Diagnostic>) {
    let Some(first) = figures.first() else {
        return;
    };
    let (which, fitting) = (first.which.name(), first.fitting.name());
    let (whose, effect) = match figures {
        [_] => (
            format!("the figure of `{}`", first.name),
            "it moves as one piece",
        ),
        _ => {
            let names = figures.iter().map(|figure| format!("`{}`", figure.name));
            let whose = format!("the figures of {}", listed(names));
            (whose, "they move as one piece each")
        }
    };
    let has = match figures {
        [only] if !only.has.is_empty() => format!(": it has {}", only.has),
        _ => String::new(),
    };
    let lacks = first.lacks;
    let message = format!("no {lacks} are found in {whose}, so {effect} in `{which}`{has}");
    let example = match first.which {
        BuiltIn::Drive => "FrontWheel",
        BuiltIn::Fly => "Lwing",
        BuiltIn::Swim => "Tail",
        _ => "Tentacle",
    };
    let root = &first.name;
    let help = match figures {
        [_] => format!(
            "write `Motion {fitting}`, which fits it, or name the parts after what they are, such as `{example}@{root}`"
        ),
        _ => "write `Motion` alone, which takes the clip that fits each figure".to_owned(),
    };
    diagnostics.push(Diagnostic::new(Code::NoLimbs, span, message).help(help));
}
