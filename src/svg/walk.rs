//! Walks usvg's tree: finds the leaves that become shapes, and their groups.

use std::sync::Arc;

use glam::{DAffine2, DVec2};
use roxmltree::{Node, NodeId};
use rustc_hash::{FxHashMap, FxHashSet};
use typed_index_collections::TiVec;

use super::clip::Clip;
use super::dropped::Users;
use super::elements::{Ids, element};
use super::paths::affine;
use super::poses::PoseNodes;
use super::prepare::Prepared;
use super::style::Styles;
use super::unsolid::Feature;
use super::{Group, GroupId, GroupKind, TransparencyGroupId};
use crate::geometry::Outline;

/// A usvg node that becomes a shape.
pub(super) struct Task<'a> {
    pub(super) node: Leaf<'a>,
    /// See [`Shape::leaf`](super::Shape::leaf).
    pub(super) leaf: usize,
    pub(super) xml: NodeId,
    pub(super) group: GroupId,
    pub(super) opacity: f64,
    /// The innermost transparency group around it.
    pub(super) transparency_group: Option<TransparencyGroupId>,
    pub(super) clips: Option<Arc<Vec<Clip>>>,
}

/// What a group passes on to what is in it.
#[derive(Clone, Copy)]
pub(super) struct Inherited<'c> {
    /// Its element.
    xml: NodeId,
    opacity: f64,
    transparency_group: Option<TransparencyGroupId>,
    clips: Option<&'c Arc<Vec<Clip>>>,
}

impl Inherited<'_> {
    /// What the outermost element passes on.
    pub(super) fn by_root(xml: NodeId) -> Self {
        Self {
            xml,
            opacity: 1.0,
            transparency_group: None,
            clips: None,
        }
    }
}

impl Task<'_> {
    /// How many points are drawn, of an image its corners.
    pub(super) fn point_count(&self) -> usize {
        match self.node {
            Leaf::Path(path) => path.data().points().len(),
            Leaf::Image(_) => 4,
        }
    }

    /// Whether it has a stroke whose width on the page is not the one that is written, by more than a hundredth.
    fn has_scaled_stroke(&self) -> bool {
        let Leaf::Path(path) = self.node else {
            return false;
        };
        let scale = affine(path.abs_transform()).matrix2.determinant().abs();
        path.stroke().is_some() && (scale.sqrt() - 1.0).abs() > 0.01
    }

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
pub(super) struct Walk<'a, 'input> {
    pub(super) prepared: &'a Prepared,
    /// The pose layers, in which nothing is a shape of the drawing.
    pub(super) poses: &'a PoseNodes,
    pub(super) root: Node<'a, 'input>,
    pub(super) by_id: Ids<'a>,
    /// For each XML node, the group that it is or is in; `None` if unknown.
    pub(super) group_of: Vec<Option<GroupId>>,
    pub(super) groups: TiVec<GroupId, Group>,
    /// The rectangles that elements are clipped to.
    pub(super) frames: FxHashMap<NodeId, (DVec2, DVec2)>,
    pub(super) tasks: Vec<Task<'a>>,
    /// How many leaves were passed.
    pub(super) leaves: usize,
    pub(super) tolerance: f64,
    pub(super) page: DAffine2,
    /// The elements that use features without a meaning for solids, by feature.
    pub(super) unsolid: Vec<(Feature, Vec<NodeId>)>,
    /// Whether shapes of markers were left out.
    pub(super) has_markers: bool,
    /// See [`Drawing::transparency_groups`](super::Drawing::transparency_groups).
    pub(super) transparency_groups: TiVec<TransparencyGroupId, Option<TransparencyGroupId>>,
}

