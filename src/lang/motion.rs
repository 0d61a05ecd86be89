//! What the arguments of `Motion` are for.
//!
//! `Motion walk 2 wave 1 "kick.bvh" high +z from 1.2 to 2.4 speed .8`: clips that play in turn, each a word of the table or a file,
//! with what is said of it behind it, in any order, and one name for all of them.

use super::ast::{Argument, ArgumentKind};
use super::keyword::Keyword;
use super::keyword::signature::{Form, Takes};
use super::keyword::vocabulary::CLIPS;
use super::parameter::ParameterRef;
use crate::diagnostic::nearest_word;

/// What an argument is for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Role {
    /// A clip: a file, or the word for one that comes along.
    Source,
    /// The name of it all.
    Name,
    /// The axis that points up in a file.
    Up,
    /// How long the clip plays.
    Seconds,
    /// A word in front of a number.
    Word(Said),
    /// The number behind such a word.
    Number(Said),
}

/// What a word in front of a number says of a clip.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Said {
    /// Where it begins in its file.
    From,
    /// Where it ends.
    To,
    /// How fast it plays.
    Speed,
}

impl Said {
    pub(crate) const ALL: [Self; 3] = [Self::From, Self::To, Self::Speed];

    /// The word.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::From => "from",
            Self::To => "to",
            Self::Speed => "speed",
        }
    }

    fn of(argument: &Argument) -> Option<Self> {
        let ArgumentKind::Word(word) = &argument.kind else {
            return None;
        };
        let mut all = Self::ALL.into_iter();
        all.find(|said| said.name().eq_ignore_ascii_case(word))
    }
}

/// What a clip is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum ClipKind {
    /// The one that fits the figure: nothing is written.
    Fitting,
    /// One that comes along.
    Word,
    /// A file.
    File,
}

/// An argument of `Motion`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Slot {
    /// Which of the clips that play in turn it says something about, counted from 0.
    pub clip: usize,
    /// What that is.
    pub kind: ClipKind,
    /// What the argument is for.
    pub role: Role,
}

impl Slot {
    /// The parameter of the table. `is_named` says whether a file's clip has a name, which is a form of its own.
    fn parameter(&self, is_named: bool) -> Option<ParameterRef> {
        let forms = Keyword::Motion.row().forms;
        let form = forms.iter().find(|form| {
            let first = form.parameters.first().map(|parameter| &parameter.takes);
            match (self.kind, first) {
                (ClipKind::File, Some(Takes::File)) => is_named == takes_name(form),
                (ClipKind::Word, Some(Takes::Choice(_))) | (ClipKind::Fitting, None) => true,
                _ => false,
            }
        })?;
        let mut all = form.all();
        let index = match self.role {
            Role::Source => Some(0),
            Role::Name => all.position(|parameter| matches!(parameter.takes, Takes::Text)),
            Role::Up => all.position(|parameter| matches!(parameter.takes, Takes::SignedAxis)),
            Role::Seconds => all.position(|parameter| matches!(parameter.takes, Takes::Number(_))),
            Role::Word(said) | Role::Number(said) => {
                let word = all.position(|parameter| parameter.name == said.name());
                word.map(|word| word + usize::from(matches!(self.role, Role::Number(_))))
            }
        };
        Some(ParameterRef {
            owner: Keyword::Motion.name(),
            kind: None,
            form,
            index: index?,
        })
    }
}

fn takes_name(form: &Form) -> bool {
    let mut parameters = form.parameters.iter();
    parameters.any(|parameter| matches!(parameter.takes, Takes::Text))
}

