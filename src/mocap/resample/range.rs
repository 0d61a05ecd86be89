//! Ranges of frames.

use crate::mocap::Clip;

use super::Error;

/// A range of frames as animators write it: counted from 1, including the last one.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Range {
    /// The first frame.
    pub first: usize,
    /// The last frame; `None` for the clip's last.
    pub last: Option<usize>,
}

/// A range that reaches beyond the end of a clip. Seconds of the clip.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Outside {
    /// The time that the clip does not have.
    pub(crate) asked: f64,
    /// Its length.
    pub(crate) seconds: f64,
    /// Whether it is the beginning, so that nothing is left.
    pub(crate) is_beginning: bool,
}

impl Range {
    /// The frames of a clip from one time to another, seconds from its beginning, as far as these are given; and what of that the clip does not have.
    pub(crate) fn of_seconds(
        clip: &Clip,
        cut: [Option<f64>; 2],
    ) -> (Option<Self>, Option<Outside>) {
        // Times are rarely written more precisely than this.
        const PRECISION: f64 = 5e-3;
        let last = clip.frames.saturating_sub(1);
        let seconds = last as f64 * clip.frame_time;
        let outside = |asked: Option<f64>, is_beginning| {
            let asked = asked.filter(|asked| *asked > seconds + clip.frame_time.max(PRECISION))?;
            Some(Outside {
                asked,
                seconds,
                is_beginning,
            })
        };
        let [from, to] = cut;
        let outside = outside(from, true).or_else(|| outside(to, false));
        if from.is_none() && to.is_none() {
            return (None, outside);
        }
        let frame = |time: f64| ((time / clip.frame_time).round() as usize).min(last);
        let first = from.map_or(0, frame);
        let range = Self {
            first: first + 1,
            // At least one step, where there is one.
            last: to.map(|to| frame(to).max(first + 1).min(last) + 1),
        };
        (Some(range), outside)
    }

    /// The same frames of a clip of so many `frames`, counted without the first `left_out`, before which it does not end.
    ///
    /// # Errors
    /// [`Error::NoFrame`] for a frame after the clip's last, as it was counted before.
    pub(crate) fn without(self, left_out: usize, frames: usize) -> Result<Self, Error> {
        match self.last {
            Some(frame) if frame > frames => Err(Error::NoFrame { frame, frames }),
            last => Ok(Self {
                first: self.first.saturating_sub(left_out).max(1),
                last: last.map(|last| last - left_out),
            }),
        }
    }
}

/// Parses `first:last`, `first:` or `:last`.
///
/// # Errors
/// [`Error::NotARange`], [`Error::Backwards`], and [`Error::NoFrame`] for frame 0.
pub(crate) fn parse_range(text: &str) -> Result<Range, Error> {
    let wrong = || Error::NotARange(text.chars().take(40).collect());
    let number = |text: &str| match text.trim() {
        "" => Ok(None),
        digits if digits.bytes().all(|b| b.is_ascii_digit()) => {
            digits.parse::<usize>().map(Some).map_err(|_| wrong())
        }
        _ => Err(wrong()),
    };
    let (first, last) = text.split_once(':').ok_or_else(wrong)?;
    let (first, last) = (number(first)?, number(last)?);
    if first.is_none() && last.is_none() {
        return Err(wrong());
    }
    if first == Some(0) || last == Some(0) {
        return Err(Error::FrameZero);
    }
    let first = first.unwrap_or(1);
    match last {
        Some(last) if last < first => Err(Error::Backwards(first, last)),
        last => Ok(Range { first, last }),
    }
}

/// The part of a clip that a range names.
///
/// # Errors
/// [`Error::NoFrame`] for a frame after the clip's last, and for frame 0; [`Error::Backwards`].
pub(crate) fn range(clip: &Clip, range: Range) -> Result<Clip, Error> {
    let frames = clip.frames;
    let last = range.last.unwrap_or(frames.max(range.first));
    for frame in [range.first, last] {
        if frame == 0 {
            return Err(Error::FrameZero);
        }
        if frame > frames {
            return Err(Error::NoFrame { frame, frames });
        }
    }
    if last < range.first {
        return Err(Error::Backwards(range.first, last));
    }
    Ok(clip.select_frames(range.first - 1..last))
}
