//! The lead-in: the T-pose with which many clips begin, and which is not part of the motion.
//!
//! The thesis has no rules for it; these were found on files of several capture systems. A step is the square root of the
//! thesis' speed (equation 5.1), √SSD(k), over all joints.

use crate::math;
use glam::DVec3;
use typed_index_collections::TiSlice;

use crate::mocap::JointId;

/// The first frame alone is a T-pose if the first step exceeds the clip's median by this factor …
const SINGLE_OVER_MEDIAN: f64 = 8.0;

/// … and the largest of the steps after it by this factor; and the number of those steps.
const SINGLE_OVER_NEXT: f64 = 4.0;
const NEXT: usize = 5;

/// The steps that lead out of a T-pose exceed the clip's median, and that of the second after them, by this factor.
const EASED_OVER: f64 = 4.0;

/// The most frames of an eased lead-in.
const MAX_EASED: usize = 12;

/// How far the arms of a T-pose deviate from the line through the shoulders, degrees.
const ARMS_WITHIN: f64 = 15.0;

/// The kind of a lead-in.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum LeadInKind {
    /// None: the clip begins with its motion.
    #[default]
    None,
    /// A single frame from which the figure jumps into its motion.
    Single,
    /// A T-pose that changes into the motion within a few frames.
    Eased,
}

/// The frames of a clip before its motion.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct LeadIn {
    /// How many frames to remove.
    pub frames: usize,
    /// Which kind of lead-in they are.
    pub kind: LeadInKind,
    /// The first step in units of the clip's median step; 0 if the median is 0.
    pub jump: f64,
}

impl LeadIn {
    /// That it is left out, for people to read; `None` without one.
    pub(super) fn note(&self) -> Option<String> {
        match self.kind {
            LeadInKind::None => None,
            LeadInKind::Single => Some(
                "frame 1 is a pose that the motion jumps out of, as files often begin: it is left out"
                    .to_owned(),
            ),
            LeadInKind::Eased => Some(format!(
                "frames 1 to {} lead out of a T-pose, as files often begin: they are left out",
                self.frames
            )),
        }
    }
}

/// Finds the lead-in of a clip. `positions` are those of [`Clip::positions`](crate::mocap::Clip::positions), `frames × joints`.
/// `arms` are the known arms, each by its shoulder (where the upper arm begins) and its hand; with fewer than two, an eased lead-in
/// is not searched for.
pub fn find_lead_in(
    positions: &[DVec3],
    joints: usize,
    frame_time: f64,
    arms: &[[JointId; 2]],
) -> LeadIn {
    if joints == 0 || positions.len() / joints < 3 {
        return LeadIn::default();
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
        (1, LeadInKind::Single)
    } else if is_t(TiSlice::from_ref(&positions[..joints]), arms) {
        match eased(&steps, median, frame_time) {
            0 => (0, LeadInKind::None),
            frames => (frames, LeadInKind::Eased),
        }
    } else {
        (0, LeadInKind::None)
    };
    LeadIn { frames, kind, jump }
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

/// How many steps lead out of the T-pose; 0 if there are more than a lead-in has, because then they are motion.
fn eased(steps: &[f64], median_step: f64, frame_time: f64) -> usize {
    let fast = steps
        .iter()
        .take_while(|step| **step > EASED_OVER * median_step)
        .count();
    let second = (1.0 / frame_time.max(1e-9)).round().max(1.0) as usize;
    let after: Vec<f64> = steps.iter().skip(fast).take(second).copied().collect();
    let limit = EASED_OVER * median(&after);
    let leads =
        fast <= MAX_EASED && !after.is_empty() && steps.iter().take(fast).all(|step| *step > limit);
    if leads { fast } else { 0 }
}

/// Whether each arm points away from the other shoulders, along the line through them. This needs no up direction.
fn is_t(pose: &TiSlice<JointId, DVec3>, arms: &[[JointId; 2]]) -> bool {
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
        known && math::angle_between(out, arm) <= ARMS_WITHIN.to_radians()
    })
}

#[cfg(test)]
mod tests {
    use std::path::Path;
    use std::sync::Arc;

