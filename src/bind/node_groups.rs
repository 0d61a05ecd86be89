//! Node groups: which shapes become one node of the hierarchy (figure.md, Groups).
//!
//! A part has a source: the fill of a shape, or its stroke if strokes are parts. All sources in a node group share a node; the
//! back-most of them is the main part candidate.

use rustc_hash::FxHashMap;

use super::bindings::{Bindings, Place};
use super::settings::Strokes;
use crate::svg::{Drawing, GroupKind};

/// The fill or the stroke of a shape, which becomes a part if it has area.
#[derive(Debug, Clone, Copy)]
pub(super) struct PartSource {
    pub(super) index: usize,
    pub(super) shape: usize,
    /// Whether its area is the shape's stroke rather than its fill.
    pub(super) is_stroke: bool,
}

/// What a group means for the hierarchy.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum GroupRole {
    /// Layers, the outermost `<svg>`, wrappers: ignored.
    Transparent,
    /// Holds several strings: its children become nodes of their own.
    Container,
    /// Its content becomes one node.
    Node,
}

/// The roles of a drawing's groups, and the sources of its parts.
#[derive(Debug)]
pub(super) struct NodeGroups {
    pub(super) sources: Vec<PartSource>,
    /// Per group.
    pub(super) roles: Vec<GroupRole>,
    parents: Vec<usize>,
    /// Per source: the group whose content shares its node.
    node_group: Vec<Option<usize>>,
    /// Per source: the nearest container around it.
    container: Vec<Option<usize>>,
    /// Per group: the group of the tile layer that it is in.
    layer: Vec<Option<usize>>,
    /// Per source: whether it is in a tile layer.
    pub(super) in_layer: Vec<bool>,
    /// Per group: whether it is a tile layer with parts that strings can belong to.
    holds_parts: Vec<bool>,
}

impl NodeGroups {
    pub(super) fn read(drawing: &Drawing, bindings: &Bindings) -> Self {
        let parents: Vec<usize> = drawing.groups.iter().map(|group| group.parent).collect();
        let mut strings = vec![0_usize; drawing.groups.len()];
        for string in bindings.strings.iter().filter(|string| string.wants_part()) {
            if let Place::Label(label) = string.place {
                strings[drawing.labels[label].1] += 1;
            }
        }
        let sources = sources(drawing, bindings);
        let groups = 0..drawing.groups.len();
        let layer =
            groups.map(|group| Some(bindings.layers[bindings.tile_layer_of_group(group)?].group));
        let layer: Vec<Option<usize>> = layer.collect();
        let roles = roles(drawing, &strings, &layer);
        let mut node_groups = Self {
            node_group: vec![None; sources.len()],
            container: vec![None; sources.len()],
            in_layer: vec![false; sources.len()],
            holds_parts: vec![false; drawing.groups.len()],
            sources,
            roles,
            parents,
            layer,
        };
        for index in 0..node_groups.sources.len() {
            let group = drawing.shapes[node_groups.sources[index].shape].group;
            if let Some(layer) = node_groups.layer[group] {
                node_groups.in_layer[index] = true;
                node_groups.container[index] = Some(layer);
                node_groups.holds_parts[layer] = true;
            }
            let chain: Vec<usize> = node_groups.chain(group).collect();
            for group in chain {
                match node_groups.roles[group] {
                    GroupRole::Transparent => {}
                    GroupRole::Node => node_groups.node_group[index] = Some(group),
                    GroupRole::Container => {
                        node_groups.container[index] = Some(group);
                        break;
                    }
                }
            }
        }
        node_groups
    }

    /// A group and the groups around it, innermost first, up to the tile layer that it is in.
    pub(super) fn chain(&self, group: usize) -> impl Iterator<Item = usize> + '_ {
        let mut next = self.parents.get(group).map(|_| group);
        std::iter::from_fn(move || {
            let group = next?;
            let last = group == 0 || self.layer[group] == Some(group);
            next = (!last).then(|| self.parents[group]);
            Some(group)
        })
    }

    /// The group of the tile layer to whose shapes strings in a group are restricted; `None` for strings outside of tile layers.
    pub(super) fn scope_of_layer(&self, group: usize) -> Option<usize> {
        self.layer[group].filter(|layer| self.holds_parts[*layer])
    }
}

