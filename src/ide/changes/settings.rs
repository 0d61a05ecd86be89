//! Sets attributes, and takes them away.

use std::ops::Range;

use super::strings::{Means, Piece, writable};
use super::{Analysis, Change, Place, Refusal, can_set, described};
use crate::bind::{PartId, PartKind, StringId};
use crate::diagnostic::{Edit, Severity};
use crate::lang::ast::{Annotation, Argument, ArgumentKind, Attribute};
use crate::lang::keyword::Keyword;
use crate::lang::{Container, Variables, parse, settings, solved};
use crate::source::Text;

/// An attribute as it is to be.
pub(super) struct Wanted {
    /// Its flags and arguments.
    pub words: String,
    /// The same as they are compared: with spaces in order, variables replaced.
    value: String,
    /// Its syntax tree; ranges are those of `$Keyword words`.
    attribute: Attribute,
}

/// Refuses attributes that no change can set.
fn settable(keyword: Keyword) -> Result<(), Refusal> {
    if can_set(keyword) {
        return Ok(());
    }
    Err(Refusal::new(format!(
        "`{}` is more than an attribute of one part: change it in the drawing",
        keyword.name()
    )))
}

impl Analysis {
    pub(super) fn set(
        &self,
        name: &str,
        keyword: Keyword,
        value: &str,
        place: Place,
    ) -> Result<Vec<Edit>, Refusal> {
        settable(keyword)?;
        let part = self.part_to_change(name)?;
        let found = &self.bindings().parts[part];
        if !matches!(
            found.kind,
            PartKind::Main | PartKind::Sub | PartKind::Legend
        ) {
            return Err(Refusal::new(format!(
                "`{name}` is {}: attributes of its own have no effect",
                described(found.kind)
            )));
        }
        let wanted = self.wanted(keyword, value)?;
        let change = |place| Change::Set {
            part: name.to_owned(),
            attribute: keyword,
            value: value.to_owned(),
            place,
        };
        if keyword == Keyword::Shape && self.bindings().is_first_look && place == Place::Ask {
            return Err(first_look().or(
                format!("Give `{name}` this `Shape`, and make plates of the others"),
                change(Place::Own),
            ));
        }
        if place == Place::Legend || found.kind == PartKind::Legend {
            let legend = self.legend_with(part, keyword)?;
            return self.write(legend, keyword, &wanted, place, &change);
        }
        let inherited = self.bindings().inherited(part, keyword);
        let own = found.string.filter(|string| {
            let attributes = self.bindings().strings[*string].annotation.attributes();
            attributes.iter().any(|one| one.keyword == keyword)
        });
        if let Some(inherited) = &inherited
            && inherited.setting.text == wanted.value
        {
            return match own {
                // What the part would have anyway need not be said.
                Some(_) => self.reset(name, keyword, place),
                None => Ok(vec![]),
            };
        }
        let shared = found.legend.map_or(0, |legend| self.painted(legend));
        if own.is_none() && place == Place::Ask && shared > 1 {
            let from_legend = inherited.filter(|source| source.from == crate::bind::SetBy::Legend);
            if let Some(source) = from_legend {
                return Err(Refusal::new(format!(
                    "`{}` of `{name}` comes from the legend `{}`, which {shared} parts share",
                    keyword.name(),
                    self.bindings().strings[source.string].text.as_str().trim()
                ))
                .or(
                    format!("Change the legend for all {shared}"),
                    change(Place::Legend),
                )
                .or(
                    format!("Give `{name}` its own `{}`", keyword.name()),
                    change(Place::Own),
                ));
            }
        }
        match found.string {
            Some(string) => self.write(string, keyword, &wanted, place, &change),
            None => self.given(part, &format!("{} {}", keyword.name(), wanted.words)),
        }
    }

    pub(super) fn reset(
        &self,
        name: &str,
        keyword: Keyword,
        place: Place,
    ) -> Result<Vec<Edit>, Refusal> {
        settable(keyword)?;
        let part = self.part_to_change(name)?;
        let Some(index) = self.bindings().parts[part].string else {
            return Ok(vec![]);
        };
        let string = &self.bindings().strings[index];
        let attributes = string.annotation.attributes();
        if !attributes.iter().any(|one| one.keyword == keyword) {
            return Ok(vec![]);
        }
        let all = self.bindings().strings.iter();
        let shapes = all.flat_map(|string| string.annotation.attributes());
        let shapes = shapes.filter(|attribute| attribute.keyword == Keyword::Shape);
        let here = attributes.iter().filter(|one| one.keyword == keyword);
        if keyword == Keyword::Shape && place == Place::Ask && shapes.count() == here.count() {
            let why = "no other string says `Shape`: without this one, round parts are inflated, and lines are tubes";
            return Err(Refusal::new(why).or(
                "Take it away all the same",
                Change::Reset {
                    part: name.to_owned(),
                    attribute: keyword,
                    place: Place::Own,
                },
            ));
        }
        let pieces = without(&string.annotation, |at| attributes[at].keyword == keyword);
        self.rewritten(index, &pieces, Means::Attribute(keyword))
    }