impl<'a> Walk<'a, '_> {
    /// The group that an element is, or the innermost group that contains it.
    pub(super) fn group(&mut self, node: Node<'_, '_>) -> GroupId {
        let slot = node.id().get_usize();
        if let Some(known) = self.group_of[slot] {
            return known;
        }
        let parent = node.parent_element().map(|parent| self.group(parent));
        let around = parent.unwrap_or(GroupId::ROOT);
        let group = match group_kind(node) {
            None => around,
            Some(kind) => {
                let element = element(node, self.prepared);
                let is_moved = node.has_attribute("transform")
                    || node
                        .attribute("style")
                        .is_some_and(|style| style.contains("transform"))
                    || !(kind == GroupKind::Root || node.tag_name().name() == "g");
                let around_is_moved =
                    parent.is_some_and(|parent| !self.groups[parent].is_untransformed);
                self.groups.push_and_get_key(Group {
                    parent: around,
                    kind,
                    is_untransformed: !is_moved && !around_is_moved,
                    frame: self.frames.get(&node.id()).copied(),
                    element,
                })
            }
        };
        self.group_of[slot] = Some(group);
        group
    }

    pub(super) fn children(&mut self, group: &'a usvg::Group, inherited: Inherited<'_>) {
        for node in group.children() {
            match node {
                usvg::Node::Group(inner) => self.inner(inner, inherited),
                usvg::Node::Path(path) if path.is_visible() => {
                    self.leaf(Leaf::Path(path), path.id(), inherited);
                }
                usvg::Node::Image(image) if image.is_visible() => {
                    self.leaf(Leaf::Image(image), image.id(), inherited);
                }
                _ => {}
            }
        }
    }

    fn inner(&mut self, group: &'a usvg::Group, inherited: Inherited<'_>) {
        let own = self.by_id.get(group.id());
        let user = || {
            own.or_else(|| self.by_id.get(only_leaf(group)?))
                .unwrap_or(inherited.xml)
        };
        let features = [
            (Feature::Mask, group.mask().is_some()),
            (Feature::Filter, !group.filters().is_empty()),
            (
                Feature::Blending,
                group.blend_mode() != usvg::BlendMode::Normal,
            ),
        ];
        let is_posed = own.is_some_and(|own| self.poses.hold(own));
        let used = features.into_iter();
        let used = used.filter(|(_, used)| *used && !is_posed);
        let used: Vec<_> = used.map(|(feature, _)| (feature, user())).collect();
        for (feature, user) in used {
            self.note(feature, user);
        }
        let opacity = f64::from(group.opacity().get());
        let around = inherited.transparency_group;
        let transparency_group = if opacity < 1.0 {
            Some(self.transparency_groups.push_and_get_key(around))
        } else {
            around
        };
        let inherited = Inherited {
            xml: own.unwrap_or(inherited.xml),
            opacity: inherited.opacity * opacity,
            transparency_group,
            ..inherited
        };
        match group.clip_path() {
            None => self.children(group, inherited),
            Some(clip) => {
                let mut all = inherited
                    .clips
                    .map(|clips| Vec::clone(clips))
                    .unwrap_or_default();
                let own = Clip::read(
                    clip,
                    self.page * affine(group.abs_transform()),
                    self.tolerance,
                );
                if let Some(frame) = own.first().and_then(|clip| clip.rectangle) {
                    self.frames.insert(inherited.xml, frame);
                }
                all.extend(own);
                let all = Arc::new(all);
                let inherited = Inherited {
                    clips: Some(&all),
                    ..inherited
                };
                self.children(group, inherited);
            }
        }
    }

    /// Notes that an element uses a feature without a meaning for solids.
    fn note(&mut self, feature: Feature, user: NodeId) {
        let known = self.unsolid.iter_mut().find(|(other, _)| *other == feature);
        match known {
            Some((_, users)) => users.push(user),
            None => self.unsolid.push((feature, vec![user])),
        }
    }

    /// Notes the elements that have markers, whose shapes are left out.
    pub(super) fn note_markers(&mut self, styles: &Styles<'_>) {
        if !self.has_markers {
            return;
        }
        let document = self.root.document();
        let has_marker = |node: Node<'_, '_>| {
            let mut values = MARKERS
                .iter()
                .map(|property| styles.inherited(node, property));
            values.any(|value| value.is_some_and(|value| value.starts_with("url")))
        };
        let paths = self
            .tasks
            .iter()
            .filter(|task| matches!(task.node, Leaf::Path(_)));
        let nodes: Vec<NodeId> = paths
            .map(|task| task.xml)
            .filter(|id| document.get_node(*id).is_some_and(has_marker))
            .collect();
        for node in nodes {
            self.note(Feature::Marker, node);
        }
    }

    /// Notes the elements that use what is not read. Strokes that keep their widths are of interest only where they are scaled.
    pub(super) fn note_dropped(&mut self, dropped: Users) {
        for (feature, mut nodes) in dropped {
            if feature == Feature::FixedWidth {
                let tasks = self.tasks.iter().filter(|task| task.has_scaled_stroke());
                let scaled: FxHashSet<NodeId> = tasks.map(|task| task.xml).collect();
                nodes.retain(|node| scaled.contains(node));
            }
            if !nodes.is_empty() {
                self.unsolid.push((feature, nodes));
            }
        }
    }

    fn leaf(&mut self, leaf: Leaf<'a>, id: &str, inherited: Inherited<'_>) {
        let number = self.leaves;
        self.leaves += 1;
        let own = self.by_id.get(id);
        let Some(node) = self.root.document().get_node(own.unwrap_or(inherited.xml)) else {
            return;
        };
        if self.poses.hold(node.id()) {
            return;
        }
        // Of paths, only those that a clone or a marker draws have no element of their own.
        let is_path = matches!(leaf, Leaf::Path(_));
        if own.is_none() && is_path && node.tag_name().name() != "use" {
            self.has_markers = true;
            return;
        }
        if node == self.root {
            return;
        }
        let xml = node.id();
        let group = self.group(node);
        self.tasks.push(Task {
            node: leaf,
            leaf: number,
            xml,
            group,
            opacity: inherited.opacity,
            transparency_group: inherited.transparency_group,
            clips: inherited.clips.cloned(),
        });
    }
}

/// The properties whose targets are drawn at a path's vertices.
const MARKERS: [&str; 4] = ["marker", "marker-start", "marker-mid", "marker-end"];

/// The kind of group that an element is, if it is one.
pub(super) fn group_kind(node: Node<'_, '_>) -> Option<GroupKind> {
    let layer = node.attributes().any(|attribute| {
        attribute.name() == "groupmode"
            && attribute.namespace().is_some()
            && attribute.value() == "layer"
    });
    match node.tag_name().name() {
        _ if node.parent_element().is_none() => Some(GroupKind::Root),
        "g" if layer => Some(GroupKind::Layer),
        "g" | "a" | "switch" | "svg" | "use" => Some(GroupKind::Group),
        _ => None,
    }
}

/// The id of the path or the image that is all a group holds. usvg wraps a shape that has a mask or a filter in a group
/// without an id.
fn only_leaf(group: &usvg::Group) -> Option<&str> {
    match group.children() {
        [usvg::Node::Group(inner)] if inner.id().is_empty() => only_leaf(inner),
        [usvg::Node::Group(inner)] => Some(inner.id()),
        [usvg::Node::Path(path)] => Some(path.id()),
        [usvg::Node::Image(image)] => Some(image.id()),
        _ => None,
    }
}
