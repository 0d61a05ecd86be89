//! The key poses of a recorded movement.

use std::f64::consts::{PI, TAU};

use super::monotone;

/// A part of the clip is at most this far from what was recorded, radians: about a hand's tremble.
const WITHIN: f64 = 2.5 * PI / 180.0;

/// Chooses few of the moments of a movement such that key poses in them, with the curves between key poses, show it.
///
/// `frames` are those of the moments, ascending and without repetition. Each track has the angles of a part in all moments, radians; the
/// movement goes the short way from one to the next, and to the first one from the part's key pose before the movement, if there is one in
/// `before`: curves do not rest there. Returns ascending indices of moments, with the first and the last one.
pub(crate) fn key_moments(
    frames: &[usize],
    tracks: &[Vec<f64>],
    before: &[Option<KeyBefore>],
) -> Vec<usize> {
    let tracks: Vec<Vec<f64>> = tracks.iter().map(|track| unwound(track)).collect();
    let Some(last) = frames.len().checked_sub(1) else {
        return Vec::new();
    };
    // Where a part turns back is a key pose, as animators choose them.
    let mut chosen: Vec<usize> = tracks.iter().flat_map(|track| reversals(track)).collect();
    chosen.extend([0, last]);
    chosen.sort_unstable();
    chosen.dedup();
    loop {
        let own: Vec<usize> = chosen
            .iter()
            .map(|&moment| frames[moment] - frames[0])
            .collect();
        // In each gap the moment that is the farthest off is chosen, too.
        let mut farthest: Vec<Option<(usize, f64)>> = vec![None; chosen.len()];
        for (track, before) in tracks.iter().zip(before) {
            let keys: Vec<f64> = chosen.iter().map(|&moment| track[moment]).collect();
            let curve = curve(&own, &keys, *before);
            let mut gap = 0;
            for (moment, angle) in track.iter().enumerate() {
                if chosen.get(gap + 1).is_some_and(|&next| moment >= next) {
                    gap += 1;
                }
                let off = (curve[frames[moment] - frames[0]] - angle).abs();
                if off > WITHIN && farthest[gap].is_none_or(|(_, known)| off > known) {
                    farthest[gap] = Some((moment, off));
                }
            }
        }
        let more: Vec<usize> = farthest
            .iter()
            .flatten()
            .map(|(moment, _)| *moment)
            .collect();
        if more.is_empty() {
            return chosen;
        }
        chosen.extend(more);
        chosen.sort_unstable();
    }
}

/// A key pose of a part before a movement.
#[derive(Debug, Clone, Copy)]
pub(crate) struct KeyBefore {
    /// How many frames before the movement begins: more than 0.
    pub frames: usize,
    /// By how much the part is turned, radians.
    pub angle: f64,
}

/// The angles in all frames from the first key on, which is in frame 0.
fn curve(frames: &[usize], keys: &[f64], before: Option<KeyBefore>) -> Vec<f64> {
    let (Some(before), Some(first)) = (before, keys.first()) else {
        return monotone(frames, keys, false);
    };
    let later = frames.iter().map(|frame| before.frames + frame);
    let frames: Vec<usize> = std::iter::once(0).chain(later).collect();
    let angle = first - short_way(before.angle, *first);
    let keys: Vec<f64> = std::iter::once(angle).chain(keys.iter().copied()).collect();
    monotone(&frames, &keys, false).split_off(before.frames)
}

/// The short way from one angle to another.
fn short_way(from: f64, to: f64) -> f64 {
    (to - from + PI).rem_euclid(TAU) - PI
}

/// The moments in which a part turns back, by more than a tremble.
fn reversals(track: &[f64]) -> Vec<usize> {
    let mut found = Vec::new();
    let (mut low, mut high) = (0, 0);
    // Whether it turns counter-clockwise.
    let mut rises = None;
    for (moment, angle) in track.iter().enumerate() {
        if *angle > track[high] {
            high = moment;
        }
        if *angle < track[low] {
            low = moment;
        }
        if rises != Some(true) && angle - track[low] > 2.0 * WITHIN {
            found.extend(rises.map(|_| low));
            rises = Some(true);
            high = moment;
        } else if rises != Some(false) && track[high] - angle > 2.0 * WITHIN {
            found.extend(rises.map(|_| high));
            rises = Some(false);
            low = moment;
        }
    }
    found
}

/// Angles such that each is the short way from the one before.
fn unwound(track: &[f64]) -> Vec<f64> {
    let mut now = track.first().copied().unwrap_or_default();
    let steps = track.iter().map(|angle| {
        now += short_way(now, *angle);
        now
    });
    steps.collect()
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        /// Of anything that is recorded.
        #[test]
        fn key_poses_show_what_was_recorded(
            steps in prop::collection::vec((1_usize..4, prop::array::uniform2(-1.0..1.0_f64)), 1..120),
            is_calm: bool,
            before in prop::array::uniform2(prop::option::of((1_usize..30, -3.0..3.0_f64))),
        ) {
            let before = before.map(|key| key.map(|(frames, angle)| KeyBefore { frames, angle }));
            let mut frames = vec![];
            let mut tracks = vec![vec![], vec![]];
            let (mut frame, mut angles) = (3, [0.0; 2]);
            for (step, turns) in steps {
                frames.push(frame);
                frame += step;
                for (part, turn) in turns.into_iter().enumerate() {
                    angles[part] += if is_calm { turn / 20.0 } else { turn };
                    tracks[part].push((angles[part] + PI).rem_euclid(TAU) - PI);
                }
            }
            let chosen = key_moments(&frames, &tracks, &before);
            prop_assert!(chosen.is_sorted_by(|one, next| one < next));
            prop_assert_eq!((chosen[0], chosen[chosen.len() - 1]), (0, frames.len() - 1));
            let own: Vec<usize> = chosen.iter().map(|&moment| frames[moment] - 3).collect();
            for (track, before) in tracks.iter().zip(before) {
                let track = unwound(track);
                let keys: Vec<f64> = chosen.iter().map(|&moment| track[moment]).collect();
                let curve = curve(&own, &keys, before);
                for (moment, angle) in track.iter().enumerate() {
                    let off = (curve[frames[moment] - 3] - angle).abs();
                    prop_assert!(off <= WITHIN, "{off} at {moment}");
                }
            }
        }
    }

    #[test]
    fn a_swing_has_a_key_pose_at_each_end() {
        let frames: Vec<usize> = (0..=96).collect();
        let swing = frames
            .iter()
            .map(|&frame| (frame as f64 / 24.0 * PI).cos() / 2.0);
        let chosen = key_moments(&frames, &[swing.collect()], &[None]);
        for turning in [0, 24, 48, 72, 96] {
            assert!(chosen.contains(&turning), "{chosen:?}");
        }
        assert!(chosen.len() <= 9, "{chosen:?}");
        assert_eq!(key_moments(&frames, &[vec![0.3; 97]], &[None]), [0, 96]);
        assert_eq!(key_moments(&[7], &[vec![0.3]], &[None]), [0]);
    }
}
