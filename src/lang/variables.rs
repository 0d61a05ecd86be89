//! Variables: what the `Let` of all `%` strings define.

use std::collections::BTreeMap;

use super::ast::{Annotation, Argument, ArgumentKind, Expression, Name};
use super::evaluate::{Failure, Known, evaluate};
use super::keyword::Keyword;
use crate::diagnostic::{Code, Diagnostic, nearest_word};
use crate::source::{Span, Text};

/// The variables of a drawing.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Variables {
    variables: BTreeMap<String, Variable>,
}

/// A variable.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Variable {
    /// Its value; `None` if its definition has a fault.
    pub value: Option<f64>,
    /// Where the drawing names it first: its name behind `Let`.
    pub place: Span,
}

/// Names offered instead of an unknown one are looked for among so many variables at most.
const OFFERED: usize = 200;

/// A definition as it is written.
struct Definition<'a> {
    text: &'a Text,
    value: &'a Argument,
    /// The value as an expression; `None` if it is no number at all, which the checker tells.
    expression: Option<Expression>,
    place: Span,
    state: State,
}

/// How far the search for a definition's value has come.
#[derive(Debug, Clone, Copy, PartialEq)]
enum State {
    New,
    Open,
    Done(Option<f64>),
}

impl Variables {
    /// Reads the definitions of all `%` strings, given in document order with their texts.
    ///
    /// A definition may stand behind its use. Of two of one name the later holds.
    pub fn collect<'a>(
        defaults: impl IntoIterator<Item = (&'a Text, &'a Annotation)>,
        diagnostics: &mut Vec<Diagnostic>,
    ) -> Self {
        let mut definitions = BTreeMap::new();
        for (text, annotation) in defaults {
            define(text, annotation, &mut definitions, diagnostics);
        }
        let names: Vec<String> = definitions.keys().cloned().collect();
        for name in &names {
            settle(name, &mut definitions, diagnostics);
        }
        let variables = definitions
            .into_iter()
            .map(|(name, definition)| {
                let value = match definition.state {
                    State::Done(value) => value,
                    State::New | State::Open => None,
                };
                let place = definition.place;
                (name, Variable { value, place })
            })
            .collect();
        Self { variables }
    }

    /// The value of a variable.
    pub fn get(&self, name: &str) -> Option<f64> {
        self.variables.get(name)?.value
    }

    /// The number that an argument stands for, if it stands for one.
    pub fn value(&self, argument: &Argument) -> Option<f64> {
        evaluate(&expression(argument)?, &|name| self.known(name)).ok()
    }

    /// All variables in the order of their names.
    pub fn iter(&self) -> impl Iterator<Item = (&str, &Variable)> {
        self.variables
            .iter()
            .map(|(name, variable)| (name.as_str(), variable))
    }

    /// What is known about a variable.
    pub(super) fn known(&self, name: &str) -> Known {
        match self.variables.get(name) {
            None => Known::Unknown,
            Some(variable) => variable.value.map_or(Known::Broken, Known::Value),
        }
    }

    /// The variable that `name` is a slip of the pen for.
    pub(super) fn nearest(&self, name: &str) -> Option<&str> {
        nearest_word(
            name,
            self.variables.keys().take(OFFERED).map(String::as_str),
        )
    }
}

/// Adds the definitions of one string.
fn define<'a>(
    text: &'a Text,
    annotation: &'a Annotation,
    definitions: &mut BTreeMap<String, Definition<'a>>,
    diagnostics: &mut Vec<Diagnostic>,
) {
    let Annotation::Defaults(attributes) = annotation else {
        return;
    };
    for attribute in attributes {
        let [name, value, ..] = attribute.arguments.as_slice() else {
            continue;
        };
        let ArgumentKind::Word(word) = &name.kind else {
            continue;
        };
        if attribute.keyword != Keyword::Let {
            continue;
        }
        let place = text.span(name.range.clone());
        let definition = Definition {
            text,
            value,
            expression: expression(value),
            place,
            state: State::New,
        };
        if let Some(earlier) = definitions.insert(word.clone(), definition) {
            diagnostics.push(
                Diagnostic::new(
                    Code::Overridden,
                    place,
                    format!("`{word}` is defined again"),
                )
                .label("this definition holds")
                .related(earlier.place, "this one has no effect"),
            );
        }
    }
}

/// An argument where a number is due, as an expression.
pub(super) fn expression(argument: &Argument) -> Option<Expression> {
    match &argument.kind {
        ArgumentKind::Number(value) => Some(Expression::Number(*value)),
        ArgumentKind::Expression(expression) => Some(expression.clone()),
        ArgumentKind::Word(word) => Some(Expression::Variable(Name {
            text: word.clone(),
            range: argument.range.clone(),
        })),
        ArgumentKind::Quoted(_) | ArgumentKind::Hex(_) | ArgumentKind::Unreadable => None,
    }
}

