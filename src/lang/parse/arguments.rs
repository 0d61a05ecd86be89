//! Parses arguments: numbers, words, quotes, colours and expressions.

use std::ops::Range;

use nom::Err;

use super::expression::{ExpressionError, ExpressionParser, MAX_DEPTH, MAX_OPERATORS};
use super::names::shorten;
use super::{Parser, lexical, suggestions};
use crate::diagnostic::{Code, Diagnostic, nearest_word};
use crate::lang::ast::{Argument, ArgumentKind, Expression, Function};
use crate::lang::did_you_mean;
use crate::lang::keyword::Keyword;
use crate::lang::keyword::signature::{Form, Takes};
use crate::lang::keyword::vocabulary::FUNCTIONS;

impl Parser<'_> {
    /// Parses the next argument; there must be one.
    pub(super) fn argument(
        &mut self,
        keyword: Keyword,
        flags: &[(char, Range<usize>)],
        before: &[Argument],
    ) -> Argument {
        let start = self.at;
        let kind = match self.peek() {
            Some('"') => self.quoted(),
            Some('(') => self.expression(),
            Some(')') => {
                self.at += 1;
                self.stray_parenthesis(start)
            }
            Some(_) => self.run(keyword, flags, before),
            None => ArgumentKind::Unreadable,
        };
        Argument {
            kind,
            range: self.range(start..self.at),
        }
    }

    fn quoted(&mut self) -> ArgumentKind {
        if let Ok((rest, text)) = lexical::quoted(self.rest()) {
            self.move_to(rest);
            return ArgumentKind::Quoted(text.to_owned());
        }
        let start = self.at;
        self.at += 1;
        self.skip_to_attribute(false);
        let end = start + self.normalized.as_str()[start..self.at].trim_end().len();
        self.at = end;
        self.unclosed_quote(start, end);
        ArgumentKind::Unreadable
    }

    fn stray_parenthesis(&mut self, start: usize) -> ArgumentKind {
        let span = self.span(start..start + 1);
        let message = "this `)` has no matching `(`";
        let diagnostic =
            Diagnostic::new(Code::UnclosedParenthesis, span, message).fix("Delete it", span, "");
        self.report(diagnostic);
        ArgumentKind::Unreadable
    }

    fn expression(&mut self) -> ArgumentKind {
        let normalized = self.normalized;
        let whole = normalized.as_str();
        let start = self.at;
        let (close, region) = match closing(self.rest()) {
            Ok(close) => (Some(start + close), start + close),
            Err(end) => (None, start + end),
        };
        let parser = ExpressionParser::new(normalized);
        let parsed = parser.sum(&whole[start + 1..], MAX_DEPTH);
        let Some(close) = close else {
            // Continue after the part that can be read as a calculation.
            self.at = match &parsed {
                Ok((rest, _)) => (whole.len() - rest.len()).min(region),
                Err(_) => start + whole[start..region].trim_end().len(),
            };
            let end = self.at;
            let diagnostic = Diagnostic::new(
                Code::UnclosedParenthesis,
                self.span(start..start + 1),
                "this parenthesis is never closed",
            )
            .fix("Close it", self.span(end..end), self.escape(end, ")"));
            self.report(diagnostic);
            return ArgumentKind::Unreadable;
        };
        self.at = close + 1;
        let error = match parsed {
            Ok((rest, value)) if whole.len() - rest.trim_start().len() == close => {
                return ArgumentKind::Expression(value);
            }
            Ok((rest, _)) => ExpressionError::Expected(
                "expected an operator: `+`, `-`, `*` or `/`",
                rest.trim_start().len(),
            ),
            Err(Err::Error(error) | Err::Failure(error)) => error,
            Err(Err::Incomplete(_)) => ExpressionError::Mismatch,
        };
        let diagnostic = self.expression_diagnostic(error, start..close + 1);
        self.report(diagnostic);
        ArgumentKind::Unreadable
    }

    /// The diagnostic for an error in the expression at `range`.
    fn expression_diagnostic(&self, error: ExpressionError, range: Range<usize>) -> Diagnostic {
        let whole = self.normalized.as_str();
        let written = shorten(&whole[range.clone()]);
        match error {
            ExpressionError::Mismatch => Diagnostic::new(
                Code::BadExpression,
                self.span(range),
                format!("`{written}` is not a valid calculation"),
            ),
            ExpressionError::Expected(what, rest) => {
                let at = (whole.len() - rest).min(range.end - 1);
                let length = lexical::run(&whole[at..]).max(1);
                let end = (at + length).min(range.end.max(at + 1));
                let message = format!("`{written}` is not a valid calculation");
                Diagnostic::new(Code::BadExpression, self.span(at..end), message).label(what)
            }
            ExpressionError::UnknownFunction(name, rest) => {
                let at = whole.len() - rest;
                let range = at..at + name.len();
                let message = format!("`{}` is not a function", shorten(&name));
                let diagnostic =
                    Diagnostic::new(Code::UnknownWord, self.span(range.clone()), message)
                        .help(format!("the functions are {}", function_names()));
                let names = FUNCTIONS.iter().map(|row| row.name);
                match nearest_word(&name, names) {
                    Some(near) => did_you_mean(diagnostic, self.text, &self.range(range), near),
                    None => diagnostic,
                }
            }
            ExpressionError::ArgumentCount(function, from, to) => {
                let row = function.row();
                Diagnostic::new(
                    Code::ArgumentCount,
                    self.span(whole.len() - from..whole.len() - to),
                    format!("`{}` takes {}", row.name, count(row.arguments.0)),
                )
                .help(format!("write `{}`", row.usage))
            }
            ExpressionError::TooLarge(from, to) => Diagnostic::new(
                Code::OutOfRange,
                self.span(whole.len() - from..whole.len() - to),
                "this number is too large",
            ),
            ExpressionError::Limit => Diagnostic::new(
                Code::LimitPassed,
                self.span(range),
                format!(
                    "this calculation has more than {MAX_DEPTH} nested parentheses or more than \
                     {MAX_OPERATORS} operators"
                ),
            )
            .help("split it up: define parts of it as variables with `Let`"),
        }
    }

    fn run(
        &mut self,
        keyword: Keyword,
        flags: &[(char, Range<usize>)],
        before: &[Argument],
    ) -> ArgumentKind {
        let start = self.at;
        let rest = self.rest();
        let length = lexical::run(rest).max(rest.chars().next().map_or(0, char::len_utf8));
        let run = &rest[..length];
        self.at += length;
        if lexical::is(run, lexical::number) {
            return match run.parse::<f64>() {
                Ok(value) if value.is_finite() => ArgumentKind::Number(value),
                _ => {
                    let message = format!("the number `{}` is too large", shorten(run));
                    let diagnostic =
                        Diagnostic::new(Code::OutOfRange, self.span(start..self.at), message);
                    self.report(diagnostic);
                    ArgumentKind::Unreadable
                }
            };
        }
        let calls = rest[length..].starts_with('(') && Function::from_name(run).is_some();
        if calls {
            return self.bare_call(start);
        }
        if lexical::is(run, lexical::word)
            || (lexical::is(run, lexical::signed_axis)
                && takes(keyword, |takes| matches!(takes, Takes::SignedAxis)))
        {
            return ArgumentKind::Word(run.to_owned());
        }
        if let Ok((after, digits)) = lexical::hex(run)
            && after.is_empty()
        {
            return ArgumentKind::Hex(digits.to_owned());
        }
        let named = run.starts_with(|c: char| c.is_alphabetic() || c == '_');
        if named && takes(keyword, |takes| matches!(takes, Takes::Names)) {
            return ArgumentKind::Word(run.to_owned());
        }
        // The last argument comes first: with many such arguments, the search then ends at once.
        let comma_reported = before.iter().rev().any(|argument| {
            argument.kind == ArgumentKind::Unreadable
                && self.text.as_str()[argument.range.clone()].contains([',', '，'])
        });
        if run.contains(',') && comma_reported {
            return ArgumentKind::Unreadable;
        }
        let bad = suggestions::BadArgument {
            keyword,
            flags,
            before,
            run,
        };
        let location = suggestions::Location {
            text: self.text,
            range: self.range(start..start + length),
        };
        let diagnostic = suggestions::malformed(&bad, &location, self.is_calculation(run));
        self.report(diagnostic);
        ArgumentKind::Unreadable
    }

    /// `min(1, 2)` without parentheses around it.
    fn bare_call(&mut self, start: usize) -> ArgumentKind {
        let whole = self.normalized.as_str();
        let Ok(close) = closing(self.rest()) else {
            return self.expression();
        };
        self.at += close + 1;
        let written = &whole[start..self.at];
        let span = self.span(start..self.at);
        let fixed = format!("({written})");
        let message = format!("the calculation `{}` needs parentheses", shorten(written));
        let diagnostic = Diagnostic::new(Code::BadExpression, span, message)
            .fix("Put it in parentheses", span, self.escape(start, &fixed))
            .safe();
        self.report(diagnostic);
        ArgumentKind::Unreadable
    }

    /// Whether `run`, a piece of the string, would be a calculation in parentheses.
    fn is_calculation(&self, run: &str) -> bool {
        let normalized = super::Normalized::new(run);
        let parser = ExpressionParser::new(&normalized);
        let parsed = parser.sum(normalized.as_str(), MAX_DEPTH);
        matches!(
            parsed,
            Ok(("", Expression::Binary(..) | Expression::Negate(_)))
        )
    }
}

