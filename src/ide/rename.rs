//! Renaming parts, variables and feature points in all strings.

use super::uses::own_name;
use super::{Analysis, Item, Symbol, Use};
use crate::bind::{DrawingString, written_by_a_person};
use crate::diagnostic::Edit;
use crate::lang::keyword::{Keyword, colors, vocabulary};
use crate::lang::quoting::{NamePlace, can_be_bare, quoted_if_needed, read_name};
use crate::lang::{is_word_char, looks_like_string};
use crate::source::{Span, end_of_tag, escape_xml};

/// Why a rename is refused.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum RenameError {
    /// There is no name at the offset.
    #[error("there is no part name and no variable here")]
    NoName,
    /// The new name cannot be written in a string.
    #[error("a name must not be empty or contain quotes")]
    NotAName,
    /// Another part has the name.
    #[error("there is a part named `{0}` already")]
    Taken(String),
    /// Another variable has the name.
    #[error("there is a variable `{0}` already")]
    VariableTaken(String),
    /// The new name is no valid variable.
    #[error("`{0}` cannot be a variable: letters, digits, `_` and `.`, beginning with a letter")]
    NotAVariable(String),
    /// The new name is a word of the language.
    #[error("`{0}` is a word of the language, and would be read as such")]
    WordOfTheLanguage(String),
    /// The part has no string.
    #[error("`{0}` has neither a string nor a label that names it: give it one first")]
    NoString(String),
    /// The new name would not be taken for a name in a label.
    #[error(
        "`{0}` in a label would be taken for the work of a program, not for a name: choose another one"
    )]
    NoLabel(String),
    /// An entity expands to more than the name.
    #[error(
        "`{0}` comes from an XML entity that contains more than the name: replace the entity by its text first"
    )]
    InEntity(String),
    /// The drawing is not well-formed.
    #[error("the drawing is not well-formed XML: fix that first, so that no name is missed")]
    NotSound,
}

impl Analysis {
    /// The span and the present name of the symbol at byte `offset` that can be renamed.
    ///
    /// # Errors
    /// If there is no symbol, or it cannot be renamed.
    pub fn prepare_rename(&self, offset: usize) -> Result<(Span, String), RenameError> {
        let (symbol, found) = self.to_rename(offset)?;
        Ok((self.span_of(&found), symbol.name().to_owned()))
    }

    /// The edits that rename the symbol at byte `offset` wherever it is used.
    ///
    /// The new name is quoted only where necessary, and escaped for XML as its context needs.
    ///
    /// # Errors
    /// If there is no symbol, or the new name cannot be used.
    pub fn rename(&self, offset: usize, new_name: &str) -> Result<Vec<Edit>, RenameError> {
        let (symbol, _) = self.to_rename(offset)?;
        let name = read_name(new_name).ok_or(RenameError::NotAName)?;
        self.rename_symbol(&symbol, &name)
    }

    /// The edits that rename a symbol wherever it is used, in order.
    pub(super) fn rename_symbol(
        &self,
        symbol: &Symbol,
        name: &str,
    ) -> Result<Vec<Edit>, RenameError> {
        if name == symbol.name() {
            return Ok(vec![]);
        }
        match symbol {
            Symbol::Part(_) if self.part_named(name).is_some() || self.named_in(name).is_some() => {
                return Err(RenameError::Taken(name.to_owned()));
            }
            Symbol::Variable(_) => self.check_variable(name)?,
            Symbol::Part(_) | Symbol::Feature(_) => {}
        }
        let mut edits = vec![];
        for found in self.uses(symbol) {
            let string = &self.bindings().strings[found.string];
            let new = rewritten(string, &found, symbol, name);
            let replaced = Edit::replacing(&string.text, found.range.clone(), &new);
            edits.extend(replaced.ok_or_else(|| RenameError::InEntity(symbol.name().to_owned()))?);
        }
        if let Symbol::Part(old) = symbol {
            edits.extend(self.named_by_element(old, name));
            edits.extend(self.labeled(old, name)?);
        }
        edits.sort_by_key(|edit| edit.span);
        // Clones share the strings of their originals.
        edits.dedup();
        Ok(edits)
    }

