//! Matches arguments against the parameters of the table.

use super::Checker;
use crate::diagnostic::{Code, Diagnostic, has_one_near_word, nearest_word};
use crate::lang::ast::{Argument, ArgumentKind, Name};
use crate::lang::did_you_mean;
use crate::lang::evaluate::{EvaluationError, Lookup, evaluate};
use crate::lang::keyword::colors::{self, COLORS};
use crate::lang::keyword::kinds::Kind;
use crate::lang::keyword::signature::{Bounds, Form, Parameter, Takes};
use crate::lang::keyword::{Keyword, vocabulary};
use crate::lang::parse::suggestions;
use crate::lang::variables::{as_expression, evaluation_diagnostic};

/// The largest number that an attribute can have, in whatever unit: products of a few of them still fit into the `f32` that
/// models are written in.
const MAX_NUMBER: f64 = 1e12;

/// The value of an argument that matches its parameter.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum ArgumentValue {
    /// A number.
    Number(f64),
    /// A word in its canonical spelling, an axis, or a variable's name.
    Word(String),
    /// A colour, and how it is written.
    Color([u8; 4], String),
    /// A file name, or text.
    Text(String),
    /// One of several names.
    Name(String),
}

/// Why an argument does not match its parameter.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum ArgumentError {
    /// The argument is wrong, which has been reported if necessary.
    Invalid,
    /// The argument is a misspelled keyword: the attribute ends before it.
    MisspelledKeyword,
}

/// The keyword or kind whose arguments are matched, for messages.
#[derive(Debug, Clone, Copy)]
pub(super) struct Callee<'a> {
    /// The keyword or the kind of `Shape`.
    pub(super) name: &'a str,
    /// The kind, if it is one.
    pub(super) kind: Option<&'static Kind>,
    /// The range of the name.
    pub(super) range: &'a std::ops::Range<usize>,
    pub(super) parameters: usize,
    /// The attribute's keyword.
    pub(super) keyword: Keyword,
}

impl Callee<'_> {
    /// The printed form, for messages.
    fn usage(&self) -> String {
        match self.kind {
            Some(kind) => format!("Shape {}", kind.usage()),
            None => self.keyword.usages().join("`, or `"),
        }
    }
}

