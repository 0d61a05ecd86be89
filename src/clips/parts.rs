//! What clips that move the parts of a figure name as their joints.

use std::sync::Arc;

use glam::DVec3;

use crate::mocap::resample::FPS;
use crate::mocap::{Axis, Channel, Clip, Joint, JointId, Skeleton};

/// A clip of joints that stand still, all of them at the origin, 24 frames a second: the figure's own parts say how they move. The first
/// joint is the root of the others.
pub(crate) fn still(names: &[&str], frames: usize) -> Clip {
    let joint = |(index, name): (usize, &&str)| Joint {
        name: (*name).to_owned(),
        parent: (index > 0).then(JointId::default),
        offset: DVec3::ZERO,
        channels: match index {
            0 => [Axis::X, Axis::Y, Axis::Z].map(Channel::Position).to_vec(),
            _ => Vec::new(),
        },
        ends: Vec::new(),
    };
    let joints = names.iter().enumerate().map(joint).collect();
    Clip::new(
        Arc::new(Skeleton { joints }),
        1.0 / FPS,
        vec![0.0; 3 * frames],
    )
}
