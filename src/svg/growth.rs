//! Estimates how much a drawing grows when its references are expanded, before usvg expands them.
//!
//! Patterns filled with patterns, nested clips, masks and markers, and clones of clones can expand to more shapes than fit
//! into memory.

use roxmltree::{Document, Node, NodeId};
use rustc_hash::FxHashMap;

use super::elements::{Ids, start_tag};
use super::prepare::Prepared;
use super::style::Styles;
use crate::diagnostic::{Code, Diagnostic};
use crate::threads::nesting_limit;

/// How many elements a drawing may expand to, if it has fewer than twice as many bytes.
const LEAST: u64 = 1 << 19;
/// How many elements the largest drawings may expand to.
const MOST: u64 = 1 << 22;

/// How many elements its clones may expand to. Each becomes a part.
const MOST_CLONED: u64 = 100_000;

/// How many vertices of paths its clones may draw.
const MOST_CLONED_CORNERS: u64 = 2_000_000;

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
        blamed_clone: None,
        has_detailed_clones: false,
        has_references: prepared.draws_again,
        most: (prepared.text.len() as u64 / 2).clamp(LEAST, MOST),
    };
    let most = growth.most;
    let Size { elements, .. } = growth.size(document.root_element());
    if let Some(clone) = growth.blamed_clone.and_then(|node| document.get_node(node)) {
        let message = if growth.has_detailed_clones {
            format!("clones draw more than {MOST_CLONED_CORNERS} points")
        } else {
            format!("clones expand to more than {MOST_CLONED} elements")
        };
        let help = "use fewer clones, or split the drawing into several files";
        return Err(Box::new(
            Diagnostic::new(Code::LimitPassed, start_tag(clone, prepared), message).help(help),
        ));
    }
    if elements <= most {
        return Ok(());
    }
    let blamed = growth.blamed.and_then(|node| document.get_node(node));
    let span = start_tag(blamed.unwrap_or(document.root_element()), prepared);
    let what = "nested clones, patterns, clips, masks or markers";
    let message = if growth.too_deep {
        format!("{what} are more than {} levels deep", nesting_limit())
    } else {
        format!("{what} expand to more than {most} elements")
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
    /// The elements among them that clones draw.
    cloned: u64,
    /// The vertices among those below that clones draw.
    cloned_corners: u64,
    /// The shapes among them that are drawn in place, and the number of their vertices.
    shapes: u64,
    corners: u64,
}

