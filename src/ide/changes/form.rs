//! What can be changed about a part, as a form: made from the language's table, with the part's own values.

use serde::Serialize;

use super::clips::MotionForm;
use super::place::PlaceForm;
use super::{Analysis, Refusal, can_set};
use crate::bind::{PartId, PartKind, StringId, plate_depth};
use crate::lang::ast::{Argument, ArgumentKind, Attribute};
use crate::lang::keyword::kinds::{self, KINDS};
use crate::lang::keyword::signature::{Bounds, Form, Parameter, Restriction, Takes, Usual};
use crate::lang::keyword::{Keyword, Row};
use crate::lang::{Container, parse};
use crate::math;
use crate::source::Text;

/// What can be changed about a part.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct PartForm {
    /// Its name.
    pub part: String,
    /// Whether it has a name that a person gave it.
    pub named: bool,
    /// Whether it is a node of the figure: only those have a parent, and a name that others use.
    pub node: bool,
    /// What it hangs on; `None` for nothing.
    pub parent: Option<String>,
    /// What it could hang on, in paint order.
    pub parents: Vec<String>,
    /// Its attributes, in the order of the reference.
    pub fields: Vec<Field>,
    /// The clips of its figure; `None` if it is in none.
    pub motion: Option<MotionForm>,
    /// Where it is in the model; `None` if it has no node there.
    pub place: Option<PlaceForm>,
}

/// An attribute that can be set.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Field {
    /// The keyword.
    pub attribute: &'static str,
    /// One line of the manual.
    pub summary: &'static str,
    /// The manual's page, Markdown.
    pub manual: &'static str,
    /// Its flags and arguments as in a string, variables resolved; `None` if nothing sets it, and the program has no value for it.
    pub value: Option<String>,
    /// `own`, `legend`, `default` or `builtin`.
    pub from: &'static str,
    /// The string that says it.
    pub string: Option<String>,
    /// The other parts for which that string says it, too, if it is a legend.
    pub shared: Vec<String>,
    /// The value without it, in words.
    pub default: &'static str,
    /// The letters that may follow `-`.
    pub flags: Vec<Switch>,
    /// The argument lists to choose from.
    pub variants: Vec<Variant>,
    /// The index of the variant that the value is one of.
    pub chosen: Option<usize>,
}

/// A letter that may follow `-`.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Switch {
    /// The letter.
    pub letter: char,
    /// One line.
    pub summary: &'static str,
    /// Whether the value has it.
    pub on: bool,
}

/// An argument list: a word that is chosen, if it begins with one, and what follows it.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Variant {
    /// The word: a kind of `Shape`, `center`.
    pub word: Option<&'static str>,
    /// One line; empty for lists without a word.
    pub summary: &'static str,
    /// How many arguments may follow the word.
    pub counts: Vec<usize>,
    /// The arguments.
    pub arguments: Vec<ArgumentField>,
}

/// An argument.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ArgumentField {
    /// Its name in the reference.
    pub name: &'static str,
    /// A few words.
    pub summary: &'static str,
    /// What it may be.
    pub takes: Control,
    /// What is written; `None` if it is left out, or another variant is chosen.
    pub value: Option<String>,
}

