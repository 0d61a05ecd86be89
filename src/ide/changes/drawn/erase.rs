//! Deletes what a part is drawn as, with the strings that are about it alone.

use roxmltree::Document;

use super::{element_at, with_space_before};
use crate::bind::{PartId, PartKind, StringId};
use crate::diagnostic::{Edit, listed};
use crate::ide::changes::{Analysis, Change, Refusal};
use crate::lang::ast::Annotation;
use crate::source::Span;

impl Analysis {
    /// Deletes a part from the drawing.
    pub(in crate::ide::changes) fn erase(&self, name: &str) -> Result<Vec<Edit>, Refusal> {
        let (part, elements) = self.drawn_part(name)?;
        self.nothing_hangs_on(part)?;
        if self.has_leader(part) {
            return Err(Refusal::new(format!(
                "a line leads from the string of `{name}` to it: delete both in the program that drew them"
            )));
        }
        let document = self.document()?;
        let starts = elements.iter().map(|element| element.span.start);
        let texts = self
            .strings_beside(part)
            .map(|(_, label)| label.element.start);
        let spans = starts.chain(texts).map(|start| {
            let node = element_at(&document, start)?;
            Ok(with_space_before(&self.source, node))
        });
        let mut spans = spans.collect::<Result<Vec<Span>, Refusal>>()?;
        spans.sort();
        // A string may lie in the group that goes.
        let mut gone: Vec<Span> = vec![];
        for span in spans {
            if gone.last().is_none_or(|last| last.end <= span.start) {
                gone.push(span);
            }
        }
        if let Some(id) = still_meant(&document, &gone) {
            return Err(Refusal::new(format!(
                "something else in the drawing refers to `#{id}`, such as a clone or a key pose: delete that first"
            )));
        }
        let cut = gone.into_iter().map(|span| Edit {
            span,
            text: String::new(),
        });
        Ok(cut.collect())
    }

    /// Refuses to delete what strings say that others hang on.
    fn nothing_hangs_on(&self, part: PartId) -> Result<(), Refusal> {
        let bindings = self.bindings();
        let says = |string: StringId| {
            let string = &bindings.strings[string];
            matches!(&string.annotation, Annotation::Part(said) if said.parent.is_some())
        };
        let hung = bindings.parts.iter().filter(|other| {
            other.kind == PartKind::Main
                && other.parent == Some(part)
                && other.string.is_some_and(says)
        });
        let hung: Vec<&str> = hung.map(|part| part.name.as_str()).collect();
        let Some(first) = hung.first() else {
            return Ok(());
        };
        let own = &bindings.parts[part];
        let names = listed(hung.iter().map(|name| format!("`{name}`")));
        let (hang, them) = match hung.len() {
            1 => ("hangs", "it"),
            _ => ("hang", "them"),
        };
        let refusal = Refusal::new(format!(
            "{names} {hang} on `{}`: hang {them} elsewhere first",
            own.name
        ));
        let above = own.parent.map(|above| bindings.parts[above].name.clone());
        let onto = above
            .as_ref()
            .map_or_else(|| "nothing".to_owned(), |name| format!("`{name}`"));
        Err(refusal.or(
            format!("Hang `{first}` on {onto}"),
            Change::Hang {
                part: (*first).to_owned(),
                parent: above,
            },
        ))
    }
}

/// An id of what goes that something else refers to.
fn still_meant(document: &Document<'_>, gone: &[Span]) -> Option<String> {
    let goes = |at: usize| gone.iter().any(|span| span.start <= at && at < span.end);
    let elements = || document.descendants().filter(roxmltree::Node::is_element);
    let ids: Vec<&str> = elements()
        .filter(|node| goes(node.range().start))
        .filter_map(|node| node.attribute("id"))
        .collect();
    let stays = elements().filter(|node| !goes(node.range().start));
    let mut values = stays.flat_map(|node| node.attributes());
    let meant = values.find_map(|attribute| {
        let value = attribute.value();
        let refers =
            |id: &&&str| value == format!("#{id}") || value.contains(&format!("url(#{id})"));
        let is_link = value.contains('#');
        ids.iter().filter(|_| is_link).find(refers).copied()
    });
    meant.map(str::to_owned)
}
