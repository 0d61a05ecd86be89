//! Why there is no picture.

use std::io;

use crate::resolver::LinkError;

/// Why there is no picture. Messages go behind the name of the file.
#[derive(Debug, thiserror::Error)]
pub enum RenderError {
    /// The bytes are no glTF, or break its rules.
    #[error("is no glTF that can be read: {0}; export it again, or ask the Khronos glTF validator")]
    Malformed(String),
    /// It needs an extension of glTF that is not known here.
    #[error("needs the glTF extension `{0}`, which okoshi does not know; export it without")]
    Extension(String),
    /// A file that it links to cannot be had.
    #[error("links to `{link}`, which {error}")]
    Link {
        /// As the file names it.
        link: String,
        /// What is wrong with it.
        error: LinkError,
    },
    /// An image cannot be decoded.
    #[error("has an image that cannot be read ({0}); PNG and JPEG can")]
    Image(String),
    /// No triangle to be seen.
    #[error("has no triangles: there is nothing to see")]
    Empty,
    /// More than [`TRIANGLE_LIMIT`](super::TRIANGLE_LIMIT) triangles.
    #[error("has {0} triangles, more than the limit of {limit}; draw it in pieces", limit = super::TRIANGLE_LIMIT)]
    TooManyTriangles(usize),
    /// A picture without pixels, or with more than fit.
    #[error("cannot be drawn {0} by {1} pixels: each side may have 1 to {limit}", limit = super::SIZE_LIMIT)]
    Size(u32, u32),
    /// The work broke off.
    #[error("cannot be drawn: this should not happen, please tell us")]
    Broken,
}

impl From<RenderError> for io::Error {
    fn from(error: RenderError) -> Self {
        Self::other(error)
    }
}
