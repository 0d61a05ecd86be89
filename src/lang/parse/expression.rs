//! Arithmetic in parentheses.

use nom::Err;
use nom::Parser as _;
use nom::character::complete::{char, one_of};
use nom::error::{ErrorKind, ParseError};

use super::lexical;
use crate::lang::ast::{Expression, Function, Name};
use crate::lang::folded::Folded;
use crate::lang::keyword::Keyword;

/// How deep parentheses, signs and functions may be nested.
pub(super) const DEPTH: usize = 64;

/// How many signs of arithmetic one expression may have.
pub(super) const OPERATIONS: usize = 256;

/// Why an expression cannot be read, and from where on.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Fault {
    /// Nothing was said yet; another parser may fit.
    Mismatch,
    /// Something else is due at this place (as the length of the rest).
    Expected(&'static str, usize),
    /// A word before `(` that is no function, with its length.
    UnknownFunction(String, usize),
    /// A function with the wrong number of arguments: the rest before the name and behind the arguments.
    ArgumentCount(Function, usize, usize),
    /// A number too large to reckon with, with its length.
    TooLarge(usize, usize),
    /// Nested too deep, or too long.
    Limit,
}

impl ParseError<&str> for Fault {
    fn from_error_kind(_: &str, _: ErrorKind) -> Self {
        Self::Mismatch
    }

    fn append(_: &str, _: ErrorKind, other: Self) -> Self {
        other
    }
}

type Parsed<'a> = nom::IResult<&'a str, Expression, Fault>;

/// Reads expressions of one string.
pub(super) struct Reader<'a> {
    /// The whole folded string.
    pub(super) folded: &'a Folded<'a>,
    /// Signs of arithmetic still allowed.
    pub(super) operations: std::cell::Cell<usize>,
}

impl<'a> Reader<'a> {
    /// A reader of one expression.
    pub(super) fn new(folded: &'a Folded<'a>) -> Self {
        Self {
            folded,
            operations: std::cell::Cell::new(OPERATIONS),
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
        signs: &'static str,
        part: fn(&Self, &'a str, usize) -> Parsed<'a>,
    ) -> Parsed<'a> {
        let (mut rest, mut left) = part(self, input, depth)?;
        loop {
            let behind = skip(rest);
            let Ok((next, sign)) = one_of::<_, _, Fault>(signs).parse(behind) else {
                return Ok((rest, left));
            };
            self.count()?;
            let (next, right) = part(self, next, depth)?;
            left = Expression::Binary(sign, Box::new(left), Box::new(right));
            rest = next;
        }
    }

    fn factor(&self, input: &'a str, depth: usize) -> Parsed<'a> {
        let input = skip(input);
        if depth == 0 {
            return Err(Err::Failure(Fault::Limit));
        }
        if let Ok((rest, _)) = char::<_, Fault>('-').parse(input) {
            self.count()?;
            let (rest, value) = self.factor(rest, depth - 1)?;
            return Ok((rest, Expression::Negate(Box::new(value))));
        }
        if let Ok((rest, _)) = char::<_, Fault>('(').parse(input) {
            let (rest, value) = self.sum(rest, depth - 1)?;
            let (rest, _) = close(rest)?;
            return Ok((rest, value));
        }
        if let Ok((rest, digits)) = lexical::magnitude(input) {
            return number(input, digits, rest);
        }
        match lexical::word(input) {
            Ok((_, name)) if Keyword::from_name(name).is_some() => {
                expected("a number or a variable is due, not a keyword", input)
            }
            Ok((rest, name)) => match char::<_, Fault>('(').parse(skip(rest)) {
                Ok((arguments, _)) => self.call(input, name, arguments, depth - 1),
                _ => Ok((rest, Expression::Variable(self.name(input, name)))),
            },
            _ => expected("a number or a variable is due here", input),
        }
    }

    fn call(&self, input: &'a str, name: &'a str, rest: &'a str, depth: usize) -> Parsed<'a> {
        let Some(function) = Function::from_name(name) else {
            let fault = Fault::UnknownFunction(name.to_owned(), input.len());
            return Err(Err::Failure(fault));
        };
        let mut arguments = vec![];
        let mut rest = rest;
        loop {
            self.count()?;
            let (next, argument) = self.sum(rest, depth)?;
            arguments.push(argument);
            match char::<_, Fault>(',').parse(skip(next)) {
                Ok((next, _)) => rest = next,
                _ => {
                    rest = close(next)?.0;
                    break;
                }
            }
        }
        let (least, most) = function.row().arguments;
        if !(least..=most).contains(&arguments.len()) {
            let fault = Fault::ArgumentCount(function, input.len(), rest.len());
            return Err(Err::Failure(fault));
        }
        Ok((rest, Expression::Call(function, arguments)))
    }

    fn name(&self, input: &str, name: &str) -> Name {
        let start = self.folded.as_str().len() - input.len();
        Name {
            text: name.to_owned(),
            range: self.folded.original(start..start + name.len()),
        }
    }

    fn count(&self) -> Result<(), Err<Fault>> {
        match self.operations.get().checked_sub(1) {
            Some(left) => {
                self.operations.set(left);
                Ok(())
            }
            None => Err(Err::Failure(Fault::Limit)),
        }
    }
}

fn number<'a>(input: &'a str, digits: &str, rest: &'a str) -> Parsed<'a> {
    match digits.parse::<f64>() {
        Ok(value) if value.is_finite() => match rest.chars().next() {
            Some(c) if lexical::in_word(c) => {
                expected("a number and letters in one word are neither", input)
            }
            _ => Ok((rest, Expression::Number(value))),
        },
        _ => Err(Err::Failure(Fault::TooLarge(input.len(), rest.len()))),
    }
}

fn close(input: &str) -> nom::IResult<&str, char, Fault> {
    let input = skip(input);
    char(')').parse(input).map_err(|_: Err<Fault>| {
        Err::Failure(Fault::Expected(
            "a sign of arithmetic or `)` is due here",
            input.len(),
        ))
    })
}

fn expected<'a>(what: &'static str, input: &str) -> Parsed<'a> {
    Err(Err::Failure(Fault::Expected(what, input.len())))
}

fn skip(input: &str) -> &str {
    input.trim_start()
}
