//! The value of an expression.

use crate::math;

use super::ast::{Expression, Function, Name};

/// The result of looking up a variable.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Lookup {
    /// Its value.
    Value(f64),
    /// Its definition has an error, which is reported at the definition.
    Invalid,
    /// It is not defined.
    Undefined,
}

/// Why an expression has no value.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum EvaluationError {
    /// A variable is not defined.
    UndefinedVariable(Name),
    /// The definition of a variable has an error, which is reported there.
    InvalidVariable,
    /// The result is not a number; the text continues "this calculation …".
    NotANumber(&'static str),
}

/// Computes the value of `expression`.
///
/// # Errors
///
/// If a variable has no value, or the result is not a finite number.
pub(super) fn evaluate(
    expression: &Expression,
    variable: &dyn Fn(&str) -> Lookup,
) -> Result<f64, EvaluationError> {
    let value = match expression {
        Expression::Number(value) => *value,
        Expression::Variable(name) => match variable(&name.text) {
            Lookup::Value(value) => value,
            Lookup::Invalid => return Err(EvaluationError::InvalidVariable),
            Lookup::Undefined => return Err(EvaluationError::UndefinedVariable(name.clone())),
        },
        Expression::Negate(inner) => -evaluate(inner, variable)?,
        Expression::Binary(sign, left, right) => {
            let (left, right) = (evaluate(left, variable)?, evaluate(right, variable)?);
            match sign {
                '+' => left + right,
                '-' => left - right,
                '*' => left * right,
                _ if right == 0. => return Err(EvaluationError::NotANumber("divides by zero")),
                _ => left / right,
            }
        }
        Expression::Call(function, arguments) => {
            let mut values = vec![];
            for argument in arguments {
                values.push(evaluate(argument, variable)?);
            }
            call(*function, &values)?
        }
    };
    if value.is_finite() {
        Ok(value)
    } else {
        Err(EvaluationError::NotANumber(
            "gives a number that is too large",
        ))
    }
}

fn call(function: Function, values: &[f64]) -> Result<f64, EvaluationError> {
    let first = values.first().copied().unwrap_or(0.);
    Ok(match function {
        Function::Min => values.iter().copied().fold(first, f64::min),
        Function::Max => values.iter().copied().fold(first, f64::max),
        Function::Abs => first.abs(),
        Function::Sqrt if first < 0. => {
            return Err(EvaluationError::NotANumber(
                "takes the square root of a negative number",
            ));
        }
        Function::Sqrt => first.sqrt(),
        Function::Sin => sine(first),
        Function::Cos => sine(first + 90.),
    })
}

/// The sine of an angle in degrees, exact where it is 0, ½ or 1.
fn sine(degrees: f64) -> f64 {
    let turn = degrees.rem_euclid(360.);
    let (sign, half) = if turn < 180. {
        (1., turn)
    } else {
        (-1., turn - 180.)
    };
    let quarter = half.min(180. - half);
    let value = match quarter {
        0. => return 0.,
        30. => 0.5,
        90. => 1.,
        quarter => math::sin(quarter.to_radians()),
    };
    sign * value
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn round_angles_are_exact() {
        for (degrees, value) in [
            (0., 0.),
            (30., 0.5),
            (150., 0.5),
            (180., 0.),
            (-90., -1.),
            (210., -0.5),
        ] {
            assert_eq!(sine(degrees), value, "{degrees}");
        }
        assert!((sine(45.) - 0.5_f64.sqrt()).abs() < 1e-15);
    }
}
