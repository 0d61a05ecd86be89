//! Loops: finds the cycle of a clip that can be repeated best, and closes it.

use glam::DVec3;
use typed_index_collections::TiSlice;

use crate::labels::Anatomy;
use crate::limited::ssd;
use crate::mocap::resample::{Mix, mixed};
use crate::mocap::travel::root_positions;
use crate::mocap::{Clip, JointId};
use crate::smoothing::ease;

/// A cycle has at least this length, seconds …
const MIN_SECONDS: f64 = 0.5;
/// … and at most this one: nobody does the same twice in more.
const MAX_SECONDS: f64 = 10.0;
/// A difference of velocities counts like the distance that it makes in this time, seconds.
const AHEAD: f64 = 0.15;
/// Over how many frames the ends of a cycle are blended at most.
const MAX_BLEND: usize = 8;

/// A cycle of a clip.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Cycle {
    /// The frame in which it begins, counted from 0.
    pub first: usize,
    /// The frame that has nearly the same pose, with which it ends.
    pub last: usize,
}

/// The best cycle of a clip, closed: its last frame is its first one, as far ahead as the body has travelled, and at most 8 frames
/// before it lead there. `None` for clips of less than half a second. `up` is the axis of the clip's world that points up.
pub(super) fn looped(clip: &Clip, anatomy: &Anatomy, up: DVec3) -> Option<(Clip, Cycle)> {
    let cycle = best_cycle(clip, anatomy, up)?;
    Some((closed(clip, cycle, up), cycle))
}

/// The cycle whose ends differ least, compared with how far the body moves between them: by the positions of the labelled joints about
/// the hips, and by their velocities. The earliest one, and of these the shortest, wins ties.
fn best_cycle(clip: &Clip, anatomy: &Anatomy, up: DVec3) -> Option<Cycle> {
    let fps = 1.0 / clip.frame_time;
    let frames = clip.frames;
    let shortest = (MIN_SECONDS * fps).ceil().max(1.0) as usize;
    let longest = (MAX_SECONDS * fps) as usize;
    if frames <= shortest {
        return None;
    }
    let poses = Poses::of(clip, anatomy, up);
    let ahead = AHEAD * fps;
    // The frames before the first one are what the last ones are blended with.
    let earliest = MAX_BLEND.min(frames - 1 - shortest);
    let mut best: Option<(f64, Cycle)> = None;
    for first in earliest..frames - shortest {
        // How far the body gets from the first pose.
        let mut extent = 0.0_f64;
        for last in first + 1..frames.min(first + longest + 1) {
            let apart = poses.apart(first, last);
            extent = extent.max(apart);
            if last - first < shortest || extent == 0.0 {
                continue;
            }
            let cost = (apart + ahead * ahead * poses.velocities_apart(first, last)) / extent;
            if best.is_none_or(|(least, _)| cost < least) {
                best = Some((cost, Cycle { first, last }));
            }
        }
    }
    // A body that never moves can be repeated as it is.
    let still = Cycle {
        first: 0,
        last: frames - 1,
    };
    Some(best.map_or(still, |(_, cycle)| cycle))
}

/// Where the labelled joints are in every frame, from the place on the ground below the hips.
struct Poses {
    points: usize,
    places: Vec<DVec3>,
}

impl Poses {
    fn of(clip: &Clip, anatomy: &Anatomy, up: DVec3) -> Self {
        let count = clip.skeleton.joints.len();
        let mut points: Vec<JointId> = anatomy.labeled().collect();
        if points.is_empty() {
            points = clip.skeleton.joints.keys().collect();
        }
        let hips = anatomy.hips.unwrap_or_default();
        let mut places = Vec::with_capacity(clip.frames * points.len());
        for pose in clip.positions().chunks_exact(count.max(1)) {
            let pose: &TiSlice<JointId, DVec3> = TiSlice::from_ref(pose);
            let below = pose[hips].reject_from(up);
            places.extend(points.iter().map(|joint| pose[*joint] - below));
        }
        Self {
            points: points.len(),
            places,
        }
    }

    fn at(&self, frame: usize) -> &[DVec3] {
        &self.places[frame * self.points..][..self.points]
    }

    /// The sum of the squared distances of two poses.
    fn apart(&self, a: usize, b: usize) -> f64 {
        ssd(self.at(a), self.at(b))
    }

    /// The sum of the squared differences of their velocities, per frame.
    fn velocities_apart(&self, a: usize, b: usize) -> f64 {
        let last = self.places.len() / self.points - 1;
        // Both at the same side of the frame where the clip begins or ends.
        let before = if a == 0 { 0 } else { 1 };
        let after = if b == last { 0 } else { 1 };
        let span = (before + after).max(1) as f64;
        let step = |frame: usize| {
            let (from, to) = (self.at(frame - before), self.at(frame + after));
            to.iter().zip(from).map(|(to, from)| *to - *from)
        };
        let pairs = step(a).zip(step(b));
        pairs.map(|(a, b)| a.distance_squared(b)).sum::<f64>() / (span * span)
    }
}

