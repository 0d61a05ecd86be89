//! Strings without a part, and why there is none for them.

use std::cmp::Reverse;

use typed_index_collections::{TiVec, ti_vec};

use crate::bind::bindings::{DrawingString, StringHolder};
use crate::bind::matching::{Matched, wants_part};
use crate::diagnostic::{Code, Diagnostic, few_or_one, listed};
use crate::lang::ast::Annotation;
use crate::svg::{Drawing, GroupId, Hidden, ShapeId};

/// Reports the strings that want a part and have none. Strings that miss one for the same reason are reported together if
/// it is a property of the whole drawing.
pub(super) fn report(drawing: &Drawing, matched: &Matched, diagnostics: &mut Vec<Diagnostic>) {
    let mut waiting = Vec::new();
    for string in &matched.strings {
        let unbound = wants_part(&string.annotation) && string.binding.is_none();
        if !unbound || string.is_of_picture || matched.layers.leave_picture_out(drawing, string) {
            continue;
        }
        match string.holder {
            StringHolder::Label(_) => waiting.push(string),
            StringHolder::Shape(shape) => diagnostics.push(of_shape(drawing, string, shape)),
            StringHolder::Group(group) => diagnostics.push(of_group(drawing, string, group)),
        }
    }
    let Some(first) = waiting.first() else {
        return;
    };
    if matched.parts.is_empty() {
        let (cause, help) = without_parts(drawing);
        let names = listed(waiting.iter().map(|string| called(string)));
        let message = format!("there is no shape for {names}: {cause}");
        let nothing = Diagnostic::new(Code::NoPartLeft, first.text.whole(), message);
        diagnostics.push(nothing.help(help));
        return;
    }
    let all_taken = AllTaken::of(drawing, matched);
    let mut left_over = Vec::new();
    for string in &waiting {
        let (cause, help) = if string.scope.is_some() {
            (
                "every shape in its group has a string already".to_owned(),
                HELP.to_owned(),
            )
        } else {
            all_taken.cause_and_help()
        };
        let help = match string.annotation {
            Annotation::Legend(_) => LEGEND_HELP.to_owned(),
            _ => help,
        };
        let message = format!("there is no part left for {}: {cause}", called(string));
        let finding = Diagnostic::new(Code::NoPartLeft, string.text.whole(), message);
        left_over.push(finding.help(help));
    }
    let names = || listed(waiting.iter().map(|string| called(string)));
    few_or_one(
        left_over,
        |_| {
            let (cause, _) = all_taken.cause_and_help();
            format!("there is no part left for {}: {cause}", names())
        },
        diagnostics,
    );
}

const HELP: &str = "delete the string, draw its shape, or put `#` before it to make it a comment";

const LEGEND_HELP: &str = "draw a small shape in the legend's colour beside it; if the attributes are for a part, write its name before `$`";

/// A string for people: the name that it gives, or its kind.
fn called(string: &DrawingString) -> String {
    match &string.annotation {
        Annotation::Part(part) => match &part.name {
            Some(name) => format!("`{}`", name.text),
            None => "this string".to_owned(),
        },
        Annotation::Legend(_) => "this legend".to_owned(),
        _ => "this string".to_owned(),
    }
}

/// A description of a shape that is no part.
fn of_shape(drawing: &Drawing, string: &DrawingString, shape: ShapeId) -> Diagnostic {
    let name = drawing.describe(shape);
    let message = format!("{name} has this description, but no area, so it is no part");
    Diagnostic::new(Code::NoPartLeft, string.text.whole(), message)
        .related(drawing.shapes[shape].element.span, "the shape")
        .help("give it a fill, or delete the description")
}

/// A description of a group without a part.
fn of_group(drawing: &Drawing, string: &DrawingString, group: GroupId) -> Diagnostic {
    let name = drawing.describe_group(group);
    let (why, help) = match drawing.groups[group].kind {
        crate::svg::GroupKind::Group => (
            "but no filled shape of its own, so it is no part",
            "give its shapes a fill, or delete the description",
        ),
        _ => (
            "but it is no part: its shapes are parts of their own",
            "write the description for a shape or a group in it, or delete it",
        ),
    };
    let message = format!("{name} has this description, {why}");
    Diagnostic::new(Code::NoPartLeft, string.text.whole(), message)
        .related(drawing.groups[group].element.span, "the group")
        .help(help)
}

