//! Computes the value of an attribute from its arguments.

use super::Checker;
use super::arguments::{ArgumentValue, Callee};
use crate::diagnostic::{Code, Diagnostic, Edit, Fix};
use crate::lang::ast::{Argument, ArgumentKind, Attribute};
use crate::lang::evaluate::Lookup;
use crate::lang::fixed_by_writing;
use crate::lang::keyword::kinds::{Kind, Rule};
use crate::lang::keyword::signature::{Form, Takes};
use crate::lang::keyword::{Keyword, kinds};
use crate::lang::parameter::form_by_first_argument;
use crate::lang::value::{
    Camerawork, Ground, HeldDrawing, KindArguments, Mark, Origin, Performance, PerformanceEffects,
    Pose, Shape, SignedAxis, Value,
};

impl Checker<'_> {
    /// The value of an attribute, and its arguments as text.
    pub(super) fn value(&mut self, attribute: &Attribute) -> Option<(Value, Vec<String>)> {
        let forms = attribute.keyword.row().forms;
        let callee = Callee {
            name: attribute.keyword.name(),
            kind: None,
            range: &attribute.keyword_range,
            parameters: forms.first().map_or(0, |form| form.parameters.len()),
            keyword: attribute.keyword,
        };
        if attribute.keyword == Keyword::Shape {
            return self.shape(attribute, callee);
        }
        if attribute.keyword == Keyword::Color && self.reports_byte_color(attribute) {
            return None;
        }
        if attribute.keyword == Keyword::Motion {
            let (motion, values) = self.motion(callee, attribute)?;
            return Some((Value::Motion(motion), values.iter().map(print).collect()));
        }
        let form = self.form(callee, attribute)?;
        let values = self.match_arguments(callee, form, &attribute.arguments)?;
        let value = match attribute.keyword {
            Keyword::Perform => Value::Performance(performance(attribute, &values)?),
            Keyword::Held => Value::Held(self.held(attribute, &values)?),
            Keyword::Pose => Value::Pose(pose(attribute, &values)?),
            keyword => value_of(keyword, &values)?,
        };
        if let Value::Axes(axes) = &value {
            self.check_axes(axes, attribute)?;
        }
        Some((value, values.iter().map(print).collect()))
    }

    /// The form that the first argument fits; reports an argument that fits none.
    fn form(&mut self, callee: Callee<'_>, attribute: &Attribute) -> Option<&'static Form> {
        let forms = attribute.keyword.row().forms;
        let (only, others) = forms.split_first()?;
        let Some(first) = attribute.arguments.first() else {
            return Some(only);
        };
        if others.is_empty() {
            return Some(only);
        }
        let found = form_by_first_argument(attribute, &|name| {
            self.variables.lookup(name) != Lookup::Undefined
        });
        if found.is_some() {
            return found;
        }
        let with_words = forms.iter().find(|form| {
            form.parameters
                .iter()
                .any(|parameter| matches!(parameter.takes, Takes::Choice(_) | Takes::ColorName))
        });
        let fallback = match first.kind {
            ArgumentKind::Word(_) => with_words.unwrap_or(only),
            _ => only,
        };
        let parameter = fallback.parameters.first()?;
        if !matches!(first.kind, ArgumentKind::Word(_)) {
            self.wrong_type(callee, parameter, first);
            return None;
        }
        Some(fallback)
    }

    /// Reports `Color 255 128 0`, with a fix; returns whether it did.
    fn reports_byte_color(&mut self, attribute: &Attribute) -> bool {
        let mut bytes = vec![];
        for argument in &attribute.arguments {
            match argument.kind {
                ArgumentKind::Number(value)
                    if (0. ..=255.).contains(&value) && value.fract() == 0. =>
                {
                    bytes.push(value);
                }
                _ => return false,
            }
        }
        let ([first, .., last], 3 | 4) = (attribute.arguments.as_slice(), bytes.len()) else {
            return false;
        };
        if bytes.iter().all(|value| *value <= 1.) {
            return false;
        }
        let digits = bytes.iter().map(|value| format!("{:02x}", *value as u8));
        let color = format!("#{}", digits.collect::<String>());
        let range = first.range.start..last.range.end;
        let message = "red, green and blue go from 0 to 1, not from 0 to 255";
        let diagnostic = self.diagnostic(Code::OutOfRange, &range, message);
        self.diagnostics
            .push(fixed_by_writing(diagnostic, self.text, &range, &color).safe());
        true
    }

    fn check_axes(&mut self, axes: &[SignedAxis; 3], attribute: &Attribute) -> Option<()> {
        let [right, up, front] = axes.map(|axis| axis.axis);
        if right != up && up != front && front != right {
            return self.check_handedness(axes, attribute);
        }
        let message = "`Axes` uses one axis twice";
        let diagnostic = self.diagnostic(Code::OutOfRange, &attribute.range, message);
        self.diagnostics
            .push(diagnostic.help("use each of x, y and z once: `%Axes +x +y +z`"));
        None
    }

    /// The drawings of `Held`: each once, in the order of the motion.
    fn held(
        &mut self,
        attribute: &Attribute,
        values: &[ArgumentValue],
    ) -> Option<Vec<HeldDrawing>> {
        let mut held: Vec<HeldDrawing> = vec![];
        for (values, arguments) in values.chunks(2).zip(attribute.arguments.chunks(2)) {
            let [ArgumentValue::Number(frame), ArgumentValue::Number(frames)] = values else {
                return None;
            };
            let (frame, frames) = (*frame as usize, *frames as usize);
            if let Some(before) = held.last().filter(|before| before.frame >= frame) {
                let range = &arguments.first()?.range;
                let message = match before.frame == frame {
                    true => format!("`Held` lists the drawing {frame} twice"),
                    false => format!(
                        "`Held` lists the drawing {frame} behind the drawing {}, which comes later",
                        before.frame
                    ),
                };
                let diagnostic = self.diagnostic(Code::OutOfRange, range, message);
                self.diagnostics.push(
                    diagnostic.help(
                        "write each drawing once, in the order of the motion: `Held 7 3 12 0`",
                    ),
                );
                return None;
            }
            held.push(HeldDrawing { frame, frames });
        }
        Some(held)
    }

    /// Left-handed axes would mirror the figure.
    fn check_handedness(&mut self, axes: &[SignedAxis; 3], attribute: &Attribute) -> Option<()> {
        let negative = axes.iter().filter(|axis| axis.negative).count();
        let cyclic = (axes[0].axis + 1) % 3 == axes[1].axis;
        if cyclic == (negative % 2 == 0) {
            return Some(());
        }
        let message = "these `Axes` would mirror the model";
        let diagnostic = self.diagnostic(Code::OutOfRange, &attribute.range, message);
        let mut diagnostic =
            diagnostic.help("reverse one of the three directions, for example from `+z` to `-z`");
        if let Some(front) = attribute.arguments.last() {
            let written = &self.text.as_str()[front.range.clone()];
            let reversed = match written.strip_prefix('-') {
                Some(axis) => format!("+{axis}"),
                None => format!("-{}", written.trim_start_matches('+')),
            };
            diagnostic = fixed_by_writing(diagnostic, self.text, &front.range, &reversed);
        }
        self.diagnostics.push(diagnostic);
        None
    }

    fn shape(&mut self, attribute: &Attribute, callee: Callee<'_>) -> Option<(Value, Vec<String>)> {
        let (first, parameters) = attribute.arguments.split_first()?;
        let ArgumentKind::Word(word) = &first.kind else {
            let parameter = attribute.keyword.row().forms.first()?.parameters.first()?;
            self.wrong_type(callee, parameter, first);
            return None;
        };
        let Some(kind) = kinds::from_name(word) else {
            let names = kinds::KINDS.iter().map(|kind| kind.name);
            self.unknown_word(callee, first, word, names);
            return None;
        };
        let callee = Callee {
            name: kind.name,
            kind: Some(kind),
            range: &first.range,
            parameters: kind.form.parameters.len(),
            keyword: Keyword::Shape,
        };
        let values = self.match_arguments(callee, &kind.form, parameters)?;
        let arguments = kind_arguments(kind, &values);
        if let KindArguments::Numbers(numbers) = &arguments {
            self.check_angles(kind, numbers, parameters)?;
            let parameters = &parameters[..values.len().min(parameters.len())];
            self.check_thickness(kind, numbers, attribute, parameters);
        }
        let has = |letter: char| has_flag(attribute, letter);
        let shape = Shape {
            kind: kind.name,
            arguments,
            has_depths: kind.takes_depths() && !values.is_empty(),
            mirrored: has('s'),
            doubled: has('d'),
            centered: has('c'),
        };
        let mut words = vec![kind.name.to_owned()];
        words.extend(values.iter().map(print));
        Some((Value::Shape(shape), words))
    }

    /// The first angle of a rounding must be smaller than the second.
    fn check_angles(&mut self, kind: &Kind, numbers: &[f64], of: &[Argument]) -> Option<()> {
        let ([a0, a1, ..], [first, second, ..]) = (numbers, of) else {
            return Some(());
        };
        if a0 < a1 || !kind.rules.contains(&Rule::Ascending) {
            return Some(());
        }
        let range = first.range.start..second.range.end;
        let message = format!("nothing is left of a rounding from {a0} to {a1} degrees");
        let mut diagnostic = Diagnostic::new(Code::OutOfRange, self.text.span(range), message)
            .label("expected the smaller angle first");
        if a0 > a1 {
            let written = |argument: &Argument| &self.text.as_str()[argument.range.clone()];
            let edit = |from: &Argument, to: &Argument| Edit {
                span: self.text.span(to.range.clone()),
                text: self.text.escape_at(to.range.start, written(from)),
            };
            diagnostic.fixes.push(Fix {
                title: "Swap the angles".to_owned(),
                edits: vec![edit(second, first), edit(first, second)],
                safe: false,
            });
        }
        self.diagnostics.push(diagnostic);
        None
    }

    /// Warns about a solid without thickness.
    fn check_thickness(
        &mut self,
        kind: &Kind,
        numbers: &[f64],
        attribute: &Attribute,
        parameters: &[Argument],
    ) {
        let thin = kind.rules.iter().any(|rule| match rule {
            Rule::Ascending => false,
            Rule::Distinct => matches!(numbers, [z0, z1, ..] if z0 == z1),
            Rule::NonZero(index) => numbers.get(*index) == Some(&0.),
        });
        if !thin {
            return;
        }
        let range = match (parameters.first(), parameters.last()) {
            (Some(first), Some(last)) => first.range.start..last.range.end,
            _ => attribute.range.clone(),
        };
        let message = format!("this `{}` has no thickness", kind.name);
        let help = "write `Shape flat` for a thin sheet, or `Shape none` for no solid at all";
        let diagnostic = self.diagnostic(Code::ZeroThickness, &range, message);
        self.diagnostics.push(diagnostic.help(help));
    }
}

