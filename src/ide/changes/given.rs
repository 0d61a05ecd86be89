//! Names, parents and strings of parts, those included that have no string yet.

use super::strings::{Means, writable};
use super::{Analysis, Change, Refusal};
use crate::bind::{Part, PartId, PartKind, written_by_a_person};
use crate::diagnostic::Edit;
use crate::ide::rename::label_edit;
use crate::ide::{RenameError, Symbol};
use crate::lang::ast::Annotation;
use crate::lang::quoting::{NamePlace, quoted_if_needed, read_name};
use crate::svg::Element;

/// The node that everything hangs on.
const ROOT: &str = "Root";

/// A string as a description. One that ends with a name in quotes, or has no letters, takes a `$` to be read as a string.
pub(in crate::ide) fn as_description(string: String) -> String {
    let is_read = !string.ends_with('"') && string.contains(char::is_alphabetic);
    if is_read { string } else { string + "$" }
}

/// `name@parent`
pub(in crate::ide) fn string_for(name: &str, parent: Option<&str>) -> String {
    let mut string = quoted_if_needed(name, NamePlace::Head);
    if let Some(parent) = parent {
        string.push('@');
        string += &quoted_if_needed(parent, NamePlace::Head);
    }
    string
}

/// The edit that names an element: its label if a person could have written that, else a description, in which the parent is said, too:
/// what has a string hangs on what that says.
fn label_or_string(
    source: &str,
    element: &Element,
    name: &str,
    parent: Option<&str>,
) -> Option<Edit> {
    if written_by_a_person(name).as_deref() == Some(name) {
        return Some(label_edit(source, element.span, name));
    }
    element.with_description(&as_description(string_for(name, parent)))
}

impl Analysis {
    /// The edit that gives a part without a string one that says `attributes`, and nothing else that was not so before.
    pub(super) fn given(&self, part: PartId, attributes: &str) -> Result<Vec<Edit>, Refusal> {
        let head = if self.is_island(part) {
            // Its name and what it hangs on are found by rule, whatever attributes are said of its path.
            String::new()
        } else {
            self.head_and_parent(part)
        };
        self.describe_with(part, &format!("{head}${attributes}"))
    }

    /// What a description must say so that its part keeps its name.
    fn head(&self, part: PartId) -> String {
        let found = &self.bindings().parts[part];
        let is_called_so = |element: &Element| element.own_name() == found.name;
        match self.bindings().naming_element(self.drawing(), part) {
            Some(element) if is_called_so(element) => String::new(),
            // With an automatic name written out, parts without a name would hang on it.
            _ if found.is_automatic() => String::new(),
            _ => string_for(&found.name, None),
        }
    }

    /// What it must say so that its part keeps its parent, too: what has a string hangs on what that says.
    fn head_and_parent(&self, part: PartId) -> String {
        let parts = &self.bindings().parts;
        let head = self.head(part);
        match parts[part].parent {
            Some(parent) => {
                let parent = quoted_if_needed(&parts[parent].name, NamePlace::Head);
                format!("{head}@{parent}")
            }
            None => head,
        }
    }

    /// Whether a part is one of several islands of its path.
    fn is_island(&self, part: PartId) -> bool {
        self.bindings().islands(part).nth(1).is_some()
    }

    /// Refuses what cannot be said of one island alone.
    fn is_whole(&self, part: PartId) -> Result<(), Refusal> {
        if !self.is_island(part) {
            return Ok(());
        }
        let name = self.bindings().describe(self.drawing(), part);
        Err(Refusal::new(format!(
            "{name} is one of several pieces of one path: break the path apart in the drawing first (in Inkscape: Path → Break Apart)"
        )))
    }

    /// The edit that gives a part a description.
    pub(in crate::ide) fn describe_with(
        &self,
        index: PartId,
        string: &str,
    ) -> Result<Vec<Edit>, Refusal> {
        writable(string)?;
        let part = &self.bindings().parts[index];
        let name = self.bindings().describe(self.drawing(), index);
        if part.kind == PartKind::Sub {
            let main = &self.bindings().parts[part.main].name;
            return Err(Refusal::new(format!(
                "{name} is a piece of `{main}` and has no string: change `{main}`, or give the piece a string in the drawing"
            )));
        }
        let element = self.naming_or_own(index, part);
        if self.is_copied(index) {
            return Err(Refusal::new(format!(
                "{name} is a clone, which shares its description with others: change it in the drawing"
            )));
        }
        let described = element.with_description(string).ok_or_else(|| {
            Refusal::new(format!(
                "{name} has a description that is no string: put a text with a string beside it in the drawing"
            ))
        });
        Ok(vec![described?])
    }

    fn naming_or_own(&self, index: PartId, part: &Part) -> &Element {
        let naming = self.bindings().naming_element(self.drawing(), index);
        naming.unwrap_or(&self.drawing().shapes[part.shape].element)
    }

