//! A figure of the drawing as motion sees it.

use glam::{DQuat, DVec2, DVec3};

use super::super::Model;
use super::super::frame::{Frame, up};
use super::super::tree::Branch;
use super::cast::Group;
use crate::lang::keyword::Keyword;
use crate::lang::value::Value;
use crate::motion::carry::{Drive, Puppet, PuppetPart};
use crate::motion::figure::{Figure, Part};
use crate::motion::labels::Class;
use crate::motion::matching::{Follow, Matching};
use crate::motion::skeleton::Placed;

/// How the parts of a figure lie, in the order of the group; drawing units, y up.
pub(super) fn figure(model: &Model<'_>, group: &Group, members: &[Vec<usize>]) -> Figure {
    let bindings = model.bindings;
    let middle = |part: usize| up(bindings.parts[part].measure.center);
    let part = |(place, &index): (usize, &usize)| {
        let part = &bindings.parts[index];
        let [one, other] = part.measure.ends.map(up);
        let nearer = |to: DVec2| match one.distance_squared(to) <= other.distance_squared(to) {
            true => [one, other],
            false => [other, one],
        };
        let parent = group.parents[place];
        let [joint, tip] = match (part.parent, parent) {
            // Its joint is where it turns, though that may be between its ends.
            (Some(_), _) => [up(part.origin), nearer(up(part.origin))[1]],
            (None, Some(parent)) => nearer(middle(group.parts[parent])),
            // A trunk stands on its lower end.
            (None, None) => match one.y <= other.y {
                true => [one, other],
                false => [other, one],
            },
        };
        let own = members[index]
            .iter()
            .map(|member| bindings.parts[*member].measure.bounds);
        let bounds = own.fold(
            [joint.min(tip), joint.max(tip)],
            |[low, high], (from, to)| {
                let (a, b) = (up(from), up(to));
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
pub(in super::super) struct Nodes {
    /// Per part its node at rest, and whether it hangs on the model's root; copies left out.
    rest: Vec<Option<(Placed, bool)>>,
    /// Per node of the scene.
    pub(super) links: Vec<Link>,
}

/// A node, and what it shows.
pub(super) struct Link {
    /// The part.
    pub(super) part: usize,
    /// Whether it hangs on the model's root.
    pub(super) is_rooted: bool,
    /// Whether it is mirrored in the drawing plane.
    pub(super) is_mirrored: bool,
}

impl Nodes {
    /// The nodes that the branches become; drawing units and the drawing's axes.
    pub(in super::super) fn new(model: &Model<'_>, frames: &[Frame], branches: &[Branch]) -> Self {
        let mut rest = vec![None; model.bindings.parts.len()];
        let mut depths = Vec::with_capacity(branches.len());
        let mut links = Vec::with_capacity(branches.len());
        for branch in branches {
            let above = branch.parent.map_or(0.0, |parent: usize| depths[parent]);
            let depth: f64 = above + branch.place.z;
            depths.push(depth);
            let frame = &frames[branch.part];
            let is_rooted = branch.parent.is_none();
            // The original stands before its copies.
            rest[branch.part].get_or_insert((
                Placed {
                    rotation: DQuat::from_rotation_z(frame.angle),
                    position: frame.origin.extend(depth),
                },
                is_rooted,
            ));
            links.push(Link {
                part: branch.part,
                is_rooted,
                is_mirrored: branch.mirrored,
            });
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
