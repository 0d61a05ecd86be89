//! Prepares a clip for everything else: labels it, removes the lead-in, resamples to an even rate, cuts out a range, makes it a loop.
//!
//! A [`PreparedClip`] has the positions and the labels that belong to its clip. Built-in clips need no preparation.

mod lead_in;
mod looping;

use glam::DVec3;

use crate::clips::{self, BuiltIn, Legs};
use crate::labels::{Anatomy, Class, Facing, Side, label_clip};
use crate::mocap::UpAxis;
use crate::mocap::resample::{self, Error, FPS, Range};
use crate::mocap::travel::{self, Ending};
use crate::mocap::{Axis, Clip, JointId};
use crate::retarget::{self, Landmarks};

pub(crate) use lead_in::LeadInKind;
pub use lead_in::find_lead_in;
pub(crate) use looping::Cycle;
use looping::looped;

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
    /// Whether the best cycle is made a loop.
    pub is_loop: bool,
    /// Whether the body stays in place.
    pub is_in_place: bool,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            fps: FPS,
            lead_in: LeadInPolicy::Drop,
            range: None,
            up: None,
            is_loop: false,
            is_in_place: false,
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
    /// Whether its numbers differ from those in the file, because it was resampled, made a loop or put in place.
    pub is_changed: bool,
    /// What its joints are.
    pub anatomy: Anatomy,
    /// The axis of the clip's world that points up, if a person names it.
    pub up: Option<UpAxis>,
    /// Whether it ends in the pose in which it begins.
    pub ending: Ending,
    /// The cycle that was made a loop, its frames counted from 0 before the others were removed.
    pub cycle: Option<Cycle>,
    /// What was done to it, for people to read.
    pub notes: Vec<String>,
}

/// A built-in clip. It has 24 frames a second, no lead-in, and is a loop.
pub fn built_in(which: BuiltIn, legs: Legs) -> PreparedClip {
    let (clip, anatomy) = clips::clip(which, legs);
    repeated(clip, anatomy)
}

/// The clip of a figure whose parts are moved without a skeleton: joints of these names, which stand still for so many frames.
pub(crate) fn of_parts(names: &[&str], frames: usize) -> PreparedClip {
    repeated(clips::still(names, frames), Anatomy::default())
}

fn repeated(clip: Clip, anatomy: Anatomy) -> PreparedClip {
    PreparedClip {
        positions: clip.positions(),
        clip,
        is_changed: false,
        anatomy,
        up: Some(UpAxis {
            axis: Axis::Y,
            is_negative: false,
        }),
        ending: Ending::Loop,
        cycle: None,
        notes: Vec::new(),
    }
}

/// Prepares a clip.
///
/// # Errors
/// Returns an error for a frame rate or a range that is not possible for the clip.
pub fn prepare(clip: Clip, options: &Options) -> Result<PreparedClip, Error> {
    let anatomy = label_clip(&clip);
    let joints = clip.skeleton.joints.len();
    let positions = clip.positions();
    let mut notes = Vec::new();
    let first = match options.lead_in {
        LeadInPolicy::Drop => lead_in_frames(&clip, &positions, &anatomy, &mut notes),
        LeadInPolicy::Keep => 0,
    };
    let mut prepared = PreparedClip {
        clip,
        positions,
        is_changed: false,
        anatomy,
        up: options.up,
        ending: Ending::Open,
        cycle: None,
        notes,
    };
    if first > 0 {
        let frames = first..prepared.clip.frames;
        prepared.clip = prepared.clip.select_frames(frames);
        prepared.positions.drain(..first * joints);
    }
    prepared.change(options)
}

impl PreparedClip {
    /// The same clip at another rate, of a range of its frames, as a loop, in place, as far as the options ask for it.
    ///
    /// # Errors
    /// Returns an error for a frame rate or a range that is not possible for the clip.
    pub fn change(mut self, options: &Options) -> Result<Self, Error> {
        let joints = self.clip.skeleton.joints.len();
        let (frames, step) = (self.clip.frames, self.clip.frame_time);
        self.clip = resample::resample(self.clip, options.fps)?;
        // A clip that was not resampled keeps its positions.
        if (self.clip.frames, self.clip.frame_time) != (frames, step) {
            self.is_changed = true;
            self.positions = self.clip.positions();
        }
        if let Some(range) = options.range {
            self.clip = resample::range(&self.clip, range)?;
            self.positions.drain(..(range.first - 1) * joints);
            self.positions.truncate(self.clip.frames * joints);
            self.ending = Ending::Open;
        }
        if options.is_loop && self.ending == Ending::Open {
            match looped(&self.clip, &self.anatomy, self.up_direction()) {
                Some((clip, cycle)) => {
                    self.replace(clip);
                    self.ending = Ending::Loop;
                    self.cycle = Some(cycle);
                }
                None => self.notes.push(
                    "it is too short to be made a loop, which takes half a second: it is left as it is"
                        .to_owned(),
                ),
            }
        }
        if options.is_in_place {
            let hips = self.anatomy.hips.unwrap_or_default();
            let up = self.up_direction();
            self.replace(travel::in_place(&self.clip, hips, up, self.ending));
        }
        Ok(self)
    }

    fn replace(&mut self, clip: Clip) {
        self.positions = clip.positions();
        self.clip = clip;
        self.is_changed = true;
    }

    /// Another clip of the same skeleton, which was made from this one and need not end as it begins.
    #[must_use]
    pub(crate) fn replaced_by(mut self, clip: Clip) -> Self {
        if clip != self.clip {
            self.replace(clip);
            self.ending = Ending::Open;
        }
        self
    }

    /// What defines how the body is oriented.
    pub fn landmarks(&self) -> Landmarks {
        Landmarks {
            up: self.up,
            ..Landmarks::of(&self.anatomy)
        }
    }

    /// The axis of the clip's world that points up.
    fn up_direction(&self) -> DVec3 {
        retarget::to_drawing(&self.clip, &self.landmarks(), Facing::Viewer).inverse() * DVec3::Y
    }
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
    let arms: Vec<[JointId; 2]> = Side::BOTH.into_iter().filter_map(arm).collect();
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
