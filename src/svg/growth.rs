//! Estimates how much a drawing grows when its references are expanded, before usvg expands them.
//!
//! Patterns filled with patterns, or nested clips, masks and markers, can expand to more shapes than fit into memory.
//! Clones are not counted here: usvg itself limits them.

use roxmltree::{Document, Node, NodeId};
use rustc_hash::FxHashMap;

use super::elements::{Ids, start_tag};
use super::prepare::{MAX_DEPTH, Prepared};
use super::style::Styles;
use crate::diagnostic::{Code, Diagnostic};

/// How many elements a drawing may expand to.
const MOST: u64 = 1 << 22;

/// Definitions that are drawn again at each reference.
pub(super) const DRAWN_AGAIN: &[&str] = &["pattern", "clipPath", "mask", "marker"];
/// Elements that are drawn only where they are referenced.
const DEFINITIONS: &[&str] = &[
    "defs", "symbol", "pattern", "clipPath", "mask", "marker", "filter",
];
/// Properties that count for every shape below their element.
const INHERITED: &[&str] = &["fill", "stroke"];
/// Inherited properties whose target is drawn at a path's vertices.
const MARKERS: &[&str] = &["marker", "marker-start", "marker-mid", "marker-end"];
/// Properties that count once.
const OWN: &[&str] = &["clip-path", "mask"];

/// Rejects a drawing that grows beyond the limit.
pub(super) fn check(
    document: &Document<'_>,
    prepared: &Prepared,
    styles: &Styles<'_>,
    ids: &Ids<'_>,
) -> Result<(), Box<Diagnostic>> {
    let mut growth = Growth {
        document,
        styles,
        ids,
        known: FxHashMap::default(),
        depth: 0,
        too_deep: false,
        blamed: None,
    };
    let Size { elements, .. } = growth.size(document.root_element());
    if elements <= MOST {
        return Ok(());
    }
    let blamed = growth.blamed.and_then(|node| document.get_node(node));
    let span = start_tag(blamed.unwrap_or(document.root_element()), prepared);
    let what = "nested patterns, clips, masks or markers";
    let message = match growth.too_deep {
        true => format!("{what} are more than {MAX_DEPTH} levels deep"),
        false => format!("{what} expand to more than {MOST} elements"),
    };
    let help = "remove the nesting: use patterns of plain shapes, and clips of a single path";
    Err(Box::new(
        Diagnostic::new(Code::LimitPassed, span, message).help(help),
    ))
}

/// The size of an expanded element.
#[derive(Clone, Copy, Default)]
struct Size {
    elements: u64,
    /// The shapes among them that are drawn in place, and the number of their vertices.
    shapes: u64,
    corners: u64,
}

struct Growth<'a, 'input> {
    document: &'a Document<'input>,
    styles: &'a Styles<'a>,
    ids: &'a Ids<'a>,
    /// The sizes of expanded definitions; zero while a definition is being expanded, in case it refers to itself.
    known: FxHashMap<NodeId, u64>,
    /// The number of nested definitions that are being expanded.
    depth: usize,
    too_deep: bool,
    /// The innermost element that grows beyond the limit.
    blamed: Option<NodeId>,
}

impl<'a, 'input> Growth<'a, 'input> {
    fn size(&mut self, node: Node<'a, 'input>) -> Size {
        let mut size = Size {
            elements: 1,
            ..Size::default()
        };
        for child in node.children().filter(Node::is_element) {
            if !DEFINITIONS.contains(&child.tag_name().name()) {
                let inner = self.size(child);
                size.elements = size.elements.saturating_add(inner.elements);
                size.shapes += inner.shapes;
                size.corners += inner.corners;
            }
        }
        if size.shapes == 0 {
            let corners = node.attribute("d").or_else(|| node.attribute("points"));
            // Two numbers per vertex, each preceded by a separator.
            let parts = |text: &str| text.split([' ', ',', '\n', '-']).count() as u64;
            size.shapes = 1;
            size.corners = 2 + corners.map_or(0, parts) / 2;
        }
        let of = [(INHERITED, size.shapes), (MARKERS, size.corners), (OWN, 1)];
        for (properties, times) in of {
            for property in properties {
                let grown = self.target(node, property).saturating_mul(times);
                size.elements = size.elements.saturating_add(grown);
            }
        }
        if size.elements > MOST && self.blamed.is_none() {
            self.blamed = Some(node.id());
        }
        size
    }

    /// The size of the definition that a property refers to.
    fn target(&mut self, node: Node<'a, 'input>, property: &str) -> u64 {
        let id = self.styles.own(node, property).and_then(|value| {
            let (_, rest) = value.split_once("url(")?;
            let (link, _) = rest.split_once(')')?;
            link.trim_matches(['"', '\'', ' ']).strip_prefix('#')
        });
        let target = id.and_then(|id| self.document.get_node(self.ids.get(id)?));
        let Some(target) = target.filter(|target| DRAWN_AGAIN.contains(&target.tag_name().name()))
        else {
            return 0;
        };
        if let Some(known) = self.known.get(&target.id()) {
            return *known;
        }
        if self.depth >= MAX_DEPTH {
            // usvg expands references recursively.
            self.too_deep = true;
            return MOST + 1;
        }
        self.known.insert(target.id(), 0);
        self.depth += 1;
        let Size { elements, .. } = self.size(target);
        self.depth -= 1;
        self.known.insert(target.id(), elements);
        elements
    }
}
