//! Travel over the ground: how far a body has gone, and clips in place, without it.

use glam::DVec3;
use typed_index_collections::TiSlice;

use crate::mocap::{Axis, Channel, Clip, JointId};

/// How a motion ends.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Ending {
    /// Anyhow.
    Open,
    /// In the pose in which it begins, so that it can be repeated.
    Loop,
}

/// The travel of a point that moves like this, frame by frame, from its first place. Height does not count; `up` is a unit vector.
///
/// It is smooth, so that the sway of each step remains when it is subtracted: in a loop the straight way from the first to the last
/// place, else the mean of the way half a second around each frame.
pub(crate) fn travel(path: &[DVec3], up: DVec3, fps: f64, ending: Ending) -> Vec<DVec3> {
    let (Some(&first), Some(&last)) = (path.first(), path.last()) else {
        return Vec::new();
    };
    let frames = path.len();
    let steps = (frames - 1).max(1) as f64;
    let around = (fps / 2.0).round() as usize;
    // Sums of all places before each frame.
    let mut sums = vec![DVec3::ZERO];
    for place in path {
        sums.push(sums[sums.len() - 1] + (*place - first));
    }
    let at = |frame: usize| match ending {
        Ending::Loop => (last - first) * (frame as f64 / steps),
        Ending::Open => {
            // Even at the ends the frame is in the middle.
            let reach = around.min(frame).min(frames - 1 - frame);
            let (from, to) = (frame - reach, frame + reach + 1);
            (sums[to] - sums[from]) / (to - from) as f64
        }
    };
    (0..frames).map(|frame| at(frame).reject_from(up)).collect()
}

/// The clip without the travel of a joint, its hips. `up` is the axis of the clip's world that points up.
#[must_use]
pub(crate) fn in_place(clip: &Clip, hips: JointId, up: DVec3, ending: Ending) -> Clip {
    let positions = clip.positions();
    let poses = positions.chunks_exact(clip.skeleton.joints.len().max(1));
    let place = |pose: &[DVec3]| TiSlice::<JointId, DVec3>::from_ref(pose)[hips];
    let path: Vec<DVec3> = poses.map(place).collect();
    let travel = travel(&path, up, 1.0 / clip.frame_time, ending);
    let mut values = clip.values().to_vec();
    let width = clip.skeleton.channel_count();
    for (row, travel) in values.chunks_mut(width.max(1)).zip(&travel) {
        for (index, axis) in root_positions(clip) {
            row[index] -= travel[axis.index()];
        }
    }
    Clip::new(clip.skeleton.clone(), clip.frame_time, values)
}

/// The numbers of a frame that are positions in the world: those of joints without a parent.
pub(crate) fn root_positions(clip: &Clip) -> impl Iterator<Item = (usize, Axis)> {
    let mut start = 0;
    let joints = clip.skeleton.joints.iter();
    joints.flat_map(move |joint| {
        let first = start;
        start += joint.channels.len();
        let is_root = joint.parent.is_none();
        let channels = joint.channels.iter().enumerate();
        channels.filter_map(move |(index, channel)| match channel {
            Channel::Position(axis) if is_root => Some((first + index, *axis)),
            _ => None,
        })
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Steps to +x with a sway to the side once a second, and a bob.
    fn steps(frames: usize) -> Vec<DVec3> {
        let step = |frame: usize| {
            let (sin, cos) = (frame as f64 / 24.0 * std::f64::consts::TAU).sin_cos();
            DVec3::new(2.0 * frame as f64, cos, sin)
        };
        (0..frames).map(step).collect()
    }

    #[test]
    fn sway_and_height_are_no_travel() {
        for (frames, ending) in [(25, Ending::Loop), (200, Ending::Open)] {
            let path = steps(frames);
            let travel = travel(&path, DVec3::Y, 24.0, ending);
            assert_eq!(travel.len(), frames);
            assert!(travel.iter().all(|travel| travel.y == 0.0));
            for (frame, travel) in travel
                .iter()
                .enumerate()
                .skip(24)
                .take(frames - 48.min(frames))
            {
                assert!((travel.x - 2.0 * frame as f64).abs() < 1e-9, "{travel}");
                assert!(travel.z.abs() < 0.1, "{travel}");
            }
        }
        assert!(travel(&[], DVec3::Y, 24.0, Ending::Open).is_empty());
        assert_eq!(
            travel(&[DVec3::ONE], DVec3::Y, 24.0, Ending::Loop),
            [DVec3::ZERO]
        );
    }
}
