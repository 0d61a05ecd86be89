//! Skeletons, and clips of their motion: what a BVH file holds.

use std::sync::Arc;

use glam::{DQuat, DVec3};

/// A hierarchy of joints. A parent stands before its children; several joints may be roots.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Skeleton {
    /// The joints, in the order of the file.
    pub joints: Vec<Joint>,
}

/// A joint, and how its numbers stand in a frame.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Joint {
    /// Its name; two joints may have the same.
    pub name: String,
    /// Index of the joint it hangs on.
    pub parent: Option<usize>,
    /// Where it stands in its parent's frame while it has no position of its own.
    pub offset: DVec3,
    /// What its numbers in a frame mean, in their order.
    pub channels: Vec<Channel>,
    /// The ends of bones that lead to no joint (`End Site`), in its frame.
    pub ends: Vec<DVec3>,
}

/// What a number of a frame means.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Channel {
    /// Where the joint stands in its parent's frame, in place of the offset's component.
    Position(Axis),
    /// A turn, degrees. Rotations apply in the order of the channels, each about axes that those before it have turned.
    Rotation(Axis),
}

/// An axis of a joint's frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Axis {
    /// The first.
    X,
    /// The second.
    Y,
    /// The third.
    Z,
}

impl Axis {
    /// Its index: 0, 1, 2.
    pub fn index(self) -> usize {
        self as usize
    }
}

impl Skeleton {
    /// How many numbers a frame has.
    pub fn width(&self) -> usize {
        self.joints.iter().map(|joint| joint.channels.len()).sum()
    }

    /// Per joint the joints that hang on it, in order.
    pub fn children(&self) -> Vec<Vec<usize>> {
        let mut children = vec![Vec::new(); self.joints.len()];
        for (index, joint) in self.joints.iter().enumerate() {
            if let Some(parent) = joint.parent {
                children[parent].push(index);
            }
        }
        children
    }

    /// Per joint whether it hangs on `joint`, however far down; not on itself.
    pub fn below(&self, joint: usize) -> Vec<bool> {
        let mut below: Vec<bool> = Vec::with_capacity(self.joints.len());
        for other in &self.joints {
            // Parents stand before their children.
            below.push(
                other
                    .parent
                    .is_some_and(|parent| parent == joint || below[parent]),
            );
        }
        below
    }

    /// Where the joints stand in the world while all channels are 0 and positions are the offsets.
    pub fn offset_pose(&self) -> Vec<Placed> {
        let mut pose: Vec<Placed> = Vec::with_capacity(self.joints.len());
        for joint in &self.joints {
            let above = joint
                .parent
                .map_or(DVec3::ZERO, |parent| pose[parent].position);
            pose.push(Placed {
                rotation: DQuat::IDENTITY,
                position: above + joint.offset,
            });
        }
        pose
    }
}

/// Where a joint is in the world: `rotation · p + position` carries a point of its frame there.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Placed {
    /// How it is turned.
    pub rotation: DQuat,
    /// Where it stands, in the file's unit.
    pub position: DVec3,
}

/// How far points reach from the lowest to the highest, along y; 0 without points.
pub(super) fn height(points: impl Iterator<Item = DVec3>) -> f64 {
    let none = (f64::INFINITY, f64::NEG_INFINITY);
    let (low, high) = points.fold(none, |(low, high), point| {
        (low.min(point.y), high.max(point.y))
    });
    (high - low).max(0.0)
}

/// A motion: frames of a skeleton at even steps of time.
#[derive(Debug, Clone, PartialEq)]
pub struct Clip {
    /// What moves.
    pub skeleton: Arc<Skeleton>,
    /// Seconds from a frame to the next.
    pub frame_time: f64,
    /// All frames, one after the other, each of [`Skeleton::width`] numbers in the order of the file.
    values: Vec<f64>,
    frames: usize,
}

impl Clip {
    /// A clip of whole frames; numbers that fill no frame are dropped. A skeleton without channels has no frames.
    pub fn new(skeleton: Arc<Skeleton>, frame_time: f64, mut values: Vec<f64>) -> Self {
        let frames = values.len().checked_div(skeleton.width()).unwrap_or(0);
        values.truncate(frames * skeleton.width());
        Self {
            skeleton,
            frame_time,
            values,
            frames,
        }
    }

    /// How many frames there are.
    pub fn frames(&self) -> usize {
        self.frames
    }

    /// The numbers of a frame.
    pub fn row(&self, frame: usize) -> &[f64] {
        let width = self.skeleton.width();
        &self.values[frame * width..][..width]
    }

    /// The numbers of all frames, one frame after the other.
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// The clip that shows these frames of this one, in this order.
    #[must_use]
    pub fn picked(&self, frames: impl IntoIterator<Item = usize>) -> Self {
        let rows = frames.into_iter().flat_map(|frame| self.row(frame));
        let values = rows.copied().collect();
        Self::new(Arc::clone(&self.skeleton), self.frame_time, values)
    }

    /// How a joint is turned and where it stands in its parent's frame, from its numbers in a frame.
    pub fn local(joint: &Joint, numbers: &[f64]) -> Placed {
        let mut position = joint.offset;
        let mut rotation = DQuat::IDENTITY;
        for (channel, number) in joint.channels.iter().zip(numbers) {
            match channel {
                Channel::Position(axis) => position[axis.index()] = *number,
                Channel::Rotation(axis) => {
                    let (sin, cos) = (number.to_radians() / 2.0).sin_cos();
                    let turn = match axis {
                        Axis::X => DQuat::from_xyzw(sin, 0.0, 0.0, cos),
                        Axis::Y => DQuat::from_xyzw(0.0, sin, 0.0, cos),
                        Axis::Z => DQuat::from_xyzw(0.0, 0.0, sin, cos),
                    };
                    rotation *= turn;
                }
            }
        }
        Placed { rotation, position }
    }

    /// Where the joints are in a frame; `pose` is emptied first.
    pub fn pose_into(&self, frame: usize, pose: &mut Vec<Placed>) {
        pose.clear();
        let mut numbers = self.row(frame);
        for joint in &self.skeleton.joints {
            let (own, rest) = numbers.split_at(joint.channels.len());
            numbers = rest;
            let local = Self::local(joint, own);
            pose.push(match joint.parent.map(|parent| pose[parent]) {
                Some(parent) => Placed {
                    rotation: parent.rotation * local.rotation,
                    position: parent.rotation * local.position + parent.position,
                },
                None => local,
            });
        }
    }

    /// Where the joints are in a frame.
    pub fn pose(&self, frame: usize) -> Vec<Placed> {
        let mut pose = Vec::with_capacity(self.skeleton.joints.len());
        self.pose_into(frame, &mut pose);
        pose
    }

    /// Where the joints are in all frames: `frames × joints`, one frame after the other.
    pub fn positions(&self) -> Vec<DVec3> {
        use rayon::prelude::*;
        /// Frames that a thread takes at once.
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
                let mut pose = Vec::with_capacity(joints);
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