/// What each argument of a `Motion` is for.
pub(crate) fn slots(arguments: &[Argument], is_variable: &dyn Fn(&str) -> bool) -> Vec<Slot> {
    let is_number = |argument: &Argument| match &argument.kind {
        ArgumentKind::Number(_) | ArgumentKind::Expression(_) => true,
        ArgumentKind::Word(word) => {
            is_variable(word) && !is_clip(word) && Said::of(argument).is_none()
        }
        _ => false,
    };
    let mut slots: Vec<Slot> = Vec::with_capacity(arguments.len());
    // Of the clip at which we are.
    let (mut clip, mut kind, mut has_seconds) = (0, ClipKind::Fitting, false);
    for (index, argument) in arguments.iter().enumerate() {
        let role = match slots.last().map(|slot| slot.role) {
            Some(Role::Word(said)) => Role::Number(said),
            _ if Said::of(argument).is_some() => Said::of(argument).map_or(Role::Name, Role::Word),
            _ if is_number(argument) => Role::Seconds,
            None => Role::Source,
            Some(_) => {
                let rest = &arguments[index + 1..];
                let is_timed = rest.first().is_some_and(is_number);
                match &argument.kind {
                    ArgumentKind::Word(word) if word.starts_with(['+', '-']) => Role::Up,
                    ArgumentKind::Word(text) | ArgumentKind::Quoted(text) if is_motion(text) => {
                        Role::Source
                    }
                    ArgumentKind::Word(word) if is_clip(word) => {
                        // A file's clip may be called `run`.
                        let is_name = index == 1
                            && kind == ClipKind::File
                            && !is_timed
                            && !rest.iter().any(is_source);
                        if is_name { Role::Name } else { Role::Source }
                    }
                    // What a number follows is a clip, if it is written like one, or cannot be a name.
                    ArgumentKind::Word(word)
                        if is_timed && (has_seconds || nearest_clip(word).is_some()) =>
                    {
                        Role::Source
                    }
                    ArgumentKind::Quoted(text) if is_timed && text.contains('.') => Role::Source,
                    _ => Role::Name,
                }
            }
        };
        match role {
            Role::Source => {
                clip += usize::from(index > 0);
                has_seconds = false;
                kind = match &argument.kind {
                    ArgumentKind::Quoted(_) => ClipKind::File,
                    ArgumentKind::Word(word) if word.contains('.') => ClipKind::File,
                    ArgumentKind::Word(_) => ClipKind::Word,
                    // It is reported as something that is no file.
                    _ => ClipKind::File,
                };
            }
            Role::Seconds => has_seconds = true,
            _ => {}
        }
        slots.push(Slot { clip, kind, role });
    }
    slots
}

/// The parameter that argument `index` is for. The argument need not exist yet: then what is most likely to follow. `None` where the table
/// has no parameter for it.
pub(super) fn parameter(
    arguments: &[Argument],
    index: usize,
    is_variable: &dyn Fn(&str) -> bool,
) -> Option<ParameterRef> {
    let slots = slots(arguments, is_variable);
    let slot = match slots.get(index) {
        Some(slot) => *slot,
        None => *next(&slots).first()?,
    };
    slot.parameter(is_named(&slots, slot))
}

/// The parameters that the argument behind these can be for, in the order of the table.
pub(crate) fn parameters_behind(
    arguments: &[Argument],
    is_variable: &dyn Fn(&str) -> bool,
) -> Vec<ParameterRef> {
    let slots = slots(arguments, is_variable);
    let next = next(&slots).into_iter();
    next.filter_map(|slot| slot.parameter(is_named(&slots, slot)))
        .collect()
}

fn is_named(slots: &[Slot], slot: Slot) -> bool {
    let mut own = slots.iter().filter(|own| own.clip == slot.clip);
    slot.role == Role::Name || own.any(|own| own.role == Role::Name)
}

/// What can follow the arguments of these slots, the likeliest first.
fn next(slots: &[Slot]) -> Vec<Slot> {
    let Some(&last) = slots.last() else {
        let first = |kind, role| Slot {
            clip: 0,
            kind,
            role,
        };
        return vec![
            first(ClipKind::File, Role::Source),
            first(ClipKind::Word, Role::Source),
            first(ClipKind::Fitting, Role::Seconds),
            first(ClipKind::Fitting, Role::Word(Said::Speed)),
        ];
    };
    let of_last = |role| Slot { role, ..last };
    if let Role::Word(said) = last.role {
        return vec![of_last(Role::Number(said))];
    }
    let has = |role: Role| {
        let mut own = slots.iter().filter(|slot| slot.clip == last.clip);
        own.any(|slot| slot.role == role)
    };
    let has_name = slots.iter().any(|slot| slot.role == Role::Name);
    let mut roles = Vec::new();
    match last.kind {
        ClipKind::File => roles.push(Role::Up),
        ClipKind::Word if !has_name => roles.push(Role::Name),
        _ => {}
    }
    roles.push(Role::Seconds);
    roles.extend(match last.kind {
        ClipKind::File => Said::ALL.map(Role::Word).to_vec(),
        _ => vec![Role::Word(Said::Speed)],
    });
    roles.retain(|role| !has(*role));
    let mut next: Vec<Slot> = roles.into_iter().map(of_last).collect();
    if last.kind != ClipKind::Fitting {
        next.extend([ClipKind::Word, ClipKind::File].map(|kind| Slot {
            clip: last.clip + 1,
            kind,
            role: Role::Source,
        }));
    }
    next
}

