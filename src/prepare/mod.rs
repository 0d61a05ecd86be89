//! Prepares a clip for everything else: labels it, removes the lead-in, cuts out a range, resamples to an even rate, plays it faster or slower,
//! makes it a loop.
//!
//! A [`PreparedClip`] has the positions and the labels that belong to its clip. Built-in clips need no preparation.

mod in_turn;
mod lead_in;
mod looping;

use std::sync::Arc;

use glam::DVec3;

use crate::clips::{self, BuiltIn, Legs};
use crate::labels::{Anatomy, Class, Facing, Side, label_clip};
use crate::mocap::UpAxis;
use crate::mocap::bvh::MAX_NUMBERS;
use crate::mocap::resample::{self, Error, FPS, Range, TimeMap};
use crate::mocap::travel::{self, Ending};
use crate::mocap::{Axis, Clip, JointId};
use crate::retarget::{self, Landmarks};

use lead_in::LeadIn;
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
    /// Which frames to keep: frames of the clip as it was read, lead-in included.
    pub range: Option<Range>,
    /// How fast it is played, more than 0: 2 is twice as fast.
    pub speed: f64,
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
            speed: 1.0,
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

/// A clip that plays in turn with others.
#[derive(Debug, Clone)]
pub(crate) struct Turn {
    /// The clip.
    pub clip: PreparedClip,
    /// For how many seconds it plays: a loop as many whole cycles as come nearest to it, anything else once.
    pub seconds: Option<f64>,
}

/// Clips in turn, joined by blends of a quarter of a second, as one clip; in a loop the last one fades into the first. The body goes on from
/// where it is. Clips of another skeleton than the first one's are left out.
///
/// # Errors
/// [`Error::Frames`] if there would be more numbers than a clip may have.
pub(crate) fn in_turn(
    first: Turn,
    others: Vec<Turn>,
    is_loop: bool,
) -> Result<PreparedClip, Error> {
    let skeleton = Arc::clone(&first.clip.clip.skeleton);
    let mut turns = vec![first];
    let others = others.into_iter();
    turns.extend(others.filter(|turn| turn.clip.clip.skeleton == skeleton));
    let most = MAX_NUMBERS / skeleton.channel_count().max(1);
    let lengths = turns.iter().map(|turn| turn.playing().length());
    let frames = lengths.fold(1, usize::saturating_add);
    if frames > most {
        let wanted = frames as f64;
        return Err(Error::Frames { wanted, most });
    }
    let up = turns[0].clip.up_direction();
    let is_repeated = turns.len() == 1 && turns[0].clip.ending == Ending::Loop;
    let joined = in_turn::in_turn(&turns, is_loop, up);
    let mut clip = turns.swap_remove(0).clip;
    if joined != clip.clip {
        clip.replace(joined);
    }
    clip.ending = if is_loop || is_repeated {
        Ending::Loop
    } else {
        Ending::Open
    };
    Ok(clip)
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
    let mut options = *options;
    let from = options.range.map_or(1, |range| range.first);
    let first = match options.lead_in {
        LeadInPolicy::Drop => lead_in(&clip, &positions, &anatomy),
        LeadInPolicy::Keep => LeadIn::default(),
    };
    // A range that begins behind the lead-in leaves it out, and one within it asks for it.
    let is_asked_for = options
        .range
        .and_then(|range| range.last)
        .is_some_and(|last| last <= first.frames);
    let first = if from > first.frames || is_asked_for {
        0
    } else {
        notes.extend(first.note());
        first.frames
    };
    if first > 0
        && let Some(range) = &mut options.range
    {
        *range = range.without(first, clip.frames)?;
    }
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
    prepared.change(&options)
}

impl PreparedClip {
    /// The same clip at another rate, of a range of its frames, as a loop, in place, as far as the options ask for it.
    ///
    /// # Errors
    /// Returns an error for a frame rate or a range that is not possible for the clip.
    pub fn change(mut self, options: &Options) -> Result<Self, Error> {
        let joints = self.clip.skeleton.joints.len();
        if let Some(range) = options.range {
            self.clip = resample::range(&self.clip, range)?;
            self.positions.drain(..(range.first - 1) * joints);
            self.positions.truncate(self.clip.frames * joints);
            self.ending = Ending::Open;
        }
        let (frames, step) = (self.clip.frames, self.clip.frame_time);
        self.clip = resample::resample(self.clip, options.fps)?;
        // A clip that was not resampled keeps its positions.
        if (self.clip.frames, self.clip.frame_time) != (frames, step) {
            self.is_changed = true;
            self.positions = self.clip.positions();
        }
        let steps = steps_at(&self.clip, options.speed);
        if steps + 1 != self.clip.frames {
            let most = MAX_NUMBERS / self.clip.skeleton.channel_count().max(1);
            if steps >= most {
                let wanted = steps as f64 + 1.0;
                return Err(Error::Frames { wanted, most });
            }
            let map = TimeMap::through(&[[0, 0], [steps, self.clip.frames - 1]]);
            let clip = resample::along(&self.clip, &map);
            self.replace(clip);
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

/// How many steps from frame to frame a clip has if it is played so fast: at least one if it has any.
pub(crate) fn steps_at(clip: &Clip, speed: f64) -> usize {
    let steps = clip.frames.saturating_sub(1);
    let played = (steps as f64 / speed).round();
    // A number that is too large becomes the largest one.
    (played as usize).max(steps.min(1))
}

/// What comes before the motion.
fn lead_in(clip: &Clip, positions: &[DVec3], anatomy: &Anatomy) -> LeadIn {
    let arm = |side| {
        let arm = anatomy.limb(Class::Arm, side)?;
        Some([arm.upper, arm.end.or(arm.lower)?])
    };
    let arms: Vec<[JointId; 2]> = Side::BOTH.into_iter().filter_map(arm).collect();
    let joints = clip.skeleton.joints.len();
    find_lead_in(positions, joints, clip.frame_time, &arms)
}
