//! The hierarchy of nodes with the copies that `-d` makes, each in its parent's frame.

use glam::DVec3;
use rustc_hash::FxHashMap;
use typed_index_collections::{TiSlice, TiVec, ti_vec};

use super::layers::Layers;
use super::{FigureContext, PartFrames};
use crate::bind::{PartId, PartKind};
use crate::diagnostic::{Code, Diagnostic};
use crate::geometry::Frame;
use crate::scene::NodeId;

/// Limit of the nodes that `-d` adds: nested copies double each time.
const MAX_COPIES: usize = 1 << 16;

/// A node of a figure in its parent's frame.
#[derive(Debug, Clone)]
pub(super) struct FigureNode {
    pub(super) name: String,
    /// The part that it shows.
    pub(super) part: PartId,
    /// Which node of the part it is: 0 is its own one, others bend it.
    pub(super) bone: usize,
    /// See [`Node::shares`](crate::scene::Node::shares).
    pub(super) shares: usize,
    /// The parent node, which comes before it.
    pub(super) parent: Option<NodeId>,
    /// Its position in the parent's frame, drawing units, y up.
    pub(super) position: DVec3,
    /// Its rotation about +Z, radians.
    pub(super) angle: f64,
    /// Whether it is mirrored in the drawing plane.
    pub(super) is_mirrored: bool,
}

/// A part that needs a node.
#[derive(Clone, Copy)]
struct Pending {
    part: PartId,
    /// The parent node, and its frame.
    parent: Option<(NodeId, Frame)>,
    is_mirrored: bool,
    /// How many of the part and its ancestors are the copies that `-d` makes.
    copies: usize,
}

/// The nodes of all main parts with the copies that `-d` makes, parents before children.
pub(super) fn nodes(
    context: &FigureContext<'_>,
    frames: &TiSlice<PartId, PartFrames>,
    layers: &Layers,
    diagnostics: &mut Vec<Diagnostic>,
) -> TiVec<NodeId, FigureNode> {
    let parts = &context.bindings.parts;
    let mut children: TiVec<PartId, Vec<PartId>> = ti_vec![Vec::new(); parts.len()];
    let mut roots = Vec::new();
    let mains = parts.iter_enumerated();
    for (index, part) in mains.filter(|(_, part)| part.kind == PartKind::Main) {
        match part.parent {
            Some(parent) => children[parent].push(index),
            None => roots.push(index),
        }
    }
    let is_doubled = |part: PartId| context.bindings.attributes(part).shape().doubled;
    let mut mains = parts
        .keys()
        .filter(|part| parts[*part].kind == PartKind::Main);
    // Copies and bones are named after their parts.
    let has_more = mains.any(is_doubled) || context.bends.iter().any(Option::is_some);
    let taken = parts.iter().filter(|_| has_more);
    let mut names: FxHashMap<String, usize> = taken.map(|part| (part.name.clone(), 1)).collect();
    let mut nodes: TiVec<NodeId, FigureNode> = TiVec::with_capacity(parts.len());
    // A stack: the copy of a part is pushed first, so that it comes after the original and all below it.
    let mut stack: Vec<Pending> = Vec::new();
    let push = |stack: &mut Vec<Pending>, pending: Pending| {
        if is_doubled(pending.part) {
            stack.push(Pending {
                is_mirrored: !pending.is_mirrored,
                copies: pending.copies + 1,
                ..pending
            });
        }
        stack.push(pending);
    };
    for root in roots.iter().rev() {
        let pending = Pending {
            part: *root,
            parent: None,
            is_mirrored: false,
            copies: 0,
        };
        push(&mut stack, pending);
    }
    while let Some(pending) = stack.pop() {
        if nodes.len() >= parts.len() + MAX_COPIES {
            let element = &context.drawing.shapes[parts[pending.part].shape].element;
            let message = format!("the copies of `-d` add more than {MAX_COPIES} nodes");
            diagnostics.push(
                    Diagnostic::new(Code::LimitPassed, element.span, message)
                    .help("each `-d` doubles everything attached to the part, so nested ones multiply: remove some of them"),
                );
            break;
        }
        let mut node = node(context, frames, layers, pending);
        if pending.copies > 0 {
            node.name = free_name(node.name, &mut names);
        }
        let id = nodes.push_and_get_key(node);
        let chain = bones(context, frames, pending, id, &mut names, &mut nodes);
        for child in children[pending.part].iter().rev() {
            let bend = context.bends[pending.part].as_deref();
            let is_worn = context.bends[*child]
                .as_deref()
                .is_some_and(|bend| bend.is_worn);
            // What follows all bones hangs on the first one.
            let bend = bend.filter(|_| !is_worn);
            let bone = bend.map_or(0, |bend| bend.node_at(frames[*child].node.origin));
            let child = Pending {
                part: *child,
                parent: Some(chain[bone]),
                ..pending
            };
            push(&mut stack, child);
        }
    }
    nodes
}