/// What an argument may be.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(tag = "type", rename_all = "lowercase")]
pub enum Control {
    /// A number.
    Number {
        /// The smallest one; `None` if there is none.
        min: Option<f64>,
        /// The largest one.
        max: Option<f64>,
        /// Where a slider begins.
        low: f64,
        /// Where it ends.
        high: f64,
        /// What it moves by.
        step: f64,
        /// What it is without being written, if that is known.
        start: Option<f64>,
    },
    /// One of a few words, each with a line about it.
    Choice {
        /// The words.
        words: Vec<[&'static str; 2]>,
    },
    /// `#rrggbb`
    Hex,
    /// The name of a colour.
    Color,
    /// A file in the drawing's folder, in quotes.
    File,
    /// Some text, in quotes if it is more than one word.
    Text,
    /// Names, each in quotes if it is more than one word.
    Names,
}

impl PartForm {
    /// The form, in which clips can also play these motion files.
    #[must_use]
    pub fn with_motion_files(mut self, files: Vec<String>) -> Self {
        if let Some(motion) = &mut self.motion {
            motion.files = files;
        }
        self
    }
}

impl Analysis {
    /// What can be changed about a part.
    ///
    /// # Errors
    /// If there is no part of this name, or several.
    pub fn form(&self, name: &str) -> Result<PartForm, Refusal> {
        let index = self.part_to_change(name)?;
        let parts = &self.bindings().parts;
        let part = &parts[index];
        let node = part.kind == PartKind::Main;
        let is_below = |one: PartId| {
            let above = std::iter::successors(Some(one), |part| parts[*part].parent);
            // Parents may be in a circle, which is an error of the drawing.
            above.take(parts.len()).any(|above| above == index)
        };
        let others = parts.iter_enumerated().filter(|(other, found)| {
            found.kind == PartKind::Main && !found.name.is_empty() && !is_below(*other)
        });
        let parent = part.parent.map(|parent| parts[parent].name.clone());
        Ok(PartForm {
            part: name.to_owned(),
            named: !part.is_automatic(),
            node,
            parent: parent.filter(|_| node),
            parents: match node {
                true => others.map(|(_, found)| found.name.clone()).collect(),
                false => vec![],
            },
            fields: match part.kind {
                PartKind::Main | PartKind::Sub | PartKind::Legend => self.fields(index),
                _ => vec![],
            },
            motion: self.motion_form(index),
            place: self.place_form(index),
        })
    }

    fn fields(&self, index: PartId) -> Vec<Field> {
        let bindings = self.bindings();
        let resolved = bindings.resolved(self.drawing(), index);
        let keywords = Keyword::built().filter(|keyword| can_set(*keyword));
        let field = |keyword: Keyword| {
            let found = resolved.iter().find(|one| one.keyword == keyword);
            let said = found.map(|one| Said {
                value: one.value.clone(),
                from: one.from.name(),
                string: one.string,
            });
            let is_legend = found.is_some_and(|one| one.from == crate::bind::SetBy::Legend);
            let legend = bindings.parts[index].legend.filter(|_| is_legend);
            let alike = bindings.parts.iter_enumerated().filter(|(other, part)| {
                legend.is_some()
                    && part.legend == legend
                    && *other != index
                    && matches!(part.kind, PartKind::Main | PartKind::Sub)
            });
            let shared = alike.map(|(other, _)| bindings.describe(self.drawing(), other));
            let shared = shared.collect();
            Field {
                shared,
                ..self.field(index, keyword, said)
            }
        };
        keywords.map(field).collect()
    }

    /// An attribute of a part, or of the clips of its figure, with the value that is said.
    pub(super) fn field(&self, index: PartId, keyword: Keyword, said: Option<Said>) -> Field {
        let row = keyword.row();
        let attribute = said.as_ref().and_then(|said| read(keyword, &said.value));
        let mut variants = variants(row);
        let written: Vec<&str> = attribute
            .iter()
            .flat_map(|(one, text)| words(one, text))
            .collect();
        let chosen = attribute
            .as_ref()
            .and_then(|(one, _)| chosen(&variants, &one.arguments));
        let fields = variants.iter_mut().enumerate().map(|(at, variant)| {
            let is_chosen = chosen == Some(at);
            let skipped = usize::from(variant.word.is_some());
            self.filled(index, keyword, variant, |argument| {
                let value = written.get(skipped + argument).filter(|_| is_chosen);
                value.map(|value| (*value).to_owned())
            })
        });
        let variants = fields.collect();
        let string = said.as_ref().and_then(|said| said.string);
        let string = string.map(|string| &self.bindings().strings[string].text);
        Field {
            attribute: keyword.name(),
            summary: row.summary,
            manual: row.long,
            from: said.as_ref().map_or("builtin", |said| said.from),
            value: said.map(|said| said.value),
            string: string.map(|text| text.as_str().trim().to_owned()),
            shared: vec![],
            default: row.default,
            flags: switches(row, attribute.as_ref().map(|(attribute, _)| attribute)),
            variants,
            chosen,
        }
    }

