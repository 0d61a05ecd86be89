//! Arguments against the parameters of the table.

use super::Checker;
use crate::diagnostic::{Code, Diagnostic, nearest_word};
use crate::lang::ast::{Argument, ArgumentKind, Name};
use crate::lang::evaluate::{Failure, Known, evaluate};
use crate::lang::keyword::colours::{self, COLOURS};
use crate::lang::keyword::kinds::Kind;
use crate::lang::keyword::signature::{Bounds, Form, Parameter, Takes};
use crate::lang::keyword::{Keyword, words};
use crate::lang::parse::slips;
use crate::lang::variables::{expression, tell};

/// An argument that fits.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Given {
    /// A number.
    Number(f64),
    /// A word in its canonical form, an axis, a variable's name.
    Word(String),
    /// A colour, and how it is written.
    Colour([u8; 4], String),
    /// A file's name, or text.
    Text(String),
    /// One of several names.
    Name(String),
}

/// Why an argument does not fit; a diagnostic was made, or none is due.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Misfit {
    /// The attribute has a fault.
    Fault,
    /// The argument is no argument, but a keyword with a slip: the attribute ends before it.
    Keyword,
}

/// Who takes the arguments, for messages.
#[derive(Debug, Clone, Copy)]
pub(super) struct Taker<'a> {
    /// A keyword or a kind of `Shape`.
    pub(super) name: &'a str,
    /// The kind, where it is one.
    pub(super) kind: Option<&'static Kind>,
    /// The place of its name.
    pub(super) place: &'a std::ops::Range<usize>,
    /// How many parameters there are.
    pub(super) parameters: usize,
    /// Whose values `Let` tells about: there nothing is said here.
    pub(super) keyword: Keyword,
}

impl Taker<'_> {
    /// How it is written in full.
    fn usage(&self) -> String {
        match self.kind {
            Some(kind) => format!("Shape {}", kind.usage()),
            None => self.keyword.usages().join("`, or `"),
        }
    }
}

