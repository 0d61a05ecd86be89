//! The nodes of figures as far as depths depend on them.

use typed_index_collections::{TiVec, ti_vec};

use super::super::FigureContext;
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
    /// Per node when a walk through the tree enters and leaves it.
    span: Vec<[usize; 2]>,
    order: Vec<usize>,
}

impl Nodes {
    pub(super) fn new(context: &FigureContext<'_>, shapes: &[Shape]) -> Self {
        let parts = &context.bindings.parts;
        let is_main = |part: &PartId| parts[*part].kind == PartKind::Main;
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
        let mut children: Vec<Vec<usize>> = vec![Vec::new(); main.len()];
        let mut open: Vec<(usize, bool)> = Vec::new();
        for (node, parent) in parent.iter().enumerate().rev() {
            match parent {
                Some(parent) => children[*parent].push(node),
                None => open.push((node, false)),
            }
        }
        let mut span = vec![[0; 2]; main.len()];
        let mut level = vec![0; main.len()];
        let mut order = Vec::with_capacity(main.len());
        while let Some((node, is_left)) = open.pop() {
            if is_left {
                span[node][1] = order.len();
                continue;
            }
            span[node][0] = order.len();
            order.push(node);
            level[node] = parent[node].map_or(0, |parent| level[parent] + 1);
            open.push((node, true));
            open.extend(children[node].iter().map(|child| (*child, false)));
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
        Self {
            given: main.iter().enumerate().map(given).collect(),
            shift: main.iter().map(shift).collect(),
            main,
            of_part,
            parent,
            shape,
            of_shape,
            level,
            span,
            order,
        }
    }

    pub(super) fn len(&self) -> usize {
        self.main.len()
    }

    /// Whether a node is another one or hangs on it, directly or not.
    pub(super) fn hangs_on(&self, node: usize, other: usize) -> bool {
        let [from, to] = self.span[other];
        (from..to).contains(&self.span[node][0])
    }

    /// All nodes, each after its parent.
    pub(super) fn by_level(&self) -> impl Iterator<Item = usize> + '_ {
        self.order.iter().copied()
    }
}
