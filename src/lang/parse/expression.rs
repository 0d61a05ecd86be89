//! Arithmetic in parentheses.

use nom::Err;
use nom::Parser as _;
use nom::character::complete::{char, one_of};
use nom::error::{ErrorKind, ParseError};

use super::lexical;
use crate::lang::ast::{Expression, Function, Name};
use crate::lang::keyword::Keyword;
use crate::lang::normalize::Normalized;

/// How deep parentheses, minus signs and functions may be nested.
pub(super) const MAX_DEPTH: usize = 64;

/// How many operators one expression may have.
pub(super) const MAX_OPERATORS: usize = 256;

/// Why an expression cannot be parsed. Positions are given as the length of the rest of the string.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum ExpressionError {
    /// Not reported: another parser may match.
    Mismatch,
    /// Something else was expected here.
    Expected(&'static str, usize),
    /// A word before `(` that is not a function.
    UnknownFunction(String, usize),
    /// A function with the wrong number of arguments: the rest before its name and after its arguments.
    ArgumentCount(Function, usize, usize),
    /// A number that is too large: the rest before and after it.
    TooLarge(usize, usize),
    /// Nested too deep, or too many operators.
    Limit,
}

impl ParseError<&str> for ExpressionError {
    fn from_error_kind(_: &str, _: ErrorKind) -> Self {
        Self::Mismatch
    }

    fn append(_: &str, _: ErrorKind, other: Self) -> Self {
        other
    }
}

type Parsed<'a> = nom::IResult<&'a str, Expression, ExpressionError>;

/// Parses an expression of a string.
pub(super) struct ExpressionParser<'a> {
    /// The whole normalized string.
    pub(super) normalized: &'a Normalized<'a>,
    /// The number of operators still allowed.
    pub(super) operators: std::cell::Cell<usize>,
}

impl<'a> ExpressionParser<'a> {
    /// A parser for one expression.
    pub(super) fn new(normalized: &'a Normalized<'a>) -> Self {
        Self {
            normalized,
            operators: std::cell::Cell::new(MAX_OPERATORS),
        }
    }

    /// `a + b - c`
    pub(super) fn sum(&self, input: &'a str, depth: usize) -> Parsed<'a> {
        self.chain(input, depth, "+-", Self::product)
    }

    fn product(&self, input: &'a str, depth: usize) -> Parsed<'a> {
        self.chain(input, depth, "*/", Self::factor)
    }

    fn chain(
        &self,
        input: &'a str,
        depth: usize,
        operators: &'static str,
        part: fn(&Self, &'a str, usize) -> Parsed<'a>,
    ) -> Parsed<'a> {
        let (mut rest, mut left) = part(self, input, depth)?;
        loop {
            let after = skip(rest);
            let Ok((next, operator)) = one_of::<_, _, ExpressionError>(operators).parse(after)
            else {
                return Ok((rest, left));
            };
            self.count()?;
            let (next, right) = part(self, next, depth)?;
            left = Expression::Binary(operator, Box::new(left), Box::new(right));
            rest = next;
        }
    }

    fn factor(&self, input: &'a str, depth: usize) -> Parsed<'a> {
        let input = skip(input);
        if depth == 0 {
            return Err(Err::Failure(ExpressionError::Limit));
        }
        if let Ok((rest, _)) = char::<_, ExpressionError>('-').parse(input) {
            self.count()?;
            let (rest, value) = self.factor(rest, depth - 1)?;
            return Ok((rest, Expression::Negate(Box::new(value))));
        }
        if let Ok((rest, _)) = char::<_, ExpressionError>('(').parse(input) {
            let (rest, value) = self.sum(rest, depth - 1)?;
            let (rest, _) = close(rest)?;
            return Ok((rest, value));
        }
        if let Ok((rest, digits)) = lexical::magnitude(input) {
            return number(input, digits, rest);
        }
        match lexical::word(input) {
            Ok((_, name)) if Keyword::from_name(name).is_some() => {
                expected("expected a number or a variable, not a keyword", input)
            }
            Ok((rest, name)) => match char::<_, ExpressionError>('(').parse(skip(rest)) {
                Ok((arguments, _)) => self.call(input, name, arguments, depth - 1),
                _ => Ok((rest, Expression::Variable(self.name(input, name)))),
            },
            _ => expected("expected a number or a variable", input),
        }
    }

    fn call(&self, input: &'a str, name: &'a str, rest: &'a str, depth: usize) -> Parsed<'a> {
        let Some(function) = Function::from_name(name) else {
            let error = ExpressionError::UnknownFunction(name.to_owned(), input.len());
            return Err(Err::Failure(error));
        };
        let mut arguments = vec![];
        let mut rest = rest;
        loop {
            self.count()?;
            let (next, argument) = self.sum(rest, depth)?;
            arguments.push(argument);
            match char::<_, ExpressionError>(',').parse(skip(next)) {
                Ok((next, _)) => rest = next,
                _ => {
                    rest = close(next)?.0;
                    break;
                }
            }
        }
        let (min, max) = function.row().arguments;
        if !(min..=max).contains(&arguments.len()) {
            let error = ExpressionError::ArgumentCount(function, input.len(), rest.len());
            return Err(Err::Failure(error));
        }
        Ok((rest, Expression::Call(function, arguments)))
    }

    fn name(&self, input: &str, name: &str) -> Name {
        let start = self.normalized.as_str().len() - input.len();
        Name {
            text: name.to_owned(),
            range: self.normalized.original(start..start + name.len()),
        }
    }

    fn count(&self) -> Result<(), Err<ExpressionError>> {
        match self.operators.get().checked_sub(1) {
            Some(left) => {
                self.operators.set(left);
                Ok(())
            }
            None => Err(Err::Failure(ExpressionError::Limit)),
        }
    }
}

fn number<'a>(input: &'a str, digits: &str, rest: &'a str) -> Parsed<'a> {
    match digits.parse::<f64>() {
        Ok(value) if value.is_finite() => match rest.chars().next() {
            Some(c) if lexical::is_word_char(c) => expected(
                "letters directly after a number: put a space or an operator between them",
                input,
            ),
            _ => Ok((rest, Expression::Number(value))),
        },
        _ => Err(Err::Failure(ExpressionError::TooLarge(
            input.len(),
            rest.len(),
        ))),
    }
}

fn close(input: &str) -> nom::IResult<&str, char, ExpressionError> {
    let input = skip(input);
    char(')').parse(input).map_err(|_: Err<ExpressionError>| {
        Err::Failure(ExpressionError::Expected(
            "expected an operator or `)`",
            input.len(),
        ))
    })
}

fn expected<'a>(what: &'static str, input: &str) -> Parsed<'a> {
    Err(Err::Failure(ExpressionError::Expected(what, input.len())))
}

fn skip(input: &str) -> &str {
    input.trim_start()
}
