//! Pictures: decoding, classification by alpha, and encoding without fringes.

use std::io::Cursor;
use std::sync::Arc;

use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::{
    DynamicImage, ExtendedColorType, ImageDecoder as _, ImageEncoder as _, ImageReader, RgbaImage,
};

use super::{Alpha, Picture};
use crate::scene::MediaType;

/// The largest width and height of a picture in pixels.
const MAX_SIDE: u32 = 16_384;
/// The gamma of sRGB as PNG files give it, in 1/100,000.
const SRGB_GAMMA: u32 = 45_455;
/// How far colours are extended into transparent pixels; farther away they get the mean colour.
const BLEED: usize = 16;
/// The largest width of antialiasing along a sharp border, in pixels to either side.
const SEAM: i64 = 2;
/// One pixel in this many may be an exception.
const STRAY_SHARE: usize = 1000;

/// A decoded picture.
#[derive(Debug, Clone)]
pub(crate) struct Decoded {
    /// Its pixels, sRGB with straight alpha.
    pub pixels: RgbaImage,
    /// The format of the file, if glTF allows it as it is.
    pub media_type: Option<MediaType>,
}

/// Why a picture cannot be read. Messages follow `the picture`.
#[derive(Debug, thiserror::Error)]
pub(crate) enum PictureError {
    /// It is too large.
    #[error("has more than {MAX_SIDE} pixels along one side, or needs more than 512 MiB")]
    TooLarge,
    /// It is not a picture, or broken.
    #[error("cannot be read: {0}")]
    Unreadable(image::ImageError),
}

impl From<image::ImageError> for PictureError {
    fn from(error: image::ImageError) -> Self {
        match error {
            image::ImageError::Limits(_) => Self::TooLarge,
            other => Self::Unreadable(other),
        }
    }
}

/// What shows the holes of a picture with sharp borders.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Holes {
    /// The outline of the part; its texture is opaque, so that walls have colour up to the edge.
    Outline,
    /// The alpha of the texture.
    Alpha,
}

/// Reads a PNG, JPEG, GIF (its first frame) or WebP.
///
/// # Errors
/// See [`PictureError`].
pub(crate) fn decode(bytes: &[u8]) -> Result<Decoded, PictureError> {
    let (pixels, media_type) = pixels(bytes)?;
    Ok(Decoded {
        pixels: pixels.into_rgba8(),
        media_type,
    })
}

/// Decodes a picture in its stored pixel format; also returns the format of the file, if glTF allows it as it is.
///
/// # Errors
/// See [`PictureError`].
pub(crate) fn pixels(bytes: &[u8]) -> Result<(DynamicImage, Option<MediaType>), PictureError> {
    let reader = reader(bytes)?;
    let media_type = match reader.format() {
        Some(image::ImageFormat::Png) => is_plain_png(bytes).then_some(MediaType::Png),
        Some(image::ImageFormat::Jpeg) => Some(MediaType::Jpeg),
        _ => None,
    };
    Ok((reader.decode()?, media_type))
}

/// Decodes a picture as it is looked at: cameras write beside the pixels which side is up.
///
/// # Errors
/// See [`PictureError`].
pub(crate) fn upright(bytes: &[u8]) -> Result<DynamicImage, PictureError> {
    let mut decoder = reader(bytes)?.into_decoder()?;
    let orientation = decoder.orientation()?;
    let mut picture = DynamicImage::from_decoder(decoder)?;
    picture.apply_orientation(orientation);
    Ok(picture)
}

fn reader(bytes: &[u8]) -> Result<ImageReader<Cursor<&[u8]>>, PictureError> {
    let mut reader = ImageReader::new(Cursor::new(bytes))
        .with_guessed_format()
        .map_err(image::ImageError::IoError)?;
    let mut limits = image::Limits::default();
    limits.max_image_width = Some(MAX_SIDE);
    limits.max_image_height = Some(MAX_SIDE);
    reader.limits(limits);
    Ok(reader)
}

/// Whether a PNG is one that glTF allows: sRGB, with square pixels, and not animated.
fn is_plain_png(bytes: &[u8]) -> bool {
    let Ok(reader) = png::Decoder::new(Cursor::new(bytes)).read_info() else {
        return false;
    };
    let info = reader.info();
    let is_square = |dots: png::PixelDimensions| dots.xppu == dots.yppu;
    info.gama_chunk
        .is_none_or(|gamma| gamma.into_scaled() == SRGB_GAMMA)
        && info.chrm_chunk.is_none()
        && info.icc_profile.is_none()
        && info.coding_independent_code_points.is_none()
        && info.animation_control.is_none()
        && info.pixel_dims.is_none_or(is_square)
}

