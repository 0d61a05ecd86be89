//! Variables, defined by the `Let` of all `%` strings.

use std::collections::BTreeMap;

use super::ast::{Annotation, Argument, ArgumentKind, Expression, Name};
use super::did_you_mean;
use super::evaluate::{EvaluationError, Lookup, evaluate};
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
    /// Its value; `None` if its definition has an error.
    pub value: Option<f64>,
    /// The name after `Let`.
    pub definition: Span,
}

/// How many variables are searched for one to suggest in place of an unknown name.
const MAX_CANDIDATES: usize = 200;

/// A definition in a `%` string.
struct Definition<'a> {
    text: &'a Text,
    value: &'a Argument,
    /// The value as an expression; `None` if it is not a number, which the checker reports.
    expression: Option<Expression>,
    span: Span,
    state: State,
}

/// The state of a definition in the depth-first search that evaluates all definitions.
#[derive(Debug, Clone, Copy, PartialEq)]
enum State {
    Unvisited,
    InProgress,
    Done(Option<f64>),
}

impl Variables {
    /// Reads the definitions of all `%` strings, given in document order with their texts.
    ///
    /// A variable may be used before its definition. Of two definitions of one name the later one counts.
    pub fn collect<'a>(
        defaults: impl IntoIterator<Item = (&'a Text, &'a Annotation)>,
        diagnostics: &mut Vec<Diagnostic>,
    ) -> Self {
        let mut definitions = BTreeMap::new();
        for (text, annotation) in defaults {
            collect_string(text, annotation, &mut definitions, diagnostics);
        }
        let names: Vec<String> = definitions.keys().cloned().collect();
        for name in &names {
            resolve(name, &mut definitions, diagnostics);
        }
        let variables = definitions
            .into_iter()
            .map(|(name, definition)| {
                let value = match definition.state {
                    State::Done(value) => value,
                    State::Unvisited | State::InProgress => None,
                };
                let definition = definition.span;
                (name, Variable { value, definition })
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
        evaluate(&as_expression(argument)?, &|name| self.lookup(name)).ok()
    }

    /// All variables, sorted by name.
    pub fn iter(&self) -> impl Iterator<Item = (&str, &Variable)> {
        self.variables
            .iter()
            .map(|(name, variable)| (name.as_str(), variable))
    }

    /// Looks up a variable.
    pub(super) fn lookup(&self, name: &str) -> Lookup {
        match self.variables.get(name) {
            None => Lookup::Undefined,
            Some(variable) => variable.value.map_or(Lookup::Invalid, Lookup::Value),
        }
    }

    /// The variable that `name` is probably a misspelling of.
    pub(super) fn nearest(&self, name: &str) -> Option<&str> {
        let names = self.variables.keys().take(MAX_CANDIDATES);
        nearest_word(name, names.map(String::as_str))
    }
}

/// Adds the definitions of one string.
fn collect_string<'a>(
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
        let span = text.span(name.range.clone());
        let definition = Definition {
            text,
            value,
            expression: as_expression(value),
            span,
            state: State::Unvisited,
        };
        if let Some(earlier) = definitions.insert(word.clone(), definition) {
            diagnostics.push(
                Diagnostic::new(Code::Overridden, span, format!("`{word}` is defined again"))
                    .label("this definition counts")
                    .related(earlier.span, "this one is ignored")
                    .help("delete one of them, or give one another name"),
            );
        }
    }
}

/// The value of a variable for which an argument has another value, if they are in proportion: 6 for `w` if `(w * 1.5)` shall be 9.
/// Variables that are calculated from it do not count.
pub(crate) fn solved(
    argument: &Argument,
    variable: &str,
    value: f64,
    variables: &Variables,
) -> Option<f64> {
    let expression = as_expression(argument)?;
    let with = |number: f64| {
        let lookup = |name: &str| match name == variable {
            true => Lookup::Value(number),
            false => variables.lookup(name),
        };
        evaluate(&expression, &lookup).ok()
    };
    let (zero, slope) = (with(0.0)?, with(1.0)? - with(0.0)?);
    let found = (value - zero) / slope;
    let is_close = (with(found)? - value).abs() <= 1e-9 * (1.0 + value.abs());
    (found.is_finite() && is_close).then_some(found)
}

