//! Node groups: which shapes become one node of the hierarchy.
//!
//! A part has a source: the fill of a shape, or its stroke if that is built. All sources in a node group share a node, but ink
//! goes with what it lies on; the back-most of the others is the main part candidate.

use std::cell::LazyCell;

use rustc_hash::{FxHashMap, FxHashSet};
use typed_index_collections::{TiSlice, TiVec, ti_vec};

use super::converted::ConvertedStrings;
use super::fills::Fills;
use super::held::{self, Hold};
use super::ink;
use super::layers::{LayerId, Layers};
use super::leaders::Leaders;
use super::parts::MatchedPart;
use super::props;
use super::settings::Strokes;
use super::stacking::ground_count;
use super::strings::{ReadString, texts_mean_parts};
use super::wrappers::{self, Wrappers};
use crate::bind::bindings::{NamedBy, PartId, StringHolder, StringId};
use crate::bind::names::of_element;
use crate::lang::ast::Annotation;
use crate::memo::Memo;
use crate::svg::{Drawing, Element, GroupId, GroupKind, Shape, ShapeId, StrokeSource};

/// The fill or the stroke of a shape, which becomes a part if it has area.
#[derive(Debug, Clone, Copy)]
pub(super) struct PartSource {
    pub(super) index: usize,
    pub(super) shape: ShapeId,
    /// Whether its area is the shape's stroke rather than its fill.
    pub(super) is_stroke: bool,
    /// For ink, the shape on which it lies.
    pub(super) host: Option<ShapeId>,
    /// For a line that begins on a shape, where it does.
    pub(super) hold: Option<Hold>,
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
    /// Its content becomes one node, apart from further pieces of a body in it, which become its children.
    Carrier,
}

/// The roles of a drawing's groups, and the sources of its parts.
#[derive(Debug)]
pub(in crate::bind) struct NodeGroups {
    pub(super) sources: Vec<PartSource>,
    /// Per group.
    pub(super) roles: TiVec<GroupId, GroupRole>,
    parents: TiVec<GroupId, GroupId>,
    /// Per source: the group whose content shares its node.
    node_group: Vec<Option<GroupId>>,
    /// Per source: the nearest container around it.
    pub(super) container: Vec<Option<GroupId>>,
    /// Per group: the group of the tile layer or view that it is in.
    layer: TiVec<GroupId, Option<GroupId>>,
    /// Per source: whether it is in such a layer.
    pub(super) in_layer: Vec<bool>,
    /// Per shape: whether it is a background, unless a string names it.
    pub(in crate::bind) backgrounds: TiVec<ShapeId, bool>,
    /// The backgrounds that are shadows on the ground.
    pub(in crate::bind) shadows: Vec<ShapeId>,
    /// Per group: whether it is such a layer, with parts that strings can belong to.
    holds_parts: TiVec<GroupId, bool>,
}

impl NodeGroups {
    /// The groups of a drawing. What shares their nodes is found by [`find_sources`](Self::find_sources).
    pub(super) fn read(
        drawing: &Drawing,
        strings: &TiSlice<StringId, ReadString>,
        layers: &Layers,
    ) -> Self {
        let parents: TiVec<GroupId, GroupId> =
            drawing.groups.iter().map(|group| group.parent).collect();
        let holds_shape = holding(drawing, |_| true);
        let mut counts: TiVec<GroupId, usize> = ti_vec![0; drawing.groups.len()];
        for string in strings.iter().filter(|string| string.wants_part()) {
            if let StringHolder::Label(label) = string.holder {
                let mut group = drawing.labels[label].1;
                // Texts that are grouped by themselves are strings of what that group is in.
                while !holds_shape[group] && drawing.groups[group].kind == GroupKind::Group {
                    group = parents[group];
                }
                counts[group] += 1;
            }
        }
        let groups = drawing.groups.keys();
        let layer = groups.map(|group| Some(layers[layers.of_group(group)?].group));
        let layer: TiVec<GroupId, Option<GroupId>> = layer.collect();
        let in_map = |group: GroupId| layer[group].is_some();
        let wrappers = wrappers::find(drawing, strings, &counts, in_map);
        Self {
            node_group: vec![],
            container: vec![],
            in_layer: vec![],
            holds_parts: ti_vec![false; drawing.groups.len()],
            sources: vec![],
            roles: roles(drawing, layers, &counts, &layer, &wrappers),
            backgrounds: wrappers.backgrounds,
            shadows: wrappers.shadows,
            parents,
            layer,
        }
    }