    /// Reads the value that an attribute is to have.
    pub(super) fn wanted(&self, keyword: Keyword, value: &str) -> Result<Wanted, Refusal> {
        writable(value)?;
        let words = value.split_whitespace().collect::<Vec<_>>().join(" ");
        let string = format!("${} {words}", keyword.name());
        let text = Text::plain(string.trim_end(), 0);
        let (annotation, mut found) = parse(&text, Container::Text);
        let read = settings(&text, &annotation, &self.bindings().variables, &mut found);
        let mut severe = found.iter();
        if let Some(found) = severe.find(|found| found.severity() != Severity::Hint) {
            return Err(Refusal::new(found.message.clone()));
        }
        match (annotation.attributes(), read.as_slice()) {
            ([attribute], [setting]) if attribute.range.end == text.as_str().len() => Ok(Wanted {
                words,
                value: setting.text.clone(),
                attribute: attribute.clone(),
            }),
            _ => Err(Refusal::new(format!(
                "`{words}` is more than one value of `{}`",
                keyword.name()
            ))),
        }
    }

    /// Writes an attribute into a string: in its place if it is there, else at the end.
    fn write(
        &self,
        index: StringId,
        keyword: Keyword,
        wanted: &Wanted,
        place: Place,
        change: &dyn Fn(Place) -> Change,
    ) -> Result<Vec<Edit>, Refusal> {
        let string = &self.bindings().strings[index];
        let text = string.text.as_str();
        let attributes = string.annotation.attributes();
        let mut same = attributes.iter().filter(|one| one.keyword == keyword);
        let pieces = match (same.next(), same.next()) {
            (Some(attribute), None) => self.changed(text, attribute, wanted, place, change)?,
            (Some(_), Some(_)) => {
                return Err(Refusal::new(format!(
                    "`{}` says `{}` several times: take all but one away first",
                    text.trim(),
                    keyword.name()
                )));
            }
            (None, _) => vec![self.appended(index, keyword, &wanted.words)?],
        };
        self.rewritten(index, &pieces, Means::Attribute(keyword))
    }

    /// The pieces of an attribute that differ from what is wanted.
    pub(super) fn changed(
        &self,
        text: &str,
        attribute: &Attribute,
        wanted: &Wanted,
        place: Place,
        change: &dyn Fn(Place) -> Change,
    ) -> Result<Vec<Piece>, Refusal> {
        let variables = &self.bindings().variables;
        let old = &attribute.arguments;
        let new = &wanted.attribute.arguments;
        let source = format!("${} {}", attribute.keyword.name(), wanted.words);
        let written = |argument: &Argument| source[argument.range.clone()].to_owned();
        let flags = |attribute: &Attribute| {
            let letters = attribute.flags.iter();
            letters
                .map(|(letter, _)| letter.to_ascii_lowercase())
                .collect::<String>()
        };
        let mut pieces = vec![];
        let is_flagged = flags(attribute) != flags(&wanted.attribute);
        if is_flagged {
            let end = attribute.flags.last().map(|(_, range)| range.end);
            let range = attribute.keyword_range.end..end.unwrap_or(attribute.keyword_range.end);
            let flags = flags(&wanted.attribute);
            let flags = if flags.is_empty() {
                flags
            } else {
                format!(" -{flags}")
            };
            pieces.push((range, flags));
        }
        let is_same = |(old, new): (&Argument, &Argument)| same(old, new, variables);
        if old.len() == new.len() {
            for (old, new) in old.iter().zip(new) {
                if is_same((old, new)) {
                    continue;
                }
                if place == Place::Ask && is_calculated(old, variables) {
                    return Err(self.calculated(text, old, new, change));
                }
                pieces.push((old.range.clone(), written(new)));
            }
            return Ok(pieces);
        }
        let kept = old
            .iter()
            .zip(new)
            .take_while(|pair| is_same(*pair))
            .count();
        if let Some(lost) = old[kept..].iter().find(|old| is_calculated(old, variables))
            && place == Place::Ask
        {
            return Err(Refusal::new(format!(
                "`{}` is calculated, and would be replaced",
                &text[lost.range.clone()]
            ))
            .or("Replace it here", change(Place::Own)));
        }
        let last = attribute
            .flags
            .last()
            .map_or(&attribute.keyword_range, |(_, range)| range);
        let before = kept.checked_sub(1).map_or(last, |last| &old[last].range);
        let rest: Vec<String> = new[kept..].iter().map(written).collect();
        let rest: String = rest.iter().map(|word| format!(" {word}")).collect();
        pieces.push((before.end..attribute.range.end.max(before.end), rest));
        Ok(joined(pieces))
    }

