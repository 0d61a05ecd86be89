//! The lead-in: the T-pose that many clips begin with, which is not part of the motion.
//!
//! Source: none in the thesis; the rules were found on files of several capture systems. A step is the root of the thesis'
//! speed (equation 5.1), √SSD(k), over all joints.

use glam::DVec3;

use super::skeleton::Clip;

/// How many times the clip's median the first step is, if the first frame alone is a T-pose.
const SINGLE_OVER_MEDIAN: f64 = 8.0;

/// How many times the largest of the steps after it, and how many those are.
const SINGLE_OVER_NEXT: f64 = 4.0;
const NEXT: usize = 5;

/// How many times the clip's median, and that of the second after them, the steps are that lead out of a T-pose.
const EASED_OVER: f64 = 4.0;

/// How many frames are left out at most where the motion was eased in.
const MOST_EASED: usize = 12;

/// How far the arms of a T-pose are from the line through the shoulders, degrees.
const ARMS_WITHIN: f64 = 15.0;

/// How a clip begins.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Kind {
    /// With its motion.
    #[default]
    None,
    /// With one frame from which the figure jumps into its motion.
    Single,
    /// With a T-pose that goes over into the motion within a few frames.
    Eased,
}

/// How many frames of a clip come before its motion.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Lead {
    /// How many first frames are to be left out.
    pub frames: usize,
    /// Why.
    pub kind: Kind,
    /// How many times the clip's median step its first step is; 0 in a clip that stands still.
    pub jump: f64,
}

/// Finds the lead-in of a clip. `arms` are the arms that are known, each by the joint of its shoulder (where the upper arm
/// begins) and the joint of its hand; with fewer than two a motion that was eased in is not looked for.
pub fn lead(clip: &Clip, arms: &[[usize; 2]]) -> Lead {
    let joints = clip.skeleton.joints.len();
    lead_of_positions(&clip.positions(), joints, clip.frame_time, arms)
}

/// As [`lead`], for whoever has the positions already: those of [`Clip::positions`], `frames × joints`, with the seconds from a
/// frame to the next.
pub fn lead_of_positions(
    positions: &[DVec3],
    joints: usize,
    frame_time: f64,
    arms: &[[usize; 2]],
) -> Lead {
    if joints == 0 || positions.len() / joints < 3 {
        return Lead::default();
    }
    let steps: Vec<f64> = positions
        .chunks_exact(joints)
        .zip(positions.chunks_exact(joints).skip(1))
        .map(|(before, after)| step(before, after))
        .collect();
    let median = median(&steps);
    let first = steps.first().copied().unwrap_or(0.0);
    let jump = if median > 0.0 { first / median } else { 0.0 };
    let next = steps.iter().skip(1).take(NEXT).copied().fold(0.0, f64::max);
    let (frames, kind) = if first > SINGLE_OVER_MEDIAN * median && first > SINGLE_OVER_NEXT * next {
        (1, Kind::Single)
    } else if is_t(&positions[..joints], arms) {
        match eased(&steps, median, frame_time) {
            0 => (0, Kind::None),
            frames => (frames, Kind::Eased),
        }
    } else {
        (0, Kind::None)
    };
    Lead { frames, kind, jump }
}

fn step(before: &[DVec3], after: &[DVec3]) -> f64 {
    let squares = before
        .iter()
        .zip(after)
        .map(|(a, b)| a.distance_squared(*b));
    squares.sum::<f64>().sqrt()
}

fn median(steps: &[f64]) -> f64 {
    let mut sorted = steps.to_vec();
    let middle = sorted.len() / 2;
    if sorted.is_empty() {
        return 0.0;
    }
    let (below, upper, _) = sorted.select_nth_unstable_by(middle, f64::total_cmp);
    let upper = *upper;
    if steps.len() % 2 == 1 {
        return upper;
    }
    let lower = below.iter().copied().fold(0.0, f64::max);
    (lower + upper) / 2.0
}

/// How many first steps lead out of the T-pose; 0 where they go on for longer, since that is a motion then.
fn eased(steps: &[f64], median_step: f64, frame_time: f64) -> usize {
    let fast = steps
        .iter()
        .take_while(|step| **step > EASED_OVER * median_step)
        .count();
    let second = (1.0 / frame_time.max(1e-9)).round().max(1.0) as usize;
    let after: Vec<f64> = steps.iter().skip(fast).take(second).copied().collect();
    let limit = EASED_OVER * median(&after);
    let leads = fast <= MOST_EASED
        && !after.is_empty()
        && steps.iter().take(fast).all(|step| *step > limit);
    if leads { fast } else { 0 }
}

/// Whether each arm points away from the other shoulders, along the line through them: so up need not be known.
fn is_t(pose: &[DVec3], arms: &[[usize; 2]]) -> bool {
    let places: Option<Vec<[DVec3; 2]>> = arms
        .iter()
        .map(|[shoulder, hand]| Some([*pose.get(*shoulder)?, *pose.get(*hand)?]))
        .collect();
    let Some(places) = places.filter(|places| places.len() >= 2) else {
        return false;
    };
    let sum: DVec3 = places.iter().map(|[shoulder, _]| *shoulder).sum();
    let others = (places.len() - 1) as f64;
    places.iter().all(|[shoulder, hand]| {
        let out = *shoulder - (sum - *shoulder) / others;
        let arm = *hand - *shoulder;
        let known = out.length_squared() > 0.0 && arm.length_squared() > 0.0;
        known && out.angle_between(arm) <= ARMS_WITHIN.to_radians()
    })
}

