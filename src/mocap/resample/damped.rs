//! Clips in which some joints turn less than they did.

use std::sync::Arc;

use glam::DQuat;
use typed_index_collections::TiSlice;

use super::euler::RotationTrack;
use crate::mocap::turns::damp;
use crate::mocap::{Channel, Clip, JointId};

/// The clip whose joints turn less: per joint the ratio R of its turns that is left, from its rotation in the first frame on; `None`
/// and 1 leave every number as it is, 0 repeats those of the first frame. Positions stay. A joint whose channels cannot express
/// every rotation has its angles scaled, each by itself.
///
/// Source: Manya & Matsuda, equation 1, which scales angles in all cases.
pub(crate) fn damped(clip: &Clip, ratios: &TiSlice<JointId, Option<f64>>) -> Clip {
    let width = clip.skeleton.channel_count();
    let mut values = clip.values().to_vec();
    let mut start = 0;
    for (id, joint) in clip.skeleton.joints.iter_enumerated() {
        let columns = start..start + joint.channels.len();
        start = columns.end;
        let ratio = ratios.get(id).copied().flatten();
        let Some(ratio) = ratio.filter(|ratio| *ratio != 1.0 && clip.frames > 1) else {
            continue;
        };
        let first = &clip.row(0)[columns.clone()];
        let mut track = RotationTrack::new(&joint.channels, first);
        if ratio == 0.0 || !track.is_complete() {
            scale(
                &mut values,
                width,
                columns.start,
                &joint.channels,
                first,
                ratio,
            );
            continue;
        }
        let rotation =
            |frame: usize| Clip::local(joint, &clip.row(frame)[columns.clone()]).rotation;
        let mut turns: Vec<DQuat> = (0..clip.frames).map(rotation).collect();
        damp(&mut turns, ratio);
        for (row, turn) in values.chunks_mut(width).zip(turns).skip(1) {
            track.set(turn, &mut row[columns.clone()]);
        }
    }
    Clip::new(Arc::clone(&clip.skeleton), clip.frame_time, values)
}

/// Scales the angles of a joint, whose numbers begin in column `start`, about those of the first frame. Each follows through time:
/// steps of more than half a turn are taken the other way.
fn scale(
    values: &mut [f64],
    width: usize,
    start: usize,
    channels: &[Channel],
    first: &[f64],
    ratio: f64,
) {
    for (channel, base) in first.iter().enumerate() {
        if !matches!(channels[channel], Channel::Rotation(_)) {
            continue;
        }
        let mut before = *base;
        for row in values.chunks_mut(width) {
            let angle = &mut row[start + channel];
            before = *angle - 360.0 * ((*angle - before) / 360.0).round();
            *angle = base + (before - base) * ratio;
        }
    }
}
