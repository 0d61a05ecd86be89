//! The nodes of figures as far as depths depend on them.

use typed_index_collections::{TiVec, ti_vec};

use super::super::FigureContext;
use super::overlaps::Overlap;
use super::shapes::Shape;
use crate::bind::{PartId, PartKind, SetBy};

/// The nodes, by an index of their own, in the order of their main parts.
pub(super) struct Nodes {
    /// Per node its main part.
    pub(super) main: Vec<PartId>,
    /// Per part its node, if it is a main part.
    pub(super) of_part: TiVec<PartId, Option<usize>>,
    pub(super) parent: Vec<Option<usize>>,
    /// Per node the shape of its main part, if that has a solid.
    pub(super) shape: Vec<Option<usize>>,
    /// Per shape its node.
    pub(super) of_shape: Vec<usize>,
    /// Per node how many it hangs on, one after the other.
    pub(super) level: Vec<usize>,
    /// Per node its own `Offset`; 0 for one whose depth is given in another way.
    pub(super) given: Vec<Option<f64>>,
    /// Per node the `Offset` of all nodes.
    pub(super) shift: Vec<f64>,
    walk: Walk,
}

/// A walk through the tree of nodes.
#[derive(Default)]
struct Walk {
    /// Per node when it is entered and left.
    span: Vec<[usize; 2]>,
    /// The nodes, each after its parent.
    order: Vec<usize>,
}

/// What hangs on the same roots.
pub(super) struct RootedShapes {
    /// Per node the one that carries all that it hangs on.
    root: Vec<usize>,
    /// Per root the shapes of its figure, and its width, drawing units.
    shapes: Vec<Vec<usize>>,
    width: Vec<f64>,
}

impl RootedShapes {
    /// The node that carries all that a node hangs on.
    pub(super) fn root(&self, node: usize) -> usize {
        self.root[node]
    }

    /// The shapes of the figure of a node, in the order of drawing.
    pub(super) fn shapes(&self, node: usize) -> &[usize] {
        &self.shapes[self.root[node]]
    }

    /// The width of the figure of a node, drawing units.
    pub(super) fn width(&self, node: usize) -> f64 {
        self.width[self.root[node]]
    }
}

impl Nodes {
    pub(super) fn new(context: &FigureContext<'_>, shapes: &[Shape]) -> Self {
        let parts = &context.bindings.parts;
        // A prop is a node of its own.
        let is_main = |part: &PartId| match parts[*part].kind {
            PartKind::Main => true,
            PartKind::Prop => parts[*part].is_candidate(),
            _ => false,
        };
        let main: Vec<PartId> = parts.keys().filter(is_main).collect();
        let mut of_part = ti_vec![None; parts.len()];
        for (node, part) in main.iter().enumerate() {
            of_part[*part] = Some(node);
        }
        let parent: Vec<Option<usize>> = main
            .iter()
            .map(|part| parts[*part].parent.and_then(|parent| of_part[parent]))
            .collect();
        let mut shape = vec![None; main.len()];
        let mut of_shape = Vec::with_capacity(shapes.len());
        for (index, own) in shapes.iter().enumerate() {
            let node = of_part[own.main].unwrap_or_default();
            of_shape.push(node);
            if own.is_main {
                shape[node] = Some(index);
            }
        }
        let offset = |part: PartId| context.bindings.attributes(part).offset();
        let given = |(node, part): (usize, &PartId)| {
            let own = offset(*part).filter(|offset| offset.source.from < SetBy::Default);
            let is_given = shape[node].is_some_and(|shape| shapes[shape].is_given);
            let is_mirrored = context.bindings.attributes(*part).shape().mirrored;
            match own {
                // Its two solids are moved instead.
                Some(offset) if !is_mirrored => Some(offset.value),
                Some(_) => Some(0.0),
                None => is_given.then_some(0.0),
            }
        };
        let shift = |part: &PartId| match offset(*part) {
            Some(offset) if offset.source.from == SetBy::Default => context.node_offset(*part),
            _ => 0.0,
        };
        let mut nodes = Self {
            given: main.iter().enumerate().map(given).collect(),
            shift: main.iter().map(shift).collect(),
            main,
            of_part,
            parent,
            shape,
            of_shape,
            level: Vec::new(),
            walk: Walk::default(),
        };
        nodes.walk_through();
        nodes
    }

