//! Builds rigs from the figures of a drawing.

use std::sync::Arc;

use glam::{DQuat, DVec2, DVec3};

use super::Context;
use super::figures::FigureGroup;
use crate::bind::Carry;
use crate::geometry::{Frame, y_up};
use crate::memo::{Bits, Same};
use crate::motion::figure::{Figure, FigurePart};
use crate::motion::labels::{Class, Facing};
use crate::motion::matching::{Drive, Follow, Matching};
use crate::motion::prepare::PreparedClip;
use crate::motion::retarget::{Rig, RigPart};
use crate::motion::skeleton::Transform;

/// A figure as it is drawn, its parts in the order of the group; drawing units, y up.
pub(super) fn drawn_figure(context: &Context<'_>, group: &FigureGroup) -> Figure {
    let bindings = context.bindings;
    let middle = |part: usize| y_up(bindings.parts[part].measure.center);
    let part = |(place, &index): (usize, &usize)| {
        let part = &bindings.parts[index];
        let [one, other] = part.measure.ends.map(y_up);
        let nearer = |to: DVec2| match one.distance_squared(to) <= other.distance_squared(to) {
            true => [one, other],
            false => [other, one],
        };
        let parent = group.parents[place];
        let [joint, tip] = match (part.parent, parent) {
            // It turns about its joint, even if that is between its ends.
            (Some(_), _) => [y_up(part.origin), nearer(y_up(part.origin))[1]],
            (None, Some(parent)) => nearer(middle(group.parts[parent])),
            // A trunk has its joint at its lower end.
            (None, None) => match one.y <= other.y {
                true => [one, other],
                false => [other, one],
            },
        };
        let own = context.parts_of_node[index]
            .iter()
            .map(|member| bindings.parts[*member].measure.bounds);
        let bounds = own.fold(
            [joint.min(tip), joint.max(tip)],
            |[low, high], (from, to)| {
                let (a, b) = (y_up(from), y_up(to));
                [low.min(a.min(b)), high.max(a.max(b))]
            },
        );
        let bones = bindings.attributes(index).bones();
        let bones = bones.map_or(Vec::new(), |bones| bones.value.to_vec());
        FigurePart {
            name: part.name.clone(),
            parent,
            joint,
            tip,
            bounds,
            drawing_order: part.shape,
            bones,
            carry: bindings.attributes(index).carry().map(follow),
        }
    };
    Figure {
        parts: group.parts.iter().enumerate().map(part).collect(),
    }
}

fn follow(carry: Carry) -> Follow {
    match carry {
        Carry::Direction => Follow::Direction,
        Carry::Change => Follow::Change,
    }
}

/// The rig of a matched figure, its parts in the order of the group.
pub(super) fn rig(
    figure: &Figure,
    group: &FigureGroup,
    matching: &Matching,
    nodes: &RestNodes,
) -> Rig {
    let is_leg = |part: usize| {
        let matched = &matching.parts[part];
        let is_bone = matched.drive.is_some_and(|drive| drive.tip.is_some());
        let class = matched.label.as_ref().map(|label| label.class);
        (is_bone, class) == (true, Some(Class::Leg))
    };
    let mut continues = vec![false; group.parts.len()];
    for (index, part) in figure.parts.iter().enumerate() {
        if let Some(parent) = part.parent.filter(|_| is_leg(index)) {
            continues[parent] = true;
        }
    }
    // A shoe without a drive follows its leg, and is what the leg stands on.
    let around = |index: usize| {
        let parts = figure.parts.iter().zip(&matching.parts);
        let worn =
            parts.filter(|(part, matched)| part.parent == Some(index) && matched.drive.is_none());
        worn.fold(figure.parts[index].bounds, |[low, high], (part, _)| {
            [low.min(part.bounds[0]), high.max(part.bounds[1])]
        })
    };
    let part = |(index, part): (usize, &FigurePart)| {
        let (node, is_rooted) = nodes.of(group.parts[index]);
        let depth = node.position.z;
        let stands = is_leg(index) && !continues[index];
        let joint = part.joint.extend(depth);
        let way = part.tip.extend(depth) - joint;
        // A joint beside the axis does not change where the part points.
        let axis = node.rotation * DVec3::Y;
        let way = if is_rooted {
            way
        } else {
            axis * way.dot(axis).abs()
        };
        RigPart {
            parent: part.parent,
            is_rooted,
            node,
            joint,
            tip: joint + way,
            sole: match stands {
                true => sole(part, around(index), depth),
                false => Vec::new(),
            },
            drive: matching.parts[index].drive,
            is_leg: is_leg(index),
        }
    };
    Rig {
        parts: figure.parts.iter().enumerate().map(part).collect(),
        facing: matching.facing,
    }
}

