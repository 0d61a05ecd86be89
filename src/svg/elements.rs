//! XML elements: their positions and names, and which of them are texts.

use std::sync::Arc;

use rayon::prelude::*;
use roxmltree::{Node, NodeId};
use rustc_hash::FxHashMap;

use super::poses::PoseNodes;
use super::prepare::{JOINED, Prepared, own_id};
use super::style::Styles;
use super::{DescSlot, Element, text};
use crate::diagnostic::Edit;
use crate::source::{Span, end_of_tag, escape_xml};

/// The namespace of Affinity's attributes.
const SERIF: &str = "http://www.serif.com/";

/// The elements by id; the first of several elements with the same id.
pub(super) struct Ids<'a> {
    /// The prefix of injected ids; a number follows.
    prefix: &'a str,
    injected: Vec<Option<NodeId>>,
    own: FxHashMap<&'a str, NodeId>,
}

impl<'a> Ids<'a> {
    pub(super) fn read(document: &'a roxmltree::Document<'_>, prepared: &'a Prepared) -> Self {
        let mut ids = Self {
            prefix: &prepared.id_prefix,
            injected: vec![None; prepared.id_count + 1],
            own: FxHashMap::default(),
        };
        for node in document.descendants().filter(Node::is_element) {
            let Some(id) = node.attribute("id") else {
                continue;
            };
            match ids.number(id) {
                Some(number) => {
                    ids.injected[number].get_or_insert(node.id());
                }
                None => {
                    ids.own.entry(id).or_insert(node.id());
                }
            }
        }
        ids
    }

    pub(super) fn get(&self, id: &str) -> Option<NodeId> {
        match self.number(id) {
            Some(number) => self.injected[number],
            None => self.own.get(id).copied(),
        }
    }

    /// The number of an injected id.
    fn number(&self, id: &str) -> Option<usize> {
        let number = id.strip_prefix(self.prefix)?.parse().ok();
        number.filter(|number| *number < self.injected.len())
    }
}

/// The original span of an element's opening bracket and name, short enough to underline.
pub(super) fn start_tag(node: Node<'_, '_>, prepared: &Prepared) -> Span {
    let start = node.range().start;
    let name = prepared.text[start..].find(|c: char| c.is_whitespace() || matches!(c, '>' | '/'));
    prepared.span(start..name.map_or(node.range().end, |end| start + end))
}

/// The tag's name, for elements that can become a part or a group.
fn known_tag(name: &str) -> &'static str {
    JOINED
        .iter()
        .find(|known| **known == name)
        .copied()
        .unwrap_or("element")
}

pub(super) fn element(node: Node<'_, '_>, prepared: &Prepared) -> Element {
    let given_id = node
        .attribute("id")
        .filter(|id| !id.starts_with(&prepared.id_prefix));
    let desc = node
        .children()
        .find(|child| child.is_element() && child.tag_name().name() == "desc");
    Element {
        span: start_tag(node, prepared),
        tag: known_tag(node.tag_name().name()),
        id: given_id.map(|id| own_id(id).into_owned()),
        label: label(node).map(str::to_owned),
        desc_slot: match desc {
            None => desc_slot(node, prepared),
            Some(_) => None,
        },
        desc: desc.map(|desc| Arc::new(text::content(desc, prepared))),
    }
}

/// The name that people see in the program that drew an element. Inkscape keeps it in `inkscape:label`; Affinity in `serif:id`
/// and Illustrator in `data-name`, where it cannot be the `id`.
fn label<'a>(node: Node<'a, '_>) -> Option<&'a str> {
    let attribute = |is_it: &dyn Fn(&str, Option<&str>) -> bool| {
        let mut attributes = node.attributes();
        let found = attributes.find(|attribute| is_it(attribute.name(), attribute.namespace()))?;
        Some(found.value())
    };
    attribute(&|name, space| name == "label" && space.is_some())
        .or_else(|| attribute(&|name, space| name == "id" && space == Some(SERIF)))
        .or_else(|| attribute(&|name, space| name == "data-name" && space.is_none()))
}

/// Where a description of an element can be inserted.
fn desc_slot(node: Node<'_, '_>, prepared: &Prepared) -> Option<DescSlot> {
    let start = node.range().start;
    let tag = &prepared.text[start + 1..];
    let name = tag.split(|c: char| c.is_whitespace() || matches!(c, '>' | '/'));
    let name = name.into_iter().next()?;
    // Declarations of namespaces are no attributes, and may come last.
    let last = node.attributes().map(|attribute| attribute.range().end);
    let from = last.max().unwrap_or(start + 1 + name.len());
    let end = end_of_tag(&prepared.text, from)?;
    let span = if prepared.text[..end].ends_with("/>") {
        prepared.span(end - 2..end)
    } else {
        prepared.span(end..end)
    };
    let prefix = name.strip_suffix(known_tag(node.tag_name().name()))?;
    Some(DescSlot {
        span,
        prefix: prefix.into(),
    })
}

impl Element {
    /// The edit that gives the element a description; `None` if it has one.
    pub fn with_description(&self, text: &str) -> Option<Edit> {
        let DescSlot { span, prefix } = self.desc_slot.as_ref()?;
        let desc = format!("<{prefix}desc>{}</{prefix}desc>", escape_xml(text));
        let text = if span.start == span.end {
            desc
        } else {
            format!(">{desc}</{prefix}{}>", self.tag)
        };
        Some(Edit { span: *span, text })
    }
}

/// The visible texts, in document order. Of those in pose layers only the strings that make them such layers, visible or not.
pub(super) fn labels<'a, 'input>(
    document: &'a roxmltree::Document<'input>,
    styles: &Styles<'_>,
    prepared: &Prepared,
    poses: &PoseNodes,
) -> Vec<(Node<'a, 'input>, text::Label)> {
    let drawn = |node: &Node<'_, '_>| {
        !node
            .ancestors()
            .any(|inner| NOT_DRAWN.contains(&inner.tag_name().name()))
    };
    let texts: Vec<_> = document
        .descendants()
        .filter(|node| node.is_element() && matches!(node.tag_name().name(), "text" | "flowRoot"))
        .filter(drawn)
        .collect();
    texts
        .into_par_iter()
        .filter_map(|node| {
            let label = if poses.are_made_by(node.id()) {
                text::read_hidden(node, styles, prepared)
            } else if poses.hold(node.id()) {
                None
            } else {
                text::read(node, styles, prepared)
            };
            Some((node, label?))
        })
        .collect()
}

/// Elements whose content is not drawn in place.
pub(super) const NOT_DRAWN: &[&str] = &[
    "defs", "symbol", "pattern", "clipPath", "mask", "marker", "metadata",
];