    /// The arguments of a variant with their values and bounds.
    fn filled(
        &self,
        part: PartId,
        keyword: Keyword,
        variant: &Open,
        value: impl Fn(usize) -> Option<String>,
    ) -> Variant {
        let arguments = variant
            .parameters
            .iter()
            .enumerate()
            .map(|(at, parameter)| {
                let value = value(at);
                let takes = match &parameter.takes {
                    Takes::Number(bounds) => {
                        let start = self.start(part, keyword, variant.word, at);
                        let now = value.as_ref().and_then(|value| value.parse().ok());
                        self.slider(part, *bounds, start, now)
                    }
                    Takes::Choice(words) => Control::Choice {
                        words: words.iter().map(|word| [word.name, word.summary]).collect(),
                    },
                    Takes::Hex => Control::Hex,
                    Takes::ColorName => Control::Color,
                    Takes::File => Control::File,
                    Takes::Names => Control::Names,
                    Takes::Kind | Takes::SignedAxis | Takes::Text | Takes::Variable => {
                        Control::Text
                    }
                };
                ArgumentField {
                    name: parameter.name,
                    summary: parameter.summary,
                    takes,
                    value,
                }
            });
        Variant {
            word: variant.word,
            summary: variant.summary,
            counts: variant.counts.clone(),
            arguments: arguments.collect(),
        }
    }

    /// The number that an argument has without being written, if that can be told.
    fn start(&self, index: PartId, keyword: Keyword, word: Option<&str>, at: usize) -> Option<f64> {
        let part = &self.bindings().parts[index];
        let drawing = self.drawing();
        let half = part.measure.half_across.min(part.measure.half_along);
        let found = match (keyword, word.and_then(kinds::from_name)) {
            (Keyword::Shape, Some(kind)) => match kind.numbers.get(at) {
                Some(number) => *number,
                None if kind.name == "default" => {
                    let depth = plate_depth(drawing);
                    if at == 0 { -depth } else { depth }
                }
                None => half,
            },
            (Keyword::Axis, _) => {
                let axis = part.node_measure().axis;
                math::atan2(-axis.y, axis.x).to_degrees()
            }
            (Keyword::Origin, None) => part.origin.to_array()[at.min(1)],
            (Keyword::Alpha, _) => self.bindings().material_factors(drawing, index).color[3],
            _ => {
                let default = keyword.row().default;
                default.split([' ', ';']).nth(at)?.parse().ok()?
            }
        };
        found.is_finite().then(|| rounded(found))
    }