/// The value of an attribute. Only keywords whose value is more than their arguments have a row here.
fn value_of(keyword: Keyword, values: &[ArgumentValue]) -> Option<Value> {
    let number = |index: usize| match values.get(index) {
        Some(ArgumentValue::Number(value)) => Some(*value),
        _ => None,
    };
    let word = |index: usize| match values.get(index) {
        Some(ArgumentValue::Word(word) | ArgumentValue::Text(word)) => Some(word.clone()),
        _ => None,
    };
    let pair = || Some([number(0)?, number(1)?]);
    Some(match keyword {
        Keyword::Color => match values.first()? {
            ArgumentValue::Color([r, g, b, a], written) => Value::Color {
                rgb: [r, g, b].map(|channel| f64::from(*channel) / 255.),
                alpha: gives_alpha(written).then_some(f64::from(*a) / 255.),
            },
            _ => Value::Color {
                rgb: [number(0)?, number(1)?, number(2)?],
                alpha: number(3),
            },
        },
        Keyword::Shape => return None,
        Keyword::Origin => Value::Origin(match values.first()? {
            ArgumentValue::Word(word) if word == "center" => Origin::Center,
            ArgumentValue::Word(word) if word == "start" => Origin::Start,
            ArgumentValue::Word(_) => Origin::End,
            _ => Origin::Point(pair()?),
        }),
        Keyword::Ground => Value::Ground(match values.first()? {
            ArgumentValue::Word(word) if word == "bottom" => Ground::Bottom,
            ArgumentValue::Word(_) => Ground::Page,
            _ => Ground::Point(pair()?),
        }),
        Keyword::Mark => match values.first()? {
            ArgumentValue::Color([r, g, b, _], written) => Value::Mark(Mark {
                word: written.clone(),
                color: [*r, *g, *b],
            }),
            _ => return None,
        },
        Keyword::Axes => Value::Axes([
            signed_axis(&word(0)?)?,
            signed_axis(&word(1)?)?,
            signed_axis(&word(2)?)?,
        ]),
        Keyword::Let => Value::Let(word(0)?, number(1)?),
        _ => return plain_value(values),
    })
}

