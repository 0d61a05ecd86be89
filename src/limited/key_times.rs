//! The keys of a clip, as animations have them.

use std::sync::Arc;

use crate::limited::Exposure;
use crate::scene::{Interpolation, Timing};

/// The keys of an animation: their times, and the frames that they show.
#[derive(Debug, Clone)]
pub struct KeyTimes {
    timing: Arc<Timing>,
    /// Per key the frame of the clip.
    pub frames: Vec<usize>,
}

impl KeyTimes {
    /// The keys of a clip of so many frames: as an exposure sheet says, or one for every frame without it.
    pub fn new(sheet: Option<&Exposure>, frames: usize, frame_time: f64) -> Self {
        match sheet {
            Some(sheet) => Self::stepped(sheet, frame_time),
            None => Self::full(frames, frame_time),
        }
    }

    /// A key for each frame that is shown: of what moves past held drawings, too.
    pub fn of_shown(sheet: Option<&Exposure>, frames: usize, frame_time: f64) -> Self {
        match sheet {
            Some(sheet) => Self::every_shown(sheet.len(), frame_time),
            None => Self::full(frames, frame_time),
        }
    }

    /// A key for every frame, interpolated linearly.
    pub fn full(frames: usize, frame_time: f64) -> Self {
        Self {
            timing: Arc::new(Timing {
                times: (0..frames)
                    .map(|frame| (frame as f64 * frame_time) as f32)
                    .collect(),
                interpolation: Interpolation::Linear,
            }),
            frames: (0..frames).collect(),
        }
    }

    /// A key for every drawing of an exposure sheet, held until the next one, and one that closes the clip.
    fn stepped(exposure: &Exposure, frame_time: f64) -> Self {
        Self::held(exposure.step_keys(), frame_time)
    }

    /// A key for every one of so many shown frames, held until the next one, and one that closes the clip. Their frames are those that
    /// are shown, counted from 0.
    fn every_shown(shown: usize, frame_time: f64) -> Self {
        let keys = (0..shown).map(|frame| [frame; 2]);
        let closing = shown.checked_sub(1).map(|last| [shown, last]);
        Self::held(keys.chain(closing).collect(), frame_time)
    }

    /// Keys at some frames, each with the frame that is shown from there on.
    fn held(keys: Vec<[usize; 2]>, frame_time: f64) -> Self {
        let time = |frame: usize| (frame as f64 * frame_time) as f32;
        let keys = keys.into_iter();
        let (times, frames) = keys.map(|[frame, source]| (time(frame), source)).unzip();
        Self {
            timing: Arc::new(Timing {
                times,
                interpolation: Interpolation::Step,
            }),
            frames,
        }
    }

    /// Whether they are the frames of a clip of so many, each once.
    pub(crate) fn are_frames(&self, count: usize) -> bool {
        self.frames.iter().copied().eq(0..count)
    }

    /// Their times.
    pub fn timing(&self) -> Arc<Timing> {
        Arc::clone(&self.timing)
    }

    /// Per key the value of its frame.
    pub fn of<T: Copy>(&self, values: &[T]) -> impl Iterator<Item = T> {
        self.frames.iter().map(|frame| values[*frame])
    }
}