/// Why a drawing has no part at all, and what to do.
fn without_parts(drawing: &Drawing) -> (String, String) {
    let hidden = drawing.unseen.hidden.iter();
    let hidden: Vec<&Hidden> = hidden.filter(|hidden| hidden.shapes > 0).collect();
    let lines = drawing.shapes.len();
    if !hidden.is_empty() {
        let shapes: usize = hidden.iter().map(|hidden| hidden.shapes).sum();
        let places = listed(hidden.iter().map(|hidden| hidden.describe()));
        let all = match (shapes, lines) {
            (1, 0) => "the only shape is in".to_owned(),
            (_, 0) => format!("all {shapes} shapes are in"),
            _ => "all filled shapes are in".to_owned(),
        };
        return (
            format!("{all} {places}"),
            "show what is hidden (in Inkscape, the eye in Layer → Layers and Objects)".to_owned(),
        );
    }
    if lines > 0 {
        let all = match lines {
            1 => "the only shape is a line without a fill".to_owned(),
            _ => format!("all {lines} shapes are lines without a fill"),
        };
        return (
            format!("{all}, and only filled shapes become solid"),
            "give them a fill (in Inkscape, Object → Fill and Stroke), or write `%Strokes lines` to build the lines"
                .to_owned(),
        );
    }
    let pictures = "draw a filled shape, and put the string on it";
    ("the drawing has no shapes".to_owned(), pictures.to_owned())
}

/// What there is besides the parts that have strings.
struct AllTaken {
    /// The group with the most shapes that are sub-parts, and their number.
    group: Option<(String, usize)>,
    /// The number of hidden shapes, and where they are.
    hidden: Option<(usize, String)>,
    /// The number of lines without a fill that are no parts.
    lines: usize,
}

impl AllTaken {
    fn of(drawing: &Drawing, matched: &Matched) -> Self {
        let mut subs: TiVec<GroupId, usize> = ti_vec![0; drawing.groups.len()];
        let mut is_part: TiVec<ShapeId, bool> = ti_vec![false; drawing.shapes.len()];
        for (index, part) in matched.parts.iter_enumerated() {
            is_part[part.shape] = true;
            if part.attributes_from().is_none() && part.main != index {
                let main = &matched.parts[part.main];
                subs[drawing.common_group(part.shape, main.shape)] += 1;
            }
        }
        let groups = subs.keys().filter(|group| *group != GroupId::ROOT);
        let group = groups.max_by_key(|group| (subs[*group], Reverse(*group)));
        let group = group.filter(|group| subs[*group] > 0);
        let hidden = drawing.unseen.hidden.iter();
        let hidden: Vec<&Hidden> = hidden.filter(|hidden| hidden.shapes > 0).collect();
        let count = hidden.iter().map(|hidden| hidden.shapes).sum();
        let places = listed(hidden.iter().map(|hidden| hidden.describe()));
        Self {
            group: group.map(|group| (drawing.describe_group(group), subs[group])),
            hidden: (count > 0).then_some((count, places)),
            lines: is_part.iter().filter(|is_part| !**is_part).count(),
        }
    }

    fn cause_and_help(&self) -> (String, String) {
        if let Some((group, subs)) = &self.group {
            let more = counted(*subs, "more shape");
            return (
                format!(
                    "every shape outside groups has a string already; {group} holds {more}, but counts as one part"
                ),
                "ungroup it (in Inkscape, Object → Ungroup), or move the string into the group with its shape"
                    .to_owned(),
            );
        }
        let cause = "every shape of the drawing has a string already";
        match (&self.hidden, self.lines) {
            (Some((count, places)), _) => (
                format!("{cause}; {} hidden, in {places}", is_or_are(*count, "more shape")),
                "show what is hidden (in Inkscape, the eye in Layer → Layers and Objects), or delete the string"
                    .to_owned(),
            ),
            (None, 0) => (cause.to_owned(), HELP.to_owned()),
            (None, lines) => (
                format!("every filled shape of the drawing has a string already; {} without a fill", is_or_are(lines, "more")),
                "give its shape a fill, write `%Strokes lines` to build lines, or put `#` before the string to make it a comment"
                    .to_owned(),
            ),
        }
    }
}

fn counted(count: usize, what: &str) -> String {
    match count {
        1 => format!("1 {what}"),
        _ => format!("{count} {what}s"),
    }
}

fn is_or_are(count: usize, what: &str) -> String {
    match (count, what) {
        (1, _) => format!("1 {what} is"),
        (_, "more") => format!("{count} more are"),
        _ => format!("{count} {what}s are"),
    }
}

impl Drawing {
    /// The innermost group that holds two shapes.
    fn common_group(&self, one: ShapeId, other: ShapeId) -> GroupId {
        let chain = |shape: ShapeId| {
            let first = Some(self.shapes[shape].group);
            std::iter::successors(first, |group| {
                (*group != GroupId::ROOT).then(|| self.groups[*group].parent)
            })
        };
        let around: Vec<GroupId> = chain(other).collect();
        chain(one)
            .find(|group| around.contains(group))
            .unwrap_or(GroupId::ROOT)
    }
}
