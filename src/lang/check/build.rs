//! Values from arguments that fit.

use super::Checker;
use super::fit::{Given, Taker};
use crate::diagnostic::{Code, Diagnostic, Edit, Fix};
use crate::lang::ast::{Argument, ArgumentKind, Attribute};
use crate::lang::evaluate::Known;
use crate::lang::keyword::signature::{Form, Takes};
use crate::lang::keyword::{Keyword, Status, kinds};
use crate::lang::slot::spoken_for;
use crate::lang::value::{Ground, Origin, Shape, ShapeKind, SignedAxis, Value};

impl Checker<'_> {
    /// The value of an attribute and its arguments as words.
    pub(super) fn value(&mut self, attribute: &Attribute) -> Option<(Value, Vec<String>)> {
        let taker = Taker {
            name: attribute.keyword.name(),
            kind: None,
            place: &attribute.keyword_range,
            parameters: attribute
                .keyword
                .row()
                .forms
                .first()
                .map_or(0, |form| form.parameters.len()),
            keyword: attribute.keyword,
        };
        if attribute.keyword == Keyword::Shape {
            return self.shape(attribute, taker);
        }
        if attribute.keyword == Keyword::Color && self.is_told_as_bytes(attribute) {
            return None;
        }
        let form = self.form(taker, attribute)?;
        let given = self.fit(taker, form, &attribute.arguments)?;
        let value = value_of(attribute.keyword, &given)?;
        if let Value::Axes(axes) = &value {
            self.distinct(axes, attribute)?;
        }
        Some((value, given.iter().map(print).collect()))
    }

    /// The form that the first argument speaks for.
    fn form(&mut self, taker: Taker<'_>, attribute: &Attribute) -> Option<&'static Form> {
        let forms = attribute.keyword.row().forms;
        let (only, others) = forms.split_first()?;
        let Some(first) = attribute.arguments.first() else {
            return Some(only);
        };
        if others.is_empty() {
            return Some(only);
        }
        let found = spoken_for(attribute, &|name| {
            self.variables.known(name) != Known::Unknown
        });
        if found.is_some() {
            return found;
        }
        let worded = forms.iter().find(|form| {
            form.parameters
                .iter()
                .any(|parameter| matches!(parameter.takes, Takes::Choice(_) | Takes::ColourName))
        });
        let fallback = match first.kind {
            ArgumentKind::Word(_) => worded.unwrap_or(only),
            _ => only,
        };
        let parameter = fallback.parameters.first()?;
        if !matches!(first.kind, ArgumentKind::Word(_)) {
            self.wrong_type(taker, parameter, first);
            return None;
        }
        Some(fallback)
    }

    /// `Color 255 128 0`: says what to write instead.
    fn is_told_as_bytes(&mut self, attribute: &Attribute) -> bool {
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
        let digits: String = bytes
            .iter()
            .map(|value| format!("{value:02x}", value = *value as u8))
            .collect();
        let range = first.range.start..last.range.end;
        let span = self.text.span(range.clone());
        self.diagnostics.push(
            Diagnostic::new(
                Code::OutOfRange,
                span,
                "red, green and blue go from 0 to 1, not to 255",
            )
            .fix(
                format!("Write `#{digits}`"),
                span,
                self.text.escape_at(range.start, &format!("#{digits}")),
            ),
        );
        true
    }

    fn distinct(&mut self, axes: &[SignedAxis; 3], attribute: &Attribute) -> Option<()> {
        let [right, up, front] = axes.map(|axis| axis.axis);
        if right != up && up != front && front != right {
            return self.right_handed(axes, attribute);
        }
        self.diagnostics.push(
            Diagnostic::new(
                Code::OutOfRange,
                self.text.span(attribute.range.clone()),
                "two directions of `Axes` lie on one axis",
            )
            .help("each of x, y and z must occur once: `%Axes +x +y +z`"),
        );
        None
    }

    /// Directions that make a left hand would show the figure as in a mirror.
    fn right_handed(&mut self, axes: &[SignedAxis; 3], attribute: &Attribute) -> Option<()> {
        let negative = axes.iter().filter(|axis| axis.negative).count();
        let cyclic = (axes[0].axis + 1) % 3 == axes[1].axis;
        if cyclic == (negative % 2 == 0) {
            return Some(());
        }
        let mut diagnostic = Diagnostic::new(
            Code::OutOfRange,
            self.text.span(attribute.range.clone()),
            "these directions of `Axes` would turn the model into its mirror image",
        )
        .help("turn one of the three round, `+z` into `-z` for example");
        if let Some(front) = attribute.arguments.last() {
            let written = &self.text.as_str()[front.range.clone()];
            let turned = match written.strip_prefix('-') {
                Some(axis) => format!("+{axis}"),
                None => format!("-{}", written.trim_start_matches('+')),
            };
            diagnostic = diagnostic.fix(
                format!("Write `{turned}`"),
                self.text.span(front.range.clone()),
                turned,
            );
        }
        self.diagnostics.push(diagnostic);
        None
    }

    fn shape(&mut self, attribute: &Attribute, taker: Taker<'_>) -> Option<(Value, Vec<String>)> {
        let (first, parameters) = attribute.arguments.split_first()?;
        let ArgumentKind::Word(word) = &first.kind else {
            let parameter = attribute.keyword.row().forms.first()?.parameters.first()?;
            self.wrong_type(taker, parameter, first);
            return None;
        };
        let Some(kind) = kinds::from_name(word) else {
            let names = kinds::KINDS.iter().map(|kind| kind.name);
            self.unknown_word(taker, first, word, names);
            return None;
        };
        if kind.status == Status::Planned {
            self.not_built(kind.name, first.range.clone());
        }
        let taker = Taker {
            name: kind.name,
            kind: Some(kind),
            place: &first.range,
            parameters: kind.form.parameters.len(),
            keyword: Keyword::Shape,
        };
        let given = self.fit(taker, &kind.form, parameters)?;
        let value = shape_kind(kind.name, &given)?;
        self.angles(&value, parameters)?;
        self.thickness(kind.name, &value, attribute, parameters, given.len());
        let has = |letter: char| {
            let mut flags = attribute.flags.iter();
            flags.any(|(flag, _)| flag.eq_ignore_ascii_case(&letter))
        };
        let shape = Shape {
            kind: value,
            mirrored: has('s'),
            doubled: has('d'),
            centered: has('c'),
        };
        let mut words = vec![kind.name.to_owned()];
        words.extend(given.iter().map(print));
        Some((Value::Shape(shape), words))
    }

    /// Angles of a rounding go up.
    fn angles(&mut self, kind: &ShapeKind, parameters: &[Argument]) -> Option<()> {
        let (ShapeKind::RoundV([a0, a1])
        | ShapeKind::RoundH([a0, a1])
        | ShapeKind::Round([a0, a1], _)) = kind
        else {
            return Some(());
        };
        let [first, second, ..] = parameters else {
            return Some(());
        };
        if a0 < a1 {
            return Some(());
        }
        let range = first.range.start..second.range.end;
        let mut diagnostic = Diagnostic::new(
            Code::OutOfRange,
            self.text.span(range),
            format!("the rounding from {a0} to {a1} degrees is empty"),
        )
        .label("the first angle must be the smaller one");
        if a0 > a1 {
            let written = |argument: &Argument| &self.text.as_str()[argument.range.clone()];
            let edit = |from: &Argument, to: &Argument| Edit {
                span: self.text.span(to.range.clone()),
                text: self.text.escape_at(to.range.start, written(from)),
            };
            diagnostic.fixes.push(Fix {
                title: "Swap the angles".to_owned(),
                edits: vec![edit(second, first), edit(first, second)],
            });
        }
        self.diagnostics.push(diagnostic);
        None
    }

    /// Warns of a solid without thickness.
    fn thickness(
        &mut self,
        name: &str,
        kind: &ShapeKind,
        attribute: &Attribute,
        parameters: &[Argument],
        count: usize,
    ) {
        let parameters = &parameters[..count.min(parameters.len())];
        let thin = match kind {
            ShapeKind::Default(Some([z0, z1]))
            | ShapeKind::Cone([z0, z1, _])
            | ShapeKind::ConeV([z0, z1, _])
            | ShapeKind::ConeH([z0, z1, _]) => z0 == z1,
            ShapeKind::Round(_, Some(depth)) | ShapeKind::Inflate(Some(depth)) => *depth == 0.,
            _ => false,
        };
        if !thin {
            return;
        }
        let range = match (parameters.first(), parameters.last()) {
            (Some(first), Some(last)) => first.range.start..last.range.end,
            _ => attribute.range.clone(),
        };
        self.diagnostics.push(
            Diagnostic::new(
                Code::ZeroThickness,
                self.text.span(range),
                format!("this `{name}` has no thickness"),
            )
            .help("for a thin bindings write `Shape flat`, for no solid at all `Shape none`"),
        );
    }
}

