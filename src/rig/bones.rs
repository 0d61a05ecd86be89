//! The bones inside the parts of a rig that bend.

use crate::math;
use glam::{DQuat, DVec3};
use rustc_hash::FxHashMap;
use typed_index_collections::{TiSlice, TiVec};

use super::Context;
use super::figures::FigureGroup;
use crate::bend::Bend;
use crate::bind::PartId;
use crate::labels::{Figure, FigurePartId};
use crate::mocap::Transform;
use crate::retarget::{Matching, Rig, RigPart, SharedTurn};

/// How many bones a part has inside: 1 if it is rigid.
pub(super) fn count(bend: Option<&Bend>) -> usize {
    bend.map_or(1, Bend::bones)
}

/// Adds the bones of parts that bend to the parts of a rig, which are in the order of the figure's.
pub(super) fn add(
    context: &Context<'_>,
    figure: &Figure,
    group: &FigureGroup,
    matching: &Matching,
    parts: &mut TiVec<FigurePartId, RigPart>,
) {
    let children = children(figure);
    let bend = |index: FigurePartId| context.bends[group.parts[index]].as_deref();
    let bending = || {
        let indices = group.parts.keys();
        indices.filter_map(move |index| Some((index, bend(index)?)))
    };
    let mut chains: FxHashMap<FigurePartId, Vec<FigurePartId>> = FxHashMap::default();
    for (index, bend) in bending().filter(|(_, bend)| !bend.is_worn) {
        let chain = add_chain(bend, index, &matching.parts[index].bones, parts);
        chains.insert(index, chain);
    }
    for (index, own) in bending().filter(|(_, bend)| bend.is_worn) {
        // No joint of the motion turns it as well, such as that of a foot.
        parts[index].drive = None;
        // A garment has the bones of its parent, but for the first.
        let wearer = figure.parts[index]
            .parent
            .and_then(|wearer| chains.get(&wearer));
        let of_wearer = wearer.map_or(Vec::new(), |chain| chain[1..].to_vec());
        if of_wearer.len() == own.nodes.len() {
            chains.insert(index, [vec![index], of_wearer].concat());
        }
    }
    for (index, own) in bending() {
        let Some(chain) = chains.get(&index) else {
            continue;
        };
        for child in &children[index] {
            let joint = figure.parts[*child].joint;
            let is_worn = bend(*child).is_some_and(|bend| bend.is_worn);
            let bone = if is_worn { 0 } else { own.node_at(joint) };
            parts[*child].parent = Some(chain[bone]);
        }
        // What is near the ground moves with the bone that it is on.
        let bone = |point: &DVec3| chain[own.node_at(point.truncate())];
        for point in std::mem::take(&mut parts[index].surface) {
            parts[bone(&point)].surface.push(point);
        }
        for point in std::mem::take(&mut parts[index].outline) {
            parts[bone(&point)].outline.push(point);
        }
        if let Some(last) = chain.last()
            && std::mem::take(&mut parts[index].stands)
        {
            parts[*last].stands = true;
        }
    }
}

fn children(figure: &Figure) -> TiVec<FigurePartId, Vec<FigurePartId>> {
    let mut children: TiVec<FigurePartId, Vec<FigurePartId>> =
        figure.parts.iter().map(|_| Vec::new()).collect();
    for (index, part) in figure.parts.iter_enumerated() {
        if let Some(parent) = part.parent {
            children[parent].push(index);
        }
    }
    children
}

