//! Definitions, references and highlights.

use std::ops::Range;

use super::at::{At, Found, Item, attributes};
use super::subject::span_of_shape;
use super::{Analysis, Symbol, Which};
use crate::bind::{PartId, SetBy, StringId};
use crate::lang::ast::{ArgumentKind, Attribute};
use crate::lang::keyword::Keyword;
use crate::lang::keyword::signature::Takes;
use crate::lang::parameter_at;
use crate::source::Span;

/// The target of a definition.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Target {
    /// A span in this drawing.
    Here(Span),
    /// A linked file, as the drawing names it.
    File(String),
}

impl Analysis {
    /// The span at byte `offset` and its definitions: a parent leads to its string, a part's name to its shape, a shape's tag to
    /// its string, a variable to its `Let`, a keyword to the legend or default that it overrides, a file's
    /// name to the file. The name of a region leads to its partners in the other views of the character, and so does the tag
    /// of a region without a string; the string of a view leads to those of the other views.
    pub fn definition(&self, offset: usize) -> Option<(Span, Vec<Target>)> {
        let at = self.at(offset)?;
        let to = match &at.found {
            Found::Tag { shape } => match self.string_of_tag(&at) {
                Some(string) => vec![Target::Here(self.span_of_string(string))],
                None => {
                    let partners = self.partners_of_shape(*shape).into_iter();
                    partners.map(Target::Here).collect()
                }
            },
            Found::String { string, token, .. } => match token.as_ref().map(|token| token.item) {
                None | Some(Item::Name | Item::Sign | Item::Remark) => {
                    self.named_by(*string, at.part)?
                }
                Some(Item::Keyword(index)) => self.overruled(*string, at.part?, index)?,
                Some(Item::Flag(..)) => return None,
                Some(item @ (Item::Parent | Item::Feature | Item::Argument(..))) => {
                    let file = || Some((at.span, vec![self.file(*string, item)?]));
                    return self.defined_at(offset).or_else(file);
                }
            },
        };
        (!to.is_empty()).then_some((at.span, to))
    }

    /// The string of a tag's part or landscape; for a sub-part without one, that of its main part.
    fn string_of_tag(&self, at: &At<'_>) -> Option<StringId> {
        let parts = &self.bindings().parts;
        let own = |part: PartId| parts[part].string.or(parts[parts[part].main].string);
        let landscape = || match at.subject?.which {
            Which::Landscape(_) => at.subject?.string_id(),
            _ => None,
        };
        at.part.and_then(own).or_else(landscape)
    }

    /// The span of the symbol at byte `offset`, and its definitions.
    fn defined_at(&self, offset: usize) -> Option<(Span, Vec<Target>)> {
        let (symbol, found) = self.symbol_at(offset)?;
        let from = self.span_of(&found);
        let mut to: Vec<_> = self
            .uses(&symbol)
            .iter()
            .filter(|other| other.defines)
            .map(|other| Target::Here(self.span_of(other)))
            .collect();
        if let (Symbol::Part(name), true) = (&symbol, to.is_empty()) {
            to.push(Target::Here(self.span_of_part(self.part_named(name)?)));
        }
        (!to.is_empty()).then_some((from, to))
    }

    /// What a string names: in the other views of a character, or else its own shape.
    fn named_by(&self, string: StringId, part: Option<PartId>) -> Option<Vec<Target>> {
        if let Some(others) = self.in_other_views(string) {
            return Some(others);
        }
        let element = &self.drawing().shapes[self.bindings().parts[part?].shape].element;
        Some(vec![Target::Here(element.span)])
    }

    /// The setting of a legend or default that an attribute of a part's own string overrides.
    fn overruled(&self, string: StringId, part: PartId, index: usize) -> Option<Vec<Target>> {
        let keyword = attributes(&self.bindings().strings[string].annotation)[index].keyword;
        let others = self.bindings().inherited(part, keyword)?;
        Some(vec![Target::Here(
            self.setting_span(others.string, &others.setting.range),
        )])
    }

    pub(super) fn setting_span(&self, string: StringId, range: &Range<usize>) -> Span {
        self.bindings().strings[string].text.span(range.clone())
    }

    /// The file that an argument names.
    fn file(&self, string: StringId, item: Item) -> Option<Target> {
        let Item::Argument(attribute, argument) = item else {
            return None;
        };
        let attribute = &attributes(&self.bindings().strings[string].annotation)[attribute];
        file_named(attribute, argument).map(|name| Target::File(name.to_owned()))
    }