/// Computes `name` and what it needs, without recursion: chains of definitions may be long.
fn settle(
    name: &str,
    definitions: &mut BTreeMap<String, Definition<'_>>,
    diagnostics: &mut Vec<Diagnostic>,
) {
    // Each entry with those of the names it needs that were not looked at yet.
    let mut path: Vec<(String, Vec<String>)> = vec![];
    if let Some(needed) = open(name, definitions) {
        path.push((name.to_owned(), needed));
    }
    while let Some((_, needed)) = path.last_mut() {
        let Some(next) = needed.pop() else {
            if let Some((done, _)) = path.pop() {
                finish(&done, definitions, diagnostics);
            }
            continue;
        };
        match definitions.get(&next).map(|definition| definition.state) {
            Some(State::New) => {
                if let Some(needed) = open(&next, definitions) {
                    path.push((next, needed));
                }
            }
            Some(State::Open) => {
                let from = path.iter().position(|(name, _)| *name == next).unwrap_or(0);
                let members: Vec<_> = path[from..].iter().map(|(name, _)| name.clone()).collect();
                report_cycle(&members, definitions, diagnostics);
                for (_, needed) in &mut path[from..] {
                    needed.clear();
                }
                for member in members {
                    close(&member, None, definitions);
                }
            }
            Some(State::Done(_)) | None => {}
        }
    }
}

/// Marks a definition as under way and gives the variables it needs.
fn open(name: &str, definitions: &mut BTreeMap<String, Definition<'_>>) -> Option<Vec<String>> {
    let definition = definitions.get_mut(name)?;
    if definition.state != State::New {
        return None;
    }
    definition.state = State::Open;
    let mut needed = vec![];
    if let Some(expression) = &definition.expression {
        expression.variables(&mut |name| needed.push(name.text.clone()));
    }
    needed.reverse();
    Some(needed)
}

fn close(name: &str, value: Option<f64>, definitions: &mut BTreeMap<String, Definition<'_>>) {
    if let Some(definition) = definitions.get_mut(name) {
        definition.state = State::Done(value);
    }
}

/// Computes a definition whose needs are settled.
fn finish(
    name: &str,
    definitions: &mut BTreeMap<String, Definition<'_>>,
    diagnostics: &mut Vec<Diagnostic>,
) {
    let Some(definition) = definitions.get(name) else {
        return;
    };
    if definition.state != State::Open {
        return;
    }
    let known = |name: &str| match definitions.get(name).map(|definition| definition.state) {
        None => Known::Unknown,
        Some(State::Done(Some(value))) => Known::Value(value),
        Some(_) => Known::Broken,
    };
    let value = match &definition.expression {
        None => None,
        Some(expression) => match evaluate(expression, &known) {
            Ok(value) => Some(value),
            Err(failure) => {
                let nearest = |name: &str| {
                    let names = definitions.keys().take(OFFERED).map(String::as_str);
                    nearest_word(name, names).map(str::to_owned)
                };
                let mut told: Vec<_> = tell(failure, definition.text, definition.value, &nearest)
                    .into_iter()
                    .collect();
                super::keep_safe_fixes(definition.text, &mut told);
                diagnostics.append(&mut told);
                None
            }
        },
    };
    close(name, value, definitions);
}

/// The diagnostic of an expression without a value.
pub(super) fn tell(
    failure: Failure,
    text: &Text,
    argument: &Argument,
    nearest: &dyn Fn(&str) -> Option<String>,
) -> Option<Diagnostic> {
    match failure {
        Failure::Broken => None,
        Failure::NoNumber(why) => Some(Diagnostic::new(
            Code::OutOfRange,
            text.span(argument.range.clone()),
            format!("this calculation {why}"),
        )),
        Failure::Unknown(name) => {
            let span = text.span(name.range.clone());
            let diagnostic = Diagnostic::new(
                Code::UnknownVariable,
                span,
                format!("no variable is called `{}`", name.text),
            );
            Some(match nearest(&name.text) {
                Some(near) => diagnostic.label(format!("did you mean `{near}`?")).fix(
                    format!("Write `{near}`"),
                    span,
                    text.escape_at(name.range.start, &near),
                ),
                None => diagnostic.label("a number is due here").help(format!(
                    "write a number, or define the variable in a `%` string: `%Let {} 10`",
                    name.text
                )),
            })
        }
    }
}

fn report_cycle(
    members: &[String],
    definitions: &BTreeMap<String, Definition<'_>>,
    diagnostics: &mut Vec<Diagnostic>,
) {
    const SHOWN: usize = 8;
    let Some((first, others)) = members.split_first() else {
        return;
    };
    let Some(definition) = definitions.get(first) else {
        return;
    };
    let mut chain: Vec<&str> = members.iter().take(SHOWN).map(String::as_str).collect();
    if members.len() > SHOWN {
        chain.push("…");
    }
    chain.push(first);
    let mut diagnostic = Diagnostic::new(
        Code::VariableCycle,
        definition.place,
        format!("the value of `{first}` depends on itself"),
    )
    .label(chain.join(" → "))
    .help("give one of them a number");
    for other in others.iter().take(SHOWN) {
        if let Some(definition) = definitions.get(other) {
            diagnostic = diagnostic.related(definition.place, format!("through `{other}`"));
        }
    }
    diagnostics.push(diagnostic);
}