struct Growth<'a, 'input> {
    document: &'a Document<'input>,
    styles: &'a Styles<'a>,
    ids: &'a Ids<'a>,
    /// The sizes of what references draw; zero while a definition is being expanded, in case it refers to itself.
    known: FxHashMap<NodeId, Size>,
    /// The number of nested definitions that are being expanded.
    depth: usize,
    too_deep: bool,
    /// The innermost element that grows beyond the limit.
    blamed: Option<NodeId>,
    /// The innermost element whose clones grow beyond their limit.
    blamed_clone: Option<NodeId>,
    /// Whether these are few, but have very many vertices.
    has_detailed_clones: bool,
    /// Whether there are definitions that are drawn again at each reference, besides clones.
    has_references: bool,
    /// How many elements the drawing may expand to.
    most: u64,
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
                size.cloned = size.cloned.saturating_add(inner.cloned);
                size.cloned_corners = size.cloned_corners.saturating_add(inner.cloned_corners);
                size.shapes = size.shapes.saturating_add(inner.shapes);
                size.corners = size.corners.saturating_add(inner.corners);
            }
        }
        if node.tag_name().name() == "use" {
            let target = self.cloned_size(node);
            size.elements = size.elements.saturating_add(target.elements);
            size.cloned = size.cloned.saturating_add(target.elements);
            size.shapes = target.shapes;
            size.corners = target.corners;
            size.cloned_corners = size.cloned_corners.saturating_add(target.corners);
        }
        let is_detailed = size.cloned_corners > MOST_CLONED_CORNERS;
        if (size.cloned > MOST_CLONED || is_detailed) && self.blamed_clone.is_none() {
            self.blamed_clone = Some(node.id());
            self.has_detailed_clones = is_detailed && size.cloned <= MOST_CLONED;
        }
        if size.shapes == 0 {
            let corners = node.attribute("d").or_else(|| node.attribute("points"));
            // Two numbers per vertex, each preceded by a separator.
            let parts = |text: &str| text.split([' ', ',', '\n', '-']).count() as u64;
            size.shapes = 1;
            size.corners = 2 + corners.map_or(0, parts) / 2;
        }
        if !self.has_references {
            return size;
        }
        let of = [(INHERITED, size.shapes), (MARKERS, size.corners), (OWN, 1)];
        for (properties, times) in of {
            for property in properties {
                let grown = self.target(node, property).saturating_mul(times);
                size.elements = size.elements.saturating_add(grown);
            }
        }
        if size.elements > self.most && self.blamed.is_none() {
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
        self.expanded(target).elements
    }

    /// The size of what a clone draws.
    fn cloned_size(&mut self, clone: Node<'a, 'input>) -> Size {
        let mut attributes = clone.attributes();
        let href = attributes.find(|attribute| attribute.name() == "href");
        let id = href.and_then(|href| href.value().trim().strip_prefix('#'));
        let target = id.and_then(|id| self.document.get_node(self.ids.get(id)?));
        target.map_or(Size::default(), |target| self.expanded(target))
    }

    /// The size of an element that is drawn at each reference.
    fn expanded(&mut self, target: Node<'a, 'input>) -> Size {
        if let Some(known) = self.known.get(&target.id()) {
            return *known;
        }
        if self.depth >= nesting_limit() {
            // usvg expands references recursively.
            self.too_deep = true;
            let elements = self.most + 1;
            return Size {
                elements,
                ..Size::default()
            };
        }
        self.known.insert(target.id(), Size::default());
        self.depth += 1;
        let size = self.size(target);
        self.depth -= 1;
        self.known.insert(target.id(), size);
        size
    }
}

#[cfg(test)]
pub(super) mod tests {
    use crate::diagnostic::Code;
    use crate::resolver::MemoryResolver;

    /// The limit that a drawing with this content passes, if it does.
    pub(in crate::svg) fn refused(body: &str) -> Option<String> {
        let text = format!(
            "<svg xmlns='http://www.w3.org/2000/svg' xmlns:xlink='http://www.w3.org/1999/xlink' width='9' height='9'>{body}</svg>"
        );
        let (drawing, diagnostics) = crate::svg::read(
            &text,
            0.001,
            &MemoryResolver::default(),
            &|_| vec![].into(),
            &|_, _| false,
        );
        let refused = diagnostics
            .into_iter()
            .find(|found| found.code == Code::LimitPassed)?;
        assert!(drawing.shapes.is_empty());
        Some(refused.message)
    }

    /// Groups of ten clones of the group before.
    fn clones(levels: usize) -> String {
        let first = "<g id='g0'><rect width='1' height='1'/></g>".to_owned();
        (1..=levels).fold(first, |text, level| {
            let clones = format!("<use xlink:href='#g{}'/>", level - 1).repeat(10);
            format!("{text}<g id='g{level}'>{clones}</g>")
        })
    }

    #[test]
    fn clones_of_clones_are_counted_before_they_are_made() {
        assert_eq!(refused(&clones(3)), None);
        let message = "clones expand to more than 100000 elements";
        for levels in [6, 40] {
            assert_eq!(refused(&clones(levels)).as_deref(), Some(message));
        }
        let flat =
            "<defs><g id='a'><rect width='1' height='1'/><rect width='1' height='1'/></g></defs>";
        let many = format!("{flat}{}", "<use href='#a'/>".repeat(40_000));
        assert_eq!(refused(&many).as_deref(), Some(message));
        let detailed = format!("<path id='a' d='M{}'/>", "1 2 ".repeat(10_000));
        let many = |count| format!("{detailed}{}", "<use href='#a'/>".repeat(count));
        assert_eq!(refused(&many(100)), None);
        let message = "clones draw more than 2000000 points";
        assert_eq!(refused(&many(250)).as_deref(), Some(message));
        // What refers to itself is not drawn.
        assert_eq!(refused("<g id='a'><use href='#a'/></g>"), None);
    }
}