    /// Gives a part another name.
    pub(super) fn call(&self, old: &str, new: &str) -> Result<Vec<Edit>, Refusal> {
        let index = self.node_to_change(old)?;
        writable(new)?;
        let name = read_name(new).ok_or_else(|| Refusal::new(RenameError::NotAName.to_string()))?;
        if name == ROOT {
            return Err(Refusal::new(format!(
                "`{ROOT}` is what the figures hang on, and cannot be the name of a part"
            )));
        }
        if name == old {
            return Ok(vec![]);
        }
        self.is_whole(index)?;
        let part = &self.bindings().parts[index];
        let is_named = part.string.is_some()
            || self
                .bindings()
                .naming_element(self.drawing(), index)
                .is_some();
        if is_named && part.string.is_none() && self.is_copied(index) {
            return Err(Refusal::new(format!(
                "`{old}` is a clone, which shares its name with others: change it in the drawing"
            )));
        }
        if let Some(string) = part.string {
            // Nothing is written here; whatever cannot be rewritten is refused before its uses are.
            self.rewritten(string, &[], Means::Everything)?;
        }
        let symbol = Symbol::Part(old.to_owned());
        let mut edits = self
            .rename_symbol(&symbol, &name)
            .map_err(|refused| Refusal::new(refused.to_string()))?;
        if !is_named {
            let element = &self.drawing().shapes[part.shape].element;
            let parent = part
                .parent
                .map(|parent| self.bindings().parts[parent].name.as_str());
            let edit = label_or_string(&self.source, element, &name, parent)
                .filter(|_| !self.is_copied(index));
            edits.push(edit.ok_or_else(|| {
                Refusal::new(format!(
                    "`{old}` is a clone, or has a description already: name it in the drawing"
                ))
            })?);
        }
        Ok(edits)
    }

    /// Hangs a part on another one.
    pub(super) fn hang(&self, name: &str, parent: Option<&str>) -> Result<Vec<Edit>, Refusal> {
        let index = self.node_to_change(name)?;
        let onto = match parent {
            None => None,
            Some(parent) => Some(self.node_to_change(parent)?),
        };
        let parts = &self.bindings().parts;
        if parts[index].parent == onto {
            return Ok(vec![]);
        }
        let above = std::iter::successors(onto, |part| parts[*part].parent);
        // Parents may be in a circle, which is an error of the drawing.
        if above.take(parts.len()).any(|part| part == index) {
            return Err(Refusal::new(format!(
                "`{}` hangs on `{name}`, or is the same part",
                parent.unwrap_or_default()
            )));
        }
        self.is_whole(index)?;
        let written = quoted_if_needed(parent.unwrap_or(ROOT), NamePlace::Head);
        let Some(string) = parts[index].string else {
            let head = self.head(index);
            return self.describe_with(index, &as_description(format!("{head}@{written}")));
        };
        let found = &self.bindings().strings[string];
        let Annotation::Part(annotation) = &found.annotation else {
            return Err(Refusal::new(format!(
                "`{}` is no string of a part",
                found.text.as_str().trim()
            )));
        };
        let piece = match (&annotation.parent, &annotation.name) {
            (Some(parent), _) => (parent.range.clone(), written),
            (None, Some(name)) => (name.range.end..name.range.end, format!("@{written}")),
            (None, None) => {
                let text = found.text.as_str();
                let start = text.len() - text.trim_start().len();
                (start..start, format!("@{written}"))
            }
        };
        self.rewritten(string, &[piece], Means::Parent)
    }

    /// Takes a part out of the model.
    pub(super) fn leave_out(&self, name: &str) -> Result<Vec<Edit>, Refusal> {
        let index = self.node_to_change(name)?;
        let parts = &self.bindings().parts;
        let children = parts.iter().filter(|part| {
            part.kind == PartKind::Main && part.parent == Some(index) && !part.name.is_empty()
        });
        let children: Vec<&str> = children.map(|part| part.name.as_str()).collect();
        if !children.is_empty() {
            let names = crate::diagnostic::listed(children.iter().map(|name| format!("`{name}`")));
            let mut refusal = Refusal::new(format!(
                "{names} {} on `{name}`: hang {} elsewhere first",
                if children.len() == 1 { "hangs" } else { "hang" },
                if children.len() == 1 { "it" } else { "them" },
            ));
            if let ([child], above) = (children.as_slice(), parts[index].parent) {
                let parent = above.map(|above| parts[above].name.clone());
                let onto = parent
                    .as_ref()
                    .map_or_else(|| "nothing".to_owned(), |name| format!("`{name}`"));
                refusal = refusal.or(
                    format!("Hang `{child}` on {onto}"),
                    Change::Hang {
                        part: (*child).to_owned(),
                        parent,
                    },
                );
            }
            return Err(refusal);
        }
        self.is_whole(index)?;
        let pieces = parts.iter().filter(|part| part.main == index).count();
        if pieces > 1 {
            return Err(Refusal::new(format!(
                "`{name}` consists of {pieces} shapes: mark each with `*` in the drawing"
            )));
        }
        let Some(string) = parts[index].string else {
            return self.describe_with(index, "*");
        };
        let text = self.bindings().strings[string].text.as_str();
        let start = text.len() - text.trim_start().len();
        self.rewritten(string, &[(start..start, "*".to_owned())], Means::Everything)
    }
}
