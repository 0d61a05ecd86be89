//! Videos: ffmpeg encodes them from frames that are piped to it.

use std::io::{self, Read as _, Write as _};
use std::process::{Child, ChildStderr, ChildStdin, Command, Stdio};
use std::thread::JoinHandle;

use crate::disk::Scratch;
use crate::export::Output;
use crate::render::Image;

/// The program that encodes and decodes videos.
pub(in crate::cli) const FFMPEG: &str = "ffmpeg";
/// The most lines of ffmpeg's errors that a message shows.
const MAX_ERROR_LINES: usize = 3;
/// The most bytes of its errors that are kept.
const MAX_ERROR_BYTES: u64 = 64 << 10;

/// The format of a video.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::cli) enum Container {
    /// H.264, which all browsers, QuickTime and editors play.
    Mp4,
    /// VP9, which browsers play.
    Webm,
}

impl Container {
    /// ffmpeg's name of the format, and what it needs to know about the codec.
    fn arguments(self) -> &'static [&'static str] {
        match self {
            Self::Mp4 => &[
                "-c:v",
                "libx264",
                "-preset",
                "medium",
                "-crf",
                "18",
                // Browsers can start before they have the whole file.
                "-movflags",
                "+faststart",
                "-f",
                "mp4",
            ],
            Self::Webm => &[
                "-c:v",
                "libvpx-vp9",
                "-deadline",
                "good",
                "-cpu-used",
                "2",
                "-row-mt",
                "1",
                "-crf",
                "24",
                "-b:v",
                "0",
                "-f",
                "webm",
            ],
        }
    }
}

/// What a video is like.
#[derive(Debug, Clone, Copy)]
pub(super) struct VideoFormat {
    pub(super) container: Container,
    /// Width and height in pixels, both even: the codecs store colours for two by two pixels.
    pub(super) size: [u32; 2],
    /// Frames per second, as a fraction.
    pub(super) rate: [u32; 2],
}

/// A running ffmpeg, which encodes a video.
pub(super) struct Encoder {
    child: Child,
    frames: Option<ChildStdin>,
    /// Reads what ffmpeg writes to its stderr, so that it never waits for a reader.
    errors: Option<JoinHandle<String>>,
}

impl Encoder {
    /// Starts ffmpeg, which writes to `scratch`.
    ///
    /// # Errors
    /// If there is no ffmpeg.
    pub(super) fn start(format: VideoFormat, scratch: &Scratch) -> io::Result<Self> {
        let [width, height] = format.size;
        let [frames, seconds] = format.rate;
        let mut child = Command::new(FFMPEG)
            .args(["-hide_banner", "-nostats", "-loglevel", "error", "-y"])
            .args(["-f", "rawvideo", "-pixel_format", "rgb24"])
            .args(["-video_size", &format!("{width}x{height}")])
            .args(["-framerate", &format!("{frames}/{seconds}")])
            .args(["-i", "pipe:0"])
            // The colours that players assume, and the only sampling that all of them play.
            .args(["-vf", "scale=out_color_matrix=bt709:out_range=tv"])
            .args(["-pix_fmt", "yuv420p", "-color_range", "tv"])
            .args(["-colorspace", "bt709", "-color_primaries", "bt709"])
            .args(["-color_trc", "bt709"])
            .args(format.container.arguments())
            .arg(scratch.path())
            .stdin(Stdio::piped())
            .stdout(Stdio::null())
            .stderr(Stdio::piped())
            .spawn()
            .map_err(not_started)?;
        let frames = child.stdin.take();
        let errors = child.stderr.take();
        let errors =
            errors.map(|errors| std::thread::Builder::new().spawn(move || read_errors(errors)));
        Ok(Self {
            child,
            frames,
            errors: errors.transpose()?,
        })
    }

