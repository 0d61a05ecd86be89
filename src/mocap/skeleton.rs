//! Skeletons, and clips of their motion: what a BVH file holds.

use std::sync::Arc;

use glam::{DQuat, DVec3};
use typed_index_collections::{TiVec, ti_vec};

use crate::index::index_type;
use crate::math;

index_type!(
    /// Refers to a joint of a skeleton.
    pub JointId
);

impl Default for JointId {
    /// The first joint of a skeleton, which is a root.
    fn default() -> Self {
        Self::from(0)
    }
}

/// A hierarchy of joints. Parents precede their children (a parent that does not is ignored); there may be several roots.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Skeleton {
    /// The joints, in the order of the file.
    pub joints: TiVec<JointId, Joint>,
}

/// A joint, with its channels.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Joint {
    /// Its name, which need not be unique.
    pub name: String,
    /// Its parent.
    pub parent: Option<JointId>,
    /// Its position in its parent's frame, unless position channels replace it.
    pub offset: DVec3,
    /// Its channels, in the order of their numbers in a frame.
    pub channels: Vec<Channel>,
    /// End sites: the ends of bones that lead to no joint, in its frame.
    pub ends: Vec<DVec3>,
}

/// The meaning of a number in a frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Channel {
    /// A coordinate of the joint in its parent's frame, which replaces that of the offset.
    Position(Axis),
    /// A rotation, degrees. Rotations apply in the order of the channels, each about an axis that those before it have rotated
    /// (intrinsic rotations).
    Rotation(Axis),
}

/// An axis of a joint's frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Axis {
    /// The first one.
    X,
    /// The second one.
    Y,
    /// The third one.
    Z,
}

impl Axis {
    /// Its index: 0, 1, 2.
    pub fn index(self) -> usize {
        self as usize
    }
}

impl Skeleton {
    /// The number of channels: how many numbers a frame has.
    pub fn channel_count(&self) -> usize {
        self.joints.iter().map(|joint| joint.channels.len()).sum()
    }

    /// Per joint its children, in order.
    pub fn children(&self) -> TiVec<JointId, Vec<JointId>> {
        let mut children: TiVec<JointId, _> = ti_vec![Vec::new(); self.joints.len()];
        for (id, joint) in self.joints.iter_enumerated() {
            if let Some(parent) = joint.parent {
                children[parent].push(id);
            }
        }
        children
    }

    /// Per joint whether it is a descendant of `joint`.
    pub fn descendants(&self, joint: JointId) -> TiVec<JointId, bool> {
        let mut descendants: TiVec<JointId, bool> = TiVec::with_capacity(self.joints.len());
        for other in &self.joints {
            // Parents precede their children.
            descendants.push(
                other
                    .parent
                    .is_some_and(|parent| parent == joint || descendants[parent]),
            );
        }
        descendants
    }

    /// The world transforms of the joints when all channels are 0 and all positions are the offsets.
    pub fn offset_pose(&self) -> Pose {
        let mut pose = Pose::with_capacity(self.joints.len());
        for joint in &self.joints {
            let parent = joint.parent.and_then(|parent| pose.get(parent));
            let above = parent.map_or(DVec3::ZERO, |parent| parent.position);
            pose.push(Transform {
                rotation: DQuat::IDENTITY,
                position: above + joint.offset,
            });
        }
        pose
    }
}

/// A rotation and a translation: `rotation · p + position` takes a point from the local frame to the outer one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Transform {
    /// The rotation.
    pub rotation: DQuat,
    /// The position, in the file's unit.
    pub position: DVec3,
}

impl Transform {
    /// A point of the local frame in the outer one.
    pub(crate) fn apply(self, point: DVec3) -> DVec3 {
        self.rotation * point + self.position
    }

    /// A point of the outer frame in the local one.
    pub(crate) fn to_local(self, point: DVec3) -> DVec3 {
        self.rotation.inverse() * (point - self.position)
    }
}

/// The extent of points along y; 0 without points.
pub(crate) fn height(points: impl Iterator<Item = DVec3>) -> f64 {
    let none = (f64::INFINITY, f64::NEG_INFINITY);
    let (low, high) = points.fold(none, |(low, high), point| {
        (low.min(point.y), high.max(point.y))
    });
    (high - low).max(0.0)
}

/// The world transforms of the joints in a pose.
pub type Pose = TiVec<JointId, Transform>;

/// A motion: frames of a skeleton at a constant rate.
#[derive(Debug, Clone, PartialEq)]
pub struct Clip {
    /// The skeleton that moves.
    pub skeleton: Arc<Skeleton>,
    /// Seconds from one frame to the next.
    pub frame_time: f64,
    /// All frames, one after the other, each with a number per channel in the order of the file.
    values: Vec<f64>,
    /// The number of frames.
    pub frames: usize,
}