    use typed_index_collections::ti_vec;

    use super::*;
    use crate::mocap::bvh::read_bytes;
    use crate::mocap::{Axis, Channel, Clip, Joint, Skeleton};

    fn find(clip: &Clip, arms: &[[usize; 2]]) -> LeadIn {
        let joints = clip.skeleton.joints.len();
        let arms: Vec<[JointId; 2]> = arms.iter().map(|arm| arm.map(JointId::from)).collect();
        find_lead_in(&clip.positions(), joints, clip.frame_time, &arms)
    }

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
        let joints = ti_vec![
            joint("Hips", None, DVec3::ZERO, Vec::new()),
            joint("LeftArm", Some(0.into()), DVec3::new(1.0, 5.0, 0.0), turn()),
            joint(
                "LeftHand",
                Some(1.into()),
                DVec3::new(4.0, 0.0, 0.0),
                Vec::new()
            ),
            joint(
                "RightArm",
                Some(0.into()),
                DVec3::new(-1.0, 5.0, 0.0),
                turn()
            ),
            joint(
                "RightHand",
                Some(3.into()),
                DVec3::new(-4.0, 0.0, 0.0),
                Vec::new()
            ),
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
            assert_eq!(find(&file(name), &[]).kind, LeadInKind::None, "{name}");
        }
        for name in ["mocapbank", "mixed_orders", "rotation_first"] {
            assert_eq!(
                find(&file(&format!("tests/motion/data/{name}.bvh")), &[]).frames,
                0,
                "{name}"
            );
        }
    }

    #[test]
    fn a_pose_put_before_a_real_clip_is_found() {
        let clip = file("tests/motion/data/mocapbank.bvh");
        let width = clip.skeleton.channel_count();
        let mut values = clip.row(0).to_vec();
        values[6..].fill(0.0);
        values.extend_from_slice(clip.values());
        assert_eq!(values.len(), (clip.frames + 1) * width);
        let found = find(
            &Clip::new(Arc::clone(&clip.skeleton), clip.frame_time, values),
            &[],
        );
        assert_eq!((found.frames, found.kind), (1, LeadInKind::Single));
        assert!(found.jump > SINGLE_OVER_MEDIAN);
    }

    #[test]
    fn an_eased_lead_in_needs_a_t_pose() {
        let swing = (0..60).map(|frame| 80.0 + f64::from(frame % 7) * 0.3);
        let eased: Vec<f64> = [0.0, 20.0, 40.0, 60.0]
            .into_iter()
            .chain(swing.clone())
            .collect();
        let clip = arms(&eased, 1.0 / 24.0);
        assert_eq!(find(&clip, &[]).frames, 0);
        assert_eq!(find(&clip, &ARMS[..1]).frames, 0);
        let found = find(&clip, &ARMS);
        assert_eq!((found.frames, found.kind), (4, LeadInKind::Eased));
        let lowered: Vec<f64> = eased.iter().map(|angle| angle + 16.0).collect();
        assert_eq!(find(&arms(&lowered, 1.0 / 24.0), &ARMS).frames, 0);
        let lowered: Vec<f64> = eased.iter().map(|angle| angle + 14.0).collect();
        assert_eq!(find(&arms(&lowered, 1.0 / 24.0), &ARMS).frames, 4);
        // More than twelve steps are a motion that begins with arms held out.
        let long = (0..13).map(|frame| f64::from(frame) * 6.0).chain(swing);
        assert_eq!(
            find(&arms(&long.collect::<Vec<_>>(), 1.0 / 24.0), &ARMS).frames,
            0
        );
    }

    #[test]
    fn still_and_short_clips_have_no_lead_in() {
        for count in 0..3 {
            assert_eq!(
                find(&arms(&vec![0.0; count], 0.04), &ARMS),
                LeadIn::default()
            );
        }
        assert_eq!(find(&arms(&[5.0; 90], 0.04), &ARMS), LeadIn::default());
        assert_eq!(
            find(&arms(&[5.0; 90], 0.04), &[[9, 1], [2, 99]]),
            LeadIn::default()
        );
    }
}