    fn to_rename(&self, offset: usize) -> Result<(Symbol, Use), RenameError> {
        if !self.is_sound() {
            return Err(RenameError::NotSound);
        }
        let (symbol, found) = self.symbol_at(offset).ok_or(RenameError::NoName)?;
        if let Symbol::Part(name) = &symbol
            && let Some(part) = self.part_named(name)
            && self.bindings().parts[part].string.is_none()
            && self
                .bindings()
                .naming_element(self.drawing(), part)
                .is_none()
        {
            return Err(RenameError::NoString(name.clone()));
        }
        Ok((symbol, found))
    }

    fn check_variable(&self, name: &str) -> Result<(), RenameError> {
        if !name.starts_with(char::is_alphabetic) || !name.chars().all(is_word_char) {
            return Err(RenameError::NotAVariable(name.to_owned()));
        }
        let is_taken = Keyword::from_name(name).is_some()
            || vocabulary::is_known(name)
            || colors::is_color(name);
        if is_taken {
            return Err(RenameError::WordOfTheLanguage(name.to_owned()));
        }
        if self.is_variable(name) || !self.uses(&Symbol::Variable(name.to_owned())).is_empty() {
            return Err(RenameError::VariableTaken(name.to_owned()));
        }
        Ok(())
    }

    /// A part without a string inherits the name of its element: the label is changed, or written where the id is the name, since
    /// other elements may refer to the id.
    fn labeled(&self, old: &str, name: &str) -> Result<Option<Edit>, RenameError> {
        let Some(index) = self.part_named(old) else {
            return Ok(None);
        };
        let Some(element) = self.bindings().naming_element(self.drawing(), index) else {
            return Ok(None);
        };
        if self.bindings().parts[index].string.is_some() {
            return Ok(None);
        }
        if written_by_a_person(name).as_deref() != Some(name) {
            return Err(RenameError::NoLabel(name.to_owned()));
        }
        Ok(Some(label_edit(&self.source, element.span, name)))
    }

    /// A description without a name inherits that of its element: the new name is inserted at its start.
    fn named_by_element(&self, old: &str, name: &str) -> Option<Edit> {
        let part = &self.bindings().parts[self.part_named(old)?];
        let string = &self.bindings().strings[part.string?];
        let head = string.text.as_str();
        let start = head.len() - head.trim_start().len();
        (own_name(string).is_none() && looks_like_string(head)).then(|| Edit {
            span: string.text.span(start..start),
            text: string
                .text
                .escape_at(start, &quoted_if_needed(name, NamePlace::Head)),
        })
    }
}

/// Declares the prefix under which Inkscape keeps labels.
const INKSCAPE: &str = "xmlns:inkscape=\"http://www.inkscape.org/namespaces/inkscape\"";

/// The edit that changes the label of the element whose tag begins at `tag`, or gives it one.
pub(super) fn label_edit(source: &str, tag: Span, name: &str) -> Edit {
    let text = escape_attribute(name);
    if let Some(span) = label_of(source, tag) {
        return Edit { span, text };
    }
    let attribute = if source.contains(INKSCAPE) {
        "inkscape:label"
    } else {
        "data-name"
    };
    Edit {
        span: Span::at(tag.end),
        text: format!(" {attribute}=\"{text}\""),
    }
}

/// The span of the value of an element's label, between its quotes; `tag` is the start of its tag.
fn label_of(source: &str, tag: Span) -> Option<Span> {
    let end = end_of_tag(source, tag.end)?;
    let text = source.get(tag.end..end)?;
    let is_label = |name: &str| {
        name == "data-name"
            || name == "serif:id"
            || name
                .rsplit_once(':')
                .is_some_and(|(_, local)| local == "label")
    };
    let mut found: Vec<(&str, Span)> = vec![];
    let mut at = 0;
    while let Some(equals) = text[at..].find('=').map(|equals| at + equals) {
        let name = text[at..equals].trim();
        let quote = equals + 1 + text[equals + 1..].find(['"', '\''])?;
        let value = quote + 1;
        let close = value + text[value..].find(&text[quote..value])?;
        if is_label(name) {
            found.push((name, Span::new(tag.end + value, tag.end + close)));
        }
        at = close + 1;
    }
    // The same order as where labels are read.
    let rank = |name: &str| match name {
        "serif:id" => 1,
        "data-name" => 2,
        _ => 0,
    };
    found.sort_by_key(|(name, _)| rank(name));
    found.first().map(|(_, span)| *span)
}

