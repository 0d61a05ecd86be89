//! Joints inside one outline: an arm, a leg, a tail that is drawn as one shape bends along its centreline (docs/figures.md, "Limbs
//! that bend").
//!
//! A part with joints has a chain of nodes instead of one. Its surface is bound to them by weights, which follow from how far along
//! the centreline a point is. At rest the surface is that of the rigid part.

mod centerline;
mod cuts;
mod grid;
mod skinned;
#[cfg(test)]
mod tests;

use crate::math;
use glam::DVec2;

pub(crate) use centerline::Centerline;
pub(crate) use skinned::{BentSurface, Bones};

/// The length of a bend about its joint, in widths there: with less, the inside folds at 120°.
const ARC: f64 = 1.5;
/// The nodes that share the turn of a joint.
const SHARES: usize = 4;
/// The longest bend about a joint, as a share of the shorter bone beside it.
const MAX_ARC: f64 = 1.8;
/// A bend folds if it is shorter than its width needs by more than this.
const MOST_CROWDING: f64 = 1.25;
/// What is smaller than this share of the width of a part that bends does not bend with it.
const RIGID: f64 = 0.5;
/// A bone of a chain is at least this long, in widths.
const SHORTEST_LINK: f64 = 1.0;
/// The drawing says where an elbow is if it bends by more than this, degrees …
const DRAWN_BEND: f64 = 25.0;
/// … in this part of the limb's length.
const MIDDLE: [f64; 2] = [0.25, 0.75];

/// How a part bends.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Bend {
    line: Centerline,
    /// The nodes that follow the part's own one, from the joint to the far end, each the child of the one before.
    pub nodes: Vec<BendNode>,
    /// How long its bends should be by its width, as a share of how long they can be by the length of its bones.
    crowding: f64,
    /// Whether it is that of a garment, which has no nodes of its own: it follows those of its parent.
    pub is_worn: bool,
}

/// A node of a part that bends, after its own one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct BendNode {
    /// Its place in the drawing, y up.
    pub position: DVec2,
    /// By how much +Y, which leads along its bone, is turned from the drawing's up, counter-clockwise, radians.
    pub angle: f64,
    /// The joint that it belongs to, from 0.
    pub joint: usize,
    /// The share of the joint's turn that it makes together with the nodes of the joint before it, up to 1.
    pub share: f64,
    /// How far along the centreline it is, drawing units.
    at: f64,
    /// How far before and after it along the centreline the surface follows it in part.
    reach: f64,
}

impl BendNode {
    /// Whether a bone begins here, and not only a share of a joint's turn is made.
    pub(crate) fn is_bone(&self) -> bool {
        self.share >= 1.0
    }
}

impl Bend {
    /// A limb with one joint, an elbow or a knee: in the middle, or where it is drawn bent. Its surface reaches as far as `depth` from
    /// the drawing plane.
    pub(crate) fn limb(line: Centerline, depth: f64) -> Self {
        let length = line.length();
        let joint = line.sharpest(MIDDLE.map(|share| share * length), DRAWN_BEND);
        Self::with_joints(line, &[joint.unwrap_or(length / 2.0)], depth)
    }

    /// A chain with joints at equal distances, as many of them as the centreline has room for.
    pub(crate) fn chain(line: Centerline, joints: usize) -> Self {
        let room = (line.length() / (SHORTEST_LINK * line.width())).floor();
        // A part that bends has a joint at least.
        let bones = (joints + 1).min(room as usize).max(2);
        let link = line.length() / bones as f64;
        let joints: Vec<f64> = (1..bones).map(|joint| joint as f64 * link).collect();
        Self::with_joints(line, &joints, 0.0)
    }

