//! Hover: a description of the item at an offset.

use std::fmt::Write as _;

use super::at::{At, Found, Item, attributes};
use super::subject::bound_by;
use super::{Analysis, Subject, Symbol, Which};
use crate::bind::{BoundBy, LayerId, NamedBy, PartId, PartKind, SetBy, StringId};
use crate::lang::ast::{Annotation, ArgumentKind};
use crate::lang::keyword::signature::Takes;
use crate::lang::keyword::{Keyword, kinds};
use crate::lang::{ParameterRef, explain, parameter_at};
use crate::source::Span;

/// The most parts that are named; the rest is only counted.
const MAX_NAMED: usize = 8;
/// The most generations of ancestors that are named.
const MAX_ANCESTORS: usize = 12;
/// What a feature point is.
const FEATURE: &str = "A feature point: between the views of a character, this place of a region's outline goes to the one with the same name.";

/// A hover.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Hover {
    /// The span that it describes.
    pub span: Span,
    /// The description, in Markdown.
    pub markdown: String,
}

impl Analysis {
    /// The hover at byte `offset`: the problems there, then a string's part, a keyword's manual page, a number's meaning, or a
    /// shape's part. It has no headings, which editors show in the size of a page's.
    pub fn hover(&self, offset: usize) -> Option<Hover> {
        let (span, markdown) = match (self.problems_at(offset), self.card_at(offset)) {
            (Some((_, problems)), Some((span, card))) => {
                (span, format!("{problems}\n---\n\n{card}"))
            }
            (problems, card) => problems.or(card)?,
        };
        let markdown = explain::without_headings(&markdown);
        Some(Hover { span, markdown })
    }

    /// What is at an offset, and its description.
    fn card_at(&self, offset: usize) -> Option<(Span, String)> {
        let at = self.at(offset)?;
        let card = match &at.found {
            Found::Tag { shape } => {
                let content = self.tiles_card(*shape);
                let content = content.or_else(|| self.picture_card(*shape));
                content.or_else(|| Some(self.part_card(at.part?)))
            }
            Found::String { string, token, .. } => match token {
                None => self.string_card(*string, &at),
                Some(token) => self.token_card(*string, token.item, offset, &at),
            },
        };
        Some((at.span, card?))
    }

    fn token_card(
        &self,
        string: StringId,
        item: Item,
        offset: usize,
        at: &At<'_>,
    ) -> Option<String> {
        let annotation = &self.bindings().strings[string].annotation;
        let attribute = |index: usize| &attributes(annotation)[index];
        match item {
            Item::Sign | Item::Name | Item::Remark => self.string_card(string, at),
            Item::Parent => {
                let Annotation::Part(part) = annotation else {
                    return None;
                };
                let name = &part.parent.as_ref()?.text;
                let unknown = || Some(format!("There is no part named `{name}`."));
                let card = at.meant.and_then(|meant| self.subject_card(meant));
                card.or_else(unknown)
            }
            Item::Feature => Some(FEATURE.to_owned()),
            Item::Keyword(index) => {
                let keyword = attribute(index).keyword;
                let manual = explain::keyword(keyword);
                let card = match keyword {
                    Keyword::View => self.view_card(string),
                    _ => self.motion_card(string, index),
                };
                Some(below(card, &manual))
            }
            Item::Flag(index, flag) => {
                let (letter, _) = attribute(index).flags[flag];
                let mut flags = attribute(index).keyword.row().flags.iter();
                let known = flags.find(|known| known.letter.eq_ignore_ascii_case(&letter))?;
                Some(format!("`-{}`: {}", known.letter, known.summary))
            }
            Item::Argument(index, argument) => {
                let attribute = attribute(index);
                let slot = parameter_at(attribute, argument, &|name| self.is_variable(name))?;
                if attribute.keyword == Keyword::Bone
                    && let ArgumentKind::Word(name) | ArgumentKind::Quoted(name) =
                        &attribute.arguments[argument].kind
                    && let Some(card) = self.joint_card(string, name)
                {
                    return Some(card);
                }
                if let Some(meant) = at.meant {
                    return self.subject_card(meant);
                }
                let card = self.argument_card(string, (index, argument), slot, offset)?;
                let has_clips = matches!(
                    attribute.keyword,
                    Keyword::Motion
                        | Keyword::Limited
                        | Keyword::Held
                        | Keyword::Perform
                        | Keyword::Pose
                        | Keyword::Mark
                );
                let motion = has_clips.then(|| self.motion_card(string, index)).flatten();
                Some(below(motion, &card))
            }
        }
    }

