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

/// The part of a clip that a range names. Ranges count the frames that are shown: those of the resampled clip, without the
/// lead-in.
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