    /// A line with joints at these distances along it, ascending.
    fn with_joints(line: Centerline, joints: &[f64], depth: f64) -> Self {
        let ends: Vec<f64> = [0.0]
            .into_iter()
            .chain(joints.iter().copied())
            .chain([line.length()])
            .collect();
        let angle = |from: f64, to: f64| {
            let way = line.at(to) - line.at(from);
            math::atan2(-way.x, way.y)
        };
        // A turn that is shared by several nodes leaves the limb as wide as it is; a chain turns little at each joint.
        let shares = if joints.len() == 1 { SHARES } else { 1 };
        let mut nodes = Vec::with_capacity(shares * joints.len());
        let mut crowding: f64 = 0.0;
        for (joint, bones) in ends.windows(3).enumerate() {
            let &[before, at, after] = bones else {
                continue;
            };
            let shorter = (at - before).min(after - at);
            let reach = match shares {
                // As far as the next joint.
                1 => shorter,
                _ => {
                    let [wanted, most] = [line.arc(at, ARC, depth), MAX_ARC * shorter];
                    crowding = crowding.max(wanted / most);
                    wanted.min(most) / (shares + 1) as f64
                }
            };
            let [above, below] = [angle(before, at), angle(at, after)];
            let bent = between(above, below);
            for number in 1..=shares {
                let share = number as f64 / shares as f64;
                let at = at + (number as f64 - (shares + 1) as f64 / 2.0) * reach;
                nodes.push(BendNode {
                    position: line.at(at),
                    angle: above + share * bent,
                    joint,
                    share,
                    at,
                    reach,
                });
            }
        }
        Self {
            line,
            nodes,
            crowding,
            is_worn: false,
        }
    }

    /// The bend of a garment over the part: its surface follows the nodes of the part.
    pub(crate) fn worn(&self) -> Self {
        Self {
            is_worn: true,
            ..self.clone()
        }
    }

    /// Whether something that reaches over these points of the drawing, y up, is on a bend.
    pub(crate) fn bends_at(&self, points: impl Iterator<Item = DVec2>) -> bool {
        let along = points.map(|point| self.line.along(point));
        let none = (f64::INFINITY, f64::NEG_INFINITY);
        let (low, high) = along.fold(none, |(low, high), at| (low.min(at), high.max(at)));
        let mut nodes = self.nodes.iter();
        nodes.any(|node| node.at - node.reach < high && low < node.at + node.reach)
    }

    /// Whether something of this size, drawing units, is too small to bend, such as a button.
    pub(crate) fn is_rigid(&self, size: DVec2) -> bool {
        size.max_element() < RIGID * self.width()
    }

    /// Whether its bones are long enough for its bends. If they are much too short, the inside of a bend folds.
    pub(crate) fn fits(&self) -> bool {
        self.crowding <= MOST_CROWDING
    }

    /// The width of the part, drawing units.
    pub(crate) fn width(&self) -> f64 {
        self.line.width()
    }

    /// How many bones the part has: one more than joints. A garment has none of its own but its node.
    pub(crate) fn bones(&self) -> usize {
        if self.is_worn {
            return 1;
        }
        1 + self.nodes.iter().filter(|node| node.is_bone()).count()
    }

    /// How many nodes share the turn of a joint.
    pub(crate) fn shares(&self) -> usize {
        self.nodes.iter().filter(|node| node.joint == 0).count()
    }

    /// The middle of the bend about a joint; `None` if there is no such joint.
    pub(crate) fn middle(&self, joint: usize) -> Option<DVec2> {
        let nodes = self.nodes.iter().filter(|node| node.joint == joint);
        let along = nodes.map(|node| node.at).sum::<f64>() / self.shares() as f64;
        let exists = self.nodes.iter().any(|node| node.joint == joint);
        exists.then(|| self.line.at(along))
    }

    /// The end of the centreline.
    pub(crate) fn tip(&self) -> DVec2 {
        self.line.at(self.line.length())
    }

    /// The node that moves what is at a point of the drawing, y up: 0 is the part's own one, and then those of `nodes`.
    pub(crate) fn node_at(&self, point: DVec2) -> usize {
        let at = self.line.along(point);
        self.nodes.iter().filter(|node| node.at <= at).count()
    }

    /// The names of the nodes of a part, in the order of `nodes`: `Arm.2` is the second bone of `Arm`, and `Arm.2a`, `Arm.2b` share
    /// the turn of its joint.
    pub(crate) fn names<'a>(&'a self, part: &'a str) -> impl Iterator<Item = String> + 'a {
        let mut helpers = 0;
        self.nodes.iter().map(move |node| {
            let bone = node.joint + 2;
            if node.is_bone() {
                helpers = 0;
                return format!("{part}.{bone}");
            }
            helpers += 1;
            let letter = char::from(b'a' + (helpers - 1) as u8);
            format!("{part}.{bone}{letter}")
        })
    }
}

/// The shortest turn from one angle to another, radians.
fn between(from: f64, to: f64) -> f64 {
    let turn = (to - from).rem_euclid(std::f64::consts::TAU);
    if turn > std::f64::consts::PI {
        turn - std::f64::consts::TAU
    } else {
        turn
    }
}
