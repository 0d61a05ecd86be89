//! Decodes the images of a file.

use std::io::Cursor;

use ::image::{ImageReader, Limits, RgbaImage};

use super::ImportError;

/// The largest width and height of an image, in texels.
const MAX_IMAGE_SIDE: u32 = 16_384;
/// The memory that an image may take, in bytes.
const MAX_IMAGE_BYTES: u64 = 512 << 20;

/// Decodes an image.
///
/// # Errors
/// One that cannot be decoded, or is too large.
pub(crate) fn decode(bytes: &[u8]) -> Result<RgbaImage, ImportError> {
    let failed = |error: String| ImportError::Image(error);
    let mut reader = ImageReader::new(Cursor::new(bytes))
        .with_guessed_format()
        .map_err(|error| failed(error.to_string()))?;
    let mut limits = Limits::default();
    limits.max_image_width = Some(MAX_IMAGE_SIDE);
    limits.max_image_height = Some(MAX_IMAGE_SIDE);
    limits.max_alloc = Some(MAX_IMAGE_BYTES);
    reader.limits(limits);
    let image = reader.decode().map_err(|error| failed(error.to_string()))?;
    Ok(image.into_rgba8())
}
