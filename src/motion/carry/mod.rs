//! A clip carried over to a figure: how its parts turn, and where it goes (motion.md, Carrying it over).
//!
//! Everything here is in the drawing's axes: x to the drawing's right, y up, z towards the viewer, in the figure's unit. The clip's
//! world is taken into them by the body axes of its first frame, so the figure sets out the way it is drawn.

mod axes;
mod ground;
mod rest;
mod turn;

use glam::{DQuat, DVec3};

use super::labels::{Facing, Tip};
use super::matching::Follow;
use super::skeleton::{Clip, Placed};

pub use axes::Landmarks;
pub use rest::Rest;

/// A figure as motion moves it: its nodes at rest, and what drives them.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Puppet {
    /// The parts. Any order; parents are indices.
    pub parts: Vec<PuppetPart>,
    /// The way that it faces.
    pub facing: Facing,
}

/// A part of a puppet.
#[derive(Debug, Clone, PartialEq)]
pub struct PuppetPart {
    /// The part it hangs on. One part of a puppet hangs on nothing: its travel is the figure's.
    pub parent: Option<usize>,
    /// Whether its node hangs on the model's root, and not on its parent's node: parts that touch without a word about it.
    pub is_rooted: bool,
    /// Its node at rest.
    pub node: Placed,
    /// Where it turns. Rooted nodes stand elsewhere, in the middle of their part.
    pub joint: DVec3,
    /// Its far end.
    pub tip: DVec3,
    /// The points of its lower edge that touch the ground, if it is what a leg stands on; empty otherwise.
    pub sole: Vec<DVec3>,
    /// What drives it.
    pub drive: Option<Drive>,
}

/// What drives a part.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Drive {
    /// The joint of the skeleton.
    pub joint: usize,
    /// The far end of the chain of bones that begins at the joint.
    pub tip: Option<Tip>,
    /// What of it the part takes over.
    pub follow: Follow,
    /// Whether the part is a leg's.
    pub is_leg: bool,
}

/// A motion of a puppet, frame by frame.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Carried {
    /// Per part how its node is turned in its parent's frame, rooted nodes in the drawing's axes; `None` for nodes that keep their
    /// place there.
    pub turns: Vec<Option<Vec<DQuat>>>,
    /// Per part where its node stands; for rooted nodes only.
    pub moves: Vec<Option<Vec<DVec3>>>,
    /// Per frame whether a foot stands on the ground.
    pub grounded: Vec<bool>,
    /// The pose that the clip's rotations were measured from.
    pub rest: Rest,
}

/// Carries a clip over. Every index in `puppet` and `landmarks` must exist. Nothing moves where nothing is driven; parts whose
/// parents form a ring stay where they are.
pub fn carry(clip: &Clip, puppet: &Puppet, landmarks: &Landmarks) -> Carried {
    let count = puppet.parts.len();
    let order = order(puppet);
    if puppet.parts.iter().all(|part| part.drive.is_none()) || order.is_empty() {
        return Carried {
            turns: vec![None; count],
            moves: vec![None; count],
            grounded: vec![false; clip.frames()],
            rest: Rest::default(),
        };
    }
    let mut poses = Poses::new(clip);
    let axes = axes::Axes::of(clip, landmarks, puppet.facing);
    let rest = rest::choose(clip, puppet, landmarks, &axes, &mut poses);
    let turns = turn::turns(clip, puppet, &axes, &rest, &mut poses, &order);
    let travel = ground::travel(clip, puppet, landmarks, &axes, &turns, &order, &mut poses);
    let frames = 0..clip.frames();
    let mut local = vec![None; count];
    for part in &order {
        let own = &puppet.parts[*part];
        let turned: Vec<DQuat> = match (own.is_rooted, own.parent) {
            (true, _) | (false, None) => {
                frames.clone().map(|frame| turns.at(*part, frame)).collect()
            }
            (false, Some(parent)) if turns.is_own(*part) => {
                let inner = |frame| turns.at(parent, frame).inverse() * turns.at(*part, frame);
                frames
                    .clone()
                    .map(|frame| inner(frame).normalize())
                    .collect()
            }
            _ => continue,
        };
        local[*part] = Some(continuous(turned));
    }
    Carried {
        turns: local,
        moves: travel.places,
        grounded: travel.grounded,
        rest: rest.rest,
    }
}

/// From a clip's world to the axes of a drawing whose figure faces the viewer: y up, and z the front of the body in the first
/// frame.
pub fn to_drawing(clip: &Clip, landmarks: &Landmarks) -> DQuat {
    axes::Axes::of(clip, landmarks, Facing::Viewer)
        .first
        .inverse()
}

/// The same rotations, each written with the sign that lies nearer to the one before.
pub(crate) fn continuous(mut turns: Vec<DQuat>) -> Vec<DQuat> {
    for at in 1..turns.len() {
        if turns[at].dot(turns[at - 1]) < 0.0 {
            turns[at] = -turns[at];
        }
    }
    turns
}

/// The parts, parents before children; those in rings are missing.
fn order(puppet: &Puppet) -> Vec<usize> {
    let count = puppet.parts.len();
    let mut children = vec![Vec::new(); count];
    let mut order: Vec<usize> = Vec::with_capacity(count);
    for (index, part) in puppet.parts.iter().enumerate() {
        match part.parent {
            Some(parent) => children[parent].push(index),
            None => order.push(index),
        }
    }
    let mut next = 0;
    while let Some(part) = order.get(next) {
        order.extend_from_slice(&children[*part]);
        next += 1;
    }
    order
}

/// The poses of a clip, made one at a time.
struct Poses<'a> {
    clip: &'a Clip,
    frame: Option<usize>,
    pose: Vec<Placed>,
}

impl<'a> Poses<'a> {
    fn new(clip: &'a Clip) -> Self {
        Self {
            clip,
            frame: None,
            pose: Vec::new(),
        }
    }

    fn at(&mut self, frame: usize) -> &[Placed] {
        if self.frame != Some(frame) {
            self.clip.pose_into(frame, &mut self.pose);
            self.frame = Some(frame);
        }
        &self.pose
    }
}