    fn argument_card(
        &self,
        string: StringId,
        (index, argument): (usize, usize),
        slot: ParameterRef,
        offset: usize,
    ) -> Option<String> {
        let bindings = self.bindings();
        let given = &attributes(&bindings.strings[string].annotation)[index].arguments[argument];
        let parameter = slot.parameter();
        let usage = match slot.kind {
            Some(kind) => format!("Shape {}", kind.usage()),
            None => format!("{} {}", slot.owner, slot.form.print()),
        };
        let mut out = match (&parameter.takes, &given.kind) {
            (Takes::Kind, ArgumentKind::Word(word)) => {
                return Some(explain::kind(kinds::from_name(word)?));
            }
            (Takes::Choice(words), ArgumentKind::Word(word)) => {
                let mut words = words.iter();
                let word = words.find(|known| known.name.eq_ignore_ascii_case(word))?;
                format!("`{}`: {}", word.name, word.summary)
            }
            (Takes::Names, ArgumentKind::Word(name) | ArgumentKind::Quoted(name))
                if slot.owner == Keyword::Follow.name() =>
            {
                return self.joint_card(string, name);
            }
            (takes, _) => format!(
                "`{}` of `{}`: {}\n\n*{}*",
                parameter.name,
                slot.owner,
                parameter.summary,
                takes.describe()
            ),
        };
        if let Some(value) = bindings.variables.value(given)
            && !matches!(given.kind, ArgumentKind::Number(_))
        {
            let _ = write!(out, "\n\nIts value here is {value}.");
        }
        if let Some(variable) = self.variable_card(offset) {
            let _ = write!(out, "\n\n{variable}");
        }
        let _ = write!(out, "\n\n```\n{usage}\n```\n");
        Some(out)
    }

    /// The variable at a byte offset: its value and its `Let`.
    fn variable_card(&self, offset: usize) -> Option<String> {
        let (Symbol::Variable(name), _) = self.symbol_at(offset)? else {
            return None;
        };
        let variables = &self.bindings().variables;
        let (_, variable) = variables.iter().find(|(known, _)| *known == name)?;
        let definition = &self.source[variable.definition.start..];
        let definition = definition.split(['<', '\n']).next().unwrap_or_default();
        let short: String = definition.chars().take(40).collect();
        Some(match variable.value {
            Some(value) => format!("`{name}` is {value}, by `%Let {}`", short.trim_end()),
            None => format!("`{name}` has no value: its `Let` has an error"),
        })
    }

    fn string_card(&self, string: StringId, at: &At<'_>) -> Option<String> {
        match &self.bindings().strings[string].annotation {
            Annotation::Defaults(_) => Some(self.defaults_card(string)),
            Annotation::Legend(_) => Some(self.legend_card(string, at.part?)),
            Annotation::Unused => Some(format!(
                "{} is left out of the model.",
                self.element_of(at.part?)
            )),
            Annotation::Part(_) => match at.part {
                Some(part) => Some(self.part_card(part)),
                None => self
                    .landscape_card(string)
                    .or_else(|| self.view_card(string))
                    .or_else(|| self.named_region_card(string))
                    .or_else(|| Some("This string is not bound to a part.".to_owned())),
            },
            Annotation::Empty
            | Annotation::Comment
            | Annotation::Caption
            | Annotation::Feature(_) => None,
        }
    }