    /// Finds the sources of parts, and the groups that each belongs to.
    pub(super) fn find_sources(
        &mut self,
        drawing: &Drawing,
        strings: &TiSlice<StringId, ReadString>,
        layers: &Layers,
        leaders: &Leaders,
        strokes: Strokes,
        memo: &Memo,
    ) {
        let lines = Lines {
            described: described_lines(drawing, strings),
            named: self.named_lines(drawing, strings),
            leaders,
            has_guides: texts_mean_parts(strings),
        };
        let backgrounds = &self.backgrounds;
        let prop_of = |shape: ShapeId| {
            let group = drawing.shapes[shape].group;
            let layer = layers.of_props(group)?;
            Some((layer, self.outermost(group)))
        };
        self.sources = sources(drawing, layers, &lines, backgrounds, prop_of, strokes, memo);
        for index in 0..self.sources.len() {
            let shape = self.sources[index].shape;
            let group = drawing.shapes[shape].group;
            let layer = self.layer[group];
            if let Some(layer) = layer {
                self.holds_parts[layer] = true;
            }
            let is_container = |group: &GroupId| self.roles[*group] == GroupRole::Container;
            let container = self.chain(group).find(is_container);
            let node_group = self.outermost(group).filter(|_| !self.backgrounds[shape]);
            self.in_layer.push(layer.is_some());
            self.container.push(container.or(layer));
            self.node_group.push(node_group);
        }
    }

    /// Per shape, whether it is an unfilled line to which a person gave a name: its own, or that of its group without filled shapes.
    /// Where strings name the parts, ids are no names, unless a string attaches something to them: many a guide has one.
    fn named_lines(
        &self,
        drawing: &Drawing,
        strings: &TiSlice<StringId, ReadString>,
    ) -> TiVec<ShapeId, bool> {
        let filled = holding(drawing, wrappers::is_filled);
        let ids_count = !texts_mean_parts(strings);
        let attached_to = strings
            .iter()
            .filter_map(|string| match &string.annotation {
                Annotation::Part(part) => Some(part.parent.as_ref()?.text.as_str()),
                _ => None,
            });
        let attached_to: FxHashSet<&str> = attached_to.collect();
        let is_name = |element: &Element| {
            of_element(element, None).is_some_and(|own| {
                let is_label = matches!(own.by, NamedBy::Label { .. });
                is_label || ids_count || attached_to.contains(own.name.as_str())
            })
        };
        let is_named = |shape: &Shape| {
            let is_line = shape.outline.polygons.is_empty() && shape.stroke.is_some();
            let group = || self.outermost(shape.group).filter(|group| !filled[*group]);
            let is_in_named =
                || group().is_some_and(|group| is_name(&drawing.groups[group].element));
            is_line && (is_name(&shape.element) || is_in_named())
        };
        drawing.shapes.iter().map(is_named).collect()
    }

    /// A group and the groups around it, innermost first, up to the layer that it is in.
    pub(super) fn chain(&self, group: GroupId) -> impl Iterator<Item = GroupId> + '_ {
        let mut next = self.parents.get(group).map(|_| group);
        std::iter::from_fn(move || {
            let group = next?;
            let last = group == GroupId::ROOT || self.layer[group] == Some(group);
            next = (!last).then(|| self.parents[group]);
            Some(group)
        })
    }

    /// The group whose content shares a node with what is in `group`; `None` if its shapes are nodes of their own.
    pub(in crate::bind) fn outermost(&self, group: GroupId) -> Option<GroupId> {
        let mut outermost = None;
        for group in self.chain(group) {
            match self.roles[group] {
                GroupRole::Transparent => {}
                GroupRole::Node => outermost = Some(group),
                GroupRole::Container => break,
                GroupRole::Carrier => return outermost.or(Some(group)),
            }
        }
        outermost
    }

    /// The nearest group around that of a node that carries it.
    pub(in crate::bind) fn carrier(&self, node_group: GroupId) -> Option<GroupId> {
        let around = self.chain(node_group).skip(1);
        let mut around = around.take_while(|group| self.roles[*group] != GroupRole::Container);
        around.find(|group| self.roles[*group] == GroupRole::Carrier)
    }

    /// Opens the group of a node: its children become nodes of their own. If one of them is a group that holds all
    /// `members`, parts of the node by their sources and the groups of their shapes, it is opened too. Returns whether there
    /// was a group to open.
    pub(super) fn open(&mut self, members: &[(usize, GroupId)]) -> bool {
        let Some((&(first, group), rest)) = members.split_first() else {
            return false;
        };
        let Some(outermost) = self.node_group[first] else {
            return false;
        };
        // The groups between the node's group and the first part, from outside in, as far as they hold all parts.
        let inside = |group: GroupId| {
            let mut chain: Vec<GroupId> = self.chain(group).collect();
            let end = chain.iter().position(|group| *group == outermost);
            chain.truncate(end.map_or(0, |end| end + 1));
            chain.reverse();
            chain
        };
        let mut common = inside(group);
        for (_, group) in rest {
            let chain = inside(*group);
            // Ink of the node may be drawn in a group of its own, as in art with colours and lines in two layers.
            if chain.is_empty() {
                continue;
            }
            let same = common.iter().zip(&chain).take_while(|(a, b)| a == b);
            let same = same.count();
            common.truncate(same);
        }
        for group in common {
            if self.roles[group] == GroupRole::Node {
                self.roles[group] = GroupRole::Transparent;
            }
        }
        for (source, group) in members {
            self.node_group[*source] = self.outermost(*group);
        }
        true
    }

    /// The group of the tile layer to whose shapes strings in a group are restricted; `None` for strings outside of tile layers.
    pub(super) fn scope_of_layer(&self, group: GroupId) -> Option<GroupId> {
        self.layer[group].filter(|layer| self.holds_parts[*layer])
    }
}