/// Whether some form of the keyword takes such an argument.
fn takes(keyword: Keyword, what: fn(&Takes) -> bool) -> bool {
    let mut parameters = keyword.row().forms.iter().flat_map(Form::all);
    parameters.any(|parameter| what(&parameter.takes))
}

/// The offset of the parenthesis that closes the one at the start of `rest`. If there is none, the error is
/// the offset of the next keyword, sign or quote, or the end of the string: the calculation ends before it.
fn closing(rest: &str) -> Result<usize, usize> {
    let mut depth = 0_usize;
    let mut word = true;
    for (at, c) in rest.char_indices() {
        match c {
            '(' => depth += 1,
            ')' => {
                depth -= 1;
                if depth == 0 {
                    return Ok(at);
                }
            }
            '$' | '@' | '"' | '%' => return Err(at),
            c if word && c.is_alphabetic() => {
                let read = lexical::word(&rest[at..]);
                if read.is_ok_and(|(_, word)| Keyword::from_name(word).is_some()) {
                    return Err(at);
                }
            }
            _ => {}
        }
        word = !lexical::is_word_char(c);
    }
    Err(rest.len())
}

fn count(number: usize) -> String {
    match number {
        1 => "one number".to_owned(),
        number => format!("{number} numbers"),
    }
}

fn function_names() -> String {
    let names: Vec<_> = FUNCTIONS
        .iter()
        .map(|row| format!("`{}`", row.name))
        .collect();
    names.join(", ")
}