/// The image file for a picture in the model: the original if it is opaque. `None` if there is not enough memory.
pub(crate) fn picture(decoded: Decoded, bytes: &Arc<[u8]>, holes: Holes) -> Option<Picture> {
    let Decoded {
        mut pixels,
        media_type,
    } = decoded;
    let alpha = alpha(&pixels);
    if let (Alpha::Opaque, Some(media_type)) = (alpha, media_type) {
        return Some(Picture {
            media_type,
            bytes: Arc::clone(bytes),
            alpha,
        });
    }
    if holes == Holes::Outline && alpha == Alpha::Holes {
        for pixel in pixels.pixels_mut() {
            pixel.0[3] = if pixel.0[3] > 127 { 255 } else { 0 };
        }
        bleed(&mut pixels);
        pixels.pixels_mut().for_each(|pixel| pixel.0[3] = 255);
    }
    encode_png(pixels)
}

/// Encodes pixels as a PNG; transparent pixels get the colours next to them.
pub(super) fn encode_png(mut pixels: RgbaImage) -> Option<Picture> {
    let alpha = alpha(&pixels);
    let (width, height) = pixels.dimensions();
    let mut bytes = Vec::new();
    let encoder =
        PngEncoder::new_with_quality(&mut bytes, CompressionType::Default, FilterType::Adaptive);
    let written = if alpha == Alpha::Opaque {
        let colors: Vec<u8> = pixels
            .pixels()
            .flat_map(|pixel| [pixel.0[0], pixel.0[1], pixel.0[2]])
            .collect();
        encoder.write_image(&colors, width, height, ExtendedColorType::Rgb8)
    } else {
        bleed(&mut pixels);
        encoder.write_image(&pixels, width, height, ExtendedColorType::Rgba8)
    };
    written.ok()?;
    Some(Picture {
        media_type: MediaType::Png,
        bytes: bytes.into(),
        alpha,
    })
}

/// Classifies the transparency of a picture.
fn alpha(pixels: &RgbaImage) -> Alpha {
    let (width, height) = pixels.dimensions();
    let at = |x: i64, y: i64| {
        let inside = (0..i64::from(width)).contains(&x) && (0..i64::from(height)).contains(&y);
        inside.then(|| pixels.get_pixel(x as u32, y as u32).0[3])
    };
    if pixels.pixels().all(|pixel| pixel.0[3] == 255) {
        return Alpha::Opaque;
    }
    let most = pixels.pixels().len() / STRAY_SHARE;
    let mut strays = 0;
    for (x, y, pixel) in pixels.enumerate_pixels() {
        if matches!(pixel.0[3], 0 | 255) {
            continue;
        }
        let (x, y) = (i64::from(x), i64::from(y));
        let (mut hole, mut whole) = (false, false);
        for v in y - SEAM..=y + SEAM {
            for u in x - SEAM..=x + SEAM {
                let alpha = at(u, v);
                hole |= alpha == Some(0);
                whole |= alpha == Some(255);
            }
        }
        strays += usize::from(!(hole && whole));
        if strays > most {
            return Alpha::Blended;
        }
    }
    Alpha::Holes
}

/// Gives transparent pixels the colours of their neighbours, and the mean colour farther away.
fn bleed(pixels: &mut RgbaImage) {
    let (width, height) = pixels.dimensions();
    let (mut sum, mut count) = ([0_u64; 3], 0_u64);
    for pixel in pixels.pixels().filter(|pixel| pixel.0[3] > 0) {
        (0..3).for_each(|i| sum[i] += u64::from(pixel.0[i]));
        count += 1;
    }
    let mean = sum.map(|sum| (sum / count.max(1)) as u8);
    let beside = |at: usize| {
        let (x, y) = (at as u32 % width, at as u32 / width);
        let left = (x > 0).then(|| at - 1);
        let right = (x + 1 < width).then_some(at + 1);
        let above = (y > 0).then(|| at - width as usize);
        let below = (y + 1 < height).then_some(at + width as usize);
        [left, right, above, below].into_iter().flatten()
    };
    let raw: &mut [[u8; 4]] = bytemuck::cast_slice_mut(pixels);
    let mut known: Vec<bool> = raw.iter().map(|pixel| pixel[3] > 0).collect();
    let mut front: Vec<usize> = (0..raw.len())
        .filter(|at| !known[*at] && beside(*at).any(|other| known[other]))
        .collect();
    for _ in 0..BLEED {
        let colors: Vec<[u8; 3]> = front
            .iter()
            .map(|at| {
                let (mut sum, mut count) = ([0_u32; 3], 0);
                for other in beside(*at).filter(|other| known[*other]) {
                    (0..3).for_each(|i| sum[i] += u32::from(raw[other][i]));
                    count += 1;
                }
                sum.map(|sum| (sum / count.max(1)) as u8)
            })
            .collect();
        for (at, color) in front.iter().zip(colors) {
            raw[*at][..3].copy_from_slice(&color);
            known[*at] = true;
        }
        let mut next: Vec<usize> = front
            .iter()
            .flat_map(|at| beside(*at))
            .filter(|other| !known[*other])
            .collect();
        next.sort_unstable();
        next.dedup();
        front = next;
    }
    for (pixel, _) in raw.iter_mut().zip(known).filter(|(_, known)| !known) {
        pixel[..3].copy_from_slice(&mean);
    }
}
