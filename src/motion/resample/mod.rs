//! Another frame rate, and parts of a clip.
//!
//! The thesis works at 24 frames a second (section 5.2.1). Rotations go by slerp (Shoemake 1985) and back to each joint's own
//! angles, so that what is written has the skeleton that was read.

mod euler;
mod range;
#[cfg(test)]
mod tests;

use std::fmt;
use std::sync::Arc;

use rayon::prelude::*;

use super::bvh::MOST_NUMBERS;
use super::skeleton::Clip;

use euler::Track;
pub use range::{Range, parse_range, range};

/// How far a clip's rate may be from the wanted one to be left as it is, as a fraction.
const AS_IT_IS: f64 = 0.005;

/// How far a rate may be from a whole one to be taken for it, as a fraction: frame times are written with few digits (0.033333
/// is 30 frames a second), and rates such as 29.97 are farther off.
const WHOLE_WITHIN: f64 = 1e-4;

/// The rates that can be asked for, frames a second: those whose frame times a file can hold.
const RATES: std::ops::RangeInclusive<f64> = 0.1..=1e5;

/// Why a clip cannot be brought to another rate, or cut.
#[derive(Debug, Clone, PartialEq)]
pub enum Error {
    /// The rate makes no sense.
    Rate(f64),
    /// There would be so many frames, and only so many are allowed.
    Frames {
        /// How many there would be.
        wanted: f64,
        /// How many there may be.
        most: usize,
    },
    /// A text that is no range of frames.
    NotARange(String),
    /// The range ends before it begins: first, last.
    Backwards(usize, usize),
    /// A frame that is not there, in a clip of so many.
    NoFrame {
        /// The frame, from 1.
        frame: usize,
        /// How many there are.
        frames: usize,
    },
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Rate(fps) => write!(
                f,
                "{fps} is no frame rate: it takes {} to {} frames a second",
                RATES.start(),
                RATES.end()
            ),
            Self::Frames { wanted, most } => write!(
                f,
                "{wanted} frames at that rate, but {most} are the limit for this skeleton"
            ),
            Self::NotARange(text) => {
                write!(
                    f,
                    "`{text}` is no range of frames: write first:last, counted from 1, such as 10:48, 10: or :48"
                )
            }
            Self::Backwards(first, last) => {
                write!(f, "the range {first}:{last} ends before it begins")
            }
            Self::NoFrame { frame: 0, .. } => write!(f, "there is no frame 0: the first is 1"),
            Self::NoFrame { frame, frames } => {
                write!(f, "there is no frame {frame}: the clip has {frames}")
            }
        }
    }
}

impl std::error::Error for Error {}

/// The frames a second that a frame time stands for.
pub fn rate(frame_time: f64) -> f64 {
    let rate = 1.0 / frame_time;
    let whole = rate.round();
    if whole > 0.0 && (rate / whole - 1.0).abs() <= WHOLE_WITHIN {
        whole
    } else {
        rate
    }
}

/// Brings a clip to another rate, frames a second. The first frame stays at time 0, the last is the last that does not lie behind
/// the clip's own; positions go straight, rotations by slerp along the shorter way. Angles are continuous in time. Where they
/// cannot express each rotation (one or two, the same axis twice in a row, more than three) they are led over by themselves, by
/// the shorter way. A clip within 0.5 % of the rate, or with fewer than two frames, stays bit for bit as it is.
///
/// # Errors
/// [`Error::Rate`] for a rate that makes no sense, [`Error::Frames`] where the clip would have more numbers than
/// [`MOST_NUMBERS`].
pub fn resample(clip: Clip, fps: f64) -> Result<Clip, Error> {
    if !RATES.contains(&fps) {
        return Err(Error::Rate(fps));
    }
    let own = rate(clip.frame_time);
    let stays = (own / fps - 1.0).abs() <= AS_IT_IS
        || (1.0 / clip.frame_time / fps - 1.0).abs() <= AS_IT_IS;
    if clip.frames() < 2 || !own.is_finite() || own <= 0.0 || stays {
        return Ok(clip);
    }
    let last = clip.frames() - 1;
    let width = clip.skeleton.width();
    let most = MOST_NUMBERS / width.max(1);
    let wanted = (last as f64 * fps / own + 1e-9).floor() + 1.0;
    if wanted > most as f64 {
        return Err(Error::Frames { wanted, most });
    }
    let samples = Samples {
        count: wanted as usize,
        last,
        own,
        fps,
    };
    Ok(Clip::new(
        Arc::clone(&clip.skeleton),
        1.0 / fps,
        values(&clip, &samples),
    ))
}

/// Where the new frames lie among the old ones.
struct Samples {
    count: usize,
    last: usize,
    own: f64,
    fps: f64,
}

impl Samples {
    /// The frame before a sample, and how far it is to the next: below 1.
    fn place(&self, sample: usize) -> (usize, f64) {
        let place = sample as f64 * self.own / self.fps;
        let frame = (place as usize).min(self.last);
        (
            frame,
            if frame == self.last {
                0.0
            } else {
                place - frame as f64
            },
        )
    }
}

/// A joint, and its numbers in some new frames.
struct Column {
    track: Track,
    /// The first of its numbers in a frame, and how many they are.
    start: usize,
    count: usize,
    numbers: Vec<f64>,
}

/// The numbers of the new frames: some frames at a time, in these joint by joint, since angles follow on each other.
fn values(clip: &Clip, samples: &Samples) -> Vec<f64> {
    /// New frames at a time: they and the old ones stay in the cache while joint after joint goes over them.
    const GRAIN: usize = 512;

    let mut columns = Vec::with_capacity(clip.skeleton.joints.len());
    let mut start = 0;
    for joint in &clip.skeleton.joints {
        let count = joint.channels.len();
        columns.push(Column {
            track: Track::new(&joint.channels, &clip.row(0)[start..start + count]),
            start,
            count,
            numbers: Vec::new(),
        });
        start += count;
    }
    let width = clip.skeleton.width();
    let mut values = vec![0.0; samples.count * width];
    for (chunk, rows) in values.chunks_mut(GRAIN * width).enumerate() {
        let first = chunk * GRAIN;
        let part = first..first + rows.len() / width;
        columns
            .par_iter_mut()
            .for_each(|column| column.fill(clip, samples, part.clone()));
        for (sample, row) in rows.chunks_mut(width).enumerate() {
            for column in &columns {
                let Column {
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

impl Column {
    /// Works out the numbers of some samples, which follow on those before.
    fn fill(&mut self, clip: &Clip, samples: &Samples, part: std::ops::Range<usize>) {
        let columns = self.start..self.start + self.count;
        self.numbers.clear();
        for sample in part {
            let (frame, t) = samples.place(sample);
            let next = (frame + 1).min(samples.last);
            let (from, to) = (
                &clip.row(frame)[columns.clone()],
                &clip.row(next)[columns.clone()],
            );
            let place = self.numbers.len();
            self.numbers
                .extend(from.iter().zip(to).map(|(from, to)| from + (to - from) * t));
            if sample > 0 {
                self.track
                    .rotations([(frame, from), (next, to)], t, &mut self.numbers[place..]);
            }
        }
    }
}
