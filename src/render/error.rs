//! Errors of rendering.

use std::io;

use crate::crash::Crash;
use crate::import::ImportError;

/// Why a picture cannot be rendered. Messages follow the name of the file.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum RenderError {
    /// The file cannot be read.
    #[error(transparent)]
    Import(#[from] ImportError),
    /// A width or height out of range.
    #[error("cannot be drawn {0} by {1} pixels: each side may have 1 to {limit}", limit = super::MAX_SIDE)]
    Size(u32, u32),
    /// A clip with too many frames.
    #[error("would be {0} frames, more than the limit of {limit}: show a part of the clip, or fewer frames a second", limit = super::MAX_CLIP_FRAMES)]
    TooManyFrames(f64),
    /// A film strip with too many pixels.
    #[error("cannot be drawn as a strip of {0} by {1} pixels, more than {limit} in all: ask for fewer moments or a smaller size", limit = super::MAX_FILM_STRIP_PIXELS)]
    FilmStripTooLarge(u64, u32),
    /// A camera whose node has a scale of zero, or numbers that are not finite.
    #[error("has a camera `{0}` without a place or direction: the scale of its node may not be 0")]
    CameraPose(String),
    /// Rendering panicked.
    #[error("cannot be rendered: {0}; {help}", help = crate::crash::HELP)]
    Crash(#[from] Crash),
    /// The pixels do not fit the size of the picture.
    #[error("cannot be rendered: {help}", help = crate::crash::HELP)]
    Broken,
}

impl From<RenderError> for io::Error {
    fn from(error: RenderError) -> Self {
        Self::other(error)
    }
}
