//! What a drawing holds but does not show: hidden layers, and texts that were converted to paths.

use std::sync::Arc;

use roxmltree::Node;

use super::elements::{NOT_DRAWN, element};
use super::prepare::Prepared;
use super::style::Styles;
use super::{Element, GroupKind, text};
use crate::source::{Span, Text};

/// A hidden layer, group or shape.
#[derive(Debug, Clone)]
pub struct Hidden {
    /// The element that hides itself and all that it holds.
    pub element: Element,
    /// Its kind, if it is a group.
    pub kind: Option<GroupKind>,
    /// The texts that are hidden with it.
    pub texts: Vec<Arc<Text>>,
    /// The number of shapes that are hidden with it.
    pub shapes: usize,
}

/// A text that was converted to paths: no text any more, but drawing programs keep what it said (`aria-label`).
#[derive(Debug, Clone)]
pub struct ConvertedText {
    /// What it said.
    pub text: String,
    /// Its element, a group or a path.
    pub element: Element,
    /// The element's first byte and the one after its last.
    pub whole: Span,
}

/// What a drawing holds but does not show.
#[derive(Debug, Clone, Default)]
pub struct Unseen {
    /// What is hidden, in document order.
    pub hidden: Vec<Hidden>,
    /// The texts that were converted to paths.
    pub converted: Vec<ConvertedText>,
}

/// Elements that are seen, if they are not hidden.
const SHAPES: &[&str] = &[
    "path", "rect", "circle", "ellipse", "polygon", "polyline", "line", "image", "use",
];

/// Finds what is not shown.
pub(super) fn read(
    document: &roxmltree::Document<'_>,
    styles: &Styles<'_>,
    prepared: &Prepared,
) -> Unseen {
    let mut unseen = Unseen::default();
    let may_hide = ["display", "visibility"];
    let may_hide = may_hide.iter().any(|word| prepared.text.contains(word));
    let may_be_converted = prepared.text.contains("aria-label");
    if !may_hide && !may_be_converted {
        return unseen;
    }
    let mut walk = Walk {
        styles,
        prepared,
        unseen: &mut unseen,
        of_node: vec![State::Shown; document.descendants().count() + 1],
    };
    for node in document.descendants().filter(Node::is_element) {
        walk.visit(node);
    }
    unseen
}

/// Whether an element is shown.
#[derive(Clone, Copy, PartialEq, Eq)]
enum State {
    Shown,
    /// Not drawn in its place, as a definition is not.
    Elsewhere,
    /// Hidden by `visibility`, which an element in it can undo.
    Invisible(usize),
    /// Hidden by `display`.
    Gone(usize),
}

struct Walk<'a, 'b> {
    styles: &'a Styles<'a>,
    prepared: &'a Prepared,
    unseen: &'b mut Unseen,
    of_node: Vec<State>,
}

impl Walk<'_, '_> {
    /// Visits an element; the elements that hold it have been visited.
    fn visit(&mut self, node: Node<'_, '_>) {
        let parent = node.parent_element();
        let outer = parent.map_or(State::Shown, |parent| self.of_node[parent.id().get_usize()]);
        let state = self.state(node, outer);
        self.of_node[node.id().get_usize()] = state;
        let tag = node.tag_name().name();
        match state {
            State::Elsewhere => {}
            State::Shown => self.shown(node),
            State::Invisible(by) | State::Gone(by) => {
                let hidden = &mut self.unseen.hidden[by];
                if matches!(tag, "text" | "flowRoot") {
                    hidden
                        .texts
                        .push(Arc::new(text::content(node, self.prepared)));
                } else if SHAPES.contains(&tag) {
                    hidden.shapes += 1;
                }
            }
        }
    }

    fn state(&mut self, node: Node<'_, '_>, outer: State) -> State {
        if matches!(outer, State::Gone(_) | State::Elsewhere) {
            return outer;
        }
        if NOT_DRAWN.contains(&node.tag_name().name()) {
            return State::Elsewhere;
        }
        if self.styles.own(node, "display") == Some("none") {
            return State::Gone(self.hides(node));
        }
        match self.styles.own(node, "visibility") {
            Some("hidden" | "collapse") => match outer {
                State::Invisible(_) => outer,
                _ => State::Invisible(self.hides(node)),
            },
            Some("visible") => State::Shown,
            _ => outer,
        }
    }

    /// Adds an element that hides what it holds.
    fn hides(&mut self, node: Node<'_, '_>) -> usize {
        self.unseen.hidden.push(Hidden {
            element: element(node, self.prepared),
            kind: super::walk::group_kind(node),
            texts: vec![],
            shapes: 0,
        });
        self.unseen.hidden.len() - 1
    }

    fn shown(&mut self, node: Node<'_, '_>) {
        let converted = matches!(node.tag_name().name(), "g" | "path");
        if let Some(said) = node.attribute("aria-label").filter(|_| converted) {
            self.unseen.converted.push(ConvertedText {
                text: said.to_owned(),
                element: element(node, self.prepared),
                whole: self.prepared.span(node.range()),
            });
        }
    }
}