    /// Refuses to replace a calculation without a word.
    fn calculated(
        &self,
        text: &str,
        old: &Argument,
        new: &Argument,
        change: &dyn Fn(Place) -> Change,
    ) -> Refusal {
        let written = &text[old.range.clone()];
        let mut refusal = Refusal::new(format!("`{written}` is calculated, and would be replaced"));
        let target = self.bindings().variables.value(new);
        let names = variables_of(old);
        if let (Some(target), [name]) = (target, names.as_slice())
            && let Some(value) = solved(old, name, target, &self.bindings().variables)
            && self.is_variable(name)
        {
            let value = (value * 1e4).round() / 1e4;
            let uses = self.uses(&super::super::Symbol::Variable((*name).to_owned()));
            let others = uses.iter().filter(|found| !found.defines).count();
            let whom = match others {
                1 => "is used here alone".to_owned(),
                count => format!("is used {count} times"),
            };
            refusal = refusal.or(
                format!("Change `{name}` to {value}, which {whom}"),
                Change::Variable {
                    name: (*name).to_owned(),
                    value,
                },
            );
        }
        refusal.or("Replace it here", change(Place::Own))
    }

    /// Where a new attribute goes in a string, and how.
    pub(super) fn appended(
        &self,
        index: StringId,
        keyword: Keyword,
        words: &str,
    ) -> Result<Piece, Refusal> {
        let string = &self.bindings().strings[index];
        let text = string.text.as_str();
        let end = text.trim_end().len();
        let attribute = format!("{} {words}", keyword.name());
        let attribute = attribute.trim_end();
        let last = string.annotation.attributes().last();
        let is_open = |sign: &Range<usize>| text[sign.end..end].trim().is_empty();
        match (&string.annotation, last) {
            (Annotation::Part(_) | Annotation::Legend(_), Some(last)) if last.range.end == end => {
                Ok((end..end, format!(" {attribute}")))
            }
            (Annotation::Part(part), None) => match part.signs.last() {
                Some(sign) if is_open(sign) && text[sign.clone()].starts_with(['$', '＄']) => {
                    Ok((sign.end..sign.end, attribute.to_owned()))
                }
                _ => Ok((end..end, format!("${attribute}"))),
            },
            _ => Err(Refusal::new(format!(
                "`{}` cannot be read to its end: correct it first",
                text.trim()
            ))),
        }
    }

    /// The string of the legend that says an attribute of a part, or that it could say it in.
    fn legend_with(&self, part: PartId, keyword: Keyword) -> Result<StringId, Refusal> {
        let found = &self.bindings().parts[part];
        let own = found.string.filter(|_| found.kind == PartKind::Legend);
        let legend = found.legend.map(|legend| &self.bindings().legends[legend]);
        let said = legend.and_then(|legend| {
            let mut settings = legend.settings.iter();
            let said = settings.find(|(_, setting)| setting.keyword == keyword);
            said.or(legend.settings.first()).map(|(string, _)| *string)
        });
        own.or(said)
            .ok_or_else(|| Refusal::new("there is no legend for this paint"))
    }

    /// How many parts have a legend.
    fn painted(&self, legend: usize) -> usize {
        let parts = self.bindings().parts.iter();
        let alike = parts.filter(|part| {
            matches!(part.kind, PartKind::Main | PartKind::Sub) && part.legend == Some(legend)
        });
        alike.count()
    }