/// A name that no other node has: that of the copy, with a number if it is taken.
fn free_name(name: String, names: &mut FxHashMap<String, usize>) -> String {
    let mut count = names.get(&name).copied().unwrap_or(0);
    if count == 0 {
        names.insert(name.clone(), 1);
        return name;
    }
    loop {
        count += 1;
        let numbered = format!("{name}-{count}");
        if !names.contains_key(&numbered) {
            names.insert(name, count);
            names.insert(numbered.clone(), 1);
            return numbered;
        }
    }
}

/// Adds the nodes that bend a part, each the child of the one before. Returns all nodes of the part with their frames, its own one
/// first; those of a garment are its own one and those that bend its parent.
fn bones(
    context: &FigureContext<'_>,
    frames: &TiSlice<PartId, PartFrames>,
    pending: Pending,
    own: NodeId,
    names: &mut FxHashMap<String, usize>,
    nodes: &mut TiVec<NodeId, FigureNode>,
) -> Vec<(NodeId, Frame)> {
    let mut chain = vec![(own, frames[pending.part].node)];
    let Some(bend) = context.bends[pending.part].as_deref() else {
        return chain;
    };
    let suffix = ".back".repeat(pending.copies);
    let called = bend.names(&context.bindings.parts[pending.part].name);
    for (number, (bone, name)) in bend.nodes.iter().zip(called).enumerate() {
        let (parent, above) = chain[number];
        let frame = Frame {
            origin: bone.position,
            center: bone.position,
            angle: bone.angle,
        };
        if let Some((wearer, _)) = pending.parent.filter(|_| bend.is_worn) {
            // They come right after the parent's own node.
            chain.push((NodeId::from(usize::from(wearer) + 1 + number), frame));
            continue;
        }
        let id = nodes.push_and_get_key(FigureNode {
            name: free_name(format!("{name}{suffix}"), names),
            part: pending.part,
            bone: number + 1,
            shares: if bone.is_bone() { bend.shares() } else { 0 },
            parent: Some(parent),
            position: above.to_local(frame.origin).extend(0.0),
            angle: frame.angle - above.angle,
            is_mirrored: pending.is_mirrored,
        });
        chain.push((id, frame));
    }
    chain
}

fn node(
    context: &FigureContext<'_>,
    frames: &TiSlice<PartId, PartFrames>,
    layers: &Layers,
    pending: Pending,
) -> FigureNode {
    let part = &context.bindings.parts[pending.part];
    let own = &frames[pending.part].node;
    let offset = layers.node_step(pending.part, part.parent);
    let depth = if pending.is_mirrored { -offset } else { offset };
    let (position, angle) = match &pending.parent {
        Some((_, above)) => (above.to_local(own.origin), own.angle - above.angle),
        None => (own.origin, own.angle),
    };
    FigureNode {
        name: format!("{}{}", part.name, ".back".repeat(pending.copies)),
        part: pending.part,
        bone: 0,
        shares: 0,
        parent: pending.parent.map(|(parent, _)| parent),
        position: position.extend(depth),
        angle,
        is_mirrored: pending.is_mirrored,
    }
}