/// The expression that an argument for a number stands for.
pub(super) fn as_expression(argument: &Argument) -> Option<Expression> {
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

/// Evaluates `name` and the variables it depends on. An explicit stack replaces recursion, because chains of
/// definitions can be long.
fn resolve(
    name: &str,
    definitions: &mut BTreeMap<String, Definition<'_>>,
    diagnostics: &mut Vec<Diagnostic>,
) {
    // The names being evaluated, each with the dependencies that were not visited yet.
    let mut path: Vec<(String, Vec<String>)> = vec![];
    if let Some(needed) = begin(name, definitions) {
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
            Some(State::Unvisited) => {
                if let Some(needed) = begin(&next, definitions) {
                    path.push((next, needed));
                }
            }
            Some(State::InProgress) => {
                let from = path.iter().position(|(name, _)| *name == next).unwrap_or(0);
                let members: Vec<_> = path[from..].iter().map(|(name, _)| name.clone()).collect();
                report_cycle(&members, definitions, diagnostics);
                for (_, needed) in &mut path[from..] {
                    needed.clear();
                }
                for member in members {
                    set_value(&member, None, definitions);
                }
            }
            Some(State::Done(_)) | None => {}
        }
    }
}

/// Marks a definition as in progress and returns the variables it depends on, last one first.
fn begin(name: &str, definitions: &mut BTreeMap<String, Definition<'_>>) -> Option<Vec<String>> {
    let definition = definitions.get_mut(name)?;
    if definition.state != State::Unvisited {
        return None;
    }
    definition.state = State::InProgress;
    let mut needed = vec![];
    if let Some(expression) = &definition.expression {
        expression.variables(&mut |name| needed.push(name.text.clone()));
    }
    needed.reverse();
    Some(needed)
}

fn set_value(name: &str, value: Option<f64>, definitions: &mut BTreeMap<String, Definition<'_>>) {
    if let Some(definition) = definitions.get_mut(name) {
        definition.state = State::Done(value);
    }
}

/// Evaluates a definition whose dependencies have been evaluated.
fn finish(
    name: &str,
    definitions: &mut BTreeMap<String, Definition<'_>>,
    diagnostics: &mut Vec<Diagnostic>,
) {
    let Some(definition) = definitions.get(name) else {
        return;
    };
    if definition.state != State::InProgress {
        return;
    }
    let lookup = |name: &str| match definitions.get(name).map(|definition| definition.state) {
        None => Lookup::Undefined,
        Some(State::Done(Some(value))) => Lookup::Value(value),
        Some(_) => Lookup::Invalid,
    };
    let value = match &definition.expression {
        None => None,
        Some(expression) => match evaluate(expression, &lookup) {
            Ok(value) => Some(value),
            Err(error) => {
                let nearest = |name: &str| {
                    let names = definitions.keys().take(MAX_CANDIDATES).map(String::as_str);
                    nearest_word(name, names).map(str::to_owned)
                };
                let mut reported: Vec<_> =
                    evaluation_diagnostic(error, definition.text, definition.value, &nearest)
                        .into_iter()
                        .collect();
                super::keep_safe_fixes(definition.text, &mut reported);
                diagnostics.append(&mut reported);
                None
            }
        },
    };
    set_value(name, value, definitions);
}

/// The diagnostic for an expression without a value; `None` if the error is reported elsewhere.
pub(super) fn evaluation_diagnostic(
    error: EvaluationError,
    text: &Text,
    argument: &Argument,
    nearest: &dyn Fn(&str) -> Option<String>,
) -> Option<Diagnostic> {
    match error {
        EvaluationError::InvalidVariable => None,
        EvaluationError::NotANumber(why) => {
            let span = text.span(argument.range.clone());
            let message = format!("this calculation {why}");
            Some(
                Diagnostic::new(Code::OutOfRange, span, message)
                    .help("change the calculation, or a variable in it, so that it has a result"),
            )
        }
        EvaluationError::UndefinedVariable(name) => {
            let span = text.span(name.range.clone());
            let message = format!("there is no variable called `{}`", name.text);
            let diagnostic = Diagnostic::new(Code::UnknownVariable, span, message);
            Some(match nearest(&name.text) {
                Some(near) => did_you_mean(diagnostic, text, &name.range, &near),
                None => diagnostic.label("expected a number").help(format!(
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
    const MAX_SHOWN: usize = 8;
    let Some((first, others)) = members.split_first() else {
        return;
    };
    let Some(definition) = definitions.get(first) else {
        return;
    };
    let mut chain: Vec<&str> = members.iter().take(MAX_SHOWN).map(String::as_str).collect();
    if members.len() > MAX_SHOWN {
        chain.push("…");
    }
    chain.push(first);
    let message = format!("the value of `{first}` depends on itself");
    let mut diagnostic = Diagnostic::new(Code::VariableCycle, definition.span, message)
        .label(chain.join(" → "))
        .help("give one of these variables a plain number");
    for other in others.iter().take(MAX_SHOWN) {
        if let Some(definition) = definitions.get(other) {
            diagnostic = diagnostic.related(definition.span, format!("through `{other}`"));
        }
    }
    diagnostics.push(diagnostic);
}
