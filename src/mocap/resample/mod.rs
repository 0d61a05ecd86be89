//! Changes the frame rate of a clip, and cuts out ranges.
//!
//! The thesis works at 24 frames a second (section 5.2.1). Rotations are interpolated by slerp (Shoemake 1985) and converted
//! back to each joint's own channels by Euler-angle extraction, so that the result has the skeleton that was read.

mod damped;
mod euler;
mod range;
#[cfg(test)]
mod tests;
mod time_map;

use std::sync::Arc;

use rayon::prelude::*;

use crate::mocap::Clip;
use crate::mocap::bvh::MAX_NUMBERS;

pub(crate) use damped::damped;
use euler::RotationTrack;
pub(crate) use range::{Outside, Range, parse_range, range};
pub use time_map::TimeMap;

/// Frames per second of hand-drawn animation.
pub(crate) const FPS: f64 = 24.0;

/// A clip whose rate differs from the requested one by at most this fraction keeps its rate.
const RATE_TOLERANCE: f64 = 0.005;

/// A rate that differs from an integer by at most this fraction is rounded to it: frame times have few digits (0.033333 is 30
/// frames a second), and rates such as 29.97 differ by more.
const ROUNDING_TOLERANCE: f64 = 1e-4;

/// The frame rates that can be requested: those whose frame times a file can hold.
const RATES: std::ops::RangeInclusive<f64> = 0.1..=1e5;

/// Why a clip cannot be resampled or cut.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum Error {
    /// An impossible frame rate.
    #[error("{0} is not a possible frame rate: use {least} to {most} frames a second", least = RATES.start(), most = RATES.end())]
    Rate(f64),
    /// More frames than allowed.
    #[error("{wanted} frames at that rate, but {most} are the limit for this skeleton")]
    Frames {
        /// How many there would be.
        wanted: f64,
        /// How many are allowed.
        most: usize,
    },
    /// A text that is not a range of frames.
    #[error(
        "`{0}` is not a range of frames: write first:last, counted from 1, such as 10:48, 10: or :48"
    )]
    NotARange(String),
    /// A range that ends before it begins: first, last.
    #[error("the range {0}:{1} ends before it begins")]
    Backwards(usize, usize),
    /// The frame before the first one.
    #[error("there is no frame 0: the first is 1")]
    FrameZero,
    /// A frame that does not exist.
    #[error("there is no frame {frame}: the clip has {frames}")]
    NoFrame {
        /// The frame, counted from 1.
        frame: usize,
        /// The number of frames of the clip.
        frames: usize,
    },
}

/// The frame rate for a frame time.
pub(crate) fn rate(frame_time: f64) -> f64 {
    let rate = 1.0 / frame_time;
    let whole = rate.round();
    if whole > 0.0 && (rate / whole - 1.0).abs() <= ROUNDING_TOLERANCE {
        whole
    } else {
        rate
    }
}

/// Resamples a clip to another frame rate. The first frame stays at time 0; the last one is the last that does not lie after
/// the clip's end. Positions are interpolated linearly, rotations by slerp along the shorter arc. Angles are continuous in
/// time. A joint whose channels cannot express every rotation (one or two, the same axis twice in a row, more than three) has
/// its angles interpolated separately, each by the shorter way. A clip within 0.5 % of the rate, or with fewer than two frames,
/// is returned unchanged.
///
/// # Errors
/// [`Error::Rate`] for an impossible frame rate, [`Error::Frames`] if the clip would have more numbers than [`MAX_NUMBERS`].
pub fn resample(clip: Clip, fps: f64) -> Result<Clip, Error> {
    if !RATES.contains(&fps) {
        return Err(Error::Rate(fps));
    }
    let own = rate(clip.frame_time);
    let stays = (own / fps - 1.0).abs() <= RATE_TOLERANCE
        || (1.0 / clip.frame_time / fps - 1.0).abs() <= RATE_TOLERANCE;
    if clip.frames < 2 || !own.is_finite() || own <= 0.0 || stays {
        return Ok(clip);
    }
    let last = clip.frames - 1;
    let width = clip.skeleton.channel_count();
    let most = MAX_NUMBERS / width.max(1);
    let wanted = (last as f64 * fps / own + 1e-9).floor() + 1.0;
    if wanted > most as f64 {
        return Err(Error::Frames { wanted, most });
    }
    let place = |sample: usize| {
        let place = sample as f64 * own / fps;
        let frame = (place as usize).min(last);
        let t = if frame == last {
            0.0
        } else {
            place - frame as f64
        };
        Mix {
            from: frame,
            to: (frame + 1).min(last),
            t,
        }
    };
    Ok(Clip::new(
        Arc::clone(&clip.skeleton),
        1.0 / fps,
        values(&clip, wanted as usize, &place),
    ))
}

