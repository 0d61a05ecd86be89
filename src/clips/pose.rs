//! A pose of a body: how its joints turn, and where its feet are. Legs reach their feet by two-bone inverse kinematics.

use crate::math;
use glam::{DMat3, DQuat, DVec3};
use typed_index_collections::{TiSlice, TiVec, ti_vec};

use super::body::{Body, Leg};
use crate::mocap::{self, Channel, JointId, Skeleton, Transform};

/// How far a leg may stretch, as a share of its length: a knee that is quite straight snaps.
pub(super) const MAX_REACH: f64 = 0.985;

/// A rotation about the axis to the left, degrees; positive tips what points up to the front.
pub(super) fn tip(degrees: f64) -> DQuat {
    math::rotation_x(degrees.to_radians())
}

/// A rotation about the vertical axis, degrees; positive turns the front to the left.
pub(super) fn turn(degrees: f64) -> DQuat {
    math::rotation_y(degrees.to_radians())
}

/// A rotation about the axis to the front, degrees; positive tips what points up to the right.
pub(super) fn lean(degrees: f64) -> DQuat {
    math::rotation_z(degrees.to_radians())
}

/// How a joint is turned.
#[derive(Debug, Clone, Copy)]
enum Turn {
    /// In its parent's frame.
    Inner(DQuat),
    /// In the world.
    World(DQuat),
}

/// Where a foot is.
#[derive(Debug, Clone, Copy)]
pub(super) struct Foot {
    /// The ankle, in the world.
    pub(super) ankle: DVec3,
    /// The rotation of the foot in the world.
    pub(super) rotation: DQuat,
    /// The rotation of the toes in the world.
    pub(super) toes: DQuat,
}

impl Foot {
    /// A foot flat on the ground with its ankle at a point.
    pub(super) fn flat(ankle: DVec3) -> Self {
        Self {
            ankle,
            rotation: DQuat::IDENTITY,
            toes: DQuat::IDENTITY,
        }
    }
}

/// A pose.
#[derive(Debug, Clone)]
pub(super) struct Pose {
    /// The position of the hips.
    pub(super) hips: DVec3,
    turns: TiVec<JointId, Turn>,
    /// Per leg its foot; a leg without one turns like any joint.
    pub(super) feet: Vec<Option<Foot>>,
}

impl Pose {
    /// The body as it stands at rest.
    pub(super) fn rest(body: &Body) -> Self {
        Self {
            hips: body.skeleton.joints[JointId::default()].offset,
            turns: ti_vec![Turn::Inner(DQuat::IDENTITY); body.skeleton.joints.len()],
            feet: body
                .legs
                .iter()
                .map(|leg| Some(Foot::flat(leg.ankle)))
                .collect(),
        }
    }

    /// Turns a joint in its parent's frame.
    pub(super) fn turn_inner(&mut self, joint: JointId, rotation: DQuat) {
        self.turns[joint] = Turn::Inner(rotation);
    }

    /// Turns a joint in the world.
    pub(super) fn turn_world(&mut self, joint: JointId, rotation: DQuat) {
        self.turns[joint] = Turn::World(rotation);
    }

    /// The world transforms of all joints.
    pub(super) fn transforms(&self, body: &Body) -> mocap::Pose {
        let mut placed = mocap::Pose::with_capacity(self.turns.len());
        let mut turns = self.turns.clone();
        for (id, joint) in body.skeleton.joints.iter_enumerated() {
            let parent = joint.parent.map(|parent| placed[parent]);
            let position = match parent {
                Some(parent) => parent.position + parent.rotation * joint.offset,
                None => self.hips,
            };
            let leg = body.legs.iter().position(|leg| leg.joints[0] == id);
            if let Some((leg, foot)) = leg.and_then(|leg| Some((&body.legs[leg], self.feet[leg]?)))
            {
                bend(body, leg, position, &foot, &mut turns);
            }
            let above = parent.map_or(DQuat::IDENTITY, |parent| parent.rotation);
            let rotation = match turns[id] {
                Turn::Inner(inner) => above * inner,
                Turn::World(world) => world,
            };
            placed.push(Transform { rotation, position });
        }
        placed
    }

    /// How far the leg that stretches most does so, as a share of the length of its bones; legs that are raised do not count.
    pub(super) fn reach(&self, body: &Body) -> f64 {
        /// The height of a raised foot, as a share of the length of its leg.
        const RAISED: f64 = 0.3;

        let placed = self.transforms(body);
        let legs = body.legs.iter().zip(&self.feet);
        let reach = legs.filter_map(|(leg, foot)| {
            let foot = foot.filter(|foot| foot.ankle.y - leg.ankle.y < RAISED * leg.length())?;
            let hip = placed[leg.joints[0]].position;
            Some(hip.distance(foot.ankle) / leg.length())
        });
        reach.fold(0.0, f64::max)
    }
}

