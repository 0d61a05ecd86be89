//! The rotations of a rig's parts.

use glam::{DQuat, DVec3};

use super::axes::Axes;
use super::rest_pose::RestPose;
use super::{PoseBuffer, Rig};
use crate::motion::matching::{Drive, Follow};
use crate::motion::skeleton::{Clip, Transform};

/// The rotations of parts in the drawing's axes, frame by frame.
pub(super) struct Rotations {
    /// Per part; `None` if it turns with its parent.
    own: Vec<Option<Vec<DQuat>>>,
    /// Per part the nearest ancestor (or itself) that turns on its own, and the part's rotation in that ancestor's frame.
    carrier: Vec<(Option<usize>, DQuat)>,
}

impl Rotations {
    /// Whether a part turns on its own, and not only with its parent.
    pub(super) fn is_own(&self, part: usize) -> bool {
        self.own[part].is_some()
    }

    /// The rotations of all parts that turn on their own.
    pub(super) fn all(&self) -> impl Iterator<Item = &[DQuat]> {
        self.own.iter().flatten().map(Vec::as_slice)
    }

    /// Lets a part turn on its own, and what hangs on it with it.
    pub(super) fn set(&mut self, rig: &Rig, order: &[usize], part: usize, turns: Vec<DQuat>) {
        self.own[part] = Some(turns);
        self.carry(rig, order);
    }

    fn carry(&mut self, rig: &Rig, order: &[usize]) {
        for part in order {
            let drawn = rig.parts[*part].node.rotation;
            self.carrier[*part] = match (self.is_own(*part), rig.parts[*part].parent) {
                (true, _) => (Some(*part), DQuat::IDENTITY),
                (false, None) => (None, drawn),
                (false, Some(parent)) => {
                    let (carrier, inner) = self.carrier[parent];
                    let above = rig.parts[parent].node.rotation;
                    (carrier, inner * above.inverse() * drawn)
                }
            };
        }
    }

    /// The rotation of any part in a frame.
    pub(super) fn at(&self, part: usize, frame: usize) -> DQuat {
        let (carrier, inner) = self.carrier[part];
        let outer = carrier.and_then(|carrier| self.own[carrier].as_ref());
        outer.map_or(inner, |rotations| rotations[frame] * inner)
    }
}

pub(super) fn rotations(
    clip: &Clip,
    rig: &Rig,
    axes: &Axes,
    rest: &RestPose,
    poses: &mut PoseBuffer<'_>,
    order: &[usize],
) -> Rotations {
    let count = rig.parts.len();
    let solvers: Vec<(usize, PartRotation)> = order
        .iter()
        .filter_map(|part| Some((*part, PartRotation::new(clip, rig, *part, axes, rest)?)))
        .collect();
    let mut own: Vec<Option<Vec<DQuat>>> = vec![None; count];
    for (part, _) in &solvers {
        own[*part] = Some(Vec::with_capacity(clip.frames()));
    }
    for frame in 0..clip.frames() {
        let pose = poses.at(frame);
        for (part, solver) in &solvers {
            if let Some(rotations) = &mut own[*part] {
                rotations.push(solver.at(clip, pose, rest));
            }
        }
    }
    let mut rotations = Rotations {
        own,
        carrier: vec![(None, DQuat::IDENTITY); count],
    };
    rotations.carry(rig, order);
    rotations
}

/// Computes the rotations of one part.
struct PartRotation {
    drive: Drive,
    /// From the clip's world to the drawing's axes: C₀ᵀ.
    to_drawing: DQuat,
    /// The rotation that the joint's change is applied to: Cᵣ · A · D for limbs, Cᵣ · D for bodies.
    drawn: DQuat,
    /// The direction of the chain at rest, if the part follows one, in the clip's world.
    direction: Option<DVec3>,
    /// The viewer's axis in the clip's world.
    viewer: DVec3,
}

impl PartRotation {
    fn new(clip: &Clip, rig: &Rig, part: usize, axes: &Axes, rest: &RestPose) -> Option<Self> {
        let part = &rig.parts[part];
        let drive = part.drive?;
        let direction = drive.direction(&clip.skeleton, &rest.pose);
        let axis = (part.tip - part.joint).try_normalize();
        let align = match (drive.follow, axis, direction) {
            (Follow::Direction, Some(axis), Some(direction)) => {
                arc(axis, rest.axes.inverse() * direction, DVec3::Z)
            }
            _ => DQuat::IDENTITY,
        };
        Some(Self {
            drive,
            to_drawing: axes.first.inverse(),
            drawn: rest.axes * align * part.node.rotation,
            direction,
            viewer: axes.first * DVec3::Z,
        })
    }

    /// G(k) · D with G(k) = C₀ᵀ · S(k) · Rⱼ(k) · Rⱼ(r)ᵀ · Cᵣ · A; A is the identity for parts that keep the drawn pose, S for those
    /// that follow no chain.
    fn at(&self, clip: &Clip, pose: &[Transform], rest: &RestPose) -> DQuat {
        let joint = self.drive.joint;
        let change = pose[joint].rotation * rest.pose[joint].rotation.inverse();
        let now = self.drive.direction(&clip.skeleton, pose);
        let straighten = match (self.direction, now) {
            (Some(rest), Some(now)) => arc(change * rest, now, self.viewer),
            _ => DQuat::IDENTITY,
        };
        (self.to_drawing * straighten * change * self.drawn).normalize()
    }
}

/// The shortest rotation from one direction to another, both unit vectors; a half turn goes about `about`.
pub(super) fn arc(from: DVec3, to: DVec3, about: DVec3) -> DQuat {
    /// Below this cosine the axis of the shortest rotation is undefined.
    const HALF_TURN: f64 = -1.0 + 1e-12;

    if from.dot(to) > HALF_TURN {
        // Not `from_rotation_arc`, which switches to a half turn some hundredths of a degree too early.
        let cross = from.cross(to);
        return DQuat::from_xyzw(cross.x, cross.y, cross.z, 1.0 + from.dot(to)).normalize();
    }
    let axis = about.reject_from(from).try_normalize();
    DQuat::from_axis_angle(
        axis.unwrap_or_else(|| from.any_orthonormal_vector()),
        std::f64::consts::PI,
    )
}
