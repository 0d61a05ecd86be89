//! Pose layers: layers of copies of shapes, which show where these are at another time. They are read whether they are shown or not, and
//! nothing in them is a shape of the drawing.

use std::sync::Arc;

use glam::{DAffine2, DVec2};
use roxmltree::{Node, NodeId};
use rustc_hash::{FxHashMap, FxHashSet};

use super::elements::{Ids, NOT_DRAWN, element};
use super::image::PictureSource;
use super::links::{parsing, styled_tree};
use super::paths::{affine, bez_path};
use super::prepare::{Prepared, prepare};
use super::style::Styles;
use super::walk::{Leaf, Task, group_kind};
use super::{Element, GroupId, text};
use crate::geometry::{Ring, flatten};
use crate::resolver::Resolver;
use crate::source::Text;

/// A function that says whether a text makes a pose layer of the group that holds it; the second argument says whether it is a
/// description.
pub(crate) type IsPose<'a> = &'a (dyn Fn(&Text, bool) -> bool + Sync);

/// The pose layers of a drawing, and what is in them.
#[derive(Debug, Clone, Default)]
pub(crate) struct Poses {
    /// The layers, in document order.
    pub layers: Vec<GroupId>,
    /// What is drawn in them, in paint order.
    pub copies: Vec<PosedShape>,
    /// The texts in them but for the strings that make them pose layers, in document order.
    pub texts: Vec<PosedText>,
    /// The paths of the drawing's shapes, by [`Shape::leaf`](super::Shape::leaf); empty if there are no pose layers.
    pub paths: FxHashMap<usize, DrawnPath>,
}

/// What is drawn in a pose layer: a path or a picture.
#[derive(Debug, Clone)]
pub(crate) struct PosedShape {
    /// The layer.
    pub layer: GroupId,
    /// Its element; for the content of a clone, the clone.
    pub element: Element,
    /// The groups around it within the layer, the innermost first.
    pub around: Vec<Element>,
    /// For the content of a clone, the number of the shape that it shows, as in [`Shape::leaf`](super::Shape::leaf).
    pub shows: Option<usize>,
    /// For the content of a clone, the id of what is cloned.
    pub cloned: Option<String>,
    /// Its path.
    pub path: DrawnPath,
}

/// A path as it is drawn, drawing units.
#[derive(Debug, Clone, Default)]
pub(crate) struct DrawnPath {
    /// Its points, those beside its curves included.
    pub points: Vec<DVec2>,
    /// Its lines without curves; open ones are rings, too.
    pub rings: Vec<Ring>,
}

/// A text in a pose layer.
#[derive(Debug, Clone)]
pub(crate) struct PosedText {
    /// The layer.
    pub layer: GroupId,
    /// What it says.
    pub text: Arc<Text>,
    /// The middle of its first line, drawing units.
    pub position: DVec2,
}

/// Where the pose layers of a document are.
#[derive(Debug, Default)]
pub(super) struct PoseNodes {
    /// The layers' elements, in document order.
    pub(super) layers: Vec<NodeId>,
    /// The texts that make them layers.
    strings: FxHashSet<NodeId>,
    /// Per node the innermost of the layers that it is or is in; empty if there are none.
    layer_of: FxHashMap<NodeId, NodeId>,
}

/// Marks the elements that are shown to see the copies.
const MARK: &str = " data-okoshi-pose=\"\"";
/// Shows them.
const STYLE: &str = "[data-okoshi-pose] { display: inline !important; visibility: visible !important; \
                     opacity: 1 !important; filter: none !important; mask: none !important; clip-path: none !important }";

impl PoseNodes {
    /// Finds the pose layers of a document.
    pub(super) fn find(
        document: &roxmltree::Document<'_>,
        prepared: &Prepared,
        is_pose: IsPose<'_>,
    ) -> Self {
        let mut found = Self::default();
        let mut layers = FxHashSet::default();
        // The keyword is ASCII, in any case.
        let words = prepared.text.as_bytes().windows(4);
        if !{ words }.any(|word| word.eq_ignore_ascii_case(b"pose")) {
            return found;
        }
        for node in document.descendants().filter(Node::is_element) {
            let is_desc = match node.tag_name().name() {
                "text" | "flowRoot" => false,
                "desc" => true,
                _ => continue,
            };
            let is_drawn = |node: &Node<'_, '_>| !NOT_DRAWN.contains(&node.tag_name().name());
            if !node.ancestors().all(|node| is_drawn(&node))
                || !is_pose(&text::content(node, prepared), is_desc)
            {
                continue;
            }
            let is_group = |node: &Node<'_, '_>| node.is_element() && group_kind(*node).is_some();
            let group = match is_desc {
                // That of a shape would go with the shape.
                true => node.parent_element().filter(is_group),
                false => node.ancestors().skip(1).find(is_group),
            };
            // A drawing as a whole is no copy of anything.
            let Some(group) = group.filter(|group| *group != document.root_element()) else {
                continue;
            };
            found.strings.insert(node.id());
            if layers.insert(group.id()) {
                found.layers.push(group.id());
            }
        }
        if !layers.is_empty() {
            for node in document.descendants().filter(Node::is_element) {
                let parent = node.parent_element();
                let around = parent.and_then(|parent| found.layer_of.get(&parent.id()).copied());
                let own = Some(node.id()).filter(|id| layers.contains(id));
                if let Some(layer) = own.or(around) {
                    found.layer_of.insert(node.id(), layer);
                }
            }
        }
        found
    }