impl Clip {
    /// A clip of complete frames; an incomplete last frame is dropped. A skeleton without channels has no frames.
    pub fn new(skeleton: Arc<Skeleton>, frame_time: f64, mut values: Vec<f64>) -> Self {
        let frames = values
            .len()
            .checked_div(skeleton.channel_count())
            .unwrap_or(0);
        values.truncate(frames * skeleton.channel_count());
        Self {
            skeleton,
            frame_time,
            values,
            frames,
        }
    }

    /// The numbers of a frame, one per channel.
    pub fn row(&self, frame: usize) -> &[f64] {
        let width = self.skeleton.channel_count();
        &self.values[frame * width..][..width]
    }

    /// The numbers of all frames, frame by frame.
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// The clip that consists of these frames of this one, in this order.
    #[must_use]
    pub fn select_frames(&self, frames: impl IntoIterator<Item = usize>) -> Self {
        let rows = frames.into_iter().flat_map(|frame| self.row(frame));
        let values = rows.copied().collect();
        Self::new(Arc::clone(&self.skeleton), self.frame_time, values)
    }

    /// The clip whose roots are moved in each frame; `None` if a root has no channels for its whole position.
    pub(crate) fn moved(mut self, ways: &[DVec3]) -> Option<Self> {
        let mut start = 0;
        let mut columns = Vec::new();
        for joint in &self.skeleton.joints {
            let own = joint.channels.iter().zip(start..);
            start += joint.channels.len();
            if joint.parent.is_none() {
                let position = |axis: Axis| {
                    let mut own = own.clone();
                    let found = own.find(|(channel, _)| **channel == Channel::Position(axis));
                    found.map(|(_, column)| (column, axis.index()))
                };
                for axis in [Axis::X, Axis::Y, Axis::Z] {
                    columns.push(position(axis)?);
                }
            }
        }
        let rows = self.values.chunks_mut(start.max(1));
        for (row, way) in rows.zip(ways) {
            for (column, axis) in &columns {
                row[*column] += way[*axis];
            }
        }
        Some(self)
    }

    /// The transform of a joint in its parent's frame, from its numbers in a frame.
    pub fn local(joint: &Joint, numbers: &[f64]) -> Transform {
        let mut position = joint.offset;
        let mut rotation = DQuat::IDENTITY;
        for (channel, number) in joint.channels.iter().zip(numbers) {
            match channel {
                Channel::Position(axis) => position[axis.index()] = *number,
                Channel::Rotation(axis) => {
                    let (sin, cos) = math::sin_cos(number.to_radians() / 2.0);
                    let turn = match axis {
                        Axis::X => DQuat::from_xyzw(sin, 0.0, 0.0, cos),
                        Axis::Y => DQuat::from_xyzw(0.0, sin, 0.0, cos),
                        Axis::Z => DQuat::from_xyzw(0.0, 0.0, sin, cos),
                    };
                    rotation *= turn;
                }
            }
        }
        Transform { rotation, position }
    }

    /// Writes the world transforms of the joints in a frame to `pose`, which is cleared first.
    pub fn pose_into(&self, frame: usize, pose: &mut Pose) {
        pose.clear();
        let mut numbers = self.row(frame);
        for joint in &self.skeleton.joints {
            let (own, rest) = numbers.split_at(joint.channels.len());
            numbers = rest;
            let local = Self::local(joint, own);
            pose.push(match joint.parent.and_then(|parent| pose.get(parent)) {
                Some(parent) => Transform {
                    rotation: parent.rotation * local.rotation,
                    position: parent.rotation * local.position + parent.position,
                },
                None => local,
            });
        }
    }

    /// The world transforms of the joints in a frame.
    pub fn pose(&self, frame: usize) -> Pose {
        let mut pose = TiVec::with_capacity(self.skeleton.joints.len());
        self.pose_into(frame, &mut pose);
        pose
    }

    /// The positions of the joints in all frames: `frames × joints`, frame by frame.
    pub fn positions(&self) -> Vec<DVec3> {
        use rayon::prelude::*;
        /// Frames that a thread processes at once.
        const GRAIN: usize = 256;

        let joints = self.skeleton.joints.len();
        let mut positions = vec![DVec3::ZERO; self.frames * joints];
        if joints == 0 {
            return positions;
        }
        positions
            .par_chunks_mut(GRAIN * joints)
            .enumerate()
            .for_each(|(chunk, positions)| {
                let mut pose = TiVec::with_capacity(joints);
                for (frame, positions) in positions.chunks_mut(joints).enumerate() {
                    self.pose_into(chunk * GRAIN + frame, &mut pose);
                    for (position, placed) in positions.iter_mut().zip(&pose) {
                        *position = placed.position;
                    }
                }
            });
        positions
    }
}
