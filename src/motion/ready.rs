//! What happens to a clip before anything else: a lead-in is left out, it gets an even rate, a part of it is taken.

use glam::DVec3;

use super::labels::{Anatomy, Class, Side, label_clip};
use super::lead::{self, Kind};
use super::resample::{self, Error, Range};
use super::skeleton::Clip;

/// Frames a second of hand-drawn animation.
pub const FPS: f64 = 24.0;

/// What becomes of a T-pose that a clip begins with.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum LeadIn {
    /// It is left out.
    #[default]
    Drop,
    /// It stays.
    Keep,
}

/// How a clip is made ready.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Options {
    /// Frames a second that it gets.
    pub fps: f64,
    /// What becomes of its lead-in.
    pub lead_in: LeadIn,
    /// Which of its frames are taken, counted at the new rate and without the lead-in.
    pub range: Option<Range>,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            fps: FPS,
            lead_in: LeadIn::Drop,
            range: None,
        }
    }
}

/// A clip that is ready.
#[derive(Debug, Clone)]
pub struct Ready {
    /// The clip.
    pub clip: Clip,
    /// Where its joints are: frames × joints, the file's unit.
    pub positions: Vec<DVec3>,
    /// Whether its numbers are others than in the file, since its rate was.
    pub is_resampled: bool,
    /// What its joints are.
    pub anatomy: Anatomy,
    /// What was done to it that people should know of.
    pub notes: Vec<String>,
}

/// Makes a clip ready.
///
/// # Errors
/// A rate or a range that the clip cannot have.
pub fn ready(clip: Clip, options: &Options) -> Result<Ready, Error> {
    let anatomy = label_clip(&clip);
    let joints = clip.skeleton.joints.len();
    let mut positions = clip.positions();
    let mut notes = Vec::new();
    let first = match options.lead_in {
        LeadIn::Drop => lead_in(&clip, &positions, &anatomy, &mut notes),
        LeadIn::Keep => 0,
    };
    let clip = match first {
        0 => clip,
        first => clip.picked(first..clip.frames()),
    };
    positions.drain(..first * joints);
    let (frames, step) = (clip.frames(), clip.frame_time);
    let mut clip = resample::resample(clip, options.fps)?;
    let is_resampled = (clip.frames(), clip.frame_time) != (frames, step);
    // What stayed as it was has the positions that it had.
    if is_resampled {
        positions = clip.positions();
    }
    if let Some(range) = options.range {
        clip = resample::range(&clip, range)?;
        positions.drain(..(range.first - 1) * joints);
        positions.truncate(clip.frames() * joints);
    }
    Ok(Ready {
        clip,
        positions,
        is_resampled,
        anatomy,
        notes,
    })
}

/// How many first frames are no motion.
fn lead_in(clip: &Clip, positions: &[DVec3], anatomy: &Anatomy, notes: &mut Vec<String>) -> usize {
    let arm = |side| {
        let arm = anatomy.limb(Class::Arm, side)?;
        Some([arm.upper, arm.end.or(arm.lower)?])
    };
    let arms: Vec<[usize; 2]> = Side::BOTH.into_iter().filter_map(arm).collect();
    let joints = clip.skeleton.joints.len();
    let lead = lead::lead_of_positions(positions, joints, clip.frame_time, &arms);
    match lead.kind {
        Kind::None => {}
        Kind::Single => notes.push(
            "frame 1 is a pose that the motion jumps out of, as files often begin: it is left out"
                .to_owned(),
        ),
        Kind::Eased => notes.push(format!(
            "frames 1 to {} lead out of a T-pose, as files often begin: they are left out",
            lead.frames
        )),
    }
    lead.frames
}