/// Turns the joints of a leg so that its ankle is where the foot is, as far as it reaches.
fn bend(body: &Body, leg: &Leg, hip: DVec3, foot: &Foot, turns: &mut TiSlice<JointId, Turn>) {
    let [thigh, shin] = leg.bones;
    let way = foot.ankle - hip;
    let down = way.normalize_or(DVec3::NEG_Y);
    let nearest = (thigh - shin).abs() + 1e-6;
    let distance = way.length().clamp(nearest, leg.length() * (1.0 - 1e-9));
    let to_knee = leg.knee.reject_from(down).normalize_or(DVec3::Z);
    let cos = (thigh * thigh + distance * distance - shin * shin) / (2.0 * thigh * distance);
    let cos = cos.clamp(-1.0, 1.0);
    let knee = hip + thigh * (down * cos + to_knee * (1.0 - cos * cos).sqrt());
    let hinge = to_knee.cross(down);
    // The same hinge at rest gives the twist of both bones.
    let joints = &body.skeleton.joints;
    let [upper, lower, end] = leg.joints;
    let at_rest = [joints[lower].offset, joints[end].offset];
    let rest_line = at_rest[0] + at_rest[1];
    let rest_knee = leg.knee.reject_from(rest_line).normalize_or(DVec3::Z);
    let rest_hinge = rest_knee.cross(rest_line).normalize_or(DVec3::X);
    let now = [knee - hip, hip + down * distance - knee];
    for (joint, (rest, now)) in [upper, lower].into_iter().zip(at_rest.into_iter().zip(now)) {
        let rotation = frame(now, hinge) * frame(rest, rest_hinge).transpose();
        turns[joint] = Turn::World(DQuat::from_mat3(&rotation).normalize());
    }
    turns[end] = Turn::World(foot.rotation);
    if let Some(toe) = leg.toe {
        turns[toe] = Turn::World(foot.toes);
    }
}

/// Axes along a bone and about its hinge.
fn frame(bone: DVec3, hinge: DVec3) -> DMat3 {
    let along = bone.normalize_or(DVec3::NEG_Y);
    let about = hinge.reject_from(along).normalize_or(DVec3::X);
    DMat3::from_cols(along, about, along.cross(about))
}

/// The numbers of frames with these poses, one per channel. Angles go on from frame to frame without jumps of a full turn.
pub(super) fn channel_values(body: &Body, poses: &[Pose]) -> Vec<f64> {
    let skeleton: &Skeleton = &body.skeleton;
    let mut values: Vec<f64> = Vec::new();
    let width = skeleton.channel_count();
    for pose in poses {
        let placed = pose.transforms(body);
        for (id, joint) in skeleton.joints.iter_enumerated() {
            let above = joint
                .parent
                .map_or(DQuat::IDENTITY, |parent| placed[parent].rotation);
            let inner = above.inverse() * placed[id].rotation;
            let angles = math::euler_zyx(inner).map(f64::to_degrees);
            for channel in &joint.channels {
                let number = match channel {
                    Channel::Position(axis) => placed[id].position[axis.index()],
                    Channel::Rotation(axis) => {
                        let angle = angles[axis.index()];
                        let before = values.len().checked_sub(width).map_or(0.0, |at| values[at]);
                        angle + ((before - angle) / 360.0).round() * 360.0
                    }
                };
                values.push(number);
            }
        }
    }
    values
}

#[cfg(test)]
mod tests {
    use super::super::Legs;
    use super::*;
    use crate::mocap::Clip;
    use std::sync::Arc;

    #[test]
    fn bodies_at_rest_have_the_joints_where_they_are_planned() {
        for legs in Legs::ALL {
            let body = Body::on(legs);
            let placed = Pose::rest(&body).transforms(&body);
            for (rest, placed) in body.skeleton.offset_pose().iter().zip(&placed) {
                // A leg that is quite straight is bent by a hair.
                assert!(rest.position.distance(placed.position) < 0.01);
                assert!(rest.rotation.angle_between(placed.rotation) < 0.001);
            }
        }
    }

    #[test]
    fn channels_are_the_pose() {
        let body = Body::on(Legs::Two);
        let mut pose = Pose::rest(&body);
        pose.turn_world(1.into(), turn(30.0) * tip(50.0) * lean(-20.0));
        pose.turn_inner(4.into(), tip(-70.0));
        pose.feet[0] = Some(Foot::flat(DVec3::new(12.0, 30.0, 25.0)));
        let placed = pose.transforms(&body);
        let values = channel_values(&body, &[pose]);
        let clip = Clip::new(Arc::new(body.skeleton.clone()), 1.0, values);
        for (now, placed) in clip.pose(0).iter().zip(&placed) {
            assert!(now.position.distance(placed.position) < 1e-6);
        }
        let ankle = placed[body.legs[0].joints[2]].position;
        assert!(ankle.distance(DVec3::new(12.0, 30.0, 25.0)) < 1e-6);
    }
}
