//! A figure of the drawing as motion sees it.

use glam::{DQuat, DVec2, DVec3};

use super::Stage;
use super::cast::Group;
use crate::geometry::{Frame, y_up};
use crate::lang::keyword::Keyword;
use crate::lang::value::Value;
use crate::motion::carry::{Drive, Puppet, PuppetPart};
use crate::motion::figure::{Figure, Part};
use crate::motion::labels::Class;
use crate::motion::matching::{Follow, Matching};
use crate::motion::skeleton::Placed;

/// How the parts of a figure lie, in the order of the group; drawing units, y up.
pub(super) fn figure(stage: &Stage<'_>, group: &Group) -> Figure {
    let bindings = stage.bindings;
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
            // Its joint is where it turns, though that may be between its ends.
            (Some(_), _) => [y_up(part.origin), nearer(y_up(part.origin))[1]],
            (None, Some(parent)) => nearer(middle(group.parts[parent])),
            // A trunk stands on its lower end.
            (None, None) => match one.y <= other.y {
                true => [one, other],
                false => [other, one],
            },
        };
        let own = stage.members[index]
            .iter()
            .map(|member| bindings.parts[*member].measure.bounds);
        let bounds = own.fold(
            [joint.min(tip), joint.max(tip)],
            |[low, high], (from, to)| {
                let (a, b) = (y_up(from), y_up(to));
                [low.min(a.min(b)), high.max(a.max(b))]
            },
        );
        let bones = match bindings
            .setting(index, Keyword::Bone)
            .map(|source| &source.setting.value)
        {
            Some(Value::Names(names)) => names.clone(),
            _ => Vec::new(),
        };
        Part {
            name: part.name.clone(),
            parent,
            joint,
            tip,
            bounds,
            drawn: part.shape,
            bones,
        }
    };
    Figure {
        parts: group.parts.iter().enumerate().map(part).collect(),
    }
}

/// The figure as it is moved, in the order of the group. `branches` are those of the drawing.
pub(super) fn puppet(figure: &Figure, group: &Group, matching: &Matching, nodes: &Nodes) -> Puppet {
    let is_leg = |part: usize| {
        let is_driven = matching.drives[part]
            .as_ref()
            .is_some_and(|drive| drive.follow == Follow::Direction);
        is_driven
            && matching.labels[part]
                .as_ref()
                .is_some_and(|label| label.class == Class::Leg)
    };
    let mut goes_on = vec![false; group.parts.len()];
    for (index, part) in figure.parts.iter().enumerate() {
        if let Some(parent) = part.parent.filter(|_| is_leg(index)) {
            goes_on[parent] = true;
        }
    }
    // A shoe that nothing drives goes along with its leg, and is what it stands on.
    let around = |index: usize| {
        let parts = figure.parts.iter().zip(&matching.drives);
        let worn = parts.filter(|(part, drive)| part.parent == Some(index) && drive.is_none());
        worn.fold(figure.parts[index].bounds, |[low, high], (part, _)| {
            [low.min(part.bounds[0]), high.max(part.bounds[1])]
        })
    };
    let part = |(index, part): (usize, &Part)| {
        let (node, is_rooted) = nodes.of(group.parts[index]);
        let depth = node.position.z;
        let stands = is_leg(index) && !goes_on[index];
        let joint = part.joint.extend(depth);
        let way = part.tip.extend(depth) - joint;
        // A joint beside the axis does not change which way the part points.
        let axis = node.rotation * DVec3::Y;
        let way = if is_rooted {
            way
        } else {
            axis * way.dot(axis).abs()
        };
        PuppetPart {
            parent: part.parent,
            is_rooted,
            node,
            joint,
            tip: joint + way,
            sole: match stands {
                true => sole(part, around(index), depth),
                false => Vec::new(),
            },
            drive: matching.drives[index].as_ref().map(|drive| Drive {
                joint: drive.joint,
                tip: drive.tip,
                follow: drive.follow,
                is_leg: is_leg(index),
            }),
        }
    };
    Puppet {
        parts: figure.parts.iter().enumerate().map(part).collect(),
        facing: matching.facing,
    }
}

/// Where a part that a leg ends with touches the ground, in the box of what hangs on it: below its tip; what is wider than high, a
/// foot, at both ends.
fn sole(part: &Part, [low, high]: [DVec2; 2], depth: f64) -> Vec<DVec3> {
    let size = part.bounds[1] - part.bounds[0];
    match size.x > size.y {
        true => vec![low.extend(depth), DVec3::new(high.x, low.y, depth)],
        false => vec![DVec3::new(part.tip.x, low.y, depth)],
    }
}

/// The nodes of parts: where they are at rest, and which there are.
pub(super) struct Nodes {
    /// Per part its node at rest, and whether it hangs on the model's root; copies left out.
    rest: Vec<Option<(Placed, bool)>>,
    /// Per node of the scene.
    pub(super) links: Vec<RestNode>,
}

/// A node of the scene at rest, and what it shows.
#[derive(Debug, Clone, Copy)]
pub struct RestNode {
    /// The part.
    pub part: usize,
    /// Whether it hangs on the model's root.
    pub is_rooted: bool,
    /// Whether it is mirrored in the drawing plane.
    pub is_mirrored: bool,
    /// How far it lies in front of the drawing plane, drawing units.
    pub depth: f64,
}

impl Nodes {
    /// The nodes of a scene, given the frames of their parts; drawing units and the drawing's axes.
    pub(super) fn new(frames: &[Frame], nodes: impl Iterator<Item = RestNode>) -> Self {
        let links: Vec<RestNode> = nodes.collect();
        let mut rest = vec![None; frames.len()];
        for node in &links {
            let frame = &frames[node.part];
            // The original stands before its copies.
            rest[node.part].get_or_insert((
                Placed {
                    rotation: DQuat::from_rotation_z(frame.angle),
                    position: frame.origin.extend(node.depth),
                },
                node.is_rooted,
            ));
        }
        Self { rest, links }
    }

    fn of(&self, part: usize) -> (Placed, bool) {
        let nowhere = Placed {
            rotation: DQuat::IDENTITY,
            position: DVec3::ZERO,
        };
        // Every main part has a branch, unless copies passed their limit.
        self.rest[part].unwrap_or((nowhere, false))
    }
}
