//! Writes pictures as PNG and animated PNG, and animations as GIF.

use std::io::{self, Write};

use super::gif_writer::{GifWriter, Palette};
use super::posed_model::Image;

/// The shortest delay that viewers of GIFs respect, in hundredths of a second.
const MIN_GIF_DELAY: u16 = 2;

/// Writes a picture as PNG.
///
/// # Errors
/// Those of `out`.
pub fn write_png(image: &Image, out: &mut (impl Write + ?Sized)) -> io::Result<()> {
    let mut encoder = png::Encoder::new(out, image.width(), image.height());
    encoder.set_color(png::ColorType::Rgba);
    encoder.set_source_srgb(png::SrgbRenderingIntent::Perceptual);
    // Tells pictures that may be replaced from those of other programs.
    let software = concat!("okoshi ", env!("CARGO_PKG_VERSION"));
    let written = encoder
        .add_text_chunk("Software".to_owned(), software.to_owned())
        .and_then(|()| encoder.write_header())
        .and_then(|mut writer| {
            writer.write_image_data(image.as_raw())?;
            writer.finish()
        });
    written.map_err(png_failure)
}

/// The error of the output itself, whose kind the conversion of the crate loses.
fn png_failure(error: png::EncodingError) -> io::Error {
    match error {
        png::EncodingError::IoError(error) => error,
        error => error.into(),
    }
}

/// Writes an animated picture frame by frame. It loops forever.
pub struct AnimationWriter<W: Write> {
    file: Format<W>,
    /// When the last frame ends, in seconds.
    until: f64,
    /// The sum of the delays written so far, in the file's own unit.
    written: f64,
}

/// The format of the file.
enum Format<W: Write> {
    /// 256 colours.
    Gif(Box<GifWriter<W>>),
    /// Animated PNG: all colours, full alpha.
    Apng(png::Writer<W>),
}

impl<W: Write> AnimationWriter<W> {
    /// Starts a GIF.
    ///
    /// # Errors
    /// Those of `out`.
    pub fn gif(out: W, size: [u32; 2], palette: Palette) -> io::Result<Self> {
        let writer = GifWriter::new(out, size, palette)?;
        Ok(Self::new(Format::Gif(Box::new(writer))))
    }

    /// Starts an animated PNG of `frames` frames.
    ///
    /// # Errors
    /// Those of `out`.
    pub fn apng(out: W, [width, height]: [u32; 2], frames: u32) -> io::Result<Self> {
        let mut encoder = png::Encoder::new(out, width, height);
        encoder.set_color(png::ColorType::Rgba);
        encoder.set_animated(frames, 0).map_err(png_failure)?;
        encoder
            .set_blend_op(png::BlendOp::Source)
            .map_err(png_failure)?;
        let writer = encoder.write_header().map_err(png_failure)?;
        Ok(Self::new(Format::Apng(writer)))
    }

    fn new(file: Format<W>) -> Self {
        Self {
            file,
            until: 0.0,
            written: 0.0,
        }
    }

    /// The delay of a frame that lasts `seconds`, rounded to `1 / units` seconds. Later frames make up for the rounding
    /// error.
    fn delay(&mut self, seconds: f64, units: f64, least: u16) -> u16 {
        self.until += seconds;
        let delay = (self.until * units).round() - self.written;
        let delay = delay.clamp(f64::from(least), f64::from(u16::MAX)) as u16;
        self.written += f64::from(delay);
        delay
    }

    /// Appends a frame that lasts some seconds: rounded to milliseconds, in a GIF to hundredths of a second and at least
    /// two of them.
    ///
    /// # Errors
    /// Those of the output.
    pub fn push(&mut self, image: &Image, seconds: f64) -> io::Result<()> {
        let delay = match self.file {
            Format::Apng(_) => self.delay(seconds, 1000.0, 0),
            Format::Gif(_) => self.delay(seconds, 100.0, MIN_GIF_DELAY),
        };
        match &mut self.file {
            Format::Apng(writer) => {
                let written = writer
                    .set_frame_delay(delay, 1000)
                    .and_then(|()| writer.write_image_data(image.as_raw()));
                written.map_err(png_failure)
            }
            Format::Gif(writer) => writer.push(image, delay),
        }
    }

    /// Completes the file.
    ///
    /// # Errors
    /// Those of the output, or missing frames.
    pub fn finish(self) -> io::Result<()> {
        match self.file {
            Format::Apng(writer) => writer.finish().map_err(png_failure),
            Format::Gif(writer) => writer.finish(),
        }
    }
}