/// Whether the arguments of a `Motion` can end here.
pub(crate) fn is_complete(arguments: &[Argument]) -> bool {
    let slots = slots(arguments, &|_| false);
    !matches!(slots.last().map(|slot| slot.role), Some(Role::Word(_)))
}

/// Whether the word behind arguments of a `Motion`, which is also a keyword, is a clip: `walk` in `Motion wave 1 walk 2`. `is_timed` says
/// whether a number follows it.
pub(super) fn continues(before: &[Argument], word: &str, is_timed: bool) -> bool {
    // In capitals it is the keyword.
    let is_written_as_clip = CLIPS.iter().any(|clip| clip.name == word);
    let is_number = |argument: &Argument| matches!(argument.kind, ArgumentKind::Number(_));
    let begins_with_word = matches!(before.first().map(|first| &first.kind), Some(ArgumentKind::Word(first)) if is_clip(first));
    is_written_as_clip && (is_timed || begins_with_word || before.iter().any(is_number))
}

fn is_source(argument: &Argument) -> bool {
    match &argument.kind {
        ArgumentKind::Word(word) => is_clip(word) || is_motion(word),
        ArgumentKind::Quoted(text) => is_motion(text),
        _ => false,
    }
}

fn is_clip(word: &str) -> bool {
    CLIPS
        .iter()
        .any(|clip| clip.name.eq_ignore_ascii_case(word))
}

/// The clip that comes along whose word is written like this one.
pub(crate) fn nearest_clip(word: &str) -> Option<&'static str> {
    nearest_word(word, CLIPS.iter().map(|clip| clip.name))
}

/// Whether a text is the name of a motion file.
fn is_motion(text: &str) -> bool {
    let ending = text.rsplit_once('.').map(|(_, ending)| ending);
    ending.is_some_and(|ending| ending.eq_ignore_ascii_case("bvh"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lang::ast::Annotation;
    use crate::lang::{Container, parse};
    use crate::source::Text;

    /// Per argument the clip that it is about and a letter for what it is for.
    fn read(string: &str) -> String {
        let (annotation, _) = parse(&Text::plain(string, 0), Container::Text);
        let Annotation::Defaults(attributes) = annotation else {
            panic!("{string} has no attributes");
        };
        let slots = slots(&attributes[0].arguments, &|name| name == "t");
        let letter = |slot: &Slot| match slot.role {
            Role::Source => 'S',
            Role::Name => 'n',
            Role::Up => 'u',
            Role::Seconds => 's',
            Role::Word(_) => 'w',
            Role::Number(_) => '#',
        };
        let slots = slots
            .iter()
            .map(|slot| format!("{}{}", slot.clip, letter(slot)));
        slots.collect::<Vec<_>>().join(" ")
    }

    #[test]
    fn arguments_are_told_apart() {
        for (string, expected) in [
            ("%Motion", ""),
            ("%Motion walk", "0S"),
            ("%Motion walk stroll", "0S 0n"),
            ("%Motion walk 2 wave 1 idle 1", "0S 0s 1S 1s 2S 2s"),
            ("%Motion wave 1 walk 2", "0S 0s 1S 1s"),
            ("%Motion run walk", "0S 1S"),
            ("%Motion walk wave greeting", "0S 1S 1n"),
            ("%Motion walk \"wave\"", "0S 0n"),
            ("%Motion walk t speed 2 wave (1 + 1)", "0S 0s 0w 0# 1S 1s"),
            ("%Motion 2", "0s"),
            ("%Motion speed .5", "0w 0#"),
            (
                "%Motion \"kick.bvh\" kick from 1.2 to 2.4 speed .8",
                "0S 0n 0w 0# 0w 0# 0w 0#",
            ),
            ("%Motion \"a.bvh\" +z \"b.bvh\" -y both", "0S 0u 1S 1u 1n"),
            ("%Motion \"kick.bvh\" 1 walk 2", "0S 0s 1S 1s"),
            ("%Motion a.bvh run", "0S 0n"),
            ("%Motion a.bvh run 1", "0S 1S 1s"),
            ("%Motion a.bvh run idle", "0S 1S 2S"),
            ("%Motion a.bvh kick 2", "0S 0n 0s"),
            ("%Motion walk 2 wav 1", "0S 0s 1S 1s"),
            ("%Motion walk 2 twirl 1", "0S 0s 1S 1s"),
            ("%Motion walk 2 twirl", "0S 0s 0n"),
        ] {
            assert_eq!(read(string), expected, "{string}");
        }
        // The keyword, and a name without quotes.
        assert_eq!(read("%Motion run Walk 40"), "0S");
        assert_eq!(read("%Motion \"a.bvh\" walk"), "0S");
    }
}