    pub(super) fn set_variable(&self, name: &str, value: f64) -> Result<Vec<Edit>, Refusal> {
        let mut found = None;
        for (index, string) in self.bindings().strings.iter_enumerated() {
            for attribute in string.annotation.attributes() {
                let is_it = attribute.keyword == Keyword::Let
                    && matches!(attribute.arguments.first(), Some(Argument { kind: ArgumentKind::Word(word), .. }) if word == name);
                if let Some(argument) = attribute.arguments.get(1).filter(|_| is_it) {
                    // Of several definitions the last one counts.
                    found = Some((index, argument));
                }
            }
        }
        let Some((index, argument)) = found else {
            return Err(Refusal::new(format!("there is no variable `{name}`")));
        };
        if !value.is_finite() {
            return Err(Refusal::new("a variable is a number"));
        }
        if !matches!(argument.kind, ArgumentKind::Number(_)) {
            let text = &self.bindings().strings[index].text.as_str()[argument.range.clone()];
            return Err(Refusal::new(format!(
                "`{name}` is `{text}`, which is calculated: change it in the drawing"
            )));
        }
        let pieces = [(argument.range.clone(), value.to_string())];
        self.rewritten(index, &pieces, Means::Attribute(Keyword::Let))
    }
}

fn first_look() -> Refusal {
    Refusal::new(
        "no string says `Shape` yet, so round parts are inflated and lines are tubes; with the first `Shape` the others become plates",
    )
}

/// The pieces of a string that take attributes away, each given by its number.
pub(super) fn without(annotation: &Annotation, goes: impl Fn(usize) -> bool) -> Vec<Piece> {
    let attributes = annotation.attributes();
    let first = (0..attributes.len()).find(|at| !goes(*at));
    let mut pieces: Vec<Piece> = vec![];
    for (at, attribute) in attributes.iter().enumerate() {
        if !goes(at) {
            continue;
        }
        let (start, end) = match (at.checked_sub(1), first) {
            (_, Some(first)) if at < first => (
                attribute.range.start,
                attributes[at + 1].keyword_range.start,
            ),
            (Some(before), _) => (attributes[before].range.end, attribute.range.end),
            (None, _) => (attribute.range.start, attribute.range.end),
        };
        let start = match annotation {
            Annotation::Part(part) if first.is_none() && at == 0 => {
                let head = part.parent.as_ref().or(part.name.as_ref());
                head.map_or(start, |head| head.range.end)
            }
            _ => start,
        };
        pieces.push((start..end, String::new()));
    }
    joined(pieces)
}

/// Pieces that touch each other as one.
pub(super) fn joined(pieces: Vec<Piece>) -> Vec<Piece> {
    let mut out: Vec<Piece> = vec![];
    for (range, text) in pieces {
        match out.last_mut() {
            Some((last, before)) if last.end >= range.start => {
                last.end = last.end.max(range.end);
                before.push_str(&text);
            }
            _ => out.push((range, text)),
        }
    }
    out
}

/// Whether two arguments mean the same.
fn same(old: &Argument, new: &Argument, variables: &Variables) -> bool {
    let number = |argument: &Argument| match &argument.kind {
        ArgumentKind::Number(_) | ArgumentKind::Expression(_) | ArgumentKind::Word(_) => {
            variables.value(argument)
        }
        _ => None,
    };
    match (&old.kind, &new.kind) {
        (ArgumentKind::Word(old), ArgumentKind::Word(new)) => old.eq_ignore_ascii_case(new),
        (ArgumentKind::Hex(old), ArgumentKind::Hex(new)) => old.eq_ignore_ascii_case(new),
        (ArgumentKind::Quoted(old) | ArgumentKind::Word(old), ArgumentKind::Quoted(new)) => {
            old == new
        }
        _ => match (number(old), number(new)) {
            (Some(old), Some(new)) => old == new,
            _ => false,
        },
    }
}

/// Whether an argument is a calculation, or a variable that is defined.
fn is_calculated(argument: &Argument, variables: &Variables) -> bool {
    match &argument.kind {
        ArgumentKind::Expression(_) => true,
        ArgumentKind::Word(word) => variables.get(word).is_some(),
        _ => false,
    }
}

/// The variables of an argument, each once.
fn variables_of(argument: &Argument) -> Vec<&str> {
    let mut names: Vec<&str> = vec![];
    match &argument.kind {
        ArgumentKind::Word(word) => names.push(word),
        ArgumentKind::Expression(expression) => {
            expression.variables(&mut |name| names.push(&name.text));
        }
        _ => {}
    }
    names.sort_unstable();
    names.dedup();
    names
}