    /// What another string names.
    fn subject_card(&self, subject: Subject<'_>) -> Option<String> {
        match subject.which {
            Which::Part(part) => Some(self.part_card(part)),
            _ => None,
        }
    }

    /// A part: its ancestors, its element and why it is bound to that, and the source of each attribute; the partners of a region.
    pub(super) fn part_card(&self, index: PartId) -> String {
        let bindings = self.bindings();
        let part = &bindings.parts[index];
        let group = self.drawing().shapes[part.shape].group;
        let of = |layer: Option<LayerId>| escaped(layer.map_or("", |at| &bindings.layers[at].name));
        let mut out = match part.kind {
            PartKind::Main => format!("**{}**", escaped(&part.name)),
            PartKind::Sub if part.host.is_some() => {
                let host = part.host.unwrap_or(part.main);
                format!("Ink on {}", bindings.describe(self.drawing(), host))
            }
            PartKind::Sub => {
                let main = bindings.describe(self.drawing(), part.main);
                format!("A solid in the node of {main}")
            }
            PartKind::Legend => "**A legend's sample**, left out of the model".to_owned(),
            PartKind::Unused => "**Left out of the model**".to_owned(),
            PartKind::Tile => format!("**Tiles** of {}", of(bindings.tile_layer_of_group(group))),
            PartKind::Prop if part.is_candidate() => {
                let place = self.place_of_prop(index).unwrap_or_default();
                format!("**{}**, a prop{place}", escaped(&part.name))
            }
            PartKind::Prop => {
                let main = bindings.describe(self.drawing(), part.main);
                format!("A solid of {main}, a prop")
            }
            PartKind::Region => format!("**A region** of {}", of(bindings.view_of_group(group))),
        };
        if part.kind == PartKind::Main {
            let _ = write!(out, "\n\n{}", self.lineage(index));
        }
        let why = match bound_by(&self.compiled, index) {
            None if part.host.is_some() => "a stroke that lies on it",
            None if part.kind != PartKind::Main => "it has no string",
            None => match part.named_by {
                NamedBy::Automatic => "it has no string: its name and parent are automatic",
                NamedBy::Label { .. } => "it has no string: its name is its label",
                NamedBy::Id { .. } => "it has no string: its name is its id",
                NamedBy::String => "it has no string",
            },
            Some(BoundBy::Desc) => "by its description",
            Some(BoundBy::Group) => "by the string that is grouped with it",
            Some(BoundBy::Leader) => "by the string that a line leads to",
            Some(BoundBy::Nearest) => "by the string that is nearest to it",
        };
        let _ = write!(out, "\n\n{}, {why}", self.element_of(index));
        if part.kind.is_solid()
            && let Some(subject) = Subject::of_part(&self.compiled, index)
        {
            // A list, since many editors do not render tables.
            out.push_str("\n\n");
            for attribute in subject.attributes() {
                let from = match attribute.from {
                    SetBy::Own => "its own string",
                    SetBy::Legend => "the legend of its paint",
                    SetBy::Default => "a `%` string",
                    SetBy::Builtin if attribute.keyword == Keyword::Color => "its own fill",
                    SetBy::Builtin => "okoshi",
                };
                let name = attribute.keyword.name();
                let value = attribute.value.replace('`', "'");
                let _ = if value.is_empty() {
                    writeln!(out, "- {name}, from {from}")
                } else {
                    writeln!(out, "- {name} `{value}`, from {from}")
                };
            }
        }
        if part.kind == PartKind::Region
            && let Some(partners) = self.region_card(part.shape)
        {
            let _ = write!(out, "\n\n{partners}");
        }
        if let Some(driven) = self.driven_card(index) {
            let _ = write!(out, "\n{driven}");
        }
        if part.kind == PartKind::Main {
            let parts = bindings.parts.iter_enumerated();
            let children = parts
                .filter(|(_, child)| child.kind == PartKind::Main && child.parent == Some(index));
            if let Some(names) = self.names(children.map(|(child, _)| child).collect()) {
                let _ = write!(out, "\nAttached parts: {names}.");
            }
        }
        out
    }

