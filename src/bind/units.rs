//! Units: what becomes one node of the hierarchy (figure.md, Groups).
//!
//! A *member* is something with area: a fill, or a stroke where strokes are parts. The members of a unit
//! share a node; the hindmost of them is the main part candidate.

use rustc_hash::FxHashMap;

use super::bindings::{Bindings, Place};
use super::settings::Strokes;
use crate::svg::{Drawing, GroupKind};

/// Something with area.
#[derive(Debug, Clone, Copy)]
pub(super) struct Member {
    pub(super) index: usize,
    pub(super) shape: usize,
    /// Whether its area is the shape's stroke rather than its fill.
    pub(super) is_stroke: bool,
}

/// How groups act.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Role {
    /// Layers, the outermost `<svg>`, wrappers: as if they were not there.
    Transparent,
    /// Holds several strings: its children are units of their own.
    Container,
    /// Makes its content one unit.
    Unit,
}

/// The units of a drawing.
#[derive(Debug)]
pub(super) struct Units {
    pub(super) members: Vec<Member>,
    roles: Vec<Role>,
    parents: Vec<usize>,
    /// Per member: the group that makes its unit.
    unit: Vec<Option<usize>>,
    /// Per member: the nearest container around it.
    container: Vec<Option<usize>>,
    /// Per group: the group of the tile layer that it is in.
    layer: Vec<Option<usize>>,
    /// Per member: whether it is in a tile layer.
    in_layer: Vec<bool>,
    /// Per group: whether it is a tile layer's and holds something that strings can belong to.
    holds_parts: Vec<bool>,
}

impl Units {
    pub(super) fn read(drawing: &Drawing, bindings: &Bindings) -> Self {
        let parents: Vec<usize> = drawing.groups.iter().map(|group| group.parent).collect();
        let mut strings = vec![0_usize; drawing.groups.len()];
        for string in bindings.strings.iter().filter(|string| string.wants_part()) {
            if let Place::Label(label) = string.place {
                strings[drawing.labels[label].1] += 1;
            }
        }
        let members = members(drawing, bindings);
        let groups = 0..drawing.groups.len();
        let layer =
            groups.map(|group| Some(bindings.layers[bindings.tile_layer_of_group(group)?].group));
        let layer: Vec<Option<usize>> = layer.collect();
        let roles = roles(drawing, &strings, &layer);
        let mut units = Self {
            unit: vec![None; members.len()],
            container: vec![None; members.len()],
            in_layer: vec![false; members.len()],
            holds_parts: vec![false; drawing.groups.len()],
            members,
            roles,
            parents,
            layer,
        };
        for index in 0..units.members.len() {
            let group = drawing.shapes[units.members[index].shape].group;
            if let Some(layer) = units.layer[group] {
                units.in_layer[index] = true;
                units.container[index] = Some(layer);
                units.holds_parts[layer] = true;
            }
            let chain: Vec<usize> = units.chain(group).collect();
            for group in chain {
                match units.roles[group] {
                    Role::Transparent => {}
                    Role::Unit => units.unit[index] = Some(group),
                    Role::Container => {
                        units.container[index] = Some(group);
                        break;
                    }
                }
            }
        }
        units
    }

    /// A group and the groups around it, innermost first. A tile layer is the last: it is as if the drawing ended
    /// there.
    pub(super) fn chain(&self, group: usize) -> impl Iterator<Item = usize> + '_ {
        let mut next = self.parents.get(group).map(|_| group);
        std::iter::from_fn(move || {
            let group = next?;
            let last = group == 0 || self.layer[group] == Some(group);
            next = (!last).then(|| self.parents[group]);
            Some(group)
        })
    }

    /// The group of the tile layer among whose shapes a string in a group is bound; `None` where strings are
    /// bound among all shapes that are in none.
    pub(super) fn scope_of_layer(&self, group: usize) -> Option<usize> {
        self.layer[group].filter(|layer| self.holds_parts[*layer])
    }

    /// Whether a member is in a tile layer.
    pub(super) fn is_in_layer(&self, member: usize) -> bool {
        self.in_layer[member]
    }

    /// Whether the group is as if it were not there: a layer, a wrapper.
    pub(super) fn is_transparent(&self, group: usize) -> bool {
        self.roles[group] == Role::Transparent
    }

    pub(super) fn is_container(&self, group: usize) -> bool {
        self.roles[group] == Role::Container
    }

    /// Whether strings in the group belong to its backmost part.
    pub(super) fn groups_strings(&self, group: usize) -> bool {
        self.roles[group] == Role::Unit
    }
}

fn members(drawing: &Drawing, bindings: &Bindings) -> Vec<Member> {
    let (lines, borders) = match bindings.settings.strokes {
        Strokes::None => (false, false),
        Strokes::Lines => (true, false),
        Strokes::All => (true, true),
    };
    let described = described_lines(drawing, bindings);
    let mut members = Vec::with_capacity(drawing.shapes.len());
    let mut add = |shape, is_stroke| {
        members.push(Member {
            index: members.len(),
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
    members
}

/// Which unfilled lines have a string of their own, by description or by a group without filled shapes.
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

fn roles(drawing: &Drawing, strings: &[usize], layer: &[Option<usize>]) -> Vec<Role> {
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
        // Several strings beside a lone group describe what is in it; a single one names the group.
        let lone = wraps[group.parent] && children[group.parent] == 1 && strings[group.parent] != 1;
        wraps[index] = group.kind == GroupKind::Root || (group.kind == GroupKind::Group && lone);
        roles.push(match group.kind {
            GroupKind::Root | GroupKind::Layer => Role::Transparent,
            GroupKind::Group if layer[index] == Some(index) => Role::Transparent,
            GroupKind::Group if wraps[index] => Role::Transparent,
            GroupKind::Group if strings[index] > 1 => Role::Container,
            GroupKind::Group => Role::Unit,
        });
    }
    roles
}

/// Makes the hindmost part of each unit its main part candidate.
pub(super) fn choose_mains(units: &Units, bindings: &mut Bindings) {
    let mut mains: FxHashMap<(Option<usize>, usize), usize> = FxHashMap::default();
    let mut main_of_shape: FxHashMap<usize, usize> = FxHashMap::default();
    for index in 0..bindings.parts.len() {
        let member = bindings.parts[index].member;
        let shape = bindings.parts[index].shape;
        let main = match units.unit[member] {
            Some(group) => *mains
                .entry((units.container[member], group))
                .or_insert(index),
            // A border belongs to the shape that it borders.
            None => *main_of_shape.entry(shape).or_insert(index),
        };
        bindings.parts[index].join_unit(index, main);
    }
}

/// The main part candidates in each container.
pub(super) fn candidates_by_container(
    units: &Units,
    bindings: &Bindings,
) -> FxHashMap<usize, Vec<usize>> {
    let mut candidates: FxHashMap<usize, Vec<usize>> = FxHashMap::default();
    for (index, part) in bindings
        .parts
        .iter()
        .enumerate()
        .filter(|(_, part)| part.is_candidate())
    {
        if let Some(container) = units.container[part.member] {
            candidates.entry(container).or_default().push(index);
        }
    }
    candidates
}
