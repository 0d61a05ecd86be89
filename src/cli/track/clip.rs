//! Clips as frames: animations, pictures and videos.

use std::io::{Cursor, Read as _};
use std::path::{Path, PathBuf};

use image::codecs::gif::GifDecoder;
use image::codecs::png::PngDecoder;
use image::codecs::webp::WebPDecoder;
use image::{AnimationDecoder, Frames, ImageDecoder, ImageReader, ImageResult, Limits, RgbImage};

use super::video;
use crate::disk::{files, open_stream, read_file};
use crate::mark_tracks::MAX_FRAMES;

/// The most pixels of a frame.
const MAX_PIXELS: u64 = 1 << 26;
/// The most bytes that decoding a frame may take.
const MAX_DECODED: u64 = 1 << 30;
/// Pictures a second, unless told otherwise.
const FPS: f64 = 24.0;
/// How long a frame is shown that the file gives no time: what browsers do.
const DEFAULT_DELAY: f64 = 0.1;

/// A frame of a clip.
pub(super) struct ClipFrame {
    pub(super) image: RgbImage,
    /// When it is shown, in seconds from the first one.
    pub(super) time: f64,
}

/// Looks at a frame; an error ends the clip.
pub(super) type Look<'a> = &'a mut dyn FnMut(ClipFrame) -> Result<(), String>;

/// A clip that can be read several times, a frame at a time.
pub(super) struct Clip {
    source: Source,
    fps: Option<f64>,
}

enum Source {
    Pictures(Vec<PathBuf>),
    Gif(PathBuf),
    Apng(PathBuf),
    WebP(PathBuf),
    Video(PathBuf),
}

impl Clip {
    /// The clip that these files are.
    ///
    /// # Errors
    /// If they cannot be read, or are no clip.
    pub(super) fn open(paths: &[PathBuf], fps: Option<f64>) -> Result<Self, String> {
        let source = match paths {
            [folder] if folder.is_dir() => match pictures(folder) {
                pictures if pictures.is_empty() => {
                    return Err(format!(
                        "the folder `{}` has no pictures: PNG, JPEG, WebP or GIF files",
                        folder.display()
                    ));
                }
                pictures => Source::Pictures(pictures),
            },
            [file] => Source::of(file)?,
            files => {
                let mut files = files.to_vec();
                natural_sort(&mut files);
                Source::Pictures(files)
            }
        };
        Ok(Self { source, fps })
    }

    /// The files that it is read from.
    pub(super) fn files(&self) -> Vec<PathBuf> {
        match &self.source {
            Source::Pictures(files) => files.clone(),
            Source::Gif(file) | Source::Apng(file) | Source::WebP(file) | Source::Video(file) => {
                vec![file.clone()]
            }
        }
    }

    /// The number of its frames, if that is known before they are read.
    pub(super) fn count(&self) -> Option<u32> {
        match &self.source {
            Source::Pictures(files) => u32::try_from(files.len()).ok(),
            _ => None,
        }
    }

    /// Reads all frames, one after the other.
    ///
    /// # Errors
    /// Those of `look`, and if a frame cannot be read, is too large, or of another size than the first one.
    pub(super) fn read(&self, look: Look<'_>) -> Result<(), String> {
        let mut number = 0_usize;
        let mut size = None;
        let mut checked = |name: &Path, frame: ClipFrame| {
            let (width, height) = frame.image.dimensions();
            let (first_width, first_height) = *size.get_or_insert((width, height));
            if (width, height) != (first_width, first_height) {
                return Err(format!(
                    "`{}` has {width} × {height} pixels, and the frames before it {first_width} × {first_height}: all must have the same size",
                    name.display()
                ));
            }
            if number == MAX_FRAMES {
                return Err(format!(
                    "the clip has more than {MAX_FRAMES} frames: cut it"
                ));
            }
            let time = match self.fps {
                Some(fps) => number as f64 / fps,
                None => frame.time,
            };
            number += 1;
            look(ClipFrame { time, ..frame })
        };
        match &self.source {
            Source::Pictures(files) => {
                for (index, file) in files.iter().enumerate() {
                    let time = index as f64 / FPS;
                    let image = picture(file)?;
                    checked(file, ClipFrame { image, time })?;
                }
                Ok(())
            }
            Source::Gif(file) => {
                let decoder = sized(file, GifDecoder::new(bytes(file)?))?;
                animation(file, decoder.into_frames(), &mut |frame| {
                    checked(file, frame)
                })
            }
            Source::Apng(file) => {
                let decoder = sized(file, PngDecoder::new(bytes(file)?))?;
                let decoder = decoder.apng().map_err(|error| broken(file, &error))?;
                animation(file, decoder.into_frames(), &mut |frame| {
                    checked(file, frame)
                })
            }
            Source::WebP(file) => {
                let decoder = sized(file, WebPDecoder::new(bytes(file)?))?;
                animation(file, decoder.into_frames(), &mut |frame| {
                    checked(file, frame)
                })
            }
            Source::Video(file) => video::read(file, &mut |frame| checked(file, frame)),
        }
    }
}