/// Text as the value of an attribute in either kind of quotes.
fn escape_attribute(text: &str) -> String {
    escape_xml(text)
        .replace('"', "&quot;")
        .replace('\'', "&apos;")
}

/// The new name in the notation of the old one: quotes that the old name did not need are kept.
fn rewritten(string: &DrawingString, found: &Use, symbol: &Symbol, name: &str) -> String {
    if matches!(symbol, Symbol::Variable(_)) {
        return name.to_owned();
    }
    let item = super::at::token_at(string, found.range.start).map(|token| token.item);
    let role = match item {
        Some(Item::Argument(..)) => NamePlace::Argument,
        _ => NamePlace::Head,
    };
    let quoted = string.text.as_str()[found.range.clone()].starts_with(['"', '＂']);
    if quoted && can_be_bare(symbol.name(), role) {
        format!("\"{name}\"")
    } else {
        quoted_if_needed(name, role)
    }
}

#[cfg(test)]
mod tests {
    use super::super::fixtures::{analysis, figure};
    use super::*;
    use crate::diagnostic::applied;

    fn renamed(source: &str, name: &str) -> Result<String, RenameError> {
        let (analysis, at) = analysis(source);
        let edits = analysis.rename(at, name)?;
        Ok(applied(analysis.source(), &edits))
    }

    #[test]
    fn parts_are_renamed_in_all_strings() {
        let before = ["Body", "Rarm@¦Body$Follow Body", "Larm@Body", "", ""];
        let after = ["Trunk", "Rarm@Trunk$Follow Trunk", "Larm@Trunk", "", ""];
        assert_eq!(renamed(&figure(before), "Trunk").unwrap(), figure(after));
        let quoted = [
            "\"the trunk\"",
            "Rarm@\"the trunk\"$Follow \"the trunk\"",
            "Larm@\"the trunk\"",
            "",
            "",
        ];
        assert_eq!(
            renamed(&figure(before), "the trunk").unwrap(),
            figure(quoted)
        );
    }

    #[test]
    fn quotes_are_added_and_removed_as_needed() {
        let needed = ["\"a b\"", "Rarm@¦\"a b\"", "", "", ""];
        assert_eq!(
            renamed(&figure(needed), "c").unwrap(),
            figure(["c", "Rarm@c", "", "", ""])
        );
        let habit = ["\"a\"", "Rarm@¦a", "", "", ""];
        assert_eq!(
            renamed(&figure(habit), "c").unwrap(),
            figure(["\"c\"", "Rarm@c", "", "", ""])
        );
    }

    #[test]
    fn names_are_escaped_for_their_context() {
        let before = ["<![CDATA[Body]]>", "Rarm@¦Body", "", "", ""];
        let after = ["<![CDATA[a&b<c]]>", "Rarm@a&amp;b&lt;c", "", "", ""];
        assert_eq!(renamed(&figure(before), "a&b<c").unwrap(), figure(after));
    }

    #[test]
    fn names_beside_entities_and_sections_are_renamed_alone() {
        let before = [
            "Bo&#x64;y",
            "a&amp;b@¦Body<![CDATA[$Offset]]> 3<!-- -->",
            "",
            "",
            "",
        ];
        let after = [
            "Trunk",
            "a&amp;b@Trunk<![CDATA[$Offset]]> 3<!-- -->",
            "",
            "",
            "",
        ];
        assert_eq!(renamed(&figure(before), "Trunk").unwrap(), figure(after));
        let entity = "<!DOCTYPE svg [<!ENTITY e \"Rarm@Body\">]>";
        let source = format!("{entity}{}", figure(["¦Body", "&e;$Offset 1", "", "", ""]));
        let refused = RenameError::InEntity("Body".to_owned());
        assert_eq!(renamed(&source, "Trunk"), Err(refused));
    }

