//! The figure's hierarchy, as an outline of the drawing.

use typed_index_collections::{TiSlice, TiVec, ti_vec};

use super::Analysis;
use crate::bind::{PartId, PartKind};
use crate::source::Span;

/// The greatest depth of the outline; deeper parts are siblings of their ancestor at this depth.
const MAX_DEPTH: usize = 100;

/// A part in the outline.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Outline {
    /// The part's name.
    pub name: String,
    /// A short description: its shape.
    pub detail: String,
    /// Whether the part has children in the model.
    pub is_joint: bool,
    /// All of its string, or its shape's tag.
    pub span: Span,
    /// Its name in the string, or its shape's tag.
    pub selection: Span,
    /// Its children.
    pub children: Vec<Outline>,
}

impl Analysis {
    /// The main parts as a tree, in the order of the file.
    pub fn outline(&self) -> Vec<Outline> {
        let bindings = self.bindings();
        if !bindings.annotated {
            return vec![];
        }
        let mut children: TiVec<PartId, Vec<PartId>> = ti_vec![vec![]; bindings.parts.len()];
        let mut roots = vec![];
        let parts = bindings.parts.iter_enumerated();
        let mains = parts.filter(|(_, part)| part.kind == PartKind::Main);
        let mut order: Vec<PartId> = mains.map(|(part, _)| part).collect();
        order.sort_by_cached_key(|part| self.span_of_part(*part));
        for part in order {
            match bindings.parts[part].parent {
                Some(parent) => children[parent].push(part),
                None => roots.push(part),
            }
        }
        self.outline_of(&roots, &children, 0)
    }

    fn outline_of(
        &self,
        parts: &[PartId],
        children: &TiSlice<PartId, Vec<PartId>>,
        depth: usize,
    ) -> Vec<Outline> {
        let mut out = vec![];
        let mut waiting: Vec<PartId> = parts.iter().rev().copied().collect();
        while let Some(part) = waiting.pop() {
            let mut outline = self.outline_entry(part);
            outline.is_joint = !children[part].is_empty();
            if depth < MAX_DEPTH {
                outline.children = self.outline_of(&children[part], children, depth + 1);
            } else {
                waiting.extend(children[part].iter().rev());
            }
            out.push(outline);
        }
        out
    }

    fn outline_entry(&self, part: PartId) -> Outline {
        let bindings = self.bindings();
        let selection = self.span_of_part(part);
        let shape = bindings.setting(part, crate::lang::keyword::Keyword::Shape);
        let span = match bindings.parts[part].string {
            Some(string) => bindings.strings[string].text.whole(),
            None => selection,
        };
        Outline {
            name: bindings.parts[part].name.clone(),
            detail: shape.map_or("default".to_owned(), |source| source.setting.text.clone()),
            is_joint: false,
            span: span.join(selection),
            selection,
            children: vec![],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::fixtures::{analysis, figure};
    use super::*;

    fn lines(outline: &[Outline], indent: &str, out: &mut Vec<String>) {
        for part in outline {
            out.push(format!("{indent}{} {}", part.name, part.detail));
            lines(&part.children, &format!("{indent}  "), out);
        }
    }

    #[test]
    fn the_outline_is_the_hierarchy() {
        let (analysis, _) = analysis(&figure([
            "Body",
            "Rarm@Body$Shape roundv",
            "Larm@Rarm",
            "",
            "",
        ]));
        let mut out = vec![];
        lines(&analysis.outline(), "", &mut out);
        let expected = [
            "Body default",
            "  Rarm roundv",
            "    swatch default",
            "    Larm default",
        ];
        assert_eq!(out, expected);
    }
}