pub(super) fn has_flag(attribute: &Attribute, letter: char) -> bool {
    let mut flags = attribute.flags.iter();
    flags.any(|(flag, _)| flag.eq_ignore_ascii_case(&letter))
}

/// The value of `Perform`.
fn performance(attribute: &Attribute, values: &[ArgumentValue]) -> Option<Performance> {
    let (ArgumentValue::Text(file), others) = values.split_first()? else {
        return None;
    };
    let emphasized = others.iter().find_map(|value| match value {
        ArgumentValue::Text(mark) => Some(mark.clone()),
        _ => None,
    });
    let keys: Vec<usize> = others
        .iter()
        .filter_map(|value| match value {
            ArgumentValue::Number(key) => Some(*key as usize),
            _ => None,
        })
        .collect();
    let camerawork = match (has_flag(attribute, 'r'), has_flag(attribute, 'c')) {
        (true, _) => Camerawork::Root,
        (false, true) => Camerawork::None,
        (false, false) => Camerawork::Camera,
    };
    Some(Performance {
        file: file.clone(),
        effects: PerformanceEffects {
            timing: !has_flag(attribute, 't'),
            emphasis: !has_flag(attribute, 'e'),
            camerawork,
        },
        emphasized,
        keys: <[usize; 2]>::try_from(keys).ok(),
    })
}

