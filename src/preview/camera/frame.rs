//! Frames as a page sends them.
//!
//! A binary message with a header of 16 bytes, numbers in little endian, followed by the pixels: rows from the top, three bytes each, sRGB.
//!
//! | bytes | type | content |
//! |---|---|---|
//! | 0–3 | `u32` | sequence number; ascends |
//! | 4–5 | `u16` | width, pixels |
//! | 6–7 | `u16` | height, pixels |
//! | 8–15 | `f64` | when the camera took the picture, milliseconds on any clock; ascends |

use axum::body::Bytes;
use thiserror::Error;

use crate::tracking::Frame;

/// The bytes before the pixels.
const HEADER: usize = 16;
/// The longest side of a picture, pixels.
pub(super) const MAX_SIDE: u32 = 320;
/// The shortest side: smaller pictures show no marks.
const MIN_SIDE: u32 = 16;
/// The latest time, milliseconds.
const MAX_TIME: f64 = 1e12;
/// The longest message that is a frame, in bytes.
pub(super) const MAX_BYTES: usize = HEADER + 3 * (MAX_SIDE * MAX_SIDE) as usize;

/// A picture of a camera.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Picture {
    /// Its number.
    pub(super) sequence: u32,
    /// Width and height, pixels.
    pub(super) size: [u32; 2],
    /// When it was taken, milliseconds.
    pub(super) time: f64,
    pixels: Bytes,
}

/// Why a message is no frame.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
pub(super) enum FrameError {
    #[error("a frame begins with a header of {HEADER} bytes; this message has {0}")]
    Header(usize),
    #[error("the sides of a frame have {MIN_SIDE} to {MAX_SIDE} pixels, not {0} × {1}")]
    Size(u32, u32),
    #[error("a frame of {0} × {1} pixels has {2} bytes of pixels, not {3}")]
    Pixels(u32, u32, usize, usize),
    #[error("the time of a frame is a number of milliseconds from 0 to {MAX_TIME:e}")]
    Time,
}

impl Picture {
    /// The picture in a binary message.
    pub(super) fn read(message: &Bytes) -> Result<Self, FrameError> {
        let (header, _) = message
            .split_first_chunk::<HEADER>()
            .ok_or(FrameError::Header(message.len()))?;
        let [s0, s1, s2, s3, w0, w1, h0, h1, time @ ..] = *header;
        let [width, height] =
            [[w0, w1], [h0, h1]].map(|bytes| u32::from(u16::from_le_bytes(bytes)));
        let is_side = |side| (MIN_SIDE..=MAX_SIDE).contains(&side);
        if !is_side(width) || !is_side(height) {
            return Err(FrameError::Size(width, height));
        }
        let time = f64::from_le_bytes(time);
        if !(0.0..=MAX_TIME).contains(&time) {
            return Err(FrameError::Time);
        }
        let pixels = message.slice(HEADER..);
        let expected = 3 * (width * height) as usize;
        if pixels.len() != expected {
            return Err(FrameError::Pixels(width, height, expected, pixels.len()));
        }
        Ok(Self {
            sequence: u32::from_le_bytes([s0, s1, s2, s3]),
            size: [width, height],
            time,
            pixels,
        })
    }

    /// Its pixels.
    pub(super) fn frame(&self) -> Option<Frame<'_>> {
        Frame::new(self.size, &self.pixels)
    }

    /// A message with a picture, for tests.
    #[cfg(test)]
    pub(super) fn message(sequence: u32, size: [u16; 2], time: f64, pixels: &[u8]) -> Bytes {
        let mut message = sequence.to_le_bytes().to_vec();
        message.extend(size.map(u16::to_le_bytes).concat());
        message.extend(time.to_le_bytes());
        message.extend(pixels);
        message.into()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_are_read() {
        let pixels = vec![7; 3 * 20 * 16];
        let picture = Picture::read(&Picture::message(9, [20, 16], 12.5, &pixels)).unwrap();
        assert_eq!(
            (picture.sequence, picture.size, picture.time),
            (9, [20, 16], 12.5)
        );
        assert_eq!(picture.frame().unwrap().size, [20, 16]);
    }

    #[test]
    fn other_messages_are_no_frames() {
        let read = |size, time, bytes: usize| {
            Picture::read(&Picture::message(1, size, time, &vec![0; bytes])).unwrap_err()
        };
        assert_eq!(
            Picture::read(&Bytes::from_static(b"short")),
            Err(FrameError::Header(5))
        );
        assert_eq!(read([0, 16], 0.0, 0), FrameError::Size(0, 16));
        assert_eq!(read([65535, 65535], 0.0, 0), FrameError::Size(65535, 65535));
        assert_eq!(
            read([16, 16], 0.0, 767),
            FrameError::Pixels(16, 16, 768, 767)
        );
        assert_eq!(
            read([16, 16], 0.0, 769),
            FrameError::Pixels(16, 16, 768, 769)
        );
        for time in [-1.0, 1e13, f64::NAN, f64::INFINITY] {
            assert_eq!(read([16, 16], time, 768), FrameError::Time);
        }
    }
}
