//! Drawings that a page makes of pictures.

use crate::trace;

/// The text of a drawing with the shapes of a picture, which may be a photograph of a drawing on paper.
///
/// # Errors
/// Why there is none; the words follow the picture's name.
pub fn trace(picture: &[u8]) -> Result<String, String> {
    let traced = trace::trace(picture).map_err(|error| error.to_string())?;
    Ok(traced.svg)
}