fn pose(attribute: &Attribute, values: &[ArgumentValue]) -> Option<Pose> {
    let (ArgumentValue::Number(seconds), others) = values.split_first()? else {
        return None;
    };
    let clip = match others {
        [ArgumentValue::Text(clip)] => Some(clip.clone()),
        _ => None,
    };
    Some(Pose {
        seconds: *seconds,
        clip,
        is_loop: has_flag(attribute, 'l'),
    })
}

/// The value of a keyword that gives its arguments no meaning of their own.
fn plain_value(values: &[ArgumentValue]) -> Option<Value> {
    Some(match values {
        [] => Value::Flag,
        [ArgumentValue::Number(value)] => Value::Number(*value),
        [ArgumentValue::Number(a), ArgumentValue::Number(b)] => Value::Pair([*a, *b]),
        [
            ArgumentValue::Number(a),
            ArgumentValue::Number(b),
            ArgumentValue::Number(c),
        ] => Value::Triple([*a, *b, *c]),
        [ArgumentValue::Word(word) | ArgumentValue::Text(word)] => Value::Word(word.clone()),
        _ => Value::Names(
            values
                .iter()
                .map(|value| match value {
                    ArgumentValue::Name(name) => Some(name.clone()),
                    _ => None,
                })
                .collect::<Option<_>>()?,
        ),
    })
}

/// Whether a colour, as it is written, sets its opacity.
fn gives_alpha(written: &str) -> bool {
    match written.strip_prefix('#') {
        Some(digits) => matches!(digits.len(), 4 | 8),
        None => written == "transparent",
    }
}

/// The arguments of a kind that were given, and the numbers that the table has for the others.
fn kind_arguments(kind: &Kind, values: &[ArgumentValue]) -> KindArguments {
    if let Some(ArgumentValue::Text(file)) = values.first() {
        return KindArguments::File(file.clone());
    }
    let numbers = values.iter().filter_map(|value| match value {
        ArgumentValue::Number(value) => Some(*value),
        _ => None,
    });
    let defaults = kind.numbers.iter().skip(values.len()).copied();
    KindArguments::Numbers(numbers.chain(defaults).collect())
}

pub(super) fn signed_axis(word: &str) -> Option<SignedAxis> {
    let (sign, axis) = word.split_at_checked(1)?;
    Some(SignedAxis {
        axis: "xyz".find(axis)?,
        negative: sign == "-",
    })
}

/// An argument as text, with variables replaced by their values.
fn print(value: &ArgumentValue) -> String {
    match value {
        ArgumentValue::Number(number) => format!("{number}"),
        ArgumentValue::Word(word) | ArgumentValue::Color(_, word) => word.clone(),
        ArgumentValue::Text(text) | ArgumentValue::Name(text) => format!("\"{text}\""),
    }
}
