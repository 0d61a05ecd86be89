//! Arms of one segment on motions that live from the elbow.

use super::{Follow, Matching, Problem};
use crate::labels::{Anatomy, Class, FigurePartId, Limb, LimbSegment};
use crate::mocap::{Clip, Pose};

/// How many frames of a clip are looked at.
const FRAMES: usize = 64;
/// The end of an arm of one segment may be this far from where it should be, in the median, as a share of the arm's length.
const MAX_ERROR: f64 = 0.25;

/// The arms of one segment whose ends would be far from the actor's hands: the drawn arm is always stretched, the actor's elbow is
/// bent. `anatomy` belongs to the clip's skeleton.
pub(crate) fn bent_arms(matching: &Matching, clip: &Clip, anatomy: &Anatomy) -> Vec<Problem> {
    let is_stretched = |part: &FigurePartId| {
        let part = &matching.parts[*part];
        let follow = part.drive.map(|drive| drive.follow);
        let label = part.label.as_ref();
        follow == Some(Follow::Direction)
            && part.bones.is_empty()
            && label.is_some_and(|label| {
                (label.class, label.segment) == (Class::Arm, LimbSegment::Whole)
            })
    };
    let arms: Vec<FigurePartId> = matching.parts.keys().filter(is_stretched).collect();
    if arms.is_empty() || clip.frames == 0 {
        return Vec::new();
    }
    let count = clip.frames.min(FRAMES);
    let poses: Vec<Pose> = (0..count)
        .map(|index| clip.pose(index * clip.frames / count))
        .collect();
    let bent = arms.into_iter().filter_map(|part| {
        let matched = &matching.parts[part];
        let joint = matched.drive?.joint;
        let limb = anatomy
            .limbs
            .iter()
            .find(|limb| limb.class == Class::Arm && limb.upper == joint)?;
        let error = median_error(limb, &poses)?;
        (error > MAX_ERROR).then_some(Problem::BentArm { part, error })
    });
    bent.collect()
}

/// The median of the distance between the end of a stretched arm and the wrist, as a share of the arm's length; `None` for an arm
/// without an elbow.
fn median_error(limb: &Limb, poses: &[Pose]) -> Option<f64> {
    let (elbow, wrist) = (limb.lower?, limb.end?);
    let error = |pose: &Pose| {
        let [shoulder, elbow, wrist] = [limb.upper, elbow, wrist].map(|joint| pose[joint].position);
        let length = shoulder.distance(elbow) + elbow.distance(wrist);
        1.0 - shoulder.distance(wrist) / length
    };
    let mut errors: Vec<f64> = poses.iter().map(error).filter(|e| e.is_finite()).collect();
    errors.sort_by(f64::total_cmp);
    errors.get(errors.len() / 2).copied()
}