    #[test]
    fn tags_within_a_name_are_kept() {
        let before = [
            "<tspan>Bo</tspan><tspan>dy</tspan>",
            "Rarm@¦Body",
            "",
            "",
            "",
        ];
        let after = [
            "<tspan>Trunk</tspan><tspan></tspan>",
            "Rarm@Trunk",
            "",
            "",
            "",
        ];
        assert_eq!(renamed(&figure(before), "Trunk").unwrap(), figure(after));
    }

    #[test]
    fn variables_are_renamed() {
        let before = [
            "Body$Offset ¦w",
            "Rarm@Body$Shape cone 0 (w * 2)",
            "",
            "",
            "%Let w 1",
        ];
        let after = [
            "Body$Offset thick",
            "Rarm@Body$Shape cone 0 (thick * 2)",
            "",
            "",
            "%Let thick 1",
        ];
        assert_eq!(renamed(&figure(before), "thick").unwrap(), figure(after));
    }

    #[test]
    fn renames_that_would_break_are_refused() {
        let parts = figure(["Body", "Rarm@¦Body", "Larm@Body", "", ""]);
        for (name, error) in [
            ("Larm", RenameError::Taken("Larm".to_owned())),
            ("a\"b", RenameError::NotAName),
            ("  ", RenameError::NotAName),
        ] {
            assert_eq!(renamed(&parts, name), Err(error));
        }
        let variables = figure(["Body$Offset ¦w", "", "", "", "%Let w 1 Let v 2"]);
        for (name, error) in [
            ("v", RenameError::VariableTaken("v".to_owned())),
            ("1v", RenameError::NotAVariable("1v".to_owned())),
            (
                "center",
                RenameError::WordOfTheLanguage("center".to_owned()),
            ),
            ("Shape", RenameError::WordOfTheLanguage("Shape".to_owned())),
        ] {
            assert_eq!(renamed(&variables, name), Err(error));
        }
        assert_eq!(
            renamed(&figure(["Body$¦Offset 1", "", "", "", ""]), "x"),
            Err(RenameError::NoName)
        );
        let automatic = figure(["Body", "Rarm@U-¦1", "", "", ""]).replace("\"left\"", "\"path2\"");
        assert_eq!(
            renamed(&automatic, "x"),
            Err(RenameError::NoString("U-1".to_owned()))
        );
    }

    #[test]
    fn a_description_without_a_name_is_given_one() {
        let before = "<svg xmlns=\"http://www.w3.org/2000/svg\"><rect id=\"a\" width=\"9\" height=\"9\"><desc>$Offset 1</desc>\
                      </rect><rect id=\"b\" x=\"20\" width=\"9\" height=\"9\"><desc>@¦a$Offset 2</desc></rect></svg>";
        let after = before.replace("<desc>$", "<desc>z$").replace("@¦a$", "@z$");
        assert_eq!(renamed(before, "z").unwrap(), after);
    }

    #[test]
    fn labels_are_renamed_and_ids_are_given_labels() {
        let drawing = |arm: &str, string: &str, space: &str| {
            format!(
                "<svg xmlns=\"http://www.w3.org/2000/svg\"{space}><g {arm}><rect width=\"9\" height=\"9\"/>\
                 <rect width=\"3\" height=\"9\"/></g><rect x=\"20\" width=\"9\" height=\"9\"><desc>Hand@{string}</desc></rect></svg>"
            )
        };
        let inkscape = format!(" {INKSCAPE}");
        for (before, after, space) in [
            (
                "style=\"a='b'\" inkscape:label=\"arm\"",
                "style=\"a='b'\" inkscape:label=\"arm &amp; hand\"",
                inkscape.as_str(),
            ),
            (
                "id=\"l\" data-name='arm'",
                "id=\"l\" data-name='arm &amp; hand'",
                "",
            ),
        ] {
            let source = drawing(before, "¦arm", space);
            let expected = drawing(after, "\"arm &amp; hand\"", space);
            assert_eq!(renamed(&source, "arm & hand").unwrap(), expected);
        }
        let by_id = drawing("id=\"arm\"", "¦arm", "");
        let expected = drawing("id=\"arm\"", "wing", "").replace("<g ", "<g data-name=\"wing\" ");
        assert_eq!(renamed(&by_id, "wing").unwrap(), expected);
        assert_eq!(
            renamed(&by_id, "path 1"),
            Err(RenameError::NoLabel("path 1".to_owned()))
        );
    }
}
