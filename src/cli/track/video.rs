//! Videos: ffmpeg decodes them, and pipes frames as YUV4MPEG2.

use std::io::{self, BufRead as _, BufReader, Read as _};
use std::path::Path;
use std::process::{Child, Command, Stdio};

use image::{Rgb, RgbImage};

use super::clip::{ClipFrame, Look, check_size};
use crate::cli::render::video::{FFMPEG, read_errors};

/// The longest header line, in bytes.
const MAX_HEADER: u64 = 4 << 10;

/// Ends ffmpeg with this value.
struct Decoder(Child);

impl Drop for Decoder {
    fn drop(&mut self) {
        // If it has ended, there is nothing to end.
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

/// What a stream begins with.
#[derive(Debug, PartialEq)]
struct Header {
    size: (u32, u32),
    /// Frames a second.
    rate: f64,
}

/// Reads the frames of a video, at its own rate.
///
/// # Errors
/// Those of `look`, if there is no ffmpeg, and if it cannot read the video.
pub(super) fn read(file: &Path, look: Look<'_>) -> Result<(), String> {
    // With the protocol, no name of a file is an option or an address.
    let mut source = std::ffi::OsString::from("file:");
    source.push(file);
    let child = Command::new(FFMPEG)
        .args(["-hide_banner", "-nostdin", "-nostats", "-loglevel", "error"])
        .arg("-i")
        .arg(source)
        .args(["-map", "0:v:0", "-an", "-sn"])
        .args(["-vf", "scale=out_color_matrix=bt601:out_range=tv"])
        .args(["-pix_fmt", "yuv444p", "-strict", "-1"])
        .args(["-f", "yuv4mpegpipe", "pipe:1"])
        .stdin(Stdio::null())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn();
    let mut decoder = Decoder(child.map_err(|error| not_started(file, &error))?);
    let errors = decoder.0.stderr.take();
    let errors = errors.map(|errors| std::thread::spawn(move || read_errors(errors)));
    let frames = match decoder.0.stdout.take() {
        Some(stream) => stream_frames(file, BufReader::new(stream), look)?,
        None => 0,
    };
    let status = decoder.0.wait();
    let told = errors
        .and_then(|errors| errors.join().ok())
        .unwrap_or_default();
    if status.is_ok_and(|status| status.success()) && frames > 0 {
        Ok(())
    } else {
        Err(not_decoded(file, &told))
    }
}

/// Reads the frames of a stream; their number is returned.
fn stream_frames(
    file: &Path,
    mut stream: impl io::BufRead,
    look: Look<'_>,
) -> Result<usize, String> {
    let Some(header) = line(&mut stream).as_deref().and_then(header) else {
        return Ok(0);
    };
    check_size(file, header.size)?;
    let (width, height) = header.size;
    let pixels = width as usize * height as usize;
    let mut planes = vec![0; 3 * pixels];
    let mut number = 0;
    while line(&mut stream).is_some_and(|line| line.starts_with("FRAME")) {
        if stream.read_exact(&mut planes).is_err() {
            break;
        }
        let (y, color) = planes.split_at(pixels);
        let (u, v) = color.split_at(pixels);
        let mut image = RgbImage::new(width, height);
        for (index, pixel) in image.pixels_mut().enumerate() {
            *pixel = rgb(y[index], u[index], v[index]);
        }
        let time = number as f64 / header.rate;
        look(ClipFrame { image, time })?;
        number += 1;
    }
    Ok(number)
}

/// A line of the stream, without its end.
fn line(stream: &mut impl io::BufRead) -> Option<String> {
    let mut bytes = Vec::new();
    let read = stream.take(MAX_HEADER).read_until(b'\n', &mut bytes);
    let is_complete = read.is_ok() && bytes.pop() == Some(b'\n');
    is_complete.then(|| String::from_utf8_lossy(&bytes).into_owned())
}

/// What the first line says, such as `YUV4MPEG2 W320 H240 F30000:1001 C444`.
fn header(line: &str) -> Option<Header> {
    let words = line.strip_prefix("YUV4MPEG2 ")?;
    let word = |letter: char| words.split(' ').find_map(|word| word.strip_prefix(letter));
    let (frames, seconds) = word('F')?.split_once(':')?;
    let rate = frames.parse::<f64>().ok()? / seconds.parse::<f64>().ok()?;
    Some(Header {
        size: (word('W')?.parse().ok()?, word('H')?.parse().ok()?),
        rate: (rate.is_finite() && rate > 0.0).then_some(rate)?,
    })
}

/// A colour of a video (BT.601, 16 to 235) in sRGB.
fn rgb(y: u8, u: u8, v: u8) -> Rgb<u8> {
    let (y, u, v) = (i32::from(y) - 16, i32::from(u) - 128, i32::from(v) - 128);
    // The standard's factors times 256.
    let rgb = [
        298 * y + 409 * v,
        298 * y - 100 * u - 208 * v,
        298 * y + 516 * u,
    ];
    Rgb(rgb.map(|value| ((value + 128) >> 8).clamp(0, 255) as u8))
}

/// Why ffmpeg could not be started, and what to do about it.
fn not_started(file: &Path, error: &io::Error) -> String {
    let name = file.display();
    match error.kind() {
        io::ErrorKind::NotFound => format!(
            "`{name}` is no GIF, PNG, WebP or JPEG, and other clips need the program ffmpeg, which is not installed; \
             install it (`apt install ffmpeg`, `brew install ffmpeg` or `winget install ffmpeg`), or convert the clip to a GIF"
        ),
        _ => format!("ffmpeg cannot be started to read `{name}`: {error}"),
    }
}

/// The message for what ffmpeg wrote to its stderr.
fn not_decoded(file: &Path, told: &str) -> String {
    let name = file.display();
    let last = told.lines().map(str::trim).rfind(|line| !line.is_empty());
    match last {
        Some(last) => format!("`{name}` is no clip that ffmpeg can read: {last}"),
        None => format!("`{name}` has no frames"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn streams_are_read_to_their_last_complete_frame() {
        let mut stream = b"YUV4MPEG2 W2 H1 F30000:1001 Ip A1:1 C444 XYSCSS=444\n".to_vec();
        stream.extend(b"FRAME\n\x52\x10\x5a\x80\xf0\x80FRAME\n\x10\xeb\x80\x80\x80\x80FRAME\n\x10");
        let mut seen = Vec::new();
        let count = stream_frames(Path::new("a.mp4"), &stream[..], &mut |frame| {
            seen.push((frame.time, frame.image.into_raw()));
            Ok(())
        });
        assert_eq!(count, Ok(2));
        assert_eq!(seen[1].1, [0, 0, 0, 255, 255, 255]);
        assert!((seen[1].0 - 1001.0 / 30000.0).abs() < 1e-9);
        // Red in this standard.
        let [r, g, b] = rgb(0x52, 0x5a, 0xf0).0;
        assert!(r > 250 && g < 5 && b < 5, "{r} {g} {b}");
    }

    #[test]
    fn other_streams_have_no_frames() {
        assert_eq!(header("YUV4MPEG2 W2 H1 F0:0"), None);
        assert_eq!(header("YUV4MPEG2 W2 F25:1"), None);
        let none = stream_frames(Path::new("a.mp4"), &b"RIFF"[..], &mut |_| Ok(()));
        assert_eq!(none, Ok(0));
    }
}