    /// A number's bounds, and those of a slider in which the present value is, too.
    pub(super) fn slider(
        &self,
        index: PartId,
        bounds: Bounds,
        start: Option<f64>,
        now: Option<f64>,
    ) -> Control {
        let part = &self.bindings().parts[index];
        let measure = part.node_measure();
        let (corner, size) = self.drawing().page;
        let (low, high) = match bounds.usual {
            Usual::Between(low, high) => (low, high),
            Usual::Across => (corner.x, corner.x + size.x),
            Usual::Down => (corner.y, corner.y + size.y),
            Usual::Length => {
                let most = nice(2.0 * measure.half_along.max(measure.half_across));
                (if bounds.min < 0.0 { -most } else { 0.0 }, most)
            }
        };
        let known = [start, now]
            .into_iter()
            .flatten()
            .filter(|one| one.is_finite());
        let low = known.clone().fold(low, f64::min).max(bounds.min);
        let high = known.fold(high, f64::max).min(bounds.max);
        let step = match bounds.restriction {
            Restriction::Integer => 1.0,
            _ => nice((high - low) / 400.0),
        };
        let low = match bounds.restriction {
            Restriction::MinExclusive => low.max(bounds.min + step),
            _ => low,
        };
        Control::Number {
            min: Some(bounds.min).filter(|min| min.is_finite()),
            max: Some(bounds.max).filter(|max| max.is_finite()),
            low,
            high,
            step,
            start,
        }
    }
}

/// What is said of an attribute.
pub(super) struct Said {
    /// Its flags and arguments, variables resolved.
    pub value: String,
    /// As [`Field::from`].
    pub from: &'static str,
    /// The string that says it.
    pub string: Option<StringId>,
}

/// The flags of a keyword, as an attribute has them.
pub(super) fn switches(row: &'static Row, attribute: Option<&Attribute>) -> Vec<Switch> {
    let has = |letter: char| {
        let flags = attribute.iter().flat_map(|attribute| &attribute.flags);
        flags
            .into_iter()
            .any(|(flag, _)| flag.eq_ignore_ascii_case(&letter))
    };
    let flags = row.flags.iter().map(|flag| Switch {
        letter: flag.letter,
        summary: flag.summary,
        on: has(flag.letter),
    });
    flags.collect()
}

/// An argument list of the table.
struct Open {
    word: Option<&'static str>,
    summary: &'static str,
    counts: Vec<usize>,
    parameters: &'static [Parameter],
}

/// The argument lists of a keyword; words to choose from, and kinds of `Shape`, are lists of their own.
fn variants(row: &'static Row) -> Vec<Open> {
    let list = |word, summary, form: &Form, skipped: usize| Open {
        word,
        summary,
        counts: form
            .counts
            .iter()
            .map(|count| count.saturating_sub(skipped))
            .collect(),
        parameters: form.parameters.get(skipped..).unwrap_or_default(),
    };
    let mut found = vec![];
    for form in row.forms {
        match form.parameters.first().map(|first| &first.takes) {
            Some(Takes::Kind) => {
                found.extend(
                    KINDS
                        .iter()
                        .map(|kind| list(Some(kind.name), kind.summary, &kind.form, 0)),
                );
            }
            Some(Takes::Choice(words)) => {
                let words = words.iter();
                found.extend(words.map(|word| list(Some(word.name), word.summary, form, 1)));
            }
            _ => found.push(list(None, "", form, 0)),
        }
    }
    found
}

/// The attribute that a value is of, and the text that its ranges are of.
fn read(keyword: Keyword, value: &str) -> Option<(Attribute, String)> {
    let text = format!("${} {value}", keyword.name());
    let (annotation, _) = parse(&Text::plain(text.trim_end(), 0), Container::Text);
    Some((annotation.attributes().first()?.clone(), text))
}

fn words<'a>(attribute: &'a Attribute, text: &'a str) -> impl Iterator<Item = &'a str> {
    let arguments = attribute.arguments.iter();
    arguments.map(|argument| &text[argument.range.clone()])
}

/// The variant that arguments are of.
fn chosen(variants: &[Open], arguments: &[Argument]) -> Option<usize> {
    let first = arguments.first().map(|argument| &argument.kind);
    if let Some(ArgumentKind::Word(word)) = first {
        let by_word = |one: &Open| one.word.is_some_and(|own| own.eq_ignore_ascii_case(word));
        if let Some(found) = variants.iter().position(by_word) {
            return Some(found);
        }
    }
    let fits = |variant: &Open| {
        let takes = variant.parameters.first().map(|parameter| &parameter.takes);
        variant.word.is_none()
            && match (takes, first) {
                (None, None) => true,
                (
                    Some(Takes::Number(_)),
                    Some(ArgumentKind::Number(_) | ArgumentKind::Expression(_)),
                ) => true,
                (Some(Takes::Number(_)), None) => variant.counts.contains(&0),
                (Some(Takes::Hex), Some(ArgumentKind::Hex(_))) => true,
                (
                    Some(Takes::ColorName | Takes::Text | Takes::Names | Takes::File),
                    Some(ArgumentKind::Word(_) | ArgumentKind::Quoted(_)),
                ) => true,
                _ => false,
            }
    };
    variants.iter().position(fits)
}

/// A number with as many digits as one can see.
fn rounded(number: f64) -> f64 {
    (number * 100.0).round() / 100.0
}

/// The next number from 1, 2 and 5 times a power of ten.
fn nice(number: f64) -> f64 {
    if !(number.is_finite() && number > 0.0) {
        return 1.0;
    }
    let power = 10f64.powi(math::log10(number).floor() as i32);
    let digit = [1.0, 2.0, 5.0]
        .into_iter()
        .find(|digit| number <= digit * power * (1.0 + 1e-9));
    digit.unwrap_or(10.0) * power
}