fn value_of(keyword: Keyword, given: &[Given]) -> Option<Value> {
    let number = |index: usize| match given.get(index) {
        Some(Given::Number(value)) => Some(*value),
        _ => None,
    };
    let word = |index: usize| match given.get(index) {
        Some(Given::Word(word) | Given::Text(word)) => Some(word.clone()),
        _ => None,
    };
    let pair = || Some([number(0)?, number(1)?]);
    Some(match keyword {
        Keyword::Color => match given.first()? {
            Given::Colour([r, g, b, a], written) => Value::Color {
                rgb: [r, g, b].map(|channel| f64::from(*channel) / 255.),
                alpha: gives_alpha(written).then_some(f64::from(*a) / 255.),
            },
            _ => Value::Color {
                rgb: [number(0)?, number(1)?, number(2)?],
                alpha: number(3),
            },
        },
        Keyword::Shape => return None,
        Keyword::Origin => Value::Origin(match given.first()? {
            Given::Word(word) if word == "center" => Origin::Center,
            Given::Word(word) if word == "start" => Origin::Start,
            Given::Word(_) => Origin::End,
            _ => Origin::Point(pair()?),
        }),
        Keyword::Ground => Value::Ground(match given.first()? {
            Given::Word(word) if word == "bottom" => Ground::Bottom,
            Given::Word(_) => Ground::Page,
            _ => Ground::Point(pair()?),
        }),
        Keyword::Emissive => Value::Rgb([number(0)?, number(1)?, number(2)?]),
        Keyword::Offset
        | Keyword::Axis
        | Keyword::Segments
        | Keyword::Smooth
        | Keyword::Metallic
        | Keyword::Roughness
        | Keyword::Alpha
        | Keyword::Depth
        | Keyword::Tiles
        | Keyword::Bevel
        | Keyword::Roof
        | Keyword::Scale
        | Keyword::Size
        | Keyword::Walk
        | Keyword::Pose => Value::Number(number(0)?),
        Keyword::View | Keyword::Stand | Keyword::Limited => Value::Pair(pair()?),
        Keyword::Texture | Keyword::Tile | Keyword::Bind | Keyword::Strokes | Keyword::Perform => {
            Value::Word(word(0)?)
        }
        Keyword::Mark => match given.first()? {
            Given::Colour(_, written) => Value::Word(written.clone()),
            _ => return None,
        },
        Keyword::Bone | Keyword::Follow => Value::Names(
            given
                .iter()
                .filter_map(|given| match given {
                    Given::Name(name) => Some(name.clone()),
                    _ => None,
                })
                .collect(),
        ),
        Keyword::Axes => Value::Axes([
            signed_axis(&word(0)?)?,
            signed_axis(&word(1)?)?,
            signed_axis(&word(2)?)?,
        ]),
        Keyword::Let => Value::Let(word(0)?, number(1)?),
        Keyword::Motion => Value::Motion {
            file: word(0)?,
            clip: word(1),
        },
        Keyword::Backing | Keyword::Hidden => Value::Flag,
    })
}