fn sources(drawing: &Drawing, bindings: &Bindings) -> Vec<PartSource> {
    let (lines, borders) = match bindings.settings.strokes {
        Strokes::None => (false, false),
        Strokes::Lines => (true, false),
        Strokes::All => (true, true),
    };
    let described = described_lines(drawing, bindings);
    let mut sources = Vec::with_capacity(drawing.shapes.len());
    let mut add = |shape, is_stroke| {
        sources.push(PartSource {
            index: sources.len(),
            shape,
            is_stroke,
        })
    };
    for (index, shape) in drawing.shapes.iter().enumerate() {
        if bindings.is_picture_of_tiles(drawing, index) {
            continue;
        }
        let filled = !shape.outline.polygons.is_empty();
        if filled {
            add(index, false);
        }
        // Strokes in a tile layer are edges.
        let is_map = bindings.tile_layer_of_group(shape.group).is_some();
        let (lines, borders) = (lines && !is_map, borders && !is_map);
        if shape.stroke.is_some()
            && if filled {
                borders
            } else {
                lines || described[index]
            }
        {
            add(index, true);
        }
    }
    sources
}

/// Per shape, whether it is an unfilled line with a string of its own: a description, or a string in its group without filled
/// shapes.
fn described_lines(drawing: &Drawing, bindings: &Bindings) -> Vec<bool> {
    let mut described = vec![false; drawing.shapes.len()];
    let mut filled = vec![false; drawing.groups.len()];
    let mut first_line = vec![None; drawing.groups.len()];
    for (index, shape) in drawing.shapes.iter().enumerate() {
        let mut group = shape.group;
        loop {
            if !shape.outline.polygons.is_empty() {
                filled[group] = true;
            } else if shape.stroke.is_some() {
                first_line[group].get_or_insert(index);
            }
            if group == 0 {
                break;
            }
            group = drawing.groups[group].parent;
        }
    }
    for string in bindings.strings.iter().filter(|string| string.wants_part()) {
        let group = match string.place {
            Place::Shape(shape) => {
                described[shape] = true;
                continue;
            }
            Place::Group(group) => group,
            Place::Label(label) => drawing.labels[label].1,
        };
        if drawing.groups[group].kind == GroupKind::Group
            && !filled[group]
            && let Some(line) = first_line[group]
        {
            described[line] = true;
        }
    }
    described
}

fn roles(drawing: &Drawing, strings: &[usize], layer: &[Option<usize>]) -> Vec<GroupRole> {
    let mut children = vec![0_usize; drawing.groups.len()];
    let mut drawn = vec![false; drawing.groups.len()];
    for shape in &drawing.shapes {
        children[shape.group] += 1;
        let mut group = shape.group;
        while group != 0 && !drawn[group] {
            drawn[group] = true;
            group = drawing.groups[group].parent;
            children[group] += 1;
        }
    }
    let mut roles = Vec::with_capacity(drawing.groups.len());
    let mut wraps = vec![false; drawing.groups.len()];
    for (index, group) in drawing.groups.iter().enumerate() {
        // Several strings beside the only group of a page describe its content; a single one names the group.
        let lone = wraps[group.parent] && children[group.parent] == 1 && strings[group.parent] != 1;
        wraps[index] = group.kind == GroupKind::Root || (group.kind == GroupKind::Group && lone);
        roles.push(match group.kind {
            GroupKind::Root | GroupKind::Layer => GroupRole::Transparent,
            GroupKind::Group if layer[index] == Some(index) => GroupRole::Transparent,
            GroupKind::Group if wraps[index] => GroupRole::Transparent,
            GroupKind::Group if strings[index] > 1 => GroupRole::Container,
            GroupKind::Group => GroupRole::Node,
        });
    }
    roles
}

/// Makes the back-most part of each node its main part candidate.
pub(super) fn choose_mains(node_groups: &NodeGroups, bindings: &mut Bindings) {
    let mut mains: FxHashMap<(Option<usize>, usize), usize> = FxHashMap::default();
    let mut main_of_shape: FxHashMap<usize, usize> = FxHashMap::default();
    for index in 0..bindings.parts.len() {
        let source = bindings.parts[index].source;
        let shape = bindings.parts[index].shape;
        let main = match node_groups.node_group[source] {
            Some(group) => *mains
                .entry((node_groups.container[source], group))
                .or_insert(index),
            // A border belongs to the shape that it borders.
            None => *main_of_shape.entry(shape).or_insert(index),
        };
        bindings.parts[index].join_node(index, main);
    }
}

/// The main part candidates in each container.
pub(super) fn candidates_by_container(
    node_groups: &NodeGroups,
    bindings: &Bindings,
) -> FxHashMap<usize, Vec<usize>> {
    let mut candidates: FxHashMap<usize, Vec<usize>> = FxHashMap::default();
    for (index, part) in bindings
        .parts
        .iter()
        .enumerate()
        .filter(|(_, part)| part.is_candidate())
    {
        if let Some(container) = node_groups.container[part.source] {
            candidates.entry(container).or_default().push(index);
        }
    }
    candidates
}
