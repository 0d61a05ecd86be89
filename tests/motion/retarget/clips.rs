//! The motions of the project, prepared, and written in other ways.

use std::path::Path;
use std::sync::Arc;

use glam::{DQuat, DVec3, EulerRot};
use okoshi::internals::mocap::bvh;
use okoshi::internals::mocap::{Axis, Channel, Clip, JointId, Pose, Skeleton, Transform};
use okoshi::internals::prepare::{Options, PreparedClip, prepare};
use typed_index_collections::{TiSlice, TiVec, ti_vec};

pub(crate) const FILES: [&str; 6] = [
    "examples/motion/boxing.bvh",
    "examples/motion/kick.bvh",
    "examples/motion/walk.bvh",
    "examples/motion/zombie-walk.bvh",
    "tests/motion/data/mocapbank.bvh",
    "tests/motion/data/mixed_orders.bvh",
];

pub(crate) fn clip(file: &str) -> PreparedClip {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(file);
    let bytes = std::fs::read(path).unwrap_or_else(|error| panic!("{file}: {error}"));
    let reading = bvh::read_bytes(&bytes).unwrap_or_else(|error| panic!("{file}: {error}"));
    prepare(reading.clip, &Options::default()).expect("24 frames a second")
}

/// The order of a joint's rotation channels.
pub(crate) const ORDERS: [(EulerRot, [Axis; 3]); 6] = [
    (EulerRot::XYZ, [Axis::X, Axis::Y, Axis::Z]),
    (EulerRot::XZY, [Axis::X, Axis::Z, Axis::Y]),
    (EulerRot::YXZ, [Axis::Y, Axis::X, Axis::Z]),
    (EulerRot::YZX, [Axis::Y, Axis::Z, Axis::X]),
    (EulerRot::ZXY, [Axis::Z, Axis::X, Axis::Y]),
    (EulerRot::ZYX, [Axis::Z, Axis::Y, Axis::X]),
];

/// A clip as rotations and positions, to be written again.
pub(crate) struct Moving {
    pub(crate) skeleton: Skeleton,
    frame_time: f64,
    /// Per frame and joint.
    locals: Vec<Pose>,
}

impl Moving {
    pub(crate) fn of(clip: &Clip) -> Self {
        let frames = (0..clip.frames).map(|frame| {
            let mut numbers = clip.row(frame);
            let joints = clip.skeleton.joints.iter().map(|joint| {
                let (own, rest) = numbers.split_at(joint.channels.len());
                numbers = rest;
                Clip::local(joint, own)
            });
            joints.collect()
        });
        Self {
            skeleton: Skeleton::clone(&clip.skeleton),
            frame_time: clip.frame_time,
            locals: frames.collect(),
        }
    }

    /// Another unit.
    pub(crate) fn scaled(mut self, by: f64) -> Self {
        for joint in &mut self.skeleton.joints {
            joint.offset *= by;
            joint.ends.iter_mut().for_each(|end| *end *= by);
        }
        let all = self.locals.iter_mut().flatten();
        all.for_each(|local| local.position *= by);
        self
    }

    /// The world rotated about the roots; the skeleton's offsets stay.
    pub(crate) fn turned(mut self, by: DQuat) -> Self {
        let joints = self.skeleton.joints.iter();
        let roots: Vec<bool> = joints.map(|joint| joint.parent.is_none()).collect();
        for frame in &mut self.locals {
            for (local, _) in frame
                .iter_mut()
                .zip(&roots)
                .filter(|(_, is_root)| **is_root)
            {
                local.rotation = by * local.rotation;
                local.position = by * local.position;
            }
        }
        self
    }

    /// Each joint's frame rotated: points in it get the inverse rotation.
    pub(crate) fn reoriented(mut self, by: &TiSlice<JointId, DQuat>) -> Self {
        let above: TiVec<JointId, DQuat> = self
            .skeleton
            .joints
            .iter()
            .map(|joint| {
                joint
                    .parent
                    .map_or(DQuat::IDENTITY, |parent| by[parent].inverse())
            })
            .collect();
        for (id, joint) in self.skeleton.joints.iter_mut_enumerated() {
            joint.offset = above[id] * joint.offset;
            joint
                .ends
                .iter_mut()
                .for_each(|end| *end = by[id].inverse() * *end);
        }
        for frame in &mut self.locals {
            for (id, local) in frame.iter_mut_enumerated() {
                local.rotation = above[id] * local.rotation * by[id];
                local.position = above[id] * local.position;
            }
        }
        self
    }

    /// The joints' frames as some programs have them: up is along each bone that goes on to a single joint or end, whatever its place in
    /// the body, so that the offsets of legs point up like those of the trunk.
    pub(crate) fn along_bones(self, up: DVec3) -> Self {
        let joints = &self.skeleton.joints;
        let mut ways: TiVec<JointId, Vec<DVec3>> =
            joints.iter().map(|joint| joint.ends.clone()).collect();
        for joint in joints {
            if let Some(parent) = joint.parent {
                ways[parent].push(joint.offset);
            }
        }
        let turn = |ways: &Vec<DVec3>| match ways[..] {
            [way] if way != DVec3::ZERO => DQuat::from_rotation_arc(up, way.normalize()),
            _ => DQuat::IDENTITY,
        };
        let turns: TiVec<JointId, DQuat> = ways.iter().map(turn).collect();
        self.reoriented(&turns)
    }

    /// World and skeleton rotated alike, as from a program with other axes.
    pub(crate) fn in_other_axes(self, by: DQuat) -> Self {
        let back = ti_vec![by.inverse(); self.skeleton.joints.len()];
        let mut out = self.turned(by).reoriented(&back);
        for joint in &mut out.skeleton.joints {
            if joint.parent.is_none() {
                joint.offset = by * joint.offset;
            }
        }
        out
    }

    /// The clip with its rotations in the order that a number stands for, which increases from joint to joint.
    pub(crate) fn written(mut self, order: usize) -> Clip {
        let order_of = |joint: usize| ORDERS[(order + joint) % ORDERS.len()];
        for (index, joint) in self.skeleton.joints.iter_mut().enumerate() {
            let places = [Axis::Z, Axis::X, Axis::Y].map(Channel::Position);
            let turns = order_of(index).1.map(Channel::Rotation);
            joint.channels = places.into_iter().chain(turns).collect();
        }
        let mut values = Vec::new();
        for local in self
            .locals
            .iter()
            .flat_map(|frame| frame.iter().enumerate())
        {
            let (index, Transform { rotation, position }) = local;
            let DVec3 { x, y, z } = *position;
            let (a, b, c) = rotation.normalize().to_euler(order_of(index).0);
            values.extend([z, x, y]);
            values.extend([a, b, c].map(f64::to_degrees));
        }
        Clip::new(Arc::new(self.skeleton), self.frame_time, values)
    }
}
