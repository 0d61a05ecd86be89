//! Prepares a clip for everything else: removes the lead-in, resamples to an even rate, cuts out a range.

use glam::DVec3;

use super::labels::{Anatomy, Class, Side, label_clip};
use super::lead_in::{LeadInKind, find_lead_in};

use super::resample::{self, Error, Range};
use super::skeleton::Clip;
use super::up::UpAxis;

/// Frames per second of hand-drawn animation.
pub const FPS: f64 = 24.0;

/// What to do with the T-pose that many clips begin with.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum LeadInPolicy {
    /// Remove it.
    #[default]
    Drop,
    /// Keep it.
    Keep,
}

/// How to prepare a clip.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Options {
    /// Frames per second of the result.
    pub fps: f64,
    /// What to do with the lead-in.
    pub lead_in: LeadInPolicy,
    /// Which frames to keep, counted at the new rate and after the lead-in was removed.
    pub range: Option<Range>,
    /// The axis of the clip's world that points up; `None` to find it.
    pub up: Option<UpAxis>,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            fps: FPS,
            lead_in: LeadInPolicy::Drop,
            range: None,
            up: None,
        }
    }
}

/// A prepared clip.
#[derive(Debug, Clone)]
pub struct PreparedClip {
    /// The clip.
    pub clip: Clip,
    /// Joint positions: frames × joints, in the file's unit.
    pub positions: Vec<DVec3>,
    /// Whether its numbers differ from those in the file because it was resampled.
    pub is_resampled: bool,
    /// What its joints are.
    pub anatomy: Anatomy,
    /// The axis of the clip's world that points up, if a person names it.
    pub up: Option<UpAxis>,
    /// What was done to it, for people to read.
    pub notes: Vec<String>,
}

/// Prepares a clip.
///
/// # Errors
/// Returns an error for a frame rate or a range that is not possible for the clip.
pub fn prepare(clip: Clip, options: &Options) -> Result<PreparedClip, Error> {
    let anatomy = label_clip(&clip);
    let joints = clip.skeleton.joints.len();
    let mut positions = clip.positions();
    let mut notes = Vec::new();
    let first = match options.lead_in {
        LeadInPolicy::Drop => lead_in_frames(&clip, &positions, &anatomy, &mut notes),
        LeadInPolicy::Keep => 0,
    };
    let clip = match first {
        0 => clip,
        first => clip.select_frames(first..clip.frames()),
    };
    positions.drain(..first * joints);
    let (frames, step) = (clip.frames(), clip.frame_time);
    let mut clip = resample::resample(clip, options.fps)?;
    let is_resampled = (clip.frames(), clip.frame_time) != (frames, step);
    // A clip that was not resampled keeps its positions.
    if is_resampled {
        positions = clip.positions();
    }
    if let Some(range) = options.range {
        clip = resample::range(&clip, range)?;
        positions.drain(..(range.first - 1) * joints);
        positions.truncate(clip.frames() * joints);
    }
    Ok(PreparedClip {
        clip,
        positions,
        is_resampled,
        anatomy,
        up: options.up,
        notes,
    })
}

/// The number of frames before the motion begins.
fn lead_in_frames(
    clip: &Clip,
    positions: &[DVec3],
    anatomy: &Anatomy,
    notes: &mut Vec<String>,
) -> usize {
    let arm = |side| {
        let arm = anatomy.limb(Class::Arm, side)?;
        Some([arm.upper, arm.end.or(arm.lower)?])
    };
    let arms: Vec<[usize; 2]> = Side::BOTH.into_iter().filter_map(arm).collect();
    let joints = clip.skeleton.joints.len();
    let lead_in = find_lead_in(positions, joints, clip.frame_time, &arms);
    match lead_in.kind {
        LeadInKind::None => {}
        LeadInKind::Single => notes.push(
            "frame 1 is a pose that the motion jumps out of, as files often begin: it is left out"
                .to_owned(),
        ),
        LeadInKind::Eased => notes.push(format!(
            "frames 1 to {} lead out of a T-pose, as files often begin: they are left out",
            lead_in.frames
        )),
    }
    lead_in.frames
}
