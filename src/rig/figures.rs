//! Finds the figures of a drawing: groups of parts that are connected, by strings or because they touch.

use std::collections::BTreeMap;

use glam::DVec2;
use typed_index_collections::{TiVec, ti_vec};

use crate::anatomy::{self, Role};
use crate::bind::{Bindings, Part, PartId, PartKind};
use crate::geometry::{self, Body, area, connected};
use crate::labels::FigurePartId;

/// Roots of one figure may be this far apart, as a share of the larger one's height with all its descendants.
const GAP: f64 = 0.02;

/// The parts of one figure.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct FigureGroup {
    /// Its parts.
    pub parts: TiVec<FigurePartId, PartId>,
    /// Per part its parent: by its string, or because they touch.
    pub parents: TiVec<FigurePartId, Option<FigurePartId>>,
    /// The part that carries the others.
    pub root: PartId,
    /// Per part without a parent by its string the parts that it touches; `None` for the others.
    touching: TiVec<FigurePartId, Option<Vec<FigurePartId>>>,
}

impl FigureGroup {
    /// Whether the motion that a part's string asks for is meant for this figure; `None` addresses all figures.
    pub(super) fn is_addressed_by(&self, part: Option<PartId>) -> bool {
        part.is_none_or(|part| self.parts.contains(&part))
    }

    /// Whether a part has no parent by its string.
    pub(super) fn is_rooted(&self, part: FigurePartId) -> bool {
        self.touching[part].is_some()
    }

    /// The parts without a parent by their strings.
    pub(super) fn rooted(&self) -> impl Iterator<Item = FigurePartId> {
        let parts = self.touching.iter_enumerated();
        parts.filter_map(|(part, touched)| touched.is_some().then_some(part))
    }

    /// The same figure with another root, which must be a part without a parent by its string.
    pub(super) fn rooted_at(mut self, part: PartId) -> Self {
        let Some(root) = self.parts.position(|own| *own == part) else {
            return self;
        };
        for (parent, touched) in self.parents.iter_mut().zip(&self.touching) {
            if touched.is_some() {
                *parent = None;
            }
        }
        let mut reached = ti_vec![false; self.parts.len()];
        reached[root] = true;
        let mut order = vec![root];
        let mut next = 0;
        while let Some(&at) = order.get(next) {
            next += 1;
            for &other in self.touching[at].iter().flatten() {
                if !std::mem::replace(&mut reached[other], true) {
                    self.parents[other] = Some(at);
                    order.push(other);
                }
            }
        }
        self.root = part;
        self
    }
}

/// The figures of a drawing, in the drawing order of their first parts.
pub(crate) fn find(bindings: &Bindings) -> Vec<FigureGroup> {
    let trees = trees(bindings);
    let near = touching(bindings, &trees);
    let groups = connected(&near).into_iter();
    groups
        .map(|members| group(bindings, &trees, &near, &members))
        .collect()
}

/// A part without a parent, first, and its descendants.
struct Tree {
    parts: Vec<PartId>,
    low: DVec2,
    high: DVec2,
}

fn trees(bindings: &Bindings) -> Vec<Tree> {
    let is_main = |part: &Part| part.kind == PartKind::Main;
    let mut children = ti_vec![Vec::new(); bindings.parts.len()];
    let mut trees = Vec::new();
    let parts = bindings.parts.iter_enumerated();
    for (index, part) in parts.filter(|(_, part)| is_main(part)) {
        match part.parent {
            Some(parent) => children[parent].push(index),
            None => trees.push(Tree {
                parts: vec![index],
                low: DVec2::INFINITY,
                high: DVec2::NEG_INFINITY,
            }),
        }
    }
    for tree in &mut trees {
        let mut next = 0;
        while let Some(&part) = tree.parts.get(next) {
            next += 1;
            tree.parts.extend_from_slice(&children[part]);
            let (low, high) = bindings.parts[part].measure.bounds;
            tree.low = tree.low.min(low);
            tree.high = tree.high.max(high);
        }
    }
    trees
}

/// Per tree the other trees whose roots touch its own root.
fn touching(bindings: &Bindings, trees: &[Tree]) -> Vec<Vec<usize>> {
    let body = |tree: &Tree| {
        let root = &bindings.parts[tree.parts[0]];
        Body {
            outlines: vec![&*root.outline],
            bounds: root.measure.bounds,
            slack: GAP * (tree.high.y - tree.low.y),
        }
    };
    let bodies: Vec<Body<'_>> = trees.iter().map(body).collect();
    geometry::touching(&bodies)
}

fn group(
    bindings: &Bindings,
    trees: &[Tree],
    near: &[Vec<usize>],
    members: &[usize],
) -> FigureGroup {
    let parts: TiVec<FigurePartId, PartId> = members
        .iter()
        .flat_map(|tree| &trees[*tree].parts)
        .copied()
        .collect();
    let place = parts.iter_enumerated().map(|(place, part)| (*part, place));
    let place: BTreeMap<PartId, FigurePartId> = place.collect();
    let parents = parts
        .iter()
        .map(|part| bindings.parts[*part].parent.map(|parent| place[&parent]));
    let first = |tree: &usize| trees[*tree].parts[0];
    let mut touching = ti_vec![None; parts.len()];
    for tree in members {
        let others = near[*tree].iter().map(|other| place[&first(other)]);
        touching[place[&first(tree)]] = Some(others.collect());
    }
    let size = |part: &PartId| area(&bindings.parts[*part].outline);
    // A head may be larger than the trunk of a stick figure.
    let may_carry = |part: &PartId| {
        let role = Role::of(&anatomy::terms(&bindings.parts[*part].name));
        role.is_none_or(|role| role.trunk().is_some())
    };
    // The first of the largest ones, so that equal parts do not swap roles.
    let largest = members.iter().map(first).rev();
    let largest = largest.max_by(|a, b| {
        let rank = |part: &PartId| (may_carry(part), size(part));
        let ((carries_a, a), (carries_b, b)) = (rank(a), rank(b));
        carries_a.cmp(&carries_b).then(a.total_cmp(&b))
    });
    let group = FigureGroup {
        parents: parents.collect(),
        touching,
        root: first(&members[0]),
        parts,
    };
    match largest {
        Some(root) => group.rooted_at(root),
        None => group,
    }
}