/// What is known about unfilled lines.
struct Lines<'a> {
    /// Per shape, whether it is one with a string of its own.
    described: TiVec<ShapeId, bool>,
    /// Per shape, whether it is one with a name from a person.
    named: TiVec<ShapeId, bool>,
    leaders: &'a Leaders,
    /// Whether hairlines beside all shapes may be guides for the strings.
    has_guides: bool,
}

fn sources(
    drawing: &Drawing,
    layers: &Layers,
    known: &Lines<'_>,
    backgrounds: &TiSlice<ShapeId, bool>,
    prop_of: impl Fn(ShapeId) -> Option<(LayerId, Option<GroupId>)>,
    strokes: Strokes,
    memo: &Memo,
) -> Vec<PartSource> {
    let Lines {
        described,
        named,
        leaders,
        has_guides,
    } = known;
    let (ink, lines, borders) = match strokes {
        Strokes::None => (false, false, false),
        Strokes::Ink => (true, false, false),
        Strokes::Lines => (true, true, false),
        Strokes::All | Strokes::Visible => (true, true, true),
    };
    // Unfilled lines beside all shapes.
    let may_be_guides = *has_guides && matches!(strokes, Strokes::Visible | Strokes::Ink);
    let is_guide = |stroke: &StrokeSource| may_be_guides && drawing.is_hairline(stroke);
    // Strokes in a tile layer are edges; those in a view belong to its regions.
    let is_map = |shape: ShapeId| {
        let group = drawing.shapes[shape].group;
        layers.with_content(group).is_some()
    };
    let is_leader = |shape: ShapeId| leaders.leads(shape);
    let is_free = |shape: ShapeId| !described[shape] && !is_leader(shape) && !is_map(shape);
    let is_ink = |shape: ShapeId| ink && is_free(shape);
    let is_host = |shape: ShapeId| !is_map(shape) && !backgrounds[shape];
    let hosts = ink::hosts(drawing, is_ink, is_host, memo);
    let fills = LazyCell::new(|| {
        let outlines = drawing.shapes.iter().map(|shape| &*shape.outline);
        let ground = ground_count(outlines, drawing.page);
        let above = drawing.shapes.keys().skip(ground);
        Fills::of(drawing, above.filter(|shape| is_host(*shape)))
    });
    let converted = ConvertedStrings::of(drawing);
    let mut sources = Vec::with_capacity(drawing.shapes.len());
    let mut add = |shape, is_stroke, host, hold| {
        sources.push(PartSource {
            index: sources.len(),
            shape,
            is_stroke,
            host,
            hold,
        })
    };
    for (index, shape) in drawing.shapes.iter_enumerated() {
        let converted = converted.contains(shape.element.span.start);
        if converted || layers.hold_picture(drawing, index) {
            continue;
        }
        let has_stroke = shape.stroke.is_some();
        let is_guide = shape.stroke.as_deref().is_some_and(is_guide);
        if !shape.outline.polygons.is_empty() {
            add(index, false, None, None);
            if has_stroke && borders && !is_map(index) {
                add(index, true, Some(index), None);
            }
        } else if let Some(host) = hosts[index].filter(|host| prop_of(*host) == prop_of(index)) {
            add(index, true, Some(host), None);
        } else if has_stroke && prop_of(index).is_some() {
            // A line in a layer of props stands there: nothing else is drawn in one.
            add(index, true, None, None);
        } else if has_stroke {
            let is_line = shape.line.is_some() && !leaders.may_be_meant(index);
            let is_line = is_line && (is_ink(index) || described[index]);
            let hold = is_line
                .then(|| held::hold(drawing, index, &fills))
                .flatten();
            // What a name makes a part stays one if the first look at the drawing ends.
            let is_built = lines || ink && named[index];
            if described[index] || hold.is_some() || (is_built && is_free(index) && !is_guide) {
                add(index, true, None, hold);
            }
        }
    }
    sources
}