    /// Hangs nodes that hang on nothing on the largest one of these that they are connected with, and details on what most of them lies
    /// on. `details` says per shape whether it is one.
    pub(super) fn hang_on_trunks(
        &mut self,
        shapes: &[Shape],
        overlaps: &[Vec<Overlap>],
        details: &[bool],
    ) {
        let roots = self.roots();
        let area = |node: usize| self.shape[node].map_or(0.0, |shape| shapes[shape].area);
        let mut trunk_of: Vec<Option<usize>> = vec![None; self.len()];
        for connected in self.connected(overlaps) {
            let free = connected.iter().copied();
            let largest = free
                .filter(|node| self.parent[*node].is_none())
                .max_by(|a, b| area(*a).total_cmp(&area(*b)).then(b.cmp(a)));
            connected.iter().for_each(|node| trunk_of[*node] = largest);
        }
        for (node, trunk) in trunk_of.into_iter().enumerate() {
            let detail = self.shape[node].filter(|shape| details[*shape]);
            let carrier = detail.and_then(|shape| {
                let below = overlaps[shape].iter();
                // Each hangs on an earlier one, so that none hangs on itself.
                let others = below.filter(|overlap| roots[self.of_shape[overlap.below]] < node);
                let most = others.max_by(|a, b| a.area.total_cmp(&b.area))?;
                Some(self.of_shape[most.below])
            });
            if self.parent[node].is_none() && trunk != Some(node) {
                self.parent[node] = carrier.or(trunk);
            }
        }
        self.walk_through();
    }

    /// Per node the one that carries all that it hangs on.
    pub(super) fn roots(&self) -> Vec<usize> {
        let mut roots: Vec<usize> = (0..self.len()).collect();
        for node in self.by_level() {
            if let Some(parent) = self.parent[node] {
                roots[node] = roots[parent];
            }
        }
        roots
    }

    /// The figures of a drawing.
    pub(super) fn figures(&self, shapes: &[Shape]) -> RootedShapes {
        let root = self.roots();
        let mut of_root: Vec<Vec<usize>> = vec![Vec::new(); self.len()];
        let mut ends = vec![[f64::INFINITY, f64::NEG_INFINITY]; self.len()];
        for (index, shape) in shapes.iter().enumerate() {
            let root = root[self.of_shape[index]];
            let (low, high) = shape.bounds;
            of_root[root].push(index);
            ends[root] = [ends[root][0].min(low.x), ends[root][1].max(high.x)];
        }
        RootedShapes {
            root,
            shapes: of_root,
            width: ends.into_iter().map(|[low, high]| high - low).collect(),
        }
    }

    /// The nodes in groups whose shapes overlap, directly or through others.
    fn connected(&self, overlaps: &[Vec<Overlap>]) -> Vec<Vec<usize>> {
        let mut near: Vec<Vec<usize>> = vec![Vec::new(); self.len()];
        for (above, below) in overlaps.iter().enumerate() {
            for overlap in below {
                let [above, below] = [above, overlap.below].map(|shape| self.of_shape[shape]);
                near[above].push(below);
                near[below].push(above);
            }
        }
        let mut is_known = vec![false; self.len()];
        let mut groups = Vec::new();
        for first in 0..self.len() {
            if std::mem::replace(&mut is_known[first], true) {
                continue;
            }
            let mut group = vec![first];
            let mut next = 0;
            while let Some(node) = group.get(next).copied() {
                for other in &near[node] {
                    if !std::mem::replace(&mut is_known[*other], true) {
                        group.push(*other);
                    }
                }
                next += 1;
            }
            groups.push(group);
        }
        groups
    }

    fn walk_through(&mut self) {
        let count = self.len();
        let mut children: Vec<Vec<usize>> = vec![Vec::new(); count];
        let mut open: Vec<(usize, bool)> = Vec::new();
        for (node, parent) in self.parent.iter().enumerate().rev() {
            match parent {
                Some(parent) => children[*parent].push(node),
                None => open.push((node, false)),
            }
        }
        self.level = vec![0; count];
        let mut walk = Walk {
            span: vec![[0; 2]; count],
            order: Vec::with_capacity(count),
        };
        while let Some((node, is_left)) = open.pop() {
            if is_left {
                walk.span[node][1] = walk.order.len();
                continue;
            }
            walk.span[node][0] = walk.order.len();
            walk.order.push(node);
            self.level[node] = self.parent[node].map_or(0, |parent| self.level[parent] + 1);
            open.push((node, true));
            open.extend(children[node].iter().map(|child| (*child, false)));
        }
        self.walk = walk;
    }

    pub(super) fn len(&self) -> usize {
        self.main.len()
    }

    /// Whether a node is another one or hangs on it, directly or not.
    pub(super) fn hangs_on(&self, node: usize, other: usize) -> bool {
        let [from, to] = self.walk.span[other];
        (from..to).contains(&self.walk.span[node][0])
    }

    /// All nodes, each after its parent.
    pub(super) fn by_level(&self) -> impl Iterator<Item = usize> + '_ {
        self.walk.order.iter().copied()
    }
}