/// Adds the bones of a part, given what drives all but the first. Returns them all, the part itself first.
fn add_chain(
    bend: &Bend,
    index: FigurePartId,
    drives: &[Option<crate::retarget::Drive>],
    parts: &mut TiVec<FigurePartId, RigPart>,
) -> Vec<FigurePartId> {
    let base = parts[index].clone();
    let depth = base.node.position.z;
    let mut chain = vec![index];
    // The bone before the joint whose turn is shared, and the first of the nodes that share it.
    let (mut before, mut first) = (index, 1);
    for node in &bend.nodes {
        let own = parts.next_key();
        let rotation = math::rotation_z(node.angle);
        let position = node.position.extend(depth);
        let is_bone = node.is_bone();
        parts.push(RigPart {
            parent: chain.last().copied(),
            is_rooted: false,
            node: Transform { rotation, position },
            joint: position,
            tip: position,
            surface: Vec::new(),
            outline: Vec::new(),
            is_arm: base.is_arm,
            stands: false,
            drive: drives
                .get(node.joint)
                .copied()
                .flatten()
                .filter(|_| is_bone),
            is_leg: base.is_leg,
            swing: base.swing.filter(|_| is_bone),
            inside: Some(index),
            shared: None,
        });
        chain.push(own);
        if is_bone {
            let places = first..chain.len() - 1;
            let sharing = chain[places.clone()].iter().zip(&bend.nodes[first - 1..]);
            for (part, node) in sharing {
                parts[*part].shared = Some(SharedTurn {
                    between: [before, own],
                    share: node.share,
                });
            }
            before = own;
            first = chain.len();
        }
    }
    set_tips(bend, &chain, parts);
    chain
}

/// Sets the far ends of the bones of a part: a bone before a joint ends in the joint's middle.
fn set_tips(bend: &Bend, chain: &[FigurePartId], parts: &mut TiSlice<FigurePartId, RigPart>) {
    let tip = bend.tip();
    for (number, part) in chain.iter().enumerate() {
        let own = number.checked_sub(1).map(|number| bend.nodes[number]);
        let joint = parts[*part].joint;
        let is_bone = own.is_none_or(|node| node.is_bone());
        let end = match own {
            // From the middle on the nodes that share a turn lead to each other.
            Some(node) if !is_bone => {
                let after = bend.nodes[number..].first();
                let is_late = node.share >= 0.5;
                after
                    .filter(|_| is_late)
                    .map_or(node.position, |after| after.position)
            }
            _ => {
                let joint = own.map_or(0, |node| node.joint + 1);
                bend.middle(joint).unwrap_or(tip)
            }
        };
        let end = end.extend(joint.z);
        parts[*part].tip = match own {
            // Its node points along the bone.
            Some(_) if is_bone => along(parts[*part].node.rotation, joint, end),
            // So does that of a part which is not drawn bent.
            None if is_along(parts[*part].node.rotation, end - joint) => {
                along(parts[*part].node.rotation, joint, end)
            }
            _ => end,
        };
    }
}

/// Whether a way leads along a node's axis, but for a few degrees.
fn is_along(rotation: DQuat, way: DVec3) -> bool {
    const FEW: f64 = 5.0;
    math::angle_between(rotation * DVec3::Y, way) < FEW.to_radians()
}

/// The place on a node's axis that is as far along it as another one.
fn along(rotation: DQuat, joint: DVec3, end: DVec3) -> DVec3 {
    let axis = rotation * DVec3::Y;
    joint + axis * (end - joint).dot(axis).max(0.0)
}

/// The bones of a part of a rig: the part itself, and those inside it from its joint to its far end.
pub(super) fn chain(rig: &Rig, part: FigurePartId) -> Vec<FigurePartId> {
    let inside = rig.parts.iter_enumerated();
    let inside = inside.filter(|(_, bone)| bone.inside == Some(part));
    let inside = inside.map(|(bone, _)| bone);
    std::iter::once(part).chain(inside).collect()
}

/// The last bone of a part that something drives; the part itself if nothing does.
pub(super) fn driven_end(rig: &Rig, part: FigurePartId) -> FigurePartId {
    let mut bones = chain(rig, part).into_iter().rev();
    let driven = bones.find(|bone| rig.parts[*bone].drive.is_some());
    driven.unwrap_or(part)
}

/// The parts of a rig, each with the number of its node: 0 is the part's own one.
pub(super) fn nodes(group: &FigureGroup, rig: &Rig) -> TiVec<FigurePartId, (PartId, usize)> {
    let mut inside: TiVec<FigurePartId, usize> = group.parts.iter().map(|_| 0).collect();
    let nodes = rig.parts.iter_enumerated().map(|(index, part)| {
        let Some(of) = part.inside else {
            return (group.parts[index], 0);
        };
        inside[of] += 1;
        (group.parts[of], inside[of])
    });
    nodes.collect()
}