/// Whether a written colour says how opaque it is.
fn gives_alpha(written: &str) -> bool {
    match written.strip_prefix('#') {
        Some(digits) => matches!(digits.len(), 4 | 8),
        None => written == "transparent",
    }
}

fn shape_kind(name: &str, given: &[Given]) -> Option<ShapeKind> {
    let number = |index: usize| match given.get(index) {
        Some(Given::Number(value)) => Some(*value),
        _ => None,
    };
    let angles = [number(0).unwrap_or(-90.), number(1).unwrap_or(90.)];
    let cone = [
        number(0).unwrap_or(0.),
        number(1).unwrap_or(20.),
        number(2).unwrap_or(0.),
    ];
    Some(match name {
        "default" => ShapeKind::Default(number(0).zip(number(1)).map(|(z0, z1)| [z0, z1])),
        "roundv" => ShapeKind::RoundV(angles),
        "roundh" => ShapeKind::RoundH(angles),
        "round" => ShapeKind::Round(angles, number(2)),
        "cone" => ShapeKind::Cone(cone),
        "conev" => ShapeKind::ConeV(cone),
        "coneh" => ShapeKind::ConeH(cone),
        "inflate" => ShapeKind::Inflate(number(0)),
        "lathe" => ShapeKind::Lathe(number(0).unwrap_or(360.)),
        "model" => match given.first()? {
            Given::Text(file) => ShapeKind::Model(file.clone()),
            _ => return None,
        },
        "flat" => ShapeKind::Flat(number(0).unwrap_or(0.)),
        "none" => ShapeKind::None,
        _ => return None,
    })
}

fn signed_axis(word: &str) -> Option<SignedAxis> {
    let (sign, axis) = word.split_at_checked(1)?;
    Some(SignedAxis {
        axis: "xyz".find(axis)?,
        negative: sign == "-",
    })
}

/// An argument as it is written, its value put in.
fn print(given: &Given) -> String {
    match given {
        Given::Number(value) => format!("{value}"),
        Given::Word(word) | Given::Colour(_, word) => word.clone(),
        Given::Text(text) | Given::Name(text) => format!("\"{text}\""),
    }
}
