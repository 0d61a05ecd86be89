//! Built-in clips that play in turn as one clip.

use glam::{DQuat, DVec3};

use super::Turn;
use crate::mocap::Clip;
use crate::mocap::in_turn::{Moment, Path, Place, Playing, blend_frames, moments, travel};
use crate::mocap::resample::{Mix, mixed};
use crate::mocap::travel::{Ending, root_positions};

/// Clips of one skeleton in turn, at least one, joined by blends; `up` is the axis of their world that points up.
pub(super) fn in_turn(turns: &[Turn], is_loop: bool, up: DVec3) -> Clip {
    let clip = &turns[0].clip.clip;
    let playing: Vec<Playing> = turns.iter().map(Turn::playing).collect();
    let moments = moments(&playing, blend_frames(clip.frame_time), is_loop);
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
    let roots: Vec<Vec<DVec3>> = turns
        .iter()
        .map(|turn| root_path(&turn.clip.clip))
        .collect();
    let paths = roots.iter().map(|root| Path {
        root,
        turn: DQuat::IDENTITY,
    });
    let paths: Vec<Path<'_>> = paths.collect();
    let (places, _) = travel(&moments, &paths, up);
    let start = roots[0]
        .first()
        .copied()
        .unwrap_or_default()
        .reject_from(up);
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

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::super::{LeadInPolicy, Options, built_in, in_turn, prepare};
    use super::*;
    use crate::clips::{BuiltIn, Legs};
    use crate::mocap::bvh;
    use crate::mocap::resample::Range;

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(32))]

        #[test]
        fn clips_in_turn_are_the_clips(
            chosen in prop::collection::vec((0..9_usize, 0.2..5.0_f64), 1..4),
            legs in prop::sample::select(Legs::ALL.to_vec()),
            is_loop: bool,
        ) {
            let turn = |(index, seconds): &(usize, f64)| Turn {
                clip: built_in(BuiltIn::ALL[*index], legs),
                seconds: Some(*seconds),
            };
            let turns: Vec<Turn> = chosen.iter().map(turn).collect();
            let joined = in_turn(turns[0].clone(), turns[1..].to_vec(), is_loop).unwrap();
            let joints = joined.clip.skeleton.joints.len();
            let relative = |positions: &[DVec3], frame: usize| {
                let pose = &positions[frame * joints..][..joints];
                let below = pose[0].reject_from(DVec3::Y);
                pose.iter().map(|place| *place - below).collect::<Vec<DVec3>>()
            };
            let (mut first, mut most) = (0, 0.0_f64);
            for (index, turn) in turns.iter().enumerate() {
                let steps = turn.clip.clip.frames - 1;
                let length = turn.playing().length();
                prop_assert_eq!(length % steps, 0);
                let blended = if index > 0 || is_loop && turns.len() > 1 { 6 } else { 0 };
                for step in blended..=length {
                    let own = if step == length { steps } else { step % steps };
                    let (a, b) = (relative(&joined.positions, first + step), relative(&turn.clip.positions, own));
                    let off = a.iter().zip(&b).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max);
                    prop_assert!(off < 1e-6, "{step}: {off}");
                }
                for frame in 1..=steps {
                    let places = &turn.clip.positions;
                    let step = (0..joints).map(|joint| places[frame * joints + joint].distance(places[(frame - 1) * joints + joint]));
                    most = step.fold(most, f64::max);
                }
                first += length;
            }
            prop_assert_eq!(joined.clip.frames, first + 1);
            for frame in 1..=first {
                for joint in 0..joints {
                    let step = joined.positions[frame * joints + joint].distance(joined.positions[(frame - 1) * joints + joint]);
                    prop_assert!(step <= 2.0 * most, "{frame} {joint}: {step} over {most}");
                }
            }
        }
    }

    #[test]
    fn a_range_is_the_file_cut_there() {
        let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/examples/motion");
        let bytes = std::fs::read(format!("{folder}/kick.bvh")).unwrap();
        let clip = bvh::read_bytes(&bytes).unwrap().clip;
        for (first, last) in [(1, 169), (73, 145), (30, 31), (169, 169)] {
            let ranged = Options {
                range: Some(Range {
                    first,
                    last: Some(last),
                }),
                ..Options::default()
            };
            let whole = Options {
                lead_in: LeadInPolicy::Keep,
                ..Options::default()
            };
            let found = prepare(clip.clone(), &ranged).unwrap();
            let cut = prepare(clip.select_frames(first - 1..last), &whole).unwrap();
            assert_eq!(found.clip, cut.clip, "{first}:{last}");
            assert_eq!(found.positions, cut.positions);
        }
        // A lead-in is counted, and left out.
        let still = clip.select_frames(std::iter::repeat_n(0, 3).chain(60..169));
        let all = prepare(still.clone(), &Options::default()).unwrap();
        let left_out = still.frames
            - prepare(
                still.clone(),
                &Options {
                    fps: 60.0,
                    ..Options::default()
                },
            )
            .unwrap()
            .clip
            .frames;
        let ranged = Options {
            range: Some(Range {
                first: 1,
                last: Some(still.frames),
            }),
            ..Options::default()
        };
        assert_eq!(prepare(still.clone(), &ranged).unwrap().clip, all.clip);
        let beyond = Options {
            range: Some(Range {
                first: 1,
                last: Some(still.frames + 1),
            }),
            ..Options::default()
        };
        let error = prepare(still.clone(), &beyond).unwrap_err();
        assert_eq!(
            error.to_string(),
            format!(
                "there is no frame {}: the clip has {}",
                still.frames + 1,
                still.frames
            ),
            "{left_out}"
        );
    }

    #[test]
    fn speed_scales_the_length() {
        for which in [BuiltIn::Walk, BuiltIn::Dance] {
            let clip = built_in(which, Legs::Two);
            let steps = (clip.clip.frames - 1) as f64;
            for speed in [0.01, 0.5, 0.8, 1.0, 1.7, 3.0, 100.0] {
                let options = Options {
                    speed,
                    ..Options::default()
                };
                let played = clip.clone().change(&options).unwrap();
                let due = (steps / speed).round().max(1.0);
                assert_eq!((played.clip.frames - 1) as f64, due, "{speed}");
                let (start, end) = (
                    clip.clip.row(clip.clip.frames - 1),
                    played.clip.row(played.clip.frames - 1),
                );
                assert!(start.iter().zip(end).all(|(a, b)| (a - b).abs() < 1e-6));
            }
        }
    }
}