/// The points where the last part of a leg touches the ground, on the lower edge of the bounding box around it and what is attached
/// to it: below its tip, or, if it is wider than high like a foot, at both ends.
fn sole(part: &FigurePart, [low, high]: [DVec2; 2], depth: f64) -> Vec<DVec3> {
    let size = part.bounds[1] - part.bounds[0];
    match size.x > size.y {
        true => vec![low.extend(depth), DVec3::new(high.x, low.y, depth)],
        false => vec![DVec3::new(part.tip.x, low.y, depth)],
    }
}

/// A node of the scene at rest, and the part that it shows.
#[derive(Debug, Clone, Copy)]
pub struct RestNode {
    /// The part.
    pub part: usize,
    /// Whether it is a child of the model's root.
    pub is_rooted: bool,
    /// Whether it is mirrored in the drawing plane.
    pub is_mirrored: bool,
    /// Its distance in front of the drawing plane, drawing units.
    pub depth: f64,
}

/// Per part its node at rest, in drawing units and the drawing's axes, and whether that is a child of the model's root; without
/// copies of parts.
pub(super) struct RestNodes(Vec<Option<(Transform, bool)>>);

impl RestNodes {
    /// The nodes of a scene, given the rest frames of parts.
    pub(super) fn new(frames: &[Frame], nodes: &[RestNode]) -> Self {
        let mut rest = vec![None; frames.len()];
        for node in nodes {
            let frame = &frames[node.part];
            // The original precedes its copies.
            rest[node.part].get_or_insert((
                Transform {
                    rotation: DQuat::from_rotation_z(frame.angle),
                    position: frame.origin.extend(node.depth),
                },
                node.is_rooted,
            ));
        }
        Self(rest)
    }

    fn of(&self, part: usize) -> (Transform, bool) {
        let origin = Transform {
            rotation: DQuat::IDENTITY,
            position: DVec3::ZERO,
        };
        // Every main part has a node, unless copies exceeded their limit.
        self.0[part].unwrap_or((origin, false))
    }
}

/// A motion and a rig with its numbers as bits, as the key of a cached [`RetargetedClip`](crate::motion::retarget::RetargetedClip).
#[derive(PartialEq, Eq, Hash)]
pub(super) struct RetargetKey {
    motion: Same<PreparedClip>,
    facing: Facing,
    parts: Vec<PartKey>,
}

#[derive(PartialEq, Eq, Hash)]
struct PartKey {
    parent: Option<usize>,
    is_rooted: bool,
    is_leg: bool,
    drive: Option<Drive>,
    rotation: Bits<[f64; 4]>,
    /// The positions of node, joint and tip, and the points of the sole.
    points: Vec<Bits<[f64; 3]>>,
}

impl RetargetKey {
    pub(super) fn new(rig: &Rig, motion: &Arc<PreparedClip>) -> Self {
        let part = |part: &RigPart| PartKey {
            parent: part.parent,
            is_rooted: part.is_rooted,
            is_leg: part.is_leg,
            drive: part.drive,
            rotation: Bits(part.node.rotation.to_array()),
            points: [part.node.position, part.joint, part.tip]
                .iter()
                .chain(&part.sole)
                .map(|point| Bits(point.to_array()))
                .collect(),
        };
        Self {
            motion: Same(Arc::clone(motion)),
            facing: rig.facing,
            parts: rig.parts.iter().map(part).collect(),
        }
    }
}
