//! Brings what a part is drawn as to the front, or behind others.

use roxmltree::Node;

use super::{Stacking, element_at, with_space_before};
use crate::diagnostic::Edit;
use crate::ide::changes::{Analysis, Refusal};
use crate::source::Span;

impl Analysis {
    /// Draws a part later or earlier than others in its layer or group.
    pub(in crate::ide::changes) fn restack(
        &self,
        name: &str,
        to: Stacking,
    ) -> Result<Vec<Edit>, Refusal> {
        let (_, elements) = self.drawn_part(name)?;
        let document = self.document()?;
        let nodes = elements.iter();
        let nodes = nodes.map(|element| element_at(&document, element.span.start));
        let mut nodes: Vec<Node<'_, '_>> = nodes.collect::<Result<_, _>>()?;
        nodes.sort_by_key(|node| node.range().start);
        let parent = nodes.first().and_then(Node::parent_element);
        let parent = parent.filter(|parent| {
            nodes
                .iter()
                .all(|node| node.parent_element().as_ref() == Some(parent))
        });
        let parent = parent.ok_or_else(|| {
            Refusal::new(format!(
                "the shapes of `{name}` lie in several groups: group them in the drawing program first"
            ))
        })?;
        // Only what is drawn is a step: texts, guides and descriptions are passed.
        let drawn = self.drawing().shapes.iter();
        let mut drawn: Vec<usize> = drawn.map(|shape| shape.element.span.start).collect();
        drawn.sort_unstable();
        let siblings: Vec<Node<'_, '_>> = parent
            .children()
            .filter(|node| {
                let range = node.range();
                let next = drawn.partition_point(|start| *start < range.start);
                node.is_element() && drawn.get(next).is_some_and(|start| range.contains(start))
            })
            .collect();
        let is_own = |node: &Node<'_, '_>| nodes.contains(node);
        let behind_all = siblings.iter().take_while(|node| is_own(node)).count() == nodes.len();
        let before_all = siblings
            .iter()
            .rev()
            .take_while(|node| is_own(node))
            .count()
            == nodes.len();
        let mut others = siblings.iter().filter(|node| !is_own(node));
        let first = nodes.first().map_or(0, |node| node.range().start);
        let last = nodes.last().map_or(0, |node| node.range().start);
        let (target, is_behind_it) = match to {
            Stacking::Front if !before_all => (others.next_back(), false),
            Stacking::Back if !behind_all => (others.next(), true),
            Stacking::Forward if !before_all => {
                (others.find(|node| node.range().start > last), false)
            }
            Stacking::Backward if !behind_all => {
                (others.rfind(|node| node.range().start < first), true)
            }
            _ => return Ok(vec![]),
        };
        let Some(target) = target else {
            return Ok(vec![]);
        };
        let source = &*self.source;
        let at = match is_behind_it {
            true => with_space_before(source, *target).start,
            false => target.range().end,
        };
        let spans: Vec<Span> = nodes
            .iter()
            .map(|node| with_space_before(source, *node))
            .collect();
        let cut = spans.iter().map(|span| Edit {
            span: *span,
            text: String::new(),
        });
        let mut edits: Vec<Edit> = cut.collect();
        let texts = spans.iter().map(|span| &source[span.start..span.end]);
        edits.push(Edit {
            span: Span::at(at),
            text: texts.collect(),
        });
        Ok(edits)
    }
}