impl Checker<'_> {
    /// Fits `arguments` to `form`.
    pub(super) fn fit(
        &mut self,
        taker: Taker<'_>,
        form: &Form,
        arguments: &[Argument],
    ) -> Option<Vec<Given>> {
        let mut given = vec![];
        let mut whole = true;
        for (index, argument) in arguments.iter().enumerate() {
            let parameter = match form.parameters.get(index).or(form.parameters.last()) {
                Some(parameter) if index < form.most() => parameter,
                _ => {
                    let ends = self.too_many(taker, &arguments[index..]);
                    let enough = form.fits(given.len());
                    return (whole && ends && enough).then_some(given);
                }
            };
            match self.argument(taker, parameter, argument) {
                Ok(value) => given.push(value),
                Err(Misfit::Fault) => {
                    if matches!(parameter.takes, Takes::Names) {
                        return self.no_name(taker, parameter, &arguments[..=index], given);
                    }
                    whole = false;
                    given.push(Given::Number(0.));
                }
                Err(Misfit::Keyword) => {
                    self.unknown_keywords(&arguments[index..]);
                    return (whole && form.fits(given.len())).then_some(given);
                }
            }
        }
        if !form.fits(given.len()) {
            self.too_few(taker, form, arguments);
            return None;
        }
        whole.then_some(given)
    }

    fn argument(
        &mut self,
        taker: Taker<'_>,
        parameter: &Parameter,
        argument: &Argument,
    ) -> Result<Given, Misfit> {
        let found = match (&parameter.takes, &argument.kind) {
            (Takes::Number(bounds), kind) => {
                if !matches!(kind, ArgumentKind::Quoted(_) | ArgumentKind::Hex(_)) {
                    return self.number(taker, parameter, *bounds, argument);
                }
                None
            }
            (Takes::Choice(choices), ArgumentKind::Word(word)) => {
                let names = choices.iter().map(|choice| choice.name);
                return self.word(taker, argument, word, names);
            }
            (Takes::SignedAxis, ArgumentKind::Word(word)) => {
                let names = words::AXES.iter().map(|axis| axis.name);
                return self.word(taker, argument, word, names);
            }
            (Takes::ColourName, ArgumentKind::Word(word)) => match colours::colour(word) {
                Some(colour) => Some(Given::Colour(colour, word.to_ascii_lowercase())),
                None => {
                    let names = COLOURS.iter().copied();
                    return self.word(taker, argument, word, names);
                }
            },
            (Takes::Hex, ArgumentKind::Hex(digits)) => match hex(digits) {
                Some(colour) => Some(Given::Colour(
                    colour,
                    format!("#{}", digits.to_ascii_lowercase()),
                )),
                None => {
                    self.bad_hex(argument, digits);
                    return Err(Misfit::Fault);
                }
            },
            (Takes::File | Takes::Text, ArgumentKind::Quoted(text) | ArgumentKind::Word(text))
                if !text.trim().is_empty() =>
            {
                Some(Given::Text(text.clone()))
            }
            (Takes::Names, ArgumentKind::Quoted(text) | ArgumentKind::Word(text))
                if !text.trim().is_empty() =>
            {
                Some(Given::Name(text.clone()))
            }
            (Takes::Variable, ArgumentKind::Word(word)) => Some(Given::Word(word.clone())),
            _ => None,
        };
        found.ok_or_else(|| {
            // Of a list of names the caller tells, who knows the name before.
            if !matches!(parameter.takes, Takes::Names) {
                self.wrong_type(taker, parameter, argument);
            }
            Misfit::Fault
        })
    }

    fn number(
        &mut self,
        taker: Taker<'_>,
        parameter: &Parameter,
        bounds: Bounds,
        argument: &Argument,
    ) -> Result<Given, Misfit> {
        let Some(expression) = expression(argument) else {
            return Err(Misfit::Fault);
        };
        let value = match evaluate(&expression, &|name| self.variables.known(name)) {
            Ok(value) => value,
            // `Variables` has looked at the values of `Let`.
            Err(_) if taker.keyword == Keyword::Let => return Err(Misfit::Fault),
            Err(failure) => {
                if let (Failure::Unknown(name), ArgumentKind::Word(_)) = (&failure, &argument.kind)
                    && self.is_rather_a_keyword(name)
                {
                    return Err(Misfit::Keyword);
                }
                let nearest = |name: &str| self.variables.nearest(name).map(str::to_owned);
                let told = tell(failure, self.text, argument, &nearest);
                self.diagnostics.extend(told);
                return Err(Misfit::Fault);
            }
        };
        if bounds.holds(value) {
            return Ok(Given::Number(value));
        }
        let owner = match taker.parameters {
            1 => format!("`{}`", taker.name),
            _ => format!("`{}` of `{}`", parameter.name, taker.name),
        };
        self.diagnostics.push(
            Diagnostic::new(
                Code::OutOfRange,
                self.text.span(argument.range.clone()),
                format!("{owner} cannot be {value}"),
            )
            .label(format!("{} is due", bounds.describe())),
        );
        Err(Misfit::Fault)
    }

    /// Whether an unknown variable is nearer to a keyword than to any variable.
    fn is_rather_a_keyword(&self, name: &Name) -> bool {
        let Some((_, distance)) = Keyword::nearly(&name.text) else {
            return false;
        };
        if words::is_known(&name.text) {
            return false;
        }
        self.variables.nearest(&name.text).is_none_or(|variable| {
            strsim::damerau_levenshtein(&name.text.to_lowercase(), &variable.to_lowercase())
                > distance
        })
    }

    fn word<'w>(
        &mut self,
        taker: Taker<'_>,
        argument: &Argument,
        word: &str,
        names: impl Iterator<Item = &'w str> + Clone,
    ) -> Result<Given, Misfit> {
        if let Some(name) = names.clone().find(|name| name.eq_ignore_ascii_case(word)) {
            return Ok(Given::Word(name.to_owned()));
        }
        self.unknown_word(taker, argument, word, names);
        Err(Misfit::Fault)
    }

    pub(super) fn unknown_word<'w>(
        &mut self,
        taker: Taker<'_>,
        argument: &Argument,
        word: &str,
        names: impl Iterator<Item = &'w str> + Clone,
    ) {
        let span = self.text.span(argument.range.clone());
        let what = match taker.keyword {
            Keyword::Shape => "no kind of `Shape`".to_owned(),
            Keyword::Color | Keyword::Mark => "no colour".to_owned(),
            _ => format!("no word of `{}`", taker.name),
        };
        let diagnostic = Diagnostic::new(Code::UnknownWord, span, format!("`{word}` is {what}"));
        let all: Vec<_> = names.clone().map(|name| format!("`{name}`")).collect();
        let diagnostic = match nearest_word(word, names) {
            Some(near) => diagnostic.label(format!("did you mean `{near}`?")).fix(
                format!("Write `{near}`"),
                span,
                self.text.escape_at(argument.range.start, near),
            ),
            None if all.len() > 20 => diagnostic.help(
                "write a colour's name as in CSS, or `#rrggbb`, or three numbers from 0 to 1",
            ),
            None => diagnostic.help(format!("it is one of {}", all.join(", "))),
        };
        self.diagnostics.push(diagnostic);
    }

    /// The last of `arguments` is no name. In `Follow Rarm Colr 1 0 0` this shows that the name before
    /// it was to be a keyword.
    fn no_name(
        &mut self,
        taker: Taker<'_>,
        parameter: &Parameter,
        arguments: &[Argument],
        mut given: Vec<Given>,
    ) -> Option<Vec<Given>> {
        if let [.., name, _] = arguments
            && let ArgumentKind::Word(word) = &name.kind
            && slips::is_nearly_keyword(word, true)
        {
            given.pop();
            let diagnostic = slips::no_keyword(self.text, name.range.clone(), word);
            self.diagnostics.push(diagnostic);
            return (!given.is_empty()).then_some(given);
        }
        if let Some(last) = arguments.last() {
            self.wrong_type(taker, parameter, last);
        }
        None
    }

    /// Too many arguments. Whether the attribute ended properly before them.
    fn too_many(&mut self, taker: Taker<'_>, excess: &[Argument]) -> bool {
        let Some((first, last)) = excess.first().zip(excess.last()) else {
            return true;
        };
        if let ArgumentKind::Word(word) = &first.kind
            && self.variables.known(word) == Known::Unknown
        {
            self.unknown_keywords(excess);
            return true;
        }
        self.diagnostics.push(
            Diagnostic::new(
                Code::ArgumentCount,
                self.text.span(first.range.start..last.range.end),
                format!("`{}` has too many arguments", taker.name),
            )
            .label(match excess.len() {
                1 => "one too many".to_owned(),
                count => format!("{count} too many"),
            })
            .help(format!("write `{}`", taker.usage())),
        );
        false
    }

    /// The first of `arguments` stands where a keyword is due; others may do so too.
    pub(super) fn unknown_keywords(&mut self, arguments: &[Argument]) {
        let mut lower_case = None;
        for argument in arguments {
            let ArgumentKind::Word(word) = &argument.kind else {
                continue;
            };
            let slip = match lower_case {
                None => true,
                Some(lower_case) => {
                    slips::is_nearly_keyword(word, lower_case)
                        && self.variables.known(word) == Known::Unknown
                }
            };
            if slip {
                lower_case = Some(word.starts_with(char::is_lowercase));
                let diagnostic = slips::no_keyword(self.text, argument.range.clone(), word);
                self.diagnostics.push(diagnostic);
            }
        }
    }

    fn too_few(&mut self, taker: Taker<'_>, form: &Form, arguments: &[Argument]) {
        let missing = form.parameters.get(arguments.len());
        let end = arguments
            .last()
            .map_or(taker.place.end, |last| last.range.end);
        let diagnostic = Diagnostic::new(
            Code::ArgumentCount,
            self.text.span(taker.place.start..end),
            format!("`{}` has too few arguments", taker.name),
        )
        .help(format!("write `{}`", taker.usage()));
        self.diagnostics.push(match missing {
            Some(missing) => diagnostic.label(format!("`{}` is missing", missing.print())),
            None => diagnostic,
        });
    }

    pub(super) fn wrong_type(
        &mut self,
        taker: Taker<'_>,
        parameter: &Parameter,
        argument: &Argument,
    ) {
        let written = self
            .text
            .as_str()
            .get(argument.range.clone())
            .unwrap_or_default();
        let shown: String = written.chars().take(40).collect();
        let span = self.text.span(argument.range.clone());
        let mut diagnostic = Diagnostic::new(
            Code::ArgumentType,
            span,
            format!("`{shown}` is not what `{}` needs here", taker.name),
        )
        .label(format!("{} is due", parameter.takes.describe()));
        let textual = matches!(parameter.takes, Takes::File | Takes::Text);
        if textual && !matches!(argument.kind, ArgumentKind::Quoted(_)) {
            diagnostic = diagnostic
                .help("text that is not one plain word stands in quotes")
                .fix(
                    "Put it in quotes",
                    span,
                    self.text
                        .escape_at(argument.range.start, &format!("\"{written}\"")),
                );
        } else {
            diagnostic = diagnostic.help(format!("write `{}`", taker.usage()));
        }
        self.diagnostics.push(diagnostic);
    }

    fn bad_hex(&mut self, argument: &Argument, digits: &str) {
        let shown: String = digits.chars().take(20).collect();
        self.diagnostics.push(
            Diagnostic::new(
                Code::ArgumentType,
                self.text.span(argument.range.clone()),
                format!("`#{shown}` is no colour"),
            )
            .label("3, 6 or 8 digits from 0 to f are due")
            .help("write a colour as `#rrggbb`, `#ff8800` for example"),
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
    let mut colour = [255; 4];
    for (index, channel) in colour.iter_mut().enumerate() {
        if let Some(pair) = long.get(2 * index..2 * index + 2) {
            *channel = u8::from_str_radix(pair, 16).ok()?;
        }
    }
    Some(colour)
}
