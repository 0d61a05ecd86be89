//! Built-in clips that play in turn as one clip.

use glam::{DQuat, DVec3};

use super::Turn;
use crate::mocap::Clip;
use crate::mocap::in_turn::{BLEND_SECONDS, Moment, Path, Place, Playing, moments, travel};
use crate::mocap::resample::{Mix, mixed};
use crate::mocap::travel::{Ending, root_positions};

/// Clips of one skeleton in turn, at least one, joined by blends; `up` is the axis of their world that points up.
pub(super) fn in_turn(turns: &[Turn], is_loop: bool, up: DVec3) -> Clip {
    let clip = &turns[0].clip.clip;
    let playing: Vec<Playing> = turns.iter().map(Turn::playing).collect();
    let blend = (BLEND_SECONDS / clip.frame_time).round() as usize;
    let moments = moments(&playing, blend, is_loop);
    // All frames of all clips, one after the other, and where each clip begins.
    let mut values = Vec::new();
    let mut starts = Vec::with_capacity(turns.len());
    let mut frames = 0;
    for turn in turns {
        starts.push(frames);
        frames += turn.clip.clip.frames;
        values.extend_from_slice(turn.clip.clip.values());
    }
    let all = Clip::new(clip.skeleton.clone(), clip.frame_time, values);
    let at = |motion: usize, place: Place| starts[motion] + place.frame;
    let mix = |moment: &Moment| {
        let own = at(moment.motion, moment.place);
        match moment.fading {
            Some(fading) => Mix {
                from: at(fading.motion, fading.place),
                to: own,
                t: 1.0 - fading.share,
            },
            None => Mix {
                from: own,
                to: own,
                t: 0.0,
            },
        }
    };
    let mixes: Vec<Mix> = moments.iter().map(mix).collect();
    let shown = mixed(&all, &mixes);
    let roots: Vec<Vec<DVec3>> = turns.iter().map(|turn| root_path(&turn.clip.clip)).collect();
    let paths = roots.iter().map(|root| Path {
        root,
        turn: DQuat::IDENTITY,
    });
    let paths: Vec<Path<'_>> = paths.collect();
    let (places, _) = travel(&moments, &paths, up);
    let start = roots[0].first().copied().unwrap_or_default().reject_from(up);
    let mut values = shown.values().to_vec();
    let width = shown.skeleton.channel_count();
    let rows = values.chunks_mut(width.max(1)).zip(root_path(&shown));
    for ((row, mixed), place) in rows.zip(places) {
        let change = start + place - mixed.reject_from(up);
        for (index, axis) in root_positions(&shown) {
            row[index] += change[axis.index()];
        }
    }
    Clip::new(shown.skeleton.clone(), shown.frame_time, values)
}

/// Frame by frame the position of the root, as its channels say.
fn root_path(clip: &Clip) -> Vec<DVec3> {
    let place = |frame: usize| {
        let row = clip.row(frame);
        let mut place = DVec3::ZERO;
        for (index, axis) in root_positions(clip) {
            place[axis.index()] = row[index];
        }
        place
    };
    (0..clip.frames).map(place).collect()
}

impl Turn {
    /// How long it plays.
    pub(super) fn playing(&self) -> Playing {
        let clip = &self.clip.clip;
        let is_loop = self.clip.ending == Ending::Loop;
        Playing::lasting(
            clip.frames.saturating_sub(1),
            is_loop,
            self.seconds,
            clip.frame_time,
        )
    }
}
