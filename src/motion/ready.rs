//! What happens to a clip before anything else: a lead-in is left out, it gets an even rate, a part of it is taken.

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
    let mut notes = Vec::new();
    let mut clip = match options.lead_in {
        LeadIn::Drop => without_lead_in(clip, &anatomy, &mut notes),
        LeadIn::Keep => clip,
    };
    clip = resample::resample(clip, options.fps)?;
    if let Some(range) = options.range {
        clip = resample::range(&clip, range)?;
    }
    Ok(Ready {
        clip,
        anatomy,
        notes,
    })
}

fn without_lead_in(clip: Clip, anatomy: &Anatomy, notes: &mut Vec<String>) -> Clip {
    let arm = |side| {
        let arm = anatomy.limb(Class::Arm, side)?;
        Some([arm.upper, arm.end.or(arm.lower)?])
    };
    let arms: Vec<[usize; 2]> = Side::BOTH.into_iter().filter_map(arm).collect();
    let lead = lead::lead(&clip, &arms);
    match lead.kind {
        Kind::None => clip,
        Kind::Single => {
            notes.push("frame 1 is a pose that the motion jumps out of, as files often begin: it is left out".to_owned());
            clip.picked(1..clip.frames())
        }
        Kind::Eased => {
            let frames = lead.frames;
            notes.push(format!(
                "frames 1 to {frames} lead out of a T-pose, as files often begin: they are left out"
            ));
            clip.picked(frames..clip.frames())
        }
    }
}