/// A pose between those of two frames.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Mix {
    /// The first frame.
    pub from: usize,
    /// The second frame.
    pub to: usize,
    /// How far it is on the way from the first to the second, 0 to 1.
    pub t: f64,
}

/// The clip that consists of these poses, at the same rate. The first one must be a frame of the clip (its `t` is 0). Positions and
/// rotations are interpolated as by [`resample`].
pub(crate) fn mixed(clip: &Clip, mixes: &[Mix]) -> Clip {
    Clip::new(
        Arc::clone(&clip.skeleton),
        clip.frame_time,
        values(clip, mixes.len(), &|sample| mixes[sample]),
    )
}

/// A clip played along a map of time, at the same rate. Poses are interpolated as by [`resample`]; where a frame of the result is one of
/// the clip, its angles are the very same but for whole turns.
pub(crate) fn along(clip: &Clip, map: &TimeMap) -> Clip {
    mixed(clip, &map.places)
}

/// The channels of a joint, and their numbers in some of the new frames.
struct JointChannels {
    track: RotationTrack,
    /// The index of its first channel, and the number of its channels.
    start: usize,
    count: usize,
    numbers: Vec<f64>,
}

/// The numbers of the new frames. Processed in blocks of frames, and joint by joint within a block, because each angle depends
/// on the one before.
fn values(clip: &Clip, count: usize, place: &(dyn Fn(usize) -> Mix + Sync)) -> Vec<f64> {
    /// New frames per block: they and the old ones stay in the processor's cache while all joints are processed.
    const GRAIN: usize = 512;

    let width = clip.skeleton.channel_count();
    if count == 0 || width == 0 {
        return Vec::new();
    }
    let first = clip.row(place(0).from);
    let mut columns = Vec::with_capacity(clip.skeleton.joints.len());
    let mut start = 0;
    for joint in &clip.skeleton.joints {
        let count = joint.channels.len();
        columns.push(JointChannels {
            track: RotationTrack::new(&joint.channels, &first[start..start + count]),
            start,
            count,
            numbers: Vec::new(),
        });
        start += count;
    }
    let mut values = vec![0.0; count * width];
    for (chunk, rows) in values.chunks_mut(GRAIN * width).enumerate() {
        let first = chunk * GRAIN;
        let part = first..first + rows.len() / width;
        columns
            .par_iter_mut()
            .for_each(|column| column.fill(clip, place, part.clone()));
        for (sample, row) in rows.chunks_mut(width).enumerate() {
            for column in &columns {
                let JointChannels {
                    start,
                    count,
                    numbers,
                    ..
                } = column;
                row[*start..start + count].copy_from_slice(&numbers[sample * count..][..*count]);
            }
        }
    }
    values
}

impl JointChannels {
    /// Computes the numbers of some samples, which continue those before.
    fn fill(
        &mut self,
        clip: &Clip,
        place: &(dyn Fn(usize) -> Mix + Sync),
        part: std::ops::Range<usize>,
    ) {
        let columns = self.start..self.start + self.count;
        self.numbers.clear();
        for sample in part {
            let Mix {
                from: frame,
                to: next,
                t,
            } = place(sample);
            let (from, to) = (
                &clip.row(frame)[columns.clone()],
                &clip.row(next)[columns.clone()],
            );
            let start = self.numbers.len();
            self.numbers
                .extend(from.iter().zip(to).map(|(from, to)| from + (to - from) * t));
            if sample > 0 {
                self.track
                    .rotations([(frame, from), (next, to)], t, &mut self.numbers[start..]);
            }
        }
    }
}
