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

use glam::DVec2;

pub(crate) use centerline::Centerline;
pub(crate) use skinned::{BentSurface, Bones};

/// The length of a bend about its joint, in widths: with less, the inside folds at 90°.
const ARC: f64 = 1.5;
/// The nodes that share the turn of a joint.
const SHARES: usize = 3;
/// The longest bend about a joint, as a share of the shorter bone beside it.
const MAX_ARC: f64 = 1.8;
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
    /// Half the length over which the surface passes from the node before to this one.
    blend: f64,
}

impl BendNode {
    /// Whether a bone begins here, and not only a share of a joint's turn is made.
    pub(crate) fn is_bone(&self) -> bool {
        self.share >= 1.0
    }
}

impl Bend {
    /// A limb with one joint, an elbow or a knee: in the middle, or where it is drawn bent.
    pub(crate) fn limb(line: Centerline) -> Self {
        let length = line.length();
        let joint = line.sharpest(MIDDLE.map(|share| share * length), DRAWN_BEND);
        Self::with_joints(line, &[joint.unwrap_or(length / 2.0)])
    }

    /// A chain with joints at equal distances, as many of them as the centreline has room for.
    pub(crate) fn chain(line: Centerline, joints: usize) -> Self {
        let room = (line.length() / (SHORTEST_LINK * line.width())).floor();
        // A part that bends has a joint at least.
        let bones = (joints + 1).min(room as usize).max(2);
        let link = line.length() / bones as f64;
        let joints: Vec<f64> = (1..bones).map(|joint| joint as f64 * link).collect();
        Self::with_joints(line, &joints)
    }

    /// A line with joints at these distances along it, ascending.
    fn with_joints(line: Centerline, joints: &[f64]) -> Self {
        let ends: Vec<f64> = [0.0]
            .into_iter()
            .chain(joints.iter().copied())
            .chain([line.length()])
            .collect();
        let angle = |from: f64, to: f64| {
            let way = line.at(to) - line.at(from);
            (-way.x).atan2(way.y)
        };
        // A turn that is shared by several nodes leaves the limb as wide as it is; a chain turns little at each joint.
        let shares = if joints.len() == 1 { SHARES } else { 1 };
        let mut nodes = Vec::with_capacity(shares * joints.len());
        for (joint, bones) in ends.windows(3).enumerate() {
            let &[before, at, after] = bones else {
                continue;
            };
            let shorter = (at - before).min(after - at);
            let arc = match shares {
                1 => shorter,
                _ => (ARC * line.width()).min(MAX_ARC * shorter),
            };
            let blend = arc / (2 * shares) as f64;
            let [above, below] = [angle(before, at), angle(at, after)];
            let bent = between(above, below);
            for number in 1..=shares {
                let share = number as f64 / shares as f64;
                let at = at + (2 * number) as f64 * blend - (shares + 1) as f64 * blend;
                nodes.push(BendNode {
                    position: line.at(at),
                    angle: above + share * bent,
                    joint,
                    share,
                    at,
                    blend,
                });
            }
        }
        Self { line, nodes }
    }

    /// The width of the part, drawing units.
    pub(crate) fn width(&self) -> f64 {
        self.line.width()
    }

    /// How many bones the part has: one more than joints.
    pub(crate) fn bones(&self) -> usize {
        1 + self.nodes.iter().filter(|node| node.is_bone()).count()
    }

    /// How many nodes share the turn of a joint.
    pub(crate) fn shares(&self) -> usize {
        self.nodes.iter().filter(|node| node.joint == 0).count()
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