impl Source {
    /// What a file is, by its first bytes.
    fn of(file: &Path) -> Result<Self, String> {
        let mut start = Vec::new();
        let stream = open_stream(file).map_err(|error| error.to_string())?;
        let read = stream.take(16).read_to_end(&mut start);
        read.map_err(|error| format!("`{}` cannot be read: {error}", file.display()))?;
        let own = file.to_owned();
        match start.as_slice() {
            [b'G', b'I', b'F', b'8', ..] => Ok(Self::Gif(own)),
            [0x89, b'P', b'N', b'G', ..] => {
                let decoder = PngDecoder::new(bytes(file)?);
                let is_animated = decoder.and_then(|decoder| decoder.is_apng());
                if is_animated.map_err(|error| broken(file, &error))? {
                    Ok(Self::Apng(own))
                } else {
                    Ok(Self::Pictures(vec![own]))
                }
            }
            [
                b'R',
                b'I',
                b'F',
                b'F',
                _,
                _,
                _,
                _,
                b'W',
                b'E',
                b'B',
                b'P',
                ..,
            ] => {
                let decoder =
                    WebPDecoder::new(bytes(file)?).map_err(|error| broken(file, &error))?;
                if decoder.has_animation() {
                    Ok(Self::WebP(own))
                } else {
                    Ok(Self::Pictures(vec![own]))
                }
            }
            [0xff, 0xd8, 0xff, ..] => Ok(Self::Pictures(vec![own])),
            [] => Err(format!("`{}` is empty", file.display())),
            _ => Ok(Self::Video(own)),
        }
    }
}

/// A decoder of frames that are not too large.
fn sized<D: ImageDecoder>(file: &Path, decoder: ImageResult<D>) -> Result<D, String> {
    let decoder = decoder.map_err(|error| broken(file, &error))?;
    check_size(file, decoder.dimensions())?;
    Ok(decoder)
}

/// The frames of an animation.
fn animation(file: &Path, frames: Frames<'_>, look: Look<'_>) -> Result<(), String> {
    let mut time = 0.0;
    for (index, frame) in frames.enumerate() {
        let frame = frame.map_err(|error| {
            format!(
                "frame {} of `{}` cannot be read: {error}",
                index + 1,
                file.display()
            )
        })?;
        let (milliseconds, of) = frame.delay().numer_denom_ms();
        let seconds = f64::from(milliseconds) / f64::from(of.max(1)) / 1000.0;
        let image = opaque(&image::DynamicImage::from(frame.into_buffer()));
        look(ClipFrame { image, time })?;
        time += if seconds > 0.0 {
            seconds
        } else {
            DEFAULT_DELAY
        };
    }
    Ok(())
}

/// A single picture.
fn picture(file: &Path) -> Result<RgbImage, String> {
    let reader = ImageReader::new(bytes(file)?).with_guessed_format();
    let mut reader =
        reader.map_err(|error| format!("`{}` cannot be read: {error}", file.display()))?;
    let mut limits = Limits::default();
    limits.max_alloc = Some(MAX_DECODED);
    reader.limits(limits);
    let image = reader.decode().map_err(|error| broken(file, &error))?;
    check_size(file, (image.width(), image.height()))?;
    Ok(opaque(&image))
}

/// A picture without transparency: before white.
fn opaque(image: &image::DynamicImage) -> RgbImage {
    if !image.color().has_alpha() {
        return image.to_rgb8();
    }
    let image = image.to_rgba8();
    RgbImage::from_fn(image.width(), image.height(), |x, y| {
        let [r, g, b, alpha] = image.get_pixel(x, y).0;
        let alpha = u16::from(alpha);
        image::Rgb(
            [r, g, b].map(|value| ((u16::from(value) * alpha + 255 * (255 - alpha)) / 255) as u8),
        )
    })
}

/// Refuses frames of more pixels than can be meant.
pub(super) fn check_size(file: &Path, (width, height): (u32, u32)) -> Result<(), String> {
    match u64::from(width) * u64::from(height) {
        0 => Err(format!("`{}` has no pixels", file.display())),
        1..=MAX_PIXELS => Ok(()),
        _ => Err(format!(
            "`{}` has frames of {width} × {height} pixels: make them smaller, 640 pixels are enough",
            file.display()
        )),
    }
}

fn bytes(file: &Path) -> Result<Cursor<Vec<u8>>, String> {
    read_file(file)
        .map(Cursor::new)
        .map_err(|error| error.to_string())
}

fn broken(file: &Path, error: &image::ImageError) -> String {
    format!(
        "`{}` is no picture that can be read: {error}",
        file.display()
    )
}

/// The pictures in a folder, by their names.
fn pictures(folder: &Path) -> Vec<PathBuf> {
    const ENDINGS: [&str; 5] = ["png", "jpg", "jpeg", "webp", "gif"];
    let mut found = files(folder, |file| {
        let ending = file.extension().map(|ending| ending.to_ascii_lowercase());
        ending.is_some_and(|ending| ENDINGS.iter().any(|own| ending == *own))
    });
    natural_sort(&mut found);
    found
}

/// Sorts files by name, numbers in them by their values: `f9` before `f10`.
fn natural_sort(files: &mut [PathBuf]) {
    files.sort_by_cached_key(|file| natural_key(&file.to_string_lossy()));
}

/// A name in pieces: texts, and numbers by length and digits.
fn natural_key(name: &str) -> Vec<(String, usize, String)> {
    let mut pieces = Vec::new();
    let mut rest = name;
    while !rest.is_empty() {
        let text = rest.len() - rest.trim_start_matches(|c: char| !c.is_ascii_digit()).len();
        let (text, after) = rest.split_at(text);
        let digits = after.len() - after.trim_start_matches(|c: char| c.is_ascii_digit()).len();
        let (digits, after) = after.split_at(digits);
        let value = digits.trim_start_matches('0');
        pieces.push((text.to_owned(), value.len(), value.to_owned()));
        rest = after;
    }
    pieces
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_in_names_are_sorted_by_value() {
        let mut files =
            ["f10.png", "f9.png", "f009b.png", "a/f11.png", "f1.png"].map(PathBuf::from);
        natural_sort(&mut files);
        let sorted = files.map(|file| file.display().to_string());
        assert_eq!(
            sorted,
            ["a/f11.png", "f1.png", "f9.png", "f009b.png", "f10.png"]
        );
    }
}