    /// Where a prop stands: on which landscape, in which cell, how high.
    fn place_of_prop(&self, part: PartId) -> Option<String> {
        let standing = self.compiled.props.get(self.bindings().prop_of(part)?)?;
        let land = escaped(&self.compiled.layers[standing.landscape].name);
        let height = standing.place.point.y;
        Some(match standing.place.cell {
            Some([column, row]) => format!(
                " that stands on {land} at height {}: column {}, row {}",
                (height * 100.0).round() / 100.0,
                column + 1,
                row + 1
            ),
            None => format!(" that stands beside {land} at height 0"),
        })
    }

    /// `Root › Ubody › **Rarm**`
    fn lineage(&self, part: PartId) -> String {
        let parts = &self.bindings().parts;
        let mut names = vec![format!("**{}**", escaped(&parts[part].name))];
        let mut at = part;
        while let Some(parent) = parts[at].parent {
            if names.len() > MAX_ANCESTORS {
                names.push("…".to_owned());
                break;
            }
            names.push(escaped(&parts[parent].name));
            at = parent;
        }
        names.push("Root".to_owned());
        names.reverse();
        names.join(" › ")
    }

    fn element_of(&self, part: PartId) -> String {
        let element = &self.drawing().shapes[self.bindings().parts[part].shape].element;
        let called = element.describe();
        if element.label.is_some() || element.id.is_some() {
            format!("`<{}>` {called}", element.tag)
        } else {
            called
        }
    }

    fn defaults_card(&self, string: StringId) -> String {
        let parts = self.parts_inheriting_from(string);
        let mut out = "Defaults and settings of the whole drawing.".to_owned();
        if let Some(names) = self.names(parts) {
            let _ = write!(out, "\n\nParts that use them: {names}.");
        }
        out
    }

    fn legend_card(&self, string: StringId, part: PartId) -> String {
        let element = self.element_of(part);
        let users = match self.names(self.parts_inheriting_from(string)) {
            Some(names) => format!("Parts that use it: {names}."),
            None => "No part uses it.".to_owned(),
        };
        format!("A legend for all parts that are painted like {element}.\n\n{users}")
    }

    /// The parts that inherit an attribute from a legend or a `%` string.
    fn parts_inheriting_from(&self, string: StringId) -> Vec<PartId> {
        let bindings = self.bindings();
        let keywords = attributes(&bindings.strings[string].annotation);
        let goes_by = |part: &PartId| {
            let is_built = bindings.parts[*part].kind.is_solid();
            is_built
                && keywords.iter().any(|attribute| {
                    let source = bindings.setting(*part, attribute.keyword);
                    source.is_some_and(|source| source.string == string)
                })
        };
        bindings.parts.keys().filter(goes_by).collect()
    }

    fn names(&self, parts: Vec<PartId>) -> Option<String> {
        let name = |part: PartId| self.bindings().describe(self.drawing(), part);
        some_of(parts.into_iter().map(name))
    }
}

/// The first of some names, and how many more there are; `None` without any.
pub(super) fn some_of(names: impl ExactSizeIterator<Item = String>) -> Option<String> {
    let more = names.len().saturating_sub(MAX_NAMED);
    let shown: Vec<_> = names.take(MAX_NAMED).collect();
    match (shown.is_empty(), more) {
        (true, _) => None,
        (_, 0) => Some(shown.join(", ")),
        _ => Some(format!("{} and {more} more", shown.join(", "))),
    }
}