    /// All references to the item at byte `offset`: the uses of a part or a variable; for a region also what shows it in the other
    /// views; for a legend or a default the strings and shapes of the parts that inherit from it.
    pub fn references(&self, offset: usize, with_definition: bool) -> Vec<Span> {
        if let Some((symbol, found)) = self.symbol_at(offset) {
            let uses = self.uses(&symbol);
            let wanted = uses
                .iter()
                .filter(|found| with_definition || !found.defines);
            let mut spans: Vec<Span> = wanted.map(|found| self.span_of(found)).collect();
            let part = self.part_of_string(found.string).filter(|_| found.defines);
            let shape = part.map(|part| self.bindings().parts[part].shape);
            let partners = shape.map_or(vec![], |shape| self.partners_of_shape(shape));
            // A partner with a string of the same name is a use of it, and so a definition.
            let is_use = |span: &Span| uses.iter().any(|found| self.span_of(found) == *span);
            spans.extend(partners.into_iter().filter(|span| !is_use(span)));
            return spans;
        }
        let Some(at) = self.at(offset) else {
            return vec![];
        };
        let shape = match at.found {
            Found::Tag { shape } => shape,
            Found::String { string, token, .. } => {
                return token.map_or(vec![], |token| self.inheriting_parts(string, token.item));
            }
        };
        if !self.regions_of_shape(shape).is_empty() {
            let own = Some(span_of_shape(&self.compiled, shape)).filter(|_| with_definition);
            let partners = self.partners_of_shape(shape);
            return own.into_iter().chain(partners).collect();
        }
        let Some(part) = at.part else {
            return vec![];
        };
        let part_name = self.bindings().parts[part].name.clone();
        let uses = self.uses(&Symbol::Part(part_name));
        uses.iter().map(|found| self.span_of(found)).collect()
    }

    /// The parts that inherit from a legend or default: anything, or one attribute.
    fn inheriting_parts(&self, string: StringId, item: Item) -> Vec<Span> {
        let keyword = match item {
            Item::Keyword(index) => {
                Some(attributes(&self.bindings().strings[string].annotation)[index].keyword)
            }
            Item::Sign => None,
            _ => return vec![],
        };
        let keywords: &[Keyword] = match &keyword {
            Some(keyword) => std::slice::from_ref(keyword),
            None => Keyword::ALL,
        };
        let goes_by = |part: &PartId| {
            keywords.iter().any(|keyword| {
                let source = self.bindings().setting(*part, *keyword);
                source.is_some_and(|source| source.string == string && source.from != SetBy::Own)
            })
        };
        let parts = self.bindings().parts.keys();
        parts
            .filter(goes_by)
            .map(|part| self.span_of_part(part))
            .collect()
    }

    /// The uses of the symbol at byte `offset`, each with whether it is a definition.
    pub fn highlights(&self, offset: usize) -> Vec<(Span, bool)> {
        let Some((symbol, _)) = self.symbol_at(offset) else {
            return vec![];
        };
        let uses = self.uses(&symbol);
        uses.iter()
            .map(|found| (self.span_of(found), found.defines))
            .collect()
    }
}

/// The file that an argument names, if any.
pub(super) fn file_named(attribute: &Attribute, argument: usize) -> Option<&str> {
    let takes = &parameter_at(attribute, argument, &|_| false)?
        .parameter()
        .takes;
    match (takes, &attribute.arguments.get(argument)?.kind) {
        (Takes::File, ArgumentKind::Quoted(name) | ArgumentKind::Word(name)) => Some(name),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::super::fixtures::{analysis, figure};
    use super::*;

    fn leads(source: &str) -> Vec<String> {
        let (analysis, at) = analysis(source);
        let Some((_, targets)) = analysis.definition(at) else {
            return vec![];
        };
        let text = |target: &Target| match target {
            Target::Here(span) => analysis.source()[span.start..].chars().take(16).collect(),
            Target::File(name) => name.clone(),
        };
        targets.iter().map(text).collect()
    }

    #[test]
    fn every_kind_of_word_has_a_definition() {
        let strings = |string| figure(["Body", string, "", "$Offset 1", "%Let w 1 Smooth 10"]);
        for (string, expected) in [
            ("Arm@¦Body", "Body</text>\n<tex"),
            ("A¦rm@Body", "<rect id=\"right\""),
            ("Arm@Body$Offset ¦w", "w 1 Smooth 10</t"),
            ("Arm@Body$Off¦set 2", "Offset 1</text>\n"),
            ("Arm@Body$Smoo¦th 2", "Smooth 10</text>"),
            ("Arm@Body$Texture \"¦a b.png\"", "a b.png"),
            ("Arm@Body$Shape model \"a.¦glb\"", "a.glb"),
            ("Arm@¦left", "<rect id=\"left\" "),
        ] {
            assert_eq!(leads(&strings(string)), [expected], "{string}");
        }
        assert!(leads(&strings("Arm@Body$Shape ¦round")).is_empty());
        assert!(leads(&strings("Arm@¦Nobody")).is_empty());
    }

    #[test]
    fn a_tag_leads_to_its_string() {
        let source = figure(["Body", "Arm@Body", "", "", ""])
            .replace("<rect id=\"right\"", "<re¦ct id=\"right\"");
        assert_eq!(leads(&source), ["Arm@Body</text>\n"]);
    }

    #[test]
    fn references_of_a_legend_are_its_parts() {
        let (analysis, at) = analysis(&figure([
            "Body",
            "Rarm@Body",
            "Larm@Body$Offset 3",
            "$Off¦set 1",
            "",
        ]));
        let places = analysis.references(at, true);
        let texts: Vec<_> = places
            .iter()
            .map(|span| &analysis.source()[span.start..span.end])
            .collect();
        assert_eq!(texts, ["Rarm"]);
    }
}
