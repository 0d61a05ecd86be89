//! Symbols (names and variables) and their uses.

use std::ops::Range;

use super::Analysis;
use super::at::{Found, Item, attributes};
use crate::bind::{DrawingString, StringId};
use crate::lang::ast::{Annotation, ArgumentKind, Attribute};
use crate::lang::keyword::Keyword;
use crate::lang::keyword::signature::Takes;
use crate::lang::parameter_at;
use crate::source::Span;

/// Something that has a name.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Symbol {
    /// A part, or a parent that no string defines.
    Part(String),
    /// A variable, or a word in place of a number.
    Variable(String),
    /// A feature point of a billboard's region.
    Feature(String),
}

/// A use of a symbol.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Use {
    /// The string.
    pub string: StringId,
    /// The range in its decoded characters, including the quotes of a name.
    pub range: Range<usize>,
    /// Whether this use is the definition.
    pub defines: bool,
}

impl Symbol {
    /// Its name.
    pub fn name(&self) -> &str {
        match self {
            Self::Part(name) | Self::Variable(name) | Self::Feature(name) => name,
        }
    }
}

impl Analysis {
    /// The symbol at byte `offset`, and its use there.
    pub fn symbol_at(&self, offset: usize) -> Option<(Symbol, Use)> {
        let Found::String {
            string,
            offset,
            token,
        } = self.at(offset)?.found
        else {
            return None;
        };
        let holds =
            |found: &(Symbol, Use)| (found.1.range.start..=found.1.range.end).contains(&offset);
        // Only names and arguments can be symbols.
        match token?.item {
            Item::Name | Item::Parent | Item::Feature | Item::Argument(..) => {
                let all = self.symbols_of(string).into_iter();
                all.filter(holds)
                    .min_by_key(|(_, found)| found.range.end == offset)
            }
            _ => None,
        }
    }

    /// The uses of a symbol, in the order of the text.
    pub fn uses(&self, symbol: &Symbol) -> Vec<Use> {
        let strings = self.bindings().strings.keys();
        let all = strings.flat_map(|string| self.symbols_of(string));
        all.filter(|(other, _)| other == symbol)
            .map(|(_, found)| found)
            .collect()
    }

    /// The span of a use in the drawing.
    pub fn span_of(&self, found: &Use) -> Span {
        self.bindings().strings[found.string]
            .text
            .span(found.range.clone())
    }

    /// The symbols of a string, in order.
    fn symbols_of(&self, index: StringId) -> Vec<(Symbol, Use)> {
        let string = &self.bindings().strings[index];
        let mut found = vec![];
        let mut push = |symbol, range: &Range<usize>, defines| {
            let range = range.clone();
            found.push((
                symbol,
                Use {
                    string: index,
                    range,
                    defines,
                },
            ));
        };
        match &string.annotation {
            Annotation::Part(part) => {
                if let Some(name) = &part.name {
                    push(Symbol::Part(name.text.clone()), &name.range, true);
                }
                if let Some(parent) = &part.parent {
                    push(Symbol::Part(parent.text.clone()), &parent.range, false);
                }
            }
            Annotation::Feature(name) => {
                push(Symbol::Feature(name.text.clone()), &name.range, false);
            }
            _ => {}
        }
        for attribute in attributes(&string.annotation) {
            self.symbols_of_attribute(attribute, &mut push);
        }
        found
    }

    fn symbols_of_attribute(
        &self,
        attribute: &Attribute,
        push: &mut impl FnMut(Symbol, &Range<usize>, bool),
    ) {
        for (index, argument) in attribute.arguments.iter().enumerate() {
            match &argument.kind {
                ArgumentKind::Expression(expression) => {
                    expression.variables(&mut |name| {
                        push(Symbol::Variable(name.text.clone()), &name.range, false);
                    });
                }
                ArgumentKind::Word(word) | ArgumentKind::Quoted(word) => {
                    let is_word = matches!(argument.kind, ArgumentKind::Word(_));
                    let slot = parameter_at(attribute, index, &|name| self.is_variable(name));
                    match slot.map(|slot| &slot.parameter().takes) {
                        Some(Takes::Variable) if is_word => {
                            push(Symbol::Variable(word.clone()), &argument.range, true);
                        }
                        Some(Takes::Number(_)) if is_word => {
                            push(Symbol::Variable(word.clone()), &argument.range, false);
                        }
                        Some(Takes::Names) if attribute.keyword == Keyword::Follow => {
                            push(Symbol::Part(word.clone()), &argument.range, false);
                        }
                        _ => {}
                    }
                }
                _ => {}
            }
        }
    }

    /// The string that names a part so, if any.
    pub(super) fn named_in(&self, name: &str) -> Option<StringId> {
        let symbol = Symbol::Part(name.to_owned());
        let mut strings = self.bindings().strings.keys();
        strings.find(|string| {
            self.symbols_of(*string)
                .iter()
                .any(|(other, found)| found.defines && *other == symbol)
        })
    }
}

/// The name that a string gives its part, if it gives one.
pub(super) fn own_name(string: &DrawingString) -> Option<&str> {
    match &string.annotation {
        Annotation::Part(part) => part.name.as_ref().map(|name| name.text.as_str()),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::super::fixtures::{analysis, figure};
    use super::*;

    fn found(strings: [&str; 5]) -> (Option<Symbol>, Vec<(String, bool)>) {
        let (analysis, at) = analysis(&figure(strings));
        let Some((symbol, _)) = analysis.symbol_at(at) else {
            return (None, vec![]);
        };
        let uses = analysis.uses(&symbol);
        let text = |found: &Use| {
            let span = analysis.span_of(found);
            (
                analysis.source()[span.start..span.end].to_owned(),
                found.defines,
            )
        };
        let uses = uses.iter().map(text).collect();
        (Some(symbol), uses)
    }

    #[test]
    fn parts_are_found_wherever_they_are_named() {
        let (symbol, uses) = found([
            "Body",
            "Rarm@Bo¦dy$Follow Body Body",
            "Larm@\"Body\"",
            "",
            "",
        ]);
        assert_eq!(symbol, Some(Symbol::Part("Body".to_owned())));
        let expected = [
            ("Body", false),
            ("Body", false),
            ("Body", false),
            ("\"Body\"", false),
            ("Body", true),
        ];
        let mut uses: Vec<_> = uses
            .iter()
            .map(|(text, defines)| (text.as_str(), *defines))
            .collect();
        let mut expected = expected.to_vec();
        uses.sort_unstable();
        expected.sort_unstable();
        assert_eq!(uses, expected);
    }

    #[test]
    fn variables_are_found_in_calculations() {
        let (symbol, uses) = found([
            "Body$Offset w",
            "Rarm@Body$Shape cone 0 (max(w, ¦w * 2))",
            "",
            "$Color w 0 0",
            "%Let w 1",
        ]);
        assert_eq!(symbol, Some(Symbol::Variable("w".to_owned())));
        assert_eq!(uses.len(), 5);
        assert_eq!(uses.iter().filter(|(_, defines)| *defines).count(), 1);
    }

    #[test]
    fn words_of_the_language_are_no_symbols() {
        assert_eq!(found(["Body$Origin cen¦ter", "", "", "", ""]).0, None);
        assert_eq!(found(["Body$Color r¦ed", "", "", "", ""]).0, None);
        assert_eq!(found(["Body$Sha¦pe round", "", "", "", ""]).0, None);
    }
}