/// A text below a card, if there is one.
fn below(card: Option<String>, text: &str) -> String {
    card.map_or_else(String::new, |card| card + "\n") + text
}

/// A name, escaped for Markdown.
pub(super) fn escaped(name: &str) -> String {
    let mut out = String::with_capacity(name.len());
    for c in name.chars() {
        if c.is_ascii_punctuation() {
            out.push('\\');
        }
        out.push(c);
    }
    out
}

#[cfg(test)]
mod tests {
    use super::super::fixtures::{analysis, figure};

    fn hover(strings: [&str; 5]) -> String {
        let (analysis, at) = analysis(&figure(strings));
        analysis
            .hover(at)
            .map_or(String::new(), |hover| hover.markdown)
    }

    #[test]
    fn hovers_of_strings_describe_the_part() {
        let card = hover([
            "Body",
            "¦Rarm@Body$Shape roundv",
            "Larm@Rarm",
            "$Offset 4",
            "%Smooth 20",
        ]);
        for part in [
            "Root › Body › **Rarm**",
            "`<rect>` `#right`, by the string that is nearest to it",
            "- Shape `roundv`, from its own string",
            "- Offset `4`, from the legend of its paint",
            "- Smooth `20`, from a `%` string",
            "- Color `1 0.8 0.6`, from its own fill",
            "Attached parts: `Larm`.",
        ] {
            assert!(card.contains(part), "{part} is not in:\n{card}");
        }
    }

    #[test]
    fn hovers_of_words_describe_them() {
        for (string, expected) in [
            ("Rarm@Body$Sha¦pe roundv", "**Shape**\n"),
            ("Rarm@Body$Shape ro¦undv", "**Shape roundv**\n"),
            (
                "Rarm@Body$Shape roundv -9¦0 90",
                "`a0` of `roundv`: where the rounding begins",
            ),
            ("Rarm@Body$Shape -¦d round", "`-d`: a second, mirrored copy"),
            ("Rarm@Body$Origin st¦art", "`start`: the end point nearer"),
            ("Rarm@Body$Motion wa¦lk", "`walk`: a walk; on four legs"),
            ("Rarm@Body$Motion -¦i run", "`-i`: in place"),
            (
                "Rarm@Body$Motion run 1 spe¦ed 2",
                "`speed`: how fast it plays",
            ),
            (
                "Rarm@Body$Motion run 1¦2 walk 2",
                "`seconds` of `Motion`: how long it plays",
            ),
            (
                "Rarm@Body$Motion run 1 wa¦lk 2",
                "`walk`: a walk; on four legs",
            ),
            ("Rarm@Body$Offset ¦w", "`w` is 12, by `%Let w 12`"),
            ("Rarm@Body$Offset (w * ¦2)", "Its value here is 24."),
            ("Rarm@Bo¦dy", "**Body**"),
            ("Rarm@No¦body", "There is no part named `Nobody`."),
            ("*¦ Rarm", "is left out"),
            (
                "Rarm@No¦body",
                "**E204: unknown parent**\n\nNo part of this",
            ),
            ("Rarm@Body$Sh¦ap round", "too many.\n\nWrite `Shape`.\n"),
        ] {
            let card = hover(["Body", string, "", "", "%Let w 12"]);
            assert!(
                card.contains(expected),
                "{string}: {expected} is not in:\n{card}"
            );
        }
    }

    #[test]
    fn hovers_of_legends_and_defaults_name_the_inheriting_parts() {
        let legend = hover(["Body", "Rarm@Body", "Larm@Body", "¦$Offset 4", ""]);
        assert!(
            legend.contains("Parts that use it: `Rarm`, `Larm`."),
            "{legend}"
        );
        let defaults = hover(["Body", "Rarm@Body", "", "", "¦%Offset 4"]);
        assert!(defaults.contains("`Body`"), "{defaults}");
        assert_eq!(hover(["Body", "¦# note", "", "", ""]), "");
    }
}
