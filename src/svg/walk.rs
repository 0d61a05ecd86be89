//! Walks usvg's tree: finds the leaves that become shapes, and their groups.

use std::sync::Arc;

use glam::DAffine2;
use roxmltree::{Node, NodeId};

use super::clip::Clip;
use super::elements::{Ids, element, start_tag};
use super::paths::affine;
use super::prepare::Prepared;
use super::{Group, GroupKind};
use crate::diagnostic::{Code, Diagnostic};
use crate::geometry::Outline;

/// A usvg node that becomes a shape.
pub(super) struct Task<'a> {
    pub(super) node: Leaf<'a>,
    pub(super) xml: NodeId,
    pub(super) group: usize,
    pub(super) opacity: f64,
    pub(super) clips: Option<Arc<Vec<Clip>>>,
}

impl Task<'_> {
    /// The part of an outline inside the clips.
    pub(super) fn clip(&self, outline: Outline) -> Outline {
        let clips = self.clips.iter().flat_map(|clips| clips.iter());
        clips.fold(outline, |outline, clip| clip.cut(outline))
    }
}

pub(super) enum Leaf<'a> {
    Path(&'a usvg::Path),
    Image(&'a usvg::Image),
}

/// The state of the walk over usvg's tree.
pub(super) struct Walk<'a, 'input, 'd> {
    pub(super) prepared: &'a Prepared,
    pub(super) root: Node<'a, 'input>,
    pub(super) by_id: Ids<'a>,
    /// For each XML node, the group that it is or is in; `usize::MAX` if unknown.
    pub(super) group_of: Vec<usize>,
    pub(super) groups: Vec<Group>,
    pub(super) tasks: Vec<Task<'a>>,
    pub(super) tolerance: f64,
    pub(super) page: DAffine2,
    pub(super) diagnostics: &'d mut Vec<Diagnostic>,
}

impl<'a> Walk<'a, '_, '_> {
    /// The group that an element is, or the innermost group that contains it.
    pub(super) fn group(&mut self, node: Node<'_, '_>) -> usize {
        let slot = node.id().get_usize();
        if self.group_of[slot] != usize::MAX {
            return self.group_of[slot];
        }
        let parent = node.parent_element().map(|parent| self.group(parent));
        let layer = node.attributes().any(|attribute| {
            attribute.name() == "groupmode"
                && attribute.namespace().is_some()
                && attribute.value() == "layer"
        });
        let group = match (parent, node.tag_name().name()) {
            (None, _) => Some(GroupKind::Root),
            (_, "g") if layer => Some(GroupKind::Layer),
            (_, "g" | "a" | "switch" | "svg" | "use") => Some(GroupKind::Group),
            _ => None,
        };
        let index = match group {
            None => parent.unwrap_or(0),
            Some(kind) => {
                let element = element(node, self.prepared);
                self.groups.push(Group {
                    parent: parent.unwrap_or(0),
                    kind,
                    element,
                });
                self.groups.len() - 1
            }
        };
        self.group_of[slot] = index;
        index
    }

    pub(super) fn children(
        &mut self,
        group: &'a usvg::Group,
        xml: NodeId,
        opacity: f64,
        clips: Option<&Arc<Vec<Clip>>>,
    ) {
        for node in group.children() {
            match node {
                usvg::Node::Group(inner) => self.inner(inner, xml, opacity, clips),
                usvg::Node::Path(path) if path.is_visible() => {
                    self.leaf(Leaf::Path(path), path.id(), xml, opacity, clips);
                }
                usvg::Node::Image(image) if image.is_visible() => {
                    self.leaf(Leaf::Image(image), image.id(), xml, opacity, clips);
                }
                _ => {}
            }
        }
    }

    fn inner(
        &mut self,
        group: &'a usvg::Group,
        xml: NodeId,
        opacity: f64,
        clips: Option<&Arc<Vec<Clip>>>,
    ) {
        let xml = self.by_id.get(group.id()).unwrap_or(xml);
        if group.mask().is_some() {
            self.no_solid_meaning(
                xml,
                "mask",
                "the part is built without the mask; cut the shape itself instead",
            );
        }
        if !group.filters().is_empty() {
            self.no_solid_meaning(
                xml,
                "filter",
                "the part is built without the filter's effect",
            );
        }
        let opacity = opacity * f64::from(group.opacity().get());
        match group.clip_path() {
            None => self.children(group, xml, opacity, clips),
            Some(clip) => {
                let mut all = clips.map(|clips| Vec::clone(clips)).unwrap_or_default();
                all.extend(Clip::read(
                    clip,
                    self.page * affine(group.abs_transform()),
                    self.tolerance,
                ));
                self.children(group, xml, opacity, Some(&Arc::new(all)));
            }
        }
    }

    fn no_solid_meaning(&mut self, xml: NodeId, what: &str, help: &'static str) {
        let Some(node) = self.root.document().get_node(xml) else {
            return;
        };
        let span = start_tag(node, self.prepared);
        let message = format!("a {what} has no meaning for solids");
        self.diagnostics
            .push(Diagnostic::new(Code::NoSolidMeaning, span, message).help(help));
    }

    fn leaf(
        &mut self,
        leaf: Leaf<'a>,
        id: &str,
        xml: NodeId,
        opacity: f64,
        clips: Option<&Arc<Vec<Clip>>>,
    ) {
        let xml = self.by_id.get(id).unwrap_or(xml);
        let Some(node) = self
            .root
            .document()
            .get_node(xml)
            .filter(|node| node.parent_element().is_some())
        else {
            return;
        };
        let group = self.group(node);
        self.tasks.push(Task {
            node: leaf,
            xml,
            group,
            opacity,
            clips: clips.cloned(),
        });
    }
}
