//! Performances of a motion by itself, on its joints.

use glam::DVec3;
use typed_index_collections::{TiSlice, TiVec};

use crate::labels::{Class, Facing};
use crate::mark_tracks::{MarkId, MarkTracks};
use crate::mocap::{JointId, resample};
use crate::performance::{Limbs, Plan, Request, joint_steps, mark_movements, plan, ratios};
use crate::prepare::PreparedClip;
use crate::retarget::to_drawing;

/// A joint that a mark performs.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct JointChannel {
    /// The mark.
    pub mark: MarkId,
    /// The joint.
    pub joint: JointId,
    /// Joints that are edited along with it.
    pub followers: Vec<JointId>,
}

/// A motion as it is performed.
#[derive(Debug)]
pub(crate) struct PerformedClip {
    /// The motion, retimed and damped.
    pub prepared: PreparedClip,
    /// What was done to it.
    pub plan: Plan,
}

/// Performs a motion: its timing first, then its emphasis. Every index in `channels` must be valid.
pub(crate) fn perform(
    prepared: PreparedClip,
    tracks: &MarkTracks,
    channels: &[JointChannel],
    request: &Request,
) -> PerformedClip {
    let marks: Vec<MarkId> = channels.iter().map(|channel| channel.mark).collect();
    let input = mark_movements(tracks, &marks, 1.0 / prepared.clip.frame_time);
    let count = prepared.clip.skeleton.joints.len().max(1);
    let path = |joint: JointId| -> Vec<DVec3> {
        let frames = prepared.positions.chunks(count);
        let place = |frame: &[DVec3]| TiSlice::<JointId, DVec3>::from_ref(frame)[joint];
        frames.map(place).collect()
    };
    let paths: Vec<Vec<DVec3>> = channels.iter().map(|channel| path(channel.joint)).collect();
    let landmarks = prepared.landmarks();
    let steps = joint_steps(&paths, &path(landmarks.hips));
    let viewer = to_drawing(&prepared.clip, &landmarks, Facing::Viewer).inverse() * DVec3::Z;
    let plan = plan(input, &steps, viewer, request);
    let mut clip = match &plan.timing {
        Some(timing) => resample::along(&prepared.clip, timing),
        None => prepared.clip.clone(),
    };
    if let Some(emphasized) = plan.emphasized.filter(|_| plan.is_damping) {
        let joints = &prepared.clip.skeleton.joints;
        let parents: TiVec<JointId, _> = joints.iter().map(|joint| joint.parent).collect();
        let labels = prepared.anatomy.labels.iter();
        let classes: TiVec<JointId, Option<Class>> = labels
            .map(|label| label.as_ref().map(|label| label.class))
            .collect();
        let limbs = Limbs {
            parents: &parents,
            classes: &classes,
        };
        let nodes: Vec<Vec<JointId>> = channels.iter().map(|channel| vec![channel.joint]).collect();
        let followers: Vec<Vec<JointId>> = channels
            .iter()
            .map(|channel| channel.followers.clone())
            .collect();
        let ratios = ratios(
            &limbs,
            &nodes,
            &followers,
            &plan.largest_inputs(),
            emphasized,
        );
        clip = resample::damped(&clip, &ratios);
    }
    PerformedClip {
        prepared: prepared.replaced_by(clip),
        plan,
    }
}