    /// Whether a node is a pose layer, or is in one.
    pub(super) fn hold(&self, node: NodeId) -> bool {
        self.layer_of.contains_key(&node)
    }

    /// Whether a text makes a group a pose layer.
    pub(super) fn are_made_by(&self, text: NodeId) -> bool {
        self.strings.contains(&text)
    }
}

/// What the pose layers are read from.
pub(super) struct PoseReader<'a, 'input> {
    pub(super) document: &'a roxmltree::Document<'input>,
    pub(super) prepared: &'a Prepared,
    pub(super) styles: &'a Styles<'a>,
    pub(super) ids: &'a Ids<'a>,
    pub(super) page: DAffine2,
    pub(super) tolerance: f64,
    pub(super) nodes: &'a PoseNodes,
}

impl PoseReader<'_, '_> {
    /// Reads the pose layers, given the group of each, and the shapes of the drawing with what they are made from.
    pub(super) fn read(
        &self,
        layers: &FxHashMap<NodeId, GroupId>,
        drawn: &[&Task<'_>],
        resolver: &dyn Resolver,
    ) -> Poses {
        let mut poses = Poses {
            layers: self.nodes.layers.iter().map(|node| layers[node]).collect(),
            ..Poses::default()
        };
        let Some(tree) = styled_tree(&self.marked(), STYLE, resolver) else {
            return poses;
        };
        let mut leaves = Vec::new();
        self.leaves(tree.root(), self.document.root_element().id(), &mut leaves);
        let mut shown = FxHashMap::default();
        for (node, leaf) in leaves {
            let Some(layer) = self.nodes.layer_of.get(&node) else {
                continue;
            };
            let Some(xml) = self.document.get_node(node) else {
                continue;
            };
            let cloned = self.cloned(xml);
            // A clone may itself be a part.
            let shows = cloned.iter().find_map(|cloned| {
                let from = shown.entry(node).or_insert(0);
                self.next_shown(*cloned, &leaf, drawn, from)
            });
            let around = xml.ancestors().skip(1);
            let around = around.take_while(|node| node.is_element() && node.id() != *layer);
            poses.copies.push(PosedShape {
                layer: layers[layer],
                element: element(xml, self.prepared),
                around: around.map(|node| element(node, self.prepared)).collect(),
                shows,
                cloned: cloned
                    .last()
                    .and_then(|node| element(*node, self.prepared).id),
                path: drawn_path(&leaf, self.page, self.tolerance),
            });
        }
        poses.paths = drawn
            .iter()
            .map(|task| {
                let path = drawn_path(&task.node, self.page, self.tolerance);
                (task.leaf, path)
            })
            .collect();
        let texts = self.document.descendants().filter(|node| {
            let is_text = matches!(node.tag_name().name(), "text" | "flowRoot");
            is_text && !self.nodes.are_made_by(node.id())
        });
        for node in texts {
            if let Some(layer) = self.nodes.layer_of.get(&node.id())
                && let Some(label) = text::read_hidden(node, self.styles, self.prepared)
            {
                poses.texts.push(PosedText {
                    layer: layers[layer],
                    text: label.text,
                    position: label.position.points[1],
                });
            }
        }
        poses
    }

    /// The text with a mark in the start tag of each pose layer and of what it is in.
    fn marked(&self) -> String {
        let layers = self.nodes.layers.iter();
        let layers = layers.filter_map(|node| self.document.get_node(*node));
        let shown = layers.flat_map(|layer| layer.ancestors().filter(Node::is_element));
        let mut starts: Vec<usize> = shown.map(|node| node.range().start).collect();
        starts.sort_unstable();
        starts.dedup();
        let text = &self.prepared.text;
        let mut marked = String::with_capacity(text.len() + MARK.len() * starts.len());
        let mut done = 0;
        for start in starts {
            let tag = &text[start..];
            let end = tag.find(|c: char| c.is_whitespace() || matches!(c, '>' | '/'));
            let end = start + end.unwrap_or_default();
            marked.push_str(&text[done..end]);
            marked.push_str(MARK);
            done = end;
        }
        marked.push_str(&text[done..]);
        marked
    }

    /// The paths and pictures in a group, each with its element, for the content of a clone the clone.
    fn leaves<'t>(
        &self,
        group: &'t usvg::Group,
        around: NodeId,
        leaves: &mut Vec<(NodeId, Leaf<'t>)>,
    ) {
        for node in group.children() {
            match node {
                usvg::Node::Group(inner) => {
                    let own = self.ids.get(inner.id()).unwrap_or(around);
                    self.leaves(inner, own, leaves);
                }
                usvg::Node::Path(path) if path.is_visible() => {
                    let own = self.ids.get(path.id()).unwrap_or(around);
                    leaves.push((own, Leaf::Path(path)));
                }
                usvg::Node::Image(image) if image.is_visible() => {
                    let own = self.ids.get(image.id()).unwrap_or(around);
                    leaves.push((own, Leaf::Image(image)));
                }
                _ => {}
            }
        }
    }

    /// The element that a clone shows; if that is a clone, followed by what it shows, and so on.
    fn cloned<'n>(&'n self, node: Node<'n, 'n>) -> Vec<Node<'n, 'n>> {
        /// Clones of clones of clones.
        const MOST: usize = 64;

        let target = |node: &Node<'n, 'n>| {
            let is_clone = node.tag_name().name() == "use";
            let mut attributes = node.attributes().filter(|_| is_clone);
            let href = attributes.find(|attribute| attribute.name() == "href")?;
            let id = self.ids.get(href.value().trim().strip_prefix('#')?)?;
            self.document.get_node(id)
        };
        std::iter::successors(target(&node), target)
            .take(MOST)
            .collect()
    }

