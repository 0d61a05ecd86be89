//! Checks the arguments of `Motion`, and puts them together clip by clip.

use super::Checker;
use super::arguments::{ArgumentError, ArgumentValue, Callee};
use super::build::{has_flag, signed_axis};
use crate::diagnostic::{Code, Diagnostic, Edit, Fix};
use crate::lang::ast::{Argument, ArgumentKind, Attribute};
use crate::lang::evaluate::Lookup;
use crate::lang::keyword::Keyword;
use crate::lang::motion::{ClipKind, Role, Said, Slot, nearest_clip, slots};
use crate::lang::parameter_at;
use crate::lang::value::{Motion, MotionSource, MotionTurn};

/// A clip that plays in turn, with the arguments that say it.
#[derive(Default)]
struct Turn {
    kind: Option<ClipKind>,
    source: Option<usize>,
    up: Option<usize>,
    seconds: Option<usize>,
    from: Option<usize>,
    to: Option<usize>,
    speed: Option<usize>,
}

impl Turn {
    fn place(&mut self, role: Role) -> Option<&mut Option<usize>> {
        Some(match role {
            Role::Source => &mut self.source,
            Role::Up => &mut self.up,
            Role::Seconds => &mut self.seconds,
            Role::Number(Said::From) => &mut self.from,
            Role::Number(Said::To) => &mut self.to,
            Role::Number(Said::Speed) => &mut self.speed,
            Role::Word(_) | Role::Name => return None,
        })
    }
}