/// Per group, whether it or a group in it holds a shape of this kind.
fn holding(drawing: &Drawing, is: impl Fn(&Shape) -> bool) -> TiVec<GroupId, bool> {
    let mut holding: TiVec<GroupId, bool> = ti_vec![false; drawing.groups.len()];
    for shape in drawing.shapes.iter().filter(|shape| is(shape)) {
        let mut group = shape.group;
        // If a group is known, so are those around it.
        while !holding[group] {
            holding[group] = true;
            group = drawing.groups[group].parent;
        }
    }
    holding
}

/// Per shape, whether it is an unfilled line with a string of its own: a description, or a string in its group without filled
/// shapes.
fn described_lines(
    drawing: &Drawing,
    strings: &TiSlice<StringId, ReadString>,
) -> TiVec<ShapeId, bool> {
    let mut described: TiVec<ShapeId, bool> = ti_vec![false; drawing.shapes.len()];
    let filled = holding(drawing, wrappers::is_filled);
    let mut has_string: TiVec<GroupId, bool> = ti_vec![false; drawing.groups.len()];
    for string in strings.iter().filter(|string| string.wants_part()) {
        let group = match string.holder {
            StringHolder::Shape(shape) => {
                described[shape] = true;
                continue;
            }
            StringHolder::Group(group) => group,
            StringHolder::Label(label) => drawing.labels[label].1,
        };
        has_string[group] |= drawing.groups[group].kind == GroupKind::Group && !filled[group];
    }
    // A group comes after the one that contains it.
    for (index, group) in drawing.groups.iter_enumerated() {
        has_string[index] |= has_string[group.parent];
    }
    for (described, shape) in described.iter_mut().zip(&drawing.shapes) {
        let is_line = shape.outline.polygons.is_empty() && shape.stroke.is_some();
        *described |= is_line && has_string[shape.group];
    }
    described
}

fn roles(
    drawing: &Drawing,
    layers: &Layers,
    strings: &TiSlice<GroupId, usize>,
    layer: &TiSlice<GroupId, Option<GroupId>>,
    wrappers: &Wrappers,
) -> TiVec<GroupId, GroupRole> {
    let groups = drawing.groups.iter_enumerated();
    let single = props::single(drawing, layers);
    let is_in_props = |group: GroupId| layers.of_props(group).is_some();
    groups
        .map(|(index, group)| match group.kind {
            GroupKind::Group if single[index] => GroupRole::Node,
            GroupKind::Root | GroupKind::Layer => GroupRole::Transparent,
            GroupKind::Group if layer[index] == Some(index) => GroupRole::Transparent,
            GroupKind::Group if is_in_props(index) => GroupRole::Node,
            GroupKind::Group if wrappers.carries[index] => GroupRole::Carrier,
            GroupKind::Group if wrappers.groups_nothing[index] => GroupRole::Transparent,
            GroupKind::Group if strings[index] > 1 => GroupRole::Container,
            GroupKind::Group => GroupRole::Node,
        })
        .collect()
}

/// Makes the back-most part of each node its main part candidate.
pub(super) fn choose_mains(node_groups: &NodeGroups, parts: &mut TiSlice<PartId, MatchedPart>) {
    let mut mains: FxHashMap<(Option<GroupId>, GroupId), PartId> = FxHashMap::default();
    // A line that is drawn before the shapes of its group is an extra of theirs.
    let [fills, lines]: [Vec<PartId>; 2] = [false, true].map(|is_line| {
        let parts = parts.iter_enumerated();
        let these = parts.filter(|(_, part)| part.is_stroke == is_line);
        these.map(|(index, _)| index).collect()
    });
    for index in fills.into_iter().chain(lines) {
        let source = parts[index].source;
        let main = match (parts[index].host, node_groups.node_group[source]) {
            (Some(host), _) => parts[host].main,
            (None, Some(group)) => *mains
                .entry((node_groups.container[source], group))
                .or_insert(index),
            (None, None) => index,
        };
        parts[index].node_group = node_groups.node_group[source];
        parts[index].main = main;
    }
}