#[cfg(test)]
mod tests {
    use std::path::Path;
    use std::sync::Arc;

    use super::*;
    use crate::motion::bvh::read_bytes;
    use crate::motion::skeleton::{Axis, Channel, Joint, Skeleton};

    fn file(name: &str) -> Clip {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(name);
        read_bytes(&std::fs::read(path).unwrap()).unwrap().clip
    }

    /// Hips with two arms along ±x, each turned about z by one number; `angles` is how far the arms hang down.
    fn arms(angles: &[f64], frame_time: f64) -> Clip {
        let joint = |name: &str, parent, offset, channels: Vec<Channel>| Joint {
            name: name.to_owned(),
            parent,
            offset,
            channels,
            ends: Vec::new(),
        };
        let turn = || vec![Channel::Rotation(Axis::Z)];
        let joints = vec![
            joint("Hips", None, DVec3::ZERO, Vec::new()),
            joint("LeftArm", Some(0), DVec3::new(1.0, 5.0, 0.0), turn()),
            joint("LeftHand", Some(1), DVec3::new(4.0, 0.0, 0.0), Vec::new()),
            joint("RightArm", Some(0), DVec3::new(-1.0, 5.0, 0.0), turn()),
            joint("RightHand", Some(3), DVec3::new(-4.0, 0.0, 0.0), Vec::new()),
        ];
        let values = angles.iter().flat_map(|angle| [-angle, *angle]).collect();
        Clip::new(Arc::new(Skeleton { joints }), frame_time, values)
    }

    const ARMS: [[usize; 2]; 2] = [[1, 2], [3, 4]];

    #[test]
    fn real_clips_without_a_lead_in_keep_all_frames() {
        for name in [
            "examples/motion/boxing.bvh",
            "examples/motion/zombie-walk.bvh",
        ] {
            assert_eq!(lead(&file(name), &[]).kind, Kind::None, "{name}");
        }
        for name in ["mocapbank", "mixed_orders", "rotation_first"] {
            assert_eq!(
                lead(&file(&format!("tests/motion/data/{name}.bvh")), &[]).frames,
                0,
                "{name}"
            );
        }
    }

    #[test]
    fn a_pose_put_before_a_real_clip_is_found() {
        let clip = file("tests/motion/data/mocapbank.bvh");
        let width = clip.skeleton.width();
        let mut values = clip.row(0).to_vec();
        values[6..].fill(0.0);
        values.extend_from_slice(clip.values());
        assert_eq!(values.len(), (clip.frames() + 1) * width);
        let found = lead(
            &Clip::new(Arc::clone(&clip.skeleton), clip.frame_time, values),
            &[],
        );
        assert_eq!((found.frames, found.kind), (1, Kind::Single));
        assert!(found.jump > SINGLE_OVER_MEDIAN);
    }

    #[test]
    fn a_motion_eased_in_needs_arms_in_a_t() {
        let swing = (0..60).map(|frame| 80.0 + f64::from(frame % 7) * 0.3);
        let eased: Vec<f64> = [0.0, 20.0, 40.0, 60.0]
            .into_iter()
            .chain(swing.clone())
            .collect();
        let clip = arms(&eased, 1.0 / 24.0);
        assert_eq!(lead(&clip, &[]).frames, 0);
        assert_eq!(lead(&clip, &ARMS[..1]).frames, 0);
        let found = lead(&clip, &ARMS);
        assert_eq!((found.frames, found.kind), (4, Kind::Eased));
        let lowered: Vec<f64> = eased.iter().map(|angle| angle + 16.0).collect();
        assert_eq!(lead(&arms(&lowered, 1.0 / 24.0), &ARMS).frames, 0);
        let lowered: Vec<f64> = eased.iter().map(|angle| angle + 14.0).collect();
        assert_eq!(lead(&arms(&lowered, 1.0 / 24.0), &ARMS).frames, 4);
        // More than twelve steps are a motion that begins with arms held out.
        let long = (0..13).map(|frame| f64::from(frame) * 6.0).chain(swing);
        assert_eq!(
            lead(&arms(&long.collect::<Vec<_>>(), 1.0 / 24.0), &ARMS).frames,
            0
        );
    }

    #[test]
    fn nothing_is_left_of_nothing() {
        for count in 0..3 {
            assert_eq!(lead(&arms(&vec![0.0; count], 0.04), &ARMS), Lead::default());
        }
        assert_eq!(lead(&arms(&[5.0; 90], 0.04), &ARMS), Lead::default());
        assert_eq!(
            lead(&arms(&[5.0; 90], 0.04), &[[9, 1], [2, 99]]),
            Lead::default()
        );
    }
}