impl Checker<'_> {
    /// Matches `arguments` against `form`. `None` if there is an error, which has been reported.
    pub(super) fn match_arguments(
        &mut self,
        callee: Callee<'_>,
        form: &Form,
        arguments: &[Argument],
    ) -> Option<Vec<ArgumentValue>> {
        let mut values = vec![];
        let mut valid = true;
        for (index, argument) in arguments.iter().enumerate() {
            let parameter = match form.parameter_index(index) {
                Some(index) => &form.parameters[index],
                None => {
                    let ends = self.too_many(callee, &arguments[index..]);
                    let enough = form.accepts(values.len());
                    return (valid && ends && enough).then_some(values);
                }
            };
            match self.argument(callee, parameter, argument) {
                Ok(value) => values.push(value),
                Err(ArgumentError::Invalid) => {
                    if matches!(parameter.takes, Takes::Names) {
                        // In `Follow Rarm Colr 1 0 0` the number shows that the name before it was meant to be a keyword.
                        if let [.., name, _] = &arguments[..=index]
                            && let ArgumentKind::Word(word) = &name.kind
                            && suggestions::is_misspelled_keyword(word, true)
                        {
                            values.pop();
                            self.unknown_keyword(name, word);
                            return (!values.is_empty()).then_some(values);
                        }
                        self.wrong_type(callee, parameter, argument);
                        return None;
                    }
                    valid = false;
                    values.push(ArgumentValue::Number(0.));
                }
                Err(ArgumentError::MisspelledKeyword) => {
                    self.unknown_keywords(&arguments[index..]);
                    return (valid && form.accepts(values.len())).then_some(values);
                }
            }
        }
        if !form.accepts(values.len()) {
            self.too_few(callee, form, arguments);
            return None;
        }
        valid.then_some(values)
    }

    pub(super) fn argument(
        &mut self,
        callee: Callee<'_>,
        parameter: &Parameter,
        argument: &Argument,
    ) -> Result<ArgumentValue, ArgumentError> {
        let found = match (&parameter.takes, &argument.kind) {
            (Takes::Number(bounds), kind) => {
                if !matches!(kind, ArgumentKind::Quoted(_) | ArgumentKind::Hex(_)) {
                    return self.number(callee, parameter, *bounds, argument);
                }
                None
            }
            (Takes::Choice(choices), ArgumentKind::Word(word)) => {
                return self.word(callee, argument, word, choices.iter().map(|own| own.name));
            }
            (Takes::SignedAxis, ArgumentKind::Word(word)) => {
                let names = vocabulary::AXES.iter().map(|axis| axis.name);
                return self.word(callee, argument, word, names);
            }
            (Takes::ColorName, ArgumentKind::Word(word)) => match colors::color(word) {
                Some(color) => Some(ArgumentValue::Color(color, word.to_ascii_lowercase())),
                None => return self.word(callee, argument, word, COLORS.iter().copied()),
            },
            (Takes::Hex, ArgumentKind::Hex(digits)) => match hex(digits) {
                Some(color) => {
                    let written = format!("#{}", digits.to_ascii_lowercase());
                    Some(ArgumentValue::Color(color, written))
                }
                None => {
                    self.bad_hex(argument, digits);
                    return Err(ArgumentError::Invalid);
                }
            },
            (Takes::File | Takes::Text, ArgumentKind::Quoted(text) | ArgumentKind::Word(text))
                if !text.trim().is_empty() =>
            {
                Some(ArgumentValue::Text(text.clone()))
            }
            (Takes::Names, ArgumentKind::Quoted(text) | ArgumentKind::Word(text))
                if !text.trim().is_empty() =>
            {
                Some(ArgumentValue::Name(text.clone()))
            }
            (Takes::Variable, ArgumentKind::Word(word)) => Some(ArgumentValue::Word(word.clone())),
            _ => None,
        };
        found.ok_or_else(|| {
            // The caller reports a bad name in a list, because it knows the name before it.
            if !matches!(parameter.takes, Takes::Names) {
                self.wrong_type(callee, parameter, argument);
            }
            ArgumentError::Invalid
        })
    }

    fn number(
        &mut self,
        callee: Callee<'_>,
        parameter: &Parameter,
        bounds: Bounds,
        argument: &Argument,
    ) -> Result<ArgumentValue, ArgumentError> {
        let Some(expression) = as_expression(argument) else {
            return Err(ArgumentError::Invalid);
        };
        let value = match evaluate(&expression, &|name| self.variables.lookup(name)) {
            Ok(value) => value,
            // `Variables::collect` has reported errors in the values of `Let`.
            Err(_) if callee.keyword == Keyword::Let => return Err(ArgumentError::Invalid),
            Err(error) => {
                if let (EvaluationError::UndefinedVariable(name), ArgumentKind::Word(_)) =
                    (&error, &argument.kind)
                    && self.is_closer_to_a_keyword(name)
                {
                    return Err(ArgumentError::MisspelledKeyword);
                }
                let nearest = |name: &str| self.variables.nearest(name).map(str::to_owned);
                let diagnostic = evaluation_diagnostic(error, self.text, argument, &nearest);
                self.diagnostics.extend(diagnostic);
                return Err(ArgumentError::Invalid);
            }
        };
        let is_usable = value.abs() <= MAX_NUMBER;
        if is_usable && bounds.contains(value) {
            return Ok(ArgumentValue::Number(value));
        }
        let owner = match callee.parameters {
            1 => format!("`{}`", callee.name),
            _ => format!("`{}` of `{}`", parameter.name, callee.name),
        };
        let message = if is_usable {
            format!("{owner} cannot be {value}")
        } else {
            // Up to 300 digits otherwise.
            format!("{owner} cannot be {value:e}")
        };
        let expected = if is_usable || !bounds.contains(value) {
            bounds.describe()
        } else {
            format!("a number from -{MAX_NUMBER} to {MAX_NUMBER}")
        };
        let diagnostic = self.diagnostic(Code::OutOfRange, &argument.range, message);
        self.diagnostics
            .push(diagnostic.label(format!("expected {expected}")));
        Err(ArgumentError::Invalid)
    }

    /// Whether an undefined variable is spelled more like a keyword than like any variable.
    fn is_closer_to_a_keyword(&self, name: &Name) -> bool {
        let Some((_, distance)) = Keyword::nearest(&name.text) else {
            return false;
        };
        if vocabulary::is_known(&name.text) {
            return false;
        }
        self.variables.nearest(&name.text).is_none_or(|variable| {
            strsim::damerau_levenshtein(&name.text.to_lowercase(), &variable.to_lowercase())
                > distance
        })
    }

    fn word<'w>(
        &mut self,
        callee: Callee<'_>,
        argument: &Argument,
        word: &str,
        names: impl Iterator<Item = &'w str> + Clone,
    ) -> Result<ArgumentValue, ArgumentError> {
        if let Some(name) = names.clone().find(|name| name.eq_ignore_ascii_case(word)) {
            return Ok(ArgumentValue::Word(name.to_owned()));
        }
        self.unknown_word(callee, argument, word, names);
        Err(ArgumentError::Invalid)
    }

    pub(super) fn unknown_word<'w>(
        &mut self,
        callee: Callee<'_>,
        argument: &Argument,
        word: &str,
        names: impl Iterator<Item = &'w str> + Clone,
    ) {
        let what = match callee.keyword {
            Keyword::Shape => "not a kind of `Shape`".to_owned(),
            Keyword::Color | Keyword::Mark => "not a colour".to_owned(),
            _ => format!("not a value for `{}`", callee.name),
        };
        let message = format!("`{word}` is {what}");
        let diagnostic = self.diagnostic(Code::UnknownWord, &argument.range, message);
        let all: Vec<_> = names.clone().map(|name| format!("`{name}`")).collect();
        let diagnostic = match nearest_word(word, names.clone()) {
            Some(near) => {
                let diagnostic = did_you_mean(diagnostic, self.text, &argument.range, near);
                if has_one_near_word(word, names) {
                    diagnostic.safe()
                } else {
                    diagnostic
                }
            }
            None if all.len() > 20 => {
                diagnostic.help("write a CSS colour name, `#rrggbb`, or three numbers from 0 to 1")
            }
            None => diagnostic.help(format!("write one of {}", all.join(", "))),
        };
        self.diagnostics.push(diagnostic);
    }

    fn unknown_keyword(&mut self, argument: &Argument, word: &str) {
        let diagnostic = suggestions::unknown_keyword(self.text, argument.range.clone(), word);
        self.diagnostics.push(diagnostic);
    }

    /// Reports too many arguments. Returns whether the attribute is complete without them.
    fn too_many(&mut self, callee: Callee<'_>, excess: &[Argument]) -> bool {
        let Some((first, last)) = excess.first().zip(excess.last()) else {
            return true;
        };
        if let ArgumentKind::Word(word) = &first.kind
            && !word.starts_with(['+', '-'])
            && self.variables.lookup(word) == Lookup::Undefined
        {
            self.unknown_keywords(excess);
            return true;
        }
        let message = format!("`{}` has too many arguments", callee.name);
        let range = first.range.start..last.range.end;
        let diagnostic = self.diagnostic(Code::ArgumentCount, &range, message);
        let diagnostic = diagnostic.label(match excess.len() {
            1 => "one too many".to_owned(),
            count => format!("{count} too many"),
        });
        self.diagnostics
            .push(diagnostic.help(format!("write `{}`", callee.usage())));
        false
    }

    /// Reports the first of `arguments`, which is in the place of a keyword, and further misspelled keywords.
    pub(super) fn unknown_keywords(&mut self, arguments: &[Argument]) {
        let mut lower_case = None;
        for argument in arguments {
            let ArgumentKind::Word(word) = &argument.kind else {
                continue;
            };
            let is_keyword = match lower_case {
                None => true,
                Some(lower_case) => {
                    suggestions::is_misspelled_keyword(word, lower_case)
                        && self.variables.lookup(word) == Lookup::Undefined
                }
            };
            if is_keyword {
                lower_case = Some(word.starts_with(char::is_lowercase));
                self.unknown_keyword(argument, word);
            }
        }
    }

    fn too_few(&mut self, callee: Callee<'_>, form: &Form, arguments: &[Argument]) {
        let missing = form.parameter_index(arguments.len());
        let missing = missing.map(|index| &form.parameters[index]);
        let end = arguments
            .last()
            .map_or(callee.range.end, |last| last.range.end);
        let message = format!("`{}` has too few arguments", callee.name);
        let range = callee.range.start..end;
        let diagnostic = self.diagnostic(Code::ArgumentCount, &range, message);
        let diagnostic = diagnostic.help(format!("write `{}`", callee.usage()));
        self.diagnostics.push(match missing {
            Some(missing) => diagnostic.label(format!("`{}` is missing", missing.print())),
            None => diagnostic,
        });
    }

    pub(super) fn wrong_type(
        &mut self,
        callee: Callee<'_>,
        parameter: &Parameter,
        argument: &Argument,
    ) {
        let text = self.text.as_str();
        let written = text.get(argument.range.clone()).unwrap_or_default();
        let shown: String = written.chars().take(40).collect();
        let span = self.text.span(argument.range.clone());
        let message = format!("`{shown}` is not what `{}` needs here", callee.name);
        let mut diagnostic = Diagnostic::new(Code::ArgumentType, span, message)
            .label(format!("expected {}", parameter.takes.describe()));
        let textual = matches!(parameter.takes, Takes::File | Takes::Text);
        if textual && !matches!(argument.kind, ArgumentKind::Quoted(_)) {
            diagnostic = diagnostic
                .help("text that is not a single plain word needs quotes")
                .fix(
                    "Put it in quotes",
                    span,
                    self.text
                        .escape_at(argument.range.start, &format!("\"{written}\"")),
                )
                .safe();
        } else {
            diagnostic = diagnostic.help(format!("write `{}`", callee.usage()));
        }
        self.diagnostics.push(diagnostic);
    }

    fn bad_hex(&mut self, argument: &Argument, digits: &str) {
        let shown: String = digits.chars().take(20).collect();
        let message = format!("`#{shown}` is not a colour");
        let diagnostic = self.diagnostic(Code::ArgumentType, &argument.range, message);
        self.diagnostics.push(
            diagnostic
                .label("expected 3, 4, 6 or 8 digits from 0 to f")
                .help("write a colour as `#rrggbb`, for example `#ff8800`"),
        );
    }
}

/// The colour `rgb`, `rgba`, `rrggbb` or `rrggbbaa`.
fn hex(digits: &str) -> Option<[u8; 4]> {
    let long: String = match digits.len() {
        3 | 4 => digits.chars().flat_map(|digit| [digit, digit]).collect(),
        6 | 8 => digits.to_owned(),
        _ => return None,
    };
    let mut color = [255; 4];
    for (index, channel) in color.iter_mut().enumerate() {
        if let Some(pair) = long.get(2 * index..2 * index + 2) {
            *channel = u8::from_str_radix(pair, 16).ok()?;
        }
    }
    Some(color)
}