    /// Appends a picture, shown for some frames.
    ///
    /// # Errors
    /// If ffmpeg has ended, with its own message.
    pub(super) fn push(&mut self, image: &Image, frames: u32) -> io::Result<()> {
        let pixels = image.pixels();
        let bytes: Vec<u8> = pixels
            .flat_map(|pixel| [pixel.0[0], pixel.0[1], pixel.0[2]])
            .collect();
        for _ in 0..frames {
            let written = match &mut self.frames {
                Some(pipe) => pipe.write_all(&bytes),
                None => return Err(io::ErrorKind::BrokenPipe.into()),
            };
            match written {
                // It says why it does not read on.
                Err(error) if error.kind() == io::ErrorKind::BrokenPipe => return self.finish(),
                written => written?,
            }
        }
        Ok(())
    }

    /// Waits until the video is complete.
    ///
    /// # Errors
    /// If ffmpeg fails, with its own message.
    pub(super) fn finish(&mut self) -> io::Result<()> {
        let was_open = self.frames.take().is_some();
        let status = self.child.wait()?;
        let told = self.errors.take().and_then(|errors| errors.join().ok());
        if status.success() && was_open {
            Ok(())
        } else {
            Err(io::Error::other(failure(&told.unwrap_or_default())))
        }
    }
}

/// The beginning of what ffmpeg writes to its stderr, which is read to its end.
pub(in crate::cli) fn read_errors(errors: ChildStderr) -> String {
    let mut told = Vec::new();
    let mut errors = errors.take(MAX_ERROR_BYTES);
    // What could be read is shown.
    let _ = errors.read_to_end(&mut told);
    let _ = io::copy(&mut errors.into_inner(), &mut io::sink());
    String::from_utf8_lossy(&told).into_owned()
}

impl Drop for Encoder {
    fn drop(&mut self) {
        // After an error of another kind ffmpeg would still wait for frames; if it has ended, there is nothing to end.
        self.frames = None;
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// Encodes the frames that `draw` pushes, and copies the video to `out`.
///
/// # Errors
/// Those of `draw`, of ffmpeg and of the output.
pub(super) fn encode(
    format: VideoFormat,
    mut scratch: Scratch,
    out: &mut dyn Output,
    draw: impl FnOnce(&mut Encoder) -> io::Result<()>,
) -> io::Result<()> {
    let mut encoder = Encoder::start(format, &scratch)?;
    draw(&mut encoder)?;
    encoder.finish()?;
    scratch.copy_to(out)
}

/// Why ffmpeg could not be started, and what to do about it.
fn not_started(error: io::Error) -> io::Error {
    match error.kind() {
        io::ErrorKind::NotFound => io::Error::new(
            error.kind(),
            "videos need the program ffmpeg, which is not installed; install it (`apt install ffmpeg`, `brew install \
             ffmpeg` or `winget install ffmpeg`), or write a .gif or .apng instead",
        ),
        kind => io::Error::new(kind, format!("ffmpeg cannot be started: {error}")),
    }
}

/// The message for what ffmpeg wrote to its stderr.
fn failure(told: &str) -> String {
    let lines: Vec<&str> = told
        .lines()
        .map(without_source)
        .filter(|line| !line.is_empty())
        .take(MAX_ERROR_LINES)
        .collect();
    if lines.is_empty() {
        "ffmpeg failed without a message; write a .gif or .apng instead".to_owned()
    } else {
        format!("ffmpeg failed: {}", lines.join("; "))
    }
}

/// A line without the part of ffmpeg that says it, as in `[libx264 @ 0x55d0c7] broken`.
fn without_source(line: &str) -> &str {
    let rest = line
        .strip_prefix('[')
        .and_then(|line| line.split_once("] "));
    match rest {
        Some((source, rest)) if source.contains(" @ 0x") => rest.trim(),
        _ => line.trim(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_of_ffmpeg_are_readable() {
        assert_eq!(
            failure(
                "[libx264 @ 0x55d0c7] width not divisible by 2 (3x2)\nError initializing output stream 0:0\n\n"
            ),
            "ffmpeg failed: width not divisible by 2 (3x2); Error initializing output stream 0:0"
        );
        assert!(failure(" \n").contains("without a message"));
        assert_eq!(without_source("[a] b"), "[a] b");
    }
}
