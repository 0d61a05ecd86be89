//! Why there is no picture.

use std::io;

use crate::import::ImportError;

/// Why there is no picture. Messages go behind the name of the file.
#[derive(Debug, thiserror::Error)]
pub enum RenderError {
    /// The file cannot be read.
    #[error(transparent)]
    Import(#[from] ImportError),
    /// A picture without pixels, or with more than fit.
    #[error("cannot be drawn {0} by {1} pixels: each side may have 1 to {limit}", limit = super::SIZE_LIMIT)]
    Size(u32, u32),
    /// A clip that would be too many frames.
    #[error("would be {0} frames, more than the limit of {limit}: show a part of the clip, or fewer frames a second", limit = super::CLIP_FRAME_LIMIT)]
    TooManyFrames(f64),
    /// A strip that would have too many pixels.
    #[error("cannot be drawn as a strip of {0} by {1} pixels, more than {limit} in all: ask for fewer moments or a smaller size", limit = super::STRIP_LIMIT)]
    Strip(u64, u32),
    /// The work broke off.
    #[error("cannot be rendered: this is a bug in okoshi, please report it")]
    Broken,
}

impl From<RenderError> for io::Error {
    fn from(error: RenderError) -> Self {
        Self::other(error)
    }
}