/// The frames of a cycle, the last of them mixed with those that lead to its first frame, where there are any.
fn closed(clip: &Clip, cycle: Cycle, up: DVec3) -> Clip {
    let Cycle { first, last } = cycle;
    let blend = MAX_BLEND.min((last - first) / 2).min(first).max(1);
    let mixes: Vec<Mix> = (first..=last)
        .map(|frame| {
            let left = last - frame;
            Mix {
                from: frame,
                to: first.saturating_sub(left),
                t: ease(1.0 - left as f64 / blend as f64),
            }
        })
        .collect();
    let mixed = mixed(clip, &mixes);
    let width = clip.skeleton.channel_count();
    let mut values = mixed.values().to_vec();
    // What the body has travelled stays.
    for (row, frame) in values.chunks_mut(width.max(1)).zip(first..) {
        let source = clip.row(frame);
        let mut change = DVec3::ZERO;
        for (index, axis) in root_positions(clip) {
            change[axis.index()] = source[index] - row[index];
        }
        let change = change.reject_from(up);
        for (index, axis) in root_positions(clip) {
            row[index] += change[axis.index()];
        }
    }
    Clip::new(clip.skeleton.clone(), clip.frame_time, values)
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use typed_index_collections::ti_vec;

    use super::*;
    use crate::labels::label_clip;
    use crate::mocap::bvh;
    use crate::mocap::{Axis, Channel, Joint, Skeleton};
    use crate::prepare::{Options, prepare};

    /// An arm that swings with a period of 20 frames after it has been raised for `rise` frames, on a body that travels.
    fn swinging(rise: usize, frames: usize) -> Clip {
        let joint = |name: &str, parent, offset, channels: &[Channel]| Joint {
            name: name.to_owned(),
            parent,
            offset,
            channels: channels.to_vec(),
            ends: Vec::new(),
        };
        let position = [Axis::X, Axis::Y, Axis::Z].map(Channel::Position);
        let turns = [Axis::Z, Axis::X, Axis::Y].map(Channel::Rotation);
        let joints = ti_vec![
            joint("Hips", None, DVec3::ZERO, &position),
            joint("LeftArm", Some(0.into()), DVec3::Y * 50.0, &turns),
            joint("LeftHand", Some(1.into()), DVec3::X * 50.0, &[]),
        ];
        let mut values = Vec::new();
        for frame in 0..frames {
            let t = frame as f64;
            let raise = 90.0 * (1.0 - (t / rise.max(1) as f64).min(1.0));
            let swing = 30.0 * (t / 20.0 * std::f64::consts::TAU).sin() + 0.01 * t;
            values.extend([t, 0.0, 2.0 * t, raise + swing, 0.0, 0.0]);
        }
        Clip::new(Arc::new(Skeleton { joints }), 1.0 / 24.0, values)
    }

    #[test]
    fn the_period_of_a_motion_is_found() {
        let clip = swinging(30, 120);
        let (found, cycle) = looped(&clip, &label_clip(&clip), DVec3::Y).unwrap();
        assert!(cycle.first >= 29, "{cycle:?}");
        assert_eq!((cycle.last - cycle.first) % 20, 0, "{cycle:?}");
        assert_eq!(found.frames, cycle.last - cycle.first + 1);
        let (start, end) = (found.row(0), found.row(found.frames - 1));
        for angle in 3..6 {
            assert!(
                (start[angle] - end[angle]).abs() < 1e-6,
                "{start:?} {end:?}"
            );
        }
        let traveled = (cycle.last - cycle.first) as f64;
        assert!((end[0] - start[0] - traveled).abs() < 1e-9);
        assert!((end[2] - start[2] - 2.0 * traveled).abs() < 1e-9);
    }

    #[test]
    fn loops_of_real_motions_have_no_seam() {
        for name in ["walk", "kick", "boxing", "zombie-walk"] {
            let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/examples/motion");
            let bytes = std::fs::read(format!("{folder}/{name}.bvh")).unwrap();
            let clip = bvh::read_bytes(&bytes).unwrap().clip;
            let clip = prepare(clip, &Options::default()).unwrap();
            let (found, cycle) = looped(&clip.clip, &clip.anatomy, DVec3::Y).unwrap();
            assert!(cycle.last - cycle.first >= 12, "{name}: {cycle:?}");
            let poses = Poses::of(&found, &clip.anatomy, DVec3::Y);
            let last = found.frames - 1;
            let mut steps: Vec<f64> = (0..last).map(|at| poses.apart(at, at + 1)).collect();
            steps.sort_by(f64::total_cmp);
            let (seam, median) = (poses.apart(0, last), steps[steps.len() / 2]);
            assert!(seam <= median, "{name}: {seam} over {median}");
            // Nor does blending make any step larger than those of the motion.
            let source = Poses::of(&clip.clip, &clip.anatomy, DVec3::Y);
            let all = (1..clip.clip.frames).map(|at| source.apart(at - 1, at));
            let most = all.fold(0.0, f64::max);
            assert!(steps[steps.len() - 1] <= most * 1.5, "{name}");
        }
    }

    #[test]
    fn short_and_still_clips_are_no_trouble() {
        let clip = swinging(0, 8);
        assert!(looped(&clip, &label_clip(&clip), DVec3::Y).is_none());
        let still = clip.select_frames(std::iter::repeat_n(0, 30));
        let (found, cycle) = looped(&still, &label_clip(&still), DVec3::Y).unwrap();
        assert_eq!((cycle.first, cycle.last), (0, 29));
        for (found, still) in found.values().iter().zip(still.values()) {
            assert!((found - still).abs() < 1e-9);
        }
    }
}