impl Checker<'_> {
    /// The value of a `Motion`, and its arguments. `None` if there is an error, which has been reported.
    pub(super) fn motion(
        &mut self,
        callee: Callee<'_>,
        attribute: &Attribute,
    ) -> Option<(Motion, Vec<ArgumentValue>)> {
        let variables = self.variables;
        let is_variable = |name: &str| variables.lookup(name) != Lookup::Undefined;
        let slots = slots(&attribute.arguments, &is_variable);
        let mut values = Vec::with_capacity(slots.len());
        let mut turns = vec![Turn::default()];
        let mut name = None;
        let mut is_valid = true;
        let arguments = attribute.arguments.as_slice();
        for (index, (argument, slot)) in arguments.iter().zip(&slots).enumerate() {
            if index > 0 && self.is_misspelled_keyword(arguments, index, *slot) {
                self.unknown_keywords(&arguments[index..]);
                break;
            }
            let Some(of_table) = parameter_at(attribute, index, &is_variable) else {
                self.does_not_fit(attribute, argument, *slot);
                is_valid = false;
                values.push(ArgumentValue::Number(0.0));
                continue;
            };
            match self.argument(callee, of_table.parameter(), argument) {
                Ok(value) => values.push(value),
                Err(ArgumentError::Invalid) => {
                    is_valid = false;
                    values.push(ArgumentValue::Number(0.0));
                }
                Err(ArgumentError::MisspelledKeyword) => {
                    self.unknown_keywords(&arguments[index..]);
                    break;
                }
            }
            if turns.len() <= slot.clip {
                turns.push(Turn::default());
            }
            let turn = &mut turns[slot.clip];
            turn.kind = Some(slot.kind);
            let place = match slot.role {
                Role::Name => Some(&mut name),
                role => turn.place(role),
            };
            if let Some(place) = place
                && let Some(first) = place.replace(index)
            {
                self.said_twice(slot.role, &arguments[first], argument);
                is_valid = false;
            }
        }
        if let (Some(Role::Word(said)), true) = (
            slots
                .get(values.len().wrapping_sub(1))
                .map(|slot| slot.role),
            values.len() == arguments.len(),
        ) {
            self.number_is_missing(said, attribute);
            is_valid = false;
        }
        if !is_valid {
            return None;
        }
        let read = turns.iter().map(|turn| self.turn(turn, arguments, &values));
        let read: Option<Vec<MotionTurn>> = read.collect();
        let clip = name.and_then(|name| match values.get(name) {
            Some(ArgumentValue::Text(name)) => Some(name.clone()),
            _ => None,
        });
        let motion = Motion {
            turns: read?,
            clip,
            is_in_place: has_flag(attribute, 'i'),
            is_loop: has_flag(attribute, 'l'),
        };
        Some((motion, values))
    }

    /// Whether a name in front of a number was meant to be a keyword: `Limted 4 30`.
    fn is_misspelled_keyword(&self, arguments: &[Argument], index: usize, slot: Slot) -> bool {
        let ArgumentKind::Word(word) = &arguments[index].kind else {
            return false;
        };
        let next = arguments.get(index + 1).map(|next| &next.kind);
        let is_timed = matches!(
            next,
            Some(ArgumentKind::Number(_) | ArgumentKind::Expression(_))
        );
        matches!(slot.role, Role::Name | Role::Source)
            && nearest_clip(word).is_none()
            && is_timed
            && word.starts_with(char::is_uppercase)
            && Keyword::nearest(word).is_some()
    }

    /// One of the motions that play in turn.
    fn turn(
        &mut self,
        turn: &Turn,
        arguments: &[Argument],
        values: &[ArgumentValue],
    ) -> Option<MotionTurn> {
        let number = |place: Option<usize>| match values.get(place?) {
            Some(ArgumentValue::Number(number)) => Some(*number),
            _ => None,
        };
        let source = match turn.source.and_then(|source| values.get(source)) {
            None => MotionSource::Fitting,
            Some(ArgumentValue::Text(file)) => MotionSource::File(file.clone()),
            Some(ArgumentValue::Word(word)) => MotionSource::BuiltIn(word.clone()),
            Some(_) => return None,
        };
        let up = turn.up.and_then(|up| match values.get(up) {
            Some(ArgumentValue::Word(axis)) => signed_axis(axis),
            _ => None,
        });
        let (from, to) = (number(turn.from), number(turn.to));
        if let (Some(start), Some(end)) = (from, to)
            && start >= end
            && let (Some(first), Some(second)) = (turn.from, turn.to)
        {
            self.ends_before_it_begins([start, end], [&arguments[first], &arguments[second]]);
            return None;
        }
        if let (Some(seconds), Some(to)) = (turn.seconds, turn.to) {
            self.ends_twice(&arguments[seconds], &arguments[to]);
            return None;
        }
        Some(MotionTurn {
            source,
            argument: turn.source,
            up,
            seconds: number(turn.seconds),
            from,
            to,
            speed: number(turn.speed).unwrap_or(1.0),
        })
    }

    /// Something that is said of files only.
    fn does_not_fit(&mut self, attribute: &Attribute, argument: &Argument, slot: Slot) {
        // The number behind `from` has its report already.
        if let Role::Number(Said::From | Said::To) = slot.role {
            return;
        }
        let written = &self.text.as_str()[argument.range.clone()];
        let source = slots(&attribute.arguments, &|_| false);
        let source = source
            .iter()
            .zip(&attribute.arguments)
            .find(|(own, _)| own.clip == slot.clip && own.role == Role::Source);
        let whose = match source.map(|(_, argument)| &argument.kind) {
            Some(ArgumentKind::Word(word)) => format!("`{word}`, a clip that comes along"),
            _ => "`Motion` without a file".to_owned(),
        };
        let (what, help) = match slot.role {
            Role::Up => (
                "which axis of a file points up",
                "leave it out: clips that come along are upright",
            ),
            _ => (
                "which part of a file plays",
                "leave it out, or say for how many seconds it plays: `Motion walk 2`",
            ),
        };
        let message = format!("`{written}` says {what}, and does not fit {whose}");
        let diagnostic = self.diagnostic(Code::ArgumentType, &argument.range, message);
        self.diagnostics.push(diagnostic.help(help));
    }

    fn said_twice(&mut self, role: Role, first: &Argument, second: &Argument) {
        let written = |argument: &Argument| &self.text.as_str()[argument.range.clone()];
        let (first, again) = (written(first), written(second));
        let (message, help) = match role {
            Role::Name => (
                format!("`{again}` is a second name, behind `{first}`: `Motion` makes one clip"),
                "leave one of them out, or write a second `Motion`; the words for clips are listed by `okoshi explain Motion`".to_owned(),
            ),
            Role::Seconds => (
                format!("`{again}` is a second number of seconds, behind `{first}`"),
                "leave one of them out, or name the clip that plays for so long: `Motion walk 2 wave 1`".to_owned(),
            ),
            Role::Up => (
                format!("`{again}` is a second axis that points up, behind `{first}`"),
                "leave one of them out".to_owned(),
            ),
            Role::Number(said) | Role::Word(said) => (
                format!("`{} {again}` is said twice of one clip", said.name()),
                "leave one of them out".to_owned(),
            ),
            Role::Source => return,
        };
        let diagnostic = self.diagnostic(Code::ArgumentCount, &second.range, message);
        self.diagnostics.push(diagnostic.help(help));
    }

    fn number_is_missing(&mut self, said: Said, attribute: &Attribute) {
        let Some(last) = attribute.arguments.last() else {
            return;
        };
        let (word, example) = match said {
            Said::From => ("from", "`from 1.2`, in seconds of the file"),
            Said::To => ("to", "`to 2.4`, in seconds of the file"),
            Said::Speed => ("speed", "`speed 2`, which is twice as fast"),
        };
        let message = format!("`{word}` needs a number behind it");
        let diagnostic = self.diagnostic(Code::ArgumentCount, &last.range, message);
        self.diagnostics
            .push(diagnostic.help(format!("write {example}; a clip of this name needs quotes")));
    }

    fn ends_before_it_begins(&mut self, [from, to]: [f64; 2], [first, second]: [&Argument; 2]) {
        let range = first.range.start..second.range.end;
        let range = range.start.min(second.range.start)..range.end.max(first.range.end);
        let message = format!("nothing is left of a motion from {from} to {to} seconds");
        let mut diagnostic = Diagnostic::new(Code::OutOfRange, self.text.span(range), message)
            .label("expected the beginning to be before the end");
        if from > to {
            let written = |argument: &Argument| &self.text.as_str()[argument.range.clone()];
            let edit = |from: &Argument, to: &Argument| Edit {
                span: self.text.span(to.range.clone()),
                text: self.text.escape_at(to.range.start, written(from)),
            };
            diagnostic.fixes.push(Fix {
                title: "Swap the two".to_owned(),
                edits: vec![edit(second, first), edit(first, second)],
                safe: false,
            });
        }
        self.diagnostics.push(diagnostic);
    }

    fn ends_twice(&mut self, seconds: &Argument, to: &Argument) {
        let written = |argument: &Argument| &self.text.as_str()[argument.range.clone()];
        let message = format!(
            "the `{}` seconds and `to {}` both say where the motion ends",
            written(seconds),
            written(to)
        );
        let later = if seconds.range.start > to.range.start {
            seconds
        } else {
            to
        };
        let diagnostic = self.diagnostic(Code::ArgumentCount, &later.range, message);
        self.diagnostics.push(diagnostic.help(
            "leave one of them out: the number says for how long it plays, `to` where in the file it ends",
        ));
    }
}