    /// The next shape of the drawing in a cloned element that looks like a leaf of the clone. `from` is the number of the first that was
    /// not compared yet.
    fn next_shown(
        &self,
        cloned: Node<'_, '_>,
        leaf: &Leaf<'_>,
        drawn: &[&Task<'_>],
        from: &mut usize,
    ) -> Option<usize> {
        let is_in = |task: &Task<'_>| {
            let node = self.document.get_node(task.xml);
            node.is_some_and(|node| node.ancestors().any(|outer| outer == cloned))
        };
        let mut rest = drawn.iter().enumerate().skip(*from);
        let (index, task) = rest.find(|(_, task)| looks_like(leaf, &task.node) && is_in(task))?;
        *from = index + 1;
        Some(task.leaf)
    }
}

/// Per element of a drawing, given by the first byte of its start tag, the transform around it: from the coordinates in which the element
/// is placed to those of the drawing. `None` for what is no element.
pub(crate) fn transforms_around(source: &str, starts: &[usize]) -> Vec<Option<DAffine2>> {
    transforms(source, starts, Place::Around)
}

/// The transform inside of an element, likewise.
pub(crate) fn transform_inside(source: &str, start: usize) -> Option<DAffine2> {
    let mut found = transforms(source, &[start], Place::Inside);
    found.pop().flatten()
}

/// In which coordinates something is: those in which an element is placed, or those of what is in it.
#[derive(Clone, Copy)]
enum Place {
    Around,
    Inside,
}

fn transforms(source: &str, starts: &[usize], place: Place) -> Vec<Option<DAffine2>> {
    let mut found = vec![None; starts.len()];
    let Ok(prepared) = prepare(source) else {
        return found;
    };
    let Ok(document) = roxmltree::Document::parse_with_options(&prepared.text, parsing()) else {
        return found;
    };
    for node in document.descendants().filter(Node::is_element) {
        let start = prepared.original(node.range().start);
        for (found, wanted) in found.iter_mut().zip(starts) {
            if *wanted == start && found.is_none() {
                let inside = match place {
                    Place::Around => node.parent_element(),
                    Place::Inside => Some(node),
                };
                *found = inside.map(text::page_transform);
            }
        }
    }
    found
}

/// Whether two leaves are drawn alike but for their place.
fn looks_like(one: &Leaf<'_>, other: &Leaf<'_>) -> bool {
    match (one, other) {
        (Leaf::Path(one), Leaf::Path(other)) => one.data() == other.data(),
        (Leaf::Image(one), Leaf::Image(other)) => one.size() == other.size(),
        _ => false,
    }
}

/// The path of a leaf as it is drawn, flattened with a tolerance.
fn drawn_path(leaf: &Leaf<'_>, page: DAffine2, tolerance: f64) -> DrawnPath {
    match leaf {
        Leaf::Path(path) => {
            let transform = page * affine(path.abs_transform());
            let points = path.data().points().iter();
            let points = points.map(|at| DVec2::new(at.x.into(), at.y.into()));
            DrawnPath {
                points: points.map(|at| transform.transform_point2(at)).collect(),
                rings: flatten(&bez_path(path.data(), transform), tolerance),
            }
        }
        Leaf::Image(image) => {
            let transform = page * affine(image.abs_transform());
            let rectangle = PictureSource::of(image, transform, None).rectangle();
            let rings: Vec<Ring> = rectangle.rings().cloned().collect();
            DrawnPath {
                points: rings.concat(),
                rings,
            }
        }
    }
}
